//! Functions: motions of joints and objects within limits, step by step: `sim.moveToConfig_init`, `_step`, `_cleanup`,
//! the same of poses.
//!
//! `sim.moveToConfig` and `sim.moveToPose` themselves wait for the simulation between steps: adapters make them of
//! these ([`Move`]). A motion is a map: what was given, where it is, and the handle of what moves (`ruckigObj`).

use sincro_dynamics::spatial::{Pose, Quat, Vec3};

use super::motions::{MIN_ACCELERATION, MIN_VELOCITY, synchronization};
use super::{Function, Outcome, done, plain};
use crate::api::convention::{matrix_of, numbers_of_pose, pose_of_matrix, pose_of_numbers, rotation_vector};
use crate::api::ik::Element;
use crate::api::{ApiError, Arguments, Handle, Motion, Reference, SimApi, Value};
use sincro_motion::{Axis, Goal, Limits, Point};
use sincro_values::fields::Fields;

pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "moveToConfig_init",
        tip: "map motionObject=sim.moveToConfig_init(map params)",
        run: |d, a| begin_config(d, Fields::of(a.get(0))?),
    },
    Function {
        name: "moveToConfig_step",
        tip: "int res,map data=sim.moveToConfig_step(map motionObject)",
        run: |d, a| step_config(d, Fields::of(a.get(0))?, a.bool_or(1, false)?),
    },
    Function { name: "moveToConfig_cleanup", tip: "sim.moveToConfig_cleanup(map motionObject)", run: end },
    Function {
        name: "moveToPose_init",
        tip: "map motionObject=sim.moveToPose_init(map params)",
        run: |d, a| begin_pose(d, Fields::of(a.get(0))?),
    },
    Function {
        name: "moveToPose_step",
        tip: "int res,map data=sim.moveToPose_step(map motionObject)",
        run: |d, a| step_pose(d, Fields::of(a.get(0))?, a.bool_or(1, false)?),
    },
    Function { name: "moveToPose_cleanup", tip: "sim.moveToPose_cleanup(map motionObject)", run: end },
];

/// Limits that mean none.
const FREE: [f64; 3] = [9_999.0, 99_999.0, 9_999_999.0];
/// Below this share of half a turn two orientations are the same on the way.
const SAME: f64 = 1e-5 * std::f64::consts::PI;
/// Distances below this are none.
const NEAR: f64 = 1e-6;

/// Axes of a motion from its fields, with their defaults; these are set.
fn axes(fields: &mut Fields, from: &[f64], to: &[f64]) -> Result<Motion, ApiError> {
    let n = from.len();
    let most: Vec<Vec<f64>> = ["maxVel", "maxAccel", "maxJerk"]
        .into_iter()
        .zip(FREE)
        .map(|(name, free)| fields.each(name, n, || vec![free; n]))
        .collect::<Result<_, _>>()?;
    let negative = |list: &[f64]| list.iter().map(|x| -x).collect::<Vec<f64>>();
    let low_v = fields.each("minVel", n, || negative(&most[0]))?;
    let low_a = fields.each("minAccel", n, || negative(&most[1]))?;
    let zero = || vec![0.0; n];
    let (v, a) = (fields.each("vel", n, zero)?, fields.each("accel", n, zero)?);
    let v_end = fields.each("targetVel", n, zero)?;
    let flags = fields.int_or("flags", -1)?;
    let flags = if flags < 0 { 0 } else { flags };
    let step = fields.real_or("timeStep", 0.0)?;
    if !(step.is_finite() && step >= 0.0) {
        return Err(ApiError(format!("`timeStep` is {step} s, expected 0 (a step of the simulation) or more")));
    }
    let all: Vec<Axis> = (0..n)
        .map(|k| Axis {
            start: Point { p: from[k], v: v[k], a: a[k] },
            limits: Limits {
                max_velocity: most[0][k],
                min_velocity: low_v[k],
                max_acceleration: most[1][k],
                min_acceleration: low_a[k],
                max_jerk: most[2][k],
            },
            goal: Goal::Position(to[k], v_end[k]),
        })
        .collect();
    let motion = Motion::new(&all, synchronization(flags))?;
    let [max_v, max_a, max_j] = <[Vec<f64>; 3]>::try_from(most).expect("three lists were made");
    for (name, list) in [
        ("maxVel", max_v),
        ("maxAccel", max_a),
        ("maxJerk", max_j),
        ("minVel", low_v),
        ("minAccel", low_a),
        ("vel", v),
        ("accel", a),
        ("targetVel", v_end),
    ] {
        fields.set_list(name, list);
    }
    fields.set("flags", flags | MIN_VELOCITY | MIN_ACCELERATION);
    fields.set("timeStep", step);
    fields.set("timeLeft", 0.0);
    Ok(motion)
}

