//! Gravity and density of the air over the position: orbits, energy, ballistic entry.

use sincro_dynamics::actuation::GravityField;
use sincro_dynamics::aero::rotor::{Drag, Rotor, RotorLaw, RotorSpec as Blades, Spin};
use sincro_dynamics::batch::obstacle_to_lanes;
use sincro_dynamics::joint::JointKind;
use sincro_dynamics::model::{
    BodySpec, DragSpec, JointSpec, MassProperties, Model, ModelBuilder, NodeId, RotorDrive, RotorSpec,
};
use sincro_dynamics::spatial::{Pose, Vec3};
use sincro_dynamics::state::State;
use sincro_dynamics::world::{MethodKind, World};
use sincro_math::expression::Expression;
use sincro_math::scalar_field::{POSITION_NAMES, ScalarField};

use crate::mechanisms::run;

fn field(text: &str) -> ScalarField {
    ScalarField::new(Expression::parse(text, &POSITION_NAMES).unwrap()).unwrap()
}

/// Inverse-square gravity with μ = 1 m³/s² about the origin.
fn inverse_square(potential: Option<&str>) -> GravityField {
    let along = |axis: &str| field(&format!("-{axis}/(x^2 + y^2 + z^2)^1.5"));
    GravityField { acceleration: ["x", "y", "z"].map(along), potential: potential.map(field) }
}

const POTENTIAL: &str = "-1/sqrt(x^2 + y^2 + z^2)";

/// A ball on a free joint, its centre of mass beside the origin of the body.
fn satellite(gravity: GravityField) -> Model<f64> {
    let mut b = ModelBuilder::new([0.0; 3]);
    b.set_gravity_field(gravity);
    let free = b.joint("free", NodeId::WORLD, Pose::identity(), JointSpec::new(JointKind::Free));
    let mass =
        MassProperties { mass: 3.0, center_of_mass: [0.1, 0.0, 0.0], inertia: [1e-2, 0.0, 0.0, 1e-2, 0.0, 1e-2] };
    b.body("ball", free, Pose::identity(), BodySpec { mass });
    b.build().unwrap().0
}

/// Period 2π, eccentricity 0.3, from the pericentre of the centre of mass.
fn orbit(gravity: GravityField, kind: MethodKind) -> World {
    let model = satellite(gravity);
    let mut x = State::new(&model);
    x.q[0] = 0.6;
    x.v[4] = (1.3_f64 / 0.7).sqrt();
    World::new(model, x, kind, 1e-13, 1e-3)
}

fn center(world: &World) -> Vec3<f64> {
    Vec3([world.state.q[0] + 0.1, world.state.q[1], world.state.q[2]])
}

#[test]
fn an_orbit_of_inverse_square_gravity_closes() {
    for kind in [MethodKind::DormandPrince, MethodKind::DormandPrince8, MethodKind::Stiff] {
        let mut world = orbit(inverse_square(Some(POTENTIAL)), kind);
        let energy = world.energy().total();
        // −μ/2a of the centre of mass
        assert!((energy + 0.5 * 3.0).abs() < 1e-12, "{energy}");
        run(&mut world, core::f64::consts::TAU / 100.0, 50);
        let apocentre = (center(&world) + Vec3([1.3, 0.0, 0.0])).norm();
        run(&mut world, core::f64::consts::TAU / 100.0, 50);
        let closure = (center(&world) - Vec3([0.7, 0.0, 0.0])).norm();
        let drift = (world.energy().total() - energy).abs();
        println!("{kind:?}: apocentre {apocentre:.1e} m, closure {closure:.1e} m, energy {drift:.1e} J");
        assert!(apocentre < 1e-9 && closure < 1e-9 && drift < 1e-11, "{kind:?}: {apocentre:e} {closure:e} {drift:e}");
        assert!(world.state.totals[0].abs() < 1e-12, "a potential does no work: {}", world.state.totals[0]);
    }
}

#[test]
fn gravity_without_a_potential_does_the_work_of_it() {
    let mut world = orbit(inverse_square(None), MethodKind::DormandPrince);
    let start = world.energy();
    run(&mut world, 0.01, 150);
    let end = world.energy();
    assert_eq!(end.potential, 0.0);
    let (from, to) = (-3.0 / 0.7, -3.0 / center(&world).norm());
    assert!((world.state.totals[0] - (from - to)).abs() < 1e-10);
    assert!((end.kinetic - start.kinetic - world.state.totals[0]).abs() < 1e-10);
}

#[test]
fn two_masses_of_one_link_feel_the_gradient() {
    // torque of a dumbbell at 45°: Σ r × m g
    let mut b = ModelBuilder::new([0.0; 3]);
    b.set_gravity_field(inverse_square(None));
    let at = |p: [f64; 3]| Pose::translation(Vec3(p));
    let hinge = b.joint(
        "hinge",
        NodeId::WORLD,
        at([1.0, 0.0, 0.0]),
        JointSpec::new(JointKind::Revolute { axis: [0.0, 0.0, 1.0] }),
    );
    let mass = MassProperties { mass: 1.0, center_of_mass: [0.0; 3], inertia: [0.0; 6] };
    let half = 0.1 * core::f64::consts::FRAC_1_SQRT_2;
    for (name, side) in [("one", half), ("other", -half)] {
        b.body(name, hinge, at([side, side, 0.0]), BodySpec { mass });
    }
    let model = b.build().unwrap().0;
    let x = State::new(&model);
    let found = World::new(model, x, MethodKind::Rk4, 1e-9, 1e-3).rates(0.0).0[0];
    let torque = |side: f64| {
        let p = [1.0 + side, side];
        let square = p[0] * p[0] + p[1] * p[1];
        let cube = square * square.sqrt();
        side * (-p[1] / cube) - side * (-p[0] / cube)
    };
    let expected = (torque(half) + torque(-half)) / (2.0 * 0.01);
    assert!((found - expected).abs() < 1e-12 && expected.abs() > 1e-1, "{found} {expected}");
}

