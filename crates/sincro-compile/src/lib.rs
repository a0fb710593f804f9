#![doc = include_str!("../README.md")]

mod c;
pub mod diagram;
pub mod native;
pub mod plant;
pub mod scene;

use core::fmt;

use sincro_math::record::Unrecordable;

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
