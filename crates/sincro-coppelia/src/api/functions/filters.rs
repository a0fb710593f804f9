//! Functions: `simVision`, filters on the pictures of vision sensors.

pub(super) use sincro_conventions::absent::VISION as ABSENT;

use super::Function;

macro_rules! table {
    ($($name:literal $tip:literal)*) => {
        &[$(Function { name: $name, tip: $tip, run: |sim, a| sincro_vision::call(sim, $name, a) }),*]
    };
}

/// Functions of `simVision`, named without it.
pub(super) const FUNCTIONS: &[Function] = sincro_vision::for_filters!(table);
