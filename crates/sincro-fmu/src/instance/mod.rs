//! An FMU at work: the simulation behind the C interface, in safe Rust.
//!
//! Between two communication points the FMU makes whole base steps of the same lock-step that `sincro run` makes, so
//! that its numbers are those of a run, to the bit. Inputs stand in place of constant commands of the scene and are
//! latched at each base step. Outputs are computed when they are asked for, at most once an instant.

mod derivatives;
mod equations;
mod exchange;
mod state;

use std::path::Path;

use sincro_scene::diagram::ControlDiagram;
use sincro_scene::overrides::Override;
use sincro_scene::record::Recorder;
use sincro_sim::results::Status;
use sincro_sim::run::{Followed, Halt, LockStep, method_for};
use sincro_sim::trace::Trace;
use sincro_sim::{Extensions, Loaded, load_without_variants};

use crate::manifest::Manifest;
use crate::tunable::{self, Tunable};
use crate::variables::{Catalogue, Role};
use exchange::Exchange;
pub use state::FmuState;

/// Share of the base step by which times of an importer may miss those of the FMU.
const SAME_TIME: f64 = 1e-6;

/// Instance of an exported scene: what the C interface of an FMU drives. It is created from the resources, takes
/// parameters, begins, and then makes base steps (co-simulation) or evaluates derivatives (model exchange). Errors are
/// texts for the importer's log.
#[derive(Debug)]
pub struct Instance {
    loaded: Loaded,
    catalogue: Catalogue,
    base: Vec<Override>,
    has_states: bool,
    /// Present values of parameters and inputs, by value reference; not a number for other variables.
    values: Vec<f64>,
    /// Time of tick 0 `[s]`.
    start: f64,
    run: Option<Run>,
}

/// A simulation under way.
#[derive(Debug)]
struct Run {
    loaded: Loaded,
    lockstep: LockStep,
    recorder: Recorder,
    /// Changes of the structure that the recorder has followed.
    structure: Followed,
    /// Values of parameters that it began with.
    begun_with: Vec<f64>,
    trace: Trace,
    row: Vec<f64>,
    /// True if `row` is that of the present instant.
    is_observed: bool,
    /// True once the row of the start was made.
    is_begun: bool,
    /// Memory of the recorder while a row is made.
    memory: Vec<f64>,
    /// Messages of scripts that were told already.
    n_told: usize,
    ended: Option<String>,
    /// The equations, for model exchange.
    exchange: Option<Box<Exchange>>,
    /// In co-simulation, the equations at the last communication point at which they were asked for.
    followed: Option<Box<Exchange>>,
    /// True if `followed` is at the present instant.
    is_followed: bool,
}

/// Outcome of [`Instance::advance`], one base step.
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// The step was made; time has advanced by [`Instance::step_size`].
    Made,
    /// The simulation has ended, with the reason; the state is that of the last good instant.
    Ended(String),
}

impl Instance {
    /// Loads the scene in the folder of resources of an unpacked FMU. `token` is the identifier in the model
    /// description (`guid` or `instantiationToken`), `extensions` are the languages and loaders that the scene may
    /// need.
    ///
    /// # Errors
    ///
    /// The resources are incomplete, belong to a model description with another token, or the scene cannot be loaded.
    pub fn new(resources: &Path, token: &str, extensions: Extensions) -> Result<Self, String> {
        let manifest = Manifest::read(resources)?;
        if manifest.token != token {
            return Err(format!(
                "the model description has the token `{token}`, the resources have `{}`",
                manifest.token
            ));
        }
        let base = manifest.overrides();
        let loaded = load_without_variants(&resources.join(&manifest.scene), &base, extensions)
            .map_err(|found| found.to_string())?;
        let catalogue =
            Catalogue::new(&loaded, &base, manifest.outputs, manifest.has_states).map_err(|found| found.to_string())?;
        let values = starts(&catalogue);
        let has_states = manifest.has_states;
        Ok(Self { loaded, catalogue, base, has_states, values, start: 0.0, run: None })
    }

    /// Variables of the FMU with their units, start values and roles; the index of a variable is its value reference.
    #[must_use]
    pub fn catalogue(&self) -> &Catalogue {
        &self.catalogue
    }

