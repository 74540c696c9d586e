//! The nearest hit among primitives, and whether anything blocks a ray.

use super::candidates::Targets;
use super::doubt::{Doubt, DoubtScope};
use super::paths::{NO_PRIMITIVE, Paths, real};
use super::scan::{Test, TreeScan, scan_lists};
use super::thin_margin::ThinMargin;
use super::walk::Stack;
use crate::plan::{Geometry, Plan, RayOrigin};
use crate::primitive::{Blur, FAR_CAUTION, Primitive};
use crate::scene::Methods;
use crate::simd::{Mask as _, Real, SimdFloat};

/// The context that all kernels of a picture share: the SIMD token and the plan. Without `TREE`, kernels are
/// compiled for plans that have no tree and track no doubt. These are faster: in the others, values that may come from
/// a list or from a tree are copied back and forth.
pub struct Kernel<'a, L: SimdFloat, const TREE: bool> {
    /// Proof that the processor supports these vectors.
    pub token: L::Token,
    /// The plan.
    pub plan: &'a Plan<L::Real>,
}

#[expect(
    clippy::expl_impl_clone_on_copy,
    reason = "`derive` would require `L: Clone`"
)]
impl<L: SimdFloat, const TREE: bool> Clone for Kernel<'_, L, TREE> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<L: SimdFloat, const TREE: bool> Copy for Kernel<'_, L, TREE> {}

/// The nearest primitive in each lane.
#[derive(Clone, Copy, Debug)]
pub struct Nearest<L> {
    /// Distance along the ray; infinity if nothing was hit.
    pub t: L,
    /// Number of the primitive, see [`crate::primitive::Primitives`]; [`NO_PRIMITIVE`] if nothing was hit.
    pub number: L,
}

impl<'a, L: SimdFloat, const TREE: bool> Kernel<'a, L, TREE> {
    /// Returns what is stored in the plan's tree, with the number of its first primitive; `None` without `TREE`.
    #[inline(always)]
    pub fn geometry(self) -> Option<(&'a Geometry<L::Real>, usize)> {
        if TREE {
            self.plan.numbered_geometry()
        } else {
            None
        }
    }

    /// Returns a scan of the plan's tree, if the candidates include the tree.
    #[inline(always)]
    pub fn tree_scan<'b>(
        self,
        targets: Targets<'b, L::Real>,
        (active, blur): (L::Mask, Blur<L>),
    ) -> Option<TreeScan<'b, L>>
    where
        'a: 'b,
    {
        let (geometry, first) = self.geometry()?;
        targets.candidates.has_geometry.then_some(TreeScan {
            geometry,
            first,
            entry_points: targets.entry_points,
            culled_faces: targets.culled_faces,
            back_from: match self.plan.ray_origin {
                RayOrigin::AtHit => targets.light.and_then(|light| light.apex(geometry)),
                _ => None,
            },
            active,
            blur,
            margin: ThinMargin::default(),
            is_boxed: self.plan.is_boxed,
        })
    }
}

