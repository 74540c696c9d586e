//! Triangle formulas that fail somewhere, kept to show where.

use super::Ray;
use crate::plan::Triangle;
use crate::simd::{Real, SimdFloat, Vec3};

/// The formula of the original program: where the ray meets the plane, then, edge by edge in clockwise
/// order, whether the cross product with the edge points away from the normal. Every rounding of
/// the hit moves it across the edge differently for each neighbour.
#[inline(always)]
pub fn edges<L: SimdFloat>(token: L::Token, ray: &Ray<L>, triangle: &Triangle<L::Real>) -> L {
    let n: Vec3<L> = Vec3::broadcast(token, triangle.normal);
    let [a, b, c] = triangle.corners;
    let (a, b, c) = (
        Vec3::broadcast(token, a),
        Vec3::broadcast(token, b),
        Vec3::broadcast(token, c),
    );
    let t = (a - ray.origin).dot(n) / ray.direction.dot(n);
    let p = ray.at(t);
    let zero = L::splat(token, L::Real::ZERO);
    let inside = (b - a).cross(p - a).dot(n).at_most(zero)
        & (c - b).cross(p - b).dot(n).at_most(zero)
        & (a - c).cross(p - c).dot(n).at_most(zero);
    L::select(inside & zero.less(t), t, L::splat(token, L::Real::INFINITY))
}

/// Barycentric coordinates by Cramer's rule. u, v and 1 - u - v come from different expressions in
/// each triangle, so that neighbours disagree on their shared edge.
///
/// Möller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", Journal of Graphics Tools
/// 2(1), 1997; without its fixed threshold for the determinant, which fails in small scenes.
#[inline(always)]
pub fn moller_trumbore<L: SimdFloat>(
    token: L::Token,
    ray: &Ray<L>,
    triangle: &Triangle<L::Real>,
) -> L {
    let [a, b, c] = triangle.corners;
    let (ab, ac) = (Vec3::broadcast(token, b - a), Vec3::broadcast(token, c - a));
    let across = ray.direction.cross(ac);
    let reciprocal = L::splat(token, L::Real::ONE) / ab.dot(across);
    let from = ray.origin - Vec3::broadcast(token, a);
    let u = from.dot(across) * reciprocal;
    let turned = from.cross(ab);
    let v = ray.direction.dot(turned) * reciprocal;
    let t = ac.dot(turned) * reciprocal;
    let (zero, one) = (
        L::splat(token, L::Real::ZERO),
        L::splat(token, L::Real::ONE),
    );
    let inside = zero.at_most(u) & zero.at_most(v) & (u + v).at_most(one);
    // A ray along the plane has no coordinates: NaN is in no range, and neither is infinity.
    let infinity = L::splat(token, L::Real::INFINITY);
    L::select(inside & zero.less(t) & t.less(infinity), t, infinity)
}

/// On which side of the planes through the ray's origin and each edge the ray goes. Neighbours get
/// the same number on a shared edge, but three planes that meet in a corner do not meet exactly.
///
/// Plücker's edge functions with the origin moved into the ray's; Davidovič, Engelhardt, Georgiev,
/// Slusallek and Dachsbacher, "3D rasterization: a bridge between rasterization and ray casting",
/// Graphics Interface 2012.
#[inline(always)]
pub fn edge_planes<L: SimdFloat>(token: L::Token, ray: &Ray<L>, triangle: &Triangle<L::Real>) -> L {
    let [a, b, c] = triangle.corners;
    let a = Vec3::broadcast(token, a) - ray.origin;
    let b = Vec3::broadcast(token, b) - ray.origin;
    let c = Vec3::broadcast(token, c) - ray.origin;
    let (d, zero) = (ray.direction, L::splat(token, L::Real::ZERO));
    let (u, v, w) = (d.dot(b.cross(c)), d.dot(c.cross(a)), d.dot(a.cross(b)));
    let none_negative = zero.at_most(u) & zero.at_most(v) & zero.at_most(w);
    let none_positive = u.at_most(zero) & v.at_most(zero) & w.at_most(zero);
    let t = a.dot(b.cross(c)) / (u + v + w);
    let infinity = L::splat(token, L::Real::INFINITY);
    let inside = (none_negative | none_positive) & zero.less(t) & t.less(infinity);
    L::select(inside, t, infinity)
}
