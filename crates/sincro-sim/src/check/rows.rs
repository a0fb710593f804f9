//! Which recorded rows a check looks at, or why it cannot.

use std::ops::Range;

use super::along::{Along, short};
use sincro_scene::experiment::check::{Check, Expected, Reference};

/// The rows that are compared, in ascending order; at least one.
pub(super) struct Rows {
    pub(super) idxs: Vec<usize>,
    /// For each of them the value of the reference, if the check has one.
    pub(super) reference: Option<Vec<f64>>,
}

/// The rows of a check.
pub(super) fn select(check: &Check, along: &Along) -> Result<Rows, String> {
    if along.keys().is_empty() {
        return Err("nothing was recorded".into());
    }
    let span = span(check, along)?;
    covered(check, along)?;
    let rows = match &check.expected {
        Expected::Reference(reference) => matched(check, along, reference, span)?,
        Expected::Value(_) | Expected::Formula(_) => Rows { idxs: span.collect(), reference: None },
    };
    for row_idx in &rows.idxs {
        if let Some(stop) = along.stop_of(*row_idx) {
            let point = along.place(along.keys()[*row_idx]);
            return Err(format!("the run at {point} stopped at t = {} s: {}", short(stop.time), stop.reason));
        }
    }
    Ok(rows)
}

/// The rows at `at`, in `window`, or all.
pub(super) fn span(check: &Check, along: &Along) -> Result<Range<usize>, String> {
    if let Some(at) = check.at {
        let row_idx = along.find(at).ok_or_else(|| no_row_at(along, at))?;
        return Ok(row_idx..row_idx + 1);
    }
    let Some((first, last)) = check.window else { return Ok(0..along.keys().len()) };
    let span = along.first_from(first)..along.first_after(last);
    if !span.is_empty() {
        return Ok(span);
    }
    let wanted = format!("from {} to {}", along.place(first), along.amount(last));
    match along.keys().last() {
        Some(end) if first > *end && !along.is_sweep() => Err(format!("{}, the check looks {wanted}", along.ending())),
        _ => Err(format!("no row was recorded {wanted}")),
    }
}

fn no_row_at(along: &Along, at: f64) -> String {
    let keys = along.keys();
    let next = along.first_from(at);
    let wanted = along.place(at);
    match (next.checked_sub(1).map(|k| keys[k]), keys.get(next)) {
        (Some(before), Some(after)) => {
            format!(
                "no row was recorded at {wanted}; the nearest are at {} and {}",
                short(before),
                along.amount(*after)
            )
        }
        (Some(_), None) if !along.is_sweep() => format!("{}, the check looks at {wanted}", along.ending()),
        (Some(nearest), None) | (None, Some(&nearest)) => {
            format!("no row was recorded at {wanted}; the nearest is at {}", along.amount(nearest))
        }
        (None, None) => "nothing was recorded".into(),
    }
}

/// Checks that the rows a check needs were recorded to the last.
fn covered(check: &Check, along: &Along) -> Result<(), String> {
    if along.is_sweep() || check.at.is_some() {
        return Ok(());
    }
    match (check.window, &check.expected) {
        (Some((_, last)), _) if last > along.covered() + along.tolerance => {
            Err(format!("{}, the check looks to {}", along.ending(), along.place(last)))
        }
        (None, Expected::Value(_) | Expected::Formula(_)) if along.stopped().is_some() => {
            Err(format!("{}, the check looks at the whole run", along.ending()))
        }
        (None, Expected::Reference(reference)) if along.stopped().is_some() => match reference.keys.last() {
            Some(last) if *last > along.covered() + along.tolerance => {
                Err(format!("{}, the reference reaches to {}", along.ending(), along.place(*last)))
            }
            _ => Ok(()),
        },
        _ => Ok(()),
    }
}

/// The rows of a reference that lie in the check's window and in the recorded part of the run.
pub(super) fn recorded_part(check: &Check, along: &Along, reference: &Reference) -> Range<usize> {
    let window = check.at.map(|at| (at, at)).or(check.window);
    let (first, last) = window.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
    let first = along.keys().first().map_or(first, |start| first.max(*start)) - along.tolerance;
    let last = last.min(along.covered()) + along.tolerance;
    let start = reference.keys.partition_point(|key| *key < first);
    let end = reference.keys.partition_point(|key| *key <= last);
    start..end.max(start)
}

