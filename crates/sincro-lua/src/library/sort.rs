//! `table.sort` by merging: stable, `n log₂ n` comparisons at most whatever the order before, the same in every run.
//!
//! Lua's own sort is a quicksort, quadratic for orders that are made for it, whose pivots depend on the clock. An order
//! that contradicts itself is no error here: the result is then some permutation. Where a comparison fails the table
//! stays as it was.

use std::cmp::Ordering;
use std::sync::Arc;

use mlua::{Error, Function, Lua, MultiValue, Table, Value};

use super::{Arguments, Library, put, type_name};
use crate::guard::Guard;

/// Elements up to which all are held at once; of larger tables each is fetched when it is compared, because references
/// from outside of Lua are few.
const MAX_HELD: usize = 1000;

/// Largest table, as in Lua.
const MAX_LEN: usize = i32::MAX as usize - 1;

pub(super) fn install(lua: &Lua, library: &Arc<Library>, tables: &Table) -> mlua::Result<()> {
    put(lua, library, tables, "sort", |library, arguments| {
        sort_table(library, arguments)?;
        Ok(MultiValue::new())
    })
}

fn sort_table(library: &Library, arguments: &Arguments<'_>) -> mlua::Result<()> {
    let lua = arguments.lua;
    let Some(Value::Table(table)) = arguments.get(1) else { return Err(arguments.wrong_type(1, "table")) };
    let n = usize::try_from(table.len()?).unwrap_or(0);
    if n < 2 {
        return Ok(());
    }
    // an element takes 16 bytes: what has more than fit has them by a metatable only
    if n > MAX_LEN || n > library.max_memory / 16 {
        return Err(arguments.wrong(1, "array too big"));
    }
    let order = match arguments.get(2) {
        None | Some(Value::Nil) => None,
        Some(Value::Function(function)) => Some(function),
        Some(_) => return Err(arguments.wrong_type(2, "function")),
    };
    let is_less = |a: &Value, b: &Value| match order {
        Some(order) => library.call(lua, order, (a, b)).map(|results| is_true(results.front())),
        None => is_less_value(library, lua, a, b),
    };
    sort_elements(lua, &library.guard, table, n, is_less)
}

/// Sorts keys of a table: truth values, then numbers, then texts, each in their own order.
pub(crate) fn sort_keys(lua: &Lua, guard: &Arc<Guard>, keys: &Table) -> mlua::Result<()> {
    sort_elements(lua, guard, keys, keys.raw_len(), |a, b| Ok(is_key_before(a, b)))
}

fn is_key_before(a: &Value, b: &Value) -> bool {
    let rank = |value: &Value| match value {
        Value::Boolean(_) => 1,
        Value::Integer(_) | Value::Number(_) => 2,
        _ => 3,
    };
    match (a, b) {
        (Value::Boolean(a), Value::Boolean(b)) => *a && !*b,
        _ if rank(a) != rank(b) => rank(a) < rank(b),
        _ => is_less_primitive(a, b).unwrap_or(false),
    }
}

fn is_true(value: Option<&Value>) -> bool {
    !matches!(value, None | Some(Value::Nil | Value::Boolean(false)))
}

/// `a < b` of Lua.
fn is_less_value(library: &Library, lua: &Lua, a: &Value, b: &Value) -> mlua::Result<bool> {
    if let Some(is_less) = is_less_primitive(a, b) {
        return Ok(is_less);
    }
    for operand in [a, b] {
        let Value::Table(table) = operand else { continue };
        let Some(metatable) = table.metatable() else { continue };
        if let Some(own) = metatable.raw_get::<Option<Function>>("__lt")? {
            return library.call(lua, &own, (a, b)).map(|results| is_true(results.front()));
        }
    }
    let (a, b) = (type_name(a), type_name(b));
    Err(Error::RuntimeError(if a == b {
        format!("attempt to compare two {a} values")
    } else {
        format!("attempt to compare {a} with {b}")
    }))
}

/// `a < b` of two numbers or two strings.
fn is_less_primitive(a: &Value, b: &Value) -> Option<bool> {
    Some(match (a, b) {
        (Value::Integer(a), Value::Integer(b)) => a < b,
        (Value::Number(a), Value::Number(b)) => a < b,
        (Value::Integer(a), Value::Number(b)) => compare(*a, *b) == Some(Ordering::Less),
        (Value::Number(a), Value::Integer(b)) => compare(*b, *a) == Some(Ordering::Greater),
        (Value::String(a), Value::String(b)) => *a.as_bytes() < *b.as_bytes(),
        _ => return None,
    })
}

