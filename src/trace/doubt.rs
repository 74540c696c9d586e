//! Whether rounding may decide what rays meet. A picture in single precision traces the samples again, in double
//! precision, of which it may.

use super::paths::Paths;
use crate::plan::Plan;
use crate::primitive::{Blur, Primitive, SurfacePoint};
use crate::scene::Methods;
use crate::simd::{Mask as _, Real, SimdFloat};

/// Two hits as close along a ray as so many times what it is off aside may change places: of surfaces that the ray
/// meets at up to 89 degrees from their normals.
const SLANT: f64 = 64.0;

/// Whether kernels tell what is in doubt. Those without `TREE` do not, and lose no time by it: a few things have few edges.
/// Where those are filtered all the same, the others trace them.
pub const fn is_filtered<L: SimdFloat, const TREE: bool>() -> bool {
    TREE && L::Real::IS_FILTERED
}

/// What rays leave undecided.
#[derive(Clone, Copy, Debug)]
pub struct Doubt<L: SimdFloat, const TREE: bool> {
    is_asked: bool,
    /// How far the rays may be beside their place.
    pub blur: Blur<L>,
    /// How far along them a hit may be off.
    along: Blur<L>,
    /// From where on they may meet something else.
    pub from: L,
    /// How far the second thing is that they meet.
    pub second: L,
}

impl<L: SimdFloat, const TREE: bool> Doubt<L, TREE> {
    /// Nothing is undecided yet, and nothing ever is if nobody asks. Without `tells_nearer`, which of two hits is nearer
    /// never is.
    #[inline(always)]
    pub fn new(blur: Blur<L>, (is_asked, tells_nearer): (bool, bool)) -> Self {
        Self {
            is_asked,
            blur,
            along: blur.times(if tells_nearer { SLANT } else { 0.0 }),
            from: blur.start.like(L::Real::INFINITY),
            second: blur.start.like(L::Real::INFINITY),
        }
    }

    /// Whether anybody asks.
    #[inline(always)]
    pub fn is_asked(&self) -> bool {
        is_filtered::<L, TREE>() && self.is_asked
    }

    /// A distance, and as much more as rounding may have taken away.
    #[inline(always)]
    pub fn after(&self, t: L) -> L {
        if self.is_asked() {
            L::select(t.less(t.like(L::Real::INFINITY)), t + self.along.at(t), t)
        } else {
            t
        }
    }

    /// The same as a multiple of a distance.
    #[inline(always)]
    pub fn stretch(&self, t: L) -> L {
        let one = t.like(L::Real::ONE);
        if self.is_asked() {
            L::select(t.like(L::Real::ZERO).less(t), self.after(t) / t, one)
        } else {
            one
        }
    }

    /// A distance, and so much less.
    #[inline(always)]
    pub fn ahead_of(&self, t: L) -> L {
        t - self.along.at(t)
    }

    /// Where the nearest hit and the second may change places: also where they are equally near, as are pieces a hair apart
    /// from afar.
    #[inline(always)]
    pub fn is_tie(&self, nearest: L, second: L) -> L::Mask {
        // Infinity less infinity is no number.
        (second - nearest).less(self.along.at(nearest))
    }

    /// How far a primitive is, and from where on that is undecided; `None` if no ray that is wanted meets it.
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
            // Where they start on it, they are known not to meet it.
            if !P::IS_CURVED {
                return None;
            }
            return Some((primitive.exit(&paths.rays), infinity));
        }
        let blur = (&self.blur, wanted);
        let found = primitive.intersect_in_doubt(&paths.rays, prepared, methods, blur);
        let own = paths.ignored.is(number);
        if !own.any() || (found.is_none() && !P::IS_CURVED) {
            return found;
        }
        let (t, from) = found.unwrap_or((infinity, infinity));
        let t = L::select(own, primitive.exit(&paths.rays), t);
        Some((t, L::select(own, infinity, from)))
    }

    /// Where the rays may meet something else up to a distance.
    #[inline(always)]
    pub fn before(&self, t: L) -> L::Mask {
        let infinity = t.like(L::Real::INFINITY);
        self.from.less(infinity) & self.from.at_most(self.after(t))
    }
}

/// The smallest cosine between rays and a surface's normal at which hits are told: the smaller it is, the more is
/// looked for around hits, and the larger, the more is traced again.
const LEAST_COSINE: f64 = 4e-3;
/// How much farther off at distance 1 mirrored rays may be.
const WIDEST: f64 = 1e-3;
/// Rays that bring back no more than this are not doubted, nor is what they see in mirrors: less than a step of 8 bits.
const FAINTEST: f64 = 1.0 / 400.0;

