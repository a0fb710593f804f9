//! Spaces of states: positions, poses and joints put together.

use std::f64::consts::PI;

use sincro_math::elementary::{acos, sin_cos};
use sincro_math::random::SplitMix64;

/// Weight of an angle `[rad]` against lengths `[m]` in the distance of poses in the plane.
const TURN_WEIGHT: f64 = 0.5;

/// Largest bound of a position `[m]` or `[rad]`: the squares of distances stay finite, and steps of a tree far above
/// the rounding of a state.
pub const MAX_BOUND: f64 = 1e6;
/// Largest weight of a part in distances (dimensionless).
pub const MAX_WEIGHT: f64 = 1e6;

/// Kind of a part of a state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Numbers that are bounded and do not wrap: positions `[m]`, joints `[rad]` or `[m]`.
    Real(usize),
    /// A joint that turns without stops `[rad]`.
    Cyclic,
    /// x, y `[m]` and an angle `[rad]`.
    Pose2,
    /// x, y, z `[m]` and a unit quaternion x, y, z, w.
    Pose3,
}

/// Part of a state: some of its numbers with their bounds.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    kind: Kind,
    low: Vec<f64>,
    high: Vec<f64>,
    weight: f64,
}

impl Part {
    /// A part with its bounds, of the positions only where it is a pose, and its weight in distances (dimensionless).
    /// None if the bounds are not as many numbers as the kind has, not finite, beyond ±[`MAX_BOUND`], or the lower ones
    /// are above the upper ones, or if the weight is negative or above [`MAX_WEIGHT`].
    #[must_use]
    pub fn new(kind: Kind, low: Vec<f64>, high: Vec<f64>, weight: f64) -> Option<Self> {
        let part = Self { kind, low, high, weight };
        let n = part.n_bounded();
        let is_within = |(low, high): (&f64, &f64)| -MAX_BOUND <= *low && low <= high && *high <= MAX_BOUND;
        let has_bounds = part.low.len() == n && part.high.len() == n && part.low.iter().zip(&part.high).all(is_within);
        (has_bounds && (0.0..=MAX_WEIGHT).contains(&weight)).then_some(part)
    }

    fn n_bounded(&self) -> usize {
        match self.kind {
            Kind::Real(n) => n,
            Kind::Cyclic => 0,
            Kind::Pose2 => 2,
            Kind::Pose3 => 3,
        }
    }

    /// Number of its numbers in a state.
    #[must_use]
    pub fn len(&self) -> usize {
        match self.kind {
            Kind::Real(n) => n,
            Kind::Cyclic => 1,
            Kind::Pose2 => 3,
            Kind::Pose3 => 7,
        }
    }

    /// Returns true if it has no numbers.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Directions in which it can change.
    fn n_directions(&self) -> usize {
        if self.kind == Kind::Pose3 { 6 } else { self.len() }
    }

