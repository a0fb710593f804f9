//! Functions that move something and wait until it is there (`sim.moveToConfig` …), for a client: step by step with the
//! simulation, and with a callback of the client at each.
//!
//! The client steps the simulation while its motion lasts, whether it did before or not, as with the official server:
//! motions are the same however fast the client is. A motion that is asked for while nothing runs waits for the start.

use std::time::{Duration, Instant};

use sincro_coppelia::api::functions::Move;
use sincro_coppelia::api::{ApiError, Phase, Value};

use super::functions::{After, CallOutcome, Endpoint};

/// Time limit of a motion that waits for the simulation to be started.
const START_TIMEOUT: Duration = Duration::from_secs(10);
/// Interval at which the start, or the end of a pause, is polled.
const POLL_INTERVAL: Duration = Duration::from_millis(2);

/// A motion of a client.
pub(crate) struct ClientMotion {
    this: Move,
    data: Value,
    callback: Option<String>,
    result: i64,
    /// One step only, that the client has asked for itself.
    is_single: bool,
}

impl Endpoint {
    /// Begins a motion, and runs it until the client is needed or it ends.
    pub(super) fn begin_move(&self, this: Move, name: &str, arguments: &[Value]) -> Result<CallOutcome, ApiError> {
        // before it waits, so that it begins with the run
        self.hub.enter().set_stepping(self.id, true);
        let motion = self.begin(this, name, arguments).inspect_err(|_| {
            self.hub.enter().set_stepping(self.id, false);
            self.hub.wake();
        });
        self.run_motion(motion?)
    }

    /// While nothing runs: waits for the start with a motion that can be begun.
    fn begin(&self, this: Move, name: &str, arguments: &[Value]) -> Result<ClientMotion, ApiError> {
        let with_name = |ApiError(e): ApiError| ApiError(format!("{e} (in function 'sim.{name}')"));
        if self.phase().0 == Phase::Stopped {
            let trial = self.prepare(this, name, arguments)?;
            self.session(&format!("sim.{}_cleanup", this.stem()), &[trial.data])?;
            self.wait_for_start().map_err(with_name)?;
        }
        self.prepare(this, name, arguments)
    }

    fn prepare(&self, this: Move, name: &str, arguments: &[Value]) -> Result<ClientMotion, ApiError> {
        let with_name = |ApiError(e): ApiError| ApiError(format!("{e} (in function 'sim.{name}')"));
        let map = {
            let mut guard = self.hub.enter();
            guard.seen(self.id);
            guard.act(|session| this.parameters(&mut session.sim(), arguments)).map_err(with_name)?
        };
        let callback = callback_of(&map);
        let data = self.one(&format!("{}_init", this.stem()), &[map])?;
        Ok(ClientMotion { this, data, callback, result: 0, is_single: false })
    }

    /// One step of a motion, with the client's callback if it has one.
    pub(super) fn step_move(&self, name: &str, arguments: &[Value]) -> Result<CallOutcome, ApiError> {
        let this = if name.starts_with("moveToPose") { Move::Pose } else { Move::Config };
        let data = arguments.first().cloned().unwrap_or_default();
        let callback = callback_of(&data);
        self.run_motion(ClientMotion { this, data, callback, result: 0, is_single: true })
    }

    /// The callback has said whether to stop.
    pub(super) fn answer_move(&self, mut motion: ClientMotion, results: &[Value]) -> Result<CallOutcome, ApiError> {
        if results.first().and_then(Value::as_bool).unwrap_or(false) {
            motion.result = 2;
        }
        match self.after_step(&motion) {
            Ok(None) => self.run_motion(motion),
            Ok(Some(results)) => Ok(CallOutcome::Done(results)),
            Err(error) => Err(self.give_up(&motion, error)),
        }
    }

