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

/// Rounding of a reference.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rounding {
    /// Significant digits.
    digits: i32,
    /// Half a unit of the last digit of the greatest value.
    bound: f64,
}

impl Rounding {
    /// The rounding that differences from a reference mostly are; `None`: they are not.
    pub fn limiting(reference: &[f64], differences: &[f64]) -> Option<Self> {
        let greatest = differences.iter().filter(|d| d.is_finite()).fold(0.0_f64, |a, d| a.max(d.abs()));
        rounding(reference).filter(|found| found.bound >= MIN_SHARE * greatest && greatest > 0.0)
    }

    /// The coarser of two roundings.
    pub fn coarser(a: Option<Self>, b: Option<Self>) -> Option<Self> {
        a.into_iter().chain(b).max_by(|a, b| a.bound.total_cmp(&b.bound))
    }

    /// Remark for an error panel.
    pub fn remark(self, unit: &str) -> String {
        let bound = format!("±{} {unit}", short(self.bound, 2));
        format!("the reference has {} digits: {} of the difference is its rounding", self.digits, bound.trim_end())
    }
}

/// Rounding of the values of a reference. A table with a fixed count of decimals has most digits where it is greatest,
/// one with a fixed number of digits has them everywhere.
fn rounding(values: &[f64]) -> Option<Rounding> {
    let greatest = values.iter().filter(|v| v.is_finite()).fold(0.0_f64, |a, v| a.max(v.abs()));
    let large: Vec<f64> = values.iter().copied().filter(|v| v.abs() >= 0.1 * greatest).take(MAX_VALUES).collect();
    if greatest == 0.0 || large.len() < MIN_VALUES || large.iter().all(|v| *v == large[0]) {
        return None;
    }
    let digits = large.iter().map(|v| significant_digits(*v)).max()?;
    let last = exponent(greatest) - digits + 1;
    (2..=MAX_DIGITS).contains(&digits).then(|| Rounding { digits, bound: 0.5 * pow10(last) })
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

    fn remark(reference: &[f64], differences: &[f64], unit: &str) -> Option<String> {
        Rounding::limiting(reference, differences).map(|rounding| rounding.remark(unit))
    }

    #[test]
    fn the_coarsest_of_several_references_is_named() {
        let [fine, coarse] = [1e-8, 5e-8].map(|bound| Rounding { digits: 9, bound });
        for (a, b) in [(fine, coarse), (coarse, fine)] {
            assert_eq!(Rounding::coarser(Some(a), Some(b)).unwrap().bound, coarse.bound);
        }
        assert!(Rounding::coarser(None, None).is_none());
    }

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
