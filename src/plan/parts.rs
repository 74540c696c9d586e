//! What of triangles hangs together, and which way it looks: they are wound clockwise or counter-clockwise, and not
//! all parts alike.

use std::collections::HashMap;

use glam::DVec3;

use crate::primitive::PackedTriangle;
use crate::simd::{Real, Vec3};

/// What a sheet surrounds by rounding alone, in parts of its area to the power of 1.5.
const ROUNDING: f64 = 1e-6;
/// From so many on, triangles that hang together are seen as one thing: fewer have edges that one looks at.
const MANY: u32 = 64;

/// Six times the volume that the triangles surround; negative where they look inwards.
pub fn volume<R: Real>(triangles: &[PackedTriangle<R>]) -> f64 {
    triangles
        .iter()
        .map(|triangle| volume_from(DVec3::ZERO, corners(triangle)))
        .sum()
}

/// For each face, of which these are the numbers of the corners, the part that it is connected with; parts have numbers
/// from 0 on.
pub fn parts(points: &[[u32; 3]]) -> Vec<u32> {
    let mut forest = Forest::new(points);
    let mut numbers = HashMap::new();
    let part = |face: &[u32; 3]| {
        let next = numbers.len() as u32;
        *numbers.entry(forest.first(face[0])).or_insert(next)
    };
    points.iter().map(part).collect()
}

/// For each triangle whether it is of a part that looks inwards. Parts with borders are seen from the mean of their
/// corners: a tube without ends has an inside, too.
pub fn inside_out<R: Real>(triangles: &[PackedTriangle<R>], parts: &[u32]) -> Vec<bool> {
    let count = parts.iter().max().map_or(0, |&last| last as usize + 1);
    let mut sums = vec![(DVec3::ZERO, 0.0); count];
    for (triangle, &part) in triangles.iter().zip(parts) {
        let (sum, count) = &mut sums[part as usize];
        *sum += corners(triangle).into_iter().sum::<DVec3>();
        *count += 3.0;
    }
    let mut volumes = vec![(0.0, 0.0); count];
    for (triangle, &part) in triangles.iter().zip(parts) {
        let (sum, count) = sums[part as usize];
        let [a, b, c] = corners(triangle);
        let (volume, area) = &mut volumes[part as usize];
        *volume += volume_from(sum / count, [a, b, c]);
        *area += (b - a).cross(c - a).length();
    }
    let is_inside_out = |&part: &u32| {
        let (volume, area) = volumes[part as usize];
        volume < -ROUNDING * area.powf(1.5)
    };
    parts.iter().map(is_inside_out).collect()
}

/// For each triangle the first one that it is one thing with, as the faces of a mesh are: those of a part and a
/// material, if they are many. Empty if that is none.
pub fn things<R: Real>(triangles: &[PackedTriangle<R>], parts: &[u32]) -> Vec<Option<u32>> {
    let mut found = HashMap::new();
    let keys = triangles
        .iter()
        .map(|triangle| triangle.material)
        .zip(parts);
    for (index, key) in (0..).zip(keys.clone()) {
        found.entry(key).or_insert((index, 0)).1 += 1;
    }
    if found.values().all(|&(_, count)| count < MANY) {
        return Vec::new();
    }
    let thing = |key| match found[&key] {
        (first, MANY..) => Some(first),
        _ => None,
    };
    keys.map(thing).collect()
}

fn corners<R: Real>(triangle: &PackedTriangle<R>) -> [DVec3; 3] {
    triangle.corners.map(Vec3::to_dvec3)
}

/// Six times the volume of a tetrahedron, clockwise seen from outside, by its tip and its foot.
fn volume_from(tip: DVec3, foot: [DVec3; 3]) -> f64 {
    let [a, b, c] = foot.map(|corner| corner - tip);
    a.dot(c.cross(b))
}

/// Points that faces connect, as a forest: each names one before it, the first of a part itself
/// (Tarjan, "Efficiency of a good but not linear set union algorithm", J. ACM 22, 1975).
struct Forest(Vec<u32>);

impl Forest {
    fn new(faces: &[[u32; 3]]) -> Self {
        let count = faces.iter().flatten().max().map_or(0, |&last| last + 1);
        let mut forest = Self((0..count).collect());
        for &[a, b, c] in faces {
            forest.join(a, b);
            forest.join(b, c);
        }
        forest
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.first(a), self.first(b));
        self.0[a.max(b) as usize] = a.min(b);
    }

    /// The first point of the part that a point is in.
    fn first(&mut self, mut point: u32) -> u32 {
        while self.0[point as usize] != point {
            let before = self.0[self.0[point as usize] as usize];
            self.0[point as usize] = before;
            point = before;
        }
        point
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::icosphere;
    use crate::primitive::number_corners;

    /// A ball of triangles in a place, of a material.
    fn ball(x: f64, material: u32) -> Vec<PackedTriangle<f64>> {
        let ball = icosphere(1.0);
        let moved = |corners: [DVec3; 3]| corners.map(|corner| corner + DVec3::X * x);
        let faces = ball
            .corners()
            .map(moved)
            .filter_map(PackedTriangle::of_mesh);
        faces
            .map(|face| PackedTriangle { material, ..face })
            .collect()
    }

    #[test]
    fn each_part_looks_its_own_way_and_a_sheet_looks_neither() {
        let (mut triangles, turned) = (ball(0.0, 0), ball(10.0, 0));
        let each = triangles.len();
        triangles.extend(turned);
        triangles[each..].iter_mut().for_each(PackedTriangle::turn);
        let sheet = [DVec3::ZERO, DVec3::X, DVec3::Y].map(|corner| corner + DVec3::Z * 7.0);
        triangles.extend(PackedTriangle::of_mesh(sheet));
        // A tube without ends: what of a ball is near its equator.
        let mut tube = ball(20.0, 0);
        tube.retain(|face| face.corners.iter().all(|corner| corner.y.abs() < 0.9));
        tube.iter_mut().for_each(PackedTriangle::turn);
        triangles.extend(tube);
        let parts = parts(&number_corners(&triangles));
        let inside_out = inside_out(&triangles, &parts);
        let (outwards, others) = inside_out.split_at(each);
        let (inwards, others) = others.split_at(each);
        assert!(outwards.iter().all(|is_out| !is_out));
        assert!(inwards.iter().all(|is_out| *is_out));
        assert!(!others[0], "a sheet");
        assert!(others.len() > 1 && others[1..].iter().all(|is_out| *is_out));
    }

    #[test]
    fn many_triangles_of_a_part_and_a_material_are_one_thing() {
        let mut triangles = ball(0.0, 0);
        let each = triangles.len();
        triangles.extend(ball(10.0, 0));
        triangles[each].material = 1;
        let few = ball(20.0, 0).into_iter().take(MANY as usize - 1);
        triangles.extend(few);
        let parts = parts(&number_corners(&triangles));
        let things = things(&triangles, &parts);
        assert!(things[..each].iter().all(|thing| *thing == Some(0)));
        assert_eq!(things[each], None, "another material");
        let second = Some(each as u32 + 1);
        assert!(
            things[each + 1..2 * each]
                .iter()
                .all(|thing| *thing == second)
        );
        assert!(things[2 * each..].iter().all(Option::is_none));
        assert!(super::things(&triangles[2 * each..], &parts[2 * each..]).is_empty());
    }
}
