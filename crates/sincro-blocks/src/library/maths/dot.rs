//! `y = Σ u1ᵢ·u2ᵢ`.

use sincro_math::Real;

use crate::block::{At, Block, Ports, elementwise};
use crate::kind::{Described, Group, Kind};
use crate::reader::Reader;

/// Dot product of two vectors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Dot;

impl Dot {
    /// The one there is.
    #[must_use]
    pub fn new() -> Self {
        Self
    }
}

impl Described for Dot {
    const KIND: &'static Kind = &Kind {
        name: "dot",
        group: Group::Maths,
        summary: "Dot product of two vectors.",
        equation: "y = Σ u1ᵢ·u2ᵢ",
        parameters: &[],
    };

    fn read(_: &mut Reader<'_>) -> Self {
        Self
    }
}

impl Block for Dot {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::numbered(2)
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        elementwise(inputs, &[])?;
        Ok(vec![Some(1)])
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        let n = at.input(0).len().max(at.input(1).len());
        y[0] = (0..n).fold(R::zero(), |sum, i| sum + at.component(0, i) * at.component(1, i));
    }

    fn label(&self) -> String {
        "u1·u2".into()
    }
}
