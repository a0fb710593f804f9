//! Motors on joints with several degrees of freedom: ball, free, planar and universal joints.

use sincro_dynamics::actuation::{Motor, MotorMode};
use sincro_dynamics::joint::JointKind;
use sincro_dynamics::model::{BodySpec, JointSpec, MassProperties, Model, ModelBuilder, NodeId};
use sincro_dynamics::signal::Signal;
use sincro_dynamics::spatial::{Pose, Quat, Vec3};
use sincro_dynamics::state::State;
use sincro_dynamics::world::{MethodKind, World};

use crate::mechanisms::{ALL, run};

/// A body of 2 kg on one joint, its centre of mass in the joint frame.
fn body(kind: JointKind, inertia: [f64; 3], motor: Vec<Motor<f64>>, torque: Vec<Signal>) -> Model<f64> {
    let mut b = ModelBuilder::new([0.0; 3]);
    let joint = JointSpec { motor, torque, ..JointSpec::new(kind) };
    let joint = b.joint("joint", NodeId::WORLD, Pose::identity(), joint);
    let [xx, yy, zz] = inertia;
    let mass = MassProperties { mass: 2.0, center_of_mass: [0.0; 3], inertia: [xx, 0.0, 0.0, yy, 0.0, zz] };
    b.body("body", joint, Pose::identity(), BodySpec { mass });
    b.build().unwrap().0
}

fn motors(mode: MotorMode, limits: &[f64]) -> Vec<Motor<f64>> {
    limits.iter().map(|&max_torque| Motor { max_torque, ..Motor::new(mode) }).collect()
}

#[test]
fn velocity_motors_of_a_ball_joint_turn_it_about_a_fixed_axis() {
    let (inertia, omega) = ([0.3, 0.5, 0.7], [1.0, -2.0, 0.5]);
    for kind in ALL {
        let model = body(JointKind::Ball, inertia, motors(MotorMode::Velocity, &[f64::INFINITY; 3]), Vec::new());
        let mut x = State::new(&model);
        x.commands.copy_from_slice(&omega);
        let mut world = World::new(model, x, kind, 1e-10, 1e-3);
        run(&mut world, 0.01, 100);
        assert_eq!(world.state.v, omega, "{kind:?}");
        let turned = Quat::exp(Vec3(omega));
        let [x, y, z] = turned.xyz.0;
        let (q, expected) = (&world.state.q, [turned.w, x, y, z]);
        let apart = (0..4).map(|k| (q[k] - expected[k]).abs()).fold(0.0, f64::max);
        assert!(apart < 1e-12, "{kind:?} {apart:e}");
        // the motors give what Euler's equations ask for: ω × Iω, from the rates of their impulses
        let before = world.state.totals.clone();
        world.advance(1.0, 0.01).unwrap();
        let momentum = Vec3(std::array::from_fn(|k| inertia[k] * omega[k]));
        let torque = Vec3(omega).cross(momentum);
        for k in 0..3 {
            let mean = (world.state.totals[2 + k] - before[2 + k]) / 0.01;
            assert!((mean - torque[k]).abs() < 1e-11, "{kind:?} {k}: {mean} {}", torque[k]);
        }
    }
}

#[test]
fn velocity_motors_of_a_free_joint_drive_it_along_a_screw() {
    let (inertia, twist) = ([0.3, 0.5, 0.7], [0.6, -1.2, 0.8, 1.0, 0.4, -0.5]);
    let end = |kind| {
        let model = body(JointKind::Free, inertia, motors(MotorMode::Velocity, &[f64::INFINITY; 6]), Vec::new());
        let mut x = State::new(&model);
        x.commands.copy_from_slice(&twist);
        let mut world = World::new(model, x, kind, 1e-10, 1e-3);
        run(&mut world, 1e-3, 1000);
        assert_eq!(world.state.v, twist, "{kind:?}");
        world.state.q
    };
    let truth = end(MethodKind::DormandPrince);
    for kind in ALL {
        let bound = match kind {
            MethodKind::SemiImplicitEuler => 1e-3,
            MethodKind::Implicit => 1e-6,
            _ => 1e-9,
        };
        let apart = end(kind).iter().zip(&truth).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(apart < bound, "{kind:?}: {apart:e}");
    }
}

