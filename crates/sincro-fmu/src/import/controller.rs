//! A foreign FMU that commands a scene in lock-step.

use sincro_scene::record::Recorder;
use sincro_scene::script::ScriptError;
use sincro_sim::controller::{Commands, Controller, Instant};

use super::Slave;

/// Connections between a scene and an FMU, and its sample time.
#[derive(Debug)]
pub struct Wiring {
    /// Recorded signals of the scene, one for each input.
    pub measured: Recorder,
    /// Value references of the FMU's inputs, in the order of the signals.
    pub inputs: Vec<u32>,
    /// Value references of outputs, with the commands of the scene that they give.
    pub outputs: Vec<(u32, usize)>,
    /// Base steps from one sample to the next.
    pub every: u64,
    /// Base step `[s]`.
    pub step: f64,
}

/// A controller that is an FMU: at each sample it gets the measurements, gives the commands until the next one, and
/// makes its own step. An FMU without direct feedthrough answers a sample later.
#[derive(Debug)]
pub struct FmuController {
    name: String,
    slave: Slave,
    wiring: Wiring,
    references: Vec<u32>,
    held: Vec<f64>,
}

impl FmuController {
    /// For an instance that was started.
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
