//! A mesh, ready to be traced: its triangles relative to its own middle, and the way to them.

use std::any::Any;
use std::ops::Range;
use std::sync::Arc;

use glam::{DMat3, DVec3};
use rayon::iter::{
    IndexedParallelIterator as _, IntoParallelRefIterator as _, ParallelIterator as _,
};

use super::borders::Borders;
use super::bvh::{Bvh, Member};
use super::cast::is_outside;
use super::components::{first_of_parts, volume};
use super::smooth::{corner_normals, largest_lift};
use super::thickness::measures;
use crate::mesh::Triangles;
use crate::primitive::{BoundingBox, CAUTION, CornerNormals, PackedTriangle, Primitive};
use crate::scene::Mesh;
use crate::simd::{Real, Vec3};

/// The triangles of a mesh, turned and scaled as they are in the world and relative to the middle of the
/// box around them: where the mesh is costs no precision, and moving it changes none of this.
#[derive(Clone, Debug)]
pub struct PackedMesh<R> {
    /// Its triangles; those without an area are left out.
    pub triangles: Vec<PackedTriangle<R>>,
    /// Their normals where they are shaded as one curved surface; none if they are flat.
    pub smooth: Vec<CornerNormals<R>>,
    /// Whether some of them look flat.
    pub has_flat: bool,
    /// How far above them rays that go on from there may start.
    pub lift: R,
    /// The length of their longest edge.
    pub longest: R,
    /// The way to them.
    pub bvh: Bvh<R>,
    /// How far they reach from the middle of the box around them.
    pub reach: R,
    /// The corners of each of them in its source; none where they do not stand in the order of the mesh before it was
    /// turned.
    faces: Arc<[[u32; 3]]>,
    /// For each of them the first of those that it hangs together with; none if all do.
    things: Arc<[u32]>,
    /// Whether it has an inside; its normals then point away from there, however its file winds them.
    is_solid: bool,
    /// Whether its file winds them the other way.
    is_inside_out: bool,
    /// The middle, from the origin of the mesh.
    middle: DVec3,
    turn: DMat3,
    /// What it was made of.
    pub key: MeshKey,
    /// Kept, so that nothing else is where it is.
    source: Arc<Triangles>,
}

/// What a packed mesh is made of, wherever that is: where its faces are kept, how they are turned and scaled, and up to
/// which angle they are smooth, bit by bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MeshKey(LevelKey, [u64; 3]);

/// The same, however they are turned.
pub type LevelKey = (usize, [u64; 3], u64);

impl MeshKey {
    /// That of a mesh.
    pub fn of(mesh: &Mesh) -> Self {
        let address = Arc::as_ptr(mesh.source.triangles()).addr();
        let bits = |parts: DVec3| parts.to_array().map(f64::to_bits);
        let level = (address, bits(mesh.scale), mesh.smooth.to_bits());
        Self(level, bits(mesh.rotation))
    }

    /// That of the mesh before it was turned.
    pub fn level(&self) -> LevelKey {
        self.0
    }
}

/// Where the points of a mesh are.
struct Points {
    /// From their middle.
    points: Vec<DVec3>,
    /// That of the box around its corners, from the origin of the mesh.
    middle: DVec3,
}

impl Points {
    fn of(source: &Triangles, turn: DMat3) -> Self {
        let mut points: Vec<DVec3> = source.points().iter().map(|&point| turn * point).collect();
        let named = source.faces().as_flattened().iter();
        let corners = named.map(|&corner| points[corner as usize]);
        let none = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let (low, high) = corners.fold(none, |(low, high), corner| {
            (low.min(corner), high.max(corner))
        });
        let middle = low * 0.5 + high * 0.5;
        for point in &mut points {
            *point -= middle;
        }
        Self { points, middle }
    }
}

/// A mesh in its place.
#[derive(Clone, Debug)]
pub struct MeshInstance<R> {
    /// What is there; several may share it.
    pub mesh: Arc<PackedMesh<R>>,
    /// Where its middle is.
    pub centre: Vec3<R>,
    /// Index of its material.
    pub material: u32,
    /// Its place in the scene's list.
    pub place: usize,
    /// The number of its first triangle, counted from that of the geometry's first primitive.
    pub first: usize,
}

impl PackedMesh<f64> {
    /// Packs a mesh: what it is is decided in double precision, whatever it is traced in; and before it is turned, so that
    /// it stays the same when it is, see [`Self::turned`].
    pub fn new(mesh: &Mesh) -> Self {
        if mesh.rotation == DVec3::ZERO {
            return Self::of(mesh);
        }
        let level = Mesh {
            rotation: DVec3::ZERO,
            ..mesh.clone()
        };
        let turned = Self::of(&level).turned(mesh);
        turned.unwrap_or_else(|| Self {
            // Its faces may stand in another order.
            faces: [].into(),
            ..Self::of(mesh)
        })
    }

