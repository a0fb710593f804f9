//! One script in its Lua state: how it is called in each phase of the step.
//!
//! | style | called |
//! |---|---|
//! | old (V-REP up to 3.4) | the whole text is run again, `sim_call_type` is the phase; globals stay |
//! | new | `sysCall_init`, `sysCall_actuation`, `sysCall_sensing`, `sysCall_cleanup`, those that are there |
//! | thread | `sysCall_thread` (an old thread: the whole text) is a coroutine, resumed at each step before any actuation |
//! | thread of V-REP 3.6 to 4.2 | the text is a coroutine, too, and may wait; when it has ended, `sysCall_threadmain` is the thread |
//!
//! The first run decides the style: it is new if there is a function `sysCall_…` after it. An old script that names no
//! `sim_call_type`, but counts its calls or calls the scripts below it, is one of V-REP up to 3.1.2: it is run in the
//! actuation phase only.

use std::sync::Arc;

use mlua::chunk::ChunkMode;
use mlua::{Function, Lua, Thread, Value};
use sincro_coppelia::api::{self as sim_api, ApiError, Handle};
use sincro_coppelia::host::Phase;
use sincro_scene::script::{Kind, OnError, Script, ScriptError, Style};

use crate::guard::Guard;
use crate::lexer::{self, Sort, Word};
use crate::sandbox::{self, CHUNK};
use crate::shared::Shared;
use crate::{api, callback, contact, convert, fault, files, older_names, power, vision};

/// Values of `sim_call_type`; any numbers will do, scripts compare names.
pub(crate) const CALL_TYPES: [(&str, i64); 10] = [
    ("init", 0),
    ("actuation", 1),
    ("sensing", 2),
    ("cleanup", 3),
    ("suspend", 4),
    ("suspended", 5),
    ("resume", 6),
    ("nonsimulation", 7),
    ("lastbeforesimulation", 8),
    ("firstaftersimulation", 9),
];

/// Function of a thread of V-REP 3.6 to 4.2: it is called when the text, which is part of the thread, has ended.
const THREAD_MAIN: &str = "sysCall_threadmain";

/// Name of the whole text as a function in the registry of its Lua state, for scripts that call it.
pub(crate) const TEXT: &str = "sincro.text";

/// Callbacks of CoppeliaSim that are not called here, and why.
const NOT_CALLED: [(&str, &str); 3] = [
    ("sysCall_trigger", "it is for scripts on vision sensors, whose sysCall_vision triggers"),
    ("sysCall_vision", "it is for scripts on vision sensors"),
    ("sysCall_nonSimulation", "it is for customization scripts, while `sincro serve` is stopped"),
];

/// Lua state of one script, with its limits and entry points.
#[derive(Debug)]
pub(crate) struct Machine {
    /// Its Lua state.
    pub lua: Lua,
    index: usize,
    shared: Arc<Shared>,
    guard: Arc<Guard>,
    chunk: Function,
    style: Style,
    entries: Entries,
    thread: Option<Thread>,
    /// True while the thread is the text itself, after which come the functions that it has made.
    is_text_pending: bool,
    /// True if `sysCall_joint` has been called.
    is_joint_called: bool,
    /// True if it has failed while there was no run.
    pub has_failed: bool,
    /// True if it has failed in a run that went on, and is not called any more there.
    is_dead: bool,
    /// True if the last error stops the run of any script: a limit, or a number that is not finite.
    must_stop: bool,
    /// True if the run goes on after an error.
    continues: bool,
    /// True if it is written for V-REP up to 3.4.
    is_old_api: bool,
    /// True once `sysCall_init` has been called.
    is_initialized: bool,
    /// True if it is one of V-REP up to 3.1.2: the whole text is run in actuation, and not otherwise.
    is_for_actuation: bool,
}

/// Functions of a new script that are there.
#[derive(Debug, Default)]
struct Entries {
    actuation: Option<Function>,
    sensing: Option<Function>,
    dynamics: Option<Function>,
    joint: Option<Function>,
    contact: Option<Function>,
    vision: Option<Function>,
    before_main: Option<Function>,
}

/// Compiles a text, its lines counted as in its source.
pub(crate) fn compile(lua: &Lua, script: &Script) -> mlua::Result<Function> {
    let text = "\n".repeat(script.lines_before) + &power::with_calls(&older_names::renamed(&script.text));
    lua.load(text).set_name(format!("={CHUNK}")).set_mode(ChunkMode::Text).into_function()
}

