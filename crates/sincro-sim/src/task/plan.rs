//! A task with its names resolved, and the draws of an episode.

use std::sync::Arc;

use sincro_blocks::library::sources::random::{gaussian, uniform};
use sincro_blocks::program::{Program, Step};
use sincro_dynamics::batch::{is_time_invariant, obstacle_to_lanes, obstacle_to_programs};
use sincro_dynamics::model::Model;
use sincro_dynamics::signal::Signal;
use sincro_dynamics::state::State;
use sincro_dynamics::world::MethodKind;
use sincro_math::Real;
use sincro_math::expression::Expression;
use sincro_math::random::splitmix64;

use super::compiled::CompiledTask;
use crate::load::Loaded;
use crate::run::{LockStep, method_for};
use sincro_scene::diagnostic::{Diagnostic, Diagnostics};
use sincro_scene::diagram::{ControlDiagram, is_known_at_ticks_only};
use sincro_scene::experiment::task::{Distribution, Target, Task, command_index};
use sincro_scene::overrides::Override;
use sincro_scene::record::probe::{needs_kinematics, of_state};
use sincro_scene::record::{Probe, Recorder, catalogue};
use sincro_scene::scene::Scene;
use sincro_scene::sensor::SensorKind;

/// Maximum number of time events of one source in an episode that are looked at.
const MAX_TIME_EVENTS: usize = 100_000;

/// A formula, the plain ones known as such.
#[derive(Clone, Debug)]
pub(super) enum Formula {
    /// A number of the list.
    Slot(usize),
    /// A constant.
    Constant(f64),
    /// Anything else.
    Expression(Expression),
}

impl Formula {
    fn of(expression: &Expression, slots: &[String]) -> Self {
        if let Some(value) = expression.constant() {
            return Self::Constant(value);
        }
        let slot = slots.iter().position(|slot| slot == expression.text().trim());
        slot.map_or_else(|| Self::Expression(expression.clone()), Self::Slot)
    }

    /// Value for a list of numbers.
    #[inline]
    pub fn eval<R: Real>(&self, values: &[R], stack: &mut Vec<R>) -> R {
        match self {
            Self::Slot(slot) => values[*slot],
            Self::Constant(value) => R::splat(*value),
            Self::Expression(expression) => expression.eval(values, stack),
        }
    }
}

/// The number, without the sign of a zero: programs do not keep it.
#[inline]
pub(super) fn unsigned_zero(x: f64) -> f64 {
    x + 0.0
}

/// Copies numbers without the signs of zeros.
#[inline]
pub(super) fn copy_unsigned(to: &mut [f64], from: &[f64]) {
    for (to, x) in to.iter_mut().zip(from) {
        *to = unsigned_zero(*x);
    }
}

/// Coordinate or velocity that an episode starts with.
#[derive(Clone, Copy, Debug)]
enum StartAt {
    Coordinate(usize),
    Rate(usize),
}

/// Task of an experiment, resolved against its scene: names of signals and commands replaced by indices. Part of
/// [`TaskWorlds`](super::TaskWorlds).
#[derive(Clone, Debug)]
pub struct Plan {
    pub(super) loaded: Loaded,
    pub(super) task: Arc<Task>,
    pub(super) method: MethodKind,
    /// Probes of the signals; of the diagram and the world.
    pub(super) probes: Vec<Probe>,
    pub(super) needs_kinematics: bool,
    pub(super) observations: Vec<Formula>,
    pub(super) reward: Formula,
    pub(super) terminated: Option<Formula>,
    /// Command of each action, if it is one.
    pub(super) of_actions: Vec<Option<usize>>,
    /// Commands by formulas.
    pub(super) of_formulas: Vec<(usize, Formula)>,
    /// Commands that signals of the scene give which change with time, and which the task leaves to them.
    pub(super) varying_commands: Vec<usize>,
    /// State at which a run begins: limits and contacts that the initial one has reached have acted.
    pub start: State<f64>,
    starts: Vec<(usize, StartAt)>,
    /// Reason why the recursions cannot advance the worlds in lanes.
    recursions_refused: Option<String>,
    /// Programs of an action, where they were compiled.
    pub(super) compiled: Option<CompiledTask>,
}

