//! Values as CBOR (RFC 8949), in the subset that the clients of CoppeliaSim understand.
//!
//! Written ([`encode`]): definite lengths, whole numbers for handles and counts, 64-bit floats for every quantity, no
//! tags. Read: every width of numbers, indefinite lengths, tags (ignored), `undefined` as nil. Depth is limited;
//! lengths that the message does not have take no memory.
//!
//! Ours and not a library's: values are trees of any shape, of which a library would only read and write the heads, and
//! limits must hold before anything is allocated.

use std::fmt;

use sincro_coppelia::api::Value;
pub use sincro_coppelia::api::cbor::encode;

use crate::limits::DEPTH;

/// Error of [`decode`]: place and reason in the encoded message.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CborError {
    /// Offset from the start of the message `[bytes]`.
    pub at: usize,
    /// Reason, in words.
    pub what: &'static str,
}

impl fmt::Display for CborError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "byte {} of the message: {}", self.at, self.what)
    }
}

impl std::error::Error for CborError {}

/// Decodes a message of the ZeroMQ or WebSocket remote API in CBOR (RFC 8949), which must be one value and nothing
/// else. Numbers of all widths, indefinite lengths and tags (ignored) are read; `undefined` is nil.
///
/// ```
/// use sincro_coppelia::api::Value;
/// use sincro_remote::cbor::{decode, encode};
///
/// let mut bytes = Vec::new();
/// encode(&Value::reals([0.5, 1.0]), &mut bytes);
/// assert_eq!(decode(&bytes)?, Value::reals([0.5, 1.0]));
/// assert_eq!(decode(&bytes[..3]).unwrap_err().at, 2);
/// # Ok::<(), sincro_remote::cbor::CborError>(())
/// ```
///
/// # Errors
///
/// The bytes are cut short, nested deeper than [`DEPTH`], followed by others, or no CBOR; the error has the offset.
pub fn decode(bytes: &[u8]) -> Result<Value, CborError> {
    let mut reader = Reader { bytes, at: 0 };
    let value = reader.value(0)?;
    if reader.at != bytes.len() {
        return Err(reader.error("something stands after the value"));
    }
    Ok(value)
}

struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
}

/// Length of a text, list or map; none: until its end mark.
type Length = Option<usize>;

impl<'a> Reader<'a> {
    fn error(&self, what: &'static str) -> CborError {
        CborError { at: self.at, what }
    }

    fn take(&mut self, n: usize) -> Result<&'a [u8], CborError> {
        let rest = &self.bytes[self.at..];
        let found = rest.get(..n).ok_or(self.error("the message is cut short"))?;
        self.at += n;
        Ok(found)
    }

    fn byte(&mut self) -> Result<u8, CborError> {
        Ok(self.take(1)?[0])
    }

    /// The number that follows an initial byte.
    fn argument(&mut self, info: u8) -> Result<u64, CborError> {
        let n = match info {
            0..24 => return Ok(info.into()),
            24..28 => 1 << (info - 24),
            _ => return Err(self.error("a length that does not exist")),
        };
        Ok(self.take(n)?.iter().fold(0, |sum, b| sum << 8 | u64::from(*b)))
    }

    fn length(&mut self, info: u8) -> Result<Length, CborError> {
        if info == 31 {
            return Ok(None);
        }
        let n = self.argument(info)?;
        // every item takes a byte at least
        let left = (self.bytes.len() - self.at) as u64;
        if n > left {
            return Err(self.error("the message is cut short"));
        }
        Ok(Some(n as usize))
    }

    /// Returns true if the end mark of something of indefinite length comes next; it is then taken.
    fn is_end(&mut self) -> Result<bool, CborError> {
        let is_end = *self.bytes.get(self.at).ok_or(self.error("the message is cut short"))? == 0xff;
        self.at += usize::from(is_end);
        Ok(is_end)
    }

    fn value(&mut self, depth: usize) -> Result<Value, CborError> {
        if depth > DEPTH {
            return Err(self.error("lists and maps are nested too deeply"));
        }
        let first = self.byte()?;
        let (major, info) = (first >> 5, first & 31);
        Ok(match major {
            0 => whole(self.argument(info)?, |n| n),
            1 => whole(self.argument(info)?, |n| -1 - n),
            2 => Value::Bytes(self.string(2, info)?),
            3 => Value::Text(String::from_utf8(self.string(3, info)?).map_err(|_| self.error("text is not UTF-8"))?),
            4 => Value::List(self.list(info, depth)?),
            5 => Value::Map(self.map(info, depth)?),
            6 => {
                self.argument(info)?;
                self.value(depth + 1)?
            }
            _ => self.simple(info)?,
        })
    }

    fn simple(&mut self, info: u8) -> Result<Value, CborError> {
        Ok(match info {
            20 => Value::Bool(false),
            21 => Value::Bool(true),
            22 | 23 => Value::Nil,
            25 => Value::Real(half(u16::from_be_bytes(self.array()?))),
            26 => Value::Real(f32::from_be_bytes(self.array()?).into()),
            27 => Value::Real(f64::from_be_bytes(self.array()?)),
            31 => return Err(self.error("an end mark where nothing has begun")),
            _ => return Err(self.error("a simple value that is not known")),
        })
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], CborError> {
        Ok(self.take(N)?.try_into().expect("as many as were taken"))
    }

    fn string(&mut self, major: u8, info: u8) -> Result<Vec<u8>, CborError> {
        if let Some(n) = self.length(info)? {
            return Ok(self.take(n)?.to_vec());
        }
        let mut whole = Vec::new();
        while !self.is_end()? {
            let first = self.byte()?;
            let n = if first >> 5 == major { self.length(first & 31)? } else { None };
            let n = n.ok_or(self.error("a piece of text or bytes is something else"))?;
            whole.extend_from_slice(self.take(n)?);
        }
        Ok(whole)
    }

    fn list(&mut self, info: u8, depth: usize) -> Result<Vec<Value>, CborError> {
        let n = self.length(info)?;
        let mut list = Vec::new();
        while !self.is_complete(n, list.len())? {
            list.push(self.value(depth + 1)?);
        }
        Ok(list)
    }

    fn map(&mut self, info: u8, depth: usize) -> Result<Vec<(String, Value)>, CborError> {
        let n = self.length(info)?;
        let mut map = Vec::new();
        while !self.is_complete(n, map.len())? {
            let key = match self.value(depth + 1)? {
                Value::Text(key) => key,
                Value::Int(key) => key.to_string(),
                _ => return Err(self.error("a key of a map is no text")),
            };
            map.push((key, self.value(depth + 1)?));
        }
        Ok(map)
    }

    fn is_complete(&mut self, n: Length, done: usize) -> Result<bool, CborError> {
        n.map_or_else(|| self.is_end(), |n| Ok(done == n))
    }
}

