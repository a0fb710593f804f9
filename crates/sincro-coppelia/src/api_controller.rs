//! The V-REP/CoppeliaSim API as a controller: the table of objects that clients and scripts act on, and the scripts themselves.

use std::sync::Arc;

use sincro_dynamics::world::World;

use crate::host::{Host, Phase, Scripts, Setting};
use crate::session::{self, Desk, Handle, Refusal, Request, Table, Value};
use sincro_scene::scenery::Piece;
use sincro_scene::script::{Kind, Script, ScriptError};
use sincro_sim::controller::{Change, Commands, Controller, Forked, Instant, Message};
use sincro_sim::load::Loaded;
use sincro_sim::proximity::Detection;
use sincro_sim::run::{Halt, LockStep};

/// The table of objects with the scripts of the scene, if it has any.
#[derive(Debug)]
pub struct ApiController {
    /// None while a script has it.
    table: Option<Box<Table>>,
    scripts: Option<Scripts>,
}

impl ApiController {
    /// A table for clients, without scripts.
    #[must_use]
    pub fn new(table: Table) -> Self {
        Self { table: Some(Box::new(table)), scripts: None }
    }

    /// The scripts of a scene, with a table of their own; `start` makes their host.
    pub fn with_scripts(loaded: &Loaded, start: impl FnOnce(&Arc<[Script]>, Setting) -> Box<dyn Host>) -> Self {
        let ticks = loaded.experiment.simulation_ticks;
        let setting = Setting { step: loaded.experiment.step * ticks as f64, seed: loaded.experiment.seed };
        let scripts = Scripts::of(&loaded.scene, setting, start);
        let mut table = Table::new(loaded, ticks);
        table.phase = session::Phase::Running;
        Self { table: Some(Box::new(table)), scripts: Some(scripts) }
    }

    /// That of a lock-step with its world, if it has one.
    pub fn of(lockstep: &mut LockStep) -> Option<(&mut Self, &mut World)> {
        lockstep.controller::<Self>()
    }

    /// Gives a lock-step another table of objects: commands that are held in it are latched from the next tick on.
    pub fn set_table(lockstep: &mut LockStep, table: Table) {
        if let Some((api, _)) = Self::of(lockstep) {
            api.table = Some(Box::new(table));
            return;
        }
        lockstep.attach(Box::new(Self::new(table)));
    }

    /// Takes the table of objects away from a lock-step.
    pub fn take_table(lockstep: &mut LockStep) -> Option<Box<Table>> {
        Self::of(lockstep).and_then(|(api, _)| api.table.take())
    }

    /// The table of objects of a lock-step with its world; none if nobody asked for one.
    pub fn desk(lockstep: &mut LockStep) -> Option<Desk<'_>> {
        let t = lockstep.t();
        let (api, world) = Self::of(lockstep)?;
        api.table.as_mut().map(|table| Desk::new(table, world, t))
    }

    /// Tells the scripts, if they were started, of a pause: that it begins, lasts or ends.
    ///
    /// # Errors
    ///
    /// If a script fails.
    pub fn tell_scripts(lockstep: &mut LockStep, phase: Phase) -> Result<(), Halt> {
        let (tick, t) = (lockstep.tick(), lockstep.t());
        let Some((api, world)) = Self::of(lockstep) else { return Ok(()) };
        if !api.is_started() {
            return Ok(());
        }
        let done = api.call_scripts(phase, Instant { world, tick, t });
        done.map_err(|fault| Halt::Controller { tick, t, is_after_step: false, fault })
    }

    /// Calls a function of the script on an object, as another script or a client asks for it.
    ///
    /// # Errors
    ///
    /// There is no script or no such function, or it failed.
    pub fn call_script(
        lockstep: &mut LockStep,
        (object, kind): (Handle, Option<Kind>),
        function: &str,
        arguments: &[Value],
    ) -> Result<Vec<Value>, Refusal> {
        let now = (lockstep.tick(), lockstep.t());
        let (scripts, table, world) = Self::parts(lockstep)?;
        scripts.call_function((object, kind), (function, arguments), world, table, now)
    }

    /// Runs a text of the script's language in the script on an object.
    ///
    /// # Errors
    ///
    /// There is no script, or the text failed.
    pub fn evaluate(
        lockstep: &mut LockStep,
        (object, kind): (Handle, Option<Kind>),
        text: &str,
    ) -> Result<Vec<Value>, Refusal> {
        let now = (lockstep.tick(), lockstep.t());
        let (scripts, table, world) = Self::parts(lockstep)?;
        scripts.evaluate((object, kind), text, world, table, now)
    }

    /// Scripts, table and world of a lock-step.
    #[expect(clippy::type_complexity, reason = "three parts of one thing")]
    fn parts(lockstep: &mut LockStep) -> Result<(&mut Scripts, &mut Option<Box<Table>>, &mut World), Refusal> {
        let none = || Refusal::new("the scene has no scripts");
        let (api, world) = Self::of(lockstep).ok_or_else(none)?;
        Ok((api.scripts.as_mut().ok_or_else(none)?, &mut api.table, world))
    }

    fn is_started(&self) -> bool {
        self.scripts.as_ref().is_some_and(Scripts::is_started)
    }

    /// True if a step of clients and scripts begins at a tick.
    fn is_due(&self, tick: u64) -> bool {
        self.table.as_ref().is_some_and(|table| table.is_due(tick))
    }

    /// Calls the scripts, if there are any; they are told the time of `at`.
    fn call_scripts(&mut self, phase: Phase, at: Instant<'_>) -> Result<(), ScriptError> {
        let Some(scripts) = &mut self.scripts else { return Ok(()) };
        scripts.call(phase, at.world, &mut self.table, (at.tick, at.t))
    }
}

