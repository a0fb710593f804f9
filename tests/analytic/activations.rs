//! Activations of actuators against closed forms: a filter and an integrator before the torque of a wheel, the ends of
//! their range, and the force along a path.
//!
//! A filter with the time constant τ under the constant command u has a = u (1 − e^{−t/τ}) and on the inertia D the
//! speed ω = u (t − τ (1 − e^{−t/τ}))/D. An integrator has a = u t and ω = u t²/(2 D) until it reaches the end a⁺ of
//! its range at t⁺ = a⁺/u, and then ω = a⁺ (t − t⁺/2)/D.

use sincro_dynamics::actuation::{Activation, ActivationDynamics, ForceLaw, Motor, MotorMode, Winding};
use sincro_dynamics::batch::{BatchSettings, BatchWorld, advance, advance_alone};
use sincro_dynamics::joint::JointKind;
use sincro_dynamics::model::{
    BodySpec, JointSpec, MassProperties, Model, ModelBuilder, NodeId, PathSpec, SpringDamperSpec,
};
use sincro_dynamics::spatial::Pose;
use sincro_dynamics::state::State;
use sincro_dynamics::world::{MethodKind, World};

use crate::mechanisms::{ALL, run};

const INERTIA: f64 = 0.02;
const COMMAND: f64 = 3.0;
const FILTER: Activation<f64> = Activation {
    command: 0,
    state: 0,
    dynamics: ActivationDynamics::Filter { time_constant: 0.05 },
    input_range: [f64::NEG_INFINITY, f64::INFINITY],
    range: [f64::NEG_INFINITY, f64::INFINITY],
    initial: 0.0,
};
const INTEGRATOR: Activation<f64> = Activation { dynamics: ActivationDynamics::Integrator, ..FILTER };

fn wheel(motor: Motor<f64>, activation: Activation<f64>, winding: Option<Winding<f64>>) -> Result<Model<f64>, String> {
    let mut b = ModelBuilder::new([0.0; 3]);
    let joint = JointSpec {
        motor: vec![motor],
        winding: vec![winding],
        activation: vec![Some(activation)],
        ..JointSpec::new(JointKind::Revolute { axis: [0.0, 0.0, 1.0] })
    };
    let joint = b.joint("shaft", NodeId::WORLD, Pose::identity(), joint);
    let inertia = [INERTIA, 0.0, 0.0, INERTIA, 0.0, INERTIA];
    let mass = MassProperties { mass: 1.0, center_of_mass: [0.0; 3], inertia };
    b.body("wheel", joint, Pose::identity(), BodySpec { mass });
    b.build().map(|(model, _)| model).map_err(|e| e.to_string())
}

fn torque(activation: Activation<f64>) -> Model<f64> {
    wheel(Motor::new(MotorMode::Torque), activation, None).unwrap()
}

fn started(model: Model<f64>, kind: MethodKind, accuracy: f64) -> World {
    let mut x = State::new(&model);
    x.commands[0] = COMMAND;
    World::new(model, x, kind, accuracy, 1e-3)
}

#[test]
fn a_filtered_torque_has_its_closed_form_at_the_order_of_each_method() {
    let (t, tau) = (0.1, 0.05);
    let lag = 1.0 - libm::exp(-t / tau);
    let (activation, speed) = (COMMAND * lag, COMMAND * (t - tau * lag) / INERTIA);
    let error = |kind, n: u32| {
        let mut world = started(torque(FILTER), kind, 1e-11);
        run(&mut world, t / f64::from(n), n);
        let error = (world.state.v[0] - speed).abs() / speed;
        error.max((world.state.rotors[0] - activation).abs() / activation)
    };
    for (kind, order) in [(MethodKind::SemiImplicitEuler, 1.0), (MethodKind::Rk4, 4.0), (MethodKind::Implicit, 2.0)] {
        let (coarse, fine) = (error(kind, 80), error(kind, 160));
        let found = libm::log2(coarse / fine);
        println!("{kind:?}: {fine:.2e}, order {found:.3}");
        assert!((found - order).abs() < 0.2, "{kind:?}: {coarse:e} {fine:e}, order {found}");
    }
    for kind in [MethodKind::DormandPrince, MethodKind::DormandPrince8, MethodKind::Stiff] {
        let found = error(kind, 4);
        println!("{kind:?}: {found:.2e}");
        assert!(found < 1e-9, "{kind:?}: {found:e}");
    }
}