impl Machine {
    /// The script `index` of a run, not called yet.
    pub fn new(shared: &Arc<Shared>, index: usize) -> Result<Self, ScriptError> {
        let script = &*shared.script(index);
        let guard = Guard::new(script.max_instructions);
        Self::furnished(shared, index, guard.clone()).map_err(|error| fault::of(script, &guard, &error))
    }

    fn furnished(shared: &Arc<Shared>, index: usize, guard: Arc<Guard>) -> mlua::Result<Self> {
        let script = &*shared.script(index);
        guard.begin();
        let lua = sandbox::new(&guard, script.max_memory)?;
        let (of_time, of_signals, of_prints) = (shared.clone(), shared.clone(), shared.clone());
        let own = crate::shared::handle_of(script);
        let services = sandbox::Services {
            time: Box::new(move || of_time.t()),
            signal: Box::new(move |lua, name| api::signal(lua, &of_signals, own, name)),
            print: Box::new(move |line| of_prints.say(index, line)),
        };
        let seed = seed_of(shared.setting.seed, &script.path);
        let waits = sandbox::furnish(&lua, &guard, seed, services)?;
        api::offer(&lua, shared, index, &guard, &waits)?;
        files::offer(&lua, shared, index, &guard)?;
        let chunk = compile(&lua, script)?;
        lua.set_named_registry_value(TEXT, &chunk)?;
        let (style, entries) = (script.style, Entries::default());
        let is_old_api = is_of_old_api(&script.text);
        let continues = match script.on_error {
            OnError::Detect => is_old_api,
            OnError::Stop => false,
            OnError::Continue => true,
        };
        Ok(Self {
            lua,
            index,
            shared: shared.clone(),
            guard,
            chunk,
            style,
            entries,
            thread: None,
            is_text_pending: false,
            is_joint_called: false,
            has_failed: false,
            is_dead: false,
            must_stop: false,
            continues,
            is_old_api,
            is_initialized: false,
            is_for_actuation: script.style != Style::New && !script.is_threaded && is_for_actuation(&script.text),
        })
    }

    fn script(&self) -> Arc<Script> {
        self.shared.script(self.index)
    }

    /// Place of its script among those that have been started.
    pub fn place(&self) -> usize {
        self.index
    }

    /// Gives the script all its instructions again: other scripts may call its functions before it is called itself.
    pub fn refill(&self) {
        self.guard.begin();
    }

    /// Resumes the script after a client's call reached a limit: in this script, or in another one that it called.
    pub fn resume_script(&self) {
        self.guard.resume_script(&self.lua);
    }

    /// Calls a function by its name, for a client.
    pub fn call_function(&mut self, name: &str, arguments: &[sim_api::Value]) -> Result<Vec<sim_api::Value>, ApiError> {
        let path = self.script().path.clone();
        let Some(function) = api::function_of(&self.lua, name) else {
            return Err(ApiError(format!("the script of `{path}` has no function `{name}`")));
        };
        // those of Lua and of the simulator would act for the script, beyond what clients are granted
        let info = function.info();
        if info.what != "Lua" || info.source.as_deref() == Some(sandbox::OWN_SOURCE) {
            return Err(ApiError(format!("`{name}` is no function that the script of `{path}` itself has")));
        }
        let done = self.within(|m| {
            let values = function.call(convert::list_to_lua(&m.lua, arguments)?)?;
            convert::list_from_lua(values)
        });
        done.map_err(|fault| ApiError(fault.to_string()))
    }

    /// Runs a text as if it stood in the script, for a client.
    pub fn evaluate(&mut self, text: &str) -> Result<Vec<sim_api::Value>, ApiError> {
        let done = self.within(|m| {
            sandbox::charge_text(&m.lua, &m.guard, text)?;
            let text = power::with_calls(&older_names::renamed(text));
            let values = m.lua.load(text).set_name("=text").set_mode(ChunkMode::Text).call(())?;
            convert::list_from_lua(values)
        });
        done.map_err(|fault| ApiError(fault.message))
    }

