//! Recorded rows and what they are lined up along: time, or the parameter of a sweep.

use crate::sweep::SweepStop;
use crate::table::{Table, number_text};

/// Times closer than this are the same `[s]`. Rounding of a day's time in a scene file is 1e-11 s, no step is below
/// 1e-7 s.
const SAME_TIME: f64 = 1e-9;

/// The same for points of a sweep, as a share of the smallest gap between them.
const SAME_POINT: f64 = 1e-9;

/// Recorded rows in ascending order of their keys.
pub(super) struct Along<'a> {
    pub(super) table: &'a Table,
    /// Keys closer than this are the same.
    pub(super) tolerance: f64,
    kind: Kind<'a>,
}

enum Kind<'a> {
    Run { stopped: Option<f64> },
    Sweep { stops: Vec<Option<&'a SweepStop>> },
}

impl<'a> Along<'a> {
    /// Rows of a run, which may have stopped at a time `[s]`.
    pub(super) fn run(table: &'a Table, stopped: Option<f64>) -> Self {
        Self { table, tolerance: SAME_TIME, kind: Kind::Run { stopped } }
    }

    /// Rows of a sweep, one a run, with those that stopped.
    pub(super) fn sweep(table: &'a Table, stops: Vec<Option<&'a SweepStop>>) -> Self {
        let keys = table.times();
        let gaps = keys.windows(2).map(|pair| pair[1] - pair[0]).filter(|gap| *gap > 0.0);
        let gap = gaps.reduce(f64::min).unwrap_or_else(|| keys.first().map_or(0.0, |key| key.abs()));
        Self { table, tolerance: SAME_POINT * gap, kind: Kind::Sweep { stops } }
    }

    /// Times `[s]`, or values of the parameter.
    pub(super) fn keys(&self) -> &'a [f64] {
        self.table.times()
    }

    pub(super) fn is_sweep(&self) -> bool {
        matches!(self.kind, Kind::Sweep { .. })
    }

    /// When the run stopped `[s]`, if it did.
    pub(super) fn stopped(&self) -> Option<f64> {
        match self.kind {
            Kind::Run { stopped } => stopped,
            Kind::Sweep { .. } => None,
        }
    }

    /// Stop of the run of a row of a sweep, if it has no values.
    pub(super) fn stop_of(&self, row_idx: usize) -> Option<&'a SweepStop> {
        match &self.kind {
            Kind::Run { .. } => None,
            Kind::Sweep { stops } => stops[row_idx],
        }
    }

    /// The row of a key.
    pub(super) fn find(&self, key: f64) -> Option<usize> {
        let row_idx = self.first_from(key);
        self.keys().get(row_idx).is_some_and(|found| *found <= key + self.tolerance).then_some(row_idx)
    }

    /// The first row at a key or after it; the number of rows if there is none.
    pub(super) fn first_from(&self, key: f64) -> usize {
        self.keys().partition_point(|found| *found < key - self.tolerance)
    }

    /// The first row after a key.
    pub(super) fn first_after(&self, key: f64) -> usize {
        self.keys().partition_point(|found| *found <= key + self.tolerance)
    }

    /// Up to where no row is missing: just short of when the next one would have been recorded.
    pub(super) fn covered(&self) -> f64 {
        match self.keys() {
            [.., before, last] if !self.is_sweep() => last + (last - before - 2.0 * self.tolerance).max(0.0),
            [.., last] => *last,
            [] => f64::NEG_INFINITY,
        }
    }

    /// A key in words: `t = 0.5 s`.
    pub(super) fn place(&self, key: f64) -> String {
        format!("{} = {}", self.table.columns[0].name, self.amount(key))
    }

    /// A key with its unit: `0.5 s`.
    pub(super) fn amount(&self, key: f64) -> String {
        match self.table.columns[0].unit.as_str() {
            "" => short(key),
            unit => format!("{} {unit}", short(key)),
        }
    }

    /// End of the run in words: `the run stopped at t = 0.5 s`.
    pub(super) fn ending(&self) -> String {
        match (self.stopped(), self.keys().last()) {
            (Some(time), _) => format!("the run stopped at {}", self.place(time)),
            (None, Some(last)) => format!("the recording ends at {}", self.place(*last)),
            (None, None) => "nothing was recorded".into(),
        }
    }
}

/// A number for messages: at most twelve digits, so that 0.1 + 0.2 reads as 0.3.
pub(super) fn short(value: f64) -> String {
    let rounded = format!("{value:.11e}").parse().unwrap_or(value);
    number_text(rounded)
}
