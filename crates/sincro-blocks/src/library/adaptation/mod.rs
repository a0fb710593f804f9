//! Adaptation: parameters that are found while the plant runs.

mod ellipsoid_projection;
mod normalized_gradient;

pub use ellipsoid_projection::EllipsoidProjection;
pub use normalized_gradient::NormalizedGradient;

use super::{Item, item};

pub(super) static BLOCKS: &[Item] = &[item::<NormalizedGradient>(), item::<EllipsoidProjection>()];
