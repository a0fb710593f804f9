//! Thrift's compact protocol, as far as the metadata of Parquet needs it.

/// Types of the protocol.
pub(super) const I32: u8 = 5;
pub(super) const I64: u8 = 6;
pub(super) const BINARY: u8 = 8;
pub(super) const LIST: u8 = 9;
pub(super) const STRUCT: u8 = 12;

/// Deepest nesting that is read; the metadata of Parquet has six levels.
const MAX_DEPTH: usize = 16;

/// A structure that is being written.
#[derive(Default)]
pub(super) struct Struct {
    bytes: Vec<u8>,
    last: u8,
}

impl Struct {
    fn field(&mut self, id: u8, kind: u8) {
        self.bytes.push(((id - self.last) << 4) | kind);
        self.last = id;
    }

    pub(super) fn int(mut self, id: u8, kind: u8, value: i64) -> Self {
        self.field(id, kind);
        varint(&mut self.bytes, zigzag(value));
        self
    }

    pub(super) fn text(mut self, id: u8, text: &str) -> Self {
        self.field(id, BINARY);
        binary(&mut self.bytes, text);
        self
    }

    pub(super) fn inner(mut self, id: u8, inner: Self) -> Self {
        self.field(id, STRUCT);
        self.bytes.extend(inner.end());
        self
    }

    pub(super) fn list(mut self, id: u8, kind: u8, items: &[Vec<u8>]) -> Self {
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

    pub(super) fn end(mut self) -> Vec<u8> {
        self.bytes.push(0);
        self.bytes
    }
}

fn zigzag(value: i64) -> u64 {
    ((value << 1) ^ (value >> 63)) as u64
}

fn varint(out: &mut Vec<u8>, mut value: u64) {
    while value >= 0x80 {
        out.push(value as u8 | 0x80);
        value >>= 7;
    }
    out.push(value as u8);
}

/// A text as an item of a list.
pub(super) fn binary(out: &mut Vec<u8>, text: &str) {
    varint(out, text.len() as u64);
    out.extend(text.as_bytes());
}

/// A number as an item of a list.
pub(super) fn number(value: i64) -> Vec<u8> {
    let mut out = Vec::new();
    varint(&mut out, zigzag(value));
    out
}

/// A value that was read.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Value {
    /// A number, true or false.
    Int(i64),
    /// A double, whose value the metadata of our files do not need.
    Double,
    /// A text or bytes.
    Binary(Vec<u8>),
    /// A list or set.
    List(Vec<Self>),
    /// A structure: its fields by their numbers.
    Struct(Vec<(i64, Self)>),
}

impl Value {
    /// The field of that number.
    pub(super) fn field(&self, id: i64) -> Option<&Self> {
        match self {
            Self::Struct(fields) => fields.iter().find(|(known, _)| *known == id).map(|(_, value)| value),
            _ => None,
        }
    }

    pub(super) fn int(&self, id: i64) -> Option<i64> {
        if let Some(Self::Int(value)) = self.field(id) { Some(*value) } else { None }
    }

    pub(super) fn text(&self, id: i64) -> Option<String> {
        match self.field(id) {
            Some(Self::Binary(bytes)) => String::from_utf8(bytes.clone()).ok(),
            _ => None,
        }
    }

    pub(super) fn list(&self, id: i64) -> &[Self] {
        if let Some(Self::List(items)) = self.field(id) { items } else { &[] }
    }
}

/// Reader of values; what is beyond the end or nested too deeply gives none.
pub(super) struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Reader<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0 }
    }

    /// Number of bytes read.
    pub(super) fn position(&self) -> usize {
        self.at
    }

    fn byte(&mut self) -> Option<u8> {
        let byte = *self.bytes.get(self.at)?;
        self.at += 1;
        Some(byte)
    }

    fn varint(&mut self) -> Option<u64> {
        let mut value = 0_u64;
        for shift in (0..64).step_by(7) {
            let byte = self.byte()?;
            value |= u64::from(byte & 0x7f) << shift;
            if byte & 0x80 == 0 {
                return Some(value);
            }
        }
        None
    }

    fn int(&mut self) -> Option<i64> {
        let value = self.varint()?;
        Some((value >> 1) as i64 ^ -((value & 1) as i64))
    }

    /// A structure at the present place.
    pub(super) fn structure(&mut self) -> Option<Value> {
        self.structure_within(0)
    }

    fn structure_within(&mut self, depth: usize) -> Option<Value> {
        let (mut fields, mut id) = (Vec::new(), 0);
        loop {
            let head = self.byte()?;
            if head == 0 {
                return Some(Value::Struct(fields));
            }
            id = if head >> 4 == 0 { self.int()? } else { i64::checked_add(id, i64::from(head >> 4))? };
            fields.push((id, self.value(head & 0x0f, false, depth + 1)?));
        }
    }

    fn value(&mut self, kind: u8, in_list: bool, depth: usize) -> Option<Value> {
        if depth > MAX_DEPTH {
            return None;
        }
        Some(match kind {
            // a boolean is its type, but in a list a byte
            1 | 2 if in_list => Value::Int(i64::from(self.byte()? == 1)),
            1 | 2 => Value::Int(i64::from(kind == 1)),
            3 => Value::Int(i64::from(self.byte()?)),
            4..=I64 => Value::Int(self.int()?),
            7 => {
                self.at = self.at.checked_add(8).filter(|at| *at <= self.bytes.len())?;
                Value::Double
            }
            BINARY => {
                let length = usize::try_from(self.varint()?).ok()?;
                let end = self.at.checked_add(length)?;
                let bytes = self.bytes.get(self.at..end)?.to_vec();
                self.at = end;
                Value::Binary(bytes)
            }
            LIST | 10 => {
                let head = self.byte()?;
                let n = if head >> 4 == 15 { self.varint()? } else { u64::from(head >> 4) };
                // each item takes a byte at least
                let n = usize::try_from(n).ok().filter(|n| *n <= self.bytes.len() - self.at)?;
                Value::List((0..n).map(|_| self.value(head & 0x0f, true, depth + 1)).collect::<Option<_>>()?)
            }
            STRUCT => self.structure_within(depth)?,
            _ => return None,
        })
    }
}
