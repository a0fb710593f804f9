//! Limits on one call of a script: instructions, wall-clock time, and the end of the program.
//!
//! Instructions are counted by a hook every [`EVERY`] of them: the same count on every machine, whatever its clock
//! says. Library functions that do work of their own add it to the count ([`Guard::charge`]). The wall clock is a
//! second line of defence, against work that neither sees (`..` of large strings, garbage collection): it is read by
//! the hook and by charges.
//!
//! A coroutine that does not give control back is made to after [`SLICE`] instructions, which it has for itself at each
//! resume: the script's thread, and coroutines that the script has made, wherever they are resumed. In CoppeliaSim a
//! time on the wall decides; an iterator that computes its next value within the slice is never interrupted.
//!
//! Once a limit is reached the call is stopped: the hook then fires at each instruction, and `pcall`, `xpcall` and
//! `coroutine.resume` of the sandbox fail when they are entered or left, so that no script can catch it and continue.

use std::sync::atomic::{AtomicBool, AtomicU8, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};
use std::time::{Duration, Instant};

use mlua::{HookTriggers, Lua, VmState};

use crate::sandbox::CHUNK;
use crate::{fault, library};

/// Instructions between two looks at the count.
pub(crate) const EVERY: u32 = 1000;

/// Instructions of a coroutine since it was resumed after which it is made to yield: a thread waits for the next step.
const SLICE: u64 = 1_000_000;

/// Instructions of a coroutine's slice that a function of the simulation takes: about its time.
const CALL_COST: u64 = 100;

/// Instructions of a coroutine's slice that a change of the structure takes, for which the scene is compiled again.
const RESTRUCTURE_COST: u64 = 50_000;

/// Wall-clock limit of one call `[s]`, for up to [`BUDGET_WITHIN_TIME_LIMIT`] instructions; more instructions have more
/// time in proportion. A hundred million take about a second: the limit is reached by work that is not counted only.
const TIME_LIMIT: f64 = 30.0;

/// Instruction limit up to which [`TIME_LIMIT`] holds.
const BUDGET_WITHIN_TIME_LIMIT: u64 = 100_000_000;

/// Set once, when the program ends.
static IS_ABORTED: AtomicBool = AtomicBool::new(false);

/// Ends every script that is running in this process, and every one that runs later, at its next check: within a
/// thousand instructions. Their runs stop with an error that says so.
///
/// For a program that is asked to end (Ctrl-C) while a script computes. It may be called from a signal handler's
/// thread, and cannot be undone.
pub fn abort_running_scripts() {
    IS_ABORTED.store(true, Ordering::Relaxed);
}

/// Reason why a call is stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
enum StopReason {
    None,
    Instructions,
    Time,
    Abort,
}

impl StopReason {
    fn of(number: u8) -> Self {
        [Self::None, Self::Instructions, Self::Time, Self::Abort][usize::from(number)]
    }
}

/// Counts of the present call.
#[derive(Debug)]
pub(crate) struct Guard {
    budget: u64,
    left: AtomicU64,
    /// Instructions that are left to the coroutine that is running until it is made to yield.
    slice: AtomicU64,
    time_limit: Duration,
    /// End of the present call's time, on the clock of [`now`]; 0 until the call's first check, so that short calls
    /// read no clock.
    deadline: AtomicU64,
    stop_reason: AtomicU8,
    /// Message of the last refusal of a number that is not finite in the present call.
    not_finite: Mutex<Option<String>>,
    /// True once a call was stopped and the script continued: see [`Guard::was_stopped`].
    was_stopped: AtomicBool,
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
    /// With a number of instructions for each call, and the wall-clock limit that belongs to it.
    pub fn new(budget: u64) -> Arc<Self> {
        let share = (budget as f64 / BUDGET_WITHIN_TIME_LIMIT as f64).max(1.0);
        // a limit beyond what the clock can tell is none
        let time_limit = Duration::try_from_secs_f64(TIME_LIMIT * share).unwrap_or(Duration::MAX);
        Self::with_time_limit(budget, time_limit)
    }

    /// With a number of instructions and a wall-clock limit for each call.
    pub fn with_time_limit(budget: u64, time_limit: Duration) -> Arc<Self> {
        Arc::new(Self {
            budget,
            left: AtomicU64::new(0),
            slice: AtomicU64::new(0),
            time_limit,
            deadline: AtomicU64::new(0),
            stop_reason: AtomicU8::new(StopReason::None as u8),
            not_finite: Mutex::default(),
            was_stopped: AtomicBool::new(false),
            switches_by_itself: AtomicBool::new(true),
            line: AtomicUsize::new(0),
        })
    }

