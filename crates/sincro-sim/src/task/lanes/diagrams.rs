//! Diagrams of worlds in lanes: one for each, which reads what all lanes measure together.

use sincro_blocks::runner::{Runner, State as DiagramState};
use sincro_dynamics::batch::{LaneObserver, SteppedLanes};
use sincro_dynamics::coupled::StateView;
use sincro_math::Real;

use super::sensors::LaneSensors;
use crate::task::plan::Plan;
use sincro_scene::diagram::Wiring;
use sincro_scene::record::Probe;
use sincro_scene::record::probe::{View, of_state};

/// Diagrams whose blocks run at ticks.
#[derive(Debug)]
pub(super) struct LaneDiagrams {
    runners: Vec<Runner<f64>>,
    /// Commands that the task leaves to the diagram, and the signals that give them.
    commands: Vec<(usize, usize)>,
}

impl LaneDiagrams {
    /// None if the task has no diagram.
    pub fn new(plan: &Plan, n_worlds: usize) -> Option<Self> {
        let program = plan.loaded.controller.as_ref()?.wiring.program();
        let commands = program.commands.iter().map(|command| (command.terminal, command.signal.start));
        Some(Self {
            runners: (0..n_worlds).map(|_| Runner::new(program.clone())).collect(),
            commands: commands.filter(|(command, _)| !plan.own_commands().any(|own| own == *command)).collect(),
        })
    }

    /// Begins an episode of one world.
    pub fn begin(&mut self, lane: usize) {
        let runner = &mut self.runners[lane];
        *runner = Runner::new(runner.program().clone());
    }

    /// State of the diagram of one world.
    pub fn state(&self, lane: usize) -> &DiagramState<f64> {
        &self.runners[lane].state
    }

    /// Goes on from another state of one world's diagram, as it was after the evaluation of tick `tick`.
    pub fn resume(&mut self, lane: usize, tick: u64, set: impl FnOnce(&mut DiagramState<f64>)) {
        let mut state = self.runners[lane].save();
        set(&mut state);
        self.runners[lane].resume(state, tick);
    }

    /// Writes the commands of one world for the step from tick `tick`, time `t` `[s]`, and updates the memory of its
    /// diagram.
    pub fn latch(&mut self, lane: usize, tick: u64, t: f64, commands: &mut [f64]) {
        let runner = &mut self.runners[lane];
        for (command, signal) in &self.commands {
            commands[*command] = runner.signals()[*signal];
        }
        runner.update(tick, t);
    }

    /// Reads the measurements of all worlds, for [`LaneDiagrams::evaluate`].
    pub fn measure(&mut self, plan: &Plan, lanes: &mut SteppedLanes, sensors: Option<&LaneSensors>) {
        let Some(wiring) = plan.loaded.controller.as_ref().map(|controller| &controller.wiring) else { return };
        lanes.observe(wiring.needs_poses[0], Measurement { wiring, runners: &mut self.runners });
        let Some(sensors) = sensors else { return };
        for reading in &wiring.early {
            for (k, probe) in reading.probes.iter().enumerate() {
                let Probe::Sensor(value) = *probe else { continue };
                for (lane, runner) in self.runners.iter_mut().enumerate() {
                    runner.signals_mut()[reading.at + k] = sensors.values(lane)[value];
                }
            }
        }
    }

    /// Evaluates the blocks of one world that are due at tick `tick`, time `t` `[s]`; false if a block gives what is
    /// not finite.
    pub fn evaluate(&mut self, lane: usize, tick: u64, t: f64) -> bool {
        let runner = &mut self.runners[lane];
        runner.evaluate(tick, t);
        runner.not_finite().is_none()
    }
}

struct Measurement<'a> {
    wiring: &'a Wiring,
    runners: &'a mut [Runner<f64>],
}

impl LaneObserver for Measurement<'_> {
    type Output = ();

    #[inline(always)]
    fn observe<R: Real>(self, seen: &StateView<'_, R>) {
        let view = View::of(seen);
        for reading in &self.wiring.early {
            for (k, probe) in reading.probes.iter().enumerate() {
                let Some(value) = of_state(&view, *probe) else { continue };
                for (lane, runner) in self.runners.iter_mut().enumerate() {
                    runner.signals_mut()[reading.at + k] = value.lane(lane);
                }
            }
        }
    }
}
