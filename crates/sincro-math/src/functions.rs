//! Elementary functions of one and two arguments with their derivatives, from the pure-Rust `libm` crate, and their
//! names: part of [`elementary`](crate::elementary), below the numbers that they are applied to.

/// Tangent of the angle `x` `[rad]` and its derivative by `x`, both dimensionless.
#[must_use]
pub fn tan(x: f64) -> (f64, f64) {
    let t = libm::tan(x);
    (t, 1.0 + t * t)
}

/// Arcsine of the dimensionless `x`: the angle in [−π/2, π/2] `[rad]`, and its derivative by `x`. NaN outside [−1, 1];
/// the derivative is infinite at ±1.
#[must_use]
pub fn asin(x: f64) -> (f64, f64) {
    (libm::asin(x), 1.0 / ((1.0 - x) * (1.0 + x)).sqrt())
}

/// Arccosine of the dimensionless `x`: the angle in [0, π] `[rad]`, and its derivative by `x`. NaN outside [−1, 1]; the
/// derivative is infinite at ±1.
#[must_use]
pub fn acos(x: f64) -> (f64, f64) {
    (libm::acos(x), -1.0 / ((1.0 - x) * (1.0 + x)).sqrt())
}

/// Arctangent of the dimensionless `x`: the angle in (−π/2, π/2) `[rad]`, and its derivative by `x`.
#[must_use]
pub fn atan(x: f64) -> (f64, f64) {
    (libm::atan(x), 1.0 / (1.0 + x * x))
}

/// Exponential of the dimensionless `x`, and its derivative by `x`.
#[must_use]
pub fn exp(x: f64) -> (f64, f64) {
    let e = libm::exp(x);
    (e, e)
}

/// Natural logarithm of the dimensionless `x`, and its derivative by `x`; −∞ at zero, NaN below.
#[must_use]
pub fn ln(x: f64) -> (f64, f64) {
    (libm::log(x), 1.0 / x)
}

/// Decimal logarithm of the dimensionless `x`, and its derivative by `x`; −∞ at zero, NaN below.
#[must_use]
pub fn log10(x: f64) -> (f64, f64) {
    (libm::log10(x), core::f64::consts::LOG10_E / x)
}

/// Hyperbolic sine of the dimensionless `x`, and its derivative by `x`.
#[must_use]
pub fn sinh(x: f64) -> (f64, f64) {
    (libm::sinh(x), libm::cosh(x))
}

/// Hyperbolic cosine of the dimensionless `x`, and its derivative by `x`.
#[must_use]
pub fn cosh(x: f64) -> (f64, f64) {
    (libm::cosh(x), libm::sinh(x))
}

/// Hyperbolic tangent of the dimensionless `x`, and its derivative by `x`.
#[must_use]
pub fn tanh(x: f64) -> (f64, f64) {
    // 1 − tanh² would lose all digits in the tails
    let c = libm::cosh(x);
    (libm::tanh(x), 1.0 / (c * c))
}

/// Angle in [−π, π] `[rad]` of the point `(x, y)`, seen from the origin, and its derivatives by `y` and by `x`, in this
/// order (per unit of `x` and `y`). At the origin the derivatives are NaN.
#[must_use]
pub fn atan2(y: f64, x: f64) -> (f64, f64, f64) {
    let square = x * x + y * y;
    (libm::atan2(y, x), x / square, -y / square)
}

/// Distance of the point `(x, y)` from the origin, in their unit, and its derivatives by `x` and by `y`
/// (dimensionless), taken as zero at the origin.
#[must_use]
pub fn hypot(x: f64, y: f64) -> (f64, f64, f64) {
    let h = libm::hypot(x, y);
    if h == 0.0 { (h, 0.0, 0.0) } else { (h, x / h, y / h) }
}

/// Power `base^exponent` of dimensionless numbers, and its derivatives by the base and by the exponent, in this order;
/// NaN for a negative base, unless the exponent is an integer.
///
/// The derivative by the exponent is NaN where the base is negative: the power is not defined beside the integers.
#[must_use]
pub fn pow(base: f64, exponent: f64) -> (f64, f64, f64) {
    let power = libm::pow(base, exponent);
    let by_base = if exponent == 0.0 { 0.0 } else { exponent * libm::pow(base, exponent - 1.0) };
    let by_exponent = if base == 0.0 && exponent > 0.0 { 0.0 } else { power * libm::log(base) };
    (power, by_base, by_exponent)
}

/// Remainder of `x` after division by `modulus`, both in one unit, with the sign of the modulus (as in Lua and Python);
/// then its derivatives by `x` and by the modulus (dimensionless). NaN where the modulus is zero.
#[must_use]
pub fn modulo(x: f64, modulus: f64) -> (f64, f64, f64) {
    let rest = libm::fmod(x, modulus);
    let other_side = rest != 0.0 && (rest < 0.0) != (modulus < 0.0);
    let rest = if other_side { rest + modulus } else { rest };
    (rest, 1.0, -libm::rint((x - rest) / modulus))
}

/// Largest integer not above `x`, in its unit, and its derivative by `x`, taken as zero everywhere.
#[must_use]
pub fn floor(x: f64) -> (f64, f64) {
    (libm::floor(x), 0.0)
}

/// Smallest integer not below `x`, in its unit, and its derivative by `x`, taken as zero everywhere.
#[must_use]
pub fn ceil(x: f64) -> (f64, f64) {
    (libm::ceil(x), 0.0)
}

/// Elementary function of one argument by its name, so that a recording ([`record`](crate::record)) can tell which one
/// is called; see [`Real::unary`](crate::Real::unary).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unary {
    /// [`tan`].
    Tan,
    /// [`asin`].
    Asin,
    /// [`acos`].
    Acos,
    /// [`atan`].
    Atan,
    /// [`exp`].
    Exp,
    /// [`ln`].
    Ln,
    /// [`log10`].
    Log10,
    /// [`sinh`].
    Sinh,
    /// [`cosh`].
    Cosh,
    /// [`tanh`].
    Tanh,
    /// [`floor`].
    Floor,
    /// [`ceil`].
    Ceil,
}

/// Elementary function of two arguments by its name; see [`Unary`] and [`Real::binary`](crate::Real::binary).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Binary {
    /// [`atan2`] of y and x.
    Atan2,
    /// [`hypot`].
    Hypot,
    /// [`pow`] of base and exponent.
    Pow,
    /// [`modulo`] of number and modulus.
    Modulo,
}

impl Unary {
    /// All functions, in the order of the enumeration.
    pub const ALL: [Self; 12] = [
        Self::Tan,
        Self::Asin,
        Self::Acos,
        Self::Atan,
        Self::Exp,
        Self::Ln,
        Self::Log10,
        Self::Sinh,
        Self::Cosh,
        Self::Tanh,
        Self::Floor,
        Self::Ceil,
    ];
}

impl Binary {
    /// All functions, in the order of the enumeration.
    pub const ALL: [Self; 4] = [Self::Atan2, Self::Hypot, Self::Pow, Self::Modulo];
}
