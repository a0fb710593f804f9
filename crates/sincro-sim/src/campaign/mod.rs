//! An experiment with everything that belongs to it: the main run, its error bars, its variants, its sweep, their
//! checks.

use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use sincro_dynamics::joint::JointKind;

mod audit;
mod refine;

pub use audit::audit;

use crate::audit::AuditReport;
use crate::check::{Outcome, evaluate, evaluate_sweep};
use crate::controller::{Change, Message};
use crate::load::Loaded;
use crate::replay::SceneView;
use crate::results::{
    ChangeReport, CheckReport, ColumnReport, MessageReport, Override as Setting, RunReport, Settings, Status,
    SweepReport, VariantReport,
};
use crate::run::{RunError, RunMonitor, RunOptions, Simulated, method_word, simulate};
use crate::sweep::Sweep;
use crate::table::Table;
use crate::trace::model_hash;
use crate::workers::{Processors, on_all_processors};
use sincro_scene::diagram::ControlDiagram;
use sincro_scene::experiment::{Experiment, Sweep as SweepPlan, Variant};
use sincro_scene::open::settings_with;
use sincro_scene::overrides::Override;
use sincro_scene::scene::{ObjectKind, Scene};

/// One run of a [`Campaign`] (main run or variant), judged by audit and checks.
#[derive(Clone, Debug)]
pub struct CompletedRun {
    /// Recorded signals, status and statistics of the run.
    pub simulated: Simulated,
    /// Recorded signals with units and error bars, in the order of the table's columns.
    pub columns: Vec<ColumnReport>,
    /// Audit of the run.
    pub audit: AuditReport,
    /// Outcomes of its checks, in their order.
    pub outcomes: Vec<Outcome>,
    /// Settings with which it ran.
    pub settings: Settings,
    /// Hash of its model, 16 hexadecimal digits.
    pub model_hash: String,
    /// Block diagram that controlled it, if there was one.
    pub controller: Option<ControlDiagram>,
    /// Visible scene, for the replay.
    pub view: SceneView,
}

/// Results of an experiment: the main run, its variants and its sweep, as [`run_campaign`] returns them.
///
/// ```
/// use sincro_sim::prelude::*;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/acrobot");
/// let loaded = load(folder.as_ref(), &[], Extensions::default())?;
/// let interrupt = std::sync::atomic::AtomicBool::new(false);
/// let done: Campaign = run_campaign(folder.as_ref(), &[], &loaded, None, &interrupt, &mut |_, _| {})?;
/// // its check: an arm that swings freely keeps its energy
/// let check = &done.main.outcomes[0];
/// assert_eq!(check.verdict, Verdict::Holds);
/// assert!(check.deviation.unwrap() <= check.limit); // [J]
/// assert!(done.variants.is_empty() && done.sweep.is_none());
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct Campaign {
    /// Main run.
    pub main: CompletedRun,
    /// Variants with their runs, in the order of the experiment.
    pub variants: Vec<(Variant, CompletedRun)>,
    /// Sweep and the outcomes of its checks, if the experiment has one.
    pub sweep: Option<(Sweep, Vec<Outcome>)>,
    /// Report of all runs, the content of `run.json`.
    pub report: RunReport,
}

/// Callback for the progress of a campaign: receives what is being done (`run`, `run and 3 variants` …) and the share
/// of it that is done, 0 to 1.
pub type Progress<'a> = &'a mut dyn FnMut(&str, f64);

