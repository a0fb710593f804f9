//! Values as they pass between the simulator and scripts or clients: what Lua tables, CBOR and JSON have in common.

use crate::{ApiError, Handle};

/// Value of any type, as functions called by name take and return it: what Lua tables, CBOR and JSON have in common.
#[derive(Clone, Debug, PartialEq, Default)]
pub enum Value {
    /// No value; an argument that was left out.
    #[default]
    Nil,
    /// True or false.
    Bool(bool),
    /// Whole number: a handle, state, count, bit mask.
    Int(i64),
    /// Quantity, in the SI unit that the function says.
    Real(f64),
    /// Text in UTF-8.
    Text(String),
    /// Bytes: images, packed tables, string signals that are not text.
    Bytes(Vec<u8>),
    /// List, in its order.
    List(Vec<Value>),
    /// Table with names as keys, in its order.
    Map(Vec<(String, Value)>),
    /// Table with whole numbers as keys, in its order.
    Numbered(Vec<(i64, Value)>),
}

impl Value {
    /// Creates a list of [`Value::Real`] from numbers, in their order.
    pub fn reals(list: impl IntoIterator<Item = f64>) -> Self {
        Self::List(list.into_iter().map(Self::Real).collect())
    }

    /// Creates a list of [`Value::Int`] from handles, in their order.
    pub fn handles(list: impl IntoIterator<Item = Handle>) -> Self {
        Self::List(list.into_iter().map(Self::from).collect())
    }

    /// Name of the type for error messages, with its article if it has one: `a whole number`, `text`.
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

    /// Reads the value as a number: of a truth value 0 or 1, of nil a NaN (MATLAB's JSON encodes it so); none for other
    /// types.
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

    /// Reads the value as a whole number: of a truth value 0 or 1, of a real the number if it has no fraction and is
    /// below 9·10¹⁵ in magnitude; none for other values.
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

    /// Reads the value as a truth value: numbers are true unless zero, nil is false; none for other types.
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

    /// Reads the value as text; bytes must be UTF-8. None for other types.
    #[must_use]
    pub fn as_text(&self) -> Option<&str> {
        match self {
            Self::Text(text) => Some(text),
            Self::Bytes(bytes) => std::str::from_utf8(bytes).ok(),
            _ => None,
        }
    }

    /// Reads the value as bytes, those of a text are its UTF-8; none for other types.
    #[must_use]
    pub fn as_bytes(&self) -> Option<&[u8]> {
        match self {
            Self::Text(text) => Some(text.as_bytes()),
            Self::Bytes(bytes) => Some(bytes),
            _ => None,
        }
    }

    /// Reads the value as a list of numbers, in its order, each as [`Value::as_real`] does; none if it is no list, or
    /// an entry is no number.
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

/// Positional arguments of a call by name, counted from 0; those that were not given read as nil. The accessors below
/// check their types, and their error messages count from 1.
///
/// ```
/// use sincro_values::{Arguments, Value};
///
/// let given = [Value::from(3_i64), Value::reals([0.0, 0.5, 1.0])];
/// let arguments = Arguments(&given);
/// assert_eq!((arguments.int(0)?, arguments.reals::<3>(1)?), (3, [0.0, 0.5, 1.0]));
/// assert_eq!(arguments.int_or(2, -1)?, -1);
/// assert!(arguments.text(0).unwrap_err().0.contains("argument 1 is a whole number"));
/// # Ok::<(), sincro_values::ApiError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Arguments<'a>(pub &'a [Value]);

impl<'a> Arguments<'a> {
    /// Number of arguments given.
    #[must_use]
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Returns true if no argument was given.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Returns argument `k`, counted from 0; nil if fewer were given.
    #[must_use]
    pub fn get(&self, k: usize) -> &'a Value {
        self.0.get(k).unwrap_or(&Value::Nil)
    }

    /// Returns true if argument `k`, counted from 0, was given and is not nil.
    #[must_use]
    pub fn has(&self, k: usize) -> bool {
        *self.get(k) != Value::Nil
    }

