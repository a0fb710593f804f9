//! Bodies in moving air: terminal velocity, wind's work, lag and spinning joints in closed form, power balances.

use sincro_dynamics::actuation::{Motor, MotorMode};
use sincro_dynamics::aero::rotor::{
    ConstantCoefficients, Drag, Rotor, RotorLaw, RotorSpec as Blades, Spin, StockPropeller,
};
use sincro_dynamics::aero::wind::{Gust, Profile, Scales, TurbulenceSpec, Wind};
use sincro_dynamics::batch::{BatchSettings, BatchWorld, advance, advance_alone};
use sincro_dynamics::energy::energy_at;
use sincro_dynamics::joint::JointKind;
use sincro_dynamics::model::{
    BodySpec, DragSpec, JointSpec, Model, ModelBuilder, NodeId, RotorDrive, RotorSpec, Shape,
};
use sincro_dynamics::spatial::{Pose, Quat, Vec3};
use sincro_dynamics::state::State;
use sincro_dynamics::world::{MethodKind, World};

use crate::mechanisms::{ALL, run};

const DENSITY: f64 = 1.225;

fn at(x: f64, y: f64, z: f64) -> Pose<f64> {
    Pose::translation(Vec3([x, y, z]))
}

fn brick(mass: f64) -> BodySpec {
    BodySpec { mass: Shape::Cuboid { size: [0.2, 0.3, 0.4] }.mass_properties(mass / 0.024) }
}

fn blades(spin: Spin) -> RotorLaw {
    let drag = Drag { cd0: 0.0087, k_cd: 0.4 };
    let (radius, chord) = (0.2032, 0.025);
    let spec = Blades { radius, chord, n_blades: 4, lift_slope: 5.7, collective_pitch: 0.1412, drag, spin };
    RotorLaw::Blade(Rotor::new(spec).unwrap())
}

fn rotor(law: RotorLaw, drive: RotorDrive) -> RotorSpec {
    RotorSpec { law, density: DENSITY, drive, inertia: 0.0, ground_effect: false }
}

fn steady(velocity: [f64; 3]) -> Wind {
    Wind::new(velocity, Profile::Constant, vec![], None).unwrap()
}

/// Shear, a gust and turbulence together.
fn rough() -> Wind {
    let shear = Profile::Logarithmic { reference: 6.0, roughness: 0.05 };
    let gust = Gust { start: 0.13, rise: 0.21, peak: [1.0, 2.0, -1.5], holds: false };
    let scales = Scales::Given { deviations: [1.0, 0.8, 0.5], lengths: [20.0, 10.0, 5.0] };
    Wind::new(
        [4.0, -3.0, 0.0],
        shear,
        vec![gust],
        Some(TurbulenceSpec { seed: 5, scales, airspeed: 5.0, convected: false }),
    )
    .unwrap()
}

fn flyer(gravity: f64, drag: Option<DragSpec>, wind: Option<Wind>) -> Model<f64> {
    let mut b = ModelBuilder::new([0.0, 0.0, -gravity]);
    let air = b.joint("air", NodeId::WORLD, at(0.0, 0.0, 3.0), JointSpec::new(JointKind::Free));
    let body = b.body("body", air, Pose::identity(), brick(2.0));
    if let Some(spec) = drag {
        let pose = Pose { rot: Quat::exp(Vec3([0.3, -0.2, 0.5])).matrix(), pos: Vec3([0.05, -0.02, 0.1]) };
        b.drag("drag", body, pose, spec);
    }
    if let Some(wind) = wind {
        b.wind(wind);
    }
    b.build().unwrap().0
}

fn total(world: &mut World) -> f64 {
    let (q, v) = (world.state.q.clone(), world.state.v.clone());
    let mechanism = world.mechanism();
    let model = mechanism.model().clone();
    energy_at(&model, &q, &v, mechanism.scratch()).total()
}

/// Energy − work + dissipation at the end minus the same at the start.
fn imbalance(model: Model<f64>, x: State<f64>, kind: MethodKind) -> f64 {
    let mut world = World::new(model, x, kind, 1e-11, 1e-3);
    let start = total(&mut world);
    run(&mut world, 0.01, 60);
    total(&mut world) - start - world.state.totals[0] + world.state.totals[1]
}

