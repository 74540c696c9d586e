//! How far rays may be beside their place, since numbers are rounded.

use crate::simd::{Real, SimdFloat};

/// Roundings of a ray's coordinates that its place may be off by, at its start and along it. With one, no pixel of 450
/// random scenes is wrong, with a half, 2 scenes are; all of them in the same direction would add up to 8.
const ROUNDINGS: f64 = 4.0;

/// How far rays may be beside where they would be in exact arithmetic: at their start, and how much farther at
/// distance 1. A running error analysis, as Wilkinson, "Rounding errors in algebraic processes" (1963), ch. 1; what
/// it leaves undecided is computed again, as Shewchuk, "Adaptive precision floating-point arithmetic and fast robust
/// geometric predicates", Discrete & Computational Geometry 18 (1997).
#[derive(Clone, Copy, Debug)]
pub struct Blur<L> {
    /// Scene units.
    pub start: L,
    /// Scene units per scene unit.
    pub spread: L,
}

impl<R: Real> Blur<R> {
    /// Of rays that are known as well as numbers of this size can be.
    pub fn of_size(size: R) -> Self {
        let spread = R::UNIT_ROUNDOFF * R::from_f64(ROUNDINGS);
        Self {
            start: size * spread,
            spread,
        }
    }

    /// Where nobody asks what is undecided.
    pub const NONE: Self = Self {
        start: R::ZERO,
        spread: R::ZERO,
    };
}

impl<L: SimdFloat> Blur<L> {
    /// The same for all rays.
    #[inline(always)]
    pub fn splat(token: L::Token, blur: Blur<L::Real>) -> Self {
        Self {
            start: L::splat(token, blur.start),
            spread: L::splat(token, blur.spread),
        }
    }

    /// How far they may be beside their place at a distance.
    #[inline(always)]
    pub fn at(&self, t: L) -> L {
        self.start + self.spread * t
    }

    /// So many times as much.
    #[inline(always)]
    #[must_use]
    pub fn times(&self, factor: f64) -> Self {
        let factor = self.start.like_f64(factor);
        Self {
            start: self.start * factor,
            spread: self.spread * factor,
        }
    }

    /// This where the mask is set, `other` elsewhere.
    #[inline(always)]
    #[must_use]
    pub fn over(&self, mask: L::Mask, other: &Self) -> Self {
        Self {
            start: L::select(mask, self.start, other.start),
            spread: L::select(mask, self.spread, other.spread),
        }
    }
}
