//! Error of a function of the API.

use std::fmt;

/// Error of a call of the API: a message of one line, which adapters hand to the client or script that called; it names
/// the object or argument and, where possible, the remedy. The call has changed nothing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ApiError(pub String);

impl ApiError {
    /// Creates an error with a message in lower case and without a full stop.
    #[must_use]
    pub fn new(message: impl Into<String>) -> Self {
        Self(message.into())
    }
}

impl fmt::Display for ApiError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for ApiError {}
