//! A torus on a plane: exact contact with the curvature of the tube, against closed forms of rolling.
//!
//! Steady turning: the axis a of the wheel keeps the angle θ from the vertical, the wheel turns about the vertical at Ω
//! and about its axis at σ. With the circle R, the tube ρ, mass m and the moments C (axial) and A the contact point is
//! C + R u − ρ z, rolling gives the distance d of the centre from the axis of turning, and the moment of weight and
//! friction is Ω z × L:
//!
//! d = −R cos θ − (σ/Ω)(R + ρ sin θ),
//! Ω sin θ (C σ + (C − A) Ω cos θ) = m Ω² d (R sin θ + ρ) − m g R cos θ.

use sincro_dynamics::contact::{Material, Surface};
use sincro_dynamics::joint::JointKind;
use sincro_dynamics::model::{BodySpec, JointSpec, MassProperties, Model, ModelBuilder, NodeId, Shape};
use sincro_dynamics::spatial::{Mat3, Pose, Quat, Vec3};
use sincro_dynamics::state::State;
use sincro_dynamics::world::{MethodKind, World};

use crate::mechanisms::run;

/// Circle and tube of a bicycle wheel [m], mass [kg], axial and transverse moments [kg·m²].
const RADIUS: f64 = 0.32;
const TUBE: f64 = 0.025;
const MASS: f64 = 2.0;
const AXIAL: f64 = 0.17;
const ACROSS: f64 = 0.09;
const G: f64 = 9.81;

fn wheel(gravity: [f64; 3], friction: f64) -> Model<f64> {
    let mut b = ModelBuilder::new(gravity);
    let material = Material { friction, ..Material::default() };
    b.collider(NodeId::WORLD, Pose::identity(), Surface::HalfSpace, material);
    let free = b.joint("free", NodeId::WORLD, Pose::identity(), JointSpec::new(JointKind::Free));
    let inertia = [ACROSS, 0.0, 0.0, ACROSS, 0.0, AXIAL];
    let body = b.body(
        "wheel",
        free,
        Pose::identity(),
        BodySpec { mass: MassProperties { mass: MASS, center_of_mass: [0.0; 3], inertia } },
    );
    let torus = Surface::Solid(Shape::Torus { major_radius: RADIUS, tube_radius: TUBE });
    b.collider(body, Pose::identity(), torus, material);
    b.build().unwrap().0
}

/// State with the centre at `p`, turned by `turn`, at velocities in world axes.
fn placed(model: &Model<f64>, p: [f64; 3], turn: Quat<f64>, w: [f64; 3], v: [f64; 3]) -> State<f64> {
    let mut x = State::new(model);
    x.q[..3].copy_from_slice(&p);
    turn.write(&mut x.q[3..7]);
    let rot: Mat3<f64> = turn.matrix();
    x.v[..3].copy_from_slice(&rot.tr_mul_vec(Vec3(w)).0);
    x.v[3..].copy_from_slice(&rot.tr_mul_vec(Vec3(v)).0);
    x
}

#[test]
fn steady_turning_returns_to_its_start() {
    let theta = 70_f64.to_radians();
    let (sin, cos) = (libm::sin(theta), libm::cos(theta));
    let turn_rate = 2.0;
    let arm = RADIUS * sin + TUBE;
    let spin = -(turn_rate * turn_rate * sin * cos * (AXIAL - ACROSS)
        + MASS * (turn_rate * turn_rate * arm + G) * RADIUS * cos)
        / (turn_rate * (sin * AXIAL + MASS * arm * (RADIUS + TUBE * sin)));
    let d = -RADIUS * cos - spin / turn_rate * (RADIUS + TUBE * sin);
    assert!(turn_rate * turn_rate * d.abs() < 0.9 * G, "it would slip");
    for (kind, tolerance) in [(MethodKind::DormandPrince, 1e-7), (MethodKind::Stiff, 1e-7), (MethodKind::Rk4, 1e-5)] {
        let model = wheel([0.0, 0.0, -G], 1.0);
        let turn = Quat { w: libm::cos(0.5 * theta), xyz: Vec3([0.0, libm::sin(0.5 * theta), 0.0]) };
        let w = [spin * sin, 0.0, turn_rate + spin * cos];
        let x = placed(&model, [d, 0.0, arm], turn, w, [0.0, turn_rate * d, 0.0]);
        let mut world = World::new(model, x, kind, 1e-12, 1e-3);
        let energy = world.energy().total();
        let n = 400;
        let h = core::f64::consts::TAU / turn_rate / f64::from(n);
        let mut height = 0.0_f64;
        for k in 0..n {
            world.advance(f64::from(k) * h, h).unwrap();
            height = height.max((world.state.q[2] - arm).abs());
        }
        let closure = (Vec3([world.state.q[0], world.state.q[1], world.state.q[2]]) - Vec3([d, 0.0, arm])).norm();
        let drift = (world.energy().total() - energy).abs();
        println!(
            "{kind:?}: height {height:.1e} m, closure {closure:.1e} m after {:.2} m, energy {drift:.1e} J",
            core::f64::consts::TAU * d.abs()
        );
        assert!(
            height < tolerance && closure < tolerance && drift < tolerance,
            "{kind:?}: {height:e} {closure:e} {drift:e}"
        );
    }
}

