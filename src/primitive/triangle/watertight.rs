//! The test that lets no ray slip between two triangles.

use super::packed::PackedTriangle;
use crate::primitive::ray::Ray;
use crate::simd::{Mask as _, Real, SimdFloat, Vec3};

/// Least ratio of a distance from the ray to the same distance in the sheared plane, which is at most as oblique as
/// the diagonal of a cube: slightly less than 1/√3.
const MIN_SHEARED_RATIO: f64 = 0.577;

/// Data that the watertight test derives from a ray once: the axis along which the direction is largest, which
/// becomes z, and the shear that aligns the ray with it.
#[derive(Clone, Copy, Debug)]
pub struct Shear<L: SimdFloat> {
    /// The lanes whose major axis is x, and those where it is y.
    is_x: L::Mask,
    is_y: L::Mask,
    /// The major axis, if all lanes have the same.
    common_axis: Option<MajorAxis>,
    /// Shift of x per unit of depth.
    pub x: L,
    y: L,
    /// One over the direction's component along the major axis.
    pub z: L,
}

#[derive(Clone, Copy, Debug)]
enum MajorAxis {
    X,
    Y,
    Z,
}

/// How rays pass a triangle.
#[derive(Clone, Copy, Debug)]
pub struct Passing<L: SimdFloat> {
    /// Whether they pass through it.
    pub inside: L::Mask,
    /// Distance from the rays to the nearest edge, ahead of their start.
    pub nearest: L,
    /// Distance to the second nearest edge.
    pub second: L,
    /// Distance along the rays to where they are nearest to the nearest edge.
    pub nearest_at: L,
}

impl<L: SimdFloat> Shear<L> {
    /// The shear of a direction (not zero).
    #[inline(always)]
    pub fn new(direction: Vec3<L>) -> Self {
        let (x, y, z) = (direction.x.abs(), direction.y.abs(), direction.z.abs());
        let is_x = y.less(x) & z.less(x);
        let is_y = !is_x & z.less(y);
        let one = direction.x.like(L::Real::ONE);
        let mut shear = Self {
            is_x,
            is_y,
            common_axis: None,
            x: one,
            y: one,
            z: one,
        };
        let all = one.same(one).bits();
        shear.common_axis = match (is_x.bits(), is_y.bits()) {
            (0, 0) => Some(MajorAxis::Z),
            (xs, _) if xs == all => Some(MajorAxis::X),
            (0, ys) if ys == all => Some(MajorAxis::Y),
            _ => None,
        };
        let [across, upwards, along] = shear.permuted(direction);
        let reciprocal = one / along;
        Self {
            x: across * reciprocal,
            y: upwards * reciprocal,
            z: reciprocal,
            ..shear
        }
    }

    /// The components in cyclic order, the major axis last.
    #[inline(always)]
    fn permuted(&self, v: Vec3<L>) -> [L; 3] {
        match self.common_axis {
            Some(MajorAxis::X) => [v.y, v.z, v.x],
            Some(MajorAxis::Y) => [v.z, v.x, v.y],
            Some(MajorAxis::Z) => [v.x, v.y, v.z],
            None => [
                self.pick(v.y, v.z, v.x),
                self.pick(v.z, v.x, v.y),
                self.pick(v.x, v.y, v.z),
            ],
        }
    }

    /// Selects the value for each lane's major axis.
    #[inline(always)]
    fn pick(&self, x: L, y: L, z: L) -> L {
        L::select(self.is_x, x, L::select(self.is_y, y, z))
    }

    /// Returns for an edge between two sheared corners: its orientation around the ray, the square of its distance
    /// from the ray, and the distance along the ray where it is nearest. The square is infinite if that is behind
    /// the start.
    #[inline(always)]
    fn nearest_on_edge(&self, from: [L; 3], to: [L; 3]) -> (L, L, L) {
        let (zero, one) = (self.x.like(L::Real::ZERO), self.x.like(L::Real::ONE));
        let (x, y) = (to[0] - from[0], to[1] - from[1]);
        let share = -(from[0] * x + from[1] * y) / (x * x + y * y);
        let share = share.max(zero).min(one);
        let (x_near, y_near) = (from[0] + x * share, from[1] + y * share);
        // The sheared plane is not perpendicular to the ray, so the component along the ray is removed.
        let along = (x_near * self.x + y_near * self.y) / self.z;
        let square = (x_near * x_near + y_near * y_near - along * along).max(zero);
        let at = (from[2] + (to[2] - from[2]) * share) * self.z;
        let square = L::select(zero.less(at), square, zero.like(L::Real::INFINITY));
        (from[0] * y - from[1] * x, square, at)
    }

