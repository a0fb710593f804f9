//! `sincro check --mutate`: each number of a scene changed in turn, and which of the changes no check notices.
//!
//! A number is noticed if the scene is refused with it, a run stops, or a check fails that held before: first those of
//! the main run, then, only if they all hold, those of the sweep and the variants, until one fails. Error bars are not
//! made. Zeros cannot be changed by a factor; they are counted and left alone.

use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use sincro::{Loaded, Override};
use sincro_scene::numbers::{Quantity, Value, numbers};
use sincro_scene::open::settings_with;
use sincro_sim::campaign::run_campaign;
use sincro_sim::check::{Outcome, Verdict, evaluate};
use sincro_sim::run::{RunError, RunMonitor, RunOptions, Simulated, simulate};
use sincro_sim::table::Table;
use sincro_sim::workers::on_all_processors;

use super::console::{self, Bar};
use crate::{Exit, diagnostics};

/// Result of one run of all checks.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Answer {
    /// A check fails, or a run stops: which.
    Noticed(String),
    /// The scene is refused.
    Refused,
    /// All checks hold.
    Unnoticed,
}

/// Changes each number by the factor 1 + `share` in turn and prints those that no check notices.
pub(super) fn run(loaded: &Loaded, settings: &[Override], share: f64) -> Exit {
    if !(share.is_finite() && share != 0.0 && share > -1.0) {
        let message = format!("--mutate {share}: expected a share such as 1e-3, not zero and above -1");
        return diagnostics::refuse(&message, None);
    }
    let quantities = match numbers(&loaded.folder, settings) {
        Ok(quantities) => quantities,
        Err(found) => return diagnostics::refuse_diagnostics(&found),
    };
    let (zeros, quantities): (Vec<_>, Vec<_>) = quantities.into_iter().partition(|q| q.value == Value::Number(0.0));
    let judge = Judge { loaded, settings };
    match judge.answer(None) {
        Answer::Unnoticed => {}
        Answer::Noticed(which) => {
            let message = format!("the scene as it is fails already: {which}");
            return diagnostics::refuse(
                &message,
                Some("correct it first: a change could not be told from what is wrong"),
            );
        }
        Answer::Refused => return diagnostics::refuse("the scene is refused without error bars", None),
    }
    let answers = judge.all(&quantities, 1.0 + share);
    report(&quantities, &answers, zeros.len(), &loaded.folder.path().display().to_string())
}

/// Prints the findings; the last line is the count.
fn report(quantities: &[Quantity], answers: &[Answer], n_zeros: usize, folder: &str) -> Exit {
    let unnoticed: Vec<&Quantity> =
        quantities.iter().zip(answers).filter(|(_, answer)| **answer == Answer::Unnoticed).map(|(q, _)| q).collect();
    let width = unnoticed.iter().map(|q| q.path.chars().count()).max().unwrap_or(0);
    for quantity in &unnoticed {
        let value = match &quantity.value {
            Value::Number(x) => console::short(*x),
            Value::Formula(text) => format!("\"{text}\""),
        };
        let place = place(quantity, Path::new(folder));
        say!("unnoticed  {:<width$}  {value}  ({place})", quantity.path);
    }
    let n_refused = answers.iter().filter(|answer| **answer == Answer::Refused).count();
    if n_refused > 0 {
        say!("{} refused by the scene itself, which counts as noticed", diagnostics::count(n_refused, "change"));
    }
    if n_zeros > 0 {
        say!("{} left alone: a factor does not change them", diagnostics::count(n_zeros, "zero"));
    }
    say!("{} numbers, {} unnoticed", quantities.len(), unnoticed.len());
    if unnoticed.is_empty() { Exit::Holds } else { Exit::Fails }
}

/// File and line of a number, the file as seen from the scene's folder.
fn place(quantity: &Quantity, folder: &Path) -> String {
    let source = &quantity.at.source;
    let line = 1 + source.text.bytes().take(quantity.at.span.start).filter(|b| *b == b'\n').count();
    let file = source.path.strip_prefix(folder).unwrap_or(&source.path);
    format!("{}:{line}", file.display())
}

/// Inputs of all runs.
struct Judge<'a> {
    loaded: &'a Loaded,
    settings: &'a [Override],
}

