//! Functions of the regular API beside the session's own: stepping, waiting, locks, information. The ZeroMQ and the
//! WebSocket endpoint share them.

use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant, SystemTime};

use sincro_coppelia::api::functions::Move;
use sincro_coppelia::api::{ApiError, Arguments, Handle, Search, Value, constants, functions, paths};
use sincro_scene::script::Kind;

use super::moves::ClientMotion;
use crate::hub::{ClientId, Hub};
use crate::limits;

/// Modules of the official program that are asked for and not offered.
const MODULES: &str = "the modules sim, simIK, simOMPL, simUI and simVision are offered";
/// Longest wait of one call `[s]`.
const MAX_WAIT: f64 = 3_600.0;
/// Longest real time for which a client that waits is not answered: less than the time-outs of clients.
const WAIT_PART: Duration = Duration::from_secs(1);

/// Name of the callback that tells a client to go on waiting.
const GO_ON_WAITING: &str = "_*wait*_";

/// `sim.scripttype_sandbox`.
const SANDBOX_TYPE: i64 = 8;
/// `sim.handle_sandbox`.
const SANDBOX: i64 = -17;

/// Functions of the endpoint, with their signatures.
const FUNCTIONS: &[(&str, &str)] = &[
    ("setStepping", "int previousLevel=sim.setStepping(bool enabled)"),
    ("step", "sim.step(int steps=1)"),
    ("switchThread", "sim.switchThread()"),
    ("yield", "sim.yield()"),
    ("wait", "float timeLeft=sim.wait(float dt,bool simulationTime=true)"),
    ("acquireLock", "sim.acquireLock()"),
    ("releaseLock", "sim.releaseLock()"),
    ("setThreadSwitchTiming", "sim.setThreadSwitchTiming(int dtInMs)"),
    ("setThreadAutomaticSwitch", "int previousLevel=sim.setThreadAutomaticSwitch(any autoSwitch)"),
    ("setAutoYieldDelay", "sim.setAutoYieldDelay(float dt)"),
    ("restartServer", "sim.restartServer()"),
    ("readCustomDataBlock", "buffer data=sim.readCustomDataBlock(int objectHandle,string tagName)"),
    ("callScriptFunction", "...=sim.callScriptFunction(string functionName,int scriptHandle,...)"),
    ("executeScriptString", "any result=sim.executeScriptString(string stringToExecute,int scriptHandle)"),
    ("getScript", "int scriptHandle=sim.getScript(int scriptType,int objectHandle=-1)"),
    ("copyTable", "any[] copy=sim.copyTable(any[] original)"),
    ("testCB", "any result=sim.testCB(any a,func cb,any b,int iterations=99)"),
    ("getApiFunc", "string[] functions=sim.getApiFunc(int scriptHandle,string apiWord)"),
    ("getApiInfo", "string info=sim.getApiInfo(int scriptHandle,string apiWord)"),
    ("getSystemTime", "float systemTime=sim.getSystemTime()"),
    ("handleExtCalls", "sim.handleExtCalls()"),
];

/// Functions that are refused as unsafe.
const UNSAFE: &[&str] = &["_evalExec"];

/// Outcome of a call.
pub(crate) enum CallOutcome {
    /// Its results.
    Done(Vec<Value>),
    /// The client must run a callback: its name, what it is given, and what comes after.
    Callback { name: String, arguments: Vec<Value>, after: After },
}

/// Continuation after a callback of the client.
pub(crate) enum After {
    /// The same again, this often; then its results are those of the call.
    Again(i64),
    /// The next step of a motion.
    Move(Box<ClientMotion>),
    /// The rest of a wait.
    Wait(Wait),
}

/// End of a wait.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Wait {
    /// Instant of the wall clock.
    Until(Instant),
    /// Simulation time `[s]`.
    Simulated(f64),
}

/// Endpoint of one client.
pub(crate) struct Endpoint {
    pub hub: Arc<Hub>,
    pub id: ClientId,
}

