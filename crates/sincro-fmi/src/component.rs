//! An instance with its mode: the calls of both versions, in safe Rust, and which of them may be made when.

use std::collections::BTreeMap;
use std::path::Path;

use sincro_fmu::Instance;
use sincro_fmu::instance::{FmuState, Step};
use sincro_sim::Extensions;

use crate::log::{Logger, Message, Status};

/// Mode of an instance, in the words of FMI 3.0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Mode {
    Instantiated,
    Initialization,
    Step,
    Event,
    ContinuousTime,
    Terminated,
    /// After a panic: nothing may be called but the function that frees it.
    Failed,
}

/// Interface type that an instance was made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    CoSimulation,
    ModelExchange,
}

/// An instance as the importer knows it.
#[derive(Debug)]
pub(crate) struct Component {
    pub instance: Instance,
    pub kind: Kind,
    pub mode: Mode,
    pub logger: Logger,
    /// Messages that are to be sent at the end of the call.
    pub messages: Vec<Message>,
    /// Reason for which the simulation came to its end.
    pub ended: Option<String>,
    pub is_early_return_allowed: bool,
    pub is_event_mode_used: bool,
    /// Function of the importer to be called between base steps, as a number.
    pub intermediate_update: Option<usize>,
    states: BTreeMap<usize, FmuState>,
    n_states: usize,
    /// The state that was written last, as bytes: an importer asks for its length first.
    serialized: Option<(usize, Vec<u8>)>,
}

/// Numbers of saved states look like addresses that no memory has.
const STRIDE: usize = 16;

impl Component {
    /// Loads the scene in the resources; `token` was read in the model description.
    pub(crate) fn new(kind: Kind, token: &str, resources: &Path, logger: Logger) -> Result<Self, String> {
        let extensions = Extensions {
            scripts: Some(sincro_lua::engine()),
            fmus: Some(sincro_fmu::import::loader()),
            ..Extensions::default()
        };
        let instance = Instance::new(resources, token, extensions)?;
        if kind == Kind::ModelExchange && !instance.has_model_exchange() {
            return Err("this FMU was exported for co-simulation: export it with --kind me or --kind both".into());
        }
        Ok(Self {
            instance,
            kind,
            mode: Mode::Instantiated,
            logger,
            messages: Vec::new(),
            ended: None,
            is_early_return_allowed: false,
            is_event_mode_used: false,
            intermediate_update: None,
            states: BTreeMap::new(),
            n_states: 0,
            serialized: None,
        })
    }

    /// Ends the instance after a panic.
    pub(crate) fn fail(&mut self) {
        self.mode = Mode::Failed;
    }

    /// Notes an error; its status.
    pub(crate) fn refuse(&mut self, why: impl Into<String>) -> Status {
        self.messages.push(Message::error(why));
        Status::Error
    }

    /// Status of a result; an error is noted.
    pub(crate) fn finish(&mut self, result: Result<(), String>) -> Status {
        match result {
            Ok(()) => Status::Ok,
            Err(why) => self.refuse(why),
        }
    }

    /// Refuses a call in a mode that it may not be made in.
    pub(crate) fn require(&mut self, call: &str, modes: &[Mode]) -> Result<(), Status> {
        if modes.contains(&self.mode) {
            return Ok(());
        }
        let mode = self.mode;
        Err(self.refuse(format!("{call} may not be called in the mode {mode:?}")))
    }

    fn event(&mut self, text: String) {
        self.messages.push(Message { status: Status::Ok, category: "logEvents", text });
    }

    pub(crate) fn set_debug_logging(&mut self, is_on: bool, categories: Vec<String>) -> Status {
        (self.logger.is_on, self.logger.categories) = (is_on, categories);
        Status::Ok
    }

    pub(crate) fn set_start(&mut self, start: f64, call: &str) -> Result<(), Status> {
        self.require(call, &[Mode::Instantiated])?;
        if !start.is_finite() {
            return Err(self.refuse(format!("{call}: the time of the start is {start}")));
        }
        self.instance.set_start_time(start);
        Ok(())
    }

    pub(crate) fn enter_initialization(&mut self, call: &str) -> Result<(), Status> {
        self.require(call, &[Mode::Instantiated])?;
        self.mode = Mode::Initialization;
        Ok(())
    }

