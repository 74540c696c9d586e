//! The things that can be added to a scene, offered in the menu *Add* and in the finder.

use egui::{Button, Ui};
use egui_material_icons::MaterialIcon;
use glam::DVec3;

use super::icons;
use super::requests::UiRequests;
use crate::editor::Edit;
use crate::lab::first_hit;
use crate::mesh::SOLIDS;
use crate::scene::{Mesh, Object, Projection, Scene, Shape};

/// Something that can be added.
#[derive(Clone, Copy, Debug)]
pub enum Addition {
    /// The shape at this index of [`Shape::examples`].
    Shape(usize),
    /// The mesh at this index of [`SOLIDS`].
    Solid(usize),
    /// A light.
    Light,
    /// A color pack.
    Pack,
}

impl Addition {
    /// Returns the edit that adds it, in front of what the camera sees.
    pub fn edit(self, scene: &Scene) -> Edit {
        let (at, size) = in_front_of_camera(scene);
        match self {
            Self::Shape(index) => {
                let shape = Shape::examples(at, size).swap_remove(index);
                let low = scene.objects_bounds().map(|(low, _)| low.y);
                let ground = || ground_distance(scene).map(|_| 0.0);
                // In the plane of another one it would not be seen; far above it, it would hide what stands there.
                let plane_offset = size * PLANE_STEP * visible_planes(scene).count() as f64;
                let floor = low.or_else(ground).map(|floor| floor + plane_offset);
                match (&shape, floor) {
                    // Existing objects end up standing on the new plane; without any, it is the ground.
                    (Shape::Plane(_), Some(floor)) => {
                        let down = DVec3::Y * (floor - shape.position().y);
                        Edit::AddObject(shape.kind(), shape.moved(down))
                    }
                    _ => Edit::AddObject(shape.kind(), stand_on_floor(scene, shape, size)),
                }
            }
            Self::Solid(index) => {
                let solid = SOLIDS[index];
                let mesh = Mesh {
                    position: at,
                    smooth: solid.smooth,
                    ..Mesh::of((solid.make)(size))
                };
                Edit::AddObject(solid.name, stand_on_floor(scene, mesh.into(), size))
            }
            Self::Light => Edit::AddLight(light_position(scene, at, size)),
            Self::Pack => Edit::AddPack,
        }
    }

    /// Yields all additions, with their icons and names.
    pub fn all() -> impl Iterator<Item = (Self, MaterialIcon, String)> {
        let shapes = Shape::examples(DVec3::ZERO, 1.0).into_iter().enumerate();
        // Meshes are offered by the names of their solids.
        let shapes = shapes.filter(|(_, shape)| !matches!(shape, Shape::Mesh(_)));
        let shapes = shapes.map(|(index, shape)| {
            let name = format!("Add {}", shape.kind());
            (Self::Shape(index), icons::of_shape(&shape), name)
        });
        let solids = SOLIDS.iter().enumerate();
        let solids = solids.map(|(index, solid)| {
            (
                Self::Solid(index),
                icons::MESH,
                format!("Add {}", solid.name),
            )
        });
        let others = [
            (Self::Light, icons::LIGHT, "Add Light".to_owned()),
            (Self::Pack, icons::PACK, "Add ColorPack".to_owned()),
        ];
        shapes.chain(solids).chain(others)
    }
}

/// Shows the entries of the menu *Add*.
pub fn add_menu(ui: &mut Ui, scene: &Scene, out: &mut UiRequests) {
    for (addition, icon, name) in Addition::all() {
        let button = ui.add(Button::new((icons::text(icon), &name)));
        if button.accessible_name(name).clicked() {
            out.edit(addition.edit(scene));
        }
    }
}

