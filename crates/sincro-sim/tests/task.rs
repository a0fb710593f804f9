//! Tasks: episodes depend on their seeds alone; a diagram leaves the commands of controllers alone.

use std::path::{Path, PathBuf};

use sincro_sim::prelude::*;
use sincro_sim::task::{Autoreset, Step, TaskWorlds};

fn scene(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(name)
}

/// Observations and rewards of `n_steps` of `n` worlds whose actions alternate.
fn episodes(name: &str, n: usize, threads: usize, n_steps: usize) -> Vec<Vec<u64>> {
    let loaded = load(&scene(name), &[], Extensions::default()).unwrap();
    let mut worlds = TaskWorlds::new(&loaded, n, threads).unwrap();
    let (n_actions, n_observations) = (worlds.plan().n_actions(), worlds.plan().n_observations());
    let seeds: Vec<Option<u64>> = (0..n as u64).map(|k| Some(7 + k)).collect();
    let mut step = Step::new(n, n_observations);
    worlds.reset(&seeds, &vec![true; n], &mut step.observations);
    let mut seen = vec![Vec::new(); n];
    for k in 0..n_steps {
        let action = if k % 3 == 0 { 1.0 } else { -0.5 };
        worlds.step(&vec![action; n * n_actions], Autoreset::SameStep, &mut step);
        for (world, seen) in seen.iter_mut().enumerate() {
            let row = &step.observations[world * n_observations..(world + 1) * n_observations];
            seen.extend(row.iter().chain([&step.rewards[world]]).map(|x| x.to_bits()));
        }
    }
    seen
}

#[test]
fn episodes_depend_on_their_seeds_alone() {
    for name in ["cart-pole-balance", "acrobot", "quadrotor-hover"] {
        let many = episodes(name, 21, 3, 100);
        let few = episodes(name, 2, 1, 100);
        assert_eq!(many[..2], few[..], "{name}");
        assert_ne!(many[0], many[1], "{name}: seeds differ");
    }
}

#[test]
fn a_continuous_diagram_leaves_commands_of_controllers_alone() {
    let loaded = load(&scene("cart-pole-lqr"), &[], Extensions::default()).unwrap();
    let mut lockstep = LockStep::new(&loaded, method_for(&loaded).0, false);
    lockstep.attach(Box::new(ClosureController::new("push", |_: Instant<'_>, held: &mut [Option<f64>]| {
        held[0] = Some(2.0)
    })));
    lockstep.start().unwrap();
    lockstep.advance().unwrap();
    assert_eq!(lockstep.state().commands[0], 2.0);
    // from rest, under 2 N alone: the gravity of the tilted pole takes part, the regulator's 8 N do not
    let v = lockstep.state().v[0];
    assert!((0.02..0.045).contains(&v), "{v}");
}
