//! The triangle as the kernels meet it, and how triangles hang together.

use std::collections::HashMap;

use glam::DVec3;

use crate::mesh::place_key;
use crate::primitive::kind::Corner;
use crate::scene::{Scene, Shape, Triangle};
use crate::simd::{Real, Vec3};

/// What a face of a solid may be left out of, where the others hide and shade the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Culling {
    /// Nothing.
    Nothing,
    /// What casts shadows from lights that it is turned to.
    Lit,
    /// What is seen by eyes, and casts shadows from lights, that it is turned away from.
    Far,
}

/// Where a triangle may slip between samples, however large it is: most of a mesh go on behind their corners.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tip {
    /// Nowhere.
    Nowhere,
    /// Wherever it is narrow itself.
    Narrow,
    /// Around this corner, which many faces share: what they surround is so many 64ths as wide as it is far from there.
    Round(Vertex, u8),
}

impl Tip {
    /// [`Self::Round`] for something so many times as wide as it is far from the corner.
    pub fn round(which: Vertex, share: f64) -> Self {
        // One that is nothing would be thin all along.
        let share = (share * WHOLE).ceil().clamp(1.0, f64::from(u8::MAX));
        Self::Round(which, share as u8)
    }
}

/// What is as wide as it is far from its tip.
pub const WHOLE: f64 = 64.0;

/// One of the corners of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Vertex {
    /// The first one.
    A,
    /// The second one.
    B,
    /// The third one.
    C,
}

impl Vertex {
    /// All, in order.
    pub const ALL: [Self; 3] = [Self::A, Self::B, Self::C];
}

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
    /// Where it may slip between samples.
    pub tip: Tip,
    /// What it may be left out of.
    pub culling: Culling,
    /// The length of its longest edge.
    pub longest: R,
    /// Index of its material.
    pub material: u32,
}

impl<R: Real> PackedTriangle<R> {
    /// A face of a mesh, as thick as it is by itself; `None` without an area.
    pub fn of_mesh(corners: [DVec3; 3]) -> Option<Self> {
        let [a, b, c] = corners;
        let normal = (c - a).cross(b - a).try_normalize()?;
        let triangle = Triangle { a, b, c };
        Some(Self {
            corners: corners.map(Vec3::from_dvec3),
            normal: Vec3::from_dvec3(normal),
            in_mesh: true,
            thickness: R::from_f64(triangle.thickness()),
            tip: Tip::Nowhere,
            culling: Culling::Lit,
            longest: R::from_f64(triangle.longest_side()),
            material: 0,
        })
    }

    /// The same, rounded to another precision.
    pub fn in_precision<S: Real>(&self) -> PackedTriangle<S> {
        PackedTriangle {
            corners: self.corners.map(Vec3::in_precision),
            normal: self.normal.in_precision(),
            in_mesh: self.in_mesh,
            thickness: S::from_f64(self.thickness.to_f64()),
            tip: self.tip,
            culling: self.culling,
            longest: S::from_f64(self.longest.to_f64()),
            material: self.material,
        }
    }

    /// Turns its outside in.
    pub fn turn(&mut self) {
        self.corners.swap(1, 2);
        self.normal = -self.normal;
        self.tip = match self.tip {
            Tip::Round(Vertex::B, share) => Tip::Round(Vertex::C, share),
            Tip::Round(Vertex::C, share) => Tip::Round(Vertex::B, share),
            tip => tip,
        };
    }
}

/// A corner as a key: corners are one where their coordinates are equal.
pub fn corner(point: DVec3) -> Corner {
    place_key(point)
}

/// Numbers for the corners of triangles: the same where they meet, which is where single precision could not tell
/// the farthest of them apart. Double precision does not see seams that are noise in the last digits either.
pub fn number_corners<R: Real>(triangles: &[PackedTriangle<R>]) -> Vec<[u32; 3]> {
    let all = triangles.iter().flat_map(|triangle| triangle.corners);
    let farthest = all.map(|corner| corner.to_dvec3().abs().max_element());
    let step =
        (farthest.fold(0.0, f64::max) * 2.0 * f64::from(f32::UNIT_ROUNDOFF)).max(f64::MIN_POSITIVE);
    let mut numbers = HashMap::new();
    let mut number = |place: Vec3<R>| {
        let next = numbers.len() as u32;
        let place = (place.to_dvec3() / step).round();
        *numbers.entry(corner(place)).or_insert(next)
    };
    let corners = triangles.iter().map(|triangle| triangle.corners);
    corners.map(|corners| corners.map(&mut number)).collect()
}

/// How many visible triangles meet at each corner.
pub fn count_corner_users(scene: &Scene) -> HashMap<Corner, usize> {
    let mut users = HashMap::new();
    for object in scene.visible_objects() {
        if let Shape::Triangle(triangle) = &object.shape {
            for point in triangle.corners() {
                *users.entry(corner(point)).or_insert(0) += 1;
            }
        }
    }
    users
}
