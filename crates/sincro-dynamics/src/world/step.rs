//! One base step of a world at a time, with a report or an error, and access to joints and motors by their ids.

use core::fmt;

use super::{Stop, World, WorldBuilder};
use crate::energy::{Energy, energy_at};
use crate::ids::{JointId, MotorId};
use crate::model::Model;
use crate::world::StepStatistics;

/// Report of one base step, returned by [`World::step`].
///
/// ```
/// use sincro_dynamics::prelude::*;
///
/// # let mut builder = ModelBuilder::new([0.0, 0.0, -9.81]);
/// # let slide = builder.joint("slide", NodeId::WORLD, Pose::identity(), JointSpec::new(JointKind::Free));
/// # let mass = Shape::Sphere { radius: 0.1 }.mass_properties(1000.0);
/// # builder.body("ball", slide, Pose::identity(), BodySpec { mass });
/// # let model = builder.build()?.0;
/// let mut world = World::builder(model).method(MethodKind::DormandPrince).step_size(0.5).build()?;
/// world.step()?;
/// let report = world.step()?;
/// assert_eq!((report.tick, report.t), (2, 1.0));
/// assert!(report.statistics.steps >= 1); // sub-steps that the error control needed in this step
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepReport {
    /// Number of base steps since the start, this one included.
    pub tick: u64,
    /// Time at its end `[s]`.
    pub t: f64,
    /// Statistics of this step alone.
    pub statistics: StepStatistics,
}

/// Error of [`World::step`]: the world stopped within the step. Its state is that of the last instant reached, with
/// finite numbers.
///
/// ```
/// use sincro_dynamics::prelude::*;
///
/// # let mut builder = ModelBuilder::new([0.0, 0.0, -9.81]);
/// # let slide = builder.joint("slide", NodeId::WORLD, Pose::identity(), JointSpec::new(JointKind::Free));
/// # let mass = Shape::Sphere { radius: 0.1 }.mass_properties(1000.0);
/// # builder.body("ball", slide, Pose::identity(), BodySpec { mass });
/// # let model = builder.build()?.0;
/// let mut world = World::builder(model).step_size(0.25).build()?;
/// world.step()?;
/// world.state.v[5] = f64::NAN; // a controller has divided by zero
/// let error = world.step().unwrap_err();
/// assert_eq!(error.t, 0.25); // [s]
/// assert!(error.to_string().starts_with("the world stopped at t = 0.25 s: "));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepError {
    /// Last instant reached `[s]`.
    pub t: f64,
    /// Reason for which it stopped.
    pub reason: Stop,
}

impl fmt::Display for StepError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the world stopped at t = {} s: {}", self.t, self.reason)
    }
}

impl std::error::Error for StepError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        Some(&self.reason)
    }
}

impl fmt::Display for Stop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Integration(failure) => failure.fmt(f),
            Self::Unsolved { residual, .. } => {
                write!(
                    f,
                    "too many constraint problems did not converge, the worst to a relative residual of {residual:.1e}"
                )
            }
            Self::Chatter { .. } => f.write_str("a drive or block had too many events within one tick"),
            Self::EndlessEvents { .. } => f.write_str("events of blocks follow from each other without end"),
        }
    }
}

impl std::error::Error for Stop {}

impl World {
    /// Builder of a world of `model`, which sets initial state, method and step size.
    ///
    /// ```
    /// use sincro_dynamics::prelude::*;
    ///
    /// let mut builder = ModelBuilder::new([0.0, 0.0, -9.81]);
    /// let slide = builder.joint("slide", NodeId::WORLD, Pose::identity(), JointSpec::new(JointKind::Free));
    /// let ball = Shape::Sphere { radius: 0.1 }.mass_properties(1000.0);
    /// builder.body("ball", slide, Pose::identity(), BodySpec { mass: ball });
    /// let mut world = World::builder(builder.build()?.0).step_size(0.01).build()?;
    /// for _ in 0..100 {
    ///     world.step()?;
    /// }
    /// let slide = world.model().names().joint_id("slide").unwrap();
    /// assert!((world.coordinates(slide)[2] + 0.5 * 9.81).abs() < 1e-9); // g t²/2 after one second
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn builder(model: Model<f64>) -> WorldBuilder {
        WorldBuilder::new(model)
    }