/// Height of a new thing, as a share of the picture's height.
const HEIGHT_SHARE: f64 = 0.2;
/// Distance by which a new plane is raised for each existing plane, in sizes of a new thing.
const PLANE_STEP: f64 = 0.1;
/// Distance between neighbouring candidate places, in sizes of a new thing.
const SPACING: f64 = 1.3;
/// Number of faces and objects above which only one place is tried.
const SEARCH_LIMIT: usize = 100_000;
/// Number of places tried in less crowded scenes: enough for all of them in most pictures.
const MAX_TRIES: usize = 192;
/// Factor on the size of a thing for which no place is free at full size, as the last resort.
const REDUCED_SCALE: f64 = 0.5;
/// Number of steps tried to each side of the middle.
const MAX_STEPS: u32 = 8;
/// Least distance of a new thing's middle from the bounding boxes of existing objects, in its sizes.
const CLEARANCE: f64 = 0.65;
/// Factor by which a thing on a near floor may look larger than one at the usual distance.
const MAX_FLOOR_SCALE: f64 = 1.6;
/// Greatest distance of a floor that a new thing is put on, in units of the usual distance.
const MAX_FLOOR_DISTANCE: f64 = 2.0;
/// Least vertical component of a floor's unit normal: things do not stand on walls.
const MIN_FLOOR_NORMAL_Y: f64 = 0.7;
/// Greatest distance of the ground for a first floor to be put there, in world units.
const MAX_GROUND_DISTANCE: f64 = 2_000.0;
/// Objects nearer to the eye than this, in units of the usual distance, do not push a new thing nearer.
const MIN_HIT_DISTANCE: f64 = 0.1;
/// Smallest size of a new thing, in world units.
const MIN_SIZE: f64 = 1e-6;

/// Finds the place and the size of a new thing: a fifth of the picture's height, as far away as the scene is, on the
/// floor if one is seen there, and beside existing objects; in front of them if there is no room.
fn in_front_of_camera(scene: &Scene) -> (DVec3, f64) {
    let camera = &scene.camera;
    let Some(framing) = camera.framing() else {
        return (camera.position, MIN_SIZE);
    };
    let usual = usual_distance(scene);
    let half = scene.render.aspect_ratio() / 2.0;
    let is_inside =
        |place: f64, half: f64| place.abs() + HEIGHT_SHARE / 2.0 <= half.max(HEIGHT_SHARE / 2.0);
    // Above the middle of the picture, a thing would hang in the air over the floor.
    let has_floor = visible_planes(scene).next().is_some();
    // First a coarse grid of places, then a finer one, then the finer one with smaller things.
    let rounds = [(1.0, 1.0), (0.5, 1.0), (0.5, REDUCED_SCALE)];
    let places = rounds.into_iter().flat_map(|(part, scale)| {
        let step = HEIGHT_SHARE * SPACING * part;
        let down =
            alternating_steps(step).filter(move |&y| is_inside(y, 0.5) && !(has_floor && y < 0.0));
        down.flat_map(move |y| {
            let across = alternating_steps(step).filter(move |&x| is_inside(x, half));
            across.map(move |x| ([x, -y], scale))
        })
    });
    // Each try costs as much as the scene has objects and faces.
    let tries = if scene.faces() + scene.objects.len() > SEARCH_LIMIT {
        1
    } else {
        MAX_TRIES
    };
    let mut free = places
        .take(tries)
        .filter_map(|(place, scale)| free_place(scene, framing.ray(place), (usual, scale)));
    let (at, size) = free
        .next()
        .unwrap_or_else(|| place_in_front_of_hit(scene, framing.ray([0.0, 0.0]), usual));
    // Rounded where the thing is large enough: whole numbers read better in the inspector.
    if size > 10.0 {
        (at.round(), size.round())
    } else {
        (at, size.max(MIN_SIZE))
    }
}

/// Returns the place of a light that shines on `at` from above, no higher than the picture shows.
fn light_position(scene: &Scene, at: DVec3, size: f64) -> DVec3 {
    let framing = scene.camera.framing();
    let is_seen = |point: &DVec3| {
        let place = framing.as_ref().and_then(|framing| framing.project(*point));
        place.is_some_and(|[_, y]| y.abs() < 0.5 - HEIGHT_SHARE / 4.0)
    };
    let heights = [1.0, 0.75, 0.5, 0.25].map(|part| at + DVec3::Y * size * part);
    heights.into_iter().find(is_seen).unwrap_or(at)
}

