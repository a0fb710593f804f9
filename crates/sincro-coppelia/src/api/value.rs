//! Values as they pass between the simulator and scripts or clients: what Lua tables, CBOR and JSON have in common.

use super::{ApiError, Handle};

/// A value of any kind.
#[derive(Clone, Debug, PartialEq, Default)]
pub enum Value {
    /// Nothing.
    #[default]
    Nil,
    /// True or false.
    Bool(bool),
    /// A handle, state, count, or other whole number.
    Int(i64),
    /// A quantity.
    Real(f64),
    /// Text.
    Text(String),
    /// Bytes: images, packed tables, string signals that are not text.
    Bytes(Vec<u8>),
    /// A list.
    List(Vec<Value>),
    /// A table with names, in its order.
    Map(Vec<(String, Value)>),
    /// A table with whole numbers as keys, in its order.
    Numbered(Vec<(i64, Value)>),
}

impl Value {
    /// Argument `k` as a list of exactly `N` numbers.
    pub fn reals(list: impl IntoIterator<Item = f64>) -> Self {
        Self::List(list.into_iter().map(Self::Real).collect())
    }

    /// A list of handles.
    pub fn handles(list: impl IntoIterator<Item = Handle>) -> Self {
        Self::List(list.into_iter().map(Self::from).collect())
    }

    /// The word for its kind.
    #[must_use]
    pub fn word(&self) -> &'static str {
        match self {
            Self::Nil => "nil",
            Self::Bool(_) => "a truth value",
            Self::Int(_) => "a whole number",
            Self::Real(_) => "a number",
            Self::Text(_) => "text",
            Self::Bytes(_) => "bytes",
            Self::List(_) => "a list",
            Self::Map(_) | Self::Numbered(_) => "a map",
        }
    }

    /// Value as a number; nil is not a number (MATLAB's encoding of NaN), none for other kinds.
    #[must_use]
    pub fn as_real(&self) -> Option<f64> {
        match *self {
            Self::Int(x) => Some(x as f64),
            Self::Real(x) => Some(x),
            Self::Bool(x) => Some(f64::from(u8::from(x))),
            Self::Nil => Some(f64::NAN),
            _ => None,
        }
    }

    /// Value as a whole number; a number without fraction will do, none for other kinds.
    #[must_use]
    pub fn as_int(&self) -> Option<i64> {
        match *self {
            Self::Int(x) => Some(x),
            Self::Bool(x) => Some(i64::from(x)),
            // beyond 2^53 not every whole number is one of these
            Self::Real(x) if x.fract() == 0.0 && x.abs() < 9e15 => Some(x as i64),
            _ => None,
        }
    }

    /// Value as truth: numbers are true unless zero, none for other kinds.
    #[must_use]
    pub fn as_bool(&self) -> Option<bool> {
        match *self {
            Self::Bool(x) => Some(x),
            Self::Nil => Some(false),
            Self::Int(x) => Some(x != 0),
            Self::Real(x) => Some(x != 0.0),
            _ => None,
        }
    }

    /// Value as text; bytes must be UTF-8, none for other kinds.
    #[must_use]
    pub fn as_text(&self) -> Option<&str> {
        match self {
            Self::Text(text) => Some(text),
            Self::Bytes(bytes) => std::str::from_utf8(bytes).ok(),
            _ => None,
        }
    }

    /// Value as bytes; that of a text is its UTF-8, none for other kinds.
    #[must_use]
    pub fn as_bytes(&self) -> Option<&[u8]> {
        match self {
            Self::Text(text) => Some(text.as_bytes()),
            Self::Bytes(bytes) => Some(bytes),
            _ => None,
        }
    }

    /// Value as a list of numbers; none if it is no list, or any entry is no number.
    #[must_use]
    pub fn as_reals(&self) -> Option<Vec<f64>> {
        let Self::List(list) = self else { return None };
        list.iter().map(Self::as_real).collect()
    }
}

impl From<Handle> for Value {
    fn from(handle: Handle) -> Self {
        Self::Int(handle.0.into())
    }
}

impl From<bool> for Value {
    fn from(x: bool) -> Self {
        Self::Bool(x)
    }
}