    /// Wall-clock limit of a call.
    #[cfg(test)]
    pub fn time_limit(&self) -> Duration {
        self.time_limit
    }

    /// The guard of a Lua state.
    pub fn of(lua: &Lua) -> Option<Arc<Self>> {
        lua.app_data_ref::<Arc<Self>>().map(|guard| guard.clone())
    }

    /// Before a call.
    pub fn begin(&self) {
        self.left.store(self.budget, Ordering::Relaxed);
        self.slice.store(SLICE, Ordering::Relaxed);
        self.deadline.store(0, Ordering::Relaxed);
        *self.not_finite() = None;
    }

    /// A number that is not finite has been refused with an error.
    pub fn note_not_finite(&self, error: &mlua::Error) {
        *self.not_finite() = Some(fault::words(error).0);
    }

    fn not_finite(&self) -> MutexGuard<'_, Option<String>> {
        self.not_finite.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn stop_reason(&self) -> StopReason {
        StopReason::of(self.stop_reason.load(Ordering::Relaxed))
    }

    /// Returns true if a limit was reached.
    pub fn is_stopped(&self) -> bool {
        self.stop_reason() != StopReason::None
    }

    /// Returns true if an error is the refusal of a number that is not finite, perhaps caught and raised again; one
    /// that the script has dealt with does not count.
    pub fn is_not_finite(&self, error: &mlua::Error) -> bool {
        self.not_finite().as_ref().is_some_and(|refusal| fault::words(error).0.contains(refusal))
    }

    /// Returns true if any call of this Lua state was ever stopped. A coroutine that ended by an error of the hook has
    /// its hooks off for good: what it has yet to close must not run.
    pub fn was_stopped(&self) -> bool {
        self.is_stopped() || self.was_stopped.load(Ordering::Relaxed)
    }

    /// Takes the time of a function of the simulation from the slice of the coroutine that called it.
    pub fn spend(self: &Arc<Self>, lua: &Lua, has_restructured: bool) -> mlua::Result<()> {
        let slice = self.slice.load(Ordering::Relaxed);
        let left = slice.saturating_sub(if has_restructured { RESTRUCTURE_COST } else { CALL_COST });
        self.slice.store(left, Ordering::Relaxed);
        // at once, not in a thousand instructions: these may be a hundred calls
        if slice >= u64::from(EVERY) && left < u64::from(EVERY) && !self.is_stopped() {
            self.watch(lua, 1)
        } else {
            Ok(())
        }
    }

    /// Gives a coroutine a slice of its own, before it is resumed; returns what is left to the one that resumes it, for
    /// [`Guard::leave_coroutine`].
    pub fn enter_coroutine(&self) -> u64 {
        self.slice.swap(SLICE, Ordering::Relaxed)
    }

    /// Goes on with the slice of the one that has resumed a coroutine, less what that coroutine took.
    pub fn leave_coroutine(&self, outer: u64) {
        let taken = SLICE.saturating_sub(self.slice.load(Ordering::Relaxed));
        self.slice.store(outer.saturating_sub(taken), Ordering::Relaxed);
    }

    /// Sets whether coroutines that do not yield are made to, and returns what was set before.
    pub fn set_switching(&self, by_itself: bool) -> bool {
        self.switches_by_itself.swap(by_itself, Ordering::Relaxed)
    }

    /// Line of the script that was running when the limit was reached.
    pub fn line(&self) -> Option<usize> {
        Some(self.line.load(Ordering::Relaxed)).filter(|line| *line > 0)
    }

    /// Message of the limit that was reached.
    pub fn words(&self) -> String {
        match self.stop_reason() {
            StopReason::None | StopReason::Instructions => {
                format!("one call took more than {} instructions", self.budget)
            }
            StopReason::Time => format!("one call took more than {} s", self.time_limit.as_secs_f64()),
            StopReason::Abort => "the program is being ended".to_owned(),
        }
    }

    /// Help for the limit that was reached.
    pub fn help(&self) -> Option<String> {
        let help = match self.stop_reason() {
            StopReason::None | StopReason::Instructions => {
                "look for a loop without end; a thread waits with sim.switchThread(), and `max_instructions` of the script raises the limit"
            }
            StopReason::Time => {
                "look for a loop that makes large strings or tables again and again, or collects garbage"
            }
            StopReason::Abort => return None,
        };
        Some(help.to_owned())
    }

    /// Fails once a limit was reached.
    pub fn check(&self) -> mlua::Result<()> {
        if self.is_stopped() { Err(mlua::Error::RuntimeError(self.words())) } else { Ok(()) }
    }