    /// Base step of the scene `[s]`, of which communication steps are whole multiples.
    #[must_use]
    pub fn step_size(&self) -> f64 {
        self.loaded.experiment.step
    }

    /// Present simulation time `[s]`; the start time before the run has begun.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.start
            + self.run.as_ref().map_or(0.0, |run| match &run.exchange {
                Some(exchange) => exchange.time(),
                None => run.lockstep.t(),
            })
    }

    /// Returns true if [`Instance::save`] can save the state of a run whole: the scene has no scripts, which keep a
    /// memory of their own.
    #[must_use]
    pub fn can_save(&self) -> bool {
        can_save(&self.loaded)
    }

    /// Sets the time at which the simulation starts `[s]`, 0 by default; to be called before the run begins.
    pub fn set_start_time(&mut self, start: f64) {
        self.start = start;
    }

    /// Begins the run with the parameters and inputs as they were set; nothing if it has begun.
    ///
    /// # Errors
    ///
    /// The parameters do not fit the scene, or its controllers cannot start; the run has then not begun.
    pub fn begin(&mut self) -> Result<(), String> {
        if self.run.is_some() {
            return Ok(());
        }
        let changed = self.changed_parameters();
        let loaded = if changed.is_empty() {
            self.loaded.clone()
        } else {
            let all: Vec<Override> = self.base.iter().cloned().chain(changed).collect();
            self.loaded.with_overrides_without_variants(&all).map_err(|found| found.to_string())?
        };
        let mut run = Run::new(loaded, &self.catalogue, self.values.clone())?;
        for (vr, _, command) in self.catalogue.with_role(as_input) {
            run.lockstep.hold_command(command, self.values[vr as usize]);
        }
        self.run = Some(run);
        Ok(())
    }

    /// Goes back to before the start; parameters and inputs get the values of the export.
    pub fn reset(&mut self) {
        self.run = None;
        self.values = starts(&self.catalogue);
    }

    /// Goes back to before the start; parameters and inputs keep their values.
    pub fn rewind(&mut self) {
        self.run = None;
    }

    /// Sets the variable of value reference `vr`, a parameter or an input, in its unit. Before the run has begun every
    /// parameter can be set, then only inputs and, in co-simulation, tunable parameters.
    ///
    /// # Errors
    ///
    /// There is no such variable, it is computed or cannot be set now, or the value is not finite or not allowed (a
    /// negative mass).
    pub fn set(&mut self, vr: u32, value: f64) -> Result<(), String> {
        let variable = self.catalogue.variables.get(vr as usize).ok_or_else(|| format!("there is no variable {vr}"))?;
        if !value.is_finite() {
            return Err(format!("`{}` cannot be {value}", variable.name));
        }
        match (&variable.role, &mut self.run) {
            (Role::Input(command), run) => {
                if let Some(run) = run {
                    run.lockstep.hold_command(*command, value);
                    run.is_followed = false;
                    if let Some(exchange) = &mut run.exchange {
                        exchange.hold_command(*command, value);
                    }
                }
            }
            (Role::Fixed(_) | Role::Tunable(..), None) => {}
            (Role::Tunable(..), Some(Run { exchange: Some(_), .. })) => {
                return Err(format!(
                    "`{}` is fixed in model exchange: set it before the simulation starts",
                    variable.name
                ));
            }
            (Role::Tunable(_, what), Some(run)) => {
                let world = run.lockstep.world();
                tunable::set(world, what, value).map_err(|why| format!("`{}`: {why}", variable.name))?;
                run.is_observed = false;
                (run.followed, run.is_followed) = (None, false);
            }
            (Role::Fixed(_), Some(_)) => {
                return Err(format!("`{}` is a fixed parameter: set it before the simulation starts", variable.name));
            }
            _ => return Err(format!("`{}` is computed and cannot be set", variable.name)),
        }
        self.values[vr as usize] = value;
        Ok(())
    }

    /// Returns the value of the variable of value reference `vr` in its unit, at the present instant. An output begins
    /// the run if it has not begun.
    ///
    /// # Errors
    ///
    /// There is no such variable, or the run cannot begin.
    #[inline]
    pub fn get(&mut self, vr: u32) -> Result<f64, String> {
        let variable = self.catalogue.variables.get(vr as usize).ok_or_else(|| format!("there is no variable {vr}"))?;
        match variable.role {
            Role::Time => Ok(self.time()),
            Role::Output(k) => {
                self.begin()?;
                let run = self.run.as_mut().ok_or("the run has not begun")?;
                if let Some(exchange) = &mut run.exchange {
                    return Ok(exchange.output(k));
                }
                run.observe();
                Ok(run.row[k + 1])
            }
            Role::State(k) => Ok(self.equations()?.states()[k]),
            Role::Derivative(k) => {
                let mut all = vec![0.0; self.catalogue.n_states];
                self.equations()?.derivatives(&mut all)?;
                Ok(all[k])
            }
            Role::Fixed(_) | Role::Tunable(..) | Role::Input(_) => Ok(self.values[vr as usize]),
        }
    }

    /// Number of base steps in a communication step from `time` to `time + span`, both `[s]`.
    ///
    /// # Errors
    ///
    /// `time` is not the present time, or `span` is no whole number of base steps (within 10⁻⁶ of one); the text says
    /// what to change.
    pub fn steps_to(&self, time: f64, span: f64) -> Result<u64, String> {
        let (h, now) = (self.step_size(), self.time());
        // times of an importer are often sums: their rounding grows with the number of terms
        let slack = SAME_TIME * h;
        if (time - now).abs() > slack || !time.is_finite() {
            return Err(format!("a step from {time} s was asked for, but the FMU stands at {now} s"));
        }
        let ratio = (time + span - now) / h;
        let n = ratio.round();
        let is_whole = ratio.is_finite() && (ratio - n).abs() <= SAME_TIME;
        if !is_whole || !(0.0..=1e15).contains(&n) {
            return Err(format!(
                "a communication step of {span} s is no whole number of base steps of {h} s: the controllers of the scene act \
                 every {h} s; take a multiple of it, or export the scene with a smaller `step`"
            ));
        }
        Ok(n as u64)
    }

    /// Begins a communication step: outputs that are means are averaged from now on. Nothing before the run has begun.
    pub fn begin_step(&mut self) {
        if let Some(run) = &mut self.run {
            run.begin_step();
        }
    }

    /// Makes one base step of co-simulation, with the inputs as they are set.
    ///
    /// # Errors
    ///
    /// The run has not begun. A simulation that stops is no error: see [`Step::Ended`].
    pub fn advance(&mut self) -> Result<Step, String> {
        let run = self.run.as_mut().ok_or("the run has not begun")?;
        Ok(run.advance())
    }

    /// Takes the messages that scripts have printed since the last call, in their order, each as `object: text`.
    pub fn take_messages(&mut self) -> Vec<String> {
        let Some(run) = &mut self.run else { return Vec::new() };
        let (messages, _) = run.lockstep.messages();
        let new = messages.iter().skip(run.n_told).map(|m| format!("{}: {}", m.object, m.text)).collect();
        run.n_told = messages.len();
        new
    }

    /// Returns true if the scene has scripts, whose messages [`Instance::take_messages`] gives.
    #[must_use]
    pub fn has_scripts(&self) -> bool {
        !self.loaded.scene.scripts.is_empty()
    }

    /// Hash of all states so far, the one that `sincro run` prints for the same run; none before the run has begun.
    #[must_use]
    pub fn trace(&self) -> Option<Trace> {
        self.run.as_ref().map(|run| run.trace)
    }

    /// Ends the run: scripts have their cleanup called. Nothing before the run has begun.
    ///
    /// # Errors
    ///
    /// A script fails in its cleanup.
    pub fn end(&mut self) -> Result<(), String> {
        match &mut self.run {
            Some(run) => run.end(),
            None => Ok(()),
        }
    }

    /// Returns true if the FMU was exported for model exchange: it has continuous states among its variables.
    #[must_use]
    pub fn has_model_exchange(&self) -> bool {
        self.has_states
    }

    /// Begins the run, if it has not begun, and prepares the equations for model exchange.
    ///
    /// # Errors
    ///
    /// The run cannot begin, or a block of the diagram gives what is not a number.
    pub fn start_exchange(&mut self) -> Result<(), String> {
        self.begin()?;
        self.exchange().map(|_| ())
    }

    fn exchange(&mut self) -> Result<&mut Exchange, String> {
        self.begin()?;
        let run = self.run.as_mut().ok_or("the run has not begun")?;
        if run.exchange.is_none() {
            let made = Exchange::new(&run.loaded, &self.catalogue, run.lockstep.signals_of_scene(), &[])?;
            run.exchange = Some(Box::new(made));
        }
        run.exchange.as_deref_mut().ok_or_else(|| "there are no equations".into())
    }

    /// The equations at the present instant: those that the importer integrates, or those of the lock-step.
    fn equations(&mut self) -> Result<&mut Exchange, String> {
        if !self.has_states {
            return Err("this FMU was exported without its equations: export it with --kind both".into());
        }
        self.begin()?;
        let tuned: Vec<(Tunable, f64)> = match &self.run {
            Some(run) if run.exchange.is_none() && run.followed.is_none() => self.tuned(&run.begun_with),
            _ => Vec::new(),
        };
        let run = self.run.as_mut().ok_or("the run has not begun")?;
        if run.exchange.is_none() && !run.is_followed {
            if run.followed.is_none() {
                let made = Exchange::new(&run.loaded, &self.catalogue, run.lockstep.signals_of_scene(), &tuned)?;
                run.followed = Some(Box::new(made));
            }
            if let Some(followed) = &mut run.followed {
                followed.follow(&run.lockstep);
            }
            run.is_followed = true;
        }
        run.exchange.as_deref_mut().or(run.followed.as_deref_mut()).ok_or_else(|| "there are no equations".into())
    }

    /// Tunable parameters that have changed since the run began.
    fn tuned(&self, begun_with: &[f64]) -> Vec<(Tunable, f64)> {
        let tunables =
            self.catalogue.with_role(|role| if let Role::Tunable(_, what) = role { Some(what.clone()) } else { None });
        let now = tunables.map(|(vr, _, what)| (vr as usize, what));
        now.filter(|(k, _)| self.values[*k] != begun_with[*k]).map(|(k, what)| (what, self.values[k])).collect()
    }

    /// Sets the time `[s]` at which model exchange evaluates derivatives and outputs.
    ///
    /// # Errors
    ///
    /// The run cannot begin, or a block of the diagram gives what is not a number.
    pub fn set_time(&mut self, time: f64) -> Result<(), String> {
        let t = time - self.start;
        self.exchange()?.set_time(t);
        Ok(())
    }

    /// Sets the continuous states: coordinates q, velocities v, speeds of rotors with a lag, states of continuous
    /// blocks, in this order and in the units of the model description.
    ///
    /// # Errors
    ///
    /// `x` is not as long as the states, an entry is not finite (nothing is set then), or the run cannot begin.
    pub fn set_continuous_states(&mut self, x: &[f64]) -> Result<(), String> {
        self.exchange()?.set_states(x)
    }

    /// Writes the continuous states into `out`, in the order and units of [`Instance::set_continuous_states`].
    ///
    /// # Errors
    ///
    /// `out` is not as long as the states (nothing is written then), or the run cannot begin.
    pub fn continuous_states(&mut self, out: &mut [f64]) -> Result<(), String> {
        let x = self.exchange()?.states();
        if x.len() != out.len() {
            return Err(format!("there are {} continuous states, not {}", x.len(), out.len()));
        }
        out.copy_from_slice(x);
        Ok(())
    }

    /// Writes the time derivatives of the continuous states into `out`, in the order of
    /// [`Instance::set_continuous_states`], each in the unit of its state per second.
    ///
    /// # Errors
    ///
    /// `out` is not as long as the states (nothing is written then), or the run cannot begin.
    pub fn derivatives(&mut self, out: &mut [f64]) -> Result<(), String> {
        self.exchange()?.derivatives(out)
    }

    /// Makes the event (sample of a discrete block) that is due at the present time, if there is one; returns the time
    /// of the next one `[s]`, none if there is none.
    ///
    /// # Errors
    ///
    /// A block of the diagram gives what is not a number, or the run cannot begin.
    pub fn update_discrete_states(&mut self) -> Result<Option<f64>, String> {
        let next = self.exchange()?.update()?;
        Ok(next.map(|t| t + self.start))
    }

    /// Parameters that differ from what the FMU was exported with.
    fn changed_parameters(&self) -> Vec<Override> {
        let parameters = self.catalogue.with_role(|role| match role {
            Role::Fixed(path) | Role::Tunable(path, _) => Some(path.clone()),
            _ => None,
        });
        let changed = parameters.filter(|(vr, variable, _)| variable.start != Some(self.values[*vr as usize]));
        changed.map(|(vr, _, path)| Override::new(&path, &format!("{:?}", self.values[vr as usize]))).collect()
    }
}

