//! Color packs: the materials.

use std::fmt;
use std::ops::Deref;
use std::sync::Arc;

use glam::DVec3;
use indexmap::IndexMap;
use serde::de::{Deserializer, Error, MapAccess, Visitor};
use serde::{Deserialize, Serialize};

use super::notation;

/// Largest Phong exponent, at which a highlight is a few thousandths of a degree wide.
pub const MAX_EXPONENT: f64 = 1e9;

/// A material: colours are 0–255 per channel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ColorPack {
    /// Colour seen without any light, scaled by the scene's ambient intensity.
    #[serde(with = "notation::vector")]
    pub ambient: DVec3,
    /// Colour of diffuse reflection.
    #[serde(with = "notation::vector")]
    pub diffuse: DVec3,
    /// Colour of highlights, and of the reflection if `reflective`.
    #[serde(with = "notation::vector")]
    pub specular: DVec3,
    /// Sharpness of highlights: 0 is uniform, 16 soft, 1000 a pinpoint.
    #[serde(with = "notation::number")]
    pub phong_exponent: f64,
    /// Whether the surface mirrors the scene.
    pub reflective: bool,
}

impl ColorPack {
    /// Creates a pack of one colour, with white highlights.
    pub fn of_color(color: DVec3) -> Self {
        Self {
            ambient: color,
            diffuse: color,
            ..Self::default()
        }
    }

    /// Returns a key that is equal for equal color packs.
    pub fn key(&self) -> ([u64; 10], bool) {
        let Self {
            ambient: a,
            diffuse: d,
            specular: s,
            phong_exponent,
            reflective,
        } = self;
        let numbers = [a.x, a.y, a.z, d.x, d.y, d.z, s.x, s.y, s.z, *phong_exponent];
        // 0.0 and -0.0 are equal.
        (numbers.map(|number| (number + 0.0).to_bits()), *reflective)
    }
}

impl Default for ColorPack {
    fn default() -> Self {
        Self {
            ambient: DVec3::new(255.0, 128.0, 128.0),
            diffuse: DVec3::new(255.0, 128.0, 128.0),
            specular: DVec3::new(255.0, 255.0, 255.0),
            phong_exponent: 16.0,
            reflective: false,
        }
    }
}

/// Color packs by name, in list order. Clones share the same map.
#[derive(Clone, Debug, Serialize)]
#[serde(transparent)]
pub struct Packs(Arc<IndexMap<String, ColorPack>>);

impl Packs {
    /// Returns whether both share the same map, and so are equal; `false` does not mean that they differ.
    pub fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }

    /// Returns the map for modification, cloned first if it is shared.
    pub fn make_mut(&mut self) -> &mut IndexMap<String, ColorPack> {
        Arc::make_mut(&mut self.0)
    }
}

impl Deref for Packs {
    type Target = IndexMap<String, ColorPack>;

    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

impl From<IndexMap<String, ColorPack>> for Packs {
    fn from(packs: IndexMap<String, ColorPack>) -> Self {
        Self(Arc::new(packs))
    }
}

/// Compares the order as well, which equality of `IndexMap` ignores.
impl PartialEq for Packs {
    fn eq(&self, other: &Self) -> bool {
        self.is_same(other) || self.as_slice() == other.as_slice()
    }
}

/// Rejects duplicate names.
impl<'de> Deserialize<'de> for Packs {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(ReadPacks).map(Self::from)
    }
}

struct ReadPacks;

impl<'de> Visitor<'de> for ReadPacks {
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
