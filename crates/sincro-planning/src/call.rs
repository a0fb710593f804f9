//! The functions of `simOMPL`.

use sincro_values::{ApiError, Arguments, Handle, Value};

use crate::calculations::Calculations;
use crate::goal::descend;
use crate::planner::MAX_POINTS;
use crate::task::{Component, Region, Task, Tasks, checks_in, limit};

/// `sim.handle_all`
const ALL: i32 = -2;
/// States that a pair of dummies gives at most.
const MAX_GOALS: usize = 5;
/// Seed of the states from which goals are searched for.
const SEED: u64 = 0xd1b5_4a32_d192_ed03;

/// Scene in which paths are planned.
pub trait Scene {
    /// Tasks of clients and scripts.
    fn tasks(&mut self) -> &mut Tasks;
    /// Collision and distance objects of clients and scripts.
    fn calculations(&mut self) -> &mut Calculations;
    /// Objects of two of [`Scene::collider`] that meet or press on each other, none if none do.
    ///
    /// # Errors
    ///
    /// One of them is gone, or has no shape.
    fn touching(&mut self, pair: [Handle; 2]) -> Result<Option<[Handle; 2]>, ApiError>;
    /// Smallest distance of two of [`Scene::collider`] `[m]`, none if there is nothing to measure.
    ///
    /// # Errors
    ///
    /// One of them is gone, or has no shape and is no point.
    fn distance_between(&mut self, pair: [Handle; 2]) -> Result<Option<f64>, ApiError>;
    /// Finds an object; with `is_joint` one with a position.
    ///
    /// # Errors
    ///
    /// There is none.
    fn object(&mut self, handle: i32, is_joint: bool) -> Result<Handle, ApiError>;
    /// Finds an object or collection that can meet others, or −2.
    ///
    /// # Errors
    ///
    /// There is none.
    fn collider(&self, handle: i32) -> Result<Handle, ApiError>;
    /// Numbers of a component where the scene is `[m]`, `[rad]`.
    ///
    /// # Errors
    ///
    /// Its object is gone.
    fn read(&mut self, component: &Component) -> Result<Vec<f64>, ApiError>;
    /// Puts the object of a component somewhere.
    ///
    /// # Errors
    ///
    /// It is gone, or cannot be put there.
    fn write(&mut self, component: &Component, numbers: &[f64]) -> Result<(), ApiError>;
    /// Acts with the scene as a trial, which leaves no trace.
    ///
    /// # Errors
    ///
    /// Those of `act`.
    fn trial<T>(&mut self, act: impl FnOnce(&mut Self) -> Result<T, ApiError>) -> Result<T, ApiError>;
    /// Puts all objects where a state says, within a trial.
    ///
    /// # Errors
    ///
    /// One of them is gone.
    fn attempt(&mut self, components: &[Component], state: &[f64]) -> Result<(), ApiError>;
    /// Returns true if two of [`Scene::collider`] meet.
    ///
    /// # Errors
    ///
    /// One of them is gone.
    fn meets(&mut self, pair: [Handle; 2]) -> Result<bool, ApiError>;
    /// Offset of a goal from the object of the robot `[m]` and the angle between them `[rad]`.
    ///
    /// # Errors
    ///
    /// One of them is gone.
    fn gap(&mut self, region: &Region) -> Result<[f64; 4], ApiError>;
    /// Height of the object of a component in the frame of its numbers `[m]`.
    ///
    /// # Errors
    ///
    /// It is gone.
    fn height(&mut self, component: &Component) -> Result<f64, ApiError>;
    /// Counts the work of checked states.
    fn spend(&mut self, checks: usize);
    /// Draws a line through points `[m]` of a width and colour (0 to 1); its handle.
    ///
    /// # Errors
    ///
    /// There are too many drawings, or the numbers make no sense.
    fn draw(&mut self, points: &[[f64; 3]], width: f64, color: [f64; 3]) -> Result<i64, ApiError>;
    /// Removes a drawing.
    ///
    /// # Errors
    ///
    /// There is none.
    fn remove_drawing(&mut self, handle: i64) -> Result<(), ApiError>;
}

