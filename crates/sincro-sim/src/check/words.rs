//! Description of a check's comparison, with its unit.

use super::along::{Along, short};
use super::rows::file_name;
use super::series::plain_signal;
use sincro_blocks::unit::{Unit, UnitsOfFormulas};
use sincro_math::expression::Expression;
use sincro_scene::experiment::check::{Check, Expected, Measure, Sense, Subject};

/// `greatest value of /shoulder.position against 0.2, from t = 1 s to 3 s`.
pub(super) fn about(check: &Check, along: &Along) -> String {
    let what = subject(check);
    if check.measure == Measure::Divergence {
        let Expected::Value(bound) = check.expected else { return what };
        return format!("{what} leaves the bound of {}{}", short(bound), place(check, along));
    }
    let what = match check.measure {
        Measure::Error | Measure::Divergence => what,
        Measure::Final => format!("last value of {what}"),
        Measure::Mean => format!("mean of {what}"),
        Measure::Min => format!("least value of {what}"),
        Measure::Max => format!("greatest value of {what}"),
        Measure::MaxAbs => format!("greatest magnitude of {what}"),
        Measure::Rms => format!("root mean square of {what}"),
        Measure::Std => format!("standard deviation of {what}"),
        Measure::Integral => format!("integral of {what}"),
        Measure::TimeOfMin => format!("place of the least value of {what}"),
        Measure::TimeOfMax => format!("place of the greatest value of {what}"),
        Measure::Overshoot => format!("overshoot of {what}{}", towards(check)),
        Measure::RiseTime => format!("rise time (10–90 %) of {what}{}", towards(check)),
        Measure::SettlingTime => {
            format!("settling time (±{} %) of {what}{}", short(100.0 * check.band), towards(check))
        }
    };
    let what = if along.is_sweep() { what } else { what.replacen("place of", "time of", 1) };
    let against = match &check.expected {
        Expected::Value(value) => short(*value),
        Expected::Formula(formula) => formula.to_string(),
        Expected::Reference(reference) => format!("column {} of {}", reference.column, file_name(reference)),
    };
    let link = match check.sense {
        Sense::Equal => "against",
        Sense::AtMost => "at most",
        Sense::AtLeast => "at least",
    };
    format!("{what} {link} {against}{}", place(check, along))
}

fn towards(check: &Check) -> String {
    check.target.map_or_else(String::new, |target| format!(" towards {}", short(target)))
}

fn subject(check: &Check) -> String {
    match (plain_signal(check), &check.what) {
        (Some(signal), _) => signal.to_owned(),
        (None, Subject::Formula(formula)) => formula.to_string(),
        (None, Subject::Signal(name)) => name.value.clone(),
    }
}

fn place(check: &Check, along: &Along) -> String {
    match (check.at, check.window) {
        (Some(at), _) => format!(", at {}", along.place(at)),
        (None, Some((first, last))) => format!(", from {} to {}", along.place(first), along.amount(last)),
        (None, None) => String::new(),
    }
}

/// Unit of the measured value; empty if it is that of a formula and does not follow from those of its signals.
pub(super) fn unit(check: &Check, along: &Along) -> String {
    let key_unit = along.table.columns[0].unit.as_str();
    let text = match (plain_signal(check), &check.what) {
        (Some(name), _) => along.table.column(name).map(|column| column.unit.clone()),
        (None, Subject::Formula(formula)) => of_formula(check, formula, along).map(|unit| unit.to_string()),
        (None, Subject::Signal(_)) => None,
    };
    match (check.measure, text) {
        (Measure::TimeOfMin | Measure::TimeOfMax | Measure::RiseTime | Measure::SettlingTime, _) => key_unit.to_owned(),
        (Measure::Overshoot, _) | (_, None) => String::new(),
        (Measure::Integral, Some(unit)) => times(&unit, key_unit),
        (_, Some(unit)) => unit,
    }
}

/// Unit of a check's formula: the declared one, or what follows from the units of its signals, there or in the formula
/// of the expected value.
fn of_formula(check: &Check, formula: &Expression, along: &Along) -> Option<Unit> {
    let of_column = |text: &str| Unit::parse(text).ok().filter(|_| !text.is_empty());
    let of_signal = |name: &str| along.table.column(name).and_then(|column| of_column(&column.unit));
    let aliases = check.aliases.iter().map(|(_, signal)| of_signal(&signal.value));
    let names: Vec<Option<Unit>> = aliases.chain([of_column(&along.table.columns[0].unit)]).collect();
    let of = |formula: &Expression| formula.unit(&UnitsOfFormulas, &names);
    let of_expected = || match &check.expected {
        Expected::Formula(expected) => of(expected),
        _ => None,
    };
    check.unit.clone().or_else(|| of(formula)).or_else(of_expected)
}

/// The product of two units: `rad/s` times `s` is `rad`.
fn times(unit: &str, by: &str) -> String {
    let parsed = |text: &str| Unit::parse(text).ok();
    let product = parsed(unit).zip(parsed(by)).and_then(|(unit, by)| Unit::product(&[(&unit, 1), (&by, 1)]));
    product.map_or_else(|| format!("{unit}·{by}"), |unit| unit.to_string())
}

#[cfg(test)]
mod tests {
    use super::times;

    #[test]
    fn units_multiply() {
        let pairs = [("N·m", "s"), ("rad/s", "s"), ("1", "s"), ("rad", ""), ("rad/s²", "s")];
        assert_eq!(pairs.map(|(unit, by)| times(unit, by)), ["N·m·s", "rad", "s", "rad", "rad/s"]);
    }
}
