//! `y = q ⊗ (0, w)/2, or (0, w) ⊗ q/2 with world axes`.

use sincro_math::Real;

use super::algebra::product;
use super::array;
use crate::block::{At, Block, Ports};
use crate::kind::{Described, Group, Kind, Parameter, Takes};
use crate::reader::Reader;

/// The rate of a quaternion (w, x, y, z) from the angular velocity `w` `[rad/s]`, in the axes of the body or of the world.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AngularVelocityToQuaternionRate {
    /// Whether the angular velocity is given in the axes of the world.
    pub world: bool,
}

impl AngularVelocityToQuaternionRate {
    /// `world`: whether the angular velocity is given in the axes of the world.
    #[must_use]
    pub fn new(world: bool) -> Self {
        Self { world }
    }
}

impl Described for AngularVelocityToQuaternionRate {
    const KIND: &'static Kind = &Kind {
        name: "angular-velocity-to-quaternion-rate",
        group: Group::Rotations,
        summary: "The rate of a quaternion from an angular velocity.",
        equation: "y = q ⊗ (0, w)/2, or (0, w) ⊗ q/2 with world axes",
        parameters: &[Parameter::optional(
            "world",
            Takes::Flag,
            "whether the angular velocity is given in the axes of the world",
            "false",
        )],
    };

    fn read(p: &mut Reader<'_>) -> Self {
        Self { world: p.flag("world") }
    }
}

impl Block for AngularVelocityToQuaternionRate {
    type Work<R: Real> = ();

    fn ports(&self) -> Ports {
        Ports::new(&["q", "w"], &["y"])
    }

    fn widths(&self, inputs: &[Option<usize>]) -> Result<Vec<Option<usize>>, String> {
        super::fixed(inputs, &[("q", 4), ("w", 3)], 4)
    }

    fn output<R: Real>(&self, at: &At<'_, R>, (): &mut (), y: &mut [R]) {
        y.copy_from_slice(&rate(array(at, 0), array(at, 1), self.world));
    }

    fn label(&self) -> String {
        "q' = ½q ⊗ ω".into()
    }
}

#[inline(always)]
fn rate<R: Real>(q: [R; 4], w: [R; 3], world: bool) -> [R; 4] {
    let half = R::splat(0.5);
    let w = [R::zero(), half * w[0], half * w[1], half * w[2]];
    if world { product(w, q) } else { product(q, w) }
}