impl Controller for ApiController {
    fn name(&self) -> &str {
        if self.scripts.is_some() { "scripts" } else { "clients" }
    }

    fn start(&mut self, at: Instant<'_>) -> Result<(), ScriptError> {
        self.call_scripts(Phase::Initialization, Instant { tick: 0, t: 0.0, ..at })
    }

    fn actuate(&mut self, at: Instant<'_>) -> Result<(), ScriptError> {
        if let Some(table) = &mut self.table {
            table.begin_tick(at.tick, &at.world.state.totals);
        }
        if self.is_due(at.tick) {
            self.call_scripts(Phase::Actuation, at)?;
        }
        if let Some(table) = &mut self.table {
            table.move_targets();
        }
        Ok(())
    }

    fn latch(&self, commands: &mut Commands<'_>) {
        if let Some(table) = &self.table {
            table.latch(commands);
        }
    }

    fn update_proximity_sensors(&mut self, at: Instant<'_>) {
        if !self.is_due(at.tick) {
            return;
        }
        if let Some(table) = &mut self.table {
            Desk::new(table, at.world, at.t).handle_made_sensors();
        }
    }

    fn sense(&mut self, at: Instant<'_>) -> Result<(), ScriptError> {
        let Some(table) = self.table.as_mut().filter(|table| table.is_due(at.tick)) else { return Ok(()) };
        at.world.release();
        table.sense(&at.world.state.q);
        // scripts are told the time at which the step began
        let tick = at.tick - table.sample_ticks().min(at.tick);
        let t = tick as f64 * table.base_step();
        self.call_scripts(Phase::Sensing, Instant { tick, t, ..at })
    }

    fn finish(&mut self, at: Instant<'_>) -> Result<(), ScriptError> {
        if self.is_started() { self.call_scripts(Phase::Cleanup, at) } else { Ok(()) }
    }

    /// The table alone: memory of scripts cannot be copied.
    fn fork(&self) -> Forked {
        let copy = Box::new(Self { table: self.table.clone(), scripts: None });
        if self.scripts.is_some() { Forked::Part(copy, "scripts".to_owned()) } else { Forked::Whole(copy) }
    }

    fn pieces(&self) -> &[Piece] {
        self.table.as_deref().map_or(&[], Table::made_pieces)
    }

    fn detected(&mut self, sensor: usize, found: Option<Detection>) {
        if let Some(table) = &mut self.table {
            table.tell(Handle(sensor as i32 + 1), found);
        }
    }

    fn float_signal(&self, name: &str) -> Option<f64> {
        self.table.as_ref()?.floats.get(name).copied()
    }

    fn streams(&self, visit: &mut dyn FnMut(&str, &str, f64)) {
        for stream in self.table.iter().flat_map(|table| table.graphs.streams()) {
            visit(&stream.column, &stream.unit, stream.value);
        }
    }

    fn take_cleared_streams(&mut self) -> Vec<usize> {
        self.table.as_mut().map_or_else(Vec::new, |table| table.graphs.take_cleared())
    }

    fn messages(&self) -> (Vec<Message>, usize) {
        let (printed, more_prints) = self.scripts.as_ref().map_or((&[][..], 0), Scripts::messages);
        let (logged, more_logs) = self.table.as_ref().map_or((&[][..], 0), |table| table.notes().all());
        let mut all = [printed, logged].concat();
        all.sort_by(|a, b| a.t.total_cmp(&b.t));
        (all, more_prints + more_logs)
    }

    fn changes(&self) -> &[Change] {
        self.table.as_ref().map_or(&[], |table| table.changes())
    }

    fn take_stop_request(&mut self) -> bool {
        self.table.as_mut().is_some_and(|table| table.take_requests().contains(&Request::Stop))
    }
}
