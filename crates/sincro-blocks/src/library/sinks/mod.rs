//! Sinks: what only looks.

use super::Item;

pub(super) const SHELF: &[Item] = &[];
