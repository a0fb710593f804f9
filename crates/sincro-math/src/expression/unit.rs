//! Unit of the value of a formula from the units of its names: the formula run on units in place of numbers.
//!
//! Numbers in the text may stand for anything (`9.81*m`), so a number times a unit is unknown, while a number added to
//! a unit has that unit. Two units that are added and differ make the result unknown, and so does every function that
//! is not defined for units; nothing is an error here.

use super::Expression;
use super::eval::{Binary, Op};
use super::function::Function;

/// Arithmetic of units, given by the caller of [`Expression::unit`].
pub trait Units {
    /// Unit of a quantity.
    type Unit: Clone;
    /// Product of powers; `None` if it cannot be expressed.
    fn product(&self, factors: &[(&Self::Unit, i8)]) -> Option<Self::Unit>;
    /// Square root; `None` if it cannot be expressed.
    fn sqrt(&self, unit: &Self::Unit) -> Option<Self::Unit>;
    /// Returns true if a number means the same in both.
    fn is_same(&self, a: &Self::Unit, b: &Self::Unit) -> bool;
    /// Unit of a pure number.
    fn one(&self) -> Self::Unit;
    /// Unit of an angle: the radian.
    fn angle(&self) -> Self::Unit;
}

/// Operand on the stack.
#[derive(Clone)]
enum Operand<U> {
    /// A quantity of this unit.
    Known(U),
    /// A number, or a quantity whose unit is unknown: it may have any.
    Any,
    /// A quantity of no unit at all: units that differ were added.
    Wrong,
}

impl Expression {
    /// Unit of the value, from those of the names, in the order given to [`Expression::parse`]; `None` for a name
    /// whose unit is unknown. `None` if it does not follow.
    pub fn unit<S: Units>(&self, units: &S, names: &[Option<S::Unit>]) -> Option<S::Unit> {
        let mut stack: Vec<Operand<S::Unit>> = Vec::new();
        for op in &self.program {
            let operands = stack.split_off(stack.len() - op.takes());
            stack.push(apply(*op, &operands, units, names));
        }
        match stack.pop() {
            Some(Operand::Known(unit)) => Some(unit),
            _ => None,
        }
    }
}

fn apply<S: Units>(op: Op, operands: &[Operand<S::Unit>], units: &S, names: &[Option<S::Unit>]) -> Operand<S::Unit> {
    let product = |factors: &[(usize, i8)]| {
        let known = factors.iter().map(|&(k, power)| match &operands[k] {
            Operand::Known(unit) => Some((unit, power)),
            _ => None,
        });
        let known = known.collect::<Option<Vec<_>>>();
        known.and_then(|known| units.product(&known)).map_or_else(|| unknown(operands), Operand::Known)
    };
    match op {
        Op::Constant(_) => Operand::Any,
        Op::Value(slot) => names.get(slot as usize).cloned().flatten().map_or(Operand::Any, Operand::Known),
        Op::Neg => operands[0].clone(),
        Op::Not => Operand::Known(units.one()),
        Op::Power(exponent) => product(&[(0, exponent)]),
        Op::Binary(Binary::Add | Binary::Sub) => shared(operands, units),
        Op::Binary(Binary::Mul) => product(&[(0, 1), (1, 1)]),
        Op::Binary(Binary::Div) => product(&[(0, 1), (1, -1)]),
        Op::Binary(Binary::Pow) => unknown(operands),
        // comparisons and logic
        Op::Binary(_) => Operand::Known(units.one()),
        Op::Call(function, _) => call(function, operands, units),
    }
}

fn call<S: Units>(function: Function, operands: &[Operand<S::Unit>], units: &S) -> Operand<S::Unit> {
    use Function as F;
    match function {
        F::Sin | F::Cos | F::Tan | F::Sinh | F::Cosh | F::Tanh | F::Exp | F::Ln | F::Log10 | F::Sign => {
            Operand::Known(units.one())
        }
        F::Asin | F::Acos | F::Atan | F::Atan2 => Operand::Known(units.angle()),
        F::Sqrt => match &operands[0] {
            Operand::Known(unit) => units.sqrt(unit).map_or(Operand::Any, Operand::Known),
            other => other.clone(),
        },
        F::Abs | F::Floor | F::Ceil | F::Mod | F::Min | F::Max | F::Clamp | F::Hypot => shared(operands, units),
        F::If => shared(&operands[1..], units),
    }
}

/// Unit that all operands have, as far as they have any.
fn shared<S: Units>(operands: &[Operand<S::Unit>], units: &S) -> Operand<S::Unit> {
    let mut found = Operand::Any;
    for operand in operands {
        match (&found, operand) {
            (_, Operand::Wrong) => return Operand::Wrong,
            (Operand::Known(a), Operand::Known(b)) if !units.is_same(a, b) => return Operand::Wrong,
            (Operand::Any, Operand::Known(_)) => found = operand.clone(),
            _ => {}
        }
    }
    found
}

/// Unknown, but wrong if an operand is.
fn unknown<U: Clone>(operands: &[Operand<U>]) -> Operand<U> {
    if operands.iter().any(|o| matches!(o, Operand::Wrong)) { Operand::Wrong } else { Operand::Any }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Metres and radians, as their exponents.
    struct Lengths;

    impl Units for Lengths {
        type Unit = [i8; 2];
        fn product(&self, factors: &[(&[i8; 2], i8)]) -> Option<[i8; 2]> {
            Some([0, 1].map(|k| factors.iter().map(|(unit, power)| unit[k] * power).sum()))
        }
        fn sqrt(&self, unit: &[i8; 2]) -> Option<[i8; 2]> {
            unit.iter().all(|e| e % 2 == 0).then(|| unit.map(|e| e / 2))
        }
        fn is_same(&self, a: &[i8; 2], b: &[i8; 2]) -> bool {
            a == b
        }
        fn one(&self) -> [i8; 2] {
            [0, 0]
        }
        fn angle(&self) -> [i8; 2] {
            [0, 1]
        }
    }

    fn unit(text: &str) -> Option<[i8; 2]> {
        let formula = Expression::parse(text, &["x", "y", "a", "k"]).unwrap();
        formula.unit(&Lengths, &[Some([1, 0]), Some([1, 0]), Some([0, 1]), None])
    }

    #[test]
    fn units_follow_where_they_are_unique() {
        assert_eq!(unit("hypot(x, y) - 0.25"), Some([1, 0]));
        assert_eq!(unit("sqrt(x^2 + y^2)/y"), Some([0, 0]));
        assert_eq!(unit("x*cos(a) - y*sin(a)"), Some([1, 0]));
        assert_eq!(unit("max(abs(x), k)"), Some([1, 0]));
        assert_eq!(unit("atan2(y, x) + a"), Some([0, 1]));
        assert_eq!(unit("if(x > 1, x, 0)"), Some([1, 0]));
    }

    #[test]
    fn units_that_do_not_follow_are_unknown() {
        // a number or a parameter as a factor, units that differ, and a sum with them
        for text in ["9.81*x", "k*x", "x + a", "(x + a) + x", "0*x + 2*k", "sqrt(x)"] {
            assert_eq!(unit(text), None, "{text}");
        }
    }
}
