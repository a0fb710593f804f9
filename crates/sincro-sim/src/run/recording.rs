//! Recording of a run, tick by tick: recorded rows, hash, balance of energy. A run from a file and a live session
//! keep it in the same way.

use std::sync::Arc;
use std::time::Instant;

use sincro_dynamics::world::{MethodKind, Observation, World};

use super::bounds::Bounds;
use super::lockstep::{Followed, LockStep};
use super::method_choice::MethodChanges;
use super::{RunError, RunOptions, Simulated, method_word};
use crate::audit::{Finding, LawAudit};
use crate::controller::ScriptFailure;
use crate::file::FileError;
use crate::load::Loaded;
use crate::replay::{FrameMap, Trajectory};
use crate::restructure::Renamed;
use crate::results::{EnergyReport, Status};
use crate::table::{CsvWriter, Table};
use crate::trace::Trace;
use crate::validity;
use sincro_scene::diagram::ControlDiagram;
use sincro_scene::experiment::Experiment;
use sincro_scene::record::Recorder;
use sincro_scene::scene::Scene;

use super::streams::Streams;

/// Recording of a run that is driven from outside: rows, frames, audit and energy balance. Calls in order:
/// [`Recording::new`], [`Recording::start`], [`Recording::tick`] after each step, [`Recording::finish`].
pub struct Recording {
    recorder: Recorder,
    table: Table,
    /// Bounds that end the run; none in the finer run of an error estimate, which goes as far as the first one.
    bounds: Option<Bounds>,
    csv: Option<CsvWriter>,
    streams: Streams,
    trajectory: Option<Trajectory>,
    validity: validity::Register,
    ledger: Ledger,
    audit: LawAudit,
    experiment: Experiment,
    trace: Trace,
    record_every: u64,
    /// Scene at the start, and the one that recorder, audit and frames know.
    scenes: [Arc<Scene>; 2],
    /// Changes of the structure that have been followed.
    followed: Followed,
    /// Places of what the frames hold, if the structure has changed.
    frame_map: Option<FrameMap>,
    /// The last tick that is recorded: a session may last longer than its experiment, its memory may not grow.
    last_tick: u64,
    clock: Instant,
}

impl Recording {
    /// Creates the recording of a run that has not started yet.
    ///
    /// # Errors
    ///
    /// [`RunError::Diagnostics`]: a recorded signal does not exist. [`RunError::File`]: the CSV file cannot be written.
    pub fn new(loaded: &Loaded, lockstep: &mut LockStep, options: RunOptions<'_>) -> Result<Self, RunError> {
        let Loaded { scene, experiment, controller, .. } = loaded;
        let entries = controller.as_ref().map(ControlDiagram::entries).unwrap_or_default();
        let recorder = Recorder::new(&experiment.record, &scene.model, &entries)?.with_units(&experiment.units);
        let rows = experiment.n_steps / experiment.record_every + 1;
        let table = Table::new(recorder.columns(), rows as usize);
        let bounds = (!options.refined && !options.takes_other_solutions)
            .then(|| Bounds::new(experiment, options.variant, &table));
        let names: Vec<&str> = recorder.columns().map(|(name, _)| name).collect();
        let csv = options.csv.map(|path| CsvWriter::create(path, &names)).transpose()?;
        let trajectory = options.keyframes.then(|| Trajectory::new(&scene.model, experiment));
        let validity = validity::Register::new(&scene.model);
        let clock = Instant::now();
        let (ledger, trace) = (Ledger::start(lockstep.world(), rows as usize), lockstep.trace());
        let (record_every, last_tick) = (experiment.record_every, experiment.n_steps);
        let streams = Streams::new(options.csv, rows as usize);
        let scenes = [Arc::clone(scene), Arc::clone(scene)];
        Ok(Self {
            recorder,
            table,
            bounds,
            csv,
            streams,
            trajectory,
            validity,
            ledger,
            audit: LawAudit::default(),
            experiment: experiment.clone(),
            trace,
            record_every,
            scenes,
            followed: Followed::default(),
            frame_map: None,
            last_tick,
            clock,
        })
    }