impl Run {
    fn new(loaded: Loaded, catalogue: &Catalogue, begun_with: Vec<f64>) -> Result<Self, String> {
        let (method, _) = method_for(&loaded);
        let entries = loaded.controller.as_ref().map(ControlDiagram::entries).unwrap_or_default();
        let recorder =
            Recorder::new(&catalogue.recorded, &loaded.scene.model, &entries).map_err(|found| found.to_string())?;
        let mut lockstep = LockStep::new(&loaded, method, false);
        // the hash starts with the state before the controllers do, as that of a run
        let trace = lockstep.trace();
        if let Err(halt) = lockstep.start() {
            return Err(explain(halt, &mut lockstep, &loaded));
        }
        let mut run = Self {
            loaded,
            lockstep,
            recorder,
            structure: Followed::default(),
            begun_with,
            trace,
            row: Vec::new(),
            is_observed: false,
            is_begun: false,
            memory: Vec::new(),
            n_told: 0,
            ended: None,
            exchange: None,
            followed: None,
            is_followed: false,
        };
        run.observe();
        Ok(run)
    }

    /// Computes the outputs of the present instant, unless that was done.
    fn observe(&mut self) {
        if self.is_observed {
            return;
        }
        let t = self.lockstep.t();
        let is_start = !self.is_begun;
        self.lockstep.bring_up(&mut self.recorder, &mut self.structure);
        self.memory.clear();
        self.memory.extend(self.recorder.memory());
        let (seen, signals) = self.lockstep.observe(t);
        let row = self.recorder.row(&seen, signals, t, is_start);
        self.row.clear();
        self.row.extend_from_slice(row);
        (self.is_observed, self.is_begun) = (true, true);
        if !is_start {
            // a mean goes on until the next communication step begins
            self.recorder.set_memory(&self.memory);
        }
    }

