#![doc = include_str!("../README.md")]

mod c;
mod comparison;
pub mod diagram;
#[cfg(feature = "jit")]
pub mod jit;
pub mod native;
pub mod plant;
pub mod scene;

use core::fmt;

use sincro_math::record::Unrecordable;

/// Returns true if the environment variable `SINCRO_COMPILE` is `off`: then no compiled code runs.
pub(crate) fn is_forbidden() -> bool {
    std::env::var_os("SINCRO_COMPILE").is_some_and(|value| value == "off")
}

/// Reason for which a model or a diagram cannot be compiled, in words that continue "it cannot be compiled: ".
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Obstacle(String);

impl Obstacle {
    /// Reason in words that continue "it cannot be compiled: ".
    #[must_use]
    pub fn new(reason: impl Into<String>) -> Self {
        Self(reason.into())
    }
}

impl fmt::Display for Obstacle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Obstacle {}

impl From<Unrecordable> for Obstacle {
    fn from(error: Unrecordable) -> Self {
        Self(error.0)
    }
}
