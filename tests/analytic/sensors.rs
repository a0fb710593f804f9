//! Force sensors that carry nothing but joints.

use sincro_dynamics::joint::JointKind;
use sincro_dynamics::model::{BodySpec, JointSpec, MassProperties, Model, ModelBuilder, NodeId};
use sincro_dynamics::spatial::{Pose, Vec3};
use sincro_dynamics::state::State;
use sincro_dynamics::world::{MethodKind, World};

use sincro_math::elementary::sin_cos;

use crate::mechanisms::run;

/// A pendulum of 2 kg, 0.5 m long, with or without a force sensor between its hinge and the world.
fn pendulum(has_sensor: bool) -> Model<f64> {
    let mut b = ModelBuilder::new([0.0, 0.0, -9.81]);
    let cell = JointSpec { sensor: has_sensor, ..JointSpec::new(JointKind::Fixed) };
    let cell = b.joint("cell", NodeId::WORLD, Pose::identity(), cell);
    let hinge = JointSpec::new(JointKind::Revolute { axis: [0.0, 1.0, 0.0] });
    let hinge = b.joint("hinge", cell, Pose::identity(), hinge);
    let mass = MassProperties { mass: 2.0, center_of_mass: [0.0; 3], inertia: [0.1, 0.0, 0.0, 0.1, 0.0, 0.01] };
    b.body("rod", hinge, Pose::translation(Vec3([0.0, 0.0, -0.5])), BodySpec { mass });
    b.build().unwrap().0
}

#[test]
fn a_force_sensor_may_carry_joints_alone() {
    let [mut with, without] = [true, false].map(|has_sensor| {
        let model = pendulum(has_sensor);
        let mut x = State::new(&model);
        *x.q.last_mut().unwrap() = 0.5;
        let mut world = World::new(model, x, MethodKind::DormandPrince, 1e-11, 1e-3);
        run(&mut world, 0.01, 100);
        world
    });
    let last = |list: &[f64]| *list.last().unwrap();
    let (angle, rate) = (last(&with.state.q), last(&with.state.v));
    assert!((angle - without.state.q[0]).abs() < 1e-9 && (rate - without.state.v[0]).abs() < 1e-9);
    // force on the hinge: gravity and the acceleration of the centre of mass at (−L sin θ, −L cos θ)
    let (m, length) = (2.0, 0.5);
    let acceleration = last(with.rates(1.0).0);
    let (sin, cos) = sin_cos(angle);
    let along = [-length * (acceleration * cos - rate * rate * sin), length * (acceleration * sin + rate * rate * cos)];
    let force = [3, 5].map(|k| with.reaction(k));
    assert!((force[0] - m * along[0]).abs() < 1e-9, "{force:?}");
    assert!((force[1] - m * (along[1] + 9.81)).abs() < 1e-9, "{force:?}");
    assert!(with.reaction(1).abs() < 1e-9);
}
