//! Functions: paths, as lists of configurations one after the other.

use super::Function;

macro_rules! table {
    ($($name:literal $tip:literal)*) => {
        &[$(Function { name: $name, tip: $tip, run: |_, a| sincro_conventions::path_functions::call($name, a) }),*]
    };
}

pub(super) const FUNCTIONS: &[Function] = sincro_conventions::for_paths!(table);
