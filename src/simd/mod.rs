//! Arithmetic that would be true with no scene: the real number a kernel computes in, and its vectors.
//!
//! Kernels are generic over [`SimdFloat`], so that one formula serves every width of the processor, the
//! fast instance (`f32`) and the reference (`f64`). Nothing here fuses a multiplication with an addition or uses an approximate
//! reciprocal: the same input gives the same bits on every machine.

mod float;

mod level;

mod vec3;

mod highlight;

pub use float::{MAX_LANES, Mask, Real, SimdFloat};
pub use highlight::Exponent;
pub use level::{Level, SimdReal, WithSimd};
pub use vec3::Vec3;