    /// Distances of the bounded numbers, and of the angle, each with its largest value.
    fn distances(&self, a: &[f64], b: &[f64]) -> [(f64, f64); 2] {
        let n = self.n_bounded();
        let squares = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| (x - y) * (x - y)).sum::<f64>();
        let straight = (squares(&a[..n], &b[..n]).sqrt(), squares(&self.high, &self.low).sqrt());
        let turn = match self.kind {
            Kind::Real(_) => (0.0, 0.0),
            Kind::Cyclic | Kind::Pose2 => (wrapped(b[n] - a[n]).abs(), PI),
            Kind::Pose3 => (acos(dot(&a[3..], &b[3..]).abs().min(1.0)).0, 0.5 * PI),
        };
        [straight, turn]
    }

    fn distance(&self, a: &[f64], b: &[f64]) -> f64 {
        let [(straight, _), (turn, _)] = self.distances(a, b);
        self.weight * (straight + if self.kind == Kind::Pose2 { TURN_WEIGHT } else { 1.0 } * turn)
    }

    fn extent(&self) -> f64 {
        let zero = vec![0.0; self.len()];
        let [(_, straight), (_, turn)] = self.distances(&zero, &zero);
        self.weight * (straight + if self.kind == Kind::Pose2 { TURN_WEIGHT } else { 1.0 } * turn)
    }

    fn interpolate(&self, a: &[f64], b: &[f64], s: f64, out: &mut [f64]) {
        let n = self.n_bounded();
        for k in 0..n {
            out[k] = a[k] + s * (b[k] - a[k]);
        }
        match self.kind {
            Kind::Real(_) => {}
            Kind::Cyclic | Kind::Pose2 => out[n] = wrapped(a[n] + s * wrapped(b[n] - a[n])),
            Kind::Pose3 => {
                let cosine = dot(&a[3..], &b[3..]);
                let sign = if cosine < 0.0 { -1.0 } else { 1.0 };
                let angle = acos(cosine.abs().min(1.0)).0;
                let sine = sin_cos(angle).0;
                let [from, to] = match sine > 1e-9 {
                    true => [sin_cos((1.0 - s) * angle).0 / sine, sin_cos(s * angle).0 / sine],
                    false => [1.0 - s, s],
                };
                (3..7).for_each(|k| out[k] = from * a[k] + sign * to * b[k]);
                normalize(&mut out[3..]);
            }
        }
    }

    fn sample(&self, random: &mut SplitMix64, out: &mut [f64]) {
        let n = self.n_bounded();
        for k in 0..n {
            out[k] = self.low[k] + (self.high[k] - self.low[k]) * random.unit();
        }
        match self.kind {
            Kind::Real(_) => {}
            Kind::Cyclic | Kind::Pose2 => out[n] = PI * (2.0 * random.unit() - 1.0),
            Kind::Pose3 => {
                // uniform on the sphere of quaternions (key `shoemake1992`)
                let (share, first, second) = (random.unit(), random.unit(), random.unit());
                let [(s1, c1), (s2, c2)] = [sin_cos(2.0 * PI * first), sin_cos(2.0 * PI * second)];
                let [r1, r2] = [(1.0 - share).sqrt(), share.sqrt()];
                out[3..].copy_from_slice(&[r1 * s1, r1 * c1, r2 * s2, r2 * c2]);
            }
        }
    }

    fn enforce(&self, state: &mut [f64]) {
        let n = self.n_bounded();
        for k in 0..n {
            state[k] = state[k].clamp(self.low[k], self.high[k]);
        }
        match self.kind {
            Kind::Real(_) => {}
            Kind::Cyclic | Kind::Pose2 => state[n] = wrapped(state[n]),
            Kind::Pose3 => normalize(&mut state[3..]),
        }
    }

    fn contains(&self, state: &[f64]) -> bool {
        let n = self.n_bounded();
        (0..n).all(|k| (self.low[k] - 1e-9..=self.high[k] + 1e-9).contains(&state[k]))
    }

    /// Changes a state in direction `k` by a share of what it can be.
    fn shift(&self, state: &mut [f64], k: usize, share: f64) {
        let n = self.n_bounded();
        if k < n {
            state[k] += share * (self.high[k] - self.low[k]);
        } else if self.kind == Kind::Pose3 {
            let (sine, cosine) = sin_cos(share * PI);
            let [x, y, z, w] = [state[3], state[4], state[5], state[6]];
            // about an axis of the world
            let turned = match k - n {
                0 => [cosine * x + sine * w, cosine * y - sine * z, cosine * z + sine * y, cosine * w - sine * x],
                1 => [cosine * x + sine * z, cosine * y + sine * w, cosine * z - sine * x, cosine * w - sine * y],
                _ => [cosine * x - sine * y, cosine * y + sine * x, cosine * z + sine * w, cosine * w - sine * z],
            };
            state[3..].copy_from_slice(&turned);
        } else {
            state[n] += share * 2.0 * PI;
        }
        self.enforce(state);
    }
}

/// Space of states: parts one after the other.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Space {
    parts: Vec<Part>,
}

impl Space {
    /// Puts parts together.
    #[must_use]
    pub fn new(parts: Vec<Part>) -> Self {
        Self { parts }
    }

    /// Number of the numbers of a state.
    #[must_use]
    pub fn len(&self) -> usize {
        self.parts.iter().map(Part::len).sum()
    }

