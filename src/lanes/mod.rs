//! Arithmetic that would be true with no scene: the real number a kernel computes in, and its vectors.
//!
//! Kernels are generic over [`Lane`], so that one formula serves every width of the processor, the
//! fast instance (`f32`) and the reference (`f64`). Nothing here fuses a multiplication with an addition or uses an approximate
//! reciprocal: the same input gives the same bits on every machine.

mod highlight;
mod lane;
mod level;
mod real;
mod vec3;

pub use highlight::Exponent;
pub use lane::{Lane, MOST_LANES, Mask};
pub use level::{Level, Vectored, Work};
pub use real::Real;
pub use vec3::Vec3;
