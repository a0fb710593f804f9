//! Values as CBOR (RFC 8949), for clients and for tables that scripts pack: definite lengths, numbers of 64 bits, no
//! tags. Whoever reads decides what is taken.

use crate::Value;

/// Appends a value to `out` as CBOR (RFC 8949), the binary encoding of the ZeroMQ and WebSocket remote APIs. Lengths
/// are definite, numbers [`Value::Real`] have 64 bits, whole numbers the shortest form; bytes that are in `out` already
/// stay.
pub fn encode(value: &Value, out: &mut Vec<u8>) {
    match value {
        Value::Nil => out.push(0xf6),
        Value::Bool(x) => out.push(0xf4 + u8::from(*x)),
        Value::Int(x) if *x >= 0 => head(0, *x as u64, out),
        Value::Int(x) => head(1, !*x as u64, out),
        Value::Real(x) => {
            out.push(0xfb);
            out.extend(x.to_be_bytes());
        }
        Value::Text(text) => {
            head(3, text.len() as u64, out);
            out.extend(text.as_bytes());
        }
        Value::Bytes(bytes) => {
            head(2, bytes.len() as u64, out);
            out.extend(bytes);
        }
        Value::List(list) => {
            head(4, list.len() as u64, out);
            list.iter().for_each(|x| encode(x, out));
        }
        Value::Numbered(map) => {
            head(5, map.len() as u64, out);
            for (key, x) in map {
                encode(&Value::Int(*key), out);
                encode(x, out);
            }
        }
        Value::Map(map) => {
            head(5, map.len() as u64, out);
            for (key, x) in map {
                head(3, key.len() as u64, out);
                out.extend(key.as_bytes());
                encode(x, out);
            }
        }
    }
}

/// Major type and argument, in the shortest form.
fn head(major: u8, n: u64, out: &mut Vec<u8>) {
    let major = major << 5;
    match n {
        0..24 => out.push(major | n as u8),
        24..0x100 => out.extend([major | 24, n as u8]),
        0x100..0x1_0000 => {
            out.push(major | 25);
            out.extend((n as u16).to_be_bytes());
        }
        0x1_0000..0x1_0000_0000 => {
            out.push(major | 26);
            out.extend((n as u32).to_be_bytes());
        }
        _ => {
            out.push(major | 27);
            out.extend(n.to_be_bytes());
        }
    }
}
