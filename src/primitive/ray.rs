//! Rays.

use crate::simd::{Real, SimdFloat, Vec3};

/// Least size of a direction's component when inverted; its reciprocal is still finite in single precision.
const LEAST: f64 = 1e-30;

/// Rays: origins and unit directions.
#[derive(Clone, Copy, Debug)]
pub struct Ray<L> {
    /// The origins.
    pub origin: Vec3<L>,
    /// The directions, of length 1.
    pub direction: Vec3<L>,
}

impl<L: SimdFloat> Ray<L> {
    /// The points at distance `t`.
    #[inline(always)]
    pub fn at(&self, t: L) -> Vec3<L> {
        self.origin + self.direction * t
    }

    /// The perpendicular distance of a point from the rays' lines.
    #[inline(always)]
    pub fn beside(&self, point: Vec3<L::Real>) -> L {
        let to = self.origin.like(point) - self.origin;
        (to - self.direction * to.dot(self.direction)).length()
    }
}

/// The reciprocal of each component; a large number for zero.
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
