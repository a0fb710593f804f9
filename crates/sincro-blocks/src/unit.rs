//! Units of signals: products of symbols with whole exponents, compared by what they measure and how large they are.
//!
//! `N·m`, `N*m` and `J` are the same; `rad` and `deg` are not: the radian is kept as a base of its own, so that an
//! angle is not taken for a number.

use core::fmt;

/// Base quantities: kilogram, metre, second, ampere, kelvin, radian.
const N_BASES: usize = 6;

/// Unit of a signal, as text with its dimension: the compiler compares the units of connected ports. Displays as
/// written.
#[derive(Clone, Debug, PartialEq)]
pub struct Unit {
    /// Text as it was written.
    text: String,
    /// Size in coherent units.
    factor: f64,
    exponents: [i8; N_BASES],
}

/// Symbol, size, exponents of kg, m, s, A, K, rad.
const SYMBOLS: [(&str, f64, [i8; N_BASES]); 26] = [
    ("1", 1.0, [0, 0, 0, 0, 0, 0]),
    ("%", 0.01, [0, 0, 0, 0, 0, 0]),
    ("kg", 1.0, [1, 0, 0, 0, 0, 0]),
    ("g", 1e-3, [1, 0, 0, 0, 0, 0]),
    ("m", 1.0, [0, 1, 0, 0, 0, 0]),
    ("cm", 1e-2, [0, 1, 0, 0, 0, 0]),
    ("mm", 1e-3, [0, 1, 0, 0, 0, 0]),
    ("km", 1e3, [0, 1, 0, 0, 0, 0]),
    ("s", 1.0, [0, 0, 1, 0, 0, 0]),
    ("ms", 1e-3, [0, 0, 1, 0, 0, 0]),
    ("min", 60.0, [0, 0, 1, 0, 0, 0]),
    ("h", 3600.0, [0, 0, 1, 0, 0, 0]),
    ("A", 1.0, [0, 0, 0, 1, 0, 0]),
    ("K", 1.0, [0, 0, 0, 0, 1, 0]),
    ("rad", 1.0, [0, 0, 0, 0, 0, 1]),
    ("deg", core::f64::consts::PI / 180.0, [0, 0, 0, 0, 0, 1]),
    ("rev", 2.0 * core::f64::consts::PI, [0, 0, 0, 0, 0, 1]),
    ("rpm", core::f64::consts::PI / 30.0, [0, 0, -1, 0, 0, 1]),
    ("Hz", 1.0, [0, 0, -1, 0, 0, 0]),
    ("N", 1.0, [1, 1, -2, 0, 0, 0]),
    ("kN", 1e3, [1, 1, -2, 0, 0, 0]),
    ("J", 1.0, [1, 2, -2, 0, 0, 0]),
    ("W", 1.0, [1, 2, -3, 0, 0, 0]),
    ("Pa", 1.0, [1, -1, -2, 0, 0, 0]),
    ("V", 1.0, [1, 2, -3, -1, 0, 0]),
    ("Ohm", 1.0, [1, 2, -3, -2, 0, 0]),
];

impl Unit {
    /// Parses a product of symbols with whole exponents, such as `N·m·s/rad`, `m/s^2`, `kg·m²`, `1/s`; every factor
    /// after a `/` stands below it.
    ///
    /// # Errors
    ///
    /// A message that names the symbol or exponent that is unknown.
    ///
    /// ```
    /// use sincro_blocks::unit::Unit;
    ///
    /// let unit = |text| Unit::parse(text).unwrap();
    /// assert!(unit("N·m").is_same(&unit("J")));
    /// assert!(unit("rad/s^2").is_same(&unit("rad/s²")));
    /// assert!(!unit("deg").is_same(&unit("rad")));
    /// assert!(Unit::parse("parsec").is_err());
    /// ```
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut unit = Self { text: text.to_owned(), factor: 1.0, exponents: [0; N_BASES] };
        for (k, part) in text.split('/').enumerate() {
            // every factor after a stroke stands below it
            let sign = if k == 0 { 1 } else { -1 };
            for factor in part.split(['·', '*', ' ']).map(|f| f.trim_matches(['(', ')'])).filter(|f| !f.is_empty()) {
                unit.multiply(factor, sign)?;
            }
        }
        Ok(unit)
    }

    fn multiply(&mut self, factor: &str, sign: i8) -> Result<(), String> {
        let digits = |c: char| matches!(c, '⁻' | '¹' | '²' | '³' | '⁴' | '^' | '-') || c.is_ascii_digit();
        let (symbol, power) = match factor.find(digits).filter(|_| factor != "1") {
            None => (factor, 1),
            Some(at) => (&factor[..at], exponent(&factor[at..]).ok_or_else(|| format!("`{factor}` is no unit"))?),
        };
        let known = SYMBOLS.iter().find(|s| s.0 == symbol).ok_or_else(|| format!("`{symbol}` is no unit"))?;
        let power = power * sign;
        for (e, base) in self.exponents.iter_mut().zip(known.2) {
            *e = e.checked_add(base * power).ok_or_else(|| format!("`{}` has too high a power", self.text))?;
        }
        for _ in 0..power.abs() {
            self.factor = if power > 0 { self.factor * known.1 } else { self.factor / known.1 };
        }
        Ok(())
    }

    /// Size of the unit in coherent SI units, and its exponents of kilogram, metre, second, ampere, kelvin, radian, in
    /// this order: of `mm` 0.001 and `[0, 1, 0, 0, 0, 0]`.
    #[must_use]
    pub fn dimension(&self) -> (f64, [i8; 6]) {
        (self.factor, self.exponents)
    }

    /// Returns true if both have the same dimension and size, so that a number means the same in both.
    #[must_use]
    pub fn is_same(&self, other: &Self) -> bool {
        self.exponents == other.exponents && (self.factor - other.factor).abs() <= 1e-9 * self.factor.abs()
    }
}

fn exponent(text: &str) -> Option<i8> {
    let plain: String = text
        .chars()
        .filter_map(|c| match c {
            '^' => None,
            '⁻' => Some('-'),
            '¹' => Some('1'),
            '²' => Some('2'),
            '³' => Some('3'),
            '⁴' => Some('4'),
            c => Some(c),
        })
        .collect();
    plain.parse().ok().filter(|e: &i8| (-9..=9).contains(e))
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

/// Unit that all known ones have in common, `None` if none is known: for blocks that pass a signal on, add or compare.
///
/// # Errors
///
/// A message that names two units that differ.
pub fn common(units: &[Option<Unit>]) -> Result<Option<Unit>, String> {
    let mut first: Option<&Unit> = None;
    for unit in units.iter().flatten() {
        match first {
            Some(known) if !known.is_same(unit) => return Err(format!("{known} and {unit} are not the same")),
            Some(_) => {}
            None => first = Some(unit),
        }
    }
    Ok(first.cloned())
}
