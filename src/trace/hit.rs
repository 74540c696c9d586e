//! The nearest hit among all primitives, and whether anything stands in a ray's way.

use super::triangle::Shear;
use super::{Ray, plane, sphere, triangle};
use crate::lanes::{Real, Vec3};
use crate::plan::{Plan, RayOffset};

/// Which primitive, by its place in the plan's list of its kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Primitive {
    /// No primitive.
    Nothing,
    /// A sphere.
    Sphere(usize),
    /// A plane.
    Plane(usize),
    /// A triangle.
    Triangle(usize),
}

/// A ray and the primitive that it starts on, which it must not meet where it starts.
#[derive(Clone, Copy, Debug)]
pub struct Path<R> {
    /// The ray.
    pub ray: Ray<R>,
    /// What it starts on.
    pub start: Primitive,
}

/// A hit, refined.
#[derive(Clone, Copy, Debug)]
pub struct Hit<R> {
    /// On the surface.
    pub point: Vec3<R>,
    /// Unit normal of the surface, on either side.
    pub normal: Vec3<R>,
    /// Index into [`Plan::materials`].
    pub material: u32,
    /// What was hit.
    pub primitive: Primitive,
    /// How far the point may be off along the normal: 0, or a few roundings where it matters.
    pub slack: R,
}

/// The nearest primitive along the path, or `None`.
pub fn nearest<R: Real>(plan: &Plan<R>, path: &Path<R>) -> Option<Hit<R>> {
    let ray = &path.ray;
    let mut best = (R::INFINITY, Primitive::Nothing);
    let mut offer = |t: R, primitive| {
        if t < best.0 {
            best = (t, primitive);
        }
    };
    for (index, sphere) in plan.spheres.iter().enumerate() {
        let primitive = Primitive::Sphere(index);
        offer(sphere_distance(plan, path, sphere, primitive), primitive);
    }
    for (index, plane) in plan.planes.iter().enumerate() {
        let primitive = Primitive::Plane(index);
        if primitive != path.start {
            offer(plane::intersect(ray, plane), primitive);
        }
    }
    if !plan.triangles.is_empty() {
        let shear = Shear::new(ray.direction);
        for (index, triangle) in plan.triangles.iter().enumerate() {
            let primitive = Primitive::Triangle(index);
            if primitive != path.start {
                let method = plan.methods.triangle;
                offer(
                    triangle::intersect(method, ray, &shear, triangle),
                    primitive,
                );
            }
        }
    }
    refine(plan, ray, best.0, best.1)
}

/// Whether a primitive that casts shadows meets the path before `distance`.
pub fn is_blocked<R: Real>(plan: &Plan<R>, path: &Path<R>, distance: R) -> bool {
    let ray = &path.ray;
    let casting = &plan.spheres[..plan.casting_spheres];
    let by_sphere = casting.iter().enumerate().any(|(index, sphere)| {
        sphere_distance(plan, path, sphere, Primitive::Sphere(index)) < distance
    });
    if by_sphere {
        return true;
    }
    let by_plane = plan.planes.iter().enumerate().any(|(index, plane)| {
        path.start != Primitive::Plane(index) && plane::intersect(ray, plane) < distance
    });
    if by_plane || plan.triangles.is_empty() {
        return by_plane;
    }
    let shear = Shear::new(ray.direction);
    plan.triangles.iter().enumerate().any(|(index, triangle)| {
        path.start != Primitive::Triangle(index)
            && triangle::intersect(plan.methods.triangle, ray, &shear, triangle) < distance
    })
}

#[inline(always)]
fn sphere_distance<R: Real>(
    plan: &Plan<R>,
    path: &Path<R>,
    sphere: &crate::plan::Sphere<R>,
    primitive: Primitive,
) -> R {
    if path.start == primitive {
        sphere::leave(&path.ray, sphere)
    } else {
        sphere::intersect(plan.methods.sphere, &path.ray, sphere)
    }
}

fn refine<R: Real>(plan: &Plan<R>, ray: &Ray<R>, t: R, primitive: Primitive) -> Option<Hit<R>> {
    Some(match primitive {
        Primitive::Nothing => return None,
        Primitive::Sphere(index) => {
            let sphere = &plan.spheres[index];
            let (point, normal) = sphere::refine(ray, sphere, t);
            Hit {
                point,
                normal,
                material: sphere.material,
                primitive,
                slack: R::ZERO,
            }
        }
        Primitive::Plane(index) => {
            let plane = &plan.planes[index];
            let point = plane::refine(ray, plane, t);
            Hit {
                point,
                normal: plane.normal,
                material: plane.material,
                primitive,
                slack: R::ZERO,
            }
        }
        Primitive::Triangle(index) => {
            let triangle = &plan.triangles[index];
            let point = triangle::refine(ray, triangle, t);
            // The neighbours in a mesh meet the triangle at its edges: 4u·(|p| + |o| + t) is what
            // the computation of the point can be off by.
            let slack = if triangle.in_mesh {
                let reach = point.max_abs() + ray.origin.max_abs() + t;
                reach * (R::UNIT_ROUNDOFF * R::from_f64(4.0))
            } else {
                R::ZERO
            };
            Hit {
                point,
                normal: triangle.normal,
                material: triangle.material,
                primitive,
                slack,
            }
        }
    })
}

impl<R: Real> Hit<R> {
    /// The path that leaves the hit in a unit direction.
    pub fn leave(&self, plan: &Plan<R>, direction: Vec3<R>) -> Path<R> {
        match plan.methods.offset {
            RayOffset::Robust => {
                let along = self.normal.dot(direction) >= R::ZERO;
                let slack = if along { self.slack } else { -self.slack };
                let origin = self.point + self.normal * slack;
                Path {
                    ray: Ray { origin, direction },
                    start: self.primitive,
                }
            }
            RayOffset::Fixed(distance) => {
                let origin = self.point + direction * R::from_f64(distance);
                Path {
                    ray: Ray { origin, direction },
                    start: Primitive::Nothing,
                }
            }
        }
    }
}
