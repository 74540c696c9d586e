//! Connected components of triangle meshes, and their orientation: triangles are wound clockwise or
//! counter-clockwise, and components may differ.

use std::collections::HashMap;
use std::hash::Hash;

use glam::DVec3;

use crate::mesh::position_key;
use crate::primitive::PackedTriangle;
use crate::simd::{Real as _, Vec3};

/// Six times the volume that an open sheet may enclose through rounding alone, relative to twice its area to the
/// power of 1.5.
const MAX_OPEN_VOLUME: f64 = 1e-6;
/// Number of connected triangles from which they count as one component; with fewer, the edges between them are visible
/// as such.
const LARGE_COMPONENT: u32 = 64;

/// Returns six times the volume that the triangles enclose; negative if their normals point inwards.
pub fn six_volumes(triangles: &[PackedTriangle<f64>]) -> f64 {
    triangles
        .iter()
        .map(|triangle| six_tetrahedra(DVec3::ZERO, corners(triangle)))
        .sum()
}

/// Returns the component of each face, given the corner numbers of the faces; faces that share a corner are
/// connected. Components are numbered from 0.
pub fn components_at_corners(points: &[[u32; 3]]) -> Vec<u32> {
    let mut sets = UnionFind::new(count_corners(points));
    for &[a, b, c] in points {
        sets.join(a, b);
        sets.join(b, c);
    }
    let first_points = points.iter().map(|face| sets.root(face[0]));
    first_points.map(numbering()).collect()
}

/// The number of corners of faces with these corner numbers.
pub fn count_corners(points: &[[u32; 3]]) -> u32 {
    points.iter().flatten().max().map_or(0, |&last| last + 1)
}

/// Returns the component of each of `count` faces, given pairs of faces that share an edge: faces that touch only
/// at a corner are in different components.
pub fn components_along_edges(count: usize, pairs: impl Iterator<Item = [u32; 2]>) -> Vec<u32> {
    let mut sets = UnionFind::new(count as u32);
    for [one, other] in pairs {
        sets.join(one, other);
    }
    let first_faces = (0..count as u32).map(|face| sets.root(face));
    first_faces.map(numbering()).collect()
}

/// Numbers the corners of triangles, with the same number where triangles meet: where single precision could not
/// distinguish points at the largest coordinate. In double precision, too, this ignores gaps that are only noise in
/// the last digits.
pub fn number_corners(triangles: &[PackedTriangle<f64>]) -> Vec<[u32; 3]> {
    let all = triangles.iter().flat_map(corners);
    let farthest = all.map(|corner| corner.abs().max_element());
    let step =
        (farthest.fold(0.0, f64::max) * 2.0 * f64::from(f32::UNIT_ROUNDOFF)).max(f64::MIN_POSITIVE);
    let mut number = numbering();
    let mut number = |corner: DVec3| number(position_key((corner / step).round()));
    let faces = triangles.iter().map(corners);
    faces.map(|corners| corners.map(&mut number)).collect()
}

/// A function that numbers distinct values from 0, in the order of their first occurrence.
pub fn numbering<K: Eq + Hash>() -> impl FnMut(K) -> u32 {
    let mut numbers = HashMap::new();
    move |value| {
        let next = numbers.len() as u32;
        *numbers.entry(value).or_insert(next)
    }
}

/// Returns the first face of each face's component; empty if there is at most one component.
pub fn first_of_components(components: &[u32]) -> Vec<u32> {
    match &component_firsts(components)[..] {
        [] | [_] => Vec::new(),
        firsts => components
            .iter()
            .map(|&component| firsts[component as usize].0)
            .collect(),
    }
}

/// The first face of each component, and the number of its faces.
fn component_firsts(components: &[u32]) -> Vec<(u32, u32)> {
    let mut firsts = Vec::new();
    for (face, &component) in (0..).zip(components) {
        if component as usize == firsts.len() {
            firsts.push((face, 0));
        }
        firsts[component as usize].1 += 1;
    }
    firsts
}

/// Returns for each triangle whether its component faces inwards. The volume of an open component is measured from
/// the mean of its corners, since a tube without ends has an inside, too.
pub fn inside_out(triangles: &[PackedTriangle<f64>], components: &[u32]) -> Vec<bool> {
    let count = components.iter().max().map_or(0, |&last| last as usize + 1);
    let mut sums = vec![(DVec3::ZERO, 0.0); count];
    for (triangle, &component) in triangles.iter().zip(components) {
        let (sum, count) = &mut sums[component as usize];
        *sum += corners(triangle).into_iter().sum::<DVec3>();
        *count += 3.0;
    }
    let mut sizes = vec![(0.0, 0.0); count];
    for (triangle, &component) in triangles.iter().zip(components) {
        let (sum, count) = sums[component as usize];
        let [a, b, c] = corners(triangle);
        let (six_volumes, two_areas) = &mut sizes[component as usize];
        *six_volumes += six_tetrahedra(sum / count, [a, b, c]);
        *two_areas += (b - a).cross(c - a).length();
    }
    let is_inside_out = |&component: &u32| {
        let (six_volumes, two_areas) = sizes[component as usize];
        six_volumes < -MAX_OPEN_VOLUME * two_areas.powf(1.5)
    };
    components.iter().map(is_inside_out).collect()
}

