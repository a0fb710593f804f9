//! To a position and velocity in a given time, not less than the least.
//!
//! Two ways are tried. The first goes to some velocity v_c, stays there and goes on to the last velocity: with the time
//! given, what is covered grows with v_c, wherever there is time for both changes. The second is the fastest motion
//! with less jerk, or lower accelerations: the less, the longer it takes. Where neither takes the time exactly (it may
//! be blocked: with a last velocity that is not zero, arriving a little later can be impossible) there is none.

use crate::fastest::{HALVINGS, fastest};
use crate::profile::{Limits, Pieces, Point, Profile};
use crate::ramp::{into_limits, to_velocity};

/// Sections in which the velocities between two corners are looked through.
const SECTIONS: usize = 8;
/// By how much a motion may take less than it should `[s]`: it waits at the end.
const TIME: f64 = 1e-11;
/// Most halvings of limits.
const SHARES: usize = 40;
/// Halvings of the interval in which the share of limits lies: enough for [`TIME`].
const SHARE_HALVINGS: usize = 60;

/// A motion that takes the time `t` `[s]`, if one is found.
pub(super) fn timed(start: Point, goal: (f64, f64), limits: &Limits, t: f64) -> Option<Profile> {
    let shortest = fastest(start, goal, limits);
    if (t - shortest.duration()).abs() <= TIME {
        return Some(shortest);
    }
    if t < shortest.duration() {
        return None;
    }
    slower(start, goal, limits, t).or_else(|| gentler(start, goal, limits, t))
}

/// By staying at some velocity.
fn slower(start: Point, goal: (f64, f64), limits: &Limits, t: f64) -> Option<Profile> {
    let first = into_limits(start, limits);
    let from = first.end(start);
    let from = Point { a: from.a.clamp(limits.min_acceleration, limits.max_acceleration), ..from };
    let search = Search { from, way: goal.0 - from.p, v_end: goal.1, limits: *limits, t: t - first.duration() };
    let rest = search.solution()?;
    let mut pieces = first;
    pieces.extend(&rest);
    Some(Profile::new(start, pieces, Point { p: goal.0, v: goal.1, a: 0.0 }))
}

struct Search {
    from: Point,
    way: f64,
    v_end: f64,
    limits: Limits,
    t: f64,
}

/// A velocity in between, the time that is left to stay there, and what is covered beyond what is to be.
#[derive(Clone, Copy)]
struct Sample {
    v: f64,
    left: f64,
    excess: f64,
}

impl Search {
    fn ramps(&self, v: f64) -> [Pieces; 2] {
        let there = Point { p: 0.0, v, a: 0.0 };
        [to_velocity(self.from, v, &self.limits), to_velocity(there, self.v_end, &self.limits)]
    }

    fn sample(&self, v: f64) -> Sample {
        let [to, on] = self.ramps(v);
        let left = self.t - to.duration() - on.duration();
        let covered = to.end(Point { p: 0.0, ..self.from }).p + on.end(Point { p: 0.0, v, a: 0.0 }).p;
        Sample { v, left, excess: covered + v * left - self.way }
    }

    /// Velocities at which the form of a ramp changes, in order, with others between them.
    fn velocities(&self) -> Vec<f64> {
        let Limits { min_velocity, max_velocity, min_acceleration: low, max_acceleration: high, max_jerk: j } =
            self.limits;
        let (Point { v, a, .. }, v_end) = (self.from, self.v_end);
        let (up, down) = ((high * high - a * a / 2.0) / j, (low * low - a * a / 2.0) / j);
        let mut corners = vec![
            min_velocity,
            max_velocity,
            v_end,
            self.from.rest_velocity(j),
            v + up,
            v - down,
            v_end + low * low / j,
            v_end - high * high / j,
            0.0,
        ];
        corners.retain(|v| (min_velocity..=max_velocity).contains(v));
        corners.sort_by(f64::total_cmp);
        corners.dedup();
        let between = |pair: &[f64]| {
            let (from, to) = (pair[0], pair[1]);
            (0..SECTIONS).map(move |k| from + (to - from) * (k as f64 / SECTIONS as f64))
        };
        let mut all: Vec<f64> = corners.windows(2).flat_map(between).collect();
        all.extend(corners.last());
        all
    }

    fn solution(&self) -> Option<Pieces> {
        let samples: Vec<Sample> = self.velocities().into_iter().map(|v| self.sample(v)).collect();
        let mut found: Vec<Sample> = samples.iter().filter(|s| s.left >= 0.0 && s.excess == 0.0).copied().collect();
        for pair in samples.windows(2) {
            let [mut from, mut to] = [pair[0], pair[1]];
            // where time is left on one side only, up to where it is
            match (from.left >= 0.0, to.left >= 0.0) {
                (false, false) => continue,
                (true, false) => to = self.halve(from, to, |s| s.left < 0.0).0,
                (false, true) => from = self.halve(from, to, |s| s.left >= 0.0).1,
                (true, true) => {}
            }
            if (from.excess < 0.0) != (to.excess < 0.0) {
                let is_over = to.excess >= 0.0;
                let (a, b) = self.halve(from, to, |s| (s.excess >= 0.0) == is_over);
                found.push(if a.excess.abs() <= b.excess.abs() { a } else { b });
            }
        }
        // the calmest of them
        let best = found.into_iter().filter(|s| s.left >= 0.0).min_by(|a, b| a.v.abs().total_cmp(&b.v.abs()))?;
        let [mut pieces, on] = self.ramps(best.v);
        pieces.push(best.left, 0.0);
        pieces.extend(&on);
        Some(pieces)
    }

