//! Flat faces that are shaded as if they were curved.

use crate::primitive::kind::SurfacePoint;
use crate::simd::{Real, SimdFloat, Vec3};

/// Cosine to which a mirrored ray is lifted that would go into the face.
const LEAST_COSINE: f64 = 0.01;

/// How far the ends of unit normals may be apart that are the same, in any precision.
const ALIKE: f64 = 1e-5;

/// The normals of a face that is shaded as if it were curved.
#[derive(Clone, Copy, Debug)]
pub struct CornerNormals<R> {
    /// Unit normals at its corners.
    pub normals: [Vec3<R>; 3],
    /// One over the smallest radius of curvature along its edges.
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

    /// Whether they are the same but for rounding: the face looks as flat as it is.
    pub fn are_alike(&self) -> bool {
        let [a, b, c] = self.normals;
        (a - b).length().max((a - c).length()) < R::from_f64(ALIKE)
    }
}

/// What is needed of such a face where it is hit, for each ray of its own face.
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
    /// The hits on the flat faces, with the normals of a curved surface and lifted onto it: Phong,
    /// "Illumination for computer generated pictures", CACM 18(6), 1975; Hanika, "Hacking the shadow
    /// terminator", Ray Tracing Gems II (2021), ch. 4. All faces are turned to where rays in this direction
    /// come from.
    #[inline(always)]
    pub fn bend(&self, flat: &SurfacePoint<L>, direction: Vec3<L>) -> SurfacePoint<L> {
        let zero = direction.x.like(L::Real::ZERO);
        let is_away = zero.less(flat.normal.dot(direction));
        let face = Vec3::select(is_away, -flat.normal, flat.normal);
        let weights = weights(self.corners, flat.normal, flat.point);
        let mut normal = Vec3::splat(zero);
        let mut lift = normal;
        for (index, weight) in weights.into_iter().enumerate() {
            let own = self.normals[index];
            let own = Vec3::select(is_away, -own, own);
            // Onto the plane of the corner where that is above: a surface that is bent inwards stays flat.
            let below = (flat.point - self.corners[index]).dot(own).min(zero);
            normal = normal + own * weight;
            lift = lift - own * (below * weight);
        }
        let normal = normal * (zero.like(L::Real::ONE) / normal.length());
        SurfacePoint {
            point: flat.point + lift + face * flat.slack,
            normal: kept_out(normal, face, direction),
            curvature: self.curvature,
            slack: zero,
            size: flat.size,
        }
    }
}

/// How much each corner has of a point of the triangle: the area on its other side.
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

/// A normal like `normal` that mirrors rays to the side of the face where they come from.
#[inline(always)]
fn kept_out<L: SimdFloat>(normal: Vec3<L>, face: Vec3<L>, direction: Vec3<L>) -> Vec3<L> {
    let along = direction.dot(normal);
    let mirrored = direction - normal * (along + along);
    let height = mirrored.dot(face);
    // A ray that grazes the face leaves as flatly as it came.
    let come = -direction.dot(face);
    let least = (come * come.like_f64(0.9)).min(come.like_f64(LEAST_COSINE));
    let raised = mirrored + face * (least - height);
    let raised = raised * (come.like(L::Real::ONE) / raised.length());
    let between = raised - direction;
    let length = between.length();
    let between = between * (come.like(L::Real::ONE) / length);
    // A ray along the face is mirrored by nothing else.
    let between = Vec3::select(come.like(L::Real::ZERO).less(length), between, face);
    Vec3::select(height.less(least), between, normal)
}
