//! Digits of a reference, where they limit what a difference from it can show.

use crate::plot::number::{exponent, pow10, short};

/// A reference with more significant digits is taken for one without rounding.
const MAX_DIGITS: i32 = 12;
/// Fewer values say nothing about their rounding.
const MIN_VALUES: usize = 8;
/// Values whose digits are looked at, at most.
const MAX_VALUES: usize = 4000;
/// Share of the greatest difference from which on rounding is named.
const MIN_SHARE: f64 = 0.2;

/// Remark for an error panel whose curve is mostly the rounding of its reference; `None`: it is not.
pub(super) fn remark(reference: &[f64], differences: &[f64], unit: &str) -> Option<String> {
    let (digits, rounding) = rounding(reference)?;
    let greatest = differences.iter().filter(|d| d.is_finite()).fold(0.0_f64, |a, d| a.max(d.abs()));
    let bound = format!("±{} {unit}", short(rounding, 2));
    (rounding >= MIN_SHARE * greatest && greatest > 0.0)
        .then(|| format!("the reference has {digits} digits: {} of the difference is its rounding", bound.trim_end()))
}

/// Significant digits of a reference, and half a unit of the last one of its greatest value. A table with a fixed count
/// of decimals has most digits where it is greatest, one with a fixed number of digits has them everywhere.
fn rounding(values: &[f64]) -> Option<(i32, f64)> {
    let greatest = values.iter().filter(|v| v.is_finite()).fold(0.0_f64, |a, v| a.max(v.abs()));
    let large: Vec<f64> = values.iter().copied().filter(|v| v.abs() >= 0.1 * greatest).take(MAX_VALUES).collect();
    if greatest == 0.0 || large.len() < MIN_VALUES || large.iter().all(|v| *v == large[0]) {
        return None;
    }
    let digits = large.iter().map(|v| significant_digits(*v)).max()?;
    let last = exponent(greatest) - digits + 1;
    (2..=MAX_DIGITS).contains(&digits).then(|| (digits, 0.5 * pow10(last)))
}

/// Digits of the shortest text that reads as this number, without zeros at either end.
fn significant_digits(value: f64) -> i32 {
    let text: String = value.abs().to_string().chars().filter(char::is_ascii_digit).collect();
    text.trim_matches('0').len() as i32
}

#[cfg(test)]
mod tests {
    use super::*;
    use sincro_math::elementary::sin_cos;

    fn wave() -> Vec<f64> {
        (0..200).map(|k| sin_cos(0.05 * f64::from(k)).0).collect()
    }

    #[test]
    fn rounding_of_a_table_is_named() {
        let exact = wave();
        let printed: Vec<f64> = exact.iter().map(|y| (y * 1e6).round() / 1e6).collect();
        let differences: Vec<f64> = exact.iter().zip(&printed).map(|(a, b)| a - b).collect();
        let remark = remark(&printed, &differences, "rad").unwrap();
        assert!(remark.contains("digits") && remark.contains("rad"), "{remark}");
    }

    #[test]
    fn a_fixed_number_of_digits_limits_the_greatest_values() {
        // seven digits: 0.9999999 has seven decimals, 1.000001 has six
        let exact: Vec<f64> =
            (0..400).map(|k| 0.98 + 1e-4 * f64::from(k) + 1.234_567_8e-7 * f64::from(k % 17)).collect();
        let printed: Vec<f64> = exact.iter().map(|y| format!("{y:.6e}").parse().unwrap()).collect();
        let differences: Vec<f64> = exact.iter().zip(&printed).map(|(a, b)| a - b).collect();
        assert!(remark(&printed, &differences, "m").unwrap().contains("7 digits"));
    }

    #[test]
    fn a_reference_of_full_digits_and_a_large_error_are_not() {
        let exact = wave();
        assert_eq!(remark(&exact, &[1e-15; 200], "rad"), None);
        let printed: Vec<f64> = exact.iter().map(|y| (y * 1e6).round() / 1e6).collect();
        assert_eq!(remark(&printed, &[1e-3; 200], "rad"), None);
        assert_eq!(remark(&[0.5; 200], &[0.0; 200], "rad"), None);
    }
}
