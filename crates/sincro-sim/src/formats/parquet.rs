//! Apache Parquet: one row group, one plain page of doubles for each column, metadata in Thrift's compact protocol.

use super::{Limits, little_endian};
use crate::table::Table;

/// Types of Thrift's compact protocol.
const I32: u8 = 5;
const I64: u8 = 6;
const BINARY: u8 = 8;
const LIST: u8 = 9;
const STRUCT: u8 = 12;

/// Physical type, encodings and repetition of Parquet.
const DOUBLE: i64 = 5;
const PLAIN: i64 = 0;
const RLE: i64 = 3;
const REQUIRED: i64 = 0;

/// A structure that is being written.
#[derive(Default)]
struct Struct {
    bytes: Vec<u8>,
    last: u8,
}

impl Struct {
    fn field(&mut self, id: u8, kind: u8) {
        self.bytes.push(((id - self.last) << 4) | kind);
        self.last = id;
    }

    fn int(mut self, id: u8, kind: u8, value: i64) -> Self {
        self.field(id, kind);
        varint(&mut self.bytes, ((value << 1) ^ (value >> 63)) as u64);
        self
    }

    fn text(mut self, id: u8, text: &str) -> Self {
        self.field(id, BINARY);
        binary(&mut self.bytes, text);
        self
    }

    fn inner(mut self, id: u8, inner: Self) -> Self {
        self.field(id, STRUCT);
        self.bytes.extend(inner.end());
        self
    }

    fn list(mut self, id: u8, kind: u8, items: &[Vec<u8>]) -> Self {
        self.field(id, LIST);
        if items.len() < 15 {
            self.bytes.push(((items.len() as u8) << 4) | kind);
        } else {
            self.bytes.push(0xf0 | kind);
            varint(&mut self.bytes, items.len() as u64);
        }
        items.iter().for_each(|item| self.bytes.extend(item));
        self
    }

    fn end(mut self) -> Vec<u8> {
        self.bytes.push(0);
        self.bytes
    }
}

fn varint(out: &mut Vec<u8>, mut value: u64) {
    while value >= 0x80 {
        out.push(value as u8 | 0x80);
        value >>= 7;
    }
    out.push(value as u8);
}

fn binary(out: &mut Vec<u8>, text: &str) {
    varint(out, text.len() as u64);
    out.extend(text.as_bytes());
}

fn number(value: i64) -> Vec<u8> {
    let mut out = Vec::new();
    varint(&mut out, ((value << 1) ^ (value >> 63)) as u64);
    out
}

/// Sizes of pages and numbers of columns are signed numbers of 32 bits.
pub(super) const LIMITS: Limits =
    Limits { columns: i32::MAX as usize, column_bytes: i32::MAX as u64, bytes: i64::MAX as u64 };

/// The file of a table.
pub(super) fn bytes(table: &Table) -> Vec<u8> {
    let n = table.n_rows() as i64;
    let mut out = b"PAR1".to_vec();
    let (mut chunks, mut total) = (Vec::new(), 0);
    for column in &table.columns {
        let data = little_endian(&column.values);
        let size = data.len() as i64;
        let of_data = Struct::default().int(1, I32, n).int(2, I32, PLAIN).int(3, I32, RLE).int(4, I32, RLE);
        let head = Struct::default().int(1, I32, 0).int(2, I32, size).int(3, I32, size).inner(5, of_data).end();
        let (offset, whole) = (out.len() as i64, head.len() as i64 + size);
        out.extend(head);
        out.extend(data);
        let mut path = Vec::new();
        binary(&mut path, &column.name);
        let meta = Struct::default()
            .int(1, I32, DOUBLE)
            .list(2, I32, &[number(PLAIN)])
            .list(3, BINARY, &[path])
            .int(4, I32, 0)
            .int(5, I64, n)
            .int(6, I64, whole)
            .int(7, I64, whole)
            .int(9, I64, offset);
        chunks.push(Struct::default().int(2, I64, offset).inner(3, meta).end());
        total += whole;
    }
    let root = Struct::default().text(4, "signals").int(5, I32, table.columns.len() as i64).end();
    let columns = table
        .columns
        .iter()
        .map(|c| Struct::default().int(1, I32, DOUBLE).int(3, I32, REQUIRED).text(4, &c.name).end());
    let schema: Vec<Vec<u8>> = std::iter::once(root).chain(columns).collect();
    let units: Vec<Vec<u8>> = table
        .columns
        .iter()
        .map(|c| Struct::default().text(1, &format!("unit of {}", c.name)).text(2, &c.unit).end())
        .collect();
    let group = Struct::default().list(1, STRUCT, &chunks).int(2, I64, total).int(3, I64, n).end();
    let meta = Struct::default()
        .int(1, I32, 1)
        .list(2, STRUCT, &schema)
        .int(3, I64, n)
        .list(4, STRUCT, &[group])
        .list(5, STRUCT, &units)
        .text(6, concat!("sincro ", env!("CARGO_PKG_VERSION")))
        .end();
    out.extend(&meta);
    out.extend((meta.len() as u32).to_le_bytes());
    out.extend(b"PAR1");
    out
}
