//! Tasks: what a client or script has said of a problem, and its solution.

use std::collections::BTreeMap;

use sincro_values::{ApiError, Handle};

use crate::names::{ALGORITHMS, FIRST_ALGORITHM, FIRST_SPACE, SPACES};
use crate::planner::Planner;
use crate::space::{Kind, MAX_BOUND, MAX_WEIGHT, Part, Space};

/// Tasks and components that may exist at once.
const MAX_COUNT: usize = 10_000;
/// Components, collision pairs and goals of one task.
const MAX_PARTS: usize = 100;
/// Checked states for a second of the time limit of a client: a clock would make every run another one.
const CHECKS_PER_SECOND: f64 = 2_000.0;
/// Checked states of one call at least: searches of OMPL that are given a tenth of a second try thousands.
const MIN_CHECKS: f64 = 5_000.0;
/// Checked states of one call at most.
const MAX_CHECKS: f64 = 50_000.0;
/// Seconds where none are given.
const DEFAULT_SECONDS: f64 = 5.0;
/// Seed of the first search of a task.
const SEED: u64 = 0x9e37_79b9_7f4a_7c15;

/// Number of checked states that a time limit `[s]` stands for: 2,000 a second, 5,000 at least and 50,000 at most;
/// 10,000 for a limit that is not positive.
#[must_use]
pub fn checks_in(seconds: f64) -> usize {
    let seconds = if seconds > 0.0 { seconds } else { DEFAULT_SECONDS };
    (seconds * CHECKS_PER_SECOND).clamp(MIN_CHECKS, MAX_CHECKS) as usize
}

/// Part of a state space that an object of the scene has: where it is, or the position of a joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Component {
    /// Name, as it was given.
    pub name: String,
    /// Kind of `simOMPL.StateSpaceType`, counted from 0.
    pub kind: usize,
    /// Object that moves.
    pub object: Handle,
    /// Object in whose frame positions are; none: the world.
    pub reference: Option<Handle>,
    part: Part,
}

impl Component {
    /// A component with a number of `simOMPL.StateSpaceType`, its bounds `[m]` or `[rad]` and its weight
    /// (dimensionless).
    ///
    /// # Errors
    ///
    /// The kind is none, or not offered, or the bounds are not those of the kind.
    pub fn new(
        (name, kind): (&str, i64),
        (object, reference): (Handle, Option<Handle>),
        (low, high): (Vec<f64>, Vec<f64>),
        weight: f64,
    ) -> Result<Self, ApiError> {
        let place = usize::try_from(kind.saturating_sub(FIRST_SPACE)).ok().filter(|k| *k < SPACES.len());
        let place = place.ok_or_else(|| {
            ApiError(format!(
                "{kind} is no state space: simOMPL.StateSpaceType.position2d … are {FIRST_SPACE} and more"
            ))
        })?;
        let form = match SPACES[place] {
            "position2d" => Kind::Real(2),
            "pose2d" => Kind::Pose2,
            "position3d" => Kind::Real(3),
            "pose3d" => Kind::Pose3,
            "joint_position" => Kind::Real(1),
            "cyclic_joint_position" => Kind::Cyclic,
            _ => {
                let help = "take pose2d, which turns on the spot";
                return Err(ApiError(format!("the state space dubins is not offered: {help}")));
            }
        };
        let (low, high) = if form == Kind::Cyclic { (Vec::new(), Vec::new()) } else { (low, high) };
        let part = Part::new(form, low, high, weight).ok_or_else(|| {
            let bounds = "lower and upper bounds of each position, the lower ones not above, and a weight of 0 or more";
            let limits = format!("bounds within ±{MAX_BOUND:e} m or rad, weights up to {MAX_WEIGHT:e}");
            ApiError(format!("the state space {} needs {bounds}; angles have none; {limits}", SPACES[place]))
        })?;
        let name = name.chars().take(100).collect();
        Ok(Self { name, kind: place, object, reference, part })
    }

    /// Number of its numbers in a state.
    #[must_use]
    pub fn len(&self) -> usize {
        self.part.len()
    }

    /// Returns true if it has no numbers.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.part.is_empty()
    }

    /// Returns true if it is the position of a joint.
    #[must_use]
    pub fn is_joint(&self) -> bool {
        matches!(SPACES[self.kind], "joint_position" | "cyclic_joint_position")
    }
}

