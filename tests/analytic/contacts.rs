//! Contact against closed forms: bouncing, sliding, sticking, rolling.

use sincro_dynamics::contact::{Material, Surface};
use sincro_dynamics::joint::JointKind;
use sincro_dynamics::model::{BodySpec, JointSpec, Model, ModelBuilder, NodeId, Shape};
use sincro_dynamics::spatial::{Pose, Quat, Vec3};
use sincro_dynamics::state::State;
use sincro_dynamics::world::{MethodKind, World};

use crate::mechanisms::run;

const G: f64 = 9.81;

/// Methods that locate events.
const LOCATING: [MethodKind; 4] = [MethodKind::Rk4, MethodKind::Implicit, MethodKind::DormandPrince, MethodKind::Stiff];

/// A free body of a shape over a plane that is tilted about y by an angle; gravity points down.
fn on_a_plane(shape: Shape, tilt: f64, floor: Material, body: Material) -> Model<f64> {
    let mut b = ModelBuilder::new([0.0, 0.0, -G]);
    let turn = Quat::exp(Vec3([0.0, tilt, 0.0])).matrix();
    b.collider(NodeId::WORLD, Pose { rot: turn, pos: Vec3::zero() }, Surface::HalfSpace, floor);
    let free = b.joint("free", NodeId::WORLD, Pose::identity(), JointSpec::new(JointKind::Free));
    let it = b.body("it", free, Pose::identity(), BodySpec { mass: shape.mass_properties(1000.0) });
    b.collider(it, Pose::identity(), Surface::Solid(shape), body);
    b.build().unwrap().0
}

/// A state with the body's axes along the plane's and its centre at a height over it.
fn placed(model: &Model<f64>, tilt: f64, height: f64) -> State<f64> {
    let mut x = State::new(model);
    let turn = Quat::exp(Vec3([0.0, tilt, 0.0]));
    let n = turn.matrix().col(2);
    x.q[..3].copy_from_slice(&n.scale(height).0);
    turn.write(&mut x.q[3..7]);
    x
}

fn material(friction: f64, restitution: f64) -> Material {
    Material { friction, restitution, ..Material::default() }
}

#[test]
fn a_ball_bounces_as_its_closed_form_says() {
    let (r, e, h0) = (0.05, 0.8, 1.0);
    for kind in LOCATING {
        let model = on_a_plane(Shape::Sphere { radius: r }, 0.0, material(0.0, 0.0), material(0.0, e));
        let x = placed(&model, 0.0, r + h0);
        let mut world = World::new(model, x, kind, 1e-10, 1e-3);
        let v0 = (2.0 * G * h0).sqrt();
        // the instant of the third impact, and the height between it and the next
        let t3 = v0 / G * (1.0 + 2.0 * e + 2.0 * e * e);
        let end = t3 + 0.1;
        let v3 = v0 * e * e * e;
        let expected = r + v3 * 0.1 - 0.5 * G * 0.01;
        let n = 200;
        run(&mut world, end / f64::from(n), n);
        assert!((world.state.q[2] - expected).abs() < 1e-9, "{kind:?} {:e}", world.state.q[2] - expected);
        assert_eq!(world.effort().impacts, 3, "{kind:?}");
    }
}

#[test]
fn a_ball_comes_to_rest_in_finite_time() {
    let (r, e) = (0.05, 0.5);
    let model = on_a_plane(Shape::Sphere { radius: r }, 0.0, material(0.0, e), material(0.0, e));
    let mut x = State::new(&model);
    x.q[2] = r + 0.1;
    let mut world = World::new(model, x, MethodKind::DormandPrince, 1e-9, 1e-3);
    run(&mut world, 0.01, 100);
    assert!((world.state.q[2] - r).abs() < 1e-11);
    assert!(world.state.v[5].abs() < 1e-11);
}

#[test]
fn a_block_sticks_just_below_the_critical_angle_and_slides_just_above() {
    let size = [0.2, 0.1, 0.05];
    let mu: f64 = 0.5;
    let critical = libm::atan(mu);
    for kind in LOCATING {
        for (tilt, slides) in [(critical - 1e-6, false), (critical + 1e-6, true), (critical + 0.1, true)] {
            let model = on_a_plane(Shape::Cuboid { size }, tilt, material(mu, 0.0), material(mu, 0.0));
            let x = placed(&model, tilt, 0.025);
            let start = x.q.clone();
            let mut world = World::new(model, x, kind, 1e-10, 1e-3);
            world.settle_start(0.0);
            run(&mut world, 0.01, 100);
            let moved: f64 =
                (0..3).map(|k| (world.state.q[k] - start[k]) * (world.state.q[k] - start[k])).sum::<f64>().sqrt();
            if slides {
                let a = G * (libm::sin(tilt) - mu * libm::cos(tilt));
                assert!((moved - 0.5 * a).abs() < 1e-9, "{kind:?} {tilt}: {moved:e} {:e}", 0.5 * a);
            } else {
                assert!(moved < 1e-12, "{kind:?}: creeps {moved:e}");
            }
        }
    }
}

#[test]
fn a_ball_slips_then_rolls() {
    // v0 = 1, no spin: rolls from t = 2 v0/(7 μ g) with 5/7 v0
    let (r, mu, v0) = (0.05, 0.2, 1.0);
    let error = |kind: MethodKind, n: u32| {
        let model = on_a_plane(Shape::Sphere { radius: r }, 0.0, material(mu, 0.0), material(mu, 0.0));
        let mut x = placed(&model, 0.0, r);
        x.v[3] = v0;
        let mut world = World::new(model, x, kind, 1e-10, 1e-3);
        world.settle_start(0.0);
        let t = 2.0 * v0 / (7.0 * mu * G);
        run(&mut world, 0.5 / f64::from(n), n);
        let slipped = v0 * t - 0.5 * mu * G * t * t;
        assert!((world.state.q[2] - r).abs() < 1e-11, "{kind:?}");
        assert_eq!(world.effort().events, 1, "{kind:?}");
        (world.state.q[0] - slipped - 5.0 / 7.0 * v0 * (0.5 - t)).abs()
    };
    for kind in [MethodKind::DormandPrince, MethodKind::Stiff] {
        assert!(error(kind, 100) < 1e-9, "{kind:?}");
    }
    // the order of the method survives the transition
    for (kind, order) in [(MethodKind::Rk4, 4.0), (MethodKind::Implicit, 2.0)] {
        let measured = libm::log2(error(kind, 100) / error(kind, 200));
        assert!((measured - order).abs() < 0.2, "{kind:?} {measured}");
    }
}
