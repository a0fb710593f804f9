//! Tasks of scenes as many worlds at once, for reinforcement learning.

use std::sync::{Mutex, MutexGuard, PoisonError};

use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use sincro_scene::experiment::task::Space;
use sincro_scene::scene::{Camera, Object, ObjectKind};
use sincro_sim::rollout::StepsBy;
use sincro_sim::task::{Autoreset, StepMut, TaskWorlds};

use crate::model::Model;
use crate::{errors, foreground};

/// Width and height of pictures [px].
const PICTURE: [usize; 2] = [480, 360];

/// Name of an action, its bounds if it has a range, its values if it has those.
type ActionSpace = (String, Option<(f64, f64)>, Option<Vec<f64>>);

/// Results of a step as arrays: observations, rewards, terminated and truncated; if there are any, stopped worlds and
/// final observations.
type Results<'py> = (
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray1<f64>>,
    [Bound<'py, PyArray1<bool>>; 2],
    Option<Bound<'py, PyArray1<bool>>>,
    Option<Bound<'py, PyArray2<f64>>>,
);

/// Sets of arrays that are kept for later steps: those that nobody holds by then. Two are in turns where each step
/// lets go of what the one before gave.
const MAX_KEPT: usize = 4;

/// Arrays of the results of a step.
struct Arrays {
    observations: Py<PyArray2<f64>>,
    rewards: Py<PyArray1<f64>>,
    terminated: Py<PyArray1<bool>>,
    truncated: Py<PyArray1<bool>>,
}

impl Arrays {
    fn new(py: Python<'_>, n: usize, n_observations: usize) -> Self {
        Self {
            observations: PyArray2::zeros(py, [n, n_observations], false).unbind(),
            rewards: PyArray1::zeros(py, n, false).unbind(),
            terminated: PyArray1::zeros(py, n, false).unbind(),
            truncated: PyArray1::zeros(py, n, false).unbind(),
        }
    }

    /// Returns true if nobody else holds one of the arrays, nor a view of it.
    // what replaces `get_refcnt` is unsafe, and gives the same number
    #[allow(deprecated)]
    fn are_free(&self, py: Python<'_>) -> bool {
        let counts = [
            self.observations.get_refcnt(py),
            self.rewards.get_refcnt(py),
            self.terminated.get_refcnt(py),
            self.truncated.get_refcnt(py),
        ];
        counts == [1; 4]
    }

    fn clone_ref(&self, py: Python<'_>) -> Self {
        Self {
            observations: self.observations.clone_ref(py),
            rewards: self.rewards.clone_ref(py),
            terminated: self.terminated.clone_ref(py),
            truncated: self.truncated.clone_ref(py),
        }
    }
}

/// Arrays of earlier steps, and flags and actions that are not handed out.
#[derive(Default)]
struct Spare {
    arrays: Vec<Arrays>,
    stopped: Vec<bool>,
    given: Vec<f64>,
}

impl Spare {
    /// Arrays to write to, no longer in use.
    fn arrays(&mut self, py: Python<'_>, n: usize, n_observations: usize) -> Arrays {
        if let Some(free) = self.arrays.iter().find(|arrays| arrays.are_free(py)) {
            return free.clone_ref(py);
        }
        let new = Arrays::new(py, n, n_observations);
        if self.arrays.len() == MAX_KEPT {
            self.arrays.remove(0);
        }
        self.arrays.push(new.clone_ref(py));
        new
    }
}

/// Many worlds of the task of a scene; see `sincro.gym`.
#[pyclass(frozen, module = "sincro._sincro")]
pub struct Worlds {
    worlds: Mutex<TaskWorlds>,
    spare: Mutex<Spare>,
    n: usize,
    n_observations: usize,
    n_actions: usize,
    /// Name and values of each action; none of one with a range.
    values: Vec<(String, Vec<f64>)>,
}

