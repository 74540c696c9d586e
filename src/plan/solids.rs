//! Closed convex solids made of triangles: seen from outside, the faces that are turned away are hidden by others
//! and need no test.

use std::collections::{HashMap, HashSet};

use glam::DVec3;

use super::components::{components_at_corners, numbering};
use crate::mesh::{are_closed, position_key};
use crate::primitive::{Corner, PackedTriangle};
use crate::scene::{Scene, Shape};
use crate::simd::{Real, Vec3};

/// Maximum number of faces of a solid, whose corners are all compared with each face.
const MAX_FACES: usize = 256;
/// Distance by which a point must be in front of or behind a face to count as such, as a share of the solid's size:
/// more than single precision can shift a ray.
const MARGIN: f64 = 1e-5;
/// Share of that distance by which a corner may be in front of a face of a convex solid: for its own rounding.
const CONVEX_SHARE: f64 = 1e-3;

/// Triangles that are clockwise seen from outside, and the solids that they form.
#[derive(Clone, Debug, Default)]
pub struct Solids {
    triangles: Vec<[DVec3; 3]>,
    /// For each solid, the indices of its faces in `triangles`.
    solids: Vec<Vec<usize>>,
}

impl Solids {
    /// Finds the closed convex solids among the triangles.
    pub fn among<R: Real>(triangles: &[PackedTriangle<R>]) -> Self {
        let corners = triangles.iter().map(|t| t.corners.map(Vec3::to_dvec3));
        Self::made_of(corners.collect())
    }

    fn made_of(triangles: Vec<[DVec3; 3]>) -> Self {
        let mut solids = connected(&triangles);
        solids.retain(|faces| {
            faces.len() <= MAX_FACES
                && are_closed(faces.iter().map(|&face| triangles[face]))
                && is_convex(&triangles, faces)
        });
        Self { triangles, solids }
    }

    /// Returns for each triangle whether rays that start or end at `point` can skip it: it belongs to a solid, the
    /// point is outside, and such a ray also hits a face that is turned towards the point.
    pub fn turned_away(&self, point: DVec3) -> Vec<bool> {
        let mut is_away = vec![false; self.triangles.len()];
        for faces in &self.solids {
            let heights = faces.iter().map(|&face| {
                let plane = FacePlane::of(&self.triangles[face]);
                let height = plane.height(point);
                (face, height, plane.margin + MARGIN * height.abs())
            });
            if heights.clone().any(|(_, height, margin)| height > margin) {
                for (face, height, margin) in heights {
                    is_away[face] = height < -margin;
                }
            }
        }
        is_away
    }
}

/// The corners of the visible triangles of a scene.
pub fn visible_triangles(scene: &Scene) -> impl Iterator<Item = [DVec3; 3]> {
    let visible = scene.visible_objects();
    visible.filter_map(|object| match &object.shape {
        Shape::Triangle(triangle) => Some(triangle.corners()),
        _ => None,
    })
}

/// Counts the visible triangles that meet at each corner.
pub fn count_corner_users(scene: &Scene) -> HashMap<Corner, usize> {
    let mut users = HashMap::new();
    for point in visible_triangles(scene).flatten() {
        *users.entry(position_key(point)).or_insert(0) += 1;
    }
    users
}

/// The corners of the faces of all solids formed by visible triangles of a scene.
pub fn faces_of_solids(scene: &Scene) -> HashSet<[Corner; 3]> {
    let Solids { triangles, solids } = Solids::made_of(visible_triangles(scene).collect());
    let faces = solids.into_iter().flatten();
    faces
        .map(|face| triangles[face].map(position_key))
        .collect()
}

/// The plane of a face.
struct FacePlane {
    /// The unit normal outwards; zero, or hardly longer, for a face without an area.
    normal: DVec3,
    /// Distance from the origin along the normal.
    offset: f64,
    /// Height up to which a point counts as on the face.
    margin: f64,
}

impl FacePlane {
    fn of([a, b, c]: &[DVec3; 3]) -> Self {
        let across = (*c - *a).cross(*b - *a);
        let normal = across.try_normalize().unwrap_or(across);
        let size = (*b - *a).length() + (*c - *a).length() + a.abs().max_element();
        Self {
            normal,
            offset: normal.dot(*a),
            margin: MARGIN * size,
        }
    }

    /// Height of a point in front of the face; negative behind it.
    fn height(&self, point: DVec3) -> f64 {
        self.normal.dot(point) - self.offset
    }
}

/// Groups triangles that are connected by common corners.
fn connected(triangles: &[[DVec3; 3]]) -> Vec<Vec<usize>> {
    let mut number = numbering();
    let mut number = |corner: DVec3| number(position_key(corner));
    let faces = triangles.iter().map(|corners| corners.map(&mut number));
    let faces: Vec<_> = faces.collect();
    let mut found: Vec<Vec<usize>> = Vec::new();
    for (index, component) in components_at_corners(&faces).into_iter().enumerate() {
        // Components are numbered in order of their first triangle.
        found.resize_with(found.len().max(component as usize + 1), Vec::new);
        found[component as usize].push(index);
    }
    found
}

/// Returns whether every corner is on or behind every face.
fn is_convex(triangles: &[[DVec3; 3]], faces: &[usize]) -> bool {
    faces.iter().all(|&face| {
        let plane = FacePlane::of(&triangles[face]);
        let mut corners = faces.iter().flat_map(|&other| triangles[other]);
        plane.normal != DVec3::ZERO
            && corners.all(|point| plane.height(point) <= plane.margin * CONVEX_SHARE)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The demo's pyramid.
    fn pyramid() -> Vec<[DVec3; 3]> {
        visible_triangles(&Scene::demo()).collect()
    }

    fn away(triangles: Vec<[DVec3; 3]>, point: DVec3) -> usize {
        let away = Solids::made_of(triangles).turned_away(point);
        away.into_iter().filter(|away| *away).count()
    }

    #[test]
    fn from_outside_the_far_faces_are_left_out() {
        assert_eq!(away(pyramid(), DVec3::new(200.0, 20.0, 1000.0)), 5);
        assert_eq!(away(pyramid(), DVec3::new(200.0, 1000.0, -100.0)), 2);
        assert_eq!(
            away(pyramid(), DVec3::new(200.0, 20.0, -100.0)),
            0,
            "inside"
        );
    }

    #[test]
    fn what_is_open_inside_out_or_dented_is_no_solid() {
        let outside = DVec3::new(200.0, 20.0, 1000.0);
        for missing in 0..6 {
            let mut open = pyramid();
            open.remove(missing);
            assert_eq!(away(open, outside), 0);
        }
        let turned = pyramid().into_iter().map(|[a, b, c]| [a, c, b]);
        assert_eq!(away(turned.collect(), outside), 0);
        let apex = DVec3::new(200.0, 55.0, -100.0);
        let low = DVec3::new(200.0, -5.0, -100.0);
        let dented = pyramid().into_iter();
        let dented = dented.map(|corners| corners.map(|p| if p == apex { low } else { p }));
        assert_eq!(away(dented.collect(), outside), 0);
        let mut doubled = pyramid();
        doubled.extend(pyramid());
        assert_eq!(away(doubled, outside), 0);
    }
}
