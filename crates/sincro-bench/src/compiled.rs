//! Subjects whose equations are compiled in memory, for one world: what runs of `sincro-sim` do once they are long.

use std::hint::black_box;
use std::sync::Arc;

use sincro_compile::{Obstacle, jit, plant};
use sincro_dynamics::world::{CompiledKind, MethodKind, World};
use sincro_math::record::Program;
use sincro_scene::scene::Scene;

use super::clock::Subject;
use super::subjects::{self, Stepper};

/// Compiles a program; returns it with a note of the time that it took.
fn compiled(program: Result<Program, Obstacle>) -> Result<(jit::JittedProgram, String), Obstacle> {
    let mut jitted = jit::compile(&[&program?])?;
    let note = format!("compiled in {:.1} ms", jitted.elapsed.as_secs_f64() * 1e3);
    Ok((jitted.programs.remove(0), note))
}

/// Accelerations from torques, the recursion alone, compiled.
pub(super) fn forward(scene: &Scene) -> Subject {
    let (state, torque) = subjects::moving(scene);
    let (function, note) = match compiled(plant::forward_dynamics(&scene.model)) {
        Ok(compiled) => compiled,
        Err(obstacle) => return subjects::forward(scene).with_note(format!("not compiled: {obstacle}")),
    };
    let inputs = [state.q, state.v, torque].concat();
    let mut v_dot = vec![0.0; function.n_outputs()];
    Subject::new(move || {
        black_box(function.evaluate(black_box(&inputs), &mut v_dot));
        black_box(&v_dot);
    })
    .with_note(note)
}

/// One step of a world by a method with fixed steps, compiled.
pub(super) fn step(scene: &Scene, method: MethodKind) -> Subject {
    let mut note = String::new();
    let compile = |world: &mut World, h: f64| {
        let kind = CompiledKind::Step { h };
        note = match compiled(plant::equations(world.model(), method, kind, false)) {
            Ok((function, note)) => {
                world.compile_in(Arc::new(function), kind);
                note
            }
            Err(obstacle) => format!("not compiled: {obstacle}"),
        };
    };
    let stepper = Stepper::new(scene, method, false).prepared(compile);
    subjects::step_of(stepper).with_added_note(&note)
}
