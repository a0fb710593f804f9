//! Block `compare`.

use super::truth::test;
use crate::library::prelude::*;

declare_block! {
    /// Compares two inputs, or one with a constant, component by component.
    pub struct Compare("compare", Logic):
        "y = 1 if u1 operator u2, else 0; with a constant y = 1 if u operator constant, else 0" {
        /// The comparison.
        pub operator: Comparison as Choice,
        /// Constant to compare the input with; if it is left out, there is a second input in its place.
        pub constant: Option<Vec<f64>> as OptionalParameter<PerComponent> = "none",
    }
}

choice! {
    /// Comparison of two numbers.
    #[allow(missing_docs)]
    pub enum Comparison {
        Less = "<",
        LessEqual = "<=",
        Greater = ">",
        GreaterEqual = ">=",
        Equal = "==",
        NotEqual = "!=",
    }
}

use Comparison::{Equal, Greater, GreaterEqual, Less, LessEqual, NotEqual};

impl Comparison {
    /// 1 where it holds, else 0; NaN where one of the two is.
    #[must_use]
    #[inline(always)]
    pub fn of<R: Real>(self, a: R, b: R) -> R {
        match self {
            Less => test(a, b, |a, b| a < b),
            LessEqual => test(a, b, |a, b| a <= b),
            Greater => test(a, b, |a, b| a > b),
            GreaterEqual => test(a, b, |a, b| a >= b),
            Equal => test(a, b, |a, b| a == b),
            NotEqual => test(a, b, |a, b| a != b),
        }
    }

    /// As in a drawing.
    #[must_use]
    pub fn sign(self) -> &'static str {
        match self {
            Less => "<",
            LessEqual => "≤",
            Greater => ">",
            GreaterEqual => "≥",
            Equal => "=",
            NotEqual => "≠",
        }
    }
}

impl Compare {
    /// Two inputs.
    #[must_use]
    pub fn new(operator: Comparison) -> Self {
        Self { operator, constant: None }
    }

    /// An input with a number.
    #[must_use]
    pub fn with(operator: Comparison, constant: f64) -> Self {
        Self { operator, constant: Some(vec![constant]) }
    }
}

impl Block for Compare {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::numbered(if self.constant.is_some() { 1 } else { 2 })
    }

    fn units(&self, inputs: &[Option<Unit>]) -> Result<Vec<Option<Unit>>, String> {
        common(inputs)?;
        Ok(vec![None])
    }

    fn unit_rule(&self) -> UnitRule {
        UnitRule::fixed(["1"])
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            let with = match &self.constant {
                Some(constant) => R::splat(of(constant, i)),
                None => at.component(1, i),
            };
            *y = self.operator.of(at.component(0, i), with);
        }
    }

    fn label(&self) -> String {
        match &self.constant {
            Some(constant) => format!("u {} {}", self.operator.sign(), short_list(constant)),
            None => self.operator.sign().into(),
        }
    }
}
