//! A foreign FMU that commands a scene in lock-step.

use sincro_scene::record::Recorder;
use sincro_scene::script::ScriptError;
use sincro_sim::controller::{Commands, Controller, Instant};

use super::Slave;

/// Connections between a scene and an FMU that commands it, and its sample time; made for [`FmuController::new`].
#[derive(Debug)]
pub struct Wiring {
    /// Signals of the scene that are measured at each sample, one for each input, each in its unit.
    pub measured: Recorder,
    /// Value references of the FMU's real inputs, in the order of `measured`.
    pub inputs: Vec<u32>,
    /// Value references of real outputs, each with the index of the scene's command that it gives.
    pub outputs: Vec<(u32, usize)>,
    /// Number of base steps from one sample to the next; 0 counts as 1.
    pub every: u64,
    /// Base step `[s]`.
    pub step: f64,
}

/// Controller of a lock-step that is an FMU: at each sample it takes the measurements, gives the commands until the
/// next one, and makes its own step. An FMU without direct feedthrough answers a sample later.
#[derive(Debug)]
pub struct FmuController {
    name: String,
    slave: Slave,
    wiring: Wiring,
    references: Vec<u32>,
    held: Vec<f64>,
}

impl FmuController {
    /// Creates a controller from an instance that was started ([`Slave::start`]); errors of the run name it `name`.
    #[must_use]
    pub fn new(name: &str, slave: Slave, wiring: Wiring) -> Self {
        let references: Vec<u32> = wiring.outputs.iter().map(|(reference, _)| *reference).collect();
        let held = vec![0.0; references.len()];
        Self { name: name.to_owned(), slave, wiring, references, held }
    }

    fn sample(&mut self, at: &mut Instant<'_>) -> Result<(), String> {
        let seen = at.world.observe(at.t);
        let row = self.wiring.measured.row(&seen, &[], at.t, at.tick == 0);
        self.slave.set(&self.wiring.inputs, &row[1..])?;
        self.slave.get(&self.references, &mut self.held)?;
        if let Some(k) = self.held.iter().position(|x| !x.is_finite()) {
            return Err(format!("the output {} of the FMU is {}", self.references[k], self.held[k]));
        }
        let goes_on = self.slave.step(at.t, self.wiring.every as f64 * self.wiring.step)?;
        if goes_on { Ok(()) } else { Err("the FMU ended the simulation".into()) }
    }
}

impl Controller for FmuController {
    fn name(&self) -> &str {
        &self.name
    }

    fn actuate(&mut self, mut at: Instant<'_>) -> Result<(), ScriptError> {
        if !at.tick.is_multiple_of(self.wiring.every.max(1)) {
            return Ok(());
        }
        self.sample(&mut at).map_err(|message| ScriptError { object: self.name.clone(), at: None, message, help: None })
    }

    fn latch(&self, commands: &mut Commands<'_>) {
        for ((_, command), value) in self.wiring.outputs.iter().zip(&self.held) {
            commands.set(*command, *value);
        }
    }
}
