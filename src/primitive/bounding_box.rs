//! Axis-aligned bounding boxes.

use super::ray::{Ray, inverse};
use crate::simd::{Real, SimdFloat, Vec3};

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundingBox<R> {
    /// The smallest coordinates.
    pub low: Vec3<R>,
    /// The largest coordinates.
    pub high: Vec3<R>,
}

impl<R: Real> BoundingBox<R> {
    /// The empty box.
    pub fn nothing() -> Self {
        Self {
            low: Vec3::splat(R::INFINITY),
            high: Vec3::splat(-R::INFINITY),
        }
    }

    /// The box around points.
    pub fn around(points: &[Vec3<R>]) -> Self {
        points.iter().fold(Self::nothing(), |around, &point| Self {
            low: around.low.min(point),
            high: around.high.max(point),
        })
    }

    /// The box around a ball, enlarged by a few roundings.
    pub fn around_ball(center: Vec3<R>, radius: R) -> Self {
        let slack = (center.max_abs() + radius) * R::UNIT_ROUNDOFF * R::from_f64(4.0);
        let reach = Vec3::splat(radius + slack);
        Self {
            low: center - reach,
            high: center + reach,
        }
    }

    /// The union of two boxes.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    /// The box enlarged by `margin` on every side.
    #[must_use]
    pub fn widened(&self, margin: R) -> Self {
        let margin = Vec3::splat(margin);
        Self {
            low: self.low - margin,
            high: self.high + margin,
        }
    }

    /// The box moved by a vector.
    #[must_use]
    pub fn moved(&self, by: Vec3<R>) -> Self {
        Self {
            low: self.low + by,
            high: self.high + by,
        }
    }

    /// The same box, rounded to another precision.
    pub fn in_precision<S: Real>(&self) -> BoundingBox<S> {
        BoundingBox {
            low: self.low.in_precision(),
            high: self.high.in_precision(),
        }
    }

    /// The box's bounding ball: its middle and radius.
    pub fn ball(&self) -> (Vec3<R>, R) {
        let half = R::from_f64(0.5);
        let middle = self.low * half + self.high * half;
        (middle, (self.high - self.low).length() * half)
    }

    /// Returns the distance at which rays enter the box enlarged by `margin` on every side; infinity where they
    /// miss it. Not inlined, since it is long and few rays need it.
    #[inline(never)]
    pub fn entry<L: SimdFloat<Real = R>>(&self, rays: &Ray<L>, margin: L) -> L {
        L::vectorize(
            margin.token(),
            #[inline(always)]
            || {
                let slack = Vec3::splat(margin);
                let low = slack.like(self.low) - rays.origin - slack;
                let high = slack.like(self.high) - rays.origin + slack;
                let infinity = margin.like(R::INFINITY);
                let (mut near, mut far) = (margin.like(R::ZERO), infinity);
                let inverse = inverse(rays.direction);
                let axes = [
                    (low.x, high.x, inverse.x),
                    (low.y, high.y, inverse.y),
                    (low.z, high.z, inverse.z),
                ];
                for (low, high, inverse) in axes {
                    let (low, high) = (low * inverse, high * inverse);
                    near = near.max(low.min(high));
                    far = far.min(low.max(high));
                }
                L::select(near.at_most(far), near, infinity)
            },
        )
    }

    /// The largest absolute coordinate.
    pub fn max_abs(&self) -> R {
        self.low.max_abs().max(self.high.max_abs())
    }
}
