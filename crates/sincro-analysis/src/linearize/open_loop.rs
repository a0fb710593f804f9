//! Loops of a sampled controller, opened at a signal: the linear system around the loop, and its margins.
//!
//! At the ticks at which its block is due, the signal is replaced by its value in the closed loop plus an input of its
//! own, held until the next; what the block gives is the output. One period has m such ticks, so the open loop over a
//! period (lifted, key `chen1995`, chapter 8) has m inputs and m outputs. All other loops stay closed. Derivatives are
//! central differences of the run, as those of the closed loop in [`super::sampled`].

use sincro_blocks::program::{Program, Rate};
use sincro_blocks::runner::LoopOpening;
use sincro_scene::diagnostic::{Diagnostic, Diagnostics, Located};
use sincro_scene::diagram::ControlDiagram;
use sincro_scene::record::{Entry, Probe, catalogue};
use sincro_scene::suggest;
use sincro_sim::load::Loaded;
use sincro_sim::run::LockStep;
use sincro_sim::snapshot::Snapshot;

use super::sampled::{CHANGE, Moment, PeriodMap, period};
use crate::linear::{Axis, DMatrix, DVector, LoopMargins, StateSpace};

/// Samples of the opened signal in a period that are still lifted.
const MAX_SAMPLES: u64 = 100;

/// Sampled loop, opened at one signal of the diagram, with its margins; result of [`open_loops`].
#[derive(Clone, Debug, PartialEq)]
pub struct OpenLoop {
    /// Name and unit of the signal.
    pub signal: Axis,
    /// Sample time of the signal `[s]`.
    pub sample_time: f64,
    /// Open loop L, which is closed by −1: inputs are the samples of the signal in one period as the loop sees them,
    /// outputs the same samples as the loop gives them, with the sign changed. Its sample time is the period.
    pub system: StateSpace,
    /// Frequency response of the loop, its gain, phase and modulus margins.
    pub margins: LoopMargins,
}

impl OpenLoop {
    /// Number of samples of the signal in a period of all sample times. If it is not 1, the loop may have several
    /// sample times.
    #[must_use]
    pub fn n_samples(&self) -> usize {
        self.system.n_inputs()
    }
}

/// Opens the sampled loops through each of the named signals in turn, at the state that a run is in, and returns them
/// in this order. A signal is one that a block of the diagram gives at ticks, or the motor command that it gives.
///
/// # Errors
///
/// One diagnostic for each name that is no such signal; or one that the sample times have no common multiple of 100 000
/// base steps or less, that the signal has more than 100 samples in it, or that the run stops within the period.
pub fn open_loops(loaded: &Loaded, at: &LockStep, names: &[Located<String>]) -> Result<Vec<OpenLoop>, Diagnostics> {
    let mut diagnostics = Diagnostics::new();
    let mut openings = Vec::new();
    for name in names {
        match resolve(loaded, at, name) {
            Ok(opening) => openings.push(opening),
            Err(diagnostic) => diagnostics.push(diagnostic),
        }
    }
    if diagnostics.any_error() {
        return Err(diagnostics);
    }
    let period = period(loaded, at)?;
    let mut found = Vec::new();
    for opening in openings {
        if period / opening.every > MAX_SAMPLES {
            let message = format!(
                "`{}` has {} samples in a period of all sample times",
                opening.signal.name,
                period / opening.every
            );
            let help = format!("open the loop at a slower signal: at most {MAX_SAMPLES} samples are lifted");
            return Err(Diagnostic::without_location(message).with_help(help).into());
        }
        found.push(open_loop(loaded, at, period, opening)?);
    }
    Ok(found)
}

/// Names of the signals at which a loop of the diagram can be opened: those that a block gives at ticks, without
/// constants.
#[must_use]
pub fn openable_signals(loaded: &Loaded, at: &LockStep) -> Vec<String> {
    let Some(control) = at.control() else { return Vec::new() };
    let program = control.wiring().program();
    let is_open = |entry: &Entry| matches!(entry.probe, Probe::Signal(k) if every(program, k).is_some());
    let of_diagram = loaded.controller.as_ref().map(ControlDiagram::entries).unwrap_or_default();
    of_diagram.into_iter().filter(is_open).map(|entry| entry.name).collect()
}

/// A signal at which a loop is opened.
struct Opening {
    signal: Axis,
    index: usize,
    /// Base steps between its samples.
    every: u64,
}

/// Base steps between the samples of a signal; `None` if it is constant, a measurement, or changes between ticks.
fn every(program: &Program, signal: usize) -> Option<u64> {
    let step = program.steps.iter().find(|step| step.out.contains(&signal))?;
    match step.rate {
        Rate::Sampled(every) => Some(every),
        // without effect between ticks
        Rate::Continuous if !step.is_minor => Some(1),
        Rate::Continuous | Rate::Constant => None,
    }
}