/// Yields 0, 1, −1, 2, −2 and so on, times `step`, far enough for any picture.
fn alternating_steps(step: f64) -> impl Iterator<Item = f64> {
    let both_signs = |steps: u32| [f64::from(steps), -f64::from(steps)];
    let steps = std::iter::once(0.0).chain((1..=MAX_STEPS).flat_map(both_signs));
    steps.map(move |steps| steps * step)
}

/// Stands a shape on a floor that is less than half its size below it, however flat it is. Discs, which would lie in
/// its surface, and planes stay where they are.
fn stand_on_floor(scene: &Scene, mut shape: Shape, size: f64) -> Shape {
    let pieces = visible_planes(scene).filter_map(|object| object.shape.plane_piece());
    for piece in pieces.filter(|piece| piece.normal.y.abs() > MIN_FLOOR_NORMAL_Y) {
        let up = piece.normal * piece.normal.y.signum();
        let height = |point: DVec3| up.dot(point - piece.point);
        let lowest = |points: &mut dyn Iterator<Item = DVec3>| {
            points.map(height).fold(f64::INFINITY, f64::min)
        };
        let gap = match &shape {
            Shape::Sphere(ball) => height(ball.center) - ball.radius,
            Shape::Triangle(triangle) => lowest(&mut triangle.corners().into_iter()),
            Shape::Mesh(mesh) => lowest(&mut mesh.world_corners().flatten()),
            Shape::Disc(_) | Shape::Plane(_) => continue,
        };
        // Rounding may have put it slightly below the floor.
        if (-size / 10.0..size / 2.0).contains(&gap) {
            shape = shape.moved(-up * gap);
        }
    }
    shape
}

/// Yields the visible planes of a scene.
fn visible_planes(scene: &Scene) -> impl Iterator<Item = &Object> {
    let is_plane = |object: &&Object| object.visible && matches!(object.shape, Shape::Plane(_));
    scene.objects.iter().filter(is_plane)
}

/// Returns the distance of the ground, y = 0, in the middle of the picture; `None` if it is not seen or very far.
fn ground_distance(scene: &Scene) -> Option<f64> {
    let (origin, direction) = scene.camera.framing()?.ray([0.0, 0.0]);
    let distance = -origin.y / direction.y;
    (0.0 < distance && distance < MAX_GROUND_DISTANCE).then_some(distance)
}

/// Returns the distance at which new things usually go: that of the scene's middle or, if the eye is within the scene,
/// half its extent. In a scene of nothing but floors, it is the distance of the floor.
fn usual_distance(scene: &Scene) -> f64 {
    let camera = &scene.camera;
    let Some((low, high)) = scene.objects_bounds() else {
        let has_floor = visible_planes(scene).next().is_some();
        let ahead = camera.framing().filter(|_| has_floor).map(|framing| {
            let (origin, direction) = framing.ray([0.0, 0.0]);
            first_hit(scene, origin, direction)
        });
        return match ahead.flatten() {
            Some((_, distance)) => distance.min(MAX_GROUND_DISTANCE),
            None => 100.0,
        };
    };
    let (radius, middle) = ((high - low).length() / 2.0, (low + high) / 2.0);
    let ahead = (middle - camera.position).dot(camera.forward());
    if ahead > radius { ahead } else { radius }
}

/// Returns the world size, at a distance, of a fifth of the picture's height.
fn size_at(scene: &Scene, distance: f64) -> f64 {
    let camera = &scene.camera;
    HEIGHT_SHARE
        * match camera.projection {
            Projection::Perspective => distance / camera.projection_distance,
            Projection::Orthographic => camera.orthographic_height,
        }
}

