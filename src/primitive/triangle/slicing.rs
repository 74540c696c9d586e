//! Slices of long narrow triangles, each with a box of its own in a tree. The box around all of such a triangle is
//! mostly empty unless it lies along an axis, and in a round cone or cylinder the boxes of all faces overlap. Ernst and
//! Greiner, "Early split clipping for bounding volume hierarchies", IEEE Symposium on Interactive Ray Tracing 2007.

use super::vertex::Vertex;
use crate::primitive::bounding_box::BoundingBox;
use crate::primitive::ray::Ray;
use crate::simd::{Real, SimdFloat, Vec3};

/// Length of a slice, in heights of the triangle over its longest edge: shorter slices make more boxes than they empty.
const SLICE_LENGTH: f64 = 6.0;
/// Maximum number of slices of a triangle.
const MAX_SLICES: u8 = 32;
/// Roundings to single precision, of numbers as large as a triangle's largest coordinate, by which the boxes of its
/// slices may be off: one of the corners, and those of a few sums and products.
const ROUNDINGS: f64 = 8.0;

/// The slices of equal length into which a triangle is cut across its longest edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slicing {
    /// The corner at which that edge begins.
    from: Vertex,
    /// The corner at which it ends.
    to: Vertex,
    /// The number of slices.
    count: u8,
}

impl Slicing {
    /// A single slice.
    pub const WHOLE: Self = Self {
        from: Vertex::A,
        to: Vertex::B,
        count: 1,
    };

    /// The slices of a triangle with these corners, at least one. Their number does not depend on where and how it
    /// lies, except for rounding.
    pub fn of(corners: &[Vec3<f64>; 3]) -> Self {
        let [a, b, c] = *corners;
        let edges = [
            (Vertex::A, Vertex::B, b - a),
            (Vertex::B, Vertex::C, c - b),
            (Vertex::C, Vertex::A, a - c),
        ];
        let square = |edge: Vec3<f64>| edge.dot(edge);
        let [first, ..] = edges;
        let (from, to, longest) = edges.into_iter().fold(first, |longest, edge| {
            if square(longest.2) < square(edge.2) {
                edge
            } else {
                longest
            }
        });
        let double_area = (b - a).cross(c - b).length();
        // NaN becomes 0.
        let count = (square(longest) / (double_area * SLICE_LENGTH)) as usize;
        Self {
            from,
            to,
            count: count.clamp(1, usize::from(MAX_SLICES)) as u8,
        }
    }

    /// The number of slices.
    pub fn count(self) -> u8 {
        self.count
    }

    /// The same with another number of slices, at least 1.
    #[must_use]
    pub fn with_count(self, count: u8) -> Self {
        Self { count, ..self }
    }

    /// The slices after the corners B and C have changed places; each keeps its number.
    #[must_use]
    pub fn flipped(self) -> Self {
        Self {
            from: self.from.flipped(),
            to: self.to.flipped(),
            ..self
        }
    }

    /// The box around a slice of a triangle with these corners; slices are counted along the edge from 0.
    pub fn bounds<R: Real>(self, corners: &[Vec3<R>; 3], index: u8) -> BoundingBox<R> {
        if self.count == 1 {
            return BoundingBox::around(corners);
        }
        let (from, to) = (self.from as usize, self.to as usize);
        let [from, to, apex] = [from, to, 3 - from - to].map(|corner| corners[corner]);
        let along = to - from;
        // The apex is above the edge, since that is the longest.
        let middle = (apex - from).dot(along) / along.dot(along);
        let middle = middle.max(R::ZERO).min(R::ONE);
        let share = |index: u8| R::from_f64(f64::from(index) / f64::from(self.count));
        let (start, end) = (share(index), share(index + 1));
        let on_sides = |share: R| {
            if share < middle {
                from + (apex - from) * (share / middle)
            } else {
                let tiny = R::from_f64(f64::from(f32::MIN_POSITIVE));
                apex + (to - apex) * ((share - middle) / (R::ONE - middle).max(tiny))
            }
        };
        let ends = [start, end].map(|share| [from + along * share, on_sides(share)]);
        let bounds = BoundingBox::around(ends.as_flattened());
        if start <= middle && middle <= end {
            bounds.union(&BoundingBox::around(&[apex]))
        } else {
            bounds
        }
    }