/// Calls a function of `simOMPL` by its name without the module.
///
/// # Errors
///
/// The arguments are not those of the function, there is no such task, or an object of it is gone.
///
/// # Panics
///
/// There is no function of that name.
pub fn call<S: Scene>(scene: &mut S, name: &str, a: Arguments<'_>) -> Result<Vec<Value>, ApiError> {
    let done = || Ok(Vec::new());
    match name {
        "createTask" => return one(scene.tasks().add(Task::new(a.text(0)?))?),
        "createStateSpace" => return create_space(scene, a),
        "destroyStateSpace" => {
            scene.tasks().component(a.int(0)?)?;
            scene.tasks().remove(a.int(0)?);
            return done();
        }
        "removeDrawingObjects" => {
            ints(a, 1)?.into_iter().try_for_each(|handle| scene.remove_drawing(handle))?;
            return done();
        }
        _ => {}
    }
    let handle = a.int(0)?;
    let task = scene.tasks().task(handle)?;
    match name {
        "destroyTask" => scene.tasks().remove(handle),
        "setVerboseLevel" => drop(a.int(1)?),
        "setStateValidityCheckingResolution" => {
            let resolution = a.real(1)?;
            if !(1e-5..=1.0).contains(&resolution) {
                return Err(ApiError(format!(
                    "a resolution of {resolution}, expected 1e-5 to 1: a share of the extent"
                )));
            }
            task.resolution = resolution;
        }
        "setStateSpace" => {
            let handles = ints(a, 1)?;
            let tasks = scene.tasks();
            let parts = handles.into_iter().map(|handle| tasks.component(handle).cloned()).collect::<Result<_, _>>()?;
            tasks.task(handle)?.set_components(parts)?;
        }
        "getStateSpaceDimension" => return one(task.space().len() as i64),
        "setAlgorithm" => task.set_algorithm(a.int(1)?)?,
        "setCollisionPairs" => {
            let pairs = collision_pairs(scene, a, 1)?;
            scene.tasks().task(handle)?.pairs = pairs;
        }
        "setStartState" => task.start = Some(task.state(reals(a, 1)?)?),
        "setGoalState" => {
            task.goals = vec![task.state(reals(a, 1)?)?];
            task.region = None;
        }
        "addGoalState" => {
            let state = task.state(reals(a, 1)?)?;
            limit(task.goals.len() + 1, "goals of a task")?;
            task.goals.push(state);
        }
        "setGoal" => set_goal(scene, handle, a)?,
        "setup" => drop(task.state(vec![0.0; task.space().len()])?),
        "solve" => {
            let seconds = if a.has(1) { a.real(1)? } else { -1.0 };
            return one(solve(scene, handle, seconds)?);
        }
        "simplifyPath" => {
            let seconds = if a.has(1) { a.real(1)? } else { -1.0 };
            with_checks(scene, handle, |task, mut check| task.simplify(checks_in(seconds), &mut check))?;
        }
        "interpolatePath" => task.interpolate(count(a, 1)?),
        "compute" => return compute(scene, handle, a),
        "hasSolution" | "hasExactSolution" => return one(!task.path.is_empty()),
        "hasApproximateSolution" => return one(false),
        "getGoalDistance" => return one(if task.path.is_empty() { -1.0 } else { 0.0 }),
        "getPath" => return Ok(vec![Value::reals(task.numbers())]),
        "readState" => {
            let task = task.clone();
            return Ok(vec![Value::reals(read(scene, &task)?)]);
        }
        "writeState" => {
            let state = task.state(reals(a, 1)?)?;
            let (components, mut at) = (task.components.clone(), 0);
            for component in &components {
                scene.write(component, &state[at..at + component.len()])?;
                at += component.len();
            }
        }
        "isStateValid" => {
            let state = task.state(reals(a, 1)?)?;
            return one(with_checks(scene, handle, |task, check| Ok(task.space().contains(&state) && check(&state)?))?);
        }
        "isStateWithinBounds" => return one(task.space().contains(&task.state(reals(a, 1)?)?)),
        "enforceBounds" => {
            let mut state = task.state(reals(a, 1)?)?;
            task.space().enforce(&mut state);
            return Ok(vec![Value::reals(state)]);
        }
        "stateDistance" => {
            let ends = [task.state(reals(a, 1)?)?, task.state(reals(a, 2)?)?];
            return one(task.space().distance(&ends[0], &ends[1]));
        }
        "getPathStateCount" => return one(states(task, a)?.len() as i64),
        "getPathState" => {
            let (all, k) = (states(task, a)?, a.int(2)?);
            let place = usize::try_from(k - 1).ok().and_then(|k| all.get(k));
            let n = all.len();
            let state =
                place.ok_or_else(|| ApiError(format!("state {k} of a path of {n}: they are counted from 1")))?;
            return Ok(vec![Value::reals(state.iter().copied())]);
        }
        "getReversedPath" => return Ok(vec![Value::reals(states(task, a)?.into_iter().rev().flatten())]),
        "drawPath" => return draw(scene, handle, a),
        "printTaskInfo" => {
            let (n, goals, pairs) = (task.space().len(), task.goals.len(), task.pairs.len());
            let text = format!("{}: {n} numbers a state, {goals} goals, {pairs} collision pairs", task.name);
            return one(Value::from(text.as_str()));
        }
        _ => unreachable!("`{name}` is no function of simOMPL"),
    }
    done()
}

