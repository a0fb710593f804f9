//! The run: who acts when.
//!
//! One tick k, from t_k to t_{k+1} (DESIGN: measure, ask, hold, advance, publish):
//!
//! 1. commands are sampled from their signals at t_k and latched;
//! 2. the world advances under them;
//! 3. the new state is hashed, and recorded if a row is due.
//!
//! Time is `tick · step`, never accumulated. If the world cannot go on, everything recorded stays, and the run says where, who and
//! why (`stop.rs`).

mod campaign;
mod refine;
mod stop;
mod trace;

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use sincro_dynamics::stiffness::{RK4_LIMIT, Stiffness, stiffest};
use sincro_dynamics::world::{Effort, MethodKind, Observation, World};

pub use campaign::{Campaign, Done, Progress, run_campaign};
pub use trace::{Trace, model_hash};

use crate::experiment::{Experiment, Integrator};
use crate::problem::Problems;
use crate::record::Recorder;
use crate::results::{EnergyReport, FileError, Status};
use crate::scene::Scene;
use crate::table::{CsvWriter, Table};

/// Rate times base step above which `auto` takes the stiff method.
const STIFF_FROM: f64 = 1.0;
/// Rate times base step above which an explicit method with error control is slow enough to be announced.
const SLOW_FROM: f64 = 20.0;
/// How much finer the second run of an error estimate is: fixed steps halved, tolerance divided.
const FINER: f64 = 100.0;

/// What a single run gave.
#[derive(Clone, Debug)]
pub struct Simulated {
    /// The recorded signals.
    pub table: Table,
    /// How it ended.
    pub status: Status,
    /// The method that ran.
    pub method: MethodKind,
    /// Hash of the states of all ticks.
    pub trace: Trace,
    /// The balance of energy.
    pub energy: EnergyReport,
    /// Sub-steps and events.
    pub effort: Effort,
    /// What to know before trusting the numbers.
    pub warnings: Vec<String>,
    /// How long it took `[s]`, recording included.
    pub wall_time: f64,
}

/// What may be asked of a run while it runs.
pub struct Watch<'a> {
    /// Set from outside to end the run after the present tick.
    pub interrupt: &'a AtomicBool,
    /// Told the share done, now and then.
    pub progress: &'a mut dyn FnMut(f64),
}

/// How a run goes to disk and how fine it is.
#[derive(Clone, Copy, Debug, Default)]
pub struct Manner<'a> {
    /// CSV file that rows are written to as they come.
    pub csv: Option<&'a Path>,
    /// Whether it is the finer run of an error estimate.
    pub refined: bool,
}

/// Why a run could not even be made.
#[derive(Debug)]
pub enum RunError {
    /// Recorded signals that mean nothing.
    Problems(Problems),
    /// The results cannot be written.
    File(FileError),
}

impl From<Problems> for RunError {
    fn from(problems: Problems) -> Self {
        Self::Problems(problems)
    }
}

impl From<FileError> for RunError {
    fn from(error: FileError) -> Self {
        Self::File(error)
    }
}

/// The method for an experiment's integrator, and what there is to say about it.
#[must_use]
pub fn choose_method(scene: &Scene, experiment: &Experiment) -> (MethodKind, Vec<String>) {
    let fastest = stiffest(&scene.model, &scene.initial);
    let product = fastest.map_or(0.0, |s| s.rate * experiment.step);
    let kind = match experiment.integrator {
        Integrator::SemiImplicitEuler => MethodKind::SemiImplicitEuler,
        Integrator::Rk4 => MethodKind::Rk4,
        Integrator::Implicit => MethodKind::Implicit,
        Integrator::DormandPrince => MethodKind::DormandPrince,
        Integrator::Stiff => MethodKind::Stiff,
        Integrator::Auto if product > STIFF_FROM => MethodKind::Stiff,
        Integrator::Auto => MethodKind::DormandPrince,
    };
    let mut warnings = Vec::new();
    if let Some(s) = fastest {
        if kind == MethodKind::Rk4 && product > RK4_LIMIT {
            let limit = RK4_LIMIT / s.rate;
            warnings.push(format!(
                "{} is too fast for `rk4` at a step of {} s, which is stable up to {limit:.2e} s: the run will diverge. Use \
                 integrator = \"implicit\" (same step) or \"auto\"",
                describe(scene, &s),
                experiment.step
            ));
        }
        if kind == MethodKind::DormandPrince && product > SLOW_FROM {
            warnings.push(format!(
                "{} makes `dormand-prince` take about {:.0} sub-steps a step. Use integrator = \"auto\" or \"stiff\"",
                describe(scene, &s),
                product / 3.3
            ));
        }
    }
    (kind, warnings)
}

