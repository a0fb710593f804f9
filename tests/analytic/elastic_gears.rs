//! Elastic gears with backlash against closed forms and an independent integration.

use sincro_dynamics::batch::{BatchSettings, BatchWorld, advance, advance_alone};
use sincro_dynamics::joint::JointKind;
use sincro_dynamics::model::{
    BodySpec, ElasticGearSpec, GearSpec, JointSpec, MassProperties, Model, ModelBuilder, NodeId,
};
use sincro_dynamics::signal::Signal;
use sincro_dynamics::spatial::Pose;
use sincro_dynamics::state::State;
use sincro_dynamics::stiffness::{StiffElement, stiffest};
use sincro_dynamics::world::{MethodKind, World};

use crate::mechanisms::{ALL, run};

const INERTIAS: [f64; 2] = [0.002, 0.3];
const RATIO: f64 = -0.2;

/// Two shafts; the first, of the motor, has an inertia of 0.002 kg·m² and this torque.
fn shafts(stiffness: f64, damping: f64, backlash: f64, torque: Signal) -> Result<Model<f64>, String> {
    let mut b = ModelBuilder::new([0.0; 3]);
    let mut joints = Vec::new();
    for (k, inertia) in INERTIAS.into_iter().enumerate() {
        let torque = if k == 0 { vec![torque.clone()] } else { Vec::new() };
        let joint = JointSpec { torque, ..JointSpec::new(JointKind::Revolute { axis: [0.0, 0.0, 1.0] }) };
        let joint = b.joint(["motor", "load"][k], NodeId::WORLD, Pose::identity(), joint);
        let inertia = [inertia, 0.0, 0.0, inertia, 0.0, inertia];
        let mass = MassProperties { mass: 1.0, center_of_mass: [0.0; 3], inertia };
        b.body(["rotor", "wheel"][k], joint, Pose::identity(), BodySpec { mass });
        joints.push(joint);
    }
    let gear = GearSpec { joints: [joints[0], joints[1]], ratio: RATIO, offset: 0.0, higher: [0.0; 3] };
    b.elastic_gear("gear", ElasticGearSpec { gear, stiffness, damping, backlash });
    b.build().map(|(model, _)| model).map_err(|e| e.to_string())
}

/// Inertia that the mesh error has: 1/(1/I₂ + r²/I₁).
fn reduced() -> f64 {
    1.0 / (1.0 / INERTIAS[1] + RATIO * RATIO / INERTIAS[0])
}

#[test]
fn without_backlash_the_mesh_is_a_damped_oscillator() {
    let (k, c) = (900.0, 0.6);
    let model = shafts(k, c, 0.0, Signal::Constant(0.0)).unwrap();
    let m = reduced();
    let (decay, square) = (0.5 * c / m, k / m);
    let omega = (square - decay * decay).sqrt();
    let t = 0.05;
    let expected = 1e-3 * libm::exp(-decay * t) * (libm::cos(omega * t) + decay / omega * libm::sin(omega * t));
    let error = |kind, n: u32| {
        let mut x = State::new(&model);
        x.q[1] = 1e-3;
        let mut world = World::new(model.clone(), x, kind, 1e-13, 1e-4);
        run(&mut world, t / f64::from(n), n);
        (world.state.q[1] - RATIO * world.state.q[0] - expected).abs() / 1e-3
    };
    for (kind, order) in [(MethodKind::SemiImplicitEuler, 1.0), (MethodKind::Rk4, 4.0), (MethodKind::Implicit, 2.0)] {
        let (coarse, fine) = (error(kind, 400), error(kind, 800));
        let found = libm::log2(coarse / fine);
        println!("{kind:?}: {fine:.2e}, order {found:.2}");
        assert!((found - order).abs() < 0.3, "{kind:?}: {coarse:e} {fine:e}");
    }
    for kind in [MethodKind::DormandPrince, MethodKind::DormandPrince8, MethodKind::Stiff] {
        let found = error(kind, 5);
        println!("{kind:?}: {found:.2e}");
        assert!(found < 1e-8, "{kind:?}: {found:e}");
    }
    let found = stiffest(&model, &State::new(&model)).unwrap();
    assert_eq!((found.element, found.element_name(&model).as_str()), (StiffElement::ElasticGear(0), "coupling `gear`"));
    assert!((found.inertia / m - 1.0).abs() < 1e-12);
}

