//! Builder of a world: model, initial state and method, checked before the first step.

use super::{MethodKind, World};
use crate::error::InvalidParameters;
use crate::ids::JointId;
use crate::integrate::Control;
use crate::model::Model;
use crate::state::State;

/// Base step unless another is set `[s]`.
const DEFAULT_STEP: f64 = 1e-3;

/// Local error allowed in a step of a method with error control unless another is set.
const DEFAULT_ACCURACY: f64 = 1e-6;

/// Builder of a [`World`], made by [`World::builder`]: initial state, method, step size.
///
/// ```
/// use sincro_dynamics::prelude::*;
///
/// # let mut builder = ModelBuilder::new([0.0, 0.0, -9.81]);
/// # let slide = JointSpec::new(JointKind::Prismatic { axis: [0.0, 0.0, 1.0] });
/// # let slide = builder.joint("slide", NodeId::WORLD, Pose::identity(), slide);
/// # let mass = Shape::Sphere { radius: 0.1 }.mass_properties(1000.0);
/// # builder.body("ball", slide, Pose::identity(), BodySpec { mass });
/// # let model = builder.build()?.0;
/// // a ball on a vertical slide, thrown upwards at 4.905 m/s, is back after 1 s
/// let slide = model.names().joint_id("slide").unwrap();
/// let mut world = World::builder(model.clone()).step_size(0.01).velocities(slide, &[4.905]).build()?;
/// for _ in 0..100 {
///     world.step()?;
/// }
/// assert!(world.coordinates(slide)[0].abs() < 1e-12); // [m]
///
/// // everything that is wrong is reported at once
/// assert_eq!(World::builder(model).step_size(-0.01).accuracy(0.0).build().unwrap_err().len(), 2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct WorldBuilder {
    model: Model<f64>,
    state: State<f64>,
    method: MethodKind,
    step_size: f64,
    accuracy: f64,
    tracks_totals: bool,
}

impl WorldBuilder {
    pub(super) fn new(model: Model<f64>) -> Self {
        let state = State::new(&model);
        let (step_size, accuracy) = (DEFAULT_STEP, DEFAULT_ACCURACY);
        Self { model, state, method: MethodKind::Implicit, step_size, accuracy, tracks_totals: true }
    }

    /// Sets the initial state; by default the one of [`State::new`], at rest at coordinates zero.
    #[must_use]
    pub fn state(mut self, state: State<f64>) -> Self {
        self.state = state;
        self
    }

    /// Sets the initial coordinates of a joint, as many as it has: `[rad]`, `[m]`, quaternions (w, x, y, z).
    ///
    /// # Panics
    ///
    /// If the model has no such joint, or the joint another number of coordinates.
    #[must_use]
    pub fn coordinates(mut self, joint: JointId, q: &[f64]) -> Self {
        let info = self.model.names().joint_info(joint);
        self.state.q[info.q_idx..info.q_idx + info.n_q].copy_from_slice(q);
        self
    }

    /// Sets the initial velocities of a joint `[rad/s]` or `[m/s]`, one for each of its degrees of freedom.
    ///
    /// # Panics
    ///
    /// If the model has no such joint, or the joint another number of degrees of freedom.
    #[must_use]
    pub fn velocities(mut self, joint: JointId, v: &[f64]) -> Self {
        let info = self.model.names().joint_info(joint);
        self.state.v[info.v_idx..info.v_idx + info.n_v].copy_from_slice(v);
        self
    }

    /// Sets the integration method; by default [`MethodKind::Implicit`], which is of order 2 and stable for any
    /// stiffness and damping of joints.
    #[must_use]
    pub fn method(mut self, method: MethodKind) -> Self {
        self.method = method;
        self
    }

    /// Sets the base step of [`World::step`] `[s]`, by default 1 ms. A method with error control divides it as needed.
    #[must_use]
    pub fn step_size(mut self, step_size: f64) -> Self {
        self.step_size = step_size;
        self
    }

    /// Sets the local error allowed in a step of a method with error control, relative to max(|y|, 1) (dimensionless);
    /// by default 1e-6. No effect on fixed steps.
    #[must_use]
    pub fn accuracy(mut self, accuracy: f64) -> Self {
        self.accuracy = accuracy;
        self
    }

    /// Leaves out the integrals of work, dissipation and motor impulses ([`State::totals`]), which saves time; they
    /// stay 0.
    #[must_use]
    pub fn without_totals(mut self) -> Self {
        self.tracks_totals = false;
        self
    }

