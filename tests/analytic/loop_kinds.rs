//! Kinds of loop joints: a mechanism closed by a loop joint moves as the one whose tree has the joint, however the
//! world is turned.

use sincro_dynamics::constraint::LoopJointKind;
use sincro_dynamics::initial;
use sincro_dynamics::joint::JointKind;
use sincro_dynamics::kinematics::{self, Attached};
use sincro_dynamics::model::{BodySpec, JointSpec, LoopJointSpec, Model, ModelBuilder, NodeId, Shape};
use sincro_dynamics::spatial::{Pose, Quat, Vec3};
use sincro_dynamics::state::State;
use sincro_dynamics::world::{MethodKind, World};

use crate::mechanisms::run;

/// Joint of a tree, the loop joint that is the same, its axes in the two ends (z is turned to them), and the velocity
/// at the start: of the tree's coordinates, and of a free joint (angular first).
struct Case {
    tree: Vec<JointKind>,
    closure: LoopJointKind,
    turns: [[f64; 3]; 2],
    velocities: Vec<f64>,
    free: [f64; 6],
}

const Z: [f64; 3] = [0.0, 0.0, 1.0];

fn cases() -> Vec<Case> {
    let same = [[0.0; 3]; 2];
    let quarter = core::f64::consts::FRAC_PI_2;
    vec![
        Case {
            tree: vec![JointKind::Prismatic { axis: Z }],
            closure: LoopJointKind::Slider,
            turns: same,
            velocities: vec![0.4],
            free: [0.0, 0.0, 0.0, 0.0, 0.0, 0.4],
        },
        Case {
            tree: vec![JointKind::Prismatic { axis: Z }, JointKind::Revolute { axis: Z }],
            closure: LoopJointKind::Cylindrical,
            turns: same,
            velocities: vec![0.4, -0.9],
            free: [0.0, 0.0, -0.9, 0.0, 0.0, 0.4],
        },
        Case {
            tree: vec![JointKind::Universal { axis: [1.0, 0.0, 0.0], axis2: [0.0, 1.0, 0.0] }],
            closure: LoopJointKind::Universal,
            // z along x of the first end, along y of the second
            turns: [[0.0, quarter, 0.0], [-quarter, 0.0, 0.0]],
            velocities: vec![0.7, -0.5],
            free: [0.7, -0.5, 0.0, 0.0, 0.0, 0.0],
        },
        Case {
            tree: vec![JointKind::Planar],
            closure: LoopJointKind::Planar,
            turns: same,
            velocities: vec![0.3, -0.2, 0.8],
            free: [0.0, 0.0, 0.8, 0.3, -0.2, 0.0],
        },
    ]
}

/// A turning arm in a world turned by `world`, with a body at its end: on joints of the tree, or free and held by a
/// loop joint.
fn mechanism(case: &Case, is_loop: bool, world: Vec3<f64>) -> (Model<f64>, State<f64>) {
    let turn = Quat::exp(world).matrix();
    let mut b = ModelBuilder::new(turn.mul_vec(Vec3([0.3, 1.0, -9.81])).0);
    let base = Pose { rot: turn, pos: Vec3::zero() };
    let hinge = b.joint("hinge", NodeId::WORLD, base, JointSpec::new(JointKind::Revolute { axis: [0.2, 1.0, 0.1] }));
    let brick = |size: [f64; 3], density: f64| BodySpec { mass: Shape::Cuboid { size }.mass_properties(density) };
    let arm = b.body("arm", hinge, Pose::translation(Vec3([0.4, 0.0, 0.0])), brick([0.8, 0.1, 0.1], 500.0));
    let place = Pose { rot: Quat::exp(Vec3([0.3, -0.4, 0.2])).matrix(), pos: Vec3([0.4, 0.0, 0.05]) };
    let mut carrier = arm;
    if is_loop {
        carrier = b.joint("free", arm, place, JointSpec::new(JointKind::Free));
    } else {
        for (k, kind) in case.tree.iter().enumerate() {
            let pose = if k == 0 { place } else { Pose::identity() };
            carrier = b.joint(&format!("joint{k}"), carrier, pose, JointSpec::new(*kind));
        }
    }
    let body = b.body("body", carrier, Pose::translation(Vec3([0.05, 0.1, -0.2])), brick([0.1, 0.2, 0.4], 300.0));
    if is_loop {
        let [one, two] = case.turns.map(|turn| Pose { rot: Quat::exp(Vec3(turn)).matrix(), pos: Vec3::zero() });
        let in_body = Pose::translation(Vec3([-0.05, -0.1, 0.2])).compose(&two);
        let poses = [place.compose(&one), in_body];
        b.loop_joint("loop", LoopJointSpec { kind: case.closure, ends: [arm, body], poses });
    }
    let model = b.build().unwrap().0;
    let mut x = State::new(&model);
    x.v[0] = 1.1;
    let velocities: &[f64] = if is_loop { &case.free } else { &case.velocities };
    x.v[1..].copy_from_slice(velocities);
    (model, x)
}

