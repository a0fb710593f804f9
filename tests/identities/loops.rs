//! A closed loop moves the same whatever the frame, the units, the masses and the ground it stands on.

use sincro_dynamics::constraint::LoopJointKind;
use sincro_dynamics::initial;
use sincro_dynamics::joint::JointKind;
use sincro_dynamics::mechanism::Mechanism;
use sincro_dynamics::model::{BodySpec, JointSpec, LoopJointSpec, MassProperties, Model, ModelBuilder, NodeId, Shape};
use sincro_dynamics::spatial::{Mat3, Pose, Quat, Vec3};
use sincro_dynamics::state::State;
use sincro_dynamics::world::{MethodKind, World};

use crate::random::Random;

/// Place and units of a mechanism.
#[derive(Clone, Copy)]
struct Setting {
    /// Rotation of everything, gravity included.
    rot: Mat3<f64>,
    /// Factor on lengths and gravity: angles stay.
    length: f64,
    /// Factor on masses: angles stay.
    mass: f64,
    /// True on a turntable about the vertical.
    turntable: bool,
    kind: LoopJointKind,
}

fn plain() -> Setting {
    Setting { rot: Mat3::identity(), length: 1.0, mass: 1.0, turntable: false, kind: LoopJointKind::Hinge }
}

/// Corners of a quadrilateral: two on the ground, two that move.
struct Corners([Vec3<f64>; 4]);

impl Corners {
    fn draw(r: &mut Random) -> Self {
        let mut near = |x: f64, z: f64| Vec3([x + 0.2 * r.unit(), 0.0, z + 0.2 * r.unit()]);
        Self([near(0.0, 0.0), near(0.1, 0.8), near(1.2, 1.0), near(1.0, 0.0)])
    }
}

/// A four-bar, closed at coordinates zero.
fn four_bar(corners: &Corners, s: Setting) -> Model<f64> {
    let Corners([o, a, b, d]) = corners;
    let [o, a, b, d] = [o, a, b, d].map(|p| p.scale(s.length));
    let mut m = ModelBuilder::new(s.rot.mul_vec(Vec3([0.0, 0.0, -9.81 * s.length])).0);
    let hinge = |axis| JointSpec::new(JointKind::Revolute { axis });
    let mut ground = m.frame("ground", NodeId::WORLD, Pose { rot: s.rot, pos: Vec3::zero() });
    if s.turntable {
        ground = m.joint("turntable", ground, Pose::identity(), hinge([0.0, 0.0, 1.0]));
        let table = Shape::Cylinder { radius: s.length, length: 0.1 * s.length };
        let mass = scaled(table.mass_properties(100.0 * s.mass / s.length.powi(3)), 1.0);
        m.body("table", ground, Pose::identity(), BodySpec { mass });
    }
    let bar = |along: Vec3<f64>| {
        let (mass, l) = (s.mass * along.norm() / s.length, along.norm());
        let i = mass * l * l / 12.0;
        let center_of_mass = along.scale(0.5).0;
        BodySpec { mass: MassProperties { mass, center_of_mass, inertia: [i, 0.0, 0.0, i, 0.0, i] } }
    };
    let y = [0.0, 1.0, 0.0];
    let crank = m.joint("crank", ground, Pose::translation(o), hinge(y));
    m.body("rod", crank, Pose::identity(), bar(a - o));
    let coupler = m.joint("coupler", crank, Pose::translation(a - o), hinge(y));
    m.body("bar", coupler, Pose::identity(), bar(b - a));
    let rocker = m.joint("rocker", ground, Pose::translation(d), hinge(y));
    m.body("arm", rocker, Pose::identity(), bar(b - d));
    // z of the ends along the hinge
    let turn = Mat3::rotation::<0>(-1.0, 0.0);
    let poses = [b - a, b - d].map(|pos| Pose { rot: turn, pos });
    m.loop_joint("pin", LoopJointSpec { kind: s.kind, ends: [coupler, rocker], poses });
    m.build().unwrap().0
}

fn scaled(mut mass: MassProperties, factor: f64) -> MassProperties {
    mass.mass *= factor;
    mass
}

/// Joint angles after one second, the speed of the turntable given at the start.
fn angles(corners: &Corners, s: Setting, kind: MethodKind, accuracy: f64) -> Vec<f64> {
    angles_with(corners, s, kind, accuracy, 1)
}

