//! Reactions of joints and nonlinear joint springs, against the figures of MSC ADAMS that come with Project Chrono's
//! unit tests (six digits), and against identities.
//!
//! The bar of the cases: 1 kg, 4 m, inertia 0.04, 0.1, 0.1 kg·m², released at rest in a gravity of 9.80665 m/s². The
//! figures are forces of the child on the joint, world axes.

use std::sync::Arc;

use sincro_dynamics::actuation::{Motor, MotorMode, NonlinearLaw};
use sincro_dynamics::constraint::LoopJointKind;
use sincro_dynamics::joint::JointKind;
use sincro_dynamics::model::{BodySpec, JointSpec, LoopJointSpec, MassProperties, Model, ModelBuilder, NodeId, Shape};
use sincro_dynamics::spatial::{Mat3, Pose, Quat, Vec3};
use sincro_dynamics::state::State;
use sincro_dynamics::world::{MethodKind, World};
use sincro_math::expression::Expression;

use crate::mechanisms::{run, zoo};

const GRAVITY: [f64; 3] = [0.0, 0.0, -9.80665];
const QUARTER: f64 = core::f64::consts::FRAC_PI_4;

fn bar(moments: [f64; 3]) -> BodySpec {
    let [x, y, z] = moments;
    BodySpec { mass: MassProperties { mass: 1.0, center_of_mass: [0.0; 3], inertia: [x, 0.0, 0.0, y, 0.0, z] } }
}

/// A bar on joints of a frame at `place`, turned by `turn`; `com` is its centre of mass in the world at zero
/// coordinates, its axes are the world's.
fn pendulum(kinds: &[JointSpec], place: [f64; 3], turn: [f64; 3], com: [f64; 3], moments: [f64; 3]) -> Model<f64> {
    let mut b = ModelBuilder::new(GRAVITY);
    let frame = Pose { rot: Quat::exp(Vec3(turn)).matrix(), pos: Vec3(place) };
    let (mut parent, mut pose) = (NodeId::WORLD, frame);
    for (k, spec) in kinds.iter().enumerate() {
        parent = b.joint(&format!("joint{k}"), parent, pose, spec.clone());
        pose = Pose::identity();
    }
    let in_joint = frame.rot.tr_mul_vec(Vec3(com) - Vec3(place));
    b.body("bar", parent, Pose { rot: frame.rot.transpose(), pos: in_joint }, bar(moments));
    b.build().unwrap().0
}

struct Seen {
    com: Vec3<f64>,
    angular_velocity: Vec3<f64>,
    /// Force of the child on the joint, world axes.
    reaction: Vec3<f64>,
}

fn seen(world: &mut World, t: f64) -> Seen {
    let model = world.model().clone();
    let joint = &model.names().joints[model.names().joints.len() - 1];
    let id = model.names().joint_id(&joint.name).unwrap();
    let observation = world.observe(t);
    let frame = |name: &str| model.names().frame(name).unwrap();
    let scratch = observation.scratch();
    let body = frame("bar");
    let attached = sincro_dynamics::kinematics::Attached { link: body.link, pose: body.pose };
    let turn: Mat3<f64> = sincro_dynamics::kinematics::frame_pose(scratch, &joint.base).rot;
    Seen {
        com: sincro_dynamics::kinematics::frame_pose(scratch, &attached).pos,
        angular_velocity: sincro_dynamics::kinematics::frame_velocity(scratch, &attached).ang,
        reaction: -turn.mul_vec(observation.joint_wrench(id).lin),
    }
}

/// Runs to each instant and compares centre of mass, angular velocity and reaction with the figures.
fn compare(model: Model<f64>, figures: &[(f64, [[f64; 3]; 3])]) {
    let x = State::new(&model);
    let mut world = World::new(model, x, MethodKind::DormandPrince, 1e-11, 1e-3);
    let mut done = 0;
    for (t, expected) in figures {
        let end = (t * 100.0).round() as u32;
        for k in done..end {
            world.advance(f64::from(k) * 0.01, 0.01).unwrap();
        }
        done = end;
        let found = seen(&mut world, *t);
        for (what, (found, figure)) in
            [found.com, found.angular_velocity, found.reaction].into_iter().zip(expected).enumerate()
        {
            // the program that made the figures keeps about five digits
            let scale = Vec3(*figure).norm().max(1.0);
            assert!((found - Vec3(*figure)).norm() < 1e-4 * scale, "{t} s, {what}: {found:?} for {figure:?}");
        }
    }
}

