//! Signals: named values that scripts and clients leave for each other.

use std::collections::BTreeMap;

use crate::ApiError;
use crate::Value;
use crate::stored::check_name;

/// Names of one kind that may exist at once.
const MAX_NAMES: usize = 10_000;
/// Bytes of one string signal.
const MAX_BYTES: usize = 64 << 20;

/// Signals of one value type (whole numbers, reals or bytes): named values by which scripts and clients exchange data.
/// The registry holds one for each type.
///
/// ```
/// use sincro_values::Signals;
///
/// let mut floats = Signals::default();
/// floats.set("height", 0.25, false)?;
/// assert_eq!(floats.get("height"), Some(&0.25));
/// assert_eq!((floats.clear("height"), floats.get("height")), (1, None));
/// # Ok::<(), sincro_values::ApiError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Signals<T> {
    by_name: BTreeMap<String, Held<T>>,
}

#[derive(Clone, Debug)]
struct Held<T> {
    value: T,
    /// Made during a run: removed when the next one starts.
    of_run: bool,
    /// True if it was set as a buffer, which is no text even if its bytes are one.
    is_buffer: bool,
}

impl<T> Default for Signals<T> {
    fn default() -> Self {
        Self { by_name: BTreeMap::new() }
    }
}

impl<T> Signals<T> {
    /// Returns the value of a signal; none if no signal has that name.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&T> {
        self.by_name.get(name).map(|held| &held.value)
    }

    /// Sets a signal, which is created if it does not exist. With `of_run` it is removed when the next run starts.
    ///
    /// # Errors
    ///
    /// The name has more than 1,024 bytes, or there are 10,000 signals of this type already.
    pub fn set(&mut self, name: &str, value: T, of_run: bool) -> Result<(), ApiError> {
        check_name("signal", name)?;
        if self.by_name.len() >= MAX_NAMES && !self.by_name.contains_key(name) {
            return Err(ApiError(format!("there are {MAX_NAMES} signals already: clear some")));
        }
        self.by_name.insert(name.to_owned(), Held { value, of_run, is_buffer: false });
        Ok(())
    }

    /// Removes the signal of a name, or all signals of this type if `name` is empty; returns the number of those
    /// removed.
    pub fn clear(&mut self, name: &str) -> usize {
        if name.is_empty() {
            let n = self.by_name.len();
            self.by_name.clear();
            return n;
        }
        usize::from(self.by_name.remove(name).is_some())
    }

    /// Names of the signals of this type, in alphabetical order.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.by_name.keys().map(String::as_str)
    }

    /// Bytes of all names.
    #[must_use]
    pub fn names_size(&self) -> usize {
        self.by_name.keys().map(String::len).sum()
    }

    /// Forgets what the last run made.
    pub fn forget_run(&mut self) {
        self.by_name.retain(|_, held| !held.of_run);
    }
}

impl Signals<Vec<u8>> {
    /// Bytes of all of them.
    #[must_use]
    pub fn total(&self) -> usize {
        self.by_name.values().map(|held| held.value.len()).sum()
    }

    /// Sets a string signal as a buffer: it is read as bytes, whatever these are; see [`Signals::set`].
    ///
    /// # Errors
    ///
    /// As [`Signals::set`].
    pub fn set_buffer(&mut self, name: &str, bytes: Vec<u8>, of_run: bool) -> Result<(), ApiError> {
        self.set(name, bytes, of_run)?;
        if let Some(held) = self.by_name.get_mut(name) {
            held.is_buffer = true;
        }
        Ok(())
    }

    /// Value of a string signal: text, unless it was set as a buffer or its bytes are not UTF-8 or have control
    /// characters other than tabs and ends of lines, as packed numbers do; then bytes. None if there is no such signal.
    #[must_use]
    pub fn value(&self, name: &str) -> Option<Value> {
        let held = self.by_name.get(name)?;
        let is_plain = |c: char| !c.is_control() || matches!(c, '\t' | '\n' | '\r');
        let text = std::str::from_utf8(&held.value).ok().filter(|text| !held.is_buffer && text.chars().all(is_plain));
        Some(text.map_or_else(|| Value::Bytes(held.value.clone()), Value::from))
    }

    /// Appends bytes to a string signal, which is created if it does not exist; `of_run` counts only then, see
    /// [`Signals::set`].
    ///
    /// # Errors
    ///
    /// The signal would exceed 64 MiB (read and clear it), the name has more than 1,024 bytes, or there are 10,000
    /// string signals.
    pub fn append(&mut self, name: &str, bytes: &[u8], of_run: bool) -> Result<(), ApiError> {
        let Some(held) = self.by_name.get_mut(name) else { return self.set(name, bytes.to_vec(), of_run) };
        if held.value.len() + bytes.len() > MAX_BYTES {
            return Err(ApiError(format!(
                "string signal `{name}` is longer than {MAX_BYTES} bytes: read and clear it"
            )));
        }
        held.value.extend_from_slice(bytes);
        Ok(())
    }
}
