//! Puts things down on what is below them.

use std::collections::HashMap;

use glam::DVec3;
use indexmap::IndexMap;

use crate::editor::{Edit, ItemKind, Selection};
use crate::lab::intersect_shape;
use crate::scene::{Scene, Shape, around, unit};

/// Number of vertical lines along each side of a thing that probe what is below it.
const LINES_PER_SIDE: usize = 5;
/// Most tests of shapes and faces with such lines: they take a tenth of a second.
const MAX_TESTS: usize = 20_000_000;
/// Gap up to which a thing counts as standing on what is below it, relative to the coordinates.
const STANDING_TOLERANCE: f64 = 1e-9;
/// Height of a flat thing above what is below it, as a share of its size: in the same surface, it might be invisible.
const FLAT_GAP: f64 = 1e-3;
/// Distance from a thing at which lines towards it begin, relative to the coordinates.
const START_OFFSET: f64 = 1e-6;

/// A vertical line through a thing: its position, and the thing's lowest and highest point on it.
struct VerticalLine {
    x: f64,
    z: f64,
    low: f64,
    high: f64,
}

/// Puts each selected object, and each group that is selected as a whole, down on what is below it. Things that have
/// sunk in are lifted.
///
/// # Errors
/// The reason why nothing moves, in words.
pub fn put_down(scene: &Scene, selected: &Selection) -> Result<Edit, &'static str> {
    let mut bodies = bodies(scene, selected);
    let shape = |index: &usize| &scene.objects[*index].shape;
    bodies.retain(|body| {
        body.iter()
            .all(|index| shape(index).endless_plane().is_none())
    });
    if bodies.is_empty() {
        return Err("Infinite objects, such as planes, cannot be put down");
    }
    // A mesh whose file is missing has no faces.
    bodies.retain(|body| body.iter().any(|index| shape(index).bounds().is_some()));
    if bodies.is_empty() {
        return Err("There is nothing to put down: it has no faces");
    }
    let work = bodies.len() * (scene.objects.len() + scene.faces());
    if work > MAX_TESTS {
        return Err("There are too many objects and faces to put this down at once");
    }
    let lines = if work * LINES_PER_SIDE * LINES_PER_SIDE > MAX_TESTS {
        0
    } else {
        LINES_PER_SIDE
    };
    // In ascending order, so that things that stand on others come down with them.
    let low = |body: &Vec<usize>| bounds(scene, body).0.y;
    bodies.sort_by(|one, other| low(one).total_cmp(&low(other)));
    let (mut scene, mut edits) = (scene.clone(), Vec::new());
    let mut has_ground = false;
    for body in bodies {
        let Some(gap) = gap_below(&scene, &body, lines) else {
            continue;
        };
        has_ground = true;
        if gap == 0.0 {
            continue;
        }
        for index in body {
            let mut object = scene.objects[index].clone();
            object.shape = object.shape.moved(DVec3::NEG_Y * gap);
            scene.objects[index] = object.clone();
            edits.push(Edit::object(index, object, "position"));
        }
    }
    let label = match edits.len() {
        0 if has_ground => return Err("It already stands on something"),
        0 => return Err("Nothing is below it"),
        1 => "Put down".to_owned(),
        count => format!("Put down {count} items"),
    };
    Ok(Edit::Each(edits, label))
}

/// Returns the selected objects that move together, as ascending indices: the members of whole groups together, and
/// other objects one by one.
fn bodies(scene: &Scene, selected: &Selection) -> Vec<Vec<usize>> {
    let mut members: HashMap<&str, usize> = HashMap::new();
    for object in &scene.objects {
        *members.entry(&object.group).or_default() += 1;
    }
    let mut bodies = Vec::new();
    let mut groups: IndexMap<&str, Vec<usize>> = IndexMap::new();
    for index in selected.indices(ItemKind::Object) {
        match scene.objects[index].group.as_str() {
            "" => bodies.push(vec![index]),
            group => groups.entry(group).or_default().push(index),
        }
    }
    for (group, indices) in groups {
        if members.get(group) == Some(&indices.len()) {
            bodies.push(indices);
        } else {
            bodies.extend(indices.into_iter().map(|index| vec![index]));
        }
    }
    bodies
}

/// Returns the height of these objects above what is below them: 0 if they stand there; `None` if nothing is below.
fn gap_below(scene: &Scene, body: &[usize], lines: usize) -> Option<f64> {
    let gaps = lines_through(scene, body, lines).into_iter();
    let gaps = gaps.filter_map(|line| Some(line.low - ground_below(scene, body, &line)?));
    let gap = gaps.reduce(f64::min)?;
    let (low, high) = bounds(scene, body);
    let size = low.abs().max(high.abs()).max_element();
    let is_flat = high.y - low.y <= STANDING_TOLERANCE * (1.0 + size);
    let gap = if is_flat {
        gap - FLAT_GAP * (high - low).max_element()
    } else {
        gap
    };
    let is_standing = gap.abs() <= STANDING_TOLERANCE * (1.0 + size);
    Some(if is_standing { 0.0 } else { gap })
}

