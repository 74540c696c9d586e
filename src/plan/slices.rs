//! Slices of long narrow triangles, each with a box of its own in a tree. The box around all of such a triangle is
//! mostly empty unless it lies along an axis, and in a round cone or cylinder the boxes of all faces overlap. Ernst and
//! Greiner, "Early split clipping for bounding volume hierarchies", IEEE Symposium on Interactive Ray Tracing 2007.

use crate::primitive::BoundingBox;
use crate::simd::{Real as _, Vec3};

/// Number of faces from which on a mesh is sliced. The boxes of fewer faces are tested quickly: rods of 20 faces would
/// take 1.4 times as long, a trunk of 48 among leaves 1.1 times.
const MIN_FACES: usize = 64;
/// Length of a slice, in heights of the triangle over its longest edge: shorter slices make more boxes than they empty.
const SLICE_LENGTH: f64 = 6.0;
/// Maximum number of slices of a triangle.
const MAX_SLICES: u8 = 32;
/// Maximum number of slices of a mesh beyond one for each of its faces. They take 60 bytes each in the tree.
const MAX_MORE_SLICES: usize = 1 << 18;

/// One of several slices of equal length into which a triangle is cut across one of its edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slice {
    /// The corner at which that edge begins, which goes on to the next corner.
    edge: u8,
    /// The number of this slice, counted along the edge from 0.
    index: u8,
    /// The number of slices.
    count: u8,
}

impl Slice {
    /// All of a triangle, or of anything else.
    pub const WHOLE: Self = Self {
        edge: 0,
        index: 0,
        count: 1,
    };

    /// The box around this slice of a triangle. It holds the slice also after the corners are rounded to single
    /// precision.
    pub fn bounds(self, corners: &[Vec3<f64>; 3]) -> BoundingBox<f64> {
        if self.count == 1 {
            return BoundingBox::around(corners);
        }
        let [from, to, apex] = [0, 1, 2].map(|step| corners[(usize::from(self.edge) + step) % 3]);
        let along = to - from;
        // The apex is above the edge, since that is the longest.
        let middle = ((apex - from).dot(along) / along.dot(along)).clamp(0.0, 1.0);
        let share = |index: u8| f64::from(index) / f64::from(self.count);
        let (start, end) = (share(self.index), share(self.index + 1));
        let on_sides = |share: f64| {
            if share < middle {
                from + (apex - from) * (share / middle)
            } else {
                apex + (to - apex) * ((share - middle) / (1.0 - middle).max(f64::MIN_POSITIVE))
            }
        };
        let ends = [start, end].map(|share| [from + along * share, on_sides(share)]);
        let mut bounds = BoundingBox::around(ends.as_flattened());
        if (start..=end).contains(&middle) {
            bounds = bounds.union(&BoundingBox::around(&[apex]));
        }
        let farthest = corners.iter().map(|corner| corner.max_abs());
        bounds.widened(farthest.fold(0.0, f64::max) * 4.0 * f64::from(f32::UNIT_ROUNDOFF))
    }
}

/// The slices into which the faces of a mesh are cut, with the numbers of these faces; empty if none is cut.
pub fn slices_of(count: usize, corners: impl Fn(usize) -> [Vec3<f64>; 3]) -> Vec<(u32, Slice)> {
    if count < MIN_FACES {
        return Vec::new();
    }
    let wanted: Vec<(u8, u8)> = (0..count)
        .map(|face| wanted_slices(&corners(face)))
        .collect();
    let more: usize = wanted
        .iter()
        .map(|&(_, wanted)| usize::from(wanted - 1))
        .sum();
    if more == 0 {
        return Vec::new();
    }
    let share = (MAX_MORE_SLICES as f64 / more as f64).min(1.0);
    // What is left of a face's share goes to the next one.
    let mut rest = 0.0;
    let mut slices = Vec::with_capacity(count + more.min(MAX_MORE_SLICES));
    for (face, (edge, wanted)) in (0..).zip(wanted) {
        rest += f64::from(wanted - 1) * share;
        let count = 1 + (rest as u8).min(wanted - 1);
        rest -= f64::from(count - 1);
        if count == 1 {
            slices.push((face, Slice::WHOLE));
        } else {
            slices.extend((0..count).map(|index| (face, Slice { edge, index, count })));
        }
    }
    slices
}