impl From<i64> for Value {
    fn from(x: i64) -> Self {
        Self::Int(x)
    }
}

impl From<f64> for Value {
    fn from(x: f64) -> Self {
        Self::Real(x)
    }
}

impl From<String> for Value {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl From<Vec<u8>> for Value {
    fn from(bytes: Vec<u8>) -> Self {
        Self::Bytes(bytes)
    }
}

impl From<&str> for Value {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

/// Positional arguments of a call; what is not given is nil.
#[derive(Clone, Copy, Debug)]
pub struct Arguments<'a>(pub &'a [Value]);

impl<'a> Arguments<'a> {
    /// Number of arguments.
    #[must_use]
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Returns true if none was given.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Argument `k`, from 0.
    #[must_use]
    pub fn get(&self, k: usize) -> &'a Value {
        self.0.get(k).unwrap_or(&Value::Nil)
    }

    /// Returns true if argument `k` was given and is not nil.
    #[must_use]
    pub fn has(&self, k: usize) -> bool {
        *self.get(k) != Value::Nil
    }

    fn wrong(&self, k: usize, expected: &str) -> ApiError {
        let found = if k < self.len() { self.get(k).word() } else { "nothing" };
        ApiError(format!("argument {} is {found}, expected {expected}", k + 1))
    }

    /// Argument `k` as a whole number.
    ///
    /// # Errors
    ///
    /// Something else was given, or nothing.
    pub fn int(&self, k: usize) -> Result<i64, ApiError> {
        self.get(k).as_int().ok_or_else(|| self.wrong(k, "a whole number"))
    }

    /// A whole number, or `default` if nothing was given.
    ///
    /// # Errors
    ///
    /// Something else was given.
    pub fn int_or(&self, k: usize, default: i64) -> Result<i64, ApiError> {
        if self.has(k) { self.int(k) } else { Ok(default) }
    }

    /// Argument `k` as a number; nil in a given place is not a number.
    ///
    /// # Errors
    ///
    /// Something else was given, or nothing.
    pub fn real(&self, k: usize) -> Result<f64, ApiError> {
        let given = self.0.get(k).and_then(Value::as_real);
        given.ok_or_else(|| self.wrong(k, "a number"))
    }

    /// True or false; numbers are true unless zero, nothing is `default`.
    ///
    /// # Errors
    ///
    /// Something else was given.
    pub fn bool_or(&self, k: usize, default: bool) -> Result<bool, ApiError> {
        if !self.has(k) {
            return Ok(default);
        }
        self.get(k).as_bool().ok_or_else(|| self.wrong(k, "true or false"))
    }

    /// Argument `k` as a text.
    ///
    /// # Errors
    ///
    /// Something else was given, or nothing.
    pub fn text(&self, k: usize) -> Result<&'a str, ApiError> {
        self.get(k).as_text().ok_or_else(|| self.wrong(k, "text"))
    }

    /// Argument `k` as bytes; a text will do.
    ///
    /// # Errors
    ///
    /// Something else was given, or nothing.
    pub fn bytes(&self, k: usize) -> Result<&'a [u8], ApiError> {
        self.get(k).as_bytes().ok_or_else(|| self.wrong(k, "bytes or text"))
    }

    /// `N` numbers.
    ///
    /// # Errors
    ///
    /// Something else was given, or another number of them.
    pub fn reals<const N: usize>(&self, k: usize) -> Result<[f64; N], ApiError> {
        let list = self.get(k).as_reals().ok_or_else(|| self.wrong(k, &format!("a list of {N} numbers")))?;
        let n = list.len();
        list.try_into().map_err(|_| ApiError(format!("argument {} has {n} numbers, expected {N}", k + 1)))
    }

    /// A handle as it was given, flags included.
    ///
    /// # Errors
    ///
    /// Something else was given, or nothing.
    pub fn handle(&self, k: usize) -> Result<i32, ApiError> {
        let n = self.get(k).as_int().and_then(|n| i32::try_from(n).ok());
        n.ok_or_else(|| self.wrong(k, "a handle"))
    }
}
