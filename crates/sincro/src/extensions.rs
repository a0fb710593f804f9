//! The parts of the program that a scene may need, put together once.

use sincro_sim::Extensions;

/// Lua for scripts, linearisation for warnings of loops that are too fast for their step.
#[must_use]
pub fn extensions() -> Extensions {
    Extensions { scripts: Some(sincro_lua::engine()), fastest_poles: Some(sincro_analysis::linearize::fastest_poles) }
}