    /// Begins a communication step: means of outputs are those over it.
    fn begin_step(&mut self) {
        self.lockstep.bring_up(&mut self.recorder, &mut self.structure);
        self.recorder.skip_row(&self.lockstep.state().totals, self.lockstep.t());
    }

    fn advance(&mut self) -> Step {
        if let Some(reason) = &self.ended {
            return Step::Ended(reason.clone());
        }
        let advanced = self.lockstep.advance();
        (self.is_observed, self.is_followed) = (false, false);
        let made = advanced.as_ref().map_or_else(Halt::is_after_step, |()| true);
        if made {
            self.lockstep.hash_into(&mut self.trace);
        }
        let reason = match advanced {
            Err(halt) => explain(halt, &mut self.lockstep, &self.loaded),
            Ok(()) if self.lockstep.take_stop_request() => "a script stopped the simulation".to_owned(),
            Ok(()) => return Step::Made,
        };
        self.ended = Some(reason.clone());
        Step::Ended(reason)
    }

    fn end(&mut self) -> Result<(), String> {
        self.lockstep.end().map_err(|halt| explain(halt, &mut self.lockstep, &self.loaded))
    }
}

/// A stop in words.
fn explain(halt: Halt, lockstep: &mut LockStep, loaded: &Loaded) -> String {
    match halt.explain(lockstep, &loaded.experiment) {
        Status::Stopped { reason, help, .. } if help.is_empty() => reason,
        Status::Stopped { reason, help, .. } => format!("{reason}; help: {help}"),
        other => format!("{other:?}"),
    }
}

/// Returns true if a snapshot holds the whole state of a scene: scripts keep a memory of their own.
pub(crate) fn can_save(loaded: &Loaded) -> bool {
    loaded.scene.scripts.is_empty()
}

fn as_input(role: &Role) -> Option<usize> {
    if let Role::Input(command) = role { Some(*command) } else { None }
}

fn starts(catalogue: &Catalogue) -> Vec<f64> {
    catalogue.variables.iter().map(|variable| variable.start.unwrap_or(f64::NAN)).collect()
}
