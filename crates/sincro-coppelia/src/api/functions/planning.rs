//! Functions: `simOMPL`, path planning; collision and distance objects of V-REP 3.

use super::Function;

macro_rules! table {
    ($($name:literal $tip:literal)*) => {
        &[$(Function { name: $name, tip: $tip, run: |sim, a| sincro_planning::call(sim, $name, a) }),*]
    };
}

/// Functions of `simOMPL`, named without it.
pub(super) const FUNCTIONS: &[Function] = sincro_planning::for_functions!(table);

macro_rules! calculations {
    ($($name:literal $tip:literal)*) => {
        &[$(Function { name: $name, tip: $tip, run: |sim, a| sincro_planning::calculate(sim, $name, a) }),*]
    };
}

/// Functions of `sim` on collision and distance objects.
pub(super) const CALCULATIONS: &[Function] = sincro_planning::for_calculations!(calculations);