    /// Runs something of the script within its limits.
    fn within<T>(&mut self, run: impl FnOnce(&mut Self) -> mlua::Result<T>) -> Result<T, ScriptError> {
        self.guard.begin();
        let done = run(self).and_then(|value| self.guard.check().map(|()| value));
        done.map_err(|error| {
            self.must_stop = self.guard.is_stopped() || self.guard.is_not_finite(&error) || fault::is_of_memory(&error);
            fault::of(&self.script(), &self.guard, &error)
        })
    }

    /// Decides what an error in a call of the run does: the run goes on if the script says so, unless the error
    /// is one of a limit, or of a number that is not finite.
    pub fn after(&mut self, done: Result<(), ScriptError>) -> Result<(), ScriptError> {
        let Err(error) = done else { return Ok(()) };
        if !self.continues || self.must_stop {
            return Err(error);
        }
        let what_follows = if self.is_old_api {
            "it is called again in the next step, as in V-REP"
        } else {
            "it is not called any more in this run, as in CoppeliaSim"
        };
        self.shared.fail(self.index, &error, what_follows);
        self.is_dead = !self.is_old_api;
        if self.is_old_api && !self.is_initialized {
            self.recover()?;
        }
        Ok(())
    }

    /// Returns true if it has failed in this run and is not called any more.
    pub fn is_dead(&self) -> bool {
        self.is_dead
    }

    /// A script of V-REP that has failed in its first call is called in the next step.
    fn recover(&mut self) -> Result<(), ScriptError> {
        self.is_initialized = true;
        if self.style == Style::Detect {
            let is_new = self.within(|m| m.has_entries())?;
            self.style = if is_new { Style::New } else { Style::Old };
        }
        self.tell_style();
        self.within(Self::update_entries)
    }

    /// Hands messages of topics to the functions of the script that have subscribed to them.
    pub fn deliver(&mut self) -> Result<(), ScriptError> {
        if !self.shared.topics().has_messages(self.index) {
            return Ok(());
        }
        self.within(|m| m.lua.named_registry_value::<Function>(api::DELIVER)?.call(()))
    }

    /// A phase of the step, or of the time between runs; threads are resumed by [`Machine::resume`].
    pub fn call(&mut self, phase: Phase) -> Result<(), ScriptError> {
        let is_old = self.style == Style::Old;
        match phase {
            Phase::Initialization | Phase::Open => self.begin(phase),
            // V-REP's old scripts know of no pauses
            Phase::Suspend | Phase::Suspended | Phase::Resume if is_old => Ok(()),
            Phase::Suspend => self.call_named("sysCall_suspend"),
            Phase::Suspended => self.call_named("sysCall_suspended"),
            Phase::Resume => self.call_named("sysCall_resume"),
            Phase::Actuation if is_old => self.within(|m| m.call_whole("actuation")),
            Phase::Sensing | Phase::Cleanup if self.is_for_actuation => Ok(()),
            Phase::Sensing if is_old => self.within(|m| m.call_whole("sensing")),
            Phase::Actuation => self.call_entry(|e| &e.actuation),
            Phase::Sensing => self.call_entry(|e| &e.sensing),
            Phase::NonSimulation => self.call_either("nonsimulation", "sysCall_nonSimulation"),
            Phase::Cleanup if self.is_customization() => {
                self.call_either("firstaftersimulation", "sysCall_afterSimulation")
            }
            Phase::Cleanup | Phase::Close => self.call_either("cleanup", "sysCall_cleanup"),
        }
    }

    /// Returns true if steps of a run do not call it, because a script has said so.
    pub fn sleeps(&self) -> bool {
        self.is_customization() && !self.shared.activity(self.index).is_in_runs
    }

    /// Returns true if it is a customization script.
    pub fn is_customization(&self) -> bool {
        self.script().kind == Kind::Customization
    }

    /// The initialization, unless it has been; before a run a customization script is told of that, too.
    fn begin(&mut self, phase: Phase) -> Result<(), ScriptError> {
        if !self.is_initialized {
            self.within(|m| m.initialize(phase))?;
            self.is_initialized = true;
            self.tell_style();
        }
        if phase == Phase::Open || !self.is_customization() {
            return Ok(());
        }
        self.call_either("lastbeforesimulation", "sysCall_beforeSimulation")?;
        self.within(Self::update_entries)
    }