/// How far off along a surface hits may be at most that are told, where rays are no farther off than this, and nothing is
/// larger than `size`.
pub fn farthest_off<R: Real>(off: R, size: R) -> R {
    (off + Blur::of_size(size).start) * R::from_f64(1.0 / LEAST_COSINE)
}

/// What is known of how right the rays of a packet are.
#[derive(Clone, Copy)]
pub struct Uncertainty<L: SimdFloat> {
    /// How far they may be beside their place.
    pub blur: Blur<L>,
    /// What of their colours comes back to the camera, at most.
    pub weight: L,
    /// Where rounding may decide what comes back.
    pub doubt: L::Mask,
    /// How far away from where coordinates count from some of their own do, in which meshes are met.
    farthest_middle: L,
    /// The same blur and weight of the rays that mirrors send on.
    mirrored: (Blur<L>, L),
}

impl<L: SimdFloat> Uncertainty<L> {
    /// Of rays from the camera.
    #[inline(always)]
    pub fn new(token: L::Token, plan: &Plan<L::Real>) -> Self {
        let weight = L::splat(token, L::Real::ONE);
        Self {
            blur: Blur::splat(token, plan.blur),
            weight,
            doubt: weight.less(weight),
            farthest_middle: L::splat(token, plan.farthest_middle),
            mirrored: (Blur::splat(token, Blur::NONE), weight),
        }
    }

    /// Of the rays that mirrors have sent on.
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

/// How far any of the rays may be beside its place.
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

/// How far along a surface the hits of rays may be off.
#[derive(Clone, Copy, Debug)]
pub struct Slant<L: SimdFloat> {
    off: L,
    /// Where that is so far that nothing can be told of rays that go on from there: not even what is looked for around
    /// them is as far off.
    pub is_lost: L::Mask,
    /// How much farther off at distance 1 the rays were that came here.
    spread: L,
    /// Of the surface.
    curvature: L,
    /// How far off rays are that set out from numbers as large as the surface's.
    own: Blur<L>,
}

impl<L: SimdFloat> Slant<L> {
    /// Of rays that have come so far, and meet the surface with this cosine between them and its normal.
    #[inline(always)]
    pub fn new(rays: &Uncertainty<L>, (t, cosine): (L, L), surface: &SurfacePoint<L>) -> Self {
        let blur = &rays.blur;
        let own = Blur::of_sizes(surface.size + rays.farthest_middle);
        let cosine = cosine.abs();
        Self {
            off: (blur.at(t) + own.start) / cosine,
            is_lost: cosine.less(cosine.like_f64(LEAST_COSINE)),
            spread: blur.spread,
            curvature: surface.curvature,
            own,
        }
    }

    /// Where light, whose angle from the normal has this cosine, may come from either side of the surface; given one over
    /// its distance. It shows where there are highlights: they may end sharply there.
    #[inline(always)]
    pub fn grazes(&self, (cosine, per_length): (L, L), shiny: Option<L::Mask>) -> L::Mask {
        let Some(shiny) = shiny else {
            return cosine.less(cosine);
        };
        let turn = self.off * (self.curvature + per_length);
        let rounded = self.own.spread + per_length * self.own.start;
        shiny & cosine.abs().at_most(turn + rounded)
    }

    /// How far rays that go on to a light, which is so far away, may be off, where something can be told of them; given
    /// one over that distance.
    #[inline(always)]
    pub fn onwards(&self, distance: (L, L)) -> Blur<L> {
        let off = L::select(self.is_lost, self.own.start, self.off);
        self.own.towards(off, distance)
    }

    /// Notes what is known of the rays that a mirror sends on, where there are some, which bring back so much of what
    /// they see. Where they are too far off for anything to be told, all of it is in doubt.
    #[inline(always)]
    pub fn mirror(&self, (active, share): (L::Mask, L), own: &mut Uncertainty<L>) {
        let off = self.off;
        let weight = own.weight * share;
        let turn = off * self.curvature;
        let blur = self.own.onwards(off, self.spread + turn + turn);
        let is_told = blur.spread.less(off.like_f64(WIDEST)) & !self.is_lost;
        let counts = off.like_f64(FAINTEST).less(weight) & active;
        let none = Blur::splat(off.token(), Blur::NONE);
        let (other_blur, other_weight) = own.mirrored;
        own.mirrored = (
            blur.over(is_told & counts, &none).over(active, &other_blur),
            L::select(active, weight, other_weight),
        );
        own.doubt = own.doubt | counts & !is_told;
    }
}
