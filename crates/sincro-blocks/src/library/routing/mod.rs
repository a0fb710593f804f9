//! Routing: which signal goes where.

mod mux;

pub use mux::Mux;

use super::{Item, item};

pub(super) const SHELF: &[Item] = &[item::<Mux>()];
