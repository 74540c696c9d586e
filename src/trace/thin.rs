//! Things that may slip between the samples of a pixel: primitives that are narrower than two pixels, their shadows
//! and their mirror images. A sample that passes such a thing closely notes that, and its surroundings are then
//! examined.

use super::candidates::{Candidates, Targets};
use super::entry_points::EntryPoints;
use super::footprint::{RayCone, distance_in_pixels};
use super::intersect::Kernel;
use super::paths::Paths;
use super::scan::{Test, TreeScan, scan_lists};
use super::thin_cull::small_mesh_pixels;
use super::thin_margin::ThinMargin;
use super::thresholds::{
    CROWDED_OBJECTS, MAX_SPREAD_INTO_MESHES, MAX_SPREAD_TO_LIGHTS, MAX_SPREAD_WHEN_CROWDED,
    MERGED_SIZE, MIN_NOTED_DISTANCE, THIN_WIDTH,
};
use super::walk::Stack;
use crate::plan::PackedMesh;
use crate::primitive::{Approach, Blur, Primitive};
use crate::simd::{Mask as _, Real, SimdFloat, Vec3};

/// Rays that search for thin things beside them.
#[derive(Clone, Copy, Debug)]
pub struct ThinQuery<'a, L: SimdFloat> {
    /// The rays.
    pub paths: &'a Paths<L>,
    /// Where there is a ray.
    pub active: L::Mask,
    /// The width of a pixel along them.
    pub cone: RayCone<L>,
    /// The same around what is treated as one thing in meshes. It does not narrow towards a light: ever more would
    /// have to be told apart, for ever less of a shadow.
    pub in_meshes: RayCone<L>,
    /// How fast a pixel widens along these rays or, for rays to a light, along those that have led there; curved
    /// mirrors make that more. The limits are multiples of the camera's own: rays with more than
    /// [`MAX_SPREAD_INTO_MESHES`] do not look into meshes, and rays to a light with more than [`MAX_SPREAD_TO_LIGHTS`]
    /// look for nothing. In crowded scenes, rays to a light look for nothing above [`MAX_SPREAD_INTO_MESHES`], and
    /// other rays above [`MAX_SPREAD_WHEN_CROWDED`].
    pub spread: L,
    /// How far they go.
    pub reach: L,
    /// Whether they go to a light: the far sides of solids are then those that the light does not see.
    pub is_to_light: bool,
}

