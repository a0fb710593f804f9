//! Functions that move something and wait until it is there: adapters make them of single steps.
//!
//! | function | steps of |
//! |---|---|
//! | `moveToConfig` (a map, or flags, positions … as before 4.7) | `moveToConfig_…` |
//! | `moveToPose` (the same) | `moveToPose_…` |
//! | `rmlMoveToJointPositions`, `rmlMoveToPosition` of V-REP | the same two |
//! | `moveToPosition` of V-REP | `moveToPose_…` |

use super::motions::{MIN_ACCELERATION, MIN_VELOCITY};
use crate::api::convention::{numbers_of_pose, pose_of_matrix, quaternion_of, rotation_of_euler};
use crate::api::{ApiError, Arguments, Reference, SimApi, Value};
use sincro_values::fields::Fields;

/// Function that moves joints or an object and returns when the motion has ended. An adapter, which alone can wait,
/// makes it of the functions `…_init`, `…_step` and `…_cleanup` of [`Move::stem`], with [`Move::parameters`] and
/// [`Move::results`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Move {
    /// `sim.moveToConfig`: joints, or any numbers, to a configuration.
    Config,
    /// `sim.moveToPose`: an object, or a pose, to a pose.
    Pose,
    /// `rmlMoveToJointPositions` of V-REP: joints to positions.
    JointPositions,
    /// `rmlMoveToPosition` of V-REP: an object to a position and orientation.
    Position,
    /// `moveToPosition` of V-REP: an object along a straight line to a position and orientation.
    Line,
}

/// Functions that wait: name without `sim.`, call tip (results, name and parameters with their types), kind.
pub const MOVES: &[(&str, &str, Move)] = &[
    ("moveToConfig", "map data=sim.moveToConfig(map params)", Move::Config),
    ("moveToPose", "map data=sim.moveToPose(map params)", Move::Pose),
    (
        "rmlMoveToJointPositions",
        "int result,float[] newPos,float[] newVel,float[] newAccel,float timeLeft=sim.rmlMoveToJointPositions(int[] jointHandles,int flags,float[] currentVel,float[] currentAccel,float[] maxVel,float[] maxAccel,float[] maxJerk,float[] targetPos,float[] targetVel,float[] direction=nil)",
        Move::JointPositions,
    ),
    (
        "rmlMoveToPosition",
        "int result,float[3] newPos,float[4] newQuaternion,float[4] newVel,float[4] newAccel,float timeLeft=sim.rmlMoveToPosition(int objectHandle,int relativeToObjectHandle,int flags,float[4] currentVel,float[4] currentAccel,float[4] maxVel,float[4] maxAccel,float[4] maxJerk,float[3] targetPosition,float[4] targetQuaternion,float[4] targetVel=nil)",
        Move::Position,
    ),
    (
        "moveToPosition",
        "int result,float timeLeft=sim.moveToPosition(int objectHandle,int relativeToObjectHandle,float[3] position=nil,float[3] eulerAngles=nil,float velocity,float acceleration=nil)",
        Move::Line,
    ),
];

impl Move {
    /// Finds the kind of a function by its present or an older name, with or without `sim.`; none if it is no function
    /// that waits.
    #[must_use]
    pub fn of(name: &str) -> Option<Self> {
        let present = super::present_name(name);
        let present = match &*present {
            "rMLMoveToJointPositions" => "rmlMoveToJointPositions",
            "rMLMoveToPosition" => "rmlMoveToPosition",
            other => other,
        };
        MOVES.iter().find(|(known, _, _)| *known == present).map(|(_, _, this)| *this)
    }

