//! Data shared by all scripts of a run: the world while they are called, their messages, and each other.

use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use mlua::WeakLua;
use sincro_coppelia::api::{ApiError, Handle, ObjectRegistry, SimApi};
use sincro_coppelia::host::Setting;
use sincro_dynamics::world::World;
use sincro_scene::script::Script;
use sincro_sim::controller::Message;

/// Messages of one phase that are kept: one more than a run keeps, so that the run reports that some were dropped.
const MAX_MESSAGES: usize = 10_001;
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
    /// The scripts, in the order of calls.
    pub scripts: Arc<[Script]>,
    /// Settings of the run.
    pub setting: Setting,
    /// Their Lua states, once all are made.
    pub states: OnceLock<Vec<WeakLua>>,
}

impl fmt::Debug for Shared {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Shared").field("scripts", &self.scripts.len()).finish_non_exhaustive()
    }
}

/// A lock that a panic of ours has left is as good as any: the run is over then.
fn open<T>(lock: &Mutex<T>) -> MutexGuard<'_, T> {
    lock.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Shared {
    /// Before the first call; `nothing` is a world of nothing.
    pub fn new(scripts: Arc<[Script]>, setting: Setting, nothing: World) -> Self {
        let stage = Mutex::new(Stage { world: nothing, registry: None, t: 0.0 });
        Self { stage, messages: Mutex::default(), scripts, setting, states: OnceLock::new() }
    }

    /// The stage. No Lua may run while it is held.
    pub fn stage(&self) -> MutexGuard<'_, Stage> {
        open(&self.stage)
    }

    /// Lets somebody act on the world for the object `own`.
    pub fn with_sim<T>(
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
            let end = text.floor_char_boundary(MAX_MESSAGE_LEN);
            messages.push(Message { t, object: self.scripts[script].path.clone(), text: text[..end].to_owned() });
        }
    }

    /// Takes what scripts have said.
    pub fn take_messages(&self) -> Vec<Message> {
        std::mem::take(&mut *open(&self.messages))
    }
}

/// The object of a script.
pub(crate) fn handle_of(script: &Script) -> Handle {
    Handle(script.object as i32 + 1)
}