    /// Returns the hash of all states so far, the start included, for a snapshot or comparison.
    #[must_use]
    pub fn trace(&self) -> Trace {
        self.trace
    }

    /// Records the state before the first tick, after [`LockStep::start`]. Returns a sentence if a stop condition ends
    /// the run here; else `None`.
    ///
    /// # Errors
    ///
    /// [`FileError`]: the CSV file cannot be written.
    pub fn start(&mut self, lockstep: &mut LockStep) -> Result<Option<String>, FileError> {
        // scripts may have changed what the run starts with
        self.follow(lockstep);
        self.ledger = Ledger::start(lockstep.world(), self.ledger.balances.capacity());
        self.look(lockstep, Some(Row::First), false)
    }

    /// Records the state after one more tick, after [`LockStep::advance`]: its hash always, a row if one is due or
    /// `is_last`. Returns a sentence if a stop condition ends the run here; else `None`.
    ///
    /// # Errors
    ///
    /// [`FileError`]: the CSV file cannot be written.
    pub fn tick(&mut self, lockstep: &mut LockStep, is_last: bool) -> Result<Option<String>, FileError> {
        self.follow(lockstep);
        lockstep.hash_into(&mut self.trace);
        let (tick, t) = (lockstep.tick(), lockstep.t());
        self.validity.update(lockstep.world(), t);
        self.audit.tick(lockstep.world(), t);
        let row_is_due = tick <= self.last_tick && (tick.is_multiple_of(self.record_every) || is_last);
        self.look(lockstep, row_is_due.then_some(Row::Later), is_last || tick == self.last_tick)
    }

    /// Continues with another lock-step, `after`, which has the state of the last one, `before`, at the same tick, but
    /// for what was changed from outside. The energy that the change added or took counts in no balance.
    pub fn resume(&mut self, before: &mut LockStep, after: &mut LockStep) {
        let stored = |lockstep: &mut LockStep| {
            let t = lockstep.t();
            let seen = lockstep.world().observe(t);
            seen.energy().total() - seen.state.totals[0] + seen.state.totals[1]
        };
        let added = stored(after) - stored(before);
        self.ledger.added += added;
    }

    /// Goes on with the structure of the lock-step, if it has changed: columns stay, signals of what has gone are NaN.
    fn follow(&mut self, lockstep: &mut LockStep) {
        let before = self.followed.energy;
        if !lockstep.bring_up(&mut self.recorder, &mut self.followed) {
            return;
        }
        let scene = lockstep.scene().clone();
        let [start, known] = &self.scenes;
        let of_known = Renamed::new(known, &scene);
        self.audit.restructured(&known.model);
        self.validity.restructured(&known.model, &scene.model, &|path| of_known.path(path));
        self.ledger.added += self.followed.energy - before;
        self.frame_map = self.trajectory.as_ref().map(|t| FrameMap::new(&t.layout, start, &scene));
        self.scenes[1] = scene;
    }

