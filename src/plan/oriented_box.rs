//! Oriented boxes around slender meshes: a rod that lies across all axes fills hardly any of its axis-aligned box.

use glam::{DMat3, DVec3};

use crate::primitive::{BoundingBox, PackedTriangle};
use crate::scene::around;
use crate::simd::{Real, Vec3};

/// Largest surface of an oriented box that is worth a test, as a share of the surface of the axis-aligned box.
const WORTH_TESTING: f64 = 0.25;
/// Number of triangles above which a mesh has none: finding it would take time whenever the mesh is rotated, and the
/// boxes in its tree are small.
const MAX_TRIANGLES: usize = 10_000;

/// A box with axes of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrientedBox<R> {
    /// Its centre.
    pub centre: Vec3<R>,
    /// Its axes, orthonormal up to rounding.
    pub axes: [Vec3<R>; 3],
    /// Half of its length along each axis; rounding is left to the tests.
    pub half: [R; 3],
}

impl<R: Real> OrientedBox<R> {
    /// Finds a box around triangles, along their longest direction and the one farthest from that. Returns `None`
    /// if it is hardly smaller than `bounds`, their axis-aligned box.
    pub fn around(triangles: &[PackedTriangle<R>], bounds: &BoundingBox<R>) -> Option<Self> {
        if triangles.is_empty() || triangles.len() > MAX_TRIANGLES {
            return None;
        }
        let corners = || {
            let corners = triangles.iter().flat_map(|triangle| triangle.corners);
            corners.map(Vec3::to_dvec3)
        };
        let farthest = |distance: &dyn Fn(DVec3) -> f64| {
            corners().max_by(|&a, &b| f64::total_cmp(&distance(a), &distance(b)))
        };
        let start = farthest(&|corner| corner.length_squared())?;
        let end = farthest(&|corner| corner.distance_squared(start))?;
        let along = (end - start).try_normalize()?;
        let aside = |corner: DVec3| (corner - start).reject_from_normalized(along);
        let widest = aside(farthest(&|corner| aside(corner).length_squared())?);
        // Rejected once more: what is left of a short vector may not be perpendicular.
        let across = widest.normalize_or_zero().reject_from_normalized(along);
        let across = across.normalize_or(along.any_orthonormal_vector());
        let axes = DMat3::from_cols(along, across, along.cross(across));
        let into = axes.transpose();
        let turned = corners().map(|corner| into * corner);
        let (low, high) = around(turned.map(|corner| (corner, corner)))?;
        let half = high * 0.5 - low * 0.5;
        let aligned = bounds.high.to_dvec3() * 0.5 - bounds.low.to_dvec3() * 0.5;
        (surface(half) < WORTH_TESTING * surface(aligned)).then(|| Self {
            centre: Vec3::from_dvec3(axes * low.midpoint(high)),
            axes: [axes.x_axis, axes.y_axis, axes.z_axis].map(Vec3::from_dvec3),
            half: half.to_array().map(R::from_f64),
        })
    }
}

/// An eighth of the surface of a box, given half of its lengths.
fn surface(half: DVec3) -> f64 {
    half.x * half.y + half.y * half.z + half.z * half.x
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// A needle from the origin, with its axis-aligned box.
    fn needle(tip: DVec3, width: f64) -> (Vec<PackedTriangle<f64>>, BoundingBox<f64>) {
        let (across, other) = tip.normalize().any_orthonormal_pair();
        let [a, b] = [across, other].map(|side| side * width);
        let faces = [[a, -a, tip], [b, -b, tip], [a, b, -a]];
        let triangles: Vec<_> = faces
            .into_iter()
            .filter_map(PackedTriangle::of_mesh)
            .collect();
        let corners: Vec<_> = triangles
            .iter()
            .flat_map(|triangle| triangle.corners)
            .collect();
        (triangles, BoundingBox::around(&corners))
    }

    proptest! {
        #[test]
        fn every_corner_is_in_the_box(
            tip in prop::array::uniform3(5.0..90.0),
            width in 1e-6..0.5,
        ) {
            let (triangles, bounds) = needle(DVec3::from_array(tip), width);
            let oriented = OrientedBox::around(&triangles, &bounds).expect("a needle has one");
            for corner in triangles.iter().flat_map(|triangle| triangle.corners) {
                for (axis, half) in oriented.axes.into_iter().zip(oriented.half) {
                    let along = (corner - oriented.centre).dot(axis).abs();
                    prop_assert!(along <= half + 1e-12, "{along} {half}");
                }
            }
            prop_assert!(oriented.half[1].max(oriented.half[2]) <= 1.5 * width);
        }
    }

    #[test]
    fn what_fills_its_aligned_box_needs_no_other() {
        let (triangles, bounds) = needle(DVec3::X * 10.0, 0.1);
        assert_eq!(OrientedBox::around(&triangles, &bounds), None);
        assert_eq!(OrientedBox::around(&[], &bounds), None);
    }
}
