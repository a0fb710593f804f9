//! Lua 5.4 scripts as controllers: adapter of the language to the script host of [`sincro_coppelia`].
//!
//! Child scripts of V-REP and CoppeliaSim run inside the step, threaded or not, in a sandbox that reaches only the
//! simulation, with limits on memory, instructions and time. [`engine`] is an argument of [`sincro_sim::load()`]; the
//! scripts are in the scene (`[[script]]`, docs/lua.md).
//!
//! | modules | hold |
//! |---|---|
//! | `sandbox`, `library` | the environment of a script, and the functions of Lua's libraries with limits of their own |
//! | `guard` | the limits of a call |
//! | `api` | the functions of `sim`, `simIK` and `simOMPL` |
//! | `machine`, `host` | the Lua state of one script, and the scripts of a run |

mod api;
mod callback;
mod contact;
mod convert;
mod fault;
mod files;
mod guard;
mod host;
mod law;
mod lexer;
mod library;
mod machine;
mod older_names;
mod power;
mod sandbox;
mod shared;
mod vision;

pub use guard::abort_running_scripts;
use sincro_sim::ScriptEngine;

/// Lua as the language of scripts: an argument of [`sincro_sim::load()`].
///
/// ```
/// use sincro_sim::Extensions;
///
/// let extensions = Extensions { scripts: Some(sincro_lua::engine()), ..Extensions::default() };
/// assert!(extensions.scripts.is_some());
/// ```
#[must_use]
pub fn engine() -> &'static dyn ScriptEngine {
    &host::Lua54
}