    /// Observes the present state, once, for the `row` and the keyframe that are due; a run that ends here has both.
    fn look(&mut self, lockstep: &mut LockStep, row: Option<Row>, is_last: bool) -> Result<Option<String>, FileError> {
        let (tick, t) = (lockstep.tick(), lockstep.t());
        let is_due = |trajectory: &Trajectory| is_last || (trajectory.is_due(tick) && tick <= self.last_tick);
        let mut has_keyframe = self.trajectory.as_ref().is_some_and(is_due);
        if row.is_none() && !has_keyframe {
            return Ok(None);
        }
        let (seen, signals) = lockstep.observe(t);
        let mut end = None;
        if let Some(row) = row {
            self.ledger.update(&seen);
            self.audit.observe(&seen, t);
            let row = self.recorder.row(&seen, signals, t, row == Row::First);
            self.table.push_row(row);
            self.csv.as_mut().map_or(Ok(()), |csv| csv.push_row(row))?;
            end = self.bounds.as_mut().and_then(|bounds| bounds.reached(&self.table));
        }
        has_keyframe |= end.is_some();
        let (mut trajectory, mut poses) = (self.trajectory.as_mut().filter(|_| has_keyframe), None);
        if let Some(trajectory) = &mut trajectory {
            trajectory.record(&seen, tick, t, self.frame_map.as_ref());
            poses = self.frame_map.as_ref().map(|_| seen.scratch().link_poses().to_vec());
        }
        if row.is_some() {
            self.streams.update(lockstep.controllers_mut(), self.table.n_rows());
        }
        if let Some(trajectory) = trajectory {
            trajectory.runtime.update(t, poses.as_deref(), |visit| lockstep.visit_runtime_objects(visit));
        }
        Ok(end)
    }

    /// Largest energy so far `[J]`.
    pub fn energy_scale(&self) -> f64 {
        self.ledger.scale
    }

    /// Completes the recording and returns the result of the run; `status` and `method` are those of the run,
    /// `warnings` those found before it.
    ///
    /// # Errors
    ///
    /// [`FileError`]: the CSV file cannot be written.
    pub fn finish(
        mut self,
        lockstep: &mut LockStep,
        status: Status,
        method: MethodKind,
        mut warnings: Vec<String>,
    ) -> Result<Simulated, FileError> {
        // what scripts have changed as they ended
        self.follow(lockstep);
        let Self { mut table, csv, streams, trajectory, validity, mut ledger, audit, experiment, trace, clock, .. } =
            self;
        csv.map_or(Ok(()), CsvWriter::finish)?;
        let n_streams = streams.finish(lockstep.controllers_mut(), &mut table)?;
        let wall_time = clock.elapsed().as_secs_f64();
        let (step, n_steps) = (lockstep.step(), lockstep.tick());
        warnings.extend(lockstep.notices());
        warnings.extend(about_method(lockstep.method_changes()));
        let failures: Vec<Finding> = lockstep.script_failures().into_iter().map(script_errors).collect();
        let world = lockstep.world();
        let (energy, statistics) = (ledger.close(world), world.statistics());
        let mut laws = audit.close(world, &experiment, method);
        laws.extend(failures);
        let outside = validity.close(world.model(), step);
        warnings.extend(validity::words(&outside, n_steps));
        warnings.extend(about_constraints(world));
        let is_ambiguous = world.ambiguous_events().count > 0;
        if trajectory.as_ref().is_some_and(|trajectory| trajectory.runtime.is_cut) {
            warnings.push("scripts and clients made more objects and drawings than are kept for pictures: the pages lack the last".to_owned());
        }
        let (messages, n_more) = lockstep.messages();
        if n_more > 0 {
            warnings.push(format!("scripts and clients said {n_more} more things than are kept"));
        }
        let (changes, images) = (lockstep.changes(), lockstep.take_images());
        // many short runs of a long experiment may wait to be written
        table.shrink_to_fit();
        ledger.balances.shrink_to_fit();
        Ok(Simulated {
            table,
            status,
            method,
            trace,
            trajectory,
            energy,
            laws,
            balances: ledger.balances,
            energy_scale: ledger.scale,
            statistics,
            outside,
            is_ambiguous,
            warnings,
            messages,
            changes,
            images,
            n_streams,
            wall_time,
            compile_time: lockstep.compile_time(),
        })
    }
}

/// Row of the table that is due.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Row {
    /// The first row, of the start.
    First,
    /// After a tick.
    Later,
}

/// Calls of a script that have failed, of which none should.
fn script_errors(failure: ScriptFailure) -> Finding {
    Finding {
        law: "script-errors".to_owned(),
        element: failure.object,
        time: failure.first,
        value: failure.count as f64,
        limit: 0.0,
        unit: String::new(),
        help: format!("mend the script, or stop at its first error with on_error = \"stop\": {}", failure.message),
    }
}