/// Returns the place along a ray and the size there, times `scale`, if nothing is in the way.
fn free_place(
    scene: &Scene,
    ray: (DVec3, DVec3),
    (usual, scale): (f64, f64),
) -> Option<(DVec3, f64)> {
    let (origin, direction) = ray;
    let (mut at, mut size) = (origin + direction * usual, size_at(scene, usual) * scale);
    let mut is_on_floor = false;
    if let Some((hit_index, distance)) = first_hit(scene, origin, direction) {
        let is_floor = matches!(scene.objects[hit_index].shape, Shape::Plane(_));
        is_on_floor = is_floor && distance < usual * MAX_FLOOR_DISTANCE;
        if is_on_floor {
            size = size.min(size_at(scene, distance) * MAX_FLOOR_SCALE * scale);
            at = origin + direction * distance;
        } else if distance < usual + size {
            return None;
        }
    }
    let mut pieces = visible_planes(scene).filter_map(|object| object.shape.plane_piece());
    if !is_on_floor && pieces.any(|piece| piece.normal.y.abs() > MIN_FLOOR_NORMAL_Y) {
        return None; // It would hang in the air over the floor.
    }
    // Move it out of planes, so that it stands on them instead of being cut by them.
    for piece in visible_planes(scene).filter_map(|object| object.shape.plane_piece()) {
        let (height, eye) = (piece.height(at), piece.height(origin));
        if height.abs() < size / 2.0 {
            at += piece.normal * (size / 2.0 * eye.signum() - height);
        }
    }
    let is_in_the_way =
        |(low, high): (DVec3, DVec3)| (at.clamp(low, high) - at).length() < size * CLEARANCE;
    let visible = scene.visible_objects();
    let mut bounds = visible.filter_map(|object| object.shape.bounds());
    (!bounds.any(is_in_the_way)).then_some((at, size))
}

