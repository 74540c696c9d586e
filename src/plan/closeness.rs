//! What the eye, lights, balls or flat pieces all but touch, where the digits of single precision are lost.

use glam::DVec3;

use crate::scene::{Light, Mesh, Outline, PlanePiece, Scene, Shape, Triangle};

/// Smallest height of the eye or a light over a sphere, in radii, in single precision: below it, the
/// distance to the ground right ahead has lost its digits.
const MIN_HEIGHT_PER_RADIUS: f64 = 1e-3;

/// Smallest height of the eye over a plane, or of a light over anything flat, as a share of the scene's
/// extent, in single precision: below it, rounding may put it on the other side.
const MIN_HEIGHT_PER_EXTENT: f64 = 1e-5;
/// The same of the eye over a disc or a triangle, which is narrow where it matters.
const MIN_HEIGHT_OVER_PIECE: f64 = 1e-7;
/// Smallest distance of the eye or a light from the border of a piece, as a share of what ends of a scene, in single
/// precision where nothing is filtered: rounding turns the line to the border by 1/5000 there. Of random triangles and
/// discs, some at a third of it are off by up to 28 pixels of 40,000; none at three times as much.
const MIN_DISTANCE_OF_BORDER: f64 = 3e-4;
/// Most pairs of an object and a light that are looked at.
const MOST_PAIRS: usize = 100_000;

/// Most faces of meshes that are held against each light, in all: a millisecond.
const MOST_FACES: usize = 20_000;

/// Smallest distance of the surfaces of two spheres as a share of the scene's extent in single precision: where
/// they are nearer everywhere, rounding decides which is seen, or whether one shadows the other.
const MIN_GAP_PER_EXTENT: f64 = 3e-4;
/// The same as a share of their radii, for small ones.
const MIN_GAP_PER_RADIUS: f64 = 1e-2;
/// Smallest distance of flat pieces as a share of the scene's extent in single precision: from afar, both are at one
/// distance otherwise, and the first is seen.
const MIN_GAP_OF_PIECES: f64 = 1e-6;
/// Most pieces that are held against each other.
const MOST_PIECES: usize = 64;
/// Most spheres that are held against each other.
const MOST_SPHERES: usize = 2_000;

/// Whether a point is all but on something round.
pub fn is_low(shape: &Shape, point: DVec3) -> bool {
    shape.height_per_radius(point) < MIN_HEIGHT_PER_RADIUS
}

/// Whether the eye is all but on a plane, or a light on anything: on something round, its shadow ends where
/// rays graze.
pub fn is_just_above(scene: &Scene, extent: f64) -> bool {
    let is_just_above = |piece: &PlanePiece, point: DVec3, least: f64| {
        let height = piece.height(point).abs();
        height > 0.0 && height < least * extent
    };
    let lights = || near_lights(scene);
    let has_lights = lights().next().is_some();
    let has_few_faces = scene.faces() * lights().count() <= MOST_FACES;
    let visible = scene.visible_objects();
    let shapes = visible.map(|object| &object.shape);
    // Without lights only planes count: many objects are not worth a closer look.
    let mut looked_at = shapes.filter(|shape| has_lights || matches!(shape, Shape::Plane(_)));
    looked_at.any(|shape| {
        if let Shape::Mesh(mesh) = shape {
            let least = MIN_HEIGHT_PER_EXTENT * extent;
            let bounds = shape.bounds();
            let is_in_box = |point| bounds.is_some_and(|bounds| is_near_box(point, bounds, least));
            let by_face = |light: &Light| {
                is_in_box(light.position) && is_by_face(mesh, light.position, least)
            };
            return has_few_faces && lights().any(by_face);
        }
        let Some(piece) = shape.plane_piece() else {
            return lights().any(|light| is_low(shape, light.position));
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

/// Whether a point is nearer than this to a face of a mesh, and not in its plane.
fn is_by_face(mesh: &Mesh, point: DVec3, least: f64) -> bool {
    let is_near = |&[a, b, c]: &[DVec3; 3]| {
        let bounds = Shape::from(Triangle { a, b, c }).bounds();
        bounds.is_some_and(|bounds| is_near_box(point, bounds, least))
    };
    let mut near = mesh.world_corners().filter(is_near);
    near.any(|corners| {
        let piece = PlanePiece::between(corners);
        let height = piece.map_or(f64::INFINITY, |piece| piece.height(point).abs());
        0.0 < height && height < least
    })
}

/// Whether a point is in a box, or no farther beside it than this along any axis.
fn is_near_box(point: DVec3, (low, high): (DVec3, DVec3), least: f64) -> bool {
    (low - least).cmple(point).all() && (high + least).cmpge(point).all()
}

/// The lights that are looked at: all, or none of very many.
fn near_lights(scene: &Scene) -> impl Iterator<Item = &Light> {
    let pairs = scene.objects.len() * scene.lights.len();
    let are_few = pairs <= MOST_PAIRS;
    scene.visible_lights().filter(move |_| are_few)
}

/// Whether an eye, if there is one in a place, or a light is all but on the border of something flat of a scene of this
/// size.
pub fn is_at_border(scene: &Scene, eye: Option<DVec3>, size: f64) -> bool {
    let least = MIN_DISTANCE_OF_BORDER * size;
    let visible = scene.visible_objects();
    let mut pieces = visible.filter_map(|object| object.shape.plane_piece());
    pieces.any(|piece| {
        let is_near = |point: DVec3| piece.distance_of_border(point) < least;
        eye.is_some_and(is_near) || near_lights(scene).any(|light| is_near(light.position))
    })
}

/// Whether two flat pieces are a hair apart. Those that are not apart have an order.
pub fn has_layers(scene: &Scene, (centre, extent): (DVec3, f64)) -> bool {
    let visible = scene.visible_objects();
    let pieces = visible.filter_map(|object| object.shape.plane_piece());
    let pieces: Vec<_> = pieces.take(MOST_PIECES).collect();
    pieces.iter().enumerate().any(|(index, piece)| {
        let mut others = pieces[index + 1..].iter();
        others.any(|other| {
            piece.is_beside(other, MIN_GAP_OF_PIECES * extent) && !piece.coincides(other, centre)
        })
    })
}

/// Whether two spheres all but fill the same surface. Those that do fill it are one.
pub fn has_twins(scene: &Scene, extent: f64) -> bool {
    let visible = scene.visible_objects();
    let spheres = visible.filter_map(|object| match &object.shape {
        Shape::Sphere(sphere) => Some((sphere.along(), sphere)),
        _ => None,
    });
    let mut spheres: Vec<_> = spheres.take(MOST_SPHERES + 1).collect();
    if spheres.len() > MOST_SPHERES {
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
