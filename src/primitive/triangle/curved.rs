//! Flat faces shaded as curved ones.

use crate::primitive::kind::SurfacePoint;
use crate::simd::{Real, SimdFloat, Vec3};

/// Cosine between a face's normal and a mirrored ray to which a ray that would enter the face is raised.
const MIN_COSINE: f64 = 0.01;

/// Distance between the ends of unit normals up to which they count as equal, in any precision.
const MAX_NORMAL_DIFFERENCE: f64 = 1e-5;

/// The normals of a face that is shaded as curved.
#[derive(Clone, Copy, Debug)]
pub struct CornerNormals<R> {
    /// Unit normals at the corners.
    pub normals: [Vec3<R>; 3],
    /// One over the smallest radius of curvature along the edges.
    pub curvature: R,
}

impl<R: Real> CornerNormals<R> {
    /// The same, rounded to another precision.
    pub fn in_precision<S: Real>(&self) -> CornerNormals<S> {
        CornerNormals {
            normals: self.normals.map(Vec3::in_precision),
            curvature: S::from_f64(self.curvature.to_f64()),
        }
    }

    /// Returns whether the normals are equal but for rounding, so that the face looks flat.
    pub fn are_alike(&self) -> bool {
        let [a, b, c] = self.normals;
        (a - b).length().max((a - c).length()) < R::from_f64(MAX_NORMAL_DIFFERENCE)
    }
}

/// What is needed of such a face where it is hit; each ray may have a different face.
#[derive(Clone, Copy, Debug)]
pub struct Curved<L> {
    /// The corners.
    pub corners: [Vec3<L>; 3],
    /// Unit normals at the corners.
    pub normals: [Vec3<L>; 3],
    /// One over the radius of curvature.
    pub curvature: L,
}

impl<L: SimdFloat> Curved<L> {
    /// Lifts hits on the flat faces onto the curved surface and gives them its normals: Phong, "Illumination for
    /// computer generated pictures", CACM 18(6), 1975; Hanika, "Hacking the shadow terminator", Ray Tracing Gems II
    /// (2021), ch. 4. All faces are turned towards the origins of rays in this direction.
    #[inline(always)]
    pub fn bend(&self, flat: &SurfacePoint<L>, direction: Vec3<L>) -> SurfacePoint<L> {
        let zero = direction.x.like(L::Real::ZERO);
        let is_away = zero.less(flat.normal.dot(direction));
        let face = Vec3::select(is_away, -flat.normal, flat.normal);
        let weights = weights(self.corners, flat.normal, flat.point);
        let mut normal = Vec3::splat(zero);
        let mut lift = normal;
        for (index, weight) in weights.into_iter().enumerate() {
            let corner_normal = self.normals[index];
            let corner_normal = Vec3::select(is_away, -corner_normal, corner_normal);
            // Onto the tangent plane of the corner if that is above; a concave surface stays flat.
            let below = (flat.point - self.corners[index])
                .dot(corner_normal)
                .min(zero);
            normal = normal + corner_normal * weight;
            lift = lift - corner_normal * (below * weight);
        }
        let normal = normal * (zero.like(L::Real::ONE) / normal.length());
        SurfacePoint {
            point: flat.point + lift + face * flat.slack,
            normal: keep_mirrored_outside(normal, face, direction),
            curvature: self.curvature,
            slack: zero,
            size: flat.size,
        }
    }
}

/// The barycentric coordinates of a point: for each corner, the share of the area opposite to it.
#[inline(always)]
fn weights<L: SimdFloat>([a, b, c]: [Vec3<L>; 3], normal: Vec3<L>, point: Vec3<L>) -> [L; 3] {
    let (a, b, c) = (a - point, b - point, c - point);
    let areas = [
        normal.dot(b.cross(c)),
        normal.dot(c.cross(a)),
        normal.dot(a.cross(b)),
    ];
    let sum = areas[0] + areas[1] + areas[2];
    let zero = sum.like(L::Real::ZERO);
    let [a, b, c] = areas.map(
        #[inline(always)]
        |area| (area / sum).max(zero),
    );
    let scale = zero.like(L::Real::ONE) / (a + b + c);
    [a * scale, b * scale, c * scale]
}

/// Returns `normal`, adjusted where needed so that it mirrors rays to the side of the face that they come from.
#[inline(always)]
fn keep_mirrored_outside<L: SimdFloat>(
    normal: Vec3<L>,
    face: Vec3<L>,
    direction: Vec3<L>,
) -> Vec3<L> {
    let along = direction.dot(normal);
    let mirrored = direction - normal * (along + along);
    let height = mirrored.dot(face);
    // Rays that graze the face may leave it as flatly as they came.
    let incidence = -direction.dot(face);
    let min_height = (incidence * incidence.like_f64(0.9)).min(incidence.like_f64(MIN_COSINE));
    let raised = mirrored + face * (min_height - height);
    let raised = raised * (incidence.like(L::Real::ONE) / raised.length());
    let between = raised - direction;
    let length = between.length();
    let between = between * (incidence.like(L::Real::ONE) / length);
    // A ray along the face is mirrored only by the face's own normal.
    let between = Vec3::select(incidence.like(L::Real::ZERO).less(length), between, face);
    Vec3::select(height.less(min_height), between, normal)
}
