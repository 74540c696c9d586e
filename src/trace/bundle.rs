//! The rays of a packet as one: boxes that none of its rays can meet are skipped, sixteen at a time.

use super::thin_margin::ThinMargin;
use crate::plan::{GROUP, Node};
use crate::primitive::{Blur, BoundingBox, CAUTION, Ray, inverse, roundings};
use crate::simd::{Mask as _, Real, SimdFloat, Vec3};

/// Length of the longest line in a box, in units of its longest side: √3, rounded up.
const BOX_DIAGONAL: f64 = 1.75;
/// Rounding error of a ray that is aimed at a point, in units of the rounding error of its start.
const AIM_ROUNDINGS: f64 = 2.0;

/// Rays, and the intervals that contain them along each axis.
#[derive(Clone, Copy, Debug)]
pub struct Bundle<L: SimdFloat> {
    /// The lanes that have a ray.
    pub active: L::Mask,
    /// The origins, shifted by their rounding errors towards lower and higher coordinates.
    pub origins: [Vec3<L>; 2],
    /// The reciprocals of the directions.
    pub inverse: Vec3<L>,
    /// The intervals that contain all of the rays.
    shaft: Shaft<L::Real>,
    /// Whether boxes that no ray meets are skipped.
    is_boxed: bool,
}

/// For each axis, the intervals that contain the starts of all rays and the reciprocals of their directions.
#[derive(Clone, Copy, Debug)]
pub struct Shaft<R> {
    axes: [ShaftAxis<R>; 3],
}

/// The intervals along one axis.
#[derive(Clone, Copy, Debug)]
struct ShaftAxis<R> {
    /// 0 if all rays go upwards and meet the lower plane of a box first; 1 if all go downwards; `None` if they go
    /// both ways.
    entry_plane: Option<usize>,
    /// Origins from which the planes met first and last are measured.
    origins: [R; 2],
    /// Least and greatest reciprocal of the directions.
    inverse: [R; 2],
}

impl<L: SimdFloat> Bundle<L> {
    /// The rays where the mask is set, among things whose coordinates are at most `reach`. Boxes that a ray only
    /// meets within its blur count as met: whether it is in doubt does not depend on the other rays of its packet.
    #[inline(always)]
    pub fn new(rays: &Ray<L>, blur: &Blur<L>, active: L::Mask, reach: L::Real) -> Self {
        let like = rays.origin.x;
        let size = rays.origin.max_abs() + like.like(reach);
        let slack =
            size * like.like(roundings()) + blur_margin(blur, like.like(L::Real::ZERO), size);
        Self::from_slack(rays.origin, slack, rays.direction, active)
    }

    /// The paths from a point to the starts of the rays, all parametrised to length 1; the rays must go to that
    /// point. They are contained in a pyramid, instead of the space that two boxes span.
    #[inline(always)]
    pub fn from_point(
        point: Vec3<L::Real>,
        (rays, blur): (&Ray<L>, &Blur<L>),
        active: L::Mask,
        reach: L::Real,
    ) -> Self {
        let origin = rays.origin.like(point);
        let to_starts = rays.origin - origin;
        let extent = origin.x.like(reach + point.max_abs());
        // Nothing is farther from the point than this. Rays that start farther away are off by more there than
        // within this distance.
        let max_distance = extent * extent.like_f64(BOX_DIAGONAL);
        let size = (rays.origin.max_abs() + extent).min(max_distance + max_distance);
        // A ray misses the point by the rounding errors of its start and its direction.
        let rounded = size * size.like_f64(AIM_ROUNDINGS) * size.like(roundings());
        let from = (to_starts.length() - max_distance).max(extent.like(L::Real::ZERO));
        let slack = rounded + blur_margin(blur, from, size);
        Self::from_slack(origin, slack, to_starts, active)
    }

    #[inline(always)]
    fn from_slack(origin: Vec3<L>, slack: L, direction: Vec3<L>, active: L::Mask) -> Self {
        let slack = Vec3::splat(slack);
        let inverse = inverse(direction);
        let origins = [origin - slack, origin + slack];
        Self {
            active,
            origins,
            inverse,
            shaft: Shaft {
                axes: [
                    ShaftAxis::new(active, [origins[0].x, origins[1].x], inverse.x),
                    ShaftAxis::new(active, [origins[0].y, origins[1].y], inverse.y),
                    ShaftAxis::new(active, [origins[0].z, origins[1].z], inverse.z),
                ],
            },
            is_boxed: true,
        }
    }