/// Runs a loaded experiment with its variants and its sweep on all processors, and judges them by their checks.
/// `folder` and `overrides` are those that it was loaded with; `out_dir`, if given, receives `signals.csv`,
/// `sweep.csv`, `run.json` and a folder for each variant. Once `interrupt` is true each run ends after its present
/// tick, those that are still to come after their first. With controllers of a program ([`Loaded::controllers`]) one
/// run is made after the other.
///
/// # Errors
///
/// [`RunError::Diagnostics`]: findings of a variant or of a point of the sweep, or a recorded signal that does not
/// exist. [`RunError::File`]: a file cannot be written. A run that stops or a check that fails is a result, not an
/// error.
///
/// ```
/// use std::sync::atomic::AtomicBool;
///
/// use sincro_sim::prelude::*;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/acrobot");
/// let shorter = [Override::new("duration", "1.0")];
/// let loaded = load(folder.as_ref(), &shorter, Extensions::default())?;
/// let interrupt = AtomicBool::new(false); // a handler of Ctrl-C would set it
/// let mut share = 0.0;
/// let done = run_campaign(folder.as_ref(), &shorter, &loaded, None, &interrupt, &mut |_what, done| share = done)?;
/// assert_eq!(done.report.status, Status::Completed);
/// assert_eq!(done.main.simulated.table.times().last(), Some(&1.0)); // [s]
/// # Ok(())
/// # }
/// ```
pub fn run_campaign(
    folder: &Path,
    overrides: &[Override],
    loaded: &Loaded,
    out_dir: Option<&Path>,
    interrupt: &AtomicBool,
    progress: Progress<'_>,
) -> Result<Campaign, RunError> {
    let (main, variants) = match loaded.experiment.variants.as_slice() {
        [] => {
            let mut tell = |share: f64| progress("run", share);
            let mut monitor = RunMonitor { interrupt, progress: &mut tell };
            let mut main = one_run(loaded, None, out_dir, (&mut monitor, &Processors::new()))?;
            main.outcomes = evaluate_checks(loaded, None, &main, &[]);
            (main, Vec::new())
        }
        variants => run_with_variants(overrides, (loaded, variants), out_dir, interrupt, progress)?,
    };
    let interrupted = |done: &CompletedRun| matches!(done.simulated.status, Status::Interrupted { .. });
    let sweep = match &loaded.experiment.sweep {
        Some(plan) if !interrupted(&main) => Some(run_sweep(overrides, loaded, plan, interrupt, progress)?),
        _ => None,
    };
    let report = report(folder, loaded, &main, &variants, sweep.as_ref());
    if let Some(dir) = out_dir {
        if let Some((sweep, _)) = &sweep {
            sweep.write(dir)?;
        }
        report.write(dir)?;
    }
    Ok(Campaign { main, variants, sweep, report })
}

/// Judges a single run that was made elsewhere, such as by clients of a live session, by the checks of its experiment:
/// without variants, sweep and error bars, because it cannot be repeated. `folder` is the scene's folder, for the
/// report.
#[must_use]
pub fn judge(folder: &Path, loaded: &Loaded, simulated: Simulated) -> Campaign {
    let columns = ColumnReport::of_table(&simulated.table);
    let time = simulated.table.times().last().copied();
    let ended = if simulated.status == Status::Completed { None } else { time };
    let outcomes = evaluate(&loaded.experiment.checks, &simulated.table, simulated.status.stopped_at().or(ended));
    let settings = settings(&loaded.experiment, &simulated);
    let model_hash = model_hash(&loaded.scene.model);
    let controller = loaded.controller.clone();
    let view = SceneView::new(&loaded.scene);
    let audit = audit(loaded, &simulated, None);
    let main = CompletedRun { simulated, columns, audit, outcomes, settings, model_hash, controller, view };
    let report = report(folder, loaded, &main, &[], None);
    Campaign { main, variants: Vec::new(), sweep: None, report }
}