/// Start of an episode, as it was drawn.
#[derive(Clone, Debug)]
pub(super) struct Drawn {
    /// State of the world.
    pub state: State<f64>,
    /// Random numbers with names.
    pub named: Vec<f64>,
    /// Numbers of the scene and the diagram.
    pub overrides: Vec<Override>,
    /// Seed of the noise of sensors, in place of that of the experiment.
    pub noise_seed: u64,
}

impl Plan {
    /// Resolves the task of an experiment.
    ///
    /// # Errors
    ///
    /// Diagnostics: the experiment has no task, a signal of it does not exist, or the scene refuses a number that is
    /// drawn.
    pub fn new(loaded: &Loaded) -> Result<Self, Diagnostics> {
        let Some(task) = loaded.experiment.task.clone() else {
            let found = Diagnostic::without_location("the experiment has no task");
            return Err(found.with_help("add a table `[task]` to `experiment.toml`: docs/python.md").into());
        };
        let model = &*loaded.scene.model;
        let entries = loaded.controller.as_ref().map(ControlDiagram::entries).unwrap_or_default();
        // as they were when the scene was loaded: all of them are there
        drop(Recorder::new(&task.signals, model, &entries)?);
        let all: Vec<_> = catalogue(model).into_iter().chain(entries).collect();
        let probe = |name: &str| all.iter().find(|entry| entry.name == name).map(|entry| entry.probe);
        let probes: Vec<Probe> = task.signals.iter().filter_map(|signal| probe(&signal.value)).collect();
        let starts = task.random.iter().enumerate().filter_map(|(k, random)| {
            let Target::Start(signal) = &random.target else { return None };
            match probe(&signal.value)? {
                Probe::Coordinate(i) => Some((k, StartAt::Coordinate(i))),
                Probe::Rate(i) => Some((k, StartAt::Rate(i))),
                _ => None,
            }
        });
        let command = |name: &str| command_index(model, name);
        let of = |expression: &Expression| Formula::of(expression, &task.slots);
        let mut plan = Self {
            method: method_for(loaded).0,
            needs_kinematics: probes.iter().any(|probe| needs_kinematics(*probe)),
            probes,
            observations: task.observations.iter().map(of).collect(),
            reward: of(&task.reward),
            terminated: task.terminated.as_ref().map(of),
            of_actions: task.actions.iter().map(|a| a.command.as_ref().and_then(|c| command(&c.value))).collect(),
            of_formulas: task.commands.iter().filter_map(|(c, f)| Some((command(&c.value)?, of(f)))).collect(),
            varying_commands: Vec::new(),
            start: loaded.scene.initial.clone(),
            starts: starts.collect(),
            recursions_refused: None,
            compiled: None,
            loaded: loaded.clone(),
            task,
        };
        let is_varying = |command: &usize| !matches!(loaded.scene.commands[*command], Signal::Constant(_));
        let left = |command: &usize| !plan.own_commands().any(|own| own == *command);
        plan.varying_commands = (0..plan.n_commands()).filter(is_varying).filter(left).collect();
        plan.recursions_refused = plan.obstacle_to_recursions();
        if plan.recursions_refused.is_none() && plan.switches() {
            plan.start = LockStep::new(loaded, plan.method, false).state().clone();
        }
        let middle = plan.drawn(0, 0);
        if !middle.overrides.is_empty() {
            loaded.with_more_overrides(&middle.overrides)?;
        }
        Ok(plan)
    }

    /// Part of the scene that keeps the recursions from advancing its worlds in lanes, in words.
    fn obstacle_to_recursions(&self) -> Option<String> {
        let model = &self.scene().model;
        let common = self.common_obstacle().or_else(|| obstacle_to_lanes(model, self.method)).map(ToOwned::to_owned);
        common.or_else(|| self.obstacle_in_diagram()).or_else(|| self.obstacle_in_sensors()).or_else(|| {
            let is_known = |probe: &Probe| is_of_state(&self.loaded.scene.model, *probe) || self.is_of_lanes(*probe);
            let words = "a signal that lanes do not compute, such as a contact, an acceleration or a proximity sensor";
            (!self.probes.iter().all(is_known)).then(|| words.to_owned())
        })
    }

