//! The compiled form of a formula and its evaluation: a flat program in postfix order, run on a stack.
//!
//! Comparisons and conditions are numbers, 1 for true and 0 for false, because lanes can differ: `if` evaluates both
//! its branches and takes, lane by lane, one of them. What is not a number stays so: a comparison, a logical operation
//! or an `if` decided by a NaN is NaN, so that a failure reaches the caller instead of becoming a plausible branch.

use super::function::Function;
use crate::{Real, elementary};

/// One step of a program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Op {
    /// Pushes a number.
    Constant(f64),
    /// Pushes the value of a name, by its slot.
    Value(u32),
    /// Replaces the top.
    Neg,
    /// 1 where the top is zero, else 0.
    Not,
    /// The top to a small whole power.
    Power(i8),
    /// Replaces the two on top.
    Binary(Binary),
    /// Replaces so many on top.
    Call(Function, u16),
}

/// An operator between two operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Binary {
    Add,
    Sub,
    Mul,
    Div,
    Pow,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Equal,
    NotEqual,
    And,
    Or,
}

/// Whole powers up to this one are products; beyond, `libm` is as exact and not slower.
pub(super) const MAX_WHOLE_POWER: i8 = 8;

impl Op {
    /// Number of operands it takes from the stack; it leaves one.
    pub(super) fn takes(self) -> usize {
        match self {
            Self::Constant(_) | Self::Value(_) => 0,
            Self::Neg | Self::Not | Self::Power(_) => 1,
            Self::Binary(_) => 2,
            Self::Call(_, count) => usize::from(count),
        }
    }

    /// The result, given the operands and the values of the names.
    #[inline]
    fn apply<R: Real>(self, operands: &[R], values: &[R]) -> R {
        match self {
            Self::Constant(x) => R::splat(x),
            Self::Value(slot) => values[slot as usize],
            Self::Neg => -operands[0],
            Self::Not => logical(operands[0], R::zero(), |x, _| x == 0.0),
            Self::Power(exponent) => whole_power(operands[0], exponent),
            Self::Binary(binary) => binary.apply(operands[0], operands[1]),
            Self::Call(function, _) => function.apply(operands),
        }
    }
}

impl Binary {
    #[inline]
    fn apply<R: Real>(self, a: R, b: R) -> R {
        match self {
            Self::Add => a + b,
            Self::Sub => a - b,
            Self::Mul => a * b,
            Self::Div => a / b,
            Self::Pow => a.map2(b, elementary::pow),
            Self::Less => logical(a, b, |a, b| a < b),
            Self::LessEqual => logical(a, b, |a, b| a <= b),
            Self::Greater => logical(a, b, |a, b| a > b),
            Self::GreaterEqual => logical(a, b, |a, b| a >= b),
            Self::Equal => logical(a, b, |a, b| a == b),
            Self::NotEqual => logical(a, b, |a, b| a != b),
            Self::And => logical(a, b, |a, b| a != 0.0 && b != 0.0),
            Self::Or => logical(a, b, |a, b| a != 0.0 || b != 0.0),
        }
    }
}

/// Runs a program. `stack` is emptied first; it does not grow if its capacity is the depth of the program.
pub(super) fn run<R: Real>(program: &[Op], values: &[R], stack: &mut Vec<R>) -> R {
    stack.clear();
    for op in program {
        let base = stack.len() - op.takes();
        let result = op.apply(&stack[base..], values);
        stack.truncate(base);
        stack.push(result);
    }
    stack[0]
}

/// Runs a program on a stack of given length.
pub(super) fn run_in<R: Real>(program: &[Op], values: &[R], stack: &mut [R]) -> R {
    let mut top = 0;
    for op in program {
        let base = top - op.takes();
        stack[base] = op.apply(&stack[base..top], values);
        top = base + 1;
    }
    stack[0]
}

/// Largest number of values on the stack of a program.
pub(super) fn stack_depth(program: &[Op]) -> usize {
    let (mut depth, mut deepest) = (0, 0);
    for op in program {
        depth = depth + 1 - op.takes();
        deepest = deepest.max(depth);
    }
    deepest
}

/// 1 where `holds`, else 0, lane by lane; NaN where `a` or `b` is. No derivatives.
#[inline]
fn logical<R: Real>(a: R, b: R, holds: impl Fn(f64, f64) -> bool) -> R {
    R::from_lanes(|k| {
        let (a, b) = (a.lane(k), b.lane(k));
        if a.is_nan() || b.is_nan() {
            f64::NAN
        } else if holds(a, b) {
            1.0
        } else {
            0.0
        }
    })
}

/// `then` where the condition is not zero, else `otherwise`, lane by lane; NaN where the condition is.
#[inline]
pub(super) fn choose<R: Real>(condition: R, then: R, otherwise: R) -> R {
    let is_false = logical(condition, R::zero(), |x, _| x == 0.0);
    // 0 or NaN: taking it away changes no bit of a number
    let poison = is_false * R::zero();
    is_false.if_less(R::splat(0.5), then, otherwise) - poison
}

/// The smaller of two, `a` where they are equal; NaN where one of them is.
#[inline]
pub(super) fn smaller<R: Real>(a: R, b: R) -> R {
    let takes_b = R::from_lanes(|k| {
        let (a, b) = (a.lane(k), b.lane(k));
        if b < a || b.is_nan() { 1.0 } else { 0.0 }
    });
    takes_b.if_less(R::splat(0.5), a, b)
}

/// `x^exponent` by squaring; a negative exponent divides 1 by it.
#[inline]
fn whole_power<R: Real>(x: R, exponent: i8) -> R {
    let mut remaining = exponent.unsigned_abs();
    let mut square = x;
    let mut power = R::one();
    while remaining > 0 {
        if remaining & 1 == 1 {
            power *= square;
        }
        remaining >>= 1;
        if remaining > 0 {
            square = square * square;
        }
    }
    if exponent < 0 { R::one() / power } else { power }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Dual, Lanes};

    #[test]
    fn whole_powers_are_products() {
        let x: f64 = -1.37;
        assert_eq!(whole_power(x, 0), 1.0);
        assert_eq!(whole_power(x, 1), x);
        assert_eq!(whole_power(x, 2), x * x);
        assert_eq!(whole_power(x, 3), x * (x * x));
        assert_eq!(whole_power(x, -2), 1.0 / (x * x));
        assert_eq!(whole_power(Dual::<1>::variable(3.0, 0), 4).partials, [108.0]);
    }

    #[test]
    fn choice_is_lane_by_lane_and_keeps_what_is_not_a_number() {
        let (then, otherwise) = (Lanes([1.0; 4]), Lanes([-0.0; 4]));
        let out = choose(Lanes([1.0, 0.0, -2.0, f64::NAN]), then, otherwise);
        assert_eq!(out.0[0], 1.0);
        assert_eq!(out.0[1].to_bits(), (-0.0f64).to_bits());
        assert_eq!(out.0[2], 1.0);
        assert!(out.0[3].is_nan());
    }

    #[test]
    fn the_branch_not_taken_leaves_no_trace() {
        let x = Dual::<1>::variable(-1.0, 0);
        let out = choose(Dual::constant(0.0), x.map(elementary::ln), x * x);
        assert_eq!((out.value, out.partials), (1.0, [-2.0]));
    }
}
