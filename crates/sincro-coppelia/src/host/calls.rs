//! The scripts of one run: made when there are any, called by the lock-step.

use sincro_dynamics::world::World;

use super::{Call, Host, Phase};
use crate::api::{ApiError, Handle, ObjectRegistry, Value};
use sincro_scene::scene::Scene;
use sincro_scene::script::{Kind, Script, ScriptError};
use sincro_sim::controller::{Message, ScriptFailure};

/// Messages that are kept of a run: a script that says something at every tick must not fill the memory.
const MAX_MESSAGES: usize = 10_000;

/// Level of scripts' messages in the log of a session.
const OF_SCRIPTS: i64 = 450;

/// Scripts with what they have said.
#[derive(Debug)]
pub(crate) struct Scripts {
    pub(crate) host: Box<dyn Host>,
    messages: Vec<Message>,
    n_dropped: usize,
    is_started: bool,
    /// True if customization scripts live through all runs of a session.
    is_open: bool,
}

impl Scripts {
    /// Scripts that a host calls.
    pub(crate) fn new(host: Box<dyn Host>) -> Self {
        Self { host, messages: Vec::new(), n_dropped: 0, is_started: false, is_open: false }
    }

    /// Calls the functions of all scripts for a phase of the step at tick `tick`, at time `t` `[s]`.
    ///
    /// # Errors
    ///
    /// The first one that fails.
    pub(crate) fn call(
        &mut self,
        phase: Phase,
        world: &mut World,
        registry: &mut Option<Box<ObjectRegistry>>,
        (tick, t): (u64, f64),
    ) -> Result<(), ScriptError> {
        self.is_started |= phase == Phase::Initialization;
        let done = self.host.call(Call { world, registry, tick, t }, phase);
        match phase {
            // a script that fails at its start is started again
            Phase::Open => self.is_open = done.is_ok(),
            Phase::Close => self.is_open = false,
            _ => {}
        }
        self.keep_messages(registry);
        done
    }

    /// Calls a function, by its name, of the script on an object (`kind`: of that kind only, none: of any); `t` is the
    /// time at `tick` `[s]`. Returns the results of the function in their order.
    ///
    /// # Errors
    ///
    /// The simulation has not begun, there is no script or no such function, or it failed.
    pub(crate) fn call_function(
        &mut self,
        (object, kind): (Handle, Option<Kind>),
        (function, arguments): (&str, &[Value]),
        world: &mut World,
        registry: &mut Option<Box<ObjectRegistry>>,
        (tick, t): (u64, f64),
    ) -> Result<Vec<Value>, ApiError> {
        self.check_alive((object, kind), registry)?;
        let done = self.host.call_function(Call { world, registry, tick, t }, (object, kind), function, arguments);
        self.keep_messages(registry);
        done
    }

    /// Returns the scripts that have failed in calls after which the run went on.
    pub(crate) fn failures(&self) -> Vec<ScriptFailure> {
        self.host.failures()
    }

    /// Runs a text in the script on an object, at tick `tick` and time `t` `[s]`.
    ///
    /// # Errors
    ///
    /// There is no script, or the text failed.
    pub(crate) fn evaluate(
        &mut self,
        script: (Handle, Option<Kind>),
        text: &str,
        world: &mut World,
        registry: &mut Option<Box<ObjectRegistry>>,
        (tick, t): (u64, f64),
    ) -> Result<Vec<Value>, ApiError> {
        self.check_alive(script, registry)?;
        let done = self.host.evaluate(Call { world, registry, tick, t }, script, text);
        self.keep_messages(registry);
        done
    }

    /// Refuses calls of a script that does not live yet: while stopped, customization scripts of a session do.
    fn check_alive(
        &self,
        (object, kind): (Handle, Option<Kind>),
        registry: &Option<Box<ObjectRegistry>>,
    ) -> Result<(), ApiError> {
        let is_customization = |script: &Script| {
            script.object as i32 + 1 == object.0
                && script.kind == Kind::Customization
                && kind.is_none_or(|k| k == script.kind)
        };
        let lives = self.is_open
            && registry.as_ref().is_some_and(|registry| registry.scene().scripts.iter().any(is_customization));
        if self.is_started || lives {
            return Ok(());
        }
        Err(ApiError::new("scripts can be called once the simulation is started; customization scripts before, too"))
    }

    fn keep_messages(&mut self, registry: &mut Option<Box<ObjectRegistry>>) {
        for message in self.host.take_messages() {
            if let Some(registry) = registry {
                registry.log(OF_SCRIPTS, message.text.clone());
            }
            if self.messages.len() < MAX_MESSAGES {
                self.messages.push(message);
            } else {
                self.n_dropped += 1;
            }
        }
    }

    /// Prepares for the next run of a session: what was said in the last one is forgotten.
    pub(crate) fn between_runs(mut self) -> Self {
        (self.messages, self.n_dropped, self.is_started) = (Vec::new(), 0, false);
        self
    }

    /// Returns true if they live through all runs of a session.
    #[must_use]
    pub(crate) fn is_open(&self) -> bool {
        self.is_open
    }

    /// Returns true if their initialisation has been called.
    #[must_use]
    pub(crate) fn is_started(&self) -> bool {
        self.is_started
    }

    /// Messages of the scripts, and the number of those beyond the limit, which were dropped.
    #[must_use]
    pub(crate) fn messages(&self) -> (&[Message], usize) {
        (&self.messages, self.n_dropped)
    }
}

/// Scripts of a scene in the order in which a [`Host`] calls them: descendants before their ancestors, siblings in the
/// order of the file; at one object a child script before a customization script.
#[must_use]
pub fn in_order(scene: &Scene) -> Vec<&Script> {
    let mut scripts: Vec<&Script> = scene.scripts.iter().collect();
    let rank = ranks(scene);
    let rank_of = |id: usize| scene.objects.iter().position(|object| object.id == id).map(|k| rank[k]);
    scripts.sort_by_cached_key(|script| (rank_of(script.object), script.kind));
    scripts
}

/// Place of each object in an order of leaves before roots; objects stand in the scene with parents before children.
fn ranks(scene: &Scene) -> Vec<usize> {
    let n = scene.objects.len();
    // the objects are in preorder: those of a branch follow each other
    let mut size = vec![1_usize; n];
    for k in (0..n).rev() {
        if let Some(parent) = scene.objects[k].parent {
            size[parent] += size[k];
        }
    }
    let mut rank = vec![0; n];
    // first free place of the branch below an object, roots behind each other
    let (mut next_root, mut next_child) = (0, vec![0; n]);
    for k in 0..n {
        let next = match scene.objects[k].parent {
            None => &mut next_root,
            Some(parent) => &mut next_child[parent],
        };
        let start = *next;
        *next += size[k];
        next_child[k] = start;
        rank[k] = start + size[k] - 1;
    }
    rank
}