fn one(value: impl Into<Value>) -> Result<Vec<Value>, ApiError> {
    Ok(vec![value.into()])
}

/// Whole numbers of a list.
fn ints(a: Arguments<'_>, k: usize) -> Result<Vec<i64>, ApiError> {
    let Value::List(list) = a.get(k) else {
        return Err(ApiError(format!("argument {} is {}, expected a list of handles", k + 1, a.get(k).word())));
    };
    let int = |value: &Value| value.as_int().ok_or_else(|| ApiError(format!("{} is no handle", value.word())));
    list.iter().map(int).collect()
}

fn handle_of(raw: i64) -> Result<i32, ApiError> {
    i32::try_from(raw).map_err(|_| ApiError(format!("{raw} is no handle")))
}

fn reals(a: Arguments<'_>, k: usize) -> Result<Vec<f64>, ApiError> {
    let wrong = || ApiError(format!("argument {} is {}, expected a list of numbers", k + 1, a.get(k).word()));
    a.get(k).as_reals().ok_or_else(wrong)
}

/// Number of states that is asked for.
fn count(a: Arguments<'_>, k: usize) -> Result<usize, ApiError> {
    let n = a.int_or(k, 0)?;
    let n = usize::try_from(n).ok().filter(|n| *n <= MAX_POINTS);
    n.ok_or_else(|| ApiError(format!("{} states of a path, expected 0 to {MAX_POINTS}", a.get(k).word())))
}

/// States of a path that is given in numbers.
fn states(task: &Task, a: Arguments<'_>) -> Result<Vec<Vec<f64>>, ApiError> {
    let (numbers, n) = (reals(a, 1)?, task.space().len());
    if n == 0 || !numbers.len().is_multiple_of(n) {
        let found = numbers.len();
        return Err(ApiError(format!(
            "a path of {found} numbers, expected a multiple of the {n} of a state of the task"
        )));
    }
    Ok(numbers.chunks(n).map(<[f64]>::to_vec).collect())
}

fn create_space<S: Scene>(scene: &mut S, a: Arguments<'_>) -> Result<Vec<Value>, ApiError> {
    let weight = if a.has(6) { a.real(6)? } else { 1.0 };
    let reference = match a.int_or(7, -1)? {
        -1 => None,
        _ => Some(scene.object(a.handle(7)?, false)?),
    };
    let bounds = (reals(a, 3)?, reals(a, 4)?);
    let mut component = Component::new((a.text(0)?, a.int(1)?), (Handle(-1), reference), bounds, weight)?;
    component.object = scene.object(a.handle(2)?, component.is_joint())?;
    one(scene.tasks().add_component(component)?)
}

/// Pairs of colliders of argument `k`, a list of handles: two of each pair.
///
/// # Errors
///
/// It is no such list, too long, or has a handle of nothing that can meet others.
pub fn collision_pairs<S: Scene>(scene: &S, a: Arguments<'_>, k: usize) -> Result<Vec<[Handle; 2]>, ApiError> {
    let list = ints(a, k)?;
    if !list.len().is_multiple_of(2) {
        return Err(ApiError(format!("{} handles of collision pairs, expected two of each pair", list.len())));
    }
    let mut pairs = Vec::new();
    for pair in list.chunks(2) {
        limit(pairs.len() + 1, "collision pairs")?;
        if pair[0] == i64::from(ALL) {
            return Err(ApiError::new("the first of a collision pair is an object or collection, not sim.handle_all"));
        }
        pairs.push([scene.collider(handle_of(pair[0])?)?, scene.collider(handle_of(pair[1])?)?]);
    }
    Ok(pairs)
}

fn set_goal<S: Scene>(scene: &mut S, handle: i64, a: Arguments<'_>) -> Result<(), ApiError> {
    let tolerance = if a.has(3) { a.real(3)? } else { 0.001 };
    let metric = if a.has(4) { a.reals::<4>(4)? } else { [1.0, 1.0, 1.0, 0.1] };
    if !(tolerance > 0.0 && tolerance.is_finite()) || metric.iter().any(|x| !(x.is_finite() && *x >= 0.0)) {
        let given = format!("a goal with the tolerance {tolerance} and the metric {metric:?}");
        return Err(ApiError(format!("{given}, expected more than 0, and weights of 0 or more")));
    }
    let mut objects = [None; 3];
    for (k, object) in [1, 2, 5].into_iter().zip(&mut objects) {
        if k < 5 || a.int_or(k, -1)? != -1 {
            *object = Some(scene.object(a.handle(k)?, false)?);
        }
    }
    let task = scene.tasks().task(handle)?;
    (task.region, task.goals) = (Some(Region { objects, tolerance, metric }), Vec::new());
    Ok(())
}