    /// Name that the functions for the single steps begin with: `moveToConfig` or `moveToPose`, followed by `_init`,
    /// `_step`, `_cleanup`.
    #[must_use]
    pub fn stem(self) -> &'static str {
        match self {
            Self::Config | Self::JointPositions => "moveToConfig",
            Self::Pose | Self::Position | Self::Line => "moveToPose",
        }
    }

    /// Converts the arguments of the call, in the order of its call tip, to the map that the function `…_init` takes.
    /// Lengths are in `[m]`, angles in `[rad]`. The field `callback` is the function called after each step; the field
    /// `legacyFunc` is set if that takes (position, velocity, acceleration, data), as it did before CoppeliaSim 4.7.
    ///
    /// # Errors
    ///
    /// An argument is of another type or length than the call tip says, or an object of it is not there; the message
    /// has its number.
    pub fn parameters(self, sim: &mut SimApi<'_>, arguments: &[Value]) -> Result<Value, ApiError> {
        let a = Arguments(arguments);
        match self {
            Self::Config | Self::Pose if a.get(0).as_int().is_none() => Ok(Fields::of(a.get(0))?.into_value()),
            Self::Config => config(a),
            Self::Pose => pose(a),
            Self::JointPositions => joint_positions(sim, a),
            Self::Position => position(sim, a),
            Self::Line => line(sim, a),
        }
    }

    /// Return values of the call, in the order of its call tip, taken from `data`, the map that the last `…_step` has
    /// given.
    #[must_use]
    pub fn results(self, data: &Value) -> Vec<Value> {
        let Ok(fields) = Fields::of(data) else { return vec![data.clone()] };
        let get = |name: &str| fields.get(name).clone();
        let is_old = fields.has("legacyFunc");
        match self {
            Self::Config if is_old => vec![get("pos"), get("vel"), get("accel"), get("timeLeft")],
            Self::Pose if is_old => vec![get("matrix"), get("timeLeft")],
            Self::Config | Self::Pose => vec![data.clone()],
            Self::JointPositions => vec![Value::Int(1), get("pos"), get("vel"), get("accel"), get("timeLeft")],
            Self::Line => vec![Value::Int(1), get("timeLeft")],
            Self::Position => {
                let numbers = fields.get("pose").as_reals().unwrap_or_default();
                let part =
                    |from: usize, to: usize| Value::reals(numbers.get(from..to).unwrap_or_default().iter().copied());
                vec![Value::Int(1), part(0, 3), part(3, 7), get("vel"), get("accel"), get("timeLeft")]
            }
        }
    }

    /// Arguments of the callback after a step, taken from `data`, the map that `…_step` has given: the map itself, or,
    /// for callbacks from before CoppeliaSim 4.7, position (or pose, or matrix), velocity, acceleration and, if they
    /// were given, the caller's data.
    #[must_use]
    pub fn callback_arguments(data: &Value) -> Vec<Value> {
        let Ok(fields) = Fields::of(data) else { return vec![data.clone()] };
        if !fields.has("legacyFunc") {
            return vec![data.clone()];
        }
        let get = |name: &str| fields.get(name).clone();
        let place = match (fields.has("targetMatrix"), fields.has("useMatrices")) {
            (true, true) => get("matrix"),
            (true, false) => get("pose"),
            (false, _) => get("pos"),
        };
        // callbacks of clients have three parameters unless data are given
        let data = Some(get("auxData")).filter(|data| *data != Value::Nil);
        [place, get("vel"), get("accel")].into_iter().chain(data).collect()
    }
}

/// Acceleration over velocity `[1/s]`, and jerk over acceleration, that count as none at all.
const AT_ONCE: f64 = 1e4;

/// The first numbers of a list, and the rest.
fn split(a: Arguments<'_>, k: usize, n: usize) -> Result<(Vec<f64>, Vec<f64>), ApiError> {
    let list = a.get(k).as_reals().filter(|list| list.len() >= n);
    let mut list = list.ok_or_else(|| ApiError(format!("argument {} is no list of at least {n} numbers", k + 1)))?;
    let rest = list.split_off(n);
    Ok((list, rest))
}

/// Flags, largest velocities, accelerations and jerks of the older forms: lowest ones stand behind the largest if the
/// flags say so.
fn limits(fields: &mut Fields, a: Arguments<'_>, (flags, first): (i64, usize), n: usize) -> Result<(), ApiError> {
    let (v, low_v) = split(a, first, n)?;
    let (acceleration, low_a) = split(a, first + 1, n)?;
    let (jerk, _) = split(a, first + 2, n)?;
    let has = |bit: i64| flags >= 0 && flags & bit != 0;
    fields.set_list("maxVel", v);
    fields.set_list("maxAccel", acceleration);
    fields.set_list("maxJerk", jerk);
    if has(MIN_VELOCITY) {
        fields.set_list("minVel", low_v);
    }
    if has(MIN_ACCELERATION) {
        fields.set_list("minAccel", low_a);
    }
    fields.set("flags", flags);
    fields.set("tolerantArgs", true);
    Ok(())
}

fn copy(fields: &mut Fields, a: Arguments<'_>, list: &[(&str, usize)]) {
    for (name, k) in list {
        if a.has(*k) {
            fields.set(name, a.get(*k).clone());
        }
    }
}

/// (flags, pos, vel, accel, maxVel, maxAccel, maxJerk, targetPos, targetVel, callback, auxData, cyclicJoints, timeStep)
fn config(a: Arguments<'_>) -> Result<Value, ApiError> {
    let mut fields = Fields::default();
    let n = a.get(1).as_reals().map(|list| list.len());
    let n = n.ok_or_else(|| ApiError::new("argument 2 is no list of numbers: the present positions"))?;
    limits(&mut fields, a, (a.int(0)?, 4), n)?;
    let rest = [("pos", 1), ("vel", 2), ("accel", 3), ("targetPos", 7), ("targetVel", 8)];
    copy(&mut fields, a, &rest);
    copy(&mut fields, a, &[("callback", 9), ("auxData", 10), ("cyclicJoints", 11), ("timeStep", 12)]);
    fields.set("legacyFunc", true);
    Ok(fields.into_value())
}

