//! Functions: motions of numbers within limits, step by step (`sim.ruckigPos` …; the names of the Reflexxes library,
//! `sim.rmlPos` …, are the same functions).

use super::{Function, Outcome, done, one};
use crate::api::{ApiError, Arguments, Motion, SimApi, Value};
use sincro_motion::{Axis, Goal, Limits, Point, Synchronization};

pub(super) const FUNCTIONS: &[Function] = &[
    Function {
        name: "ruckigPos",
        tip: "int handle=sim.ruckigPos(int dofs,float baseCycleTime,int flags,float[] currentPosVelAccel,float[] maxVelAccelJerk,int[] selection,float[] targetPosVel)",
        run: |d, a| make(d, a, true),
    },
    Function {
        name: "ruckigVel",
        tip: "int handle=sim.ruckigVel(int dofs,float baseCycleTime,int flags,float[] currentPosVelAccel,float[] maxAccelJerk,int[] selection,float[] targetVel)",
        run: |d, a| make(d, a, false),
    },
    Function {
        name: "ruckigStep",
        tip: "int result,float[] newPosVelAccel,float synchronizationTime=sim.ruckigStep(int handle,float cycleTime)",
        run: step,
    },
    Function { name: "ruckigRemove", tip: "sim.ruckigRemove(int handle)", run: remove },
];

/// Flags: of how axes belong together the two lowest bits.
const TIME: i64 = 1;
const NONE: i64 = 3;
/// Lowest velocities are given.
pub(super) const MIN_VELOCITY: i64 = 0x100;
/// Lowest accelerations are given.
pub(super) const MIN_ACCELERATION: i64 = 0x200;

/// Synchronization of axes; −1 means that all arrive at one time.
pub(super) fn synchronization(flags: i64) -> Synchronization {
    match flags & 3 {
        _ if flags < 0 => Synchronization::Time,
        TIME => Synchronization::Time,
        NONE => Synchronization::None,
        _ => Synchronization::Phase,
    }
}

fn counted(a: Arguments<'_>, k: usize, n: usize, what: &str) -> Result<Vec<f64>, ApiError> {
    let list = a.get(k).as_reals();
    let list = list.ok_or_else(|| ApiError(format!("argument {} is {}, expected {what}", k + 1, a.get(k).word())))?;
    if list.len() != n {
        let found = list.len();
        return Err(ApiError(format!("argument {} has {found} numbers, expected {n}: {what}", k + 1)));
    }
    Ok(list)
}

fn make(sim: &mut SimApi<'_>, a: Arguments<'_>, is_position: bool) -> Outcome {
    let (n, base, flags) = (a.int(0)?, a.real(1)?, a.int(2)?);
    let n = usize::try_from(n).ok().filter(|n| (1..=100).contains(n));
    let n = n.ok_or_else(|| ApiError::new("argument 1 is no number of degrees of freedom, expected 1 to 100"))?;
    if !(base.is_finite() && base >= 0.0) {
        return Err(ApiError(format!("argument 2, the base cycle time, is {base} s, expected 0.0001")));
    }
    let bit = |bit: i64| flags >= 0 && flags & bit != 0;
    let (has_low_v, has_low_a) = (is_position && bit(MIN_VELOCITY), bit(MIN_ACCELERATION));
    let state = counted(a, 3, 3 * n, "positions, velocities and accelerations")?;
    let kinds = usize::from(is_position) + 2 + usize::from(has_low_v) + usize::from(has_low_a);
    let what =
        if is_position { "largest velocities, accelerations and jerks" } else { "largest accelerations and jerks" };
    let what = match (has_low_v, has_low_a) {
        (false, false) => what.to_owned(),
        (true, false) => format!("{what}, lowest velocities"),
        (false, true) => format!("{what}, lowest accelerations"),
        (true, true) => format!("{what}, lowest velocities and accelerations"),
    };
    let most = counted(a, 4, kinds * n, &what)?;
    let selected = counted(a, 5, n, "a number other than 0 for each degree of freedom that is to move")?;
    let target = match is_position {
        true => counted(a, 6, 2 * n, "target positions and velocities")?,
        false => counted(a, 6, n, "target velocities")?,
    };
    let first = if is_position { 0 } else { n };
    let of = |kind: usize, k: usize| most[kind * n - first + k];
    let axes: Vec<Axis> = (0..n)
        .map(|k| {
            let velocity = if is_position { of(0, k) } else { 1.0 };
            let lows = 3 + usize::from(has_low_v);
            let limits = Limits {
                min_velocity: if has_low_v { of(3, k) } else { -velocity },
                min_acceleration: if has_low_a { of(lows, k) } else { -of(1, k) },
                ..Limits::symmetric(velocity, of(1, k), of(2, k))
            };
            let goal = match (selected[k] != 0.0, is_position) {
                (false, _) => Goal::Free,
                (true, true) => Goal::Position(target[k], target[n + k]),
                (true, false) => Goal::Velocity(target[k]),
            };
            Axis { start: Point { p: state[k], v: state[n + k], a: state[2 * n + k] }, limits, goal }
        })
        .collect();
    one(sim.registry.motions.add(Motion::new(&axes, synchronization(flags))?)?)
}

/// Positions, then velocities, then accelerations.
fn flat(points: &[Point]) -> Value {
    let all = [|x: &Point| x.p, |x: &Point| x.v, |x: &Point| x.a];
    Value::reals(all.into_iter().flat_map(|of| points.iter().map(of)))
}

fn step(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let stepped = sim.registry.motions.step(a.int(0)?, a.real(1)?)?;
    Ok(vec![Value::Int(stepped.is_done.into()), flat(&stepped.points), Value::Real(stepped.left)])
}

fn remove(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    sim.registry.motions.remove(a.int(0)?)?;
    done()
}
