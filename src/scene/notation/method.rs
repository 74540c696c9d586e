//! Serialization of methods by their ids.

use serde::de::Error;
use serde::{Deserialize, Deserializer, Serializer};

use crate::scene::methods::Method;

/// Writes the id.
pub fn serialize<T: Method, S: Serializer>(value: &T, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(&value.id())
}

/// Reads an id.
pub fn deserialize<'de, T: Method, D: Deserializer<'de>>(deserializer: D) -> Result<T, D::Error> {
    let word = String::deserialize(deserializer)?;
    T::parse(&word).map_err(|expected| D::Error::custom(format!("{expected}; found {word:?}")))
}
