//! Functions: objects that are selected. Nothing shows them: a selection is a list that scripts and clients share.

use super::shapes::scale_each;
use super::{Function, Outcome, done, handle, one, plain};
use crate::api::{ApiError, Arguments, Handle, SimApi, Value};

/// `sim.handle_all`, `sim.handle_tree`, `sim.handle_chain`, `sim.handle_single`.
const ALL: i32 = -2;
const TREE: i32 = -6;
const CHAIN: i32 = -7;
const SINGLE: i32 = -8;

pub(super) const FUNCTIONS: &[Function] = &[
    Function { name: "getObjectSel", tip: "int[] objectHandles=sim.getObjectSel()", run: |sim, _| all(sim) },
    Function { name: "setObjectSel", tip: "sim.setObjectSel(int[] objectHandles)", run: set },
    Function {
        name: "addObjectToSelection",
        tip: "int result=sim.addObjectToSelection(int what=nil,int objectHandle=nil)",
        run: add,
    },
    Function {
        name: "removeObjectFromSelection",
        tip: "int result=sim.removeObjectFromSelection(int what=nil,int objectHandle=nil)",
        run: remove,
    },
    Function {
        name: "isObjectInSelection",
        tip: "int result=sim.isObjectInSelection(int objectHandle)",
        run: |sim, a| {
            let own = handle(sim, a, 0)?;
            one(i64::from(present(sim).contains(&own)))
        },
    },
    Function { name: "copyPasteSelectedObjects", tip: "int result=sim.copyPasteSelectedObjects()", run: copy },
    Function {
        name: "deleteSelectedObjects",
        tip: "int result=sim.deleteSelectedObjects()",
        run: |sim, _| {
            let selected = present(sim);
            sim.remove_objects(&selected, false)?;
            one(1_i64)
        },
    },
    Function {
        name: "scaleSelectedObjects",
        tip: "int result=sim.scaleSelectedObjects(float scalingFactor,bool scalePositionsToo)",
        run: |sim, a| {
            let selected = present(sim);
            scale_each(sim, &selected, (a.real(0)?, a.bool_or(1, false)?))?;
            one(1_i64)
        },
    },
    Function {
        name: "getObjectSelectionSize",
        tip: "int count=sim.getObjectSelectionSize()",
        run: |sim, _| one(present(sim).len() as i64),
    },
    Function {
        name: "getObjectLastSelection",
        tip: "int objectHandle=sim.getObjectLastSelection()",
        run: |sim, _| one(present(sim).last().copied().unwrap_or(Handle(-1))),
    },
];

/// Selected objects that are there.
fn present(sim: &SimApi<'_>) -> Vec<Handle> {
    sim.registry.selected()
}

fn all(sim: &mut SimApi<'_>) -> Outcome {
    Ok(vec![Value::handles(present(sim))])
}

/// The objects of a list.
fn listed(sim: &SimApi<'_>, list: &[Value]) -> Result<Vec<Handle>, ApiError> {
    let wrong = |value: &Value| ApiError(format!("argument 1 has {}, expected handles", value.word()));
    let of = |value: &Value| {
        let raw = value.as_int().and_then(|n| i32::try_from(n).ok()).ok_or_else(|| wrong(value))?;
        plain(sim, raw)
    };
    list.iter().map(of).collect()
}

/// Copies what is selected; the copies are selected then.
fn copy(sim: &mut SimApi<'_>, _: Arguments<'_>) -> Outcome {
    let selected = present(sim);
    if !selected.is_empty() {
        sim.registry.selection = sim.copy_objects(&selected, false)?;
    }
    one(1_i64)
}

/// Objects that are meant: a list, or an object alone, with those below or above it, or all. Nil is no object.
fn meant(sim: &SimApi<'_>, a: Arguments<'_>) -> Result<Vec<Handle>, ApiError> {
    if let Value::List(list) = a.get(0) {
        return listed(sim, list);
    }
    if !a.has(0) {
        return Ok(Vec::new());
    }
    let what = a.handle(0)?;
    let registry = &sim.registry;
    if what == ALL {
        return Ok(registry.entries().map(|e| e.handle).collect());
    }
    let own = handle(sim, a, 1)?;
    Ok(match what {
        SINGLE => vec![own],
        TREE => registry.visible_tree(own),
        CHAIN => {
            let chain = std::iter::successors(Some(own), |at| registry.visible_parent(*at));
            chain.take(registry.entries().count()).collect()
        }
        _ => {
            let words = "sim.handle_single, sim.handle_tree, sim.handle_chain, sim.handle_all";
            return Err(ApiError(format!("argument 1 is {what}, expected a list or one of {words}")));
        }
    })
}

fn set(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let Value::List(list) = a.get(0) else {
        return Err(ApiError(format!("argument 1 is {}, expected a list of handles", a.get(0).word())));
    };
    sim.registry.selection = listed(sim, list)?;
    done()
}

fn add(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let mut now = present(sim);
    for own in meant(sim, a)? {
        if !now.contains(&own) {
            now.push(own);
        }
    }
    sim.registry.selection = now;
    one(1_i64)
}

fn remove(sim: &mut SimApi<'_>, a: Arguments<'_>) -> Outcome {
    let gone = meant(sim, a)?;
    sim.registry.selection = present(sim).into_iter().filter(|own| !gone.contains(own)).collect();
    one(1_i64)
}
