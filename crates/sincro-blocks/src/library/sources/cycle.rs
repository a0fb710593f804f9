//! Time in periods, for sources that repeat themselves.

use crate::block::SAME_INSTANT;

/// Periods of equal length, one after the other from a start on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cycle {
    /// Start of the first period `[s]`.
    pub start: f64,
    /// Length `[s]`, greater than zero.
    pub period: f64,
}

impl Cycle {
    /// Time since the last period began `[s]`; none before the start.
    pub(super) fn phase(self, t: f64) -> Option<f64> {
        let since = t - self.start;
        // a tick that rounding puts just before a beginning is in the new period
        let whole = ((since + SAME_INSTANT) / self.period).floor();
        (whole >= 0.0).then(|| (since - whole * self.period).max(0.0))
    }

    /// The first instant after `t` that lies `offset` `[s]` after the beginning of a period.
    pub(super) fn next(self, t: f64, offset: f64) -> f64 {
        let first = self.start + offset;
        let now = t + SAME_INSTANT;
        if now < first {
            return first;
        }
        let whole = ((now - first) / self.period).floor();
        let next = first + (whole + 1.0) * self.period;
        if next > now { next } else { first + (whole + 2.0) * self.period }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_period_begins_with_phase_zero_though_its_length_is_no_binary_fraction() {
        let cycle = Cycle { start: 0.1, period: 0.1 };
        assert_eq!(cycle.phase(0.05), None);
        for k in 1..10_000 {
            let t = f64::from(k) * 0.1;
            let phase = cycle.phase(t).unwrap();
            assert!(phase < 1e-11, "{k} {phase}");
            let next = cycle.next(t, 0.0);
            assert!((next - t - 0.1).abs() < 1e-9, "{k} {next}");
        }
    }
}
