//! Continuous states of a scene for model exchange: their names and start values.

use sincro_blocks::runner::Runner;
use sincro_scene::record::{Probe, WindingQuantity, catalogue};
use sincro_sim::Loaded;

/// A continuous state of an FMU of model exchange, with its unit and initial value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ContinuousState {
    /// Name of the signal that it is, or of its block.
    pub name: String,
    /// Unit; empty if none is known.
    pub unit: String,
    /// Value at the start.
    pub start: f64,
}

/// States in the order q, v, speeds of rotors with a lag, currents of windings, activations, continuous blocks.
#[must_use]
pub(crate) fn states(loaded: &Loaded) -> Vec<ContinuousState> {
    let (model, initial) = (&loaded.scene.model, &loaded.scene.initial);
    let entries = catalogue(model);
    let named = |probe: Probe, start: f64| {
        let entry = entries.iter().find(|entry| entry.probe == probe);
        let name = entry.map_or_else(|| format!("{probe:?}"), |entry| entry.name.clone());
        ContinuousState { name, unit: entry.map_or_else(String::new, |entry| entry.unit.to_string()), start }
    };
    let q = initial.q.iter().enumerate().map(|(k, x)| named(Probe::Coordinate(k), *x));
    let v = initial.v.iter().enumerate().map(|(k, x)| named(Probe::Rate(k), *x));
    let mut all: Vec<ContinuousState> = q.chain(v).collect();
    for (rotor, name) in model.rotors().iter().zip(&model.names().rotors) {
        if let Some(start) = rotor.speed.initial() {
            all.push(ContinuousState { name: format!("{name}.speed"), unit: "rad/s".into(), start });
        }
    }
    for (k, winding) in model.windings().iter().enumerate() {
        if let Some(state) = winding.state {
            all.push(named(Probe::Winding(WindingQuantity::Current, k), initial.rotors[state]));
        }
    }
    for (k, activation) in model.activations().iter().enumerate() {
        all.push(named(Probe::Activation(k), initial.rotors[activation.state]));
    }
    if let Some(controller) = &loaded.controller {
        let program = controller.wiring.program();
        let runner = Runner::<f64>::new(program.clone());
        for step in &program.steps {
            let n = step.states.len();
            for (k, place) in step.states.clone().enumerate() {
                let name = if n == 1 { step.path.clone() } else { format!("{}.state[{k}]", step.path) };
                all.push(ContinuousState { name, unit: String::new(), start: runner.state.continuous[place] });
            }
        }
    }
    all
}
