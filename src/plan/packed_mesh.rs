//! A mesh prepared for tracing: its triangles relative to its own middle, and their tree.

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
use super::components::{first_of_components, six_volumes};
use super::oriented_box::OrientedBox;
use super::slices::{entries, slicings};
use super::smooth::{corner_normals, largest_lift};
use super::thickness::widths;
use super::tips::tips;
use crate::mesh::Triangles;
use crate::primitive::{BoundingBox, CAUTION, CornerNormals, PackedTriangle, Slicing};
use crate::scene::{Mesh, around};
use crate::simd::{Real, Vec3};

/// The triangles of a mesh, rotated and scaled as in the world and relative to the middle of their bounding box:
/// the mesh's position costs no precision, and moving the mesh changes none of this.
#[derive(Clone, Debug)]
pub struct PackedMesh<R> {
    /// The triangles; those without an area are left out.
    pub triangles: Vec<PackedTriangle<R>>,
    /// The corner normals of each triangle, if the mesh is shaded as a curved surface; otherwise empty.
    pub smooth: Vec<CornerNormals<R>>,
    /// Whether any of the triangles look flat.
    pub has_flat: bool,
    /// Upper bound of the height above the triangles at which secondary rays start.
    pub lift: R,
    /// The length of the longest edge.
    pub longest: R,
    /// The tree over the triangles.
    pub bvh: Bvh<R>,
    /// A box that lies along the mesh, if that is much smaller than the axis-aligned one.
    pub oriented: Option<OrientedBox<R>>,
    /// The greatest distance of a corner from the middle of the bounding box.
    pub reach: R,
    /// For each triangle, the indices of its corners in the source; empty if the triangles are not in the order
    /// that they have without rotation.
    faces: Arc<[[u32; 3]]>,
    /// For each triangle, the first one of its connected component; empty if there is only one component.
    component_firsts: Arc<[u32]>,
    /// Whether the mesh has an inside; its normals then point outwards, however the file winds its faces.
    is_solid: bool,
    /// Whether the file winds the faces inside out.
    is_inside_out: bool,
    /// The middle of the bounding box relative to the mesh's origin.
    middle: DVec3,
    linear: DMat3,
    /// What the mesh was packed from.
    pub key: MeshKey,
    /// Kept alive so that nothing else gets its address.
    source: Arc<Triangles>,
}

/// What a packed mesh is made from, independent of its position.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MeshKey {
    /// What does not depend on the rotation.
    pub level: LevelKey,
    /// The bits of the rotation.
    rotation: [u64; 3],
}

/// What a packed mesh is made from, apart from its rotation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct LevelKey {
    /// The address of the faces.
    faces: usize,
    /// The bits of the scale.
    scale: [u64; 3],
    /// The bits of the smoothing angle.
    smooth: u64,
}

impl MeshKey {
    /// The key of a mesh.
    pub fn of(mesh: &Mesh) -> Self {
        let bits = |parts: DVec3| parts.to_array().map(f64::to_bits);
        let level = LevelKey {
            faces: Arc::as_ptr(mesh.source.triangles()).addr(),
            scale: bits(mesh.scale),
            smooth: mesh.smooth.to_bits(),
        };
        Self {
            level,
            rotation: bits(mesh.rotation),
        }
    }
}

/// The rotated and scaled points of a mesh, relative to the middle of the box around its corners; and that middle,
/// relative to the mesh's origin.
fn points_and_middle(source: &Triangles, linear: DMat3) -> (Vec<DVec3>, DVec3) {
    let points = source.points().iter().map(|&point| linear * point);
    let mut points: Vec<DVec3> = points.collect();
    let named = source.faces().as_flattened().iter();
    let corners = named.map(|&corner| points[corner as usize]);
    let (low, high) = around(corners.map(|corner| (corner, corner))).unwrap_or_default();
    let middle = low.midpoint(high);
    for point in &mut points {
        *point -= middle;
    }
    (points, middle)
}