    /// Lets scripts above know how this one is called; an old one may call those below it itself.
    fn tell_style(&self) {
        let script = self.script();
        let is_thread = script.is_threaded || (self.style == Style::Old && self.thread.is_some());
        let is_caller = self.style == Style::Old && !is_thread && calls_those_below(&script.text);
        self.shared.change_cascade(self.index, |cascade| {
            (cascade.style, cascade.is_thread) = (self.style, is_thread);
            cascade.is_automatic &= !is_caller;
        });
    }

    /// Calls an old script as a whole, a new one and a thread by a function.
    fn call_either(&mut self, call_type: &str, name: &str) -> Result<(), ScriptError> {
        let is_whole = self.style == Style::Old && self.thread.is_none();
        if is_whole { self.within(|m| m.call_whole(call_type)) } else { self.call_named(name) }
    }

    fn initialize(&mut self, phase: Phase) -> mlua::Result<()> {
        let script = self.script();
        let has_main = self.style != Style::Old && script.text.contains(THREAD_MAIN);
        if script.is_threaded || has_main {
            self.style = Style::Old;
            self.is_text_pending = true;
            if has_main {
                api::hold_variables(&self.lua)?;
            }
            self.become_thread(self.chunk.clone())?;
            // one that is declared a thread begins with the first step
            return if script.is_threaded { Ok(()) } else { self.begin_text(phase) };
        }
        if self.is_for_actuation {
            self.style = Style::Old;
            return Ok(());
        }
        if self.style == Style::New {
            self.chunk.call::<()>(())?;
        } else {
            self.call_whole("init")?;
            if self.style == Style::Old || !self.has_entries()? {
                self.style = Style::Old;
                return Ok(());
            }
            self.style = Style::New;
            self.lua.globals().set("sim_call_type", Value::Nil)?;
        }
        self.begin_new(phase)
    }

    /// Runs the text of a script with `sysCall_threadmain` until it ends or waits for the first time.
    fn begin_text(&mut self, phase: Phase) -> mlua::Result<()> {
        let init = CALL_TYPES.iter().find(|(name, _)| *name == "init").map(|(_, number)| *number);
        self.lua.globals().set("sim_call_type", init)?;
        self.resume_thread(phase)
    }

    /// Resumes the thread; if that was the text and it has ended, its functions come to life.
    fn resume_thread(&mut self, phase: Phase) -> mlua::Result<()> {
        let Some(thread) = self.thread.clone().filter(Thread::is_resumable) else { return Ok(()) };
        thread.resume::<()>(())?;
        if thread.is_resumable() || !std::mem::take(&mut self.is_text_pending) {
            return Ok(());
        }
        api::set_held_variables(&self.lua)?;
        if self.has_entries()? {
            (self.style, self.thread) = (Style::New, None);
            self.lua.globals().set("sim_call_type", Value::Nil)?;
            return self.begin_new(phase);
        }
        if !self.script().is_threaded {
            self.thread = None;
        }
        Ok(())
    }

    /// Returns true if any function `sysCall_…` is there.
    fn has_entries(&self) -> mlua::Result<bool> {
        for pair in self.lua.globals().pairs::<Value, Value>() {
            let (name, value) = pair?;
            if let (Value::String(name), Value::Function(_)) = (name, value)
                && name.as_bytes().starts_with(b"sysCall_")
            {
                return Ok(true);
            }
        }
        Ok(false)
    }

    fn entry(&self, names: &[&str]) -> mlua::Result<Option<Function>> {
        let globals = self.lua.globals();
        for name in names {
            if let Value::Function(function) = globals.get(*name)? {
                return Ok(Some(function));
            }
        }
        Ok(None)
    }