    fn of(mesh: &Mesh) -> Self {
        let turn = mesh.turn();
        let Points { points, middle } = Points::of(mesh.source.triangles(), turn);
        let is_mirrored = turn.determinant() < 0.0;
        // Clockwise seen from outside, as it was before.
        let face = |&[a, b, c]: &[u32; 3]| if is_mirrored { [a, c, b] } else { [a, b, c] };
        let corners = |face: [u32; 3]| face.map(|point| points[point as usize]);
        let packed = |face: &[u32; 3]| PackedTriangle::of_mesh(corners(*face));
        let faces = mesh.source.triangles().faces().iter().map(face);
        let faces: Vec<_> = faces.filter(|face| packed(face).is_some()).collect();
        // The tree first: to build it takes more room than anything else.
        let mut bvh = Bvh::new(faces.len(), |number| Member {
            bounds: BoundingBox::around(&corners(faces[number]).map(Vec3::from_dvec3)),
            thickness: f64::INFINITY,
        });
        // What is met together stands together.
        let order = bvh.renumber().into_iter();
        let faces: Vec<_> = order.map(|number| faces[number as usize]).collect();
        let corners_of = |face: u32| corners(faces[face as usize]).map(Vec3::from_dvec3);
        let borders = Borders::of(&faces, corners_of, |_| 0);
        let mut triangles = Vec::with_capacity(faces.len());
        triangles.extend(faces.iter().filter_map(packed));
        drop(points);
        measure(&mut triangles, &faces, &mut bvh, &borders);
        let things = first_of_parts(&borders.connected).into();
        let volume = if borders.is_closed {
            volume(&triangles)
        } else {
            0.0
        };
        if volume < 0.0 {
            triangles.iter_mut().for_each(PackedTriangle::turn);
        }
        let smooth = normals_of(mesh, &triangles);
        Self {
            has_flat: has_flat(&smooth),
            lift: largest_lift(&triangles, &smooth),
            longest: longest(&triangles),
            reach: reach(&triangles, bvh.bounds.ball().0),
            smooth,
            faces: faces.into(),
            things,
            bvh,
            is_solid: volume != 0.0,
            is_inside_out: volume < 0.0,
            triangles,
            middle,
            turn,
            key: MeshKey::of(mesh),
            source: Arc::clone(mesh.source.triangles()),
        }
    }

    /// The same in another precision, or this one itself: what was decided of it stays, and its tree is shared.
    pub fn in_precision<R: Real>(this: &Arc<Self>) -> Arc<PackedMesh<R>> {
        let own: Arc<dyn Any + Send + Sync> = Arc::clone(this) as _;
        own.downcast().unwrap_or_else(|_| Arc::new(this.rounded()))
    }

    fn rounded<R: Real>(&self) -> PackedMesh<R> {
        let triangles = self.triangles.iter().map(PackedTriangle::in_precision);
        let smooth = self.smooth.iter().map(CornerNormals::in_precision);
        self.with(
            (triangles.collect(), smooth.collect()),
            self.bvh.in_precision(),
        )
    }
}

impl<R: Real> PackedMesh<R> {
    /// The same mesh, turned otherwise: what hangs together, how thick it is and what stands beside what need not be found
    /// out again. `None` where that is not known, or rounding leaves a face without an area.
    pub fn turned(&self, mesh: &Mesh) -> Option<PackedMesh<f64>> {
        let turn = mesh.turn();
        let Points { points, middle } = Points::of(&self.source, turn);
        let faces = self.faces.par_iter().zip(&self.triangles);
        let triangles = faces.map(|(face, own)| {
            let corners = face.map(|point| points[point as usize]);
            let mut triangle = PackedTriangle::of_mesh(corners)?;
            if self.is_inside_out {
                triangle.turn();
            }
            triangle.thickness = own.thickness.to_f64();
            triangle.tip = own.tip;
            Some(triangle)
        });
        let triangles: Vec<PackedTriangle<f64>> = triangles.collect::<Option<_>>()?;
        if triangles.len() < self.triangles.len() {
            return None;
        }
        let mut bvh = self.bvh.in_precision();
        bvh.refit(|number| member(&triangles[number]));
        let smooth = normals_of(mesh, &triangles);
        Some(PackedMesh {
            middle,
            turn,
            key: MeshKey::of(mesh),
            ..self.with((triangles, smooth), bvh)
        })
    }

