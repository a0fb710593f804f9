//! Access control of every server of sincro, in one place so that it can be reviewed in one sitting.
//!
//! | module | decides |
//! |---|---|
//! | [`guard`] | which HTTP request or WebSocket handshake may enter: `Host`, `Origin`, token |
//! | [`printable`] | what of a text of a client may go to a terminal |
//! | [`connections`] | which connection may be kept: total, per address, unused and idle ones first to go |
//!
//! Threat model, limits and what is not defended: `docs/security.md`. It is a crate because two adapters that do not
//! know each other (`sincro-remote`, `sincro-viewer`) must apply the same rules.

pub mod connections;
pub mod guard;
mod terminal;

pub use connections::{ConnectionLimits, Connections, Permit};
pub use guard::{Guard, Refused, Request};
pub use terminal::printable;