    fn run_motion(&self, mut motion: ClientMotion) -> Result<CallOutcome, ApiError> {
        loop {
            let done = self.step_once(&mut motion).and_then(|()| match motion.callback {
                Some(_) => Ok(None),
                None => self.after_step(&motion),
            });
            match (done, motion.callback.clone()) {
                (Err(error), _) => return Err(self.give_up(&motion, error)),
                (Ok(_), Some(name)) => {
                    let arguments = Move::callback_arguments(&motion.data);
                    return Ok(CallOutcome::Callback { name, arguments, after: After::Move(Box::new(motion)) });
                }
                (Ok(Some(results)), None) => return Ok(CallOutcome::Done(results)),
                (Ok(None), None) => {}
            }
        }
    }

    fn step_once(&self, motion: &mut ClientMotion) -> Result<(), ApiError> {
        let name = format!("sim.{}_step", motion.this.stem());
        let given = [motion.data.clone(), Value::Bool(motion.callback.is_some())];
        // with the run its motions end: whoever stops it may come between two steps
        let ended = |error| if self.phase().0 == Phase::Stopped { stopped_early() } else { error };
        let mut results = self.session(&name, &given).map_err(ended)?;
        motion.data = results.pop().unwrap_or_default();
        motion.result = results.first().and_then(Value::as_int).unwrap_or(0);
        Ok(())
    }

    /// After what is done was done: the simulation's step, and the results if that was the last.
    fn after_step(&self, motion: &ClientMotion) -> Result<Option<Vec<Value>>, ApiError> {
        if motion.is_single {
            return Ok(Some(vec![Value::Int(motion.result), motion.data.clone()]));
        }
        self.next_step()?;
        if motion.result == 0 {
            return Ok(None);
        }
        self.hub.enter().set_stepping(self.id, false);
        self.hub.wake();
        self.session(&format!("sim.{}_cleanup", motion.this.stem()), std::slice::from_ref(&motion.data))?;
        Ok(Some(motion.this.results(&without_handles(&motion.data))))
    }

    /// Removes a motion that cannot continue.
    pub(super) fn give_up(&self, motion: &ClientMotion, error: ApiError) -> ApiError {
        if !motion.is_single {
            self.hub.enter().set_stepping(self.id, false);
            let name = format!("sim.{}_cleanup", motion.this.stem());
            // with the run its motions have ended already
            let _ = self.session(&name, std::slice::from_ref(&motion.data));
            self.hub.wake();
        }
        error
    }

    fn one(&self, name: &str, arguments: &[Value]) -> Result<Value, ApiError> {
        Ok(self.session(&format!("sim.{name}"), arguments)?.pop().unwrap_or_default())
    }

    fn phase(&self) -> (Phase, u64) {
        let mut guard = self.hub.enter();
        guard.seen(self.id);
        (guard.session.phase(), guard.steps())
    }

    fn wait_for_start(&self) -> Result<(), ApiError> {
        let begin = Instant::now();
        while self.phase().0 == Phase::Stopped {
            if begin.elapsed() > START_TIMEOUT || self.hub.is_closing() {
                let seconds = START_TIMEOUT.as_secs();
                return Err(ApiError(format!("no simulation was started for {seconds} s: motions take its time")));
            }
            std::thread::sleep(POLL_INTERVAL);
        }
        Ok(())
    }

    /// One step of the simulation, however long it is paused.
    fn next_step(&self) -> Result<(), ApiError> {
        loop {
            let (phase, before) = self.phase();
            if phase == Phase::Stopped || self.hub.is_closing() {
                return Err(stopped_early());
            }
            self.hub.step(self.id)?;
            if self.phase().1 != before {
                return Ok(());
            }
            std::thread::sleep(POLL_INTERVAL);
        }
    }
}

fn stopped_early() -> ApiError {
    ApiError::new("the simulation was stopped before the motion had ended")
}

/// The name of the function that the client has given.
fn callback_of(map: &Value) -> Option<String> {
    let Value::Map(fields) = map else { return None };
    let name = fields.iter().find(|(key, _)| key == "callback")?.1.as_text()?;
    Some(name.strip_suffix("@func").unwrap_or(name).to_owned())
}

/// Removes the handles from the data of a motion that has ended.
fn without_handles(data: &Value) -> Value {
    let Value::Map(fields) = data else { return data.clone() };
    Value::Map(fields.iter().filter(|(key, _)| key != "ruckigObj" && key != "ik").cloned().collect())
}
