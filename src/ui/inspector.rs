//! The panel on the right: every property of what is selected.

use egui::{Align2, Id, RichText, ScrollArea, TextEdit, Ui};
use egui_material_icons::MaterialIcon;

use super::rows::{Field, Rows, coordinate};
use super::theme::{GRID, ROW};
use super::{Out, icons};
use crate::editor::{Edit, Editor, Item, Kind, Orientation, Selection};
use crate::scene::{
    Camera, ColorPack, Light, LightObj, MAX_REFLECTIONS, MAX_SIDE, Object, Projection, Render,
    Scene, Shape,
};

/// Shows the selection and pushes its changes.
pub fn show(ui: &mut Ui, editor: &Editor, out: &mut Out) {
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        ui.add_space(GRID / 2.0);
        let scene = editor.scene();
        match editor.selection {
            Selection::Camera => camera(ui, editor, out),
            Selection::World => world(ui, scene, out),
            Selection::Render => picture(ui, scene, out),
            Selection::Item(Item {
                kind: Kind::Light,
                index,
            }) => {
                if let Some(value) = scene.lights.get(index) {
                    light(ui, scene, index, value, out);
                }
            }
            Selection::Item(Item {
                kind: Kind::Object,
                index,
            }) => {
                if let Some(value) = scene.objects.get(index) {
                    object(ui, scene, index, value, out);
                }
            }
            Selection::Item(Item {
                kind: Kind::Pack,
                index,
            }) => {
                if let Some((name, value)) = scene.color_packs.get_index(index) {
                    title_field(ui, icons::PACK, Item::pack(index), name, out);
                    pack(ui, index, value, out);
                    used_by(ui, scene, name, out);
                }
            }
        }
        ui.add_space(GRID);
    });
}

fn title(ui: &mut Ui, icon: MaterialIcon, name: &str) {
    ui.horizontal(|ui| {
        ui.set_min_height(ROW);
        ui.label(icons::text(icon));
        ui.label(RichText::new(name).heading());
    });
}

/// The title of an item is its name, which can be edited in place.
fn title_field(ui: &mut Ui, icon: MaterialIcon, item: Item, name: &str, out: &mut Out) {
    ui.horizontal(|ui| {
        ui.set_min_height(ROW);
        ui.label(icons::text(icon));
        if let Some(new) = name_field(ui, "name", Id::unique(("title", item)), name) {
            out.edit(Edit::Rename(item, new));
        }
    });
}

/// A text field that gives the text when it is left with Enter or a click elsewhere, and forgets it
/// on Escape.
pub fn name_field(ui: &mut Ui, label: &str, id: Id, name: &str) -> Option<String> {
    let mut text = ui
        .data(|data| data.get_temp::<String>(id))
        .unwrap_or_else(|| name.to_owned());
    let field = TextEdit::singleline(&mut text)
        .id(id)
        .char_limit(200)
        .align(Align2::LEFT_CENTER);
    let response = ui
        .add_sized([ui.available_width(), ROW], field)
        .accessible_name(label);
    if response.lost_focus() {
        ui.data_mut(|data| data.remove::<String>(id));
        let is_cancelled = ui.input(|input| input.key_pressed(egui::Key::Escape));
        return (!is_cancelled && text.trim() != name).then_some(text);
    }
    if response.changed() {
        ui.data_mut(|data| data.insert_temp(id, text));
    }
    None
}

fn camera(ui: &mut Ui, editor: &Editor, out: &mut Out) {
    title(ui, icons::CAMERA, "Camera");
    let before = &editor.scene().camera;
    let mut camera = before.clone();
    let mut rows = Rows::new(ui);
    let kinds = [Projection::Perspective, Projection::Orthographic];
    rows.choice(
        "projection",
        "Whether rays spread from the eye (P) or run side by side (O)",
        &mut camera.projection,
        kinds.map(|kind| (kind, format!("{kind:?}"))),
    );
    projection_rows(&mut rows, &mut camera);
    rows.heading("Place");
    let defaults = Camera::default();
    rows.vector(
        &coordinate("position", "Where the camera stands, in world units"),
        &mut camera.position,
    );
    angle_rows(&mut rows, editor.orientation(), &mut camera);
    rows.heading("Vectors");
    rows.vector(
        &Field {
            default: 0.0,
            ..coordinate("look_at", "Viewing direction; its length does not matter")
        },
        &mut camera.look_at,
    );
    rows.vector(
        &coordinate("up", "Roughly upwards; must not be along look_at"),
        &mut camera.up,
    );
    let reset = ui.button("Reset to the demo's camera").clicked();
    let field = rows_changed(reset, &mut camera, defaults, before);
    if let Some(field) = field {
        out.edit(Edit::Camera(camera, field));
    }
}