    /// Returns true if limited drives, friction, limits of joints or contacts may change what acts from step to step.
    fn switches(&self) -> bool {
        let model = &self.scene().model;
        model.has_limited_drives() || !model.constraints().is_empty()
    }

    /// Sensors that lanes cannot measure though they can others of their kind, in words.
    fn obstacle_in_sensors(&self) -> Option<String> {
        let reads_accelerations = || {
            let kinds = self.read_sensor_values().filter_map(|value| self.sensor_of(value));
            kinds.into_iter().any(|kind| matches!(kind, SensorKind::Imu { .. }))
        };
        let words = "a sensor of accelerations, which contacts, limits of joints, limited drives and friction change";
        (self.switches() && reads_accelerations()).then(|| words.to_owned())
    }

    /// Part of the diagram that keeps it from running in or beside lanes, in words.
    fn obstacle_in_diagram(&self) -> Option<String> {
        let wiring = &self.loaded.controller.as_ref()?.wiring;
        let program = wiring.program();
        if let Some(step) = program.steps.iter().find(|step| step.template.zero_crossing_count().is_some()) {
            return Some(format!("block `{}` of the diagram, which has events between ticks", step.path));
        }
        if program.is_continuous() && !self.scene().model.constraints().is_empty() {
            return Some("a continuous diagram beside limits of joints or contacts".to_owned());
        }
        if !wiring.late.is_empty() {
            return Some("a diagram that measures accelerations or motor torques".to_owned());
        }
        // steps of semi-implicit Euler do not end at time events
        if self.method != MethodKind::SemiImplicitEuler
            && let Some((path, t)) = self.event_between_ticks(program)
        {
            let words = "whose jump or corner at t =";
            return Some(format!("block `{path}` of the diagram, {words} {t} s does not fall exactly on a tick"));
        }
        let measured = |probe: &Probe| !is_known_at_ticks_only(*probe) || self.is_of_lanes(*probe);
        let words = "a diagram that measures a contact, a proximity sensor, or a mean over the step";
        (!wiring.early.iter().flat_map(|reading| &reading.probes).all(measured)).then(|| words.to_owned())
    }

