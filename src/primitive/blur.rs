//! How far rays may be off because numbers are rounded.

use crate::simd::{Real, SimdFloat};

/// Roundings of a ray's coordinates by which it may be off, at its start and along it; if all of them went in the
/// same direction, they would add up to 8. With this bound, no pixel of 1,000 random scenes is wrong.
const ROUNDINGS: f64 = 4.0;

/// How far rays may be from their position in exact arithmetic: at their start, and the increase per unit of
/// distance. A running error analysis, as in Wilkinson, "Rounding errors in algebraic processes" (1963), ch. 1;
/// results that it leaves undecided are computed again, as in Shewchuk, "Adaptive precision floating-point
/// arithmetic and fast robust geometric predicates", Discrete & Computational Geometry 18 (1997).
#[derive(Clone, Copy, Debug)]
pub struct Blur<L> {
    /// In scene units.
    pub start: L,
    /// In scene units per scene unit; negative for rays to a point that is known more precisely than their start.
    pub spread: L,
    /// Lower bound along the rays, in scene units.
    least: L,
}

impl<R: Real> Blur<R> {
    /// The blur of rays whose start has no coordinate larger than `size` and is as precise as such numbers can be.
    /// Whatever they hit has no coordinate larger than `size` plus its distance, so its rounding error is no larger
    /// either.
    pub fn of_size(size: R) -> Self {
        let spread = R::UNIT_ROUNDOFF * R::from_f64(ROUNDINGS);
        Self::spreading(size * spread, spread)
    }

    /// The blur of rays that are off by `start` at their start, and by `spread` more per unit of distance.
    pub fn spreading(start: R, spread: R) -> Self {
        Self {
            start,
            spread,
            least: R::ZERO,
        }
    }

    /// For pictures in which undecided results are not looked for.
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

    /// The same blur for all rays.
    #[inline(always)]
    pub fn splat(token: L::Token, blur: Blur<L::Real>) -> Self {
        Self {
            start: L::splat(token, blur.start),
            spread: L::splat(token, blur.spread),
            least: L::splat(token, blur.least),
        }
    }

    /// The blur of secondary rays from hits that may be off by `off`, in addition to `self`; `deviation` is the change
    /// of their direction that results from it.
    #[inline(always)]
    #[must_use]
    pub fn onwards(&self, off: L, deviation: L) -> Self {
        Self {
            start: off + self.start,
            spread: self.spread + deviation,
            ..*self
        }
    }

    /// The same for rays of a given length to a known point, at which they converge. Takes the length and one over
    /// the distance of the point, which may be slightly larger than the length.
    #[inline(always)]
    #[must_use]
    pub fn towards(&self, off: L, (distance, per_length): (L, L)) -> Self {
        Self {
            least: self.at(distance),
            ..self.onwards(off, -off * per_length)
        }
    }

    /// How far rays may be off at a distance.
    #[inline(always)]
    pub fn at(&self, t: L) -> L {
        (self.start + self.spread * t).max(self.least)
    }

    /// How far rays may be off between two distances.
    #[inline(always)]
    pub fn between(&self, from: L, to: L) -> L {
        self.at(from).max(self.at(to))
    }

    /// How far rays may be off at distances that differ from `t` by at most `reach`.
    #[inline(always)]
    pub fn around(&self, t: L, reach: L) -> L {
        self.between((t - reach).max(t.like(L::Real::ZERO)), t + reach)
    }

    /// The blur multiplied by a factor.
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

    /// This blur where the mask is set, `other` elsewhere.
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
        // Also behind the light.
        assert!(blur.at(2.0 * distance) >= own.at(distance));
        let onwards = own.onwards(off, 1e-4);
        assert_eq!(onwards.at(0.0), off + own.start);
        assert!(onwards.at(distance) > off + 1.9);
        assert_eq!(blur.around(2.0 * off, off), blur.at(off));
        assert_eq!(blur.around(off, 2.0 * off), blur.at(0.0));
        assert_eq!(onwards.around(2.0 * off, off), onwards.at(3.0 * off));
        // The first one is widest at the start of the rays, the other one at their end.
        assert_eq!(blur.between(0.0, distance), blur.at(0.0));
        assert_eq!(onwards.between(0.0, distance), onwards.at(distance));
    }
}
