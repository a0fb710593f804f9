//! Compilation of the equations of a run's world, once the run has been long enough.
//!
//! A compilation takes as long as some thousands of steps: it is made when so many have been, so that no run takes much
//! longer than without, and runs of any length that nobody knows beforehand get it. After a change of parameters the
//! equations are those of the recursions, and are compiled anew: at once after the first change, then after twice as
//! many steps each time, so that a client that changes them all the time does not wait for it.

use std::sync::Arc;
use std::time::Duration;

use sincro_compile::{Obstacle, jit, plant};
use sincro_dynamics::world::{CompiledKind, MethodKind, World};

/// Steps of a method with fixed steps, and of one with error control, that take about as long as a compilation.
const STEPS_OF_A_COMPILATION: [u64; 2] = [10_000, 2_000];

/// Evaluation of the equations of a world.
#[derive(Clone, Debug, PartialEq)]
pub enum EquationsBy {
    /// Code that was compiled for its model and parameters.
    Compiled {
        /// Time for compiling it and comparing it with the recursions.
        elapsed: Duration,
    },
    /// The recursions.
    Recursions {
        /// Reason why they are not compiled, in words that continue "it is not compiled: ".
        reason: String,
    },
}

/// State of the compilation.
#[derive(Clone, Debug)]
pub(super) struct Compilation {
    /// True for the run at the finer steps of the error bars.
    is_refined: bool,
    /// Number of compilations.
    n_made: u32,
    /// Tick from which the equations are compiled; none: after [`STEPS_OF_A_COMPILATION`].
    from: Option<u64>,
    /// True if they cannot be compiled.
    is_impossible: bool,
    last: EquationsBy,
    changed: EquationsBy,
}

impl Compilation {
    /// Creates the state before a run, at the finer steps of the error bars if it `is_refined`.
    pub fn new(is_refined: bool) -> Self {
        let by_recursions = |reason: &str| EquationsBy::Recursions { reason: reason.to_owned() };
        Self {
            is_refined,
            n_made: 0,
            from: None,
            is_impossible: false,
            last: by_recursions("it would take longer than the steps so far"),
            changed: by_recursions("a parameter has been changed since"),
        }
    }

    /// Lets the equations be compiled at the next step.
    pub fn want(&mut self) {
        (self.from, self.is_impossible) = (Some(0), false);
    }

    /// Returns the evaluation of the equations of `world`.
    pub fn equations_by(&self, world: &World) -> &EquationsBy {
        let is_lost = world.compiled_evaluations().is_none() && matches!(self.last, EquationsBy::Compiled { .. });
        if is_lost { &self.changed } else { &self.last }
    }

    /// Returns true if the equations are to be compiled before the step of `tick`.
    #[inline]
    pub fn is_due(&self, tick: u64, world: &World) -> bool {
        let steps = STEPS_OF_A_COMPILATION[usize::from(world.method().controls_error())];
        !self.is_impossible && world.compiled_evaluations().is_none() && tick >= self.from.unwrap_or(steps)
    }

    /// Compiles the equations of a world with steps of `step` `[s]`, next to a diagram that `acts` between them or not.
    #[cold]
    pub fn compile(&mut self, tick: u64, step: f64, acts: bool, world: &mut World) {
        match compiled(step, (self.is_refined, acts), world) {
            Ok(elapsed) => {
                self.last = EquationsBy::Compiled { elapsed };
                // after the first change at once
                self.from = Some(if self.n_made == 0 { 0 } else { tick + (1 << self.n_made.min(20)) });
                self.n_made += 1;
            }
            Err(obstacle) => {
                self.last = EquationsBy::Recursions { reason: obstacle.to_string() };
                self.is_impossible = true;
            }
        }
    }
}

/// Compiles the equations of a world and lets it use them; returns the time that it took.
fn compiled(step: f64, (is_refined, acts): (bool, bool), world: &mut World) -> Result<Duration, Obstacle> {
    if acts {
        return Err(Obstacle::new("the diagram acts between the steps"));
    }
    let method = world.method();
    let kind = match method {
        MethodKind::DormandPrince | MethodKind::DormandPrince8 => CompiledKind::Slope,
        MethodKind::Stiff => return Err(Obstacle::new("the stiff method has no step of a fixed length")),
        MethodKind::SemiImplicitEuler if is_refined => CompiledKind::Step { h: step / 2.0 },
        _ if is_refined => return Err(Obstacle::new("the steps of its finer run differ in length")),
        _ => CompiledKind::Step { h: step },
    };
    let tracks_totals = world.mechanism().layout().tracks_totals();
    let program = plant::equations(world.model(), method, kind, tracks_totals)?;
    let mut jitted = jit::compile(&[&program])?;
    world.compile_in(Arc::new(jitted.programs.remove(0)), kind);
    Ok(jitted.elapsed + jitted.compared)
}