impl Endpoint {
    /// Calls a function for a client that runs no callbacks, for the reason `why`: waits are not answered in parts.
    ///
    /// # Errors
    ///
    /// There is none of that name, it refused, or it wants a callback.
    pub fn call_without_callbacks(&self, name: &str, arguments: &[Value], why: &str) -> Result<Vec<Value>, ApiError> {
        let mut outcome = self.call(name, arguments)?;
        loop {
            outcome = match outcome {
                CallOutcome::Done(results) => return Ok(results),
                CallOutcome::Callback { after: After::Wait(wait), .. } => self.wait(wait)?,
                CallOutcome::Callback { after, .. } => return Err(self.decline(after, why)),
            };
        }
    }

    /// Calls a function.
    ///
    /// # Errors
    ///
    /// There is none of that name, or it refused.
    pub fn call(&self, name: &str, arguments: &[Value]) -> Result<CallOutcome, ApiError> {
        let bare = name.strip_prefix("sim.").unwrap_or(name);
        let a = Arguments(arguments);
        let results = match bare {
            "setStepping" => {
                // Lua lets a level be given: any above zero is stepping
                let before = self.hub.enter().set_stepping(self.id, a.bool_or(0, true)?);
                self.hub.wake();
                vec![Value::Int(before.into())]
            }
            "step" | "switchThread" | "yield" => self.steps(a)?,
            "wait" => return self.begin_wait(a),
            "copyTable" => vec![a.get(0).clone()],
            "acquireLock" | "releaseLock" => {
                self.hub.enter().lock(self.id, bare == "acquireLock");
                self.hub.wake();
                Vec::new()
            }
            "setThreadSwitchTiming" | "setAutoYieldDelay" | "handleExtCalls" | "restartServer" => Vec::new(),
            "setThreadAutomaticSwitch" => vec![Value::Int(0)],
            "testCB" => return callback(a),
            "getApiFunc" => vec![Value::List(names(a.text(1)?).map(Value::from).collect())],
            "getApiInfo" => vec![tip(a.text(1)?).map_or(Value::Text(String::new()), Value::from)],
            "getSystemTime" => vec![Value::Real(clock())],
            "moveToConfig_step" | "moveToPose_step" => return self.step_move(bare, arguments),
            "callScriptFunction" => self.script(a)?,
            "executeScriptString" => self.evaluate(a)?,
            "getScript" | "getScriptHandle" => self.script_of(a)?,
            name if let Some(this) = Move::of(name) => return self.begin_move(this, name, arguments),
            name if UNSAFE.contains(&name) => {
                return Err(ApiError(format!("sim.{name} is not allowed over the network")));
            }
            _ => {
                let mut results = self.session(name, arguments)?;
                // over the wire nothing stored is an empty text
                if matches!(bare, "readCustomDataBlock" | "readCustomBufferData") && results == [Value::Nil] {
                    results = vec![Value::Bytes(Vec::new())];
                }
                results
            }
        };
        Ok(CallOutcome::Done(results))
    }

    /// The client has run a callback, with these results.
    ///
    /// # Errors
    ///
    /// What comes after it cannot be done.
    pub fn answer(
        &self,
        name: &str,
        arguments: &[Value],
        after: After,
        results: &[Value],
    ) -> Result<CallOutcome, ApiError> {
        match after {
            After::Again(left) if left > 0 => {
                let (name, arguments) = (name.to_owned(), arguments.to_vec());
                Ok(CallOutcome::Callback { name, arguments, after: After::Again(left - 1) })
            }
            After::Again(_) => Ok(CallOutcome::Done(results.to_vec())),
            After::Move(motion) => self.answer_move(*motion, results),
            After::Wait(wait) => self.wait(wait),
        }
    }