fn angles_with(corners: &Corners, s: Setting, kind: MethodKind, accuracy: f64, substeps: u32) -> Vec<f64> {
    let model = four_bar(corners, s);
    let mut x = State::new(&model);
    if s.turntable {
        x.v[0] = 2.0;
    }
    let mut world = World::new(model, x, kind, accuracy, 1e-3);
    world.set_substeps(substeps);
    world.initialize(0.0);
    for k in 0..100 {
        world.advance(0.01 * f64::from(k), 0.01).unwrap();
    }
    let open = initial::constraint_residuals(world.model(), &world.state)[0].distance;
    assert!(open < 1e-10 * s.length.max(1e-2), "open by {open:e} m");
    world.state.q.clone()
}

fn difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

fn turned(r: &mut Random) -> Mat3<f64> {
    Quat::exp(Vec3(r.vector()).scale(3.0)).matrix()
}

#[test]
fn a_four_bar_moves_the_same_in_every_frame_and_unit() {
    let mut r = Random::new(7);
    for draw in 0..6 {
        let corners = Corners::draw(&mut r);
        for turntable in [false, true] {
            let on = Setting { turntable, ..plain() };
            let expected = angles(&corners, on, MethodKind::DormandPrince, 1e-11);
            let agrees = |name: &str, s: Setting, accuracy: f64| {
                let off = difference(&expected, &angles(&corners, s, MethodKind::DormandPrince, accuracy));
                assert!(off < 1e-9, "draw {draw}, turntable {turntable}, {name}: off by {off:e} rad");
            };
            agrees("turned by 30° about z", Setting { rot: Mat3::rotation::<2>(0.5, 0.75_f64.sqrt()), ..on }, 1e-11);
            agrees("turned at random", Setting { rot: turned(&mut r), ..on }, 1e-11);
            agrees("a thousandth of the length", Setting { length: 1e-3, ..on }, 1e-11);
            agrees("a thousand times the length", Setting { length: 1e3, rot: turned(&mut r), ..on }, 1e-11);
            agrees("1e-9 of the mass", Setting { mass: 1e-9, rot: turned(&mut r), ..on }, 1e-11);
            agrees("1000 times the mass", Setting { mass: 1e3, ..on }, 1e-11);
            agrees("a point instead of a hinge", Setting { kind: LoopJointKind::Point, ..on }, 1e-11);
        }
    }
}

#[test]
fn two_integrators_agree_on_a_turned_four_bar_on_a_turntable() {
    let mut r = Random::new(11);
    let corners = Corners::draw(&mut r);
    let s = Setting { rot: turned(&mut r), turntable: true, ..plain() };
    let one = angles(&corners, s, MethodKind::DormandPrince, 1e-11);
    assert!(difference(&one, &angles(&corners, s, MethodKind::Stiff, 1e-11)) < 1e-8);
    for (kind, order) in [(MethodKind::Rk4, 4), (MethodKind::Implicit, 2)] {
        let error = |substeps| difference(&one, &angles_with(&corners, s, kind, 1e-11, substeps));
        let [coarse, fine] = [error(4), error(16)];
        // a quarter of the step, 4^order times as exact; asymptotically
        assert!(fine < 2.0 * coarse / 4.0_f64.powi(order), "{kind:?}: {coarse:e}, {fine:e} rad");
    }
}

#[test]
fn the_degrees_of_freedom_are_the_mechanism_s_whatever_its_frame() {
    let mut r = Random::new(13);
    for _ in 0..10 {
        let corners = Corners::draw(&mut r);
        for (kind, equations, rigid) in
            [(LoopJointKind::Point, 3, 0), (LoopJointKind::Hinge, 5, 0), (LoopJointKind::Weld, 6, 1)]
        {
            for turntable in [false, true] {
                let length = [1e-3, 1.0, 1e3][r.below(3)];
                let s = Setting { rot: turned(&mut r), length, turntable, kind, ..plain() };
                let model = four_bar(&corners, s);
                let found = initial::mobility(&model, &State::new(&model));
                let dofs = 1 - rigid + usize::from(turntable);
                assert_eq!((found.equations, found.dofs()), (equations, dofs), "{kind:?}, turntable {turntable}");
            }
        }
    }
}

#[test]
fn a_welded_loop_that_cannot_move_rests() {
    let mut r = Random::new(17);
    for _ in 0..4 {
        let corners = Corners::draw(&mut r);
        let s = Setting { rot: turned(&mut r), kind: LoopJointKind::Weld, ..plain() };
        let q = angles(&corners, s, MethodKind::DormandPrince, 1e-9);
        assert!(q.iter().all(|q| q.abs() < 1e-12), "{q:?}");
    }
}

