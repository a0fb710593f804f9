//! Signals of a model whose structure has changed: the same signals of the same objects, wherever they now stand.

use std::collections::BTreeMap;

use sincro_dynamics::model::Model;

use super::{Entry, Probe, Recorder, catalogue};

/// Returns the name of a signal whose object has another path, which `path_of` gives; `None` if the object has gone.
pub fn present_name(name: &str, path_of: &dyn Fn(&str) -> Option<String>) -> Option<String> {
    let Some((path, quantity)) = name.split_once('.').filter(|(path, _)| path.starts_with('/')) else {
        return Some(name.to_owned());
    };
    path_of(path).map(|path| format!("{path}.{quantity}"))
}

/// Probes of a model by the names of their signals.
fn probes(model: &Model<f64>) -> BTreeMap<String, Probe> {
    catalogue(model).into_iter().map(|entry| (entry.name, entry.probe)).collect()
}

/// Finds the probes of one model in another one.
#[derive(Clone, Debug)]
pub struct ProbeMap {
    former: Vec<Entry>,
    now: BTreeMap<String, Probe>,
    /// Present path of each object of the former model.
    paths: BTreeMap<String, Option<String>>,
}

impl ProbeMap {
    /// Creates the map from `former` to `model`; `path_of` gives the path now of an object of the former model, `None`
    /// for what has gone.
    #[must_use]
    pub fn new(former: &Model<f64>, model: &Model<f64>, path_of: &dyn Fn(&str) -> Option<String>) -> Self {
        let former = catalogue(former);
        let path = |entry: &Entry| entry.name.split_once('.').map_or("", |(path, _)| path).to_owned();
        let paths = former.iter().map(path).map(|path| (path.clone(), path_of(&path))).collect();
        Self { former, now: probes(model), paths }
    }

    /// Returns the probe of the same signal in the other model, or the name of the signal, if there is none.
    ///
    /// # Errors
    ///
    /// The object of the signal has gone, or has no such signal any more.
    pub fn probe(&self, probe: Probe) -> Result<Probe, String> {
        if matches!(probe, Probe::Signal(_) | Probe::FloatSignal(_)) {
            return Ok(probe);
        }
        let Some(entry) = self.former.iter().find(|entry| entry.probe == probe) else { return Err(String::new()) };
        let name = present_name(&entry.name, &|path| self.paths.get(path).cloned().flatten());
        name.and_then(|name| self.now.get(&name).copied()).ok_or_else(|| entry.name.clone())
    }
}

impl Recorder {
    /// Goes on with the signals of a model whose structure has changed; the columns stay. `path_of` gives the path now
    /// of an object by its path at the start. Signals of what has gone are NaN from now on. `energy_added` is the
    /// energy that the change has brought in `[J]`: the balance leaves it out.
    pub fn follow(&mut self, model: &Model<f64>, path_of: &dyn Fn(&str) -> Option<String>, energy_added: f64) {
        let now = probes(model);
        let mut impulse = vec![0.0; model.motors().len()];
        for (entry, bound) in self.entries.iter().zip(&mut self.bound) {
            let before = *bound;
            *bound = match entry.probe {
                Probe::Signal(_) | Probe::FloatSignal(_) => Some(entry.probe),
                _ => present_name(&entry.name, path_of).and_then(|name| now.get(&name).copied()),
            };
            if let (Some(Probe::MotorTorqueMean(old)), Some(Probe::MotorTorqueMean(new))) = (before, *bound) {
                impulse[new] = self.motor_impulse[old];
            }
        }
        self.motor_impulse = impulse;
        self.energy_at_start += energy_added;
        self.n_sensed = model.names().sensors.iter().map(|sensor| sensor.values.len()).sum();
    }
}