/// A mesh at its position.
#[derive(Clone, Debug)]
pub struct MeshInstance<R> {
    /// The packed mesh, which several instances may share.
    pub mesh: Arc<PackedMesh<R>>,
    /// The position of the mesh's middle.
    pub centre: Vec3<R>,
    /// Index of its material.
    pub material: u32,
    /// Its index in the scene's list.
    pub object_index: usize,
    /// The number of its first triangle, counted from that of the geometry's first primitive.
    pub first: usize,
}

impl PackedMesh<f64> {
    /// Packs a mesh. Its properties are determined in double precision, whichever precision traces it, and without
    /// rotation, so that they do not change when it is rotated, see [`Self::turned`].
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
            // The faces may be in another order.
            faces: [].into(),
            ..Self::of(mesh)
        })
    }

    fn of(mesh: &Mesh) -> Self {
        let linear = mesh.linear_transform();
        let (points, middle) = points_and_middle(mesh.source.triangles(), linear);
        let is_mirrored = linear.determinant() < 0.0;
        // Clockwise seen from outside, as in the source.
        let face = |&[a, b, c]: &[u32; 3]| if is_mirrored { [a, c, b] } else { [a, b, c] };
        let corners = |face: [u32; 3]| face.map(|point| points[point as usize]);
        let packed = |face: &[u32; 3]| PackedTriangle::of_mesh(corners(*face));
        let faces = mesh.source.triangles().faces().iter().map(face);
        let faces: Vec<_> = faces.filter(|face| packed(face).is_some()).collect();
        // The tree first, since building it takes more memory than anything else.
        let face_corners = |face: usize| corners(faces[face]).map(Vec3::from_dvec3);
        let slicings = slicings(faces.len(), face_corners);
        let mut bvh = tree(&slicings, faces.len(), face_corners);
        // Triangles that are hit together are stored together.
        let order = bvh.renumber(faces.len());
        let slicing = |&number: &u32| slicings.get(number as usize);
        let slicings: Vec<_> = order.iter().filter_map(slicing).copied().collect();
        let faces: Vec<_> = order.iter().map(|&number| faces[number as usize]).collect();
        let corners_of = |face: u32| corners(faces[face as usize]).map(Vec3::from_dvec3);
        let borders = Borders::of(&faces, corners_of, |_| 0);
        let mut triangles = Vec::with_capacity(faces.len());
        triangles.extend(faces.iter().filter_map(packed));
        for (triangle, slicing) in triangles.iter_mut().zip(slicings) {
            triangle.slicing = slicing;
        }
        drop(points);
        measure(&mut triangles, &faces, &mut bvh, &borders);
        let component_firsts = first_of_components(&borders.connected).into();
        let volume = if borders.is_closed {
            six_volumes(&triangles)
        } else {
            0.0
        };
        if volume < 0.0 {
            triangles.iter_mut().for_each(PackedTriangle::flip);
        }
        let smooth = normals_of(mesh, &triangles);
        Self {
            has_flat: has_flat(&smooth),
            lift: largest_lift(&triangles, &smooth),
            longest: longest(&triangles),
            reach: reach(&triangles, bvh.bounds.ball().0),
            oriented: OrientedBox::around(&triangles, &bvh.bounds),
            smooth,
            faces: faces.into(),
            component_firsts,
            bvh,
            is_solid: volume != 0.0,
            is_inside_out: volume < 0.0,
            triangles,
            middle,
            linear,
            key: MeshKey::of(mesh),
            source: Arc::clone(mesh.source.triangles()),
        }
    }

    /// Returns the mesh in another precision, or itself if it has that one: its properties stay, and its tree is
    /// shared.
    pub fn in_precision<R: Real>(this: &Arc<Self>) -> Arc<PackedMesh<R>> {
        let same: Arc<dyn Any + Send + Sync> = Arc::clone(this) as _;
        same.downcast().unwrap_or_else(|_| Arc::new(this.rounded()))
    }

    fn rounded<R: Real>(&self) -> PackedMesh<R> {
        let triangles = self.triangles.iter().map(PackedTriangle::in_precision);
        let smooth = self.smooth.iter().map(CornerNormals::in_precision);
        self.with(
            triangles.collect(),
            smooth.collect(),
            self.bvh.in_precision(),
        )
    }
}