/// A whole number, as a real one where 64 bits do not hold it.
fn whole(n: u64, sign: impl Fn(i64) -> i64) -> Value {
    match i64::try_from(n) {
        Ok(n) => Value::Int(sign(n)),
        Err(_) => Value::Real(n as f64 * sign(1).signum() as f64),
    }
}

/// A 16-bit float.
fn half(bits: u16) -> f64 {
    let (exponent, mantissa) = (i32::from(bits >> 10 & 31), f64::from(bits & 0x3ff));
    let size = match exponent {
        0 => mantissa / f64::from(1 << 24),
        31 if mantissa == 0.0 => f64::INFINITY,
        31 => f64::NAN,
        e if e < 25 => (1024.0 + mantissa) / f64::from(1_u32 << (25 - e)),
        e => (1024.0 + mantissa) * f64::from(1_u32 << (e - 25)),
    };
    if bits & 0x8000 == 0 { size } else { -size }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bytes(hex: &str) -> Vec<u8> {
        (0..hex.len() / 2).map(|k| u8::from_str_radix(&hex[2 * k..2 * k + 2], 16).unwrap()).collect()
    }

    #[test]
    fn the_examples_of_the_standard_are_read() {
        // RFC 8949, appendix A
        let examples = [
            ("17", Value::Int(23)),
            ("1b000000e8d4a51000", Value::Int(1_000_000_000_000)),
            ("3903e7", Value::Int(-1000)),
            ("f90001", Value::Real(5.960_464_477_539_063e-8)),
            ("f97bff", Value::Real(65504.0)),
            ("f9c400", Value::Real(-4.0)),
            ("f93e00", Value::Real(1.5)),
            ("fa47c35000", Value::Real(100_000.0)),
            ("fb3ff199999999999a", Value::Real(1.1)),
            ("f97c00", Value::Real(f64::INFINITY)),
            ("f7", Value::Nil),
            ("c11a514b67b0", Value::Int(1_363_896_240)),
            ("62c3bc", Value::Nil),
            ("5f42010243030405ff", Value::Bytes(vec![1, 2, 3, 4, 5])),
            ("7f657374726561646d696e67ff", Value::Text("streaming".into())),
            ("9f0102ff", Value::List(vec![Value::Int(1), Value::Int(2)])),
            (
                "bf6346756ef563416d7421ff",
                Value::Map(vec![("Fun".into(), Value::Bool(true)), ("Amt".into(), Value::Int(-2))]),
            ),
        ];
        for (hex, value) in examples {
            if hex == "62c3bc" {
                assert_eq!(decode(&bytes(hex)), Ok(Value::Text("ü".into())));
            } else {
                assert_eq!(decode(&bytes(hex)), Ok(value), "{hex}");
            }
        }
    }

    #[test]
    fn the_answer_of_the_transcript_has_its_bytes() {
        let mut out = Vec::new();
        encode(&Value::Map(vec![("ret".into(), Value::List(vec![Value::Int(17)]))]), &mut out);
        assert_eq!(out, bytes("a1637265748111"));
    }

    #[test]
    fn what_is_no_value_is_told() {
        for (hex, what) in [
            ("", "the message is cut short"),
            ("9bffffffffffffffff", "the message is cut short"),
            ("5f01ff", "a piece of text or bytes is something else"),
            ("0000", "something stands after the value"),
            ("61ff", "text is not UTF-8"),
            ("ff", "an end mark where nothing has begun"),
            ("1c", "a length that does not exist"),
            ("a1f500", "a key of a map is no text"),
        ] {
            assert_eq!(decode(&bytes(hex)).unwrap_err().what, what, "{hex}");
        }
        assert_eq!(decode(&[0x81; 100]).unwrap_err().what, "lists and maps are nested too deeply");
    }
}
