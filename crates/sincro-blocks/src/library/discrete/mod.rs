//! Discrete: memory that changes at ticks.

mod discrete_pid;
mod discrete_state_space;
mod discrete_transfer_function;
mod method;
mod unit_delay;

pub use discrete_pid::DiscretePid;
pub use discrete_state_space::DiscreteStateSpace;
pub use discrete_transfer_function::DiscreteTransferFunction;
pub use method::Method;
pub use unit_delay::UnitDelay;

use super::{Item, item};
use method::METHOD;

pub(super) const SHELF: &[Item] =
    &[item::<UnitDelay>(), item::<DiscreteTransferFunction>(), item::<DiscreteStateSpace>(), item::<DiscretePid>()];
