//! Evaluation of checks: each [`Check`] of an experiment against the recorded rows.
//!
//! | which rows | |
//! |---|---|
//! | `at` | the row of that time |
//! | `window` | the rows from its first to its last time, ends included |
//! | reference | of those, the rows of the reference; each of its rows inside the run must fall on a recorded one |
//! | else | all |
//!
//! Times match within 1e-9 s. Nothing is interpolated: a reference that falls between the rows is not compared, and the
//! outcome says what step to use.
//!
//! The measure `error` compares row by row, and the largest deviation counts. Every other measure is one number of the
//! series, compared with one expected number. What is expected is then a number or a formula of parameters alone; a
//! reference, or a formula that varies from row to row, is measured in the same way over the same rows: peak against
//! peak, mean against mean.
//!
//! The deviation is |measured − expected|, with `at_most` and `at_least` how far the measured value lies beyond the
//! bound; with `relative`, divided by max(|expected|, floor), where zero of zero is zero. A check holds if the
//! deviation is finite and at most the tolerance. A NaN among the numbers that enter a comparison is its result, so a
//! check with a NaN never holds. What cannot be compared is not made, and says why: a run that stopped early has only
//! its checks of the time before.

mod along;
mod measure;
mod rows;
mod series;
mod words;

#[cfg(test)]
mod tests;

use crate::sweep::Sweep;
use crate::table::Table;
use along::Along;
use measure::{Measured, StepShape};
use rows::Rows;
use series::Source;
use sincro_scene::experiment::check::{Check, Expected, Measure, Sense};

/// Outcome of one check: the verdict and the numbers it rests on; result of [`evaluate`].
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// Name of the check.
    pub name: String,
    /// Verdict on the check.
    pub verdict: Verdict,
    /// Description of the comparison in English: `greatest value of /shoulder.position against 0.2`.
    pub about: String,
    /// Measured value, in `unit`; of the measure `error` that of the worst row. `None` if the check was not made.
    pub measured: Option<f64>,
    /// Expected value at the same place, in `unit`; `None` if the check was not made.
    pub expected: Option<f64>,
    /// Comparison: equal, at most or at least.
    pub sense: Sense,
    /// Deviation |measured − expected|, or the excess beyond a bound, in `unit`; divided by max(|expected|, floor) if
    /// `relative`. May be infinite or NaN, which never holds; `None` if the check was not made.
    pub deviation: Option<f64>,
    /// Largest deviation that holds, in the unit of `deviation`.
    pub limit: f64,
    /// True if deviation and limit are relative (dimensionless).
    pub relative: bool,
    /// Unit of measured and expected value; empty where it is not known, as for formulas.
    pub unit: String,
    /// Time `[s]` of the row of the measured value (in a sweep: value of the parameter); `None` if it is not that of
    /// one row.
    pub at: Option<f64>,
    /// Number of rows that were evaluated.
    pub n_rows: usize,
    /// Recorded signal that was measured; `None` for formulas.
    pub signal: Option<String>,
    /// Expected values row by row, as far as the run came, of the measure `error` against a reference or formula; else
    /// `None`.
    pub series: Option<Series>,
}

/// Verdict on a check.
///
/// ```
/// use sincro_sim::check::evaluate;
/// use sincro_sim::prelude::*;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/acrobot");
/// let loaded = load(folder.as_ref(), &[], Extensions::default())?;
/// // the check of the scene wants `energy.balance` to be zero within 1e-5 J
/// let verdict = |joules: f64| {
///     let mut table = Table::new([("t", "s"), ("energy.balance", "J")], 1);
///     table.push_row(&[0.0, joules]);
///     evaluate(&loaded.experiment.checks, &table, None)[0].verdict.clone()
/// };
/// assert_eq!((verdict(1e-6), verdict(1e-3)), (Verdict::Holds, Verdict::Fails));
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The deviation is finite and within its limit.
    Holds,
    /// The deviation is beyond its limit or not finite.
    Fails,
    /// The check could not be made, for this reason (in English), such as a run that stopped before the time that is
    /// looked at.
    NotMade(String),
}

