//! The functions that formulas know: name, number of arguments, value.

use super::eval::{choose, sign, smaller};
use crate::elementary::{Binary, Unary};
use crate::{Branches, Real};

/// A function of a formula.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Function {
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Atan2,
    Sinh,
    Cosh,
    Tanh,
    Sqrt,
    Exp,
    Ln,
    Log10,
    Abs,
    Sign,
    Floor,
    Ceil,
    Mod,
    Min,
    Max,
    Clamp,
    Hypot,
    If,
}

/// Number of arguments of a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Arity {
    Exactly(usize),
    AtLeast(usize),
}

impl Arity {
    pub(super) fn admits(self, count: usize) -> bool {
        match self {
            Self::Exactly(n) => count == n,
            Self::AtLeast(n) => count >= n,
        }
    }
}

/// Name, function, number of arguments, and how it is written (for messages).
const TABLE: [(&str, Function, Arity, &str); 24] = [
    ("sin", Function::Sin, Arity::Exactly(1), "sin(x)"),
    ("cos", Function::Cos, Arity::Exactly(1), "cos(x)"),
    ("tan", Function::Tan, Arity::Exactly(1), "tan(x)"),
    ("asin", Function::Asin, Arity::Exactly(1), "asin(x)"),
    ("acos", Function::Acos, Arity::Exactly(1), "acos(x)"),
    ("atan", Function::Atan, Arity::Exactly(1), "atan(x)"),
    ("atan2", Function::Atan2, Arity::Exactly(2), "atan2(y, x)"),
    ("sinh", Function::Sinh, Arity::Exactly(1), "sinh(x)"),
    ("cosh", Function::Cosh, Arity::Exactly(1), "cosh(x)"),
    ("tanh", Function::Tanh, Arity::Exactly(1), "tanh(x)"),
    ("sqrt", Function::Sqrt, Arity::Exactly(1), "sqrt(x)"),
    ("exp", Function::Exp, Arity::Exactly(1), "exp(x)"),
    ("ln", Function::Ln, Arity::Exactly(1), "ln(x)"),
    ("log10", Function::Log10, Arity::Exactly(1), "log10(x)"),
    ("abs", Function::Abs, Arity::Exactly(1), "abs(x)"),
    ("sign", Function::Sign, Arity::Exactly(1), "sign(x)"),
    ("floor", Function::Floor, Arity::Exactly(1), "floor(x)"),
    ("ceil", Function::Ceil, Arity::Exactly(1), "ceil(x)"),
    ("mod", Function::Mod, Arity::Exactly(2), "mod(x, modulus)"),
    ("min", Function::Min, Arity::AtLeast(2), "min(a, b, ...)"),
    ("max", Function::Max, Arity::AtLeast(2), "max(a, b, ...)"),
    ("clamp", Function::Clamp, Arity::Exactly(3), "clamp(x, low, high)"),
    ("hypot", Function::Hypot, Arity::Exactly(2), "hypot(x, y)"),
    ("if", Function::If, Arity::Exactly(3), "if(condition, then, otherwise)"),
];

impl Function {
    pub(super) fn named(name: &str) -> Option<Self> {
        TABLE.iter().find(|row| row.0 == name).map(|row| row.1)
    }

    /// The names of all functions.
    pub(super) fn names() -> impl Iterator<Item = &'static str> {
        TABLE.iter().map(|row| row.0)
    }

    pub(super) fn arity(self) -> Arity {
        self.row().2
    }

    /// A call as one writes it, such as `atan2(y, x)`.
    pub(super) fn usage(self) -> &'static str {
        self.row().3
    }

    fn row(self) -> &'static (&'static str, Self, Arity, &'static str) {
        // in the order of the enum, which a test keeps true
        &TABLE[self as usize]
    }

    /// The value at `x`, whose length the parser has checked.
    #[inline(always)]
    pub(super) fn apply<R: Real>(self, x: &[R]) -> R {
        match self {
            Self::Sin => x[0].sin_cos().0,
            Self::Cos => x[0].sin_cos().1,
            Self::Tan => x[0].unary(Unary::Tan),
            Self::Asin => x[0].unary(Unary::Asin),
            Self::Acos => x[0].unary(Unary::Acos),
            Self::Atan => x[0].unary(Unary::Atan),
            Self::Atan2 => x[0].binary(Binary::Atan2, x[1]),
            Self::Sinh => x[0].unary(Unary::Sinh),
            Self::Cosh => x[0].unary(Unary::Cosh),
            Self::Tanh => x[0].unary(Unary::Tanh),
            Self::Sqrt => x[0].sqrt(),
            Self::Exp => x[0].unary(Unary::Exp),
            Self::Ln => x[0].unary(Unary::Ln),
            Self::Log10 => x[0].unary(Unary::Log10),
            Self::Abs => x[0].abs(),
            Self::Sign => sign(x[0]),
            Self::Floor => x[0].unary(Unary::Floor),
            Self::Ceil => x[0].unary(Unary::Ceil),
            Self::Mod => x[0].binary(Binary::Modulo, x[1]),
            Self::Min => x[1..].iter().fold(x[0], |least, &x| smaller(least, x)),
            Self::Max => -x[1..].iter().fold(-x[0], |least, &x| smaller(least, -x)),
            Self::Clamp => smaller(-smaller(-x[0], -x[1]), x[2]),
            Self::Hypot => x[0].binary(Binary::Hypot, x[1]),
            Self::If => choose(x[0], x[1], x[2]),
        }
    }
}

impl Function {
    /// Notes the branch taken at `x` for the value `y`; nothing for a function without branches.
    pub(super) fn note_branch(self, x: &[f64], y: f64, branches: &mut Branches) {
        match self {
            Self::Abs | Self::Sign => branches.note_side(x[0], 0.0),
            // both zeros are one
            Self::Floor | Self::Ceil => branches.note((y + 0.0).to_bits()),
            Self::Mod => branches.note(((x[0] / x[1]).unary(Unary::Floor) + 0.0).to_bits()),
            Self::Atan2 => branches.note(u64::from(x[0] < 0.0 && x[1] < 0.0)),
            Self::Min | Self::Max | Self::Clamp => {
                branches.note(x.iter().position(|x| *x == y).map_or(u64::MAX, |k| k as u64));
            }
            Self::If => branches.note(u64::from(x[0] != 0.0)),
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_in_the_order_of_the_enum() {
        for (index, row) in TABLE.iter().enumerate() {
            assert_eq!(row.1 as usize, index, "{}", row.0);
            assert!(row.3.starts_with(row.0) && row.3[row.0.len()..].starts_with('('));
        }
    }

    #[test]
    fn functions_with_corners_keep_what_is_not_a_number() {
        for function in [Function::Min, Function::Max] {
            assert!(function.apply(&[f64::NAN, 1.0]).is_nan() && function.apply(&[1.0, f64::NAN]).is_nan());
        }
        assert!(Function::Clamp.apply(&[f64::NAN, 0.0, 1.0]).is_nan());
        assert!(Function::Sign.apply(&[f64::NAN]).is_nan());
    }

    #[test]
    fn limits() {
        assert_eq!(Function::Min.apply(&[3.0, -1.0, 2.0]), -1.0);
        assert_eq!(Function::Max.apply(&[3.0, -1.0, 7.0]), 7.0);
        for (x, clamped) in [(-2.0, -1.0), (0.5, 0.5), (9.0, 4.0)] {
            assert_eq!(Function::Clamp.apply(&[x, -1.0, 4.0]), clamped);
        }
    }
}