    /// Makes one base step under the present commands: [`World::advance`] from [`World::time`] by [`World::step_size`].
    ///
    /// # Errors
    ///
    /// [`StepError`] with time and reason if the method cannot go on; the state is then that of the last instant
    /// reached, and the tick is not counted.
    pub fn step(&mut self) -> Result<StepReport, StepError> {
        let before = self.statistics();
        let (t, h) = (self.time(), self.step_size);
        self.advance(t, h).map_err(|(t, reason)| StepError { t, reason })?;
        Ok(StepReport { tick: self.state.tick, t: self.time(), statistics: self.statistics().since(&before) })
    }

    /// Time of the present state `[s]`: number of ticks times step size.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.state.tick as f64 * self.step_size
    }

    /// Length of the base step of [`World::step`] `[s]`.
    #[must_use]
    pub fn step_size(&self) -> f64 {
        self.step_size
    }

    /// Coordinates of a joint in the present state, as many as it has: `[rad]`, `[m]`, quaternions (w, x, y, z). Panics
    /// if the model has no such joint.
    ///
    /// ```
    /// use sincro_dynamics::prelude::*;
    ///
    /// let mut builder = ModelBuilder::new([0.0, 0.0, -9.81]);
    /// let ball = builder.joint("ball", NodeId::WORLD, Pose::identity(), JointSpec::new(JointKind::Ball));
    /// let mass = Shape::Cuboid { size: [0.1, 0.2, 0.3] }.mass_properties(1000.0);
    /// builder.body("box", ball, Pose::identity(), BodySpec { mass });
    /// let (model, _warnings) = builder.build()?;
    /// let ball = model.names().joint_id("ball").unwrap();
    /// let world = World::builder(model).velocities(ball, &[0.0, 0.0, 1.0]).build()?;
    /// assert_eq!(world.coordinates(ball), [1.0, 0.0, 0.0, 0.0]); // no rotation: w = 1
    /// assert_eq!(world.velocities(ball), [0.0, 0.0, 1.0]); // [rad/s], child axes
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn coordinates(&self, joint: JointId) -> &[f64] {
        let info = self.model().names().joint_info(joint);
        &self.state.q[info.q_idx..info.q_idx + info.n_q]
    }

    /// Velocities of a joint in the present state `[rad/s]`, `[m/s]`, one for each of its degrees of freedom, in the
    /// order that [`JointKind`](crate::joint::JointKind) gives. Panics if the model has no such joint.
    #[must_use]
    pub fn velocities(&self, joint: JointId) -> &[f64] {
        let info = self.model().names().joint_info(joint);
        &self.state.v[info.v_idx..info.v_idx + info.n_v]
    }

    /// Sets the command of a motor, in the unit of its [`MotorMode`](crate::actuation::MotorMode); it acts from the
    /// next step on. Panics if the model has no such motor.
    pub fn set_command(&mut self, motor: MotorId, command: f64) {
        self.state.commands[motor.index()] = command;
    }

    /// Kinetic and potential energy in the present state `[J]`, that of windings included; computed anew by each call.
    pub fn energy(&mut self) -> Energy<f64> {
        let mechanism = &mut self.mechanism;
        energy_at(&mechanism.model, &self.state.q, &self.state.v, &mut mechanism.scratch)
            .with_stored(mechanism.model.magnetic_energy(&self.state.rotors))
    }
}

impl StepStatistics {
    /// Difference to earlier statistics of the same world.
    fn since(&self, before: &Self) -> Self {
        Self {
            steps: self.steps - before.steps,
            events: self.events - before.events,
            impacts: self.impacts - before.impacts,
            fallback_ticks: self.fallback_ticks - before.fallback_ticks,
            fallback_steps: self.fallback_steps - before.fallback_steps,
            fallback_square: self.fallback_square - before.fallback_square,
            undecided_modes: self.undecided_modes - before.undecided_modes,
            event_work: self.event_work - before.event_work,
        }
    }
}
