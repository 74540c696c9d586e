//! The nearest hit among some primitives, and whether anything stands in a ray's way.

use super::bundle::Beside;
use super::candidates::Among;
use super::paths::{NOTHING, Paths, real};
use super::scan::{Test, Thicket, scan_lists};
use super::walk::Stack;
use crate::plan::{Geometry, Plan, RayOrigin};
use crate::primitive::{FAR_CAUTION, Primitive, WithPrimitive};
use crate::scene::Methods;
use crate::simd::{Mask as _, Real, SimdFloat};

/// What the kernels of a picture share: the proof that the processor has the lanes, and the plan. Without
/// `TREE` they are compiled for plans that have no tree, and are faster: what may be in a list or in a tree
/// is copied back and forth.
pub struct Kernel<'a, L: SimdFloat, const TREE: bool> {
    /// Proof that the processor has these vectors.
    pub token: L::Token,
    /// The plan.
    pub plan: &'a Plan<L::Real>,
}

#[expect(
    clippy::expl_impl_clone_on_copy,
    reason = "derived, it would ask for the same of every lane"
)]
impl<L: SimdFloat, const TREE: bool> Clone for Kernel<'_, L, TREE> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<L: SimdFloat, const TREE: bool> Copy for Kernel<'_, L, TREE> {}

/// The nearest primitives.
#[derive(Clone, Copy, Debug)]
pub struct Nearest<L> {
    /// How far; infinity for nothing.
    pub t: L,
    /// Number of the primitive, see [`crate::primitive::Primitives`]; [`NOTHING`] for nothing.
    pub number: L,
}

impl<'a, L: SimdFloat, const TREE: bool> Kernel<'a, L, TREE> {
    /// What stands in the plan's tree, with the number of its first primitive.
    #[inline(always)]
    pub fn geometry(self) -> Option<(&'a Geometry<L::Real>, usize)> {
        if TREE {
            self.plan.numbered_geometry()
        } else {
            None
        }
    }

    /// What stands in the plan's tree, if it is among these.
    #[inline(always)]
    pub fn thicket<'b>(self, among: Among<'b, L::Real>, active: L::Mask) -> Option<Thicket<'b, L>>
    where
        'a: 'b,
    {
        let (geometry, first) = self.geometry()?;
        among.candidates.has_geometry.then_some(Thicket {
            geometry,
            first,
            roots: among.roots,
            light: among.light,
            back_from: match self.plan.ray_origin {
                RayOrigin::AtHit => among.light.and_then(|light| light.apex(geometry)),
                _ => None,
            },
            active,
            beside: Beside::default(),
            is_boxed: self.plan.is_boxed,
        })
    }
}

