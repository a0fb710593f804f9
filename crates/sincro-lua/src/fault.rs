//! Errors of Lua as faults of a script: the line, its text, what is wrong, how to mend it.

use mlua::Error;
use sincro_scene::diagnostic::Location;
use sincro_scene::script::{Script, ScriptError};

use crate::guard::Guard;
use crate::sandbox::CHUNK;

/// Message of an error, without positions and tracebacks, and the innermost line of the script that it is about.
pub(crate) fn words(error: &Error) -> (String, Option<usize>) {
    match error {
        Error::CallbackError { traceback, cause } => {
            let (message, line) = words(cause);
            (message, line.or_else(|| line_in(traceback)))
        }
        Error::RuntimeError(text) | Error::MemoryError(text) | Error::SyntaxError { message: text, .. } => {
            let (head, trace) = text.split_once("\nstack traceback:").unwrap_or((text, ""));
            match positioned(head) {
                Some((line, message)) => (message.to_owned(), Some(line)),
                None => (without_own(head).to_owned(), line_in(trace)),
            }
        }
        Error::BadArgument { to, pos, cause, .. } => {
            let to = to.as_deref().map_or(String::new(), |to| format!(" to '{to}'"));
            (format!("bad argument #{pos}{to} ({})", words(cause).0), None)
        }
        Error::FromLuaConversionError { from, to, .. } => (format!("expected {}, got {from}", plain(to)), None),
        other => (other.to_string(), None),
    }
}

/// Lua's word for what Rust calls it.
fn plain(to: &str) -> &str {
    match to {
        "f64" | "f32" | "i32" | "i64" | "usize" | "number" => "a number",
        "String" | "string" | "&str" => "text",
        "bool" => "true or false",
        other => other,
    }
}

/// `script:12: message` as 12 and the message.
fn positioned(text: &str) -> Option<(usize, &str)> {
    let (line, message) = text.strip_prefix(CHUNK)?.strip_prefix(':')?.split_once(": ")?;
    Some((line.parse().ok()?, message))
}

/// Without a position in the prelude, which is none of the script's author's.
fn without_own(text: &str) -> &str {
    let own = text.strip_prefix("sincro:").and_then(|rest| rest.split_once(": "));
    own.filter(|(line, _)| line.parse::<usize>().is_ok()).map_or(text, |(_, message)| message)
}

/// The first line of the script in a traceback.
fn line_in(trace: &str) -> Option<usize> {
    let lines = trace.lines().filter_map(|l| l.trim_start().strip_prefix(CHUNK)?.strip_prefix(':')?.split(':').next());
    lines.filter_map(|n| n.parse().ok()).next()
}

/// The fault of a script.
pub(crate) fn of(script: &Script, guard: &Guard, error: &Error) -> ScriptError {
    let (message, line) = words(error);
    let line = if guard.is_stopped() { guard.line().or(line) } else { line };
    let (message, help) = if guard.is_stopped() {
        (guard.words(), guard.help())
    } else if is_of_memory(error) {
        let message = format!("it took more than {} MiB of memory", script.max_memory >> 20);
        (
            message,
            Some(
                "look for a table or text that grows without end; `max_memory_mib` of the script raises the limit"
                    .into(),
            ),
        )
    } else {
        // an address says nothing, and is another one in every run
        let message =
            if message.starts_with("table: 0x") { "an error that is a table, not a text".to_owned() } else { message };
        let help = help(&message);
        (message, help)
    };
    ScriptError { object: script.path.clone(), at: line.and_then(|line| location(script, line)), message, help }
}

pub(crate) fn is_of_memory(error: &Error) -> bool {
    match error {
        Error::MemoryError(_) => true,
        Error::CallbackError { cause, .. } => is_of_memory(cause),
        Error::RuntimeError(text) => text.starts_with("not enough memory"),
        _ => false,
    }
}

/// Help for some messages of Lua.
fn help(message: &str) -> Option<String> {
    let is_call = message.contains("call a nil value");
    let help = if is_call && (message.contains("(global 'sim") || message.contains("(field '")) {
        "there is no function of that name; docs/lua.md lists those of `sim`"
    } else if message.contains("a nil value (global '") {
        "nothing of that name has been set; look for a misspelt name, or a value that only another script has"
    } else {
        return None;
    };
    Some(help.to_owned())
}

/// A line of a script's text, blanks around it left out; lines of the text are counted in its source.
fn location(script: &Script, line: usize) -> Option<Location> {
    let text = &script.source.text;
    let start: usize = text.split_inclusive('\n').take(line.checked_sub(1)?).map(str::len).sum();
    let whole = text.get(start..)?.lines().next().unwrap_or("");
    let from = start + whole.len() - whole.trim_start().len();
    Some(Location { source: script.source.clone(), span: from..from + whole.trim().len() })
}