/// What the change of the camera is called, if it changed.
fn rows_changed(
    reset: bool,
    camera: &mut Camera,
    defaults: Camera,
    before: &Camera,
) -> Option<&'static str> {
    if reset {
        *camera = defaults;
        return Some("reset");
    }
    let fields = [
        (camera.position != before.position, "position"),
        (camera.projection != before.projection, "projection"),
        (
            camera.projection_distance != before.projection_distance,
            "projection distance",
        ),
        (
            camera.orthographic_height != before.orthographic_height,
            "orthographic height",
        ),
        (
            camera.look_at != before.look_at || camera.up != before.up,
            "direction",
        ),
    ];
    fields
        .into_iter()
        .find_map(|(changed, name)| changed.then_some(name))
}

fn projection_rows(rows: &mut Rows, camera: &mut Camera) {
    if camera.projection == Projection::Orthographic {
        rows.number(
            &Field {
                name: "height",
                hint: "Height of the view window, in world units",
                unit: "",
                default: 200.0,
                range: 1e-6..=1e12,
                speed: None,
            },
            &mut camera.orthographic_height,
        );
        return;
    }
    rows.number(
        &Field {
            name: "distance",
            hint: "Projection distance: from the eye to the image plane, in image heights (0.001–100000). Longer is a narrower view",
            unit: " h",
            default: 0.5625,
            range: 1e-3..=1e5,
            speed: None,
        },
        &mut camera.projection_distance,
    );
    let degrees = camera.field_of_view_radians().to_degrees();
    let mut edited = degrees;
    rows.number(
        &Field {
            name: "view angle",
            hint: "The same as an angle: vertical field of view in degrees",
            unit: "°",
            default: Camera::default().field_of_view_radians().to_degrees(),
            range: 0.001..=179.0,
            speed: Some(0.2),
        },
        &mut edited,
    );
    if edited != degrees {
        camera.projection_distance = 0.5 / (edited.to_radians() / 2.0).tan();
    }
}

/// Yaw, pitch and roll in degrees; a change rebuilds look_at and up from them.
fn angle_rows(rows: &mut Rows, before: Orientation, camera: &mut Camera) {
    let mut angles = before;
    let parts = [
        (
            "yaw",
            "Turn to the right, from -180° to 180°",
            180.0,
            &mut angles.yaw,
        ),
        (
            "pitch",
            "Tilt upwards, up to 89.9°",
            89.9,
            &mut angles.pitch,
        ),
        (
            "roll",
            "Lean to the right, from -180° to 180°",
            180.0,
            &mut angles.roll,
        ),
    ];
    for (name, hint, limit, radians) in parts {
        let degrees = radians.to_degrees();
        let mut edited = degrees;
        let field = Field {
            name,
            hint,
            unit: "°",
            default: 0.0,
            range: -limit..=limit,
            speed: Some(0.25),
        };
        rows.number(&field, &mut edited);
        if edited != degrees {
            *radians = edited.to_radians();
        }
    }
    if angles != before {
        *camera = angles.apply(camera);
    }
}

fn world(ui: &mut Ui, scene: &Scene, out: &mut Out) {
    title(ui, icons::WORLD, "World");
    let mut ambient = scene.ambient_intensity;
    let mut background = scene.background;
    let mut markers = scene.light_visualization;
    let mut rows = Rows::new(ui);
    rows.number(
        &fraction(
            "ambient",
            "Ambient intensity: how much of every ambient colour is seen without light, 0–1",
            0.5,
        ),
        &mut ambient,
    );
    rows.color(
        "background",
        "Colour of a ray that hits nothing, 0–255",
        &mut background,
    );
    rows.toggle(
        "light markers",
        "Light visualization: whether the markers of lights are seen (I on, U off)",
        &mut markers,
    );
    if ambient != scene.ambient_intensity {
        out.edit(Edit::Ambient(ambient));
    }
    if background != scene.background {
        out.edit(Edit::Background(background));
    }
    if markers != scene.light_visualization {
        out.edit(Edit::LightVisualization(markers));
    }
}