/// The main run and its variants, on all processors.
fn run_with_variants(
    overrides: &[Override],
    (loaded, variants): (&Loaded, &[Variant]),
    out_dir: Option<&Path>,
    interrupt: &AtomicBool,
    progress: Progress<'_>,
) -> Result<(CompletedRun, Vec<(Variant, CompletedRun)>), RunError> {
    let n = 1 + variants.len();
    let shares: Vec<AtomicU64> = (0..n).map(|_| AtomicU64::new(0)).collect();
    let (is_refused, processors) = (AtomicBool::new(false), Processors::new());
    let job = |k: usize| -> Result<Option<(Option<Loaded>, CompletedRun)>, RunError> {
        let variant = k.checked_sub(1).map(|k| &variants[k]);
        if is_refused.load(Ordering::Relaxed) {
            return Ok(None);
        }
        let mut tell = |share: f64| shares[k].store(share.to_bits(), Ordering::Relaxed);
        let by = (&mut RunMonitor { interrupt, progress: &mut tell }, &processors);
        let done = match variant {
            None => one_run(loaded, None, out_dir, by).map(|done| (None, done)),
            Some(variant) => variant_run((overrides, loaded), variant, out_dir, by),
        };
        tell(1.0);
        is_refused.fetch_or(done.is_err(), Ordering::Relaxed);
        done.map(Some)
    };
    let words = format!("run and {} variant{}", n - 1, if n == 2 { "" } else { "s" });
    let mut meanwhile = || {
        let done: f64 = shares.iter().map(|share| f64::from_bits(share.load(Ordering::Relaxed))).sum();
        progress(&words, done / n as f64);
    };
    let done: Vec<_> = on_processors(loaded, n, &job, &mut meanwhile).into_iter().collect::<Result<_, _>>()?;
    // none is left out where none is refused
    let mut done = done.into_iter().flatten();
    let (_, mut main) = done.next().expect("the main run is the first");
    main.outcomes = evaluate_checks(loaded, None, &main, &[]);
    let mut made: Vec<(Variant, CompletedRun)> = Vec::new();
    for (variant, done) in variants.iter().zip(done) {
        let (Some(own), mut done) = done else { unreachable!("a variant has settings of its own") };
        let before: Vec<(&str, &Table)> = std::iter::once(("main", &main.simulated.table))
            .chain(made.iter().map(|(v, done)| (v.name.as_str(), &done.simulated.table)))
            .collect();
        done.outcomes = evaluate_checks(&own, Some(&variant.name), &done, &before);
        made.push((variant.clone(), done));
    }
    Ok((main, made))
}

/// Results of `n` jobs on all processors; one after the other with controllers of a program, which may have a memory
/// that all runs share.
fn on_processors<T: Send>(
    loaded: &Loaded,
    n: usize,
    job: &(dyn Fn(usize) -> T + Sync),
    between: &mut dyn FnMut(),
) -> Vec<T> {
    if loaded.controllers.is_empty() {
        return on_all_processors(n, job, between);
    }
    let one = |k| {
        between();
        job(k)
    };
    (0..n).map(one).collect()
}