/// Handles of a field that is a list of them, each of a joint with one coordinate.
fn joints(sim: &SimApi<'_>, fields: &Fields) -> Result<Vec<Handle>, ApiError> {
    let Value::List(list) = fields.get("joints") else {
        return Err(ApiError(format!("`joints` is {}, expected a list of handles", fields.get("joints").word())));
    };
    let handle = |value: &Value| {
        let raw = value.as_int().and_then(|n| i32::try_from(n).ok());
        let raw = raw.ok_or_else(|| ApiError(format!("`joints` has {}, expected handles", value.word())))?;
        Ok(sim.registry.joint(plain(sim, raw)?)?.handle)
    };
    list.iter().map(handle).collect()
}

fn begin_config(sim: &mut SimApi<'_>, mut fields: Fields) -> Outcome {
    let own = if fields.has("joints") { Some(joints(sim, &fields)?) } else { None };
    let n = match (&own, fields.get("pos")) {
        (Some(joints), _) => joints.len(),
        (None, Value::List(list)) => list.len(),
        (None, Value::Nil) => return Err(ApiError::new("either `joints` or `pos` is needed")),
        (None, other) => return Err(ApiError(format!("`pos` is {}, expected a list of numbers", other.word()))),
    };
    if n == 0 {
        return Err(ApiError::new("nothing is to be moved: `joints` or `pos` is an empty list"));
    }
    let pos = match (&own, fields.has("pos")) {
        (Some(joints), false) => joints.iter().map(|h| sim.joint_position(*h)).collect::<Result<Vec<f64>, _>>()?,
        _ => fields.numbers("pos", n)?,
    };
    let mut target = fields.numbers("targetPos", n)?;
    if let Value::List(cyclic) = fields.get("cyclicJoints") {
        for (k, is_cyclic) in cyclic.iter().enumerate().take(n) {
            if is_cyclic.as_bool() == Some(true) {
                target[k] = nearest_turn(target[k], pos[k]);
            }
        }
    }
    let motion = axes(&mut fields, &pos, &target)?;
    fields.set_list("pos", pos);
    fields.set_list("targetPos", target);
    fields.set("ruckigObj", sim.registry.motions.add(motion)?);
    Ok(vec![fields.into_value()])
}

/// The angle, or one that is whole turns from it, that is nearest to another; half a turn forwards rather than
/// backwards.
fn nearest_turn(angle: f64, to: f64) -> f64 {
    use std::f64::consts::{PI, TAU};
    if !(angle.is_finite() && to.is_finite()) {
        return angle;
    }
    angle - TAU * ((angle - to - PI) / TAU).ceil()
}

/// Advances the motion of a map; gives true if it has ended, and the axes.
fn go_on(sim: &mut SimApi<'_>, fields: &mut Fields) -> Result<(bool, Vec<Point>), ApiError> {
    let step = fields.real_or("timeStep", 0.0)?;
    let step = if step == 0.0 { sim.registry.sample_time() } else { step };
    let stepped = sim.registry.motions.step(fields.int("ruckigObj")?, step)?;
    if !stepped.is_done {
        fields.set("timeLeft", step - stepped.left);
    }
    fields.set_list("vel", stepped.points.iter().map(|x| x.v));
    fields.set_list("accel", stepped.points.iter().map(|x| x.a));
    Ok((stepped.is_done, stepped.points))
}

/// The next step; joints are commanded unless there is a callback.
fn step_config(sim: &mut SimApi<'_>, mut fields: Fields, is_told: bool) -> Outcome {
    let own = if fields.has("joints") { joints(sim, &fields)? } else { Vec::new() };
    let (is_done, points) = go_on(sim, &mut fields)?;
    fields.set_list("pos", points.iter().map(|x| x.p));
    if !is_told {
        own.iter().zip(&points).try_for_each(|(joint, x)| put(sim, *joint, x.p))?;
    }
    Ok(vec![Value::Int(is_done.into()), fields.into_value()])
}

/// Sets the position of a joint; a cyclic one stays within its present turn.
fn put(sim: &mut SimApi<'_>, joint: Handle, position: f64) -> Result<(), ApiError> {
    let is_cyclic = sim.joint_interval(joint)?.0;
    let now = sim.world.state.q[sim.registry.joint(joint)?.q_idx];
    sim.apply(joint, if is_cyclic { nearest_turn(position, now) } else { position })
}

