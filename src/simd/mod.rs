//! Arithmetic that knows nothing of scenes: the real number types that kernels compute in, and their vectors.
//!
//! Kernels are generic over [`SimdFloat`], so that one formula serves every vector width, the fast version (`f32`)
//! and the reference (`f64`). Nothing here fuses a multiplication with an addition or uses an approximate
//! reciprocal: the same input gives the same bits on every machine.

mod float;

mod level;

mod vec3;

mod highlight;

pub use float::{MAX_LANES, Mask, Real, SimdFloat};
pub use highlight::Exponent;
pub use level::{Level, SimdReal, WithSimd};
pub use vec3::Vec3;