    /// Creates the world and resolves drives and contacts in the initial state.
    ///
    /// # Errors
    ///
    /// [`InvalidParameters`] with one sentence for each fault: a step size or an accuracy that is not positive and
    /// finite, a state whose lists do not fit the model, numbers in it that are not finite.
    pub fn build(self) -> Result<World, InvalidParameters> {
        let problems = self.problems();
        if !problems.is_empty() {
            return Err(InvalidParameters::new(problems));
        }
        let control = Control::new(self.accuracy, self.step_size);
        let mut world = World::with_totals(self.model, self.state, self.method, control, self.tracks_totals);
        let t = world.time();
        world.initialize(t);
        Ok(world)
    }

    fn problems(&self) -> Vec<String> {
        let mut problems = Vec::new();
        for (name, x, unit) in [("step size", self.step_size, " s"), ("accuracy", self.accuracy, "")] {
            if !(x.is_finite() && x > 0.0) {
                problems.push(format!("the {name} is {x}{unit}: expected a positive number"));
            }
        }
        let fitting = State::new(&self.model);
        let lists = |s: &State<f64>| [s.q.len(), s.v.len(), s.commands.len(), s.drives.len()];
        let others = |s: &State<f64>| [s.totals.len(), s.rotors.len()];
        if lists(&self.state) != lists(&fitting) || others(&self.state) != others(&fitting) {
            problems.push("the state was made for another model: its lists have other lengths".to_owned());
        }
        if !self.model.constraints().accepts(&self.state.contacts) {
            problems.push("the state was made for another model: its contacts are none of this one".to_owned());
        }
        if !self.state.q.iter().chain(&self.state.v).chain(&self.state.commands).all(|x| x.is_finite()) {
            problems.push("the initial state has a number that is not finite".to_owned());
        }
        problems
    }
}

#[cfg(test)]
mod tests {
    use crate::prelude::*;

    fn pendulum() -> Model<f64> {
        let mut builder = ModelBuilder::new([0.0, 0.0, -9.81]);
        let joint = JointSpec::new(JointKind::Revolute { axis: [0.0, 1.0, 0.0] });
        let joint = builder.joint("hinge", NodeId::WORLD, Pose::identity(), joint);
        let mass = MassProperties { mass: 1.0, center_of_mass: [0.0, 0.0, -1.0], inertia: [0.0; 6] };
        builder.body("bob", joint, Pose::identity(), BodySpec { mass });
        builder.build().unwrap().0
    }

    #[test]
    fn steps_of_the_builder_s_world_are_those_of_advance() {
        let model = pendulum();
        let hinge = model.names().joint_id("hinge").unwrap();
        let mut stepped = World::builder(model.clone())
            .method(MethodKind::Rk4)
            .step_size(0.01)
            .coordinates(hinge, &[0.5])
            .build()
            .unwrap();
        let mut state = State::new(&model);
        state.q[0] = 0.5;
        let mut advanced = World::new(model, state, MethodKind::Rk4, 1e-6, 0.01);
        advanced.initialize(0.0);
        for k in 0..100 {
            let report = stepped.step().unwrap();
            advanced.advance(f64::from(k) * 0.01, 0.01).unwrap();
            assert_eq!((report.tick, report.statistics.steps), (u64::from(k as u32) + 1, 1));
        }
        assert_eq!(stepped.state, advanced.state);
        assert_eq!(stepped.coordinates(hinge), &advanced.state.q[..]);
    }

    #[test]
    fn everything_wrong_is_said_at_once() {
        let model = pendulum();
        let hinge = model.names().joint_id("hinge").unwrap();
        let error = World::builder(model).step_size(0.0).accuracy(-1.0).coordinates(hinge, &[f64::NAN]).build();
        assert_eq!(error.unwrap_err().len(), 3);
    }

    #[test]
    fn a_step_that_fails_says_when_and_why() {
        let model = pendulum();
        let mut world = World::builder(model).method(MethodKind::SemiImplicitEuler).build().unwrap();
        world.step().unwrap();
        world.state.v[0] = f64::INFINITY;
        let error: Box<dyn std::error::Error> = world.step().unwrap_err().into();
        assert!(error.to_string().starts_with("the world stopped at t = 0.001 s: "), "{error}");
    }
}
