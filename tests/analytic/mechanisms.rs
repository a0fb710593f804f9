//! Small mechanisms that several tests share.

use sincro_dynamics::actuation::Motor;
use sincro_dynamics::joint::JointKind;
use sincro_dynamics::model::{BodySpec, JointSpec, MassProperties, Model, ModelBuilder, NodeId, Shape};
use sincro_dynamics::signal::Signal;
use sincro_dynamics::spatial::{Pose, Vec3};
use sincro_dynamics::state::State;
use sincro_dynamics::world::{MethodKind, World};

pub const ALL: [MethodKind; 6] = MethodKind::ALL;

/// A cart on a rail, mass `[kg]`.
pub fn cart(mass: f64, spec: JointSpec) -> Model<f64> {
    let mut b = ModelBuilder::new([0.0, 0.0, -9.81]);
    let joint = JointSpec { kind: JointKind::Prismatic { axis: [1.0, 0.0, 0.0] }, ..spec };
    let joint = b.joint("rail", NodeId::WORLD, Pose::identity(), joint);
    let mass = MassProperties { mass, center_of_mass: [0.0; 3], inertia: [1.0, 0.0, 0.0, 1.0, 0.0, 1.0] };
    b.body("cart", joint, Pose::identity(), BodySpec { mass });
    b.build().unwrap().0
}

pub fn motor(motor: Motor<f64>) -> JointSpec {
    JointSpec { motor: vec![motor], ..slider() }
}

pub fn slider() -> JointSpec {
    JointSpec::new(JointKind::Prismatic { axis: [1.0, 0.0, 0.0] })
}

/// Every kind of joint in one tree, with springs, dampers and a torque that changes in time: smooth, moderately fast.
pub fn zoo() -> (Model<f64>, State<f64>) {
    let mut b = ModelBuilder::new([0.0, 0.0, -9.81]);
    let brick = |m: f64| BodySpec { mass: Shape::Cuboid { size: [0.2, 0.3, 0.4] }.mass_properties(m / 0.024) };
    let at = |x: f64, y: f64, z: f64| Pose::translation(Vec3([x, y, z]));
    let free = b.joint("free", NodeId::WORLD, at(0.0, 0.0, 1.0), JointSpec::new(JointKind::Free));
    let hull = b.body("hull", free, Pose::identity(), brick(5.0));
    let ball = JointSpec { damping: vec![0.05; 3], ..JointSpec::new(JointKind::Ball) };
    let ball = b.joint("ball", hull, at(0.3, 0.0, 0.1), ball);
    let arm = b.body("arm", ball, at(0.2, 0.1, 0.0), brick(1.0));
    let hinge = JointSpec {
        spring: vec![(3.0, 0.2)],
        damping: vec![0.1],
        torque: vec![Signal::Sine { amplitude: 0.5, angular_frequency: 3.0, phase: 0.4, offset: 0.1 }],
        ..JointSpec::new(JointKind::Revolute { axis: [0.3, 1.0, -0.2] })
    };
    let hinge = b.joint("hinge", arm, at(0.1, 0.2, 0.0), hinge);
    let fore = b.body("fore", hinge, at(0.0, 0.1, 0.2), brick(0.8));
    let universal = JointKind::Universal { axis: [1.0, 0.0, 0.0], axis2: [0.0, 1.0, 0.0] };
    let universal = b.joint("universal", hull, at(-0.3, 0.0, 0.0), JointSpec::new(universal));
    let leg = b.body("leg", universal, at(0.0, 0.0, -0.3), brick(1.2));
    let screw = JointKind::Screw { axis: [0.0, 0.0, 1.0], pitch: 0.05 };
    let screw = b.joint("screw", leg, at(0.0, 0.0, -0.2), JointSpec::new(screw));
    b.body("nut", screw, at(0.1, 0.0, 0.0), brick(0.5));
    let planar = JointSpec { spring: vec![(20.0, 0.0), (30.0, 0.1), (2.0, 0.0)], ..JointSpec::new(JointKind::Planar) };
    let planar = b.joint("planar", fore, at(0.0, 0.1, 0.1), planar);
    b.body("plate", planar, at(0.05, 0.0, 0.0), brick(0.4));
    let model = b.build().unwrap().0;
    let mut x = State::new(&model);
    for (k, v) in x.v.iter_mut().enumerate() {
        *v = 0.4 - 0.13 * (k as f64 % 7.0);
    }
    (model, x)
}

/// Runs for `n` ticks of `h`; panics if the world stops.
pub fn run(world: &mut World, h: f64, n: u32) {
    for k in 0..n {
        world.advance(f64::from(k) * h, h).unwrap();
    }
}

/// Largest difference of two states, the quaternions' sign put aside.
pub fn distance(model: &Model<f64>, a: &State<f64>, b: &State<f64>) -> f64 {
    let mut worst = a.v.iter().zip(&b.v).fold(0.0_f64, |w, (x, y)| w.max((x - y).abs()));
    for joint in &model.names().joints {
        let range = joint.q_idx..joint.q_idx + joint.n_q;
        worst = a.q[range.clone()].iter().zip(&b.q[range]).fold(worst, |w, (x, y)| w.max((x - y).abs()));
    }
    worst
}