impl<R: Real> PackedMesh<R> {
    /// Returns the same mesh with another rotation, without determining its components, widths and tree again.
    /// Returns `None` if the original order of its faces is not known, or if rounding leaves a face without an
    /// area.
    pub fn turned(&self, mesh: &Mesh) -> Option<PackedMesh<f64>> {
        let linear = mesh.linear_transform();
        let (points, middle) = points_and_middle(&self.source, linear);
        let faces = self.faces.par_iter().zip(&self.triangles);
        let triangles = faces.map(|(face, before)| {
            let corners = face.map(|point| points[point as usize]);
            let mut triangle = PackedTriangle::of_mesh(corners)?;
            if self.is_inside_out {
                triangle.flip();
            }
            triangle.thickness = before.thickness.to_f64();
            triangle.wider = before.wider.to_f64();
            triangle.tip = before.tip;
            triangle.slicing = before.slicing;
            Some(triangle)
        });
        let triangles: Vec<PackedTriangle<f64>> = triangles.collect::<Option<_>>()?;
        if triangles.len() < self.triangles.len() {
            return None;
        }
        let mut bvh = self.bvh.in_precision();
        bvh.refit(|number, slice| Member::of_slice(&triangles[number], slice));
        let smooth = normals_of(mesh, &triangles);
        Some(PackedMesh {
            middle,
            linear,
            key: MeshKey::of(mesh),
            ..self.with(triangles, smooth, bvh)
        })
    }

    /// The same mesh with other corners of its triangles.
    fn with<S: Real>(
        &self,
        triangles: Vec<PackedTriangle<S>>,
        smooth: Vec<CornerNormals<S>>,
        bvh: Bvh<S>,
    ) -> PackedMesh<S> {
        PackedMesh {
            has_flat: has_flat(&smooth),
            lift: largest_lift(&triangles, &smooth),
            longest: longest(&triangles),
            reach: reach(&triangles, bvh.bounds.ball().0),
            oriented: OrientedBox::around(&triangles, &bvh.bounds),
            triangles,
            smooth,
            bvh,
            faces: Arc::clone(&self.faces),
            component_firsts: Arc::clone(&self.component_firsts),
            is_solid: self.is_solid,
            is_inside_out: self.is_inside_out,
            middle: self.middle,
            linear: self.linear,
            key: self.key,
            source: Arc::clone(&self.source),
        }
    }

    /// Returns whether not all faces are connected.
    pub fn has_parts(&self) -> bool {
        !self.component_firsts.is_empty()
    }

    /// The first face of the connected component of `face`.
    pub fn component_of(&self, face: usize) -> usize {
        self.component_firsts
            .get(face)
            .map_or(0, |&first| first as usize)
    }

    /// The position of a point of the source relative to the middle, with exactly the rounding of the triangles'
    /// corners.
    pub fn to_local(&self, point: DVec3) -> Vec3<R> {
        Vec3::from_dvec3(self.linear * point - self.middle)
    }

    /// The position of the mesh's middle in the world, given the mesh that it was packed from.
    pub fn middle_of(&self, mesh: &Mesh) -> DVec3 {
        mesh.position + self.middle
    }
}

