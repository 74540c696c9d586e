//! Contents of a mesh file: named parts, which may have colours.

use super::triangles::Triangles;

/// Contents of a mesh file.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshFile {
    /// The parts that have triangles; at least one.
    pub parts: Vec<Part>,
    /// Notes on what is missing or was left out, each a clause without a full stop; empty if the file was read
    /// completely.
    pub notes: Vec<String>,
}

impl MeshFile {
    /// A file with one part, without colours or notes.
    pub(super) fn of_one(name: String, triangles: Triangles) -> Self {
        let colors = None;
        let parts = vec![Part {
            name,
            colors,
            triangles,
        }];
        let notes = Vec::new();
        Self { parts, notes }
    }
}

/// The note on colours of points, which scenes do not support.
pub(super) const NOTE_POINT_COLORS: &str = "colours of points or faces are left out";

/// The note on transparency, which scenes do not support.
pub(super) const NOTE_TRANSPARENT: &str = "transparent materials are shown opaque";
/// The note on emissive materials, which scenes do not support: only lights emit light.
pub(super) const NOTE_EMISSIVE: &str = "glowing materials do not glow";
/// Note about textures.
pub(super) const NOTE_TEXTURES: &str = "its textures are left out";

/// A group or object of an OBJ file, a primitive of a glTF file, or the whole of an STL or PLY file.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// The name in the file, or else the stem of the file name. Not unique.
    pub name: String,
    /// Its colours, if the file has any.
    pub colors: Option<PartColors>,
    /// Its triangles; at least one.
    pub triangles: Triangles,
}

/// The colours that a file gives a part, 0–1 and encoded for display: the linear colours of glTF have been converted
/// to sRGB.
#[derive(Clone, Debug, PartialEq)]
pub struct PartColors {
    /// The name of the material in the file.
    pub name: String,
    /// `Kd` of MTL, or the base colour of glTF.
    pub diffuse: [f64; 3],
    /// `Ks` of MTL.
    pub specular: Option<[f64; 3]>,
    /// `Ns` of MTL: the exponent of the highlight, 0 or more.
    pub exponent: Option<f64>,
    /// Whether it is a mirror, from `illum` of MTL.
    pub reflective: bool,
}