/// Goal that is reached where two objects are in the same place.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    /// Object of the robot, its goal, and the object whose axes the metric has, none: the world.
    pub objects: [Option<Handle>; 3],
    /// Distance that is allowed.
    pub tolerance: f64,
    /// Weights of x, y, z and of the angle between the two `[m]`, `[rad]`.
    pub metric: [f64; 4],
}

/// A problem of path planning.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Task {
    /// Name, as it was given.
    pub name: String,
    /// Parts of its states, in their order.
    pub components: Vec<Component>,
    /// Objects, collections or −2 (all) that must not meet.
    pub pairs: Vec<[Handle; 2]>,
    /// Begin of the path; none: where the scene is.
    pub start: Option<Vec<f64>>,
    /// States in which it may end.
    pub goals: Vec<Vec<f64>>,
    /// Pair of objects that says where it may end.
    pub region: Option<Region>,
    /// Number of `simOMPL.Algorithm` counted from 0, as it was set.
    pub algorithm: usize,
    /// Longest piece of a line that is not checked, as a share of the largest distance.
    pub resolution: f64,
    /// Solution; empty for none.
    pub path: Vec<Vec<f64>>,
    n_searches: u64,
    /// Effort since it was taken, in checked states.
    n_checks: usize,
}

impl Task {
    /// A task without states.
    #[must_use]
    pub fn new(name: &str) -> Self {
        Self { name: name.chars().take(100).collect(), resolution: 0.01, ..Self::default() }
    }

    /// The space of its states.
    #[must_use]
    pub fn space(&self) -> Space {
        Space::new(self.components.iter().map(|component| component.part.clone()).collect())
    }

    /// Sets the algorithm by its number.
    ///
    /// # Errors
    ///
    /// There is none of that number.
    pub fn set_algorithm(&mut self, number: i64) -> Result<(), ApiError> {
        let place = usize::try_from(number.saturating_sub(FIRST_ALGORITHM)).ok().filter(|k| *k < ALGORITHMS.len());
        self.algorithm = place.ok_or_else(|| {
            ApiError(format!("{number} is no algorithm: simOMPL.Algorithm.BiTRRT … are {FIRST_ALGORITHM} and more"))
        })?;
        Ok(())
    }

    /// Gives the task its parts; what was said of states is forgotten.
    ///
    /// # Errors
    ///
    /// They are none or too many.
    pub fn set_components(&mut self, components: Vec<Component>) -> Result<(), ApiError> {
        limit(components.len(), "components of the state space")?;
        *self = Self { components, start: None, goals: Vec::new(), path: Vec::new(), ..std::mem::take(self) };
        Ok(())
    }

    /// A state of the task from numbers, within the bounds.
    ///
    /// # Errors
    ///
    /// They are not as many as a state has, or not finite.
    pub fn state(&self, numbers: Vec<f64>) -> Result<Vec<f64>, ApiError> {
        let space = self.space();
        if space.is_empty() {
            return Err(ApiError::new("the task has no state space: call simOMPL.setStateSpace before"));
        }
        if numbers.len() != space.len() || numbers.iter().any(|x| !x.is_finite()) {
            let (n, wanted) = (numbers.len(), space.len());
            return Err(ApiError(format!("a state of {n} numbers, expected {wanted} that are finite")));
        }
        Ok(numbers)
    }

    /// Searches for a path from a start to one of the goals and keeps it; true if there is one. Each search of a task
    /// has other random numbers, the same in every run.
    ///
    /// # Errors
    ///
    /// Those of the check.
    pub fn solve<E>(
        &mut self,
        start: &[f64],
        max_checks: usize,
        check: &mut impl FnMut(&[f64]) -> Result<bool, E>,
    ) -> Result<bool, E> {
        self.n_searches += 1;
        let space = self.space();
        let mut planner = Planner::new(&space, SEED.wrapping_mul(self.n_searches), max_checks);
        planner = planner.with_resolution(self.resolution);
        let mut within = |state: &[f64]| Ok(space.contains(state) && check(state)?);
        let found = planner.connect(start, &self.goals, &mut within);
        self.n_checks += planner.n_checks();
        if self.region.is_some() {
            // the pair of objects is measured anew by the next search
            self.goals.clear();
        }
        self.path = found?.unwrap_or_default();
        Ok(!self.path.is_empty())
    }

