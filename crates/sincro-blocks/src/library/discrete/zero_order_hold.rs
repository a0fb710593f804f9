//! `y(t) = u(t_k)` for `t_k ≤ t < t_{k+1}`.

use sincro_math::Real;

use crate::block::{At, Block, Pace, Ports, elementwise};
use crate::kind::{Described, Group, Kind};
use crate::reader::Reader;
use crate::unit::Unit;

/// The input at the last sample, held until the next one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ZeroOrderHold;

impl Described for ZeroOrderHold {
    const KIND: &'static Kind = &Kind {
        name: "zero-order-hold",
        group: Group::Discrete,
        summary: "The input at the last sample, held until the next one.",
        equation: "y(t) = u(t_k), t_k ≤ t < t_{k+1}",
        parameters: &[],
    };

    fn read(_: &mut Reader<'_>) -> Self {
        Self
    }
}

impl Block for ZeroOrderHold {
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

    fn pace(&self) -> Pace {
        Pace::Sampled
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        y.copy_from_slice(at.input(0));
    }

    fn label(&self) -> String {
        "ZOH".into()
    }
}
