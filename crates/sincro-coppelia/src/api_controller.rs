//! The V-REP/CoppeliaSim API as a controller: the object registry that clients and scripts act on, and the scripts
//! themselves.

use sincro_dynamics::world::World;

use crate::api::{self, ApiError, Handle, ObjectRegistry, Request, SimApi, Value};
use crate::host::{Call, Host, Phase, Scripts, Setting};
use sincro_scene::scenery::Piece;
use sincro_scene::script::{Kind, ScriptError};
use sincro_sim::controller::{Change, Commands, Controller, Forked, Instant, Message, SavedImage, ScriptFailure};
use sincro_sim::load::Loaded;
use sincro_sim::proximity::Detection;
use sincro_sim::restructure::Restructured;
use sincro_sim::run::{Halt, LockStep};
use sincro_sim::runtime_object::RuntimeObject;

/// Controller of a lock-step that holds the object registry, on which clients and scripts act, and the scripts of the
/// scene, if it has any. Commands that are held in the registry win over those of scene and diagram.
#[derive(Debug)]
pub struct ApiController {
    /// None while a script has it.
    registry: Option<Box<ObjectRegistry>>,
    scripts: Option<Scripts>,
}

impl ApiController {
    /// Creates a controller that clients act on through its registry, without scripts; attach it to a lock-step with
    /// [`ApiController::set_registry`].
    #[must_use]
    pub fn new(registry: ObjectRegistry) -> Self {
        Self { registry: Some(Box::new(registry)), scripts: None }
    }

    /// Creates a controller for the scripts of a scene, with a registry of its own. `start` makes their host.
    pub fn with_scripts(loaded: &Loaded, start: impl FnOnce(Setting) -> Box<dyn Host>) -> Self {
        let ticks = loaded.experiment.simulation_ticks;
        let setting = Setting { step: loaded.experiment.step * ticks as f64, seed: loaded.experiment.seed };
        let scripts = Scripts::new(start(setting));
        let mut registry = ObjectRegistry::new(loaded, ticks);
        registry.phase = api::Phase::Running;
        Self { registry: Some(Box::new(registry)), scripts: Some(scripts) }
    }

    /// That of a lock-step with its world, if it has one.
    pub(crate) fn of(lockstep: &mut LockStep) -> Option<(&mut Self, &mut World)> {
        lockstep.controller::<Self>()
    }

    /// Replaces the object registry of a lock-step, or attaches a controller with it: commands that it holds are
    /// latched from the next tick on.
    pub fn set_registry(lockstep: &mut LockStep, registry: ObjectRegistry) {
        if let Some((api, _)) = Self::of(lockstep) {
            api.registry = Some(Box::new(registry));
            return;
        }
        lockstep.attach(Box::new(Self::new(registry)));
    }

    /// Takes the object registry away from a lock-step.
    pub(crate) fn take_registry(lockstep: &mut LockStep) -> Option<Box<ObjectRegistry>> {
        Self::of(lockstep).and_then(|(api, _)| api.registry.take())
    }

