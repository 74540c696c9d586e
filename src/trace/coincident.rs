//! Hits on several objects that fill the same surface. Rounding would decide which of them is nearest; instead, of
//! those whose outlines contain the hit, the one that comes first in the order of objects is shown.

use std::ops::Range;

use super::candidates::Targets;
use super::intersect::{Kernel, Nearest};
use super::paths::{Paths, real};
use super::scan::Test;
use super::walk::Stack;
use crate::plan::RankedObjects;
use crate::primitive::{Blur, Primitive, WithPrimitive};
use crate::scene::Methods;
use crate::simd::{Mask as _, Real, SimdFloat};

/// Coincident surfaces are searched for along the rays up to this many times the distance allowed between them:
/// that is how far apart they are along a ray at 89 degrees from the normal.
const SLANT: f64 = 64.0;

impl<L: SimdFloat, const TREE: bool> Kernel<'_, L, TREE> {
    /// Returns the nearest hits, replaced where another object in the same surface is to be shown.
    #[inline(never)]
    pub fn settled(
        self,
        targets: Targets<L::Real>,
        (paths, blur): (&Paths<L>, Blur<L>),
        nearest: Nearest<L>,
        stack: &mut Stack<L::Real>,
    ) -> Nearest<L> {
        L::vectorize(
            self.token,
            #[inline(always)]
            || {
                let mut settled = nearest;
                let infinity = self.infinity();
                let mut left = nearest.t.less(infinity).bits();
                while left != 0 {
                    let lane = left.trailing_zeros() as usize;
                    left &= left - 1;
                    let number = nearest.number.lane(lane).to_f64() as usize;
                    let Some(tie) = self.plan.tie_of(number) else {
                        continue;
                    };
                    let Range { start, end } = tie.numbers;
                    let (start, end) = (self.splat(start as f64), self.splat(end as f64));
                    let here = start.at_most(nearest.number) & nearest.number.less(end);
                    left &= !here.bits();
                    let mut test = CoincidentTest {
                        methods: &self.plan.methods,
                        over: &tie.over,
                        met: nearest,
                        apart: (nearest.t + nearest.t.like(self.plan.extent))
                            * nearest.t.like(self.plan.clearance),
                        here,
                        found: Nearest {
                            t: infinity,
                            number: settled.number,
                        },
                        rank: infinity,
                    };
                    self.meet_all(&tie.over, paths, &mut test);
                    if tie.over.are_in_tree()
                        && let Some(tree_scan) = self.tree_scan(targets, (here, blur))
                    {
                        tree_scan.scan(paths, stack, &mut test);
                    }
                    let (found, is_found) = (test.found, test.rank.less(infinity));
                    settled.t = L::select(is_found, found.t, settled.t);
                    settled.number = L::select(is_found, found.number, settled.number);
                }
                settled
            },
        )
    }

    /// Tests those of the objects that are in no tree.
    #[inline(always)]
    fn meet_all(self, over: &RankedObjects, paths: &Paths<L>, test: &mut CoincidentTest<L>) {
        for number in over.listed() {
            let meet = TestListed {
                paths,
                number,
                test: &mut *test,
            };
            self.plan.primitives.with(number, meet);
        }
    }
}

/// Looks for the first of some objects that is hit where another one was.
struct CoincidentTest<'a, L: SimdFloat> {
    methods: &'a Methods,
    over: &'a RankedObjects,
    met: Nearest<L>,
    /// Greatest distance between the two hits across the surface.
    apart: L,
    /// The lanes in which it is looked for.
    here: L::Mask,
    found: Nearest<L>,
    /// Its place in the order of objects; infinity while nothing is found.
    rank: L,
}

impl<L: SimdFloat> Test<L> for CoincidentTest<'_, L> {
    #[inline(always)]
    fn reach(&self) -> L {
        let reach = self.met.t + self.apart * self.apart.like_f64(SLANT);
        L::select(self.here, reach, reach.like_f64(-1.0))
    }

    #[inline(always)]
    fn test<P: Primitive<L::Real>>(
        &mut self,
        primitive: &P,
        prepared: &P::Prepared<L>,
        paths: &Paths<L>,
        number: usize,
    ) {
        let Some(rank) = self.over.rank_of(number) else {
            return;
        };
        let t = paths.distance::<false, P>(primitive, prepared, number, self.methods);
        let met = self.here & t.less(t.like(L::Real::INFINITY));
        let rank = t.like(real(rank));
        if !(met & rank.at_most(self.rank)).any() {
            return;
        }
        let normal = primitive.refine(&paths.rays, t).normal;
        let across = (t - self.met.t).abs() * normal.dot(paths.rays.direction).abs();
        let is_nearer = rank.less(self.rank) | (rank.same(self.rank) & t.less(self.found.t));
        let found = met & across.at_most(self.apart) & is_nearer;
        self.rank = L::select(found, rank, self.rank);
        self.found.t = L::select(found, t, self.found.t);
        self.found.number = L::select(found, t.like(real(number)), self.found.number);
    }
}

/// Tests a primitive that is in no tree.
struct TestListed<'a, 'b, L: SimdFloat> {
    paths: &'a Paths<L>,
    number: usize,
    test: &'a mut CoincidentTest<'b, L>,
}

impl<L: SimdFloat> WithPrimitive<L::Real> for TestListed<'_, '_, L> {
    type Output = ();

    #[inline(always)]
    fn run<P: Primitive<L::Real>>(self, primitive: &P) {
        let prepared = P::prepare(self.paths.rays.direction);
        self.test
            .test(primitive, &prepared, self.paths, self.number);
    }
}