    /// First time event of an episode that would end a step of one world before its next tick: path of the block and
    /// time `[s]`. A source with very many events counts as one that has such an event.
    fn event_between_ticks<'a>(&self, program: &'a Program) -> Option<(&'a str, f64)> {
        let h = self.loaded.experiment.step;
        let end = self.task.max_actions.saturating_mul(self.task.ticks) as f64 * h;
        let splits = |step: &Step, tick: f64| {
            let (start, event) = (tick * h, step.template.next_time_event(tick * h));
            event < start + h
        };
        program.steps.iter().filter(|step| step.is_minor).find_map(|step| {
            let (mut t, mut n_events) = (0.0, 0);
            loop {
                let event = step.template.next_time_event(t);
                // beyond the last tick, or none
                if event > end || event.is_nan() {
                    return None;
                }
                let tick = (event / h).floor();
                let near = [tick - 1.0, tick, tick + 1.0].into_iter().filter(|tick| *tick >= 0.0);
                n_events += 1;
                if n_events > MAX_TIME_EVENTS || near.into_iter().any(|tick| splits(step, tick)) {
                    return Some((step.path.as_str(), event));
                }
                t = event;
            }
        })
    }

    /// Returns true for the value of a sensor that the state and the accelerations decide, with its noise.
    fn is_of_lanes(&self, probe: Probe) -> bool {
        let Probe::Sensor(value) = probe else { return false };
        !matches!(self.sensor_of(value), None | Some(SensorKind::Contact { .. } | SensorKind::Proximity { .. }))
    }

    /// Kind of the sensor that a value belongs to, by its number among those of all sensors.
    fn sensor_of(&self, value: usize) -> Option<SensorKind> {
        let sensors = self.loaded.scene.sensors.iter();
        sensors.flat_map(|sensor| sensor.kind.values().into_iter().map(|_| sensor.kind)).nth(value)
    }

    /// Values of sensors that the task or its diagram reads, by their numbers among those of all sensors.
    pub(super) fn read_sensor_values(&self) -> impl Iterator<Item = usize> {
        let wiring = self.loaded.controller.as_ref().map(|controller| &controller.wiring);
        let of_diagram = wiring.into_iter().flat_map(|wiring| &wiring.early).flat_map(|reading| &reading.probes);
        self.probes.iter().chain(of_diagram).filter_map(|probe| match probe {
            Probe::Sensor(value) => Some(*value),
            _ => None,
        })
    }

    /// Part of the scene that keeps compiled programs from advancing its worlds, in words; its diagram apart.
    pub(super) fn obstacle_to_programs(&self) -> Option<&str> {
        let model = &self.loaded.scene.model;
        let of_model = || obstacle_to_programs(model, self.method).or_else(|| obstacle_to_lanes(model, self.method));
        self.common_obstacle().or_else(of_model).or_else(|| {
            let scene = &self.loaded.scene;
            if !scene.commands.iter().all(|s| matches!(s, Signal::Constant(_))) {
                return Some("signals of the scene that change with time");
            }
            (!self.probes.iter().all(|probe| is_of_state(&scene.model, *probe))).then_some(
                "a signal that the state alone does not decide, such as a sensor, a contact or an acceleration",
            )
        })
    }

    /// Part of the scene that neither recursions nor programs advance in lanes, in words.
    fn common_obstacle(&self) -> Option<&'static str> {
        let scene = &self.loaded.scene;
        let fixed = matches!(self.method, MethodKind::SemiImplicitEuler | MethodKind::Rk4 | MethodKind::Implicit);
        let model = &*scene.model;
        if !fixed {
            return Some("an integrator with error control: set `rk4`, `implicit` or `semi-implicit-euler`");
        }
        if !self.loaded.controllers.is_empty() {
            return Some("a controller in another language");
        }
        if !scene.scripts.is_empty() {
            return Some("scripts");
        }
        if self.task.random.iter().any(|random| matches!(random.target, Target::Parameter(_))) {
            return Some("numbers of the scene that are drawn for each episode");
        }
        if !is_time_invariant(model) {
            return Some("forces, gusts or turbulence that change with time");
        }
        (sincro_math::lanes::width() == 1).then_some("a processor without AVX2")
    }

    /// Returns the reason in English why SIMD lanes cannot advance the worlds, such as a diagram, so that each is
    /// advanced alone; `None` if lanes do.
    #[must_use]
    pub fn lanes_refused(&self) -> Option<&str> {
        if self.compiled.is_some() { None } else { self.recursions_refused.as_deref() }
    }

    /// As [`Plan::lanes_refused`], for the recursions.
    pub(super) fn recursions_refused(&self) -> Option<&str> {
        self.recursions_refused.as_deref()
    }

    /// Commands that the task sets, itself or by formulas.
    pub(super) fn own_commands(&self) -> impl Iterator<Item = usize> {
        self.of_actions.iter().flatten().copied().chain(self.of_formulas.iter().map(|(command, _)| *command))
    }

    /// State at which an episode begins: `start`, but for what was drawn.
    pub(super) fn with_drawn(&self, start: &State<f64>, drawn: &State<f64>) -> State<f64> {
        let (mut state, nominal) = (start.clone(), &self.loaded.scene.initial);
        let of_drawn = drawn.q.iter().zip(&nominal.q).chain(drawn.v.iter().zip(&nominal.v));
        for (now, (drawn, nominal)) in state.q.iter_mut().chain(&mut state.v).zip(of_drawn) {
            *now = if drawn == nominal { *now } else { *drawn };
        }
        state
    }

    /// Returns the scene of all worlds, as its files describe it before random numbers are drawn.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        &self.loaded.scene
    }

    /// Returns the number of entries of an observation: the formulas of [`Task::observations`].
    #[must_use]
    pub fn n_observations(&self) -> usize {
        self.observations.len()
    }

    /// Returns the number of entries of an action: those of [`Task::actions`].
    #[must_use]
    pub fn n_actions(&self) -> usize {
        self.task.actions.len()
    }

    /// Number of random numbers with names.
    pub(super) fn n_named(&self) -> usize {
        self.task.random.iter().filter(|random| matches!(random.target, Target::Name(_))).count()
    }

    /// Number of coordinates, velocities and rotor states of the model.
    pub(super) fn n_state(&self) -> usize {
        let model = &self.loaded.scene.model;
        model.n_q() + model.n_v() + model.n_rotor_states()
    }

    /// Number of commands of the model.
    pub(super) fn n_commands(&self) -> usize {
        self.loaded.scene.commands.len()
    }

    /// Commands of the scene itself, in the order of the model.
    pub(super) fn commands(&self) -> Vec<f64> {
        self.loaded.scene.commands.iter().map(|signal| signal.value(0.0)).collect()
    }

    /// Returns the task as the experiment has it: formulas, actions, random numbers.
    #[must_use]
    pub fn task(&self) -> &Task {
        &self.task
    }

    /// Returns the time between two actions `[s]`.
    #[must_use]
    pub fn period(&self) -> f64 {
        self.task.ticks as f64 * self.loaded.experiment.step
    }

    /// The actions as they act: within their ranges; of those with values the nearest.
    pub(super) fn acting(&self, given: &[f64], out: &mut [f64]) {
        for ((out, x), action) in out.iter_mut().zip(given).zip(&self.task.actions) {
            *out = unsigned_zero(action.space.acting(*x));
        }
    }

    /// Draws of an episode: number `k` is number `k` of the generator of the seed's episode, whatever was drawn before.
    pub(super) fn drawn(&self, seed: u64, episode: u64) -> Drawn {
        let state = self.loaded.scene.initial.clone();
        let mut drawn = Drawn { state, named: Vec::new(), overrides: Vec::new(), noise_seed: 0 };
        self.draw(seed, episode, &mut drawn);
        drawn
    }

    /// As [`Plan::drawn`], into what an earlier call gave.
    pub(super) fn draw(&self, seed: u64, episode: u64, drawn: &mut Drawn) {
        let key = splitmix64(seed, episode);
        // by a number that no random number of the task has
        drawn.noise_seed = splitmix64(key, u64::MAX) ^ self.loaded.experiment.seed;
        let value = |k: usize| {
            let key = splitmix64(key, k as u64);
            match self.task.random[k].distribution {
                Distribution::Uniform(low, high) => low + (high - low) * uniform(key, 0),
                Distribution::Normal(mean, deviation) => mean + deviation * gaussian(key, 0),
            }
        };
        for (k, at) in &self.starts {
            match at {
                StartAt::Coordinate(i) => drawn.state.q[*i] = value(*k),
                StartAt::Rate(i) => drawn.state.v[*i] = value(*k),
            }
        }
        drawn.named.clear();
        drawn.overrides.clear();
        for (k, random) in self.task.random.iter().enumerate() {
            match &random.target {
                Target::Name(_) => drawn.named.push(value(k)),
                Target::Parameter(path) => drawn.overrides.push(Override::new(&path.value, &format!("{:?}", value(k)))),
                Target::Start(_) => {}
            }
        }
    }
}

/// Returns true if the state of the world, its commands and its diagram decide a probe.
fn is_of_state(model: &Model<f64>, probe: Probe) -> bool {
    use sincro_dynamics::kinematics;
    use sincro_dynamics::scratch::Scratch;
    use sincro_scene::record::probe::View;

    if matches!(probe, Probe::Command(_) | Probe::Signal(_)) {
        return true;
    }
    let (state, mut scratch) = (State::new(model), Scratch::new(model));
    kinematics::motions(model, &state.q, &state.v, &vec![0.0; model.n_v()], &mut scratch);
    let State { q, v, rotors, commands, .. } = &state;
    of_state(&View { t: 0.0, model, q, v, rotors, commands, scratch: &scratch }, probe).is_some()
}
