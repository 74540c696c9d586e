//! Faces of meshes that lie in something else, or that something lies in.

use std::cell::OnceCell;

use glam::DVec3;

use super::list::List;
use super::object::Object;
use super::shape::{Describe as _, Mesh, Outline, PlanePiece, Shape, Triangle};
use crate::mesh::are_closed;

/// Most faces that are held against what is around them, of all pairs of objects.
const MOST_FACES: usize = 200_000;

/// Most pairs of objects whose boxes are held against each other, and of faces that are: some ten milliseconds.
const MOST_BOXES: usize = 4_000_000;
const MOST_PAIRS: usize = 2_000_000;

/// Most faces of what is looked at whether it is a solid: a few milliseconds.
const MOST_OF_SOLID: usize = 20_000;

/// Most corners of faces that are held against endless planes: some ten milliseconds.
const MOST_CORNERS: usize = 6_000_000;

/// Share of its size by which a box is widened.
const LITTLE: f64 = 1e-6;

/// Two visible objects, by their places in the list, that fill the same surface, in part or wholly.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Coincidence {
    /// The later one, which is not seen where the earlier one is.
    pub later: usize,
    /// The earlier one.
    pub earlier: usize,
    /// How much of the later one that is.
    pub extent: Overlap,
}

/// How much of an object lies in the surface of another one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Overlap {
    /// Nothing of it is left to be seen.
    Whole,
    /// Some of what is flat lies in what is flat.
    Part,
    /// Some faces of a mesh lie in something, or something lies in them.
    Faces,
    /// A mesh stands on an endless plane or hangs below it, and has faces there.
    Standing,
    /// Faces of solids are against each other: what is there is seen from within alone.
    Touching,
}

/// What of a scene's visible meshes lies in something; coordinates count from `centre`.
pub fn mesh_coincidences(objects: &List<Object>, centre: DVec3) -> Vec<Coincidence> {
    let visible = objects.iter().enumerate();
    let mut ended: Vec<BoxedSurface> = visible
        .filter(|(_, object)| object.visible)
        .filter_map(|(index, object)| BoxedSurface::of(index, object))
        .collect();
    let endless: Vec<_> = ended.extract_if(.., |one| one.bounds.is_none()).collect();
    ended.sort_by(|one, other| one.start().total_cmp(&other.start()));
    let mut found = Vec::new();
    let mut add = |one: &BoxedSurface, other: &BoxedSurface, extent: Overlap| {
        found.push(Coincidence {
            later: one.index.max(other.index),
            earlier: one.index.min(other.index),
            extent,
        });
    };
    let mut corners = MOST_CORNERS;
    for one in &ended {
        let Shape::Mesh(mesh) = one.shape else {
            continue;
        };
        for plane in &endless {
            if let Some(flat) = plane.shape.plane_piece()
                && let Some(extent) = on_plane(mesh, &flat, (centre, &mut corners))
            {
                add(one, plane, extent);
            }
        }
    }
    let mut search = Search {
        centre,
        faces: MOST_FACES,
        pairs: MOST_PAIRS,
        pairs_of_sides: MOST_PAIRS,
    };
    let all: Vec<&BoxedSurface> = ended.iter().collect();
    let meshes: Vec<&BoxedSurface> = ended.iter().filter(|one| one.is_mesh()).collect();
    let (mut seen, mut boxes) = (0, MOST_BOXES);
    for (place, one) in ended.iter().enumerate() {
        seen += usize::from(one.is_mesh());
        // Of two that are no meshes others know, and there may be a wall of them.
        let others = if one.is_mesh() {
            &all[place + 1..]
        } else {
            &meshes[seen..]
        };
        let end = one.bounds.map_or(0.0, |(_, high)| high.x);
        let near = others.iter().take_while(|other| other.start() <= end);
        for other in near.take_while(|_| counts_down(&mut boxes)) {
            if let Some(extent) = search.extent(one, other) {
                add(one, other, extent);
            }
        }
    }
    found
}

/// A flat object or a mesh, and the box around it, a little wider than it is; none if it has no end.
struct BoxedSurface<'a> {
    index: usize,
    shape: &'a Shape,
    bounds: Option<(DVec3, DVec3)>,
    /// See [`Self::outer_side`]: many may stand against one.
    side: OnceCell<Option<f64>>,
}

