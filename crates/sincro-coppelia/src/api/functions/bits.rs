//! Functions: bits of whole numbers.

use super::Function;

macro_rules! table {
    ($($name:literal $tip:literal)*) => {
        &[$(Function { name: $name, tip: $tip, run: |_, a| sincro_values::bits::call($name, a) }),*]
    };
}

pub(super) const FUNCTIONS: &[Function] = sincro_values::for_bits!(table);
