//! Maps that are given to functions and given back: what they must have, in words where they have not.

use crate::{ApiError, Value};

/// A map by its names, in its order.
#[derive(Clone, Debug, Default)]
pub struct Fields(Vec<(String, Value)>);

impl Fields {
    /// Fields of an argument.
    ///
    /// # Errors
    ///
    /// If it is no map.
    pub fn of(value: &Value) -> Result<Self, ApiError> {
        match value {
            Value::Map(list) => Ok(Self(list.clone())),
            Value::List(list) if list.is_empty() => Ok(Self::default()),
            other => Err(ApiError(format!("argument 1 is {}, expected a map of parameters", other.word()))),
        }
    }

    /// The map as a value.
    #[must_use]
    pub fn into_value(self) -> Value {
        Value::Map(self.0)
    }

    /// A field, nil if it is not there.
    #[must_use]
    pub fn get(&self, name: &str) -> &Value {
        self.0.iter().find(|(key, _)| key == name).map_or(&Value::Nil, |(_, value)| value)
    }

    /// Returns true if it is there and not nil.
    #[must_use]
    pub fn has(&self, name: &str) -> bool {
        *self.get(name) != Value::Nil
    }

    /// Sets a field, new ones after the others.
    pub fn set(&mut self, name: &str, value: impl Into<Value>) {
        let value = value.into();
        match self.0.iter_mut().find(|(key, _)| key == name) {
            Some((_, old)) => *old = value,
            None => self.0.push((name.to_owned(), value)),
        }
    }

    /// Sets a field to a list of numbers.
    pub fn set_list(&mut self, name: &str, numbers: impl IntoIterator<Item = f64>) {
        self.set(name, Value::reals(numbers));
    }

    fn wrong(&self, name: &str, expected: &str) -> ApiError {
        if self.has(name) {
            let found = self.get(name);
            let found = match found {
                Value::List(list) => format!("a list of {}", list.len()),
                other => other.word().to_owned(),
            };
            ApiError(format!("`{name}` is {found}, expected {expected}"))
        } else {
            ApiError(format!("`{name}` is missing, expected {expected}"))
        }
    }

    /// A whole number.
    ///
    /// # Errors
    ///
    /// If it is missing or something else.
    pub fn int(&self, name: &str) -> Result<i64, ApiError> {
        self.get(name).as_int().ok_or_else(|| self.wrong(name, "a whole number"))
    }

    /// A whole number, `default` if it is missing.
    ///
    /// # Errors
    ///
    /// If it is something else.
    pub fn int_or(&self, name: &str, default: i64) -> Result<i64, ApiError> {
        if self.has(name) { self.int(name) } else { Ok(default) }
    }

    /// A handle.
    ///
    /// # Errors
    ///
    /// If it is missing or something else.
    pub fn handle(&self, name: &str) -> Result<i32, ApiError> {
        let handle = self.get(name).as_int().and_then(|n| i32::try_from(n).ok());
        handle.ok_or_else(|| self.wrong(name, "a handle"))
    }

    /// A number, `default` if it is missing.
    ///
    /// # Errors
    ///
    /// If it is something else.
    pub fn real_or(&self, name: &str, default: f64) -> Result<f64, ApiError> {
        if !self.has(name) {
            return Ok(default);
        }
        self.get(name).as_real().ok_or_else(|| self.wrong(name, "a number"))
    }

    /// A truth value, `default` if it is missing.
    ///
    /// # Errors
    ///
    /// If it is something else.
    pub fn bool_or(&self, name: &str, default: bool) -> Result<bool, ApiError> {
        if !self.has(name) {
            return Ok(default);
        }
        self.get(name).as_bool().ok_or_else(|| self.wrong(name, "true or false"))
    }

    /// A list of `n` numbers; of more, the first, if the function always took them so.
    ///
    /// # Errors
    ///
    /// If it is missing or something else.
    pub fn numbers(&self, name: &str, n: usize) -> Result<Vec<f64>, ApiError> {
        let is_tolerant = self.has("tolerantArgs");
        let list = self.get(name).as_reals().filter(|list| list.len() == n || (is_tolerant && list.len() > n));
        let mut list = list.ok_or_else(|| self.wrong(name, &format!("a list of {}", counted(n))))?;
        list.truncate(n);
        Ok(list)
    }

    /// The same, all alike if one number is given, and `default` if none is.
    ///
    /// # Errors
    ///
    /// If it is something else.
    pub fn each(&self, name: &str, n: usize, default: impl FnOnce() -> Vec<f64>) -> Result<Vec<f64>, ApiError> {
        match self.get(name) {
            Value::Nil => Ok(default()),
            Value::List(_) => self.numbers(name, n),
            other => match other.as_real() {
                Some(x) => Ok(vec![x; n]),
                None => Err(self.wrong(name, &format!("a number, or a list of {}", counted(n)))),
            },
        }
    }
}

fn counted(n: usize) -> String {
    if n == 1 { "one number".into() } else { format!("{n} numbers") }
}
