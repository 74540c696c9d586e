//! Mesh faces that coincide with other surfaces.

use std::cell::OnceCell;

use glam::DVec3;

use super::list::List;
use super::object::Object;
use super::shape::{Describe as _, Mesh, Outline, PlanePiece, Shape, Triangle};
use crate::mesh::are_closed;

/// Largest number of faces that are compared with their surroundings, summed over all pairs of objects.
const MAX_FACES: usize = 200_000;

/// Largest number of pairs of objects whose bounding boxes are compared, and of pairs of faces: takes some ten
/// milliseconds.
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
    let mut corners = MAX_CORNERS;
    for one in &bounded {
        let Shape::Mesh(mesh) = one.shape else {
            continue;
        };
        for (index, plane) in &planes {
            if let Some(extent) = on_plane(mesh, plane, (centre, &mut corners)) {
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

/// Returns how a mesh coincides with an infinite plane; `None` if no face is in the plane, or if the budget of
/// corners in `budget` does not suffice.
fn on_plane(
    mesh: &Mesh,
    plane: &PlanePiece,
    (centre, budget): (DVec3, &mut usize),
) -> Option<Overlap> {
    let triangles = mesh.source.triangles();
    let transform = mesh.transform();
    let height = |point: DVec3| {
        plane
            .normal
            .dot(transform.transform_point3(point) - plane.point)
    };
    let (low, high) = triangles.bounds()?;
    let corners = (0..8).map(|corner| {
        let side = [0, 1, 2].map(|axis| f64::from(corner >> axis & 1));
        transform.transform_point3(low + (high - low) * DVec3::from(side))
    });
    let reach = corners.map(|corner| (corner - centre).abs().max_element());
    let tolerance = plane.plane_tolerance(centre, reach.fold(0.0, f64::max));
    // Extent of the box to each side of its middle, along the plane's normal.
    let (middle, half) = ((low + high) * 0.5, (high - low) * 0.5);
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
mod tests {
    use super::*;
    use crate::mesh::Triangles;
    use crate::scene::{Disc, Plane};

    /// Returns a sheet of `squares` × `squares` squares, `width` units wide, centred at `at` and turned by
    /// `rotation` in degrees.
    fn sheet(squares: u32, width: f64, at: DVec3, rotation: DVec3) -> Mesh {
        let side = squares + 1;
        let place = |index: u32| (f64::from(index) / f64::from(squares) - 0.5) * width;
        let points = (0..side * side).map(|n| DVec3::new(place(n % side), 0.0, place(n / side)));
        let faces = (0..squares * squares).flat_map(|n| {
            let corner = n / squares * side + n % squares;
            [
                [corner, corner + 1, corner + side],
                [corner + 1, corner + side + 1, corner + side],
            ]
        });
        let triangles = Triangles::new(points.collect(), faces.collect()).expect("in range");
        Mesh {
            position: at,
            rotation,
            ..Mesh::of(triangles)
        }
    }

    fn found(one: impl Into<Shape>, other: impl Into<Shape>) -> Option<Overlap> {
        let objects = [
            Object::new("one", "red", one.into()),
            Object::new("other", "blue", other.into()),
        ];
        let found = mesh_coincidences(&objects.into_iter().collect(), DVec3::ZERO);
        assert!(found.len() <= 1);
        found.first().map(|found| {
            assert_eq!((found.earlier, found.later), (0, 1));
            found.extent
        })
    }

    fn floor() -> Plane {
        Plane {
            point: DVec3::ZERO,
            normal: DVec3::Y,
        }
    }

    #[test]
    fn a_sheet_lies_in_a_floor_and_a_box_stands_on_it() {
        let flat = sheet(7, 50.0, DVec3::ZERO, DVec3::ZERO);
        assert_eq!(found(flat.clone(), floor()), Some(Overlap::Faces));
        assert_eq!(found(floor(), flat.clone()), Some(Overlap::Faces));
        let higher = sheet(7, 50.0, DVec3::Y * 1e-3, DVec3::ZERO);
        assert_eq!(found(higher, floor()), None);
        let turned = sheet(7, 50.0, DVec3::ZERO, DVec3::X);
        assert_eq!(found(turned, floor()), None);
        let cube = |y: f64| Mesh {
            position: DVec3::Y * y,
            ..Mesh::of((crate::mesh::SOLIDS[0].make)(2.0))
        };
        let half = cube(0.0).bounds().map_or(0.0, |(_, high)| high.y);
        assert_eq!(found(cube(half), floor()), Some(Overlap::Standing));
        assert_eq!(found(cube(-half), floor()), Some(Overlap::Standing));
        assert_eq!(found(cube(0.3 * half), floor()), None);
        assert_eq!(found(cube(9.0), floor()), None);
    }

    #[test]
    fn solids_that_stand_on_each_other_touch_and_one_in_a_side_of_another_lies_there() {
        let cube = |x: f64, y: f64| Mesh {
            position: DVec3::new(x, y, 0.0),
            ..Mesh::of((crate::mesh::SOLIDS[0].make)(2.0))
        };
        let side = cube(0.0, 0.0)
            .bounds()
            .map_or(0.0, |(low, high)| (high - low).y);
        let lower = cube(0.0, 0.0);
        assert_eq!(
            found(lower.clone(), cube(0.3, side)),
            Some(Overlap::Touching)
        );
        // Their front faces are in one plane.
        assert_eq!(found(lower.clone(), cube(0.3, 0.3)), Some(Overlap::Faces));
        let mirrored = Mesh {
            scale: DVec3::new(1.0, -1.0, 1.0),
            ..cube(0.3, side)
        };
        assert_eq!(found(lower.clone(), mirrored), Some(Overlap::Touching));
        // A sheet is no solid.
        let lid = sheet(1, 1.0, DVec3::Y * side / 2.0, DVec3::X * 180.0);
        assert_eq!(found(lower, lid), Some(Overlap::Faces));
    }

    #[test]
    fn sheets_that_share_an_area_coincide_however_they_are_cut_and_turned() {
        let turned = DVec3::new(11.0, 23.0, 5.0);
        let at = DVec3::new(1.0, 3.0, 2.0);
        let sheets =
            |other: DVec3| found(sheet(7, 50.0, at, turned), sheet(11, 30.0, other, turned));
        assert_eq!(sheets(at), Some(Overlap::Faces));
        let one = sheet(7, 50.0, at, turned);
        let (across, along) = (
            one.linear_transform() * DVec3::Y,
            one.linear_transform() * DVec3::X,
        );
        assert_eq!(sheets(at + across * 1e-3), None);
        assert_eq!(sheets(at + along * 39.9), Some(Overlap::Faces));
        assert_eq!(sheets(at + along * 40.1), None, "beside it");
        let disc = |center: DVec3| Disc {
            center,
            normal: across,
            radius: 1.0,
        };
        assert_eq!(found(disc(at), one.clone()), Some(Overlap::Faces));
        assert_eq!(found(disc(at + across), one), None);
    }
}