fn revolute(axis: [f64; 3]) -> JointSpec {
    JointSpec::new(JointKind::Revolute { axis })
}

const SLENDER: [f64; 3] = [0.04, 0.1, 0.1];

#[test]
fn a_revolute_joint_reacts_as_that_of_adams() {
    let model = pendulum(&[revolute([0.0, 1.0, 0.0])], [0.0; 3], [0.0; 3], [2.0, 0.0, 0.0], SLENDER);
    // at the start −m g I/(I + m l²)
    let mut world = World::new(model.clone(), State::new(&model), MethodKind::DormandPrince, 1e-9, 1e-3);
    let start = seen(&mut world, 0.0).reaction;
    assert!((start[2] + 9.80665 * 0.1 / 4.1).abs() < 1e-12, "{start:?}");
    compare(
        model,
        &[
            (0.5, [[1.66081, 0.0, -1.11432], [0.0, 2.30881, 0.0], [13.2797, 0.0, -9.14925]]),
            (1.0, [[-0.892_381, 0.0, -1.78988], [0.0, 2.92614, 0.0], [-11.4612, 0.0, -23.2273]]),
            (2.0, [[-1.95112, 0.0, -0.439_479], [0.0, -1.44995, 0.0], [-6.15295, 0.0, -1.62512]]),
            (5.0, [[-1.99968, 0.0, -0.035_558_7], [0.0, 0.412_436, 0.0], [-0.510_225, 0.0, -0.248_259]]),
        ],
    );
}

#[test]
fn a_skew_revolute_joint_reacts_as_that_of_adams() {
    let turn = [-QUARTER, 0.0, 0.0];
    let model = pendulum(&[revolute([0.0, 0.0, 1.0])], [1.0, 2.0, 3.0], turn, [3.0, 2.0, 3.0], SLENDER);
    compare(
        model,
        &[
            (0.5, [[2.82591, 2.57708, 2.42292], [0.0, 1.17487, 1.17487], [7.56095, -2.39407, -7.41259]]),
            (1.0, [[1.04210, 3.41390, 1.58610], [0.0, 1.83898, 1.83898], [0.427_164, 9.56081, -19.3673]]),
            (5.0, [[1.20996, 3.40640, 1.59360], [0.0, 1.83410, 1.83410], [2.11895, 9.40977, -19.2164]]),
        ],
    );
}

#[test]
fn a_universal_joint_reacts_as_that_of_adams() {
    let turn = [core::f64::consts::FRAC_PI_2, 0.0, 0.0];
    let kind = JointKind::Universal { axis: [1.0, 0.0, 0.0], axis2: [0.0, 1.0, 0.0] };
    let model = pendulum(&[JointSpec::new(kind)], [0.0; 3], turn, [0.0, 2.0, 0.0], [0.1, 0.04, 0.1]);
    compare(model, &[(1.0, [[0.0, -0.892_369, -1.78988], [-2.92608, 0.0, 0.0], [0.0, -11.4609, -23.2270]])]);
}

#[test]
fn a_prismatic_joint_reacts_as_that_of_adams() {
    let slide = JointSpec::new(JointKind::Prismatic { axis: [0.0, 0.0, 1.0] });
    let model = pendulum(&[slide], [1.0, 2.0, 3.0], [-QUARTER, 0.0, 0.0], [3.0, 2.0, 3.0], SLENDER);
    let reaction = [0.0, 4.90332, -4.90332];
    compare(
        model,
        &[
            (1.0, [[3.0, -0.451_662, 0.548_338], [0.0; 3], reaction]),
            (5.0, [[3.0, -59.2916, -58.2916], [0.0; 3], reaction]),
        ],
    );
}

