//! A run, from its start to its end.
//!
//! [`LockStep::advance`] is one base step, with its stages in order; [`simulate`] makes them all, hashes and records
//! the state after each.
//!
//! Time is `tick · step`, never accumulated. If the world cannot go on, everything recorded stays, and the run says
//! where, who and why (`stop.rs`).

mod bounds;
#[cfg(feature = "jit")]
mod compiled;
mod lockstep;
mod method_choice;
mod recording;
mod stop;
mod streams;

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use sincro_dynamics::aero::rotor::SpeedSource;
use sincro_dynamics::integrate::Control;
use sincro_dynamics::stiffness::{RK4_LIMIT, Stiffness, stiffest};
use sincro_dynamics::world::{MethodKind, StepStatistics, World};

use crate::audit::Finding;
use crate::trace::Trace;
use crate::validity::ValidityViolation;
#[cfg(feature = "jit")]
pub use compiled::EquationsBy;
pub use lockstep::{Followed, Halt, LockStep};
pub use recording::Recording;

use crate::controller::{Change, Message, SavedImage};
use crate::file::FileError;
use crate::load::Loaded;
use crate::replay::Trajectory;
use crate::results::{EnergyReport, Status};
use crate::table::Table;
use sincro_scene::diagnostic::Diagnostics;
use sincro_scene::diagram::ControlDiagram;
use sincro_scene::experiment::{Experiment, Integrator};
use sincro_scene::scene::Scene;

/// Rate times base step above which `auto` takes the stiff method.
const STIFF_FROM: f64 = 1.0;
/// Rate times base step above which an explicit method with error control is slow enough to be announced.
const SLOW_FROM: f64 = 20.0;
/// Pole times step above which a method that takes a feedback at the old state diverges.
const EULER_LIMIT: f64 = 1.0;
/// Refinement of the second run of an error estimate: fixed steps halved, tolerance divided by this.
const FINER: f64 = 100.0;
/// Smallest tolerance of that run: beyond, `stiff` makes ever shorter steps.
const FINEST: f64 = 1e-15;

/// Result of a single run, by [`simulate`]: recorded signals, status, statistics.
///
/// ```
/// use sincro_sim::prelude::*;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/acrobot");
/// let loaded = load(folder.as_ref(), &[], Extensions::default())?;
/// let mut monitor = RunMonitor { interrupt: &false.into(), progress: &mut |_| {} };
/// let run: Simulated = simulate(&loaded, RunOptions::default(), &mut monitor)?;
/// let tip = run.table.column("/shoulder/upper/elbow/lower/tip.position.z").unwrap();
/// assert!((tip.values[0] + 2.0 * f64::cos(0.1)).abs() < 1e-12); // two links of 1 m, 0.1 rad from hanging
/// assert_eq!((run.status, run.statistics.steps), (Status::Completed, 200));
/// assert!(run.balances.iter().all(|joules| joules.abs() < 1e-5) && run.warnings.is_empty());
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct Simulated {
    /// Recorded signals.
    pub table: Table,
    /// Status at the end of the run.
    pub status: Status,
    /// Integration method that was used; with `auto`, the first one.
    pub method: MethodKind,
    /// Hash of the states of all ticks: equal hashes mean equal bits.
    pub trace: Trace,
    /// Frames for the replay, if they were asked for.
    pub trajectory: Option<Trajectory>,
    /// Energy balance.
    pub energy: EnergyReport,
    /// Laws of the mechanism and the solver, each with its worst value.
    pub laws: Vec<Finding>,
    /// Error of the energy balance at each recorded row `[J]`.
    pub balances: Vec<f64>,
    /// Largest energy that entered the balance `[J]`, to judge its error by.
    pub energy_scale: f64,
    /// Statistics of the integrator: sub-steps and events.
    pub statistics: StepStatistics,
    /// Rotors outside the validity of their theory.
    pub outside: Vec<ValidityViolation>,
    /// True if there were instants at which several sets of contact forces keep all laws and give other motions.
    pub is_ambiguous: bool,
    /// Warnings about the accuracy of the numbers.
    pub warnings: Vec<String>,
    /// Messages of scripts and controllers, in the order of time.
    pub messages: Vec<Message>,
    /// Changes of the model by clients and scripts.
    pub changes: Vec<Change>,
    /// Pictures that scripts have saved, and texts that they have written.
    pub images: Vec<SavedImage>,
    /// Number of the table's last columns that come from data streams of controllers.
    pub n_streams: usize,
    /// Wall time `[s]`, recording included.
    pub wall_time: f64,
    /// Part of it in which the equations were compiled `[s]`; `None` if they were evaluated by the recursions, as they
    /// always are without the feature `jit`.
    pub compile_time: Option<f64>,
}