impl<L: SimdFloat, const TREE: bool> Kernel<'_, L, TREE> {
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

    /// The nearest primitives along the paths where the mask is set.
    #[inline(always)]
    pub fn nearest(
        self,
        among: Among<L::Real>,
        paths: &Paths<L>,
        active: L::Mask,
        stack: &mut Stack<L::Real>,
    ) -> Nearest<L> {
        let mut test = NearestTest::<L, true> {
            methods: &self.plan.methods,
            best: Nearest {
                t: self.infinity(),
                number: self.splat(NOTHING),
            },
        };
        scan_lists(self.plan, among.candidates, paths, &mut test);
        let mut best = test.best;
        if let Some(thicket) = self.thicket(among, active) {
            best = self.nearest_in(&thicket, paths, best, stack);
        }
        if self.plan.ties.is_empty() {
            best
        } else {
            self.settled(paths, best)
        }
    }

    /// The same, but for what lies in the surface of the nearest and is seen there. Which of them is nearer,
    /// rounding decides; which of them is met, their outlines.
    #[inline(never)]
    fn settled(self, paths: &Paths<L>, nearest: Nearest<L>) -> Nearest<L> {
        L::vectorize(
            self.token,
            #[inline(always)]
            || {
                let mut settled = nearest;
                for tie in &self.plan.ties {
                    let mut open = nearest.number.same(self.splat(tie.number as f64));
                    for &number in &tie.over {
                        if !open.any() {
                            break;
                        }
                        let methods = &self.plan.methods;
                        let t = self.plan.primitives.with(number, Meet { paths, methods });
                        let met = open & t.less(self.infinity());
                        settled.t = L::select(met, t, settled.t);
                        settled.number = L::select(met, self.splat(number as f64), settled.number);
                        open = open & !met;
                    }
                }
                settled
            },
        )
    }

    /// The nearest of `best` and what stands in the tree. A function of its own: it is long, and few
    /// scenes need it.
    #[inline(never)]
    fn nearest_in(
        self,
        thicket: &Thicket<L>,
        paths: &Paths<L>,
        best: Nearest<L>,
        stack: &mut Stack<L::Real>,
    ) -> Nearest<L> {
        L::vectorize(
            self.token,
            #[inline(always)]
            || {
                let mut test = NearestTest::<L, false> {
                    methods: &self.plan.methods,
                    best,
                };
                thicket.scan(paths, stack, &mut test);
                test.best
            },
        )
    }

    /// Where one of the primitives meets the paths before `distance`; looked for only where `wanted`.
    #[inline(always)]
    pub fn blocked(
        self,
        among: Among<L::Real>,
        paths: &Paths<L>,
        (distance, wanted): (L, L::Mask),
        stack: &mut Stack<L::Real>,
    ) -> L::Mask {
        let mut test = BlockedTest::<L, true> {
            methods: &self.plan.methods,
            distance,
            reach: distance,
            free: wanted,
        };
        scan_lists(self.plan, among.candidates, paths, &mut test);
        let mut free = test.free;
        if free.any()
            && let Some(thicket) = self.thicket(among, free)
        {
            free = self.free_in(&thicket, paths, distance, stack);
        }
        wanted & !free
    }

    /// Where nothing in the tree meets the paths before `distance`.
    #[inline(never)]
    fn free_in(
        self,
        thicket: &Thicket<L>,
        paths: &Paths<L>,
        distance: L,
        stack: &mut Stack<L::Real>,
    ) -> L::Mask {
        L::vectorize(
            self.token,
            #[inline(always)]
            || {
                let all = L::Real::from_f64(1.0 + FAR_CAUTION);
                let mut test = BlockedTest::<L, false> {
                    methods: &self.plan.methods,
                    distance,
                    reach: match thicket.back_from {
                        None => distance,
                        Some(_) => distance.like(all),
                    },
                    free: thicket.active,
                };
                thicket.scan(paths, stack, &mut test);
                test.free
            },
        )
    }
}

/// How far one primitive is.
struct Meet<'a, L> {
    paths: &'a Paths<L>,
    methods: &'a Methods,
}

impl<L: SimdFloat> WithPrimitive<L::Real> for Meet<'_, L> {
    type Output = L;

    #[inline(always)]
    fn run<P: Primitive<L::Real>>(self, primitive: &P) -> L {
        primitive.meet(&self.paths.rays, self.methods)
    }
}

/// Looks for the nearest primitive. Of two at the same distance it is the one with the smaller number:
/// the first that is tested, where they are tested in order.
struct NearestTest<'a, L, const LISTED: bool> {
    methods: &'a Methods,
    best: Nearest<L>,
}

impl<L: SimdFloat, const LISTED: bool> Test<L> for NearestTest<'_, L, LISTED> {
    #[inline(always)]
    fn reach(&self) -> L {
        self.best.t
    }

    #[inline(always)]
    fn test<P: Primitive<L::Real>>(
        &mut self,
        primitive: &P,
        prepared: &P::Prepared<L>,
        paths: &Paths<L>,
        number: usize,
    ) {
        let t = paths.distance::<LISTED, P>(primitive, prepared, number, self.methods);
        let own = t.like(real(number));
        let mut closer = t.less(self.best.t);
        if !LISTED {
            closer = closer | (t.same(self.best.t) & own.less(self.best.number));
        }
        self.best.t = L::select(closer, t, self.best.t);
        self.best.number = L::select(closer, own, self.best.number);
    }
}

/// Looks for anything before a distance.
struct BlockedTest<'a, L: SimdFloat, const LISTED: bool> {
    methods: &'a Methods,
    distance: L,
    /// How far boxes are looked for.
    reach: L,
    /// Where nothing was met yet.
    free: L::Mask,
}

impl<L: SimdFloat, const LISTED: bool> Test<L> for BlockedTest<'_, L, LISTED> {
    #[inline(always)]
    fn reach(&self) -> L {
        L::select(self.free, self.reach, self.reach.like_f64(-1.0))
    }

    #[inline(always)]
    fn is_done(&self) -> bool {
        !self.free.any()
    }

    #[inline(always)]
    fn test<P: Primitive<L::Real>>(
        &mut self,
        primitive: &P,
        prepared: &P::Prepared<L>,
        paths: &Paths<L>,
        number: usize,
    ) {
        let t = paths.distance::<LISTED, P>(primitive, prepared, number, self.methods);
        self.free = self.free & !t.less(self.distance);
    }
}
