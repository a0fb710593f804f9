//! Outputs of a world at one instant.

use super::{SAME_INSTANT, World};
use crate::actuation::DriveKind;
use crate::constraint::ContactPoint;
use crate::energy::{Energy, energy, momentum};
use crate::ids::JointId;
use crate::mechanism::Mechanism;
use crate::model::Model;
use crate::scratch::Scratch;
use crate::spatial::Force;
use crate::state::State;

/// Outputs of a world at one instant, from [`World::observe`]: accelerations, kinematics, forces. The world cannot
/// change while it is held.
#[derive(Clone, Copy, Debug)]
pub struct Observation<'a> {
    /// State of the world.
    pub state: &'a State<f64>,
    /// Accelerations (n_v) `[rad/s²]` or `[m/s²]`.
    pub accelerations: &'a [f64],
    pub(super) mechanism: &'a Mechanism<f64>,
    /// Target velocity of each drive in the tick that ends here.
    pub(super) target_velocities: &'a [f64],
    /// True if the state is that at the end of a tick, and nothing has been changed from outside since.
    pub(super) is_settled: bool,
    /// True if no input jumps at this instant.
    pub(super) inputs_are_continuous: bool,
}

impl Observation<'_> {
    /// Model of the world.
    #[must_use]
    pub fn model(&self) -> &Model<f64> {
        self.mechanism.model()
    }

    /// Smooth torque of each motor `[N·m]` or `[N]`, in the order of [`Model::motors`]; impacts left out.
    #[must_use]
    pub fn motor_torque(&self) -> &[f64] {
        self.mechanism.motor_torque()
    }

    /// Torque `[N·m]` or force `[N]` of Coulomb friction on degree of freedom `dof` (0 to n_v − 1); 0 if it has no
    /// friction.
    #[must_use]
    pub fn friction_torque(&self, dof: usize) -> f64 {
        let drives = self.model().drives();
        let friction = drives.iter().position(|d| d.dof == dof && d.kind == DriveKind::Friction);
        friction.map_or(0.0, |i| self.mechanism.friction_torque(i, self.state.v[dof]))
    }

    /// Contact points of this instant with their forces.
    pub fn contacts(&self) -> impl Iterator<Item = ContactPoint> {
        contacts_of(self.mechanism)
    }

    /// Position residual of loop joint `k`, or of gear `k` less the number of loop joints: distance of the ends `[m]`,
    /// of a gear in the unit of its second joint. Panics if there is neither.
    #[must_use]
    pub fn residual(&self, k: usize) -> f64 {
        let set = self.model().constraints();
        match set.loop_joints.get(k) {
            Some(joint) => joint.residual(self.scratch()).0,
            None => set.gears[k - set.loop_joints.len()].residual(&self.state.q).abs(),
        }
    }

    /// Wrench of the parent of a joint on its child, whatever transmits it: torque `[N·m]` about the origin of the
    /// joint frame of the child and force `[N]`, in the axes of the joint frame of the parent. Costs a pass over what
    /// is beyond it.
    ///
    /// # Panics
    ///
    /// If the model has no such joint.
    #[must_use]
    pub fn joint_wrench(&self, joint: JointId) -> Force<f64> {
        self.mechanism.joint_wrench(self.model().names().joint_info(joint))
    }

    /// Torque `[N·m]` or force `[N]` of the joint limits on degree of freedom `dof` (0 to n_v − 1); 0 if none is
    /// reached.
    #[must_use]
    pub fn limit_torque(&self, dof: usize) -> f64 {
        self.mechanism.constraints.as_deref().map_or(0.0, |c| c.limit_torque(self.model(), dof))
    }

    /// Poses, twists and accelerations of the links, for the functions of [`kinematics`](crate::kinematics).
    #[must_use]
    pub fn scratch(&self) -> &Scratch<f64> {
        &self.mechanism.scratch
    }

    /// Kinetic and potential energy `[J]`, that of windings included.
    #[must_use]
    pub fn energy(&self) -> Energy<f64> {
        energy(self.model(), &self.state.q, &self.state.v, self.scratch())
            .with_stored(self.model().magnetic_energy(&self.state.rotors))
    }

    /// Momentum of all bodies about the world's origin, in world axes: angular `[kg·m²/s]`, linear `[kg·m/s]`.
    #[must_use]
    pub fn momentum(&self) -> Force<f64> {
        momentum(self.model(), self.scratch())
    }
}

pub(super) fn contacts_of(mechanism: &Mechanism<f64>) -> impl Iterator<Item = ContactPoint> {
    let constraints = mechanism.constraints.as_deref();
    constraints.into_iter().flat_map(|c| c.points(mechanism.model(), &mechanism.scratch))
}

impl World {
    /// Computes accelerations, forces and kinematics in the present state at time `t` `[s]`, and returns them.
    ///
    /// ```
    /// use sincro_dynamics::prelude::*;
    ///
    /// # let mut builder = ModelBuilder::new([0.0, 0.0, -9.81]);
    /// # let base = builder.joint("base", NodeId::WORLD, Pose::identity(), JointSpec::new(JointKind::Free));
    /// # let mass = Shape::Sphere { radius: 0.1 }.mass_properties(1000.0);
    /// # builder.body("ball", base, Pose::identity(), BodySpec { mass });
    /// # let model = builder.build()?.0;
    /// let mut world = World::builder(model).build()?; // a ball in free fall
    /// let observation = world.observe(0.0);
    /// assert!((observation.accelerations[5] + 9.81).abs() < 1e-12); // three angular, three linear [m/s²]
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn observe(&mut self, t: f64) -> Observation<'_> {
        self.rates(t);
        self.mechanism.update_kinematics(&self.state, &self.accelerations);
        self.observation(t)
    }

    /// Outputs as last computed.
    pub(super) fn observation(&self, t: f64) -> Observation<'_> {
        let next_jump = self.model().next_time_event(t - 2.0 * SAME_INSTANT);
        Observation {
            state: &self.state,
            accelerations: &self.accelerations,
            mechanism: &self.mechanism,
            target_velocities: &self.target_velocities,
            is_settled: self.settled_at == Some(self.state.tick),
            inputs_are_continuous: next_jump > t + SAME_INSTANT && !self.mechanism.has_external_forces(),
        }
    }
}