/// The longest edge of a triangle, and the number of slices into which it is to be cut. They do not depend on where
/// and how it lies, except for rounding.
fn wanted_slices(corners: &[Vec3<f64>; 3]) -> (u8, u8) {
    let edges = [0, 1, 2].map(|edge| corners[(edge + 1) % 3] - corners[edge]);
    let squares = edges.map(|edge| edge.dot(edge));
    let longest = (0..3).fold(0, |longest, edge| {
        if squares[longest] < squares[edge] {
            edge
        } else {
            longest
        }
    });
    let double_area = edges[0].cross(edges[1]).length();
    // NaN becomes 0.
    let wanted = (squares[longest] / (double_area * SLICE_LENGTH)) as usize;
    (
        longest as u8,
        wanted.clamp(1, usize::from(MAX_SLICES)) as u8,
    )
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::bvh::{Bvh, Member};
    use super::*;

    fn point() -> impl Strategy<Value = Vec3<f64>> {
        prop::array::uniform3(-50.0..50.0_f64).prop_map(Vec3::from)
    }

    fn holds(bounds: &BoundingBox<f64>, point: Vec3<f64>) -> bool {
        bounds.union(&BoundingBox::around(&[point])) == *bounds
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
            let (edge, _) = wanted_slices(&corners);
            let slices = (0..count).map(|index| Slice { edge, index, count });
            let boxes: Vec<_> = slices.map(|slice| slice.bounds(&corners)).collect();
            let rounded = corners.map(|corner| corner.map(|part| f64::from(part as f32)));
            for [a, b, c] in [corners, rounded] {
                let inner = weights.iter().map(|&(u, v)| {
                    let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
                    a + (b - a) * u + (c - a) * v
                });
                for point in inner.chain([a, b, c]) {
                    prop_assert!(boxes.iter().any(|bounds| holds(bounds, point)), "{point:?} {boxes:?}");
                }
            }
        }
    }

    /// The faces of a cone with its point at the origin.
    fn cone(sides: usize) -> Vec<[Vec3<f64>; 3]> {
        let rim = |side: usize| {
            let angle = side as f64 / sides as f64 * std::f64::consts::TAU;
            Vec3::new(angle.cos() * 5.0, -8.0, angle.sin() * 5.0)
        };
        let face = |side: usize| [Vec3::splat(0.0), rim(side), rim(side + 1)];
        (0..sides).map(face).collect()
    }

    #[test]
    fn few_boxes_in_a_cone_of_many_sides_hold_a_point_of_it() {
        let faces = cone(1000);
        let slices = slices_of(faces.len(), |face| faces[face]);
        let trees = [&[][..], &slices].map(|slices: &[(u32, Slice)]| {
            let slice = |entry: usize| match slices.get(entry) {
                Some(&(face, slice)) => (face as usize, slice),
                None => (entry, Slice::WHOLE),
            };
            let count = slices.len().max(faces.len());
            Bvh::of_slices((count, slice), |face, slice| Member {
                bounds: slice.bounds(&faces[face]),
                thickness: 1.0,
            })
        });
        let [whole, sliced] = trees.map(|bvh| {
            let held = faces.iter().step_by(10).map(|[a, b, c]| {
                let middle = (*a + *b + *c) * (1.0 / 3.0);
                bvh.members_where(|bounds| holds(bounds, middle)).len()
            });
            held.sum::<usize>()
        });
        assert!(sliced * 10 < whole, "{sliced} of {whole}");
    }

    #[test]
    fn ordinary_faces_and_those_of_a_few_are_not_sliced() {
        let narrow = cone(1000);
        assert!(slices_of(MIN_FACES - 1, |face| narrow[face]).is_empty());
        let wide = cone(20);
        assert!(slices_of(1000, |face| wide[face % 20]).is_empty());
        // A million such faces get no more slices than they may take memory for.
        let many = slices_of(1_000_000, |face| narrow[face % 1000]);
        let more = many.len() - 1_000_000;
        assert!(
            (MAX_MORE_SLICES - 1..=MAX_MORE_SLICES).contains(&more),
            "{more}"
        );
        // A face that is not cut is a whole one among others that are.
        let mixed = slices_of(100, |face| {
            if face == 7 {
                narrow[7]
            } else {
                wide[face % 20]
            }
        });
        let cut = mixed.iter().filter(|(_, slice)| *slice != Slice::WHOLE);
        assert!(mixed.len() > 100 && cut.clone().all(|(face, _)| *face == 7) && cut.count() > 1);
    }
}
