//! Bounds at which a run ends before its duration: no failure, but nothing more to be seen.
//!
//! There are two kinds: those of `[[stop_when]]`, each of which ends every run of the experiment, and those of
//! `diverges` checks, which end the run that they are made on when all of them are reached. Recorded rows are looked
//! at, at the instants at which they are recorded.

use super::Experiment;
use super::check::{Check, Expected, Measure, Subject};
use crate::diagnostic::{Diagnostic, Diagnostics, Located};

/// Stop condition: a bound of a recorded signal at which a run ends before its duration.
#[derive(Clone, Debug, PartialEq)]
pub struct StopWhen {
    /// Name of the recorded signal.
    pub signal: Located<String>,
    /// Side of the bound on which the run ends.
    pub side: Side,
    /// Bound, in the unit of the signal.
    pub bound: f64,
}

/// Side of a bound on which a run ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Values above the bound end the run.
    Above,
    /// Values below the bound end the run.
    Below,
    /// Magnitudes above the bound end the run.
    Beyond,
}

impl StopWhen {
    /// Returns true if the run ends at the value `x` of the signal, in its unit; NaN does not end it.
    #[must_use]
    pub fn is_reached(&self, x: f64) -> bool {
        match self.side {
            Side::Above => x > self.bound,
            Side::Below => x < self.bound,
            Side::Beyond => x.abs() > self.bound,
        }
    }

    /// Returns the stop condition of a check for divergence of a signal beyond a number; `None` for other checks.
    #[must_use]
    pub fn of(check: &Check) -> Option<Self> {
        match (check.measure, &check.what, &check.expected) {
            (Measure::Divergence, Subject::Signal(signal), Expected::Value(bound)) => {
                Some(Self { signal: signal.clone(), side: Side::Beyond, bound: *bound })
            }
            _ => None,
        }
    }

    /// Returns a sentence that the signal has the value `x` beyond the bound, both in the unit `unit`: ``
    /// `/hinge.position` is 1.2 rad, beyond the bound of 1 rad ``.
    #[must_use]
    pub fn words(&self, x: f64, unit: &str) -> String {
        let side = match self.side {
            Side::Above => "above",
            Side::Below => "below",
            Side::Beyond => "beyond",
        };
        let unit = if matches!(unit, "" | "1") { String::new() } else { format!(" {unit}") };
        let (name, bound) = (&self.signal.value, super::grid::short(self.bound));
        format!("`{name}` is {}{unit}, {side} the bound of {bound}{unit}", four_digits(x))
    }
}

/// A number in four significant digits: where a run passes a bound is decided by its rows.
fn four_digits(x: f64) -> f64 {
    format!("{x:.3e}").parse().unwrap_or(x)
}

/// Refuses bounds of signals that are not recorded: they would never be reached.
pub(crate) fn check_recorded(experiment: &Experiment) -> Diagnostics {
    let mut diagnostics = Diagnostics::new();
    let of_variants = experiment.variants.iter().flat_map(|variant| &variant.checks);
    let wanted = experiment.checks.iter().chain(of_variants).filter_map(StopWhen::of);
    for stop in experiment.stops.iter().cloned().chain(wanted) {
        let name = &stop.signal.value;
        if !experiment.record.iter().any(|known| known.value == *name) {
            let known: Vec<&str> = experiment.record.iter().map(|known| known.value.as_str()).collect();
            let help = match crate::suggest::nearest(name, known) {
                Some(near) => format!("add it to `record`; `{near}` is recorded"),
                None => "add it to `record`".to_owned(),
            };
            let message = format!("`{name}` is not recorded, so that its bound cannot be seen");
            diagnostics.push(Diagnostic::error(&stop.signal.at, message).with_help(help));
        }
    }
    diagnostics
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnostic::{Location, SourceText};

    fn stop(side: Side) -> StopWhen {
        let source = std::sync::Arc::new(SourceText { path: "experiment.toml".into(), text: String::new() });
        let at = Location { source, span: 0..0 };
        StopWhen { signal: Located { value: "/j.position".into(), at }, side, bound: 1.0 }
    }

    #[test]
    fn a_bound_is_reached_on_its_side_only() {
        let reached = |side| [-2.0, -1.0, 1.0, 2.0, f64::NAN].map(|x| stop(side).is_reached(x));
        assert_eq!(reached(Side::Above), [false, false, false, true, false]);
        assert_eq!(reached(Side::Below), [true, true, false, false, false]);
        assert_eq!(reached(Side::Beyond), [true, false, false, true, false]);
    }
}