    fn begin_new(&mut self, phase: Phase) -> mlua::Result<()> {
        self.entries = Entries {
            actuation: self.entry(&["sysCall_actuation"])?,
            sensing: self.entry(&["sysCall_sensing"])?,
            dynamics: self.entry(&["sysCall_dyn", "sysCall_dynCallback"])?,
            joint: self.entry(&["sysCall_joint", "sysCall_jointCallback"])?,
            contact: self.entry(&["sysCall_contact", "sysCall_contactCallback"])?,
            vision: self.entry(&["sysCall_vision"])?,
            before_main: self
                .entry(&["sysCall_beforeMainScript"])?
                .filter(|_| self.script().kind == Kind::Customization),
        };
        for (name, why) in NOT_CALLED {
            // those of a session are
            let is_called = match name {
                "sysCall_nonSimulation" => phase == Phase::Open,
                "sysCall_vision" | "sysCall_trigger" => vision::is_sensor(&self.shared, self.shared.object(self.index)),
                _ => false,
            };
            if !is_called && self.entry(&[name])?.is_some() {
                self.shared.say(self.index, format!("{name} is not called: {why}"));
            }
        }
        if let Some(function) = self.entry(&["sysCall_init"])? {
            function.call::<()>(())?;
        }
        self.update_entries()?;
        match self.entry(&["sysCall_thread", THREAD_MAIN])? {
            Some(function) => self.become_thread(function),
            None => Ok(()),
        }
    }

    /// Finds the functions again: others may have been made by the one that was called.
    fn update_entries(&mut self) -> mlua::Result<()> {
        if self.style == Style::New {
            self.entries.actuation = self.entry(&["sysCall_actuation"])?;
            self.entries.sensing = self.entry(&["sysCall_sensing"])?;
        }
        Ok(())
    }

    fn become_thread(&mut self, function: Function) -> mlua::Result<()> {
        let thread = self.lua.create_thread(function)?;
        self.thread = Some(thread);
        Ok(())
    }

    /// The text of an old script; one that is a thread is not called.
    fn call_whole(&mut self, call_type: &str) -> mlua::Result<()> {
        if self.thread.is_some() {
            return Ok(());
        }
        let call_type = CALL_TYPES.iter().find(|(name, _)| *name == call_type).map(|(_, number)| *number);
        self.lua.globals().set("sim_call_type", call_type)?;
        self.chunk.call::<()>(())?;
        let count = self.shared.execution_count(self.index);
        self.shared.set_execution_count(self.index, count.saturating_add(1));
        Ok(())
    }

    fn call_entry(&mut self, which: fn(&Entries) -> &Option<Function>) -> Result<(), ScriptError> {
        let Some(function) = which(&self.entries).clone() else { return Ok(()) };
        self.within(|_| function.call(()))
    }

    /// Prepares for the next run of a session: a limit that was reached counts no longer.
    pub fn forget_run(&mut self) {
        (self.is_joint_called, self.has_failed, self.is_dead, self.must_stop) = (false, false, false, false);
        self.resume_script();
    }

    /// Calls a function if the script has it.
    fn call_named(&mut self, name: &str) -> Result<(), ScriptError> {
        self.within(|m| m.entry(&[name])?.map_or(Ok(()), |function| function.call(())))
    }

    /// Resumes the script's thread, if it is one and has not ended.
    pub fn resume(&mut self) -> Result<(), ScriptError> {
        if !self.thread.as_ref().is_some_and(Thread::is_resumable) {
            return Ok(());
        }
        let phase = if self.is_customization() { Phase::Open } else { Phase::Initialization };
        self.within(|m| {
            let was_text = m.is_text_pending;
            m.resume_thread(phase)?;
            // what follows the text goes on in the same step
            if was_text && !m.is_text_pending {
                m.tell_style();
                m.resume_thread(phase)
            } else {
                Ok(())
            }
        })
    }

    /// Calls `sysCall_dyn` before or after the world's step.
    pub fn call_dynamics(&mut self, step: f64, is_after: bool) -> Result<(), ScriptError> {
        let Some(function) = self.entries.dynamics.clone() else { return Ok(()) };
        self.within(|m| {
            let info = m.lua.create_table()?;
            info.set("passCnt", 1)?;
            info.set("totalPasses", 1)?;
            info.set("dynStepSize", step)?;
            info.set("afterStep", is_after)?;
            function.call(info)
        })
    }

    /// Calls `sysCall_beforeMainScript` of a customization script, before anything else of the step; says whether it
    /// holds the step back.
    pub fn call_before_main(&mut self) -> Result<bool, ScriptError> {
        let Some(function) = self.entries.before_main.clone() else { return Ok(false) };
        let answer: Value = self.within(|_| function.call(()))?;
        let Value::Table(answer) = answer else { return Ok(false) };
        Ok(answer.get::<Option<bool>>("doNotRunMainScript").ok().flatten() == Some(true))
    }

