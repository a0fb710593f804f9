//! Messages to the importer, through the function that it gave.

use std::ffi::{CString, c_char, c_void};

/// Status of a call, as both versions number it (3.0 has no `Pending`).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(C)]
#[allow(dead_code)]
pub(crate) enum Status {
    Ok,
    Warning,
    Discard,
    Error,
    Fatal,
    Pending,
}

/// Logger of FMI 2.0: a function in the manner of `printf`.
pub(crate) type Logger2 = unsafe extern "C" fn(*mut c_void, *const c_char, Status, *const c_char, *const c_char, ...);
/// Logger of FMI 3.0.
pub(crate) type Logger3 = unsafe extern "C" fn(*mut c_void, Status, *const c_char, *const c_char);

/// Function that takes messages.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Function {
    None,
    V2(Logger2),
    V3(Logger3),
}

/// Logger of an instance.
#[derive(Clone, Debug)]
pub(crate) struct Logger {
    pub function: Function,
    /// Given back to the importer with every message.
    pub environment: *mut c_void,
    pub instance: CString,
    /// True if the importer asked for more than errors and warnings.
    pub is_on: bool,
    /// Categories that it asked for; empty for all.
    pub categories: Vec<String>,
}

// SAFETY: `environment` is never dereferenced here; the importer calls from whichever thread it likes, and gets its own
// pointer back there
unsafe impl Send for Logger {}

/// A message under way.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Message {
    pub status: Status,
    pub category: &'static str,
    pub text: String,
}

impl Message {
    pub(crate) fn error(text: impl Into<String>) -> Self {
        Self { status: Status::Error, category: "logStatusError", text: text.into() }
    }
}

impl Logger {
    /// Sends a message, if the importer wants it.
    pub(crate) fn send(&self, message: &Message) {
        let Message { status, category, text } = message;
        let is_asked_for = self.is_on && (self.categories.is_empty() || self.categories.iter().any(|c| c == category));
        if *status < Status::Warning && !is_asked_for {
            return;
        }
        let of_c = |text: &str| CString::new(text.replace('\0', " ")).unwrap_or_default();
        let category = of_c(category);
        match self.function {
            Function::None => {}
            Function::V2(logger) => {
                // the text is a format: signs of per cent are doubled
                let text = of_c(&text.replace('%', "%%"));
                let (instance, category, text) = (self.instance.as_ptr(), category.as_ptr(), text.as_ptr());
                // SAFETY: the importer promised such a function; the texts live until it returns
                unsafe { logger(self.environment, instance, *status, category, text) }
            }
            Function::V3(logger) => {
                let text = of_c(text);
                // SAFETY: as above
                unsafe { logger(self.environment, *status, category.as_ptr(), text.as_ptr()) }
            }
        }
    }
}