fn fraction(name: &'static str, hint: &'static str, default: f64) -> Field {
    Field {
        name,
        hint,
        unit: "",
        default,
        range: 0.0..=1.0,
        speed: Some(0.005),
    }
}

fn picture(ui: &mut Ui, scene: &Scene, out: &mut Out) {
    title(ui, icons::IMAGE, "Picture");
    let mut render = scene.render.clone();
    let defaults = Render::default();
    let mut rows = Rows::new(ui);
    for (name, hint, default, limit, value) in [
        (
            "width",
            "Width of the high-res picture in pixels",
            defaults.width,
            MAX_SIDE,
            &mut render.width,
        ),
        (
            "height",
            "Height of the high-res picture in pixels",
            defaults.height,
            MAX_SIDE,
            &mut render.height,
        ),
    ] {
        whole(&mut rows, name, hint, " px", default, 1..=limit, value);
    }
    whole(
        &mut rows,
        "reflections",
        "How often light may be mirrored on its way to the eye",
        "",
        defaults.reflection_limit,
        0..=MAX_REFLECTIONS,
        &mut render.reflection_limit,
    );
    let changed = rows.changed();
    if let Some(field) = changed.filter(|_| render != scene.render) {
        out.edit(Edit::Render(render, field));
    }
}

/// A row for a whole number.
fn whole(
    rows: &mut Rows,
    name: &'static str,
    hint: &'static str,
    unit: &'static str,
    default: u32,
    range: std::ops::RangeInclusive<u32>,
    value: &mut u32,
) {
    let range = f64::from(*range.start())..=f64::from(*range.end());
    let speed = Some(if *range.end() > 100.0 { 2.0 } else { 0.05 });
    let mut real = f64::from(*value);
    rows.number(
        &Field {
            name,
            hint,
            unit,
            default: f64::from(default),
            range,
            speed,
        },
        &mut real,
    );
    *value = real.round() as u32;
}

