//! The operating point: where a run is at some time.

use sincro_scene::diagnostic::{Diagnostic, Located};
use sincro_sim::load::Loaded;
use sincro_sim::run::{LockStep, method_for};

/// Request for a linearisation.
#[derive(Clone, Debug, Default)]
pub struct Request {
    /// Inputs; empty: all commands of motors that are not ideal.
    pub inputs: Vec<Located<String>>,
    /// Outputs; empty: all coordinates.
    pub outputs: Vec<Located<String>>,
    /// With the diagram in the loop.
    pub is_closed: bool,
}

/// Runs a scene to the tick nearest to `t` `[s]` and latches the commands that hold from there on.
///
/// # Errors
///
/// If the run stops before, or `t` is negative or not finite.
pub fn operating_point(loaded: &Loaded, t: f64) -> Result<LockStep, Diagnostic> {
    let n = (t / loaded.experiment.step).round();
    if !(0.0..1e12).contains(&n) {
        let diagnostic = Diagnostic::nowhere(format!("there is no operating point at {t} s"));
        return Err(diagnostic.with_help("give a time from 0 on"));
    }
    let (method, _) = method_for(loaded);
    let mut run = LockStep::new(loaded, method, false);
    let mut go = run.start();
    for _ in 0..n as u64 {
        if go.is_err() {
            break;
        }
        go = run.advance();
    }
    if go.is_err() {
        let diagnostic = Diagnostic::nowhere(format!("the run stops before {t} s, at {} s", run.t()));
        return Err(diagnostic.with_help("`sincro run` says why"));
    }
    run.latch();
    Ok(run)
}
