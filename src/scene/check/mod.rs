//! Validation of scenes: the checks that a file passes before it is loaded, and an edit before it is applied. Every
//! error names the field, what it must be and what it is.

mod place;

mod camera;

mod animation;

pub use camera::PROJECTION_DISTANCES;
pub use place::{MAX_COORDINATE, MAX_FACTOR, Problem};

use std::collections::HashSet;
use std::sync::Arc;

use camera::check_camera;
use place::{At, Check, no_such};

use super::material::MAX_EXPONENT;
use super::names::MAX_NAME;
use super::object::{LightObj, Object};
use super::render::{MAX_REFLECTIONS, MAX_SIDE, Render};
use super::shape::{Property, PropertyValue, Shape};
use super::whole::{MAX_BYTES, Scene, VERSION};

/// Number of faces that always fits into a scene file, unless the points are written with hundreds of digits.
const FACES_THAT_FIT: usize = 1_000_000;

/// Largest number of pixels of a picture: 1 GiB of 8-bit RGBA.
const MAX_PIXELS: u64 = 1 << 28;

/// Rejects a scene that cannot be traced as it is, with the first problem in file order.
///
/// # Errors
/// The [`Problem`], which can be located in a file by line and column.
pub fn check(scene: &Scene) -> Result<(), Problem> {
    check_since(scene, None)
}

/// Like [`check`], for a scene derived from a valid one: parts that both share are not checked again.
///
/// # Errors
/// The [`Problem`], as a sentence for the user.
pub fn check_edit(scene: &Scene, valid: &Scene) -> Result<(), Problem> {
    check_since(scene, Some(valid))?;
    // Measuring the length takes long, and most edits do not add triangles.
    let is_same = scene.objects.is_same(&valid.objects);
    if is_same || scene.own_faces() <= valid.own_faces().max(FACES_THAT_FIT) {
        return Ok(());
    }
    let bytes = scene.own_bytes();
    if bytes <= MAX_BYTES {
        return Ok(());
    }
    let (limit, bytes) = (MAX_BYTES >> 20, bytes.div_ceil(1 << 20));
    At::root().field("objects").refuse(format!(
        "the triangles of all objects would take {bytes} MiB, but a scene file can have at most {limit} MiB: they could not be saved"
    ))
}

fn check_since(scene: &Scene, valid: Option<&Scene>) -> Result<(), Problem> {
    let root = At::root();
    check_version(&root, scene.version)?;
    root.field("background").color(scene.background)?;
    root.field("ambient_intensity")
        .within(scene.ambient_intensity, 0.0..=1.0)?;
    check_camera(&root.field("camera"), &scene.camera)?;
    let bookmarks = root.field("bookmarks");
    for (index, bookmark) in scene.bookmarks.iter().enumerate() {
        let at = bookmarks.index(index);
        check_name(&at.field("name"), &bookmark.name)?;
        check_camera(&at.field("camera"), &bookmark.camera)?;
    }
    let has_same_packs = valid.is_some_and(|valid| valid.color_packs.is_same(&scene.color_packs));
    if !has_same_packs {
        check_packs(&root.field("color_packs"), scene)?;
    }
    check_objects(&root.field("objects"), scene, valid)?;
    check_lights(&root.field("lights"), scene)?;
    check_render(&root.field("render"), &scene.render)?;
    let is_same_flight = valid.is_some_and(|valid| {
        Arc::ptr_eq(&valid.animation, &scene.animation) && valid.has_names_of(scene)
    });
    if is_same_flight {
        return Ok(());
    }
    animation::check_animation(&root.field("animation"), scene)
}

fn check_version(root: &At, version: u32) -> Check {
    let at = root.field("version");
    match version {
        VERSION => Ok(()),
        0 => at.refuse(format!("version must be {VERSION}, found 0")),
        newer => at.refuse(format!(
            "version {newer} is newer than this program understands ({VERSION}); open it with a newer Glint"
        )),
    }
}

fn check_packs(at: &At, scene: &Scene) -> Check {
    for (name, pack) in scene.color_packs.iter() {
        let at = at.key(name);
        check_name(&at, name)?;
        at.field("ambient").color(pack.ambient)?;
        at.field("diffuse").color(pack.diffuse)?;
        at.field("specular").color(pack.specular)?;
        at.field("phong_exponent")
            .within(pack.phong_exponent, 0.0..=MAX_EXPONENT)?;
    }
    Ok(())
}

fn check_objects(at: &At, scene: &Scene, valid: Option<&Scene>) -> Check {
    let changes = valid
        .filter(|valid| valid.has_packs_of(scene))
        .and_then(|valid| Some((valid, scene.objects.changes(&valid.objects)?)));
    let Some((valid, changes)) = changes else {
        for (index, object) in scene.objects.iter().enumerate() {
            check_object(&at.index(index), scene, object)?;
        }
        return check_object_names(at, scene);
    };
    let mut is_renamed = false;
    for (index, object) in changes {
        check_object(&at.index(index), scene, object)?;
        is_renamed |= valid.objects[index].name != object.name;
    }
    if is_renamed {
        check_object_names(at, scene)?;
    }
    Ok(())
}