#[test]
fn a_cylindrical_joint_reacts_as_that_of_adams() {
    let slide = JointSpec::new(JointKind::Prismatic { axis: [0.0, 0.0, 1.0] });
    let kinds = [slide, revolute([0.0, 0.0, 1.0])];
    let model = pendulum(&kinds, [1.0, 2.0, 3.0], [-QUARTER, 0.0, 0.0], [3.0, 2.0, 3.0], SLENDER);
    compare(
        model,
        &[
            (1.0, [[1.04210, 0.962_238, -0.865_563], [0.0, 1.83898, 1.83898], [0.427_153, 14.4646, -14.4646]]),
            (5.0, [[1.20996, -57.8852, -59.698], [0.0, 1.83410, 1.83410], [2.11887, 14.3128, -14.3128]]),
        ],
    );
}

#[test]
fn a_rotary_spring_and_damper_moves_as_that_of_adams() {
    let spec = JointSpec { spring: vec![(200.0, 0.0)], damping: vec![10.0], ..revolute([0.0, 1.0, 0.0]) };
    let model = pendulum(&[spec], [0.0; 3], [0.0; 3], [2.0, 0.0, 0.0], SLENDER);
    compare(
        model,
        &[
            (0.5, [[1.97729, 0.0, -0.300_513], [0.0, -0.115_866, 0.0], [-0.678_432, 0.0, -14.4483]]),
            (1.0, [[1.99492, 0.0, -0.142_445], [0.0, 0.120_178, 0.0], [0.171_096, 0.0, -7.81128]]),
            (5.0, [[1.99044, 0.0, -0.195_325], [0.0, 8.0e-6, 0.0], [-0.0021, 0.0, -9.82814]]),
        ],
    );
}

#[test]
fn a_nonlinear_rotary_spring_moves_as_that_of_adams() {
    let formula = Expression::parse("-(50 + 10*abs(x))*x", &["x", "v"]).unwrap();
    let law = Arc::new(NonlinearLaw::formula(formula).unwrap());
    let spec = JointSpec { spring_law: vec![Some(law)], damping: vec![10.0], ..revolute([0.0, 1.0, 0.0]) };
    let model = pendulum(&[spec], [0.0; 3], [0.0; 3], [2.0, 0.0, 0.0], SLENDER);
    compare(
        model.clone(),
        &[
            (0.5, [[1.89736, 0.0, -0.632_476], [0.0, 0.744_544, 0.0], [0.131_742, 0.0, -12.9162]]),
            (5.0, [[1.88243, 0.0, -0.675_612], [0.0, -6.4e-4, 0.0], [0.00827, 0.0, -9.78362]]),
        ],
    );
    // the energy is balanced, and implicit steps find the same
    let total = |world: &mut World| world.energy().total();
    for (kind, tolerance) in
        [(MethodKind::DormandPrince, 1e-8), (MethodKind::Stiff, 1e-6), (MethodKind::Implicit, 1e-4)]
    {
        let mut world = World::new(model.clone(), State::new(&model), kind, 1e-11, 1e-3);
        let start = total(&mut world);
        run(&mut world, 1e-3, 500);
        let imbalance = total(&mut world) - start - world.state.totals[0] + world.state.totals[1];
        assert!(imbalance.abs() < 10.0 * tolerance, "{kind:?} {imbalance:e}");
        let com = seen(&mut world, 0.5).com;
        assert!((com - Vec3([1.89736, 0.0, -0.632_476])).norm() < tolerance.max(1e-5), "{kind:?} {com:?}");
    }
}

