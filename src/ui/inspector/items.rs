//! The properties of lights, objects and color packs.

use egui::{AtomExt as _, Id, RichText, Ui};

use glam::DVec3;

use super::title::title_field;
use crate::editor::{Edit, Item, ItemKind, marker_radius};
use crate::scene::{
    self, ColorPack, Light, LightObj, List, MAX_COORDINATE, MAX_EXPONENT, MAX_FACTOR,
    MAX_SEPARATED, Object, PropertyValue, Scene, Shape, default_intensity,
};
use crate::ui::commands::Command;
use crate::ui::hint::Hinted as _;
use crate::ui::icons;
use crate::ui::menu_entry::on_click;
use crate::ui::requests::UiRequests;
use crate::ui::rows::{EditedPart, Field, FieldRows, color_names, coordinate, fraction};
use crate::words::counted;

/// Maximum number of items listed as users of a color pack.
const MAX_LISTED_USERS: usize = 100;

/// Label of the row that chooses a color pack.
pub const COLOR_PACK: &str = "color pack";

/// Label of the row that sets ambient and diffuse colour together.
pub const BOTH_COLORS: (&str, [&str; 3]) = color_names!("color");

/// Shows the properties of an item; if it is the only one selected, also what cannot be done with several. Returns the
/// edit of a field that the user set to the value it already has, if any.
pub fn item(
    ui: &mut Ui,
    scene: &Scene,
    (item, is_alone): (Item, bool),
    out: &mut UiRequests,
) -> Option<(Edit, EditedPart)> {
    let (icon, name) = (icons::of_item(scene, item), item.name(scene)?);
    title_field(ui, icon, item, name, out);
    match item.kind {
        ItemKind::Light => light(ui, scene, item.index, out),
        ItemKind::Object => object(ui, scene, (item.index, is_alone), out),
        ItemKind::Pack => {
            let (name, value) = scene.color_packs.get_index(item.index)?;
            let chosen = pack(ui, item.index, value, out);
            if is_alone {
                used_by(ui, scene, name, out);
            }
            chosen
        }
    }
}

/// Shows a light and its marker.
fn light(
    ui: &mut Ui,
    scene: &Scene,
    index: usize,
    out: &mut UiRequests,
) -> Option<(Edit, EditedPart)> {
    let before = scene.lights.get(index)?;
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
    rows.toggle("on", "Whether the light is on", &mut light.visible);
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

/// The color pack for the first marker of a light: that of another marker, a pack named "light", or any.
fn marker_pack(scene: &Scene) -> Option<&String> {
    let markers = scene
        .lights
        .iter()
        .filter_map(|light| light.marker.as_ref());
    let names = || scene.color_packs.keys();
    let mut marker_packs = markers.map(|marker| &marker.color_pack);
    marker_packs
        .next()
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

/// A field in degrees.
pub(super) fn angle(name: &'static str, hint: &'static str) -> Field {
    Field {
        unit: "°",
        speed: Some(0.5),
        ..coordinate(name, hint)
    }
}

/// A field in degrees, 0–180.
fn half_turn(name: &'static str, hint: &'static str) -> Field {
    Field {
        range: 0.0..=180.0,
        ..angle(name, hint)
    }
}

/// A field for a scale factor.
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
        "The material, shared by everything that uses it",
        name,
        options,
    );
}

