//! Sensors of worlds in lanes: measured in all lanes together, with the errors of each world alone.

use sincro_dynamics::batch::{LaneObserver, SteppedLanes};
use sincro_dynamics::coupled::StateView;
use sincro_math::Real;

use crate::sensors::{Sensor, Sensors, Timing};
use crate::task::plan::Plan;

/// Sensors of the worlds of a bundle, with what they gave last.
#[derive(Debug)]
pub(super) struct LaneSensors {
    /// Those that the task or its diagram reads.
    list: Vec<Sensor>,
    /// Values of all sensors of the scene, of one lane after the other; those that nobody reads stay zero.
    values: Vec<f64>,
    n_values: usize,
    /// Seeds of the noise, `lane × sensor`.
    seeds: Vec<u64>,
    /// Number of the sample that is due, `lane × sensor`; scratch.
    due: Vec<Option<u64>>,
}

impl LaneSensors {
    /// None if no sensor is read.
    pub fn new(plan: &Plan, n_worlds: usize) -> Option<Self> {
        let scene = &plan.loaded.scene;
        let all = Sensors::new(scene, Timing::new(&plan.loaded.experiment));
        let n_values = all.values.len();
        let is_read = |sensor: &Sensor| plan.read_sensor_values().any(|value| sensor.values().contains(&value));
        let list: Vec<Sensor> = all.into_list().into_iter().filter(is_read).collect();
        let n = n_worlds * list.len();
        let values = vec![0.0; n_worlds * n_values];
        (!list.is_empty()).then(|| Self { list, values, n_values, seeds: vec![0; n], due: vec![None; n] })
    }

    /// Begins an episode of one world.
    pub fn begin(&mut self, lane: usize, seed: u64) {
        let n = self.list.len();
        for (of_sensor, sensor) in self.seeds[lane * n..(lane + 1) * n].iter_mut().zip(&self.list) {
            *of_sensor = sensor.seed_in(seed);
        }
        self.values_mut(lane).fill(0.0);
    }

    /// Last values of one world, in the order of the scene's sensors.
    pub fn values(&self, lane: usize) -> &[f64] {
        &self.values[lane * self.n_values..(lane + 1) * self.n_values]
    }

    fn values_mut(&mut self, lane: usize) -> &mut [f64] {
        &mut self.values[lane * self.n_values..(lane + 1) * self.n_values]
    }

    /// Number of base steps, `n_steps` at most, to the next tick whose samples are seen at the end of `n_steps` steps
    /// from tick `tick`: the last ones that are due by then.
    pub fn steps_to_sample(&self, tick: u64, n_steps: u64) -> u64 {
        let last = |sensor: &Sensor| ((tick + n_steps) / sensor.every * sensor.every).saturating_sub(tick);
        self.list.iter().map(last).filter(|n| *n > 0).min().unwrap_or(n_steps)
    }

    /// Takes the samples that are due in the worlds that `is_active`, whose ticks are `ticks`.
    pub fn sample(&mut self, lanes: &mut SteppedLanes, ticks: &[u64], is_active: impl Fn(usize) -> bool) {
        let n = self.list.len();
        let mut measures_accelerations = false;
        for (lane, due) in self.due.chunks_exact_mut(n).enumerate() {
            for (due, sensor) in due.iter_mut().zip(&self.list) {
                let is_due = is_active(lane) && ticks[lane].is_multiple_of(sensor.every);
                *due = is_due.then(|| ticks[lane] / sensor.every);
                measures_accelerations |= is_due && sensor.measures_accelerations();
            }
        }
        if self.due.iter().all(Option::is_none) {
            return;
        }
        let sampling = Sampling { sensors: self };
        if measures_accelerations {
            lanes.observe_with_accelerations(sampling);
        } else {
            lanes.observe(true, sampling);
        }
    }
}

/// Samples that are due.
struct Sampling<'a> {
    sensors: &'a mut LaneSensors,
}

impl LaneObserver for Sampling<'_> {
    type Output = ();

    #[inline(always)]
    fn observe<R: Real>(self, seen: &StateView<'_, R>) {
        let LaneSensors { list, values, n_values, seeds, due } = self.sensors;
        let n = list.len();
        for (i, sensor) in list.iter().enumerate() {
            let of_sensor = || due.iter().skip(i).step_by(n);
            if of_sensor().all(Option::is_none) {
                continue;
            }
            let exact = sensor.exact(seen).expect("the plan refuses other sensors");
            for (lane, k) in of_sensor().enumerate().filter_map(|(lane, due)| Some((lane, (*due)?))) {
                let y = &mut values[lane * *n_values..][sensor.values()];
                sensor.add_errors(&exact.lane(lane), seeds[lane * n + i], k, y);
            }
        }
    }
}
