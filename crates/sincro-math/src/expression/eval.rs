//! The compiled form of a formula and its evaluation: a flat program in postfix order, run on a stack.
//!
//! Comparisons and conditions are numbers, 1 for true and 0 for false, because lanes can differ: `if` evaluates both
//! its branches and takes, lane by lane, one of them. What is not a number stays so: a comparison, a logical operation
//! or an `if` decided by a NaN is NaN, so that a failure reaches the caller instead of becoming a plausible branch.

use super::function::Function;
use crate::{Branches, Real, Task, elementary};

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
    #[inline(always)]
    fn apply<R: Real>(self, operands: &[R], values: &[R]) -> R {
        match self {
            Self::Constant(x) => R::splat(x),
            Self::Value(slot) => values[slot as usize],
            Self::Neg => -operands[0],
            Self::Not => logical(operands[0], R::zero(), equal(operands[0], R::zero())),
            Self::Power(exponent) => whole_power(operands[0], exponent),
            Self::Binary(binary) => binary.apply(operands[0], operands[1]),
            Self::Call(function, _) => function.apply(operands),
        }
    }
}

impl Binary {
    /// Returns true if its result is 1 or 0.
    fn is_logical(self) -> bool {
        !matches!(self, Self::Add | Self::Sub | Self::Mul | Self::Div | Self::Pow)
    }

    #[inline(always)]
    fn apply<R: Real>(self, a: R, b: R) -> R {
        match self {
            Self::Add => a + b,
            Self::Sub => a - b,
            Self::Mul => a * b,
            Self::Div => a / b,
            Self::Pow => a.binary(elementary::Binary::Pow, b),
            Self::Less => logical(a, b, less(a, b)),
            Self::LessEqual => logical(a, b, not(less(b, a))),
            Self::Greater => logical(a, b, less(b, a)),
            Self::GreaterEqual => logical(a, b, not(less(a, b))),
            Self::Equal => logical(a, b, equal(a, b)),
            Self::NotEqual => logical(a, b, not(equal(a, b))),
            Self::And => logical(a, b, not(equal(a, R::zero())) * not(equal(b, R::zero()))),
            Self::Or => logical(a, b, not(equal(a, R::zero()) * equal(b, R::zero()))),
        }
    }
}

/// Evaluation in lanes, compiled for them as a whole.
pub(super) struct Run<'a, R> {
    pub program: &'a [Op],
    pub values: &'a [R],
    pub stack: &'a mut Vec<R>,
}

impl<R: Real> Task for Run<'_, R> {
    type Output = R;

    #[inline(always)]
    fn run(self) -> R {
        run(self.program, self.values, self.stack)
    }
}

/// The same on a stack of given length.
pub(super) struct RunIn<'a, R> {
    pub program: &'a [Op],
    pub values: &'a [R],
    pub stack: &'a mut [R],
}

impl<R: Real> Task for RunIn<'_, R> {
    type Output = R;

    #[inline(always)]
    fn run(self) -> R {
        run_in(self.program, self.values, self.stack)
    }
}

/// Runs a program. `stack` is emptied first; it does not grow if its capacity is the depth of the program.
#[inline(always)]
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
#[inline(always)]
pub(super) fn run_in<R: Real>(program: &[Op], values: &[R], stack: &mut [R]) -> R {
    let mut top = 0;
    for op in program {
        let base = top - op.takes();
        stack[base] = op.apply(&stack[base..top], values);
        top = base + 1;
    }
    stack[0]
}

