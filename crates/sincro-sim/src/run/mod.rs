//! The run: who acts when.
//!
//! One tick k, from t_k to t_{k+1} (DESIGN: measure, ask, hold, advance, publish):
//!
//! 1. commands are latched: those of signals sampled at t_k, those of the diagram as it was evaluated at t_k; its memory is updated;
//! 2. the world advances under them, continuous blocks with it;
//! 3. the diagram measures the new state and every block that is due is evaluated;
//! 4. the new state is hashed, and recorded if a row is due.
//!
//! Time is `tick · step`, never accumulated. If the world cannot go on, everything recorded stays, and the run says where, who and
//! why (`stop.rs`).

mod campaign;
mod lockstep;
mod refine;
mod stop;
mod trace;

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use sincro_dynamics::integrate::Control;
use sincro_dynamics::stiffness::{RK4_LIMIT, Stiffness, stiffest};
use sincro_dynamics::world::{Effort, MethodKind, Observation, World};

pub use campaign::{Campaign, Done, Progress, run_campaign};
pub use lockstep::{Halt, LockStep};
pub use trace::{Trace, model_hash, plant_hash};

use crate::diagram::Controller;
use crate::experiment::{Experiment, Integrator};
use crate::load::Loaded;
use crate::problem::Problems;
use crate::record::Recorder;
use crate::results::{EnergyReport, FileError, Status};
use crate::scene::Scene;
use crate::table::{CsvWriter, Table};

/// Rate times base step above which `auto` takes the stiff method.
const STIFF_FROM: f64 = 1.0;
/// Rate times base step above which an explicit method with error control is slow enough to be announced.
const SLOW_FROM: f64 = 20.0;
/// Pole times step above which a method that takes a feedback at the old state diverges.
const EULER_LIMIT: f64 = 1.0;
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

