//! What a new thing is called, and where it stands.

use std::collections::HashSet;

use glam::DVec3;

use crate::scene::{Bookmark, Names, Scene, Shape};

/// Most steps to one side, in search of a place for a copy.
const MOST_STEPS: u32 = 1_000;

/// A name for an object that no other has, like the one that is wanted.
pub fn free_object_name(scene: &Scene, wanted: &str) -> String {
    let taken = scene.objects.iter().map(|object| &*object.name);
    Names::new(taken).take(wanted)
}

/// A name for a light that no other has, like the one that is wanted.
pub fn free_light_name(scene: &Scene, wanted: &str) -> String {
    let taken = scene.lights.iter().map(|light| &*light.name);
    Names::new(taken).take(wanted)
}

/// A name for a pack that no other has, like the one that is wanted.
pub fn free_pack_name(scene: &Scene, wanted: &str) -> String {
    Names::new(scene.color_packs.keys().map(String::as_str)).take(wanted)
}

/// A name for a group that no other has, like the one that is wanted.
pub fn free_group_name(scene: &Scene, wanted: &str) -> String {
    let taken = scene.objects.iter().map(|object| &*object.group);
    Names::new(taken).take(wanted)
}

/// A name for a bookmark that no other has, like the one that is wanted.
pub fn free_bookmark_name(bookmarks: &[Bookmark], wanted: &str) -> String {
    let taken = bookmarks.iter().map(|bookmark| &*bookmark.name);
    Names::new(taken).take(wanted)
}

/// From a shape to where its copy stands: two things in one place would shadow each other, as would two copies.
pub fn copy_offset(scene: &Scene, shape: &Shape) -> DVec3 {
    let new = [Spot::of(shape)];
    way_past(scene, &new, (step_aside(scene, shape), 1))
}

/// Something where others of its kind would shadow it.
#[derive(Clone, Copy, Debug)]
pub struct Spot {
    /// The kind of a shape; lights have none.
    kind: Option<&'static str>,
    /// Where it is.
    pub place: DVec3,
}

impl Spot {
    /// Of a shape.
    pub fn of(shape: &Shape) -> Self {
        Self {
            kind: Some(shape.kind()),
            place: shape.position(),
        }
    }

    /// Of a light at this place.
    pub fn light(place: DVec3) -> Self {
        Self { kind: None, place }
    }

    /// All that a scene has.
    pub fn all_of(scene: &Scene) -> impl Iterator<Item = Self> {
        let objects = scene.objects.iter().map(|object| Self::of(&object.shape));
        let lights = scene.lights.iter().map(|light| Self::light(light.position));
        objects.chain(lights)
    }
}

/// Steps, at least so many, after which none of these is where something of its kind is in the scene.
pub fn way_past(scene: &Scene, new: &[Spot], (step, least): (DVec3, u32)) -> DVec3 {
    // Steps one after the other are rounded otherwise than all of them at once.
    let near = step.length() * 1e-6;
    let cell = |place: DVec3| {
        let cell = place / (near * 4.0).max(f64::MIN_POSITIVE);
        cell.floor().to_array().map(|part| part as i64)
    };
    let there = Spot::all_of(scene).map(|Spot { kind, place }| (kind, cell(place)));
    let there: HashSet<(Option<&str>, [i64; 3])> = there.collect();
    let is_taken = |by: DVec3| {
        new.iter().any(|Spot { kind, place }| {
            let wanted = *place + by;
            let ([x0, y0, z0], [x1, y1, z1]) = (cell(wanted - near), cell(wanted + near));
            // Two along each axis at most.
            let cells = (x0..=x1).flat_map(|x| (y0..=y1).map(move |y| (x, y)));
            let mut cells = cells.flat_map(|(x, y)| (z0..=z1).map(move |z| [x, y, z]));
            cells.any(|cell| there.contains(&(*kind, cell)))
        })
    };
    let steps = (least..least + MOST_STEPS).map(|count| step * f64::from(count));
    let mut free = steps.filter(|by| !is_taken(*by));
    free.next().unwrap_or(step)
}

/// From a shape to one beside it.
pub fn step_aside(scene: &Scene, shape: &Shape) -> DVec3 {
    if let Some((low, high)) = shape.bounds() {
        return DVec3::new((high - low).abs().max_element(), 0.0, 0.0);
    }
    let normal = shape
        .endless_plane()
        .and_then(|(_, normal)| normal.try_normalize());
    let extent = scene
        .bounds()
        .map_or(1.0, |(low, high)| (high - low).length());
    normal.map_or(DVec3::ZERO, |normal| normal * (extent / 20.0))
}
