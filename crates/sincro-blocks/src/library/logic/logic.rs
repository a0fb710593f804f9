//! Block `logic`.

use super::truth::test;
use crate::library::prelude::*;

declare_block! {
    /// Joins truths component by component, or all components of a single input; zero is false.
    ///
    /// Any number but zero is true; an output that depends on a NaN is NaN.
    pub struct Logic("logic", Logic): "y = u1 operator u2 operator … (1 or 0); not: y = 1 if u = 0, else 0" {
        /// Operator; `xor` is true of an odd number of truths.
        pub operator: Operator as Choice,
        /// Number of inputs; `not` has one.
        pub inputs: usize as InputCount = "2",
    }
}

choice! {
    /// Operator that joins truths.
    pub enum Operator {
        /// All are true.
        And = "and",
        /// At least one is true.
        Or = "or",
        /// The only one is false.
        Not = "not",
        /// An odd number is true.
        Xor = "xor",
        /// Not all are true.
        Nand = "nand",
        /// None is true.
        Nor = "nor",
    }
}

use Operator::{And, Nand, Nor, Not, Or, Xor};

impl Operator {
    /// The truth of two, before the negation of `Not`, `Nand` and `Nor`.
    #[inline(always)]
    fn join<R: Real>(self, a: R, b: R) -> R {
        match self {
            And | Nand => test(a, b, |a, b| a != 0.0 && b != 0.0),
            Or | Nor | Not => test(a, b, |a, b| a != 0.0 || b != 0.0),
            Xor => test(a, b, |a, b| (a != 0.0) != (b != 0.0)),
        }
    }

    /// Neutral element of [`Operator::join`].
    fn neutral<R: Real>(self) -> R {
        if matches!(self, And | Nand) { R::one() } else { R::zero() }
    }

    #[inline(always)]
    fn finish<R: Real>(self, joined: R) -> R {
        if matches!(self, Not | Nand | Nor) { R::one() - joined } else { joined }
    }
}

impl Logic {
    /// Creates the block with two inputs, `Not` with one.
    #[must_use]
    pub fn new(operator: Operator) -> Self {
        Self { operator, inputs: if operator == Not { 1 } else { 2 } }
    }
}

impl Block for Logic {
    type Work<R: Real> = ();

    fn validate(&mut self, p: &mut Reader<'_>) {
        if self.operator == Not && !p.has("inputs") {
            self.inputs = 1;
        }
        if self.operator == Not && self.inputs != 1 {
            p.fault("inputs", format!("`not` with {} inputs", self.inputs), "it has one; leave `inputs` out");
        }
    }

    fn ports(&self) -> Ports {
        Ports::numbered(self.inputs)
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        let is_one = self.inputs == 1 && self.operator != Not;
        Ok(vec![if is_one { Some(1) } else { elementwise(inputs, &[])? }])
    }

    fn unit_rule(&self) -> UnitRule {
        UnitRule::fixed(["1"])
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let (operator, neutral) = (self.operator, self.operator.neutral());
        if self.inputs == 1 && operator != Not {
            y[0] = operator.finish(at.input(0).iter().fold(neutral, |joined, u| operator.join(joined, *u)));
            return;
        }
        for (i, y) in y.iter_mut().enumerate() {
            let joined = (0..self.inputs).fold(neutral, |joined, k| operator.join(joined, at.component(k, i)));
            *y = operator.finish(joined);
        }
    }

    fn label(&self) -> String {
        self.operator.word().to_uppercase()
    }
}
