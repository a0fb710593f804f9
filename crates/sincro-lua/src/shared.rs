//! Data shared by all scripts of a run: the world while they are called, their messages, and each other.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::sync::atomic::AtomicUsize;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use mlua::{Lua, WeakLua};
use sincro_coppelia::api::topics::Topics;
use sincro_coppelia::api::{ApiError, Handle, ObjectRegistry, SimApi};
use sincro_coppelia::host::Setting;
use sincro_dynamics::world::World;
use sincro_scene::scene::Scene;
use sincro_scene::script::{Kind, Script, ScriptError, Style};
use sincro_sim::controller::{Message, ScriptFailure};

/// Messages of one phase that are kept: one more than a run keeps, so that the run reports that some were dropped.
const MAX_MESSAGES: usize = 10_001;
/// Different errors of a script that are told.
const MAX_ERRORS_TOLD: usize = 100;
/// Bytes of a message that are kept.
const MAX_MESSAGE_LEN: usize = 10_000;

/// The world, lent to the scripts for the time of a call; a world of nothing stands in its place otherwise.
#[derive(Debug)]
pub(crate) struct Stage {
    /// The world.
    pub world: World,
    /// The objects.
    pub registry: Option<Box<ObjectRegistry>>,
    /// Time `[s]` of the scripts.
    pub t: f64,
}

/// Data shared by all scripts of a run.
pub(crate) struct Shared {
    stage: Mutex<Stage>,
    messages: Mutex<Vec<Message>>,
    /// Scripts in the order in which they were started, with those that have ended.
    scripts: Mutex<Vec<Known>>,
    /// Errors after which the run went on, by the places of the scripts.
    failures: Mutex<BTreeMap<usize, Failures>>,
    /// Topics of `simROS`, with their publishers and subscribers.
    topics: Mutex<Topics>,
    /// Number of scripts that are calling each other down the tree.
    pub depth: AtomicUsize,
    /// Settings of the run.
    pub setting: Setting,
}

/// Errors of one script after which the run went on.
#[derive(Debug)]
struct Failures {
    failure: ScriptFailure,
    /// Texts of the errors that have been told, up to [`MAX_ERRORS_TOLD`].
    told: BTreeSet<String>,
}

/// Script that has been started.
struct Known {
    script: Arc<Script>,
    /// Its Lua state; none before it and those that are started with it are there, and after it has ended.
    state: Option<WeakLua>,
    has_ended: bool,
    /// Number of the calls of an old script, unless it has set another one itself.
    n_executions: i64,
    cascade: Cascade,
    activity: Activity,
}

/// When a script is called: as it has asked for, or another one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Activity {
    /// False if no step and no function of the simulation calls it any more.
    pub is_enabled: bool,
    /// False if it is a customization script that steps of a run do not call.
    pub is_in_runs: bool,
}

impl Activity {
    const NEW: Self = Self { is_enabled: true, is_in_runs: true };
}

/// Part of a script in the cascade of V-REP's calls: which scripts below it are called by whom.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Cascade {
    /// Its style, once that is known.
    pub style: Style,
    /// True if it is a thread as a whole: those below it are called as if it were not there.
    pub is_thread: bool,
    /// True if the step calls the scripts below it; false if it calls them itself (`simHandleChildScripts`).
    pub is_automatic: bool,
    /// True once it has been called by its handle (`simHandleChildScript`): calls of all but explicit ones skip it.
    pub is_explicit: bool,
}

impl Cascade {
    const NEW: Self = Self { style: Style::Detect, is_thread: false, is_automatic: true, is_explicit: false };
}

impl fmt::Debug for Shared {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Shared").field("scripts", &open(&self.scripts).len()).finish_non_exhaustive()
    }
}

