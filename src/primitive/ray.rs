//! Half-lines.

use crate::simd::{Real, SimdFloat, Vec3};

/// The smallest component of a direction; one over it is still a number in single precision.
const LEAST: f64 = 1e-30;

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

    /// How far they pass a point, seen along them.
    #[inline(always)]
    pub fn beside(&self, point: Vec3<L::Real>) -> L {
        let to = self.origin.like(point) - self.origin;
        (to - self.direction * to.dot(self.direction)).length()
    }
}

/// One over each component of directions; a large number where that is nothing.
#[inline(always)]
pub fn inverse<L: SimdFloat>(direction: Vec3<L>) -> Vec3<L> {
    Vec3::new(
        one_over(direction.x),
        one_over(direction.y),
        one_over(direction.z),
    )
}

#[inline(always)]
fn one_over<L: SimdFloat>(along: L) -> L {
    let size = along.abs().max(along.like_f64(LEAST));
    let along = L::select(along.less(along.like(L::Real::ZERO)), -size, size);
    along.like(L::Real::ONE) / along
}