/// State in which the scene is.
fn read<S: Scene>(scene: &mut S, task: &Task) -> Result<Vec<f64>, ApiError> {
    let mut state = Vec::new();
    for component in &task.components {
        state.extend(scene.read(component)?);
    }
    task.state(state)
}

/// Acts with a task and the check of its collision pairs, the scene being a trial.
fn with_checks<S: Scene, T>(
    scene: &mut S,
    handle: i64,
    act: impl FnOnce(&mut Task, &mut dyn FnMut(&[f64]) -> Result<bool, ApiError>) -> Result<T, ApiError>,
) -> Result<T, ApiError> {
    let mut task = scene.tasks().task(handle)?.clone();
    let (components, pairs) = (task.components.clone(), task.pairs.clone());
    let done = scene.trial(|scene| {
        let mut n_met = 0;
        let result = act(&mut task, &mut |state| {
            scene.attempt(&components, state)?;
            for pair in &pairs {
                n_met += 1;
                if scene.meets(*pair)? {
                    return Ok(false);
                }
            }
            Ok(true)
        });
        scene.spend(n_met.max(task.take_checks()));
        result
    });
    *scene.tasks().task(handle)? = task;
    done
}

/// Start of a search, and goals from a pair of objects, which the task is given.
///
/// # Errors
///
/// An object is gone, or there is no goal.
pub fn ends<S: Scene>(scene: &mut S, handle: i64) -> Result<Vec<f64>, ApiError> {
    let task = scene.tasks().task(handle)?.clone();
    let start = match &task.start {
        Some(start) => start.clone(),
        None => read(scene, &task)?,
    };
    if let (Some(region), true) = (&task.region, task.goals.is_empty()) {
        let space = task.space();
        let goals = scene.trial(|scene| {
            let mut n = 0;
            let found = descend(&space, &start, (region.tolerance, MAX_GOALS, checks_in(1.0)), SEED, &mut |state| {
                n += 1;
                scene.attempt(&task.components, state)?;
                let gap = scene.gap(region)?;
                let weighted = gap.iter().zip(&region.metric).map(|(x, weight)| x * x * weight * weight);
                Ok(weighted.sum::<f64>().sqrt())
            });
            scene.spend(n);
            found
        })?;
        scene.tasks().task(handle)?.goals = goals;
    } else if task.goals.is_empty() {
        return Err(ApiError::new("the task has no goal: call simOMPL.setGoalState or setGoal before"));
    }
    Ok(start)
}

fn solve<S: Scene>(scene: &mut S, handle: i64, seconds: f64) -> Result<bool, ApiError> {
    let start = ends(scene, handle)?;
    with_checks(scene, handle, |task, mut check| task.solve(&start, checks_in(seconds), &mut check))
}

fn compute<S: Scene>(scene: &mut S, handle: i64, a: Arguments<'_>) -> Result<Vec<Value>, ApiError> {
    let n = count(a, 3)?;
    let [seconds, simplification] = [a.real(1)?, if a.has(2) { a.real(2)? } else { -1.0 }];
    if !solve(scene, handle, seconds)? {
        return Ok(vec![false.into(), Value::List(Vec::new())]);
    }
    with_checks(scene, handle, |task, mut check| task.simplify(checks_in(simplification), &mut check))?;
    let task = scene.tasks().task(handle)?;
    task.interpolate(n);
    Ok(vec![true.into(), Value::reals(task.numbers())])
}

/// Positions of the first object of a path in the frame of its component, joined by lines.
fn draw<S: Scene>(scene: &mut S, handle: i64, a: Arguments<'_>) -> Result<Vec<Value>, ApiError> {
    let task = scene.tasks().task(handle)?.clone();
    let states = states(&task, a)?;
    let width = if a.has(2) { a.real(2)? } else { 1.0 };
    let color = if a.has(3) { a.reals::<3>(3)? } else { [1.0, 0.0, 0.0] };
    let Some(first) = task.components.first().filter(|component| !component.is_joint()) else {
        return Err(ApiError::new("paths of joints are not drawn: draw the positions of the tip along the path"));
    };
    let is_flat = matches!(first.len(), 2) || first.kind == 1;
    let z = if is_flat { scene.height(first)? } else { 0.0 };
    let points: Vec<[f64; 3]> =
        states.iter().map(|state| [state[0], state[1], if is_flat { z } else { state[2] }]).collect();
    one(Value::List(vec![Value::Int(scene.draw(&points, width, color)?)]))
}
