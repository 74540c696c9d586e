//! The size of a pixel: along rays, and on the surfaces that they hit.

use super::thresholds::{FULL_SHADOW_DEPTH, GRAZING, HIGHLIGHT_REACH, THIN_WIDTH};
use crate::simd::{Real, SimdFloat};

/// Width of a pixel along rays: where they start, and how it changes with distance.
#[derive(Clone, Copy, Debug)]
pub struct RayCone<L> {
    /// Scene units.
    pub width: L,
    /// Scene units per scene unit; negative where the cone narrows.
    pub spread: L,
}

/// The area of a surface that a pixel covers.
#[derive(Clone, Copy, Debug)]
pub struct Footprint<L> {
    /// Its width across the ray.
    cone: RayCone<L>,
    /// Its length along the surface.
    length: L,
    /// Angle by which the surface's normal turns over that length.
    turn: L,
}

impl<L: SimdFloat> RayCone<L> {
    /// Width of a pixel at distance `t`.
    #[inline(always)]
    pub fn width_at(&self, t: L) -> L {
        self.width + self.spread * t
    }

    /// The same cone, with the width kept constant where it would narrow.
    #[inline(always)]
    pub fn widening(&self) -> Self {
        Self {
            spread: self.spread.max(self.width.like(L::Real::ZERO)),
            ..*self
        }
    }
}

impl<L: SimdFloat> Footprint<L> {
    /// The footprint of a ray that hits a surface of this curvature at distance `t` and this cosine; for the
    /// length, cosines below `grazing` count as `grazing`.
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

    /// The cone of the mirrored ray; a curved mirror spreads it.
    #[inline(always)]
    pub fn mirrored(&self) -> RayCone<L> {
        RayCone {
            spread: self.cone.spread + self.turn + self.turn,
            ..self.cone
        }
    }

    /// The cone of the rays from the surface to a light at this distance, where it narrows to a point.
    #[inline(always)]
    pub fn shadow(&self, distance: L) -> RayCone<L> {
        RayCone {
            width: self.length,
            spread: -self.length / distance,
        }
    }

    /// The cone of those rays around parts of meshes that are treated as one thing; it does not narrow. Its width
    /// is limited: on a surface that stretches to the horizon, most of a mesh would be one thing.
    #[inline(always)]
    pub fn shadow_in_meshes(&self) -> RayCone<L> {
        let width = self.cone.width;
        RayCone {
            width: self.length.min(width * width.like_f64(1.0 / GRAZING)),
            spread: width.like(L::Real::ZERO),
        }
    }

    /// Greatest width of things whose shadows may slip between samples.
    #[inline(always)]
    pub fn thin_width(&self) -> L {
        self.length * self.length.like_f64(THIN_WIDTH)
    }

    /// Distance from the edge of a shadow beyond which a pixel is entirely inside of it.
    #[inline(always)]
    pub fn full_shadow_depth(&self) -> L {
        self.length * self.length.like_f64(FULL_SHADOW_DEPTH)
    }

    /// The spread of the cone of the rays that arrive here.
    #[inline(always)]
    pub fn spread(&self) -> L {
        self.cone.spread
    }

    /// Distance in pixels to a highlight with exponent 1/`size`² whose light is at `light_distance`, where
    /// half-vector and normal differ by `off`. Infinity for a highlight that is wider than [`THIN_WIDTH`] pixels.
    #[inline(always)]
    pub fn highlight_distance(&self, size: f64, off: L, light_distance: L) -> L {
        let half = off.like_f64(0.5);
        let per_pixel = self.turn + (self.cone.spread + self.length / light_distance) * half;
        let distance = off - off.like_f64(HIGHLIGHT_REACH * size);
        let sharp = off.like_f64(size / THIN_WIDTH).less(per_pixel);
        distance_in_pixels(sharp, distance, per_pixel)
    }
}

/// `distance / width` where the mask is set and `distance` is positive; infinity elsewhere. Where it is not positive,
/// a sample sees the thing itself.
#[inline(always)]
pub fn distance_in_pixels<L: SimdFloat>(mask: L::Mask, distance: L, width: L) -> L {
    let outside = mask & distance.like(L::Real::ZERO).less(distance);
    L::select(outside, distance / width, distance.like(L::Real::INFINITY))
}
