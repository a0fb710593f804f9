//! `auto` follows the stiffness: a mass sinks onto a hard pad, rests there, and is lifted off again.

use sincro_dynamics::world::MethodKind;
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

/// An arm that is at rest for 1 s, swings for 1 s, and is braked to rest.
const SWING: &str = r#"
format = 2

[[joint]]
name = "hinge"
kind = "revolute"
axis = [0, 1, 0]
damping = 1.0
torque = { ramp = { from = 1.0, until = 1.5, slope = 400.0 } }

[[body]]
name = "arm"
parent = "/hinge"
mass = 1.0
inertia = { xx = 0.1, yy = 0.1, zz = 0.1 }
"#;

fn swinging(scene: &str, integrator: &str, accuracy: &str) -> Loaded {
    let (accuracy, integrator) = (format!("accuracy={accuracy}"), format!("integrator=\"{integrator}\""));
    let settings = ["duration=12.0", "step=0.02", "record=[\"/hinge.position\"]", &accuracy, &integrator];
    SceneFolder::of(scene, EXPERIMENT).load(&settings).unwrap_or_else(|e| panic!("{e}"))
}

/// Methods of a run after each tick, without repetitions.
fn methods(loaded: &Loaded, refined: bool) -> Vec<MethodKind> {
    let mut run = LockStep::new(loaded, method_for(loaded).0, refined);
    run.start().unwrap();
    let mut taken = vec![run.world().method()];
    for _ in 0..600 {
        run.advance().unwrap();
        taken.push(run.world().method());
    }
    taken.dedup();
    taken
}

#[test]
fn auto_takes_order_8_while_the_motion_is_fast_and_order_5_before_and_after() {
    let (five, eight) = (MethodKind::DormandPrince, MethodKind::DormandPrince8);
    for (accuracy, refined) in [("1e-9", false), ("1e-9", true), ("1e-11", false), ("1e-11", true)] {
        let taken = methods(&swinging(SWING, "auto", accuracy), refined);
        assert!(taken.starts_with(&[five, eight]) && taken.ends_with(&[eight, five]), "{accuracy} {refined} {taken:?}");
    }
    // too loose for the longer steps to pay; a limit, whose impacts are located within steps
    assert_eq!(methods(&swinging(SWING, "auto", "1e-5"), false), [five]);
    let limited = SWING.replace("damping = 1.0", "damping = 1.0\nlimits = { lower = -1e6, upper = 1e6 }");
    assert_ne!(limited, SWING);
    assert_eq!(methods(&swinging(&limited, "auto", "1e-9"), false), [five]);
}

#[test]
fn orders_by_choice_and_by_name_agree_and_a_restored_run_has_the_same_bits() {
    let run = |integrator: &str| {
        let run = sincro_testing::run(&swinging(SWING, integrator, "1e-11"));
        (last(&run, "/hinge.position"), run.statistics.steps)
    };
    let [(auto, steps), (five, steps_5), (eight, steps_8)] = ["auto", "dormand-prince", "dormand-prince-8"].map(run);
    assert!((auto - five).abs() < 1e-8 && (auto - eight).abs() < 1e-8, "{auto} {five} {eight}");
    assert!(steps_8 <= steps && steps < steps_5, "{steps_8} {steps} {steps_5}");
    let advance = |run: &mut LockStep, ticks: u64| (0..ticks).for_each(|_| run.advance().unwrap());
    let loaded = swinging(SWING, "auto", "1e-11");
    let method = method_for(&loaded).0;
    let mut run = LockStep::new(&loaded, method, false);
    run.start().unwrap();
    advance(&mut run, 80);
    let snapshot = run.snapshot(run.trace());
    assert_eq!(snapshot.method, MethodKind::DormandPrince8);
    let mut other = LockStep::new(&loaded, method, false);
    other.restore(&Snapshot::from_bytes(&snapshot.to_bytes(&loaded), &loaded).unwrap());
    for run in [&mut run, &mut other] {
        advance(run, 400);
    }
    assert_eq!(run.state(), other.state());
}
