//! A vector as `(x, y, z)`.

use glam::DVec3;
use serde::de::{Error, SeqAccess, Visitor};
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

/// Reads three numbers, or one for all three.
pub fn one_or_three<'de, D: Deserializer<'de>>(deserializer: D) -> Result<DVec3, D::Error> {
    deserializer.deserialize_any(OneOrThree)
}

struct OneOrThree;

impl<'de> Visitor<'de> for OneOrThree {
    type Value = DVec3;

    fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.write_str("a number or three numbers")
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<DVec3, E> {
        Ok(DVec3::splat(value))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<DVec3, E> {
        Ok(DVec3::splat(value as f64))
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<DVec3, E> {
        Ok(DVec3::splat(value as f64))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut values: A) -> Result<DVec3, A::Error> {
        let mut next = |index| {
            let value = values.next_element()?;
            value.ok_or_else(|| Error::invalid_length(index, &self))
        };
        Ok(DVec3::new(next(0)?, next(1)?, next(2)?))
    }
}
