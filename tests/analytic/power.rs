//! Power in equals energy rate, for all force elements together and for each.

use sincro_dynamics::actuation::{Motor, MotorMode};
use sincro_dynamics::energy::energy_at;
use sincro_dynamics::model::{JointSpec, Model};
use sincro_dynamics::signal::Signal;
use sincro_dynamics::state::State;
use sincro_dynamics::world::{MethodKind, World};

use crate::mechanisms::{cart, motor, run, slider, zoo};

fn total(world: &mut World) -> f64 {
    let (q, v) = (world.state.q.clone(), world.state.v.clone());
    let mechanism = world.mechanism();
    let model = mechanism.model().clone();
    energy_at(&model, &q, &v, mechanism.scratch()).total()
}

/// Energy − work + dissipation at the end minus the same at the start.
fn imbalance(model: Model<f64>, x: State<f64>, kind: MethodKind, h: f64, n: u32) -> f64 {
    let mut world = World::new(model, x, kind, 1e-11, 1e-3);
    let start = total(&mut world);
    run(&mut world, h, n);
    total(&mut world) - start - world.state.totals[0] + world.state.totals[1]
}

#[test]
fn every_element_of_the_zoo_is_accounted_for() {
    let (model, x) = zoo();
    let e = imbalance(model, x, MethodKind::DormandPrince, 0.01, 100);
    assert!(e.abs() < 1e-8, "{e:e}");
}

#[test]
fn motors_in_every_mode_are_accounted_for() {
    let spring = Motor { stiffness: 40.0, damping: 3.0, ..Motor::new(MotorMode::Spring) };
    let position = Motor { kp: 5.0, ..Motor::new(MotorMode::Position) };
    for m in [Motor::new(MotorMode::Torque), Motor::new(MotorMode::Velocity), spring, position] {
        let model = cart(2.0, JointSpec { spring: vec![(7.0, 0.1)], damping: vec![0.3], ..motor(m) });
        let mut x = State::new(&model);
        (x.q[0], x.v[0], x.commands[0]) = (0.2, 1.0, 0.7);
        for kind in [MethodKind::DormandPrince, MethodKind::DormandPrince8, MethodKind::Stiff] {
            let e = imbalance(model.clone(), x.clone(), kind, 0.01, 50);
            assert!(e.abs() < 1e-9, "{:?} {kind:?} {e:e}", m.mode);
        }
    }
}

#[test]
fn damper_dissipates_what_the_closed_form_says() {
    // v = v0 exp(−c t/m): dissipated ½ m v0² (1 − exp(−2 c t/m))
    let (m, c, v0, t) = (2.0, 3.0, 1.5, 0.8);
    let model = cart(m, JointSpec { damping: vec![c], ..slider() });
    let mut x = State::new(&model);
    x.v[0] = v0;
    let mut world = World::new(model, x, MethodKind::DormandPrince, 1e-12, 1e-3);
    run(&mut world, t, 1);
    let expected = 0.5 * m * v0 * v0 * (1.0 - libm::exp(-2.0 * c * t / m));
    assert!((world.state.totals[1] - expected).abs() < 1e-10);
}

#[test]
fn a_torque_in_time_does_the_work_of_its_closed_form() {
    // F = a sin(ωt) on a mass from rest: v = a/(mω)(1 − cos ωt), work = ½ m v²
    let (m, a, w, t) = (2.0, 3.0, 4.0, 1.1);
    let torque = vec![Signal::Sine { amplitude: a, angular_frequency: w, phase: 0.0, offset: 0.0 }];
    let model = cart(m, JointSpec { torque, ..slider() });
    let x = State::new(&model);
    let mut world = World::new(model, x, MethodKind::DormandPrince, 1e-12, 1e-3);
    run(&mut world, t, 1);
    let v = a / (m * w) * (1.0 - libm::cos(w * t));
    assert!((world.state.v[0] - v).abs() < 1e-10);
    assert!((world.state.totals[0] - 0.5 * m * v * v).abs() < 1e-10);
}

#[test]
fn passive_energy_never_rises() {
    for kind in [MethodKind::Implicit, MethodKind::Stiff] {
        let model = cart(1.0, JointSpec { spring: vec![(1e6, 0.0)], damping: vec![50.0], ..slider() });
        let mut x = State::new(&model);
        x.q[0] = 0.01;
        let mut world = World::new(model, x, kind, 1e-8, 1e-3);
        let mut last = total(&mut world);
        for k in 0..200 {
            world.advance(f64::from(k) * 1e-3, 1e-3).unwrap();
            let now = total(&mut world);
            assert!(now <= last * (1.0 + 1e-9), "{kind:?} at {k}: {last} to {now}");
            last = now;
        }
    }
}