/// Pose of the body after a second, taken back into the world that is not turned.
fn end(model: &Model<f64>, x: &State<f64>, kind: MethodKind, world: Vec3<f64>) -> Pose<f64> {
    let mut at = World::new(model.clone(), x.clone(), kind, 1e-12, 1e-3);
    at.initialize(0.0);
    run(&mut at, 0.01, 100);
    let info = model.names().frame("body").unwrap();
    let attached = Attached { link: info.link, pose: info.pose };
    let seen = at.observe(1.0);
    assert!(model.constraints().loop_joints.is_empty() || seen.residual(0) < 1e-11);
    let back = Pose { rot: Quat::exp(world).matrix().transpose(), pos: Vec3::zero() };
    back.compose(&kinematics::frame_pose(seen.scratch(), &attached))
}

fn distance(a: &Pose<f64>, b: &Pose<f64>) -> f64 {
    let turned = (0..3).map(|k| (a.rot.col(k) - b.rot.col(k)).norm()).fold(0.0, f64::max);
    turned.max((a.pos - b.pos).norm())
}

#[test]
fn a_loop_joint_moves_as_the_joint_of_a_tree() {
    for case in cases() {
        let straight = Vec3::zero();
        let (tree, x) = mechanism(&case, false, straight);
        let expected = end(&tree, &x, MethodKind::DormandPrince, straight);
        for world in [straight, Vec3([0.7, -1.9, 0.4]), Vec3([-0.3, 0.2, 2.6])] {
            let (model, x) = mechanism(&case, true, world);
            let found = end(&model, &x, MethodKind::DormandPrince, world);
            let off = distance(&found, &expected);
            assert!(off < 1e-9, "{:?} {world:?}: {off:e}", case.closure);
        }
        let (model, x) = mechanism(&case, true, straight);
        let off = distance(&end(&model, &x, MethodKind::Stiff, straight), &expected);
        assert!(off < 1e-8, "{:?}: {off:e}", case.closure);
    }
}

#[test]
fn the_degrees_of_freedom_are_those_of_the_joint() {
    for case in cases() {
        for world in [Vec3::zero(), Vec3([0.7, -1.9, 0.4])] {
            let (model, x) = mechanism(&case, true, world);
            let found = initial::mobility(&model, &x);
            assert_eq!((found.equations, found.redundant), (6 - case.velocities.len(), 0), "{:?}", case.closure);
            assert_eq!(found.tree_dofs - found.equations, 1 + case.velocities.len(), "{:?}", case.closure);
        }
    }
}

#[test]
fn an_open_loop_joint_is_measured_by_its_kind() {
    // the body displaced and turned: what the kind leaves free is no opening
    let free = |case: &Case, q: [f64; 7]| {
        let (model, mut x) = mechanism(case, true, Vec3::zero());
        x.q[1..].copy_from_slice(&q);
        initial::constraint_residuals(&model, &x).iter().map(|o| (o.distance, o.angle)).next().unwrap()
    };
    let [slider, cylindrical, universal, planar] = &cases()[..] else { panic!() };
    let half = Quat::exp(Vec3([0.0, 0.0, 0.3]));
    let along = [0.0, 0.0, 0.2, 1.0, 0.0, 0.0, 0.0];
    let about = [0.0, 0.0, 0.0, half.w, half.xyz[0], half.xyz[1], half.xyz[2]];
    let across = [0.1, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0];
    let close = |found: (f64, f64), expected: (f64, f64)| {
        assert!((found.0 - expected.0).abs() < 1e-12 && (found.1 - expected.1).abs() < 1e-12, "{found:?} {expected:?}");
    };
    close(free(slider, along), (0.0, 0.0));
    close(free(slider, about), (0.0, 0.3));
    close(free(slider, across), (0.1, 0.0));
    close(free(cylindrical, along), (0.0, 0.0));
    close(free(cylindrical, about), (0.0, 0.0));
    close(free(cylindrical, across), (0.1, 0.0));
    close(free(universal, along), (0.2, 0.0));
    close(free(universal, about), (0.0, 0.3));
    close(free(planar, along), (0.2, 0.0));
    close(free(planar, about), (0.0, 0.0));
    close(free(planar, across), (0.0, 0.0));
}
