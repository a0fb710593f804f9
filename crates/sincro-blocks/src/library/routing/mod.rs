//! Routing: which signal goes where.

mod demux;
mod merge;
mod multiport_switch;
mod mux;
mod selector;
mod switch;

pub use demux::Demux;
pub use merge::Merge;
pub use multiport_switch::MultiportSwitch;
pub use mux::Mux;
pub use selector::Selector;
pub use switch::Switch;

use super::{Item, item};

pub(super) static BLOCKS: &[Item] =
    &[item::<Mux>(), item::<Demux>(), item::<Selector>(), item::<Switch>(), item::<MultiportSwitch>(), item::<Merge>()];
