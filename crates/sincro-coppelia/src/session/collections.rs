//! Collections: sets of objects that clients and scripts put together, to be looked at as one.

use super::table::{Handle, Table};
use super::{Desk, Refusal};

/// The first handle of a collection: objects have smaller ones.
const FIRST: i32 = 900_000;
/// Collections that may exist at once.
const MOST: usize = 10_000;
/// Rules of one of them.
const MOST_ITEMS: usize = 10_000;

/// What a rule of a collection names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Item {
    /// Every object, those that are made later, too.
    All,
    /// One object.
    Single(Handle),
    /// An object and all that hangs on it; `but_base`: without itself.
    Tree(Handle, bool),
    /// An object and all that it hangs on; `but_base`: without itself.
    Chain(Handle, bool),
}

/// A set of objects: rules that add and take away, one after the other, looked up anew each time.
#[derive(Clone, Debug, Default)]
pub struct Collection {
    name: String,
    /// Whether it adds.
    items: Vec<(Item, bool)>,
}

impl Collection {
    /// An object is gone.
    pub(super) fn forget(&mut self, own: Handle) {
        let base = |item: &Item| match item {
            Item::All => None,
            Item::Single(base) | Item::Tree(base, _) | Item::Chain(base, _) => Some(*base),
        };
        self.items.retain(|(item, _)| base(item) != Some(own));
    }
}

impl Table {
    /// Makes an empty collection.
    ///
    /// # Errors
    ///
    /// There are too many.
    pub fn create_collection(&mut self, name: &str) -> Result<Handle, Refusal> {
        let all = &mut self.senses.collections;
        if all.len() >= MOST {
            return Err(Refusal(format!("there are {MOST} collections already: destroy some")));
        }
        let handle = all.last_key_value().map_or(Handle(FIRST), |(last, _)| Handle(last.0 + 1));
        all.insert(handle, Collection { name: name.to_owned(), items: Vec::new() });
        Ok(handle)
    }

    /// The collection of a name.
    #[must_use]
    pub fn collection_named(&self, name: &str) -> Option<Handle> {
        let found = self.senses.collections.iter().find(|(_, c)| !c.name.is_empty() && c.name == name);
        found.map(|(handle, _)| *handle)
    }

    /// Whether a handle is one of a collection.
    #[must_use]
    pub fn is_collection(&self, handle: Handle) -> bool {
        self.senses.collections.contains_key(&handle)
    }

    fn collection(&mut self, handle: Handle) -> Result<&mut Collection, Refusal> {
        let found = self.senses.collections.get_mut(&handle);
        found.ok_or_else(|| Refusal(format!("there is no collection with the handle {}", handle.0)))
    }

    /// Adds a rule to a collection, or one that takes away.
    ///
    /// # Errors
    ///
    /// There is no such collection, or it has too many rules.
    pub fn add_to_collection(&mut self, handle: Handle, item: Item, adds: bool) -> Result<(), Refusal> {
        let collection = self.collection(handle)?;
        if collection.items.len() >= MOST_ITEMS {
            return Err(Refusal(format!("a collection has {MOST_ITEMS} items at most: empty it")));
        }
        collection.items.push((item, adds));
        Ok(())
    }

    /// Takes everything out of a collection.
    ///
    /// # Errors
    ///
    /// There is no such collection.
    pub fn empty_collection(&mut self, handle: Handle) -> Result<(), Refusal> {
        self.collection(handle)?.items.clear();
        Ok(())
    }

    /// Removes a collection; its objects stay.
    ///
    /// # Errors
    ///
    /// There is no such collection.
    pub fn remove_collection(&mut self, handle: Handle) -> Result<(), Refusal> {
        self.collection(handle)?;
        self.senses.collections.remove(&handle);
        Ok(())
    }

    /// The objects of a collection, in their order.
    ///
    /// # Errors
    ///
    /// There is no such collection.
    pub fn collected(&self, handle: Handle) -> Result<Vec<Handle>, Refusal> {
        let found = self.senses.collections.get(&handle);
        let collection =
            found.ok_or_else(|| Refusal(format!("there is no collection with the handle {}", handle.0)))?;
        let mut members = std::collections::BTreeSet::new();
        for (item, adds) in &collection.items {
            let named: Vec<Handle> = match *item {
                Item::All => self.entries().map(|e| e.handle).collect(),
                Item::Single(one) => vec![one],
                Item::Tree(base, but_base) => self.tree(base).into_iter().filter(|h| !but_base || *h != base).collect(),
                Item::Chain(base, but_base) => {
                    let up = std::iter::successors(Some(base), |h| self.entry(*h).ok()?.parent);
                    up.filter(|h| !but_base || *h != base).collect()
                }
            };
            for one in named {
                if *adds {
                    members.insert(one);
                } else {
                    members.remove(&one);
                }
            }
        }
        Ok(members.into_iter().collect())
    }
}

/// What can be looked at as one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Entity {
    /// Everything.
    All,
    /// An object.
    Object(Handle),
    /// A collection.
    Collection(Handle),
}

impl Desk<'_> {
    /// What a handle means where an object, a collection or −2 for all may stand.
    ///
    /// # Errors
    ///
    /// It is none of them.
    pub fn entity(&self, handle: Handle) -> Result<Entity, Refusal> {
        Ok(match handle {
            Handle(-2) => Entity::All,
            h if self.table.is_collection(h) => Entity::Collection(h),
            h => Entity::Object(self.table.entry(h)?.handle),
        })
    }

    /// The objects of an entity.
    ///
    /// # Errors
    ///
    /// It is a collection that is gone.
    pub(super) fn members(&self, entity: Entity) -> Result<Vec<Handle>, Refusal> {
        match entity {
            Entity::All => Ok(self.table.entries().map(|e| e.handle).collect()),
            Entity::Object(one) => Ok(vec![one]),
            Entity::Collection(handle) => self.table.collected(handle),
        }
    }
}