    /// From now on, counts every box as met.
    #[inline(always)]
    pub fn accept_all_boxes(&mut self) {
        self.is_boxed = false;
        for axis in &mut self.shaft.axes {
            axis.entry_plane = None;
        }
    }

    /// The same rays in coordinates relative to `centre`; the margin for rounding stays that of the original ones.
    #[inline(always)]
    #[must_use]
    pub fn seen_from(&self, centre: Vec3<L::Real>) -> Self {
        let [low, high] = self.origins;
        let by = low.like(centre);
        Self {
            origins: [low - by, high - by],
            shaft: self.shaft.seen_from(centre),
            ..*self
        }
    }

    /// The intervals that contain all of the rays.
    #[inline(always)]
    pub fn shaft(&self) -> &Shaft<L::Real> {
        &self.shaft
    }

    /// Returns which rays meet the box at `index` of a node, or pass within `margin` of it, before their own
    /// `reach`, by the slab method of Kay and Kajiya, "Ray tracing complex scenes", SIGGRAPH 1986.
    #[inline(always)]
    pub fn lanes_meeting_box(
        &self,
        node: &Node,
        index: usize,
        reach: L,
        margin: L::Real,
    ) -> L::Mask {
        let mut near = reach.like(L::Real::ZERO);
        let mut far = reach;
        let [below, above] = &self.origins;
        let origins = [
            (below.x, above.x, self.inverse.x),
            (below.y, above.y, self.inverse.y),
            (below.z, above.z, self.inverse.z),
        ];
        for (axis, (below, above, inverse)) in origins.into_iter().enumerate() {
            let low = L::Real::from_single(node.planes[0][axis][index]);
            let high = L::Real::from_single(node.planes[1][axis][index]);
            let (low, high) = (reach.like(low - margin), reach.like(high + margin));
            // The origin is moved away from either plane, which enlarges the box.
            let (low, high) = ((low - above) * inverse, (high - below) * inverse);
            near = near.max(low.min(high));
            far = far.min(low.max(high));
        }
        if !self.is_boxed {
            return self.active;
        }
        let slack = L::Real::ONE + roundings::<L::Real>();
        near.at_most(far * reach.like(slack)) & self.active
    }

    /// Margin around the origins for rounding and blur, along every axis.
    #[inline(always)]
    pub fn margin(&self) -> L {
        let [below, above] = &self.origins;
        (above.x - below.x) * below.x.like_f64(0.5)
    }

    /// Returns which boxes of a node any of the rays in `lanes` meets before its own `reach`, as bits; sets `nears`
    /// to the least distances at which they are entered.
    #[inline(always)]
    pub fn boxes_met_by_lanes(
        &self,
        mut lanes: u64,
        node: &Node,
        reach: L,
        nears: &mut [L::Real; GROUP],
    ) -> u64 {
        if !self.is_boxed {
            return node.filled();
        }
        let token = reach.token();
        *nears = [L::Real::INFINITY; GROUP];
        let mut bits = 0;
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize;
            lanes &= lanes - 1;
            let (ray, reach) = (self.lane_shaft(lane), L::splat(token, reach.lane(lane)));
            for first in (0..node.count).step_by(L::WIDTH) {
                let (near, is_met) = ray.slabs::<L>(node, first, reach, None);
                let before = L::load(token, &nears[first..]);
                L::select(is_met, near.min(before), before).store(&mut nears[first..]);
                bits |= is_met.bits() << first;
            }
        }
        bits & node.filled()
    }

    /// The shaft of a single ray.
    #[inline(always)]
    fn lane_shaft(&self, lane: usize) -> Shaft<L::Real> {
        let [below, above] = &self.origins;
        let axis = |below: L, above: L, inverse: L| {
            let inverse = inverse.lane(lane);
            ShaftAxis::from_intervals([below.lane(lane), above.lane(lane)], [inverse, inverse])
        };
        Shaft {
            axes: [
                axis(below.x, above.x, self.inverse.x),
                axis(below.y, above.y, self.inverse.y),
                axis(below.z, above.z, self.inverse.z),
            ],
        }
    }
}

