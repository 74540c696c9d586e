//! What is in a scene: objects and lights.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::notation;
use super::shape::Shape;

/// A named shape with a material.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Object {
    /// Unique name, shown in the outliner.
    pub name: String,
    /// Name of its material in [`super::Scene::color_packs`].
    pub color_pack: String,
    /// Where and what it is.
    pub shape: Shape,
    /// An invisible object is not in the picture at all: no shadow, no reflection.
    #[serde(default = "yes", skip_serializing_if = "is_true")]
    pub visible: bool,
    /// Name of the group that it is listed in; empty for none.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub group: String,
}

impl Object {
    /// A visible object in no group.
    pub fn new(
        name: impl Into<String>,
        color_pack: impl Into<String>,
        shape: impl Into<Shape>,
    ) -> Self {
        Self {
            name: name.into(),
            color_pack: color_pack.into(),
            shape: shape.into(),
            visible: true,
            group: String::new(),
        }
    }

    /// Whether it is a mesh whose faces are shaded as one curved surface.
    pub fn is_smooth(&self) -> bool {
        matches!(&self.shape, Shape::Mesh(mesh) if mesh.smooth > 0.0)
    }

    /// How many triangles it has, if it is a mesh.
    pub fn faces(&self) -> usize {
        match &self.shape {
            Shape::Mesh(mesh) => mesh.source.triangles().faces().len(),
            _ => 0,
        }
    }
}

/// A point light that does not fall off with distance.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Light {
    /// Unique name, shown in the outliner.
    pub name: String,
    /// Where it shines from.
    #[serde(with = "notation::vector")]
    pub position: DVec3,
    /// Brightness, 0–1.
    #[serde(default = "default_intensity", with = "notation::number")]
    pub intensity: f64,
    /// What shows where the light is, if anything does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub marker: Option<LightObj>,
    /// An invisible light is switched off, marker included.
    #[serde(default = "yes", skip_serializing_if = "is_true")]
    pub visible: bool,
}

/// The marker of a light: a sphere in the full ambient colour of its pack that casts no shadow.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct LightObj {
    /// Radius in world units, > 0.
    #[serde(with = "notation::number")]
    pub radius: f64,
    /// Name of its material in [`super::Scene::color_packs`].
    pub color_pack: String,
}

impl Default for LightObj {
    fn default() -> Self {
        Self {
            radius: 5.0,
            color_pack: "light".to_owned(),
        }
    }
}

/// Brightness of a light that a file says nothing about.
pub fn default_intensity() -> f64 {
    0.2
}

/// What most switches are.
pub fn yes() -> bool {
    true
}

#[expect(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde asks with a reference"
)]
fn is_true(value: &bool) -> bool {
    *value
}
