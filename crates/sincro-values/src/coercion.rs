//! Numbers where text is expected, and texts of numbers where numbers are: Lua converts both, and so do the functions
//! of V-REP and CoppeliaSim, for scripts and for clients.

use crate::Value;

/// Kind of a parameter as call tips write it: `string name`, `float[3] position`.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Text,
    Number,
    Other,
}

impl Kind {
    /// Kind of the entries of a type, and whether it is a list.
    fn of(parameter: &str) -> (Self, bool) {
        let word = parameter.trim_start().split([' ', '=']).next().unwrap_or_default();
        let (name, is_list) = word.split_once('[').map_or((word, false), |(name, _)| (name, true));
        let kind = match name {
            "string" | "buffer" => Self::Text,
            "int" | "float" | "double" => Self::Number,
            _ => Self::Other,
        };
        (kind, is_list)
    }

    /// Returns true if a value is converted.
    fn is_changed(self, value: &Value) -> bool {
        match (self, value) {
            (Self::Text, Value::Int(_) | Value::Real(_)) => true,
            (Self::Number, Value::Text(text)) => number(text).is_some(),
            _ => false,
        }
    }

    fn convert(self, value: &Value) -> Value {
        match (self, value) {
            (Self::Text, Value::Int(x)) => Value::Text(x.to_string()),
            (Self::Text, Value::Real(x)) => Value::Text(text(*x)),
            (Self::Number, Value::Text(text)) => number(text).unwrap_or_else(|| value.clone()),
            _ => value.clone(),
        }
    }
}

/// Parameters of a call tip such as `int result=sim.f(int handle,float[4] metric={1,1,1,0.1})`, in their order.
pub fn parameters(tip: &str) -> impl Iterator<Item = &str> {
    let arguments = tip.split_once('(').map_or("", |(_, arguments)| arguments.trim_end_matches(')'));
    let mut depth = 0;
    arguments.split(move |c: char| {
        depth += i32::from(c == '{') - i32::from(c == '}');
        c == ',' && depth == 0
    })
}

/// Arguments as the parameters of a call tip take them: numbers as text where the tip says `string` or `buffer`, texts
/// that are numbers as numbers where it says `int`, `float` or `double`, alone and in lists. None if nothing changes.
///
/// ```
/// use sincro_values::{Value, coercion::coerced};
///
/// let tip = "int result=sim.tubeWrite(int tubeHandle,buffer data)";
/// let given = [Value::from("7"), Value::from(0.5)];
/// assert_eq!(coerced(tip, &given), Some(vec![Value::from(7_i64), Value::from("0.5")]));
/// assert_eq!(coerced(tip, &[Value::from(7_i64), Value::from("on")]), None);
/// ```
#[must_use]
pub fn coerced(tip: &str, given: &[Value]) -> Option<Vec<Value>> {
    let is_changed = |(value, parameter): (&Value, &str)| match (value, Kind::of(parameter)) {
        (Value::List(list), (kind, true)) => list.iter().any(|entry| kind.is_changed(entry)),
        (_, (kind, false)) => kind.is_changed(value),
        _ => false,
    };
    if !given.iter().zip(parameters(tip)).any(is_changed) {
        return None;
    }
    let mut changed = given.to_vec();
    for (value, parameter) in changed.iter_mut().zip(parameters(tip)) {
        match (&mut *value, Kind::of(parameter)) {
            (Value::List(list), (kind, true)) => list.iter_mut().for_each(|entry| *entry = kind.convert(entry)),
            (_, (kind, false)) => *value = kind.convert(value),
            _ => {}
        }
    }
    Some(changed)
}

/// The number that a text is, as Lua reads it, blanks around it or not; none for other texts.
fn number(text: &str) -> Option<Value> {
    let text = text.trim();
    let is_decimal = |c: u8| c.is_ascii_digit() || matches!(c, b'+' | b'-' | b'.' | b'e' | b'E');
    if !text.bytes().all(is_decimal) {
        return None;
    }
    text.parse().map(Value::Int).ok().or_else(|| text.parse().map(Value::Real).ok())
}

/// The text of a number as Lua writes it: 14 digits, with a fraction.
fn text(x: f64) -> String {
    let rounded: f64 = format!("{x:.13e}").parse().unwrap_or(x);
    let (size, zero) = (rounded.abs(), rounded == 0.0);
    match rounded.is_finite() && (zero || (1e-5..1e15).contains(&size)) {
        true if rounded.fract() == 0.0 => format!("{rounded:.1}"),
        true => rounded.to_string(),
        false => format!("{rounded:e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_those_of_lua() {
        let cases = [(0.0, "0.0"), (5.0, "5.0"), (-0.1, "-0.1"), (1.0 / 3.0, "0.33333333333333"), (2.5e20, "2.5e20")];
        for (x, expected) in cases {
            assert_eq!(text(x), expected);
        }
    }

    #[test]
    fn only_texts_that_are_numbers_become_numbers() {
        assert_eq!(number(" 12 "), Some(Value::Int(12)));
        assert_eq!(number("-1.5e-3"), Some(Value::Real(-1.5e-3)));
        for other in ["", "e", "inf", "nan", "1 2", "0x", "@backCompatibility1:3", "joint1"] {
            assert_eq!(number(other), None, "{other}");
        }
    }

    #[test]
    fn lists_and_defaults_with_commas_keep_the_order_of_parameters() {
        let tip = "float[] q=simIK.f(int group,float[4] metric={1,1,1,0.1},string name='')";
        let metric = Value::List(vec!["1".into(), 2.0.into(), 3_i64.into(), "0.1".into()]);
        let changed = coerced(tip, &[1_i64.into(), metric, 4_i64.into()]).unwrap();
        let metric = Value::List(vec![1_i64.into(), 2.0.into(), 3_i64.into(), 0.1.into()]);
        assert_eq!(changed, [1_i64.into(), metric, "4".into()]);
    }
}