#[test]
fn a_potential_that_is_none_of_the_acceleration_is_noticed() {
    let at = Vec3([0.3, -0.8, 0.5]);
    assert_eq!(inverse_square(Some(POTENTIAL)).inconsistency(at), None);
    assert!(inverse_square(Some("1/sqrt(x^2 + y^2 + z^2)")).inconsistency(at).is_some());
    assert!(inverse_square(Some("ln(-1 - x^2)")).inconsistency(at).is_some());
}

/// Density of an isothermal atmosphere, scale height 8.5 km.
const ATMOSPHERE: &str = "1.225*exp(-z/8500)";

#[test]
fn a_body_enters_the_atmosphere_along_the_closed_form() {
    // without gravity v = v₀ exp(−½ ρ₀ a H/m (e^{−z/H} − e^{−z₀/H})) (Allen and Eggers)
    let mut b = ModelBuilder::new([0.0; 3]);
    b.set_air_density(field(ATMOSPHERE));
    let down = JointKind::Prismatic { axis: [0.0, 0.0, 1.0] };
    let down = b.joint("down", NodeId::WORLD, Pose::identity(), JointSpec::new(down));
    let mass = MassProperties { mass: 500.0, center_of_mass: [0.0; 3], inertia: [1.0, 0.0, 0.0, 1.0, 0.0, 1.0] };
    let body = b.body("capsule", down, Pose::identity(), BodySpec { mass });
    b.drag("hull", body, Pose::identity(), DragSpec { area: [0.3; 3], linear: [0.0; 3], density: 7.0 });
    let model = b.build().unwrap().0;
    assert_eq!(obstacle_to_lanes(&model, MethodKind::Rk4), Some("a density of the air that depends on the position"));
    let (z0, v0) = (80e3, 6000.0);
    let mut x = State::new(&model);
    (x.q[0], x.v[0]) = (z0, -v0);
    let mut world = World::new(model, x, MethodKind::DormandPrince, 1e-12, 1e-3);
    let start = world.energy().total();
    for _ in 0..4 {
        let t = world.time();
        for k in 0..50 {
            world.advance(t + 0.1 * f64::from(k), 0.1).unwrap();
        }
        let (z, v) = (world.state.q[0], -world.state.v[0]);
        let share = |z: f64| libm::exp(-z / 8500.0);
        let expected = v0 * libm::exp(-0.5 * 1.225 * 0.3 * 8500.0 / 500.0 * (share(z) - share(z0)));
        assert!((v / expected - 1.0).abs() < 1e-10, "at {z} m: {v} {expected}");
    }
    let balance = world.energy().total() - start - world.state.totals[0] + world.state.totals[1];
    assert!(balance.abs() < 1e-8 * start, "{balance}");
}

#[test]
fn a_rotor_has_the_load_of_the_density_where_it_is() {
    let acceleration = |density: f64, atmosphere: Option<&str>, height: f64| {
        let mut b = ModelBuilder::new([0.0, 0.0, -9.81]);
        if let Some(text) = atmosphere {
            b.set_air_density(field(text));
        }
        let free = b.joint("free", NodeId::WORLD, Pose::identity(), JointSpec::new(JointKind::Free));
        let mass = MassProperties { mass: 1.0, center_of_mass: [0.0; 3], inertia: [0.1, 0.0, 0.0, 0.1, 0.0, 0.1] };
        let body = b.body("hull", free, Pose::identity(), BodySpec { mass });
        let drag = Drag { cd0: 0.0087, k_cd: 0.4 };
        let (radius, chord, spin) = (0.2032, 0.025, Spin::Clockwise);
        let spec = Blades { radius, chord, n_blades: 4, lift_slope: 5.7, collective_pitch: 0.1412, drag, spin };
        let law = RotorLaw::Blade(Rotor::new(spec).unwrap());
        let spec = RotorSpec { law, density, drive: RotorDrive::Command, inertia: 0.0, ground_effect: false };
        b.rotor("rotor", body, Pose::identity(), spec);
        let model = b.build().unwrap().0;
        let mut x = State::new(&model);
        (x.q[2], x.commands[0]) = (height, 500.0);
        World::new(model, x, MethodKind::Rk4, 1e-9, 1e-3).rates(0.0).0.to_vec()
    };
    let height = 2400.0;
    let here = 1.225 * libm::exp(-height / 8500.0);
    let (uniform, varying) = (acceleration(here, None, height), acceleration(1.0, Some(ATMOSPHERE), height));
    for (a, b) in uniform.iter().zip(&varying) {
        assert!((a - b).abs() < 1e-13 * a.abs().max(1.0), "{uniform:?} {varying:?}");
    }
}

#[test]
fn lanes_name_what_they_cannot_do() {
    let model = satellite(inverse_square(None));
    assert_eq!(obstacle_to_lanes(&model, MethodKind::Rk4), Some("gravity that depends on the position"));
}
