//! Refined hits of rays on primitives, and the rays that start there.

use super::gather::{Gathered, HitPrimitive};
use super::intersect::{Kernel, Nearest};
use super::mixed_materials::MixedMaterials;
use super::paths::{IgnoredPrimitive, Paths};
use crate::plan::{PointLight, RayOrigin};
use crate::primitive::{Primitive, Ray, SurfacePoint, WithPrimitive, roundings};
use crate::simd::{Real, SimdFloat, Vec3};

/// Hits on one primitive, or on several of a kind.
#[derive(Clone, Copy, Debug)]
pub struct Hit<L: SimdFloat> {
    /// Which rays these are the hits of.
    pub lanes: L::Mask,
    /// Point, normal and curvature of the surface.
    pub surface: SurfacePoint<L>,
    /// Index into [`crate::plan::Plan::materials`] of the material of the first hit.
    pub material: u32,
    /// Whether other hits have another material.
    pub is_mixed: bool,
    /// The primitives that were hit.
    ignored: IgnoredPrimitive<L>,
}

struct Refine<'a, L: SimdFloat> {
    rays: &'a Ray<L>,
    nearest: &'a Nearest<L>,
    lanes: L::Mask,
    number: usize,
}

impl<L: SimdFloat> WithPrimitive<L::Real> for Refine<'_, L> {
    type Output = Hit<L>;

    #[inline(always)]
    fn run<P: Primitive<L::Real>>(self, primitive: &P) -> Hit<L> {
        Hit {
            lanes: self.lanes,
            surface: primitive.refine(self.rays, self.nearest.t),
            material: primitive.material(),
            is_mixed: false,
            ignored: IgnoredPrimitive::listed(self.number, self.nearest.number),
        }
    }
}

