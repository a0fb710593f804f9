//! Accuracy of the default settings: against a run with a far smaller tolerance, and by conserved energy.

use sincro_dynamics::world::{MethodKind, World};
use sincro_scene::scene::Scene;
use sincro_sim::run::{choose_method, world_of};

use super::subjects::{STEP, default_experiment, world};

/// Tolerance of the reference.
const REFERENCE_ACCURACY: f64 = 1e-13;

/// Largest difference of any joint `[rad]` between the default settings and the reference at the ticks of the first
/// `duration` seconds; infinite if a run stops.
pub(super) fn joint_error(scene: &Scene, duration: f64) -> f64 {
    let experiment = default_experiment(STEP, duration);
    let mut ours = world_of(scene, &experiment, choose_method(scene, &experiment).0, false);
    let mut reference = world(scene, MethodKind::DormandPrince, REFERENCE_ACCURACY, false);
    let mut worst = 0.0_f64;
    for tick in 0..experiment.n_steps {
        let t = tick as f64 * STEP;
        if ours.advance(t, STEP).is_err() || reference.advance(t, STEP).is_err() {
            return f64::INFINITY;
        }
        worst = ours.state.q.iter().zip(&reference.state.q).fold(worst, |worst, (a, b)| worst.max((a - b).abs()));
    }
    worst
}

/// Largest error of the total energy over `duration` seconds at default settings, as a share of the energy released:
/// the largest kinetic energy that the scene, let go at rest, reaches. Infinite if the run stops.
pub(super) fn energy_error(scene: &Scene, duration: f64) -> f64 {
    let experiment = default_experiment(STEP, duration);
    let mut world = world_of(scene, &experiment, choose_method(scene, &experiment).0, false);
    let total = |world: &mut World, t: f64| {
        let energy = world.observe(t).energy();
        (energy.total(), energy.kinetic)
    };
    let start = total(&mut world, 0.0).0;
    let (mut worst, mut released) = (0.0_f64, 0.0_f64);
    for tick in 0..experiment.n_steps {
        let t = tick as f64 * STEP;
        if world.advance(t, STEP).is_err() {
            return f64::INFINITY;
        }
        let (now, kinetic) = total(&mut world, t + STEP);
        worst = worst.max((now - start).abs());
        released = released.max(kinetic);
    }
    worst / released
}

#[cfg(test)]
mod tests {
    use super::super::models;
    use super::*;

    #[test]
    fn default_settings_are_far_better_than_a_first_order_step() {
        // a semi-implicit step of 5 ms is off by about 1e-2 rad after a second
        assert!(joint_error(&models::robot("arm2").unwrap().scene, 0.2) < 1e-5);
    }

    #[test]
    fn a_free_pendulum_keeps_its_energy() {
        assert!(energy_error(&models::robot("pend_free").unwrap().scene, 1.0) < 1e-6);
    }
}