    /// The client runs no callbacks, or is gone: the continuation is dropped.
    pub fn decline(&self, after: After, why: &str) -> ApiError {
        let error = ApiError::new(why);
        match after {
            After::Again(_) | After::Wait(_) => error,
            After::Move(motion) => self.give_up(&motion, error),
        }
    }

    /// Calls a function of a script: (name, script, …), (script, name, …), or (`name@object`, type, …) of old clients.
    fn script(&self, a: Arguments<'_>) -> Result<Vec<Value>, ApiError> {
        let (name, other) =
            if a.get(0).as_text().is_some() { (a.text(0)?, a.int(1)?) } else { (a.text(1)?, a.int(0)?) };
        let arguments = a.0.get(2..).unwrap_or_default();
        let mut guard = self.hub.enter();
        guard.seen(self.id);
        let results = guard.act(|session| match name.split_once('@') {
            Some((function, object)) => {
                let object = session.registry().find(object, Search::default())?;
                session.call_script(object, kind_of(other), function, arguments)
            }
            None => {
                // scripts have the handles of their objects here
                let object = i32::try_from(other).map_err(|_| ApiError(format!("{other} is no handle")))?;
                session.call_script(Handle(object), None, name, arguments)
            }
        });
        drop(guard);
        self.hub.wake();
        let mut results =
            results.map_err(|ApiError(e)| ApiError(format!("{e} (in function 'sim.callScriptFunction')")))?;
        if results.is_empty() {
            results.push(Value::Nil);
        }
        Ok(results)
    }

    /// Runs a text in a script, if that is granted: (text, script) or (`text@object`, type).
    fn evaluate(&self, a: Arguments<'_>) -> Result<Vec<Value>, ApiError> {
        let (text, script) = (a.text(0)?, a.int_or(1, 0)?);
        let mut guard = self.hub.enter();
        guard.seen(self.id);
        let results = guard.act(|session| {
            let named = text.rsplit_once('@').and_then(|(text, name)| {
                let object = session.registry().find(name, Search::default()).ok()?;
                Some((text, object))
            });
            match named {
                Some((text, object)) => session.evaluate(object, kind_of(script), text),
                None => {
                    let object = i32::try_from(script).map_err(|_| ApiError(format!("{script} is no handle")))?;
                    session.evaluate(Handle(object), None, text)
                }
            }
        });
        drop(guard);
        self.hub.wake();
        results.map_err(|ApiError(e)| ApiError(format!("{e} (in function 'sim.executeScriptString')")))
    }

    /// The script of an object: it has the object's handle. The sandbox has none.
    fn script_of(&self, a: Arguments<'_>) -> Result<Vec<Value>, ApiError> {
        if a.get(0).as_int() == Some(SANDBOX_TYPE) && !a.has(1) {
            return Ok(vec![Value::Int(SANDBOX)]);
        }
        let mut guard = self.hub.enter();
        let registry = guard.session.registry();
        let object = match a.get(1) {
            Value::Text(path) => registry.find(path, Search::default())?,
            _ => registry.entry(Handle(a.handle(if a.has(1) { 1 } else { 0 })?))?.handle,
        };
        Ok(vec![object.into()])
    }

    pub(super) fn session(&self, name: &str, arguments: &[Value]) -> Result<Vec<Value>, ApiError> {
        if !name.starts_with("sim") {
            let short: String = name.chars().take(100).collect();
            return Err(ApiError(format!("No such function: {short}")));
        }
        let mut guard = self.hub.enter();
        guard.seen(self.id);
        let result = guard.act(|session| session.call(name, arguments));
        drop(guard);
        self.hub.wake();
        result
    }

    /// One step, or as many as are asked for in one call.
    fn steps(&self, a: Arguments<'_>) -> Result<Vec<Value>, ApiError> {
        // old clients give a truth value: it means nothing
        let n = match a.get(0) {
            Value::Nil | Value::Bool(_) => 1,
            _ => a.int(0)?,
        };
        if !(1..=limits::STEPS).contains(&n) {
            return Err(ApiError(format!("{n} steps, expected 1 to {}", limits::STEPS)));
        }
        for _ in 0..n {
            self.hub.step(self.id)?;
        }
        Ok(Vec::new())
    }