impl Worlds {
    fn worlds<T: Send>(&self, py: Python<'_>, act: impl FnOnce(&mut TaskWorlds) -> T + Send) -> PyResult<T> {
        foreground::contained(py, || act(&mut self.worlds.lock().unwrap_or_else(PoisonError::into_inner)))
    }

    fn rows<'py>(&self, py: Python<'py>, numbers: Vec<f64>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        PyArray1::from_vec(py, numbers).reshape([self.n, self.n_observations])
    }
}

#[pymethods]
impl Worlds {
    #[new]
    fn new(py: Python<'_>, model: &Bound<'_, Model>, n: usize, threads: usize) -> PyResult<Self> {
        if n == 0 {
            return Err(errors::argument(py, "there is at least one world"));
        }
        let loaded = model.get().loaded();
        let made = foreground::contained(py, || TaskWorlds::new(loaded, n, threads))?;
        let worlds = made.map_err(|found| errors::scene(py, &found))?;
        let (n_observations, n_actions) = (worlds.plan().n_observations(), worlds.plan().n_actions());
        let of = |action: &sincro_scene::experiment::task::Action| match &action.space {
            Space::Range(..) => (action.name.clone(), Vec::new()),
            Space::Values(values) => (action.name.clone(), values.clone()),
        };
        let values = worlds.plan().task().actions.iter().map(of).collect();
        Ok(Self { worlds: Mutex::new(worlds), spare: Mutex::default(), n, n_observations, n_actions, values })
    }

    /// Formulas of the observations.
    #[getter]
    fn observations(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        self.worlds(py, |worlds| worlds.plan().task().observations.iter().map(ToString::to_string).collect())
    }

    /// Name of each action, its bounds if it has a range, its values if it has those.
    #[getter]
    fn actions(&self, py: Python<'_>) -> PyResult<Vec<ActionSpace>> {
        self.worlds(py, |worlds| {
            let of = |action: &sincro_scene::experiment::task::Action| match &action.space {
                Space::Range(low, high) => (action.name.clone(), Some((*low, *high)), None),
                Space::Values(values) => (action.name.clone(), None, Some(values.clone())),
            };
            worlds.plan().task().actions.iter().map(of).collect()
        })
    }

    /// Time from one action to the next [s].
    #[getter]
    fn period(&self, py: Python<'_>) -> PyResult<f64> {
        self.worlds(py, |worlds| worlds.plan().period())
    }

    /// Actions in the longest episode.
    #[getter]
    fn max_actions(&self, py: Python<'_>) -> PyResult<u64> {
        self.worlds(py, |worlds| worlds.plan().task().max_actions)
    }

    /// Reason why lanes cannot advance the worlds; none if they do.
    #[getter]
    fn lanes_refused(&self, py: Python<'_>) -> PyResult<Option<String>> {
        self.worlds(py, |worlds| worlds.plan().lanes_refused().map(ToOwned::to_owned))
    }

    /// Base steps that worlds in lanes have made by themselves, because a limit of a joint or a contact might act.
    #[getter]
    fn steps_alone(&self, py: Python<'_>) -> PyResult<u64> {
        self.worlds(py, TaskWorlds::steps_alone)
    }

    /// Reason why the steps are not compiled; none if they are.
    #[getter]
    fn compilation_refused(&self, py: Python<'_>) -> PyResult<Option<String>> {
        self.worlds(py, |worlds| match worlds.steps_by() {
            StepsBy::Compiled { .. } => None,
            StepsBy::Recursions { reason } => Some(reason.clone()),
        })
    }

