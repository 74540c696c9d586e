//! Hits on several objects that fill the same surface. Rounding would decide which of them is nearest; instead, of
//! those whose outlines contain the hit, the one that comes first in the order of objects is shown.

use std::ops::Range;

use super::candidates::Targets;
use super::doubt::GRAZING_FACTOR;
use super::intersect::{Kernel, Nearest};
use super::paths::{Paths, real};
use super::scan::Test;
use super::walk::Stack;
use crate::plan::RankedObjects;
use crate::primitive::{Blur, Primitive, WithPrimitive};
use crate::scene::Methods;
use crate::simd::{Mask as _, Real, SimdFloat};

impl<L: SimdFloat, const TREE: bool> Kernel<'_, L, TREE> {
    /// Returns the nearest hits, replaced where another object in the same surface is to be shown.
    #[inline(never)]
    pub fn resolve_ties(
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
                let mut resolved = nearest;
                let infinity = self.infinity();
                let mut remaining = nearest.t.less(infinity).bits();
                while remaining != 0 {
                    let lane = remaining.trailing_zeros() as usize;
                    remaining &= remaining - 1;
                    let number = nearest.number.lane(lane).to_f64() as usize;
                    let Some(tie) = self.plan.tie_of(number) else {
                        continue;
                    };
                    let Range { start, end } = tie.numbers;
                    let (start, end) = (self.splat(start as f64), self.splat(end as f64));
                    let lanes = start.at_most(nearest.number) & nearest.number.less(end);
                    remaining &= !lanes.bits();
                    let mut test = CoincidentTest {
                        methods: &self.plan.methods,
                        ranked: &tie.over,
                        nearest_hit: nearest,
                        max_separation: (nearest.t + nearest.t.like(self.plan.extent))
                            * nearest.t.like(self.plan.clearance),
                        lanes,
                        found: Nearest {
                            t: infinity,
                            number: resolved.number,
                        },
                        rank: infinity,
                    };
                    self.test_listed(&tie.over, paths, &mut test);
                    if tie.over.are_in_tree()
                        && let Some(tree_scan) = self.tree_scan(targets, (lanes, blur))
                    {
                        tree_scan.scan(paths, stack, &mut test);
                    }
                    let (found, is_found) = (test.found, test.rank.less(infinity));
                    resolved.t = L::select(is_found, found.t, resolved.t);
                    resolved.number = L::select(is_found, found.number, resolved.number);
                }
                resolved
            },
        )
    }

    /// Tests those of the objects that are in no tree.
    #[inline(always)]
    fn test_listed(self, ranked: &RankedObjects, paths: &Paths<L>, test: &mut CoincidentTest<L>) {
        for number in ranked.listed() {
            let test_primitive = TestListed {
                paths,
                number,
                test: &mut *test,
            };
            self.plan.primitives.with(number, test_primitive);
        }
    }
}

/// Looks for the first of some objects that is hit where another one was.
struct CoincidentTest<'a, L: SimdFloat> {
    methods: &'a Methods,
    ranked: &'a RankedObjects,
    nearest_hit: Nearest<L>,
    /// Greatest distance between the two hits across the surface.
    max_separation: L,
    /// The lanes in which it is looked for.
    lanes: L::Mask,
    found: Nearest<L>,
    /// Its place in the order of objects; infinity while nothing is found.
    rank: L,
}

impl<L: SimdFloat> Test<L> for CoincidentTest<'_, L> {
    #[inline(always)]
    fn reach(&self) -> L {
        let reach =
            self.nearest_hit.t + self.max_separation * self.max_separation.like_f64(GRAZING_FACTOR);
        L::select(self.lanes, reach, reach.like_f64(-1.0))
    }

    #[inline(always)]
    fn test<P: Primitive<L::Real>>(
        &mut self,
        primitive: &P,
        prepared: &P::Prepared<L>,
        paths: &Paths<L>,
        number: usize,
    ) {
        let Some(rank) = self.ranked.rank_of(number) else {
            return;
        };
        let t = paths.distance::<false, P>(primitive, prepared, number, self.methods);
        let met = self.lanes & t.less(t.like(L::Real::INFINITY));
        let rank = t.like(real(rank));
        if !(met & rank.at_most(self.rank)).any() {
            return;
        }
        let normal = primitive.refine(&paths.rays, t).normal;
        let across = (t - self.nearest_hit.t).abs() * normal.dot(paths.rays.direction).abs();
        let is_nearer = rank.less(self.rank) | (rank.same(self.rank) & t.less(self.found.t));
        let found = met & across.at_most(self.max_separation) & is_nearer;
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
