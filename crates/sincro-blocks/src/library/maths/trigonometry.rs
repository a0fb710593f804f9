//! `y = sin(u)`, `cos(u)` …, angles in radians.

use sincro_math::{Real, elementary};

use crate::block::{At, Block, Ports, elementwise};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::reader::Reader;

/// A function of angles, component by component.
///
/// `atan2` has two inputs, first that along y; the others have one. Outside [−1, 1] `asin` and `acos` are not numbers: the run stops and names
/// this block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Trigonometry {
    /// Which one.
    pub function: Trigonometric,
}

/// A trigonometric function or the inverse of one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Trigonometric {
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Atan2,
}

use Trigonometric::{Acos, Asin, Atan, Atan2, Cos, Sin, Tan};

/// By name.
const FUNCTIONS: [(&str, Trigonometric); 7] =
    [("sin", Sin), ("cos", Cos), ("tan", Tan), ("asin", Asin), ("acos", Acos), ("atan", Atan), ("atan2", Atan2)];

impl Trigonometry {
    /// The block of a function.
    #[must_use]
    pub fn new(function: Trigonometric) -> Self {
        Self { function }
    }
}

impl Described for Trigonometry {
    const KIND: &'static Kind = &Kind {
        name: "trigonometry",
        group: Group::Maths,
        summary: "A function of angles in radians, component by component.",
        equation: "y = function(u); y = atan2(u1, u2), the angle in [−π, π] of the point x = u2, y = u1",
        parameters: &[Parameter::required(
            "function",
            Takes::Choice(&["sin", "cos", "tan", "asin", "acos", "atan", "atan2"]),
            "which function; angles in [rad]",
        )],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        Self::new(FUNCTIONS[p.choice("function")].1)
    }
}

impl Block for Trigonometry {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::numbered(if self.function == Atan2 { 2 } else { 1 })
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![elementwise(inputs, &[])?])
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            let u = at.component(0, i);
            *y = match self.function {
                Sin => u.sin_cos().0,
                Cos => u.sin_cos().1,
                Tan => u.map(elementary::tan),
                Asin => u.map(elementary::asin),
                Acos => u.map(elementary::acos),
                Atan => u.map(elementary::atan),
                Atan2 => u.map2(at.component(1, i), elementary::atan2),
            };
        }
    }

    fn label(&self) -> String {
        FUNCTIONS.iter().find(|f| f.1 == self.function).map_or_else(String::new, |f| f.0.to_owned())
    }
}