fn check_object(at: &At, scene: &Scene, object: &Object) -> Check {
    check_name(&at.field("name"), &object.name)?;
    if !object.group.is_empty() {
        check_name(&at.field("group"), &object.group)?;
    }
    check_pack_exists(&at.field("color_pack"), scene, &object.color_pack)?;
    check_shape(&at.field("shape"), &object.shape)
}

fn check_object_names(at: &At, scene: &Scene) -> Check {
    let mut names = HashSet::new();
    for (index, object) in scene.objects.iter().enumerate() {
        if !names.insert(&object.name) {
            return at
                .index(index)
                .field("name")
                .refuse(format!("there is another object named {:?}", object.name));
        }
    }
    Ok(())
}

impl Scene {
    /// Returns whether another scene has color packs of the same names, in the same order.
    fn has_packs_of(&self, other: &Self) -> bool {
        self.color_packs.is_same(&other.color_packs)
            || self.color_packs.keys().eq(other.color_packs.keys())
    }

    /// Returns whether the objects and lights of another scene have the same names. May be `false` if the object
    /// lists are divided into different chunks.
    fn has_names_of(&self, other: &Self) -> bool {
        let changes = other.objects.changes(&self.objects);
        let is_named_alike = |(index, object): (usize, &Object)| {
            self.objects.get(index).map(|own| &own.name) == Some(&object.name)
        };
        let lights = self.lights.iter().map(|light| &light.name);
        changes.is_some_and(|changes| changes.into_iter().all(is_named_alike))
            && lights.eq(other.lights.iter().map(|light| &light.name))
    }
}

fn check_lights(at: &At, scene: &Scene) -> Check {
    let mut names = HashSet::new();
    for (index, light) in scene.lights.iter().enumerate() {
        let at = at.index(index);
        check_name(&at.field("name"), &light.name)?;
        if !names.insert(&light.name) {
            return at
                .field("name")
                .refuse(format!("there is another light named {:?}", light.name));
        }
        at.field("position").point(light.position)?;
        at.field("intensity").within(light.intensity, 0.0..=1.0)?;
        if let Some(LightObj { radius, color_pack }) = &light.marker {
            let at = at.field("marker");
            at.field("radius").positive(*radius)?;
            check_pack_exists(&at.field("color_pack"), scene, color_pack)?;
        }
    }
    Ok(())
}

fn check_shape(at: &At, shape: &Shape) -> Check {
    let mut result = Ok(());
    shape.clone().fields(&mut |Property { name, value, .. }| {
        if result.is_ok() {
            let at = at.field(name);
            result = match value {
                PropertyValue::Point(point) => at.point(*point),
                PropertyValue::Direction(direction) => at.direction(*direction),
                PropertyValue::Length(length) => at.positive(*length),
                PropertyValue::Angles(angles) => at.angles(*angles),
                PropertyValue::Angle(angle) => at.within(*angle, 0.0..=180.0),
                PropertyValue::Factors(factors) => at.factors(*factors),
            };
        }
    });
    result?;
    shape
        .problem()
        .map_or(Ok(()), |sentence| at.refuse(sentence))
}

fn check_render(at: &At, render: &Render) -> Check {
    for (name, side) in [("width", render.width), ("height", render.height)] {
        if side == 0 || side > MAX_SIDE {
            return at.field(name).refuse(format!(
                "{name} must be between 1 and {MAX_SIDE} pixels, found {side}"
            ));
        }
    }
    let pixels = u64::from(render.width) * u64::from(render.height);
    if pixels > MAX_PIXELS {
        return at.field("width").refuse(format!(
            "a picture may have at most {MAX_PIXELS} pixels, found {} × {}",
            render.width, render.height
        ));
    }
    if render.reflection_limit > MAX_REFLECTIONS {
        return at.field("reflection_limit").refuse(format!(
            "reflection_limit must be between 0 and {MAX_REFLECTIONS}, found {}",
            render.reflection_limit
        ));
    }
    Ok(())
}

fn check_name(at: &At, name: &str) -> Check {
    if name.trim().is_empty() {
        return at.refuse("a name must not be empty".to_owned());
    }
    if name.chars().any(char::is_control) {
        return at.refuse(format!(
            "a name must not contain control characters, found {name:?}"
        ));
    }
    if name.chars().count() > MAX_NAME {
        return at.refuse(format!(
            "a name must not be longer than {MAX_NAME} characters"
        ));
    }
    Ok(())
}

fn check_pack_exists(at: &At, scene: &Scene, name: &str) -> Check {
    if scene.color_packs.contains_key(name) {
        return Ok(());
    }
    let known = scene.color_packs.keys().map(String::as_str);
    at.refuse(no_such("color pack", name, known))
}
