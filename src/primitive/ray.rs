//! Half-lines.

use crate::simd::{SimdFloat, Vec3};

/// Half-lines: origins and unit directions.
#[derive(Clone, Copy, Debug)]
pub struct Ray<L> {
    /// Where they start.
    pub origin: Vec3<L>,
    /// Where they go; of length 1.
    pub direction: Vec3<L>,
}

impl<L: SimdFloat> Ray<L> {
    /// The points `t` along.
    #[inline(always)]
    pub fn at(&self, t: L) -> Vec3<L> {
        self.origin + self.direction * t
    }
}
