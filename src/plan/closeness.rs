//! Near contacts of the eye, lights, spheres and flat pieces, where single precision loses too many digits.

use glam::DVec3;

use crate::scene::{Describe as _, Light, Mesh, Outline, PlanePiece, Scene, Shape, Triangle};

/// Least height of the eye or a light above a sphere for single precision, in radii: below it, the distance to the
/// ground straight ahead has lost its digits.
const MIN_HEIGHT_PER_RADIUS: f64 = 1e-3;

/// Least height of the eye above a plane, or of a light above anything flat, for single precision, as a share of
/// the scene's extent: below it, rounding may put it on the other side.
const MIN_HEIGHT_PER_EXTENT: f64 = 1e-5;
/// The same for the eye above a disc or a triangle.
const MIN_HEIGHT_OVER_PIECE: f64 = 1e-7;
/// Least distance of the eye or a light from the border of a piece for single precision without filtering, as a
/// share of the size of the scene's bounded part: rounding then turns the line to the border by 1/5000. Of random
/// triangles and discs at a third of this distance, some are off by up to 28 pixels of 40,000; at three times as
/// much, none.
const MIN_DISTANCE_OF_BORDER: f64 = 3e-4;
/// Maximum number of pairs of an object and a light that are checked.
const MAX_PAIRS: usize = 100_000;

/// Maximum number of faces of meshes that are compared with lights, in all: a millisecond.
const MAX_FACES: usize = 20_000;

/// Least distance between the surfaces of two spheres for single precision, as a share of the scene's extent: if
/// they are nearer everywhere, rounding decides which is seen, or whether one shadows the other.
const MIN_GAP_PER_EXTENT: f64 = 3e-4;
/// The same as a share of their radii, for small spheres.
const MIN_GAP_PER_RADIUS: f64 = 1e-2;
/// Least distance between flat pieces for single precision, as a share of the scene's extent: from afar, both would
/// be at the same distance, and the first one would be seen.
const MIN_GAP_OF_PIECES: f64 = 1e-6;
/// Maximum number of pieces that are compared with each other.
const MAX_PIECES: usize = 64;
/// Maximum number of spheres that are compared with each other.
const MAX_SPHERES: usize = 2_000;

/// Returns whether a point is almost on a curved surface.
pub fn is_almost_on(shape: &Shape, point: DVec3) -> bool {
    shape.height_per_radius(point) < MIN_HEIGHT_PER_RADIUS
}

/// Returns whether the eye is almost on a plane, or a light almost on anything: on a curved surface, the light's
/// shadow ends where rays graze.
pub fn is_just_above(scene: &Scene, extent: f64) -> bool {
    let is_just_above = |piece: &PlanePiece, point: DVec3, least: f64| {
        let height = piece.height(point).abs();
        height > 0.0 && height < least * extent
    };
    let lights = || checked_lights(scene);
    let has_lights = lights().next().is_some();
    let has_few_faces = scene.faces() * lights().count() <= MAX_FACES;
    let visible = scene.visible_objects();
    let shapes = visible.map(|object| &object.shape);
    // Without lights only planes matter; the many other objects are skipped.
    let mut relevant = shapes.filter(|shape| has_lights || matches!(shape, Shape::Plane(_)));
    relevant.any(|shape| {
        if let Shape::Mesh(mesh) = shape {
            let least = MIN_HEIGHT_PER_EXTENT * extent;
            let bounds = shape.bounds();
            let is_in_box = |point| bounds.is_some_and(|bounds| is_near_box(point, bounds, least));
            let close_to_face = |light: &Light| {
                is_in_box(light.position) && is_close_to_face(mesh, light.position, least)
            };
            return has_few_faces && lights().any(close_to_face);
        }
        let Some(piece) = shape.plane_piece() else {
            return lights().any(|light| is_almost_on(shape, light.position));
        };
        let least = if piece.outline == Outline::Endless {
            MIN_HEIGHT_PER_EXTENT
        } else {
            MIN_HEIGHT_OVER_PIECE
        };
        is_just_above(&piece, scene.camera.position, least)
            || lights().any(|light| is_just_above(&piece, light.position, MIN_HEIGHT_PER_EXTENT))
    })
}