    pub(crate) fn exit_initialization(&mut self, call: &str) -> Result<(), Status> {
        self.require(call, &[Mode::Initialization])?;
        if let Err(why) = self.instance.begin() {
            return Err(self.refuse(why));
        }
        self.mode = match self.kind {
            Kind::CoSimulation if !self.is_event_mode_used => Mode::Step,
            _ => Mode::Event,
        };
        if self.kind == Kind::ModelExchange
            && let Err(why) = self.instance.start_exchange()
        {
            return Err(self.refuse(why));
        }
        self.tell();
        Ok(())
    }

    pub(crate) fn terminate(&mut self, call: &str) -> Result<(), Status> {
        self.require(call, &[Mode::Step, Mode::Event, Mode::ContinuousTime])?;
        self.mode = Mode::Terminated;
        if let Some(trace) = self.instance.trace().filter(|_| self.kind == Kind::CoSimulation) {
            self.messages.push(Message { status: Status::Ok, category: "logTrace", text: format!("trace {trace}") });
        }
        let ended = self.instance.end();
        self.tell();
        match ended {
            Ok(()) => Ok(()),
            Err(why) => Err(self.refuse(why)),
        }
    }

    pub(crate) fn reset(&mut self, call: &str) -> Result<(), Status> {
        let modes =
            [Mode::Instantiated, Mode::Initialization, Mode::Step, Mode::Event, Mode::ContinuousTime, Mode::Terminated];
        self.require(call, &modes)?;
        self.instance.reset();
        self.instance.set_start_time(0.0);
        (self.mode, self.ended) = (Mode::Instantiated, None);
        Ok(())
    }

    /// Values of variables.
    pub(crate) fn get(&mut self, references: &[u32], values: &mut [f64], call: &str) -> Status {
        if self.mode == Mode::Failed {
            return self.refuse(format!("{call}: this instance is lost"));
        }
        for (vr, value) in references.iter().zip(values) {
            match self.instance.get(*vr) {
                Ok(x) => *value = x,
                Err(why) => return self.refuse(format!("{call}: {why}")),
            }
        }
        Status::Ok
    }

    pub(crate) fn set(&mut self, references: &[u32], values: &[f64], call: &str) -> Status {
        let modes = [Mode::Instantiated, Mode::Initialization, Mode::Step, Mode::Event, Mode::ContinuousTime];
        if let Err(status) = self.require(call, &modes) {
            return status;
        }
        if self.mode == Mode::Initialization {
            // what was computed to be looked at begins anew with the new values
            self.instance.rewind();
        }
        for (vr, value) in references.iter().zip(values) {
            if let Err(why) = self.instance.set(*vr, *value) {
                return self.refuse(format!("{call}: {why}"));
            }
        }
        Status::Ok
    }

    /// Number of base steps of a communication step.
    pub(crate) fn begin_step(&mut self, time: f64, span: f64, call: &str) -> Result<u64, Status> {
        self.require(call, &[Mode::Step])?;
        match self.instance.steps_to(time, span) {
            Ok(n) => {
                self.instance.begin_step();
                Ok(n)
            }
            Err(why) => {
                self.messages.push(Message { status: Status::Discard, ..Message::error(why) });
                Err(Status::Discard)
            }
        }
    }

    /// Makes base steps; returns false if the simulation came to its end before.
    pub(crate) fn advance(&mut self, n: u64) -> Result<bool, Status> {
        for _ in 0..n {
            match self.instance.advance() {
                Ok(Step::Made) => {}
                Ok(Step::Ended(reason)) => {
                    if self.ended.is_none() {
                        self.messages.push(Message {
                            status: Status::Warning,
                            category: "logEvents",
                            text: format!("the simulation ended: {reason}"),
                        });
                    }
                    self.ended = Some(reason);
                    self.tell();
                    return Ok(false);
                }
                Err(why) => return Err(self.refuse(why)),
            }
        }
        self.tell();
        Ok(true)
    }

    /// Passes messages of scripts on.
    fn tell(&mut self) {
        if self.instance.has_scripts() && self.logger.is_on {
            for text in self.instance.take_messages() {
                self.event(text);
            }
        }
    }

