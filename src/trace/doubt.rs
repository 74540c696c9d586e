//! Whether rounding may decide what rays hit. Single-precision pictures retrace the samples for which it may in
//! double precision.

use super::paths::Paths;
use crate::plan::Plan;
use crate::primitive::{Blur, Primitive, SurfacePoint};
use crate::scene::Methods;
use crate::simd::{Mask as _, Real, SimdFloat};

/// Distance along a ray, as a multiple of the distance across a surface, up to which two hits may swap places or be on
/// the same surface: enough for surfaces that the ray meets at up to 89 degrees from their normals (1 / cos 89° = 57).
pub const GRAZING_FACTOR: f64 = 64.0;

/// Share of the error along rays within which two hits may swap places for samples that search for an edge inside a
/// pixel: they need not see again what is only in doubt where a surface is met at a grazing angle.
const TIE_SHARE: f64 = 1.0 / 16.0;

/// What may be in doubt about the hits of rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DoubtScope {
    /// Nothing.
    Nothing,
    /// Whether something is hit, and which of two hits is nearer.
    All,
    /// Whether something is hit.
    Hits,
    /// Which of two hits is nearer.
    Ties,
}

impl DoubtScope {
    /// Everything, or nothing unless `is_doubted`. Without `doubts_nearer`, it is never in doubt which of two hits is
    /// nearer.
    pub fn of(is_doubted: bool, doubts_nearer: bool) -> Self {
        match (is_doubted, doubts_nearer) {
            (false, _) => Self::Nothing,
            (true, false) => Self::Hits,
            (true, true) => Self::All,
        }
    }
}

/// Whether kernels detect doubtful hits. Those without `TREE` do not, and lose no time by it: scenes of few things
/// have few edges. If such a scene is filtered nevertheless, kernels with `TREE` trace it.
pub const fn is_filtered<L: SimdFloat, const TREE: bool>() -> bool {
    TREE && L::Real::IS_FILTERED
}

/// What is undecided about the hits of rays.
#[derive(Clone, Copy, Debug)]
pub struct Doubt<L: SimdFloat, const TREE: bool> {
    scope: DoubtScope,
    /// Lateral error of the rays.
    pub blur: Blur<L>,
    /// Error of a hit along the rays.
    along: Blur<L>,
    /// Distance from which on the rays may hit something else.
    pub undecided_from: L,
    /// Distance of the second-nearest hit.
    pub second_nearest: L,
}

impl<L: SimdFloat, const TREE: bool> Doubt<L, TREE> {
    /// Starts with nothing in doubt about rays with this lateral error.
    #[inline(always)]
    pub fn new(blur: Blur<L>, scope: DoubtScope) -> Self {
        let along = match scope {
            DoubtScope::All => GRAZING_FACTOR,
            DoubtScope::Nothing | DoubtScope::Hits => 0.0,
            DoubtScope::Ties => GRAZING_FACTOR * TIE_SHARE,
        };
        let lateral = match scope {
            DoubtScope::Ties => Blur::splat(blur.start.token(), Blur::NONE),
            _ => blur,
        };
        Self {
            scope,
            blur: lateral,
            along: blur.times(along),
            undecided_from: blur.start.like(L::Real::INFINITY),
            second_nearest: blur.start.like(L::Real::INFINITY),
        }
    }

    /// Returns whether doubtful hits are detected.
    #[inline(always)]
    pub fn is_enabled(&self) -> bool {
        is_filtered::<L, TREE>() && self.scope != DoubtScope::Nothing
    }

    /// Returns a distance, increased by as much as rounding may have reduced it.
    #[inline(always)]
    pub fn upper_bound(&self, t: L) -> L {
        if self.is_enabled() {
            L::select(t.less(t.like(L::Real::INFINITY)), t + self.along.at(t), t)
        } else {
            t
        }
    }

    /// The factor by which [`Self::upper_bound`] increases a distance.
    #[inline(always)]
    pub fn stretch(&self, t: L) -> L {
        let one = t.like(L::Real::ONE);
        if self.is_enabled() {
            L::select(t.like(L::Real::ZERO).less(t), self.upper_bound(t) / t, one)
        } else {
            one
        }
    }

