//! `y = u1 and u2 and …`, or, not, xor, nand, nor: 1 if it holds, else 0.

use sincro_math::Real;

use super::truth::test;
use crate::block::{At, Block, Ports, elementwise};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::reader::Reader;

/// Joins truths component by component; with a single input, all its components with each other.
///
/// Zero is false, any other number true; what depends on a NaN is NaN.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Logic {
    /// How.
    pub operator: Operator,
    /// Number of inputs; 1 for `Not`.
    pub inputs: usize,
}

/// How truths are joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operator {
    /// All are true.
    And,
    /// At least one is true.
    Or,
    /// The only one is false.
    Not,
    /// An odd number is true.
    Xor,
    /// Not all are true.
    Nand,
    /// None is true.
    Nor,
}

use Operator::{And, Nand, Nor, Not, Or, Xor};

/// By name.
const OPERATORS: [(&str, Operator); 6] =
    [("and", And), ("or", Or), ("not", Not), ("xor", Xor), ("nand", Nand), ("nor", Nor)];

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

    /// What joins with any truth without changing it.
    fn neutral<R: Real>(self) -> R {
        if matches!(self, And | Nand) { R::one() } else { R::zero() }
    }

    #[inline(always)]
    fn finish<R: Real>(self, joined: R) -> R {
        if matches!(self, Not | Nand | Nor) { R::one() - joined } else { joined }
    }
}

impl Logic {
    /// With two inputs, `Not` with one.
    #[must_use]
    pub fn new(operator: Operator) -> Self {
        Self { operator, inputs: if operator == Not { 1 } else { 2 } }
    }
}

impl Described for Logic {
    const KIND: &'static Kind = &Kind {
        name: "logic",
        group: Group::Logic,
        summary: "Joins truths component by component, or all components of a single input; zero is false.",
        equation: "y = u1 operator u2 operator … (1 or 0); not: y = 1 if u = 0, else 0",
        parameters: &[
            Parameter::required(
                "operator",
                Takes::Choice(&["and", "or", "not", "xor", "nand", "nor"]),
                "how they are joined; `xor` is true of an odd number of truths",
            ),
            Parameter::optional("inputs", Takes::Count, "number of inputs; `not` has one", "2"),
        ],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        let operator = OPERATORS[p.choice("operator")].1;
        if operator == Not && !p.has("inputs") {
            return Self::new(Not);
        }
        let inputs = crate::library::maths::n_inputs(p);
        if operator == Not && inputs != 1 {
            p.fault("inputs", format!("`not` with {inputs} inputs"), "it has one; leave `inputs` out");
        }
        Self { operator, inputs }
    }
}

impl Block for Logic {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::numbered(self.inputs)
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        let is_one = self.inputs == 1 && self.operator != Not;
        Ok(vec![if is_one { Some(1) } else { elementwise(inputs, &[])? }])
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
        OPERATORS.iter().find(|o| o.1 == self.operator).map_or_else(String::new, |o| o.0.to_uppercase())
    }
}
