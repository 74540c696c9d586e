//! The nearest hit among some primitives, and whether anything stands in a ray's way.

use super::candidates::Targets;
use super::doubt::Doubt;
use super::paths::{NOTHING, Paths, real};
use super::scan::{Test, TreeScan, scan_lists};
use super::thin_margin::ThinMargin;
use super::walk::Stack;
use crate::plan::{Geometry, Plan, RayOrigin};
use crate::primitive::{Blur, FAR_CAUTION, Primitive};
use crate::scene::Methods;
use crate::simd::{Mask as _, Real, SimdFloat};

/// What the kernels of a picture share: the proof that the processor has the lanes, and the plan. Without
/// `TREE` they are compiled for plans that have no tree and are not doubted, and are faster: what may be in a list or
/// in a tree is copied back and forth.
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

    /// The nearest primitives along the paths where the mask is set, and where that is in doubt.
    #[inline(always)]
    pub fn nearest(
        self,
        targets: Targets<L::Real>,
        (paths, blur): (&Paths<L>, Blur<L>),
        active: L::Mask,
        stack: &mut Stack<L::Real>,
    ) -> (Nearest<L>, L::Mask) {
        let nothing = Nearest {
            t: self.infinity(),
            number: self.splat(NOTHING),
        };
        let is_tied = !self.plan.ties.is_empty();
        let mut best = nothing;
        let mut doubt = Doubt::new(blur, (self.plan.is_doubted(), !is_tied));
        let mut test = NearestTest::<L, TREE, true> {
            methods: &self.plan.methods,
            best: &mut best,
            active,
            doubt: &mut doubt,
        };
        scan_lists(self.plan, targets.candidates, paths, &mut test);
        if let Some(tree_scan) = self.tree_scan(targets, (active, blur)) {
            // What is lent to a function of its own is in memory for good: those above are in registers.
            let (mut found, mut undecided) = (best, doubt);
            self.nearest_in(&tree_scan, paths, (&mut found, &mut undecided), stack);
            (best, doubt) = (found, undecided);
        }
        let doubt = if doubt.is_asked() {
            (doubt.before(best.t) | doubt.is_tie(best.t, doubt.second)) & active
        } else {
            active & !active
        };
        if is_tied {
            best = self.settled(targets, (paths, blur), best, stack);
        }
        (best, doubt)
    }

    /// Looks in the tree for what is nearer than `best`. A function of its own: it is long, and few
    /// scenes need it. What it finds is written where it is: the whole of it would be copied to and fro, for which the
    /// processor waits.
    #[inline(never)]
    fn nearest_in(
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

    /// What stands before `distance` in the way of the paths; looked for only where `wanted`. Where something is thicker
    /// there than `thick` is told apart, if that is given: the way is then searched until it is found.
    #[inline(always)]
    pub fn blocked(
        self,
        targets: Targets<L::Real>,
        (paths, doubt): (&Paths<L>, Doubt<L, TREE>),
        (distance, wanted, thick): (L, L::Mask, Option<L>),
        stack: &mut Stack<L::Real>,
    ) -> Blocked<L> {
        let none = !wanted & wanted;
        let mut way = Way {
            free: wanted,
            met: none,
            passed: none,
            doubt,
        };
        let mut test = BlockedTest::<L, TREE, true> {
            methods: &self.plan.methods,
            distance,
            sure: doubt.ahead_of(distance),
            reach: distance,
            thick,
            way: &mut way,
        };
        scan_lists(self.plan, targets.candidates, paths, &mut test);
        if way.free.any()
            && let Some(tree_scan) = self.tree_scan(targets, (way.free, way.doubt.blur))
        {
            let mut known = way;
            self.way_in(&tree_scan, paths, (distance, thick, &mut known), stack);
            way = known;
        }
        Blocked {
            anywhere: wanted & (!way.free | way.passed | way.met),
            wide: wanted & !way.free,
            // What may be behind the light is not looked for. What is passed by says nothing of what is wide.
            doubt: way.free & way.doubt.from.at_most(distance),
        }
    }

    /// The same among what is in the tree.
    #[inline(never)]
    fn way_in(
        self,
        tree_scan: &TreeScan<L>,
        paths: &Paths<L>,
        (distance, thick, way): (L, Option<L>, &mut Way<L, TREE>),
        stack: &mut Stack<L::Real>,
    ) {
        L::vectorize(
            self.token,
            #[inline(always)]
            || {
                let all = distance.like_f64(1.0 + FAR_CAUTION);
                let mut test = BlockedTest::<L, TREE, false> {
                    methods: &self.plan.methods,
                    distance,
                    sure: way.doubt.ahead_of(distance),
                    reach: match tree_scan.back_from {
                        None => distance,
                        Some(_) => all * way.doubt.stretch(distance),
                    },
                    thick,
                    way,
                };
                tree_scan.scan(paths, stack, &mut test);
            },
        );
    }
}