/// Order of an integer and a floating-point number, without rounding.
fn compare(n: i64, x: f64) -> Option<Ordering> {
    const TWO_63: f64 = 9_223_372_036_854_775_808.0;
    if x.is_nan() {
        return None;
    }
    if x >= TWO_63 {
        return Some(Ordering::Less);
    }
    if x < -TWO_63 {
        return Some(Ordering::Greater);
    }
    let whole = x.floor();
    Some(n.cmp(&(whole as i64)).then(if x > whole { Ordering::Less } else { Ordering::Equal }))
}

/// Elements of a table while it is sorted.
enum Elements<'a> {
    Held(Vec<Value>),
    InTable(&'a Table),
}

impl Elements<'_> {
    fn with<T>(&self, (a, b): (u32, u32), act: impl FnOnce(&Value, &Value) -> mlua::Result<T>) -> mlua::Result<T> {
        match self {
            Self::Held(values) => act(&values[a as usize], &values[b as usize]),
            Self::InTable(table) => act(&table.get(u64::from(a) + 1)?, &table.get(u64::from(b) + 1)?),
        }
    }
}

/// Sorts the elements 1 … `n` of a table, for one instruction an element and a comparison.
fn sort_elements(
    lua: &Lua,
    guard: &Arc<Guard>,
    table: &Table,
    n: usize,
    is_less: impl Fn(&Value, &Value) -> mlua::Result<bool>,
) -> mlua::Result<()> {
    guard.charge(lua, n as u64)?;
    let elements = if n <= MAX_HELD {
        Elements::Held((1..=n).map(|k| table.get(k)).collect::<mlua::Result<_>>()?)
    } else {
        Elements::InTable(table)
    };
    let mut n_compared = 0;
    let order = merge_sort(n as u32, |a, b| {
        n_compared += 1;
        if n_compared % CHARGE_EVERY == 0 {
            guard.charge(lua, CHARGE_EVERY)?;
        }
        elements.with((a, b), &is_less)
    })?;
    guard.charge(lua, n_compared % CHARGE_EVERY)?;
    put_back(lua, table, &elements, &order)
}

/// Comparisons after which they are charged for.
const CHARGE_EVERY: u64 = 64;

fn put_back(lua: &Lua, table: &Table, elements: &Elements<'_>, order: &[u32]) -> mlua::Result<()> {
    if let Elements::Held(values) = elements {
        return order.iter().enumerate().try_for_each(|(k, from)| table.set(k + 1, &values[*from as usize]));
    }
    let sorted = lua.create_table()?;
    for (k, from) in order.iter().enumerate() {
        sorted.raw_set(k + 1, table.get::<Value>(u64::from(*from) + 1)?)?;
    }
    (1..=order.len()).try_for_each(|k| table.set(k, sorted.raw_get::<Value>(k)?))
}

/// Order of the elements 0 … `n` − 1: runs of one, two, four … are merged.
fn merge_sort(n: u32, mut is_less: impl FnMut(u32, u32) -> mlua::Result<bool>) -> mlua::Result<Vec<u32>> {
    let mut order: Vec<u32> = (0..n).collect();
    let mut merged = Vec::with_capacity(order.len());
    let mut width = 1;
    while width < order.len() {
        merged.clear();
        for pair in order.chunks(2 * width) {
            let (left, right) = pair.split_at(width.min(pair.len()));
            merge(left, right, &mut merged, &mut is_less)?;
        }
        std::mem::swap(&mut order, &mut merged);
        width *= 2;
    }
    Ok(order)
}

/// Appends two runs in order; of equal elements the left one comes first.
fn merge(
    left: &[u32],
    right: &[u32],
    merged: &mut Vec<u32>,
    is_less: &mut impl FnMut(u32, u32) -> mlua::Result<bool>,
) -> mlua::Result<()> {
    let (mut i, mut j) = (0, 0);
    while i < left.len() && j < right.len() {
        if is_less(right[j], left[i])? {
            merged.push(right[j]);
            j += 1;
        } else {
            merged.push(left[i]);
            i += 1;
        }
    }
    merged.extend_from_slice(&left[i..]);
    merged.extend_from_slice(&right[j..]);
    Ok(())
}
