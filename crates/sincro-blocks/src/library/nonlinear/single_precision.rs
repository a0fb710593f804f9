//! `y` = the nearest number of single precision.

use sincro_math::Real;

use crate::block::{At, Block, Ports, elementwise};
use crate::kind::{Described, Group, Kind};
use crate::reader::Reader;
use crate::unit::Unit;

/// Rounds to single precision (IEEE 754 binary32, ties to even): what is left of a number on a wire that carries four bytes, such as that of V-REP's
/// legacy remote API. Its derivative is one.
#[derive(Clone, Debug, PartialEq)]
pub struct SinglePrecision;

impl Described for SinglePrecision {
    const KIND: &'static Kind = &Kind {
        name: "single-precision",
        group: Group::Nonlinear,
        summary: "Rounds to single precision, as a wire or a program does that has four bytes for a number.",
        equation: "y = the number of binary32 nearest to u, ties to even",
        parameters: &[],
    };

    fn read(_: &mut Reader<'_>) -> Self {
        Self
    }
}

impl Block for SinglePrecision {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::single()
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![elementwise(inputs, &[])?])
    }

    fn units(&self, inputs: &[Option<Unit>]) -> Result<Vec<Option<Unit>>, String> {
        Ok(inputs.to_vec())
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            *y = at.component(0, i).map(|u| (f64::from(u as f32), 1.0));
        }
    }
}