/// A ball on a vertical rail.
fn falling(spec: DragSpec, wind: Option<Wind>) -> World {
    let mut b = ModelBuilder::new([0.0, 0.0, -9.81]);
    let rail = JointSpec::new(JointKind::Prismatic { axis: [0.0, 0.0, 1.0] });
    let rail = b.joint("rail", NodeId::WORLD, Pose::identity(), rail);
    let body = b.body("ball", rail, Pose::identity(), brick(2.0));
    b.drag("drag", body, Pose::identity(), spec);
    if let Some(wind) = wind {
        b.wind(wind);
    }
    let model = b.build().unwrap().0;
    let x = State::new(&model);
    World::new(model, x, MethodKind::DormandPrince, 1e-12, 1e-3)
}

#[test]
fn a_falling_ball_follows_the_hyperbolic_tangent() {
    // m v' = −m g + ½ρa v²: v = −u tanh(g t/u), u² = 2 m g/(ρ a)
    let (m, g, a, t) = (2.0, 9.81, 0.5, 1.7);
    let mut world = falling(DragSpec { area: [a; 3], linear: [0.0; 3], density: DENSITY }, None);
    run(&mut world, t / 10.0, 10);
    let u = (2.0 * m * g / (DENSITY * a)).sqrt();
    assert!((world.state.v[0] + u * libm::tanh(g * t / u)).abs() < 1e-10);
    assert!((world.state.q[0] + u * u / g * libm::log(libm::cosh(g * t / u))).abs() < 1e-10);
    // no wind: drag only takes
    assert!(world.state.totals[0].abs() < 1e-12 && world.state.totals[1] > 0.0);
}

#[test]
fn linear_drag_decays_towards_the_wind() {
    // m v' = −m g − c (v − w): v = (w − m g/c)(1 − exp(−c t/m))
    let (m, g, c, w, t) = (2.0, 9.81, 3.0, 12.0, 0.9);
    let mut world =
        falling(DragSpec { area: [0.0; 3], linear: [0.0, 0.0, c], density: DENSITY }, Some(steady([5.0, 0.0, w])));
    run(&mut world, t / 10.0, 10);
    let expected = (w - m * g / c) * (1.0 - libm::exp(-c * t / m));
    assert!((world.state.v[0] - expected).abs() < 1e-10, "{}", world.state.v[0]);
    // the updraught lifts it: it does work
    assert!(world.state.totals[0] > 0.0 && world.state.totals[1] > 0.0);
}

#[test]
fn a_body_at_rest_in_moving_air_feels_what_a_body_moving_in_still_air_feels() {
    let spec = DragSpec { area: [0.4, 0.7, 0.2], linear: [0.3, 0.0, 0.1], density: DENSITY };
    let rates = |wind: Option<Wind>, v: [f64; 3]| {
        let model = flyer(0.0, Some(spec), wind);
        let mut x = State::new(&model);
        x.v[3..].copy_from_slice(&v);
        let mut world = World::new(model, x, MethodKind::DormandPrince, 1e-9, 1e-3);
        world.rates(0.0).0.to_vec()
    };
    let (still, moving) = (rates(None, [-3.0, 2.0, 1.0]), rates(Some(steady([3.0, -2.0, -1.0])), [0.0; 3]));
    for (a, b) in still.iter().zip(&moving) {
        assert!((a - b).abs() < 1e-13 * a.abs().max(1.0), "{still:?} {moving:?}");
    }
}

#[test]
fn drag_of_equal_areas_knows_no_direction() {
    let spec = DragSpec { area: [0.5; 3], linear: [0.0; 3], density: DENSITY };
    let model = flyer(0.0, Some(spec), None);
    for direction in [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.6, 0.0, 0.8], [-0.36, 0.48, 0.8]] {
        let drag = &model.drags()[0];
        let resistance = drag.resistance(Vec3(direction).scale(7.0), &Pose::identity());
        let expected = 0.5 * DENSITY * 0.5 * 49.0;
        assert!((resistance.force.norm() / expected - 1.0).abs() < 1e-14);
        assert!((resistance.force.dot(Vec3(direction)) + expected).abs() < 1e-12);
        assert!((resistance.dissipation / (7.0 * expected) - 1.0).abs() < 1e-14);
    }
    assert_eq!(model.drags()[0].resistance(Vec3([0.0; 3]), &Pose::identity()).force.0.map(f64::abs), [0.0; 3]);
}

