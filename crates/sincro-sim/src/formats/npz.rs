//! NumPy's archive of arrays: a ZIP file of `.npy` files, stored without compression.

use super::{Limits, little_endian};
use crate::table::Table;

/// Names in UTF-8.
const UTF8: u16 = 1 << 11;
/// First of January 1980: archives of one run are the same bytes.
const DATE: u16 = (1 << 5) | 1;

/// Counts of 16 bits and offsets of 32 bits: larger archives need the format's extension to 64 bits.
pub(super) const LIMITS: Limits =
    Limits { columns: u16::MAX as usize, column_bytes: u32::MAX as u64, bytes: u32::MAX as u64 };

/// The archive of a table.
pub(super) fn bytes(table: &Table) -> Vec<u8> {
    let (mut out, mut directory) = (Vec::new(), Vec::new());
    for column in &table.columns {
        let (name, content) = (format!("{}.npy", column.name), array(&column.values));
        let offset = out.len() as u32;
        let entry = entry(&name, &content);
        out.extend(b"PK\x03\x04");
        out.extend(&entry);
        out.extend(name.as_bytes());
        out.extend(&content);
        directory.extend(b"PK\x01\x02");
        directory.extend(20_u16.to_le_bytes());
        directory.extend(&entry);
        // comment, disk, attributes
        directory.extend([0; 10]);
        directory.extend(offset.to_le_bytes());
        directory.extend(name.as_bytes());
    }
    let (start, n) = (out.len() as u32, table.columns.len() as u16);
    out.extend(&directory);
    out.extend(b"PK\x05\x06\0\0\0\0");
    out.extend(n.to_le_bytes());
    out.extend(n.to_le_bytes());
    out.extend((directory.len() as u32).to_le_bytes());
    out.extend(start.to_le_bytes());
    out.extend([0; 2]);
    out
}

/// Fields that stand both before a file and in the directory.
fn entry(name: &str, content: &[u8]) -> Vec<u8> {
    let (crc, size) = (crc32fast::hash(content), content.len() as u32);
    let mut out = Vec::new();
    for field in [20, UTF8, 0, 0, DATE] {
        out.extend(u16::to_le_bytes(field));
    }
    for field in [crc, size, size] {
        out.extend(field.to_le_bytes());
    }
    out.extend((name.len() as u16).to_le_bytes());
    out.extend([0; 2]);
    out
}

/// An array as a `.npy` file.
fn array(values: &[f64]) -> Vec<u8> {
    let mut head = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({},), }}", values.len());
    // the data begin at a multiple of 64 bytes
    while (10 + head.len() + 1) % 64 != 0 {
        head.push(' ');
    }
    head.push('\n');
    let mut out = b"\x93NUMPY\x01\0".to_vec();
    out.extend((head.len() as u16).to_le_bytes());
    out.extend(head.as_bytes());
    out.extend(little_endian(values));
    out
}
