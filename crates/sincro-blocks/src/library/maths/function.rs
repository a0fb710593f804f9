//! Block `function`.

use crate::library::prelude::*;

declare_block! {
    /// A function of one argument, component by component: exponential, logarithm, rounding and others.
    ///
    /// Where it has no value (the logarithm of a negative number,
    /// the reciprocal of zero) the run stops and names this block.
    pub struct Function("function", Maths): "y = function(u)" {
        /// Function; `round` takes halves away from zero.
        pub function: Unary as Choice,
    }
}

choice! {
    /// A function of one argument.
    #[allow(missing_docs)]
    pub enum Unary {
        Exp = "exp",
        Ln = "ln",
        Log10 = "log10",
        Sinh = "sinh",
        Cosh = "cosh",
        Tanh = "tanh",
        Square = "square",
        Reciprocal = "reciprocal",
        /// The next whole number below.
        Floor = "floor",
        /// The next whole number above.
        Ceil = "ceil",
        /// The nearest whole number; halves away from zero.
        Round = "round",
    }
}

use Unary::{Ceil, Cosh, Exp, Floor, Ln, Log10, Reciprocal, Round, Sinh, Square, Tanh};

impl Function {
    /// The block of a function.
    #[must_use]
    pub fn new(function: Unary) -> Self {
        Self { function }
    }
}

impl Block for Function {
    type Work<R: Real> = ();

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (y, u) in y.iter_mut().zip(at.input(0)) {
            *y = match self.function {
                Exp => u.unary(elementary::Unary::Exp),
                Ln => u.unary(elementary::Unary::Ln),
                Log10 => u.unary(elementary::Unary::Log10),
                Sinh => u.unary(elementary::Unary::Sinh),
                Cosh => u.unary(elementary::Unary::Cosh),
                Tanh => u.unary(elementary::Unary::Tanh),
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
            _ => self.function.word().into(),
        }
    }
}
