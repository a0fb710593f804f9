//! Logic and comparison: true is 1, false is 0.

use super::Item;

pub(super) const SHELF: &[Item] = &[];