    fn begin_wait(&self, a: Arguments<'_>) -> Result<CallOutcome, ApiError> {
        let dt = a.real(0)?;
        if !(0.0..=MAX_WAIT).contains(&dt) {
            return Err(ApiError(format!("a wait of {dt} s, expected 0 to {MAX_WAIT} s")));
        }
        self.wait(if a.bool_or(1, true)? {
            Wait::Simulated(self.time().0 + dt)
        } else {
            Wait::Until(Instant::now() + Duration::from_secs_f64(dt))
        })
    }

    /// Waits on, and tells the client to come back where that takes long.
    fn wait(&self, wait: Wait) -> Result<CallOutcome, ApiError> {
        let begin = Instant::now();
        let time_left = match wait {
            Wait::Until(end) => {
                std::thread::sleep(end.saturating_duration_since(begin).min(WAIT_PART));
                (Instant::now() >= end).then_some(0.0)
            }
            Wait::Simulated(end) => loop {
                let (t, runs) = self.time();
                if t >= end - 1e-9 || !runs {
                    break Some((end - t).min(0.0));
                }
                if begin.elapsed() >= WAIT_PART {
                    break None;
                }
                self.hub.step(self.id)?;
            },
        };
        self.hub.enter().seen(self.id);
        Ok(match time_left {
            Some(time_left) => CallOutcome::Done(vec![Value::Real(time_left)]),
            None => CallOutcome::Callback {
                name: GO_ON_WAITING.to_owned(),
                arguments: Vec::new(),
                after: After::Wait(wait),
            },
        })
    }

    /// Simulation time `[s]`, and whether a run is on.
    fn time(&self) -> (f64, bool) {
        let mut guard = self.hub.enter();
        (guard.session.t(), guard.session.phase() == sincro_coppelia::api::Phase::Running)
    }
}

/// The kind of script of a number of V-REP; none for those that scenes do not have.
pub(crate) fn kind_of(number: i64) -> Option<Kind> {
    match number {
        1 => Some(Kind::Child),
        6 => Some(Kind::Customization),
        _ => None,
    }
}

fn callback(a: Arguments<'_>) -> Result<CallOutcome, ApiError> {
    let name = a.text(1)?;
    let name = name.strip_suffix("@func").unwrap_or(name).to_owned();
    let left = a.int_or(3, 99)?.clamp(0, 10_000);
    Ok(CallOutcome::Callback { name, arguments: vec![a.get(0).clone(), a.get(2).clone()], after: After::Again(left) })
}

/// Seconds of the wall clock: for clients that time themselves, not for the simulation.
fn clock() -> f64 {
    SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).map_or(0.0, |d| d.as_secs_f64())
}

/// Present names of all functions that the module `sim` of the ZeroMQ API offers, without `sim.`, for the table of
/// `docs/compatibility.md`.
#[must_use]
pub fn present_names() -> Vec<&'static str> {
    let own = FUNCTIONS.iter().map(|(name, _)| *name).filter(|name| functions::function(name).is_none());
    let moves = functions::MOVES.iter().map(|(name, _, _)| *name);
    functions::functions().map(|f| f.name).chain(own).chain(moves).collect()
}

/// Every function that can be called, by present and old names, without `sim.`.
fn all() -> impl Iterator<Item = &'static str> {
    let own = FUNCTIONS.iter().map(|(name, _)| *name).filter(|name| functions::function(name).is_none());
    let old = functions::old_names().filter(|(_, present)| functions::function(present).is_some()).map(|(old, _)| old);
    let moves = functions::MOVES.iter().map(|(name, _, _)| *name);
    functions::functions().map(|f| f.name).chain(own).chain(moves).chain(old)
}

