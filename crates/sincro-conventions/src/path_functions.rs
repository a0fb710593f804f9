//! Functions on paths that are lists of configurations, one after the other.

use sincro_values::{ApiError, Arguments, Value};

use crate::paths::{Coordinate, Curve, Path, closest, distance};

/// Numbers of a path that is made at most.
const MAX_SAMPLES: usize = 1_000_000;

/// Results of a function.
type Outcome = Result<Vec<Value>, ApiError>;

/// Gives the names of the functions of [`call`] and their call tips to a macro, as literals.
#[macro_export]
macro_rules! for_paths {
    ($table:ident) => {
        $table! {
            "getPathLengths" "float[] pathLengths,float totalLength=sim.getPathLengths(float[] path,int dof)"
            "getPathInterpolatedConfig" "float[] config=sim.getPathInterpolatedConfig(float[] path,float[] pathLengths,float t,map method=nil,int[] types=nil)"
            "resamplePath" "float[] path=sim.resamplePath(float[] path,float[] pathLengths,int finalConfigCnt,map method=nil,int[] types=nil)"
            "getClosestPosOnPath" "float posAlongPath=sim.getClosestPosOnPath(float[] path,float[] pathLengths,float[3] absPt)"
            "getConfigDistance" "float distance=sim.getConfigDistance(float[] configA,float[] configB)"
        }
    };
}

/// Calls a function on paths by its name.
///
/// # Errors
///
/// An argument is no path, or does not fit it.
///
/// # Panics
///
/// There is no function of that name.
pub fn call(name: &str, a: Arguments<'_>) -> Result<Vec<Value>, ApiError> {
    match name {
        "getPathLengths" => lengths(a),
        "getPathInterpolatedConfig" => interpolated(a),
        "resamplePath" => resampled(a),
        "getClosestPosOnPath" => closest_length(a),
        "getConfigDistance" => {
            let (from, to) = (numbers(a, 0)?, numbers(a, 1)?);
            if from.len() != to.len() {
                return Err(ApiError::new("the two configurations have not as many numbers"));
            }
            Ok(vec![distance(&from, &to).into()])
        }
        _ => unreachable!("`{name}` is no function on paths"),
    }
}

fn list(numbers: Vec<f64>) -> Outcome {
    Ok(vec![Value::reals(numbers)])
}

fn numbers(a: Arguments<'_>, k: usize) -> Result<Vec<f64>, ApiError> {
    let list = a.get(k).as_reals().filter(|list| list.iter().all(|x| x.is_finite()));
    list.ok_or_else(|| ApiError(format!("argument {} is no list of finite numbers", k + 1)))
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
    let path = Path::new(&numbers, &lengths).map_err(ApiError::new)?;
    if t.is_nan() {
        return Err(ApiError::new("argument 3 is no number"));
    }
    list(path.config(t, curve(a, 3)?, &types(a, 4, path.dof())?))
}

/// A number of configurations at equal distances.
fn resampled(a: Arguments<'_>) -> Outcome {
    let (numbers, lengths) = (numbers(a, 0)?, numbers(a, 1)?);
    let path = Path::new(&numbers, &lengths).map_err(ApiError::new)?;
    let n = usize::try_from(a.int(2)?).ok().filter(|n| (2..=MAX_SAMPLES / path.dof()).contains(n));
    let n =
        n.ok_or_else(|| ApiError(format!("argument 3 is no number from 2 on, for {MAX_SAMPLES} numbers at most")))?;
    list(path.resampled(n, curve(a, 3)?, &types(a, 4, path.dof())?))
}

/// Length of a path up to its point that is closest to another one.
fn closest_length(a: Arguments<'_>) -> Outcome {
    let (numbers, lengths, point) = (numbers(a, 0)?, numbers(a, 1)?, a.reals::<3>(2)?);
    let path = Path::new(&numbers, &lengths).map_err(ApiError::new)?;
    if path.dof() < 3 {
        return Err(ApiError::new("the points of the path have fewer than three numbers"));
    }
    Ok(vec![closest(&path, &point).into()])
}
