//! Description of a check's comparison, with its unit.

use super::along::{Along, short};
use super::rows::file_name;
use super::series::plain_signal;
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

/// Unit of the measured value; empty if it is that of a formula.
pub(super) fn unit(check: &Check, along: &Along) -> String {
    let key_unit = along.table.columns[0].unit.as_str();
    let signal = plain_signal(check).and_then(|name| along.table.column(name));
    match (check.measure, signal.map(|column| column.unit.as_str())) {
        (Measure::TimeOfMin | Measure::TimeOfMax | Measure::RiseTime | Measure::SettlingTime, _) => key_unit.to_owned(),
        (Measure::Overshoot, _) | (_, None) => String::new(),
        (Measure::Integral, Some(unit)) => times(unit, key_unit),
        (_, Some(unit)) => unit.to_owned(),
    }
}

/// The product of two units: `rad/s` times `s` is `rad`.
fn times(unit: &str, by: &str) -> String {
    match (unit, by) {
        ("" | "1", by) => by.to_owned(),
        (unit, "" | "1") => unit.to_owned(),
        (unit, by) => match unit.strip_suffix(by).and_then(|rest| rest.strip_suffix('/')) {
            Some(rest) => rest.to_owned(),
            None => format!("{unit}·{by}"),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::times;

    #[test]
    fn units_multiply() {
        assert_eq!(
            [times("N·m", "s"), times("rad/s", "s"), times("1", "s"), times("rad", "")],
            ["N·m·s", "rad", "s", "rad"]
        );
        assert_eq!(times("rad/s²", "s"), "rad/s²·s");
    }
}
