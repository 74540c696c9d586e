//! Serialization of numbers in the shortest form that reads back exactly: `175` rather than `175.0`.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Whole numbers below this are written without a decimal point; every one of them is exact in `f64`.
const MAX_PLAIN: f64 = 1e15;

/// Writes `value`.
#[expect(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde asks with a reference"
)]
pub fn serialize<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    let is_plain = value.fract() == 0.0 && value.abs() < MAX_PLAIN;
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

/// A number that is serialized in this form.
pub struct Shortest(pub f64);

impl Serialize for Shortest {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serialize(&self.0, serializer)
    }
}
