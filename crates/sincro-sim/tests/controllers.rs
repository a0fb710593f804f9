//! Controllers in lock-step: a closure as one, whose commands win, and what a fork cannot copy.

use sincro_dynamics::world::MethodKind;
use sincro_sim::controller::{ClosureController, Controller, Instant, Source};
use sincro_sim::run::LockStep;
use sincro_testing::scenes;

fn lockstep() -> LockStep {
    let loaded = scenes::sprung_arm().load(&[]).unwrap();
    LockStep::new(&loaded, MethodKind::SemiImplicitEuler, false)
}

/// A law that holds the only command at `rate`.
fn constant(name: &str, rate: f64) -> Box<dyn Controller> {
    Box::new(ClosureController::new(name, move |_: Instant<'_>, held: &mut [Option<f64>]| held[0] = Some(rate)))
}

#[test]
fn last_attached_controller_gives_the_command() {
    let mut run = lockstep();
    run.start().unwrap();
    run.advance().unwrap();
    assert_eq!(run.sources(), [Source::Scene]);
    run.attach(constant("first", 0.5));
    run.attach(constant("second", -0.25));
    run.advance().unwrap();
    assert_eq!((run.sources(), run.state().commands[0]), (&[Source::Controller(1)][..], -0.25));
    // an ideal velocity motor follows exactly
    assert_eq!(run.state().v[1], -0.25);
}

#[test]
fn closure_that_repeats_the_scene_gives_the_same_bits() {
    let (mut of_scene, mut of_law) = (lockstep(), lockstep());
    of_law.attach(Box::new(ClosureController::new("ramp", |at: Instant<'_>, held: &mut [Option<f64>]| {
        held[0] = Some(at.t)
    })));
    for run in [&mut of_scene, &mut of_law] {
        run.start().unwrap();
        (0..20).for_each(|_| run.advance().unwrap());
    }
    assert_eq!(of_scene.trace(), of_law.trace());
}

#[test]
fn fork_says_what_it_goes_on_without() {
    let mut run = lockstep();
    assert!(run.fork().not_copied.is_empty());
    run.attach(constant("pd", 0.5));
    run.start().unwrap();
    run.advance().unwrap();
    let mut fork = run.fork();
    assert_eq!(fork.not_copied, ["pd"]);
    fork.lockstep.advance().unwrap();
    assert_eq!(fork.lockstep.sources(), [Source::Scene]);
}
