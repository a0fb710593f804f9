//! Each integrator shows its order when the step is halved, on a mechanism with every kind of joint.

use sincro_dynamics::integrate::Control;
use sincro_dynamics::state::State;
use sincro_dynamics::world::{MethodKind, World};

use crate::mechanisms::{distance, run, zoo};

const SPAN: f64 = 0.4;

fn at_end(kind: MethodKind, accuracy: f64, n: u32) -> State<f64> {
    let (model, x) = zoo();
    let mut world = World::new(model, x, kind, accuracy, 1e-3);
    run(&mut world, SPAN / f64::from(n), n);
    world.state
}

fn reference() -> State<f64> {
    at_end(MethodKind::DormandPrince, 1e-13, 1)
}

/// Observed order between `n` and `2n` steps.
fn observed_order(kind: MethodKind, n: u32) -> f64 {
    let (model, _) = zoo();
    let exact = reference();
    let [coarse, fine] = [n, 2 * n].map(|n| distance(&model, &at_end(kind, 1.0, n), &exact));
    libm::log2(coarse / fine)
}

#[test]
fn semi_implicit_euler_is_of_first_order() {
    let p = observed_order(MethodKind::SemiImplicitEuler, 800);
    assert!((p - 1.0).abs() < 0.1, "{p}");
}

#[test]
fn implicit_is_of_second_order() {
    let p = observed_order(MethodKind::Implicit, 400);
    assert!((p - 2.0).abs() < 0.15, "{p}");
}

#[test]
fn rk4_is_of_fourth_order() {
    let p = observed_order(MethodKind::Rk4, 80);
    assert!((p - 4.0).abs() < 0.25, "{p}");
}

#[test]
fn dormand_prince_at_a_fixed_step_is_of_fifth_order() {
    // an accuracy so loose that every proposed step is accepted and cut by the tick
    let p = observed_order(MethodKind::DormandPrince, 24);
    assert!((p - 5.0).abs() < 0.4, "{p}");
}

#[test]
fn error_control_follows_the_tolerance() {
    let (model, _) = zoo();
    let exact = reference();
    for kind in [MethodKind::DormandPrince, MethodKind::DormandPrince8, MethodKind::Stiff] {
        for accuracy in [1e-5, 1e-7, 1e-9] {
            let error = distance(&model, &at_end(kind, accuracy, 1), &exact);
            assert!(error < 100.0 * accuracy, "{kind:?} {accuracy:e}: {error:e}");
        }
    }
}

#[test]
fn both_error_controlled_methods_find_the_same_motion() {
    let (model, _) = zoo();
    let error = distance(&model, &at_end(MethodKind::Stiff, 1e-11, 4), &reference());
    assert!(error < 1e-8, "{error:e}");
}

#[test]
fn quaternions_stay_unit() {
    let (model, x) = zoo();
    let mut world = World::new(model.clone(), x, MethodKind::Rk4, 1.0, 1.0);
    run(&mut world, 0.005, 400);
    for joint in &model.names().joints {
        let at = match joint.n_q {
            4 => joint.q_idx,
            7 => joint.q_idx + 3,
            _ => continue,
        };
        let norm: f64 = world.state.q[at..at + 4].iter().map(|x| x * x).sum();
        assert!((norm - 1.0).abs() < 1e-15);
    }
}

#[test]
fn ticks_do_not_change_what_error_control_finds() {
    let (model, _) = zoo();
    let few = at_end(MethodKind::DormandPrince, 1e-10, 2);
    let many = at_end(MethodKind::DormandPrince, 1e-10, 160);
    assert!(distance(&model, &few, &many) < 1e-7);
}

#[test]
fn a_snapshot_continues_bit_for_bit() {
    for kind in crate::mechanisms::ALL {
        let (model, x) = zoo();
        let mut whole = World::new(model.clone(), x, kind, 1e-8, 1e-3);
        run(&mut whole, 0.005, 20);
        let control = whole.control().unwrap_or(Control::new(1e-8, 1e-3));
        let mut resumed = World::with_totals(model, whole.state.clone(), kind, control, true);
        for k in 20..40 {
            whole.advance(f64::from(k) * 0.005, 0.005).unwrap();
            resumed.advance(f64::from(k) * 0.005, 0.005).unwrap();
        }
        assert_eq!(whole.state, resumed.state, "{kind:?}");
    }
}
