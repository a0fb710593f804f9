//! Digits of a reference, where they limit what a difference from it can show.

use crate::plot::number::short;

/// A reference with more decimals is taken for one without rounding.
const MAX_DECIMALS: usize = 12;
/// Fewer values say nothing about their rounding.
const MIN_VALUES: usize = 8;
/// Values whose digits are looked at, at most.
const MAX_VALUES: usize = 4000;
/// Share of the greatest difference from which on rounding is named.
const MIN_SHARE: f64 = 0.2;

/// Remark for an error panel whose curve is mostly the rounding of its reference; `None`: it is not.
pub(super) fn remark(reference: &[f64], differences: &[f64], unit: &str) -> Option<String> {
    let (decimals, rounding) = rounding(reference)?;
    let greatest = differences.iter().filter(|d| d.is_finite()).fold(0.0_f64, |a, d| a.max(d.abs()));
    let bound = format!("±{} {unit}", short(rounding, 2));
    (rounding >= MIN_SHARE * greatest && greatest > 0.0).then(|| {
        let plural = if decimals == 1 { "" } else { "s" };
        format!("the reference has {decimals} decimal{plural}: {} of the difference is its rounding", bound.trim_end())
    })
}

/// Decimals of the greatest values of a reference, and half a unit of the last one.
fn rounding(values: &[f64]) -> Option<(usize, f64)> {
    let greatest = values.iter().filter(|v| v.is_finite()).fold(0.0_f64, |a, v| a.max(v.abs()));
    // small values may have more decimals, where the number of significant digits is fixed
    let large: Vec<f64> = values.iter().copied().filter(|v| v.abs() >= 0.1 * greatest).take(MAX_VALUES).collect();
    if greatest == 0.0 || large.len() < MIN_VALUES || large.iter().all(|v| *v == large[0]) {
        return None;
    }
    let decimals = large.iter().map(|v| decimals(*v)).max()?;
    (1..=MAX_DECIMALS).contains(&decimals).then(|| (decimals, 0.5 * crate::plot::number::pow10(-(decimals as i32))))
}

/// Digits behind the point of the shortest text that reads as this number.
fn decimals(value: f64) -> usize {
    value.to_string().split_once('.').map_or(0, |(_, behind)| behind.len())
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
        assert!(remark.contains("6 decimals") && remark.contains("rad"), "{remark}");
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