/// Returns for each triangle the first triangle of its component, if that has many triangles, as meshes have. Empty if
/// there is no such component.
pub fn large_components(components: &[u32]) -> Vec<Option<u32>> {
    let found = component_firsts(components);
    if found.iter().all(|&(_, count)| count < LARGE_COMPONENT) {
        return Vec::new();
    }
    let first_face = |&component: &u32| match found[component as usize] {
        (first, LARGE_COMPONENT..) => Some(first),
        _ => None,
    };
    components.iter().map(first_face).collect()
}

fn corners(triangle: &PackedTriangle<f64>) -> [DVec3; 3] {
    triangle.corners.map(Vec3::to_dvec3)
}

/// Six times the volume of a tetrahedron, given by its apex and its base, which is clockwise seen from outside.
fn six_tetrahedra(apex: DVec3, base: [DVec3; 3]) -> f64 {
    let [a, b, c] = base.map(|corner| corner - apex);
    a.dot(c.cross(b))
}

/// A union-find forest: each element points to an earlier one of its set, the first one to itself (Tarjan,
/// "Efficiency of a good but not linear set union algorithm", J. ACM 22, 1975).
struct UnionFind(Vec<u32>);

impl UnionFind {
    fn new(count: u32) -> Self {
        Self((0..count).collect())
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b) as usize] = a.min(b);
    }

    /// The first element of the set that contains `point`.
    fn root(&mut self, mut point: u32) -> u32 {
        while self.0[point as usize] != point {
            let grandparent = self.0[self.0[point as usize] as usize];
            self.0[point as usize] = grandparent;
            point = grandparent;
        }
        point
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::icosphere;

    /// A ball of triangles with its middle at `x` on the x axis.
    fn ball(x: f64) -> Vec<PackedTriangle<f64>> {
        let ball = icosphere(1.0);
        let moved = |corners: [DVec3; 3]| corners.map(|corner| corner + DVec3::X * x);
        let corners = ball.corners().map(moved);
        corners.filter_map(PackedTriangle::of_mesh).collect()
    }

    #[test]
    fn orientation_is_found_per_component_and_a_sheet_has_none() {
        let (mut triangles, turned) = (ball(0.0), ball(10.0));
        let each = triangles.len();
        triangles.extend(turned);
        triangles[each..].iter_mut().for_each(PackedTriangle::flip);
        let sheet = [DVec3::ZERO, DVec3::X, DVec3::Y].map(|corner| corner + DVec3::Z * 7.0);
        triangles.extend(PackedTriangle::of_mesh(sheet));
        // A tube without ends: the part of a ball near its equator.
        let mut tube = ball(20.0);
        tube.retain(|face| face.corners.iter().all(|corner| corner.y.abs() < 0.9));
        tube.iter_mut().for_each(PackedTriangle::flip);
        triangles.extend(tube);
        let components = components_at_corners(&number_corners(&triangles));
        let inside_out = inside_out(&triangles, &components);
        let (outwards, others) = inside_out.split_at(each);
        let (inwards, others) = others.split_at(each);
        assert!(outwards.iter().all(|is_out| !is_out));
        assert!(inwards.iter().all(|is_out| *is_out));
        assert!(!others[0], "a sheet");
        assert!(others.len() > 1 && others[1..].iter().all(|is_out| *is_out));
    }

    #[test]
    fn only_large_components_count_as_one() {
        let many = LARGE_COMPONENT as usize;
        let components = [vec![0; many], vec![1; many - 1], vec![2; many]].concat();
        let things = large_components(&components);
        assert!(things[..many].iter().all(|thing| *thing == Some(0)));
        assert!(things[many..2 * many - 1].iter().all(Option::is_none));
        let last = Some(2 * LARGE_COMPONENT - 1);
        assert!(things[2 * many - 1..].iter().all(|thing| *thing == last));
        assert!(super::large_components(&vec![0; many - 1]).is_empty());
    }

    #[test]
    fn faces_hang_together_along_edges() {
        // Faces 0, 2 and 3 are connected in a row, the other two are single.
        let components = components_along_edges(5, [[3, 2], [0, 3]].into_iter());
        assert_eq!(components, [0, 1, 0, 0, 2]);
        assert_eq!(first_of_components(&components), [0, 1, 0, 0, 4]);
        assert!(first_of_components(&[0; 5]).is_empty());
        // Faces that touch only at a corner are connected only if corners count.
        let touching = [[0, 1, 2], [2, 3, 4]];
        assert_eq!(super::components_at_corners(&touching), [0, 0]);
    }
}