/// Returns lines through these objects: `lines` along each side, and the one through their lowest point.
fn lines_through(scene: &Scene, body: &[usize], lines: usize) -> Vec<VerticalLine> {
    let (low, high) = bounds(scene, body);
    let shapes = || body.iter().map(|&index| &scene.objects[index].shape);
    let top = |x: f64, z: f64| {
        let heights = shapes().filter_map(|shape| surface_below(shape, DVec3::new(x, high.y, z)));
        heights.reduce(f64::max)
    };
    let share = |line: usize| (line as f64 + 0.5) / lines as f64;
    let grid = (0..lines).flat_map(|x| (0..lines).map(move |z| (share(x), share(z))));
    let mut found: Vec<VerticalLine> = grid
        .filter_map(|(x, z)| {
            let point = low + (high - low) * DVec3::new(x, 0.0, z);
            let heights = shapes().filter_map(|shape| surface_above(shape, point));
            Some(VerticalLine {
                x: point.x,
                z: point.z,
                low: heights.reduce(f64::min)?,
                high: top(point.x, point.z)?,
            })
        })
        .collect();
    let points = shapes().filter_map(lowest_point);
    found.extend(
        points
            .min_by(|a, b| a.y.total_cmp(&b.y))
            .map(|point| VerticalLine {
                x: point.x,
                z: point.z,
                low: point.y,
                high: top(point.x, point.z).unwrap_or(high.y),
            }),
    );
    found
}

/// Returns the height of the highest surface on a line, below the top of these objects, that they could stand on.
fn ground_below(scene: &Scene, body: &[usize], line: &VerticalLine) -> Option<f64> {
    let from = DVec3::new(line.x, line.high, line.z);
    let others = scene.objects.iter().enumerate();
    // Binary search: `body` is ascending, and a group may have thousands of objects.
    let others =
        others.filter(|(index, other)| other.visible && body.binary_search(index).is_err());
    let heights = others.filter_map(|(_, other)| {
        let is_outside = other.shape.bounds().is_some_and(|(low, high)| {
            line.x < low.x || line.x > high.x || line.z < low.z || line.z > high.z
        });
        (!is_outside).then(|| surface_below(&other.shape, from))?
    });
    heights.reduce(f64::max)
}

/// Returns the height at which a shape is met below `from`; `None` if that is inside a ball.
fn surface_below(shape: &Shape, from: DVec3) -> Option<f64> {
    let from = from + DVec3::Y * start_offset(from);
    let (t, normal) = intersect_shape(shape, from, DVec3::NEG_Y)?;
    let is_inside = matches!(shape, Shape::Sphere(_)) && normal.y < 0.0;
    (!is_inside).then_some(from.y - t)
}

/// Returns the height at which a shape is met above `from`.
fn surface_above(shape: &Shape, from: DVec3) -> Option<f64> {
    let from = from - DVec3::Y * start_offset(from);
    Some(from.y + intersect_shape(shape, from, DVec3::Y)?.0)
}

fn start_offset(from: DVec3) -> f64 {
    START_OFFSET * (1.0 + from.abs().max_element())
}

/// Returns the bounding box of objects that are not endless.
fn bounds(scene: &Scene, body: &[usize]) -> (DVec3, DVec3) {
    let bounds = body
        .iter()
        .filter_map(|&index| scene.objects[index].shape.bounds());
    around(bounds).unwrap_or_default()
}

/// Returns the lowest point of a shape; `None` for planes.
fn lowest_point(shape: &Shape) -> Option<DVec3> {
    match shape {
        Shape::Plane(_) => None,
        Shape::Sphere(ball) => Some(ball.center - DVec3::Y * ball.radius),
        Shape::Disc(disc) => {
            let normal = unit(disc.normal).unwrap_or_default();
            let down = unit(normal * normal.y - DVec3::Y).unwrap_or_default();
            Some(disc.center + down * disc.radius)
        }
        Shape::Triangle(triangle) => lowest(triangle.corners().into_iter()),
        Shape::Mesh(mesh) => lowest(mesh.world_corners().flatten()),
    }
}