impl<L: SimdFloat, const TREE: bool> Kernel<'_, L, TREE> {
    /// Returns how many pixels away from the rays the nearest primitive is that is narrower there than [`THIN_WIDTH`]
    /// pixels; infinity for none.
    #[inline(always)]
    pub fn thin_distance(
        self,
        targets: &Candidates,
        query: &ThinQuery<L>,
        stack: &mut Stack<L::Real>,
    ) -> L {
        let spread = self.plan.view.spread();
        let mesh_spread_limit = spread * L::Real::from_f64(MAX_SPREAD_INTO_MESHES);
        let spread_limit = match (
            self.plan.visible_objects < CROWDED_OBJECTS,
            query.is_to_light,
        ) {
            (true, true) => spread * L::Real::from_f64(MAX_SPREAD_TO_LIGHTS),
            (true, false) => L::Real::INFINITY,
            (false, true) => mesh_spread_limit,
            (false, false) => spread * L::Real::from_f64(MAX_SPREAD_WHEN_CROWDED),
        };
        let may_enter_meshes = query
            .spread
            .at_most(self.splat(0.0).like(mesh_spread_limit));
        let may_search = query.spread.at_most(self.splat(0.0).like(spread_limit));
        let query = &ThinQuery {
            active: query.active & may_search,
            ..*query
        };
        let mut test = ThinTest::new(query, true, self.infinity());
        scan_lists(self.plan, targets, query.paths, &mut test);
        let mut best = test.best;
        // Entry points that were computed for the rays would leave out what is beside them.
        let entry_points = EntryPoints::default();
        let targets = Targets {
            candidates: targets,
            entry_points: &entry_points,
            light: None,
            culled_faces: &[],
        };
        let exact = Blur::splat(self.token, Blur::NONE);
        // Separately, since boxes are widened by the widest pixel of all rays.
        for (lanes, enters_meshes) in [(may_enter_meshes, true), (!may_enter_meshes, false)] {
            let lanes = query.active & lanes;
            if lanes.any()
                && let Some(tree_scan) = self.tree_scan(targets, (lanes, exact))
            {
                best = self.thin_distance_in_tree(&tree_scan, (query, enters_meshes), best, stack);
            }
        }
        L::select(query.active, best, self.infinity())
    }

    /// Returns `best` or, if that is nearer, the distance in pixels of the nearest thin thing in the tree; in meshes
    /// as well if they are entered.
    #[inline(never)]
    fn thin_distance_in_tree(
        self,
        tree_scan: &TreeScan<L>,
        (query, enters_meshes): (&ThinQuery<L>, bool),
        best: L,
        stack: &mut Stack<L::Real>,
    ) -> L {
        L::vectorize(
            self.token,
            #[inline(always)]
            || {
                let active = tree_scan.active;
                let (zero, minus_infinity) = (self.splat(0.0), self.splat(-1.0) * self.infinity());
                let widest = |width: L| L::select(active, width, zero).greatest();
                let spread = L::select(active, query.cone.spread, minus_infinity).greatest();
                let margin = ThinMargin {
                    narrowing: L::Real::ZERO.max(-spread),
                    min_width: widest(query.in_meshes.width),
                    ..ThinMargin::new(widest(query.cone.width), L::Real::ZERO.max(spread))
                };
                let tree_scan = TreeScan {
                    margin,
                    // The search for thin things is the same whether the plan uses boxes or not.
                    is_boxed: true,
                    ..*tree_scan
                };
                let query = ThinQuery { active, ..*query };
                let mut test = ThinTest::new(&query, enters_meshes, best);
                tree_scan.scan(query.paths, stack, &mut test);
                L::select(active, test.best, best)
            },
        )
    }
}

/// Looks for the thin thing that the rays pass most closely.
struct ThinTest<'a, L: SimdFloat> {
    query: &'a ThinQuery<'a, L>,
    /// How many pixels away the nearest one is.
    best: L,
    /// Whether the rays look into meshes, and not only at small ones as a whole.
    enters_meshes: bool,
    /// While a mesh is tested, the rays for which its parts count.
    face_lanes: L::Mask,
    /// The width of a pixel around what is treated as one thing.
    cone: RayCone<L>,
    /// The rays that have treated a box around the tested primitive as one thing, bit by bit, and those for which
    /// the primitive still counts.
    merged_lanes: u64,
    unmerged_lanes: L::Mask,
}

/// How rays pass a ball.
struct BallApproach<L> {
    /// Distance along the rays at which they are closest to its middle.
    along: L,
    /// Distance of the middle from the rays.
    off: L,
    /// Its radius.
    radius: L,
    /// Width of a pixel there.
    width: L,
}

impl<'a, L: SimdFloat> ThinTest<'a, L> {
    /// Creates a test for thin things that are fewer than `best` pixels away.
    #[inline(always)]
    fn new(query: &'a ThinQuery<'a, L>, enters_meshes: bool, best: L) -> Self {
        let all = query.active | !query.active;
        Self {
            query,
            best,
            enters_meshes,
            face_lanes: all,
            cone: query.cone,
            merged_lanes: 0,
            unmerged_lanes: all,
        }
    }

    #[inline(always)]
    fn approach_ball(
        &self,
        center: Vec3<L::Real>,
        radius: L::Real,
        paths: &Paths<L>,
    ) -> BallApproach<L> {
        let x = paths.rays.origin - paths.rays.origin.like(center);
        let along = -paths.rays.direction.dot(x);
        let off = (x + paths.rays.direction * along).length();
        BallApproach {
            along,
            off,
            radius: off.like(radius),
            width: self.cone.width_at(along.max(off.like(L::Real::ZERO))),
        }
    }