impl<L: SimdFloat, const TREE: bool> Kernel<'_, L, TREE> {
    /// Returns the hits on the primitive that the first of the rays in `remaining` (bit by bit) has hit, or on all that
    /// are like it; that ray must have hit something. If there may be several materials, `mixed` becomes these.
    #[inline(always)]
    pub fn refine(
        self,
        rays: &Ray<L>,
        nearest: &Nearest<L>,
        remaining: u64,
        mixed: &mut MixedMaterials<L>,
    ) -> Hit<L> {
        let number = nearest.number.lane(remaining.trailing_zeros() as usize);
        let refine = Refine {
            rays,
            nearest,
            lanes: nearest.number.same(nearest.number.like(number)),
            number: number.to_f64() as usize,
        };
        match self.geometry() {
            Some((geometry, first)) if refine.number >= first => {
                let index = refine.number - first;
                match HitPrimitive::of(geometry, index) {
                    Some(hit_primitive) => {
                        self.refine_alike(&hit_primitive, (rays, nearest, remaining), mixed)
                    }
                    None => geometry.primitives.with(index, refine),
                }
            }
            _ => self.plan.primitives.with(refine.number, refine),
        }
    }

    /// Returns the hits on all primitives that are like one: each ray has hit its own, and they are lit together.
    #[inline(never)]
    fn refine_alike(
        self,
        hit_primitive: &HitPrimitive<L::Real>,
        (rays, nearest, remaining): (&Ray<L>, &Nearest<L>, u64),
        mixed: &mut MixedMaterials<L>,
    ) -> Hit<L> {
        L::vectorize(
            self.token,
            #[inline(always)]
            || self.refine_alike_vectorized(hit_primitive, (rays, nearest, remaining), mixed),
        )
    }

    #[inline(always)]
    fn refine_alike_vectorized(
        self,
        hit_primitive: &HitPrimitive<L::Real>,
        (rays, nearest, mut remaining): (&Ray<L>, &Nearest<L>, u64),
        mixed: &mut MixedMaterials<L>,
    ) -> Hit<L> {
        let mut gathered = Gathered::like(hit_primitive);
        while remaining != 0 {
            let lane = remaining.trailing_zeros() as usize;
            remaining &= remaining - 1;
            if let Some((geometry, first)) = self.geometry()
                && let number = nearest.number.lane(lane).to_f64() as usize
                && number >= first
                && let Some(other) = HitPrimitive::of(geometry, number - first)
                && other.is_like(hit_primitive)
            {
                gathered.set(lane, &other);
            }
        }
        gathered.group_by_material::<L>(self.token, mixed);
        Hit {
            lanes: gathered.mask::<L>(self.token),
            surface: gathered.refine(hit_primitive, rays, nearest.t),
            material: hit_primitive.material,
            is_mixed: mixed.are_several(),
            ignored: IgnoredPrimitive::in_tree(nearest.number),
        }
    }

    /// Returns the paths that start at the hits in unit directions, on the side that the normal points to.
    #[inline(always)]
    pub fn spawn(self, hit: &Hit<L>, direction: Vec3<L>) -> Paths<L> {
        let SurfacePoint {
            point,
            normal,
            slack,
            ..
        } = hit.surface;
        let origin = match self.plan.ray_origin {
            RayOrigin::AtHit if self.plan.clearance > L::Real::ZERO => {
                let reach = point.max_abs() + slack.like(self.plan.extent);
                point + normal * slack.max(reach * slack.like(self.plan.clearance))
            }
            RayOrigin::AtHit => point + normal * slack,
            RayOrigin::Along(distance) => point + direction * slack.like(distance),
            RayOrigin::Roundings => point + roundings_along(point, normal),
        };
        let is_at_hit = matches!(self.plan.ray_origin, RayOrigin::AtHit);
        let ignored = hit.ignored.only_if(is_at_hit);
        let rays = Ray { origin, direction };
        Paths { rays, ignored }
    }

    /// Returns how large the cosine between the normal of a surface and the unit direction to a light must be for
    /// the surface to be lit, if the light may be in its plane or on a ball: infinity where that ball blocks the
    /// light. The light is at this distance; `shrink` is one over that.
    #[inline(always)]
    pub fn min_lit_cosine(
        self,
        light: &PointLight<L::Real>,
        (direction, distance): (Vec3<L>, L),
        shrink: L,
    ) -> L {
        let (part, rounding) = (distance.like(roundings()), distance.like(light.rounding));
        let chord = direction.dot(direction.like(light.ball.chord));
        let size = distance + distance.like(light.ball.diameter);
        let is_hidden =
            part.like(L::Real::ZERO).less(chord) & (size * part + rounding).less(distance - chord);
        L::select(is_hidden, self.infinity(), part + shrink * rounding)
    }

    /// Returns the paths from the hits to a light, which is at a distance in a unit direction from there, and the
    /// distance from their start up to which an occluder counts.
    #[inline(always)]
    pub fn towards(
        self,
        hit: &Hit<L>,
        light: &PointLight<L::Real>,
        (direction, distance): (Vec3<L>, L),
    ) -> (Paths<L>, L) {
        let mut paths = self.spawn(hit, direction);
        let mut distance = distance;
        let is_at_hit = matches!(self.plan.ray_origin, RayOrigin::AtHit);
        if is_at_hit && self.plan.clearance > L::Real::ZERO {
            // Parallel to the way from the hit, they might hit something a little behind the light within its
            // distance.
            let to_light = paths.rays.origin.like(light.position) - paths.rays.origin;
            distance = to_light.length();
            let exact_direction = to_light * (self.splat(1.0) / distance);
            // From the place of the light itself, no direction leads to it.
            let is_apart = self.splat(0.0).less(distance);
            paths.rays.direction = Vec3::select(is_apart, exact_direction, direction);
        }
        (paths, self.reach_to(light, distance))
    }

    /// Returns the distance from the start of such paths up to which an occluder counts, given that of the light.
    #[inline(always)]
    fn reach_to(self, light: &PointLight<L::Real>, distance: L) -> L {
        match self.plan.ray_origin {
            // What the light is on, within rounding, does not block it.
            RayOrigin::AtHit if light.may_be_on_surface => {
                let part = distance.like(roundings());
                distance - distance * part - distance.like(light.rounding)
            }
            RayOrigin::AtHit | RayOrigin::Roundings => distance,
            RayOrigin::Along(start) => distance - distance.like(start),
        }
    }
}

/// Returns an offset along the normal: 256 roundings of each coordinate, and 1/65536 of a unit near zero.
///
/// Wächter and Binder, "A fast and robust method for avoiding self-intersection", Ray Tracing Gems (2019), ch. 6;
/// with 2u·|p|, which is at most twice as much, in place of the step to the next number.
#[inline(always)]
fn roundings_along<L: SimdFloat>(point: Vec3<L>, normal: Vec3<L>) -> Vec3<L> {
    let like = point.x;
    let roundings = like.like(L::Real::UNIT_ROUNDOFF * L::Real::from_f64(2.0 * 256.0));
    let near = like.like_f64(1.0 / 32.0);
    let least = like.like_f64(1.0 / 65536.0);
    let (x, y, z) = (point.x.abs(), point.y.abs(), point.z.abs());
    Vec3::new(
        normal.x * L::select(x.less(near), least, x * roundings),
        normal.y * L::select(y.less(near), least, y * roundings),
        normal.z * L::select(z.less(near), least, z * roundings),
    )
}