/// A lock that a panic of ours has left is as good as any: the run is over then.
fn open<T>(lock: &Mutex<T>) -> MutexGuard<'_, T> {
    lock.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Shared {
    /// Before the first call; `nothing` is a world of nothing.
    pub fn new(setting: Setting, nothing: World) -> Self {
        let stage = Mutex::new(Stage { world: nothing, registry: None, t: 0.0 });
        let (messages, scripts, failures) = (Mutex::default(), Mutex::default(), Mutex::default());
        let topics = Mutex::default();
        Self { stage, messages, scripts, failures, topics, depth: AtomicUsize::new(0), setting }
    }

    /// Counts an error of a script after which the run goes on; one of the same text is told once.
    pub fn fail(&self, place: usize, error: &ScriptError, what_follows: &str) {
        let (t, message, object) = (self.t(), cut(error.to_string()), self.script(place).path.clone());
        let new = || {
            let failure = ScriptFailure { object, count: 0, first: t, message: message.clone() };
            Failures { failure, told: BTreeSet::new() }
        };
        let is_new = {
            let mut all = open(&self.failures);
            let of_script = all.entry(place).or_insert_with(new);
            of_script.failure.count += 1;
            of_script.told.len() < MAX_ERRORS_TOLD && of_script.told.insert(message.clone())
        };
        if is_new {
            self.say(place, format!("error: {message}; {what_follows}"));
        }
    }

    /// Scripts that have failed since the run began.
    pub fn failures(&self) -> Vec<ScriptFailure> {
        open(&self.failures).values().map(|failures| failures.failure.clone()).collect()
    }

    /// Forgets the errors of the run before.
    pub fn forget_failures(&self) {
        open(&self.failures).clear();
    }

    /// Adds a script; returns its place, which it keeps: that of an earlier run of a session, if it was there.
    pub fn add(&self, script: Arc<Script>) -> usize {
        let mut scripts = open(&self.scripts);
        let is_same =
            |known: &Known| known.has_ended && (known.script.object, known.script.kind) == (script.object, script.kind);
        let earlier = scripts.iter().position(is_same);
        let new = Known {
            script,
            state: None,
            has_ended: false,
            n_executions: 0,
            cascade: Cascade::NEW,
            activity: Activity::NEW,
        };
        if let Some(place) = earlier {
            scripts[place] = new;
            return place;
        }
        scripts.push(new);
        scripts.len() - 1
    }

    /// Keeps the Lua state of a script for others that call it.
    pub fn set_state(&self, place: usize, state: WeakLua) {
        open(&self.scripts)[place].state = Some(state);
    }

    /// When a script is called.
    pub fn activity(&self, place: usize) -> Activity {
        open(&self.scripts)[place].activity
    }

    /// Changes when a script is called.
    pub fn change_activity(&self, place: usize, change: impl FnOnce(&mut Activity)) {
        change(&mut open(&self.scripts)[place].activity);
    }

    /// Topics of the scripts.
    pub fn topics(&self) -> MutexGuard<'_, Topics> {
        open(&self.topics)
    }

    /// Lets a script be found no longer.
    pub fn end(&self, place: usize) {
        self.topics().forget(place);
        let known = &mut open(&self.scripts)[place];
        (known.state, known.has_ended) = (None, true);
    }

    /// The script of a place, whether it has ended or not.
    pub fn script(&self, place: usize) -> Arc<Script> {
        open(&self.scripts)[place].script.clone()
    }

    /// The Lua state of a script.
    pub fn state(&self, place: usize) -> Option<Lua> {
        open(&self.scripts)[place].state.as_ref()?.try_upgrade()
    }

    /// Number of the calls of an old script before the present one.
    pub fn execution_count(&self, place: usize) -> i64 {
        open(&self.scripts)[place].n_executions
    }

    /// Sets the number of the calls of an old script.
    pub fn set_execution_count(&self, place: usize, count: i64) {
        open(&self.scripts)[place].n_executions = count;
    }

    /// Part of a script in the cascade of calls.
    pub fn cascade(&self, place: usize) -> Cascade {
        open(&self.scripts)[place].cascade
    }

    /// Changes the part of a script in the cascade of calls.
    pub fn change_cascade(&self, place: usize, change: impl FnOnce(&mut Cascade)) {
        change(&mut open(&self.scripts)[place].cascade);
    }

    /// Returns true if a script is called by one above it, not by the step: the nearest ones without threads decide.
    pub fn is_called_from_above(&self, place: usize) -> bool {
        let scripts = open(&self.scripts);
        let is_manual = |known: &Known| {
            !known.has_ended
                && known.script.kind == Kind::Child
                && !(known.cascade.is_automatic || known.cascade.is_thread)
        };
        if scripts[place].script.kind != Kind::Child || !scripts.iter().any(is_manual) {
            return false;
        }
        let stage = self.stage();
        let Some(registry) = &stage.registry else { return false };
        let objects = &registry.scene().objects;
        let own = objects.iter().position(|object| object.id == scripts[place].script.object);
        let above = std::iter::successors(own.and_then(|k| objects[k].parent), |k| objects[*k].parent);
        let manual: Vec<usize> = scripts.iter().filter(|known| is_manual(known)).map(|k| k.script.object).collect();
        above.into_iter().any(|k| manual.contains(&objects[k].id))
    }

    /// Places of the child scripts that are met first on the ways down from an object, threads left out, in the order
    /// of the scene.
    pub fn first_below(&self, object: usize) -> Vec<usize> {
        let scripts = open(&self.scripts);
        let stage = self.stage();
        let Some(registry) = &stage.registry else { return Vec::new() };
        let objects = &registry.scene().objects;
        let place_on = |id: usize| {
            let is_it = |known: &Known| {
                !known.has_ended
                    && known.script.object == id
                    && known.script.kind == Kind::Child
                    && !known.cascade.is_thread
            };
            scripts.iter().position(is_it)
        };
        // parents stand before their children
        let mut is_open = vec![false; objects.len()];
        let mut found = Vec::new();
        for (k, at) in objects.iter().enumerate() {
            if at.id == object {
                is_open[k] = true;
            } else if at.parent.is_some_and(|parent| is_open[parent]) {
                match place_on(at.id) {
                    Some(place) => found.push(place),
                    None => is_open[k] = true,
                }
            }
        }
        found
    }

    /// The object of a script.
    pub fn object(&self, place: usize) -> Handle {
        handle_of(&self.script(place))
    }

    /// Returns true if the object of a script is part of the scene; `known` is a scene that it is part of.
    pub fn is_present(&self, script: &Script, known: Option<&Arc<Scene>>) -> bool {
        let stage = self.stage();
        let Some(registry) = &stage.registry else { return true };
        let scene = registry.scene();
        known.is_some_and(|known| Arc::ptr_eq(known, scene))
            || scene.objects.iter().any(|o| o.id == script.object)
            || registry.entry(handle_of(script)).is_ok_and(|entry| entry.is_runtime)
    }

    /// Place of the first script that is meant, of those whose objects are there.
    pub fn find(&self, is_meant: impl Fn(&Script) -> bool) -> Option<usize> {
        let is_it = |known: &Known| !known.has_ended && is_meant(&known.script) && self.is_present(&known.script, None);
        open(&self.scripts).iter().position(is_it)
    }

    /// Object and kind of a script that was added at run time, by its handle.
    pub fn added_script(&self, handle: i64) -> Option<(Handle, Kind)> {
        self.stage().registry.as_ref()?.added_script(handle)
    }

    /// Place of the script on an object.
    pub fn script_on(&self, object: Handle, kind: Option<Kind>) -> Option<usize> {
        self.find(|script| handle_of(script) == object && kind.is_none_or(|kind| script.kind == kind))
    }

    /// Objects with scripts that have not ended.
    pub fn objects(&self) -> Vec<Handle> {
        let is_there = |known: &&Known| !known.has_ended && self.is_present(&known.script, None);
        open(&self.scripts).iter().filter(is_there).map(|known| handle_of(&known.script)).collect()
    }

    /// Returns true if there is a script of that place that has not ended.
    pub fn has(&self, place: usize) -> bool {
        let is_there = |known: &Known| !known.has_ended && self.is_present(&known.script, None);
        open(&self.scripts).get(place).is_some_and(is_there)
    }

    /// The stage. No Lua may run while it is held.
    pub fn stage(&self) -> MutexGuard<'_, Stage> {
        open(&self.stage)
    }

    /// Lets somebody act on the world for the object `own`; what was removed has gone.
    pub fn with_sim<T>(
        &self,
        own: Handle,
        act: impl FnOnce(&mut SimApi<'_>) -> Result<T, ApiError>,
    ) -> Result<T, ApiError> {
        self.with_sim_as_it_is(own, |sim| {
            sim.remove_doomed()?;
            act(sim)
        })
    }

    /// As [`Shared::with_sim`], while objects wait to be removed.
    pub fn with_sim_as_it_is<T>(
        &self,
        own: Handle,
        act: impl FnOnce(&mut SimApi<'_>) -> Result<T, ApiError>,
    ) -> Result<T, ApiError> {
        let mut stage = self.stage();
        let Stage { world, registry, t } = &mut *stage;
        let Some(registry) = registry else {
            return Err(ApiError::new("the simulation can be reached while a script is called only"));
        };
        let mut sim = SimApi::new(registry, world, *t);
        sim.own = Some(own);
        act(&mut sim)
    }

    /// Time `[s]` of the scripts.
    pub fn t(&self) -> f64 {
        self.stage().t
    }

    /// Keeps what a script said.
    pub fn say(&self, script: usize, text: String) {
        let t = self.t();
        let mut messages = open(&self.messages);
        if messages.len() < MAX_MESSAGES {
            messages.push(Message { t, object: self.script(script).path.clone(), text: cut(text) });
        }
    }

    /// Takes what scripts have said.
    pub fn take_messages(&self) -> Vec<Message> {
        std::mem::take(&mut *open(&self.messages))
    }
}

/// A message, its end beyond [`MAX_MESSAGE_LEN`] left out.
fn cut(mut text: String) -> String {
    if text.len() > MAX_MESSAGE_LEN {
        text.truncate(text.floor_char_boundary(MAX_MESSAGE_LEN));
        text.shrink_to_fit();
    }
    text
}

/// The object of a script.
pub(crate) fn handle_of(script: &Script) -> Handle {
    Handle(script.object as i32 + 1)
}