    /// Returns a distance, reduced by its error.
    #[inline(always)]
    pub fn lower_bound(&self, t: L) -> L {
        t - self.along.at(t)
    }

    /// Returns where it is in doubt what is hit, given the distance of the nearest hit.
    #[inline(always)]
    pub fn about_nearest(&self, nearest: L) -> L::Mask {
        let is_tie = self.is_tie(nearest, self.second_nearest);
        if self.scope == DoubtScope::Ties {
            is_tie
        } else {
            self.may_hit_before(nearest) | is_tie
        }
    }

    /// Returns where the nearest and the second hit may swap places: also where they are at equal distances, as
    /// surfaces a hair apart are if seen from afar.
    #[inline(always)]
    fn is_tie(&self, nearest: L, second_nearest: L) -> L::Mask {
        // If both are infinite, the difference is NaN, which is not less.
        (second_nearest - nearest).less(self.along.at(nearest))
    }

    /// Returns the distance of a primitive, and the distance from which on it is undecided whether it is hit;
    /// `None` if no wanted ray hits it.
    #[inline(always)]
    pub fn distance<const LISTED: bool, P: Primitive<L::Real>>(
        &self,
        (primitive, number): (&P, usize),
        prepared: &P::Prepared<L>,
        paths: &Paths<L>,
        (methods, wanted): (&Methods, L::Mask),
    ) -> Option<(L, L)> {
        let infinity = self.blur.start.like(L::Real::INFINITY);
        if LISTED && paths.ignored.shared() == Some(number) {
            // Rays that start on a flat primitive do not hit it.
            if !P::IS_CURVED {
                return None;
            }
            return Some((primitive.exit(&paths.rays), infinity));
        }
        let blur = (&self.blur, wanted);
        let found = primitive.intersect_in_doubt(&paths.rays, prepared, methods, blur);
        let starts_here = paths.ignored.starts_on(number);
        if !starts_here.any() || (found.is_none() && !P::IS_CURVED) {
            return found;
        }
        let (t, from) = found.unwrap_or((infinity, infinity));
        let t = L::select(starts_here, primitive.exit(&paths.rays), t);
        Some((t, L::select(starts_here, infinity, from)))
    }

    /// Returns where the rays may hit something else up to a distance.
    #[inline(always)]
    fn may_hit_before(&self, t: L) -> L::Mask {
        let infinity = t.like(L::Real::INFINITY);
        self.undecided_from.less(infinity) & self.undecided_from.at_most(self.upper_bound(t))
    }
}

/// Smallest cosine between rays and a surface's normal at which hits are judged: if it were smaller, more would have
/// to be searched around hits; if it were larger, more would be traced again.
const MIN_COSINE: f64 = 4e-3;
/// Least error per unit of distance at which mirrored rays are not judged.
const MAX_SPREAD: f64 = 1e-3;
/// Rays that contribute no more than this are not doubted, nor is what they see in mirrors: less than an 8-bit
/// level.
const MIN_WEIGHT: f64 = 1.0 / 400.0;

/// Upper bound of the error along the surface of hits that are judged, if the rays are off by no more than `off`
/// and no coordinate exceeds `size`.
pub fn max_hit_error<R: Real>(off: R, size: R) -> R {
    (off + Blur::of_size(size).start) * R::from_f64(1.0 / MIN_COSINE)
}

/// How exact the rays of a packet are.
#[derive(Clone, Copy)]
pub struct Uncertainty<L: SimdFloat> {
    /// Lateral error of the rays.
    pub blur: Blur<L>,
    /// Upper bound of the share of their colours that reaches the camera.
    pub weight: L,
    /// Where rounding may decide their colours.
    pub doubt: L::Mask,
    /// The largest coordinate of the centre of a mesh: rays meet faces in coordinates relative to that.
    max_mesh_centre: L,
    /// Blur and weight of the rays that mirrors send on.
    mirrored: (Blur<L>, L),
}

impl<L: SimdFloat> Uncertainty<L> {
    /// For rays from the camera.
    #[inline(always)]
    pub fn new(token: L::Token, plan: &Plan<L::Real>) -> Self {
        let weight = L::splat(token, L::Real::ONE);
        Self {
            blur: Blur::splat(token, plan.blur),
            weight,
            doubt: weight.less(weight),
            max_mesh_centre: L::splat(token, plan.max_mesh_centre),
            mirrored: (Blur::splat(token, Blur::NONE), weight),
        }
    }