/// A fast degree of freedom in words.
fn describe(scene: &Scene, s: &Stiffness) -> String {
    format!(
        "joint `{}` (stiffness {:.3e}, damping {:.3e} on an inertia of {:.3e}: {:.3e} 1/s)",
        scene.model.names().dof_name(s.dof),
        s.stiffness,
        s.damping,
        s.inertia,
        s.rate
    )
}

/// The name of a method, as in the experiment file.
#[must_use]
pub fn method_word(kind: MethodKind) -> &'static str {
    match kind {
        MethodKind::SemiImplicitEuler => "semi-implicit-euler",
        MethodKind::Rk4 => "rk4",
        MethodKind::Implicit => "implicit",
        MethodKind::DormandPrince => "dormand-prince",
        MethodKind::Stiff => "stiff",
    }
}

/// A world ready for its first tick.
#[must_use]
pub fn world_of(scene: &Scene, experiment: &Experiment, kind: MethodKind, refined: bool) -> World {
    let accuracy = if refined { experiment.accuracy / FINER } else { experiment.accuracy };
    let first_step = (experiment.step * 0.1).min(1e-3);
    let mut world = World::new((*scene.model).clone(), scene.initial.clone(), kind, accuracy, first_step);
    world.set_substeps(if refined { 2 } else { 1 });
    world.settle_start(0.0);
    world
}

/// Runs an experiment once, without its variants, sweep and checks.
///
/// # Errors
///
/// If a recorded signal does not exist or the CSV file cannot be written. A run that stops is not an error: see
/// [`Simulated::status`].
pub fn simulate(
    scene: &Scene,
    experiment: &Experiment,
    manner: Manner<'_>,
    watch: &mut Watch<'_>,
) -> Result<Simulated, RunError> {
    let (method, warnings) = choose_method(scene, experiment);
    let mut recorder = Recorder::new(&experiment.record, &scene.model)?;
    let rows = experiment.n_steps / experiment.record_every + 1;
    let mut table = Table::new(recorder.columns(), rows as usize);
    let names: Vec<&str> = recorder.columns().map(|(name, _)| name).collect();
    let mut csv = manner.csv.map(|path| CsvWriter::create(path, &names)).transpose()?;

    let clock = Instant::now();
    let mut world = world_of(scene, experiment, method, manner.refined);
    let mut ledger = Ledger::start(&mut world);
    let mut trace = Trace::start(&world.state);
    let mut publish = |world: &mut World, t: f64, is_start: bool| -> Result<(), FileError> {
        let seen = world.observe(t);
        ledger.look(&seen);
        let row = recorder.row(&seen, t, is_start);
        table.push_row(row);
        csv.as_mut().map_or(Ok(()), |csv| csv.push_row(row))
    };
    publish(&mut world, 0.0, true)?;

    let mut status = Status::Completed;
    for tick in 0..experiment.n_steps {
        let t = tick as f64 * experiment.step;
        for (command, signal) in world.state.commands.iter_mut().zip(&scene.commands) {
            *command = signal.value(t);
        }
        if let Err((at, cause)) = world.advance(t, experiment.step) {
            status = stop::explain(&world, experiment, (tick, at, cause), method);
            break;
        }
        trace.add(&world.state);
        let now = (tick + 1) as f64 * experiment.step;
        if (tick + 1) % experiment.record_every == 0 {
            publish(&mut world, now, false)?;
        }
        if watch.interrupt.load(Ordering::Relaxed) {
            status = Status::Interrupted { tick: tick + 1, time: now };
            break;
        }
        if tick % 256 == 0 {
            (watch.progress)(tick as f64 / experiment.n_steps as f64);
        }
    }
    if let Some(csv) = csv {
        csv.finish()?;
    }
    let wall_time = clock.elapsed().as_secs_f64();
    let energy = ledger.close(&world);
    Ok(Simulated { table, status, method, trace, energy, effort: world.effort(), warnings, wall_time })
}

/// Follows the balance of energy.
struct Ledger {
    start: (f64, f64),
    worst: f64,
    last: (f64, f64),
}

impl Ledger {
    fn start(world: &mut World) -> Self {
        let e = world.observe(0.0).energy();
        Self { start: (e.kinetic, e.potential), worst: 0.0, last: (e.kinetic, e.potential) }
    }

    fn look(&mut self, seen: &Observation<'_>) {
        let (e, totals) = (seen.energy(), &seen.state.totals);
        let balance = e.total() - (self.start.0 + self.start.1) - totals[0] + totals[1];
        self.worst = self.worst.max(balance.abs());
        self.last = (e.kinetic, e.potential);
    }

    fn close(&self, world: &World) -> EnergyReport {
        let totals = &world.state.totals;
        EnergyReport {
            kinetic_start: self.start.0,
            kinetic_end: self.last.0,
            potential_start: self.start.1,
            potential_end: self.last.1,
            work: totals[0],
            dissipated: totals[1],
            residual: self.worst,
        }
    }
}