#[test]
fn it_rolls_down_a_slope_on_its_whole_radius() {
    // upright, axis along y: a = g sin β/(1 + C/(m (R + ρ)²))
    let beta = 0.2;
    let gravity = [G * libm::sin(beta), 0.0, -G * libm::cos(beta)];
    let whole = RADIUS + TUBE;
    let expected = G * libm::sin(beta) / (1.0 + AXIAL / (MASS * whole * whole));
    let turn = Quat::exp(Vec3([core::f64::consts::FRAC_PI_2, 0.0, 0.0]));
    let error = |kind, n: u32| {
        let model = wheel(gravity, 0.8);
        let x = placed(&model, [0.0, 0.0, whole], turn, [0.0; 3], [0.0; 3]);
        let mut world = World::new(model, x, kind, 1e-11, 1e-3);
        run(&mut world, 1.0 / f64::from(n), n);
        (world.state.q[0] / (0.5 * expected) - 1.0).abs()
    };
    for kind in [MethodKind::DormandPrince, MethodKind::DormandPrince8, MethodKind::Stiff, MethodKind::Rk4] {
        assert!(error(kind, 100) < 1e-8, "{kind:?}: {:e}", error(kind, 100));
    }
    let (coarse, fine) = (error(MethodKind::Implicit, 200), error(MethodKind::Implicit, 400));
    assert!(coarse < 1e-4 && coarse / fine > 3.5, "{coarse:e} {fine:e}");
}

#[test]
fn it_lies_flat_on_its_tube() {
    let model = wheel([0.0, 0.0, -G], 0.5);
    let x = placed(&model, [0.0, 0.0, TUBE], Quat::exp(Vec3([0.0; 3])), [0.0; 3], [0.0; 3]);
    let mut world = World::new(model, x, MethodKind::DormandPrince, 1e-9, 1e-3);
    run(&mut world, 0.01, 20);
    assert!((world.state.q[2] - TUBE).abs() < 1e-9 && world.state.v.iter().all(|v| v.abs() < 1e-9));
    let force: f64 = world.observe(0.2).contacts().map(|c| c.force[2]).sum();
    assert!((force - MASS * G).abs() < 1e-6, "{force}");
}

#[test]
fn the_contact_row_is_the_rate_of_the_gap() {
    // free fall onto the plane at a tilt: it touches when the lowest point of the tube is down
    let theta = 0.9_f64;
    let lowest = RADIUS * libm::sin(theta) + TUBE;
    let turn = Quat::exp(Vec3([0.0, theta, 0.0]));
    let model = wheel([0.0, 0.0, -G], 0.0);
    let x = placed(&model, [0.0, 0.0, lowest + 0.1], turn, [0.0; 3], [0.0; 3]);
    let mut world = World::new(model, x, MethodKind::DormandPrince, 1e-10, 1e-3);
    let falls = (2.0 * 0.1 / G).sqrt();
    world.advance(0.0, 0.999 * falls).unwrap();
    assert_eq!(world.observe(falls).contacts().count(), 0);
    world.advance(0.999 * falls, 0.002 * falls).unwrap();
    // the inelastic impact: the lowest point has no normal rate, v_z + ω·(r × z) = 0, by an impulse through it
    let arm = RADIUS * libm::cos(theta);
    let share = 1.0 / (1.0 + MASS * arm * arm / ACROSS);
    let rot = turn.matrix();
    let v = rot.mul_vec(Vec3([world.state.v[3], world.state.v[4], world.state.v[5]]));
    let expected = -(2.0 * G * 0.1).sqrt() * (1.0 - share);
    assert!((v[2] - expected).abs() < 1e-3 * expected.abs() + 0.01, "{} {expected}", v[2]);
}
