//! Error bars: the same run once more, finer; the difference of the recorded signals estimates the error of the coarser
//! one.
//!
//! This is the error of what the user sees, with everything that piles up over the run, and not the local error that a
//! method estimates of itself. The bar of an energy is never below the largest energy balance, which is an error of the
//! run whatever a finer one says; that of a position or velocity of a mechanism with constraints never below the
//! tolerance to which it is projected onto them. Where several sets of contact forces keep all laws, one more run
//! follows others, and bars cover it. Where the finer run cannot halve the step of scripts, which is part of
//! the error, there are no bars.
//!
//! Both runs are made at the same time where two processors are free; one after the other where code of others takes
//! part, which may have a memory that both would share, or write files: scripts, FMUs, controllers of a program.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;

use sincro_dynamics::mechanism::PROJECTION_TOLERANCE;
use sincro_dynamics::world::MethodKind;

use crate::load::Loaded;
use crate::results::{ColumnReport, Status};
use crate::run::{RunError, RunMonitor, RunOptions, Simulated, finer_accuracy, has_foreign_blocks, simulate};
use crate::workers::{POLL_INTERVAL, Processors, STACK_BYTES};
use sincro_scene::experiment::ErrorBar;

/// A run and the finer run of its error bars: none if the experiment wants no bars, the run does not come to its end,
/// or the finer one cannot halve the step of scripts.
pub(super) fn with_finer_run(
    loaded: &Loaded,
    options: RunOptions<'_>,
    monitor: &mut RunMonitor<'_>,
    processors: &Processors,
) -> Result<(Simulated, Option<Simulated>), RunError> {
    let run = |monitor: &mut RunMonitor<'_>| processors.work(|| simulate(loaded, options, monitor));
    let finer = |monitor: &mut RunMonitor<'_>| processors.work(|| finer_run(loaded, monitor));
    if loaded.experiment.error_bar == ErrorBar::None {
        return Ok((run(monitor)?, None));
    }
    if !loaded.controllers.is_empty() || !loaded.scene.scripts.is_empty() || has_foreign_blocks(loaded) {
        let run = run(monitor)?;
        let finer = if run.status == Status::Completed { finer(monitor)? } else { None };
        return Ok((run, finer));
    }
    let (user, is_cancelled, caller) = (monitor.interrupt, AtomicBool::new(false), thread::current());
    let is_made = AtomicBool::new(false);
    let finer = || {
        let finer = finer(&mut RunMonitor { interrupt: &is_cancelled, progress: &mut |_| {} });
        // said before the caller looks: a thread is not yet finished when it wakes another
        is_made.store(true, Ordering::Release);
        caller.unpark();
        finer
    };
    let (run, finer) = thread::scope(|scope| {
        // the finer run asks for a processor once the run has one: who waits for both sees an interrupt in the run
        let (run, finer) = processors.work(|| {
            let finer = thread::Builder::new().stack_size(STACK_BYTES).spawn_scoped(scope, finer);
            (simulate(loaded, options, monitor), finer.expect("a thread can be made"))
        });
        let is_whole = run.as_ref().is_ok_and(|run| run.status == Status::Completed);
        while !(is_made.load(Ordering::Acquire) || finer.is_finished()) {
            is_cancelled.fetch_or(!is_whole || user.load(Ordering::Relaxed), Ordering::Relaxed);
            thread::park_timeout(POLL_INTERVAL);
        }
        (run, finer.join().unwrap_or_else(|panic| resume_unwind(panic)))
    });
    let run = run?;
    Ok(if run.status == Status::Completed { (run, finer?) } else { (run, None) })
}