/// The tree over the faces of a mesh, or over their slices if there are any.
fn tree(slicings: &[Slicing], faces: usize, corners: impl Fn(usize) -> [Vec3<f64>; 3]) -> Bvh<f64> {
    let member = |bounds| Member {
        bounds,
        thickness: f64::INFINITY,
    };
    if slicings.is_empty() {
        return Bvh::new(faces, |face| member(BoundingBox::around(&corners(face))));
    }
    let entries = entries(slicings);
    let slice = |entry: usize| entries[entry];
    let mut bvh = Bvh::of_slices(entries.len(), slice, |face, slice| {
        let bounds = slicings[face].bounds(&corners(face), slice);
        if slicings[face].count() == 1 {
            return member(bounds);
        }
        // Round: in their own boxes, the slices of an upright face would be grouped like a whole one, whose box is
        // mostly empty once the mesh is rotated.
        let (middle, radius) = bounds.ball();
        member(BoundingBox::around(&[middle]).widened(radius))
    });
    bvh.refit(|face, slice| member(slicings[face].tree_bounds(&corners(face), slice)));
    bvh
}

/// Sets the widths and the tip of each triangle, given their corner numbers, tree and borders, and updates the
/// thicknesses in the tree.
pub fn measure(
    triangles: &mut [PackedTriangle<f64>],
    faces: &[[u32; 3]],
    bvh: &mut Bvh<f64>,
    borders: &Borders,
) {
    let widths = widths(triangles, bvh, borders);
    let border_faces = borders.widths.iter().map(|&(face, _)| face);
    let tips = tips(triangles, faces, border_faces);
    for ((triangle, width), tip) in triangles.iter_mut().zip(widths).zip(tips) {
        (triangle.thickness, triangle.wider) = width.at_least(triangle.thickness);
        triangle.tip = tip;
    }
    bvh.refit(|number, slice| Member::of_slice(&triangles[number], slice));
}

/// The normals of faces that are shaded as one curved surface; empty if the mesh is flat.
fn normals_of(mesh: &Mesh, triangles: &[PackedTriangle<f64>]) -> Vec<CornerNormals<f64>> {
    if mesh.smooth > 0.0 {
        corner_normals(triangles, mesh.smooth)
    } else {
        Vec::new()
    }
}

/// Returns whether any faces with these normals look flat.
fn has_flat<R: Real>(smooth: &[CornerNormals<R>]) -> bool {
    smooth.is_empty() || smooth.iter().any(CornerNormals::are_alike)
}

/// Upper bound of the distance of the triangles' corners from a point.
fn reach<R: Real>(triangles: &[PackedTriangle<R>], from: Vec3<R>) -> R {
    let corners = triangles.iter().flat_map(|triangle| triangle.corners);
    let farthest = corners.map(|corner| (corner - from).length());
    farthest.fold(R::ZERO, R::max) * R::from_f64(1.0 + CAUTION)
}

/// The longest edge of the triangles.
fn longest<R: Real>(triangles: &[PackedTriangle<R>]) -> R {
    let edges = triangles.iter().map(|triangle| triangle.longest);
    edges.fold(R::ZERO, R::max)
}

impl<R: Real> MeshInstance<R> {
    /// The numbers of its triangles, counted from the geometry's first primitive.
    pub fn numbers(&self) -> Range<usize> {
        self.first..self.first + self.mesh.triangles.len()
    }

    /// Returns whether it has an inside: what touches its faces from outside cannot be seen.
    pub fn is_solid(&self) -> bool {
        self.mesh.is_solid
    }

    /// Returns whether the mesh has an inside and the point is not in it.
    pub fn is_seen_from_outside(&self, point: Vec3<R>) -> bool {
        let PackedMesh { triangles, bvh, .. } = &*self.mesh;
        self.mesh.is_solid && is_outside(triangles, bvh, point - self.centre)
    }

    /// The mesh as a member of the tree over all objects.
    pub fn member(&self) -> Member<R> {
        let bounds = &self.mesh.bvh.bounds;
        // One rounding per sum.
        let size = self.centre.max_abs() + bounds.max_abs();
        let slack = size * R::UNIT_ROUNDOFF * R::from_f64(2.0);
        Member {
            bounds: bounds.moved(self.centre).widened(slack),
            thickness: self.mesh.bvh.thinnest,
        }
    }
}

#[cfg(test)]
mod tests;
