//! Objects and lights of a scene.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::list::List;
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
    /// Geometry, including position, size and orientation.
    pub shape: Shape,
    /// If false, the object is excluded from the picture entirely: it casts no shadow and has no reflection.
    #[serde(default = "default_true", skip_serializing_if = "is_true")]
    pub visible: bool,
    /// Name of the group that the outliner lists it in; empty for none.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub group: String,
}

impl Object {
    /// Creates a visible object in no group.
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

    /// Returns whether the object is a mesh whose faces are shaded as one curved surface.
    pub fn is_smooth(&self) -> bool {
        matches!(&self.shape, Shape::Mesh(mesh) if mesh.smooth > 0.0)
    }

    /// The number of triangles of a mesh; 0 for all other shapes.
    pub fn faces(&self) -> usize {
        match &self.shape {
            Shape::Mesh(mesh) => mesh.source.triangles().faces().len(),
            _ => 0,
        }
    }
}

impl List<Object> {
    /// Iterates over the visible objects with their indices.
    pub fn visible(&self) -> impl Iterator<Item = (usize, &Object)> + Clone {
        let objects = self.iter().enumerate();
        objects.filter(|(_, object)| object.visible)
    }
}

/// A point light that does not fall off with distance.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Light {
    /// Unique name, shown in the outliner.
    pub name: String,
    /// Position in world units.
    #[serde(with = "notation::vector")]
    pub position: DVec3,
    /// Brightness, 0–1.
    #[serde(default = "default_intensity", with = "notation::number")]
    pub intensity: f64,
    /// Sphere drawn at the position of the light, if any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub marker: Option<LightObj>,
    /// If false, the light is switched off and its marker is hidden.
    #[serde(default = "default_true", skip_serializing_if = "is_true")]
    pub visible: bool,
}

/// The marker of a light: a sphere that shows the full ambient colour of its color pack and casts no shadow.
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

/// Brightness of a light whose intensity the file leaves out.
pub fn default_intensity() -> f64 {
    0.2
}

/// Default of the boolean fields that are on unless the file says otherwise.
pub fn default_true() -> bool {
    true
}

#[expect(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde asks with a reference"
)]
fn is_true(value: &bool) -> bool {
    *value
}
