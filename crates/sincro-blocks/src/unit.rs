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
const SYMBOLS: [(&str, f64, [i8; N_BASES]); 27] = [
    ("1", 1.0, [0, 0, 0, 0, 0, 0]),
    ("px", 1.0, [0, 0, 0, 0, 0, 0]),
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
        for (sign, factor) in factors(text) {
            unit.multiply(factor, sign)?;
        }
        Ok(unit)
    }

    fn multiply(&mut self, factor: &str, sign: i8) -> Result<(), String> {
        let (symbol, power) = split_power(factor).ok_or_else(|| format!("`{factor}` is no unit"))?;
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

    /// Text of the unit, as it was written.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Size of the unit in coherent SI units, and its exponents of kilogram, metre, second, ampere, kelvin, radian, in
    /// this order: of `mm` 0.001 and `[0, 1, 0, 0, 0, 0]`.
    #[must_use]
    pub fn dimension(&self) -> (f64, [i8; 6]) {
        (self.factor, self.exponents)
    }

    /// Product of powers of units, such as `N·m` from `N·m/rad` and `rad`: symbols that cancel are left out, the text
    /// is in the order in which the symbols first appear. `None` if an exponent grows beyond ±9.
    ///
    /// ```
    /// use sincro_blocks::unit::Unit;
    ///
    /// let unit = |text| Unit::parse(text).unwrap();
    /// let torque = Unit::product(&[(&unit("N·m/rad"), 1), (&unit("rad"), 1)]).unwrap();
    /// assert_eq!(torque.to_string(), "N·m");
    /// assert_eq!(Unit::product(&[(&unit("m/s"), 1), (&unit("s"), -1)]).unwrap().to_string(), "m/s²");
    /// assert_eq!(Unit::product(&[(&unit("rad/s"), 1), (&unit("s"), 1)]).unwrap().to_string(), "rad");
    /// assert_eq!(Unit::product(&[(&unit("m"), 1), (&unit("m"), -1)]).unwrap().to_string(), "1");
    /// ```
    #[must_use]
    pub fn product(factors: &[(&Self, i8)]) -> Option<Self> {
        let mut powers: Vec<(String, i8)> = Vec::new();
        for (unit, exponent) in factors {
            for (symbol, power) in unit.symbols() {
                let power = power.checked_mul(*exponent)?;
                match powers.iter_mut().find(|(known, _)| *known == symbol) {
                    Some((_, sum)) => *sum = sum.checked_add(power)?,
                    None => powers.push((symbol, power)),
                }
            }
        }
        Self::of_powers(powers)
    }

    /// Square root, such as `rad/s` of `rad²/s²`; `None` if an exponent is odd.
    #[must_use]
    pub fn sqrt(&self) -> Option<Self> {
        let halves = self.symbols().into_iter().map(|(symbol, power)| (power % 2 == 0).then_some((symbol, power / 2)));
        Self::of_powers(halves.collect::<Option<Vec<_>>>()?)
    }

    /// Symbols with their exponents, as written.
    fn symbols(&self) -> Vec<(String, i8)> {
        let mut found = Vec::new();
        for (sign, factor) in factors(&self.text) {
            if let Some((symbol, power)) = split_power(factor).filter(|(symbol, _)| *symbol != "1") {
                found.push((symbol.to_owned(), power * sign));
            }
        }
        found
    }

    /// Unit of symbols and exponents: `kg·m²/(s²·rad)`.
    fn of_powers(mut powers: Vec<(String, i8)>) -> Option<Self> {
        powers.retain(|(_, power)| *power != 0);
        let side = |sign: i8| -> Vec<String> {
            let of_side = powers.iter().filter(|(_, power)| power.signum() == sign);
            of_side.map(|(symbol, power)| format!("{symbol}{}", raised(power.unsigned_abs()))).collect()
        };
        let (above, below) = (side(1), side(-1));
        let above = if above.is_empty() { "1".to_owned() } else { above.join("·") };
        let text = match &below[..] {
            [] => above,
            [one] => format!("{above}/{one}"),
            many => format!("{above}/({})", many.join("·")),
        };
        Self::parse(&text).ok()
    }

    /// Returns true if both have the same dimension and size, so that a number means the same in both.
    #[must_use]
    pub fn is_same(&self, other: &Self) -> bool {
        self.exponents == other.exponents && (self.factor - other.factor).abs() <= 1e-9 * self.factor.abs()
    }
}

/// Factors of the text of a unit with the sign of their exponents: every factor after a stroke stands below it.
fn factors(text: &str) -> impl Iterator<Item = (i8, &str)> {
    text.split('/').enumerate().flat_map(|(k, part)| {
        let sign = if k == 0 { 1 } else { -1 };
        let factors = part.split(['·', '*', ' ']).map(|f| f.trim_matches(['(', ')'])).filter(|f| !f.is_empty());
        factors.map(move |factor| (sign, factor))
    })
}

/// Symbol and exponent of a factor such as `s²`; `None` if the exponent is not a number.
fn split_power(factor: &str) -> Option<(&str, i8)> {
    let digits = |c: char| matches!(c, '⁻' | '¹' | '²' | '³' | '⁴' | '^' | '-') || c.is_ascii_digit();
    match factor.find(digits).filter(|_| factor != "1") {
        None => Some((factor, 1)),
        Some(at) => Some((&factor[..at], exponent(&factor[at..])?)),
    }
}

/// Exponent as it is written after a symbol: nothing for 1.
fn raised(power: u8) -> String {
    match power {
        1 => String::new(),
        2 => "²".into(),
        3 => "³".into(),
        4 => "⁴".into(),
        power => format!("^{power}"),
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

/// Arithmetic of [`Unit`]s for formulas; see
/// [`Expression::unit`](sincro_math::expression::Expression::unit).
#[derive(Clone, Copy, Debug)]
pub struct UnitsOfFormulas;

impl sincro_math::expression::Units for UnitsOfFormulas {
    type Unit = Unit;

    fn product(&self, factors: &[(&Unit, i8)]) -> Option<Unit> {
        Unit::product(factors)
    }

    fn sqrt(&self, unit: &Unit) -> Option<Unit> {
        unit.sqrt()
    }

    fn is_same(&self, a: &Unit, b: &Unit) -> bool {
        a.is_same(b)
    }

    fn one(&self) -> Unit {
        Unit::parse("1").expect("a unit")
    }

    fn angle(&self) -> Unit {
        Unit::parse("rad").expect("a unit")
    }
}
