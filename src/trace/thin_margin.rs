//! How far beside rays boxes are searched for thin things.

use super::thresholds::THIN_WIDTH;
use crate::primitive::CAUTION;
use crate::simd::{Real, SimdFloat};

/// Greatest distance before a box, in widths of a pixel, at which a ray may pass what is in it; discs need the most.
const APPROACH_WIDTHS: f64 = 4.0;

/// Share of the width of a pixel around a packet that counts for a ray by itself: a packet of one ray then finds all
/// that counts for it, although it computes the width in another order.
const OWN_SHARE: f64 = 0.999;

/// Upper bound of the width of a pixel around rays, and how thick the things are that are looked for.
#[derive(Clone, Copy, Debug, Default)]
pub struct ThinMargin<R> {
    /// Width where the rays start, in scene units.
    pub width: R,
    /// Growth of the width per unit of distance.
    pub spread: R,
    /// Thickness in widths of a pixel below which things are looked for.
    pub max_thickness: R,
    /// How much narrower a pixel becomes per unit of distance, at least, if it narrows along all of the rays; else 0.
    pub narrowing: R,
    /// Least width in spite of narrowing, in scene units.
    pub min_width: R,
}

impl<L: SimdFloat> ThinMargin<L> {
    /// Returns the largest width of a pixel of each ray around a box, given an upper and a lower bound of its distance:
    /// what [`Self::narrowed`] is for a packet.
    #[inline(always)]
    pub fn own_width(&self, farthest: L, nearest: L) -> L {
        let zero = nearest.like(L::Real::ZERO);
        let width = farthest * self.spread + self.width;
        let certain_distance =
            nearest * nearest.like_f64(1.0 - CAUTION) - width * nearest.like_f64(APPROACH_WIDTHS);
        let narrowed = width - certain_distance.max(zero) * self.narrowing;
        let narrowed = narrowed.max(self.min_width);
        L::select(zero.less(self.narrowing), narrowed, width) * nearest.like_f64(OWN_SHARE)
    }
}

impl<R: Real> ThinMargin<R> {
    /// Creates the margin for things that may slip between samples, where pixels are this wide.
    #[inline(always)]
    pub fn new(width: R, spread: R) -> Self {
        Self {
            width,
            spread,
            max_thickness: R::from_f64(THIN_WIDTH),
            narrowing: R::ZERO,
            min_width: width,
        }
    }

    /// Returns the same margin for pixels that do not narrow.
    #[must_use]
    pub fn without_narrowing(self) -> Self {
        Self {
            narrowing: R::ZERO,
            ..self
        }
    }

    /// Returns the largest width of a pixel around a box that is no nearer than `near` to the start of any ray,
    /// given the width without narrowing. What is in the box may be passed some widths before it.
    #[inline(always)]
    pub fn narrowed<L: SimdFloat<Real = R>>(&self, width: L, near: L) -> L {
        let certain_distance =
            near * near.like_f64(1.0 - CAUTION) - width * near.like_f64(APPROACH_WIDTHS);
        let narrowed = width - certain_distance.max(near.like(R::ZERO)) * near.like(self.narrowing);
        narrowed.max(near.like(self.min_width))
    }

    /// Returns how far something may be from where rays start that go as far as `reach`, where a pixel is this wide.
    #[inline(always)]
    pub fn end<L: SimdFloat<Real = R>>(&self, reach: L, width: L) -> L {
        // Round things count up to their own size behind the end.
        reach + width * reach.like(self.max_thickness + R::ONE)
    }
}
