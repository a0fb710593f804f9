//! Direct-current motors against the closed form of their linear equations.
//!
//! With the inertia D at the joint, K = N k_t = N k_e and the voltage V from rest, s² + (R/L) s + K²/(L D) = 0 has the
//! roots s₁, s₂, and ω = (V/K) (1 + (s₂ e^{s₁t} − s₁ e^{s₂t})/(s₁ − s₂)), i = D ω̇/K.

use sincro_dynamics::actuation::{Motor, MotorMode, Winding};
use sincro_dynamics::batch::{BatchSettings, BatchWorld, advance, advance_alone};
use sincro_dynamics::joint::{Friction, JointKind};
use sincro_dynamics::model::{BodySpec, JointSpec, MassProperties, Model, ModelBuilder, NodeId};
use sincro_dynamics::spatial::Pose;
use sincro_dynamics::state::State;
use sincro_dynamics::stiffness::{StiffElement, stiffest};
use sincro_dynamics::world::{MethodKind, World};

use crate::mechanisms::{ALL, run};

const VOLTAGE: f64 = 12.0;
const INERTIA: f64 = 0.02;
/// Gear ratio, torque constant, inertia of the rotor: K = 0.5, and D = 0.02 with that of the rotor.
const GEAR: f64 = 10.0;
const ROTOR: f64 = 5e-5;

fn winding(inductance: f64) -> Winding<f64> {
    Winding { inductance, gear_ratio: GEAR, rotor_inertia: ROTOR, ..Winding::new(1.0, 0.05) }
}

fn shaft(winding: Winding<f64>, friction: f64) -> Result<Model<f64>, String> {
    let mut b = ModelBuilder::new([0.0; 3]);
    let joint = JointSpec {
        motor: vec![Motor::new(MotorMode::Voltage)],
        winding: vec![Some(winding)],
        friction: if friction > 0.0 { vec![Friction::coulomb(friction)] } else { Vec::new() },
        ..JointSpec::new(JointKind::Revolute { axis: [0.0, 0.0, 1.0] })
    };
    let joint = b.joint("shaft", NodeId::WORLD, Pose::identity(), joint);
    let own = INERTIA - GEAR * GEAR * ROTOR;
    let mass = MassProperties { mass: 1.0, center_of_mass: [0.0; 3], inertia: [own, 0.0, 0.0, own, 0.0, own] };
    b.body("wheel", joint, Pose::identity(), BodySpec { mass });
    b.build().map(|(model, _)| model).map_err(|e| e.to_string())
}

fn started(model: Model<f64>, kind: MethodKind, accuracy: f64) -> World {
    let mut x = State::new(&model);
    x.commands[0] = VOLTAGE;
    World::new(model, x, kind, accuracy, 1e-3)
}

/// Speed and current at time `t` for real roots.
fn closed_form(w: &Winding<f64>, t: f64) -> (f64, f64) {
    let k = w.gear_ratio * w.torque_constant;
    let half = 0.5 * w.resistance / w.inductance;
    let root = (half * half - k * k / (w.inductance * INERTIA)).sqrt();
    let (s1, s2) = (-half + root, -half - root);
    let (e1, e2) = (libm::exp(s1 * t), libm::exp(s2 * t));
    let final_speed = VOLTAGE / k;
    let speed = final_speed * (1.0 + (s2 * e1 - s1 * e2) / (s1 - s2));
    (speed, INERTIA / k * final_speed * s1 * s2 * (e1 - e2) / (s1 - s2))
}