    /// Picture of a world by a camera of the scene (the first one unless named), (height, width, 3).
    fn picture<'py>(&self, py: Python<'py>, world: usize, camera: Option<&str>) -> PyResult<Bound<'py, PyArray3<u8>>> {
        if world >= self.n {
            return Err(errors::argument(py, &format!("there is no world {world} among {}", self.n)));
        }
        let found = self.worlds(py, |worlds| {
            let q = worlds.coordinates(world);
            let scene = worlds.plan().scene();
            let index = match camera {
                Some(name) => sincro::camera(scene, name)?,
                None => {
                    let is_camera = |object: &Object| matches!(object.kind, ObjectKind::Camera { .. });
                    scene.objects.iter().position(is_camera).ok_or_else(Vec::new)?
                }
            };
            let mut camera = Camera::of_scene(scene, index, PICTURE).ok_or_else(Vec::new)?;
            Ok(camera.render(&q).rgb().to_vec())
        })?;
        let pixels: Vec<u8> = found.map_err(|cameras: Vec<String>| {
            let words = match cameras.is_empty() {
                true => "the scene has no camera: add a [[camera]] to it".to_owned(),
                false => format!("there is no camera of that name; cameras here: {}", cameras.join(", ")),
            };
            errors::unknown(py, &words)
        })?;
        let [width, height] = PICTURE;
        PyArray1::from_vec(py, pixels).reshape([height, width, 3])
    }

    /// Begins new episodes in the worlds of the mask; returns their observations, in an array that has `before`
    /// elsewhere.
    fn reset<'py>(
        &self,
        py: Python<'py>,
        seeds: Vec<Option<u64>>,
        mask: Vec<bool>,
        before: Option<PyReadonlyArray2<'py, f64>>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        if seeds.len() != self.n || mask.len() != self.n {
            let words = format!("there are {} seeds and a mask of {} for {} worlds", seeds.len(), mask.len(), self.n);
            return Err(errors::argument(py, &words));
        }
        let mut observations = match before {
            Some(before) if before.shape() == [self.n, self.n_observations] => {
                before.as_array().iter().copied().collect()
            }
            _ => vec![0.0; self.n * self.n_observations],
        };
        let observations = self.worlds(py, move |worlds| {
            worlds.reset(&seeds, &mask, &mut observations);
            observations
        })?;
        self.rows(py, observations)
    }

    /// Steps all worlds by one action each, `(n, n_actions)`.
    fn step<'py>(
        &self,
        py: Python<'py>,
        actions: PyReadonlyArray2<'py, f64>,
        autoreset: &str,
    ) -> PyResult<Results<'py>> {
        self.check_shape(py, actions.shape())?;
        let mut given = core::mem::take(&mut self.spare().given);
        given.clear();
        match actions.as_slice() {
            Ok(all) => given.extend_from_slice(all),
            Err(_) => given.extend(actions.as_array().iter()),
        }
        // x − x is 0, or NaN where x is not finite
        if given.iter().map(|x| x + -x).sum::<f64>() != 0.0 {
            let k = given.iter().position(|x| !x.is_finite()).unwrap_or_default();
            let (world, action) = (k / self.n_actions, k % self.n_actions);
            let words = format!("action {action} of world {world} is {}, not a finite number", given[k]);
            return Err(errors::argument(py, &words));
        }
        self.step_by(py, given, autoreset)
    }

    /// Steps all worlds by one action each, `(n, n_actions)`: numbers of values, counted from 0, of actions that have
    /// them.
    fn step_chosen<'py>(
        &self,
        py: Python<'py>,
        actions: PyReadonlyArray2<'py, i64>,
        autoreset: &str,
    ) -> PyResult<Results<'py>> {
        self.check_shape(py, actions.shape())?;
        let mut given = core::mem::take(&mut self.spare().given);
        given.resize(self.n * self.n_actions, 0.0);
        let done = match actions.as_slice() {
            Ok(chosen) => self.choose(chosen, &mut given),
            Err(_) => self.choose(&actions.as_array().iter().copied().collect::<Vec<i64>>(), &mut given),
        };
        done.map_err(|words| errors::argument(py, &words))?;
        self.step_by(py, given, autoreset)
    }
}

