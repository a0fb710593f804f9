//! Tables from bytes: the part of CBOR (RFC 8949) that [`crate::cbor`] writes.

use crate::Value;

/// Lists and maps inside each other beyond which bytes are refused.
const MAX_DEPTH: usize = 64;

/// The value that bytes stand for.
///
/// # Errors
///
/// They are no table that was packed here, or something follows it.
pub fn read(bytes: &[u8]) -> Result<Value, String> {
    let mut reader = Reader { rest: bytes };
    let value = reader.value(0)?;
    if reader.rest.is_empty() { Ok(value) } else { Err(format!("{} bytes follow the packed table", reader.rest.len())) }
}

struct Reader<'a> {
    rest: &'a [u8],
}

impl<'a> Reader<'a> {
    fn take(&mut self, n: usize) -> Result<&'a [u8], String> {
        let (head, rest) = self.rest.split_at_checked(n).ok_or("the packed table is cut off")?;
        self.rest = rest;
        Ok(head)
    }

    fn number(&mut self, n: usize) -> Result<u64, String> {
        Ok(self.take(n)?.iter().fold(0, |sum, byte| (sum << 8) | u64::from(*byte)))
    }

    fn value(&mut self, depth: usize) -> Result<Value, String> {
        if depth > MAX_DEPTH {
            return Err("the packed table is too deep".into());
        }
        let first = self.take(1)?[0];
        let (major, low) = (first >> 5, first & 31);
        if major == 7 {
            return match low {
                20 | 21 => Ok(Value::Bool(low == 21)),
                22 => Ok(Value::Nil),
                26 => Ok(Value::Real(f64::from(f32::from_bits(self.number(4)? as u32)))),
                27 => Ok(Value::Real(f64::from_bits(self.number(8)?))),
                _ => Err(format!("the packed table has an unknown value ({first:#04x})")),
            };
        }
        let n = match low {
            0..24 => u64::from(low),
            24..28 => self.number(1 << (low - 24))?,
            _ => return Err(format!("the packed table has an unknown length ({first:#04x})")),
        };
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        let whole = || i64::try_from(n).map_err(|_| "the packed table has a number beyond 63 bits".to_owned());
        // a length beyond the bytes that are there is not believed
        let count = usize::try_from(n).ok().filter(|n| *n <= self.rest.len());
        let cut_off = || "the packed table is cut off".to_owned();
        Ok(match major {
            0 => Value::Int(whole()?),
            1 => Value::Int(-1 - whole()?),
            2 => Value::Bytes(self.take(count.ok_or_else(cut_off)?)?.to_vec()),
            3 => Value::Text(text(self.take(count.ok_or_else(cut_off)?)?)),
            4 => Value::List((0..count.ok_or_else(cut_off)?).map(|_| self.value(depth + 1)).collect::<Result<_, _>>()?),
            5 => {
                let mut map = Vec::new();
                for _ in 0..count.ok_or_else(cut_off)? {
                    let Value::Text(name) = self.value(depth + 1)? else {
                        return Err("the packed table has a key that is no text".into());
                    };
                    map.push((name, self.value(depth + 1)?));
                }
                Value::Map(map)
            }
            _ => return Err(format!("the packed table has an unknown value ({first:#04x})")),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cbor::encode;

    #[test]
    fn what_is_packed_comes_back() {
        let value = Value::Map(vec![
            ("a".into(), Value::List(vec![Value::Int(-70_000), Value::Int(1 << 40), Value::Real(0.1), Value::Nil])),
            ("b".into(), Value::Text("x".repeat(300))),
            ("c".into(), Value::Bytes(vec![0, 255])),
            ("d".into(), Value::Bool(true)),
        ]);
        let mut bytes = Vec::new();
        encode(&value, &mut bytes);
        assert_eq!(read(&bytes), Ok(value));
        for n in 0..bytes.len() {
            assert!(read(&bytes[..n]).is_err(), "cut at {n}");
        }
    }

    #[test]
    fn lengths_are_not_believed() {
        assert!(read(&[0x9b, 0x7f, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff]).is_err());
        assert!(read(&[0x81; 200]).is_err());
        assert!(read(&[0x01, 0x01]).is_err());
    }
}
