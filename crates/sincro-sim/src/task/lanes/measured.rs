//! Values of probes in lanes.

use sincro_dynamics::kinematics;
use sincro_dynamics::spatial::Vec3;
use sincro_math::Real;
use sincro_scene::record::probe::{View, attached, of_state};
use sincro_scene::record::{FrameQuantity, Probe};

/// Values of probes of one state, one after the other: the components of a quantity of a frame, which stand side by
/// side, are computed together.
pub(super) struct Measured<'a, R> {
    view: &'a View<'a, R>,
    /// Quantity and frame of the components.
    last: Option<(FrameQuantity, usize)>,
    components: Vec3<R>,
}

impl<'a, R: Real> Measured<'a, R> {
    #[inline(always)]
    pub fn new(view: &'a View<'a, R>) -> Self {
        Self { view, last: None, components: Vec3::zero() }
    }

    /// Value of a probe, with the bits of [`of_state`].
    #[inline(always)]
    pub fn value(&mut self, probe: Probe) -> Option<R> {
        match probe {
            Probe::Coordinate(i) => Some(self.view.q[i]),
            Probe::Rate(i) => Some(self.view.v[i]),
            Probe::Frame(quantity, frame, component) if is_of_pose_or_twist(quantity) => {
                if self.last != Some((quantity, frame)) {
                    self.components = components(self.view, quantity, frame);
                    self.last = Some((quantity, frame));
                }
                Some(self.components[component])
            }
            probe => of_state(self.view, probe),
        }
    }
}

/// Returns true for what [`components`] computes.
#[inline(always)]
fn is_of_pose_or_twist(quantity: FrameQuantity) -> bool {
    use FrameQuantity::{Angles, AngularVelocity, Position, Velocity};
    matches!(quantity, Position | Angles | Velocity | AngularVelocity)
}

#[inline(always)]
fn components<R: Real>(view: &View<'_, R>, quantity: FrameQuantity, frame: usize) -> Vec3<R> {
    let fixed = attached(view.model, frame);
    match quantity {
        FrameQuantity::Position => kinematics::frame_pose(view.scratch, &fixed).pos,
        FrameQuantity::Angles => kinematics::roll_pitch_yaw(&kinematics::frame_pose(view.scratch, &fixed).rot),
        FrameQuantity::Velocity => kinematics::frame_velocity(view.scratch, &fixed).lin,
        _ => kinematics::frame_velocity(view.scratch, &fixed).ang,
    }
}
