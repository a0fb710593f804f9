//! Limits on what one call of a script may take.
//!
//! Instructions are counted by a hook every [`EVERY`] of them: the same count on every machine, whatever its clock says. Once the
//! limit is reached the call is doomed: the hook then fires at each instruction, and `pcall`, `xpcall` and `coroutine.resume` of the
//! sandbox fail when they are entered or left, so that no script can catch it and go on.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};

use mlua::{HookTriggers, Lua, Thread, VmState};

use crate::sandbox::CHUNK;

/// Instructions between two looks at the count.
pub(crate) const EVERY: u32 = 1000;

/// Instructions after which a thread that does not wait is made to wait for the next step.
const SLICE: u64 = 1_000_000;

/// Name under which the registry holds the thread that a script is.
pub(crate) const THREAD: &str = "script thread";

/// Counts of the present call.
#[derive(Debug, Default)]
pub(crate) struct Guard {
    budget: AtomicU64,
    left: AtomicU64,
    slice: AtomicU64,
    is_doomed: AtomicBool,
    is_in_thread: AtomicBool,
    switches_by_itself: AtomicBool,
    /// Line of the script that was running when the limit was reached; 0 if none is known.
    line: AtomicUsize,
}

/// The innermost line of the script that is running.
fn line_of(lua: &Lua) -> usize {
    let at = |level| lua.inspect_stack(level, |d| (d.source().short_src.is_some_and(|s| s == CHUNK), d.current_line()));
    let lines = (0..100).map_while(at);
    lines.filter_map(|(is_script, line)| line.filter(|_| is_script)).next().unwrap_or(0)
}

impl Guard {
    /// With a number of instructions for each call.
    pub fn new(budget: u64) -> Arc<Self> {
        let new = Self::default();
        new.budget.store(budget, Ordering::Relaxed);
        new.switches_by_itself.store(true, Ordering::Relaxed);
        Arc::new(new)
    }

    /// Before a call; `is_thread` if a thread is resumed.
    pub fn begin(&self, is_thread: bool) {
        self.left.store(self.budget.load(Ordering::Relaxed), Ordering::Relaxed);
        self.slice.store(SLICE, Ordering::Relaxed);
        self.is_in_thread.store(is_thread, Ordering::Relaxed);
    }

    /// Whether the limit was reached.
    pub fn is_doomed(&self) -> bool {
        self.is_doomed.load(Ordering::Relaxed)
    }

    /// Whether threads that do not wait are made to.
    pub fn set_switching(&self, by_itself: bool) -> bool {
        self.switches_by_itself.swap(by_itself, Ordering::Relaxed)
    }

    /// Line of the script that was running when the limit was reached.
    pub fn line(&self) -> Option<usize> {
        Some(self.line.load(Ordering::Relaxed)).filter(|line| *line > 0)
    }

    /// What is said when the limit is reached.
    pub fn words(&self) -> String {
        let budget = self.budget.load(Ordering::Relaxed);
        format!("one call took more than {budget} instructions")
    }

    /// Fails once the limit was reached.
    pub fn check(&self) -> mlua::Result<()> {
        if self.is_doomed() { Err(mlua::Error::RuntimeError(self.words())) } else { Ok(()) }
    }

    /// Counts down; what is to be done now.
    fn count(self: &Arc<Self>, lua: &Lua) -> mlua::Result<VmState> {
        let every = u64::from(EVERY);
        let left = self.left.load(Ordering::Relaxed);
        if left < every && !self.is_doomed.swap(true, Ordering::Relaxed) {
            self.line.store(line_of(lua), Ordering::Relaxed);
            self.watch(lua, 1)?;
        }
        self.check()?;
        self.left.store(left - every, Ordering::Relaxed);
        let slice = self.slice.load(Ordering::Relaxed);
        if slice >= every {
            self.slice.store(slice - every, Ordering::Relaxed);
        } else if self.is_in_thread.load(Ordering::Relaxed)
            && self.switches_by_itself.load(Ordering::Relaxed)
            && lua.named_registry_value::<Thread>(THREAD).is_ok_and(|thread| thread == lua.current_thread())
        {
            self.slice.store(SLICE, Ordering::Relaxed);
            return Ok(VmState::Yield);
        }
        Ok(VmState::Continue)
    }

    fn watch(self: &Arc<Self>, lua: &Lua, every: u32) -> mlua::Result<()> {
        let guard = self.clone();
        lua.set_global_hook(HookTriggers::new().every_nth_instruction(every), move |lua, _| guard.count(lua))
    }

    /// After a call from outside that reached the limit: it has failed, the script itself goes on.
    pub fn forgive(self: &Arc<Self>, lua: &Lua) {
        if self.is_doomed.swap(false, Ordering::Relaxed) {
            self.line.store(0, Ordering::Relaxed);
            // without a count nothing would hold the script: then it stays doomed
            if self.watch(lua, EVERY).is_err() {
                self.is_doomed.store(true, Ordering::Relaxed);
            }
        }
    }

    /// Begins to count in a Lua state.
    pub fn install(self: &Arc<Self>, lua: &Lua) -> mlua::Result<()> {
        self.watch(lua, EVERY)
    }
}