/// Shows an object's shape and color pack; if it is the only one selected, also the tools to join and separate it.
fn object(
    ui: &mut Ui,
    scene: &Scene,
    (index, is_alone): (usize, bool),
    out: &mut UiRequests,
) -> Option<(Edit, EditedPart)> {
    let before = scene.objects.get(index)?;
    let mut object = before.clone();
    let mut rows = FieldRows::new(ui);
    rows.heading(before.shape.kind());
    shape_rows(&mut rows, &mut object.shape);
    rows.toggle(
        "visible",
        "An invisible object casts no shadow and has no reflection",
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
    let Some((pack_index, name, value)) = scene.color_packs.get_full(&before.color_pack) else {
        return chosen;
    };
    let chosen = pack(ui, pack_index, value, out).or(chosen);
    let users = count_users(ui, scene, name);
    ui.horizontal(|ui| {
        ui.weak(format!("used by {users}"));
        // With several objects selected, the packs of the others may be shared.
        let obstacle = (users == 1 && is_alone).then_some("no other object uses this color pack");
        let unique = ui.add_enabled(obstacle.is_none(), egui::Button::new("Make unique"));
        let hint = if is_alone {
            "Give this object a color pack of its own"
        } else {
            "Give each of these objects a color pack of its own"
        };
        if unique.hint_unless(obstacle, hint).clicked() {
            out.edit(Edit::MakePacksUnique(vec![index]));
        }
    });
    chosen
}

/// Tools that turn triangles into a mesh and back; only for a single selected object.
fn mesh_tools(rows: &mut FieldRows, shape: &Shape, out: &mut UiRequests) {
    match shape {
        Shape::Triangle(_) => {
            let hint =
                "Join this triangle and all that are connected by shared corners into one mesh";
            let join = rows.ui.button("Join connected");
            on_click(rows.ui, join, (hint, Command::Join), out);
        }
        Shape::Mesh(mesh) => {
            let faces = mesh.source.triangles().faces().len();
            rows.ui.weak(counted(faces, "triangle"));
            if let Some(problem) = mesh.source.problem() {
                rows.ui.label(problem);
            }
            let hint =
                format!("Make each triangle an object of its own, up to {MAX_SEPARATED} of them");
            let separate = egui::Button::new("Separate");
            let separate = rows.ui.add_enabled(mesh.is_separable(), separate);
            on_click(rows.ui, separate, (&hint, Command::Separate), out);
        }
        _ => {}
    }
}

/// Counts the users of a color pack. This visits every object, so it is repeated only when they have changed; a drag
/// cannot change the count.
fn count_users(ui: &Ui, scene: &Scene, name: &str) -> usize {
    let id = Id::unique(("users of a pack", name));
    let cached = ui.data(|data| data.get_temp::<(List<Object>, List<Light>, usize)>(id));
    let is_dragging = ui.input(|input| input.pointer.any_down());
    let (objects, lights) = (&scene.objects, &scene.lights);
    match cached {
        Some((counted, _, users)) if is_dragging && counted.len() == objects.len() => users,
        Some((counted, shining, users)) if counted.is_same(objects) && shining.is_same(lights) => {
            users
        }
        _ => {
            let users = Item::users_of_pack(scene, name).count();
            ui.data_mut(|data| data.insert_temp(id, (objects.clone(), lights.clone(), users)));
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

/// Shows the colours of a color pack.
fn pack(
    ui: &mut Ui,
    index: usize,
    before: &ColorPack,
    out: &mut UiRequests,
) -> Option<(Edit, EditedPart)> {
    let mut pack = before.clone();
    let defaults = ColorPack::default();
    let mut rows = FieldRows::new(ui);
    let mut shared_color = pack.diffuse;
    rows.color(
        BOTH_COLORS,
        "Ambient and diffuse together: the colour of most objects",
        defaults.diffuse,
        &mut shared_color,
    );
    // Also if the chosen colour is what diffuse was, as ambient may have been another.
    if shared_color != pack.diffuse || rows.chosen().is_some() {
        (pack.ambient, pack.diffuse) = (shared_color, shared_color);
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
        "Whether the surface mirrors the scene; reflections are multiplied by the specular color and the sum of all light intensities",
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

/// Lists the users of a color pack; a click selects one.
fn used_by(ui: &mut Ui, scene: &Scene, name: &str, out: &mut UiRequests) {
    let mut rows = FieldRows::new(ui);
    rows.heading("Used by");
    let mut all = Item::users_of_pack(scene, name);
    let users: Vec<Item> = all.by_ref().take(MAX_LISTED_USERS).collect();
    let more = all.count();
    if users.is_empty() {
        ui.weak("Nothing yet – choose it in an object's ColorPack");
    }
    for item in users {
        let name = item.name(scene).unwrap_or_default();
        // Long names are truncated, not the icon.
        let shown = RichText::new(name).atom_shrink(true);
        let button = egui::Button::new((icons::text(icons::of_item(scene, item)), shown))
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
