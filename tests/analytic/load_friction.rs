//! Friction that grows with the load of its bearing, against closed forms.

use sincro_dynamics::joint::Friction;
use sincro_dynamics::prelude::*;
use sincro_dynamics::signal::Signal;

use crate::mechanisms::run;

const LOCATED: [MethodKind; 5] =
    [MethodKind::Rk4, MethodKind::Implicit, MethodKind::DormandPrince, MethodKind::DormandPrince8, MethodKind::Stiff];

fn loaded(load_coefficient: f64) -> Vec<Friction<f64>> {
    vec![Friction { load_coefficient, ..Friction::none() }]
}

fn point_mass(mass: f64, center_of_mass: [f64; 3], inertia: f64) -> BodySpec {
    BodySpec { mass: MassProperties { mass, center_of_mass, inertia: [inertia, 0.0, 0.0, inertia, 0.0, inertia] } }
}

fn world(model: Model<f64>, v: f64, kind: MethodKind, h: f64) -> World {
    let mut x = State::new(&model);
    x.v[0] = v;
    World::new(model, x, kind, 1e-10, h)
}

/// A slider on a rail at an angle to the horizontal.
fn slope(angle: f64, friction: Vec<Friction<f64>>) -> Model<f64> {
    let mut b = ModelBuilder::new([0.0, 0.0, -9.81]);
    let (sin, cos) = (libm::sin(angle), libm::cos(angle));
    let joint = JointSpec { friction, ..JointSpec::new(JointKind::Prismatic { axis: [2.0 * cos, 0.0, -2.0 * sin] }) };
    let joint = b.joint("rail", NodeId::WORLD, Pose::identity(), joint);
    b.body("block", joint, Pose::identity(), point_mass(2.5, [0.1, 0.2, 0.3], 1.0));
    b.build().unwrap().0
}

#[test]
fn a_slider_on_a_slope_slides_and_stops_as_coulomb_says() {
    let (g, mu) = (9.81, 0.3);
    for kind in LOCATED {
        // on the level it stops after v/(μ g), and stays
        let mut level = world(slope(0.0, loaded(mu)), 1.0, kind, 0.01);
        run(&mut level, 0.01, 60);
        let way = 1.0 / (2.0 * mu * g);
        assert!((level.state.q[0] - way).abs() < 1e-12, "{kind:?} {} {way}", level.state.q[0]);
        assert_eq!((level.state.v[0], level.state.drives[0]), (0.0, 0.0), "{kind:?}");
        // on a slope of tan α < μ it stays where it is, on a steeper one it is accelerated
        let mut flat = world(slope(libm::atan(0.29), loaded(mu)), 0.0, kind, 0.01);
        run(&mut flat, 0.01, 20);
        assert_eq!((flat.state.q[0], flat.state.v[0]), (0.0, 0.0), "{kind:?}");
        let angle = 0.5;
        let mut steep = world(slope(angle, loaded(mu)), 0.0, kind, 0.01);
        run(&mut steep, 0.01, 100);
        let expected = g * (libm::sin(angle) - mu * libm::cos(angle));
        assert!((steep.state.v[0] - expected).abs() < 1e-11, "{kind:?} {} {expected}", steep.state.v[0]);
    }
}

#[test]
fn an_eccentric_rotor_slows_down_by_its_own_centrifugal_force() {
    // N = m e √(ω⁴ + α²) and I α = −c N: α = −k ω² with k = c m e/√(I² − (c m e)²), so that ω = ω₀/(1 + k ω₀ t)
    let (m, e, inertia, c, start) = (2.0, 0.1, 0.05_f64, 0.2, 30.0);
    let about_axis = inertia + m * e * e;
    let k = c * m * e / (about_axis * about_axis - (c * m * e) * (c * m * e)).sqrt();
    let mut b = ModelBuilder::new([0.0; 3]);
    let joint = JointSpec { friction: loaded(c), ..JointSpec::new(JointKind::Revolute { axis: [0.0, 0.0, 1.0] }) };
    let joint = b.joint("hinge", NodeId::WORLD, Pose::identity(), joint);
    b.body("rotor", joint, Pose::identity(), point_mass(m, [e, 0.0, 0.0], inertia));
    let model = b.build().unwrap().0;
    for (kind, h, tolerance) in
        [(MethodKind::DormandPrince, 0.01, 1e-8), (MethodKind::Stiff, 0.01, 1e-8), (MethodKind::Rk4, 1e-4, 1e-8)]
    {
        let mut rotor = world(model.clone(), start, kind, h);
        run(&mut rotor, h, (0.5 / h) as u32);
        let expected = start / (1.0 + k * start * 0.5);
        assert!((rotor.state.v[0] - expected).abs() < tolerance, "{kind:?} {} {expected}", rotor.state.v[0]);
        // what friction takes is what is lost
        let lost = 0.5 * about_axis * (start * start - rotor.state.v[0] * rotor.state.v[0]);
        assert!((rotor.state.totals[1] - lost).abs() < 1e-6, "{kind:?} {} {lost}", rotor.state.totals[1]);
    }
}

