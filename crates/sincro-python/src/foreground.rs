//! Long work beside the interpreter: the GIL is released, Ctrl-C is heard, a panic becomes an exception.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use pyo3::prelude::*;

use crate::errors;

/// Time between two looks at Ctrl-C: short for a person, long for a processor.
const LOOK_EVERY: Duration = Duration::from_millis(50);

/// Stack of the thread that works [bytes]: as much as a program's first thread has.
const STACK: usize = 8 << 20;

fn words(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|s| (*s).to_owned());
    let text = text.or_else(|| panic.downcast_ref::<String>().cloned());
    text.unwrap_or_else(|| "no reason given".into())
}

fn internal(py: Python<'_>, panic: &(dyn Any + Send)) -> PyErr {
    errors::new(py, "InternalError", &format!("an error of sincro itself: {}", words(panic)))
}

/// Short work with the GIL released; a panic in it is an `InternalError`.
pub fn contained<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    py.detach(|| catch_unwind(AssertUnwindSafe(work))).map_err(|panic| internal(py, &*panic))
}

/// Long work in a thread of its own, while this one listens for Ctrl-C. `interrupt` is given to the work, which ends
/// early once it is set; the exception of the signal's handler (`KeyboardInterrupt`) is then the result.
pub fn run<T: Send>(py: Python<'_>, work: impl FnOnce(&AtomicBool) -> T + Send) -> PyResult<T> {
    let interrupt = AtomicBool::new(false);
    let (result, heard) = py.detach(|| {
        std::thread::scope(|scope| {
            let (done, is_done) = channel::<()>();
            let interrupt = &interrupt;
            let worker =
                std::thread::Builder::new().name("sincro".into()).stack_size(STACK).spawn_scoped(scope, move || {
                    let result = catch_unwind(AssertUnwindSafe(|| work(interrupt)));
                    drop(done);
                    result
                });
            let worker = match worker {
                Ok(worker) => worker,
                Err(error) => return (Err(Box::new(format!("no thread: {error}")) as Box<dyn Any + Send>), None),
            };
            let mut heard = None;
            while let Err(RecvTimeoutError::Timeout) = is_done.recv_timeout(LOOK_EVERY) {
                if let Err(error) = Python::attach(|py| py.check_signals()) {
                    interrupt.store(true, Ordering::Relaxed);
                    heard = Some(error);
                }
            }
            let result = worker.join().unwrap_or_else(Err);
            (result, heard)
        })
    });
    match (result, heard) {
        (_, Some(error)) => Err(error),
        (Ok(value), None) => Ok(value),
        (Err(panic), None) => Err(internal(py, &*panic)),
    }
}