/// The end of the range is reached in the middle of a step: what acts is exact there, and the speed differs by the
/// quadrature of one step with a kink, of second order in it.
#[test]
fn an_integrator_stops_at_the_end_of_its_range_and_leaves_it_at_once() {
    let limited = Activation { range: [-0.2, 0.5], input_range: [-2.0, 2.0], ..INTEGRATOR };
    let (end, u, t) = (0.5, 2.0, 0.4);
    let reached = end / u;
    let speed = end * (t - 0.5 * reached) / INERTIA;
    for kind in ALL {
        let error = |n: u32| {
            let mut world = started(torque(limited), kind, 1e-11);
            run(&mut world, t / f64::from(n), n);
            assert_eq!(world.state.rotors[0], end, "{kind:?}");
            // the other way: from the end, without windup
            let before = world.state.v[0];
            world.state.commands[0] = -1.0;
            run(&mut world, 0.1 / f64::from(n), n);
            let slower = 0.1 * (end - 0.05) / INERTIA;
            assert!((world.state.rotors[0] - (end - 0.1)).abs() < 1e-12, "{kind:?}: {}", world.state.rotors[0]);
            (before - speed).abs() + (world.state.v[0] - before - slower).abs()
        };
        let (coarse, fine) = (error(43), error(430));
        println!("{kind:?}: {coarse:.1e}, {fine:.1e}");
        match kind {
            // of first order
            MethodKind::SemiImplicitEuler => assert!(fine < 0.2 * coarse && fine < 2e-2, "{fine:e} {coarse:e}"),
            MethodKind::DormandPrince | MethodKind::DormandPrince8 => {
                assert!(coarse.max(fine) < 1e-7, "{kind:?}: {coarse:e}")
            }
            _ => assert!(fine < 0.05 * coarse && fine < 1e-4, "{kind:?}: {fine:e} {coarse:e}"),
        }
    }
}

#[test]
fn work_of_an_activated_actuator_is_kinetic_energy_and_heat() {
    let spring = Motor { stiffness: 2.0, damping: 0.05, ..Motor::new(MotorMode::Spring) };
    let voltage = Motor::new(MotorMode::Voltage);
    let winding = Winding { inductance: 0.01, gear_ratio: 10.0, ..Winding::new(1.0, 0.05) };
    for (what, motor, winding) in
        [("torque", Motor::new(MotorMode::Torque), None), ("spring", spring, None), ("voltage", voltage, Some(winding))]
    {
        for activation in [FILTER, INTEGRATOR, Activation { range: [-1.0, 0.4], ..INTEGRATOR }] {
            for kind in ALL {
                let mut world = started(wheel(motor, activation, winding).unwrap(), kind, 1e-10);
                let start = world.energy().total();
                run(&mut world, 5e-4, 400);
                let (work, heat) = (world.state.totals[0], world.state.totals[1]);
                let imbalance = (world.energy().total() - start - work + heat) / world.energy().total();
                // totals are quadratures of the method; that of semi-implicit Euler is of first order in the spring
                let is_fine = !matches!(kind, MethodKind::SemiImplicitEuler | MethodKind::Implicit);
                let bound = if is_fine { 1e-6 } else { 5e-3 };
                println!("{what} {kind:?}: imbalance {imbalance:.1e}");
                assert!(imbalance.abs() < bound, "{what} {kind:?} {activation:?}: {imbalance:e}");
            }
        }
    }
}

