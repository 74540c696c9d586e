//! The triangle as the kernels meet it, and how triangles hang together.

use std::collections::HashMap;

use glam::DVec3;

use crate::primitive::kind::Corner;
use crate::scene::{Scene, Shape};
use crate::simd::Vec3;

/// A flat triangle.
#[derive(Clone, Copy, Debug)]
pub struct PackedTriangle<R> {
    /// The corners.
    pub corners: [Vec3<R>; 3],
    /// Unit normal, outwards for corners that are clockwise seen from outside.
    pub normal: Vec3<R>,
    /// Whether it shares a corner with another triangle. Its neighbours then shadow it at the seam
    /// unless secondary rays start a few roundings off the surface.
    pub in_mesh: bool,
    /// Its smallest altitude.
    pub thickness: R,
    /// Index of its material.
    pub material: u32,
}

/// A corner as a key: corners are one where their coordinates are equal.
pub fn corner(point: DVec3) -> Corner {
    // Adding zero makes one zero of the two.
    point.to_array().map(|part| (part + 0.0).to_bits())
}

/// How many visible triangles meet at each corner.
pub fn count_corner_users(scene: &Scene) -> HashMap<Corner, usize> {
    let mut users = HashMap::new();
    for object in scene.objects.iter().filter(|object| object.visible) {
        if let Shape::Triangle(triangle) = &object.shape {
            for point in triangle.corners() {
                *users.entry(corner(point)).or_insert(0) += 1;
            }
        }
    }
    users
}
