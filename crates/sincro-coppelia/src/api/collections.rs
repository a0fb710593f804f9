//! Collections: sets of objects that clients and scripts put together, to be looked at as one.

use super::registry::{Handle, ObjectRegistry};
use super::{ApiError, SimApi};

/// The first handle of a collection: objects have smaller ones.
const FIRST: i32 = 900_000;
/// Collections that may exist at once.
const MAX_COLLECTIONS: usize = 10_000;
/// Rules of one of them.
const MAX_ITEMS: usize = 10_000;

/// Objects that a rule of a collection selects.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Item {
    /// Every object, those that are made later, too.
    All,
    /// One object.
    Single(Handle),
    /// An object and all that hangs on it; `but_base`: without itself.
    Tree(Handle, bool),
    /// An object and all that it hangs on; `but_base`: without itself.
    Chain(Handle, bool),
}

/// A set of objects: rules that add and take away, one after the other, resolved at each use.
#[derive(Clone, Debug, Default)]
pub(crate) struct Collection {
    name: String,
    /// True if its members take part in everything, whatever their own flags say.
    overrides: bool,
    /// True if it adds.
    items: Vec<(Item, bool)>,
}

impl Collection {
    /// Forgets an object that was removed.
    pub(super) fn forget(&mut self, own: Handle) {
        let base = |item: &Item| match item {
            Item::All => None,
            Item::Single(base) | Item::Tree(base, _) | Item::Chain(base, _) => Some(*base),
        };
        self.items.retain(|(item, _)| base(item) != Some(own));
    }
}

impl ObjectRegistry {
    /// Makes an empty collection; with `overrides` its members take part in everything, whatever their own flags say.
    ///
    /// # Errors
    ///
    /// There are too many.
    pub(crate) fn create_collection(&mut self, name: &str, overrides: bool) -> Result<Handle, ApiError> {
        let all = &mut self.senses.collections;
        if all.len() >= MAX_COLLECTIONS {
            return Err(ApiError(format!("there are {MAX_COLLECTIONS} collections already: destroy some")));
        }
        let handle = all.last_key_value().map_or(Handle(FIRST), |(last, _)| Handle(last.0 + 1));
        all.insert(handle, Collection { name: name.to_owned(), overrides, items: Vec::new() });
        Ok(handle)
    }

    /// Returns the handle of the first collection (a set of objects that a client or script has put together) with a
    /// name; none if there is none.
    #[must_use]
    pub fn collection_named(&self, name: &str) -> Option<Handle> {
        let found = self.senses.collections.iter().find(|(_, c)| !c.name.is_empty() && c.name == name);
        found.map(|(handle, _)| *handle)
    }

    /// Returns true if a handle is that of a collection; handles of objects are smaller than those of collections.
    #[must_use]
    pub fn is_collection(&self, handle: Handle) -> bool {
        self.senses.collections.contains_key(&handle)
    }

    /// Returns true if members of a collection take part in everything.
    pub(super) fn overrides_flags(&self, handle: Handle) -> bool {
        self.senses.collections.get(&handle).is_some_and(|collection| collection.overrides)
    }

    fn collection(&mut self, handle: Handle) -> Result<&mut Collection, ApiError> {
        let found = self.senses.collections.get_mut(&handle);
        found.ok_or_else(|| ApiError(format!("there is no collection with the handle {}", handle.0)))
    }

    /// Adds a rule to a collection, or one that takes away.
    ///
    /// # Errors
    ///
    /// There is no such collection, or it has too many rules.
    pub(crate) fn add_to_collection(&mut self, handle: Handle, item: Item, adds: bool) -> Result<(), ApiError> {
        let collection = self.collection(handle)?;
        if collection.items.len() >= MAX_ITEMS {
            return Err(ApiError(format!("a collection has {MAX_ITEMS} items at most: empty it")));
        }
        collection.items.push((item, adds));
        Ok(())
    }

    /// Takes everything out of a collection.
    ///
    /// # Errors
    ///
    /// There is no such collection.
    pub(crate) fn empty_collection(&mut self, handle: Handle) -> Result<(), ApiError> {
        self.collection(handle)?.items.clear();
        Ok(())
    }

    /// Removes a collection; its objects stay.
    ///
    /// # Errors
    ///
    /// There is no such collection.
    pub(crate) fn remove_collection(&mut self, handle: Handle) -> Result<(), ApiError> {
        self.collection(handle)?;
        self.senses.collections.remove(&handle);
        self.forget_entity(Entity::Collection(handle));
        Ok(())
    }

    /// Handles of the objects that belong to a collection now, in ascending order, each once.
    ///
    /// # Errors
    ///
    /// `handle` is no collection, or one that was removed.
    pub fn collected(&self, handle: Handle) -> Result<Vec<Handle>, ApiError> {
        let found = self.senses.collections.get(&handle);
        let collection =
            found.ok_or_else(|| ApiError(format!("there is no collection with the handle {}", handle.0)))?;
        let mut members = std::collections::BTreeSet::new();
        for (item, adds) in &collection.items {
            let named: Vec<Handle> = match *item {
                Item::All => self.entries().map(|e| e.handle).collect(),
                Item::Single(one) => vec![one],
                Item::Tree(base, but_base) => {
                    self.visible_tree(base).into_iter().filter(|h| !but_base || *h != base).collect()
                }
                Item::Chain(base, but_base) => {
                    let up = std::iter::successors(Some(base), |h| self.visible_parent(*h));
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

/// Object, collection or whole scene, where a function of the API accepts any of them; [`SimApi::entity`] makes it of a
/// handle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Entity {
    /// All objects of the registry.
    All,
    /// One object, without what hangs on it.
    Object(Handle),
    /// The objects of a collection, resolved at each use.
    Collection(Handle),
}

impl Entity {
    /// Number of the entity where −1 stands for all.
    pub(super) fn number(self) -> i64 {
        match self {
            Self::All => -1,
            Self::Object(handle) | Self::Collection(handle) => handle.0.into(),
        }
    }
}

impl SimApi<'_> {
    /// Resolves a handle to what it stands for: an object, a collection, or, for −2 (`sim.handle_all`), everything.
    ///
    /// # Errors
    ///
    /// `handle` is neither −2 nor the handle of an object or a collection that exists.
    pub fn entity(&self, handle: Handle) -> Result<Entity, ApiError> {
        Ok(match handle {
            Handle(-2) => Entity::All,
            h if self.registry.is_collection(h) => Entity::Collection(h),
            h => Entity::Object(self.registry.entry(h)?.handle),
        })
    }

    /// The objects of an entity.
    ///
    /// # Errors
    ///
    /// It is a collection that was removed.
    pub(super) fn members(&self, entity: Entity) -> Result<Vec<Handle>, ApiError> {
        self.registry.members(entity)
    }
}

impl ObjectRegistry {
    /// The objects of an entity.
    pub(super) fn members(&self, entity: Entity) -> Result<Vec<Handle>, ApiError> {
        match entity {
            Entity::All => Ok(self.entries().map(|e| e.handle).collect()),
            Entity::Object(one) => Ok(vec![one]),
            Entity::Collection(handle) => self.collected(handle),
        }
    }
}