/// As [`choose_method`], the diagram's continuous blocks considered too: by how fast each decays, and by the fastest pole of the loop that
/// they close, which the linearisation gives exactly.
#[must_use]
pub fn method_for(loaded: &Loaded) -> (MethodKind, Vec<String>) {
    let (kind, mut warnings) = choose_method(&loaded.scene, &loaded.experiment);
    let Some(controller) = loaded.controller.as_ref().filter(|c| c.wiring.program().is_continuous()) else {
        return (kind, warnings);
    };
    let step = loaded.experiment.step;
    if let Some((block, rate)) = controller.fastest()
        && kind == MethodKind::DormandPrince
        && rate * step > SLOW_FROM
    {
        if loaded.experiment.integrator == Integrator::Auto {
            return (MethodKind::Stiff, warnings);
        }
        let sub_steps = rate * step / 3.3;
        warnings.push(format!(
            "block `{block}` decays at {rate:.3e} 1/s and makes `dormand-prince` take about {sub_steps:.0} sub-steps a step. Use \
             integrator = \"auto\" or \"stiff\""
        ));
    }
    // fixed steps take what blocks do to the world at the old state, whatever else they take at the new one
    let limit = match kind {
        MethodKind::Rk4 => RK4_LIMIT,
        MethodKind::SemiImplicitEuler | MethodKind::Implicit => EULER_LIMIT,
        MethodKind::DormandPrince | MethodKind::Stiff => return (kind, warnings),
    };
    if let Some((closed, open)) = crate::linearize::fastest_poles(loaded, kind)
        && closed > 1.2 * open
        && closed * step > limit
    {
        warnings.push(format!(
            "the loop that the diagram closes has a pole of {closed:.3e} 1/s, too fast for `{}` at a step of {step} s: the run may \
             diverge. Use integrator = \"auto\", or a step below {:.1e} s",
            method_word(kind),
            limit / closed
        ));
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

/// The world of a scene, ready for its first tick, without the scene's diagram.
#[must_use]
pub fn world_of(scene: &Scene, experiment: &Experiment, kind: MethodKind, refined: bool) -> World {
    let mut world = world_with_room(scene, experiment, kind, refined, 0);
    world.settle_start(0.0);
    world
}

/// A world with room for `n_states` continuous states of a diagram, its drives not settled yet.
fn world_with_room(scene: &Scene, experiment: &Experiment, kind: MethodKind, refined: bool, n_states: usize) -> World {
    let accuracy = if refined { experiment.accuracy / FINER } else { experiment.accuracy };
    let first_step = (experiment.step * 0.1).min(1e-3);
    let (model, control) = ((*scene.model).clone(), Control::new(accuracy, first_step));
    let mut world = World::with_attachment(model, scene.initial.clone(), kind, control, true, n_states);
    world.set_substeps(if refined { 2 } else { 1 });
    world
}

/// Runs an experiment once, without its variants, sweep and checks.
///
/// # Errors
///
/// If a recorded signal does not exist or the CSV file cannot be written. A run that stops is not an error: see
/// [`Simulated::status`].
pub fn simulate(loaded: &Loaded, manner: Manner<'_>, watch: &mut Watch<'_>) -> Result<Simulated, RunError> {
    let Loaded { scene, experiment, controller, .. } = loaded;
    let (method, warnings) = method_for(loaded);
    let entries = controller.as_ref().map(Controller::entries).unwrap_or_default();
    let mut recorder = Recorder::new(&experiment.record, &scene.model, &entries)?;
    let rows = experiment.n_steps / experiment.record_every + 1;
    let mut table = Table::new(recorder.columns(), rows as usize);
    let names: Vec<&str> = recorder.columns().map(|(name, _)| name).collect();
    let mut csv = manner.csv.map(|path| CsvWriter::create(path, &names)).transpose()?;

    let clock = Instant::now();
    let mut lockstep = LockStep::new(loaded, method, manner.refined);
    let mut ledger = Ledger::start(lockstep.world());
    let mut trace = lockstep.trace();
    let mut publish = |lockstep: &mut LockStep, t: f64, is_start: bool| -> Result<(), FileError> {
        let (seen, signals) = lockstep.observe(t);
        ledger.look(&seen);
        let row = recorder.row(&seen, signals, t, is_start);
        table.push_row(row);
        csv.as_mut().map_or(Ok(()), |csv| csv.push_row(row))
    };
    let mut status = Status::Completed;
    let first = lockstep.start();
    publish(&mut lockstep, 0.0, true)?;
    if let Err(halt) = first {
        status = halt.explain(&mut lockstep, experiment, method);
    }
    for tick in 0..experiment.n_steps {
        if status != Status::Completed {
            break;
        }
        let advanced = lockstep.advance();
        if let Err(halt @ Halt::World { .. }) = advanced {
            status = halt.explain(&mut lockstep, experiment, method);
            break;
        }
        lockstep.add_to(&mut trace);
        let now = (tick + 1) as f64 * experiment.step;
        if (tick + 1) % experiment.record_every == 0 || advanced.is_err() {
            publish(&mut lockstep, now, false)?;
        }
        if let Err(halt) = advanced {
            status = halt.explain(&mut lockstep, experiment, method);
            break;
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
    let world = lockstep.world();
    let energy = ledger.close(world);
    let mut warnings = warnings;
    warnings.extend(about_constraints(world));
    Ok(Simulated { table, status, method, trace, energy, effort: world.effort(), warnings, wall_time })
}

/// What the user should know of the constraint solver's work.
fn about_constraints(world: &World) -> Vec<String> {
    let mut warnings = Vec::new();
    let rough = world.effort().rough_ticks;
    if rough > 0 {
        warnings.push(format!(
            "contacts changed so often that {rough} steps were finished at velocity level, to first order: take a smaller step, or compliant contacts"
        ));
    }
    if let Some(report) = world.solver_report().filter(|r| r.not_converged > 0) {
        warnings.push(format!(
            "the constraint solver did not converge in {} of {} problems; forces or rates miss their laws by up to {:.1e} of the largest",
            report.not_converged, report.solved, report.worst_residual
        ));
    }
    warnings
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
