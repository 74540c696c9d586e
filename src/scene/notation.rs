//! How numbers, vectors and pack lists are written in the file: `175` rather than `175.0`, vectors
//! as `(x, y, z)`, and no pack twice.

use std::fmt;

use indexmap::IndexMap;
use serde::de::{Deserialize, Deserializer, Error, MapAccess, Visitor};
use serde::ser::{Serialize, SerializeTuple, Serializer};

use glam::DVec3;

use super::ColorPack;

/// Whole numbers below this are written without a decimal point; every one of them is exact in `f64`.
const LARGEST_PLAIN: f64 = 1e15;

/// One number in its shortest form that reads back as the same bits.
pub mod number {
    use super::{Deserialize, Deserializer, LARGEST_PLAIN, Serializer};

    /// Writes `value`.
    #[expect(
        clippy::trivially_copy_pass_by_ref,
        reason = "serde asks with a reference"
    )]
    pub fn serialize<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
        let is_plain = value.fract() == 0.0 && value.abs() < LARGEST_PLAIN;
        if is_plain && (*value != 0.0 || value.is_sign_positive()) {
            serializer.serialize_i64(*value as i64)
        } else {
            serializer.serialize_f64(*value)
        }
    }

    /// Reads a number, with or without a decimal point.
    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
        f64::deserialize(deserializer)
    }
}

/// A choice by its word.
pub mod word {
    use super::{Deserialize, Deserializer, Error, Serializer};
    use crate::scene::Method;

    /// Writes the word.
    pub fn serialize<T: Method, S: Serializer>(
        value: &T,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&value.id())
    }

    /// Reads a word.
    pub fn deserialize<'de, T: Method, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<T, D::Error> {
        let word = String::deserialize(deserializer)?;
        T::parse(&word).map_err(|expected| D::Error::custom(format!("{expected}; found {word:?}")))
    }
}

/// Whether a value need not be written.
pub fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// The shortest text that reads back as `value`, without `.0` on whole numbers.
pub fn format_number(value: f64) -> String {
    format!("{value}")
}

/// Reads `1, 2, 3`, `(1, 2, 3)` or `1 2 3`; `None` if that is not three finite numbers.
pub fn parse_vec3(text: &str) -> Option<DVec3> {
    let inner = text
        .trim()
        .trim_start_matches(['(', '['])
        .trim_end_matches([')', ']']);
    let numbers: Option<Vec<f64>> = inner
        .split([',', ' ', ';', '\t'])
        .filter(|part| !part.is_empty())
        .map(|part| part.parse().ok().filter(|number: &f64| number.is_finite()))
        .collect();
    <[f64; 3]>::try_from(numbers?).ok().map(DVec3::from)
}

struct Number(f64);

impl Serialize for Number {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        number::serialize(&self.0, serializer)
    }
}

/// A vector as `(x, y, z)`.
pub mod vector {
    use super::{DVec3, Deserialize, Deserializer, Number, SerializeTuple as _, Serializer};

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
}

/// Reads the map of colour packs, refusing a name that comes twice.
pub fn packs<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<IndexMap<String, ColorPack>, D::Error> {
    deserializer.deserialize_map(Packs)
}

struct Packs;

impl<'de> Visitor<'de> for Packs {
    type Value = IndexMap<String, ColorPack>;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a map from names to ColorPack")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
        let mut packs = IndexMap::new();
        while let Some(name) = map.next_key::<String>()? {
            if packs.contains_key(&name) {
                return Err(A::Error::custom(format!(
                    "there is another color pack named {name:?}"
                )));
            }
            packs.insert(name, map.next_value()?);
        }
        Ok(packs)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_are_pasted_in_many_ways() {
        for text in ["1, 2, -3.5", "(1,2,-3.5)", " 1 2 -3.5 ", "[1; 2; -3.5]"] {
            assert_eq!(parse_vec3(text), Some(DVec3::new(1.0, 2.0, -3.5)), "{text}");
        }
        for text in ["", "1, 2", "1, 2, 3, 4", "1, x, 3", "1, inf, 3"] {
            assert_eq!(parse_vec3(text), None, "{text}");
        }
    }
}