/// One variant of an experiment, and the experiment with its settings.
fn variant_run(
    (overrides, loaded): (&[Override], &Loaded),
    variant: &Variant,
    out_dir: Option<&Path>,
    by: (&mut RunMonitor<'_>, &Processors),
) -> Result<(Option<Loaded>, CompletedRun), RunError> {
    let own = loaded.with_overrides(&settings_with(overrides, &variant.set))?;
    let dir = out_dir.map(|dir| dir.join("variants").join(&variant.name));
    if let Some(dir) = &dir {
        crate::file::prepare(dir)?;
    }
    let done = one_run(&own, Some(&variant.name), dir.as_deref(), by)?;
    Ok((Some(own), done))
}

/// One run with error bars, whose checks are still to be evaluated; `signals.csv` goes into `dir`.
fn one_run(
    loaded: &Loaded,
    variant: Option<&str>,
    dir: Option<&Path>,
    (monitor, processors): (&mut RunMonitor<'_>, &Processors),
) -> Result<CompletedRun, RunError> {
    let csv = dir.map(|dir| dir.join("signals.csv"));
    let options = RunOptions { csv: csv.as_deref(), variant, keyframes: true, ..RunOptions::default() };
    let (simulated, finer) = refine::with_finer_run(loaded, options, monitor, processors)?;
    let columns = match simulated.status {
        Status::Completed => refine::columns(loaded, &simulated, finer.as_ref(), (monitor, processors))?,
        _ => ColumnReport::of_table(&simulated.table),
    };
    let audit = audit(loaded, &simulated, finer.as_ref());
    let settings = settings(&loaded.experiment, &simulated);
    let model_hash = model_hash(&loaded.scene.model);
    let controller = loaded.controller.clone();
    let view = SceneView::new(&loaded.scene);
    Ok(CompletedRun { simulated, columns, audit, outcomes: Vec::new(), settings, model_hash, controller, view })
}

/// Outcomes of the checks of a run; for a variant of those that the file gives it, which may look at the runs `before`
/// it.
fn evaluate_checks(
    loaded: &Loaded,
    variant: Option<&str>,
    run: &CompletedRun,
    before: &[(&str, &Table)],
) -> Vec<Outcome> {
    let experiment = &loaded.experiment;
    let stopped = run.simulated.status.stopped_at();
    let Some(variant) = variant.and_then(|name| experiment.variants.iter().find(|v| v.name == name)) else {
        return evaluate(&experiment.checks, &run.simulated.table, stopped);
    };
    let table = run.simulated.table.with_columns_of(before);
    let mut outcomes = evaluate(&variant.checks, &table, stopped);
    if variant.inherit_checks {
        outcomes.extend(evaluate(&experiment.checks, &table, stopped));
    }
    outcomes
}

fn settings(experiment: &Experiment, run: &Simulated) -> Settings {
    Settings {
        integrator: method_word(run.method).into(),
        step: experiment.step,
        accuracy: experiment.accuracy,
        duration: experiment.duration,
        record_every: experiment.record_every,
        seed: experiment.seed,
        overrides: Vec::new(),
    }
}

/// The runs of a sweep on all processors; results in the order of the values.
fn run_sweep(
    overrides: &[Override],
    loaded: &Loaded,
    plan: &SweepPlan,
    interrupt: &AtomicBool,
    progress: Progress<'_>,
) -> Result<(Sweep, Vec<Outcome>), RunError> {
    let n = plan.values.len();
    let point = |value: f64| -> Result<(Simulated, AuditReport), RunError> {
        let settings: Vec<Override> = overrides.iter().cloned().chain(plan.settings(value)).collect();
        let at = loaded.with_overrides(&settings)?;
        let run = simulate(&at, RunOptions::default(), &mut RunMonitor { interrupt, progress: &mut |_| {} })?;
        let audit = audit(&at, &run, None);
        Ok((run, audit))
    };
    let points = on_processors(loaded, n, &|k| point(plan.values[k]), &mut || ());
    progress("sweep", 1.0);
    let unit = parameter_unit(&loaded.scene, &plan.parameter.value);
    let signals: Vec<(&str, &str)> = Vec::new();
    let mut sweep = Sweep::new(&plan.parameter.value, unit, signals, n);
    let mut audits = Vec::with_capacity(n);
    for (k, result) in points.into_iter().enumerate() {
        let (run, audit) = result?;
        audits.push((format!("{} = {}", plan.parameter.value, plan.values[k]), audit));
        if k == 0 {
            let columns =
                run.table.columns[..n_recorded(&run)].iter().skip(1).map(|c| (c.name.as_str(), c.unit.as_str()));
            sweep = Sweep::new(&plan.parameter.value, unit, columns, n);
        }
        let finals: Vec<f64> = run.table.columns[..n_recorded(&run)]
            .iter()
            .skip(1)
            .map(|c| c.values.last().copied().unwrap_or(f64::NAN))
            .collect();
        match &run.status {
            // at a bound a run is at its end: the values there are its final ones
            Status::Completed | Status::Ended { .. } => sweep.push(plan.values[k], &finals),
            Status::Stopped { time, reason, .. } => sweep.push_stopped(plan.values[k], *time, reason),
            Status::Interrupted { time, .. } => sweep.push_stopped(plan.values[k], *time, "interrupted"),
        }
    }
    sweep.audit = AuditReport::worst(audits);
    let outcomes = evaluate_sweep(&loaded.experiment.sweep.as_ref().map_or(Vec::new(), |s| s.checks.clone()), &sweep);
    Ok((sweep, outcomes))
}

/// Unit of what a `--set` path reaches, as far as its last word and the kind of its joint tell; else empty.
fn parameter_unit(scene: &Scene, path: &str) -> &'static str {
    let (object, keys) = path.split_once('.').unwrap_or(("", path));
    let is_length = scene
        .object(object)
        .is_some_and(|o| matches!(o.kind, ObjectKind::Joint { kind: JointKind::Prismatic { .. }, .. }));
    let names = scene.model.names();
    let is_length = is_length || names.spring_dampers.iter().chain(&names.bushings).any(|name| name == object);
    let of_joint = |angle: &'static str, length: &'static str| if is_length { length } else { angle };
    match keys.rsplit('.').next().unwrap_or(keys) {
        "stiffness" => of_joint("N·m/rad", "N/m"),
        "damping" => of_joint("N·m·s/rad", "N·s/m"),
        "rotational_stiffness" => "N·m/rad",
        "rotational_damping" => "N·m·s/rad",
        "friction" | "max_torque" | "torque" => of_joint("N·m", "N"),
        "rest" => of_joint("rad", "m"),
        "velocity" | "max_velocity" => of_joint("rad/s", "m/s"),
        "armature" => of_joint("kg·m²", "kg"),
        "mass" => "kg",
        "density" => "kg/m³",
        "radius" | "length" | "free_length" => "m",
        "preload" => "N",
        "step" | "duration" => "s",
        _ => "",
    }
}

fn report(
    folder: &Path,
    loaded: &Loaded,
    main: &CompletedRun,
    variants: &[(Variant, CompletedRun)],
    sweep: Option<&(Sweep, Vec<Outcome>)>,
) -> RunReport {
    let scene = sincro_scene::open::folder_name(folder);
    let diagnostics = loaded.warnings.iter().map(|w| w.message.clone());
    RunReport {
        sincro_version: env!("CARGO_PKG_VERSION").into(),
        scene,
        scene_path: folder.display().to_string(),
        title: loaded.experiment.title.clone(),
        status: main.simulated.status.clone(),
        settings: main.settings.clone(),
        model_hash: main.model_hash.clone(),
        trace_hash: main.simulated.trace.to_string(),
        n_dof: loaded.scene.freedom().dofs(),
        columns: main.columns.clone(),
        energy: Some(main.simulated.energy),
        audit: main.audit.clone(),
        checks: main.outcomes.iter().map(CheckReport::from).collect(),
        sweep: sweep.map(|(sweep, outcomes)| SweepReport::new(sweep, outcomes)),
        variants: variants.iter().map(variant_report).collect(),
        outside_theory: main.simulated.outside.iter().map(Into::into).collect(),
        warnings: diagnostics.chain(main.simulated.warnings.iter().cloned()).collect(),
        messages: main.simulated.messages.iter().map(message_report).collect(),
        changes: main.simulated.changes.iter().map(change_report).collect(),
        wall_time_s: main.simulated.wall_time,
        real_time_factor: main.simulated.table.times().last().copied().unwrap_or(0.0) / main.simulated.wall_time,
        compile_time_s: main.simulated.compile_time,
    }
}

/// Columns that every run of a sweep has: streams of graphs are a matter of the script.
fn n_recorded(run: &Simulated) -> usize {
    run.table.columns.len() - run.n_streams
}

fn change_report(change: &Change) -> ChangeReport {
    let Change { t, object, quantity, value } = change;
    ChangeReport { t: *t, object: object.clone(), quantity: (*quantity).to_owned(), value: value.clone() }
}

fn message_report(message: &Message) -> MessageReport {
    MessageReport { t: message.t, object: message.object.clone(), text: message.text.clone() }
}

fn variant_report((variant, done): &(Variant, CompletedRun)) -> VariantReport {
    let set = variant.set.iter().map(|s| Setting { path: s.path.value.clone(), value: s.value.value.clone() });
    VariantReport {
        name: variant.name.clone(),
        description: variant.description.clone(),
        status: done.simulated.status.clone(),
        settings: Settings { overrides: set.collect(), ..done.settings.clone() },
        model_hash: done.model_hash.clone(),
        trace_hash: done.simulated.trace.to_string(),
        columns: done.columns.clone(),
        energy: Some(done.simulated.energy),
        audit: done.audit.clone(),
        checks: done.outcomes.iter().map(CheckReport::from).collect(),
        outside_theory: done.simulated.outside.iter().map(Into::into).collect(),
        warnings: done.simulated.warnings.clone(),
        wall_time_s: done.simulated.wall_time,
    }
}