impl<L: SimdFloat, const TREE: bool> Kernel<'_, L, TREE> {
    /// Returns the number in every lane.
    #[inline(always)]
    pub fn splat(self, value: f64) -> L {
        L::splat(self.token, L::Real::from_f64(value))
    }

    /// Returns infinity in every lane.
    #[inline(always)]
    pub fn infinity(self) -> L {
        L::splat(self.token, L::Real::INFINITY)
    }

    /// Finds the nearest primitives along the paths where the mask is set. The returned mask tells where rounding
    /// may decide which these are, as far as that is in the scope, if the paths have this lateral error.
    #[inline(always)]
    pub fn nearest(
        self,
        targets: Targets<L::Real>,
        (paths, blur, scope): (&Paths<L>, Blur<L>, DoubtScope),
        active: L::Mask,
        stack: &mut Stack<L::Real>,
    ) -> (Nearest<L>, L::Mask) {
        let nothing = Nearest {
            t: self.infinity(),
            number: self.splat(NO_PRIMITIVE),
        };
        let mut best = nothing;
        let mut doubt = Doubt::new(blur, scope);
        let mut test = NearestTest::<L, TREE, true> {
            methods: &self.plan.methods,
            best: &mut best,
            active,
            doubt: &mut doubt,
        };
        scan_lists(self.plan, targets.candidates, paths, &mut test);
        if let Some(tree_scan) = self.tree_scan(targets, (active, doubt.blur)) {
            // A value that is lent to an out-of-line function stays in memory; the originals can stay in registers.
            let (mut found, mut undecided) = (best, doubt);
            self.nearest_in_tree(&tree_scan, paths, (&mut found, &mut undecided), stack);
            (best, doubt) = (found, undecided);
        }
        let doubt = if doubt.is_enabled() {
            doubt.about_nearest(best.t) & active
        } else {
            active & !active
        };
        if !self.plan.ties.is_empty() {
            best = self.resolve_ties(targets, (paths, blur), best, stack);
        }
        (best, doubt)
    }

    /// Looks in the tree for primitives nearer than `best`. Out of line: it is long, and few scenes need it. The
    /// results are written in place: returned by value, they would be copied back and forth, and the processor would
    /// stall on that.
    #[inline(never)]
    fn nearest_in_tree(
        self,
        tree_scan: &TreeScan<L>,
        paths: &Paths<L>,
        (best, doubt): (&mut Nearest<L>, &mut Doubt<L, TREE>),
        stack: &mut Stack<L::Real>,
    ) {
        L::vectorize(
            self.token,
            #[inline(always)]
            || {
                let mut test = NearestTest::<L, TREE, false> {
                    methods: &self.plan.methods,
                    best,
                    active: tree_scan.active,
                    doubt,
                };
                tree_scan.scan(paths, stack, &mut test);
            },
        );
    }

    /// Finds occluders of the paths nearer than `distance`, only where `wanted` is set. If `thin_width` is given,
    /// occluders that are thicker are also reported by themselves, and the search goes on until one is found.
    #[inline(always)]
    pub fn blocked(
        self,
        targets: Targets<L::Real>,
        (paths, doubt): (&Paths<L>, Doubt<L, TREE>),
        (distance, wanted, thin_width): (L, L::Mask, Option<L>),
        stack: &mut Stack<L::Real>,
    ) -> Blocked<L> {
        let none = !wanted & wanted;
        let mut state = OcclusionState {
            free: wanted,
            possible_hit: none,
            certain_hit: none,
            doubt,
        };
        let mut test = BlockedTest::<L, TREE, true> {
            methods: &self.plan.methods,
            distance,
            certain_distance: doubt.lower_bound(distance),
            reach: distance,
            thin_width,
            state: &mut state,
        };
        scan_lists(self.plan, targets.candidates, paths, &mut test);
        if state.free.any()
            && let Some(tree_scan) = self.tree_scan(targets, (state.free, state.doubt.blur))
        {
            let mut tree_state = state;
            self.blocked_in_tree(
                &tree_scan,
                paths,
                (distance, thin_width, &mut tree_state),
                stack,
            );
            state = tree_state;
        }
        Blocked {
            anywhere: wanted & (!state.free | state.certain_hit | state.possible_hit),
            by_thick: wanted & !state.free,
            // Possible hits behind the light do not count. A thin occluder does not settle whether there is a wide
            // one.
            doubt: state.free & state.doubt.undecided_from.at_most(distance),
        }
    }

    /// Continues [`Self::blocked`] in the tree.
    #[inline(never)]
    fn blocked_in_tree(
        self,
        tree_scan: &TreeScan<L>,
        paths: &Paths<L>,
        (distance, thin_width, state): (L, Option<L>, &mut OcclusionState<L, TREE>),
        stack: &mut Stack<L::Real>,
    ) {
        L::vectorize(
            self.token,
            #[inline(always)]
            || {
                let whole_distance = distance.like_f64(1.0 + FAR_CAUTION);
                let mut test = BlockedTest::<L, TREE, false> {
                    methods: &self.plan.methods,
                    distance,
                    certain_distance: state.doubt.lower_bound(distance),
                    reach: match tree_scan.back_from {
                        None => distance,
                        Some(_) => whole_distance * state.doubt.stretch(distance),
                    },
                    thin_width,
                    state,
                };
                tree_scan.scan(paths, stack, &mut test);
            },
        );
    }
}

/// Where paths are blocked.
#[derive(Clone, Copy, Debug)]
pub struct Blocked<L: SimdFloat> {
    /// Where there is any occluder.
    pub anywhere: L::Mask,
    /// Where there is an occluder that is thicker than the given limit, or any if there is no limit.
    pub by_thick: L::Mask,
    /// Where rounding may decide one of the two.
    pub doubt: L::Mask,
}

/// Looks for the nearest primitive. Of two at the same distance, the one with the smaller number wins: in lists,
/// which are tested in order, that is the first one.
struct NearestTest<'a, L: SimdFloat, const TREE: bool, const LISTED: bool> {
    methods: &'a Methods,
    best: &'a mut Nearest<L>,
    active: L::Mask,
    doubt: &'a mut Doubt<L, TREE>,
}

