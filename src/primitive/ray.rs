//! Rays.

use crate::simd::{Real, SimdFloat, Vec3};

/// Least size of a direction's component when inverted; its reciprocal is still finite in single precision.
const MIN_COMPONENT: f64 = 1e-30;

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
    pub fn distance_to(&self, point: Vec3<L::Real>) -> L {
        let to_point = self.origin.like(point) - self.origin;
        (to_point - self.direction * to_point.dot(self.direction)).length()
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
fn one_over<L: SimdFloat>(component: L) -> L {
    let size = component.abs().max(component.like_f64(MIN_COMPONENT));
    let component = L::select(component.less(component.like(L::Real::ZERO)), -size, size);
    component.like(L::Real::ONE) / component
}