    /// Adds the work of a library function to the count, before or while it is done; fails, and stops the call, if that
    /// is more than is left.
    pub fn charge(self: &Arc<Self>, lua: &Lua, instructions: u64) -> mlua::Result<()> {
        let left = self.left.load(Ordering::Relaxed);
        if left < instructions {
            self.stop(lua, StopReason::Instructions)?;
        }
        self.check()?;
        self.left.store(left - instructions, Ordering::Relaxed);
        self.check_clock(lua)
    }

    /// Stops the call if the program is being ended or the call's time is over; the first check of a call starts its
    /// time.
    pub fn check_clock(self: &Arc<Self>, lua: &Lua) -> mlua::Result<()> {
        if IS_ABORTED.load(Ordering::Relaxed) {
            self.stop(lua, StopReason::Abort)?;
        } else if self.is_late() {
            self.stop(lua, StopReason::Time)?;
        }
        self.check()
    }

    fn is_late(&self) -> bool {
        let (now, deadline) = (now(), self.deadline.load(Ordering::Relaxed));
        if deadline > 0 {
            return now >= deadline;
        }
        self.deadline.store(now.saturating_add(nanoseconds(self.time_limit)).max(1), Ordering::Relaxed);
        self.time_limit.is_zero()
    }

    /// Runs a function of another guard's script, as part of the present call: within what is left of this call's time.
    pub fn lend_time<T>(&self, other: &Self, run: impl FnOnce() -> T) -> T {
        // starts the time if nothing has yet
        self.is_late();
        let own = other.deadline.swap(self.deadline.load(Ordering::Relaxed), Ordering::Relaxed);
        let result = run();
        other.deadline.store(own, Ordering::Relaxed);
        result
    }

    fn stop(self: &Arc<Self>, lua: &Lua, why: StopReason) -> mlua::Result<()> {
        let first =
            self.stop_reason.compare_exchange(StopReason::None as u8, why as u8, Ordering::Relaxed, Ordering::Relaxed);
        if first.is_ok() {
            self.line.store(line_of(lua), Ordering::Relaxed);
            self.watch(lua, 1)?;
        }
        Ok(())
    }

    /// Counts down; returns the thread's next state.
    fn count(self: &Arc<Self>, lua: &Lua) -> mlua::Result<VmState> {
        let every = u64::from(EVERY);
        // once stopped the hook fires at every instruction: nothing to count
        if let Err(error) = self.check().and_then(|()| self.charge(lua, every)) {
            // what the error closes would run with hooks off
            library::disarm(lua)?;
            return Err(error);
        }
        let slice = self.slice.load(Ordering::Relaxed);
        self.slice.store(slice.saturating_sub(every), Ordering::Relaxed);
        if slice < every {
            // the hook may be here early: see `spend`
            self.watch(lua, EVERY)?;
        }
        // asked for again until it is possible: not within a callback of a library function, never outside coroutines
        if slice < every && self.switches_by_itself.load(Ordering::Relaxed) {
            return Ok(VmState::Yield);
        }
        Ok(VmState::Continue)
    }

    fn watch(self: &Arc<Self>, lua: &Lua, every: u32) -> mlua::Result<()> {
        let guard = self.clone();
        lua.set_global_hook(HookTriggers::new().every_nth_instruction(every), move |lua, _| guard.count(lua))
    }

    /// After a call from outside that reached the limit: it has failed, the script itself continues.
    pub fn resume_script(self: &Arc<Self>, lua: &Lua) {
        let stop_reason = self.stop_reason.swap(StopReason::None as u8, Ordering::Relaxed);
        if stop_reason != StopReason::None as u8 {
            self.was_stopped.store(true, Ordering::Relaxed);
            self.line.store(0, Ordering::Relaxed);
            // without a count nothing would hold the script: then it stays stopped
            if self.watch(lua, EVERY).and_then(|()| library::rearm(lua)).is_err() {
                self.stop_reason.store(stop_reason, Ordering::Relaxed);
            }
        }
    }

    /// Begins to count in a Lua state, and makes the guard known to it.
    pub fn install(self: &Arc<Self>, lua: &Lua) -> mlua::Result<()> {
        lua.set_app_data(self.clone());
        self.watch(lua, EVERY)
    }
}

/// Nanoseconds since the first call of this function.
fn now() -> u64 {
    static ZERO: OnceLock<Instant> = OnceLock::new();
    nanoseconds(ZERO.get_or_init(Instant::now).elapsed())
}

fn nanoseconds(duration: Duration) -> u64 {
    u64::try_from(duration.as_nanos()).unwrap_or(u64::MAX)
}