    /// Typed functions of the API on the registry and world of a lock-step, at its present time; none if it has no
    /// registry.
    pub fn sim(lockstep: &mut LockStep) -> Option<SimApi<'_>> {
        let t = lockstep.t();
        let (api, world) = Self::of(lockstep)?;
        api.registry.as_mut().map(|registry| SimApi::new(registry, world, t))
    }

    /// Tells the scripts, if they were started, of a pause: that it begins, lasts or ends.
    ///
    /// # Errors
    ///
    /// If a script fails.
    pub(crate) fn notify_scripts(lockstep: &mut LockStep, phase: Phase) -> Result<(), Halt> {
        let (tick, t) = (lockstep.tick(), lockstep.t());
        let Some((api, world)) = Self::of(lockstep) else { return Ok(()) };
        if !api.is_started() {
            return Ok(());
        }
        let done = api.call_scripts(phase, Instant { world, tick, t });
        done.map_err(|fault| Halt::Controller { tick, t, is_after_step: false, fault: Box::new(fault) })
    }

    /// Calls the customization scripts of a session that is stopped, for [`Phase::Open`], [`Phase::NonSimulation`] or
    /// [`Phase::Close`].
    ///
    /// # Errors
    ///
    /// The first script that fails.
    pub(crate) fn call_stopped(lockstep: &mut LockStep, phase: Phase) -> Result<(), ScriptError> {
        let Some((api, world)) = Self::of(lockstep) else { return Ok(()) };
        api.call_scripts(phase, Instant { world, tick: 0, t: 0.0 })
    }

    /// Returns true if customization scripts live in a lock-step through all runs of a session.
    pub(crate) fn is_open(lockstep: &mut LockStep) -> bool {
        Self::of(lockstep).is_some_and(|(api, _)| api.scripts.as_ref().is_some_and(Scripts::is_open))
    }

    /// Takes scripts that live through all runs of a session away from the lock-step of one that is over.
    pub(crate) fn take_open_scripts(lockstep: &mut LockStep) -> Option<Scripts> {
        let (api, _) = Self::of(lockstep)?;
        api.scripts.take_if(|scripts| scripts.is_open()).map(Scripts::between_runs)
    }

    /// Lets scripts go on in the lock-step of the next run.
    pub(crate) fn set_scripts(lockstep: &mut LockStep, scripts: Option<Scripts>) {
        if let (Some(scripts), Some((api, _))) = (scripts, Self::of(lockstep)) {
            api.scripts = Some(scripts);
        }
    }

    /// Calls a function of the script on an object, as another script or a client asks for it.
    ///
    /// # Errors
    ///
    /// There is no script or no such function, or it failed.
    pub(crate) fn call_script(
        lockstep: &mut LockStep,
        (object, kind): (Handle, Option<Kind>),
        function: &str,
        arguments: &[Value],
    ) -> Result<Vec<Value>, ApiError> {
        let now = (lockstep.tick(), lockstep.t());
        let (scripts, registry, world) = Self::parts(lockstep)?;
        scripts.call_function((object, kind), (function, arguments), world, registry, now)
    }

    /// Lets the script on a vision sensor filter its picture; returns true if there is one that does.
    ///
    /// # Errors
    ///
    /// It has failed.
    pub(crate) fn filter_picture(lockstep: &mut LockStep, sensor: Handle) -> Result<bool, ApiError> {
        let (tick, t) = (lockstep.tick(), lockstep.t());
        let Ok((scripts, registry, world)) = Self::parts(lockstep) else { return Ok(false) };
        if !scripts.is_started() {
            return Ok(false);
        }
        scripts.host.filter_picture(Call { world, registry, tick, t }, sensor)
    }

    /// Runs a text of the script's language in the script on an object.
    ///
    /// # Errors
    ///
    /// There is no script, or the text failed.
    pub(crate) fn evaluate(
        lockstep: &mut LockStep,
        (object, kind): (Handle, Option<Kind>),
        text: &str,
    ) -> Result<Vec<Value>, ApiError> {
        let now = (lockstep.tick(), lockstep.t());
        let (scripts, registry, world) = Self::parts(lockstep)?;
        scripts.evaluate((object, kind), text, world, registry, now)
    }

    /// Scripts, registry and world of a lock-step.
    #[allow(clippy::type_complexity, reason = "three parts of one thing")]
    fn parts(
        lockstep: &mut LockStep,
    ) -> Result<(&mut Scripts, &mut Option<Box<ObjectRegistry>>, &mut World), ApiError> {
        let none = || ApiError::new("the scene has no scripts");
        let (api, world) = Self::of(lockstep).ok_or_else(none)?;
        Ok((api.scripts.as_mut().ok_or_else(none)?, &mut api.registry, world))
    }

    fn is_started(&self) -> bool {
        self.scripts.as_ref().is_some_and(Scripts::is_started)
    }

    /// True if the scene has scripts and these can be run.
    fn runs_scripts(&self) -> bool {
        let has_some = |registry: &ObjectRegistry| !registry.scene().scripts.is_empty();
        self.scripts.is_some() && self.registry.as_deref().is_none_or(has_some)
    }

    /// True if a step of clients and scripts begins at a tick.
    fn is_due(&self, tick: u64) -> bool {
        self.registry.as_ref().is_some_and(|registry| registry.is_due(tick))
    }

    /// Calls the scripts, if there are any; their time is that of `at`.
    fn call_scripts(&mut self, phase: Phase, at: Instant<'_>) -> Result<(), ScriptError> {
        let Some(scripts) = &mut self.scripts else { return Ok(()) };
        scripts.call(phase, at.world, &mut self.registry, (at.tick, at.t))?;
        self.make_bodies(at)
    }

    /// Makes the bodies that clients and scripts have told shapes to be, before the world goes on.
    fn make_bodies(&mut self, at: Instant<'_>) -> Result<(), ScriptError> {
        let Some(registry) = &mut self.registry else { return Ok(()) };
        SimApi::new(registry, at.world, at.t).make_bodies().map_err(|ApiError(message)| {
            let message = format!("shapes that become bodies: {message}");
            ScriptError { object: "/".to_owned(), at: None, message, help: None }
        })
    }
}

impl Controller for ApiController {
    fn name(&self) -> &str {
        if self.runs_scripts() { "scripts" } else { "clients" }
    }

    fn start(&mut self, at: Instant<'_>) -> Result<(), ScriptError> {
        self.call_scripts(Phase::Initialization, Instant { tick: 0, t: 0.0, ..at })
    }

    fn preview(&mut self, commands: &[f64]) {
        if let Some(registry) = &mut self.registry {
            registry.preview(commands);
        }
    }

    fn actuate(&mut self, at: Instant<'_>) -> Result<(), ScriptError> {
        if let Some(registry) = &mut self.registry {
            registry.begin_tick(at.tick, &at.world.state.totals);
        }
        if self.is_due(at.tick) {
            self.call_scripts(Phase::Actuation, Instant { world: &mut *at.world, ..at })?;
        }
        if let Some(registry) = &mut self.registry {
            registry.drop_spent_forces(at.world);
            if registry.is_due(at.tick) {
                let failed = |what: &str, ApiError(message): ApiError| {
                    let message = format!("{what}: {message}");
                    ScriptError { object: "/".to_owned(), at: None, message, help: None }
                };
                let mut sim = SimApi::new(registry, at.world, at.t);
                sim.handle_implicit_groups().map_err(|error| failed("inverse kinematics", error))?;
                sim.move_belts().map_err(|error| failed("conveyor belts", error))?;
            }
            registry.move_targets();
            registry.preview(&[]);
        }
        Ok(())
    }