    /// Returns how the ray passes a triangle, given its sheared corners.
    #[inline(always)]
    pub fn passing(&self, [a, b, c]: [[L; 3]; 3]) -> Passing<L> {
        let edges = [
            self.nearest_on_edge(a, b),
            self.nearest_on_edge(b, c),
            self.nearest_on_edge(c, a),
        ];
        let zero = self.x.like(L::Real::ZERO);
        let (mut min_orientation, mut nearest, mut nearest_at) = edges[0];
        let (mut max_orientation, mut second) = (min_orientation, zero.like(L::Real::INFINITY));
        for (orientation, square, at) in [edges[1], edges[2]] {
            (min_orientation, max_orientation) = (
                min_orientation.min(orientation),
                max_orientation.max(orientation),
            );
            nearest_at = L::select(square.less(nearest), at, nearest_at);
            second = second.min(nearest.max(square));
            nearest = nearest.min(square);
        }
        Passing {
            // All edges have the same orientation around the ray.
            inside: zero.less(min_orientation) | max_orientation.less(zero),
            nearest: nearest.sqrt(),
            second: second.sqrt(),
            nearest_at,
        }
    }

    /// A lower bound of the distance between the ray and a triangle with these sheared corners, by the box around
    /// it.
    #[inline(always)]
    pub fn min_distance(&self, [a, b, c]: [[L; 3]; 3]) -> L {
        let x = a[0].min(b[0]).min(c[0]).max(-a[0].max(b[0]).max(c[0]));
        let y = a[1].min(b[1]).min(c[1]).max(-a[1].max(b[1]).max(c[1]));
        x.max(y) * self.x.like_f64(MIN_SHEARED_RATIO)
    }

    /// The distance to the plane of a triangle with these sheared corners and edge functions. All three functions
    /// are zero for a triangle seen edge-on: 0/0 fails every comparison.
    #[inline(always)]
    pub fn distance(&self, [a, b, c]: [[L; 3]; 3], [u, v, w]: [L; 3]) -> L {
        (u * a[2] + v * b[2] + w * c[2]) * self.z / (u + v + w)
    }

    /// A corner relative to the ray's origin: sheared x and y, and its depth along the axis.
    #[inline(always)]
    pub fn apply(&self, corner: Vec3<L>) -> [L; 3] {
        let [x, y, depth] = self.permuted(corner);
        [x - self.x * depth, y - self.y * depth, depth]
    }
}

/// Shears the corners so that the ray is the z axis, then evaluates three 2D edge functions. Each is computed from
/// per-corner values, so two triangles get the same number, up to sign, on a shared edge: no ray slips between
/// them. No multiplication here may be fused with an addition.
///
/// Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013.
#[inline(always)]
pub fn watertight<L: SimdFloat>(
    ray: &Ray<L>,
    shear: &Shear<L>,
    triangle: &PackedTriangle<L::Real>,
) -> L {
    let (corners, edges) = edges_of(ray, shear, triangle);
    let [u, v, w] = edges;
    let zero = u.like(L::Real::ZERO);
    let none_negative = zero.at_most(u) & zero.at_most(v) & zero.at_most(w);
    let none_positive = u.at_most(zero) & v.at_most(zero) & w.at_most(zero);
    let infinity = u.like(L::Real::INFINITY);
    let inside = none_negative | none_positive;
    if !inside.any() {
        return infinity;
    }
    let t = shear.distance(corners, edges);
    L::select(inside & zero.less(t), t, infinity)
}

/// Returns the sheared corners and the edge functions, whose signs are the edges' orientations around the ray.
#[inline(always)]
pub fn edges_of<L: SimdFloat>(
    ray: &Ray<L>,
    shear: &Shear<L>,
    triangle: &PackedTriangle<L::Real>,
) -> ([[L; 3]; 3], [L; 3]) {
    // Written out, since a closure called by the standard library is not compiled with the lanes' instruction set.
    let [a, b, c] = triangle.corners;
    let a = shear.apply(ray.origin.like(a) - ray.origin);
    let b = shear.apply(ray.origin.like(b) - ray.origin);
    let c = shear.apply(ray.origin.like(c) - ray.origin);
    let u = c[0] * b[1] - c[1] * b[0];
    let v = a[0] * c[1] - a[1] * c[0];
    let w = b[0] * a[1] - b[1] * a[0];
    ([a, b, c], [u, v, w])
}
