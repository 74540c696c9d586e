//! Single rays against single primitives: what the lab looks for failures with.

use super::triangle::Shear;
use super::{Ray, plane, sphere, triangle};
use crate::plan::{Plane, Sphere, SphereMethod, Triangle, TriangleMethod};
use crate::simd::Real;

/// The t > 0 at which the ray meets the sphere; infinity if it does not.
pub fn meet_sphere<R: Real>(method: SphereMethod, ray: &Ray<R>, target: &Sphere<R>) -> R {
    sphere::intersect((), method, ray, target)
}

/// The t > 0 at which the ray meets the triangle; infinity if it does not.
pub fn meet_triangle<R: Real>(method: TriangleMethod, ray: &Ray<R>, target: &Triangle<R>) -> R {
    triangle::intersect((), method, ray, &Shear::new((), ray.direction), target)
}

/// The t > 0 at which the ray meets the plane; infinity if it does not.
pub fn meet_plane<R: Real>(ray: &Ray<R>, target: &Plane<R>) -> R {
    plane::intersect((), ray, target)
}
