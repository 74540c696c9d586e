//! Mesh faces that coincide with other surfaces.

use std::cell::OnceCell;

use glam::{DAffine3, DVec3};

use super::list::List;
use super::object::Object;
use super::shape::{Describe as _, Outline, PlanePiece, Shape, Triangle};
use crate::mesh::{Triangles, are_closed};

/// Largest number of faces that are compared with their surroundings, summed over all pairs of objects.
const MAX_FACES: usize = 200_000;

/// Largest number of pairs of objects whose bounding boxes are compared, the same of a mesh and an infinite plane, and
/// of pairs of faces: each takes some ten milliseconds.
const MAX_BOXES: usize = 4_000_000;
const MAX_PAIRS: usize = 2_000_000;

/// Largest number of faces of a mesh that is tested for being a solid: takes a few milliseconds.
const MAX_SOLID_FACES: usize = 20_000;

/// Largest number of face corners that are compared with infinite planes: takes some ten milliseconds.
const MAX_CORNERS: usize = 6_000_000;

/// Margin by which a bounding box is widened, as a share of its size.
const BOX_MARGIN: f64 = 1e-6;

/// Two visible objects, by index, that share a surface in part or entirely.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Coincidence {
    /// The later one in the list, which is hidden where the earlier one is.
    pub later: usize,
    /// The earlier one in the list.
    pub earlier: usize,
    /// How they coincide.
    pub extent: Overlap,
}

/// The way in which an object coincides with another one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Overlap {
    /// The later object is hidden entirely.
    Whole,
    /// Flat objects overlap in part.
    Part,
    /// Some faces of a mesh coincide with the other object.
    Faces,
    /// A mesh stands on an infinite plane or hangs below it, with faces in the plane.
    Standing,
    /// Faces of solids touch from outside: the shared area is visible only from inside the solids.
    Touching,
}

impl Overlap {
    /// Returns whether the shared surface is seen only from inside the solids, or not at all.
    pub fn is_hidden(self) -> bool {
        matches!(self, Self::Standing | Self::Touching)
    }
}

/// Finds the visible meshes that share a surface with other objects. Coordinates are taken relative to `centre`.
pub fn mesh_coincidences(objects: &List<Object>, centre: DVec3) -> Vec<Coincidence> {
    let planes = objects
        .visible()
        .filter_map(|(index, object)| Some((index, object.shape.endless_plane()?)));
    let planes: Vec<(usize, PlanePiece)> = planes.collect();
    let bounded = objects
        .visible()
        .filter_map(|(index, object)| BoxedSurface::of(index, object));
    let mut bounded: Vec<BoxedSurface> = bounded.collect();
    bounded.sort_by(|one, other| one.start().total_cmp(&other.start()));
    let mut found = Vec::new();
    let mut add = |one: &BoxedSurface, other: usize, extent: Overlap| {
        found.push(Coincidence {
            later: one.index.max(other),
            earlier: one.index.min(other),
            extent,
        });
    };
    let (mut corners, mut placed) = (MAX_CORNERS, MAX_BOXES);
    for one in &bounded {
        let Some(mesh) = PlacedMesh::new(one.shape, centre) else {
            continue;
        };
        for (index, plane) in planes.iter().take_while(|_| try_spend(&mut placed)) {
            if let Some(extent) = mesh.on_plane(plane, &mut corners) {
                add(one, *index, extent);
            }
        }
    }
    let mut search = Search {
        centre,
        faces: MAX_FACES,
        pairs: MAX_PAIRS,
        pairs_of_sides: MAX_PAIRS,
    };
    let all: Vec<&BoxedSurface> = bounded.iter().collect();
    let meshes: Vec<&BoxedSurface> = bounded.iter().filter(|one| one.is_mesh()).collect();
    let (mut meshes_seen, mut boxes) = (0, MAX_BOXES);
    for (rank, one) in bounded.iter().enumerate() {
        meshes_seen += usize::from(one.is_mesh());
        // Pairs without a mesh are found elsewhere, and there may be very many of them.
        let others = if one.is_mesh() {
            &all[rank + 1..]
        } else {
            &meshes[meshes_seen..]
        };
        let end = one.bounds.1.x;
        let near = others.iter().take_while(|other| other.start() <= end);
        for other in near.take_while(|_| try_spend(&mut boxes)) {
            if let Some(extent) = search.extent(one, other) {
                add(one, other.index, extent);
            }
        }
    }
    found
}

