//! Threads: a waiting script is resumed at the next step.

use std::sync::Arc;
use std::sync::atomic::{AtomicI64, Ordering};

use mlua::{MultiValue, Value};

use super::ApiContext;
use crate::sandbox::Waits;

pub(super) fn offer(context: &ApiContext<'_>, waits: &Waits) -> mlua::Result<()> {
    for name in ["switchThread", "step", "yield", "handleExtCalls"] {
        context.put(name, waits.switch.clone())?;
    }
    context.put("wait", waits.wait.clone())?;
    context.put("waitForSignal", waits.wait_for_signal.clone())?;
    let guard = context.guard.clone();
    context.add("setThreadAutomaticSwitch", move |_, by_itself: Value| {
        let before = guard.set_switching(!matches!(by_itself, Value::Nil | Value::Boolean(false) | Value::Integer(0)));
        Ok(i64::from(before))
    })?;
    // stepping and automatic switching are the same switch, seen from its two sides
    let (guard, level) = (context.guard.clone(), Arc::new(AtomicI64::new(0)));
    context.add("setStepping", move |_, wanted: Value| {
        let before = level.load(Ordering::Relaxed);
        let after = match wanted {
            Value::Integer(n) => n.max(0),
            Value::Boolean(true) => before + 1,
            _ => (before - 1).max(0),
        };
        level.store(after, Ordering::Relaxed);
        guard.set_switching(after == 0);
        Ok(before)
    })?;
    for name in [
        "setThreadSwitchTiming",
        "setAutoYieldDelay",
        "setThreadResumeLocation",
        "setThreadIsFree",
        "acquireLock",
        "releaseLock",
    ] {
        context.add(name, |_, _: MultiValue| Ok(0))?;
    }
    context.add("getThreadId", |_, ()| Ok(0))
}