/// Names that begin as asked for, with `sim.` before them; `+` before the beginning asks for all of it.
fn names(begin: &str) -> impl Iterator<Item = String> {
    let begin = begin.trim_start_matches(['+', '-']).to_owned();
    all().map(|name| format!("sim.{name}")).filter(move |name| name.starts_with(&begin))
}

fn tip(name: &str) -> Option<&'static str> {
    let bare = name.strip_prefix("sim.").unwrap_or(name);
    let own = FUNCTIONS.iter().find(|(known, _)| *known == bare).map(|(_, tip)| *tip);
    let of_move = || functions::MOVES.iter().find(|(known, _, _)| *known == bare).map(|(_, tip, _)| *tip);
    own.or_else(of_move).or_else(|| functions::function(name).map(|f| f.tip))
}

/// Everything that a module has, as clients build their own from it.
///
/// # Errors
///
/// The module is not offered.
pub(crate) fn info(module: &str) -> Result<Value, ApiError> {
    static SIM: OnceLock<Value> = OnceLock::new();
    static IK: OnceLock<Value> = OnceLock::new();
    static UI: OnceLock<Value> = OnceLock::new();
    static VISION: OnceLock<Value> = OnceLock::new();
    static PLANNING: OnceLock<Value> = OnceLock::new();
    if !is_offered(module) {
        return Err(ApiError(format!("there is no module {module}: {MODULES}")));
    }
    if module.starts_with("simIK") {
        let names = functions::ik_functions().map(|f| f.name).chain(functions::old_ik_names().map(|(old, _)| old));
        return Ok(IK.get_or_init(|| members(names, functions::ik::CONSTANTS.iter().copied())).clone());
    }
    if module.starts_with("simOMPL") {
        return Ok(PLANNING.get_or_init(planning).clone());
    }
    if module.starts_with("simUI") {
        return Ok(UI.get_or_init(|| members(functions::ui_functions().map(|f| f.name), std::iter::empty())).clone());
    }
    if module.starts_with("simVision") {
        let of_vision = || members(functions::vision_functions().map(|f| f.name), std::iter::empty());
        return Ok(VISION.get_or_init(of_vision).clone());
    }
    Ok(SIM.get_or_init(|| members(all(), constants::constants())).clone())
}

/// The module `simOMPL`, whose constants stand in tables.
fn planning() -> Value {
    let mut all = Vec::new();
    if let Value::Map(functions) = members(functions::planning_functions().map(|f| f.name), std::iter::empty()) {
        all = functions;
    }
    for (table, constants) in paths::names::tables() {
        all.push((table.into(), members(std::iter::empty(), constants.into_iter())));
    }
    Value::Map(all)
}

/// A module as clients build their own from it.
fn members<'a>(names: impl Iterator<Item = &'a str>, constants: impl Iterator<Item = (&'a str, i64)>) -> Value {
    let func = || Value::Map(vec![("func".into(), Value::Map(Vec::new()))]);
    let constant = |x: i64| Value::Map(vec![("const".into(), Value::Int(x))]);
    let functions = names.map(|name| (name.to_owned(), func()));
    let constants = constants.map(|(name, x)| (name.to_owned(), constant(x)));
    Value::Map(functions.chain(constants).collect())
}

/// Returns true if a module is here: `sim`, `simIK`, `simOMPL`, `simUI` and `simVision`, with or without a version.
pub(crate) fn is_offered(module: &str) -> bool {
    let (name, version) = module.split_once('-').unwrap_or((module, "1"));
    matches!(name, "sim" | "simIK" | "simOMPL" | "simUI" | "simVision") && version.parse() == Ok(1)
}

/// `require`
///
/// # Errors
///
/// The module is not offered.
pub(crate) fn require(module: &str) -> Result<Vec<Value>, ApiError> {
    let short: String = module.chars().take(100).collect();
    if is_offered(module) {
        Ok(vec![Value::Nil])
    } else {
        Err(ApiError(format!("there is no module {short}: {MODULES}")))
    }
}