/// A bounded flat object or a mesh, and its slightly widened bounding box.
struct BoxedSurface<'a> {
    index: usize,
    shape: &'a Shape,
    bounds: (DVec3, DVec3),
    /// Cached result of [`Self::normal_orientation`]: many objects may touch one.
    orientation: OnceCell<Option<f64>>,
}

impl<'a> BoxedSurface<'a> {
    fn of(index: usize, object: &'a Object) -> Option<Self> {
        let shape = &object.shape;
        let is_surface = matches!(shape, Shape::Mesh(_)) || shape.plane_piece().is_some();
        let bounds = shape.bounds().filter(|_| is_surface)?;
        Some(Self {
            index,
            shape,
            bounds: widened(bounds),
            orientation: OnceCell::new(),
        })
    }

    fn is_mesh(&self) -> bool {
        matches!(self.shape, Shape::Mesh(_))
    }

    /// Returns whether the normals of the faces point outwards (1) or inwards (-1); `None` if the object is not a
    /// solid, or has too many faces to test.
    fn normal_orientation(&self) -> Option<f64> {
        *self.orientation.get_or_init(|| self.find_orientation())
    }

    fn find_orientation(&self) -> Option<f64> {
        let Shape::Mesh(mesh) = self.shape else {
            return None;
        };
        let triangles = mesh.source.triangles();
        if triangles.faces().len() > MAX_SOLID_FACES || !are_closed(triangles.corners()) {
            return None;
        }
        let from = mesh.position;
        let corners = mesh.world_corners();
        let volumes = corners.map(|[a, b, c]| (a - from).dot((b - from).cross(c - from)));
        let volume: f64 = volumes.sum();
        (volume != 0.0).then(|| volume.signum())
    }

    /// Lower end of the bounding box along x.
    fn start(&self) -> f64 {
        self.bounds.0.x
    }

    /// Returns the flat pieces that meet the box `within`, with their bounding boxes.
    fn pieces_in(&self, within: (DVec3, DVec3)) -> Vec<Boxed> {
        let Shape::Mesh(mesh) = self.shape else {
            let piece = self.shape.plane_piece();
            return piece
                .map(|piece| (piece, self.bounds))
                .into_iter()
                .collect();
        };
        let boxed = |piece: PlanePiece| {
            let Outline::Triangle(corners) = piece.outline else {
                return None;
            };
            let [a, b, c] = corners;
            let around = widened(Triangle { a, b, c }.bounds()?);
            boxes_overlap(around, within).then_some((piece, around))
        };
        mesh.pieces().filter_map(boxed).collect()
    }
}

/// Decrements a budget, and returns whether any of it was left.
pub fn try_spend(budget: &mut usize) -> bool {
    let was_left = *budget > 0;
    *budget = budget.saturating_sub(1);
    was_left
}

/// Returns a slightly larger box: the bounding boxes of flat objects may have no height.
pub fn widened((low, high): (DVec3, DVec3)) -> (DVec3, DVec3) {
    let margin = DVec3::splat(BOX_MARGIN * (high - low).max_element());
    (low - margin, high + margin)
}

/// Returns whether two boxes overlap or touch.
pub fn boxes_overlap(one: (DVec3, DVec3), other: (DVec3, DVec3)) -> bool {
    one.0.cmple(other.1).all() && other.0.cmple(one.1).all()
}

/// A mesh that is compared with many infinite planes.
struct PlacedMesh<'a> {
    triangles: &'a Triangles,
    transform: DAffine3,
    centre: DVec3,
    /// Largest coordinate of its bounding box relative to the centre.
    reach: f64,
}

impl<'a> PlacedMesh<'a> {
    fn new(shape: &'a Shape, centre: DVec3) -> Option<Self> {
        let Shape::Mesh(mesh) = shape else {
            return None;
        };
        let (low, high) = mesh.bounds()?;
        let reach = (low - centre).abs().max((high - centre).abs());
        Some(Self {
            triangles: mesh.source.triangles(),
            transform: mesh.transform(),
            centre,
            reach: reach.max_element(),
        })
    }