impl<R: Real> Shaft<R> {
    /// The shaft of rays that start in one box and whose directions lie in another.
    pub fn of(origins: &BoundingBox<R>, directions: &BoundingBox<R>) -> Self {
        let (lows, highs) = (origins.low.to_array(), origins.high.to_array());
        let (froms, tos) = (directions.low.to_array(), directions.high.to_array());
        let axis = |axis: usize| ShaftAxis::of([lows[axis], highs[axis]], [froms[axis], tos[axis]]);
        Self {
            axes: [axis(0), axis(1), axis(2)],
        }
    }

    /// The same shaft in coordinates relative to `centre`.
    #[inline(always)]
    #[must_use]
    pub fn seen_from(&self, centre: Vec3<R>) -> Self {
        let mut moved = *self;
        for (axis, by) in moved.axes.iter_mut().zip(centre.to_array()) {
            axis.origins = axis.origins.map(|origin| origin - by);
        }
        moved
    }

    /// Returns which boxes of a node any ray may meet before `reach`, as bits; sets `nears` to the least distances
    /// at which they may be entered.
    #[inline(always)]
    pub fn meets<L: SimdFloat<Real = R>>(
        &self,
        token: L::Token,
        node: &Node,
        reach: R,
        nears: &mut [R; GROUP],
    ) -> u64 {
        let mut bits = 0;
        for first in (0..node.count).step_by(L::WIDTH) {
            let (near, is_met) = self.slabs::<L>(node, first, L::splat(token, reach), None);
            near.store(&mut nears[first..]);
            bits |= is_met.bits() << first;
        }
        bits & node.filled()
    }

    /// Returns which boxes of a node hold something thin and may be passed closely by a ray before `reach`, as
    /// bits; sets `widths` to the greatest width of a pixel at each box.
    #[inline(always)]
    pub fn meets_thin<L: SimdFloat<Real = R>>(
        &self,
        token: L::Token,
        node: &Node,
        reach: R,
        margin: &ThinMargin<R>,
        widths: &mut [R; GROUP],
    ) -> u64 {
        let mut bits = 0;
        for first in (0..node.count).step_by(L::WIDTH) {
            let mut width = self.max_distance::<L>(token, node, first)
                * L::splat(token, margin.spread)
                + L::splat(token, margin.width);
            if R::ZERO < margin.narrowing {
                width = margin.narrowed(width, self.min_distance::<L>(token, node, first));
            }
            width.store(&mut widths[first..]);
            let thickness = L::load_singles(token, &node.thickness[first..]);
            let is_thin = thickness.less(width * L::splat(token, margin.max_thickness));
            if is_thin.any() {
                let reach = margin.end(L::splat(token, reach), width);
                let (_, is_met) = self.slabs(node, first, reach, Some(width));
                bits |= (is_thin & is_met).bits() << first;
            }
        }
        bits & node.filled()
    }

    /// Upper bound of the distance from the start of any ray to the farthest corner of each box.
    #[inline(always)]
    fn max_distance<L: SimdFloat<Real = R>>(&self, token: L::Token, node: &Node, from: usize) -> L {
        let mut sum = L::splat(token, R::ZERO);
        for (axis, interval) in self.axes.iter().enumerate() {
            let [one, other] = interval.origins;
            let low = L::load_singles(token, &node.planes[0][axis][from..]);
            let high = L::load_singles(token, &node.planes[1][axis][from..]);
            let above = high - L::splat(token, one.min(other));
            let below = L::splat(token, one.max(other)) - low;
            sum = sum + above.max(below).max(L::splat(token, R::ZERO));
        }
        sum
    }

    /// Lower bound of the distance from the start of any ray to each box: the greatest along one axis.
    #[inline(always)]
    fn min_distance<L: SimdFloat<Real = R>>(&self, token: L::Token, node: &Node, from: usize) -> L {
        let mut gap = L::splat(token, R::ZERO);
        for (axis, interval) in self.axes.iter().enumerate() {
            let [one, other] = interval.origins;
            let low = L::load_singles(token, &node.planes[0][axis][from..]);
            let high = L::load_singles(token, &node.planes[1][axis][from..]);
            let above = low - L::splat(token, one.max(other));
            let below = L::splat(token, one.min(other)) - high;
            gap = gap.max(above.max(below));
        }
        gap
    }

