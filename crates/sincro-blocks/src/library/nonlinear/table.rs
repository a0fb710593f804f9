//! Interpolation between breakpoints, for the lookup tables.

use crate::library::prelude::*;

choice! {
    /// Values beyond the ends of a table.
    pub enum Extrapolation {
        /// The value at the end.
        Hold = "hold",
        /// The line through the last two points.
        Linear = "linear",
    }
}

/// Number of the interval that holds `x`, and how far into it `x` is: 0 at its beginning, 1 at its end, with the rate
/// of that by `x`. Beyond the ends it is below 0 or above 1, or held there. A NaN stays one.
pub(super) fn interval(breakpoints: &[f64], x: f64, extrapolation: Extrapolation) -> (usize, f64, f64) {
    let n = breakpoints.len();
    if n == 1 {
        return (0, if x.is_nan() { x } else { 0.0 }, 0.0);
    }
    let k = breakpoints.partition_point(|b| *b <= x).clamp(1, n - 1) - 1;
    let width = breakpoints[k + 1] - breakpoints[k];
    let part = (x - breakpoints[k]) / width;
    match extrapolation {
        Extrapolation::Hold if part < 0.0 => (k, 0.0, 0.0),
        Extrapolation::Hold if part > 1.0 => (k, 1.0, 0.0),
        _ => (k, part, 1.0 / width),
    }
}

/// A fault if the breakpoints do not rise; whether they do.
pub(super) fn check_breakpoints(p: &mut Reader<'_>, key: &str, breakpoints: &[f64]) -> bool {
    let bad = breakpoints.windows(2).position(|pair| pair[1] <= pair[0]);
    if let Some(k) = bad {
        let message = format!("`{key}` has {} after {}", breakpoints[k + 1], breakpoints[k]);
        p.fault(key, message, "breakpoints must rise from one to the next");
    }
    bad.is_none()
}