/// Seven numbers of a field.
fn pose(fields: &Fields, name: &str) -> Result<Pose<f64>, ApiError> {
    let numbers = <[f64; 7]>::try_from(fields.numbers(name, 7)?).expect("seven were asked for");
    if let Some(x) = numbers.iter().find(|x| !x.is_finite()) {
        return Err(ApiError(format!("`{name}` has {x}, expected finite numbers")));
    }
    pose_of_numbers(numbers).ok_or_else(|| ApiError(format!("`{name}` has a quaternion without direction")))
}

/// Reference frame of the pose of an object.
fn against(sim: &SimApi<'_>, fields: &Fields) -> Result<Reference, ApiError> {
    Ok(match fields.int_or("relObject", -1)? {
        -1 => Reference::World,
        -11 => Reference::Parent,
        _ => Reference::Object(plain(sim, fields.handle("relObject")?)?),
    })
}

fn begin_pose(sim: &mut SimApi<'_>, mut fields: Fields) -> Outcome {
    let mut chain = None;
    let from = if fields.has("pose") {
        fields.set("object", Value::Nil);
        fields.set("ik", Value::Nil);
        pose(&fields, "pose")?
    } else if fields.has("object") {
        fields.set("ik", Value::Nil);
        let object = plain(sim, fields.handle("object")?)?;
        sim.pose(object, against(sim, &fields)?)?
    } else if fields.has("ik") {
        let ik = Chain::of(sim, &Fields::of(fields.get("ik"))?)?;
        let at = sim.pose(ik.element.tip, Reference::World)?;
        chain = Some(ik);
        at
    } else {
        return Err(ApiError::new("one of `object`, `pose` and `ik` is needed"));
    };
    let to = pose(&fields, "targetPose")?;
    let turn = rotation_vector(&from.rot.transpose().mul(&to.rot));
    let (way, angle) = (to.pos - from.pos, turn.norm());
    let motion = if fields.has("metric") {
        let metric = fields.numbers("metric", 4)?;
        if let Some(x) = metric.iter().find(|x| !(x.is_finite() && **x >= 0.0)) {
            return Err(ApiError(format!("`metric` has {x}, expected numbers that are not negative")));
        }
        let parts = [way[0], way[1], way[2], angle];
        let distance = parts.iter().zip(&metric).map(|(x, m)| (x * m) * (x * m)).sum::<f64>().sqrt();
        fields.set("dist", distance);
        let motion = axes(&mut fields, &[0.0], &[distance])?;
        (distance > NEAR).then_some(motion)
    } else {
        fields.set("dist", 1.0);
        Some(axes(&mut fields, &[0.0; 4], &[way[0], way[1], way[2], angle])?)
    };
    let motion = motion.map(|motion| sim.registry.motions.add(motion)).transpose()?;
    if let Some(chain) = chain {
        let entered = chain.enter(sim).inspect_err(|_| {
            let _ = motion.map(|motion| sim.registry.motions.remove(motion));
        });
        fields.set("ik", entered?);
        fields.set("object", chain.element.target);
        fields.set("relObject", -1_i64);
    }
    fields.set("angle", angle);
    fields.set_list("startMatrix", matrix_of(&from));
    fields.set_list("targetMatrix", matrix_of(&to));
    place(&mut fields, &from);
    fields.set("ruckigObj", motion.map_or(Value::Nil, Value::Int));
    Ok(vec![fields.into_value()])
}

fn place(fields: &mut Fields, pose: &Pose<f64>) {
    fields.set_list("matrix", matrix_of(pose));
    fields.set_list("pose", numbers_of_pose(pose));
}

fn matrix(fields: &Fields, name: &str) -> Result<Pose<f64>, ApiError> {
    Ok(pose_of_matrix(&<[f64; 12]>::try_from(fields.numbers(name, 12)?).expect("twelve were asked for")))
}