#[test]
fn drag_and_rotors_in_rough_air_are_accounted_for() {
    let build = |drive: RotorDrive| {
        let mut b = ModelBuilder::new([0.0, 0.0, -9.81]);
        let air = b.joint("air", NodeId::WORLD, at(0.0, 0.0, 3.0), JointSpec::new(JointKind::Free));
        let body = b.body("body", air, Pose::identity(), brick(5.0));
        b.drag("drag", body, at(0.0, 0.0, 0.2), DragSpec { area: [0.3, 0.2, 0.5], linear: [0.1; 3], density: DENSITY });
        b.rotor("left", body, at(0.0, 0.4, 0.1), rotor(blades(Spin::Clockwise), drive));
        b.rotor("right", body, at(0.0, -0.4, 0.1), rotor(blades(Spin::CounterClockwise), drive));
        b.wind(rough());
        b.build().unwrap().0
    };
    for drive in [RotorDrive::Command, RotorDrive::Lag { time_constant: 0.1, initial: 300.0 }] {
        let model = build(drive);
        let mut x = State::new(&model);
        x.v.copy_from_slice(&[0.3, -0.2, 0.5, 1.0, 0.5, -0.4]);
        x.commands.copy_from_slice(&[650.0, 700.0]);
        for kind in [MethodKind::DormandPrince, MethodKind::DormandPrince8, MethodKind::Stiff] {
            let e = imbalance(model.clone(), x.clone(), kind);
            assert!(e.abs() < 1e-7, "{drive:?} {kind:?} {e:e}");
        }
    }
}

#[test]
fn a_lag_is_its_exponential_in_every_method() {
    let mut b = ModelBuilder::new([0.0, 0.0, 0.0]);
    let air = b.joint("air", NodeId::WORLD, Pose::identity(), JointSpec::new(JointKind::Free));
    let body = b.body("body", air, Pose::identity(), brick(5.0));
    let (tau, start, command) = (0.136_535_884, 100.0, 750.0);
    let law = RotorLaw::Constant(ConstantCoefficients { thrust: 5e-5, torque: 0.0, spin: Spin::CounterClockwise });
    let lag = RotorDrive::Lag { time_constant: tau, initial: start };
    b.rotor("rotor", body, Pose::identity(), rotor(law, lag));
    let model = b.build().unwrap().0;
    for kind in ALL {
        let mut x = State::new(&model);
        assert_eq!(x.rotors, [start]);
        x.commands[0] = command;
        let mut world = World::new(model.clone(), x, kind, 1e-11, 1e-3);
        run(&mut world, 0.001, 500);
        let expected = command + (start - command) * libm::exp(-0.5 / tau);
        // order 1: half a step by the time constant of what is left to do; order 2: its square
        let tolerance = match kind {
            MethodKind::SemiImplicitEuler => 0.3,
            MethodKind::Implicit => 1e-3,
            _ => 1e-7,
        };
        assert!((world.state.rotors[0] - expected).abs() < tolerance, "{kind:?} {}", world.state.rotors[0] - expected);
    }
    // any time constant is stable where the lag is taken at the new state
    for kind in [MethodKind::SemiImplicitEuler, MethodKind::Implicit, MethodKind::Stiff] {
        let mut fast = model.clone();
        fast = {
            let mut b = ModelBuilder::new([0.0, 0.0, 0.0]);
            let air = b.joint("air", NodeId::WORLD, Pose::identity(), JointSpec::new(JointKind::Free));
            let body = b.body("body", air, Pose::identity(), brick(5.0));
            let law = fast.rotors()[0].law.clone();
            let lag = RotorDrive::Lag { time_constant: 1e-6, initial: start };
            b.rotor("rotor", body, Pose::identity(), rotor(law, lag));
            b.build().unwrap().0
        };
        let mut x = State::new(&fast);
        x.commands[0] = command;
        let mut world = World::new(fast, x, kind, 1e-9, 1e-3);
        run(&mut world, 0.01, 20);
        assert!((world.state.rotors[0] - command).abs() < 1e-3, "{kind:?} {}", world.state.rotors[0]);
    }
}