#[test]
fn a_step_of_voltage_has_its_closed_form_at_the_order_of_each_method() {
    let w = winding(0.01);
    let t = 0.04;
    let error = |kind, n: u32| {
        let mut world = started(shaft(w, 0.0).unwrap(), kind, 1e-11);
        run(&mut world, t / f64::from(n), n);
        let (speed, current) = closed_form(&w, t);
        ((world.state.v[0] - speed).abs() / speed).max((world.state.rotors[0] - current).abs() / current)
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

#[test]
fn power_of_the_source_is_heat_motion_and_magnetic_energy() {
    // k_e above k_t: the difference is heat as well
    for (inductance, back_emf_constant) in [(0.01, 0.05), (0.0, 0.05), (0.01, 0.06), (1e-7, 0.05)] {
        let w = Winding { back_emf_constant, ..winding(inductance) };
        for kind in ALL {
            if inductance == 1e-7 && matches!(kind, MethodKind::Rk4 | MethodKind::DormandPrince) {
                continue;
            }
            let mut world = started(shaft(w, 0.0).unwrap(), kind, 1e-10);
            let start = world.energy().total();
            run(&mut world, 5e-4, 80);
            let end = world.energy().total();
            let (work, heat) = (world.state.totals[0], world.state.totals[1]);
            let imbalance = (end - start - work + heat) / work;
            // quadrature of the totals is of the order of the method; linearly implicit Euler balances each step
            let bound = if matches!(kind, MethodKind::Implicit) { 1e-5 } else { 1e-7 };
            println!("L {inductance} {kind:?}: imbalance {imbalance:.1e} of {work:.4} J, heat {heat:.4} J");
            assert!(imbalance.abs() < bound, "L {inductance} {kind:?}: {imbalance:e}");
            assert!(heat > 0.0 && end > start);
        }
    }
}

#[test]
fn torque_over_speed_is_a_straight_line_without_inductance() {
    let model = shaft(winding(0.0), 0.0).unwrap();
    assert_eq!(model.n_rotor_states(), 0);
    let (stall, no_load) = (0.5 * VOLTAGE, VOLTAGE / 0.5);
    for share in [0.0, 0.25, 1.0, 1.5] {
        let mut world = started(model.clone(), MethodKind::Rk4, 1e-9);
        world.state.v[0] = share * no_load;
        let torque = world.rates(0.0).1[0];
        assert!((torque - stall * (1.0 - share)).abs() < 1e-12, "at {share}: {torque}");
    }
    // time constant R D/K²
    for kind in ALL {
        let mut world = started(model.clone(), kind, 1e-11);
        run(&mut world, 1e-3, 100);
        let expected = no_load * (1.0 - libm::exp(-0.1 * 0.25 / INERTIA));
        let relative = (world.state.v[0] - expected).abs() / expected;
        let bound = match kind {
            MethodKind::SemiImplicitEuler => 4e-3,
            MethodKind::Implicit => 3e-5,
            _ => 1e-9,
        };
        assert!(relative < bound, "{kind:?}: {relative:e}");
    }
}

#[test]
fn the_stall_torque_is_held_by_friction_just_above_it() {
    let stall = 0.5 * VOLTAGE;
    for (factor, moves) in [(1.001, false), (0.999, true)] {
        for kind in ALL {
            let mut world = started(shaft(winding(0.01), factor * stall).unwrap(), kind, 1e-9);
            run(&mut world, 0.01, 20);
            assert_eq!(world.state.v[0] > 1e-9, moves, "{kind:?} {factor}: {}", world.state.v[0]);
            if !moves {
                let current = world.state.rotors[0];
                assert!((current / VOLTAGE - 1.0).abs() < 1e-6, "{kind:?}: {current} A");
            }
        }
    }
}

#[test]
fn a_winding_faster_than_the_step_is_stable_and_acts_as_none() {
    // L/R = 1 ns at a step of 1 ms
    for kind in [MethodKind::SemiImplicitEuler, MethodKind::Implicit, MethodKind::Stiff] {
        let speed = |inductance: f64| {
            let mut world = started(shaft(winding(inductance), 0.0).unwrap(), kind, 1e-9);
            run(&mut world, 1e-3, 100);
            world.state.v[0]
        };
        let (with, without) = (speed(1e-9), speed(0.0));
        assert!((with - without).abs() < 1e-5 * without, "{kind:?}: {with} {without}");
    }
    let model = shaft(winding(1e-9), 0.0).unwrap();
    let found = stiffest(&model, &State::new(&model)).unwrap();
    assert_eq!(found.element, StiffElement::Winding(0));
    assert!((found.rate / 1e9 - 1.0).abs() < 1e-6 && found.element_name(&model) == "winding of the motor of `shaft`");
}

#[test]
fn commands_beyond_the_supply_are_limited() {
    let model = shaft(Winding { max_voltage: 6.0, ..winding(0.0) }, 0.0).unwrap();
    assert!((started(model, MethodKind::Rk4, 1e-9).rates(0.0).1[0] - 0.5 * 6.0).abs() < 1e-12);
}

#[test]
fn lanes_have_the_bits_of_one_world() {
    let models: Vec<Model<f64>> = [0.01, 0.02, 0.005].map(|l| shaft(winding(l), 0.0).unwrap()).into();
    let worlds = |models: &[Model<f64>]| -> Vec<BatchWorld> {
        models
            .iter()
            .map(|model| {
                let mut state = State::new(model);
                state.commands[0] = VOLTAGE;
                BatchWorld::new(model.clone(), state)
            })
            .collect()
    };
    for method in [MethodKind::Rk4, MethodKind::SemiImplicitEuler, MethodKind::Implicit] {
        let settings = BatchSettings { method, h: 1e-3, n_steps: 50, record_every: 0 };
        let (mut together, mut alone) = (worlds(&models), worlds(&models));
        advance(&mut together, &settings).unwrap();
        alone.iter_mut().for_each(|world| advance_alone(world, &settings));
        for (a, b) in together.iter().zip(&alone) {
            assert_eq!(a.state, b.state, "{method:?}");
        }
    }
}

#[test]
fn numbers_that_no_winding_has_are_refused_by_name() {
    let plain = winding(0.01);
    for (winding, name) in [
        (Winding { resistance: 0.0, ..plain }, "resistance"),
        (Winding { resistance: f64::NAN, ..plain }, "resistance"),
        (Winding { inductance: -1e-3, ..plain }, "inductance"),
        (Winding { torque_constant: f64::INFINITY, ..plain }, "torque_constant"),
        (Winding { gear_ratio: 0.0, ..plain }, "gear_ratio"),
        (Winding { max_voltage: f64::NAN, ..plain }, "max_voltage"),
    ] {
        let refused = shaft(winding, 0.0).unwrap_err();
        assert!(refused.contains(name) && refused.contains("`shaft`"), "{refused}");
    }
}
