//! Functions that move something and wait until it is there (`sim.moveToConfig` …), for a client: step by step with the simulation, and with a callback of the
//! client at each.
//!
//! The client steps the simulation while its motion lasts, whether it did before or not, as with the official server: motions are the same however fast the
//! client is. A motion that is asked for while nothing runs waits for the start.

use std::time::{Duration, Instant};

use sincro_coppelia::session::api::Move;
use sincro_coppelia::session::{Phase, Refusal, Value};

use super::functions::{After, Door, Said};

/// How long a motion waits for the simulation to be started.
const PATIENCE: Duration = Duration::from_secs(10);
/// How often it is looked whether it was, or whether a pause is over.
const GLANCE: Duration = Duration::from_millis(2);

/// A motion of a client.
pub(crate) struct Moving {
    this: Move,
    data: Value,
    callback: Option<String>,
    result: i64,
    /// One step only, that the client has asked for itself.
    is_single: bool,
}

impl Door {
    /// Begins a motion, and goes on with it as far as it goes without the client.
    pub(super) fn begin_move(&self, this: Move, name: &str, arguments: &[Value]) -> Result<Said, Refusal> {
        // before it waits, so that it begins with the run
        self.hub.enter().set_stepping(self.id, true);
        let begun = self.begin(this, name, arguments).inspect_err(|_| {
            self.hub.enter().set_stepping(self.id, false);
            self.hub.wake();
        });
        self.go_on(begun?)
    }

    /// While nothing runs: a motion that can be begun is waited with.
    fn begin(&self, this: Move, name: &str, arguments: &[Value]) -> Result<Moving, Refusal> {
        let told = |Refusal(e): Refusal| Refusal(format!("{e} (in function 'sim.{name}')"));
        if self.phase().0 == Phase::Stopped {
            let tried = self.prepare(this, name, arguments)?;
            self.session(&format!("sim.{}_cleanup", this.stem()), &[tried.data])?;
            self.wait_for_start().map_err(told)?;
        }
        self.prepare(this, name, arguments)
    }

    fn prepare(&self, this: Move, name: &str, arguments: &[Value]) -> Result<Moving, Refusal> {
        let told = |Refusal(e): Refusal| Refusal(format!("{e} (in function 'sim.{name}')"));
        let map = {
            let mut floor = self.hub.enter();
            floor.seen(self.id);
            floor.act(|session| this.parameters(&mut session.desk(), arguments)).map_err(told)?
        };
        let callback = callback_of(&map);
        let data = self.one(&format!("{}_init", this.stem()), &[map])?;
        Ok(Moving { this, data, callback, result: 0, is_single: false })
    }

    /// One step of a motion, with the client's callback if it has one.
    pub(super) fn step_move(&self, name: &str, arguments: &[Value]) -> Result<Said, Refusal> {
        let this = if name.starts_with("moveToPose") { Move::Pose } else { Move::Config };
        let data = arguments.first().cloned().unwrap_or_default();
        let callback = callback_of(&data);
        self.go_on(Moving { this, data, callback, result: 0, is_single: true })
    }

    /// The callback has said whether to stop.
    pub(super) fn answer_move(&self, mut moving: Moving, results: &[Value]) -> Result<Said, Refusal> {
        if results.first().and_then(Value::as_bool).unwrap_or(false) {
            moving.result = 2;
        }
        match self.after_step(&moving) {
            Ok(None) => self.go_on(moving),
            Ok(Some(results)) => Ok(Said::Done(results)),
            Err(refusal) => Err(self.give_up(&moving, refusal)),
        }
    }

    fn go_on(&self, mut moving: Moving) -> Result<Said, Refusal> {
        loop {
            let done = self.step_once(&mut moving).and_then(|()| match moving.callback {
                Some(_) => Ok(None),
                None => self.after_step(&moving),
            });
            match (done, moving.callback.clone()) {
                (Err(refusal), _) => return Err(self.give_up(&moving, refusal)),
                (Ok(_), Some(name)) => {
                    let arguments = Move::told(&moving.data);
                    return Ok(Said::Callback { name, arguments, after: After::Move(Box::new(moving)) });
                }
                (Ok(Some(results)), None) => return Ok(Said::Done(results)),
                (Ok(None), None) => {}
            }
        }
    }

    fn step_once(&self, moving: &mut Moving) -> Result<(), Refusal> {
        let name = format!("sim.{}_step", moving.this.stem());
        let given = [moving.data.clone(), Value::Bool(moving.callback.is_some())];
        let mut results = self.session(&name, &given)?;
        moving.data = results.pop().unwrap_or_default();
        moving.result = results.first().and_then(Value::as_int).unwrap_or(0);
        Ok(())
    }

    /// After what is done was done: the simulation's step, and the results if that was the last.
    fn after_step(&self, moving: &Moving) -> Result<Option<Vec<Value>>, Refusal> {
        if moving.is_single {
            return Ok(Some(vec![Value::Int(moving.result), moving.data.clone()]));
        }
        self.next_step()?;
        if moving.result == 0 {
            return Ok(None);
        }
        self.hub.enter().set_stepping(self.id, false);
        self.hub.wake();
        self.session(&format!("sim.{}_cleanup", moving.this.stem()), std::slice::from_ref(&moving.data))?;
        Ok(Some(moving.this.results(&without_handles(&moving.data))))
    }

    /// A motion that cannot go on is forgotten.
    pub(super) fn give_up(&self, moving: &Moving, refusal: Refusal) -> Refusal {
        if !moving.is_single {
            self.hub.enter().set_stepping(self.id, false);
            let name = format!("sim.{}_cleanup", moving.this.stem());
            // with the run its motions have ended already
            let _ = self.session(&name, std::slice::from_ref(&moving.data));
            self.hub.wake();
        }
        refusal
    }

    fn one(&self, name: &str, arguments: &[Value]) -> Result<Value, Refusal> {
        Ok(self.session(&format!("sim.{name}"), arguments)?.pop().unwrap_or_default())
    }

    fn phase(&self) -> (Phase, u64) {
        let mut floor = self.hub.enter();
        floor.seen(self.id);
        (floor.session.phase(), floor.steps())
    }

    fn wait_for_start(&self) -> Result<(), Refusal> {
        let begin = Instant::now();
        while self.phase().0 == Phase::Stopped {
            if begin.elapsed() > PATIENCE || self.hub.is_closing() {
                let seconds = PATIENCE.as_secs();
                return Err(Refusal(format!("no simulation was started for {seconds} s: motions take its time")));
            }
            std::thread::sleep(GLANCE);
        }
        Ok(())
    }

    /// One step of the simulation, however long it is paused.
    fn next_step(&self) -> Result<(), Refusal> {
        loop {
            let (phase, before) = self.phase();
            if phase == Phase::Stopped || self.hub.is_closing() {
                return Err(Refusal::new("the simulation was stopped before the motion had ended"));
            }
            self.hub.step(self.id)?;
            if self.phase().1 != before {
                return Ok(());
            }
            std::thread::sleep(GLANCE);
        }
    }
}

/// The name of the function that the client has given.
fn callback_of(map: &Value) -> Option<String> {
    let Value::Map(fields) = map else { return None };
    let name = fields.iter().find(|(key, _)| key == "callback")?.1.as_text()?;
    Some(name.strip_suffix("@func").unwrap_or(name).to_owned())
}

/// What has ended has no handles any more.
fn without_handles(data: &Value) -> Value {
    let Value::Map(fields) = data else { return data.clone() };
    Value::Map(fields.iter().filter(|(key, _)| key != "ruckigObj" && key != "ik").cloned().collect())
}