/// The recorded rows on which the rows of a reference fall.
fn matched(check: &Check, along: &Along, reference: &Reference, span: Range<usize>) -> Result<Rows, String> {
    let inside = recorded_part(check, along, reference);
    let mut rows = Rows { idxs: Vec::with_capacity(inside.len()), reference: None };
    let mut values = Vec::with_capacity(inside.len());
    let mut missed = None;
    for k in inside.clone() {
        match along.find(reference.keys[k]).filter(|row_idx| span.contains(row_idx)) {
            Some(row_idx) => {
                rows.idxs.push(row_idx);
                values.push(reference.values[k]);
            }
            None => missed = missed.or(Some(reference.keys[k])),
        }
    }
    match missed {
        Some(key) if !along.is_sweep() => return Err(between_rows(along, reference, inside, key)),
        Some(key) if !every_point_is_a_row(along, reference, span, &rows.idxs) => {
            return Err(format!(
                "the reference has a row at {} where the sweep has no point, and the sweep has points between its rows; \
                 nothing is interpolated",
                along.place(key)
            ));
        }
        _ => {}
    }
    if rows.idxs.is_empty() {
        return Err(format!("{} has no row in the part of the run that is checked", file_name(reference)));
    }
    rows.reference = Some(values);
    Ok(rows)
}

/// Returns true if each point of a sweep that lies between the first and the last row of a reference falls on one of
/// its rows.
fn every_point_is_a_row(along: &Along, reference: &Reference, mut span: Range<usize>, matched: &[usize]) -> bool {
    let (Some(first), Some(last)) = (reference.keys.first(), reference.keys.last()) else { return false };
    let between = |key: f64| key >= first - along.tolerance && key <= last + along.tolerance;
    span.all(|row_idx| !between(along.keys()[row_idx]) || matched.contains(&row_idx))
}

/// A row of a reference falls between the recorded rows: which one, and what would bring them together.
fn between_rows(along: &Along, reference: &Reference, inside: Range<usize>, key: f64) -> String {
    let file = file_name(reference);
    let place = along.place(key);
    let what = format!("the row {place} of {file} falls between the recorded rows, and nothing is interpolated");
    match common_step(&reference.keys[inside], along.tolerance) {
        Some(step) => {
            format!("{what}: `step` times `record_every` must be {} or a whole fraction of it", along.amount(step))
        }
        None => format!("{what}: no step fits the reference"),
    }
}

pub(super) fn file_name(reference: &Reference) -> String {
    reference.file.file_name().map_or_else(|| "the reference".into(), |name| name.to_string_lossy().into_owned())
}

/// The greatest step of which all times are whole multiples: Euclid's algorithm, with remainders below `tolerance`
/// taken as zero.
fn common_step(times: &[f64], tolerance: f64) -> Option<f64> {
    /// No step is as small as this `[s]`.
    const LEAST: f64 = 1e-7;
    let mut step = 0.0;
    for time in times {
        let (mut a, mut b) = (time.abs(), step);
        while b > tolerance {
            let rest = (a - (a / b).round() * b).abs();
            (a, b) = (b, rest);
        }
        step = a;
    }
    (step > LEAST).then_some(step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_common_step_of_times_that_are_only_nearly_multiples() {
        let step = |times: &[f64]| common_step(times, 1e-9).map(short);
        assert_eq!(step(&[0.0, 0.02, 0.04, 4.0]).as_deref(), Some("0.02"));
        assert_eq!(step(&[0.3, 0.1 + 0.2, 1.0]).as_deref(), Some("0.1"));
        assert_eq!(step(&[0.01, 0.025]).as_deref(), Some("0.005"));
        assert_eq!(step(&[1.0, std::f64::consts::SQRT_2]), None);
        assert_eq!(step(&[0.0]), None);
    }
}
