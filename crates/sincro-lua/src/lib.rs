//! Adapter: scripts in Lua as controllers.
//!
//! Child scripts of V-REP and CoppeliaSim run inside the step, in both styles, shut off from everything but the simulation, with limits
//! on memory and instructions. [`engine`] is given to whoever loads a scene; everything else is in the scene (`[[script]]`, docs/lua.md).
//!
//! `sandbox.rs` is what a script finds, `library/` the functions of Lua's libraries that need limits of their own, `guard.rs` the limits, `api/` the functions of `sim`, `machine.rs` how one script is called, `host.rs` all of them.

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
mod power;
mod sandbox;
mod shared;

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
