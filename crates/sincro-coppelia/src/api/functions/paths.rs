//! Functions: paths, as lists of configurations one after the other.

use sincro_dynamics::spatial::Quat;

use super::rotations::rotation_vector;
use super::{Function, Outcome};
use crate::api::convention::{quaternion_of, rotation_of_quaternion};
use crate::api::{ApiError, Arguments, Value};

/// Numbers of a path that is made at most.
const MAX_SAMPLES: usize = 1_000_000;

pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "getPathLengths",
        tip: "float[] pathLengths,float totalLength=sim.getPathLengths(float[] path,int dof)",
        run: |_, a| lengths(a),
    },
    Function {
        name: "getPathInterpolatedConfig",
        tip: "float[] config=sim.getPathInterpolatedConfig(float[] path,float[] pathLengths,float t,map method=nil,int[] types=nil)",
        run: |_, a| interpolated(a),
    },
    Function {
        name: "resamplePath",
        tip: "float[] path=sim.resamplePath(float[] path,float[] pathLengths,int finalConfigCnt,map method=nil,int[] types=nil)",
        run: |_, a| resampled(a),
    },
    Function {
        name: "getClosestPosOnPath",
        tip: "float posAlongPath=sim.getClosestPosOnPath(float[] path,float[] pathLengths,float[3] absPt)",
        run: |_, a| closest_length(a),
    },
    Function {
        name: "getConfigDistance",
        tip: "float distance=sim.getConfigDistance(float[] configA,float[] configB)",
        run: |_, a| {
            let (from, to) = (numbers(a, 0)?, numbers(a, 1)?);
            if from.len() != to.len() {
                return Err(ApiError::new("the two configurations have not as many numbers"));
            }
            super::one(distance(&from, &to))
        },
    },
];

fn numbers(a: Arguments<'_>, k: usize) -> Result<Vec<f64>, ApiError> {
    let list = a.get(k).as_reals().filter(|list| list.iter().all(|x| x.is_finite()));
    list.ok_or_else(|| ApiError(format!("argument {} is no list of finite numbers", k + 1)))
}

fn distance(from: &[f64], to: &[f64]) -> f64 {
    from.iter().zip(to).map(|(a, b)| (b - a) * (b - a)).sum::<f64>().sqrt()
}

/// Length of the path up to each of its points.
fn lengths(a: Arguments<'_>) -> Outcome {
    let (path, dof) = (numbers(a, 0)?, a.int(1)?);
    let dof = usize::try_from(dof).ok().filter(|n| *n > 0 && path.len().is_multiple_of(*n) && !path.is_empty());
    let dof = dof.ok_or_else(|| ApiError::new("the path is not a whole number of configurations"))?;
    let points: Vec<&[f64]> = path.chunks_exact(dof).collect();
    let mut sum = 0.0;
    let steps = points.windows(2).map(|pair| {
        sum += distance(pair[0], pair[1]);
        sum
    });
    let lengths: Vec<f64> = [0.0].into_iter().chain(steps).collect();
    Ok(vec![Value::reals(lengths), Value::Real(sum)])
}

/// Form of the curve: a map with `type`, `strength` and `forceOpen`; straight lines if there is none.
fn curve(a: Arguments<'_>, k: usize) -> Result<Curve, ApiError> {
    let Value::Map(map) = a.get(k) else { return Ok(Curve::Linear) };
    let get = |name: &str| map.iter().find(|(key, _)| key == name).map(|(_, value)| value);
    match get("type").map(Value::as_text) {
        None | Some(Some("linear")) => Ok(Curve::Linear),
        Some(Some("quadraticBezier")) => {
            let strength = get("strength").map_or(Some(1.0), Value::as_real).filter(|x| (0.0..=1.0).contains(x));
            let strength = strength.ok_or_else(|| ApiError::new("the strength of a curve is no number from 0 to 1"))?;
            let is_open = get("forceOpen").and_then(Value::as_bool) == Some(true);
            Ok(if strength == 0.0 { Curve::Linear } else { Curve::Bezier { strength, is_open } })
        }
        Some(_) => Err(ApiError::new("a curve is `linear` or `quadraticBezier`")),
    }
}