/// Warning about changes of the method.
fn about_method(changes: MethodChanges) -> Option<String> {
    let (t, method) = changes.first?;
    let word = method_word(method);
    Some(match changes.count {
        1 => format!("`auto` changed to `{word}` at t = {t:.6} s, where the stiffness had changed"),
        n => format!("`auto` changed its method {n} times with the stiffness, first to `{word}` at t = {t:.6} s"),
    })
}

/// Warnings about the convergence of the constraint solver.
fn about_constraints(world: &World) -> Vec<String> {
    let mut warnings = Vec::new();
    let rough = world.statistics().fallback_ticks;
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
    if let Some(report) = world.solver_report().filter(|r| r.unconverged_islands > 0) {
        warnings.push(format!(
            "{} of {} islands of contacts were left with a residual above 1e-6, up to {:.1e} of their largest force: take a smaller step",
            report.unconverged_islands, report.islands, report.worst_island
        ));
    }
    let passed = world.passed_singularities();
    if passed.count > 0 {
        let words = if passed.count == 1 { "once,".to_owned() } else { format!("{} times, first", passed.count) };
        warnings.push(format!(
            "loops passed a singular position {words} at t = {:.6} s; their momentum decided the branch there",
            passed.first
        ));
    }
    let ambiguous = world.ambiguous_events();
    if ambiguous.count > 0 {
        let words = match ambiguous.count {
            1 => "an event".to_owned(),
            n => format!("{n} events, the first"),
        };
        warnings.push(format!(
            "after {words} at t = {:.6} s several sets of contact forces keep all laws and move the bodies differently (rigid contacts with friction that share a load); the run follows one of them, and error bars, where there are any, cover a run that follows others: give surfaces a `stiffness` if the difference matters",
            ambiguous.first
        ));
    }
    let jams = world.jams();
    if jams.count > 0 {
        let words = if jams.count == 1 { "once,".to_owned() } else { format!("{} times, first", jams.count) };
        warnings.push(format!(
            "bodies jammed {words} at t = {:.6} s: no finite forces of contact and friction kept their laws there, and impulses stopped what moved",
            jams.first
        ));
    }
    let chatter = world.chattering_steps();
    if chatter.count > 0 {
        let words = match chatter.count {
            1 => "in a step".to_owned(),
            n => format!("in {n} steps, the first"),
        };
        warnings.push(format!(
            "{words} at t = {:.6} s motors, friction and contacts changed their modes more than 20 times: each change hangs on the last, and error bars may be too small from there on; surfaces with a `stiffness`, motors in mode `spring`, or with a `max_torque` that they do not reach, end it",
            chatter.first
        ));
    }
    warnings
}

/// Follows the balance of energy.
struct Ledger {
    /// Kinetic and potential energy at the start.
    start: (f64, f64),
    /// Energy that changes of state and structure from outside have brought in since.
    added: f64,
    worst: f64,
    last: (f64, f64),
    /// Balance of each row.
    balances: Vec<f64>,
    /// Largest energy so far.
    scale: f64,
}

impl Ledger {
    /// For at most `rows` rows.
    fn start(world: &mut World, rows: usize) -> Self {
        let e = world.observe(0.0).energy();
        let (start, balances) = ((e.kinetic, e.potential), Vec::with_capacity(rows));
        Self { start, added: 0.0, worst: 0.0, last: start, balances, scale: start.0.abs().max(start.1.abs()) }
    }

    fn update(&mut self, seen: &Observation<'_>) {
        let (e, totals) = (seen.energy(), &seen.state.totals);
        let balance = e.total() - (self.start.0 + self.start.1) - self.added - totals[0] + totals[1];
        self.worst = self.worst.max(balance.abs());
        self.balances.push(balance);
        let energies = [e.kinetic, e.potential, totals[0], totals[1]];
        self.scale = energies.iter().fold(self.scale, |scale, x| scale.max(x.abs()));
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