    /// The same mesh, with its triangles elsewhere.
    fn with<S: Real>(
        &self,
        (triangles, smooth): (Vec<PackedTriangle<S>>, Vec<CornerNormals<S>>),
        bvh: Bvh<S>,
    ) -> PackedMesh<S> {
        PackedMesh {
            has_flat: has_flat(&smooth),
            lift: largest_lift(&triangles, &smooth),
            longest: longest(&triangles),
            reach: reach(&triangles, bvh.bounds.ball().0),
            triangles,
            smooth,
            bvh,
            faces: Arc::clone(&self.faces),
            things: Arc::clone(&self.things),
            is_solid: self.is_solid,
            is_inside_out: self.is_inside_out,
            middle: self.middle,
            turn: self.turn,
            key: self.key,
            source: Arc::clone(&self.source),
        }
    }

    /// The first of its faces that one of this number hangs together with.
    pub fn thing_of(&self, face: usize) -> usize {
        self.things.get(face).map_or(0, |&first| first as usize)
    }

    /// Where a point of its source is, from its middle: exactly where corners of its triangles are.
    pub fn place(&self, point: DVec3) -> Vec3<R> {
        Vec3::from_dvec3(self.turn * point - self.middle)
    }

    /// Where its middle is in the world, if it is that of `mesh`.
    pub fn middle_of(&self, mesh: &Mesh) -> DVec3 {
        mesh.position + self.middle
    }
}

/// Sets how thick each of the triangles is, whose corners have these numbers, that are in this tree and have these
/// borders, and how thick is what is in its boxes.
pub fn measure(
    triangles: &mut [PackedTriangle<f64>],
    faces: &[[u32; 3]],
    bvh: &mut Bvh<f64>,
    borders: &Borders,
) {
    let measures = measures(triangles, faces, bvh, borders);
    let measured = measures.thicknesses.iter().zip(&measures.tips);
    for (triangle, (&thickness, &tip)) in triangles.iter_mut().zip(measured) {
        triangle.thickness = triangle.thickness.max(thickness);
        triangle.tip = tip;
    }
    bvh.refit(|number| member(&triangles[number]));
}

/// The normals of faces that are shaded as one curved surface.
fn normals_of(mesh: &Mesh, triangles: &[PackedTriangle<f64>]) -> Vec<CornerNormals<f64>> {
    if mesh.smooth > 0.0 {
        corner_normals(triangles, mesh.smooth)
    } else {
        Vec::new()
    }
}

/// Whether some faces with these normals look flat.
fn has_flat<R: Real>(smooth: &[CornerNormals<R>]) -> bool {
    smooth.is_empty() || smooth.iter().any(CornerNormals::are_alike)
}

/// How far the corners of triangles are from a point, at most.
fn reach<R: Real>(triangles: &[PackedTriangle<R>], from: Vec3<R>) -> R {
    let corners = triangles.iter().flat_map(|triangle| triangle.corners);
    let farthest = corners.map(|corner| (corner - from).length());
    farthest.fold(R::ZERO, R::max) * R::from_f64(1.0 + CAUTION)
}

/// The longest edge of triangles.
fn longest<R: Real>(triangles: &[PackedTriangle<R>]) -> R {
    let edges = triangles.iter().map(|triangle| triangle.longest);
    edges.fold(R::ZERO, R::max)
}

/// A triangle as a member of a tree.
pub fn member(triangle: &PackedTriangle<f64>) -> Member<f64> {
    Member {
        bounds: BoundingBox::around(&triangle.corners),
        thickness: Primitive::thickness(triangle),
    }
}

impl<R: Real> MeshInstance<R> {
    /// The numbers of its triangles, counted from that of the geometry's first primitive.
    pub fn numbers(&self) -> Range<usize> {
        self.first..self.first + self.mesh.triangles.len()
    }

    /// Whether it has an inside: what is against its faces from outside is seen from nowhere.
    pub fn is_solid(&self) -> bool {
        self.mesh.is_solid
    }

    /// Whether it has an inside, and a point is not there.
    pub fn is_seen_from_outside(&self, point: Vec3<R>) -> bool {
        let PackedMesh { triangles, bvh, .. } = &*self.mesh;
        self.mesh.is_solid && is_outside(triangles, bvh, point - self.centre)
    }

    /// The mesh as a member of the tree over all objects.
    pub fn member(&self) -> Member<R> {
        let BoundingBox { low, high } = self.mesh.bvh.bounds;
        // A rounding of each sum.
        let size = self.centre.max_abs() + low.max_abs().max(high.max_abs());
        let slack = Vec3::splat(size * R::UNIT_ROUNDOFF * R::from_f64(2.0));
        Member {
            bounds: BoundingBox {
                low: self.centre + low - slack,
                high: self.centre + high + slack,
            },
            thickness: self.mesh.bvh.thinnest,
        }
    }
}

#[cfg(test)]
mod tests;
