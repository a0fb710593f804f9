//! Numbers as text, the same on every machine: no locale, no negative zero, no platform logarithm.
//!
//! Coordinates inside SVG use the ASCII minus, numbers for readers the minus sign (−) and powers of ten as `×10⁻⁹`.

use std::fmt::Write;

/// Decimal exponent of a finite number other than zero: 3 for 1234, −2 for 0.05; 0 for everything else.
///
/// Read off the shortest decimal form, which is exact, where a logarithm could be off by one next to a power of ten.
pub(crate) fn exponent(x: f64) -> i32 {
    if x == 0.0 || !x.is_finite() {
        return 0;
    }
    let text = format!("{x:e}");
    text.split_once('e').and_then(|(_, digits)| digits.parse().ok()).unwrap_or(0)
}

/// 10ⁿ, correctly rounded.
pub(crate) fn pow10(n: i32) -> f64 {
    format!("1e{n}").parse().unwrap_or(1.0)
}

/// log₁₀ x for x > 0, to about 1e-15: `ln m = 2 artanh((m − 1)/(m + 1))` on a mantissa near one.
pub(crate) fn log10(x: f64) -> f64 {
    let power = exponent(x);
    // x / 10^power lies in [1, 10), its fourth root in [1, 1.78): z < 0.29, and 16 terms of the series are enough.
    let mantissa = (x / pow10(power)).sqrt().sqrt();
    let z = (mantissa - 1.0) / (mantissa + 1.0);
    let series: f64 = (0..16).rev().fold(0.0, |sum, k| sum * z * z + 1.0 / f64::from(2 * k + 1));
    f64::from(power) + 4.0 * 2.0 * z * series / std::f64::consts::LN_10
}

