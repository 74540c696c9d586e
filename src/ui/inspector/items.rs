//! Lights, objects and colour packs.

use egui::{Id, Ui};

use glam::DVec3;

use super::title::title_field;
use crate::editor::{Edit, Item, marker_radius};
use crate::scene::{
    self, ColorPack, Light, LightObj, MAX_COORDINATE, MAX_EXPONENT, MAX_FACTOR, MOST_SEPARATE,
    Object, PropertyValue, Scene, Shape, default_intensity,
};
use crate::ui::commands::Command;
use crate::ui::hint::Hinted as _;
use crate::ui::icons;
use crate::ui::requests::UiRequests;
use crate::ui::rows::{EditedPart, Field, FieldRows, color_names, coordinate, fraction};
use crate::words::counted;

/// Most things that are listed as wearing a pack.
const MOST_USERS: usize = 100;

/// What the pack of something is called.
pub const COLOR_PACK: &str = "color pack";

/// What ambient and diffuse colour are called at once.
pub const BOTH: (&str, [&str; 3]) = color_names!("color");

/// A light and its marker. What was chosen and is what it was.
pub fn light(
    ui: &mut Ui,
    scene: &Scene,
    index: usize,
    before: &Light,
    out: &mut UiRequests,
) -> Option<(Edit, EditedPart)> {
    title_field(ui, icons::LIGHT, Item::light(index), &before.name, out);
    let mut light = before.clone();
    let mut rows = FieldRows::new(ui);
    rows.vector(
        &coordinate("position", "Where it shines from, in world units"),
        DVec3::ZERO,
        &mut light.position,
    );
    rows.number(
        &fraction(
            "intensity",
            "Brightness, 0–1; it does not fall off with distance",
            default_intensity(),
        ),
        &mut light.intensity,
    );
    rows.toggle("on", "Whether it shines at all", &mut light.visible);
    rows.heading("Marker");
    let mut has_marker = light.marker.is_some();
    rows.toggle(
        "marker",
        "A sphere that shows where the light is; casts no shadow",
        &mut has_marker,
    );
    if has_marker != light.marker.is_some() {
        light.marker = marker_pack(scene)
            .filter(|_| has_marker)
            .map(|pack| LightObj {
                color_pack: pack.clone(),
                radius: marker_radius(scene),
            });
    }
    if let Some(marker) = &mut light.marker {
        let radius = length(
            "radius",
            "In world units, greater than 0",
            LightObj::default().radius,
        );
        rows.number(&radius, &mut marker.radius);
        pack_choice(&mut rows, scene, &mut marker.color_pack);
    }
    if light == *before {
        let chosen = rows.chosen()?;
        return Some((Edit::Light(index, light, chosen.field), chosen));
    }
    if let Some(field) = rows.changed() {
        out.edit(Edit::Light(index, light, field));
    }
    None
}

/// What the marker of a light wears that has none yet: what those of others wear, a pack that is called like one, or any.
fn marker_pack(scene: &Scene) -> Option<&String> {
    let markers = scene
        .lights
        .iter()
        .filter_map(|light| light.marker.as_ref());
    let names = || scene.color_packs.keys();
    let mut worn = markers.map(|marker| &marker.color_pack);
    worn.next()
        .or_else(|| names().find(|name| *name == "light"))
        .or_else(|| names().next())
}

fn length(name: &'static str, hint: &'static str, default: f64) -> Field {
    Field {
        default,
        range: 1e-9..=MAX_COORDINATE,
        ..coordinate(name, hint)
    }
}

/// Degrees.
pub(super) fn angle(name: &'static str, hint: &'static str) -> Field {
    Field {
        unit: "°",
        speed: Some(0.5),
        ..coordinate(name, hint)
    }
}

/// Degrees up to half a turn.
fn half_turn(name: &'static str, hint: &'static str) -> Field {
    Field {
        range: 0.0..=180.0,
        ..angle(name, hint)
    }
}