    /// Intersects boxes of a node, from index `from` on, as slabs between planes: returns where the first ray may
    /// enter each, and whether any may meet it, or pass within `margin`, before `reach`.
    #[inline(always)]
    fn slabs<L: SimdFloat<Real = R>>(
        &self,
        node: &Node,
        from: usize,
        reach: L,
        margin: Option<L>,
    ) -> (L, L::Mask) {
        let token = reach.token();
        let mut near = L::splat(token, R::ZERO);
        let mut far = reach;
        for (axis, interval) in self.axes.iter().enumerate() {
            let Some(first) = interval.entry_plane else {
                continue;
            };
            let enter = L::load_singles(token, &node.planes[first][axis][from..]);
            let leave = L::load_singles(token, &node.planes[1 - first][axis][from..]);
            let mut enter = enter - L::splat(token, interval.origins[0]);
            let mut leave = leave - L::splat(token, interval.origins[1]);
            if let Some(margin) = margin {
                let outwards = if first == 0 { margin } else { -margin };
                enter = enter - outwards;
                leave = leave + outwards;
            }
            let [least, greatest] = interval.inverse;
            let (least, greatest) = (L::splat(token, least), L::splat(token, greatest));
            near = near.max((enter * least).min(enter * greatest));
            far = far.min((leave * least).max(leave * greatest));
        }
        let slack = R::ONE + roundings::<R>();
        (near, near.at_most(far * L::splat(token, slack)))
    }
}

impl<R: Real> ShaftAxis<R> {
    #[inline(always)]
    fn new<L: SimdFloat<Real = R>>(active: L::Mask, origins: [L; 2], inverse: L) -> Self {
        let inverse = [least(active, inverse), greatest(active, inverse)];
        Self::from_intervals(
            [least(active, origins[0]), greatest(active, origins[1])],
            inverse,
        )
    }

    /// The intervals of rays that start between these origins, and have directions between `from` and `to`.
    fn of(origins: [R; 2], [from, to]: [R; 2]) -> Self {
        let inverse = if from > R::ZERO || to < R::ZERO {
            let (one, other) = (R::ONE / to, R::ONE / from);
            let slack = one.abs().max(other.abs()) * roundings();
            [one - slack, other + slack]
        } else {
            [-R::INFINITY, R::INFINITY]
        };
        Self::from_intervals(origins, inverse)
    }

    #[inline(always)]
    fn from_intervals(origins: [R; 2], inverse: [R; 2]) -> Self {
        if inverse[0] > R::ZERO {
            Self {
                entry_plane: Some(0),
                origins: [origins[1], origins[0]],
                inverse,
            }
        } else if inverse[1] < R::ZERO {
            Self {
                entry_plane: Some(1),
                origins,
                inverse,
            }
        } else {
            Self {
                entry_plane: None,
                origins,
                inverse,
            }
        }
    }
}

/// How far beside the rays a box still counts as met, if it is no nearer than `from` and no coordinate exceeds
/// `size`.
#[inline(always)]
pub fn blur_margin<L: SimdFloat>(blur: &Blur<L>, from: L, size: L) -> L {
    if L::Real::IS_FILTERED {
        // As much as hits may be in doubt, along the longest path through the scene.
        let longest = from + size * size.like_f64(BOX_DIAGONAL);
        blur.between(from, longest) * size.like_f64(1.0 + CAUTION)
    } else {
        size.like(L::Real::ZERO)
    }
}

/// The smallest number where the mask is set; infinity if it is set nowhere.
#[inline(always)]
fn least<L: SimdFloat>(active: L::Mask, numbers: L) -> L::Real {
    L::select(active, numbers, numbers.like(L::Real::INFINITY)).least()
}

/// The largest number where the mask is set; minus infinity if it is set nowhere.
#[inline(always)]
fn greatest<L: SimdFloat>(active: L::Mask, numbers: L) -> L::Real {
    L::select(active, numbers, numbers.like(-L::Real::INFINITY)).greatest()
}
