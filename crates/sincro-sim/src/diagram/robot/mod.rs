//! Robot blocks: what the model knows, for use in a controller.

use std::sync::Arc;

use sincro_blocks::instance::Template;
use sincro_blocks::kind::Kind;
use sincro_blocks::reader::Reader;
use sincro_dynamics::model::Model;

/// What robot blocks are made with.
#[derive(Clone, Debug)]
pub struct Context {
    /// The scene's model.
    pub model: Arc<Model<f64>>,
}

/// A kind of block and how one is made from parameters and the model.
#[derive(Clone, Copy, Debug)]
pub struct Item {
    /// Its description.
    pub kind: &'static Kind,
    /// Makes one.
    pub read: fn(&mut Reader<'_>, &Context) -> Box<dyn Template>,
}

const SHELF: &[Item] = &[];

/// All robot blocks.
pub fn all() -> impl Iterator<Item = &'static Item> {
    SHELF.iter()
}

/// The block of a name.
#[must_use]
pub fn find(name: &str) -> Option<&'static Item> {
    all().find(|item| item.kind.name == name)
}
