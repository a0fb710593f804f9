//! Level 5 MAT-files: numbers, texts and cells, without compression.

use super::{Limits, little_endian};
use crate::table::Table;

const INT8: u32 = 1;
const INT32: u32 = 5;
const UINT32: u32 = 6;
const DOUBLE: u32 = 9;
const MATRIX: u32 = 14;
const UTF8: u32 = 16;

/// Classes of arrays.
const CELL: u32 = 1;
const CHAR: u32 = 4;
const DOUBLES: u32 = 6;

/// Sizes are signed numbers of 32 bits, and `signals` is one variable.
pub(super) const LIMITS: Limits =
    Limits { columns: i32::MAX as usize, column_bytes: i32::MAX as u64, bytes: i32::MAX as u64 };

/// The file of a table.
pub(super) fn bytes(table: &Table) -> Vec<u8> {
    let mut out = b"MATLAB 5.0 MAT-file, written by sincro".to_vec();
    out.resize(116, b' ');
    out.resize(124, 0);
    out.extend([0, 1, b'I', b'M']);
    let (n, columns) = (table.n_rows(), &table.columns[1..]);
    let values: Vec<u8> = columns.iter().flat_map(|c| little_endian(&c.values)).collect();
    out.extend(array("t", DOUBLES, [n, 1], element(DOUBLE, &little_endian(table.times()))));
    out.extend(array("signals", DOUBLES, [n, columns.len()], element(DOUBLE, &values)));
    out.extend(texts("names", columns.iter().map(|c| c.name.as_str())));
    out.extend(texts("units", columns.iter().map(|c| c.unit.as_str())));
    out
}

/// A column of cells with texts.
fn texts<'a>(name: &str, all: impl ExactSizeIterator<Item = &'a str>) -> Vec<u8> {
    let n = all.len();
    let cells = all.flat_map(|text| {
        let size = [usize::from(!text.is_empty()), text.chars().count()];
        array("", CHAR, size, element(UTF8, text.as_bytes()))
    });
    array(name, CELL, [n, 1], cells.collect())
}

fn array(name: &str, class: u32, size: [usize; 2], content: Vec<u8>) -> Vec<u8> {
    let flags: Vec<u8> = [class, 0].iter().flat_map(|x| x.to_le_bytes()).collect();
    let size: Vec<u8> = size.iter().flat_map(|n| (*n as i32).to_le_bytes()).collect();
    let parts = [element(UINT32, &flags), element(INT32, &size), element(INT8, name.as_bytes()), content];
    element(MATRIX, &parts.concat())
}

/// Type, length and bytes, filled up to a multiple of 8.
fn element(kind: u32, bytes: &[u8]) -> Vec<u8> {
    let mut out = [kind.to_le_bytes(), (bytes.len() as u32).to_le_bytes()].concat();
    out.extend(bytes);
    out.resize(out.len().next_multiple_of(8), 0);
    out
}