#[test]
fn a_joint_that_jams_stops_at_once() {
    // c m e > I: no friction fits, a step at velocity level stops the joint and is counted
    let mut b = ModelBuilder::new([0.0; 3]);
    let joint = JointSpec { friction: loaded(2.0), ..JointSpec::new(JointKind::Revolute { axis: [0.0, 0.0, 1.0] }) };
    let joint = b.joint("hinge", NodeId::WORLD, Pose::identity(), joint);
    b.body("rotor", joint, Pose::identity(), point_mass(2.0, [0.1, 0.0, 0.0], 0.05));
    let mut rotor = world(b.build().unwrap().0, 30.0, MethodKind::DormandPrince, 0.01);
    rotor.advance(0.0, 0.01).unwrap();
    assert_eq!((rotor.state.v[0], rotor.state.drives[0], rotor.jams().count), (0.0, 0.0, 1));
}

/// Two links, friction with load in both joints, a limited motor in the first.
fn arm(with_floor: bool) -> Model<f64> {
    let mut b = ModelBuilder::new([0.0, 0.0, -9.81]);
    let hinge = JointKind::Revolute { axis: [0.0, 1.0, 0.0] };
    let friction = || vec![Friction { at_rest: 0.3, sliding: 0.2, stribeck_velocity: 0.1, load_coefficient: 0.01 }];
    let motor = vec![Motor { max_torque: 3.0, ..Motor::new(MotorMode::Velocity) }];
    let shoulder = JointSpec { friction: friction(), motor, ..JointSpec::new(hinge) };
    let shoulder = b.joint("shoulder", NodeId::WORLD, Pose::identity(), shoulder);
    let upper = b.body("upper", shoulder, Pose::identity(), point_mass(1.0, [0.5, 0.0, 0.0], 0.1));
    let push = Signal::Sine { amplitude: 2.0, angular_frequency: 5.0, phase: 0.0, offset: 0.0 };
    let elbow = JointSpec { friction: friction(), torque: vec![push], ..JointSpec::new(hinge) };
    let elbow = b.joint("elbow", upper, Pose::translation(Vec3([1.0, 0.0, 0.0])), elbow);
    let fore = b.body("fore", elbow, Pose::identity(), point_mass(0.8, [0.4, 0.0, 0.0], 0.05));
    if with_floor {
        let material = Material { friction: 0.4, ..Material::default() };
        let tip = Pose::translation(Vec3([0.8, 0.0, 0.0]));
        b.collider(fore, tip, Surface::Solid(Shape::Sphere { radius: 0.1 }), material);
        let floor = Pose::translation(Vec3([0.0, 0.0, -0.9]));
        b.collider(NodeId::WORLD, floor, Surface::Solid(Shape::Cuboid { size: [9.0, 9.0, 0.2] }), material);
    }
    b.build().unwrap().0
}

#[test]
fn an_arm_with_loaded_bearings_keeps_its_balance_with_every_method() {
    for with_floor in [false, true] {
        let model = arm(with_floor);
        let end = |kind: MethodKind, h: f64| {
            let mut x = State::new(&model);
            x.commands[0] = 0.7;
            let mut world = World::new(model.clone(), x, kind, 1e-10, h);
            let before = world.energy().total();
            run(&mut world, h, (1.5 / h).round() as u32);
            let (work, heat) = (world.state.totals[0], world.state.totals[1]);
            let balance = world.energy().total() - before - work + heat;
            (world.state.q.clone(), balance)
        };
        let (q, balance) = end(MethodKind::DormandPrince, 0.005);
        let (stiff, of_stiff) = end(MethodKind::Stiff, 0.005);
        if !with_floor {
            assert!(balance.abs() < 1e-7 && of_stiff.abs() < 1e-7, "{balance:e} {of_stiff:e}");
        }
        assert!((0..2).all(|k| (q[k] - stiff[k]).abs() < 1e-6), "{with_floor} {q:?} {stiff:?}");
        let (coarse, _) = end(MethodKind::SemiImplicitEuler, 1e-3);
        let (fine, _) = end(MethodKind::SemiImplicitEuler, 1e-4);
        let apart = |other: &[f64]| (0..2).map(|k| (other[k] - q[k]).abs()).fold(0.0, f64::max);
        assert!(apart(&fine) < 2e-3 && apart(&fine) < 0.5 * apart(&coarse), "{with_floor} {coarse:?} {fine:?} {q:?}");
    }
}
