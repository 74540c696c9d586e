//! Ray against plane.

use super::ball::Ball;
use super::blur::Blur;
use super::bounding_box::BoundingBox;
use super::kind::{Approach, Packing, Primitive, SurfacePoint};
use super::projector::{Projector, Rectangle};
use super::ray::Ray;
use crate::scene::{Methods, Plane, unit};
use crate::simd::{Mask as _, Real, SimdFloat, Vec3};

/// An infinite plane: the points p with normal · p = offset.
#[derive(Clone, Copy, Debug)]
pub struct PackedPlane<R> {
    /// Unit normal.
    pub normal: Vec3<R>,
    /// Distance from the scene's middle along the normal.
    pub offset: R,
    /// Index of its material.
    pub material: u32,
}

impl<R: Real> Primitive<R> for PackedPlane<R> {
    type Description = Plane;
    type Prepared<L: SimdFloat<Real = R>> = ();
    const IS_ENDLESS: bool = true;

    fn pack(description: &Plane, material: u32, packing: &Packing) -> Option<Self> {
        let normal = unit(description.normal)?;
        Some(Self {
            normal: Vec3::from_dvec3(normal),
            offset: R::from_f64(normal.dot(description.point - packing.centre)),
            material,
        })
    }

    fn rectangle(_description: &Plane, _projector: &Projector) -> Option<Rectangle> {
        None
    }

    fn ball(&self) -> Option<Ball> {
        None
    }

    fn bounds(&self) -> Option<BoundingBox<R>> {
        None
    }

    fn flat(&self) -> Option<(Vec3<R>, R)> {
        Some((self.normal, R::INFINITY))
    }

    fn material(&self) -> u32 {
        self.material
    }

    fn thickness(&self) -> R {
        R::INFINITY
    }

    fn reach(&self) -> (Vec3<R>, R) {
        (self.normal * self.offset, R::INFINITY)
    }

    #[inline(always)]
    fn prepare<L: SimdFloat<Real = R>>(_directions: Vec3<L>) {}

    /// t = (offset - n·o) / (n·d), or infinity if that is not in front. A ray parallel to the plane divides by
    /// zero; the comparison then fails, and the plane is correctly invisible edge-on.
    #[inline(always)]
    fn intersect<L: SimdFloat<Real = R>>(&self, rays: &Ray<L>, (): &(), _methods: &Methods) -> L {
        let normal = rays.origin.like(self.normal);
        let height = normal.x.like(self.offset) - normal.dot(rays.origin);
        let t = height / normal.dot(rays.direction);
        L::select(t.like(R::ZERO).less(t), t, t.like(R::INFINITY))
    }

    /// Undecided for rays that start on the plane or run along it.
    #[inline(always)]
    fn intersect_in_doubt<L: SimdFloat<Real = R>>(
        &self,
        rays: &Ray<L>,
        (): &(),
        _methods: &Methods,
        (blur, wanted): (&Blur<L>, L::Mask),
    ) -> Option<(L, L)> {
        let normal = rays.origin.like(self.normal);
        let height = normal.x.like(self.offset) - normal.dot(rays.origin);
        let speed = normal.dot(rays.direction);
        let t = height / speed;
        let (zero, infinity) = (t.like(R::ZERO), t.like(R::INFINITY));
        let distance = L::select(zero.less(t), t, infinity);
        let (height, speed) = (height.abs(), speed.abs());
        let starts_on_it = height.at_most(blur.at(t.like(self.offset.abs())));
        let is_along = speed.at_most(blur.spread);
        if !(wanted & (starts_on_it | is_along)).any() {
            return Some((distance, infinity));
        }
        let earliest = L::select(is_along, height / (speed + blur.spread), infinity);
        Some((distance, L::select(starts_on_it, zero, earliest)))
    }

    #[inline(always)]
    fn refine<L: SimdFloat<Real = R>>(&self, rays: &Ray<L>, t: L) -> SurfacePoint<L> {
        let normal = rays.origin.like(self.normal);
        let point = rays.at(t);
        SurfacePoint {
            point: point - normal * (normal.dot(point) - t.like(self.offset)),
            normal,
            curvature: t.like(R::ZERO),
            slack: t.like(R::ZERO),
            size: point.max_abs(),
        }
    }

    /// A plane is never thin.
    #[inline(always)]
    fn approach<L: SimdFloat<Real = R>>(
        &self,
        _rays: &Ray<L>,
        (): &(),
        _matters: impl FnOnce(&Approach<L>) -> bool,
    ) -> Option<Approach<L>> {
        None
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    fn floor() -> PackedPlane<f32> {
        PackedPlane {
            normal: Vec3::new(0.0, 1.0, 0.0),
            offset: 0.0,
            material: 0,
        }
    }

    fn ray_at_degrees(degrees: f64) -> Ray<f32> {
        let (sin, cos) = degrees.to_radians().sin_cos();
        Ray {
            origin: Vec3::new(0.0, 1.0, 0.0),
            direction: Vec3::from_dvec3(DVec3::new(cos, -sin, 0.0)),
        }
    }

    fn intersect(ray: &Ray<f32>) -> f32 {
        floor().intersect_single(ray, &Methods::default())
    }

    #[test]
    fn grazing_rays_lose_digits_no_faster_than_one_over_the_sine() {
        for degrees in [45.0, 1.0, 0.01, 1e-4, 1e-5] {
            let ray = ray_at_degrees(degrees);
            let exact = 1.0 / -f64::from(ray.direction.y);
            let error = (f64::from(intersect(&ray)) / exact - 1.0).abs();
            let u = f64::from(f32::UNIT_ROUNDOFF);
            assert!(
                error <= 8.0 * u / degrees.to_radians().sin(),
                "{degrees}: {error:e}"
            );
        }
    }

    #[test]
    fn edge_on_and_behind_are_misses() {
        assert_eq!(intersect(&ray_at_degrees(0.0)), f32::INFINITY);
        assert_eq!(intersect(&ray_at_degrees(-30.0)), f32::INFINITY);
        let inside = Ray {
            origin: Vec3::splat(0.0),
            ..ray_at_degrees(0.0)
        };
        assert_eq!(intersect(&inside), f32::INFINITY, "0/0");
    }
}
