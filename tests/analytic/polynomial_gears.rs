//! A cam: the height of a follower is a polynomial of the angle of a shaft.
//!
//! With q₂ = p(q₁), the inertia I of the shaft, the mass m of the follower, gravity g against it and the torque τ,
//! (I + m p'²) q̈₁ + m p' p'' q̇₁² + m g p' = τ: one degree of freedom, whose equation is integrated here by itself.

use sincro_dynamics::initial;
use sincro_dynamics::joint::JointKind;
use sincro_dynamics::model::{
    BodySpec, GearConstraint, GearSpec, JointSpec, MassProperties, Model, ModelBuilder, NodeId,
};
use sincro_dynamics::signal::Signal;
use sincro_dynamics::spatial::Pose;
use sincro_dynamics::state::State;
use sincro_dynamics::world::{MethodKind, World};

use crate::mechanisms::run;

const G: f64 = 9.81;
const SHAFT: f64 = 0.3;
const MASS: f64 = 2.0;
const TORQUE: f64 = 1.5;
/// Coefficients of the powers 0 to 4.
const CAM: [f64; 5] = [0.1, 0.02, 0.15, -0.04, 0.01];

fn cam([offset, ratio, higher @ ..]: [f64; 5]) -> Model<f64> {
    let mut b = ModelBuilder::new([0.0, 0.0, -G]);
    let inertia = [SHAFT, 0.0, 0.0, SHAFT, 0.0, SHAFT];
    let body = |mass: f64| BodySpec { mass: MassProperties { mass, center_of_mass: [0.0; 3], inertia } };
    let shaft = JointSpec {
        torque: vec![Signal::Constant(TORQUE)],
        ..JointSpec::new(JointKind::Revolute { axis: [0.0, 0.0, 1.0] })
    };
    let shaft = b.joint("shaft", NodeId::WORLD, Pose::identity(), shaft);
    b.body("wheel", shaft, Pose::identity(), body(1.0));
    let lift = JointSpec::new(JointKind::Prismatic { axis: [0.0, 0.0, 1.0] });
    let lift = b.joint("lift", NodeId::WORLD, Pose::identity(), lift);
    b.body("follower", lift, Pose::identity(), body(MASS));
    b.gear("cam", GearSpec { joints: [shaft, lift], ratio, offset, higher });
    b.build().unwrap().0
}

fn derivatives(q: f64) -> [f64; 3] {
    let sum = |f: &dyn Fn(f64, i32) -> f64| (0..5).map(|k| CAM[k as usize] * f(f64::from(k), k)).sum::<f64>();
    [
        sum(&|_, k| q.powi(k)),
        sum(&|n, k| if k < 1 { 0.0 } else { n * q.powi(k - 1) }),
        sum(&|n, k| if k < 2 { 0.0 } else { n * (n - 1.0) * q.powi(k - 2) }),
    ]
}

/// Angle and speed of the shaft at time `t` by the classical method of order 4 with steps of 0.1 ms.
fn reduced(mut x: [f64; 2], t: f64) -> [f64; 2] {
    let rate = |[q, v]: [f64; 2]| {
        let [_, slope, curvature] = derivatives(q);
        let inertia = SHAFT + MASS * slope * slope;
        [v, (TORQUE - MASS * slope * (curvature * v * v + G)) / inertia]
    };
    let n = (t / 1e-4).round() as usize;
    let h = t / n as f64;
    for _ in 0..n {
        let at = |k: [f64; 2], c: f64| [x[0] + c * h * k[0], x[1] + c * h * k[1]];
        let k1 = rate(x);
        let k2 = rate(at(k1, 0.5));
        let k3 = rate(at(k2, 0.5));
        let k4 = rate(at(k3, 1.0));
        for i in 0..2 {
            x[i] += h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
        }
    }
    x
}

/// Turns at 3 rad/s, at first where p(q₁) is.
fn started(kind: MethodKind) -> World {
    let model = cam(CAM);
    let mut x = State::new(&model);
    let [height, slope, _] = derivatives(-0.4);
    x.q.copy_from_slice(&[-0.4, height]);
    x.v.copy_from_slice(&[3.0, 3.0 * slope]);
    World::new(model, x, kind, 1e-12, 1e-3)
}

