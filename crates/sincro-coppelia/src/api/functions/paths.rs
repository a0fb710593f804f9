//! Functions: paths, as lists of configurations one after the other.

use super::{Function, Outcome};
use crate::api::{ApiError, Arguments, Value};

pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "getPathLengths",
        tip: "float[] pathLengths,float totalLength=sim.getPathLengths(float[] path,int dof)",
        run: |_, a| lengths(a),
    },
    Function {
        name: "getPathInterpolatedConfig",
        tip: "float[] config=sim.getPathInterpolatedConfig(float[] path,float[] pathLengths,float t)",
        run: |_, a| interpolated(a),
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

/// The configuration at a length, on straight lines between the points; before the first and behind the last it stays.
fn interpolated(a: Arguments<'_>) -> Outcome {
    let (path, lengths, t) = (numbers(a, 0)?, numbers(a, 1)?, a.real(2)?);
    let n = lengths.len();
    if n == 0 || path.is_empty() || !path.len().is_multiple_of(n) || t.is_nan() {
        return Err(ApiError::new("the path has not a configuration for each of its lengths"));
    }
    if lengths.windows(2).any(|pair| pair[1] < pair[0]) {
        return Err(ApiError::new("the lengths of the path do not increase"));
    }
    let dof = path.len() / n;
    let at = |k: usize| &path[k * dof..(k + 1) * dof];
    let next = lengths.partition_point(|length| *length <= t);
    if next == 0 || next == n {
        return super::list(at(next.min(n - 1)).iter().copied());
    }
    let share = (t - lengths[next - 1]) / (lengths[next] - lengths[next - 1]);
    super::list(at(next - 1).iter().zip(at(next)).map(|(a, b)| a + share * (b - a)))
}