/// The next step; the object is moved unless there is a callback.
fn step_pose(sim: &mut SimApi<'_>, mut fields: Fields, is_told: bool) -> Outcome {
    if !fields.has("ruckigObj") {
        return Ok(vec![Value::Int(1), fields.into_value()]);
    }
    let (from, to) = (matrix(&fields, "startMatrix")?, matrix(&fields, "targetMatrix")?);
    let turn = rotation_vector(&from.rot.transpose().mul(&to.rot));
    let (is_done, points) = go_on(sim, &mut fields)?;
    let between = |share: f64| from.rot.mul(&Quat::exp(turn.scale(share)).matrix());
    let at = match points[..] {
        // there, exactly
        _ if is_done && points.iter().all(|x| x.v == 0.0) => to,
        [x] => {
            let share = x.p / fields.real_or("dist", 1.0)?;
            Pose { rot: between(share), pos: from.pos + (to.pos - from.pos).scale(share) }
        }
        [x, y, z, angle] => {
            let share = if turn.norm() > SAME { angle.p / turn.norm() } else { 0.0 };
            Pose { rot: between(share), pos: from.pos + Vec3([x.p, y.p, z.p]) }
        }
        _ => return Err(ApiError::new("`ruckigObj` is the motion of something else")),
    };
    place(&mut fields, &at);
    if !is_told {
        if fields.has("object") {
            let object = plain(sim, fields.handle("object")?)?;
            sim.set_pose(object, &at, against(sim, &fields)?)?;
        }
        if fields.has("ik") {
            follow(sim, &Fields::of(fields.get("ik"))?)?;
        }
    }
    Ok(vec![Value::Int(is_done.into()), fields.into_value()])
}

/// A chain of joints that brings its tip to what is moved.
struct Chain {
    element: Element,
    method: i64,
    damping: f64,
    iterations: i64,
    fields: Fields,
}

impl Chain {
    fn of(sim: &SimApi<'_>, fields: &Fields) -> Result<Self, ApiError> {
        if fields.has("joints") {
            return Err(ApiError::new("`ik.joints` is not offered: all joints between base and tip move"));
        }
        let base = match fields.int_or("base", -1)? {
            -1 => None,
            _ => Some(plain(sim, fields.handle("base")?)?),
        };
        let precision = match fields.has("precision") {
            true => <[f64; 2]>::try_from(fields.numbers("precision", 2)?).expect("two were asked for"),
            false => [0.001, 0.5 * std::f64::consts::PI / 180.0],
        };
        let (tip, target) = (plain(sim, fields.handle("tip")?)?, plain(sim, fields.handle("target")?)?);
        let element = Element { precision, ..Element::new(base, tip, target, fields.int_or("constraints", 31)?) };
        let (method, damping) = (fields.int_or("method", 1)?, fields.real_or("damping", 0.02)?);
        Ok(Self { element, method, damping, iterations: fields.int_or("iterations", 20)?, fields: fields.clone() })
    }

    /// Makes what solves it; the target begins at the tip.
    fn enter(&self, sim: &mut SimApi<'_>) -> Result<Value, ApiError> {
        let environment = sim.create_environment()? as i64;
        self.fill(sim, environment).inspect_err(|_| {
            let _ = sim.erase_environment(environment);
        })
    }

    fn fill(&self, sim: &mut SimApi<'_>, environment: i64) -> Result<Value, ApiError> {
        let group = sim.create_group(environment, "")? as i64;
        let damping = if self.method == 1 { self.damping } else { 0.0 };
        sim.set_calculation(environment, group, damping, self.iterations)?;
        sim.add_element(environment, group, self.element.clone())?;
        let tip = sim.pose(self.element.tip, Reference::World)?;
        sim.set_pose(self.element.target, &tip, Reference::World)?;
        let mut fields = self.fields.clone();
        fields.set("ikEnv", environment);
        fields.set("ikGroup", group);
        Ok(fields.into_value())
    }
}

fn follow(sim: &mut SimApi<'_>, ik: &Fields) -> Result<(), ApiError> {
    let allowed = ik.bool_or("allowError", false)?;
    let Some(outcome) = sim.handle_group(ik.int("ikEnv")?, ik.int("ikGroup")?, (true, allowed))? else {
        return Err(ApiError::new("the group of inverse kinematics is not enabled"));
    };
    let tolerance = if outcome.is_reached { 0 } else { super::ik::NOT_WITHIN_TOLERANCE };
    let flags = tolerance | if outcome.hit_limit { super::ik::LIMIT_HIT } else { 0 };
    let breaking = flags & ik.int_or("breakFlags", 0)?;
    if breaking == 0 { Ok(()) } else { Err(ApiError(format!("simIK.handleGroup returned flags {flags}"))) }
}

/// Forgets what moves.
fn end(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let fields = Fields::of(a.get(0))?;
    if fields.has("ik") {
        let ik = Fields::of(fields.get("ik"))?;
        if ik.has("ikEnv") {
            sim.erase_environment(ik.int("ikEnv")?)?;
        }
    }
    if fields.has("ruckigObj") {
        sim.registry.motions.remove(fields.int("ruckigObj")?)?;
    }
    done()
}