impl<L: SimdFloat, const TREE: bool, const LISTED: bool> Test<L>
    for NearestTest<'_, L, TREE, LISTED>
{
    #[inline(always)]
    fn reach(&self) -> L {
        self.doubt.upper_bound(self.best.t)
    }

    #[inline(always)]
    fn test<P: Primitive<L::Real>>(
        &mut self,
        primitive: &P,
        prepared: &P::Prepared<L>,
        paths: &Paths<L>,
        number: usize,
    ) {
        let doubt = &mut *self.doubt;
        let t = if doubt.is_enabled() {
            let (primitive, query) = ((primitive, number), (self.methods, self.active));
            let Some((t, from)) = doubt.distance::<LISTED, P>(primitive, prepared, paths, query)
            else {
                return;
            };
            doubt.undecided_from = doubt.undecided_from.min(from);
            let mut other = t.max(self.best.t);
            if !LISTED {
                // Several slices of a face may be met, but it is no other one.
                let is_again = self.best.number.same(other.like(real(number)));
                other = L::select(is_again, other.like(L::Real::INFINITY), other);
            }
            doubt.second_nearest = doubt.second_nearest.min(other);
            t
        } else {
            paths.distance::<LISTED, P>(primitive, prepared, number, self.methods)
        };
        let numbers = t.like(real(number));
        let mut closer = t.less(self.best.t);
        if !LISTED {
            closer = closer | (t.same(self.best.t) & numbers.less(self.best.number));
        }
        self.best.t = L::select(closer, t, self.best.t);
        self.best.number = L::select(closer, numbers, self.best.number);
    }
}

/// Looks for any primitive nearer than a distance.
struct BlockedTest<'a, L: SimdFloat, const TREE: bool, const LISTED: bool> {
    methods: &'a Methods,
    distance: L,
    /// Hits nearer than this are nearer than `distance` however they were rounded.
    certain_distance: L,
    /// How far boxes are tested.
    reach: L,
    /// If given, primitives that are no thicker do not end the search.
    thin_width: Option<L>,
    state: &'a mut OcclusionState<L, TREE>,
}

/// What is known so far about the paths up to the distance.
#[derive(Clone, Copy)]
struct OcclusionState<L: SimdFloat, const TREE: bool> {
    /// Where no certain hit was found yet, except on primitives that are too thin to end the search.
    free: L::Mask,
    /// Where a hit was found, certain or not; only noted if doubt is tracked.
    possible_hit: L::Mask,
    /// Where a certain hit was found while a thickness is given. Noting it in `possible_hit` makes plain pictures of
    /// lists 1.06 times as slow.
    certain_hit: L::Mask,
    doubt: Doubt<L, TREE>,
}

impl<L: SimdFloat, const TREE: bool, const LISTED: bool> Test<L>
    for BlockedTest<'_, L, TREE, LISTED>
{
    #[inline(always)]
    fn reach(&self) -> L {
        L::select(self.state.free, self.reach, self.reach.like_f64(-1.0))
    }

    #[inline(always)]
    fn is_done(&self) -> bool {
        !self.state.free.any()
    }

    #[inline(always)]
    fn test<P: Primitive<L::Real>>(
        &mut self,
        primitive: &P,
        prepared: &P::Prepared<L>,
        paths: &Paths<L>,
        number: usize,
    ) {
        let state = &mut *self.state;
        let is_met = if state.doubt.is_enabled() {
            let (primitive, query) = ((primitive, number), (self.methods, state.free));
            let distance = state
                .doubt
                .distance::<LISTED, P>(primitive, prepared, paths, query);
            let Some((t, from)) = distance else { return };
            // A certain hit leaves no doubt about itself; if it does not end the search, doubt about what is behind
            // it may remain.
            let is_met = t.less(self.certain_distance) & self.distance.less(from);
            let undecided_from = L::select(is_met, state.doubt.undecided_from, from.min(t));
            state.doubt.undecided_from = state.doubt.undecided_from.min(undecided_from);
            state.possible_hit = state.possible_hit | t.less(self.distance);
            is_met
        } else {
            let t = paths.distance::<LISTED, P>(primitive, prepared, number, self.methods);
            t.less(self.distance)
        };
        let is_end = match self.thin_width {
            None => is_met,
            Some(thin_width) => {
                state.certain_hit = state.certain_hit | state.free & is_met;
                is_met & thin_width.less(primitive.blocking_width(paths.rays.direction))
            }
        };
        state.free = state.free & !is_end;
    }
}