/// A propeller on a motor joint on a body that can only yaw.
fn spinning(spin: Spin, axis: f64, law: impl Fn(Spin) -> RotorLaw, mode: MotorMode) -> (Model<f64>, NodeId) {
    let mut b = ModelBuilder::new([0.0, 0.0, 0.0]);
    let yaw = JointSpec::new(JointKind::Revolute { axis: [0.0, 0.0, 1.0] });
    let yaw = b.joint("yaw", NodeId::WORLD, Pose::identity(), yaw);
    let body = b.body("body", yaw, Pose::identity(), brick(5.0));
    let shaft =
        JointSpec { motor: vec![Motor::new(mode)], ..JointSpec::new(JointKind::Revolute { axis: [0.0, 0.0, axis] }) };
    let shaft = b.joint("shaft", body, at(0.3, 0.0, 0.1), shaft);
    let disc = BodySpec { mass: Shape::Cylinder { radius: 0.1, length: 0.01 }.mass_properties(300.0) };
    let disc = b.body("disc", shaft, Pose::identity(), disc);
    b.rotor("rotor", disc, Pose::identity(), rotor(law(spin), RotorDrive::Joint(shaft)));
    (b.build().unwrap().0, shaft)
}

#[test]
fn a_rotor_on_a_joint_has_the_joints_speed_and_brakes_it() {
    let law = |spin| RotorLaw::Constant(ConstantCoefficients { thrust: 5e-5, torque: 9e-7, spin });
    for (spin, axis, rate) in [
        (Spin::CounterClockwise, 1.0, 400.0),
        (Spin::Clockwise, 1.0, -400.0),
        (Spin::CounterClockwise, -1.0, -400.0),
        (Spin::Clockwise, -1.0, 400.0),
    ] {
        let (model, _) = spinning(spin, axis, law, MotorMode::Torque);
        assert_eq!(model.n_commands(), 1, "the motor's alone");
        let mut x = State::new(&model);
        x.v[1] = rate;
        let speed = model.rotors()[0].speed.value(&x.v, &x.commands, &x.rotors);
        assert_eq!(speed, 400.0);
        let mut world = World::new(model, x, MethodKind::DormandPrince, 1e-9, 1e-3);
        let v_dot = world.rates(0.0).0.to_vec();
        // the air's torque on the disc is 9e-7·400² against its motion; nothing but the motor's zero turns the body
        let disc = 300.0 * core::f64::consts::PI * 0.01 * 0.01 * 0.5 * 0.01;
        assert!(
            (v_dot[1] * rate.signum() + 9e-7 * 160_000.0 / disc).abs() < 1e-6 * 9e-7 * 160_000.0 / disc,
            "{v_dot:?}"
        );
        assert!(v_dot[0].abs() < 1e-9, "{v_dot:?}");
    }
}

#[test]
fn a_driven_rotor_turns_its_airframe_by_the_airs_torque() {
    // an ideal motor keeps the disc at its rate: what the air takes, the airframe gets
    let (model, _) = spinning(Spin::CounterClockwise, 1.0, blades, MotorMode::Velocity);
    let mut x = State::new(&model);
    (x.v[1], x.commands[0]) = (500.0, 500.0);
    let rotor = model.rotors()[0].clone();
    let mut world = World::new(model, x, MethodKind::DormandPrince, 1e-11, 1e-3);
    world.initialize(0.0);
    let (v_dot, torque) = world.rates(0.0);
    let (v_dot, torque) = (v_dot.to_vec(), torque[0]);
    let RotorLaw::Blade(law) = &rotor.law else { unreachable!() };
    let load = law.evaluate(DENSITY, 500.0, Vec3([0.0; 3]));
    // relative to the airframe's slow yaw the disc's rate is held: both turn back together
    assert!(torque > 0.0 && (torque + load.torque).abs() < 0.01 * torque, "{torque} {}", load.torque);
    assert!(v_dot[0] < 0.0, "the airframe yaws against the rotor");
    let start = total(&mut world);
    run(&mut world, 0.01, 50);
    let e = total(&mut world) - start - world.state.totals[0] + world.state.totals[1];
    assert!(e.abs() < 1e-7, "{e:e}");
}

