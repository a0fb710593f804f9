//! Motions of numbers under way (`sim.ruckigPos`): several axes on profiles of `sincro-motion`, by their handles.

use std::collections::BTreeMap;

use sincro_motion::{Axis, PlanError, Point, Profile, Synchronization, plan};
use sincro_values::ApiError;

/// Motions that may be under way at once.
const MAX_MOTIONS: usize = 1_000;
/// Axes of one of them.
const MAX_AXES: usize = 100;
/// A motion that lacks less than this has ended `[s]`: sums of steps are no multiples of them.
const DONE: f64 = 1e-9;

/// Several axes, and the time since they began.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    profiles: Vec<Profile>,
    duration: f64,
    elapsed: f64,
}

/// Result of one step of a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionStep {
    /// True if all axes have arrived.
    pub is_done: bool,
    /// States of the axes.
    pub points: Vec<Point>,
    /// Time that is left `[s]`; negative if the last step was longer than what was left.
    pub left: f64,
}

/// Motions of numbers by their handles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Motions {
    list: BTreeMap<i64, Motion>,
    next: i64,
}

impl Motion {
    /// Plans a motion of axes.
    ///
    /// # Errors
    ///
    /// There are none or too many, or a number makes no sense.
    pub fn new(axes: &[Axis], synchronization: Synchronization) -> Result<Self, ApiError> {
        if axes.is_empty() || axes.len() > MAX_AXES {
            return Err(ApiError(format!("{} degrees of freedom, expected 1 to {MAX_AXES}", axes.len())));
        }
        let profiles = plan(axes, synchronization)
            .map_err(|PlanError { axis, why }| ApiError(format!("degree of freedom {}: {why}", axis + 1)))?;
        let duration = profiles.iter().map(Profile::duration).fold(0.0, f64::max);
        Ok(Self { profiles, duration, elapsed: 0.0 })
    }

    fn step(&mut self, dt: f64) -> MotionStep {
        self.elapsed += dt;
        let is_done = self.elapsed >= self.duration - DONE;
        let t = if is_done { self.elapsed.max(self.duration) } else { self.elapsed };
        MotionStep {
            is_done,
            points: self.profiles.iter().map(|profile| profile.at(t)).collect(),
            left: self.duration - self.elapsed,
        }
    }
}

impl Motions {
    /// Adds a motion and returns its handle.
    ///
    /// # Errors
    ///
    /// There are too many.
    pub fn add(&mut self, motion: Motion) -> Result<i64, ApiError> {
        if self.list.len() >= MAX_MOTIONS {
            return Err(ApiError(format!("there are {MAX_MOTIONS} motions already: remove some (sim.ruckigRemove)")));
        }
        let handle = self.next;
        self.next += 1;
        self.list.insert(handle, motion);
        Ok(handle)
    }

    /// Advances a motion by a time `[s]`.
    ///
    /// # Errors
    ///
    /// There is none, or the time is none.
    pub fn step(&mut self, handle: i64, dt: f64) -> Result<MotionStep, ApiError> {
        let motion = self.list.get_mut(&handle).ok_or_else(|| missing(handle))?;
        if !(dt.is_finite() && dt > 0.0) {
            return Err(ApiError(format!("the cycle time is {dt} s, expected a finite time above 0")));
        }
        Ok(motion.step(dt))
    }

    /// Forgets a motion.
    ///
    /// # Errors
    ///
    /// There is none.
    pub fn remove(&mut self, handle: i64) -> Result<(), ApiError> {
        self.list.remove(&handle).map(drop).ok_or_else(|| missing(handle))
    }
}

fn missing(handle: i64) -> ApiError {
    ApiError(format!("there is no motion with the handle {handle}"))
}