#[test]
fn limited_motors_of_a_ball_joint_reach_their_velocities_one_after_the_other() {
    // the inertia of a sphere has no gyroscopic torque: each axis speeds up by itself
    let (inertia, limits, targets) = (0.4, [0.2, 0.5, 1.0], [0.3, -0.6, 0.9]);
    for kind in [
        MethodKind::Rk4,
        MethodKind::Implicit,
        MethodKind::DormandPrince,
        MethodKind::DormandPrince8,
        MethodKind::Stiff,
    ] {
        let model = body(JointKind::Ball, [inertia; 3], motors(MotorMode::Velocity, &limits), Vec::new());
        let mut x = State::new(&model);
        x.commands.copy_from_slice(&targets);
        let mut world = World::new(model, x, kind, 1e-10, 0.05);
        for tick in 1..=20 {
            world.advance(f64::from(tick - 1) * 0.05, 0.05).unwrap();
            let t = f64::from(tick) * 0.05;
            for k in 0..3 {
                let expected = targets[k].signum() * (limits[k] / inertia * t).min(targets[k].abs());
                assert!((world.state.v[k] - expected).abs() < 1e-12, "{kind:?} {t} {k}: {:?}", world.state.v);
            }
        }
    }
}

#[test]
fn torque_motors_of_a_free_joint_are_applied_torques_in_child_axes() {
    let loads = [0.1, -0.2, 0.3, 1.0, 2.0, -3.0];
    let commanded = body(JointKind::Free, [0.3, 0.5, 0.7], motors(MotorMode::Torque, &[2.5; 6]), Vec::new());
    // the last one is limited
    let applied = loads.map(|x: f64| Signal::Constant(x.max(-2.5))).to_vec();
    let applied = body(JointKind::Free, [0.3, 0.5, 0.7], Vec::new(), applied);
    let end = |model: Model<f64>, commands: &[f64]| {
        let mut x = State::new(&model);
        x.commands.copy_from_slice(commands);
        x.v.copy_from_slice(&[1.0, 2.0, 3.0, 0.1, 0.2, 0.3]);
        let mut world = World::new(model, x, MethodKind::DormandPrince, 1e-10, 0.01);
        run(&mut world, 0.01, 100);
        let power = world.state.totals[0];
        (world.state.q.clone(), world.state.v.clone(), power)
    };
    let (one, two) = (end(commanded, &loads), end(applied, &[]));
    assert_eq!((one.0, one.1), (two.0, two.1));
    assert!((one.2 - two.2).abs() < 1e-12 * two.2.abs(), "{} {}", one.2, two.2);
}

#[test]
fn position_motors_of_planar_and_universal_joints_settle_at_their_commands() {
    let universal = JointKind::Universal { axis: [1.0, 0.0, 0.0], axis2: [0.0, 1.0, 0.0] };
    for (kind, n) in [(JointKind::Planar, 3), (universal, 2)] {
        let servo = Motor { kp: 4.0, ..Motor::new(MotorMode::Position) };
        let model = body(kind, [0.3, 0.5, 0.7], vec![servo; n], Vec::new());
        let mut x = State::new(&model);
        let commands = [0.2, -0.3, 0.4];
        x.commands.copy_from_slice(&commands[..n]);
        let mut world = World::new(model, x, MethodKind::DormandPrince, 1e-10, 0.01);
        run(&mut world, 0.01, 100);
        for k in 0..n {
            // latched every tick: q⁺ = q + h kp (c − q)
            let expected = (0..100).fold(0.0, |q, _| q + 0.01 * 4.0 * (commands[k] - q));
            assert!((world.state.q[k] - expected).abs() < 1e-13, "{kind:?} {k} {:?}", world.state.q);
        }
    }
}

#[test]
fn motors_of_several_axes_are_checked() {
    let build = |kind: JointKind, motor: Vec<Motor<f64>>| {
        let mut b = ModelBuilder::new([0.0; 3]);
        let joint = JointSpec { motor, ..JointSpec::new(kind) };
        let joint = b.joint("joint", NodeId::WORLD, Pose::identity(), joint);
        let mass = MassProperties { mass: 2.0, center_of_mass: [0.0; 3], inertia: [1.0, 0.0, 0.0, 1.0, 0.0, 1.0] };
        b.body("body", joint, Pose::identity(), BodySpec { mass });
        b.build().map(|_| ()).map_err(|e| e.to_string()).unwrap_err()
    };
    let one = build(JointKind::Ball, motors(MotorMode::Torque, &[1.0]));
    assert!(one.contains("joint `joint` has 3 degrees of freedom and 1 motors"), "{one}");
    let servo = build(JointKind::Free, vec![Motor { kp: 1.0, ..Motor::new(MotorMode::Position) }; 6]);
    assert!(servo.contains("orientation of the joint is no list of positions"), "{servo}");
}