/// Returns whether a point is nearer than `least` to a face of a mesh, and not in its plane.
fn is_close_to_face(mesh: &Mesh, point: DVec3, least: f64) -> bool {
    let is_near = |&[a, b, c]: &[DVec3; 3]| {
        let bounds = Triangle { a, b, c }.bounds();
        bounds.is_some_and(|bounds| is_near_box(point, bounds, least))
    };
    let mut near = mesh.world_corners().filter(is_near);
    near.any(|corners| {
        let piece = PlanePiece::between(corners);
        let height = piece.map_or(f64::INFINITY, |piece| piece.height(point).abs());
        0.0 < height && height < least
    })
}

/// Returns whether a point is in a box, or at most `least` outside of it along any axis.
fn is_near_box(point: DVec3, (low, high): (DVec3, DVec3), least: f64) -> bool {
    (low - least).cmple(point).all() && (high + least).cmpge(point).all()
}

/// The lights to check: all of them, or none if there are very many.
fn checked_lights(scene: &Scene) -> impl Iterator<Item = &Light> {
    let pairs = scene.objects.len() * scene.lights.len();
    let are_few = pairs <= MAX_PAIRS;
    scene.visible_lights().filter(move |_| are_few)
}

/// The visible endless planes.
pub fn visible_planes(scene: &Scene) -> impl Iterator<Item = PlanePiece> {
    let visible = scene.visible_objects();
    visible.filter_map(|object| object.shape.endless_plane())
}

/// The visible flat objects.
fn visible_pieces(scene: &Scene) -> impl Iterator<Item = PlanePiece> {
    let visible = scene.visible_objects();
    visible.filter_map(|object| object.shape.plane_piece())
}

/// Returns whether the eye, if rays start from a point, or a light is almost on the border of something flat, in a
/// scene of this size.
pub fn is_at_border(scene: &Scene, eye: Option<DVec3>, size: f64) -> bool {
    let least = MIN_DISTANCE_OF_BORDER * size;
    visible_pieces(scene).any(|piece| {
        let is_near = |point: DVec3| piece.distance_of_border(point) < least;
        eye.is_some_and(is_near) || checked_lights(scene).any(|light| is_near(light.position))
    })
}

/// Returns whether two flat pieces are a tiny distance apart. Those that coincide are ordered by ties.
pub fn has_layers(scene: &Scene, centre: DVec3, extent: f64) -> bool {
    let pieces: Vec<_> = visible_pieces(scene).take(MAX_PIECES).collect();
    pieces.iter().enumerate().any(|(index, piece)| {
        let mut others = pieces[index + 1..].iter();
        others.any(|other| {
            piece.is_layered_with(other, MIN_GAP_OF_PIECES * extent)
                && !piece.coincides(other, centre)
        })
    })
}

/// Returns whether two spheres almost fill the same surface. Those that do fill it count as one.
pub fn has_twins(scene: &Scene, extent: f64) -> bool {
    let visible = scene.visible_objects();
    let spheres = visible.filter_map(|object| match &object.shape {
        Shape::Sphere(sphere) => Some((sphere.along(), sphere)),
        _ => None,
    });
    let mut spheres: Vec<_> = spheres.take(MAX_SPHERES + 1).collect();
    if spheres.len() > MAX_SPHERES {
        return false;
    }
    spheres.sort_unstable_by(|one, other| one.0.total_cmp(&other.0));
    let nearest = MIN_GAP_PER_EXTENT * extent;
    spheres.iter().enumerate().any(|(index, (along, one))| {
        let least = nearest.min(MIN_GAP_PER_RADIUS * one.radius);
        let others = spheres[index + 1..].iter();
        let near = others.take_while(|(other, _)| other - along < least);
        let mut others = near.map(|(_, other)| other);
        others.any(|other| one.gap(other) < least && !one.is_same(other))
    })
}
