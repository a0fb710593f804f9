//! The scripts of a run: made at the first call, called in V-REP's order.

use std::collections::BTreeSet;
use std::sync::Arc;

use sincro_coppelia::api::{ApiError, Handle, Value};
use sincro_coppelia::api_controller::ApiController;
use sincro_coppelia::host::{Call, Host, Phase, in_order};
use sincro_dynamics::model::ModelBuilder;
use sincro_dynamics::state::State;
use sincro_dynamics::world::{MethodKind, World};
use sincro_scene::scene::Scene;
use sincro_scene::script::{Kind, Script, ScriptError, ScriptParser, ScriptedLaw, ScriptedLawSpec};
use sincro_sim::Loaded;
use sincro_sim::ScriptEngine;
use sincro_sim::controller::{Controller, Message, ScriptFailure};

use crate::guard::Guard;
use crate::law::LuaLaw;
use crate::machine::{self, Machine};
use crate::shared::{Shared, handle_of};
use crate::{fault, sandbox};

/// Limit on how often one step may be held back; the simulation time does not advance meanwhile.
const MAX_HELD: u32 = 1_000;

/// Lua 5.4.
#[derive(Debug)]
pub(crate) struct Lua54;

impl ScriptParser for Lua54 {
    fn check(&self, script: &Script) -> Result<(), ScriptError> {
        let guard = Guard::new(script.max_instructions);
        let compiled = sandbox::new(&guard, script.max_memory).and_then(|lua| machine::compile(&lua, script).map(drop));
        compiled.map_err(|error| fault::of(script, &guard, &error))
    }

    fn law(&self, spec: &ScriptedLawSpec) -> Result<Box<dyn ScriptedLaw>, String> {
        Ok(Box::new(LuaLaw::new(spec)?))
    }
}

impl ScriptEngine for Lua54 {
    fn controller(&self, loaded: &Loaded) -> Box<dyn Controller> {
        Box::new(ApiController::with_scripts(loaded, |setting| {
            let shared = Arc::new(Shared::new(setting, nothing()));
            Box::new(Scripts {
                shared,
                machines: Vec::new(),
                scene: None,
                holder: 0,
                is_running: false,
                is_open: false,
            })
        }))
    }
}

/// A world without anything in it.
fn nothing() -> World {
    let (model, _) = ModelBuilder::new([0.0; 3]).build().expect("a model of nothing has no problems");
    let state = State::new(&model);
    World::new(model, state, MethodKind::SemiImplicitEuler, 1e-6, 1e-3)
}

#[derive(Debug)]
struct Scripts {
    shared: Arc<Shared>,
    /// Machines of the scripts that have not ended, in the order of calls.
    machines: Vec<Machine>,
    /// Scene that they belong to.
    scene: Option<Arc<Scene>>,
    /// The last one that has held back a step.
    holder: usize,
    /// True between the initialization and the cleanup of a run: child scripts live.
    is_running: bool,
    /// True if customization scripts live through all runs of a session.
    is_open: bool,
}

impl Host for Scripts {
    fn call(&mut self, mut call: Call<'_>, phase: Phase) -> Result<(), ScriptError> {
        self.lend(&mut call);
        let done = self.run(phase);
        self.lend(&mut call);
        done
    }

    fn call_function(
        &mut self,
        mut call: Call<'_>,
        (object, kind): (Handle, Option<Kind>),
        function: &str,
        arguments: &[Value],
    ) -> Result<Vec<Value>, ApiError> {
        let k = self.machine_on(object, kind)?;
        self.lend(&mut call);
        let done = self.machines[k].call_function(function, arguments);
        self.machines.iter().for_each(Machine::resume_script);
        self.lend(&mut call);
        done
    }

    fn filter_picture(&mut self, mut call: Call<'_>, sensor: Handle) -> Result<bool, ApiError> {
        let Ok(k) = self.machine_on(sensor, None) else { return Ok(false) };
        self.lend(&mut call);
        let done = self.machines[k].filter_picture();
        self.machines.iter().for_each(Machine::resume_script);
        self.lend(&mut call);
        done
    }

    fn evaluate(
        &mut self,
        mut call: Call<'_>,
        (object, kind): (Handle, Option<Kind>),
        text: &str,
    ) -> Result<Vec<Value>, ApiError> {
        let k = self.machine_on(object, kind)?;
        self.lend(&mut call);
        let done = self.machines[k].evaluate(text);
        self.machines.iter().for_each(Machine::resume_script);
        self.lend(&mut call);
        done
    }

    fn failures(&self) -> Vec<ScriptFailure> {
        self.shared.failures()
    }

    fn take_messages(&mut self) -> Vec<Message> {
        self.shared.take_messages()
    }
}

