//! What a new thing is called, and where it stands.

use glam::DVec3;

use crate::scene::{Bookmark, Names, Scene, Shape};

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

/// From a shape to where its copy stands: two things in one place would shadow each other.
pub fn copy_offset(scene: &Scene, shape: &Shape) -> DVec3 {
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
