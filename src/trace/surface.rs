//! Where rays have met a primitive, refined, and the rays that start there.

use super::intersect::{IgnoredPrimitive, Kernel, Nearest, Paths};
use crate::plan::RayOrigin;
use crate::primitive::{Primitive, Ray, SurfacePoint, WithPrimitive};
use crate::simd::{Real, SimdFloat, Vec3};

/// Hits on one primitive.
#[derive(Clone, Copy, Debug)]
pub struct Hit<L: SimdFloat> {
    /// Point, normal and curvature of the surface.
    pub surface: SurfacePoint<L>,
    /// Index into [`crate::plan::Plan::materials`].
    pub material: u32,
    /// Number of the primitive.
    pub number: usize,
}

struct Refine<'a, L> {
    rays: &'a Ray<L>,
    t: L,
    number: usize,
}

impl<L: SimdFloat> WithPrimitive<L::Real> for Refine<'_, L> {
    type Output = Hit<L>;

    #[inline(always)]
    fn run<P: Primitive<L::Real>>(self, primitive: &P) -> Hit<L> {
        Hit {
            surface: primitive.refine(self.rays, self.t),
            material: primitive.material(),
            number: self.number,
        }
    }
}

impl<L: SimdFloat> Kernel<'_, L> {
    /// The hits on the primitive of this number.
    #[inline(always)]
    pub fn refine(self, rays: &Ray<L>, nearest: &Nearest<L>, number: L::Real) -> Hit<L> {
        let number = number.to_f64() as usize;
        let t = nearest.t;
        let refine = Refine { rays, t, number };
        self.plan.primitives.with(number, refine)
    }

    /// The paths that start at the hits in unit directions on the side that the normal points to.
    #[inline(always)]
    pub fn spawn(self, hit: &Hit<L>, direction: Vec3<L>) -> Paths<L> {
        let SurfacePoint {
            point,
            normal,
            slack,
            ..
        } = hit.surface;
        let (origin, ignored) = match self.plan.ray_origin {
            RayOrigin::AtHit => (point + normal * slack, IgnoredPrimitive::Shared(hit.number)),
            RayOrigin::Along(distance) => (
                point + direction * slack.like(distance),
                IgnoredPrimitive::Nothing,
            ),
            RayOrigin::Roundings => (
                point + roundings_along(point, normal),
                IgnoredPrimitive::Nothing,
            ),
        };
        let rays = Ray { origin, direction };
        Paths { rays, ignored }
    }
}

/// 256 roundings of each coordinate in the direction of the normal, and 1/65536 of a unit near zero.
///
/// Wächter and Binder, "A fast and robust method for avoiding self-intersection", Ray Tracing Gems
/// (2019), ch. 6; with 2u·|p| in place of the step to the next number, which is at most twice that.
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