/// Two carts on a line, pushed apart by an actuator with an activation.
fn carts(activation: Activation<f64>) -> Model<f64> {
    let mut b = ModelBuilder::new([0.0; 3]);
    let mut cart = |name: &str, x: f64| {
        let joint = JointSpec::new(JointKind::Prismatic { axis: [1.0, 0.0, 0.0] });
        let at = Pose::translation(sincro_dynamics::spatial::Vec3([x, 0.0, 0.0]));
        let joint = b.joint(&format!("{name}.slide"), NodeId::WORLD, at, joint);
        let mass = MassProperties { mass: 2.0, center_of_mass: [0.0; 3], inertia: [0.1, 0.0, 0.0, 0.1, 0.0, 0.1] };
        b.body(name, joint, Pose::identity(), BodySpec { mass })
    };
    let ends = [cart("left", 0.0), cart("right", 1.0)];
    b.spring_damper(
        "line",
        SpringDamperSpec {
            path: PathSpec::Points(ends.map(|end| (end, [0.0; 3])).to_vec()),
            free_length: None,
            law: ForceLaw { stiffness: 0.0, damping: 0.0, preload: 0.0, nonlinear: None },
            tension_only: false,
            actuator: Some(f64::INFINITY),
            activation: Some(activation),
        },
    );
    b.build().unwrap().0
}

#[test]
fn an_actuator_along_a_line_takes_its_activation() {
    for kind in [MethodKind::Rk4, MethodKind::DormandPrince, MethodKind::DormandPrince8, MethodKind::Stiff] {
        let mut world = started(carts(FILTER), kind, 1e-11);
        run(&mut world, 1e-3, 100);
        let lag = 1.0 - libm::exp(-0.1 / 0.05);
        let speed = COMMAND * (0.1 - 0.05 * lag) / 2.0;
        let error = (world.state.v[1] - speed).abs().max((world.state.v[0] + speed).abs());
        assert!(error < 1e-8, "{kind:?}: {error:e}");
        let (work, energy) = (world.state.totals[0], world.energy().total());
        assert!((work - energy).abs() < 1e-8 * energy, "{kind:?}: {work} {energy}");
        assert_eq!(world.model().actuation(0, &world.state.commands, &world.state.rotors), world.state.rotors[0]);
    }
}

#[test]
fn lanes_and_a_copied_state_go_on_bit_for_bit() {
    let limited = Activation { range: [-0.2, 0.5], input_range: [-20.0, 2.0], ..INTEGRATOR };
    let slower = Activation { dynamics: ActivationDynamics::Filter { time_constant: 0.2 }, ..FILTER };
    for own in [[FILTER, slower], [limited, Activation { range: [-0.1, 0.3], ..limited }]] {
        for kind in [MethodKind::SemiImplicitEuler, MethodKind::Rk4, MethodKind::Implicit] {
            let settings = BatchSettings { method: kind, h: 5e-3, n_steps: 80, record_every: 0 };
            let worlds = |k: u32| {
                let model = torque(own[k as usize % 2]);
                let mut x = State::new(&model);
                x.commands[0] = COMMAND - 1.7 * f64::from(k);
                BatchWorld::new(model, x)
            };
            let mut together: Vec<BatchWorld> = (0..5).map(worlds).collect();
            let mut alone = together.clone();
            advance(&mut together, &settings).unwrap();
            alone.iter_mut().for_each(|world| advance_alone(world, &settings));
            for (one, other) in together.iter().zip(&alone) {
                assert_eq!((&one.state.v, &one.state.rotors), (&other.state.v, &other.state.rotors), "{kind:?}");
            }
        }
    }
    let mut world = started(torque(FILTER), MethodKind::Rk4, 1e-9);
    run(&mut world, 1e-3, 20);
    let mut copy = World::new(world.model().clone(), world.state.clone(), MethodKind::Rk4, 1e-9, 1e-3);
    run(&mut world, 1e-3, 20);
    run(&mut copy, 1e-3, 20);
    assert_eq!((world.state.v, world.state.rotors), (copy.state.v, copy.state.rotors));
}

#[test]
fn activations_of_ideal_motors_and_of_bad_numbers_are_refused() {
    let refused = |mode, own| wheel(Motor::new(mode), own, None).unwrap_err();
    assert!(refused(MotorMode::Velocity, FILTER).contains("an ideal motor has no activation"));
    let none = Activation { range: [1.0, -1.0], ..FILTER };
    assert!(refused(MotorMode::Torque, none).contains("range [1, -1] of the activation of the motor of `shaft`"));
}
