//! `y = u1 ⊗ u2`.

use sincro_math::Real;

use super::algebra::product;
use super::array;
use crate::block::{At, Block, Ports};
use crate::kind::{Described, Group, Kind};
use crate::reader::Reader;

/// The product of two quaternions (w, x, y, z): first the rotation `u2`, then `u1`, as q_wc = q_wb ⊗ q_bc.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct QuaternionProduct;

impl Described for QuaternionProduct {
    const KIND: &'static Kind = &Kind {
        name: "quaternion-product",
        group: Group::Rotations,
        summary: "One rotation after another.",
        equation: "y = u1 ⊗ u2",
        parameters: &[],
    };

    fn read(_: &mut Reader<'_>) -> Self {
        Self
    }
}

impl Block for QuaternionProduct {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::new(&["u1", "u2"], &["y"])
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        super::fixed(inputs, &[("u1", 4), ("u2", 4)], 4)
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        y.copy_from_slice(&product(array(at, 0), array(at, 1)));
    }

    fn label(&self) -> String {
        "⊗".into()
    }
}