    /// The neighbours between which something becomes true.
    fn halve(&self, mut from: Sample, mut to: Sample, is_true: impl Fn(&Sample) -> bool) -> (Sample, Sample) {
        for _ in 0..HALVINGS {
            let v = from.v + (to.v - from.v) / 2.0;
            if v == from.v || v == to.v {
                break;
            }
            let mid = self.sample(v);
            if is_true(&mid) { to = mid } else { from = mid }
        }
        (from, to)
    }
}

/// With less jerk, or lower accelerations.
fn gentler(start: Point, goal: (f64, f64), limits: &Limits, t: f64) -> Option<Profile> {
    let less_jerk = |share: f64| Limits { max_jerk: share * limits.max_jerk, ..*limits };
    let lower = |share: f64| Limits {
        max_acceleration: (share * limits.max_acceleration).max(start.a.min(limits.max_acceleration)),
        min_acceleration: (share * limits.min_acceleration).min(start.a.max(limits.min_acceleration)),
        ..*limits
    };
    let ways: [&dyn Fn(f64) -> Limits; 2] = [&less_jerk, &lower];
    ways.into_iter().find_map(|way| within_share(&|share| fastest(start, goal, &way(share)), start, limits, t))
}

/// The share of the limits with which the time is taken.
fn within_share(with: &dyn Fn(f64) -> Profile, start: Point, limits: &Limits, t: f64) -> Option<Profile> {
    let (mut more, mut less) = (1.0, 1.0);
    for _ in 0..SHARES {
        less /= 2.0;
        if with(less).duration() >= t {
            break;
        }
        more = less;
    }
    for _ in 0..SHARE_HALVINGS {
        let mid = less + (more - less) / 2.0;
        if mid == less || mid == more {
            break;
        }
        if with(mid).duration() > t { less = mid } else { more = mid }
    }
    Some(with(more)).filter(|profile| (t - profile.duration()).abs() <= TIME && stays_within(profile, start, limits))
}

/// Returns true if a motion keeps the limits, where it does not begin outside of them.
fn stays_within(profile: &Profile, start: Point, limits: &Limits) -> bool {
    let range = |low: f64, high: f64, x: f64| {
        let room = 1e-9 * (high - low);
        low.min(x) - room..=high.max(x) + room
    };
    let velocities = range(limits.min_velocity, limits.max_velocity, start.v);
    let accelerations = range(limits.min_acceleration, limits.max_acceleration, start.a);
    profile.corners().all(|x| velocities.contains(&x.v) && accelerations.contains(&x.a))
}

/// To a velocity in a given time, not less than the least: with a lower peak of the acceleration, else with less jerk,
/// else with a wait at the end.
pub(super) fn timed_velocity(start: Point, v: f64, limits: &Limits, t: f64) -> Profile {
    let with = |share: f64, jerk: f64| {
        let limits = Limits {
            max_acceleration: (share * limits.max_acceleration).max(start.a.min(limits.max_acceleration)),
            min_acceleration: (share * limits.min_acceleration).min(start.a.max(limits.min_acceleration)),
            max_jerk: jerk * limits.max_jerk,
            ..*limits
        };
        fastest_velocity(start, v, &limits)
    };
    let ways: [&dyn Fn(f64) -> Profile; 2] = [&|share| with(share, 1.0), &|share| with(1.0, share)];
    for way in ways {
        let (mut more, mut less) = (1.0, 0.0);
        for _ in 0..HALVINGS {
            let mid = less + (more - less) / 2.0;
            if mid == less || mid == more {
                break;
            }
            if way(mid).duration() > t { less = mid } else { more = mid }
        }
        let found = way(more);
        if (t - found.duration()).abs() <= TIME {
            return found;
        }
    }
    fastest_velocity(start, v, limits)
}

/// To a velocity in the least time.
pub(super) fn fastest_velocity(start: Point, v: f64, limits: &Limits) -> Profile {
    let over = start.a - start.a.clamp(limits.min_acceleration, limits.max_acceleration);
    let mut pieces = Pieces::default();
    pieces.push(over.abs() / limits.max_jerk, -over.signum() * limits.max_jerk);
    let from = Point { a: start.a - over, ..pieces.end(start) };
    pieces.extend(&to_velocity(from, v, limits));
    let p = pieces.end(start).p;
    Profile::new(start, pieces, Point { p, v, a: 0.0 })
}
