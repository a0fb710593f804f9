//! Several axes: each for itself, all at the same time, or all on one straight line.

use crate::fastest::{candidates, fastest};
use crate::profile::{Limits, Point, Profile};
use crate::timed::{fastest_velocity, timed, timed_velocity};

/// Synchronization of the motions of several axes, an input of [`plan`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Synchronization {
    /// All are on one straight line at every time, if start, goal and limits allow it; else as `Time`.
    Phase,
    /// All arrive at the same time.
    Time,
    /// Each arrives as soon as its own limits allow.
    None,
}

/// Goal of the motion along one axis; `u` stands for the unit of the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Goal {
    /// A position `[u]` and the velocity there [u/s].
    Position(f64, f64),
    /// A velocity [u/s], wherever that is.
    Velocity(f64),
    /// None: the axis keeps its velocity.
    Free,
}

/// One axis of a motion to be planned: start, limits and goal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    /// State of motion at the start.
    pub start: Point,
    /// Limits of the motion; those of the velocity have no meaning for `Goal::Velocity`.
    pub limits: Limits,
    /// Goal.
    pub goal: Goal,
}

/// Error of [`plan`]: the first axis whose numbers allow no motion.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlanError {
    /// Index of the axis in the slice given to [`plan`], from 0.
    pub axis: usize,
    /// Reason, with the value and what was expected.
    pub why: String,
}

/// A motion that takes longer is refused `[s]`.
const MAX_DURATION: f64 = 1e9;
/// Tolerance of two axes on one straight line, relative to the larger.
const STRAIGHT: f64 = 1e-12;
/// Relative tolerance of limits that rounding exceeds.
const ROOM: f64 = 1e-9;
/// Numbers larger than this are refused, and limits smaller than its inverse: products of some of them must be numbers
/// yet.
const LARGEST: f64 = 1e15;
/// Times that are tried for all axes together at which one of them can arrive.
const TIMES: usize = 60;
/// Times that are tried between the first possible one and nine times that, and again behind the last of those above.
const MORE_TIMES: usize = 40;

/// Plans the motions of several axes, as `sim.ruckigPos` and `sim.moveToConfig` do: one profile for each axis, in their
/// order. All of them hold their limits, arrive at their goals exactly, and have no acceleration there.
///
/// ```
/// use sincro_motion::{Axis, Goal, Limits, Point, Synchronization, plan};
/// let limits = Limits::symmetric(1.0, 3.0, 8.0);
/// let axis = Axis { start: Point::default(), limits, goal: Goal::Position(0.25, 0.0) };
/// let motion = plan(&[axis], Synchronization::Time).unwrap()[0];
/// // neither the largest velocity nor acceleration is reached: four times the cube root of 0.25/(2·8)
/// assert!((motion.duration() - 4.0 * 0.25).abs() < 1e-12);
/// assert_eq!(motion.at(motion.duration()).p, 0.25);
/// ```
///
/// # Errors
///
/// A number is not finite or beyond 10¹⁵, a limit has the wrong sign or is below 10⁻¹⁵, a target velocity is beyond the
/// limits, or the motion would take more than 10⁹ s; the error has the axis.
pub fn plan(axes: &[Axis], synchronization: Synchronization) -> Result<Vec<Profile>, PlanError> {
    for (axis, this) in axes.iter().enumerate() {
        this.check().map_err(|why| PlanError { axis, why })?;
    }
    let mut profiles: Vec<Profile> = axes.iter().map(Axis::fastest).collect();
    let longest = |profiles: &[Profile]| {
        let durations = profiles.iter().map(Profile::duration).enumerate();
        durations.fold((0, 0.0), |best: (usize, f64), next| if next.1 > best.1 { next } else { best })
    };
    let (slowest, t) = longest(&profiles);
    if !(0.0..=MAX_DURATION).contains(&t) {
        return Err(PlanError {
            axis: slowest,
            why: format!("the motion would take {t} s, more than {MAX_DURATION} s"),
        });
    }
    match synchronization {
        Synchronization::None => {}
        Synchronization::Phase => {
            profiles = straight(axes, &profiles[slowest], slowest).unwrap_or_else(|| in_time(axes, profiles, t));
        }
        Synchronization::Time => profiles = in_time(axes, profiles, t),
    }
    Ok(profiles)
}

impl Axis {
    fn check(&self) -> Result<(), String> {
        let Limits { max_velocity, min_velocity, max_acceleration, min_acceleration, max_jerk } = self.limits;
        let (p, v) = match self.goal {
            Goal::Position(p, v) => (p, v),
            Goal::Velocity(v) => (0.0, v),
            Goal::Free => (0.0, 0.0),
        };
        let finite = [
            ("position", self.start.p),
            ("velocity", self.start.v),
            ("acceleration", self.start.a),
            ("target position", p),
            ("target velocity", v),
        ];
        if let Some((name, x)) = finite.into_iter().find(|(_, x)| !x.is_finite()) {
            return Err(format!("its {name} is {x}, expected a finite number"));
        }
        if let Some((name, x)) = finite.into_iter().find(|(_, x)| x.abs() > LARGEST) {
            return Err(format!("its {name} is {x}, expected a number up to {LARGEST:e}"));
        }
        if self.goal == Goal::Free {
            return Ok(());
        }
        let is_position = matches!(self.goal, Goal::Position(..));
        let above = [
            ("largest velocity", max_velocity, is_position),
            ("largest acceleration", max_acceleration, true),
            ("largest jerk", max_jerk, true),
        ];
        let wrong = |x: f64| !(1.0 / LARGEST..=LARGEST).contains(&x);
        if let Some((name, x, _)) = above.into_iter().find(|(_, x, is_used)| *is_used && wrong(*x)) {
            return Err(format!(
                "its {name} is {x}, expected a number above 0, from {:e} to {LARGEST:e}",
                1.0 / LARGEST
            ));
        }
        let below = [("lowest velocity", min_velocity, is_position), ("lowest acceleration", min_acceleration, true)];
        if let Some((name, x, _)) = below.into_iter().find(|(_, x, is_used)| *is_used && wrong(-*x)) {
            return Err(format!(
                "its {name} is {x}, expected a number below 0, from -{LARGEST:e} to -{:e}",
                1.0 / LARGEST
            ));
        }
        if is_position && !(min_velocity..=max_velocity).contains(&v) {
            return Err(format!("its target velocity {v} is not within its limits, {min_velocity} to {max_velocity}"));
        }
        Ok(())
    }

