//! From one velocity to another, and back into the limits.
//!
//! The fastest change of velocity is a triangle or trapezium of acceleration: jerk, none, jerk the other way. With J
//! the largest jerk, the peak is A = √(J·|v₁ − v₀| + a₀²/2), cut off at the largest acceleration.

use crate::profile::{Limits, Pieces, Point};

/// The fastest way to the velocity `v` and no acceleration, from an acceleration within the limits.
pub(super) fn to_velocity(from: Point, v: f64, limits: &Limits) -> Pieces {
    let max_jerk = limits.max_jerk;
    let is_up = v >= from.rest_velocity(max_jerk);
    // as if upwards
    let (sign, top) = if is_up { (1.0, limits.max_acceleration) } else { (-1.0, -limits.min_acceleration) };
    let (gain, a) = (sign * (v - from.v), sign * from.a);
    let peak = (max_jerk * gain + a * a / 2.0).max(0.0).sqrt();
    let mut pieces = Pieces::default();
    if peak <= top {
        pieces.push((peak - a) / max_jerk, sign * max_jerk);
        pieces.push(peak / max_jerk, -sign * max_jerk);
    } else {
        let held = gain - (2.0 * top * top - a * a) / (2.0 * max_jerk);
        pieces.push((top - a) / max_jerk, sign * max_jerk);
        pieces.push(held / top, 0.0);
        pieces.push(top / max_jerk, -sign * max_jerk);
    }
    pieces
}

/// Pieces that come first if the acceleration is out of its limits, or the velocity is or cannot but get there: the
/// fastest way to where a motion within the limits can begin. Of the velocity, the way ends where it is at its limit,
/// or where the acceleration has to be taken back so as not to pass the other one.
pub(super) fn into_limits(from: Point, limits: &Limits) -> Pieces {
    let (mut pieces, mut x) = (Pieces::default(), from);
    let j = limits.max_jerk;
    let over = x.a - x.a.clamp(limits.min_acceleration, limits.max_acceleration);
    if over != 0.0 {
        pieces.push(over.abs() / j, -over.signum() * j);
        x = pieces.end(from);
        x.a = x.a.clamp(limits.min_acceleration, limits.max_acceleration);
    }
    if is_too_fast(x, limits) {
        pieces.extend(&slow_down(x, limits));
    } else if is_too_fast(x.mirrored(), &limits.mirrored()) {
        pieces.extend(&slow_down(x.mirrored(), &limits.mirrored()).scaled(-1.0));
    }
    pieces
}

fn is_too_fast(x: Point, limits: &Limits) -> bool {
    let rest = x.rest_velocity(limits.max_jerk);
    if x.a > 0.0 { rest > limits.max_velocity } else { x.v > limits.max_velocity && rest > limits.min_velocity }
}

/// Jerk downwards, then the lowest acceleration, until the velocity is the largest allowed, or to raise the
/// acceleration at once ends at the lowest.
fn slow_down(x: Point, limits: &Limits) -> Pieces {
    let (j, lowest) = (limits.max_jerk, limits.min_acceleration);
    let time_to = |square: f64| (x.a + square.max(0.0).sqrt()) / j;
    let to_max = time_to(x.a * x.a + 2.0 * j * (x.v - limits.max_velocity));
    let to_min = time_to(x.a * x.a / 2.0 + j * (x.v - limits.min_velocity));
    let (until, to_lowest) = (to_max.min(to_min), (x.a - lowest) / j);
    let mut pieces = Pieces::default();
    if to_lowest >= until {
        pieces.push(until, -j);
        return pieces;
    }
    pieces.push(to_lowest, -j);
    let v = x.after(to_lowest, -j).v;
    let hold = |v_end: f64| (v - v_end) / -lowest;
    pieces.push(hold(limits.max_velocity).min(hold(limits.min_velocity + lowest * lowest / (2.0 * j))), 0.0);
    pieces
}
