//! `y = exp(u)`, `ln(u)` …: growth and rounding.

use sincro_math::{Real, elementary};

use crate::block::{At, Block, Ports};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::reader::Reader;

/// A function of one argument, component by component.
///
/// Where it has no value (the logarithm of a negative number, the reciprocal of zero) the run stops and names this block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Function {
    /// Which one.
    pub function: Unary,
}

/// A function of one argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Unary {
    Exp,
    Ln,
    Log10,
    Sinh,
    Cosh,
    Tanh,
    Square,
    Reciprocal,
    /// The next whole number below.
    Floor,
    /// The next whole number above.
    Ceil,
    /// The nearest whole number; halves away from zero.
    Round,
}

use Unary::{Ceil, Cosh, Exp, Floor, Ln, Log10, Reciprocal, Round, Sinh, Square, Tanh};

/// By name.
const FUNCTIONS: [(&str, Unary); 11] = [
    ("exp", Exp),
    ("ln", Ln),
    ("log10", Log10),
    ("sinh", Sinh),
    ("cosh", Cosh),
    ("tanh", Tanh),
    ("square", Square),
    ("reciprocal", Reciprocal),
    ("floor", Floor),
    ("ceil", Ceil),
    ("round", Round),
];

impl Function {
    /// The block of a function.
    #[must_use]
    pub fn new(function: Unary) -> Self {
        Self { function }
    }
}

impl Described for Function {
    const KIND: &'static Kind = &Kind {
        name: "function",
        group: Group::Maths,
        summary: "A function of one argument, component by component: exponential, logarithm, rounding and others.",
        equation: "y = function(u)",
        parameters: &[Parameter::required(
            "function",
            Takes::Choice(&[
                "exp",
                "ln",
                "log10",
                "sinh",
                "cosh",
                "tanh",
                "square",
                "reciprocal",
                "floor",
                "ceil",
                "round",
            ]),
            "which function; `round` takes halves away from zero",
        )],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        Self::new(FUNCTIONS[p.choice("function")].1)
    }
}

impl Block for Function {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::single()
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(inputs.to_vec())
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (y, u) in y.iter_mut().zip(at.input(0)) {
            *y = match self.function {
                Exp => u.map(elementary::exp),
                Ln => u.map(elementary::ln),
                Log10 => u.map(elementary::log10),
                Sinh => u.map(elementary::sinh),
                Cosh => u.map(elementary::cosh),
                Tanh => u.map(elementary::tanh),
                Square => *u * *u,
                Reciprocal => R::one() / *u,
                Floor => u.map(|u| (u.floor(), 0.0)),
                Ceil => u.map(|u| (u.ceil(), 0.0)),
                Round => u.map(|u| (u.round(), 0.0)),
            };
        }
    }

    fn label(&self) -> String {
        match self.function {
            Square => "u²".into(),
            Reciprocal => "1/u".into(),
            Exp => "eᵘ".into(),
            _ => FUNCTIONS.iter().find(|f| f.1 == self.function).map_or_else(String::new, |f| f.0.to_owned()),
        }
    }
}