/// What something is multiplied by.
fn factor(name: &'static str, hint: &'static str) -> Field {
    Field {
        default: 1.0,
        range: -MAX_FACTOR..=MAX_FACTOR,
        ..coordinate(name, hint)
    }
}

fn pack_choice(rows: &mut FieldRows, scene: &Scene, name: &mut String) {
    let options = scene
        .color_packs
        .keys()
        .map(|name| (name.clone(), name.clone()));
    rows.choice(
        COLOR_PACK,
        "The material, shared by everything that names it",
        name,
        options,
    );
}

/// An object: its shape and its pack; by itself it can be joined and taken apart besides. What was chosen and is what it
/// was.
pub fn object(
    ui: &mut Ui,
    scene: &Scene,
    (index, is_alone): (usize, bool),
    before: &Object,
    out: &mut UiRequests,
) -> Option<(Edit, EditedPart)> {
    title_field(
        ui,
        icons::of_shape(&before.shape),
        Item::object(index),
        &before.name,
        out,
    );
    let mut object = before.clone();
    let mut rows = FieldRows::new(ui);
    rows.heading(before.shape.kind());
    shape_rows(&mut rows, &mut object.shape);
    rows.toggle(
        "visible",
        "An invisible object casts no shadow and no reflection",
        &mut object.visible,
    );
    if is_alone {
        mesh_tools(&mut rows, &before.shape, out);
    }
    rows.heading("ColorPack");
    pack_choice(&mut rows, scene, &mut object.color_pack);
    let chosen = rows.chosen().filter(|_| object == *before);
    if let Some(field) = rows.changed().filter(|_| object != *before) {
        out.edit(Edit::object(index, object.clone(), field));
    }
    let chosen = chosen.map(|chosen| (Edit::object(index, object, chosen.field), chosen));
    let Some((place, name, value)) = scene.color_packs.get_full(&before.color_pack) else {
        return chosen;
    };
    let chosen = pack(ui, place, value, out).or(chosen);
    let users = count_users(ui, scene, name);
    ui.horizontal(|ui| {
        ui.weak(format!("used by {users}"));
        // Of several, others may share theirs.
        let can_be = users > 1 || !is_alone;
        let unique = ui.add_enabled(can_be, egui::Button::new("Make unique"));
        let hint = if is_alone {
            "Give this object a color pack of its own"
        } else {
            "Give each of these objects a color pack of its own"
        };
        if unique.hint(hint).clicked() {
            out.edit(Edit::MakePackUnique(index));
        }
    });
    chosen
}

/// What turns triangles into a mesh and back: what is shown is all that is selected.
fn mesh_tools(rows: &mut FieldRows, shape: &Shape, out: &mut UiRequests) {
    match shape {
        Shape::Triangle(_) => {
            let hint = "Make one mesh of this triangle and all that share corners with it";
            if tool(rows, "Join connected", hint, true) {
                out.commands.push(Command::Join);
            }
        }
        Shape::Mesh(mesh) => {
            let faces = mesh.source.triangles().faces().len();
            rows.ui.weak(counted(faces, "triangle"));
            if let Some(problem) = mesh.source.problem() {
                rows.ui.label(problem);
            }
            let hint = format!("Make an object of each triangle, up to {MOST_SEPARATE} of them");
            if tool(rows, "Separate", &hint, mesh.is_separable()) {
                out.commands.push(Command::Separate);
            }
        }
        _ => {}
    }
}

fn tool(rows: &mut FieldRows, name: &str, hint: &str, is_enabled: bool) -> bool {
    let button = rows.ui.add_enabled(is_enabled, egui::Button::new(name));
    button.hint(hint).clicked()
}

/// How many things wear a pack. To count them takes a look at every object: what is dragged changes
/// nothing about it, so it is counted when the button is up.
fn count_users(ui: &Ui, scene: &Scene, name: &str) -> usize {
    let id = Id::unique(("users of a pack", name));
    let known = ui.data(|data| data.get_temp::<(usize, usize)>(id));
    let is_dragging = ui.input(|input| input.pointer.any_down());
    match known {
        Some((objects, users)) if is_dragging && objects == scene.objects.len() => users,
        _ => {
            let users = Item::wearing(scene, name).count();
            ui.data_mut(|data| data.insert_temp(id, (scene.objects.len(), users)));
            users
        }
    }
}

