//! Functions: paths as objects. A path is a dummy that keeps its points as data, in its own frame, as CoppeliaSim does:
//! `PATH` and `PATHCTRLPTS` are poses of seven numbers each, packed as doubles.

use sincro_dynamics::spatial::{Pose, Vec3};

use super::{Function, Outcome, handle, list, objects, one};
use crate::api::convention::{euler_of, numbers_of_pose, pose_of_numbers, rotation_of_euler};
use crate::api::stored::Stored;
use crate::api::{ApiError, Arguments, Handle, Reference, SimApi, Value};
use sincro_conventions::path_shapes::{Shape, lengths_of, sampled};
use sincro_conventions::paths::{Curve, POSE, Path, closest};

/// Data of a path: its points.
const POINTS: &str = "PATH";
/// Data of a path: its control points.
const CONTROL_POINTS: &str = "PATHCTRLPTS";
/// Data of a path: the place of V-REP's `setPathPosition` `[m]`.
const POSITION: &str = "PATHPOSITION";
/// Points of a path at most.
const MAX_POINTS: usize = 100_000;
/// Points that a path has if nothing is said.
const SUBDIVISIONS: i64 = 100;

pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "createPath",
        tip: "int pathHandle=sim.createPath(float[] ctrlPts,int options=0,int subdiv=100,float smoothness=1.0,int orientationMode=0,float[3] upVector={0,0,1})",
        run: create,
    },
    Function {
        name: "insertPathCtrlPoints",
        tip: "int result=sim.insertPathCtrlPoints(int pathHandle,int options,int startIndex,int ptCnt,float[] ptData)",
        run: insert,
    },
    Function {
        name: "cutPathCtrlPoints",
        tip: "int result=sim.cutPathCtrlPoints(int pathHandle,int startIndex,int ptCnt)",
        run: cut,
    },
    Function {
        name: "getPathLength",
        tip: "float length=sim.getPathLength(int pathHandle)",
        run: |sim, a| one(points_of(sim, a)?.total()),
    },
    Function {
        name: "getPositionOnPath",
        tip: "float[3] position=sim.getPositionOnPath(int pathHandle,float relativeDistance)",
        run: |sim, a| list(place_at(sim, a)?.pos.0),
    },
    Function {
        name: "getOrientationOnPath",
        tip: "float[3] eulerAngles=sim.getOrientationOnPath(int pathHandle,float relativeDistance)",
        run: |sim, a| list(euler_of(&place_at(sim, a)?.rot)),
    },
    Function {
        name: "getClosestPositionOnPath",
        tip: "float relativeDistance=sim.getClosestPositionOnPath(int pathHandle,float[3] absolutePosition)",
        run: closest_position,
    },
    Function {
        name: "getPathPosition",
        tip: "float position=sim.getPathPosition(int objectHandle)",
        run: |sim, a| {
            let own = path(sim, a)?;
            one(numbers(sim, own, POSITION).first().copied().unwrap_or(0.0))
        },
    },
    Function {
        name: "setPathTargetNominalVelocity",
        tip: "int result=sim.setPathTargetNominalVelocity(int objectHandle,float targetNominalVelocity)",
        run: |sim, a| {
            path(sim, a)?;
            if a.real(1)? != 0.0 {
                return Err(ApiError::new(
                    "the position on a path does not move by itself: set it with setPathPosition",
                ));
            }
            one(1_i64)
        },
    },
    Function {
        name: "setPathPosition",
        tip: "int result=sim.setPathPosition(int objectHandle,float position)",
        run: |sim, a| {
            let own = path(sim, a)?;
            keep(sim, own, POSITION, &[a.real(1)?])?;
            one(1_i64)
        },
    },
];

/// Points of a path with the lengths up to each.
struct Points {
    numbers: Vec<f64>,
    lengths: Vec<f64>,
}

impl Points {
    fn total(&self) -> f64 {
        self.lengths.last().copied().unwrap_or(0.0)
    }
}

/// The path that is the first argument.
fn path(sim: &SimApi<'_>, a: Arguments<'_>) -> Result<Handle, ApiError> {
    let own = handle(sim, a, 0)?;
    if sim.registry.data.contains_key(&(own, CONTROL_POINTS.to_owned())) {
        return Ok(own);
    }
    let path = &sim.registry.entry(own)?.path;
    Err(ApiError(format!("`{path}` is no path: sim.createPath makes one")))
}

/// Numbers that a path keeps.
fn numbers(sim: &SimApi<'_>, own: Handle, tag: &str) -> Vec<f64> {
    let stored = sim.registry.data.get(&(own, tag.to_owned()));
    let bytes = stored.map_or(&[][..], |data| &data.bytes);
    bytes.as_chunks::<8>().0.iter().map(|eight| f64::from_le_bytes(*eight)).collect()
}

fn keep(sim: &mut SimApi<'_>, own: Handle, tag: &str, numbers: &[f64]) -> Result<(), ApiError> {
    let bytes = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
    objects::store(sim, (own, tag), Stored::from_value(&Value::Bytes(bytes))).map(|_| ())
}

fn points_of(sim: &SimApi<'_>, a: Arguments<'_>) -> Result<Points, ApiError> {
    let own = path(sim, a)?;
    let numbers = numbers(sim, own, POINTS);
    if numbers.len() < 7 {
        return Err(ApiError(format!("the path `{}` has no points", sim.registry.entry(own)?.path)));
    }
    let lengths = lengths_of(&numbers);
    Ok(Points { numbers, lengths })
}