    /// Saves the present state; `old` is one that may be overwritten, or 0.
    pub(crate) fn save(&mut self, old: usize, call: &str) -> Result<usize, Status> {
        if self.mode == Mode::Failed {
            return Err(self.refuse(format!("{call}: this instance is lost")));
        }
        if old != 0 && !self.states.contains_key(&old) {
            return Err(
                self.refuse(format!("{call}: the state to be overwritten is none of this instance, or was freed"))
            );
        }
        match self.instance.save() {
            Ok(state) => Ok(self.keep(old, state)),
            Err(why) => Err(self.refuse(format!("{call}: {why}"))),
        }
    }

    fn keep(&mut self, old: usize, state: FmuState) -> usize {
        let number = if old == 0 {
            self.n_states += 1;
            self.n_states * STRIDE
        } else {
            old
        };
        self.serialized = None;
        self.states.insert(number, state);
        number
    }

    pub(crate) fn restore(&mut self, number: usize, call: &str) -> Status {
        let modes =
            [Mode::Instantiated, Mode::Initialization, Mode::Step, Mode::Event, Mode::ContinuousTime, Mode::Terminated];
        if let Err(status) = self.require(call, &modes) {
            return status;
        }
        let Some(state) = self.states.get(&number) else {
            return self.refuse(format!("{call}: the state is none of this instance, or was freed"));
        };
        let (has_begun, result) = (state.has_begun(), self.instance.restore(state));
        self.ended = None;
        if result.is_ok() {
            self.mode = match (has_begun, self.mode, self.kind) {
                (false, Mode::Initialization, _) => Mode::Initialization,
                (false, ..) => Mode::Instantiated,
                (true, mode @ (Mode::Event | Mode::ContinuousTime), _) => mode,
                (true, Mode::Initialization, _) => Mode::Initialization,
                (true, _, Kind::CoSimulation) => Mode::Step,
                (true, _, Kind::ModelExchange) => Mode::Event,
            };
        }
        self.finish(result)
    }

    pub(crate) fn free_state(&mut self, number: usize, call: &str) -> Status {
        match self.states.remove(&number) {
            Some(_) => Status::Ok,
            None => self.refuse(format!("{call}: the state is none of this instance, or was freed already")),
        }
    }

    /// A saved state as bytes.
    pub(crate) fn bytes(&mut self, number: usize, call: &str) -> Result<&[u8], Status> {
        if self.serialized.as_ref().is_none_or(|(of, _)| *of != number) {
            let Some(state) = self.states.get(&number) else {
                return Err(self.refuse(format!("{call}: the state is none of this instance, or was freed")));
            };
            self.serialized = Some((number, self.instance.to_bytes(state)));
        }
        Ok(self.serialized.as_ref().map_or(&[], |(_, bytes)| bytes))
    }

    pub(crate) fn state_of_bytes(&mut self, bytes: &[u8], call: &str) -> Result<usize, Status> {
        match self.instance.from_bytes(bytes) {
            Ok(state) => Ok(self.keep(0, state)),
            Err(why) => Err(self.refuse(format!("{call}: {why}"))),
        }
    }
}

/// Model exchange, and the event mode of both interface types.
impl Component {
    pub(crate) fn enter_event_mode(&mut self, call: &str) -> Result<(), Status> {
        self.require(call, &[Mode::ContinuousTime, Mode::Step, Mode::Event])?;
        if self.kind == Kind::CoSimulation && !self.is_event_mode_used {
            return Err(self.refuse(format!("{call}: the event mode was not asked for at the instantiation")));
        }
        self.mode = Mode::Event;
        Ok(())
    }

    pub(crate) fn enter_step_mode(&mut self, call: &str) -> Result<(), Status> {
        self.require(call, &[Mode::Event])?;
        if self.kind != Kind::CoSimulation {
            return Err(self.refuse(format!("{call}: the instance is one for model exchange")));
        }
        self.mode = Mode::Step;
        Ok(())
    }

    pub(crate) fn enter_continuous_time_mode(&mut self, call: &str) -> Result<(), Status> {
        self.require_exchange(call, &[Mode::Event])?;
        self.mode = Mode::ContinuousTime;
        Ok(())
    }