fn shape_rows(rows: &mut FieldRows, shape: &mut Shape) {
    shape.fields(&mut |scene::Property { name, hint, value }| match value {
        PropertyValue::Point(point) => rows.vector(&coordinate(name, hint), DVec3::ZERO, point),
        PropertyValue::Direction(direction) => {
            rows.vector(&coordinate(name, hint), DVec3::Y, direction);
        }
        PropertyValue::Length(length) => rows.number(&self::length(name, hint, 50.0), length),
        PropertyValue::Angles(angles) => rows.vector(&angle(name, hint), DVec3::ZERO, angles),
        PropertyValue::Angle(angle) => rows.number(&half_turn(name, hint), angle),
        PropertyValue::Factors(factors) => rows.vector(&factor(name, hint), DVec3::ONE, factors),
    });
}

/// The colours of a pack. What was chosen and is what it was.
pub fn pack(
    ui: &mut Ui,
    index: usize,
    before: &ColorPack,
    out: &mut UiRequests,
) -> Option<(Edit, EditedPart)> {
    let mut pack = before.clone();
    let defaults = ColorPack::default();
    let mut rows = FieldRows::new(ui);
    let mut both = pack.diffuse;
    rows.color(
        BOTH,
        "Ambient and diffuse at once: what most things are painted in",
        defaults.diffuse,
        &mut both,
    );
    // Also where it is what diffuse was, and ambient another.
    if both != pack.diffuse || rows.chosen().is_some() {
        (pack.ambient, pack.diffuse) = (both, both);
    }
    rows.color(
        color_names!("ambient"),
        "Colour without any light, scaled by the ambient intensity",
        defaults.ambient,
        &mut pack.ambient,
    );
    rows.color(
        color_names!("diffuse"),
        "Colour of matte reflection",
        defaults.diffuse,
        &mut pack.diffuse,
    );
    rows.color(
        color_names!("specular"),
        "Colour of the highlight, and of the mirror image",
        defaults.specular,
        &mut pack.specular,
    );
    rows.number(
        &Field {
            name: "phong",
            hint: "Phong exponent: sharpness of the highlight. 0 is flat, 16 soft, 1000 a pinpoint",
            unit: "",
            default: defaults.phong_exponent,
            range: 0.0..=MAX_EXPONENT,
            speed: None,
        },
        &mut pack.phong_exponent,
    );
    rows.toggle(
        "reflective",
        "Whether the surface mirrors the scene: through its specular color, as bright as all lights together",
        &mut pack.reflective,
    );
    if pack == *before {
        let chosen = rows.chosen()?;
        return Some((Edit::Pack(index, pack, chosen.field), chosen));
    }
    let chosen = || rows.chosen().map(|chosen| chosen.field);
    if let Some(field) = rows.changed().or_else(chosen) {
        out.edit(Edit::Pack(index, pack, field));
    }
    None
}

/// What uses a pack, each a way to it.
pub fn used_by(ui: &mut Ui, scene: &Scene, name: &str, out: &mut UiRequests) {
    let mut rows = FieldRows::new(ui);
    rows.heading("Used by");
    let mut all = Item::wearing(scene, name);
    let users: Vec<Item> = all.by_ref().take(MOST_USERS).collect();
    let more = all.count();
    if users.is_empty() {
        ui.weak("Nothing yet – choose it in an object's ColorPack");
    }
    for item in users {
        let name = item.name(scene).unwrap_or_default();
        let button = egui::Button::new((icons::text(icons::of_item(scene, item)), name))
            .frame_when_inactive(false)
            .truncate();
        if ui
            .add(button)
            .accessible_name(format!("Go to {name}"))
            .clicked()
        {
            out.select(item);
        }
    }
    if more > 0 {
        ui.weak(format!("and {more} more"));
    }
}
