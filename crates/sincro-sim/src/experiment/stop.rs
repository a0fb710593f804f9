//! Bounds at which a run ends before its duration: no failure, but nothing more to be seen.
//!
//! There are two kinds: those of `[[stop_when]]`, each of which ends every run of the experiment, and those of `diverges` checks, which end
//! the run that they are made on when all of them are reached. Recorded rows are looked at, at the instants at which they are recorded.

use super::Experiment;
use super::check::{Check, Expected, Measure, Subject};
use crate::problem::{Located, Problem, Problems};
use crate::table::Table;

/// A bound of a recorded signal.
#[derive(Clone, Debug, PartialEq)]
pub struct StopWhen {
    /// The recorded signal.
    pub signal: Located<String>,
    /// Which side of the bound is the end.
    pub side: Side,
    /// The bound.
    pub bound: f64,
}

/// Where a run ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Above the bound.
    Above,
    /// Below it.
    Below,
    /// Where the magnitude is above it.
    Beyond,
}

impl StopWhen {
    /// Whether a value lies where the run ends.
    #[must_use]
    pub fn is_reached(&self, x: f64) -> bool {
        match self.side {
            Side::Above => x > self.bound,
            Side::Below => x < self.bound,
            Side::Beyond => x.abs() > self.bound,
        }
    }

    /// Of a check that wants a divergence.
    fn of(check: &Check) -> Option<Self> {
        match (check.measure, &check.what, &check.expected) {
            (Measure::Divergence, Subject::Signal(signal), Expected::Value(bound)) => {
                Some(Self { signal: signal.clone(), side: Side::Beyond, bound: *bound })
            }
            _ => None,
        }
    }

    /// `/hinge.position is 1.2 rad, beyond the bound of 1 rad`.
    fn words(&self, x: f64, unit: &str) -> String {
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

/// The bounds of one run, with the columns they look at.
#[derive(Clone, Debug)]
pub(crate) struct Bounds {
    any: Vec<(StopWhen, usize)>,
    all: Vec<(StopWhen, usize, bool)>,
}

impl Bounds {
    /// Of an experiment's main run, or of one of its variants.
    pub fn new(experiment: &Experiment, variant: Option<&str>, table: &Table) -> Self {
        let column = |stop: &StopWhen| table.columns.iter().position(|c| c.name == stop.signal.value);
        let of_variant = variant.and_then(|name| experiment.variants.iter().find(|v| v.name == name));
        let (own, inherits) = match of_variant {
            Some(variant) => (&variant.checks[..], variant.inherit_checks),
            None => (&[][..], true),
        };
        let inherited = experiment.checks.iter().filter(|_| inherits);
        let checks = own.iter().chain(inherited).filter_map(StopWhen::of);
        Self {
            any: experiment.stops.iter().filter_map(|stop| Some((stop.clone(), column(stop)?))).collect(),
            all: checks.filter_map(|stop| column(&stop).map(|k| (stop, k, false))).collect(),
        }
    }

    /// Why the run ends with the last row of a table, if it does.
    pub fn reached(&mut self, table: &Table) -> Option<String> {
        let last = |column: usize| table.columns[column].values.last().copied().unwrap_or(f64::NAN);
        let words = |stop: &StopWhen, k: usize| stop.words(last(k), &table.columns[k].unit);
        if let Some((stop, k)) = self.any.iter().find(|(stop, k)| stop.is_reached(last(*k))) {
            return Some(words(stop, *k));
        }
        let mut newest = None;
        for (stop, k, is_reached) in self.all.iter_mut().filter(|(.., is_reached)| !is_reached) {
            if stop.is_reached(last(*k)) {
                *is_reached = true;
                newest = Some(words(stop, *k));
            }
        }
        newest.filter(|_| self.all.iter().all(|(.., is_reached)| *is_reached))
    }
}

/// Refuses bounds of signals that are not recorded: they would never be reached.
pub(crate) fn check_recorded(experiment: &Experiment) -> Problems {
    let mut problems = Problems::new();
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
            problems.push(Problem::error(&stop.signal.at, message).with_help(help));
        }
    }
    problems
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::{Location, SourceText};

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

    #[test]
    fn all_divergences_but_any_bound_end_a_run() {
        let mut table = Table::new([("t", "s"), ("/j.position", "rad"), ("/k.position", "rad")], 4);
        table.push_row(&[0.0, 2.0, 0.0]);
        let mut bounds =
            Bounds { any: vec![], all: vec![(stop(Side::Beyond), 1, false), (stop(Side::Beyond), 2, false)] };
        assert_eq!(bounds.reached(&table), None);
        table.push_row(&[0.1, 0.0, -3.0]);
        assert_eq!(bounds.reached(&table).unwrap(), "`/j.position` is -3 rad, beyond the bound of 1 rad");
        let mut any = Bounds { any: vec![(stop(Side::Below), 2)], all: vec![(stop(Side::Beyond), 1, false)] };
        assert_eq!(any.reached(&table).unwrap(), "`/j.position` is -3 rad, below the bound of 1 rad");
    }
}
