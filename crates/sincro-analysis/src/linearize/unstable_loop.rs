//! Loops that are unstable from the first: the growth of a small disturbance at the start, with the diagram in the loop
//! and with its commands held.

use core::fmt;

use sincro_blocks::program::Rate;
use sincro_scene::diagram::is_known_at_ticks_only;
use sincro_scene::record::Probe;
use sincro_scene::sensor::SensorKind;
use sincro_sim::load::Loaded;
use sincro_sim::run::{LockStep, method_for};

use super::sampled::period;
use super::{Request, linearize, linearize_sampled};
use crate::linear::StateSpace;

/// Growth over the run, as the logarithm of a factor, from which a loop is told of: a thousandfold.
const GROWTH: f64 = 6.9;

/// Closed growth over open growth from which the loop is to blame for it, where the start is no equilibrium.
const WORSE: f64 = 1.2;

/// Change of the growth `[1/s]` below which the diagram closes no loop.
const NO_LOOP: f64 = 1e-6;

/// Rate of the states at an equilibrium, or their change in a period, in their own units.
const STEADY: f64 = 1e-6;

/// Change of a state in a period, in its own unit, from which on nothing small is about the start: steps over it may
/// take minutes.
const VIOLENT: f64 = 1e3;

/// Steps of the method that a sampled loop may take to be linearised: a fraction of a second.
const MAX_STEPS: u64 = 40_000;

/// Loop that a diagram closes and that is unstable at the start of the run; result of [`unstable_loop`].
///
/// ```
/// use sincro_analysis::linearize::UnstableLoop;
///
/// let found = UnstableLoop { closed: 4.6, open: 0.0 }; // [1/s]
/// assert!(found.to_string().contains("grows tenfold in 5.01e-1 s, with the commands held it does not grow"));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnstableLoop {
    /// Growth rate of the fastest growing disturbance with the diagram in the loop `[1/s]`.
    pub closed: f64,
    /// The same with the commands held at their first values `[1/s]`; 0 if nothing grows.
    pub open: f64,
}

impl fmt::Display for UnstableLoop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let tenfold = core::f64::consts::LN_10 / self.closed;
        write!(
            f,
            "the loop that the diagram closes is unstable from the first: a small disturbance grows tenfold in {tenfold:.2e} s"
        )?;
        match self.open > 0.0 {
            true => write!(f, ", with the commands held in {:.2e} s. ", core::f64::consts::LN_10 / self.open)?,
            false => f.write_str(", with the commands held it does not grow. ")?,
        }
        f.write_str("Look at signs, gains and sample times; `sincro linearize` has the poles")
    }
}

/// Finds out whether the diagram of a scene closes a loop that is unstable at the start: a small disturbance would grow
/// a thousandfold within the run, and the loop is to blame, since the disturbance grows faster than with the commands
/// held, or the run starts at an equilibrium, which the loop then does not hold. `None` if it is not, or cannot be
/// told: without a loop, with blocks that measure contacts, proximity or sums over a step, with contacts, scripts,
/// FMUs, blocks in Lua or controllers of the program, and where linearising would take longer than a fraction of a
/// second. Sensors are in the loop with their sample times; their noise is the same in all runs that are compared.
///
/// ```
/// use sincro_analysis::prelude::*;
/// use sincro_sim::prelude::*;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/cart-pole-lqr");
/// let loaded = load(folder.as_ref(), &[], Extensions::default())?;
/// assert_eq!(unstable_loop(&loaded), None);
/// # Ok(())
/// # }
/// ```
#[must_use]
pub fn unstable_loop(loaded: &Loaded) -> Option<UnstableLoop> {
    let program = loaded.controller.as_ref()?.wiring.program();
    let runs_foreign = program.steps.iter().any(|step| matches!(step.template.kind().name, "fmu" | "lua"));
    let touches = !loaded.scene.model.constraints().pairs.is_empty();
    if runs_foreign || touches || !loaded.scene.scripts.is_empty() || !loaded.controllers.is_empty() {
        return None;
    }
    // what is known at ticks only is a constant in the equations: the loop is closed by the map over a period
    let readings = &loaded.controller.as_ref()?.wiring.early;
    let probes = readings.iter().flat_map(|reading| reading.probes.iter().copied());
    let at_ticks: Vec<Probe> = probes.filter(|probe| is_known_at_ticks_only(*probe)).collect();
    if !at_ticks.iter().all(|probe| matches!(probe, Probe::Sensor(value) if is_smooth(loaded, *value))) {
        return None;
    }
    let mut at = LockStep::new(loaded, method_for(loaded).0, false);
    at.start().ok()?;
    at.latch();
    let held = linearize(loaded, &at, &Request::default()).ok()?;
    let is_sampled = !at_ticks.is_empty() || program.steps.iter().any(|step| matches!(step.rate, Rate::Sampled(_)));
    let (closed, is_steady) = if is_sampled {
        let (period, n_runs) = (period(loaded, &at).ok()?, 2 * n_states(&at) + 1);
        if held.drift() * period as f64 * at.step() > VIOLENT {
            return None;
        }
        let is_short = period.saturating_mul(n_runs) <= MAX_STEPS && is_short_run(loaded, period, MAX_STEPS / n_runs);
        let found = is_short.then(|| linearize_sampled(loaded, &at).ok()).flatten()?;
        (growth(&found.system), found.drift < STEADY)
    } else {
        let found = linearize(loaded, &at, &Request { is_closed: true, ..Request::default() }).ok()?;
        (growth(&found.system), found.drift() < STEADY)
    };
    let open = growth(&held.system);
    let grows = closed * loaded.experiment.duration > GROWTH;
    let is_loop = (closed - open).abs() > NO_LOOP * (1.0 + open);
    (grows && is_loop && (closed > WORSE * open || is_steady)).then_some(UnstableLoop { closed, open })
}

/// Returns true if the sensor that gives a value, counted over all sensors, measures the motion of its frame: what
/// contact and proximity sensors give jumps.
fn is_smooth(loaded: &Loaded, value: usize) -> bool {
    let kinds = loaded.scene.sensors.iter().flat_map(|s| std::iter::repeat_n(s.kind, s.kind.values().len()));
    let of_value = kinds.into_iter().nth(value);
    of_value.is_some_and(|kind| !matches!(kind, SensorKind::Contact { .. } | SensorKind::Proximity { .. }))
}

/// Returns true if the method makes at most `most` steps over the first `period` base steps.
fn is_short_run(loaded: &Loaded, period: u64, most: u64) -> bool {
    let mut run = LockStep::new(loaded, method_for(loaded).0, false);
    run.start().is_ok() && (0..period).all(|_| run.advance().is_ok() && run.world().statistics().steps <= most)
}

/// Number of states of a run, at least.
fn n_states(at: &LockStep) -> u64 {
    let snapshot = at.snapshot(at.trace());
    let of_diagram = snapshot.diagram.as_ref().map_or(0, |d| d.continuous.len() + d.memory.len());
    (2 * snapshot.state.v.len() + of_diagram + snapshot.sensors.len()) as u64
}

/// Growth rate of the fastest growing motion `[1/s]`; 0 if none grows.
fn growth(system: &StateSpace) -> f64 {
    let rates = system.poles().into_iter().map(|mode| -1.0 / mode.time_constant);
    rates.filter(|rate| rate.is_finite()).fold(0.0, f64::max)
}
