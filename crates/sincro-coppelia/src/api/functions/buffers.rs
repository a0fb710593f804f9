//! Functions: numbers and tables as bytes, little-endian, and back.

use super::Function;

macro_rules! table {
    ($($name:literal $tip:literal)*) => {
        &[$(Function { name: $name, tip: $tip, run: |_, a| sincro_values::buffers::call($name, a) }),*]
    };
}

pub(super) const FUNCTIONS: &[Function] = sincro_values::for_buffers!(table);