/// Expected values of a check over time, or over the parameter of a sweep, to be drawn beside the measured ones.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    /// Times `[s]`, or values of the parameter, ascending.
    pub times: Vec<f64>,
    /// Expected value at each of `times`, in the unit of the signal.
    pub values: Vec<f64>,
}

/// Evaluates the checks of one run on its recorded signals `table` and returns one outcome for each, in their order.
/// `stopped` is the time `[s]` at which the run ended before its duration; `None` if it came to its end.
#[must_use]
pub fn evaluate(checks: &[Check], table: &Table, stopped: Option<f64>) -> Vec<Outcome> {
    let along = Along::run(table, stopped);
    checks.iter().map(|check| judge(check, &along)).collect()
}

/// Judges the checks of a sweep, in their order. The parameter takes the place of time: in references, in `at` and
/// `window`, and in measures. Points match within a billionth of the smallest gap between them.
///
/// A reference may have more rows than the sweep has points, or fewer, but not both.
#[must_use]
pub(crate) fn evaluate_sweep(checks: &[Check], sweep: &Sweep) -> Vec<Outcome> {
    let runs = sweep.ascending();
    let table = sweep.table(&runs);
    let along = Along::sweep(&table, runs.iter().map(|run_idx| sweep.stop(*run_idx)).collect());
    checks.iter().map(|check| judge(check, &along)).collect()
}

/// Two numbers, how far they are apart, and where.
struct Comparison {
    measured: f64,
    expected: f64,
    deviation: f64,
    at: Option<f64>,
    n_rows: usize,
}

fn judge(check: &Check, along: &Along) -> Outcome {
    let (verdict, comparison) = match compare(check, along) {
        Ok(comparison) => (verdict(check, comparison.deviation), Some(comparison)),
        Err(reason) => (Verdict::NotMade(reason), None),
    };
    Outcome {
        name: check.name.clone(),
        verdict,
        about: words::about(check, along),
        measured: comparison.as_ref().map(|c| c.measured),
        expected: comparison.as_ref().map(|c| c.expected),
        sense: check.sense,
        deviation: comparison.as_ref().map(|c| c.deviation),
        limit: check.tolerance,
        relative: check.relative,
        unit: words::unit(check, along),
        at: comparison.as_ref().and_then(|c| c.at),
        n_rows: comparison.as_ref().map_or(0, |c| c.n_rows),
        signal: series::plain_signal(check).map(str::to_owned),
        series: overlay(check, along),
    }
}

fn verdict(check: &Check, deviation: f64) -> Verdict {
    if deviation.is_finite() && deviation <= check.tolerance { Verdict::Holds } else { Verdict::Fails }
}

fn compare(check: &Check, along: &Along) -> Result<Comparison, String> {
    let source = Source::new(check, along)?;
    if check.measure == Measure::Divergence {
        return divergence(check, along, &source);
    }
    let rows = rows::select(check, along)?;
    let measured = source.measured(&rows.idxs)?;
    match check.measure {
        Measure::Error => {
            let expected = source.expected(&rows)?;
            Ok(compare_rows(check, along, &rows, &measured, &expected))
        }
        _ => compare_numbers(check, along, &source, &rows, &measured),
    }
}