impl Worlds {
    fn check_shape(&self, py: Python<'_>, shape: &[usize]) -> PyResult<()> {
        if shape == [self.n, self.n_actions] {
            return Ok(());
        }
        let words = format!("the actions are ({}, {}), not ({}, {})", shape[0], shape[1], self.n, self.n_actions);
        Err(errors::argument(py, &words))
    }

    /// Writes the values that are chosen by their numbers; an error names the first that is none.
    fn choose(&self, chosen: &[i64], given: &mut [f64]) -> Result<(), String> {
        for (action, (name, values)) in self.values.iter().enumerate() {
            // a negative number is a huge one without its sign
            let is_one = |index: i64| (index as u64) < values.len() as u64;
            let Some(last) = values.len().checked_sub(1) else { continue };
            let mut are_all = true;
            // all are looked at: a search that ends early is slower
            let mut choose = |to: &mut f64, index: i64| {
                are_all &= is_one(index);
                *to = values[(index as usize).min(last)];
            };
            if self.n_actions == 1 {
                given.iter_mut().zip(chosen).for_each(|(to, index)| choose(to, *index));
            } else {
                let of_action = given.iter_mut().zip(chosen).skip(action).step_by(self.n_actions);
                of_action.for_each(|(to, index)| choose(to, *index));
            }
            if !are_all {
                let mut chosen = chosen.iter().skip(action).step_by(self.n_actions);
                let index = chosen.find(|index| !is_one(**index)).copied().unwrap_or_default();
                return Err(format!("`{name}` is chosen from 0 to {last}, not {index}"));
            }
        }
        Ok(())
    }

    fn spare(&self) -> MutexGuard<'_, Spare> {
        self.spare.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn step_by<'py>(&self, py: Python<'py>, given: Vec<f64>, autoreset: &str) -> PyResult<Results<'py>> {
        let autoreset = match autoreset {
            "next-step" => Autoreset::NextStep,
            "same-step" => Autoreset::SameStep,
            _ => Autoreset::Disabled,
        };
        let (n, n_observations) = (self.n, self.n_observations);
        let (arrays, mut stopped) = {
            let mut spare = self.spare();
            (spare.arrays(py, n, n_observations), core::mem::take(&mut spare.stopped))
        };
        let Arrays { observations, rewards, terminated, truncated } = arrays;
        let (observations, rewards) = (observations.into_bound(py), rewards.into_bound(py));
        let (terminated, truncated) = (terminated.into_bound(py), truncated.into_bound(py));
        let mut finals = vec![0.0; if autoreset == Autoreset::SameStep { n * n_observations } else { 0 }];
        stopped.resize(n, false);
        let has_finals = {
            let (mut observations, mut rewards) = (observations.readwrite(), rewards.readwrite());
            let (mut terminated, mut truncated) = (terminated.readwrite(), truncated.readwrite());
            let out = StepMut {
                observations: observations.as_slice_mut()?,
                rewards: rewards.as_slice_mut()?,
                terminated: terminated.as_slice_mut()?,
                truncated: truncated.as_slice_mut()?,
                stopped: &mut stopped,
                final_observations: &mut finals,
            };
            self.worlds(py, |worlds| worlds.step_into(&given, autoreset, out))?;
            let (terminated, truncated) = (terminated.as_slice()?, truncated.as_slice()?);
            autoreset == Autoreset::SameStep && (terminated.contains(&true) || truncated.contains(&true))
        };
        let finals = has_finals.then(|| self.rows(py, finals)).transpose()?;
        // all are looked at: a search that ends early is slower
        let any_stopped = stopped.iter().fold(false, |any, stopped| any | stopped);
        let stopped_now = any_stopped.then(|| PyArray1::from_slice(py, &stopped));
        {
            let mut spare = self.spare();
            (spare.given, spare.stopped) = (given, stopped);
        }
        Ok((observations, rewards, [terminated, truncated], stopped_now, finals))
    }
}
