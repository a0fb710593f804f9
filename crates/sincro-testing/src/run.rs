//! Runs to the end, and the script runner.

use std::sync::atomic::AtomicBool;

use sincro_sim::run::{RunMonitor, RunOptions, Simulated, simulate};
use sincro_sim::{Extensions, Loaded};

/// Extensions with Lua as the language of scripts.
#[must_use]
pub fn with_scripts() -> Extensions {
    Extensions { scripts: Some(sincro_lua::engine()), ..Extensions::default() }
}

/// Runs a loaded scene to its end.
#[must_use]
pub fn run(loaded: &Loaded) -> Simulated {
    let interrupt = AtomicBool::new(false);
    let mut monitor = RunMonitor { interrupt: &interrupt, progress: &mut |_| {} };
    simulate(loaded, RunOptions::default(), &mut monitor).unwrap()
}

/// Last value of a recorded signal, in the unit of its column.
#[must_use]
pub fn last(run: &Simulated, name: &str) -> f64 {
    *run.table.column(name).unwrap_or_else(|| panic!("no column {name}")).values.last().unwrap()
}