/// Runs a program on a stack of given length and notes the branches that it takes.
pub(super) fn note_branches(program: &[Op], values: &[f64], stack: &mut [f64], branches: &mut Branches) {
    let mut top = 0;
    for op in program {
        let base = top - op.takes();
        let operands = &stack[base..top];
        let result = op.apply(operands, values);
        match op {
            Op::Call(function, _) => function.note_branch(operands, result, branches),
            Op::Not => branches.note(result.to_bits()),
            Op::Binary(binary) if binary.is_logical() => branches.note(result.to_bits()),
            _ => {}
        }
        stack[base] = result;
        top = base + 1;
    }
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

/// 1 where a condition holds, else 0: `value`, but NaN where `a` or `b` is. No derivatives.
#[inline(always)]
fn logical<R: Real>(a: R, b: R, value: R) -> R {
    unless_nan(a, unless_nan(b, value, R::splat(f64::NAN)), R::splat(f64::NAN))
}

/// `value` where `x` is a number, else `otherwise`.
#[inline(always)]
fn unless_nan<R: Real>(x: R, value: R, otherwise: R) -> R {
    // every number is below 1 or above ½
    x.if_less(R::one(), value, R::splat(0.5).if_less(x, value, otherwise))
}

/// 1 where a is less than b, else 0.
#[inline(always)]
fn less<R: Real>(a: R, b: R) -> R {
    a.if_less(b, R::one(), R::zero())
}

/// 1 where a is neither less nor more than b, else 0.
#[inline(always)]
fn equal<R: Real>(a: R, b: R) -> R {
    a.if_less(b, R::zero(), b.if_less(a, R::zero(), R::one()))
}

/// 1 where a condition, 1 or 0, does not hold, else 0.
#[inline(always)]
fn not<R: Real>(condition: R) -> R {
    R::one() - condition
}

/// `then` where the condition is not zero, else `otherwise`, lane by lane; NaN where the condition is.
#[inline(always)]
pub(super) fn choose<R: Real>(condition: R, then: R, otherwise: R) -> R {
    let is_false = logical(condition, R::zero(), equal(condition, R::zero()));
    // 0 or NaN: taking it away changes no bit of a number
    let poison = is_false + -is_false;
    is_false.if_less(R::splat(0.5), then, otherwise) - poison
}

/// The smaller of two, `a` where they are equal; NaN where one of them is.
#[inline]
pub(super) fn smaller<R: Real>(a: R, b: R) -> R {
    unless_nan(b, b.if_less(a, b, a), b)
}

/// −1, 0 or 1; NaN for NaN. No derivatives.
#[inline]
pub(super) fn sign<R: Real>(x: R) -> R {
    // the cube of a zero keeps its sign, and has no slope
    R::zero().if_less(x, R::one(), x.if_less(R::zero(), -R::one(), x * x * x))
}

/// `x^exponent` by squaring; a negative exponent divides 1 by it.
#[inline(always)]
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
        let out = choose(Dual::constant(0.0), x.unary(elementary::Unary::Ln), x * x);
        assert_eq!((out.value, out.partials), (1.0, [-2.0]));
    }

    const SPECIAL: [f64; 13] = [
        f64::NAN,
        f64::NEG_INFINITY,
        -1e300,
        -1.0,
        -0.5,
        -0.0,
        0.0,
        f64::MIN_POSITIVE,
        0.5,
        0.75,
        1.0,
        3.0,
        f64::INFINITY,
    ];

    #[test]
    fn comparisons_without_branches_have_the_values_of_branches() {
        type Holds = fn(f64, f64) -> bool;
        let branches: [(Binary, Holds); 8] = [
            (Binary::Less, |a, b| a < b),
            (Binary::LessEqual, |a, b| a <= b),
            (Binary::Greater, |a, b| a > b),
            (Binary::GreaterEqual, |a, b| a >= b),
            (Binary::Equal, |a, b| a == b),
            (Binary::NotEqual, |a, b| a != b),
            (Binary::And, |a, b| a != 0.0 && b != 0.0),
            (Binary::Or, |a, b| a != 0.0 || b != 0.0),
        ];
        for (a, b) in SPECIAL.iter().flat_map(|a| SPECIAL.iter().map(move |b| (*a, *b))) {
            for (binary, holds) in branches {
                let expected = if a.is_nan() || b.is_nan() { f64::NAN } else { f64::from(u8::from(holds(a, b))) };
                let found = binary.apply(a, b);
                assert!(
                    found.to_bits() == expected.to_bits() || found.is_nan() && expected.is_nan(),
                    "{binary:?} {a} {b}"
                );
                assert_eq!(
                    binary.apply(Dual::<1>::variable(a, 0), Dual::constant(b)).partials,
                    [0.0],
                    "{binary:?} {a} {b}"
                );
            }
            let least = if b < a || b.is_nan() { b } else { a };
            assert_eq!(smaller(a, b).to_bits(), least.to_bits(), "{a} {b}");
        }
    }

    #[test]
    fn the_sign_keeps_zeros_and_has_no_slope() {
        for x in SPECIAL {
            let expected = if x == 0.0 || x.is_nan() { x } else { 1f64.copysign(x) };
            let found = sign(x);
            assert!(found.to_bits() == expected.to_bits() || found.is_nan() && expected.is_nan(), "{x}");
            if !x.is_nan() {
                assert_eq!(sign(Dual::<1>::variable(x, 0)).partials, [0.0], "{x}");
            }
        }
    }

    #[test]
    fn recorded_functions_keep_what_is_not_a_number() {
        for text in ["sign(x)", "x < 1", "not(x)", "min(x, 1)", "max(1, x)", "clamp(x, 0, 1)", "if(x, 1, 2)", "x and 0"]
        {
            let formula = crate::expression::Expression::parse(text, &["x"]).unwrap();
            let program = crate::record::record(1, 1, |x| vec![formula.eval(x, &mut Vec::new())]).unwrap();
            assert!(program.evaluate(&[f64::NAN], 0)[0].is_nan(), "{text}");
        }
    }

    #[test]
    fn recordings_of_one_formula_are_equal() {
        let formula = crate::expression::Expression::parse("if(x > 1, x, 2)", &["x"]).unwrap();
        let program = |unused: f64| {
            let act = |x: &[crate::record::Recorded]| {
                Real::sqrt(x[0] + crate::record::Recorded::splat(unused));
                vec![formula.eval(x, &mut Vec::new()) * x[0]]
            };
            crate::record::record(1, 1, act).unwrap()
        };
        // a number that nothing needs, also one of those in the formula
        assert!([0.0, 1.0, 2.0, 0.5, 7.0].into_iter().all(|unused| program(unused) == program(3.0)));
    }

    #[test]
    fn formulas_with_comparisons_are_recorded_with_their_bits() {
        let text =
            "if(x > 0.5 and not(y == x), min(x, y, 0.7), sign(y)) + clamp(x, -1, y) + max(x, 2*y) + (x <= y or x != 3)";
        let formula = crate::expression::Expression::parse(text, &["x", "y"]).unwrap();
        let program = crate::record::record(2, 1, |x| vec![formula.eval(x, &mut Vec::new())]).unwrap();
        for (x, y) in SPECIAL.iter().flat_map(|x| SPECIAL.iter().map(move |y| (*x, *y))) {
            let (expected, found) = (formula.eval(&[x, y], &mut Vec::new()), program.evaluate(&[x, y], 0)[0]);
            assert!(found.to_bits() == expected.to_bits() || found.is_nan() && expected.is_nan(), "{x} {y}");
        }
    }
}