    /// Returns true if states have no numbers.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Parts with the places of their numbers in a state.
    fn placed(&self) -> impl Iterator<Item = (&Part, std::ops::Range<usize>)> {
        self.parts.iter().scan(0, |at, part| {
            *at += part.len();
            Some((part, *at - part.len()..*at))
        })
    }

    /// Distance of two states: sum over the parts of weight times length `[m]` or `[rad]` and turn `[rad]`; turns of
    /// [`Kind::Pose2`] count half, those of [`Kind::Pose3`] are half the angle between the orientations.
    #[must_use]
    pub fn distance(&self, a: &[f64], b: &[f64]) -> f64 {
        self.placed().map(|(part, at)| part.distance(&a[at.clone()], &b[at])).sum()
    }

    /// Largest distance of two states within the bounds.
    #[must_use]
    pub fn extent(&self) -> f64 {
        self.parts.iter().map(Part::extent).sum()
    }

    /// State at share `s` (0 to 1) of the straight line between two states; turns go the shorter way.
    #[must_use]
    pub fn interpolate(&self, a: &[f64], b: &[f64], s: f64) -> Vec<f64> {
        let mut out = vec![0.0; a.len()];
        self.placed().for_each(|(part, at)| part.interpolate(&a[at.clone()], &b[at.clone()], s, &mut out[at]));
        out
    }

    /// Number of pieces of the straight line between two states that are no longer than a `resolution` in any part, as
    /// a share of its largest distance; 1 at least.
    #[must_use]
    pub fn n_pieces(&self, a: &[f64], b: &[f64], resolution: f64) -> usize {
        let of_part = |(part, at): (&Part, std::ops::Range<usize>)| {
            let [straight, turn] = part.distances(&a[at.clone()], &b[at]);
            let share = |(d, most): (f64, f64)| if most > 0.0 { d / most } else { 0.0 };
            share(straight).max(share(turn))
        };
        let share = self.placed().map(of_part).fold(0.0, f64::max);
        // up to rounding: a line that was cut into pieces gives as many again
        ((share / resolution - 1e-9).ceil() as usize).clamp(1, 1 << 20)
    }

    /// Random state, uniform within the bounds.
    #[must_use]
    pub fn sample(&self, random: &mut SplitMix64) -> Vec<f64> {
        let mut out = vec![0.0; self.len()];
        self.placed().for_each(|(part, at)| part.sample(random, &mut out[at]));
        out
    }

    /// Brings a state within the bounds: numbers to the nearest bound, angles to −π … π, quaternions to length 1.
    pub fn enforce(&self, state: &mut [f64]) {
        self.placed().for_each(|(part, at)| part.enforce(&mut state[at]));
    }

    /// Returns true if the numbers of a state that have bounds are within them, up to 1e-9.
    #[must_use]
    pub fn contains(&self, state: &[f64]) -> bool {
        self.placed().all(|(part, at)| part.contains(&state[at]))
    }

    /// Directions in which a state can change.
    #[must_use]
    pub fn n_directions(&self) -> usize {
        self.parts.iter().map(Part::n_directions).sum()
    }

    /// Changes a state in one direction, counted from 0, by a share of the range of that direction, within the bounds.
    pub fn shift(&self, state: &mut [f64], mut direction: usize, share: f64) {
        for (part, at) in self.placed() {
            if direction < part.n_directions() {
                part.shift(&mut state[at], direction, share);
                return;
            }
            direction -= part.n_directions();
        }
    }
}

/// An angle in −π … π.
fn wrapped(angle: f64) -> f64 {
    if (-PI..=PI).contains(&angle) { angle } else { angle - 2.0 * PI * ((angle + PI) / (2.0 * PI)).floor() }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

fn normalize(q: &mut [f64]) {
    let norm = dot(q, q).sqrt();
    if norm > 0.0 && norm.is_finite() {
        q.iter_mut().for_each(|x| *x /= norm);
    } else {
        q.copy_from_slice(&[0.0, 0.0, 0.0, 1.0]);
    }
}