#[test]
fn a_loop_joint_between_fixed_frames_takes_nothing_away() {
    for with_joint in [false, true] {
        let mut b = ModelBuilder::new([0.0, 0.0, -9.81]);
        let frames = ["a", "b"].map(|name| b.frame(name, NodeId::WORLD, Pose::identity()));
        if with_joint {
            let hinge = JointSpec::new(JointKind::Revolute { axis: [0.0, 1.0, 0.0] });
            let hinge = b.joint("hinge", NodeId::WORLD, Pose::identity(), hinge);
            let mass = Shape::Sphere { radius: 0.1 }.mass_properties(1000.0);
            b.body("ball", hinge, Pose::identity(), BodySpec { mass });
        }
        let poses = [Pose::identity(), Pose::identity()];
        b.loop_joint("pin", LoopJointSpec { kind: LoopJointKind::Weld, ends: frames, poses });
        let model = b.build().unwrap().0;
        let found = initial::mobility(&model, &State::new(&model));
        assert_eq!((found.equations, found.dofs()), (6, usize::from(with_joint)));
        let mut world = World::builder(model).build().unwrap();
        world.step().unwrap();
    }
}

/// `n` four-bars in a row, folded flat along x: cranks of the lengths given from pivots on the ground, each coupled to
/// the next; units and frame as set. The sign of a crank's length is its direction.
fn folded(pivots: &[f64], cranks: &[f64], s: Setting) -> (Model<f64>, usize) {
    let mut m = ModelBuilder::new(s.rot.mul_vec(Vec3([0.0, 0.0, -9.81 * s.length])).0);
    let hinge = || JointSpec::new(JointKind::Revolute { axis: [0.0, 1.0, 0.0] });
    let along = |x: f64| Vec3([x * s.length, 0.0, 0.0]);
    let bar = |x: f64| {
        let mass = s.mass * x.abs();
        let i = mass * (x * s.length) * (x * s.length) / 12.0;
        let inertia = [0.1 * i, 0.0, 0.0, i, 0.0, i];
        BodySpec { mass: MassProperties { mass, center_of_mass: along(0.5 * x).0, inertia } }
    };
    let ground = m.frame("ground", NodeId::WORLD, Pose { rot: s.rot, pos: Vec3::zero() });
    let mut joints = Vec::new();
    for (k, (pivot, crank)) in pivots.iter().zip(cranks).enumerate() {
        let joint = m.joint(&format!("crank{k}"), ground, Pose::translation(along(*pivot)), hinge());
        m.body(&format!("rod{k}"), joint, Pose::identity(), bar(*crank));
        joints.push(joint);
    }
    let turn = Mat3::rotation::<0>(-1.0, 0.0);
    for k in 1..pivots.len() {
        let tip = along(cranks[k - 1]);
        let joint = m.joint(&format!("coupler{k}"), joints[k - 1], Pose::translation(tip), hinge());
        let length = pivots[k] + cranks[k] - pivots[k - 1] - cranks[k - 1];
        m.body(&format!("bar{k}"), joint, Pose::identity(), bar(length));
        let poses = [length, cranks[k]].map(|x| Pose { rot: turn, pos: along(x) });
        m.loop_joint(&format!("pin{k}"), LoopJointSpec { kind: s.kind, ends: [joint, joints[k]], poses });
    }
    (m.build().unwrap().0, pivots.len() - 1)
}

#[test]
fn loops_that_start_folded_flat_have_the_degrees_of_freedom_of_the_mechanism() {
    let mut r = Random::new(23);
    for draw in 0..14 {
        // a row of parallelograms; a four-bar in which two lengths are as long as the other two
        let crank = 0.5 + 0.2 * r.unit();
        let row: Vec<f64> = (0..=1 + draw % 7).map(|k| 1.2 * f64::from(k) + 0.1 * r.unit()).collect();
        let parallelograms = (row.clone(), vec![crank; row.len()]);
        let [short, ground, rocker] = [0.3, 0.8, 0.5].map(|x: f64| x + 0.1 * r.unit());
        for (pivots, cranks) in [parallelograms, (vec![0.0, ground], vec![short, rocker])] {
            for kind in [LoopJointKind::Hinge, LoopJointKind::Point] {
                for length in [1e-3, 1.0, 1e3] {
                    let (model, loops) =
                        folded(&pivots, &cranks, Setting { length, rot: turned(&mut r), kind, ..plain() });
                    let x = State::new(&model);
                    let independent = Mechanism::new(model, false).select_loop_rows(&x.q);
                    assert_eq!(independent, 2 * loops, "draw {draw}, {kind:?}, {length} times the length, {pivots:?}");
                }
            }
        }
    }
}