#[test]
fn commands_of_rotors_come_after_those_of_motors_and_forces() {
    let mut b = ModelBuilder::new([0.0; 3]);
    let air = b.joint("air", NodeId::WORLD, Pose::identity(), JointSpec::new(JointKind::Free));
    let body = b.body("body", air, Pose::identity(), brick(5.0));
    let law = RotorLaw::Constant(ConstantCoefficients { thrust: 1.0, torque: 0.0, spin: Spin::Clockwise });
    for (name, drive) in [("one", RotorDrive::Command), ("two", RotorDrive::Lag { time_constant: 0.1, initial: 0.0 })] {
        b.rotor(name, body, Pose::identity(), rotor(law.clone(), drive));
    }
    let shaft = JointSpec {
        motor: vec![Motor::new(MotorMode::Torque)],
        ..JointSpec::new(JointKind::Revolute { axis: [0.0, 0.0, 1.0] })
    };
    let shaft = b.joint("shaft", body, Pose::identity(), shaft);
    b.body("disc", shaft, Pose::identity(), brick(0.1));
    b.rotor("three", shaft, Pose::identity(), rotor(law.clone(), RotorDrive::Joint(shaft)));
    b.rotor("four", body, Pose::identity(), rotor(law, RotorDrive::Command));
    let model = b.build().unwrap().0;
    let commands: Vec<_> = model.rotors().iter().map(|r| r.speed.command()).collect();
    assert_eq!(commands, [Some(1), Some(2), None, Some(3)]);
    assert_eq!((model.n_commands(), model.n_rotor_states()), (4, 1));
}

#[test]
fn a_rotor_must_turn_with_its_joint() {
    let build = |rotor_on_body: bool, turned: bool| {
        let mut b = ModelBuilder::new([0.0; 3]);
        let air = b.joint("air", NodeId::WORLD, Pose::identity(), JointSpec::new(JointKind::Free));
        let body = b.body("body", air, Pose::identity(), brick(5.0));
        let shaft = JointSpec::new(JointKind::Revolute { axis: [0.0, 0.0, 1.0] });
        let shaft = b.joint("shaft", body, Pose::identity(), shaft);
        let disc = b.body("disc", shaft, Pose::identity(), brick(0.1));
        let on = if rotor_on_body { body } else { disc };
        let rot = Quat::exp(Vec3([if turned { 0.1 } else { 0.0 }, 0.0, 0.0])).matrix();
        b.rotor(
            "rotor",
            on,
            Pose { rot, pos: Vec3([0.0; 3]) },
            rotor(blades(Spin::Clockwise), RotorDrive::Joint(shaft)),
        );
        b.build().map(|_| ()).map_err(|diagnostics| diagnostics[0].message.clone())
    };
    assert_eq!(build(false, false), Ok(()));
    assert!(build(true, false).unwrap_err().contains("does not turn with it"));
    assert!(build(false, true).unwrap_err().contains("axis of rotor `rotor` is not that of joint `shaft`"));
}

#[test]
fn inertia_and_ground_effect_are_refused_where_they_mean_nothing() {
    let stock = RotorLaw::Stock(StockPropeller::default());
    let constant = RotorLaw::Constant(ConstantCoefficients { thrust: 1e-5, torque: 0.0, spin: Spin::Clockwise });
    let fields = |law: &RotorLaw, on_joint: bool, inertia: f64, ground_effect: bool| {
        let mut b = ModelBuilder::new([0.0; 3]);
        let shaft = JointSpec::new(JointKind::Revolute { axis: [0.0, 0.0, 1.0] });
        let shaft = b.joint("shaft", NodeId::WORLD, Pose::identity(), shaft);
        let disc = b.body("disc", shaft, Pose::identity(), brick(0.1));
        let drive = if on_joint { RotorDrive::Joint(shaft) } else { RotorDrive::Command };
        let spec = RotorSpec { inertia, ground_effect, ..rotor(law.clone(), drive) };
        b.rotor("rotor", disc, Pose::identity(), spec);
        b.build().map_or_else(|found| found.iter().map(|d| d.field).collect::<Vec<_>>(), |_| vec![])
    };
    let blade = blades(Spin::Clockwise);
    for inertia in [f64::NAN, -1e-6, f64::INFINITY] {
        assert_eq!(fields(&blade, false, inertia, false), ["inertia"], "{inertia}");
    }
    // a joint's bodies have theirs already; what knows no sense of rotation has no axis to turn about
    assert_eq!(fields(&blade, true, 1e-6, false), ["inertia"]);
    assert_eq!(fields(&stock, false, 1e-6, false), ["inertia"]);
    assert_eq!(fields(&constant, false, 0.0, true), ["ground_effect"]);
    assert!(fields(&blade, true, 0.0, true).is_empty());
    assert!(fields(&blade, false, 1e-6, true).is_empty());
    assert!(fields(&constant, false, 1e-6, false).is_empty());
}