#[test]
fn the_reaction_along_the_axis_is_what_the_joint_gives() {
    // torques of motor, spring, damper and armature of a hinge, with the bar beyond it
    let motor = Motor { stiffness: 3.0, damping: 0.2, ..Motor::new(MotorMode::Spring) };
    let axis = [0.2, 1.0, -0.3];
    let spec = JointSpec {
        spring: vec![(7.0, 0.1)],
        damping: vec![0.3],
        armature: vec![0.5],
        motor: vec![motor],
        ..revolute(axis)
    };
    let model = pendulum(&[spec], [0.3, 0.2, 0.1], [0.3, 0.2, 0.5], [1.0, 0.4, 0.2], SLENDER);
    let mut x = State::new(&model);
    (x.q[0], x.v[0], x.commands[0]) = (0.4, -1.2, 0.8);
    let mut world = World::new(model, x, MethodKind::DormandPrince, 1e-9, 1e-3);
    let joint = world.model().names().joint_id("joint0").unwrap();
    let observation = world.observe(0.0);
    let unit = Vec3(axis).scale(1.0 / Vec3(axis).norm());
    let given = 7.0 * (0.1 - 0.4) + 0.3 * 1.2 + 3.0 * (0.8 - 0.4) + 0.2 * 1.2 - 0.5 * observation.accelerations[0];
    assert!((observation.joint_wrench(joint).ang.dot(unit) - given).abs() < 1e-12);
}

#[test]
fn reactions_carry_the_momentum_of_everything_beyond() {
    // a free joint transmits nothing; the joints on its body carry what hangs on them
    let (model, x) = zoo();
    let mut world = World::new(model, x, MethodKind::DormandPrince, 1e-9, 1e-3);
    let free = world.model().names().joint_id("free").unwrap();
    let observation = world.observe(0.0);
    let wrench = observation.joint_wrench(free);
    assert!(wrench.lin.norm() < 1e-9 && wrench.ang.norm() < 1e-9, "{wrench:?}");
}

#[test]
fn a_joint_and_a_force_cell_agree_and_loops_take_their_share() {
    // a beam on a force cell at one end, held at its tip by a point; the cell, and a hinge in its place
    let build = |cell: bool, is_held: bool| {
        let mut b = ModelBuilder::new([0.3, 0.0, -9.81]);
        let turned = Pose { rot: Quat::exp(Vec3([0.4, 0.1, -0.2])).matrix(), pos: Vec3([0.1, 0.0, 0.5]) };
        let kind = if cell { JointKind::Fixed } else { JointKind::Revolute { axis: [0.0, 1.0, 0.0] } };
        let joint = b.joint("root", NodeId::WORLD, turned, JointSpec { sensor: cell, ..JointSpec::new(kind) });
        let beam = Shape::Cuboid { size: [1.0, 0.1, 0.2] }.mass_properties(300.0);
        let beam = b.body("beam", joint, Pose::translation(Vec3([0.5, 0.0, 0.0])), BodySpec { mass: beam });
        if is_held {
            let tip = Pose::translation(Vec3([0.5, 0.0, 0.0]));
            let place = turned.compose(&Pose::translation(Vec3([1.0, 0.0, 0.0])));
            let ends = ([beam, NodeId::WORLD], [tip, place]);
            b.loop_joint("tip", LoopJointSpec { kind: LoopJointKind::Point, ends: ends.0, poses: ends.1 });
        }
        b.build().unwrap().0
    };
    let model = build(true, false);
    let x = State::new(&model);
    let mut world = World::new(model, x, MethodKind::DormandPrince, 1e-9, 1e-3);
    let joint = world.model().names().joint_id("root").unwrap();
    let observation = world.observe(0.0);
    let (wrench, cell) = (observation.joint_wrench(joint), observation.scratch().reaction());
    for k in 0..3 {
        assert!((wrench.ang[k] - cell[k]).abs() < 1e-11 && (wrench.lin[k] - cell[3 + k]).abs() < 1e-11);
    }
    let model = build(false, true);
    let mut x = State::new(&model);
    x.tick = 0;
    let mut world = World::new(model, x, MethodKind::DormandPrince, 1e-9, 1e-3);
    world.initialize(0.0);
    let joint = world.model().names().joint_id("root").unwrap();
    let weight = 300.0 * 0.02 * 9.81;
    let observation = world.observe(0.0);
    let wrench = observation.joint_wrench(joint);
    // at rest; the hinge gives no torque about its axis, and the tip carries half of what is across the beam
    assert!(wrench.ang[1].abs() < 1e-9, "{wrench:?}");
    assert!(wrench.lin.norm() < weight && wrench.lin.norm() > 0.3 * weight, "{wrench:?}");
}