impl<'a> BoxedSurface<'a> {
    fn of(index: usize, object: &'a Object) -> Option<Self> {
        let shape = &object.shape;
        let is_flat = || shape.plane_piece().is_some();
        let bounds = match shape.bounds() {
            None if matches!(shape, Shape::Plane(_)) => None,
            Some(bounds) if matches!(shape, Shape::Mesh(_)) || is_flat() => Some(widened(bounds)),
            _ => return None,
        };
        Some(Self {
            index,
            shape,
            bounds,
            side: OnceCell::new(),
        })
    }

    fn is_mesh(&self) -> bool {
        matches!(self.shape, Shape::Mesh(_))
    }

    /// Whether the normals of its faces point out of it (1) or into it (-1); `None` if it is no solid, or a large one.
    fn outer_side(&self) -> Option<f64> {
        *self.side.get_or_init(|| self.find_outer_side())
    }

    fn find_outer_side(&self) -> Option<f64> {
        let Shape::Mesh(mesh) = self.shape else {
            return None;
        };
        let triangles = mesh.source.triangles();
        if triangles.faces().len() > MOST_OF_SOLID || !are_closed(triangles.corners()) {
            return None;
        }
        let from = mesh.position;
        let corners = mesh.world_corners();
        let volumes = corners.map(|[a, b, c]| (a - from).dot((b - from).cross(c - from)));
        let volume: f64 = volumes.sum();
        (volume != 0.0).then(|| volume.signum())
    }

    /// Where it begins along x.
    fn start(&self) -> f64 {
        self.bounds.map_or(0.0, |(low, _)| low.x)
    }

    /// Its flat pieces in a box, with the boxes around them.
    fn pieces_in(&self, within: (DVec3, DVec3)) -> Vec<Boxed> {
        let Shape::Mesh(mesh) = self.shape else {
            let piece = self.shape.plane_piece().zip(self.bounds);
            return piece.into_iter().collect();
        };
        let boxed = |piece: PlanePiece| {
            let Outline::Triangle(corners) = piece.outline else {
                return None;
            };
            let [a, b, c] = corners;
            let around = widened(Triangle { a, b, c }.bounds()?);
            meet(around, within).then_some((piece, around))
        };
        mesh.pieces().filter_map(boxed).collect()
    }
}

/// One less, if there is any.
pub fn counts_down(left: &mut usize) -> bool {
    let is_left = *left > 0;
    *left = left.saturating_sub(1);
    is_left
}

/// A box, a little wider: flat ones have no height.
pub fn widened((low, high): (DVec3, DVec3)) -> (DVec3, DVec3) {
    let little = DVec3::splat(LITTLE * (high - low).max_element());
    (low - little, high + little)
}

/// Whether two boxes meet.
pub fn meet(one: (DVec3, DVec3), other: (DVec3, DVec3)) -> bool {
    one.0.cmple(other.1).all() && other.0.cmple(one.1).all()
}

/// How a mesh lies in an endless plane, if any face of it does, and as far as so many corners may still be looked at.
fn on_plane(
    mesh: &Mesh,
    plane: &PlanePiece,
    (centre, left): (DVec3, &mut usize),
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
        let way = [0, 1, 2].map(|axis| f64::from(corner >> axis & 1));
        transform.transform_point3(low + (high - low) * DVec3::from(way))
    });
    let reach = corners.map(|corner| (corner - centre).abs().max_element());
    let little = plane.height_in(centre, reach.fold(0.0, f64::max));
    // Half of the box to each side, along the plane's normal.
    let (middle, half) = ((low + high) * 0.5, (high - low) * 0.5);
    let across = (transform.matrix3.transpose() * plane.normal)
        .abs()
        .dot(half);
    if height(middle).abs() > across + little {
        return None;
    }
    *left = left.checked_sub(3 * triangles.faces().len())?;
    let heights: Vec<f64> = triangles
        .points()
        .iter()
        .map(|&point| height(point))
        .collect();
    let is_on = |corner: &u32| heights[*corner as usize].abs() <= little;
    let is_in = |face: &[u32; 3]| face.iter().all(is_on);
    let faces = triangles.faces().iter().zip(triangles.corners());
    let mut lying = faces.filter(|(face, _)| is_in(face));
    lying.find(|(_, corners)| PlanePiece::between(*corners).is_some())?;
    let lowest = heights.iter().copied().fold(f64::INFINITY, f64::min);
    let highest = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let is_beside = -little <= lowest || highest <= little;
    let is_flat = highest - lowest <= 2.0 * little;
    Some(if is_beside && !is_flat {
        Overlap::Standing
    } else {
        Overlap::Faces
    })
}

