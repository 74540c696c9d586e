//! Primitives in the form that the kernels use: one file each, with its alternative formulas side by side.
//!
//! A new primitive is a file here that implements [`Primitive`], and a line in `list.rs`; its description is in
//! [`crate::scene`]. Each kernel is written once, for any real type and any number of lanes.

mod ray;

mod ball;

mod bounding_box;

mod projector;

mod blur;

mod kind;

mod sphere;

mod plane;

mod triangle;

mod disc;

mod list;

pub use ball::{Ball, CAUTION, FAR_CAUTION, roundings};
pub use blur::Blur;
pub use bounding_box::BoundingBox;
pub use disc::PackedDisc;
pub use kind::{Approach, Corner, Packing, Primitive, SurfacePoint};
pub use list::{KINDS, Kind, Packed, Prepared, Primitives, Visit, WithPrepared, WithPrimitive};
pub use plane::PackedPlane;
pub use projector::{Extent, Projector, Rectangle};
pub use ray::{Ray, inverse};
pub use sphere::{PackedSphere, Round};
pub use triangle::{CornerNormals, Culling, Curved, Flat, PackedTriangle, Slicing, Tip, Vertex};
