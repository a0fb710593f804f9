//! Functions: collections.

use super::{Function, Outcome, done, one, plain};
use crate::api::{ApiError, Arguments, Handle, Item, SimApi, Value};

pub(super) const FUNCTIONS: &[Function] = &[
    Function { name: "createCollection", tip: "int collectionHandle=sim.createCollection(int options=0)", run: create },
    Function {
        name: "addItemToCollection",
        tip: "sim.addItemToCollection(int collectionHandle,int what,int objectHandle,int options=0)",
        run: |d, a| add(d, a, (1, 2)),
    },
    Function {
        name: "addObjectToCollection",
        tip: "int result=sim.addObjectToCollection(int collectionHandle,int objectHandle,int what,int options)",
        run: |d, a| add(d, a, (2, 1)),
    },
    Function {
        name: "emptyCollection",
        tip: "sim.emptyCollection(int collectionHandle)",
        run: |d, a| d.registry.empty_collection(Handle(a.handle(0)?)).and_then(|()| done()),
    },
    Function { name: "removeCollection", tip: "sim.removeCollection(int collectionHandle)", run: remove },
    Function { name: "destroyCollection", tip: "sim.destroyCollection(int collectionHandle)", run: remove },
    Function {
        name: "getCollectionObjects",
        tip: "int[] objectHandles=sim.getCollectionObjects(int collectionHandle)",
        run: |d, a| Ok(vec![Value::handles(d.registry.collected(Handle(a.handle(0)?))?)]),
    },
    Function {
        name: "getCollectionHandle",
        tip: "int collectionHandle=sim.getCollectionHandle(string collectionName)",
        run: |d, a| {
            let name = a.text(0)?;
            let found = d.registry.collection_named(name.strip_suffix('#').unwrap_or(name));
            one(found.ok_or_else(|| ApiError(format!("there is no collection `{}`", short(name))))?)
        },
    },
];

fn short(name: &str) -> String {
    name.chars().take(100).collect()
}

/// Creates a collection from options, or, as in V-REP, from a name and options: bit 0 lets its objects take part
/// whatever their own flags say.
fn create(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let name = if let Value::Text(_) | Value::Bytes(_) = a.get(0) { a.text(0)? } else { "" };
    let options = a.int_or(usize::from(matches!(a.get(0), Value::Text(_) | Value::Bytes(_))), 0)?;
    if !name.is_empty() && sim.registry.collection_named(name).is_some() {
        return Err(ApiError(format!("there is a collection `{}` already", short(name))));
    }
    one(sim.registry.create_collection(&short(name), options & 1 != 0)?)
}

fn remove(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    sim.registry.remove_collection(Handle(a.handle(0)?))?;
    done()
}

/// Adds or removes an item. `what` is −2 for all, −8 single, −6 tree, −7 chain; option 1 takes away, option 2 leaves
/// the base of a tree or the tip of a chain out.
fn add(sim: &mut SimApi<'_>, a: Arguments<'_>, (what, object): (usize, usize)) -> Outcome {
    let (collection, options) = (Handle(a.handle(0)?), a.int_or(3, 0)?);
    let base = || plain(sim, a.handle(object)?);
    let item = match a.handle(what)? {
        -2 => Item::All,
        -8 => Item::Single(base()?),
        -6 => Item::Tree(base()?, options & 2 != 0),
        -7 => Item::Chain(base()?, options & 2 != 0),
        other => {
            let known = "sim.handle_all, handle_single, handle_tree or handle_chain";
            return Err(ApiError(format!("{other} is no item of a collection: {known}")));
        }
    };
    sim.registry.add_to_collection(collection, item, options & 1 == 0)?;
    done()
}