    /// For the rays that mirrors have sent on.
    #[inline(always)]
    #[must_use]
    pub fn of_mirrored(&self) -> Self {
        let (blur, weight) = self.mirrored;
        let doubt = weight.less(weight);
        Self {
            blur,
            weight,
            doubt,
            ..*self
        }
    }
}

/// Returns the blur that covers those of all rays.
#[inline(always)]
pub fn widest_blur<L: SimdFloat>(
    token: L::Token,
    uncertainties: &[Uncertainty<L>],
) -> Blur<L::Real> {
    let zero = L::splat(token, L::Real::ZERO);
    let (mut start, mut spread) = (zero, zero);
    for Uncertainty { blur, .. } in uncertainties {
        start = start.max(blur.start);
        spread = spread.max(blur.spread);
    }
    Blur::spreading(start.greatest(), spread.greatest())
}

/// Error of the hits of rays along a surface.
#[derive(Clone, Copy, Debug)]
pub struct HitError<L: SimdFloat> {
    offset: L,
    /// Where the error is so large that nothing can be said about rays that go on from there: it exceeds even the
    /// distance that is searched around them.
    pub is_lost: L::Mask,
    /// Error per unit of distance of the rays that hit the surface.
    spread: L,
    /// Curvature of the surface.
    curvature: L,
    /// Blur of rays that start at coordinates as large as the surface's.
    start_blur: Blur<L>,
}

impl<L: SimdFloat> HitError<L> {
    /// For rays that hit the surface at distance `t`, with this cosine between them and its normal.
    #[inline(always)]
    pub fn new(rays: &Uncertainty<L>, (t, cosine): (L, L), surface: &SurfacePoint<L>) -> Self {
        let blur = &rays.blur;
        let start_blur = Blur::of_sizes(surface.size + rays.max_mesh_centre);
        let cosine = cosine.abs();
        Self {
            offset: (blur.at(t) + start_blur.start) / cosine,
            is_lost: cosine.less(cosine.like_f64(MIN_COSINE)),
            spread: blur.spread,
            curvature: surface.curvature,
            start_blur,
        }
    }

    /// Returns where a light, at this cosine from the normal, may be on either side of the surface; `per_length` is
    /// one over its distance. This only shows where there are highlights, which may end abruptly there.
    #[inline(always)]
    pub fn grazes(&self, (cosine, per_length): (L, L), shiny: Option<L::Mask>) -> L::Mask {
        let Some(shiny) = shiny else {
            return cosine.less(cosine);
        };
        let turn = self.offset * (self.curvature + per_length);
        let rounded = self.start_blur.spread + per_length * self.start_blur.start;
        shiny & cosine.abs().at_most(turn + rounded)
    }

    /// Returns the blur of rays that go on to a light, as far as anything is known about it; given the light's
    /// distance and one over that.
    #[inline(always)]
    pub fn blur_to_light(&self, distance: (L, L)) -> Blur<L> {
        let offset = L::select(self.is_lost, self.start_blur.start, self.offset);
        self.start_blur.towards(offset, distance)
    }

    /// Notes blur and weight of the rays that a mirror sends on, where `active`; `share` is the share that it
    /// reflects. Where their error is too large to judge them, the whole ray is in doubt.
    #[inline(always)]
    pub fn note_reflection(&self, (active, share): (L::Mask, L), uncertainty: &mut Uncertainty<L>) {
        let offset = self.offset;
        let weight = uncertainty.weight * share;
        let turn = offset * self.curvature;
        let blur = self.start_blur.onwards(offset, self.spread + turn + turn);
        let is_judged = blur.spread.less(offset.like_f64(MAX_SPREAD)) & !self.is_lost;
        let counts = offset.like_f64(MIN_WEIGHT).less(weight) & active;
        let none = Blur::splat(offset.token(), Blur::NONE);
        let (other_blur, other_weight) = uncertainty.mirrored;
        uncertainty.mirrored = (
            blur.over(is_judged & counts, &none)
                .over(active, &other_blur),
            L::select(active, weight, other_weight),
        );
        uncertainty.doubt = uncertainty.doubt | counts & !is_judged;
    }
}