/// Monitor of a run: takes interruptions, receives progress.
///
/// ```
/// use std::sync::atomic::AtomicBool;
///
/// use sincro_sim::prelude::*;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/acrobot");
/// let loaded = load(folder.as_ref(), &[], Extensions::default())?;
/// let interrupt = AtomicBool::new(true); // the user has pressed Ctrl-C
/// let mut monitor = RunMonitor { interrupt: &interrupt, progress: &mut |share| assert!(share <= 1.0) };
/// let run = simulate(&loaded, RunOptions::default(), &mut monitor)?;
/// assert!(matches!(run.status, Status::Interrupted { tick: 1, .. }));
/// # Ok(())
/// # }
/// ```
pub struct RunMonitor<'a> {
    /// Flag to end the run after the present tick, set from outside.
    pub interrupt: &'a AtomicBool,
    /// Callback that receives the share of the run that is done, 0 to 1, from time to time.
    pub progress: &'a mut dyn FnMut(f64),
}

/// Options of a run; the default records in memory only.
///
/// ```
/// use sincro_sim::prelude::*;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/acrobot");
/// let loaded = load(folder.as_ref(), &[], Extensions::default())?;
/// let mut monitor = RunMonitor { interrupt: &false.into(), progress: &mut |_| {} };
/// let coarse = simulate(&loaded, RunOptions::default(), &mut monitor)?;
/// // with half of the step: what an error bar compares with
/// let finer = simulate(&loaded, RunOptions { refined: true, ..RunOptions::default() }, &mut monitor)?;
/// let angle = |run: &Simulated| *run.table.column("/shoulder.position").unwrap().values.last().unwrap();
/// assert!(angle(&coarse) != angle(&finer) && (angle(&coarse) - angle(&finer)).abs() < 1e-4); // [rad]
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct RunOptions<'a> {
    /// Path of a CSV file to which rows are written as they come; `None`: no file.
    pub csv: Option<&'a Path>,
    /// True for the finer run of an error estimate: smaller steps, or a tighter tolerance that work and dissipation are
    /// kept to as well, relative to the largest energy so far.
    pub refined: bool,
    /// True for a run that goes on with another set of contact forces wherever several keep all laws, for the error
    /// bars.
    pub takes_other_solutions: bool,
    /// True if frames for the replay are recorded.
    pub keyframes: bool,
    /// Name of the variant whose checks for divergence end the run; `None`: those of the main run.
    pub variant: Option<&'a str>,
}

/// Error before the first step of a run, or in writing its results.
///
/// ```
/// use sincro_sim::prelude::*;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/acrobot");
/// let loaded = load(folder.as_ref(), &[], Extensions::default())?;
/// let mut monitor = RunMonitor { interrupt: &false.into(), progress: &mut |_| {} };
/// let nowhere = RunOptions { csv: Some("no-such-folder/signals.csv".as_ref()), ..RunOptions::default() };
/// let error = simulate(&loaded, nowhere, &mut monitor).unwrap_err();
/// assert!(matches!(&error, RunError::File(_)) && error.to_string().contains("no-such-folder"));
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub enum RunError {
    /// Findings about the experiment, such as recorded signals that do not exist.
    Diagnostics(Diagnostics),
    /// A file of the results cannot be written.
    File(FileError),
}

impl From<Diagnostics> for RunError {
    fn from(diagnostics: Diagnostics) -> Self {
        Self::Diagnostics(diagnostics)
    }
}

impl From<FileError> for RunError {
    fn from(error: FileError) -> Self {
        Self::File(error)
    }
}

