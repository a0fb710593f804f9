//! A world as a lock-step of its own: for whatever lanes cannot advance.

use crate::controller::{Commands, Controller, Forked};
use crate::load::Loaded;
use crate::restructure::Restructured;
use crate::run::LockStep;
use sincro_blocks::runner::State as DiagramState;
use sincro_dynamics::state::State;
use sincro_scene::diagram::ControlDiagram;
use sincro_scene::record::Recorder;

use super::plan::{Drawn, Plan};

/// Commands of the task: they win over the scene's and the diagram's.
#[derive(Clone, Debug)]
struct Commanded(Vec<Option<f64>>);

impl Controller for Commanded {
    fn name(&self) -> &str {
        "task"
    }

    fn latch(&self, commands: &mut Commands<'_>) {
        for (command, value) in self.0.iter().enumerate() {
            if let Some(value) = value {
                commands.set(command, *value);
            }
        }
    }

    fn restructured(&mut self, _: &Restructured) -> Result<(), String> {
        Err("the structure changes, which a task with commands by number cannot follow".to_owned())
    }

    fn fork(&self) -> Forked {
        Forked::Whole(Box::new(self.clone()))
    }
}

/// One world.
#[derive(Debug)]
pub(super) struct SingleWorld {
    run: Option<(LockStep, Recorder)>,
    is_good: bool,
}

impl SingleWorld {
    pub fn new() -> Self {
        Self { run: None, is_good: false }
    }

    /// Begins an episode.
    pub fn start(&mut self, plan: &Plan, drawn: &Drawn) {
        self.run = None;
        let varied: Option<Loaded> = match drawn.overrides.is_empty() {
            true => None,
            // what the files refuse for this draw ends the episode at once, as any world that cannot go on
            false => match plan.loaded.with_more_overrides(&drawn.overrides) {
                Ok(loaded) => Some(loaded),
                Err(_) => {
                    self.is_good = false;
                    return;
                }
            },
        };
        let loaded = varied.as_ref().unwrap_or(&plan.loaded);
        let mut lockstep = LockStep::new(loaded, plan.method, false);
        lockstep.attach(Box::new(Commanded(vec![None; loaded.scene.commands.len()])));
        // a scene with other numbers may have another start of its own
        let state = plan.with_drawn(lockstep.state(), &drawn.state);
        lockstep.set_state(state, &[]);
        lockstep.reseed_sensors(drawn.noise_seed);
        self.is_good = lockstep.start().is_ok();
        let entries = loaded.controller.as_ref().map(ControlDiagram::entries).unwrap_or_default();
        let recorder = Recorder::new(&plan.task.signals, &loaded.scene.model, &entries);
        self.run = recorder.ok().map(|mut recorder| {
            if lockstep.structure().is_none() {
                let (seen, signals) = lockstep.observe(0.0);
                recorder.row(&seen, signals, 0.0, true);
            }
            (lockstep, recorder)
        });
    }

    /// Advances by one action's period under commands; none is left to the scene and its diagram.
    pub fn advance(&mut self, plan: &Plan, commands: &[Option<f64>]) {
        let Some((lockstep, _)) = &mut self.run else { return };
        if let Some((held, _)) = lockstep.controller::<Commanded>() {
            held.0.copy_from_slice(commands);
        }
        for _ in 0..plan.task.ticks {
            if !self.is_good {
                return;
            }
            self.is_good = lockstep.advance().is_ok() && !lockstep.take_stop_request();
        }
    }

    /// Coordinates of the world; none before its first episode.
    pub fn coordinates(&self) -> Option<Vec<f64>> {
        self.run.as_ref().map(|(lockstep, _)| lockstep.state().q.clone())
    }

    /// State of the world, and that of its diagram; none before its first episode.
    pub fn state(&self) -> Option<(&State<f64>, Option<&DiagramState<f64>>)> {
        let (lockstep, _) = self.run.as_ref()?;
        Some((lockstep.state(), lockstep.control().map(|control| &control.runner.state)))
    }

    /// Puts the world at tick `tick` into the state that `set` makes of its last one and of that of its diagram.
    pub fn resume(&mut self, tick: u64, set: impl FnOnce(&mut State<f64>, Option<&mut DiagramState<f64>>)) {
        let Some((lockstep, _)) = &mut self.run else { return };
        let mut snapshot = lockstep.snapshot(lockstep.trace());
        set(&mut snapshot.state, snapshot.diagram.as_mut());
        snapshot.state.tick = tick;
        lockstep.restore(&snapshot);
    }

    /// Signals of the world; false if it cannot go on.
    pub fn observe(&mut self, out: &mut [f64]) -> bool {
        let Some((lockstep, recorder)) = &mut self.run else { return false };
        if lockstep.structure().is_some() {
            return false;
        }
        let t = lockstep.t();
        let (seen, signals) = lockstep.observe(t);
        out.copy_from_slice(&recorder.row(&seen, signals, t, false)[1..]);
        self.is_good && out.iter().all(|x| x.is_finite())
    }
}