/// A path of control points of seven numbers each; of V-REP 3, which gave a number for its looks, an empty path.
fn create(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let is_list = matches!(a.get(0), Value::List(_));
    let control = if is_list { a.get(0).as_reals().unwrap_or_default() } else { Vec::new() };
    if is_list && (control.len() < 14 || !control.len().is_multiple_of(7) || !control.iter().all(|x| x.is_finite())) {
        return Err(ApiError::new("argument 1 is no list of at least two control points of seven numbers each"));
    }
    let mut points = Vec::new();
    if is_list {
        let (options, n) = (a.int_or(1, 0)?, a.int_or(2, SUBDIVISIONS)?);
        let n = usize::try_from(n).ok().filter(|n| (2..=MAX_POINTS).contains(n));
        let n = n.ok_or_else(|| ApiError(format!("argument 3 is no number of points from 2 to {MAX_POINTS}")))?;
        let smoothness = if a.has(3) { a.real(3)? } else { 1.0 };
        if !(0.0..=1.0).contains(&smoothness) {
            return Err(ApiError(format!("argument 4, the smoothness, is {smoothness}, expected 0 to 1")));
        }
        let up = Vec3(if a.has(5) { a.reals::<3>(5)? } else { [0.0, 0.0, 1.0] });
        let (is_closed, is_oriented) = (options & 2 != 0, options & 16 != 0);
        points = sampled(&control, &Shape { is_closed, is_oriented, n, smoothness, mode: a.int_or(4, 0)?, up })
            .map_err(ApiError::new)?;
    }
    let own = sim.registry.create_dummy("Path")?;
    keep(sim, own, CONTROL_POINTS, &control)?;
    keep(sim, own, POINTS, &points)?;
    one(own)
}

/// Control points of V-REP 3: position and Euler angles, and what else each has, which is not used; bit 0 of the
/// options closes the path.
fn insert(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = path(sim, a)?;
    let (options, start) = (a.int(1)?, a.int(2)?);
    let data = a.get(4).as_reals().filter(|list| list.iter().all(|x| x.is_finite()));
    let data = data.ok_or_else(|| ApiError::new("argument 5 is no list of finite numbers"))?;
    let n = usize::try_from(a.int(3)?).ok().filter(|n| *n > 0 && data.len().is_multiple_of(*n) && data.len() / *n >= 6);
    let n = n.ok_or_else(|| ApiError::new("argument 4 is no number of points that argument 5 has numbers for"))?;
    let mut control = numbers(sim, own, CONTROL_POINTS);
    let at = usize::try_from(start).ok().filter(|k| 7 * k <= control.len()).unwrap_or(control.len() / 7);
    let new: Vec<f64> = data
        .chunks_exact(data.len() / n)
        .flat_map(|p| {
            let rot = rotation_of_euler([p[3], p[4], p[5]]);
            numbers_of_pose(&Pose { rot, pos: Vec3([p[0], p[1], p[2]]) })
        })
        .collect();
    control.splice(7 * at..7 * at, new);
    keep_control(sim, own, &control, options & 1 != 0)?;
    one(1_i64)
}

/// Takes control points away; from −1 on all of them.
fn cut(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let own = path(sim, a)?;
    let (start, n) = (a.int(1)?, a.int(2)?);
    let mut control = numbers(sim, own, CONTROL_POINTS);
    match (usize::try_from(start), usize::try_from(n)) {
        (Ok(start), Ok(n)) if 7 * start < control.len() => {
            let end = (7 * start.saturating_add(n)).min(control.len());
            control.drain(7 * start..end);
        }
        (Err(_), _) => control.clear(),
        _ => return Err(ApiError::new("the path has no control points there")),
    }
    keep_control(sim, own, &control, false)?;
    one(1_i64)
}

/// Control points of V-REP 3, between which paths are straight lines.
fn keep_control(sim: &mut SimApi<'_>, own: Handle, control: &[f64], is_closed: bool) -> Result<(), ApiError> {
    if control.len() / 7 > MAX_POINTS {
        return Err(ApiError(format!("a path has at most {MAX_POINTS} points")));
    }
    let mut points = control.to_vec();
    if is_closed && points.len() > 7 {
        points.extend_from_within(..7);
    }
    keep(sim, own, CONTROL_POINTS, control)?;
    keep(sim, own, POINTS, &points)
}

/// Pose in the world at a share of a path's length.
fn place_at(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Result<Pose<f64>, ApiError> {
    let (own, points) = (path(sim, a)?, points_of(sim, a)?);
    let share = a.real(1)?;
    if !share.is_finite() {
        return Err(ApiError::new("argument 2 is not finite"));
    }
    let at = Path::new(&points.numbers, &points.lengths).map_err(ApiError::new)?.config(
        share * points.total(),
        Curve::Linear,
        &POSE,
    );
    let pose = <[f64; 7]>::try_from(at).ok().and_then(pose_of_numbers);
    let pose = pose.ok_or_else(|| ApiError::new("a point of the path has no orientation"))?;
    Ok(sim.pose(own, Reference::World)?.compose(&pose))
}

fn closest_position(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let (own, points) = (path(sim, a)?, points_of(sim, a)?);
    let point = sim.pose(own, Reference::World)?.inverse().point(Vec3(a.reals(1)?));
    let positions: Vec<f64> = points.numbers.chunks_exact(7).flat_map(|p| [p[0], p[1], p[2]]).collect();
    let at = closest(&Path::new(&positions, &points.lengths).map_err(ApiError::new)?, &point.0);
    one(if points.total() > 0.0 { at / points.total() } else { 0.0 })
}
