//! Continuous: states that are integrated together with the world.

mod integrator;

pub use integrator::Integrator;

use super::{Item, item};

pub(super) const SHELF: &[Item] = &[item::<Integrator>()];