/// A coordinate in an SVG attribute: two decimals at most, no trailing zeros.
pub(crate) fn coordinate(x: f64) -> String {
    let text = format!("{x:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if matches!(text, "-0" | "") { "0".into() } else { text.into() }
}

/// Adds a whole number of hundredths to an attribute as [`coordinate`] writes it.
pub(crate) fn push_hundredths(text: &mut String, hundredths: f64) {
    // above, a double has no hundredths
    if hundredths.abs() >= 1e15 || hundredths.is_nan() {
        return text.push_str(&coordinate(hundredths / 100.0));
    }
    let (whole, rest) = (hundredths.abs() as u64 / 100, hundredths.abs() as u64 % 100);
    let sign = if hundredths < 0.0 { "-" } else { "" };
    let written = match (rest / 10, rest % 10) {
        (0, 0) => write!(text, "{sign}{whole}"),
        (tenths, 0) => write!(text, "{sign}{whole}.{tenths}"),
        (tenths, last) => write!(text, "{sign}{whole}.{tenths}{last}"),
    };
    written.expect("a string takes all text");
}

/// Formats a number with `decimals` digits after the point and a typographic minus: `−0.50`. The caller adds the unit.
pub fn fixed(x: f64, decimals: usize) -> String {
    let text = format!("{:.decimals$}", x.abs());
    let is_zero = text.bytes().all(|b| matches!(b, b'0' | b'.'));
    if x < 0.0 && !is_zero { format!("−{text}") } else { text }
}

/// Formats a number with `digits` significant digits: `0.0123`, `4.56×10⁻⁹`, `∞`, `not a number`. The caller adds the
/// unit.
///
/// ```
/// use sincro_figures::plot::number::{fixed, short, significant};
///
/// assert_eq!((significant(0.5, 3), short(0.5, 3)), ("0.500".to_owned(), "0.5".to_owned()));
/// assert_eq!((significant(4.56e-9, 3), fixed(-0.5, 2)), ("4.56×10⁻⁹".to_owned(), "−0.50".to_owned()));
/// ```
pub fn significant(x: f64, digits: usize) -> String {
    if let Some(text) = special(x) {
        return text;
    }
    let digits = digits.clamp(1, 17);
    let rounded = format!("{:.*e}", digits - 1, x.abs());
    let (mantissa, power) = rounded.split_once('e').unwrap_or((&rounded, "0"));
    let power: i32 = power.parse().unwrap_or(0);
    if (-4..6).contains(&power) {
        return fixed(x, (digits as i32 - 1 - power).max(0) as usize);
    }
    let sign = if x < 0.0 { "−" } else { "" };
    format!("{sign}{mantissa}×10{}", superscript(power))
}

/// Formats a number as [`significant`] does, without trailing zeros: for limits and settings that somebody has typed.
pub fn short(x: f64, digits: usize) -> String {
    let text = significant(x, digits);
    let (number, rest) = text.split_once('×').map_or((text.as_str(), None), |(n, r)| (n, Some(r)));
    let number = match number.contains('.') {
        true => number.trim_end_matches('0').trim_end_matches('.'),
        false => number,
    };
    match rest {
        None => number.into(),
        Some(rest) if number == "1" => rest.into(),
        Some(rest) if number == "−1" => format!("−{rest}"),
        Some(rest) => format!("{number}×{rest}"),
    }
}

/// A number with as many digits as a difference of size `resolution` needs to be seen, at least 3, at most 15.
pub(crate) fn resolved(x: f64, resolution: f64) -> String {
    if resolution > 0.0 && resolution.is_finite() && x.is_finite() {
        let digits = exponent(x) - exponent(resolution) + 2;
        significant(x, digits.clamp(3, 15) as usize)
    } else {
        significant(x, 9)
    }
}

/// `⁻⁹` for −9.
pub(crate) fn superscript(n: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raise = |c: char| c.to_digit(10).map_or('⁻', |digit| DIGITS[digit as usize]);
    n.to_string().chars().map(raise).collect()
}

/// Text of zero and of what is not a finite number.
fn special(x: f64) -> Option<String> {
    let text = match x {
        0.0 => "0",
        _ if x.is_nan() => "not a number",
        f64::INFINITY => "∞",
        f64::NEG_INFINITY => "−∞",
        _ => return None,
    };
    Some(text.into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hundredths_are_written_as_coordinates() {
        let large = [1e7 + 3.0, 123_456_789_012_345.0, 1e15, 3e18, f64::NAN, f64::NEG_INFINITY];
        for hundredths in (-2001..2001).map(f64::from).chain([-0.0]).chain(large) {
            let mut text = String::new();
            push_hundredths(&mut text, hundredths);
            assert_eq!(text, coordinate(hundredths / 100.0), "{hundredths}");
        }
    }

    #[test]
    fn negative_zero_is_never_written() {
        assert_eq!(coordinate(-0.001), "0");
        assert_eq!(fixed(-0.004, 2), "0.00");
        assert_eq!(significant(-0.0, 3), "0");
    }

    #[test]
    fn exponents_are_exact_at_powers_of_ten() {
        for n in -300..=300 {
            assert_eq!(exponent(pow10(n)), n);
            assert_eq!(log10(pow10(n)), f64::from(n));
        }
    }

    #[test]
    fn logarithm_agrees_with_the_platform() {
        for i in 1..2000 {
            let x = f64::from(i) * 0.37;
            // Both are good to a few units in the last place of numbers up to 3.
            assert!((log10(x) - x.log10()).abs() < 3e-15, "{x}");
        }
    }

    #[test]
    fn readers_get_powers_of_ten_and_minus_signs() {
        assert_eq!(significant(-4.561e-9, 3), "−4.56×10⁻⁹");
        assert_eq!(significant(0.012345, 3), "0.0123");
        assert_eq!(significant(9.9999e5, 3), "1.00×10⁶");
        assert_eq!(significant(f64::NAN, 3), "not a number");
        assert_eq!(short(1e-9, 3), "10⁻⁹");
        assert_eq!(short(2.50, 3), "2.5");
        assert_eq!(short(-2e-7, 3), "−2×10⁻⁷");
    }

    #[test]
    fn digits_follow_the_resolution() {
        assert_eq!(resolved(-0.29700587012, 2e-9), "−0.2970058701");
        assert_eq!(resolved(0.0, 2e-9), "0");
        assert_eq!(resolved(12.3456, 10.0), "12.3");
    }
}
