//! `y = R(q)·v, or Rᵀ(q)·v if inverse`.

use sincro_math::Real;

use super::algebra::{quaternion_to_matrix, rotate};
use super::array;
use crate::block::{At, Block, Ports};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::reader::Reader;

/// Turns a vector by a quaternion (w, x, y, z), which need not be of length 1: with q_wb, from components in B to components in W.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RotateVector {
    /// Whether it turns back.
    pub inverse: bool,
}

impl RotateVector {
    /// `inverse`: whether it turns back.
    #[must_use]
    pub fn new(inverse: bool) -> Self {
        Self { inverse }
    }
}

impl Described for RotateVector {
    const KIND: &'static Kind = &Kind {
        name: "rotate-vector",
        group: Group::Rotations,
        summary: "Turns a vector by a quaternion.",
        equation: "y = R(q)·v, or Rᵀ(q)·v if inverse",
        parameters: &[Parameter::optional("inverse", Takes::Flag, "whether it turns back", "false")],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        Self { inverse: p.flag("inverse") }
    }
}

impl Block for RotateVector {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::new(&["q", "v"], &["y"])
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        super::fixed(inputs, &[("q", 4), ("v", 3)], 3)
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        y.copy_from_slice(&rotate(quaternion_to_matrix(array(at, 0)), array(at, 1), self.inverse));
    }

    fn label(&self) -> String {
        if self.inverse { "Rᵀv".into() } else { "Rv".into() }
    }
}
