//! Sinks: blocks without outputs.

mod scope;
mod terminator;

pub use scope::Scope;
pub use terminator::Terminator;

use super::{Item, item};

pub(super) static BLOCKS: &[Item] = &[item::<Scope>(), item::<Terminator>()];