    fn fastest(&self) -> Profile {
        match self.goal {
            Goal::Position(p, v) => fastest(self.start, (p, v), &self.limits),
            Goal::Velocity(v) => fastest_velocity(self.start, v, &self.limits),
            Goal::Free => Profile::new(self.start, super::profile::Pieces::default(), Point { a: 0.0, ..self.start }),
        }
    }

    /// In a given time, if there is a motion that takes it.
    fn timed(&self, shortest: &Profile, t: f64) -> Option<Profile> {
        match self.goal {
            Goal::Position(p, v) => {
                // once there it can stay there
                let wait = || (v == 0.0).then_some(*shortest);
                timed(self.start, (p, v), &self.limits, t).or_else(wait)
            }
            Goal::Velocity(v) => Some(timed_velocity(self.start, v, &self.limits, t)),
            Goal::Free => Some(*shortest),
        }
    }

    /// Times from which on it may be able to arrive.
    fn times(&self) -> Vec<f64> {
        match self.goal {
            Goal::Position(p, v) => {
                candidates(self.start, (p, v), &self.limits).iter().map(Profile::duration).collect()
            }
            _ => Vec::new(),
        }
    }

    /// Motion of the axis as a vector: displacement, velocity and acceleration at the start, velocity at the end.
    fn direction(&self) -> [f64; 4] {
        match self.goal {
            Goal::Position(p, v) => [p - self.start.p, self.start.v, self.start.a, v],
            Goal::Velocity(v) => [0.0, self.start.v, self.start.a, v],
            Goal::Free => [0.0; 4],
        }
    }
}

/// All axes in the least time in which each of them can arrive; if none is found, each for itself.
fn in_time(axes: &[Axis], profiles: Vec<Profile>, t: f64) -> Vec<Profile> {
    let at = |t: f64| -> Option<Vec<Profile>> {
        axes.iter().zip(&profiles).map(|(axis, shortest)| axis.timed(shortest, t)).collect()
    };
    if let Some(found) = at(t) {
        return found;
    }
    let mut times: Vec<f64> = axes.iter().flat_map(Axis::times).filter(|other| *other > t).collect();
    times.sort_by(f64::total_cmp);
    times.truncate(TIMES);
    let later = |from: f64| (1..=MORE_TIMES).map(move |k| from * (1.0 + 0.005 * (k * k) as f64));
    let last = times.last().copied().unwrap_or(t);
    times.extend(later(t));
    times.sort_by(f64::total_cmp);
    times.into_iter().chain(later(last)).find_map(at).unwrap_or(profiles)
}

/// All axes as the slowest, each by its own factor: on one straight line. None if their starts and goals are on no
/// line, or a limit would be exceeded.
fn straight(axes: &[Axis], leading: &Profile, slowest: usize) -> Option<Vec<Profile>> {
    let lead = axes[slowest].direction();
    let kind = lead.iter().position(|x| *x != 0.0)?;
    let largest: Vec<f64> =
        (0..4).map(|k| axes.iter().map(|axis| axis.direction()[k].abs()).fold(0.0, f64::max)).collect();
    let mut profiles = Vec::with_capacity(axes.len());
    for (k, axis) in axes.iter().enumerate() {
        if k == slowest || axis.goal == Goal::Free {
            profiles.push(if k == slowest { *leading } else { axis.fastest() });
            continue;
        }
        let own = axis.direction();
        let factor = own[kind] / lead[kind];
        let is_off = (0..4).any(|i| (own[i] - factor * lead[i]).abs() > STRAIGHT * largest[i]);
        if is_off {
            return None;
        }
        let pieces = leading.pieces.scaled(factor);
        let end = match axis.goal {
            Goal::Position(p, v) => Point { p, v, a: 0.0 },
            Goal::Velocity(v) => Point { p: pieces.end(axis.start).p, v, a: 0.0 },
            Goal::Free => axis.start,
        };
        let profile = Profile::new(axis.start, pieces, end);
        if !axis.allows(&profile) {
            return None;
        }
        profiles.push(profile);
    }
    Some(profiles)
}

impl Axis {
    fn allows(&self, profile: &Profile) -> bool {
        let Limits { max_velocity, min_velocity, max_acceleration, min_acceleration, max_jerk } = self.limits;
        let within = |x: f64, low: f64, high: f64| x >= low - ROOM * low.abs() && x <= high + ROOM * high.abs();
        let is_position = matches!(self.goal, Goal::Position(..));
        profile.pieces.iter().all(|piece| within(piece.jerk, -max_jerk, max_jerk))
            && profile.corners().all(|x| {
                within(x.a, min_acceleration, max_acceleration)
                    && (!is_position || within(x.v, min_velocity, max_velocity))
            })
    }
}
