//! The scripts of a run: made at the first call, called in V-REP's order.

use std::sync::Arc;

use sincro_coppelia::api::{ApiError, Handle, Value};
use sincro_coppelia::api_controller::ApiController;
use sincro_coppelia::host::{Call, Host, Phase};
use sincro_dynamics::model::ModelBuilder;
use sincro_dynamics::state::State;
use sincro_dynamics::world::{MethodKind, World};
use sincro_scene::script::{Kind, Script, ScriptError, ScriptParser, ScriptedLaw, ScriptedLawSpec};
use sincro_sim::Loaded;
use sincro_sim::ScriptEngine;
use sincro_sim::controller::Controller;
use sincro_sim::controller::Message;

use crate::guard::Guard;
use crate::law::LuaLaw;
use crate::machine::{self, Machine};
use crate::shared::Shared;
use crate::{api, fault, sandbox};

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
        Box::new(ApiController::with_scripts(loaded, |scripts, setting| {
            let shared = Arc::new(Shared::new(scripts.clone(), setting, nothing()));
            Box::new(Scripts { shared, machines: Vec::new(), holder: 0 })
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
    machines: Vec<Machine>,
    /// The last one that has held back a step.
    holder: usize,
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
        let place = api::script_on(&self.shared.scripts, object, kind).filter(|k| *k < self.machines.len());
        let place = place.ok_or_else(|| ApiError::new("there is no script on that object"))?;
        self.lend(&mut call);
        let done = self.machines[place].call_function(function, arguments);
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
        let place = api::script_on(&self.shared.scripts, object, kind).filter(|k| *k < self.machines.len());
        let place = place.ok_or_else(|| ApiError::new("there is no script on that object"))?;
        self.lend(&mut call);
        let done = self.machines[place].evaluate(text);
        self.machines.iter().for_each(Machine::resume_script);
        self.lend(&mut call);
        done
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
        if self.machines.is_empty() {
            self.make()?;
        }
        self.machines.iter().for_each(Machine::refill);
        if phase == Phase::Actuation {
            self.wait_for_main()?;
            self.machines.iter_mut().try_for_each(Machine::resume)?;
        }
        if phase == Phase::Sensing {
            self.machines.iter_mut().try_for_each(|m| m.call_dynamics(step, true))?;
        }
        self.machines.iter_mut().try_for_each(|m| m.call(phase))?;
        if phase == Phase::Actuation {
            self.machines.iter_mut().try_for_each(|m| m.call_dynamics(step, false))?;
            self.machines.iter_mut().try_for_each(|m| m.call_joint(step))?;
            self.decide_contacts()?;
        }
        Ok(())
    }

    /// Calls `sysCall_beforeMainScript` again and again while a script holds the step back.
    fn wait_for_main(&mut self) -> Result<(), ScriptError> {
        for _ in 0..MAX_HELD {
            let mut holder = None;
            for (k, machine) in self.machines.iter_mut().enumerate() {
                if machine.call_before_main()? {
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
        let own = crate::shared::handle_of(&self.shared.scripts[first]);
        // a table is there while scripts are called
        let near = self.shared.with_sim(own, |sim| Ok(sim.candidate_pairs())).unwrap_or_default();
        for bodies in near {
            for machine in self.machines.iter_mut().filter(|m| m.has_contact()) {
                if machine.call_contact(bodies)? {
                    break;
                }
            }
        }
        Ok(())
    }

    fn make(&mut self) -> Result<(), ScriptError> {
        for index in 0..self.shared.scripts.len() {
            self.machines.push(Machine::new(&self.shared, index)?);
        }
        let states = self.machines.iter().map(|m| m.lua.weak()).collect();
        let _ = self.shared.states.set(states);
        Ok(())
    }
}
