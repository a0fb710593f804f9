//! Transfer of state and parameters from one model to another one that holds the same objects and others: a mechanism
//! whose structure changes between two steps.
//!
//! Everything is found by name. Coordinates, velocities, modes, currents, totals and the warm start of contacts of what
//! both models have are kept. Where bodies were joined or parted, velocities follow from the momenta of the bodies, as
//! in a perfectly inelastic impact:
//!
//! ```text
//! M v⁺ = Σ J_bᵀ h_b          h_b: momentum of body b before, J_b: its Jacobian in the new model
//! ```
//!
//! so that momentum along every new degree of freedom is conserved and kinetic energy can only be lost. Source: key
//! `featherstone2008`, section 11.7 (impulsive dynamics). Cost: bodies × degrees of freedom.

mod momentum;
mod numbers;
mod slots;

use crate::energy::{Energy, energy_at, momentum as momentum_of};
use crate::model::Model;
use crate::scratch::Scratch;
use crate::spatial::Vec3;
use crate::state::State;

/// Object of the former model that an object of the new model continues or is a copy of.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Origin {
    /// Name in the former model.
    pub name: String,
    /// True if it is the same object, which keeps its velocity and everything else that it remembers; false for a copy,
    /// which has its coordinates and parameters, and starts at rest.
    pub is_same: bool,
}

/// State of a new model, made from that of a former one by [`transfer`].
#[derive(Clone, Debug)]
pub struct Transferred {
    /// State of the new model.
    pub state: State<f64>,
    /// Former command of each command of the new model; `None` for what is new.
    pub commands: Vec<Option<usize>>,
    /// Linear momentum of all bodies after less before `[kg·m/s]`, world axes: what was brought in or taken out by the
    /// change.
    pub momentum_change: Vec3<f64>,
    /// Angular momentum of all bodies about the world's origin after less before `[kg·m²/s]`, world axes.
    pub angular_momentum_change: Vec3<f64>,
    /// Kinetic and potential energy after less before `[J]`.
    pub energy_change: f64,
    /// Kinetic energy lost by joining bodies that moved relative to each other `[J]`.
    pub joining_loss: f64,
}

/// Transfers state and parameters of a former model (`from`) to the model `to`, whose state is `initial` for all that
/// is new. `origin` gives what an object of the new model continues, by its name there; names that it does not know are
/// new. With `conserves_momentum` velocities of bodies that were joined or parted follow from their momenta; without it
/// all joints keep their velocities: objects were put elsewhere.
///
/// ```
/// use sincro_dynamics::prelude::*;
/// use sincro_dynamics::transfer::{Origin, transfer};
///
/// let ball = || BodySpec { mass: Shape::Sphere { radius: 0.1 }.mass_properties(1000.0) };
/// let mut apart = ModelBuilder::new([0.0; 3]);
/// let mut joined = ModelBuilder::new([0.0; 3]);
/// for name in ["a", "b"] {
///     let base = apart.joint(&format!("{name}'s"), NodeId::WORLD, Pose::identity(), JointSpec::new(JointKind::Free));
///     apart.body(name, base, Pose::identity(), ball());
/// }
/// let base = joined.joint("a's", NodeId::WORLD, Pose::identity(), JointSpec::new(JointKind::Free));
/// let a = joined.body("a", base, Pose::identity(), ball());
/// joined.body("b", a, Pose::translation(Vec3([1.0, 0.0, 0.0])), ball());
/// let (apart, mut joined) = (apart.build()?.0, joined.build()?.0);
/// let mut before = State::new(&apart);
/// before.q[7] = 1.0; // b is at x = 1 m
/// before.v[9] = 2.0; // and moves along x with 2 m/s
/// let same = |name: &str| Some(Origin { name: name.to_owned(), is_same: true });
/// let initial = State::new(&joined);
/// let after = transfer((&apart, &before), (&mut joined, initial), &same, true);
/// assert!((after.state.v[3] - 1.0).abs() < 1e-12); // both with half of it
/// assert!(after.momentum_change.norm() < 1e-12 && after.joining_loss > 0.0);
/// # Ok::<(), BuildError>(())
/// ```
#[must_use]
pub fn transfer(
    from: (&Model<f64>, &State<f64>),
    to: (&mut Model<f64>, State<f64>),
    origin: &dyn Fn(&str) -> Option<Origin>,
    conserves_momentum: bool,
) -> Transferred {
    let (former, before) = from;
    let (model, initial) = to;
    let names = numbers::Correspondence::new(former, model, origin);
    numbers::transfer_params(former, model, &names);
    let mut state = numbers::transfer_state((former, before), (model, initial), &names);
    state.contacts = slots::transfer_contacts((former, before), (model, std::mem::take(&mut state.contacts)), origin);
    let mut joining_loss = 0.0;
    if conserves_momentum {
        joining_loss = momentum::conserve((former, before), (model, &mut state), &names);
    }
    let (old, new) = (Motion::of(former, before), Motion::of(model, &state));
    Transferred {
        state,
        commands: names.commands,
        momentum_change: new.linear - old.linear,
        angular_momentum_change: new.angular - old.angular,
        energy_change: new.energy.total() - old.energy.total(),
        joining_loss,
    }
}

/// Momentum and energy of a state.
struct Motion {
    linear: Vec3<f64>,
    angular: Vec3<f64>,
    energy: Energy<f64>,
}

impl Motion {
    fn of(model: &Model<f64>, state: &State<f64>) -> Self {
        let mut scratch = Scratch::new(model);
        let energy = energy_at(model, &state.q, &state.v, &mut scratch);
        let momentum = momentum_of(model, &scratch);
        Self { linear: momentum.lin, angular: momentum.ang, energy }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::joint::JointKind;
    use crate::model::{BodySpec, GearSpec, JointSpec, ModelBuilder, NodeId};
    use crate::spatial::Pose;

    /// Two wheels, of which the second follows the first.
    fn geared(ratio: f64, higher: [f64; 3]) -> Model<f64> {
        let mut builder = ModelBuilder::new([0.0; 3]);
        let joints = ["first", "second"].map(|name| {
            let kind = JointKind::Revolute { axis: [0.0, 0.0, 1.0] };
            let joint = builder.joint(name, NodeId::WORLD, Pose::identity(), JointSpec::new(kind));
            let mass = crate::model::Shape::Sphere { radius: 0.1 }.mass_properties(1000.0);
            builder.body(&format!("{name} wheel"), joint, Pose::identity(), BodySpec { mass });
            joint
        });
        builder.gear("gear", GearSpec { joints, ratio, offset: 0.0, higher });
        builder.build().unwrap().0
    }

    #[test]
    fn the_ratio_of_a_coupling_stays_with_its_polynomial() {
        let same = |name: &str| Some(Origin { name: name.to_owned(), is_same: true });
        let set = |model: &mut Model<f64>| Arc::make_mut(&mut model.params.constraints).gears[0].offset = 0.3;
        for (higher, offset) in [([0.5, 0.0, 0.0], 0.3), ([0.0; 3], 0.0), ([0.5, 0.0, 0.1], 0.0)] {
            let (mut former, mut model) = (geared(2.0, [0.5, 0.0, 0.0]), geared(3.0, higher));
            set(&mut former);
            let (before, initial) = (State::new(&former), State::new(&model));
            let _ = transfer((&former, &before), (&mut model, initial), &same, false);
            let gear = &model.constraints().gears[0];
            let ratio = if offset == 0.0 { 3.0 } else { 2.0 };
            assert_eq!((gear.ratio, gear.offset, gear.higher), (ratio, offset, higher));
        }
    }
}
