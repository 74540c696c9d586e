//! Several things at once: what they have in common is changed for all.

use egui::{Id, Ui};
use glam::DVec3;

use super::alike::{for_all, packs_of, values};
use super::items;
use super::title::{name_field, tell_different, title, title_field};
use crate::editor::{Action, Edit, Editor, Item, Kind};
use crate::scene::{ColorPack, Light, Object, Scene, Shape};
use crate::ui::hint::Hint as _;
use crate::ui::icons;
use crate::ui::requests::UiRequests;
use crate::ui::theme::{GRID, ROW};

/// Most things that are compared, in every frame of the window.
const MOST: usize = 500;

/// The properties of what was selected last; a change is made to all that have the property.
pub fn show(ui: &mut Ui, editor: &Editor, out: &mut UiRequests) {
    let (scene, selected) = (editor.shown(), editor.selected().items());
    let objects = editor.selected().places(Kind::Object);
    let group = editor.selected().group(scene);
    if let Some(group) = group {
        group_title(ui, group, out);
    } else {
        title(ui, icons::SELECTED, &format!("{} items", selected.len()));
    }
    let Some(&last) = selected.last() else { return };
    tell_different(ui, differences(scene, selected, last).into_iter());
    ui.weak(if group.is_some() {
        "A change is made to all that have the property; a position moves the group."
    } else {
        "A change is made to all that have the property; a position that is dragged moves them together."
    });
    let is_joinable = |index: &usize| {
        let object = scene.objects.get(*index);
        object.is_some_and(|object| matches!(object.shape, Shape::Triangle(_) | Shape::Mesh(_)))
    };
    let can_join = objects.len() == selected.len() && objects.iter().all(is_joinable);
    let join = ui.add_enabled(can_join, egui::Button::new("Join"));
    let hint = "Make one mesh of these triangles and meshes, with the name and the color pack of the first";
    if join.hint(hint).on_disabled_hover_text(hint).clicked() {
        out.edit(Edit::Join(objects));
    }
    ui.add_space(GRID);
    let mut own = UiRequests::default();
    match last.kind {
        Kind::Object => {
            if let Some(object) = scene.objects.get(last.index) {
                items::object(ui, scene, last.index, object, &mut own);
            }
        }
        Kind::Light => {
            if let Some(light) = scene.lights.get(last.index) {
                items::light(ui, scene, last.index, light, &mut own);
            }
        }
        Kind::Pack => {
            if let Some((name, pack)) = scene.color_packs.get_index(last.index) {
                title_field(ui, icons::PACK, last, name, &mut own);
                items::pack(ui, last.index, pack, &mut own);
            }
        }
    }
    // A group stays what it is; and it is not the click elsewhere that ends what was typed.
    let is_together = group.is_some() || ui.input(|input| input.pointer.is_decidedly_dragging());
    for action in own.actions {
        out.actions.push(match action {
            Action::Edit(edit) => Action::Edit(for_all(scene, selected, edit, is_together)),
            other => other,
        });
    }
}

/// The name of a group, which can be edited.
fn group_title(ui: &mut Ui, group: &str, out: &mut UiRequests) {
    ui.horizontal(|ui| {
        ui.set_min_height(ROW);
        ui.label(icons::text(icons::GROUP));
        let id = Id::unique(("title of a group", group));
        let name = name_field(ui, "group", id, group);
        let name = name.map(|name| name.trim().to_owned());
        if let Some(name) = name.filter(|name| !name.is_empty()) {
            out.edit(Edit::RenameGroup(group.to_owned(), name));
        }
    });
}

/// The properties of `last` that others have otherwise.
fn differences(scene: &Scene, selected: &[Item], last: Item) -> Vec<&'static str> {
    let mut names = match last.kind {
        Kind::Light => light_differences(scene, selected, last.index),
        Kind::Object => object_differences(scene, selected, last),
        Kind::Pack => Vec::new(),
    };
    if last.kind != Kind::Light {
        names.extend(pack_differences(scene, selected));
    }
    names
}

/// The same of the packs that are selected or worn.
fn pack_differences(scene: &Scene, selected: &[Item]) -> Vec<&'static str> {
    let selected = &selected[selected.len().saturating_sub(MOST)..];
    let packs = packs_of(scene, selected).filter_map(|place| scene.color_packs.get_index(place));
    let packs: Vec<&ColorPack> = packs.map(|(_, pack)| pack).collect();
    let differ = |alike: &dyn Fn(&ColorPack, &ColorPack) -> bool| {
        packs.windows(2).any(|pair| !alike(pair[0], pair[1]))
    };
    let mut names = Vec::new();
    let mut note = |name, alike: &dyn Fn(&ColorPack, &ColorPack) -> bool| {
        if differ(alike) {
            names.push(name);
        }
    };
    note("ambient", &|a, b| a.ambient == b.ambient);
    note("diffuse", &|a, b| a.diffuse == b.diffuse);
    note("specular", &|a, b| a.specular == b.specular);
    note("phong", &|a, b| a.phong_exponent == b.phong_exponent);
    note("reflective", &|a, b| a.reflective == b.reflective);
    names
}

/// The same of an object.
fn object_differences(scene: &Scene, selected: &[Item], last: Item) -> Vec<&'static str> {
    let of = |item: &Item| scene.objects.get(item.index);
    let Some(object) = of(&last) else {
        return Vec::new();
    };
    let others: Vec<&Object> = selected
        .iter()
        .filter(|item| item.kind == Kind::Object)
        .filter_map(of)
        .take(MOST)
        .collect();
    let theirs: Vec<_> = others.iter().map(|other| values(&other.shape)).collect();
    let mut names = Vec::new();
    for (name, value) in values(&object.shape) {
        let is_other = |(own, other): &(&str, DVec3)| *own == name && *other != value;
        if theirs.iter().flatten().any(is_other) {
            names.push(name);
        }
    }
    if others.iter().any(|other| other.visible != object.visible) {
        names.push("visible");
    }
    if others
        .iter()
        .any(|other| other.color_pack != object.color_pack)
    {
        names.push("color pack");
    }
    names
}

/// The same of a light.
fn light_differences(scene: &Scene, selected: &[Item], last: usize) -> Vec<&'static str> {
    let Some(light) = scene.lights.get(last) else {
        return Vec::new();
    };
    let others: Vec<&Light> = selected
        .iter()
        .filter(|item| item.kind == Kind::Light)
        .filter_map(|item| scene.lights.get(item.index))
        .take(MOST)
        .collect();
    let mut names = Vec::new();
    let mut note = |name, differs: &dyn Fn(&Light) -> bool| {
        if others.iter().any(|other| differs(other)) {
            names.push(name);
        }
    };
    note("position", &|other| other.position != light.position);
    note("intensity", &|other| other.intensity != light.intensity);
    note("on", &|other| other.visible != light.visible);
    note("marker", &|other| other.marker != light.marker);
    names
}
