//! The primitive shapes of the scene file, one module each.
//!
//! A new shape needs a file here that implements [`Describe`] and a line in the list in `kinds.rs`; a file and a
//! line in [`crate::primitive`], which has the kernels; a symbol in the user interface's `icons.rs`; and what the
//! compiler then asks for.

mod plane_piece;

mod angles;

mod describe;

mod disc;

mod mesh_source;

mod mesh;

mod plane;

mod sphere;

mod triangle;

mod kinds;

pub use angles::rotations_between;
pub use describe::{Describe, Property, PropertyValue};
pub use disc::Disc;
pub use kinds::Shape;
pub use mesh::Mesh;
pub use mesh_source::{MeshFiles, MeshSource, unshared_triangle_bytes};
pub use plane::Plane;
pub use plane_piece::{Outline, PlanePiece};
pub use sphere::Sphere;
pub use triangle::Triangle;
