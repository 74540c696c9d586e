//! A piece of a mesh file that has a name and may have colours.

use super::triangles::Triangles;

/// What was read of a mesh file.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshFile {
    /// The parts that have triangles, of which there is at least one.
    pub parts: Vec<Part>,
    /// What of it is missing or was left out, each a part of a sentence; empty if nothing is.
    pub notes: Vec<String>,
}

impl MeshFile {
    /// One part without colours, and nothing left out.
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

/// The note that points have colours, which scenes do not have.
pub(super) const COLORS_OF_POINTS: &str = "colours of points or faces are left out";

/// The note that something is transparent, which nothing in scenes is.
pub(super) const CLEAR: &str = "transparent materials are shown opaque";
/// The note that something gives light of its own, which only lights do.
pub(super) const GLOWING: &str = "glowing materials do not glow";

/// A group or object of an OBJ file, a primitive of a glTF file; STL and PLY files are one part.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// What the file calls it, or the stem of the file's name. Several parts may have one name.
    pub name: String,
    /// Its colours, if the file has any.
    pub colors: Option<PartColors>,
    /// Its triangles, of which there is at least one.
    pub triangles: Triangles,
}

/// The colours that a file gives a part, 0–1, as a picture shows them: glTF's, which are linear
/// light, have been converted to sRGB.
#[derive(Clone, Debug, PartialEq)]
pub struct PartColors {
    /// What the file calls the material.
    pub name: String,
    /// `Kd` of MTL, or the base colour of glTF.
    pub diffuse: [f64; 3],
    /// `Ks` of MTL.
    pub specular: Option<[f64; 3]>,
    /// `Ns` of MTL: the exponent of the highlight, 0 or more.
    pub exponent: Option<f64>,
    /// Whether it mirrors, by `illum` of MTL.
    pub reflective: bool,
}