/// (flags, pose, maxVel, maxAccel, maxJerk, targetPose, callback, auxData, metric, timeStep); poses may be matrices.
fn pose(a: Arguments<'_>) -> Result<Value, ApiError> {
    let mut fields = Fields::default();
    let n = if a.has(8) { 1 } else { 4 };
    limits(&mut fields, a, (a.int(0)?, 2), n)?;
    for (name, k) in [("pose", 1), ("targetPose", 5)] {
        match a.get(k).as_reals().map(|list| list.len()) {
            Some(12) => {
                let numbers = a.reals::<12>(k)?;
                fields.set_list(name, numbers_of_pose(&pose_of_matrix(&numbers)));
                if k == 1 {
                    fields.set("useMatrices", true);
                }
            }
            _ => fields.set_list(name, a.reals::<7>(k)?),
        }
    }
    copy(&mut fields, a, &[("callback", 6), ("auxData", 7), ("metric", 8), ("timeStep", 9)]);
    fields.set("legacyFunc", true);
    Ok(fields.into_value())
}

/// (joints, flags, vel, accel, maxVel, maxAccel, maxJerk, targetPos, targetVel, direction)
fn joint_positions(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Result<Value, ApiError> {
    let mut fields = Fields::default();
    let Value::List(joints) = a.get(0) else {
        return Err(ApiError(format!("argument 1 is {}, expected a list of joints", a.get(0).word())));
    };
    let n = joints.len();
    limits(&mut fields, a, (a.int(1)?, 4), n)?;
    copy(&mut fields, a, &[("joints", 0), ("vel", 2), ("accel", 3), ("targetVel", 8)]);
    let (mut target, _) = split(a, 7, n)?;
    let direction = if a.has(9) { split(a, 9, n)?.0 } else { vec![0.0; n] };
    for (k, joint) in joints.iter().enumerate() {
        let raw = joint.as_int().and_then(|h| i32::try_from(h).ok());
        let raw = raw.ok_or_else(|| ApiError(format!("argument 1 has {}, expected joints", joint.word())))?;
        let handle = super::plain(sim, raw)?;
        if sim.joint_interval(handle)?.0 {
            target[k] = turned(target[k], sim.joint_position(handle)?, direction[k]);
        }
    }
    fields.set_list("targetPos", target);
    Ok(fields.into_value())
}

/// The way that a joint without end takes: 0 the shortest, a positive number forwards, a negative one backwards, with
/// as many more turns as it is beyond one.
fn turned(target: f64, from: f64, direction: f64) -> f64 {
    use std::f64::consts::{PI, TAU};
    let turns = (target - from) / TAU;
    let ahead = TAU * (turns - turns.floor());
    if !(turns.is_finite() && direction.is_finite()) {
        return target;
    }
    let more = TAU * (direction.abs() - 1.0).max(0.0).floor();
    from + match direction {
        d if d > 0.0 => ahead + more,
        d if d < 0.0 => ahead - TAU - more,
        _ if ahead > PI => ahead - TAU,
        _ => ahead,
    }
}

/// Pose of the object of argument 1 in that of argument 2.
fn present(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Result<[f64; 7], ApiError> {
    let object = super::handle(sim, a, 0)?;
    let against = match a.handle(1)? {
        -1 => Reference::World,
        -11 => Reference::Parent,
        other => Reference::Object(super::plain(sim, other)?),
    };
    Ok(numbers_of_pose(&sim.pose(object, against)?))
}

/// (object, relativeTo, position, eulerAngles, velocity, acceleration): what is nil stays as it is. A turn by 1 rad
/// takes as long as a way of 0.1 m; without an acceleration, or with 0, the velocity is reached at once.
fn line(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Result<Value, ApiError> {
    let mut fields = Fields::default();
    copy(&mut fields, a, &[("object", 0), ("relObject", 1)]);
    let mut seven = present(sim, a)?;
    if a.has(2) {
        seven[..3].copy_from_slice(&a.reals::<3>(2)?);
    }
    if a.has(3) {
        seven[3..].copy_from_slice(&quaternion_of(&rotation_of_euler(a.reals::<3>(3)?)));
    }
    if a.has(6) {
        return Err(ApiError::new(
            "argument 7, corrections of distance and orientation, is not offered: leave it away",
        ));
    }
    let velocity = a.real(4)?;
    let acceleration = if a.has(5) && a.real(5)? != 0.0 { a.real(5)? } else { AT_ONCE * velocity };
    fields.set_list("targetPose", seven);
    fields.set_list("maxVel", [velocity]);
    fields.set_list("maxAccel", [acceleration]);
    fields.set_list("maxJerk", [AT_ONCE * acceleration]);
    fields.set_list("metric", [1.0, 1.0, 1.0, 0.1]);
    Ok(fields.into_value())
}

/// (object, relativeTo, flags, vel, accel, maxVel, maxAccel, maxJerk, position, quaternion, targetVel)
fn position(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Result<Value, ApiError> {
    let mut fields = Fields::default();
    limits(&mut fields, a, (a.int(2)?, 5), 4)?;
    copy(&mut fields, a, &[("object", 0), ("relObject", 1), ("vel", 3), ("accel", 4), ("targetVel", 10)]);
    let mut seven = present(sim, a)?;
    if a.has(8) {
        seven[..3].copy_from_slice(&a.reals::<3>(8)?);
    }
    if a.has(9) {
        seven[3..].copy_from_slice(&a.reals::<4>(9)?);
    }
    fields.set_list("targetPose", seven);
    Ok(fields.into_value())
}
