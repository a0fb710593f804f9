//! Quotients of polynomials, as transfer functions have them: read, checked, brought to a leading one, written out.

use crate::reader::Reader;

/// Proper quotient of polynomials in s or z, `numerator/denominator`, with coefficients in the order of descending
/// powers, as in MATLAB: the transfer function of a block.
#[derive(Clone, Debug, PartialEq)]
pub struct Rational {
    numerator: Vec<f64>,
    denominator: Vec<f64>,
    /// Numerator over the leading coefficient of the denominator, with zeros in front up to the length of `a`.
    b: Vec<f64>,
    /// Denominator over its leading coefficient: `a[0]` is 1.
    a: Vec<f64>,
}

impl Rational {
    /// Creates the quotient from the coefficients of numerator and denominator, highest power first (the coefficient of
    /// sᵏ in units of `[sᵏ]` relative to that of s⁰); leading zeros are dropped.
    ///
    /// # Errors
    ///
    /// A message, if the denominator is zero or the numerator of a higher degree.
    pub fn new(numerator: &[f64], denominator: &[f64]) -> Result<Self, String> {
        let (numerator, denominator) = (stripped(numerator), stripped(denominator));
        let Some(&lead) = denominator.first() else {
            return Err("the denominator is zero".into());
        };
        let numerator = if numerator.is_empty() { &[0.0] } else { numerator };
        let (n, m) = (numerator.len() - 1, denominator.len() - 1);
        if n > m {
            return Err(format!("improper transfer function: numerator of degree {n}, denominator of degree {m}"));
        }
        let mut b = vec![0.0; m - n];
        b.extend(numerator.iter().map(|x| x / lead));
        let a = denominator.iter().map(|x| x / lead).collect();
        Ok(Self { numerator: numerator.to_vec(), denominator: denominator.to_vec(), b, a })
    }

    /// Reads the parameters `numerator` and `denominator`; 1 after an error.
    pub(in crate::library) fn read(p: &mut Reader<'_>, help: &str) -> Self {
        let (numerator, denominator) = (p.numbers("numerator"), p.numbers("denominator"));
        if numerator.iter().chain(&denominator).any(|x| x.is_nan()) {
            return Self::one();
        }
        Self::new(&numerator, &denominator).unwrap_or_else(|message| {
            let is_zero = stripped(&denominator).is_empty();
            let (key, help) = if is_zero {
                ("denominator", "give its coefficients, highest power first: [1, 2] is s + 2")
            } else {
                ("numerator", help)
            };
            p.fault(key, message, help);
            Self::one()
        })
    }

    fn one() -> Self {
        Self { numerator: vec![1.0], denominator: vec![1.0], b: vec![1.0], a: vec![1.0] }
    }

    /// Coefficients of the numerator as given, highest power first, without leading zeros; `[0]` for zero.
    #[must_use]
    pub fn numerator(&self) -> &[f64] {
        &self.numerator
    }

    /// Coefficients of the denominator as given, highest power first, without leading zeros.
    #[must_use]
    pub fn denominator(&self) -> &[f64] {
        &self.denominator
    }

    /// Degree of the denominator: the number of states of one component.
    #[must_use]
    pub fn order(&self) -> usize {
        self.a.len() - 1
    }

    /// Coefficient `k` of the numerator, 0 to `order()`, divided by the denominator's leading coefficient; `b(0)`
    /// belongs to the highest power of the denominator. Panics for other indices.
    #[must_use]
    #[inline(always)]
    pub fn b(&self, k: usize) -> f64 {
        self.b[k]
    }

    /// Coefficient `k` of the denominator, 0 to `order()`, divided by the leading one, so that `a(0)` is 1. Panics for
    /// other indices.
    #[must_use]
    #[inline(always)]
    pub fn a(&self, k: usize) -> f64 {
        self.a[k]
    }

    /// Formula in the given variable (`s` or `z`), such as `(s + 1)/(s² + 2s)`.
    #[must_use]
    pub fn text(&self, variable: char) -> String {
        let below = polynomial(&self.denominator, variable);
        let above = polynomial(&self.numerator, variable);
        if below == "1" {
            return above;
        }
        let bracket = |text: String, is_factor: bool| if is_factor { text } else { format!("({text})") };
        let is_sum = |text: &str| text.contains(' ');
        let is_power = below.starts_with(variable) || !below.contains(variable);
        let plain = !is_sum(&below) && is_power;
        format!("{}/{}", bracket(above.clone(), !is_sum(&above)), bracket(below, plain))
    }
}

/// Without zeros in front.
fn stripped(coefficients: &[f64]) -> &[f64] {
    let from = coefficients.iter().position(|x| *x != 0.0).unwrap_or(coefficients.len());
    &coefficients[from..]
}

/// A polynomial as it is written: `s² + 2s − 1`.
pub(in crate::library) fn polynomial(coefficients: &[f64], variable: char) -> String {
    let degree = coefficients.len().saturating_sub(1);
    let mut text = String::new();
    for (k, &x) in coefficients.iter().enumerate().filter(|(_, x)| **x != 0.0) {
        text += match (text.is_empty(), x < 0.0) {
            (true, true) => "−",
            (true, false) => "",
            (false, true) => " − ",
            (false, false) => " + ",
        };
        let power = degree - k;
        if x.abs() != 1.0 || power == 0 {
            text += &crate::library::short(x.abs());
        }
        if power > 0 {
            text.push(variable);
        }
        if power > 1 {
            text += &superscripts(power);
        }
    }
    if text.is_empty() { "0".into() } else { text }
}

/// A whole number as an exponent.
pub(in crate::library) fn superscripts(number: usize) -> String {
    number.to_string().chars().map(superscript).collect()
}

fn superscript(digit: char) -> char {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    digit.to_digit(10).map_or(digit, |d| DIGITS[d as usize])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quotient_is_written_as_engineers_write_it() {
        let text = |n: &[f64], d: &[f64]| Rational::new(n, d).unwrap().text('s');
        assert_eq!(text(&[1.0, 1.0], &[1.0, 2.0, 0.0]), "(s + 1)/(s² + 2s)");
        assert_eq!(text(&[1.0], &[1.0, 0.0, 0.0]), "1/s²");
        assert_eq!(text(&[2.5], &[2.0, 0.0]), "2.5/(2s)");
        assert_eq!(text(&[-1.0, 0.0], &[0.1, -1.0]), "−s/(0.1s − 1)");
        assert_eq!(text(&[3.0], &[1.0]), "3");
    }

    #[test]
    fn zeros_in_front_do_not_raise_the_degree() {
        let g = Rational::new(&[0.0, 0.0, 2.0], &[0.0, 4.0, 8.0]).unwrap();
        assert_eq!((g.order(), g.b(0), g.b(1), g.a(1)), (1, 0.0, 0.5, 2.0));
    }

    #[test]
    fn an_improper_quotient_is_refused_with_both_degrees() {
        let words = Rational::new(&[1.0, 0.0, 0.0], &[1.0, 1.0]).unwrap_err();
        assert_eq!(words, "improper transfer function: numerator of degree 2, denominator of degree 1");
        assert!(Rational::new(&[1.0], &[0.0]).is_err());
    }
}