    /// The box around a slice for a tree. It holds the box that kernels of any precision compute.
    pub fn tree_bounds(self, corners: &[Vec3<f64>; 3], index: u8) -> BoundingBox<f64> {
        let bounds = self.bounds(corners, index);
        if self.count == 1 {
            return bounds;
        }
        let farthest = corners.iter().map(|corner| corner.max_abs());
        bounds.widened(farthest.fold(0.0, f64::max) * ROUNDINGS * f64::from(f32::UNIT_ROUNDOFF))
    }

    /// The distance at which rays first enter one of the slices' boxes, enlarged by `margin` on every side; infinity
    /// where they miss all of them. Not inlined, since few rays need it.
    #[inline(never)]
    pub fn entry<L: SimdFloat>(self, corners: &[Vec3<L::Real>; 3], ray: &Ray<L>, margin: L) -> L {
        L::vectorize(
            margin.token(),
            #[inline(always)]
            || {
                let mut nearest = margin.like(L::Real::INFINITY);
                for index in 0..self.count {
                    nearest = nearest.min(self.bounds(corners, index).entry(ray, margin));
                }
                nearest
            },
        )
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn point() -> impl Strategy<Value = Vec3<f64>> {
        prop::array::uniform3(-50.0..50.0_f64).prop_map(Vec3::from)
    }

    fn holds(outer: &BoundingBox<f64>, inner: &BoundingBox<f64>) -> bool {
        outer.union(inner) == *outer
    }

    proptest! {
        #[test]
        fn every_point_of_a_triangle_is_in_the_box_of_a_slice_also_in_single_precision(
            corners in prop::array::uniform3(point()), width in 0.0..1.0_f64, count in 2..=MAX_SLICES,
            weights in prop::collection::vec((0.0..1.0_f64, 0.0..1.0_f64), 20),
        ) {
            let [a, b, c] = corners;
            // Mostly long and narrow.
            let corners = [a, b, a + (c - a) * width.powi(4)];
            let slicing = Slicing::of(&corners).with_count(count);
            let boxes: Vec<_> = (0..count).map(|index| slicing.tree_bounds(&corners, index)).collect();
            let rounded = corners.map(|corner| corner.map(|part| f64::from(part as f32)));
            for [a, b, c] in [corners, rounded] {
                let inner = weights.iter().map(|&(u, v)| {
                    let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
                    a + (b - a) * u + (c - a) * v
                });
                for point in inner.chain([a, b, c]) {
                    let point = BoundingBox::around(&[point]);
                    prop_assert!(boxes.iter().any(|bounds| holds(bounds, &point)), "{point:?} {boxes:?}");
                }
            }
        }

        #[test]
        fn boxes_in_a_tree_hold_those_of_kernels_whichever_way_the_triangle_is_wound(
            (a, along, up) in (point(), point(), point()), width in 0.0..0.03_f64,
        ) {
            let [a, b, c] = [a, a + along, a + along * 0.3 + up * width];
            let original = Slicing::of(&[a, b, c]);
            // Trees round the box of a whole triangle outwards.
            prop_assume!(original.count() > 1);
            for (slicing, corners) in [(original, [a, b, c]), (original.flipped(), [a, c, b])] {
                let single = corners.map(Vec3::in_precision::<f32>);
                for index in 0..slicing.count() {
                    let tree = slicing.tree_bounds(&corners, index);
                    prop_assert_eq!(tree, original.tree_bounds(&[a, b, c], index));
                    let kernel = slicing.bounds(&single, index).in_precision();
                    prop_assert!(holds(&tree, &kernel), "{index} of {slicing:?}: {tree:?} {kernel:?}");
                }
            }
        }
    }
}