    /// Returns how the mesh coincides with a plane; `None` if no face is in the plane, or if the budget of corners
    /// does not suffice.
    fn on_plane(&self, plane: &PlanePiece, budget: &mut usize) -> Option<Overlap> {
        let (triangles, transform) = (self.triangles, &self.transform);
        let height = |point: DVec3| {
            let point = transform.transform_point3(point);
            plane.normal.dot(point - plane.point)
        };
        let tolerance = plane.plane_tolerance(self.centre, self.reach);
        let (low, high) = triangles.bounds()?;
        // Extent of the box to each side of its middle, along the plane's normal.
        let (middle, half) = (low.midpoint(high), (high - low) * 0.5);
        let across = (transform.matrix3.transpose() * plane.normal)
            .abs()
            .dot(half);
        if height(middle).abs() > across + tolerance {
            return None;
        }
        *budget = budget.checked_sub(3 * triangles.faces().len())?;
        let heights: Vec<f64> = triangles
            .points()
            .iter()
            .map(|&point| height(point))
            .collect();
        let is_on = |corner: &u32| heights[*corner as usize].abs() <= tolerance;
        let is_in = |face: &[u32; 3]| face.iter().all(is_on);
        let faces = triangles.faces().iter().zip(triangles.corners());
        let mut in_plane = faces.filter(|(face, _)| is_in(face));
        in_plane.find(|(_, corners)| PlanePiece::between(*corners).is_some())?;
        let lowest = heights.iter().copied().fold(f64::INFINITY, f64::min);
        let highest = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let is_on_one_side = -tolerance <= lowest || highest <= tolerance;
        let is_flat = highest - lowest <= 2.0 * tolerance;
        Some(if is_on_one_side && !is_flat {
            Overlap::Standing
        } else {
            Overlap::Faces
        })
    }
}

/// Remaining budget of a search.
struct Search {
    centre: DVec3,
    faces: usize,
    pairs: usize,
    /// Separate budget of pairs for the sides of solids.
    pairs_of_sides: usize,
}

/// A flat piece and its bounding box.
type Boxed = (PlanePiece, (DVec3, DVec3));

impl Search {
    /// Returns how two bounded objects share a plane; `None` if they do not, or if the budget does not suffice.
    fn extent(&mut self, one: &BoxedSurface, other: &BoxedSurface) -> Option<Overlap> {
        let (around, other_around) = (one.bounds, other.bounds);
        if !boxes_overlap(around, other_around) {
            return None;
        }
        let faces = |surface: &BoxedSurface| match surface.shape {
            Shape::Mesh(mesh) => mesh.source.triangles().faces().len(),
            _ => 1,
        };
        self.faces = self.faces.checked_sub(faces(one) + faces(other))?;
        let within = (around.0.max(other_around.0), around.1.min(other_around.1));
        let pieces = [one, other].map(|surface| {
            let mut pieces = surface.pieces_in(within);
            pieces.sort_by(|a, b| a.1.0.x.total_cmp(&b.1.0.x));
            pieces
        });
        if !self.any_pair(&pieces, &|_| true) {
            return None;
        }
        // If no pair is found here, all have been examined. This has its own budget, so as not to use up that of
        // other objects.
        std::mem::swap(&mut self.pairs, &mut self.pairs_of_sides);
        let sides = one.normal_orientation().zip(other.normal_orientation());
        let are_touching = sides.is_some_and(|(side, other)| {
            let face_alike = |cosine: f64| cosine * side * other > 0.0;
            !self.any_pair(&pieces, &face_alike) && self.pairs > 0
        });
        std::mem::swap(&mut self.pairs, &mut self.pairs_of_sides);
        Some(if are_touching {
            Overlap::Touching
        } else {
            Overlap::Faces
        })
    }

    /// Returns whether any piece of one object coincides with one of the other, see [`Self::any`].
    fn any_pair(
        &mut self,
        [one, other]: &[Vec<Boxed>; 2],
        is_wanted: &dyn Fn(f64) -> bool,
    ) -> bool {
        self.any(one, other, is_wanted) || self.any(other, one, is_wanted)
    }

    /// Returns whether any piece coincides with one of `others` that starts at the same x or later, among pairs
    /// whose cosine between the normals satisfies `is_wanted`. Both lists must be sorted by the lower end along x.
    fn any(&mut self, pieces: &[Boxed], others: &[Boxed], is_wanted: &dyn Fn(f64) -> bool) -> bool {
        pieces.iter().any(|(piece, around)| {
            let from = others.partition_point(|(_, other)| other.0.x < around.0.x);
            let others = others[from..].iter();
            let mut near = others.take_while(|(_, other)| other.0.x <= around.1.x);
            near.any(|(other, other_around)| {
                try_spend(&mut self.pairs)
                    && boxes_overlap(*around, *other_around)
                    && is_wanted(piece.normal.dot(other.normal))
                    && piece.coincides(other, self.centre)
            })
        })
    }
}

#[cfg(test)]
mod tests;
