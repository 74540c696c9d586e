//! What may slip between the samples of a pixel: primitives, and their shadows and mirror images,
//! that are narrower than two pixels, and highlights that are sharper. A sample that passes such a
//! thing closely says so, and is then not left alone.

use super::cull::Candidates;
use super::hit::{Paths, Start};
use super::packet::RayCone;
use super::triangle::Shear;
use super::{sphere, triangle};
use crate::plan::Plan;
use crate::simd::{Real, SimdFloat};

/// Widest thing, in pixels, that may slip between samples.
pub const SLIPPING: f64 = 2.0;
/// Cosine below which a surface seen at a grazing angle does not stretch a pixel any further: what
/// [`LARGEST_STRETCH`] promises.
const GRAZING: f64 = 0.25;
/// How much longer than wide a pixel on a surface can be.
pub const LARGEST_STRETCH: f64 = 1.0 / GRAZING;
/// Half the width of a highlight of exponent p, in units of 1/√p: it has fallen to 1 % there.
const HIGHLIGHT_REACH: f64 = 3.0;

/// A pixel as it lies on a surface.
#[derive(Clone, Copy, Debug)]
pub struct Footprint<L> {
    /// Across the ray.
    trail: RayCone<L>,
    /// Along the surface.
    pub length: L,
    /// How far the surface's normal turns over that length.
    turn: L,
}

impl<L: SimdFloat> Footprint<L> {
    /// The pixel around a ray that has gone as far as `t` and meets a surface of this radius of
    /// curvature (infinity: flat) at this cosine.
    #[inline(always)]
    pub fn new(token: L::Token, trail: RayCone<L>, t: L, cosine: L, radius: L::Real) -> Self {
        let width = trail.width + trail.spread * t;
        let length = width
            / cosine
                .abs()
                .max(L::splat(token, L::Real::from_f64(GRAZING)));
        Self {
            trail: RayCone {
                width,
                spread: trail.spread,
            },
            length,
            turn: length * L::splat(token, L::Real::ONE / radius),
        }
    }

    /// How wide a pixel is along the mirrored ray: a curved mirror spreads it.
    #[inline(always)]
    pub fn mirrored(&self) -> RayCone<L> {
        RayCone {
            spread: self.trail.spread + self.turn + self.turn,
            ..self.trail
        }
    }

    /// The trail of the rays that go on from the surface to a light: no wider there than here.
    #[inline(always)]
    pub fn shadow(&self, token: L::Token) -> RayCone<L> {
        RayCone {
            width: self.length,
            spread: L::splat(token, L::Real::ZERO),
        }
    }

    /// How many pixels away a highlight is: half-vector and normal differ by `off`, its exponent
    /// is 1/`size`², and the light is at this distance. Infinity for one that is wider than
    /// [`SLIPPING`] pixels.
    #[inline(always)]
    pub fn highlight_distance(&self, token: L::Token, size: f64, off: L, light_distance: L) -> L {
        let half = L::splat(token, L::Real::from_f64(0.5));
        let per_pixel = self.turn + (self.trail.spread + self.length / light_distance) * half;
        let beside = off - L::splat(token, L::Real::from_f64(HIGHLIGHT_REACH * size));
        let sharp = L::splat(token, L::Real::from_f64(size / SLIPPING)).less(per_pixel);
        pixels(token, sharp, beside, per_pixel)
    }
}

/// How many pixels away from the paths the nearest of the primitives in the lists is that are
/// narrower there than [`SLIPPING`] pixels, before `reach`; infinity for none.
#[inline(always)]
pub fn thin_distance<L: SimdFloat>(
    token: L::Token,
    plan: &Plan<L::Real>,
    among: &Candidates,
    paths: &Paths<L>,
    trail: RayCone<L>,
    reach: L,
) -> L {
    let slipping = L::splat(token, L::Real::from_f64(SLIPPING));
    let zero = L::splat(token, L::Real::ZERO);
    let mut best = L::splat(token, L::Real::INFINITY);
    for &index in &among.spheres {
        let sphere = &plan.spheres[index as usize];
        let size = L::splat(token, sphere.radius + sphere.radius);
        let (along, beside) = sphere::beside(token, &paths.rays, sphere);
        let width = trail.width + trail.spread * along;
        let thin = size.less(width * slipping) & zero.less(along) & along.less(reach + size);
        let thin = match paths.start {
            Start::Nowhere => thin,
            start => thin & !start.is(token, index as usize),
        };
        best = best.min(pixels(token, thin, beside, width));
    }
    if among.triangles.is_empty() {
        return best;
    }
    let shear = Shear::new(token, paths.rays.direction);
    for &index in &among.triangles {
        let triangle = &plan.triangles[index as usize];
        let size = L::splat(token, triangle.thickness);
        let (from, to, beside) = triangle::beside(token, &paths.rays, &shear, triangle);
        let width = trail.width + trail.spread * to;
        let thin = size.less(width * slipping) & zero.less(to) & from.less(reach + width);
        best = best.min(pixels(token, thin, beside, width));
    }
    best
}

/// `beside / width` where the mask is set; infinity elsewhere, and inside, where a sample sees the
/// thing itself.
#[inline(always)]
fn pixels<L: SimdFloat>(token: L::Token, mask: L::Mask, beside: L, width: L) -> L {
    let outside = mask & L::splat(token, L::Real::ZERO).less(beside);
    L::select(outside, beside / width, L::splat(token, L::Real::INFINITY))
}