/// Chooses the integration method for the integrator of an experiment, `auto` resolved by the stiffness of the scene,
/// and returns it with warnings about accuracy and stability.
#[must_use]
pub fn choose_method(scene: &Scene, experiment: &Experiment) -> (MethodKind, Vec<String>) {
    let fastest = stiffest(&scene.model, &scene.initial);
    let product = fastest.map_or(0.0, |s| s.rate * experiment.step);
    let kind = match experiment.integrator {
        Integrator::SemiImplicitEuler => MethodKind::SemiImplicitEuler,
        Integrator::Rk4 => MethodKind::Rk4,
        Integrator::Implicit => MethodKind::Implicit,
        Integrator::DormandPrince => MethodKind::DormandPrince,
        Integrator::DormandPrince8 => MethodKind::DormandPrince8,
        Integrator::Stiff => MethodKind::Stiff,
        Integrator::Auto if product > STIFF_FROM || has_fast_lag(scene, experiment) => MethodKind::Stiff,
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
        if let Some(limit) = explicit_limit(kind)
            && product > SLOW_FROM
        {
            warnings.push(format!(
                "{} makes `{}` take about {:.0} sub-steps a step. Use integrator = \"auto\" or \"stiff\"",
                describe(scene, &s),
                method_word(kind),
                product / limit
            ));
        }
    }
    warnings.extend(warn_of_lag(scene, experiment, kind));
    (kind, warnings)
}

/// The rotor or activation that follows its command fastest with a lag, in words, and how fast [1/s].
fn fastest_lag(scene: &Scene) -> Option<(String, f64)> {
    let (model, names) = (&scene.model, scene.model.names());
    let rotors = model.rotors().iter().zip(&names.rotors).filter_map(|(rotor, name)| match rotor.speed {
        SpeedSource::Lag { time_constant, .. } => Some((format!("the lag of rotor `{name}`"), 1.0 / time_constant)),
        _ => None,
    });
    let activations = model.activations().iter().filter_map(|own| {
        let line = || model.spring_dampers().iter().position(|s| s.actuator.is_some_and(|a| a.command == own.command));
        let name = match model.motors().get(own.command) {
            Some(motor) => names.dof_name(motor.dof),
            None => &names.spring_dampers[line()?],
        };
        Some((format!("the activation of the actuator of `{name}`"), 1.0 / own.time_constant()?))
    });
    rotors.chain(activations).max_by(|a, b| a.1.total_cmp(&b.1))
}

/// Returns true if a rotor or activation follows its command so fast that an explicit method with error control would
/// be slow.
fn has_fast_lag(scene: &Scene, experiment: &Experiment) -> bool {
    fastest_lag(scene).is_some_and(|(_, rate)| rate * experiment.step > SLOW_FROM)
}

/// Block of the diagram that decays so fast that an explicit method with error control would be slow, and its rate
/// [1/s].
fn fast_block(loaded: &Loaded) -> Option<(String, f64)> {
    let controller = loaded.controller.as_ref().filter(|c| c.wiring.program().is_continuous())?;
    controller.fastest_decay().filter(|(_, rate)| rate * loaded.experiment.step > SLOW_FROM)
}

/// Returns true if the diagram has blocks that run code of others, of FMUs.
pub(crate) fn has_foreign_blocks(loaded: &Loaded) -> bool {
    let is_foreign =
        |c: &ControlDiagram| c.wiring.program().steps.iter().any(|step| step.template.zero_crossing_count().is_some());
    loaded.controller.as_ref().is_some_and(is_foreign)
}

/// Returns true if something else than springs and dampers asks for the stiff method.
fn is_stiff_otherwise(loaded: &Loaded) -> bool {
    has_fast_lag(&loaded.scene, &loaded.experiment) || fast_block(loaded).is_some()
}

/// Step times decay rate up to which an explicit method with error control is stable; `None` for others.
fn explicit_limit(kind: MethodKind) -> Option<f64> {
    match kind {
        MethodKind::DormandPrince => Some(3.3),
        MethodKind::DormandPrince8 => Some(6.4),
        _ => None,
    }
}

/// Warnings about the lag of rotors and activations under an explicit method.
fn warn_of_lag(scene: &Scene, experiment: &Experiment, kind: MethodKind) -> Option<String> {
    let (lag, rate) = fastest_lag(scene)?;
    let product = rate * experiment.step;
    if kind == MethodKind::Rk4 && product > RK4_LIMIT {
        return Some(format!(
            "{lag} ({:.3e} s) is too short for `rk4` at a step of {} s, which is stable up to {:.2e} s: the run will \
             diverge. Use integrator = \"implicit\" (same step) or \"auto\"",
            1.0 / rate,
            experiment.step,
            RK4_LIMIT / rate
        ));
    }
    let limit = explicit_limit(kind).filter(|_| product > SLOW_FROM)?;
    Some(format!(
        "{lag} ({:.3e} s) makes `{}` take about {:.0} sub-steps a step. Use integrator = \"auto\" or \"stiff\"",
        1.0 / rate,
        method_word(kind),
        product / limit
    ))
}

