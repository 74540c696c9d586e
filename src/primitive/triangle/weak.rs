//! Triangle formulas that fail in some cases, kept to show where.

use super::packed::PackedTriangle;
use crate::primitive::ray::Ray;
use crate::scene::TriangleMethod;
use crate::simd::{Real, SimdFloat, Vec3};

/// Evaluates one of the formulas. Not inlined: only the lab uses it, but it is called from everywhere.
#[inline(never)]
pub fn weak<L: SimdFloat>(
    ray: &Ray<L>,
    triangle: &PackedTriangle<L::Real>,
    method: TriangleMethod,
) -> L {
    L::vectorize(
        ray.origin.x.token(),
        #[inline(always)]
        || match method {
            TriangleMethod::Edges => edges(ray, triangle),
            TriangleMethod::MollerTrumbore => moller_trumbore(ray, triangle),
            TriangleMethod::EdgePlanes | TriangleMethod::Watertight => edge_planes(ray, triangle),
        },
    )
}

/// The formula of the original program: intersects the ray with the plane, then checks for each edge in clockwise
/// order whether the cross product with the edge points away from the normal. Each rounding of the hit shifts it
/// across the edge differently for each neighbour.
#[inline(always)]
fn edges<L: SimdFloat>(ray: &Ray<L>, triangle: &PackedTriangle<L::Real>) -> L {
    let n: Vec3<L> = ray.origin.like(triangle.normal);
    let [a, b, c] = triangle.corners;
    let (a, b, c) = (ray.origin.like(a), ray.origin.like(b), ray.origin.like(c));
    let t = (a - ray.origin).dot(n) / ray.direction.dot(n);
    let p = ray.at(t);
    let zero = ray.origin.x.like(L::Real::ZERO);
    let inside = (b - a).cross(p - a).dot(n).at_most(zero)
        & (c - b).cross(p - b).dot(n).at_most(zero)
        & (a - c).cross(p - c).dot(n).at_most(zero);
    L::select(
        inside & zero.less(t),
        t,
        ray.origin.x.like(L::Real::INFINITY),
    )
}

/// Barycentric coordinates by Cramer's rule. u, v and 1 - u - v come from different expressions in
/// each triangle, so that neighbours disagree on their shared edge.
///
/// Möller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", Journal of Graphics Tools
/// 2(1), 1997; without its fixed threshold for the determinant, which fails in small scenes.
#[inline(always)]
fn moller_trumbore<L: SimdFloat>(ray: &Ray<L>, triangle: &PackedTriangle<L::Real>) -> L {
    let [a, b, c] = triangle.corners;
    let (ab, ac) = (ray.origin.like(b - a), ray.origin.like(c - a));
    let across = ray.direction.cross(ac);
    let reciprocal = ray.origin.x.like(L::Real::ONE) / ab.dot(across);
    let from = ray.origin - ray.origin.like(a);
    let u = from.dot(across) * reciprocal;
    let turned = from.cross(ab);
    let v = ray.direction.dot(turned) * reciprocal;
    let t = ac.dot(turned) * reciprocal;
    let (zero, one) = (
        ray.origin.x.like(L::Real::ZERO),
        ray.origin.x.like(L::Real::ONE),
    );
    let inside = zero.at_most(u) & zero.at_most(v) & (u + v).at_most(one);
    // A ray along the plane has no coordinates: NaN is in no range, and neither is infinity.
    let infinity = ray.origin.x.like(L::Real::INFINITY);
    L::select(inside & zero.less(t) & t.less(infinity), t, infinity)
}

/// Checks on which side of the planes through the ray's origin and each edge the ray is. Neighbours get the same
/// number on a shared edge, but three planes through a corner do not intersect exactly there.
///
/// Plücker's edge functions with the origin moved into the ray's; Davidovič, Engelhardt, Georgiev,
/// Slusallek and Dachsbacher, "3D rasterization: a bridge between rasterization and ray casting",
/// Graphics Interface 2012.
#[inline(always)]
fn edge_planes<L: SimdFloat>(ray: &Ray<L>, triangle: &PackedTriangle<L::Real>) -> L {
    let [a, b, c] = triangle.corners;
    let a = ray.origin.like(a) - ray.origin;
    let b = ray.origin.like(b) - ray.origin;
    let c = ray.origin.like(c) - ray.origin;
    let (d, zero) = (ray.direction, ray.origin.x.like(L::Real::ZERO));
    let (u, v, w) = (d.dot(b.cross(c)), d.dot(c.cross(a)), d.dot(a.cross(b)));
    let none_negative = zero.at_most(u) & zero.at_most(v) & zero.at_most(w);
    let none_positive = u.at_most(zero) & v.at_most(zero) & w.at_most(zero);
    let t = a.dot(b.cross(c)) / (u + v + w);
    let infinity = ray.origin.x.like(L::Real::INFINITY);
    let inside = (none_negative | none_positive) & zero.less(t) & t.less(infinity);
    L::select(inside, t, infinity)
}
