//! Numbers and names as a person would write them.

/// Shortest decimal that reads back as the same number; always with a point or an exponent.
pub(crate) fn number(x: f64) -> String {
    let plain = format!("{:?}", x + 0.0);
    // 1e-5 is good TOML, 1e16 too
    if plain == "-0.0" { "0.0".into() } else { plain }
}

/// Shortest decimal that reads back as the same number, whole numbers without a point.
pub(crate) fn plain(x: f64) -> String {
    format!("{}", x + 0.0)
}

/// A list in brackets.
pub(crate) fn list(numbers: &[f64]) -> String {
    format!("[{}]", numbers.iter().map(|x| number(*x)).collect::<Vec<_>>().join(", "))
}

/// Degrees with as few digits as give the same angle, to 2 units in the last place.
pub(crate) fn degrees(radians: f64) -> f64 {
    if radians == 0.0 {
        return 0.0;
    }
    let exact = radians.to_degrees();
    let close = |d: f64| (d.to_radians() - radians).abs() <= 2.0 * f64::EPSILON * radians.abs();
    (0..=16)
        .map(|digits| format!("{exact:.digits$}").parse::<f64>().unwrap_or(exact))
        .find(|d| close(*d))
        .unwrap_or(exact)
}

/// A name of the scene language: letters, digits, `_` and `-`.
pub(crate) fn name(text: &str) -> String {
    let good = |c: char| if c.is_ascii_alphanumeric() || c == '_' || c == '-' { c } else { '_' };
    let made: String = text.trim().chars().map(good).collect();
    if made.is_empty() { "unnamed".into() } else { made }
}

/// A string of TOML.
pub(crate) fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            '\n' => out.push_str("\\n"),
            c if c.is_control() => out.push_str(&format!("\\u{:04X}", u32::from(c))),
            c => out.push(c),
        }
    }
    out.push('"');
    out
}

/// Four significant digits, for tables.
pub(crate) fn short(x: f64) -> String {
    if x == 0.0 {
        return "0".into();
    }
    let magnitude = x.abs().log10().floor();
    if !(-4.0..6.0).contains(&magnitude) {
        return format!("{x:.3e}");
    }
    let digits = (3.0 - magnitude).max(0.0) as usize;
    let text = format!("{x:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn right_angles_are_round_in_degrees() {
        assert_eq!(degrees(std::f64::consts::FRAC_PI_2), 90.0);
        assert_eq!(degrees(-std::f64::consts::PI), -180.0);
        assert!((degrees(0.1).to_radians() - 0.1).abs() <= 5e-17, "{}", degrees(0.1));
        assert_eq!(degrees(30.0_f64.to_radians()), 30.0);
    }

    #[test]
    fn names_have_letters_digits_and_dashes_alone() {
        assert_eq!(name("left arm/1"), "left_arm_1");
        assert_eq!(name(""), "unnamed");
    }

    #[test]
    fn figures_of_tables_have_four_digits() {
        assert_eq!([short(12.34567), short(0.0), short(1e-7), short(2.0)], ["12.35", "0", "1.000e-7", "2"]);
    }
}