/// How much may still be looked at.
struct Search {
    centre: DVec3,
    faces: usize,
    pairs: usize,
    /// The same where it is asked which sides of solids they are.
    pairs_of_sides: usize,
}

/// A flat piece, and the box around it.
type Boxed = (PlanePiece, (DVec3, DVec3));

impl Search {
    /// How two objects that end have flat pieces in one plane; `None` if they have none, or where that is too much to
    /// look at.
    fn extent(&mut self, one: &BoxedSurface, other: &BoxedSurface) -> Option<Overlap> {
        let (around, other_around) = (one.bounds?, other.bounds?);
        if !meet(around, other_around) {
            return None;
        }
        let faces = |placed: &BoxedSurface| match placed.shape {
            Shape::Mesh(mesh) => mesh.source.triangles().faces().len(),
            _ => 1,
        };
        self.faces = self.faces.checked_sub(faces(one) + faces(other))?;
        let within = (around.0.max(other_around.0), around.1.min(other_around.1));
        let pieces = [one, other].map(|placed| {
            let mut pieces = placed.pieces_in(within);
            pieces.sort_by(|a, b| a.1.0.x.total_cmp(&b.1.0.x));
            pieces
        });
        if !self.either(&pieces, &|_| true) {
            return None;
        }
        // All pairs are looked at where none is found: what others need to be found is not used up by that.
        std::mem::swap(&mut self.pairs, &mut self.pairs_of_sides);
        let sides = one.outer_side().zip(other.outer_side());
        let are_apart = sides.is_some_and(|(side, other)| {
            let is_one_way = |cosine: f64| cosine * side * other > 0.0;
            !self.either(&pieces, &is_one_way) && self.pairs > 0
        });
        std::mem::swap(&mut self.pairs, &mut self.pairs_of_sides);
        Some(if are_apart {
            Overlap::Touching
        } else {
            Overlap::Faces
        })
    }

    /// Whether any piece of one coincides with one of the other, see [`Self::any`].
    fn either(&mut self, [one, other]: &[Vec<Boxed>; 2], is_wanted: &dyn Fn(f64) -> bool) -> bool {
        self.any(one, other, is_wanted) || self.any(other, one, is_wanted)
    }

    /// Whether any piece coincides with one of the others that begins behind it along x, if the cosine between their
    /// normals is wanted; both are sorted by that.
    fn any(&mut self, pieces: &[Boxed], others: &[Boxed], is_wanted: &dyn Fn(f64) -> bool) -> bool {
        pieces.iter().any(|(piece, around)| {
            let from = others.partition_point(|(_, other)| other.0.x < around.0.x);
            let others = others[from..].iter();
            let mut near = others.take_while(|(_, other)| other.0.x <= around.1.x);
            near.any(|(other, other_around)| {
                counts_down(&mut self.pairs)
                    && meet(*around, *other_around)
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

    /// A sheet of so many squares a side, that many units wide, whose middle is at `at`, turned by so many degrees.
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
        // Their fronts are one surface.
        assert_eq!(found(lower.clone(), cube(0.3, 0.3)), Some(Overlap::Faces));
        let mirrored = Mesh {
            scale: DVec3::new(1.0, -1.0, 1.0),
            ..cube(0.3, side)
        };
        assert_eq!(found(lower.clone(), mirrored), Some(Overlap::Touching));
        // A sheet has no inside.
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
        let (across, along) = (one.turn() * DVec3::Y, one.turn() * DVec3::X);
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
