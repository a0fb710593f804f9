//! `y = gain·u`.

use sincro_math::Real;

use crate::block::{At, Block, Ports, elementwise, of};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::reader::Reader;

/// Multiplies by a constant.
#[derive(Clone, Debug, PartialEq)]
pub struct Gain {
    /// One factor for all components, or one for each.
    pub gain: Vec<f64>,
}

impl Gain {
    /// One factor for all components.
    #[must_use]
    pub fn new(gain: f64) -> Self {
        Self { gain: vec![gain] }
    }
}

impl Described for Gain {
    const KIND: &'static Kind = &Kind {
        name: "gain",
        group: Group::Maths,
        summary: "Multiplies by a constant.",
        equation: "y = gain·u",
        parameters: &[Parameter::required("gain", Takes::Numbers, "factor, one for all components or one for each")],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        Self { gain: p.numbers("gain") }
    }
}

impl Block for Gain {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::single()
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        Ok(vec![elementwise(inputs, &[("gain", self.gain.len())])?])
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        for (i, y) in y.iter_mut().enumerate() {
            *y = R::splat(of(&self.gain, i)) * at.component(0, i);
        }
    }

    fn label(&self) -> String {
        crate::library::short_list(&self.gain)
    }
}