/// As [`choose_method`], with the diagram's continuous blocks taken into account: by their own decay rates, and by the
/// fastest pole of the loop that they close ([`Extensions::fastest_poles`](crate::load::Extensions::fastest_poles)).
///
/// ```
/// use sincro_dynamics::world::MethodKind;
/// use sincro_sim::prelude::*;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/acrobot");
/// let loaded = load(folder.as_ref(), &[], Extensions::default())?; // integrator = "rk4"
/// let (method, warnings) = method_for(&loaded);
/// assert!(method == MethodKind::Rk4 && warnings.is_empty());
/// // a spring that is too stiff for an explicit method at a step of 50 ms
/// let stiff = loaded.with_overrides(&[Override::new("/shoulder.spring", "{ stiffness = 1e6 }")])?;
/// assert_eq!(method_for(&stiff).1.len(), 1);
/// # Ok(())
/// # }
/// ```
#[must_use]
pub fn method_for(loaded: &Loaded) -> (MethodKind, Vec<String>) {
    let (kind, mut warnings) = choose_method(&loaded.scene, &loaded.experiment);
    if !loaded.controller.as_ref().is_some_and(|c| c.wiring.program().is_continuous()) {
        return (kind, warnings);
    }
    let step = loaded.experiment.step;
    if let Some((block, rate)) = fast_block(loaded)
        && let Some(limit) = explicit_limit(kind)
    {
        if loaded.experiment.integrator == Integrator::Auto {
            return (MethodKind::Stiff, warnings);
        }
        let (word, sub_steps) = (method_word(kind), rate * step / limit);
        warnings.push(format!(
            "block `{block}` decays at {rate:.3e} 1/s and makes `{word}` take about {sub_steps:.0} sub-steps a step. Use \
             integrator = \"auto\" or \"stiff\""
        ));
    }
    // fixed steps take what blocks do to the world at the old state, whatever else they take at the new one
    let limit = match kind {
        MethodKind::Rk4 => RK4_LIMIT,
        MethodKind::SemiImplicitEuler | MethodKind::Implicit => EULER_LIMIT,
        MethodKind::DormandPrince | MethodKind::DormandPrince8 | MethodKind::Stiff => return (kind, warnings),
    };
    // poles would run the code of FMUs, which a scene that is only looked at must not
    if has_foreign_blocks(loaded) {
        return (kind, warnings);
    }
    if let Some((closed, open)) = loaded.extensions.fastest_poles.and_then(|fastest| fastest(loaded, kind))
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

/// A fast element in words.
fn describe(scene: &Scene, s: &Stiffness) -> String {
    format!(
        "{} (stiffness {:.3e}, damping {:.3e} on an inertia of {:.3e}: {:.3e} 1/s)",
        s.element_name(&scene.model),
        s.stiffness,
        s.damping,
        s.inertia,
        s.rate
    )
}

/// Returns the name of a method as the experiment file has it, such as `rk4`.
#[must_use]
pub fn method_word(kind: MethodKind) -> &'static str {
    match kind {
        MethodKind::SemiImplicitEuler => "semi-implicit-euler",
        MethodKind::Rk4 => "rk4",
        MethodKind::Implicit => "implicit",
        MethodKind::DormandPrince => "dormand-prince",
        MethodKind::DormandPrince8 => "dormand-prince-8",
        MethodKind::Stiff => "stiff",
    }
}

/// Creates the world of a scene, ready for its first tick, with the integration method `kind` and without the scene's
/// diagram; `refined` for the finer steps of the error bars.
#[must_use]
pub fn world_of(scene: &Scene, experiment: &Experiment, kind: MethodKind, refined: bool) -> World {
    let mut world = world_with_room(scene, experiment, kind, refined, 0);
    world.initialize(0.0);
    world
}

