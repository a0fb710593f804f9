//! Simulation of a diagram alone, without a world: for tests and small examples.
//!
//! Continuous states are taken from tick to tick by the classical Runge–Kutta method of order 4.

use std::sync::Arc;

use crate::block::SAME_INSTANT;
use crate::compile::{CompileError, Interface, compile};
use crate::diagram::Diagram;
use crate::runner::Runner;

/// Simulation of a diagram alone, without a world, at a fixed step: for tests and small examples.
///
/// ```
/// use sincro_blocks::library::continuous::LowPass;
/// use sincro_blocks::library::sources::Constant;
/// use sincro_blocks::prelude::*;
///
/// // a first-order lag with a time constant of 0.5 s
/// let mut diagram = Diagram::new();
/// diagram.block("one", Constant::new(1.0)).block("lag", LowPass::new(0.5)).wire("one", "lag");
/// let mut simulator = Simulator::new(&diagram, 0.01)?;
/// while simulator.t() < 1.0 {
///     simulator.advance();
/// }
/// assert!((simulator.output("lag")[0] - (1.0 - f64::exp(-1.0 / 0.5))).abs() < 1e-8);
/// # Ok::<(), CompileError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Simulator {
    /// Diagram with its state.
    pub runner: Runner<f64>,
    tick: u64,
    derivatives: [Vec<f64>; 4],
    start: Vec<f64>,
}

impl Simulator {
    /// Compiles a diagram with the base step `step` `[s]` and evaluates its first tick, at t = 0.
    ///
    /// # Errors
    ///
    /// [`CompileError`] with everything that is wrong with the diagram.
    pub fn new(diagram: &Diagram, step: f64) -> Result<Self, CompileError> {
        let program = Arc::new(compile(diagram, &Interface::new(step))?);
        let zero = vec![0.0; program.n_states];
        let derivatives = [zero.clone(), zero.clone(), zero.clone(), zero.clone()];
        let mut runner = Runner::new(program);
        runner.evaluate(0, 0.0);
        Ok(Self { runner, tick: 0, derivatives, start: zero })
    }

    /// Present time `[s]`.
    #[must_use]
    pub fn t(&self) -> f64 {
        self.tick as f64 * self.runner.program().step
    }

    /// Advances by one base step: continuous states by the Runge–Kutta method of order 4, then the outputs of the new
    /// tick.
    pub fn advance(&mut self) {
        let (t, h, tick) = (self.t(), self.runner.program().step, self.tick);
        self.runner.update(tick, t);
        self.start.copy_from_slice(&self.runner.state.continuous);
        let time_event = self.runner.program().next_time_event(t);
        let time_event = if time_event <= t + h + SAME_INSTANT { t + h } else { f64::INFINITY };
        for stage in 0..4 {
            let c = [0.0, 0.5, 0.5, 1.0][stage];
            for (k, x) in self.runner.state.continuous.iter_mut().enumerate() {
                *x = self.start[k] + if stage == 0 { 0.0 } else { c * h * self.derivatives[stage - 1][k] };
            }
            self.runner.minor(tick, t + c * h, time_event);
            self.runner.derivatives(tick, t + c * h, time_event, &mut self.derivatives[stage]);
        }
        for (k, x) in self.runner.state.continuous.iter_mut().enumerate() {
            let s = &self.derivatives;
            *x = self.start[k] + h / 6.0 * (s[0][k] + 2.0 * s[1][k] + 2.0 * s[2][k] + s[3][k]);
        }
        self.tick += 1;
        let now = self.t();
        self.runner.evaluate(self.tick, now);
    }

    /// Present output of a block, such as `pid` or `loop/pid` (`block.port` where there are several): its components,
    /// in the unit of the signal.
    ///
    /// # Panics
    ///
    /// If there is no output of that name.
    #[must_use]
    pub fn output(&self, name: &str) -> &[f64] {
        let found = self.runner.program().outputs().find(|(known, ..)| known == name);
        let (_, range, _) = found.unwrap_or_else(|| panic!("no output `{name}`"));
        &self.runner.signals()[range]
    }

    /// Advances `n` base steps and returns the first component of an output at every tick, the start included: `n + 1`
    /// numbers in the unit of the signal.
    ///
    /// # Panics
    ///
    /// If there is no output of that name.
    pub fn record(&mut self, name: &str, n: usize) -> Vec<f64> {
        let mut rows = vec![self.output(name)[0]];
        for _ in 0..n {
            self.advance();
            rows.push(self.output(name)[0]);
        }
        rows
    }
}
