//! The nearest hit among some primitives, and whether anything stands in a ray's way.

use super::candidates::Candidates;
use crate::plan::Plan;
use crate::primitive::{Kind, Primitive, Ray, Visit};
use crate::scene::Methods;
use crate::simd::{Mask as _, Real, SimdFloat};

/// What the kernels of a picture share: the proof that the processor has the lanes, and the plan.
pub struct Kernel<'a, L: SimdFloat> {
    /// Proof that the processor has these vectors.
    pub token: L::Token,
    /// The plan.
    pub plan: &'a Plan<L::Real>,
}

#[expect(
    clippy::expl_impl_clone_on_copy,
    reason = "derived, it would ask for the same of every lane"
)]
impl<L: SimdFloat> Clone for Kernel<'_, L> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<L: SimdFloat> Copy for Kernel<'_, L> {}

/// Rays and the primitives that they start on, which they must not meet where they start.
#[derive(Clone, Copy, Debug)]
pub struct Paths<L> {
    /// The rays.
    pub rays: Ray<L>,
    /// What they start on.
    pub ignored: IgnoredPrimitive<L>,
}

/// The primitives that rays start on.
#[derive(Clone, Copy, Debug)]
pub enum IgnoredPrimitive<L> {
    /// None.
    Nothing,
    /// All rays start on the primitive of this number.
    Shared(usize),
    /// Each ray starts on the primitive whose number is in its lane; [`NOTHING`] for none.
    Each(L),
}

/// The nearest primitives.
#[derive(Clone, Copy, Debug)]
pub struct Nearest<L> {
    /// How far; infinity for nothing.
    pub t: L,
    /// Number of the primitive, see [`crate::primitive::Primitives`]; [`NOTHING`] for nothing.
    pub number: L,
}

/// The number of no primitive.
pub const NOTHING: f64 = -1.0;

#[inline(always)]
fn real<R: Real>(number: usize) -> R {
    R::from_f64(number as f64)
}

impl<L: SimdFloat> IgnoredPrimitive<L> {
    /// This where the mask is set, `other` elsewhere.
    #[inline(always)]
    pub fn over(self, token: L::Token, mask: L::Mask, other: Self) -> Self {
        match (self, other) {
            (Self::Nothing, Self::Nothing) => self,
            (Self::Shared(this), Self::Shared(other)) if this == other => self,
            _ => Self::Each(L::select(mask, self.numbers(token), other.numbers(token))),
        }
    }

    /// Where it is the primitive of this number.
    #[inline(always)]
    pub fn is(self, token: L::Token, number: usize) -> L::Mask {
        self.numbers(token).same(L::splat(token, real(number)))
    }

    #[inline(always)]
    fn numbers(self, token: L::Token) -> L {
        match self {
            Self::Nothing => L::splat(token, L::Real::from_f64(NOTHING)),
            Self::Shared(number) => L::splat(token, real(number)),
            Self::Each(numbers) => numbers,
        }
    }
}

impl<L: SimdFloat> Paths<L> {
    /// How far the primitive of this number is; infinity for none, and where the rays start on it.
    #[inline(always)]
    fn distance<P: Primitive<L::Real>>(
        &self,
        primitive: &P,
        prepared: &P::Prepared<L>,
        number: usize,
        methods: &Methods,
    ) -> L {
        let rays = &self.rays;
        match self.ignored {
            IgnoredPrimitive::Shared(start) if start == number => primitive.exit(rays),
            IgnoredPrimitive::Nothing | IgnoredPrimitive::Shared(_) => {
                primitive.intersect(rays, prepared, methods)
            }
            IgnoredPrimitive::Each(start) => {
                let t = primitive.intersect(rays, prepared, methods);
                let own = start.same(start.like(real(number)));
                if !P::IS_CURVED || own.any() {
                    L::select(own, primitive.exit(rays), t)
                } else {
                    t
                }
            }
        }
    }
}

impl<L: SimdFloat> Kernel<'_, L> {
    /// The number in every lane.
    #[inline(always)]
    pub fn splat(self, value: f64) -> L {
        L::splat(self.token, L::Real::from_f64(value))
    }

    /// Infinity in every lane.
    #[inline(always)]
    pub fn infinity(self) -> L {
        L::splat(self.token, L::Real::INFINITY)
    }

    /// The nearest primitives along the paths.
    #[inline(always)]
    pub fn nearest(self, among: &Candidates, paths: &Paths<L>) -> Nearest<L> {
        let mut scan = NearestScan {
            methods: &self.plan.methods,
            among,
            paths,
            best: Nearest {
                t: self.infinity(),
                number: self.splat(NOTHING),
            },
        };
        self.plan.primitives.visit(&mut scan);
        scan.best
    }

    /// Where one of the primitives meets the paths before `distance`; looked for only where `wanted`.
    #[inline(always)]
    pub fn blocked(
        self,
        among: &Candidates,
        paths: &Paths<L>,
        distance: L,
        wanted: L::Mask,
    ) -> L::Mask {
        let mut scan = BlockedScan {
            methods: &self.plan.methods,
            among,
            paths,
            distance,
            free: wanted,
        };
        self.plan.primitives.visit(&mut scan);
        wanted & !scan.free
    }
}

struct NearestScan<'a, L> {
    methods: &'a Methods,
    among: &'a Candidates,
    paths: &'a Paths<L>,
    best: Nearest<L>,
}

impl<L: SimdFloat> Visit<L::Real> for NearestScan<'_, L> {
    #[inline(always)]
    fn visit<P: Primitive<L::Real>>(&mut self, kind: Kind, primitives: &[P], first: usize) {
        let among = self.among.of(kind);
        if among.is_empty() {
            return;
        }
        let prepared = P::prepare(self.paths.rays.direction);
        for &index in among {
            let number = first + index as usize;
            let primitive = &primitives[index as usize];
            let t = self
                .paths
                .distance(primitive, &prepared, number, self.methods);
            let closer = t.less(self.best.t);
            self.best.t = L::select(closer, t, self.best.t);
            self.best.number = L::select(closer, t.like(real(number)), self.best.number);
        }
    }
}

struct BlockedScan<'a, L: SimdFloat> {
    methods: &'a Methods,
    among: &'a Candidates,
    paths: &'a Paths<L>,
    distance: L,
    /// Where nothing was met yet.
    free: L::Mask,
}

impl<L: SimdFloat> Visit<L::Real> for BlockedScan<'_, L> {
    #[inline(always)]
    fn visit<P: Primitive<L::Real>>(&mut self, kind: Kind, primitives: &[P], first: usize) {
        let among = self.among.of(kind);
        if among.is_empty() || !self.free.any() {
            return;
        }
        let prepared = P::prepare(self.paths.rays.direction);
        for &index in among {
            let number = first + index as usize;
            let primitive = &primitives[index as usize];
            let t = self
                .paths
                .distance(primitive, &prepared, number, self.methods);
            self.free = self.free & !t.less(self.distance);
            if !self.free.any() {
                return;
            }
        }
    }
}
