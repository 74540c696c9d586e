//! What a new thing is called, and where it stands.

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
    past_objects(scene, shape, (step_aside(scene, shape), 1))
}

/// Steps, at least so many, after which no shape of this kind is where this one would be.
pub fn past_objects(scene: &Scene, shape: &Shape, (step, least): (DVec3, u32)) -> DVec3 {
    let alike = || {
        let shapes = scene.objects.iter().map(|object| &object.shape);
        shapes.filter(|other| other.kind() == shape.kind())
    };
    let from = shape.position();
    free_step((step, least), |by| {
        alike().any(|other| is_there(other.position(), from + by, step))
    })
}

/// The same of lights, for one that is there.
pub fn past_lights(scene: &Scene, from: DVec3, (step, least): (DVec3, u32)) -> DVec3 {
    free_step((step, least), |by| {
        let mut lights = scene.lights.iter();
        lights.any(|light| is_there(light.position, from + by, step))
    })
}

fn free_step((step, least): (DVec3, u32), is_taken: impl Fn(DVec3) -> bool) -> DVec3 {
    let steps = (least..least + MOST_STEPS).map(|count| step * f64::from(count));
    let mut free = steps.filter(|by| !is_taken(*by));
    free.next().unwrap_or(step)
}

/// Steps one after the other are rounded otherwise than all of them at once.
fn is_there(place: DVec3, wanted: DVec3, step: DVec3) -> bool {
    (place - wanted).length() <= step.length() * 1e-6
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
