//! How far rays may be beside their place, since numbers are rounded.

use crate::simd::{Real, SimdFloat};

/// Roundings of a ray's coordinates that its place may be off by, at its start and along it; all of them in the same
/// direction would add up to 8. With these, no pixel of 1,000 random scenes is wrong.
const ROUNDINGS: f64 = 4.0;

/// How far rays may be beside where they would be in exact arithmetic: at their start, and how much farther at
/// distance 1. A running error analysis, as Wilkinson, "Rounding errors in algebraic processes" (1963), ch. 1; what
/// it leaves undecided is computed again, as Shewchuk, "Adaptive precision floating-point arithmetic and fast robust
/// geometric predicates", Discrete & Computational Geometry 18 (1997).
#[derive(Clone, Copy, Debug)]
pub struct Blur<L> {
    /// Scene units.
    pub start: L,
    /// Scene units per scene unit; below 0 for rays to a place that is known better than their start.
    pub spread: L,
    /// What it is at least along them, scene units.
    least: L,
}

impl<R: Real> Blur<R> {
    /// Of rays that start where no coordinate is larger than this, and are known as well as such numbers can be. What
    /// they meet has coordinates no larger than that and its distance: it is off by no more.
    pub fn of_size(size: R) -> Self {
        let spread = R::UNIT_ROUNDOFF * R::from_f64(ROUNDINGS);
        Self::spreading(size * spread, spread)
    }

    /// Of rays that are so far off at their start, and so much more at distance 1.
    pub fn spreading(start: R, spread: R) -> Self {
        Self {
            start,
            spread,
            least: R::ZERO,
        }
    }

    /// Where nobody asks what is undecided.
    pub const NONE: Self = Self {
        start: R::ZERO,
        spread: R::ZERO,
        least: R::ZERO,
    };
}

impl<L: SimdFloat> Blur<L> {
    /// [`Blur::of_size`] for each ray.
    #[inline(always)]
    pub fn of_sizes(sizes: L) -> Self {
        let one = Self::splat(sizes.token(), Blur::of_size(L::Real::ONE));
        Self {
            start: sizes * one.start,
            ..one
        }
    }

    /// The same for all rays.
    #[inline(always)]
    pub fn splat(token: L::Token, blur: Blur<L::Real>) -> Self {
        Self {
            start: L::splat(token, blur.start),
            spread: L::splat(token, blur.spread),
            least: L::splat(token, blur.least),
        }
    }

    /// Of rays that go on from where others may be so far beside their place: `off` more at their start, and as much as
    /// that is turned in a new direction.
    #[inline(always)]
    #[must_use]
    pub fn onwards(&self, off: L, turn: L) -> Self {
        Self {
            start: off + self.start,
            spread: self.spread + turn,
            ..*self
        }
    }

    /// Of rays that go on from there, so far, to a point that is known: they come together there. Given with the distance
    /// is one over that of the point, which may be a little farther away.
    #[inline(always)]
    #[must_use]
    pub fn towards(&self, off: L, (distance, per_length): (L, L)) -> Self {
        Self {
            least: self.at(distance),
            ..self.onwards(off, -off * per_length)
        }
    }

    /// How far they may be beside their place at a distance.
    #[inline(always)]
    pub fn at(&self, t: L) -> L {
        (self.start + self.spread * t).max(self.least)
    }

    /// How far at most from a distance on up to a greater one.
    #[inline(always)]
    pub fn between(&self, from: L, to: L) -> L {
        self.at(from).max(self.at(to))
    }

    /// How far at most within so much of a distance.
    #[inline(always)]
    pub fn around(&self, t: L, reach: L) -> L {
        self.between((t - reach).max(t.like(L::Real::ZERO)), t + reach)
    }

    /// So many times as much.
    #[inline(always)]
    #[must_use]
    pub fn times(&self, factor: f64) -> Self {
        let factor = self.start.like_f64(factor);
        Self {
            start: self.start * factor,
            spread: self.spread * factor,
            least: self.least * factor,
        }
    }

    /// This where the mask is set, `other` elsewhere.
    #[inline(always)]
    #[must_use]
    pub fn over(&self, mask: L::Mask, other: &Self) -> Self {
        Self {
            start: L::select(mask, self.start, other.start),
            spread: L::select(mask, self.spread, other.spread),
            least: L::select(mask, self.least, other.least),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_to_a_light_come_together_there() {
        let own = Blur::of_size(100.0_f32);
        let (off, distance) = (1.5, 2e4);
        let blur = own.towards(off, (distance, 1.0 / distance));
        for part in [0.0, 0.25, 0.5, 0.99, 1.0] {
            let t = part * distance;
            let known = off * (1.0 - part) + own.at(t);
            assert!(blur.at(t) >= known * 0.999, "{part}");
            assert!(blur.at(t) <= known * 1.001 + own.at(distance), "{part}");
        }
        // Also behind it.
        assert!(blur.at(2.0 * distance) >= own.at(distance));
        let onwards = own.onwards(off, 1e-4);
        assert_eq!(onwards.at(0.0), off + own.start);
        assert!(onwards.at(distance) > off + 1.9);
        assert_eq!(blur.around(2.0 * off, off), blur.at(off));
        assert_eq!(blur.around(off, 2.0 * off), blur.at(0.0));
        assert_eq!(onwards.around(2.0 * off, off), onwards.at(3.0 * off));
        // The widest of a way is at its start for the one, and at its end for the other.
        assert_eq!(blur.between(0.0, distance), blur.at(0.0));
        assert_eq!(onwards.between(0.0, distance), onwards.at(distance));
    }
}