#[test]
fn lanes_have_the_bits_of_single_worlds_in_rough_air() {
    let build = |k: u32| {
        let mut b = ModelBuilder::new([0.0, 0.0, -9.81]);
        let air = b.joint("air", NodeId::WORLD, at(0.0, 0.0, 3.0), JointSpec::new(JointKind::Free));
        let body = b.body("body", air, Pose::identity(), brick(5.0 + f64::from(k)));
        let area = [0.3 + 0.01 * f64::from(k), 0.2, 0.5];
        b.drag("drag", body, at(0.0, 0.0, 0.2), DragSpec { area, linear: [0.1; 3], density: DENSITY });
        let lag = RotorDrive::Lag { time_constant: 0.1 + 0.01 * f64::from(k), initial: 300.0 + f64::from(k) };
        let heavy = |spin, drive| RotorSpec { inertia: 2e-3, ground_effect: true, ..rotor(blades(spin), drive) };
        b.rotor("left", body, at(0.0, 0.4, 0.1), heavy(Spin::Clockwise, lag));
        b.rotor("right", body, at(0.0, -0.4, 0.1), heavy(Spin::CounterClockwise, RotorDrive::Command));
        let scales = Scales::Given { deviations: [1.0; 3], lengths: [20.0; 3] };
        let turbulence = Some(TurbulenceSpec { seed: 5, scales, airspeed: 5.0, convected: true });
        let shear = Profile::Logarithmic { reference: 6.0, roughness: 0.05 };
        b.wind(Wind::new([4.0, -3.0, 0.0], shear, vec![], turbulence).unwrap());
        let model = b.build().unwrap().0;
        let mut x = State::new(&model);
        x.commands.copy_from_slice(&[650.0, 700.0 - f64::from(k)]);
        x.v[0] = 0.1 * f64::from(k);
        BatchWorld::new(model, x)
    };
    for method in [MethodKind::SemiImplicitEuler, MethodKind::Rk4, MethodKind::Implicit] {
        let settings = BatchSettings { method, h: 0.005, n_steps: 100, record_every: 0 };
        let mut together: Vec<BatchWorld> = (0..8).map(build).collect();
        let mut alone = together.clone();
        advance(&mut together, &settings).unwrap();
        for (k, (world, other)) in alone.iter_mut().zip(&together).enumerate() {
            advance_alone(world, &settings);
            assert_eq!(world.stop, None);
            assert_eq!(world.state, other.state, "{method:?} {k}");
        }
    }
}

#[test]
fn gusts_are_corners_and_end_where_they_said() {
    let gust = |start, holds| Gust { start, rise: 0.5, peak: [1.0, 0.0, 0.0], holds };
    let wind = Wind::new([0.0; 3], Profile::Constant, vec![gust(1.0, false), gust(2.5, true)], None).unwrap();
    let mut t = -1.0;
    let corners: Vec<f64> = core::iter::from_fn(|| {
        t = wind.next_time_event(t);
        t.is_finite().then_some(t)
    })
    .collect();
    assert_eq!(corners, [1.0, 2.0, 2.5, 3.0]);
    assert_eq!(wind.velocity::<f64>(2.25, 0.0)[0], 0.0);
    assert_eq!(wind.velocity::<f64>(9.0, 0.0)[0], 1.0);
}