    /// Makes the path shorter, if there is one.
    ///
    /// # Errors
    ///
    /// Those of the check.
    pub fn simplify<E>(
        &mut self,
        max_checks: usize,
        check: &mut impl FnMut(&[f64]) -> Result<bool, E>,
    ) -> Result<(), E> {
        let space = self.space();
        let mut planner = Planner::new(&space, SEED ^ self.n_searches, max_checks).with_resolution(self.resolution);
        let mut path = std::mem::take(&mut self.path);
        let done = planner.shorten(&mut path, check);
        (self.path, self.n_checks) = (path, self.n_checks + planner.n_checks());
        done
    }

    /// Puts states between those of the path: `n` in all at least, or, for 0, as many as are checked.
    pub fn interpolate(&mut self, n: usize) {
        let space = self.space();
        self.path = Planner::new(&space, 0, 0).with_resolution(self.resolution).interpolate(&self.path, n);
    }

    /// All numbers of the path, state by state.
    #[must_use]
    pub fn numbers(&self) -> Vec<f64> {
        self.path.concat()
    }

    /// Returns true if its last search has found no path.
    fn has_failed(&self) -> bool {
        self.n_searches & 0xffff_ffff > 0 && self.path.is_empty()
    }

    /// Takes the effort since the last time, in checked states.
    pub fn take_checks(&mut self) -> usize {
        std::mem::take(&mut self.n_checks)
    }
}

/// Refuses lists that are empty or too long.
pub(crate) fn limit(n: usize, what: &str) -> Result<(), ApiError> {
    if (1..=MAX_PARTS).contains(&n) { Ok(()) } else { Err(ApiError(format!("{n} {what}, expected 1 to {MAX_PARTS}"))) }
}

/// Tasks and components of state spaces by their handles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tasks {
    tasks: BTreeMap<i64, Task>,
    components: BTreeMap<i64, Component>,
    n_made: i64,
    /// Number of tasks that were removed after a search in vain.
    n_failed: u64,
}

impl Tasks {
    fn next(&mut self) -> Result<i64, ApiError> {
        if self.tasks.len() + self.components.len() >= MAX_COUNT {
            let help = "destroy some with simOMPL.destroyTask and destroyStateSpace";
            return Err(ApiError(format!("there are {MAX_COUNT} tasks and state spaces already: {help}")));
        }
        self.n_made += 1;
        Ok(self.n_made)
    }

    /// Keeps a task; its handle.
    ///
    /// # Errors
    ///
    /// There are too many.
    pub fn add(&mut self, mut task: Task) -> Result<i64, ApiError> {
        let handle = self.next()?;
        // one that is made after others have failed searches in another way
        let failed = self.tasks.values().filter(|task| task.has_failed()).count();
        task.n_searches += (self.n_failed + failed as u64) << 32;
        self.tasks.insert(handle, task);
        Ok(handle)
    }

    /// Keeps a component; its handle.
    ///
    /// # Errors
    ///
    /// There are too many.
    pub fn add_component(&mut self, component: Component) -> Result<i64, ApiError> {
        let handle = self.next()?;
        self.components.insert(handle, component);
        Ok(handle)
    }

    /// A task by its handle.
    ///
    /// # Errors
    ///
    /// There is none.
    pub fn task(&mut self, handle: i64) -> Result<&mut Task, ApiError> {
        let help = "simOMPL.createTask gives the handles";
        self.tasks.get_mut(&handle).ok_or_else(|| ApiError(format!("there is no planning task {handle}: {help}")))
    }

    /// A component by its handle.
    ///
    /// # Errors
    ///
    /// There is none.
    pub fn component(&self, handle: i64) -> Result<&Component, ApiError> {
        let help = "simOMPL.createStateSpace gives the handles";
        self.components.get(&handle).ok_or_else(|| ApiError(format!("there is no state space {handle}: {help}")))
    }

    /// Removes a task or a component; tasks have components of their own.
    pub fn remove(&mut self, handle: i64) {
        let removed = self.tasks.remove(&handle);
        self.n_failed += u64::from(removed.is_some_and(|task| task.has_failed()));
        self.components.remove(&handle);
    }
}