    /// Returns for which rays a primitive counts that they approach like this, and how wide a pixel is there.
    #[inline(always)]
    fn counts<P: Primitive<L::Real>>(&self, primitive: &P, approach: &Approach<L>) -> (L::Mask, L) {
        let ThinQuery { cone, reach, .. } = self.query;
        let Approach { from, to, size, .. } = *approach;
        let zero = to.like(L::Real::ZERO);
        let width = cone.width_at(to).max(cone.width_at(from.max(zero)));
        let is_before = from.less(*reach + primitive.margin(width));
        let thin = size.less(width * to.like_f64(THIN_WIDTH)) & zero.less(to) & is_before;
        (thin & self.face_lanes & self.unmerged_lanes, width)
    }

    /// Returns how many pixels away from the rays a primitive is; infinity where it does not count.
    #[inline(always)]
    fn pixels_to<P: Primitive<L::Real>>(
        &self,
        primitive: &P,
        prepared: &P::Prepared<L>,
        paths: &Paths<L>,
        number: usize,
    ) -> L {
        let direction = paths.rays.direction;
        let infinity = direction.x.like(L::Real::INFINITY);
        let is_to_light = self.query.is_to_light;
        let far = primitive.is_far(if is_to_light { -direction } else { direction });
        let active = match far {
            Some(far) => self.query.active & !far,
            None => self.query.active,
        };
        if !active.any() {
            return infinity;
        }
        let approach = primitive.approach(
            &paths.rays,
            prepared,
            // Beyond a pixel, the exact distance does not matter.
            #[inline(always)]
            |rough| {
                let (counts, width) = self.counts(primitive, rough);
                (counts & active & rough.distance.less(width)).any()
            },
        );
        let Some(approach) = approach else {
            return infinity;
        };
        let (counts, width) = self.counts(primitive, &approach);
        let mut counts = counts & active;
        // A curved surface surrounds the rays that start on it.
        if P::IS_CURVED {
            counts = counts & !paths.ignored.starts_on(number);
        }
        distance_in_pixels(counts, approach.distance, width)
    }

    /// Notes how many pixels away from the rays something is, where these pass a box closely. That is asked last,
    /// since it takes long.
    #[inline(always)]
    fn note(&mut self, near: L, passing: impl FnOnce() -> L::Mask) {
        if near.less(self.best).any() {
            let near = L::select(passing(), near, near.like(L::Real::INFINITY));
            self.best = self.best.min(near);
        }
    }
}

impl<L: SimdFloat> BallApproach<L> {
    /// Returns how many pixels away from the rays a ball is, given its distance; infinity where it does not count.
    #[inline(always)]
    fn in_pixels(&self, counts: L::Mask, distance: L) -> L {
        let width = self.width;
        // Whether a ray hits what is inside does not matter: it passes closely enough.
        let distance = distance.max(width * width.like_f64(MIN_NOTED_DISTANCE));
        distance_in_pixels(counts, distance, width)
    }
}

