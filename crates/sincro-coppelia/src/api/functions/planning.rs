//! Functions: `simOMPL`, path planning.

use super::Function;

macro_rules! table {
    ($($name:literal $tip:literal)*) => {
        &[$(Function { name: $name, tip: $tip, run: |sim, a| sincro_planning::call(sim, $name, a) }),*]
    };
}

/// Functions of `simOMPL`, named without it.
pub(super) const FUNCTIONS: &[Function] = sincro_planning::for_functions!(table);