/// The first row beyond the bound, from the start of the run on: that the run ended there is what is wanted. It must
/// lie in the window.
fn divergence(check: &Check, along: &Along, source: &Source) -> Result<Comparison, String> {
    let Expected::Value(bound) = check.expected else { return Err("the bound is not a number".into()) };
    let (from, to) = check.window.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
    let n_rows = along.first_after(to);
    let values = source.measured(&(0..n_rows).collect::<Vec<_>>())?;
    if values.is_empty() {
        return Err("nothing was recorded".into());
    }
    let shape = StepShape { target: Some(bound), band: check.band, has_step_means: false };
    let Measured { value, row } = measure::measure(Measure::Divergence, &shape, along.keys(), &values)?;
    let at = row.map(|row| along.keys()[row]);
    if value > bound
        && let Some(t) = at.filter(|t| *t < from - along.tolerance)
    {
        return Err(format!("it leaves the bound at {} already, before the window", along.place(t)));
    }
    // a bound that is met exactly has not been left
    let deviation = if value > bound { 0.0 } else { (bound - value).max(f64::MIN_POSITIVE) };
    Ok(Comparison { measured: value, expected: bound, deviation, at, n_rows })
}

/// The row that deviates most; the first of equals, and the first that is not a number before all others.
fn compare_rows(check: &Check, along: &Along, rows: &Rows, measured: &[f64], expected: &[f64]) -> Comparison {
    let excesses: Vec<f64> = measured.iter().zip(expected).map(|(m, e)| excess(check, *m, *e)).collect();
    let worst = measure::greatest(&excesses);
    Comparison {
        measured: measured[worst],
        expected: expected[worst],
        deviation: deviation(check, measured[worst], expected[worst]),
        at: Some(along.keys()[rows.idxs[worst]]),
        n_rows: rows.idxs.len(),
    }
}

fn compare_numbers(
    check: &Check,
    along: &Along,
    source: &Source,
    rows: &Rows,
    measured: &[f64],
) -> Result<Comparison, String> {
    let keys: Vec<f64> = rows.idxs.iter().map(|row_idx| along.keys()[*row_idx]).collect();
    let shape = StepShape { target: check.target, band: check.band, has_step_means: source.has_step_means() };
    let Measured { value: measured, row } = measure::measure(check.measure, &shape, &keys, measured)?;
    let expected = match source.expected_number(rows)? {
        Some(number) => number,
        None => measure::measure(check.measure, &shape, &keys, &source.expected(rows)?)?.value,
    };
    Ok(Comparison {
        measured,
        expected,
        deviation: deviation(check, measured, expected),
        at: row.map(|row| keys[row]),
        n_rows: keys.len(),
    })
}

/// Deviation of a value; for a bound with its sign, negative where it holds.
fn excess(check: &Check, measured: f64, expected: f64) -> f64 {
    let difference = match check.sense {
        Sense::Equal => (measured - expected).abs(),
        Sense::AtMost => measured - expected,
        Sense::AtLeast => expected - measured,
    };
    if !check.relative || difference == 0.0 || difference.is_nan() {
        return difference;
    }
    difference / expected.abs().max(check.floor)
}

/// Absolute or relative deviation; an infinite value is beyond every bound.
fn deviation(check: &Check, measured: f64, expected: f64) -> f64 {
    let excess = excess(check, measured, expected);
    match measured.is_infinite() {
        true => f64::INFINITY,
        false if excess < 0.0 => 0.0,
        false => excess,
    }
}

/// Expected series, row by row, if a plot can show it.
fn overlay(check: &Check, along: &Along) -> Option<Series> {
    if check.measure != Measure::Error || check.sense != Sense::Equal {
        return None;
    }
    match &check.expected {
        Expected::Value(_) => None,
        Expected::Reference(reference) => {
            let inside = rows::recorded_part(check, along, reference);
            let series =
                Series { times: reference.keys[inside.clone()].to_vec(), values: reference.values[inside].to_vec() };
            (!series.times.is_empty()).then_some(series)
        }
        Expected::Formula(formula) => {
            let idxs: Vec<usize> = rows::span(check, along).ok()?.collect();
            let values = Source::new(check, along).and_then(|source| source.formula(formula, &idxs)).ok()?;
            Some(Series { times: idxs.iter().map(|row_idx| along.keys()[*row_idx]).collect(), values })
        }
    }
}