/// A world with room for `n_states` continuous states of a diagram, its drives not settled yet.
fn world_with_room(scene: &Scene, experiment: &Experiment, kind: MethodKind, refined: bool, n_states: usize) -> World {
    let accuracy = if refined { finer_accuracy(experiment.accuracy) } else { experiment.accuracy };
    let first_step = (experiment.step * 0.1).min(1e-3);
    let (model, control) = ((*scene.model).clone(), Control::new(accuracy, first_step));
    let mut world = World::with_coupled_states(model, scene.initial.clone(), kind, control, true, n_states);
    world.set_substeps(if refined { 2 } else { 1 });
    world.announce_step(experiment.step);
    world
}

/// Tolerance of the finer run of an error estimate.
pub(crate) fn finer_accuracy(accuracy: f64) -> f64 {
    (accuracy / FINER).max(FINEST)
}

/// Runs an experiment once, without its variants, sweep and checks.
///
/// # Errors
///
/// [`RunError::Diagnostics`]: a recorded signal does not exist. [`RunError::File`]: the CSV file cannot be written. A
/// run that stops is not an error: see [`Simulated::status`].
///
/// ```
/// use sincro_sim::prelude::*;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/acrobot");
/// let loaded = load(folder.as_ref(), &[Override::new("duration", "2.0")], Extensions::default())?;
/// let mut monitor = RunMonitor { interrupt: &false.into(), progress: &mut |_| {} };
/// let run = simulate(&loaded, RunOptions::default(), &mut monitor)?;
/// assert_eq!(run.table.n_rows(), 41); // 2 s at 50 ms, the start included
/// // the same scene gives the same bits
/// assert_eq!(simulate(&loaded, RunOptions::default(), &mut monitor)?.trace, run.trace);
/// # Ok(())
/// # }
/// ```
pub fn simulate(loaded: &Loaded, options: RunOptions<'_>, monitor: &mut RunMonitor<'_>) -> Result<Simulated, RunError> {
    let experiment = &loaded.experiment;
    let (method, warnings) = method_for(loaded);
    let mut lockstep = LockStep::new(loaded, method, options.refined);
    lockstep.world().take_other_solutions(options.takes_other_solutions);
    let mut recording = Recording::new(loaded, &mut lockstep, options)?;
    let mut status = Status::Completed;
    let first = lockstep.start();
    let end = recording.start(&mut lockstep)?;
    if let Err(halt) = first {
        status = halt.explain(&mut lockstep, experiment);
    } else if let Some(reason) = end {
        status = Status::Ended { tick: 0, time: 0.0, reason };
    }
    for tick in 0..experiment.n_steps {
        if status != Status::Completed {
            break;
        }
        if options.refined {
            lockstep.world().control_energies(recording.energy_scale());
        }
        let advanced = lockstep.advance();
        if advanced.as_ref().is_err_and(|halt| !halt.is_after_step()) {
            status = advanced.map_or_else(|halt| halt.explain(&mut lockstep, experiment), |()| status);
            break;
        }
        let end = recording.tick(&mut lockstep, advanced.is_err())?;
        if let Err(halt) = advanced {
            status = halt.explain(&mut lockstep, experiment);
            break;
        }
        if let Some(reason) = end {
            status = Status::Ended { tick: tick + 1, time: lockstep.t(), reason };
            break;
        }
        if lockstep.take_stop_request() {
            status = stopped_by_script(&lockstep);
            break;
        }
        if monitor.interrupt.load(Ordering::Relaxed) {
            status = Status::Interrupted { tick: tick + 1, time: lockstep.t() };
            break;
        }
        if tick % 256 == 0 {
            (monitor.progress)(tick as f64 / experiment.n_steps as f64);
        }
    }
    if let Err(halt) = lockstep.end()
        && status == Status::Completed
    {
        status = halt.explain(&mut lockstep, experiment);
    }
    Ok(recording.finish(&mut lockstep, status, method, warnings)?)
}

/// A script has called `sim.stopSimulation`.
fn stopped_by_script(lockstep: &LockStep) -> Status {
    let (tick, time) = (lockstep.tick(), lockstep.t());
    let reason = format!("a script stopped the simulation after tick {tick} at t = {time:.6} s");
    Status::Stopped { tick, time, reason, help: format!("if that is the end that is meant, set duration = {time}") }
}
