//! Arithmetic that would be true with no scene: the real number a kernel computes in, and its vectors.
//!
//! Kernels are generic over [`Real`], so that one formula serves the fast instance (`f32`) and the
//! reference (`f64`). Nothing here fuses a multiplication with an addition or uses an approximate
//! reciprocal: the same input gives the same bits on every machine.

mod highlight;
mod real;
mod vec3;

pub use highlight::Exponent;
pub use real::Real;
pub use vec3::Vec3;
