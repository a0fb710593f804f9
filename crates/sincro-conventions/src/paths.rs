//! Paths as lists of configurations one after the other: interpolated, rounded off, sampled.

use sincro_geometry::spatial::Quat;

use crate::poses::{quaternion_of, rotation_of_quaternion, rotation_vector};

/// Length of a path up to its point that is closest to another one; the first three numbers of its points are
/// positions.
#[must_use]
pub fn closest(path: &Path<'_>, point: &[f64; 3]) -> f64 {
    let mut best = (f64::INFINITY, 0.0);
    for k in 0..path.lengths.len().max(2) - 1 {
        let (from, to) = (&path.at(k)[..3], &path.at((k + 1).min(path.lengths.len() - 1))[..3]);
        let dot = |p: &[f64]| (0..3).map(|i| (p[i] - from[i]) * (to[i] - from[i])).sum::<f64>();
        let square = dot(to);
        let share = if square > 0.0 { (dot(point) / square).clamp(0.0, 1.0) } else { 0.0 };
        let at: Vec<f64> = from.iter().zip(to).map(|(a, b)| a + share * (b - a)).collect();
        let away = distance(&at, point);
        if away < best.0 {
            let next = path.lengths[(k + 1).min(path.lengths.len() - 1)];
            best = (away, path.lengths[k] + share * (next - path.lengths[k]));
        }
    }
    best.1
}

/// Treatment of a coordinate between two points: a number, an angle that goes the shorter way round, a quaternion of
/// which it is a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coordinate {
    /// A number.
    Linear,
    /// An angle.
    Cyclic,
    /// One of the four numbers of a quaternion.
    Quaternion,
}

/// Positions and quaternions, as paths of poses have them.
pub const POSE: [Coordinate; 7] = {
    use Coordinate::{Linear as L, Quaternion as Q};
    [L, L, L, Q, Q, Q, Q]
};

/// Form of the curve between the points of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Curve {
    /// Straight lines.
    Linear,
    /// Quadratic Bézier curves that round off each point, from the `strength`-th part of half the way to it on; at the
    /// joint of a closed path, too, unless `is_open`.
    Bezier {
        /// Share of half the way that is rounded off, 0 to 1.
        strength: f64,
        /// True if a closed path keeps the corner where it begins.
        is_open: bool,
    },
}

/// List of configurations one after the other, with the length of the path up to each.
pub struct Path<'a> {
    /// Configurations.
    pub numbers: &'a [f64],
    /// Lengths.
    pub lengths: &'a [f64],
}

