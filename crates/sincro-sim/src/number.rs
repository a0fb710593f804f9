//! Numbers that JSON cannot hold: written as null, read as NaN.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// For `#[serde(with = "number")]`: null where the number is not finite.
pub(crate) fn serialize<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    value.is_finite().then_some(*value).serialize(serializer)
}

/// For `#[serde(with = "number")]`: NaN where there is null.
pub(crate) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(deserializer)?.unwrap_or(f64::NAN))
}
