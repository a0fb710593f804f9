//! Runs whose equations are compiled have the bits of runs whose equations are not.
#![cfg(feature = "jit")]

use std::path::PathBuf;

use sincro_compile::plant;
use sincro_dynamics::actuation::ExternalForce;
use sincro_dynamics::spatial::Vec3;
use sincro_dynamics::world::MethodKind;
use sincro_scene::overrides::Override;
use sincro_sim::prelude::*;
use sincro_sim::run::EquationsBy;

/// Ticks of each run.
const N_TICKS: u64 = 200;

fn scenes() -> Vec<PathBuf> {
    let mut found: Vec<PathBuf> = ["", "third-party"]
        .iter()
        .flat_map(|folder| std::fs::read_dir(sincro_testing::repository_scene(folder)).unwrap())
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.join("experiment.toml").is_file())
        .collect();
    found.sort();
    found
}

/// Everything that a run shows of a tick, as bits.
fn bits(run: &mut LockStep) -> Vec<u64> {
    let energy = run.world().energy();
    let signals = run.control().map_or_else(Vec::new, |control| control.signals().to_vec());
    let state = run.state();
    let numbers = [&state.q, &state.v, &state.rotors, &state.totals, &state.commands, &signals];
    let numbers = numbers.into_iter().flatten().chain([&energy.kinetic, &energy.potential]);
    let mut bits: Vec<u64> = numbers.map(|x| x.to_bits()).collect();
    let statistics = run.world().statistics();
    bits.extend([run.tick(), statistics.steps, statistics.events]);
    bits
}

/// Runs a scene compiled and not, tick by tick; returns the number of evaluations by compiled code.
fn compared(loaded: &Loaded, name: &str) -> Option<u64> {
    let method = method_for(loaded).0;
    let [mut compiled, mut plain] = [(); 2].map(|()| LockStep::new(loaded, method, false));
    compiled.compile_equations();
    assert_eq!(compiled.start().is_ok(), plain.start().is_ok(), "{name}");
    for tick in 0..loaded.experiment.n_steps.min(N_TICKS) {
        let made = [compiled.advance(), plain.advance()];
        // by their words: what is not a number equals nothing
        assert_eq!(format!("{:?}", made[0]), format!("{:?}", made[1]), "{name}");
        assert!(bits(&mut compiled) == bits(&mut plain), "{name}: tick {} differs", tick + 1);
        if made[0].is_err() {
            break;
        }
    }
    assert_eq!(plain.world().compiled_evaluations(), None);
    let evaluations = compiled.world().compiled_evaluations();
    assert_eq!(evaluations.is_some(), matches!(compiled.equations_by(), EquationsBy::Compiled { .. }), "{name}");
    evaluations
}

fn loaded(scene: &std::path::Path, settings: &[Override]) -> Loaded {
    load(scene, settings, sincro_testing::with_scripts()).unwrap_or_else(|found| panic!("{found}"))
}

#[test]
fn shipped_scenes_have_the_bits_of_their_recursions() {
    // scenes that are compiled, with their own method and with any
    let (mut by_own, mut by_any) = (0, 0);
    for scene in scenes() {
        let name = scene.file_name().unwrap().to_string_lossy().into_owned();
        let mut is_compiled = false;
        let own: [&[Override]; 1] = [&[]];
        let others = ["rk4", "implicit", "semi-implicit-euler"].map(|word| [Override::new("integrator", word)]);
        for settings in own.into_iter().chain(others.iter().map(|settings| &settings[..])) {
            let loaded = loaded(&scene, settings);
            let method = method_for(&loaded).0;
            let method = if method.controls_error() { MethodKind::Rk4 } else { method };
            if plant::check(&loaded.scene.model, method).is_err() {
                continue;
            }
            let is_used = compared(&loaded, &format!("{name}, {method:?}")).is_some_and(|n| n > 0);
            by_own += u32::from(is_used && settings.is_empty());
            is_compiled |= is_used;
        }
        by_any += u32::from(is_compiled);
    }
    assert!(by_own >= 20 && by_any >= 25, "{by_own} and {by_any} scenes are compiled");
}

fn double_pendulum(settings: &[(&str, &str)]) -> Loaded {
    let settings: Vec<Override> = settings.iter().map(|(path, value)| Override::new(path, value)).collect();
    loaded(&sincro_testing::repository_scene("double-pendulum"), &settings)
}

/// Runs of a scene, compiled and not, before their first tick.
fn both(loaded: &Loaded) -> [LockStep; 2] {
    let mut runs = [(); 2].map(|()| LockStep::new(loaded, method_for(loaded).0, false));
    runs[0].compile_equations();
    runs.iter_mut().for_each(|run| run.start().unwrap());
    runs
}

