//! Serialization of vectors as `(x, y, z)`.

use glam::DVec3;
use serde::de::{Error, SeqAccess, Visitor};
use serde::ser::SerializeTuple as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::number::{self, Shortest};

/// Writes the three numbers.
pub fn serialize<S: Serializer>(value: &DVec3, serializer: S) -> Result<S::Ok, S::Error> {
    let mut tuple = serializer.serialize_tuple(3)?;
    for part in value.to_array() {
        tuple.serialize_element(&Shortest(part))?;
    }
    tuple.end()
}

/// Reads three numbers.
pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<DVec3, D::Error> {
    <[f64; 3]>::deserialize(deserializer).map(DVec3::from)
}

/// Reads three numbers, or a single one for all three components.
pub fn one_or_three<'de, D: Deserializer<'de>>(deserializer: D) -> Result<DVec3, D::Error> {
    let read = deserializer.deserialize_any(NumberOrPoint("a number or three numbers"))?;
    Ok(match read {
        Value::Number(number) => DVec3::splat(number),
        Value::Point(point) => point,
    })
}

/// A number or a vector: the value of a track's key.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// An intensity.
    Number(f64),
    /// A position in world units, or a rotation in degrees.
    Point(DVec3),
}

impl Serialize for Value {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Number(value) => number::serialize(value, serializer),
            Self::Point(point) => serialize(point, serializer),
        }
    }
}

impl<'de> Deserialize<'de> for Value {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(NumberOrPoint("a number or a point such as (1, 2, 3)"))
    }
}

/// Deserializes a number or a vector. Holds the description of what is expected, for error messages.
struct NumberOrPoint(&'static str);

impl<'de> Visitor<'de> for NumberOrPoint {
    type Value = Value;

    fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.write_str(self.0)
    }

    fn visit_f64<E: Error>(self, number: f64) -> Result<Value, E> {
        Ok(Value::Number(number))
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<Value, E> {
        Ok(Value::Number(number as f64))
    }

    fn visit_u64<E: Error>(self, number: u64) -> Result<Value, E> {
        Ok(Value::Number(number as f64))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut parts: A) -> Result<Value, A::Error> {
        let mut point = [0.0; 3];
        for (index, part) in point.iter_mut().enumerate() {
            *part = parts
                .next_element()?
                .ok_or_else(|| A::Error::invalid_length(index, &self))?;
        }
        match parts.next_element::<f64>()? {
            Some(_) => Err(A::Error::invalid_length(4, &self)),
            None => Ok(Value::Point(DVec3::from(point))),
        }
    }
}
