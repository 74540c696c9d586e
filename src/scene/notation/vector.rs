//! A vector as `(x, y, z)`.

use glam::DVec3;
use serde::ser::SerializeTuple as _;
use serde::{Deserialize, Deserializer, Serializer};

use super::number::Number;

/// Writes the three numbers.
pub fn serialize<S: Serializer>(value: &DVec3, serializer: S) -> Result<S::Ok, S::Error> {
    let mut tuple = serializer.serialize_tuple(3)?;
    for part in value.to_array() {
        tuple.serialize_element(&Number(part))?;
    }
    tuple.end()
}

/// Reads three numbers.
pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<DVec3, D::Error> {
    <[f64; 3]>::deserialize(deserializer).map(DVec3::from)
}
