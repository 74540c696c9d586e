//! The triangle in the form that kernels use.

use glam::DVec3;

use super::slicing::Slicing;
use super::vertex::Vertex;
use crate::scene::Triangle;
use crate::simd::{Real, Vec3};

/// How a face of a solid may be left out, since others hide and shade the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Culling {
    /// In no way.
    Nothing,
    /// As an occluder of lights that it is turned towards.
    Lit,
    /// For eyes, and as an occluder of lights, that it is turned away from.
    Far,
}

/// Where a triangle may slip between samples, whatever its size: in a mesh, most triangles continue beyond their
/// corners.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tip {
    /// Nowhere.
    Nowhere,
    /// Wherever the triangle itself is narrow.
    Narrow,
    /// Around this corner of many faces: the width of what they enclose is this many 64ths of the distance from the
    /// corner.
    Round(Vertex, u8),
}

impl Tip {
    /// [`Self::Round`] for something whose width is `share` times the distance from the corner.
    pub fn round(corner: Vertex, share: f64) -> Self {
        // With zero, it would be thin everywhere.
        let share = (share * SHARES_PER_UNIT)
            .ceil()
            .clamp(1.0, f64::from(u8::MAX));
        Self::Round(corner, share as u8)
    }
}

/// The share of a tip whose width equals the distance from it.
pub const SHARES_PER_UNIT: f64 = 64.0;

/// A flat triangle.
#[derive(Clone, Copy, Debug)]
pub struct PackedTriangle<R> {
    /// The corners.
    pub corners: [Vec3<R>; 3],
    /// Unit normal, outwards for corners that are clockwise seen from outside.
    pub normal: Vec3<R>,
    /// Whether it shares a corner with another triangle. At the seam, its neighbours then shadow it unless
    /// secondary rays start a few roundings above the surface.
    pub in_mesh: bool,
    /// Its smallest altitude, or the thickness of the mesh there if that is known and greater.
    pub thickness: R,
    /// How much wider the mesh is there for somebody who looks straight at the triangle: a plate is wide from above,
    /// however thin it is.
    pub wider: R,
    /// Where it may slip between samples.
    pub tip: Tip,
    /// How it may be left out.
    pub culling: Culling,
    /// The slices of it that have boxes of their own in the tree of its mesh.
    pub slicing: Slicing,
    /// The length of its longest edge.
    pub longest: R,
    /// Index of its material.
    pub material: u32,
}

impl<R: Real> PackedTriangle<R> {
    /// A face of a mesh with the thickness of the triangle by itself; `None` without an area.
    pub fn of_mesh(corners: [DVec3; 3]) -> Option<Self> {
        let [a, b, c] = corners;
        let normal = (c - a).cross(b - a).try_normalize()?;
        let triangle = Triangle { a, b, c };
        Some(Self {
            corners: corners.map(Vec3::from_dvec3),
            normal: Vec3::from_dvec3(normal),
            in_mesh: true,
            thickness: R::from_f64(triangle.thickness()),
            wider: R::ZERO,
            tip: Tip::Nowhere,
            culling: Culling::Lit,
            slicing: Slicing::WHOLE,
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
            wider: S::from_f64(self.wider.to_f64()),
            tip: self.tip,
            culling: self.culling,
            slicing: self.slicing,
            longest: S::from_f64(self.longest.to_f64()),
            material: self.material,
        }
    }

    /// Turns it inside out.
    pub fn flip(&mut self) {
        self.corners.swap(1, 2);
        self.normal = -self.normal;
        self.slicing = self.slicing.flipped();
        if let Tip::Round(corner, _) = &mut self.tip {
            *corner = corner.flipped();
        }
    }
}