/// Advances runs by `n` ticks, with the same bits.
fn advance(runs: &mut [LockStep; 2], n: u64) {
    for _ in 0..n {
        let [compiled, plain] = runs.each_mut().map(|run| {
            run.advance().unwrap();
            bits(run)
        });
        assert!(compiled == plain);
    }
}

#[test]
fn a_changed_parameter_costs_a_compilation() {
    let mut runs = both(&double_pendulum(&[("integrator", "rk4")]));
    advance(&mut runs, 5);
    assert_eq!(runs[0].world().compiled_evaluations(), Some(5));
    for (k, waiting) in [0, 2, 4].into_iter().enumerate() {
        for run in &mut runs {
            run.world().set_gravity(Vec3([0.0, 0.1, -9.0 - k as f64]));
        }
        let EquationsBy::Recursions { reason } = runs[0].equations_by() else { panic!("{:?}", runs[0].equations_by()) };
        assert_eq!(reason, "a parameter has been changed since");
        if k > 0 {
            // since the last compilation
            advance(&mut runs, 1);
        }
        let mut waited = u64::from(k > 0);
        while runs[0].world().compiled_evaluations().is_none() {
            advance(&mut runs, 1);
            waited += 1;
        }
        assert!(waited <= waiting + 1, "{waited} ticks after change {k}");
        advance(&mut runs, 3);
    }
    assert!(matches!(runs[0].equations_by(), EquationsBy::Compiled { .. }));
}

#[test]
fn forces_from_outside_are_left_to_the_recursions() {
    for integrator in ["rk4", "dormand-prince", "dormand-prince-8"] {
        let mut runs = both(&double_pendulum(&[("integrator", integrator)]));
        advance(&mut runs, 2);
        let before = runs[0].world().compiled_evaluations().unwrap();
        assert!(before > 0);
        let [point, torque] = [[0.0, 0.0, -0.1], [0.0; 3]].map(Vec3);
        let pushing = ExternalForce { link: 0, point, force: Vec3([1.0, 0.0, 0.5]), torque };
        runs.iter_mut().for_each(|run| run.world().apply_external_force(pushing));
        advance(&mut runs, 3);
        assert_eq!(runs[0].world().compiled_evaluations(), Some(before));
        runs.iter_mut().for_each(|run| run.world().clear_external_forces());
        advance(&mut runs, 1);
        assert!(runs[0].world().compiled_evaluations().unwrap() > before);
    }
}

#[test]
fn states_that_a_program_does_not_know_are_left_to_the_recursions() {
    let mut runs = both(&double_pendulum(&[("integrator", "rk4")]));
    advance(&mut runs, 2);
    for value in [-0.0, 1e101] {
        let before = runs[0].world().compiled_evaluations();
        for run in &mut runs {
            run.world().state.v.fill(value);
        }
        let [compiled, plain] = runs.each_mut().map(|run| format!("{:?} {:?}", run.advance(), run.state()));
        assert_eq!(compiled, plain);
        assert_eq!(runs[0].world().compiled_evaluations(), before, "{value}");
    }
}

#[test]
fn runs_that_go_on_are_compiled_by_themselves() {
    let loaded = double_pendulum(&[("duration", "1000.0")]);
    let mut run = LockStep::new(&loaded, method_for(&loaded).0, false);
    run.start().unwrap();
    (0..2000).for_each(|_| run.advance().unwrap());
    let reason = "it would take longer than the steps so far".to_owned();
    assert_eq!(run.equations_by(), &EquationsBy::Recursions { reason });
    run.advance().unwrap();
    assert!(matches!(run.equations_by(), EquationsBy::Compiled { .. }));
    // a copy goes on by the same code
    let mut copy = run.fork().lockstep;
    let evaluations = copy.world().compiled_evaluations().unwrap();
    for run in [&mut run, &mut copy] {
        run.advance().unwrap();
    }
    assert!(copy.world().compiled_evaluations().unwrap() > evaluations);
    assert_eq!(bits(&mut run), bits(&mut copy));
}

#[test]
fn what_cannot_be_compiled_says_why() {
    let reasons = [
        ("bouncing-ball", "the model has contacts, loop joints or limits of joints"),
        ("cart-pole-lqr", "the diagram acts between the steps"),
    ];
    for (scene, expected) in reasons {
        let loaded = loaded(&sincro_testing::repository_scene(scene), &[]);
        let mut run = LockStep::new(&loaded, method_for(&loaded).0, false);
        run.compile_equations();
        run.start().unwrap();
        run.advance().unwrap();
        let EquationsBy::Recursions { reason } = run.equations_by() else { panic!("{scene} is compiled") };
        assert_eq!(reason, expected);
    }
}