impl Scripts {
    /// Swaps the world of the call with that of the stage.
    fn lend(&self, call: &mut Call<'_>) {
        let mut stage = self.shared.stage();
        std::mem::swap(&mut stage.world, call.world);
        std::mem::swap(&mut stage.registry, call.registry);
        stage.t = call.t;
    }

    fn run(&mut self, phase: Phase) -> Result<(), ScriptError> {
        let step = self.shared.setting.step;
        let is_first = matches!(phase, Phase::Initialization | Phase::Open);
        if phase == Phase::Initialization {
            // child scripts come to life
            (self.is_running, self.scene) = (true, None);
            self.shared.forget_failures();
        }
        let new = self.follow_scene()?;
        if !is_first {
            // those that are started while the simulation runs, or is stopped
            let first = if self.is_running { Phase::Initialization } else { Phase::Open };
            let is_new = |m: &&mut Machine| new.contains(&m.place());
            let is_running = self.is_running;
            self.machines.iter_mut().filter(is_new).try_for_each(|m| {
                let done = m.call(first);
                if is_running { m.after(done) } else { done }
            })?;
        }
        let n = self.machines.len();
        self.machines.iter().for_each(Machine::refill);
        if phase == Phase::NonSimulation {
            return self.call_while_stopped();
        }
        if phase == Phase::Actuation {
            self.wait_for_main()?;
            (0..n).try_for_each(|k| self.with_machine(k, Machine::deliver))?;
            (0..n).try_for_each(|k| self.with_machine(k, Machine::resume))?;
        }
        if phase == Phase::Sensing {
            (0..n).try_for_each(|k| self.with_machine(k, |m| m.call_dynamics(step, true)))?;
            (0..n).try_for_each(|k| self.with_machine(k, Machine::call_vision))?;
        }
        if phase == Phase::Initialization {
            // those of customization scripts have begun before any of them is told of a run
            let begin = |m: &mut Machine| if m.is_customization() { m.call(Phase::Open) } else { Ok(()) };
            (0..n).try_for_each(|k| self.with_machine(k, begin))?;
        }
        let is_in_step = matches!(phase, Phase::Actuation | Phase::Sensing);
        let called = (0..n).try_for_each(|k| {
            // others call those that V-REP's cascade leaves to the script above
            let sleeps = self.machines[k].sleeps();
            let is_left_out = is_in_step && (sleeps || self.shared.is_called_from_above(self.machines[k].place()));
            if is_left_out { Ok(()) } else { self.with_machine(k, |m| m.call(phase)) }
        });
        match phase {
            Phase::Open => {
                self.is_open = called.is_ok();
                self.machines.iter().for_each(Machine::resume_script);
            }
            Phase::Cleanup => return called.and(self.end_run()),
            Phase::Close => {
                (self.is_open, self.scene) = (false, None);
                self.machines.drain(..).for_each(|machine| self.shared.end(machine.place()));
            }
            _ => {}
        }
        called?;
        if phase == Phase::Actuation {
            (0..n).try_for_each(|k| self.with_machine(k, |m| m.call_dynamics(step, false)))?;
            (0..n).try_for_each(|k| self.with_machine(k, |m| m.call_joint(step)))?;
            self.decide_contacts()?;
        }
        Ok(())
    }

    /// Calls the scripts that live while there is no run, each whether or not another one fails; one that has failed is
    /// not called again before the next run. Returns the first failure.
    fn call_while_stopped(&mut self) -> Result<(), ScriptError> {
        let mut first = Ok(());
        for k in 0..self.machines.len() {
            if self.machines[k].has_failed {
                continue;
            }
            let done = self.with_machine(k, |m| m.resume().and_then(|()| m.call(Phase::NonSimulation)));
            if done.is_err() {
                self.machines[k].has_failed = true;
                self.machines[k].resume_script();
            }
            first = first.and(done);
        }
        first
    }

    /// Ends the child scripts; customization scripts stay if they live through all runs of a session.
    fn end_run(&mut self) -> Result<(), ScriptError> {
        (self.is_running, self.scene) = (false, None);
        let is_open = self.is_open;
        let stays = |m: &Machine| is_open && m.is_customization();
        let (staying, gone): (Vec<Machine>, Vec<Machine>) = self.machines.drain(..).partition(stays);
        self.machines = staying;
        self.machines.iter_mut().for_each(Machine::forget_run);
        let mut first = Ok(());
        for mut machine in gone {
            if machine.is_customization() {
                first = first.and(machine.call(Phase::Close));
            }
            self.shared.end(machine.place());
        }
        first
    }

