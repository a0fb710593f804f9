//! Data that clients and scripts store with objects, the scene and the application: bytes, texts and packed values
//! under tags, which all functions share.

use crate::{ApiError, Value, cbor, unpack};

/// Bytes of the longest name: of a signal, a tag, a tube, a parameter.
const MAX_NAME: usize = 1_024;

/// Form of stored data: what the function that wrote them was given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Plain bytes.
    Bytes,
    /// Text.
    Text,
    /// Any other value, in CBOR.
    Packed,
}

/// Data under a tag.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stored {
    /// Form of the bytes.
    pub form: Form,
    /// The bytes; of a text, its UTF-8.
    pub bytes: Vec<u8>,
}

impl Stored {
    /// The form in which a value is stored.
    #[must_use]
    pub fn from_value(value: &Value) -> Self {
        match value {
            Value::Bytes(bytes) => Self { form: Form::Bytes, bytes: bytes.clone() },
            Value::Text(text) => Self { form: Form::Text, bytes: text.clone().into_bytes() },
            other => {
                let mut bytes = Vec::new();
                cbor::encode(other, &mut bytes);
                Self { form: Form::Packed, bytes }
            }
        }
    }

    /// The value that was stored.
    ///
    /// # Errors
    ///
    /// The bytes are not of their form.
    pub fn value(&self) -> Result<Value, ApiError> {
        match self.form {
            Form::Bytes => Ok(Value::Bytes(self.bytes.clone())),
            Form::Text => self.text().map(Value::Text),
            Form::Packed => self.unpacked(),
        }
    }

    /// The data as text.
    ///
    /// # Errors
    ///
    /// They are none.
    pub fn text(&self) -> Result<String, ApiError> {
        let wrong = || ApiError::new("these data are no text: read them as a buffer");
        if self.form == Form::Packed {
            return Err(wrong());
        }
        String::from_utf8(self.bytes.clone()).map_err(|_| wrong())
    }

    /// The data as a table: what was stored as one, or bytes that `sim.packTable` gave.
    ///
    /// # Errors
    ///
    /// They are none.
    pub fn table(&self) -> Result<Value, ApiError> {
        match self.unpacked()? {
            table @ (Value::List(_) | Value::Map(_) | Value::Numbered(_)) => Ok(table),
            other => Err(ApiError(format!("these data are {}, no table: read them as that", other.word()))),
        }
    }

    fn unpacked(&self) -> Result<Value, ApiError> {
        unpack::read(&self.bytes).map_err(ApiError)
    }
}

/// Checks that a name of a signal, tag, tube or parameter is short enough to be kept; `what` says in the message what
/// it is the name of.
///
/// # Errors
///
/// The name has more than 1,024 bytes.
pub fn check_name(what: &str, name: &str) -> Result<(), ApiError> {
    if name.len() > MAX_NAME {
        let start: String = name.chars().take(30).collect();
        let n = name.len();
        return Err(ApiError(format!(
            "the name of a {what} has {n} bytes (`{start}…`), more than {MAX_NAME}: shorten it"
        )));
    }
    Ok(())
}

/// Refuses tags that are too long or contain a zero byte.
///
/// # Errors
///
/// It is such a tag.
pub fn check_tag(tag: &str) -> Result<(), ApiError> {
    check_name("block of data", tag)?;
    if tag.contains('\0') {
        return Err(ApiError::new("the name of a block of data contains a zero byte: leave it out"));
    }
    Ok(())
}
