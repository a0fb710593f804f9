//! `auto` follows the stiffness: a mass sinks onto a hard pad, rests there, and is lifted off again.

use sincro_sim::prelude::*;
use sincro_sim::run::method_for;
use sincro_testing::{SceneFolder, last};

const SCENE: &str = r#"
format = 2

[[joint]]
name = "rail"
kind = "prismatic"
axis = [0, 0, 1]
initial = { position = 0.05 }
damping = 20.0
spring = { rest = 0.0, table = [[-1.0, 1e7], [0.0, 0.0], [1.0, 0.0]] }
torque = { step = { time = 2.0, to = 15.0 } }

[[body]]
name = "mass"
parent = "/rail"
mass = 1.0
inertia = { xx = 1.0, yy = 1.0, zz = 1.0 }
"#;

const EXPERIMENT: &str = r#"
format = 2
title = "A pad"
duration = 3.0
step = 0.005
record = ["/rail.position", "/rail.velocity"]
"#;

fn loaded_with(integrator: &str) -> Loaded {
    let setting = format!("integrator=\"{integrator}\"");
    SceneFolder::of(SCENE, EXPERIMENT).load(&[&setting]).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn auto_takes_the_stiff_method_while_the_pad_is_touched() {
    let runs = ["auto", "dormand-prince", "stiff"].map(|integrator| sincro_testing::run(&loaded_with(integrator)));
    let said = |run: &Simulated| run.warnings.iter().find(|w| w.contains("`auto` changed")).cloned();
    let words = said(&runs[0]).expect("auto changes its method");
    assert!(words.contains("2 times with the stiffness, first to `stiff` at t = 0."), "{words}");
    assert!(said(&runs[1]).is_none() && said(&runs[2]).is_none());
    // the explicit method makes many small steps all the while the mass rests on the pad
    let [auto, explicit, stiff] = runs.each_ref().map(|run| run.statistics.steps);
    assert!(5 * auto < 4 * explicit, "{auto} {explicit} {stiff}");
    for name in ["/rail.position", "/rail.velocity"] {
        let [auto, explicit, stiff] = runs.each_ref().map(|run| last(run, name));
        assert!((auto - explicit).abs() < 1e-6 && (auto - stiff).abs() < 1e-6, "{name} {auto} {explicit} {stiff}");
    }
}

#[test]
fn a_run_restored_with_the_other_method_goes_on_with_the_same_bits() {
    let loaded = loaded_with("auto");
    let method = method_for(&loaded).0;
    let advance = |run: &mut LockStep, ticks: u64| (0..ticks).for_each(|_| run.advance().unwrap());
    let mut run = LockStep::new(&loaded, method, false);
    run.start().unwrap();
    advance(&mut run, 300);
    let snapshot = run.snapshot(run.trace());
    assert_ne!(snapshot.method, method);
    let bytes = snapshot.to_bytes(&loaded);
    let mut other = LockStep::new(&loaded, method, false);
    other.restore(&Snapshot::from_bytes(&bytes, &loaded).unwrap());
    for run in [&mut run, &mut other] {
        advance(run, 300);
    }
    assert_eq!(run.state(), other.state());
    // a run that names its method keeps it
    for named in ["dormand-prince", "rk4", "semi-implicit-euler"] {
        let named = loaded_with(named);
        let method = method_for(&named).0;
        let mut run = LockStep::new(&named, method, false);
        run.restore(&snapshot);
        assert_eq!((run.world().method(), run.state()), (method, &snapshot.state));
    }
    assert_eq!(run.world().method(), method);
}