fn resolve(loaded: &Loaded, at: &LockStep, name: &Located<String>) -> Result<Opening, Diagnostic> {
    let Some(control) = at.control() else {
        let message = format!("there is no loop to open at `{}`: the scene has no diagram", name.value);
        return Err(Diagnostic::error(&name.at, message));
    };
    let program = control.wiring().program();
    let of_diagram = loaded.controller.as_ref().map(ControlDiagram::entries).unwrap_or_default();
    let all: Vec<Entry> = catalogue(&loaded.scene.model).into_iter().chain(of_diagram).collect();
    let path = |e: &Entry| e.name.strip_suffix(".command").or_else(|| e.name.strip_suffix(".speed")).map(str::to_owned);
    let entry = all.iter().find(|e| e.name == name.value || path(e).as_ref() == Some(&name.value));
    let index = match entry.map(|entry| entry.probe) {
        Some(Probe::Signal(index)) => Some(index),
        Some(Probe::Command(motor)) => {
            program.commands.iter().find(|c| c.terminal == motor).map(|command| command.signal.start)
        }
        _ => None,
    };
    let openable = openable_signals(loaded, at);
    let known: Vec<&str> = openable.iter().map(String::as_str).collect();
    let help = suggest::help(&name.value, &known, "signals");
    let (Some(entry), Some(index)) = (entry, index) else {
        let message = match entry {
            Some(_) => format!("no block of the diagram gives `{}`", name.value),
            None => format!("there is no signal `{}`", name.value),
        };
        return Err(Diagnostic::error(&name.at, message).with_help(help));
    };
    let Some(every) = every(program, index) else {
        let message =
            format!("`{}` is not sampled: a loop is opened where a block gives its output at ticks", name.value);
        return Err(Diagnostic::error(&name.at, message).with_help(help));
    };
    Ok(Opening { signal: super::axis(&entry.name, &*entry.unit), index, every })
}

/// The run over a period with a loop opened.
struct OpenMap<'a> {
    map: PeriodMap<'a>,
    index: usize,
    every: u64,
    /// Samples of the signal in the closed loop.
    nominal: Vec<f64>,
}

impl OpenMap<'_> {
    /// The state after a period, and the samples that the loop gives, from a changed state and changed inputs.
    fn after(&mut self, change: &[f64], inputs: &[f64]) -> Result<(Snapshot, DVector<f64>), Diagnostic> {
        let (index, every, n) = (self.index, self.every, self.nominal.len());
        let (mut given, nominal) = (DVector::zeros(n), &self.nominal);
        let sample = |tick: u64| tick.is_multiple_of(every).then_some((tick / every) as usize).filter(|k| *k < n);
        let end = self.map.after_with(change, |moment, run| match moment {
            Moment::Before(tick) => {
                if let Some(k) = sample(tick) {
                    let value = nominal[k] + inputs[k];
                    run.set_opening(Some(LoopOpening { signal: index, value, own: f64::NAN }));
                }
            }
            Moment::After(tick) => {
                let opening = run.control().and_then(|control| control.runner.opening);
                if let (Some(k), Some(opening)) = (sample(tick), opening) {
                    given[k] = opening.own;
                }
            }
        });
        Ok((end?, given))
    }
}

fn open_loop(loaded: &Loaded, at: &LockStep, period: u64, opening: Opening) -> Result<OpenLoop, Diagnostic> {
    let mut map = PeriodMap::new(loaded, at, period)?;
    let (n, m) = (map.n_states(), (period / opening.every) as usize);
    let mut nominal = vec![0.0; m];
    map.after_with(&vec![0.0; n], |moment, run| {
        if let Moment::After(tick) = moment
            && tick.is_multiple_of(opening.every)
            && let (Some(value), Some(control)) = (nominal.get_mut((tick / opening.every) as usize), run.control())
        {
            *value = control.runner.signals()[opening.index];
        }
    })?;
    let mut open = OpenMap { map, index: opening.index, every: opening.every, nominal };
    let middle = open.after(&vec![0.0; n], &vec![0.0; m])?.0;
    let mut change = vec![0.0; n + m];
    let (mut by_state, mut by_input) = (DMatrix::zeros(n, n + m), DMatrix::zeros(m, n + m));
    for k in 0..n + m {
        let mut side = |by: f64| {
            change[k] = by;
            let found = open.after(&change[..n], &change[n..]);
            change[k] = 0.0;
            found
        };
        let (up, down) = (side(CHANGE)?, side(-CHANGE)?);
        by_state.set_column(k, &open.map.slope(&up.0, &down.0, &middle));
        by_input.set_column(k, &((up.1 - down.1) / (2.0 * CHANGE)));
    }
    let (a, c) = (by_state.columns(0, n).into_owned(), -by_input.columns(0, n));
    let kept = open.map.kept(&a, &c);
    let samples = |letter: &str| -> Vec<Axis> {
        let name = |k: usize| match m {
            1 => format!("{}{letter}", opening.signal.name),
            _ => format!("{}{letter}, sample {}", opening.signal.name, k + 1),
        };
        (0..m).map(|k| Axis::new(name(k), opening.signal.unit.clone())).collect()
    };
    let system = StateSpace {
        a: a.select_rows(&kept).select_columns(&kept),
        b: by_state.columns(n, m).select_rows(&kept),
        c: c.select_columns(&kept),
        d: -by_input.columns(n, m),
        states: kept.iter().map(|&k| open.map.axes()[k].clone()).collect(),
        inputs: samples(""),
        outputs: samples(" given, sign changed"),
        t: at.t(),
        sample_time: Some(period as f64 * at.step()),
    };
    let margins = system.loop_margins();
    Ok(OpenLoop { signal: opening.signal, sample_time: opening.every as f64 * at.step(), system, margins })
}