    /// Calls a script, unless another one has removed its object in this phase.
    fn with_machine(
        &mut self,
        k: usize,
        call: impl FnOnce(&mut Machine) -> Result<(), ScriptError>,
    ) -> Result<(), ScriptError> {
        let machine = &mut self.machines[k];
        let own = self.shared.script(machine.place());
        let is_enabled = self.shared.activity(machine.place()).is_enabled;
        if !is_enabled || machine.is_dead() || !self.shared.is_present(&own, self.scene.as_ref()) {
            return Ok(());
        }
        let done = call(machine);
        // without a run nothing goes on
        if self.is_running { machine.after(done) } else { done }
    }

    /// Calls `sysCall_beforeMainScript` again and again while a script holds the step back.
    fn wait_for_main(&mut self) -> Result<(), ScriptError> {
        for _ in 0..MAX_HELD {
            let mut holder = None;
            for k in 0..self.machines.len() {
                let mut holds = false;
                self.with_machine(k, |m| m.call_before_main().map(|answer| holds = answer))?;
                if holds {
                    holder = Some(k);
                }
            }
            let Some(k) = holder else { return Ok(()) };
            self.machines[k].refill();
            self.holder = k;
        }
        Err(self.machines[self.holder].holds_back(MAX_HELD))
    }

    /// Asks `sysCall_contact` of each script in turn about each pair that may come to touch: the first that does not
    /// leave it to others decides.
    fn decide_contacts(&mut self) -> Result<(), ScriptError> {
        let Some(first) = self.machines.iter().position(Machine::has_contact) else { return Ok(()) };
        let own = self.shared.object(self.machines[first].place());
        // a table is there while scripts are called
        let near = self.shared.with_sim(own, |sim| Ok(sim.candidate_pairs())).unwrap_or_default();
        for bodies in near {
            for k in 0..self.machines.len() {
                let mut decides = false;
                let ask = |m: &mut Machine| m.call_contact(bodies).map(|answer| decides = answer);
                if self.machines[k].has_contact() {
                    self.with_machine(k, ask)?;
                }
                if decides {
                    break;
                }
            }
        }
        Ok(())
    }

    /// Machine of the script on an object.
    fn machine_on(&self, object: Handle, kind: Option<Kind>) -> Result<usize, ApiError> {
        let place = self.shared.script_on(object, kind);
        let machine = place.and_then(|place| self.machines.iter().position(|m| m.place() == place));
        machine.ok_or_else(|| ApiError::new("there is no script on that object"))
    }

    /// Ends the scripts whose objects have gone and makes those that are new; returns the places of the latter, which
    /// have not been called yet.
    fn follow_scene(&mut self) -> Result<BTreeSet<usize>, ScriptError> {
        let mut new = BTreeSet::new();
        let Some(scene) = self.shared.stage().registry.as_ref().map(|registry| registry.scene().clone()) else {
            return Ok(new);
        };
        if self.scene.as_ref().is_some_and(|known| Arc::ptr_eq(known, &scene)) {
            return Ok(new);
        }
        let restarts =
            self.shared.stage().registry.as_mut().map(|registry| registry.take_script_restarts()).unwrap_or_default();
        let is_running = self.is_running;
        let mut scripts = in_order(&scene);
        scripts.retain(|script| is_running || script.kind == Kind::Customization);
        let stays = |m: &Machine| {
            let own = self.shared.script(m.place());
            let is_restarted = restarts.contains(&(handle_of(&own), own.kind));
            !is_restarted && scripts.iter().any(|script| (script.object, script.kind) == (own.object, own.kind))
        };
        let (staying, gone): (Vec<Machine>, Vec<Machine>) = self.machines.drain(..).partition(stays);
        self.machines = staying;
        for mut machine in gone {
            let told = if is_running { machine.call(Phase::Cleanup) } else { Ok(()) };
            let ended = if machine.is_customization() { machine.call(Phase::Close) } else { Ok(()) };
            if let Err(fault) = told.and(ended) {
                // its object is not there any more
                self.shared.say(machine.place(), fault.to_string());
            }
            self.shared.end(machine.place());
        }
        let mut places = Vec::new();
        for script in scripts {
            let known = self.shared.script_on(handle_of(script), Some(script.kind));
            let place = known.unwrap_or_else(|| self.shared.add(Arc::new(script.clone())));
            if known.is_none() {
                new.insert(place);
            }
            places.push(place);
        }
        for place in &new {
            let machine = Machine::new(&self.shared, *place).inspect_err(|_| {
                // else they would be taken for known ones the next time
                let has_one = |place: &usize| self.machines.iter().any(|m| m.place() == *place);
                new.iter().filter(|place| !has_one(place)).for_each(|place| self.shared.end(*place));
            });
            self.machines.push(machine?);
        }
        self.machines.iter().for_each(|m| self.shared.set_state(m.place(), m.lua.weak()));
        let order = |m: &Machine| places.iter().position(|place| *place == m.place());
        self.machines.sort_by_cached_key(order);
        self.scene = Some(scene);
        Ok(new)
    }
}