    fn latch(&self, commands: &mut Commands<'_>) {
        if let Some(registry) = &self.registry {
            registry.latch(commands);
        }
    }

    fn holds_motion(&self) -> bool {
        self.registry.as_ref().is_some_and(|registry| registry.is_motion_held())
    }

    fn update_proximity_sensors(&mut self, at: Instant<'_>) {
        if !self.is_due(at.tick) {
            return;
        }
        if let Some(registry) = &mut self.registry {
            SimApi::new(registry, at.world, at.t).handle_runtime_sensors();
        }
    }

    fn sense(&mut self, at: Instant<'_>) -> Result<(), ScriptError> {
        let Some(registry) = self.registry.as_mut().filter(|registry| registry.is_due(at.tick)) else { return Ok(()) };
        registry.are_forces_spent = true;
        registry.sense(&at.world.state.q);
        // the time of scripts is that at which the step began
        let tick = at.tick - registry.sample_ticks().min(at.tick);
        let t = tick as f64 * registry.base_step();
        self.call_scripts(Phase::Sensing, Instant { tick, t, ..at })
    }

    fn finish(&mut self, at: Instant<'_>) -> Result<(), ScriptError> {
        if self.is_started() { self.call_scripts(Phase::Cleanup, at) } else { Ok(()) }
    }

    /// The registry alone: memory of scripts cannot be copied.
    fn fork(&self) -> Forked {
        let mut copy = Box::new(Self { registry: self.registry.clone(), scripts: None });
        // pictures are kept once
        drop(copy.take_images());
        if self.runs_scripts() { Forked::Part(copy, "scripts".to_owned()) } else { Forked::Whole(copy) }
    }

    fn pieces(&self) -> &[Piece] {
        self.registry.as_deref().map_or(&[], ObjectRegistry::runtime_pieces)
    }

    fn detected_objects(&self, sensor: usize) -> Option<Vec<usize>> {
        self.registry.as_ref()?.detected_objects(sensor)
    }

    fn is_undetectable(&self, object: usize) -> bool {
        self.registry.as_ref().is_some_and(|registry| registry.is_undetectable(Handle(object as i32 + 1)))
    }

    fn runtime_objects(&self, visit: &mut dyn FnMut(&RuntimeObject<'_>)) {
        if let Some(registry) = &self.registry {
            registry.visit_runtime_objects(visit);
        }
    }

    fn detected(&mut self, sensor: usize, found: Option<Detection>) {
        if let Some(registry) = &mut self.registry {
            registry.sampled(Handle(sensor as i32 + 1), found);
        }
    }

    fn float_signal(&self, name: &str) -> Option<f64> {
        self.registry.as_ref()?.floats.get(name).copied()
    }

    fn streams(&self, visit: &mut dyn FnMut(&str, &str, f64)) {
        for stream in self.registry.iter().flat_map(|registry| registry.graphs.streams()) {
            visit(&stream.column, &stream.unit, stream.value);
        }
    }

    fn take_cleared_streams(&mut self) -> Vec<usize> {
        self.registry.as_mut().map_or_else(Vec::new, |registry| registry.graphs.take_cleared())
    }

    fn messages(&self) -> (Vec<Message>, usize) {
        let (printed, more_prints) = self.scripts.as_ref().map_or((&[][..], 0), Scripts::messages);
        let (logged, more_logs) = self.registry.as_ref().map_or((&[][..], 0), |registry| registry.notes().all());
        let mut all = [printed, logged].concat();
        all.sort_by(|a, b| a.t.total_cmp(&b.t));
        (all, more_prints + more_logs)
    }

    fn script_failures(&self) -> Vec<ScriptFailure> {
        self.scripts.as_ref().map_or_else(Vec::new, Scripts::failures)
    }

    fn take_images(&mut self) -> Vec<SavedImage> {
        let images =
            self.registry.as_mut().map_or_else(Default::default, |registry| std::mem::take(&mut registry.images));
        images.into_iter().map(|(name, bytes)| SavedImage { name, bytes }).collect()
    }

    fn changes(&self) -> &[Change] {
        self.registry.as_ref().map_or(&[], |registry| registry.changes())
    }

    fn take_restructured(&mut self) -> Vec<Restructured> {
        self.registry.as_mut().and_then(|registry| registry.take_restructured()).into_iter().collect()
    }

    fn restructured(&mut self, change: &Restructured) -> Result<(), String> {
        if let Some(registry) = &mut self.registry {
            registry.adopt_structure(change);
        }
        Ok(())
    }

    fn take_stop_request(&mut self) -> bool {
        self.registry.as_mut().is_some_and(|registry| registry.take_requests().contains(&Request::Stop))
    }
}