/// Returns the place in front of what a ray hits, however near that is, and the size there.
fn place_in_front_of_hit(scene: &Scene, ray: (DVec3, DVec3), usual: f64) -> (DVec3, f64) {
    let (origin, direction) = ray;
    // Things close to the eye fill the picture anyway.
    let hit_distance = match first_hit(scene, origin, direction) {
        Some((_, distance)) if distance > MIN_HIT_DISTANCE * usual => distance,
        _ => f64::INFINITY,
    };
    // Half the size must fit between the place and the hit; in perspective the size grows with distance.
    let distance = match scene.camera.projection {
        Projection::Perspective => usual.min(hit_distance / (1.0 + size_at(scene, 1.0) / 2.0)),
        Projection::Orthographic => usual.min(hit_distance - size_at(scene, hit_distance) / 2.0),
    };
    (origin + direction * distance, size_at(scene, distance))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_added_is_seen() {
        for projection in [Projection::Perspective, Projection::Orthographic] {
            let mut scene = Scene::demo();
            scene.camera.projection = projection;
            for (addition, _, name) in Addition::all() {
                let Edit::AddObject(_, Shape::Mesh(_)) = addition.edit(&scene) else {
                    continue;
                };
                let mut with = scene.clone();
                addition.edit(&scene).apply(&mut with).expect("added");
                let framing = with.camera.framing().expect("a basis");
                // A ray through the middle of a torus hits nothing.
                let grid = (-20..=20)
                    .flat_map(|y| (-20..=20).map(move |x| [x, y].map(|at| f64::from(at) / 40.0)));
                let mut grid = grid.map(|place| framing.ray(place));
                let seen = grid.any(|(origin, direction)| {
                    first_hit(&with, origin, direction).is_some_and(|(seen, _)| seen == 9)
                });
                assert!(seen, "{projection:?}: {name}");
            }
        }
    }

    /// Adds things by name and returns the bounding boxes of all objects.
    fn add_by_name(scene: &mut Scene, names: &[&str]) -> Vec<(DVec3, DVec3)> {
        for name in names {
            let (addition, ..) = Addition::all()
                .find(|(.., all)| all == name)
                .expect("there is");
            addition.edit(scene).apply(scene).expect("added");
        }
        let bounds = scene
            .objects
            .iter()
            .filter_map(|object| object.shape.bounds());
        bounds.collect()
    }

    #[test]
    fn every_solid_stands_on_the_floor_however_flat_it_is() {
        for solid in SOLIDS {
            let mut scene = Scene::empty();
            scene.objects.clear();
            add_by_name(&mut scene, &["Add Plane", &format!("Add {}", solid.name)]);
            let pack = &scene.color_packs[&scene.objects[0].color_pack];
            assert_eq!(pack.diffuse, DVec3::new(196.0, 192.0, 186.0), "grey");
            let floor = scene.objects[0].shape.plane_piece().expect("a floor");
            assert_eq!(floor.point.y, 0.0, "the ground");
            let Shape::Mesh(mesh) = &scene.objects[1].shape else {
                panic!("{}", solid.name);
            };
            let heights = mesh.world_corners().flatten();
            let low = heights.map(|corner| floor.height(corner));
            let low = low.fold(f64::INFINITY, f64::min);
            assert!(low.abs() < 1e-9, "{}: {low}", solid.name);
        }
    }

    #[test]
    fn what_is_added_to_the_demo_stands_on_its_floor_beside_what_is_there() {
        let mut scene = Scene::demo();
        let before = add_by_name(&mut scene, &[]).len();
        let bounds = add_by_name(&mut scene, &["Add Box", "Add Cylinder", "Add Torus"]);
        for (index, (low, high)) in bounds.iter().enumerate().skip(before) {
            assert!(low.y.abs() < 1.0, "{index} hangs at {low}");
            for (other_low, other_high) in &bounds[..index] {
                let apart = low.cmpgt(*other_high).any() || high.cmplt(*other_low).any();
                assert!(apart, "{index} in another");
            }
        }
    }

    #[test]
    fn a_second_floor_and_a_light_are_seen() {
        let mut scene = Scene::demo();
        add_by_name(&mut scene, &["Add Plane", "Add Light"]);
        let planes = visible_planes(&scene).filter_map(|object| object.shape.plane_piece());
        let heights: Vec<f64> = planes.map(|piece| piece.point.y).collect();
        assert!(
            heights.len() == 2 && (heights[1] - heights[0]).abs() > 1.0,
            "{heights:?}"
        );
        // The demo's camera looks down at a low angle, so what stands on the floor is high in the picture.
        let mut scene = Scene::demo();
        for _ in 0..6 {
            add_by_name(&mut scene, &["Add Light"]);
            let framing = scene.camera.framing().expect("a basis");
            let light = scene.lights.iter().last().expect("added").position;
            let [_, y] = framing.project(light).expect("before the eye");
            assert!(y.abs() < 0.5, "{light} is at {y}");
        }
    }

    #[test]
    fn a_still_life_stands_side_by_side_on_its_floor() {
        for floor_first in [true, false] {
            let mut scene = Scene::empty();
            scene.objects.clear();
            let mut names = vec!["Add Sphere", "Add Sphere", "Add Box", "Add Sphere"];
            names.insert(if floor_first { 0 } else { names.len() }, "Add Plane");
            let bounds = add_by_name(&mut scene, &names);
            assert_eq!(bounds.len(), 4);
            let floor = scene
                .objects
                .iter()
                .find_map(|object| object.shape.plane_piece());
            let floor = floor.expect("a floor");
            let sizes: Vec<f64> = bounds.iter().map(|(low, high)| (*high - *low).x).collect();
            for (index, (low, high)) in bounds.iter().enumerate() {
                let gap = floor.height(*low);
                // If the floor comes last, they stand where the eye looks.
                let is_on = gap.abs() < 1e-9 || (!floor_first && gap > -1.0);
                assert!(is_on, "{floor_first}: {index} stands {gap} above it");
                assert!((0.5..2.0).contains(&(sizes[index] / sizes[0])), "{sizes:?}");
                for (other_low, other_high) in &bounds[..index] {
                    let apart = low.cmpgt(*other_high).any() || high.cmplt(*other_low).any();
                    assert!(apart, "{floor_first}: {index} in another");
                }
            }
        }
    }
}
