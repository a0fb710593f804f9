//! Tasks of scenes as many worlds at once, for reinforcement learning.

use std::sync::{Mutex, PoisonError};

use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use sincro_scene::experiment::task::Space;
use sincro_scene::scene::{Camera, Object, ObjectKind};
use sincro_sim::task::{Autoreset, Step, TaskWorlds};

use crate::model::Model;
use crate::{errors, foreground};

/// Width and height of pictures [px].
const PICTURE: [usize; 2] = [480, 360];

/// Name of an action, its bounds if it has a range, its values if it has those.
type ActionSpace = (String, Option<(f64, f64)>, Option<Vec<f64>>);

/// Results of a step as arrays: observations, rewards, terminated, truncated, stopped, final observations.
type Results<'py> = (
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray1<f64>>,
    [Bound<'py, PyArray1<bool>>; 3],
    Option<Bound<'py, PyArray2<f64>>>,
);

/// Many worlds of the task of a scene; see `sincro.gym`.
#[pyclass(frozen, module = "sincro._sincro")]
pub struct Worlds {
    worlds: Mutex<TaskWorlds>,
    n: usize,
    n_observations: usize,
    n_actions: usize,
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
        Ok(Self { worlds: Mutex::new(worlds), n, n_observations, n_actions })
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
        if actions.shape() != [self.n, self.n_actions] {
            let [rows, columns] = [actions.shape()[0], actions.shape()[1]];
            let words = format!("the actions are ({rows}, {columns}), not ({}, {})", self.n, self.n_actions);
            return Err(errors::argument(py, &words));
        }
        let given: Vec<f64> = match actions.as_slice() {
            Ok(given) => given.to_vec(),
            Err(_) => actions.as_array().iter().copied().collect(),
        };
        if let Some(k) = given.iter().position(|x| !x.is_finite()) {
            let (world, action) = (k / self.n_actions, k % self.n_actions);
            let words = format!("action {action} of world {world} is {}, not a finite number", given[k]);
            return Err(errors::argument(py, &words));
        }
        let autoreset = match autoreset {
            "next-step" => Autoreset::NextStep,
            "same-step" => Autoreset::SameStep,
            _ => Autoreset::Disabled,
        };
        let (n, n_observations) = (self.n, self.n_observations);
        let step = self.worlds(py, move |worlds| {
            let mut step = Step::new(n, n_observations);
            worlds.step(&given, autoreset, &mut step);
            step
        })?;
        let has_ended = step.terminated.iter().chain(&step.truncated).any(|ended| *ended);
        let finals = (has_ended && autoreset == Autoreset::SameStep).then_some(step.final_observations);
        let flags = [step.terminated, step.truncated, step.stopped].map(|flags| PyArray1::from_vec(py, flags));
        let finals = finals.map(|finals| self.rows(py, finals)).transpose()?;
        Ok((self.rows(py, step.observations)?, PyArray1::from_vec(py, step.rewards), flags, finals))
    }
}