fn light(ui: &mut Ui, scene: &Scene, index: usize, before: &Light, out: &mut Out) {
    title_field(ui, icons::LIGHT, Item::light(index), &before.name, out);
    let mut light = before.clone();
    let mut rows = Rows::new(ui);
    rows.vector(
        &coordinate("position", "Where it shines from, in world units"),
        &mut light.position,
    );
    rows.number(
        &fraction(
            "intensity",
            "Brightness, 0–1; it does not fall off with distance",
            0.2,
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
        let names = scene.color_packs.keys();
        let pack = names
            .clone()
            .find(|name| *name == "light")
            .or(scene.color_packs.keys().next());
        light.marker = pack.filter(|_| has_marker).map(|pack| LightObj {
            color_pack: pack.clone(),
            ..LightObj::default()
        });
    }
    if let Some(marker) = &mut light.marker {
        rows.number(&radius(5.0), &mut marker.radius);
        pack_choice(&mut rows, scene, &mut marker.color_pack);
    }
    if let Some(field) = rows.changed().filter(|_| light != *before) {
        out.edit(Edit::Light(index, light, field));
    }
}

fn radius(default: f64) -> Field {
    Field {
        name: "radius",
        hint: "In world units, greater than 0",
        unit: "",
        default,
        range: 1e-9..=1e12,
        speed: None,
    }
}

fn pack_choice(rows: &mut Rows, scene: &Scene, name: &mut String) {
    let options = scene
        .color_packs
        .keys()
        .map(|name| (name.clone(), name.clone()));
    rows.choice(
        "color pack",
        "The material, shared by everything that names it",
        name,
        options,
    );
}

fn object(ui: &mut Ui, scene: &Scene, index: usize, before: &Object, out: &mut Out) {
    title_field(
        ui,
        icons::of_shape(&before.shape),
        Item::object(index),
        &before.name,
        out,
    );
    let mut object = before.clone();
    let mut rows = Rows::new(ui);
    rows.heading(before.shape.kind());
    shape_rows(&mut rows, &mut object.shape);
    rows.toggle(
        "visible",
        "An invisible object casts no shadow and no reflection",
        &mut object.visible,
    );
    rows.heading("ColorPack");
    pack_choice(&mut rows, scene, &mut object.color_pack);
    if let Some(field) = rows.changed().filter(|_| object != *before) {
        out.edit(Edit::Object(index, object, field));
    }
    let Some((place, name, value)) = scene.color_packs.get_full(&before.color_pack) else {
        return;
    };
    pack(ui, place, value, out);
    let users = scene.users_of_pack(name).len();
    ui.horizontal(|ui| {
        ui.weak(format!("used by {users}"));
        let unique = ui.add_enabled(users > 1, egui::Button::new("Make unique"));
        if unique
            .on_hover_text("Give this object a color pack of its own")
            .clicked()
        {
            out.edit(Edit::MakePackUnique(index));
        }
    });
}

fn shape_rows(rows: &mut Rows, shape: &mut Shape) {
    match shape {
        Shape::Sphere { center, radius: r } => {
            rows.vector(
                &coordinate("center", "The middle of the ball, in world units"),
                center,
            );
            rows.number(&radius(50.0), r);
        }
        Shape::Plane { point, normal } => {
            rows.vector(&coordinate("point", "Any point on the plane"), point);
            rows.vector(
                &coordinate(
                    "normal",
                    "Direction across the plane; its length does not matter",
                ),
                normal,
            );
        }
        Shape::Triangle { a, b, c } => {
            for (name, corner) in [("a", a), ("b", b), ("c", c)] {
                rows.vector(
                    &coordinate(name, "A corner; clockwise seen from outside"),
                    corner,
                );
            }
        }
    }
}

fn pack(ui: &mut Ui, index: usize, before: &ColorPack, out: &mut Out) {
    let mut pack = before.clone();
    let mut rows = Rows::new(ui);
    rows.color(
        "ambient",
        "Colour without any light, scaled by the ambient intensity",
        &mut pack.ambient,
    );
    rows.color("diffuse", "Colour of matte reflection", &mut pack.diffuse);
    rows.color(
        "specular",
        "Colour of the highlight, and of the mirror image",
        &mut pack.specular,
    );
    rows.number(
        &Field {
            name: "phong",
            hint: "Phong exponent: sharpness of the highlight. 0 is flat, 16 soft, 1000 a pinpoint",
            unit: "",
            default: 16.0,
            range: 0.0..=1e7,
            speed: None,
        },
        &mut pack.phong_exponent,
    );
    rows.toggle(
        "reflective",
        "Whether the surface mirrors the scene",
        &mut pack.reflective,
    );
    if let Some(field) = rows.changed().filter(|_| pack != *before) {
        out.edit(Edit::Pack(index, pack, field));
    }
}

/// What uses a pack, each a way to it.
fn used_by(ui: &mut Ui, scene: &Scene, name: &str, out: &mut Out) {
    let mut rows = Rows::new(ui);
    rows.heading("Used by");
    let lights = scene.lights.iter().enumerate().filter(|(_, light)| {
        light
            .marker
            .as_ref()
            .is_some_and(|marker| marker.color_pack == name)
    });
    let lights = lights.map(|(index, light)| (icons::LIGHT, Item::light(index), &light.name));
    let objects = scene
        .objects
        .iter()
        .enumerate()
        .filter(|(_, object)| object.color_pack == name);
    let objects = objects.map(|(index, object)| {
        (
            icons::of_shape(&object.shape),
            Item::object(index),
            &object.name,
        )
    });
    let users: Vec<_> = lights.chain(objects).collect();
    if users.is_empty() {
        ui.weak("Nothing yet – choose it in an object's ColorPack");
    }
    for (icon, item, name) in users {
        let button = egui::Button::new((icons::text(icon), name))
            .frame_when_inactive(false)
            .truncate();
        if ui
            .add(button)
            .accessible_name(format!("Go to {name}"))
            .clicked()
        {
            out.select(Selection::Item(item));
        }
    }
}