/// Treatment of each coordinate: 0 a number, 1 an angle, 2 a part of a quaternion; numbers if there is no list.
fn types(a: Arguments<'_>, k: usize, dof: usize) -> Result<Vec<Coordinate>, ApiError> {
    if !a.has(k) {
        return Ok(vec![Coordinate::Linear; dof]);
    }
    let wrong = || ApiError(format!("argument {} is no list of {dof} types: 0 linear, 1 cyclic, 2 quaternion", k + 1));
    let list = a.get(k).as_reals().filter(|list| list.len() == dof).ok_or_else(wrong)?;
    let of = |x: &f64| match *x {
        0.0 => Ok(Coordinate::Linear),
        1.0 => Ok(Coordinate::Cyclic),
        2.0 => Ok(Coordinate::Quaternion),
        _ => Err(wrong()),
    };
    list.iter().map(of).collect()
}

/// The configuration at a length; before the first point and behind the last it stays.
fn interpolated(a: Arguments<'_>) -> Outcome {
    let (numbers, lengths, t) = (numbers(a, 0)?, numbers(a, 1)?, a.real(2)?);
    let path = Path::new(&numbers, &lengths)?;
    if t.is_nan() {
        return Err(ApiError::new("argument 3 is no number"));
    }
    super::list(path.config(t, curve(a, 3)?, &types(a, 4, path.dof())?))
}

/// A number of configurations at equal distances.
fn resampled(a: Arguments<'_>) -> Outcome {
    let (numbers, lengths) = (numbers(a, 0)?, numbers(a, 1)?);
    let path = Path::new(&numbers, &lengths)?;
    let n = usize::try_from(a.int(2)?).ok().filter(|n| (2..=MAX_SAMPLES / path.dof()).contains(n));
    let n =
        n.ok_or_else(|| ApiError(format!("argument 3 is no number from 2 on, for {MAX_SAMPLES} numbers at most")))?;
    super::list(path.resampled(n, curve(a, 3)?, &types(a, 4, path.dof())?))
}

/// Length of a path up to its point that is closest to another one.
fn closest_length(a: Arguments<'_>) -> Outcome {
    let (numbers, lengths, point) = (numbers(a, 0)?, numbers(a, 1)?, a.reals::<3>(2)?);
    let path = Path::new(&numbers, &lengths)?;
    if path.dof() < 3 {
        return Err(ApiError::new("the points of the path have fewer than three numbers"));
    }
    super::one(closest(&path, &point))
}

/// Length of a path up to its point that is closest to another one; the first three numbers of its points are
/// positions.
pub(super) fn closest(path: &Path<'_>, point: &[f64; 3]) -> f64 {
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
pub(super) enum Coordinate {
    Linear,
    Cyclic,
    Quaternion,
}

/// Positions and quaternions, as paths of poses have them.
pub(super) const POSE: [Coordinate; 7] = {
    use Coordinate::{Linear as L, Quaternion as Q};
    [L, L, L, Q, Q, Q, Q]
};

/// Form of the curve between the points of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Curve {
    /// Straight lines.
    Linear,
    /// Quadratic Bézier curves that round off each point, from the `strength`-th part of half the way to it on; at the
    /// joint of a closed path, too, unless `is_open`.
    Bezier { strength: f64, is_open: bool },
}

/// List of configurations one after the other, with the length of the path up to each.
pub(super) struct Path<'a> {
    pub numbers: &'a [f64],
    pub lengths: &'a [f64],
}

impl<'a> Path<'a> {
    /// Checks that there is a configuration for each length, and that the lengths do not decrease.
    pub(super) fn new(numbers: &'a [f64], lengths: &'a [f64]) -> Result<Self, ApiError> {
        if lengths.is_empty() || numbers.is_empty() || !numbers.len().is_multiple_of(lengths.len()) {
            return Err(ApiError::new("the path has not a configuration for each of its lengths"));
        }
        if lengths.windows(2).any(|pair| pair[1] < pair[0]) {
            return Err(ApiError::new("the lengths of the path do not increase"));
        }
        Ok(Self { numbers, lengths })
    }

    fn n(&self) -> usize {
        self.lengths.len()
    }

    /// Numbers of a configuration.
    pub(super) fn dof(&self) -> usize {
        self.numbers.len() / self.n()
    }

    /// Point `k`.
    pub(super) fn at(&self, k: usize) -> &'a [f64] {
        &self.numbers[k * self.dof()..(k + 1) * self.dof()]
    }

    /// Configuration at a length; before the first point and behind the last it stays there.
    pub(super) fn config(&self, t: f64, curve: Curve, types: &[Coordinate]) -> Vec<f64> {
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
    pub(super) fn resampled(&self, n: usize, curve: Curve, types: &[Coordinate]) -> Vec<f64> {
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
