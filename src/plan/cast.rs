//! Single rays through the tree of a mesh: the distance to the opposite side, and whether a point is outside.

use std::collections::HashSet;

use super::bvh::{Bvh, Child, GROUP};
use crate::primitive::PackedTriangle;
use crate::simd::{Real, Vec3};

/// Calls `on_hit` once with each triangle that a ray hits and its distance, in any order; it returns the distance up to
/// which the search goes on. Returns whether visiting `max_nodes` nodes was enough to find all hits.
pub fn cast<R: Real>(
    triangles: &[PackedTriangle<R>],
    bvh: &Bvh<R>,
    origin: Vec3<R>,
    direction: Vec3<R>,
    max_nodes: usize,
    mut on_hit: impl FnMut(u32, R) -> R,
) -> bool {
    let inverse = direction.to_array().map(|part| R::ONE / part);
    let mut reach = R::INFINITY;
    let (mut waiting, mut hits) = (vec![0], HashSet::new());
    let mut remaining = max_nodes;
    while let Some(node) = waiting
        .pop()
        .and_then(|index: u32| bvh.nodes.get(index as usize))
    {
        if remaining == 0 {
            return false;
        }
        remaining -= 1;
        let (near, far) = slabs(&node.planes, origin.to_array(), inverse);
        for index in 0..node.count {
            // NaN satisfies no comparison: such a box is entered.
            if near[index] > far[index] || near[index] > reach || far[index] < R::ZERO {
                continue;
            }
            match node.child(index) {
                Child::Node(inner) => waiting.push(inner),
                Child::Member(face) => {
                    let t = intersect(&triangles[face as usize].corners, origin, direction);
                    // Several slices of it may be in boxes that are hit.
                    if t < R::INFINITY && hits.insert(face) {
                        reach = on_hit(face, t);
                    }
                }
            }
        }
    }
    true
}

/// Two arbitrary directions; along none of the axes, so that they rarely hit edges.
const PROBE_DIRECTIONS: [[f64; 3]; 2] = [[0.312, 0.871, 0.379], [-0.523, 0.233, -0.817]];

/// Returns whether a point is outside of a closed mesh whose normals point outwards: a ray from it hits a front
/// face first, and leaves the mesh as often as it enters it. A mesh may have components inside of others.
pub fn is_outside<R: Real>(triangles: &[PackedTriangle<R>], bvh: &Bvh<R>, point: Vec3<R>) -> bool {
    PROBE_DIRECTIONS.iter().all(|probe| {
        let direction = Vec3::from(probe.map(R::from_f64));
        let (mut nearest, mut first, mut winding) = (R::INFINITY, -1, 0);
        let unlimited = usize::MAX;
        cast(triangles, bvh, point, direction, unlimited, |face, t| {
            let is_exit = triangles[face as usize].normal.dot(direction) > R::ZERO;
            let crossing = if is_exit { 1 } else { -1 };
            winding += crossing;
            if t < nearest {
                (nearest, first) = (t, crossing);
            }
            R::INFINITY
        });
        first == -1 && winding == 0
    })
}

/// The distances at which a ray enters and leaves the boxes of a node.
fn slabs<R: Real>(
    planes: &[[[f32; GROUP]; 3]; 2],
    origin: [R; 3],
    inverse: [R; 3],
) -> ([R; GROUP], [R; GROUP]) {
    let (mut near, mut far) = ([R::ZERO; GROUP], [R::INFINITY; GROUP]);
    for axis in 0..3 {
        for index in 0..GROUP {
            let plane = |side: usize| R::from_single(planes[side][axis][index]);
            let low = (plane(0) - origin[axis]) * inverse[axis];
            let high = (plane(1) - origin[axis]) * inverse[axis];
            near[index] = near[index].max(low.min(high));
            far[index] = far[index].min(low.max(high));
        }
    }
    (near, far)
}

/// The distance at which a ray hits a triangle, from either side; infinity if it does not. Möller and Trumbore's
/// formula: a ray that slips through an edge is one of many.
fn intersect<R: Real>([a, b, c]: &[Vec3<R>; 3], origin: Vec3<R>, direction: Vec3<R>) -> R {
    let (ab, ac) = (*b - *a, *c - *a);
    let across = direction.cross(ac);
    let determinant = ab.dot(across);
    let to_origin = origin - *a;
    let u = to_origin.dot(across) / determinant;
    let turned = to_origin.cross(ab);
    let v = direction.dot(turned) / determinant;
    let t = ac.dot(turned) / determinant;
    let is_inside = u >= R::ZERO && v >= R::ZERO && u + v <= R::ONE;
    if is_inside && t > R::ZERO && t < R::INFINITY {
        t
    } else {
        R::INFINITY
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::bvh::Member;

    fn at(x: f64, y: f64, z: f64) -> Vec3<f64> {
        Vec3::new(x, y, z)
    }

    /// A box with this half width around a point on the y axis; clockwise seen from outside, or from inside if
    /// hollow.
    fn solid(half: f64, at_y: f64, is_hollow: bool) -> Vec<[Vec3<f64>; 3]> {
        let corner = |index: usize| {
            let side = |bit: usize| if index >> bit & 1 == 0 { -half } else { half };
            at(side(0), side(1) + at_y, side(2))
        };
        let sides = [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ];
        let faces = sides.iter().flat_map(|side| {
            let [a, b, c, d] = side.map(corner);
            [[a, b, c], [a, c, d]]
        });
        let turn = |[a, b, c]: [Vec3<f64>; 3]| if is_hollow { [a, b, c] } else { [a, c, b] };
        faces.map(turn).collect()
    }

    #[test]
    fn points_in_nested_closed_surfaces_are_inside() {
        let is_seen = |parts: &[Vec<[Vec3<f64>; 3]>], point: Vec3<f64>| {
            let packed =
                |corners: &[Vec3<f64>; 3]| PackedTriangle::of_mesh(corners.map(Vec3::to_dvec3));
            let triangles: Vec<_> = parts.iter().flatten().filter_map(packed).collect();
            let bvh = Bvh::new(triangles.len(), |n| Member::of(&triangles[n]));
            is_outside(&triangles, &bvh, point)
        };
        let room = [solid(10.0, 0.0, false), solid(3.0, 4.0, false)];
        // Below the table, beside it, in it, and far away.
        let points = [at(0.1, -3.0, 0.2), at(8.1, 0.2, 0.1), at(0.1, 4.2, 0.3)];
        for point in points {
            assert!(!is_seen(&room, point), "{point:?}");
        }
        assert!(is_seen(&room, at(1.0, -30.0, 2.0)));
        // The inside of a hollow is outside of the mesh.
        let shell = [solid(10.0, 0.0, false), solid(3.0, 4.0, true)];
        assert!(is_seen(&shell, at(0.1, 4.2, 0.3)) && !is_seen(&shell, at(0.1, -3.0, 0.2)));
    }
}