/// The recorded columns of a run that came to its end, with their error bars by the `finer` run.
pub(super) fn columns(
    loaded: &Loaded,
    run: &Simulated,
    finer: Option<&Simulated>,
    (monitor, processors): (&mut RunMonitor<'_>, &Processors),
) -> Result<Vec<ColumnReport>, RunError> {
    let mut columns = ColumnReport::of_table(&run.table);
    if loaded.experiment.error_bar == ErrorBar::None {
        return Ok(columns);
    }
    columns[0].error_bar_method = "exact: tick times step".into();
    let Some(finer) = finer else {
        let reason = "not estimated: scripts act once a step, which a finer run cannot halve; with an even number of base \
                      steps as `simulation_step` it can";
        without_bars(&mut columns, reason);
        return Ok(columns);
    };
    if let Some(reason) = why_unfinished(&finer.status) {
        without_bars(&mut columns, &format!("not estimated: the finer run stopped: {reason}"));
        return Ok(columns);
    }
    let (factor, mut method) = estimate(run.method, loaded.experiment.accuracy);
    if !loaded.scene.scripts.is_empty() {
        method += "; step of scripts halved";
    }
    let other = if run.is_ambiguous { Some(processors.work(|| other_run(loaded, monitor))?) } else { None };
    if let Some(reason) = other.as_ref().and_then(|other| why_unfinished(&other.status)) {
        without_bars(&mut columns, &format!("not estimated: the run with other contact forces stopped: {reason}"));
        return Ok(columns);
    }
    let is_constrained = !loaded.scene.model.constraints().is_empty();
    // the first column is time, which is exact
    for (k, column) in columns.iter_mut().enumerate().skip(1) {
        // a script may have made another stream in the finer run
        let Some(fine) = finer.table.column(&column.path).map(|c| &c.values) else { continue };
        let bar = factor * largest_difference(&run.table.columns[k].values, fine);
        let (least, of_least) = least_bar((column, k), (run, other.as_ref()), is_constrained);
        column.error_bar = Some(bar.max(least));
        column.error_bar_method =
            if least > bar { format!("{of_least}; by a finer run {bar:.1e}: {method}") } else { method.clone() };
    }
    Ok(columns)
}

/// Least error bar of column `k` whatever a finer run says, and its source; `other` is the run with other contact
/// forces, if there was one.
fn least_bar(
    (column, k): (&ColumnReport, usize),
    (run, other): (&Simulated, Option<&Simulated>),
    is_constrained: bool,
) -> (f64, &'static str) {
    let least = least_of_run(column, run, is_constrained);
    let Some(other) = other.and_then(|other| other.table.column(&column.path)) else { return least };
    let apart = largest_difference(&run.table.columns[k].values, &other.values);
    if apart > least.0 { (apart, "largest difference from a run with other contact forces") } else { least }
}

/// Least error bar of a column by the run alone, and its source.
fn least_of_run(column: &ColumnReport, run: &Simulated, is_constrained: bool) -> (f64, &'static str) {
    if column.path.starts_with("energy.") {
        return (run.energy.residual, "largest energy balance");
    }
    if is_constrained && matches!(&*column.unit, "m" | "rad" | "m/s" | "rad/s") {
        return (PROJECTION_TOLERANCE, "tolerance of projections onto constraints");
    }
    (0.0, "")
}

/// The finer run; none if it cannot halve the step of scripts.
fn finer_run(loaded: &Loaded, monitor: &mut RunMonitor<'_>) -> Result<Option<Simulated>, RunError> {
    let options = RunOptions { refined: true, ..RunOptions::default() };
    if loaded.scene.scripts.is_empty() {
        return simulate(loaded, options, monitor).map(Some);
    }
    let ticks = loaded.experiment.simulation_ticks;
    if !ticks.is_multiple_of(2) {
        return Ok(None);
    }
    let mut halved = loaded.clone();
    halved.experiment.simulation_ticks = ticks / 2;
    simulate(&halved, options, monitor).map(Some)
}

/// The run with other sets of contact forces where several keep all laws.
fn other_run(loaded: &Loaded, monitor: &mut RunMonitor<'_>) -> Result<Simulated, RunError> {
    simulate(loaded, RunOptions { takes_other_solutions: true, ..RunOptions::default() }, monitor)
}

/// Reason why a run did not come to its end; none if it did.
fn why_unfinished(status: &Status) -> Option<&str> {
    match status {
        _ if status.is_good() => None,
        Status::Stopped { reason, .. } => Some(reason),
        _ => Some("it was interrupted"),
    }
}

fn without_bars(columns: &mut [ColumnReport], reason: &str) {
    columns.iter_mut().skip(1).for_each(|column| column.error_bar_method = reason.to_owned());
}

fn largest_difference(coarse: &[f64], fine: &[f64]) -> f64 {
    coarse.iter().zip(fine).fold(0.0_f64, |worst, (a, b)| {
        // where both have no value, such as a signal that no script has set yet, they agree
        let difference = if a.is_nan() && b.is_nan() { 0.0 } else { (a - b).abs() };
        if difference.is_nan() { f64::INFINITY } else { worst.max(difference) }
    })
}

/// Factor on the difference from a finer run that estimates the error of a run by this method.
pub(super) fn error_bar_factor(method: MethodKind, accuracy: f64) -> f64 {
    estimate(method, accuracy).0
}

/// Factor on the difference, and the estimate in words.
fn estimate(method: MethodKind, accuracy: f64) -> (f64, String) {
    let order = match method {
        MethodKind::SemiImplicitEuler => 1,
        MethodKind::Implicit => 2,
        MethodKind::Rk4 => 4,
        MethodKind::DormandPrince | MethodKind::DormandPrince8 | MethodKind::Stiff => {
            let finer = accuracy / finer_accuracy(accuracy);
            let words = format!("tolerance tightened {finer:.0}-fold: largest difference from that run");
            return (finer / (finer - 1.0), words);
        }
    };
    let power = f64::from(1 << order);
    let factor = power / (power - 1.0);
    (factor, format!("step halved: largest difference from that run times {factor:.3} (order {order})"))
}