impl<'a> Path<'a> {
    /// Checks that there is a configuration for each length, and that the lengths do not decrease.
    ///
    /// # Errors
    ///
    /// What is wrong with them, in words.
    pub fn new(numbers: &'a [f64], lengths: &'a [f64]) -> Result<Self, &'static str> {
        if lengths.is_empty() || numbers.is_empty() || !numbers.len().is_multiple_of(lengths.len()) {
            return Err("the path has not a configuration for each of its lengths");
        }
        if lengths.windows(2).any(|pair| pair[1] < pair[0]) {
            return Err("the lengths of the path do not increase");
        }
        Ok(Self { numbers, lengths })
    }

    fn n(&self) -> usize {
        self.lengths.len()
    }

    /// Numbers of a configuration.
    #[must_use]
    pub fn dof(&self) -> usize {
        self.numbers.len() / self.n()
    }

    /// Point `k`.
    #[must_use]
    pub fn at(&self, k: usize) -> &'a [f64] {
        &self.numbers[k * self.dof()..(k + 1) * self.dof()]
    }

    /// Configuration at a length; before the first point and behind the last it stays there.
    #[must_use]
    pub fn config(&self, t: f64, curve: Curve, types: &[Coordinate]) -> Vec<f64> {
        let n = self.n();
        let next = self.lengths.partition_point(|length| *length <= t);
        if next == 0 || (next == n && !self.is_rounded_at_its_end(curve)) {
            return self.at(next.min(n - 1)).to_vec();
        }
        let next = next.min(n - 1);
        let width = self.lengths[next] - self.lengths[next - 1];
        let share = if width > 0.0 { ((t - self.lengths[next - 1]) / width).min(1.0) } else { 1.0 };
        let line = |share: f64| between(self.at(next - 1), self.at(next), share, types);
        let Curve::Bezier { strength, is_open } = curve else { return line(share) };
        // the corner that is near, the points before and behind it, and how far along the rounded part it is
        let half = 0.5 * strength;
        let is_closed = !is_open && n > 2 && self.at(0) == self.at(n - 1);
        let (before, corner, behind, s) = if share > 1.0 - half {
            let behind = if next + 1 < n { Some(next + 1) } else { is_closed.then_some(1) };
            (Some(next - 1), next, behind, 0.5 * (share - (1.0 - half)) / half)
        } else if share < half {
            let before = if next >= 2 { Some(next - 2) } else { is_closed.then(|| n - 2) };
            (before, next - 1, Some(next), 0.5 + 0.5 * share / half)
        } else {
            return line(share);
        };
        let (Some(before), Some(behind)) = (before, behind) else { return line(share) };
        let start = between(self.at(corner), self.at(before), half, types);
        let end = between(self.at(corner), self.at(behind), half, types);
        let (a, b) = (between(&start, self.at(corner), s, types), between(self.at(corner), &end, s, types));
        between(&a, &b, s, types)
    }

    fn is_rounded_at_its_end(&self, curve: Curve) -> bool {
        let n = self.n();
        matches!(curve, Curve::Bezier { is_open: false, .. }) && n > 2 && self.at(0) == self.at(n - 1)
    }

    /// `n` configurations at equal distances from the first point to the last.
    #[must_use]
    pub fn resampled(&self, n: usize, curve: Curve, types: &[Coordinate]) -> Vec<f64> {
        let total = self.lengths[self.n() - 1];
        let at = |k: usize| total * k as f64 / (n - 1).max(1) as f64;
        (0..n).flat_map(|k| self.config(at(k), curve, types)).collect()
    }
}

/// Configuration between two others, at a share of the way.
fn between(from: &[f64], to: &[f64], share: f64, types: &[Coordinate]) -> Vec<f64> {
    use std::f64::consts::{PI, TAU};
    let mut result = Vec::with_capacity(from.len());
    let mut k = 0;
    while k < from.len() {
        match types.get(k).copied().unwrap_or(Coordinate::Linear) {
            Coordinate::Quaternion if k + 4 <= from.len() => {
                result.extend(quaternion_between(&from[k..k + 4], &to[k..k + 4], share));
                k += 4;
                continue;
            }
            Coordinate::Cyclic => {
                let turns = (to[k] - from[k] + PI) / TAU;
                result.push(from[k] + share * (TAU * (turns - turns.floor()) - PI));
            }
            _ => result.push(from[k] + share * (to[k] - from[k])),
        }
        k += 1;
    }
    result
}

/// Quaternion between two others, the shorter way; those that are no rotations are taken as numbers.
fn quaternion_between(from: &[f64], to: &[f64], share: f64) -> Vec<f64> {
    let four = |q: &[f64]| rotation_of_quaternion([q[0], q[1], q[2], q[3]]);
    let (Some(a), Some(b)) = (four(from), four(to)) else {
        return from.iter().zip(to).map(|(a, b)| a + share * (b - a)).collect();
    };
    let turn = rotation_vector(&a.transpose().mul(&b));
    quaternion_of(&a.mul(&Quat::exp(turn.scale(share)).matrix())).to_vec()
}

/// Euclidean distance of two points with as many numbers.
#[must_use]
pub fn distance(from: &[f64], to: &[f64]) -> f64 {
    from.iter().zip(to).map(|(a, b)| (b - a) * (b - a)).sum::<f64>().sqrt()
}
