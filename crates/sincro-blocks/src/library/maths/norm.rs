//! `y = √(Σ uᵢ²)`.

use sincro_math::Real;

use crate::block::{At, Block, Ports};
use crate::kind::{Described, Group, Kind};
use crate::reader::Reader;
use crate::unit::Unit;

/// Euclidean length of a vector. Its derivative at zero is taken as zero.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Norm;

impl Norm {
    /// The one there is.
    #[must_use]
    pub fn new() -> Self {
        Self
    }
}

impl Described for Norm {
    const KIND: &'static Kind = &Kind {
        name: "norm",
        group: Group::Maths,
        summary: "Euclidean length of a vector.",
        equation: "y = √(Σ uᵢ²)",
        parameters: &[],
    };

    fn read(_: &mut Reader<'_>) -> Self {
        Self
    }
}

impl Block for Norm {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::single()
    }

    fn widths(&self, _: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![Some(1)])
    }

    fn units(&self, inputs: &[Option<Unit>]) -> Result<Vec<Option<Unit>>, String> {
        Ok(inputs.to_vec())
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        y[0] = at.input(0).iter().fold(R::zero(), |sum, u| sum + *u * *u).sqrt();
    }

    fn label(&self) -> String {
        "|u|".into()
    }
}