fn lowest(points: impl Iterator<Item = DVec3>) -> Option<DVec3> {
    points.min_by(|a, b| a.y.total_cmp(&b.y))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::editor::Item;
    use crate::mesh::{SOLIDS, Triangles};
    use crate::scene::{Disc, Mesh, Object, Plane, Sphere};

    /// Makes a scene of these shapes above the ground.
    fn scene(shapes: Vec<Shape>) -> Scene {
        let mut scene = Scene::empty();
        let ground = Plane {
            point: DVec3::ZERO,
            normal: DVec3::Y,
        };
        for (number, shape) in shapes.into_iter().chain([ground.into()]).enumerate() {
            let object = Object::new(format!("Thing {number}"), "pack 1", shape);
            scene.objects.push(object);
        }
        scene
    }

    fn ball(x: f64, y: f64, radius: f64) -> Shape {
        let center = DVec3::new(x, y, 0.0);
        Sphere { center, radius }.into()
    }

    fn put(scene: &mut Scene, places: &[usize]) -> bool {
        let selected = Selection::all(places.iter().copied().map(Item::object));
        let Ok(edit) = put_down(scene, &selected) else {
            return false;
        };
        edit.apply(scene).expect("a step");
        true
    }

    fn low(scene: &Scene, index: usize) -> f64 {
        lowest_point(&scene.objects[index].shape)
            .expect("it ends")
            .y
    }

    #[test]
    fn things_come_down_to_the_floor_and_up_from_below_it() {
        for height in [40.0, -3.0] {
            let mut scene = scene(vec![ball(3.0, height, 5.0)]);
            assert!(put(&mut scene, &[0]));
            assert!(low(&scene, 0).abs() < 1e-9);
            assert!(!put(&mut scene, &[0]), "it stands there");
        }
    }

    #[test]
    fn what_is_turned_stands_on_its_corner() {
        for solid in SOLIDS {
            let mesh = Mesh {
                position: DVec3::new(7.0, 90.0, -4.0),
                rotation: DVec3::new(20.0, 30.0, 40.0),
                ..Mesh::of((solid.make)(10.0))
            };
            let mut scene = scene(vec![mesh.into()]);
            assert!(put(&mut scene, &[0]));
            assert!(low(&scene, 0).abs() < 1e-9, "{}", solid.name);
        }
    }

    #[test]
    fn a_stack_comes_down_as_a_stack_and_a_group_as_one() {
        let mut scene = scene(vec![ball(0.0, 60.0, 5.0), ball(0.0, 30.0, 5.0)]);
        let mut group = scene.clone();
        assert!(put(&mut scene, &[0, 1]));
        assert!(low(&scene, 1).abs() < 1e-9);
        assert!((low(&scene, 0) - 10.0).abs() < 1e-9);
        for index in [0, 1] {
            group.objects[index].group = "both".to_owned();
        }
        let above = Object {
            shape: ball(100.0, 7.0, 1.0),
            ..group.objects[2].clone()
        };
        group.objects.push(above);
        // The group also moves as one if another object is selected too.
        for places in [&[0, 1][..], &[0, 1, 3]] {
            let mut group = group.clone();
            assert!(put(&mut group, places));
            assert!(low(&group, 1).abs() < 1e-9);
            assert!((low(&group, 0) - 30.0).abs() < 1e-9);
        }
        assert!(put(&mut group, &[0, 3]), "a part of it is by itself");
        assert!((low(&group, 0) - 35.0).abs() < 1e-9);
    }

    #[test]
    fn what_is_flat_lies_a_little_over_what_is_below_and_stays_there() {
        let table = Mesh {
            position: DVec3::Y * 5.0,
            ..Mesh::of((SOLIDS[0].make)(10.0))
        };
        let disc = Disc {
            center: DVec3::Y * 30.0,
            normal: DVec3::Y,
            radius: 2.0,
        };
        let mut scene = scene(vec![table.into(), disc.into()]);
        assert!(put(&mut scene, &[1]));
        let height = low(&scene, 1) - 10.0;
        assert!((height - 4e-3).abs() < 1e-6, "{height}");
        assert!(!put(&mut scene, &[1]));
    }

    #[test]
    fn what_stands_beside_holds_nothing_up() {
        // The small ball is below a corner of the large one's bounding box, but not below the large one.
        let mut scene = scene(vec![ball(0.0, 50.0, 50.0), ball(46.0, 5.0, 5.0)]);
        let Shape::Sphere(small) = &mut scene.objects[1].shape else {
            panic!("a ball");
        };
        small.center.z = 46.0;
        assert!(!put(&mut scene, &[0]));
    }

    #[test]
    fn what_has_nothing_below_stays_and_so_does_what_never_ends() {
        let mut scene = scene(vec![ball(0.0, 9.0, 1.0)]);
        assert!(!put(&mut scene, &[1]), "the ground");
        let why = |scene: &Scene| {
            let selected = Selection::from(Item::object(0));
            put_down(scene, &selected).err()
        };
        assert!(put(&mut scene, &[0]));
        let mut missing = scene.clone();
        missing.objects[0].shape = Mesh::of(Triangles::default()).into();
        assert_eq!(
            why(&missing),
            Some("There is nothing to put down: it has no faces")
        );
        assert_eq!(why(&scene), Some("It already stands on something"));
        scene.objects.remove(1);
        assert_eq!(why(&scene), Some("Nothing is below it"));
        let before = scene.clone();
        assert!(!put(&mut scene, &[0]));
        assert_eq!(scene, before);
    }
}