impl Judge<'_> {
    /// The answers to all changes, on all processors, in the order of the numbers.
    fn all(&self, quantities: &[Quantity], factor: f64) -> Vec<Answer> {
        let n = quantities.len();
        let done = AtomicUsize::new(0);
        let bar = Bar::new("mutate");
        let job = |k: usize| {
            let answer = self.answer(Some(quantities[k].scaled(factor)));
            done.fetch_add(1, Ordering::Relaxed);
            answer
        };
        let mut meanwhile = || {
            let so_far = done.load(Ordering::Relaxed);
            bar.show(&format!("{so_far} of {n} numbers"), so_far as f64 / n as f64);
        };
        let answers = on_all_processors(n, &job, &mut meanwhile);
        bar.finish();
        answers
    }

    /// Runs all checks with a change.
    fn answer(&self, change: Option<Override>) -> Answer {
        let without_error_bars = Override::new("error_bar", "\"none\"");
        let set: Vec<Override> = self.settings.iter().cloned().chain([without_error_bars]).chain(change).collect();
        match self.first_failure(&set) {
            Ok(None) => Answer::Unnoticed,
            Ok(Some(which)) => Answer::Noticed(which),
            Err(()) => Answer::Refused,
        }
    }

    /// The first check that fails; an error if the scene is refused.
    fn first_failure(&self, set: &[Override]) -> Result<Option<String>, ()> {
        let main = self.loaded.with_overrides_without_variants(set).map_err(drop)?;
        let done = one(&main)?;
        let stopped = done.status.stopped_at();
        if let Some(which) = failed(&evaluate(&main.experiment.checks, &done.table, stopped), stopped, "") {
            return Ok(Some(which));
        }
        if let Some(which) = self.sweep(&main, set)? {
            return Ok(Some(which));
        }
        let mut before: Vec<(String, Table)> = vec![("main".to_owned(), done.table)];
        for variant in &main.experiment.variants {
            let settings = settings_with(set, &variant.set);
            let other = self.loaded.with_overrides_without_variants(&settings).map_err(drop)?;
            let done = one(&other)?;
            let stopped = done.status.stopped_at();
            let known: Vec<(&str, &Table)> = before.iter().map(|(name, table)| (name.as_str(), table)).collect();
            let table = done.table.with_columns_of(&known);
            let mut outcomes = evaluate(&variant.checks, &table, stopped);
            if variant.inherit_checks {
                outcomes.extend(evaluate(&main.experiment.checks, &table, stopped));
            }
            if let Some(which) = failed(&outcomes, stopped, &variant.name) {
                return Ok(Some(which));
            }
            before.push((variant.name.clone(), done.table));
        }
        Ok(None)
    }

    /// The first check of the sweep that fails, if there is a sweep.
    fn sweep(&self, main: &Loaded, set: &[Override]) -> Result<Option<String>, ()> {
        if main.experiment.sweep.is_none() {
            return Ok(None);
        }
        let mut alone = main.clone();
        alone.experiment.variants.clear();
        let quiet = AtomicBool::new(false);
        let folder = self.loaded.folder.path();
        let campaign = run_campaign(folder, set, &alone, None, &quiet, &mut |_, _| {}).map_err(drop)?;
        Ok(campaign.sweep.and_then(|(_, outcomes)| failed(&outcomes, None, "sweep")))
    }
}

/// One run in memory.
fn one(loaded: &Loaded) -> Result<Simulated, ()> {
    let quiet = AtomicBool::new(false);
    let mut monitor = RunMonitor { interrupt: &quiet, progress: &mut |_| {} };
    simulate(loaded, RunOptions::default(), &mut monitor).map_err(|_: RunError| ())
}

/// The first check that does not hold, or the end of the run before its time.
fn failed(outcomes: &[Outcome], stopped: Option<f64>, run: &str) -> Option<String> {
    let of = if run.is_empty() { String::new() } else { format!("{run}: ") };
    let fails = outcomes.iter().find(|outcome| outcome.verdict != Verdict::Holds);
    fails
        .map(|outcome| format!("{of}{}", outcome.name))
        .or_else(|| stopped.map(|time| format!("{of}stops after {} s", console::short(time))))
}