/// The same equations, written down again: classical Runge–Kutta with the teeth held as they are (none, one side, the
/// other), and a step that ends at the corner, found by bisection, where they meet or part.
fn independent(k: f64, c: f64, gap: f64, torque: impl Fn(f64) -> f64, t_end: f64, h: f64) -> [f64; 4] {
    let mesh = |y: [f64; 4], side: i32| {
        let (x, rate) = (y[1] - RATIO * y[0], y[3] - RATIO * y[2]);
        if side == 0 { 0.0 } else { -k * (x - 0.5 * gap * f64::from(side)) - c * rate }
    };
    let side_of = |y: [f64; 4]| {
        let x = y[1] - RATIO * y[0];
        let side = if x > 0.5 * gap {
            1
        } else if x < -0.5 * gap {
            -1
        } else {
            0
        };
        // they push only
        if mesh(y, side) * f64::from(side) < 0.0 { side } else { 0 }
    };
    let moved = |y: [f64; 4], s: [f64; 4], h: f64| -> [f64; 4] { std::array::from_fn(|i| y[i] + h * s[i]) };
    let step = |t: f64, y: [f64; 4], side: i32, h: f64| -> [f64; 4] {
        let slope = |t: f64, y: [f64; 4]| {
            let f = mesh(y, side);
            [y[2], y[3], (torque(t) - RATIO * f) / INERTIAS[0], f / INERTIAS[1]]
        };
        let a = slope(t, y);
        let b = slope(t + 0.5 * h, moved(y, a, 0.5 * h));
        let c = slope(t + 0.5 * h, moved(y, b, 0.5 * h));
        let d = slope(t + h, moved(y, c, h));
        std::array::from_fn(|i| y[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]))
    };
    let (mut t, mut y, mut side) = (0.0, [0.0; 4], 0);
    while t < t_end - 1e-13 {
        let mut h = h.min(t_end - t);
        if side_of(step(t, y, side, h)) != side {
            let mut before = 0.0;
            for _ in 0..60 {
                let middle = 0.5 * (before + h);
                if side_of(step(t, y, side, middle)) == side { before = middle } else { h = middle }
            }
        }
        y = step(t, y, side, h);
        t += h;
        side = side_of(y);
    }
    y
}

#[test]
fn a_motor_that_reverses_crosses_the_backlash_as_integrated_independently() {
    let (k, c, gap) = (900.0, 3.0, 0.02);
    let (amplitude, omega) = (0.3, 12.0);
    let torque = Signal::Sine { amplitude, angular_frequency: omega, phase: 0.0, offset: 0.0 };
    let model = shafts(k, c, gap, torque).unwrap();
    let t = 0.6;
    let exact = independent(k, c, gap, |t| amplitude * libm::sin(omega * t), t, 2e-5);
    let coarse = independent(k, c, gap, |t| amplitude * libm::sin(omega * t), t, 4e-5);
    let own: f64 = exact.iter().zip(&coarse).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    for (kind, n, tolerance) in [
        (MethodKind::DormandPrince, 100, 1e-6),
        (MethodKind::Stiff, 100, 1e-6),
        (MethodKind::Rk4, 20_000, 1e-4),
        (MethodKind::Implicit, 20_000, 1e-3),
        (MethodKind::SemiImplicitEuler, 20_000, 2e-2),
    ] {
        let mut world = World::new(model.clone(), State::new(&model), kind, 1e-10, 1e-3);
        run(&mut world, t / f64::from(n), n);
        let found = [world.state.q[0], world.state.q[1], world.state.v[0], world.state.v[1]];
        let worst = found.iter().zip(&exact).map(|(a, b)| (a - b).abs() / (1.0 + b.abs())).fold(0.0, f64::max);
        let balance = world.energy().total() - world.state.totals[0] + world.state.totals[1];
        println!(
            "{kind:?}: {worst:.1e} (reference {own:.1e}), balance {balance:.1e} of {:.3} J",
            world.state.totals[0]
        );
        assert!(worst < tolerance, "{kind:?}: {found:?} {exact:?}");
        if kind == MethodKind::DormandPrince {
            assert!(balance.abs() < 1e-5, "{kind:?}: {balance:e}");
        }
    }
}

