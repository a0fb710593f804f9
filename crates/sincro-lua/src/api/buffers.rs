//! Numbers and tables as bytes, little-endian, and back.

use mlua::{Error, LuaString, Table, Value as LuaValue};
use sincro_sim::session::cbor;

use super::Shelf;
use crate::{bytes, convert};

/// Sorts of numbers: name, bytes of one, to bytes, from bytes.
type Sort = (&'static str, usize, fn(f64) -> Vec<u8>, fn(&[u8]) -> f64);

// casts saturate: what does not fit becomes the nearest that does
const SORTS: [Sort; 6] = [
    ("Float", 4, |x| (x as f32).to_le_bytes().to_vec(), |b| f64::from(f32::from_le_bytes(fixed(b)))),
    ("Double", 8, |x| x.to_le_bytes().to_vec(), |b| f64::from_le_bytes(fixed(b))),
    ("Int32", 4, |x| (x as i32).to_le_bytes().to_vec(), |b| f64::from(i32::from_le_bytes(fixed(b)))),
    ("UInt32", 4, |x| (x as u32).to_le_bytes().to_vec(), |b| f64::from(u32::from_le_bytes(fixed(b)))),
    ("UInt16", 2, |x| (x as u16).to_le_bytes().to_vec(), |b| f64::from(u16::from_le_bytes(fixed(b)))),
    ("UInt8", 1, |x| vec![x as u8], |b| f64::from(b[0])),
];

/// Names that V-REP had for some of them.
const OLD: [(&str, &str); 6] = [
    ("Floats", "Float"),
    ("Doubles", "Double"),
    ("Ints", "Int32"),
    ("UInts", "UInt32"),
    ("Words", "UInt16"),
    ("Bytes", "UInt8"),
];

/// The first `N` bytes, of at least as many.
fn fixed<const N: usize>(bytes: &[u8]) -> [u8; N] {
    std::array::from_fn(|k| bytes[k])
}

pub(super) fn offer(shelf: &Shelf<'_>) -> mlua::Result<()> {
    for (name, size, to_bytes, from_bytes) in SORTS {
        let is_whole = !matches!(name, "Float" | "Double");
        let pack =
            shelf.lua.create_function(move |lua, (list, start, count): (Table, Option<usize>, Option<usize>)| {
                let (first, n) = (start.unwrap_or(0), list.raw_len());
                let n = some_of(n.saturating_sub(first), count);
                let mut packed = Vec::with_capacity(n * size);
                for k in first..first + n {
                    packed.extend(to_bytes(list.raw_get::<f64>(k + 1)?));
                }
                lua.create_string(packed)
            })?;
        type Given = (LuaString, Option<usize>, Option<usize>, Option<usize>);
        let unpack = shelf.lua.create_function(move |lua, (packed, start, count, offset): Given| {
            let packed = packed.as_bytes();
            let whole = packed.get(offset.unwrap_or(0)..).unwrap_or_default();
            let all = whole.chunks_exact(size).skip(start.unwrap_or(0));
            let n = some_of(all.len(), count);
            let list = lua.create_table_with_capacity(n, 0)?;
            for (k, chunk) in all.take(n).enumerate() {
                let x = from_bytes(chunk);
                list.raw_set(k + 1, if is_whole { LuaValue::Integer(x as i64) } else { LuaValue::Number(x) })?;
            }
            Ok(list)
        })?;
        for old in OLD.iter().filter(|(_, present)| *present == name).map(|(old, _)| old) {
            shelf.put(&format!("pack{old}"), pack.clone())?;
            shelf.put(&format!("unpack{old}"), unpack.clone())?;
        }
        shelf.put(&format!("pack{name}Table"), pack)?;
        shelf.put(&format!("unpack{name}Table"), unpack)?;
    }
    shelf.add("packTable", |lua, (table, _): (LuaValue, LuaValue)| {
        let value = convert::from_lua(table)?;
        let mut packed = Vec::new();
        cbor::encode(&value, &mut packed);
        lua.create_string(packed)
    })?;
    shelf.add("unpackTable", |lua, packed: LuaString| {
        let value = bytes::read(&packed.as_bytes());
        let value = value.map_err(|m| Error::RuntimeError(format!("{m} (in function 'sim.unpackTable')")))?;
        convert::to_lua(lua, &value)
    })
}

/// 0 or nothing means all.
fn some_of(n: usize, count: Option<usize>) -> usize {
    match count {
        None | Some(0) => n,
        Some(count) => n.min(count),
    }
}