impl<L: SimdFloat> Test<L> for ThinTest<'_, L> {
    const FINDS_THIN: bool = true;

    #[inline(always)]
    fn test_ball(
        &mut self,
        mesh: &PackedMesh<L::Real>,
        widest: L::Real,
        paths: &Paths<L>,
        active: L::Mask,
    ) -> Option<L::Mask> {
        let (center, radius) = mesh.bvh.bounds.ball();
        let small = small_mesh_pixels(mesh);
        if widest * small <= radius + radius {
            if !self.enters_meshes {
                return None;
            }
            self.cone = self.query.in_meshes;
            return Some(active);
        }
        let ball = self.approach_ball(center, radius, paths);
        let is_small = (ball.radius + ball.radius).less(ball.width * ball.width.like(small));
        // The box reaches farther than the mesh: rays through its corners pass the mesh.
        let distance = ball.off - ball.off.like(mesh.reach);
        let is_before = (ball.along - ball.radius).less(self.query.reach + ball.width);
        let is_ahead = ball
            .width
            .like(L::Real::ZERO)
            .less(ball.along + ball.radius);
        // Rays for which the mesh is not thin enough, or which do not come close enough to its box, do not count:
        // they are only here because of other rays of the packet.
        let thickness = ball.width.like(mesh.bvh.thinnest);
        let is_thin = thickness.less(ball.width * ball.width.like_f64(THIN_WIDTH));
        let entry = mesh.bvh.bounds.entry(&paths.rays, ball.width);
        let is_close = entry.less(self.query.reach + ball.width);
        let counts = is_small & is_thin & is_before & is_ahead & is_close & self.unmerged_lanes;
        self.best = self.best.min(ball.in_pixels(counts, distance));
        let larger = active & !is_small;
        if !self.enters_meshes || !larger.any() {
            return None;
        }
        self.face_lanes = !is_small;
        self.cone = self.query.in_meshes;
        Some(larger)
    }

    #[inline(always)]
    fn test_merged_box(
        &mut self,
        (center, radius): (Vec3<L::Real>, L::Real),
        thickness: L::Real,
        paths: &Paths<L>,
        (active, passing): (L::Mask, impl FnOnce() -> L::Mask),
    ) -> u64 {
        let ball = self.approach_ball(center, radius, paths);
        let (width, zero) = (ball.width, ball.width.like(L::Real::ZERO));
        let is_merged = (ball.radius + ball.radius).less(width * width.like_f64(MERGED_SIZE));
        let is_thin = width
            .like(thickness)
            .less(width * width.like_f64(THIN_WIDTH));
        let is_in_reach = zero.less(ball.along) & ball.along.less(self.query.reach + width);
        let lanes = active & self.face_lanes & self.unmerged_lanes;
        let counts = is_merged & is_thin & is_in_reach & lanes;
        self.note(ball.in_pixels(counts, ball.off - ball.radius), passing);
        (is_merged | !active).bits()
    }

    #[inline(always)]
    fn own_margin(&self) -> Option<ThinMargin<L>> {
        let ThinQuery {
            cone, in_meshes, ..
        } = self.query;
        let zero = cone.spread.like(L::Real::ZERO);
        Some(ThinMargin {
            width: cone.width,
            spread: cone.spread.max(zero),
            max_thickness: zero.like_f64(THIN_WIDTH),
            narrowing: (-cone.spread).max(zero),
            min_width: in_meshes.width,
        })
    }

    #[inline(always)]
    fn exclude_lanes(&mut self, merged_lanes: u64) -> u64 {
        let before = self.merged_lanes;
        if merged_lanes != before {
            let is_excluded = |lane: usize| f64::from(u8::from(merged_lanes >> lane & 1 == 1));
            let token = self.best.token();
            let excluded = L::from_fn(token, |lane| L::Real::from_f64(is_excluded(lane)));
            self.unmerged_lanes = excluded.less(excluded.like(L::Real::ONE));
            self.merged_lanes = merged_lanes;
        }
        before
    }

    #[inline(always)]
    fn leave_mesh(&mut self) {
        self.face_lanes = self.face_lanes | !self.face_lanes;
        self.cone = self.query.cone;
    }

    #[inline(always)]
    fn reach(&self) -> L {
        self.query.reach
    }

    #[inline(always)]
    fn test<P: Primitive<L::Real>>(
        &mut self,
        primitive: &P,
        prepared: &P::Prepared<L>,
        paths: &Paths<L>,
        number: usize,
    ) {
        let near = self.pixels_to(primitive, prepared, paths, number);
        self.best = self.best.min(near);
    }

    #[inline(always)]
    fn test_slice<P: Primitive<L::Real>>(
        &mut self,
        primitive: &P,
        prepared: &P::Prepared<L>,
        (paths, passing): (&Paths<L>, impl FnOnce() -> L::Mask),
        number: usize,
    ) {
        self.note(self.pixels_to(primitive, prepared, paths, number), passing);
    }
}
