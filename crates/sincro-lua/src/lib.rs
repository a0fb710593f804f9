//! A door: scripts in Lua are controllers.
//!
//! Child scripts of V-REP and CoppeliaSim run inside the step, in both styles, shut off from everything but the simulation, with limits
//! on memory and instructions. [`install`] gives a program the language; everything else is in the scene (`[[script]]`, docs/lua.md).
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

/// Gives this program Lua as the language of its scripts.
///
/// ```
/// sincro_lua::install();
/// assert!(sincro_sim::script::engine().is_some());
/// ```
pub fn install() {
    sincro_sim::script::install(&host::Lua54);
}
