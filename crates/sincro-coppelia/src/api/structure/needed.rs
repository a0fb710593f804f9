//! Signals and actuators that the block diagram of a scene needs: they cannot be taken away from it.

use std::sync::Arc;

use sincro_dynamics::model::Model;
use sincro_scene::record::{Probe, catalogue, present_name};
use sincro_scene::scene::Scene;
use sincro_sim::load::Loaded;
use sincro_sim::restructure::Renamed;

use crate::api::ApiError;

/// Needs of the diagram, by the names at the start.
#[derive(Clone, Debug)]
pub(crate) struct Needed {
    start: Arc<Scene>,
    signals: Vec<String>,
    /// Joints whose motors take commands, rotors, external forces, springs and dampers.
    actuators: Vec<String>,
}

impl Needed {
    /// Needs of the diagram of a loaded scene.
    pub fn new(loaded: &Loaded) -> Self {
        let (mut signals, mut actuators) = (Vec::new(), Vec::new());
        if let Some(controller) = &loaded.controller {
            let model = &loaded.scene.model;
            let wiring = &controller.wiring;
            let known = catalogue(model);
            let probes = wiring.early.iter().chain(&wiring.late).flat_map(|reading| &reading.probes);
            let name = |probe: &Probe| known.iter().find(|entry| entry.probe == *probe).map(|entry| entry.name.clone());
            signals = probes.filter_map(name).collect();
            let commands = wiring.program().commands.iter().map(|command| command.terminal);
            actuators = commands.filter_map(|command| actuator_of(model, command)).collect();
        }
        Self { start: loaded.scene.clone(), signals, actuators }
    }

    /// Refuses a scene that has not what the diagram needs.
    ///
    /// # Errors
    ///
    /// It has not.
    pub fn check(&self, to: &Scene) -> Result<(), ApiError> {
        if self.signals.is_empty() && self.actuators.is_empty() {
            return Ok(());
        }
        let renamed = Renamed::new(&self.start, to);
        let known = catalogue(&to.model);
        for signal in &self.signals {
            let now = present_name(signal, &|path| renamed.path(path));
            if !now.is_some_and(|now| known.iter().any(|entry| entry.name == now)) {
                return Err(ApiError(format!("the diagram measures `{signal}`: its object has to stay")));
            }
        }
        for path in &self.actuators {
            let n = to.model.n_commands();
            let now = renamed.path(path);
            if !now.is_some_and(|now| (0..n).any(|k| actuator_of(&to.model, k).as_ref() == Some(&now))) {
                return Err(ApiError(format!("the diagram commands `{path}`: it has to stay")));
            }
        }
        Ok(())
    }
}

/// Name of the joint, rotor, force or spring and damper that takes a command.
fn actuator_of(model: &Model<f64>, command: usize) -> Option<String> {
    let names = model.names();
    let n_motors = model.motors().len();
    if command < n_motors {
        let has = |joint: &&sincro_dynamics::model::JointInfo| joint.motors().any(|motor| motor.index() == command);
        return names.joints.iter().find(has).map(|joint| joint.name.clone());
    }
    if let Some(input) = names.inputs.get((command - n_motors) / 6) {
        return Some(input.clone());
    }
    let rotor = model.rotors().iter().position(|rotor| rotor.speed.command() == Some(command));
    if let Some(rotor) = rotor {
        return Some(names.rotors[rotor].clone());
    }
    let takes = |actuator: &sincro_dynamics::actuation::spring_damper::LineActuator<f64>| actuator.command == command;
    let line = model.spring_dampers().iter().position(|line| line.actuator.as_ref().is_some_and(takes));
    line.map(|line| names.spring_dampers[line].clone())
}
