//! A piece of a mesh file that has a name and may have colours.

use super::triangles::Triangles;

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
}