    /// The script has held a step back too often.
    pub fn holds_back(&self, times: u32) -> ScriptError {
        let message = format!(
            "sysCall_beforeMainScript has held back one step {times} times: nothing can let it go, for time stands still meanwhile"
        );
        let (object, help) = (self.script().path.clone(), "hold back for a number of calls, or pause the simulation");
        ScriptError { object, at: None, message, help: Some(help.to_owned()) }
    }

    /// Returns true if the script decides what touches.
    pub fn has_contact(&self) -> bool {
        self.entries.contact.is_some()
    }

    /// Asks the script what a pair of bodies does in the coming step; says whether it decided.
    pub fn call_contact(&mut self, bodies: [Handle; 2]) -> Result<bool, ScriptError> {
        let Some(function) = self.entries.contact.clone() else { return Ok(false) };
        self.within(|m| contact::ask(&m.lua, &m.shared, m.index, &function, bodies))
    }

    /// Calls `sysCall_vision` of a script on a vision sensor that each step handles.
    pub fn call_vision(&mut self) -> Result<(), ScriptError> {
        let Some(function) = self.entries.vision.clone() else { return Ok(()) };
        let sensor = self.shared.object(self.index);
        if !vision::is_handled_by_step(&self.shared, sensor) {
            return Ok(());
        }
        self.within(|m| vision::filter(&m.lua, &m.shared, sensor, &function))
    }

    /// Calls `sysCall_vision` of a script on a vision sensor that a client has handled; returns true if there is one.
    pub fn filter_picture(&mut self) -> Result<bool, ApiError> {
        let Some(function) = self.entries.vision.clone() else { return Ok(false) };
        let sensor = self.shared.object(self.index);
        let done = self.within(|m| vision::filter(&m.lua, &m.shared, sensor, &function));
        done.map(|()| true).map_err(|fault| ApiError(fault.to_string()))
    }

    /// Calls `sysCall_joint` of a script on a joint with a motor, once a step, after actuation: what it returns is what
    /// the joint is commanded.
    pub fn call_joint(&mut self, step: f64) -> Result<(), ScriptError> {
        let Some(function) = self.entries.joint.clone() else { return Ok(()) };
        let is_first = !std::mem::replace(&mut self.is_joint_called, true);
        self.within(|m| callback::joint(&m.lua, &m.shared, m.index, &function, (step, is_first)))
    }
}

/// Returns true if a text calls the scripts below it as V-REP up to 3.1.2 did; comments and quoted texts do not count.
fn calls_those_below(text: &str) -> bool {
    let words = lexer::words(text);
    let is_call =
        |pair: &[Word]| text[pair[0].at.clone()] == *"simHandleChildScript" && text[pair[1].at.clone()] == *"(";
    words.windows(2).any(is_call)
}

/// Returns true if a text is written for V-REP up to 3.4: it calls functions such as `simGetObjectHandle`, or asks for
/// `sim_call_type`, and has nothing of the table `sim` and no functions `sysCall_…`.
pub(crate) fn is_of_old_api(text: &str) -> bool {
    let words = lexer::words(text);
    let word = |word: &Word| &text[word.at.clone()];
    let is_old = |name: &str| {
        name.strip_prefix("sim").is_some_and(|rest| rest.starts_with(|c: char| c == '_' || c.is_ascii_uppercase()))
    };
    let is_of_table = |pair: &[Word]| word(&pair[0]) == "sim" && word(&pair[1]) == ".";
    let names = || words.iter().filter(|w| w.sort == Sort::Name).map(word);
    names().any(is_old) && !names().any(|name| name.starts_with("sysCall_")) && !words.windows(2).any(is_of_table)
}

/// Returns true if a text is one of V-REP up to 3.1.2, where scripts had no call types.
fn is_for_actuation(text: &str) -> bool {
    let words = lexer::words(text);
    let names = |part: &str| words.iter().any(|word| text[word.at.clone()].contains(part));
    let has_call_types = names("sim_call_type") || names("sysCall_");
    !has_call_types && (calls_those_below(text) || names("simGetScriptExecutionCount"))
}

/// The run's seed and the object's path, mixed (FNV-1a).
fn seed_of(seed: u64, path: &str) -> u64 {
    let bytes = seed.to_le_bytes().into_iter().chain(path.bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3))
}
