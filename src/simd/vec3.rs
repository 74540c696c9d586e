//! Three real numbers: a point, a direction or a linear colour.

use std::ops::{Add, Mul, Neg, Sub};

use glam::DVec3;

use super::{Real, SimdFloat};

/// Three real numbers in the order x, y, z (or red, green, blue).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vec3<R> {
    /// First component: right, or red.
    pub x: R,
    /// Second component: up, or green.
    pub y: R,
    /// Third component: towards the viewer, or blue.
    pub z: R,
}

impl<R> Vec3<R> {
    /// The vector (x, y, z).
    #[inline(always)]
    pub const fn new(x: R, y: R, z: R) -> Self {
        Self { x, y, z }
    }
}

impl<T> Vec3<T> {
    /// Applies `change` to each component.
    pub fn map<U>(self, change: impl Fn(T) -> U) -> Vec3<U> {
        Vec3::new(change(self.x), change(self.y), change(self.z))
    }
}

impl<L: SimdFloat> Vec3<L> {
    /// The same vector in every lane.
    #[inline(always)]
    pub fn broadcast(token: L::Token, v: Vec3<L::Real>) -> Self {
        Self::new(
            L::splat(token, v.x),
            L::splat(token, v.y),
            L::splat(token, v.z),
        )
    }

    /// Broadcasts a vector to as many lanes as this one has.
    #[inline(always)]
    pub fn like(self, v: Vec3<L::Real>) -> Self {
        Self::broadcast(self.x.token(), v)
    }

    /// The same number three times.
    #[inline(always)]
    pub fn splat(value: L) -> Self {
        Self::new(value, value, value)
    }

    /// The vector in one lane.
    #[inline(always)]
    pub fn lane(self, index: usize) -> Vec3<L::Real> {
        Vec3::new(self.x.lane(index), self.y.lane(index), self.z.lane(index))
    }

    /// `yes` where the mask is set, `no` elsewhere.
    #[inline(always)]
    pub fn select(mask: L::Mask, yes: Self, no: Self) -> Self {
        Self::new(
            L::select(mask, yes.x, no.x),
            L::select(mask, yes.y, no.y),
            L::select(mask, yes.z, no.z),
        )
    }

    /// Scalar product.
    #[inline(always)]
    pub fn dot(self, other: Self) -> L {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// Vector product.
    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        Self::new(
            self.y * other.z - self.z * other.y,
            self.z * other.x - self.x * other.z,
            self.x * other.y - self.y * other.x,
        )
    }

    /// Component-wise product, as when a coloured surface filters light.
    #[inline(always)]
    pub fn filter(self, other: Self) -> Self {
        Self::new(self.x * other.x, self.y * other.y, self.z * other.z)
    }

    /// Euclidean length.
    #[inline(always)]
    pub fn length(self) -> L {
        self.dot(self).sqrt()
    }

    /// The component-wise minimum.
    #[inline(always)]
    pub fn min(self, other: Self) -> Self {
        Self::new(
            self.x.min(other.x),
            self.y.min(other.y),
            self.z.min(other.z),
        )
    }

    /// The component-wise maximum.
    #[inline(always)]
    pub fn max(self, other: Self) -> Self {
        Self::new(
            self.x.max(other.x),
            self.y.max(other.y),
            self.z.max(other.z),
        )
    }

    /// The largest magnitude among the components.
    #[inline(always)]
    pub fn max_abs(self) -> L {
        self.x.abs().max(self.y.abs()).max(self.z.abs())
    }

    /// Clamps every component to `floor` and `ceiling`; NaN becomes `floor`.
    #[inline(always)]
    pub fn clamp(self, floor: L, ceiling: L) -> Self {
        self.max(Self::splat(floor)).min(Self::splat(ceiling))
    }

    /// The components in order.
    #[inline(always)]
    pub fn to_array(self) -> [L; 3] {
        [self.x, self.y, self.z]
    }
}

impl<R: Real> Vec3<R> {
    /// Narrows (or copies) a double-precision vector.
    #[inline(always)]
    pub fn from_dvec3(v: DVec3) -> Self {
        Self::new(R::from_f64(v.x), R::from_f64(v.y), R::from_f64(v.z))
    }

    /// The same vector in double precision (exact).
    #[inline(always)]
    pub fn to_dvec3(self) -> DVec3 {
        DVec3::new(self.x.to_f64(), self.y.to_f64(), self.z.to_f64())
    }

    /// The same vector, rounded to another precision.
    #[inline(always)]
    pub fn in_precision<S: Real>(self) -> Vec3<S> {
        Vec3::from_dvec3(self.to_dvec3())
    }

    /// The vector of length 1 in this direction, or `None` where there is no direction (zero, NaN or infinite).
    #[inline(always)]
    pub fn try_normalize(self) -> Option<Self> {
        let length = self.length();
        (length > R::ZERO && length < R::INFINITY).then(|| self * (R::ONE / length))
    }
}

impl<R> From<[R; 3]> for Vec3<R> {
    fn from([x, y, z]: [R; 3]) -> Self {
        Self { x, y, z }
    }
}

impl<L: SimdFloat> Add for Vec3<L> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y, self.z + other.z)
    }
}

impl<L: SimdFloat> Sub for Vec3<L> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y, self.z - other.z)
    }
}

impl<L: SimdFloat> Mul<L> for Vec3<L> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: L) -> Self {
        Self::new(self.x * factor, self.y * factor, self.z * factor)
    }
}

impl<L: SimdFloat> Neg for Vec3<L> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y, -self.z)
    }
}
