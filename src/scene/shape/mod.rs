//! The primitives as the file describes them: one file each.
//!
//! A new one is a file here that implements [`Describe`] and its name in the list in `kinds.rs`; its
//! kernels are in [`crate::primitive`], its symbol is in the window's.

mod describe;

mod disc;

mod plane;

mod sphere;

mod triangle;

mod kinds;

pub use describe::{Describe, Field, FieldValue};
pub use disc::Disc;
pub use kinds::Shape;
pub use plane::Plane;
pub use sphere::Sphere;
pub use triangle::Triangle;
