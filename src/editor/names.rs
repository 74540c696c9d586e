//! Names and places of new things.

use std::collections::HashSet;

use glam::DVec3;

use crate::scene::{Bookmark, Names, Scene, Shape};

/// Most steps that are tried in search of a place for a copy.
const MAX_STEPS: u32 = 1_000;

/// Returns an unused object name: `wanted`, or that with a new number.
pub fn free_object_name(scene: &Scene, wanted: &str) -> String {
    let taken = scene.objects.iter().map(|object| &*object.name);
    Names::new(taken).take(wanted)
}

/// Returns an unused light name: `wanted`, or that with a new number.
pub fn free_light_name(scene: &Scene, wanted: &str) -> String {
    let taken = scene.lights.iter().map(|light| &*light.name);
    Names::new(taken).take(wanted)
}

/// Returns an unused color pack name: `wanted`, or that with a new number.
pub fn free_pack_name(scene: &Scene, wanted: &str) -> String {
    Names::new(scene.color_packs.keys().map(String::as_str)).take(wanted)
}

/// Returns an unused group name: `wanted`, or that with a new number.
pub fn free_group_name(scene: &Scene, wanted: &str) -> String {
    let taken = scene.objects.iter().map(|object| &*object.group);
    Names::new(taken).take(wanted)
}

/// Returns an unused bookmark name: `wanted`, or that with a new number.
pub fn free_bookmark_name(bookmarks: &[Bookmark], wanted: &str) -> String {
    let taken = bookmarks.iter().map(|bookmark| &*bookmark.name);
    Names::new(taken).take(wanted)
}

/// Returns the offset from a shape to its copy: two things in one place would shadow each other, as would two copies.
pub fn copy_offset(scene: &Scene, shape: &Shape) -> DVec3 {
    let new = [Spot::of(shape)];
    offset_to_free_place(scene, &new, (shape_copy_step(scene, shape), 1))
}

/// A place taken by a thing: others of its kind in the same place would shadow it, or be taken for it.
#[derive(Clone, Copy, Debug)]
pub struct Spot {
    /// The kind of the shape; `None` for lights.
    kind: Option<&'static str>,
    /// Its position.
    pub position: DVec3,
}

impl Spot {
    /// The spot of a shape.
    pub fn of(shape: &Shape) -> Self {
        Self {
            kind: Some(shape.kind()),
            position: shape.position(),
        }
    }

    /// The spot of a light at `position`.
    pub fn light(position: DVec3) -> Self {
        Self {
            kind: None,
            position,
        }
    }

    /// The spots of all objects and lights of a scene.
    pub fn all_of(scene: &Scene) -> impl Iterator<Item = Self> {
        let objects = scene.objects.iter().map(|object| Self::of(&object.shape));
        let lights = scene.lights.iter().map(|light| Self::light(light.position));
        objects.chain(lights)
    }
}

/// Returns an offset of whole steps, at least `min_steps` of them, that takes none of the `new` spots to where
/// something of its kind is in the scene already; one step if no such place is found.
pub fn offset_to_free_place(scene: &Scene, new: &[Spot], (step, min_steps): (DVec3, u32)) -> DVec3 {
    // Steps added one by one are rounded differently from their sum.
    let tolerance = step.length() * 1e-6;
    let cell = |position: DVec3| {
        let cell = position / (tolerance * 4.0).max(f64::MIN_POSITIVE);
        cell.floor().to_array().map(|part| part as i64)
    };
    let occupied = Spot::all_of(scene).map(|Spot { kind, position }| (kind, cell(position)));
    let occupied: HashSet<(Option<&str>, [i64; 3])> = occupied.collect();
    let is_taken = |offset: DVec3| {
        new.iter().any(|Spot { kind, position }| {
            let wanted = *position + offset;
            let ([x0, y0, z0], [x1, y1, z1]) = (cell(wanted - tolerance), cell(wanted + tolerance));
            // At most two cells along each axis.
            let cells = (x0..=x1).flat_map(|x| (y0..=y1).map(move |y| (x, y)));
            let mut cells = cells.flat_map(|(x, y)| (z0..=z1).map(move |z| [x, y, z]));
            cells.any(|cell| occupied.contains(&(*kind, cell)))
        })
    };
    let steps = (min_steps..min_steps + MAX_STEPS).map(|count| step * f64::from(count));
    let mut free = steps.filter(|offset| !is_taken(*offset));
    free.next().unwrap_or(step)
}

/// Returns the offset from a shape to a copy beside it.
pub fn shape_copy_step(scene: &Scene, shape: &Shape) -> DVec3 {
    if let Some((low, high)) = shape.bounds() {
        return DVec3::new((high - low).abs().max_element(), 0.0, 0.0);
    }
    let plane = shape.endless_plane();
    let extent = scene
        .bounds()
        .map_or(1.0, |(low, high)| (high - low).length());
    plane.map_or(DVec3::ZERO, |plane| plane.normal * (extent / 20.0))
}