#[test]
fn a_cam_follows_its_reduced_equation_at_the_order_of_each_method() {
    let exact = reduced([-0.4, 3.0], 1.0);
    let error = |kind, n: u32| {
        let mut world = started(kind);
        run(&mut world, 1.0 / f64::from(n), n);
        let open = initial::constraint_residuals(world.model(), &world.state)[0].distance;
        assert!(open < 1e-11, "{kind:?} is open by {open:e}");
        let slope = derivatives(world.state.q[0])[1];
        assert!((world.state.v[1] - slope * world.state.v[0]).abs() < 1e-9, "{kind:?}");
        (world.state.q[0] - exact[0]).abs().max((world.state.v[0] - exact[1]).abs())
    };
    for kind in [MethodKind::DormandPrince, MethodKind::DormandPrince8, MethodKind::Stiff] {
        let found = error(kind, 100);
        println!("{kind:?}: {found:.1e}");
        assert!(found < 1e-8, "{kind:?}: {found:e}");
    }
    for (kind, order) in [(MethodKind::Rk4, 4.0), (MethodKind::Implicit, 2.0), (MethodKind::SemiImplicitEuler, 1.0)] {
        let (coarse, fine) = (error(kind, 100), error(kind, 200));
        let measured = libm::log2(coarse / fine);
        println!("{kind:?}: {fine:.1e}, order {measured:.2}");
        assert!(measured > order - 0.25, "{kind:?}: order {measured}");
    }
}

#[test]
fn the_cam_does_no_work() {
    for (kind, bound) in [(MethodKind::DormandPrince, 1e-9), (MethodKind::Stiff, 1e-9), (MethodKind::Rk4, 1e-5)] {
        let mut world = started(kind);
        let start = world.energy().total();
        run(&mut world, 5e-3, 200);
        let imbalance = world.energy().total() - start - world.state.totals[0] + world.state.totals[1];
        println!("{kind:?}: {imbalance:.1e} J of {start:.2} J");
        assert!(imbalance.abs() < bound, "{kind:?}: {imbalance:e}");
        // stages are off the cam by the error of the method: rate of the row times its force
        assert!(world.state.totals[1].abs() < bound, "{kind:?}: {:e}", world.state.totals[1]);
    }
}

#[test]
fn slope_and_curvature_are_derivatives_of_the_residual() {
    let [offset, ratio, higher @ ..] = CAM;
    let gear = GearConstraint { name: "cam".into(), dofs: [0, 1], coordinates: [0, 1], ratio, offset, higher };
    for q in [-1.3, -0.2, 0.0, 0.7, 2.1] {
        let h = 1e-4;
        let [below, at, above] = [q - h, q, q + h].map(|q| -gear.residual::<f64>(&[q, 0.0]));
        assert!((gear.slope(q) - (above - below) / (2.0 * h)).abs() < 1e-7);
        assert!((gear.curvature(q) - (above - 2.0 * at + below) / (h * h)).abs() < 1e-6);
        let [height, slope, curvature] = derivatives(q);
        assert!((at - height).abs().max((gear.slope(q) - slope).abs()) < 1e-14);
        assert!((gear.curvature(q) - curvature).abs() < 1e-14);
    }
}

#[test]
fn an_open_cam_is_assembled_and_its_velocities_are_brought_along() {
    let model = cam(CAM);
    let mut x = State::new(&model);
    x.q.copy_from_slice(&[0.9, -0.3]);
    let q = initial::assemble(&model, &x).unwrap();
    assert!((q[1] - derivatives(q[0])[0]).abs() < 1e-9, "{q:?}");
    x.q = q;
    x.v.copy_from_slice(&[2.0, 0.0]);
    let v = initial::consistent_velocities(&model, &x).unwrap();
    assert!((v[1] - derivatives(x.q[0])[1] * v[0]).abs() < 1e-12 && v[0] > 0.5, "{v:?}");
}

/// At a slope of zero the follower alone is held.
#[test]
fn a_stationary_point_is_no_singular_position() {
    let model = cam([0.0, 0.0, 0.5, 0.0, 0.0]);
    let mut x = State::new(&model);
    x.v[0] = 2.0;
    let mut world = World::new(model, x, MethodKind::DormandPrince, 1e-11, 1e-3);
    run(&mut world, 1e-3, 300);
    assert!((world.state.q[1] - 0.5 * world.state.q[0].powi(2)).abs() < 1e-11);
    let start = 0.5 * SHAFT * 4.0;
    assert!((world.energy().total() - start - world.state.totals[0]).abs() < 1e-9);
}
