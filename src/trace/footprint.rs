//! How large a pixel is: along rays, and on what they meet.

use super::thresholds::{GRAZING, HIDDEN, HIGHLIGHT_REACH, SLIPPING};
use crate::simd::{Real, SimdFloat};

/// How wide a pixel is along rays: where they start, and how much wider at distance 1.
#[derive(Clone, Copy, Debug)]
pub struct RayCone<L> {
    /// Scene units.
    pub width: L,
    /// Scene units per scene unit; below 0 where it narrows.
    pub spread: L,
}

/// A pixel as it lies on a surface.
#[derive(Clone, Copy, Debug)]
pub struct Footprint<L> {
    /// Across the ray.
    cone: RayCone<L>,
    /// Along the surface.
    length: L,
    /// How far the surface's normal turns over that length.
    turn: L,
}

impl<L: SimdFloat> RayCone<L> {
    /// How wide a pixel is at `t`.
    #[inline(always)]
    pub fn width_at(&self, t: L) -> L {
        self.width + self.spread * t
    }

    /// The cone that narrows nowhere.
    #[inline(always)]
    pub fn widening(&self) -> Self {
        Self {
            spread: self.spread.max(self.width.like(L::Real::ZERO)),
            ..*self
        }
    }
}

impl<L: SimdFloat> Footprint<L> {
    /// The pixel around a ray that has gone as far as `t` and meets a surface of this curvature at this
    /// cosine; where that is less than `grazing`, as long as at that.
    #[inline(always)]
    pub fn new(cone: RayCone<L>, (t, cosine, grazing): (L, L, L), curvature: L) -> Self {
        let width = cone.width_at(t);
        let length = width / cosine.abs().max(grazing);
        Self {
            cone: RayCone { width, ..cone },
            length,
            turn: length * curvature,
        }
    }

    /// How wide a pixel is along the mirrored ray: a curved mirror spreads it.
    #[inline(always)]
    pub fn mirrored(&self) -> RayCone<L> {
        RayCone {
            spread: self.cone.spread + self.turn + self.turn,
            ..self.cone
        }
    }

    /// The cone of the rays that go on from the surface to a light at this distance: it narrows to nothing there.
    #[inline(always)]
    pub fn shadow(&self, distance: L) -> RayCone<L> {
        RayCone {
            width: self.length,
            spread: -self.length / distance,
        }
    }

    /// The cone of those rays around what is looked at as one thing in meshes. On what stretches to the horizon, most of a
    /// mesh would be one thing.
    #[inline(always)]
    pub fn shadow_in_meshes(&self) -> RayCone<L> {
        let width = self.cone.width;
        RayCone {
            width: self.length.min(width * width.like_f64(1.0 / GRAZING)),
            spread: width.like(L::Real::ZERO),
        }
    }

    /// How wide is what casts shadows between samples, at most.
    #[inline(always)]
    pub fn slipping(&self) -> L {
        self.length * self.length.like_f64(SLIPPING)
    }

    /// How far inside of a shadow all of a pixel is in it.
    #[inline(always)]
    pub fn hidden(&self) -> L {
        self.length * self.length.like_f64(HIDDEN)
    }

    /// How much wider a pixel becomes along the rays that come here.
    #[inline(always)]
    pub fn spread(&self) -> L {
        self.cone.spread
    }

    /// How many pixels away a highlight is: half-vector and normal differ by `off`, its exponent
    /// is 1/`size`², and the light is at this distance. Infinity for one that is wider than
    /// [`SLIPPING`] pixels.
    #[inline(always)]
    pub fn highlight_distance(&self, size: f64, off: L, light_distance: L) -> L {
        let half = off.like_f64(0.5);
        let per_pixel = self.turn + (self.cone.spread + self.length / light_distance) * half;
        let beside = off - off.like_f64(HIGHLIGHT_REACH * size);
        let sharp = off.like_f64(size / SLIPPING).less(per_pixel);
        pixels(sharp, beside, per_pixel)
    }
}

/// `beside / width` where the mask is set; infinity elsewhere, and inside, where a sample sees the
/// thing itself.
#[inline(always)]
pub fn pixels<L: SimdFloat>(mask: L::Mask, beside: L, width: L) -> L {
    let outside = mask & beside.like(L::Real::ZERO).less(beside);
    L::select(outside, beside / width, beside.like(L::Real::INFINITY))
}