    fn wrong(&self, k: usize, expected: &str) -> ApiError {
        let found = if k < self.len() { self.get(k).word() } else { "nothing" };
        ApiError(format!("argument {} is {found}, expected {expected}", k + 1))
    }

    /// Reads argument `k`, counted from 0, as a whole number, see [`Value::as_int`].
    ///
    /// # Errors
    ///
    /// It was not given, or is no whole number.
    pub fn int(&self, k: usize) -> Result<i64, ApiError> {
        self.get(k).as_int().ok_or_else(|| self.wrong(k, "a whole number"))
    }

    /// Reads argument `k`, counted from 0, as a whole number; `default` if it was not given or is nil.
    ///
    /// # Errors
    ///
    /// It was given and is no whole number.
    pub fn int_or(&self, k: usize, default: i64) -> Result<i64, ApiError> {
        if self.has(k) { self.int(k) } else { Ok(default) }
    }

    /// Reads argument `k`, counted from 0, as a number, see [`Value::as_real`]: a given nil is NaN.
    ///
    /// # Errors
    ///
    /// It was not given, or is no number.
    pub fn real(&self, k: usize) -> Result<f64, ApiError> {
        let given = self.0.get(k).and_then(Value::as_real);
        given.ok_or_else(|| self.wrong(k, "a number"))
    }

    /// Reads argument `k`, counted from 0, as a truth value, numbers being true unless zero; `default` if it was not
    /// given or is nil.
    ///
    /// # Errors
    ///
    /// It was given and is neither a truth value nor a number.
    pub fn bool_or(&self, k: usize, default: bool) -> Result<bool, ApiError> {
        if !self.has(k) {
            return Ok(default);
        }
        self.get(k).as_bool().ok_or_else(|| self.wrong(k, "true or false"))
    }

    /// Reads argument `k`, counted from 0, as text; bytes must be UTF-8.
    ///
    /// # Errors
    ///
    /// It was not given, or is no text.
    pub fn text(&self, k: usize) -> Result<&'a str, ApiError> {
        self.get(k).as_text().ok_or_else(|| self.wrong(k, "text"))
    }

    /// Reads argument `k`, counted from 0, as bytes; those of a text are its UTF-8.
    ///
    /// # Errors
    ///
    /// It was not given, or is neither bytes nor text.
    pub fn bytes(&self, k: usize) -> Result<&'a [u8], ApiError> {
        self.get(k).as_bytes().ok_or_else(|| self.wrong(k, "bytes or text"))
    }

    /// Reads argument `k`, counted from 0, as a list of `N` numbers, in its order; further ones are left out, as
    /// CoppeliaSim does: programs give a pose where a position is expected.
    ///
    /// # Errors
    ///
    /// It was not given, is no list of numbers, or has fewer than `N`.
    pub fn reals<const N: usize>(&self, k: usize) -> Result<[f64; N], ApiError> {
        let list = self.get(k).as_reals().ok_or_else(|| self.wrong(k, &format!("a list of {N} numbers")))?;
        let n = list.len();
        let first = list.get(..N).and_then(|first| first.try_into().ok());
        first.ok_or_else(|| ApiError(format!("argument {} has {n} numbers, expected {N}", k + 1)))
    }

    /// Reads argument `k`, counted from 0, as the number of a handle, with the flags that clients may add to it
    /// (`sim.handleflag_…`).
    ///
    /// # Errors
    ///
    /// It was not given, or is no whole number of 32 bits. Whether there is such an object is not checked.
    pub fn handle(&self, k: usize) -> Result<i32, ApiError> {
        let number = match self.get(k) {
            // as V-REP 3.1.3 wrote it into older scripts
            Value::Text(text) => text.strip_prefix("@backCompatibility1:").and_then(|number| number.parse().ok()),
            other => other.as_int(),
        };
        let n = number.and_then(|n| i32::try_from(n).ok());
        n.ok_or_else(|| self.wrong(k, "a handle"))
    }
}
