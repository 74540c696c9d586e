//! How far beside rays boxes are looked into for what is thin.

use super::thresholds::SLIPPING;
use crate::primitive::CAUTION;
use crate::simd::{Real, SimdFloat};

/// How many widths of a pixel before a box a ray passes what is in it, at most: discs the farthest.
const PASSED_BEFORE: f64 = 4.0;

/// How wide a pixel is around the rays, at most: where they start, and how much more at distance 1.
#[derive(Clone, Copy, Debug, Default)]
pub struct ThinMargin<R> {
    /// Scene units.
    pub width: R,
    /// Scene units per scene unit.
    pub spread: R,
    /// How many times as wide as that things may be that are looked for.
    pub thickest: R,
    /// How much less at distance 1 at least, where pixels narrow along all of the rays.
    pub narrowing: R,
    /// How wide they count at least all the same.
    pub least: R,
}

impl<R: Real> ThinMargin<R> {
    /// What may slip between samples, where pixels are so wide.
    #[inline(always)]
    pub fn slipping(width: R, spread: R) -> Self {
        Self {
            width,
            spread,
            thickest: R::from_f64(SLIPPING),
            narrowing: R::ZERO,
            least: width,
        }
    }

    /// The same where pixels do not narrow.
    #[must_use]
    pub fn without_narrowing(self) -> Self {
        Self {
            narrowing: R::ZERO,
            ..self
        }
    }

    /// How wide a pixel is around a box at most that is no nearer than this to where any ray starts, where it would be so
    /// wide without narrowing. What is in it may be passed some widths before it.
    #[inline(always)]
    pub fn narrowed<L: SimdFloat<Real = R>>(&self, width: L, near: L) -> L {
        let sure = near * near.like_f64(1.0 - CAUTION) - width * near.like_f64(PASSED_BEFORE);
        let narrowed = width - sure.max(near.like(R::ZERO)) * near.like(self.narrowing);
        narrowed.max(near.like(self.least))
    }

    /// How far something may be from where rays start that go as far as `reach`, where a pixel is so wide.
    #[inline(always)]
    pub fn end<L: SimdFloat<Real = R>>(&self, reach: L, width: L) -> L {
        // Round things count up to their own size behind the end.
        reach + width * reach.like(self.thickest + R::ONE)
    }
}
