//! Discrete: memory that changes at ticks.

mod unit_delay;

pub use unit_delay::UnitDelay;

use super::{Item, item};

pub(super) const SHELF: &[Item] = &[item::<UnitDelay>()];