/// What stands before something.
#[derive(Clone, Copy, Debug)]
pub struct Blocked<L: SimdFloat> {
    /// Where anything does.
    pub anywhere: L::Mask,
    /// Where something does that is not passed by.
    pub wide: L::Mask,
    /// Where one of both is in doubt.
    pub doubt: L::Mask,
}

/// Looks for the nearest primitive. Of two at the same distance it is the one with the smaller number:
/// the first that is tested, where they are tested in order.
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
        self.doubt.after(self.best.t)
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
        let t = if doubt.is_asked() {
            let (primitive, asked) = ((primitive, number), (self.methods, self.active));
            let Some((t, from)) = doubt.distance::<LISTED, P>(primitive, prepared, paths, asked)
            else {
                return;
            };
            doubt.from = doubt.from.min(from);
            doubt.second = doubt.second.min(t.max(self.best.t));
            t
        } else {
            paths.distance::<LISTED, P>(primitive, prepared, number, self.methods)
        };
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
struct BlockedTest<'a, L: SimdFloat, const TREE: bool, const LISTED: bool> {
    methods: &'a Methods,
    distance: L,
    /// What is nearer than that is nearer than the distance.
    sure: L,
    /// How far boxes are looked for.
    reach: L,
    /// What is no thicker is passed by, if that is given.
    thick: Option<L>,
    way: &'a mut Way<L, TREE>,
}

/// What is known of the way before a distance.
#[derive(Clone, Copy)]
struct Way<L: SimdFloat, const TREE: bool> {
    /// Where nothing was met yet for sure, but what was passed by.
    free: L::Mask,
    /// Where something was met, sure or not.
    met: L::Mask,
    /// Where something was met for sure and passed by. Noted in `met`, it makes plain pictures of lists 1.06 times as slow.
    passed: L::Mask,
    doubt: Doubt<L, TREE>,
}

impl<L: SimdFloat, const TREE: bool, const LISTED: bool> Test<L>
    for BlockedTest<'_, L, TREE, LISTED>
{
    #[inline(always)]
    fn reach(&self) -> L {
        L::select(self.way.free, self.reach, self.reach.like_f64(-1.0))
    }

    #[inline(always)]
    fn is_done(&self) -> bool {
        !self.way.free.any()
    }

    #[inline(always)]
    fn test<P: Primitive<L::Real>>(
        &mut self,
        primitive: &P,
        prepared: &P::Prepared<L>,
        paths: &Paths<L>,
        number: usize,
    ) {
        let way = &mut *self.way;
        let is_met = if way.doubt.is_asked() {
            let (primitive, asked) = ((primitive, number), (self.methods, way.free));
            let distance = way
                .doubt
                .distance::<LISTED, P>(primitive, prepared, paths, asked);
            let Some((t, from)) = distance else { return };
            // What is met for sure leaves no doubt of itself; there may be some of what is behind it, if it is passed by.
            let is_met = t.less(self.sure) & self.distance.less(from);
            let open = L::select(is_met, way.doubt.from, from.min(t));
            way.doubt.from = way.doubt.from.min(open);
            way.met = way.met | t.less(self.distance);
            is_met
        } else {
            let t = paths.distance::<LISTED, P>(primitive, prepared, number, self.methods);
            t.less(self.distance)
        };
        let is_end = match self.thick {
            None => is_met,
            Some(thick) => {
                way.passed = way.passed | way.free & is_met;
                is_met & thick.less(primitive.breadth(paths.rays.direction))
            }
        };
        way.free = way.free & !is_end;
    }
}
