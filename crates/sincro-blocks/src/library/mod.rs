//! The library of blocks, by category.
//!
//! [`all`] lists them with their descriptions; [`find`] gives the one of a name.

pub mod adaptation;
pub mod continuous;
pub mod discrete;
pub mod logic;
pub mod maths;
pub mod matrices;
pub mod nonlinear;
mod prelude;
pub mod rotations;
pub mod routing;
pub mod sinks;
pub mod sources;

use crate::block::Block;
use crate::instance::DynBlock;
use crate::kind::{Described, Kind};
use crate::reader::Reader;

/// Entry of the library: a kind of block and its constructor from parameters; from [`all`] or [`find`].
#[derive(Clone, Copy, Debug)]
pub struct Item {
    /// Description of the kind.
    pub kind: &'static Kind,
    /// Creates a block from the parameters in a reader, which collects the errors in them.
    pub read: fn(&mut Reader<'_>) -> Box<dyn DynBlock>,
}

/// The item of a block type.
pub(crate) const fn item<B: Block + Described>() -> Item {
    Item { kind: B::KIND, read: |reader| Box::new(B::read(reader)) }
}

/// All kinds of block of the library, category by category.
// the tables are statics and this is not inlined: blocks are compiled here alone, not in each crate that asks for them
#[inline(never)]
pub fn all() -> impl Iterator<Item = &'static Item> {
    let categories = [
        sources::BLOCKS,
        maths::BLOCKS,
        matrices::BLOCKS,
        nonlinear::BLOCKS,
        continuous::BLOCKS,
        discrete::BLOCKS,
        adaptation::BLOCKS,
        routing::BLOCKS,
        logic::BLOCKS,
        rotations::BLOCKS,
        sinks::BLOCKS,
    ];
    categories.into_iter().flatten()
}

/// Kind of block with this name in files, such as `transfer-function`; `None` if there is none.
#[must_use]
pub fn find(name: &str) -> Option<&'static Item> {
    all().find(|item| item.kind.name == name)
}

/// Numbers as they fit into a box of a drawing.
pub(crate) fn short_list(numbers: &[f64]) -> String {
    match numbers {
        [x] => short(*x),
        _ if numbers.len() <= 3 => format!("[{}]", numbers.iter().map(|x| short(*x)).collect::<Vec<_>>().join(" ")),
        _ => format!("[{} … {}]", short(numbers[0]), short(numbers[numbers.len() - 1])),
    }
}

/// A number in few digits.
pub(crate) fn short(x: f64) -> String {
    let plain = format!("{x}");
    if plain.len() <= 7 {
        return plain;
    }
    if x != 0.0 && (x.abs() < 1e-3 || x.abs() >= 1e5) { format!("{x:.2e}") } else { format!("{x:.4}") }
}
