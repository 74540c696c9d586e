//! Ray against plane.

use super::Ray;
use crate::plan::Plane;
use crate::simd::{Real, SimdFloat, Vec3};

/// t = (offset - n·o) / (n·d), or infinity if that is not in front. A ray along the plane divides
/// by zero; the comparison then fails and the plane is rightly not seen edge-on.
#[inline(always)]
pub fn intersect<L: SimdFloat>(token: L::Token, ray: &Ray<L>, plane: &Plane<L::Real>) -> L {
    let normal = Vec3::broadcast(token, plane.normal);
    let height = L::splat(token, plane.offset) - normal.dot(ray.origin);
    let t = height / normal.dot(ray.direction);
    L::select(
        L::splat(token, L::Real::ZERO).less(t),
        t,
        L::splat(token, L::Real::INFINITY),
    )
}

/// The hit at `t`, drawn onto the plane.
#[inline(always)]
pub fn refine<L: SimdFloat>(
    token: L::Token,
    ray: &Ray<L>,
    plane: &Plane<L::Real>,
    t: L,
) -> Vec3<L> {
    let normal = Vec3::broadcast(token, plane.normal);
    let point = ray.at(t);
    point - normal * (normal.dot(point) - L::splat(token, plane.offset))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    fn floor() -> Plane<f32> {
        Plane {
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

    #[test]
    fn grazing_rays_lose_digits_no_faster_than_one_over_the_sine() {
        for degrees in [45.0, 1.0, 0.01, 1e-4, 1e-5] {
            let ray = ray_at_degrees(degrees);
            let exact = 1.0 / -f64::from(ray.direction.y);
            let error = (f64::from(intersect((), &ray, &floor())) / exact - 1.0).abs();
            let u = f64::from(f32::UNIT_ROUNDOFF);
            assert!(
                error <= 8.0 * u / degrees.to_radians().sin(),
                "{degrees}: {error:e}"
            );
        }
    }

    #[test]
    fn edge_on_and_behind_are_misses() {
        assert_eq!(intersect((), &ray_at_degrees(0.0), &floor()), f32::INFINITY);
        assert_eq!(
            intersect((), &ray_at_degrees(-30.0), &floor()),
            f32::INFINITY
        );
        let inside = Ray {
            origin: Vec3::splat(0.0),
            ..ray_at_degrees(0.0)
        };
        assert_eq!(intersect((), &inside, &floor()), f32::INFINITY, "0/0");
    }
}