    fn require_exchange(&mut self, call: &str, modes: &[Mode]) -> Result<(), Status> {
        self.require(call, modes)?;
        if self.kind == Kind::ModelExchange {
            return Ok(());
        }
        Err(self.refuse(format!("{call}: the instance is one for co-simulation")))
    }

    /// Updates what is sampled; returns the time of the next event, if there is one.
    pub(crate) fn update_discrete_states(&mut self, call: &str) -> Result<Option<f64>, Status> {
        self.require(call, &[Mode::Event])?;
        if self.kind == Kind::CoSimulation {
            return Ok(None);
        }
        let updated = self.instance.update_discrete_states();
        updated.map_err(|why| self.refuse(format!("{call}: {why}")))
    }

    pub(crate) fn set_time(&mut self, time: f64, call: &str) -> Result<(), Status> {
        self.require_exchange(call, &[Mode::Event, Mode::ContinuousTime])?;
        if !time.is_finite() {
            return Err(self.refuse(format!("{call}: the time is {time}")));
        }
        let set = self.instance.set_time(time);
        set.map_err(|why| self.refuse(format!("{call}: {why}")))
    }

    pub(crate) fn set_continuous_states(&mut self, x: &[f64], call: &str) -> Result<(), Status> {
        self.require_exchange(call, &[Mode::Event, Mode::ContinuousTime])?;
        let set = self.instance.set_continuous_states(x);
        set.map_err(|why| self.refuse(format!("{call}: {why}")))
    }

    const WITH_STATES: [Mode; 4] = [Mode::Initialization, Mode::Event, Mode::ContinuousTime, Mode::Terminated];

    pub(crate) fn continuous_states(&mut self, out: &mut [f64], call: &str) -> Result<(), Status> {
        self.require_exchange(call, &Self::WITH_STATES)?;
        let got = self.instance.continuous_states(out);
        got.map_err(|why| self.refuse(format!("{call}: {why}")))
    }

    pub(crate) fn derivatives(&mut self, out: &mut [f64], call: &str) -> Result<(), Status> {
        self.require_exchange(call, &Self::WITH_STATES)?;
        let got = self.instance.derivatives(out);
        got.map_err(|why| self.refuse(format!("{call}: {why}")))
    }

    pub(crate) fn nominals(&mut self, out: &mut [f64], call: &str) -> Result<(), Status> {
        let modes = [Mode::Instantiated, Mode::Initialization, Mode::Event, Mode::ContinuousTime, Mode::Terminated];
        self.require_exchange(call, &modes)?;
        out.fill(1.0);
        Ok(())
    }

    pub(crate) fn event_indicators(&mut self, out: &mut [f64], call: &str) -> Result<(), Status> {
        self.require_exchange(call, &Self::WITH_STATES)?;
        if out.is_empty() { Ok(()) } else { Err(self.refuse(format!("{call}: there are no event indicators"))) }
    }

    /// Derivatives of the present instant. In co-simulation it is the communication point.
    pub(crate) fn directional_derivative(
        &mut self,
        unknowns: &[u32],
        knowns: &[u32],
        seed: &[f64],
        sensitivity: &mut [f64],
        call: &str,
    ) -> Status {
        self.differentiate(call, |instance| instance.directional_derivative((unknowns, knowns), seed, sensitivity))
    }

    /// As [`Component::directional_derivative`], of the transposed matrix.
    pub(crate) fn adjoint_derivative(
        &mut self,
        unknowns: &[u32],
        knowns: &[u32],
        seed: &[f64],
        sensitivity: &mut [f64],
        call: &str,
    ) -> Status {
        self.differentiate(call, |instance| instance.adjoint_derivative((unknowns, knowns), seed, sensitivity))
    }

    fn differentiate(&mut self, call: &str, act: impl FnOnce(&mut Instance) -> Result<(), String>) -> Status {
        if let Err(status) = self.require(call, &Self::WITH_DERIVATIVES) {
            return status;
        }
        let result = act(&mut self.instance);
        self.finish(result.map_err(|why| format!("{call}: {why}")))
    }

    const WITH_DERIVATIVES: [Mode; 5] =
        [Mode::Initialization, Mode::Step, Mode::Event, Mode::ContinuousTime, Mode::Terminated];
}
