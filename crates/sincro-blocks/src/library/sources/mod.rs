//! Sources: functions of time.

mod constant;

pub use constant::Constant;

use super::{Item, item};

pub(super) const SHELF: &[Item] = &[item::<Constant>()];
