//! Base steps and recorded rows: which times there are.

/// A whole number may be missed by this share of the run, the rounding of typed decimals [relative].
const SLACK: f64 = 1e-9;

/// More base steps than this cannot be told apart by their times in double precision.
const MAX_STEPS: f64 = 1e15;

/// Times of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Grid {
    /// `[s]`
    pub duration: f64,
    /// `[s]`
    pub step: f64,
    pub record_every: u64,
}

impl Grid {
    /// Number of base steps, or what is wrong with them and how to mend it.
    pub fn n_steps(&self) -> Result<u64, (String, String)> {
        let Self { duration, step, .. } = *self;
        let n = (duration / step).round();
        if duration < step * (1.0 - SLACK) {
            return Err((
                format!("duration {duration} s is shorter than one step of {step} s"),
                format!("use {step} s or more, or a smaller step"),
            ));
        }
        if n > MAX_STEPS {
            return Err((format!("duration {duration} s has {n:e} steps of {step} s"), "use a larger step".into()));
        }
        if (n * step - duration).abs() > SLACK * duration {
            let below = (duration / step).floor();
            let (below, above) = (short(below * step), short((below + 1.0) * step));
            return Err((
                format!("duration {duration} s is not a whole number of steps of {step} s"),
                format!("use {below} or {above}, or another step"),
            ));
        }
        Ok(n as u64)
    }

    /// Recorded times around `t`: the one before or at it and the one after, or `t` alone if a row falls on it.
    pub fn rows_around(&self, t: f64) -> (f64, f64) {
        let row = self.step * self.record_every as f64;
        let nearest = (t / row).round() * row;
        if (nearest - t).abs() <= SLACK * self.duration.max(1.0) {
            return (t, t);
        }
        let before = (t / row).floor() * row;
        (before, before + row)
    }

    /// Returns true if `t` lies in the run.
    pub fn contains(&self, t: f64) -> bool {
        let slack = SLACK * self.duration;
        t >= -slack && t <= self.duration + slack
    }
}

/// A number without the dust of binary arithmetic.
pub(crate) fn short(x: f64) -> String {
    let rounded: f64 = format!("{x:.11e}").parse().unwrap_or(x);
    rounded.to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn steps(duration: f64, step: f64) -> Result<u64, String> {
        Grid { duration, step, record_every: 1 }.n_steps().map_err(|(message, help)| format!("{message}; {help}"))
    }

    #[test]
    fn durations_are_whole_numbers_of_steps() {
        assert_eq!(steps(3.0, 0.005), Ok(600));
        assert_eq!(steps(0.3, 0.1), Ok(3));
        assert_eq!(steps(1e6, 1e-3), Ok(1_000_000_000));
        assert_eq!(
            steps(1.0, 0.3).unwrap_err(),
            "duration 1 s is not a whole number of steps of 0.3 s; use 0.9 or 1.2, or another step"
        );
        assert!(steps(0.001, 0.01).unwrap_err().contains("shorter than one step"));
        assert!(steps(1e9, 1e-9).unwrap_err().contains("1e18 steps"));
    }

    #[test]
    fn rows_are_found_between_others() {
        let grid = Grid { duration: 1.0, step: 0.005, record_every: 2 };
        assert_eq!(grid.rows_around(0.1), (0.1, 0.1));
        let (before, after) = grid.rows_around(0.105);
        assert_eq!((short(before), short(after)), ("0.1".into(), "0.11".into()));
    }
}