#[test]
fn a_stiff_mesh_is_stable_at_a_large_step() {
    // √(k/m) h = 1200 at 1 ms: as a rigid gear of I₁ + r² I₂
    let model = shafts(1e10, 1.0, 0.0, Signal::Constant(0.3)).unwrap();
    let expected = 0.3 / (INERTIAS[0] + RATIO * RATIO * INERTIAS[1]) * 0.2;
    for kind in [MethodKind::Implicit, MethodKind::Stiff] {
        let mut world = World::new(model.clone(), State::new(&model), kind, 1e-9, 1e-3);
        run(&mut world, 1e-3, 200);
        assert!((world.state.v[0] / expected - 1.0).abs() < 1e-4, "{kind:?}: {} {expected}", world.state.v[0]);
    }
}

#[test]
fn lanes_have_the_bits_of_single_worlds() {
    let models: Vec<Model<f64>> =
        [0.0, 0.01, 0.03].map(|gap| shafts(900.0, 0.6, gap, Signal::Constant(0.2)).unwrap()).into();
    let start = || -> Vec<BatchWorld> { models.iter().map(|m| BatchWorld::new(m.clone(), State::new(m))).collect() };
    for method in [MethodKind::Rk4, MethodKind::Implicit] {
        let settings = BatchSettings { method, h: 1e-3, n_steps: 50, record_every: 0 };
        let (mut together, mut alone) = (start(), start());
        advance(&mut together, &settings).unwrap();
        alone.iter_mut().for_each(|world| advance_alone(world, &settings));
        for (one, other) in together.iter().zip(&alone) {
            assert_eq!(one.state, other.state, "{method:?}");
        }
    }
}

#[test]
fn every_method_loses_energy_to_damping_alone() {
    for kind in ALL {
        let model = shafts(900.0, 0.6, 0.01, Signal::Constant(0.0)).unwrap();
        let mut x = State::new(&model);
        x.v[0] = 5.0;
        let mut world = World::new(model, x, kind, 1e-9, 1e-4);
        let start = world.energy().total();
        run(&mut world, 1e-4, 5000);
        assert!(world.energy().total() < start && world.state.totals[1] > 0.0, "{kind:?}");
        // torque on the first is −r times that on the second: I₁ ω₁ + r I₂ ω₂ is kept
        let kept = INERTIAS[0] * world.state.v[0] + RATIO * INERTIAS[1] * world.state.v[1];
        assert!((kept - INERTIAS[0] * 5.0).abs() < 1e-12, "{kind:?}: {kept}");
    }
}

#[test]
fn numbers_that_cannot_be_are_refused_by_name() {
    let refused = |k, c, gap| shafts(k, c, gap, Signal::Constant(0.0)).unwrap_err();
    assert!(refused(0.0, 0.0, 0.0).contains("stiffness 0 of the elastic gear `gear`"));
    assert!(refused(f64::NAN, 0.0, 0.0).contains("stiffness NaN"));
    assert!(refused(1.0, -1.0, 0.0).contains("damping -1"));
    assert!(refused(1.0, 0.0, -0.1).contains("backlash -0.1"));
}
