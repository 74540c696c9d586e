//! The properties of several selected items: changes are made to all that have the property.

use egui::{Id, Key, Ui};
use glam::DVec3;

use super::alike::{chosen_for_all, for_all, packs_of, values};
use super::as_one::transform_group;
use super::items;
use super::keys;
use super::title::{differing, list_differing, name_field, title};
use crate::editor::{Action, Edit, Editor, Item, ItemKind};
use crate::scene::{ColorPack, Light, Object, Scene};
use crate::ui::commands::Command;
use crate::ui::hint::Hinted as _;
use crate::ui::icons;
use crate::ui::obstacles::obstacle;
use crate::ui::requests::UiRequests;
use crate::ui::rows::EditedPart;
use crate::ui::theme::{GRID, ROW};

/// Maximum number of items that are compared, or whose keys are examined, in every UI frame.
const MAX_COMPARED: usize = 500;

/// Shows the properties of the item selected last; a change is made to all items that have the property.
pub fn show(ui: &mut Ui, editor: &Editor, out: &mut UiRequests) {
    let (scene, selected) = (editor.shown(), editor.selection().items());
    let group = editor.selection().group(scene);
    if let Some(group) = group {
        group_title(ui, group, out);
    } else {
        title(ui, icons::SELECTED, &format!("{} items", selected.len()));
    }
    let Some(&last) = selected.last() else { return };
    list_differing(ui, &differences(scene, selected, last));
    let name = last.name(scene).unwrap_or_default();
    ui.weak(if group.is_some() {
        format!(
            "These are the values of {name}. Changing its place, rotation or scale changes that of the whole group; any other change applies to all that have the property."
        )
    } else {
        format!(
            "These are the values of {name}. A change applies to all items that have the property; dragging a position moves them together."
        )
    });
    let obstacle = obstacle(&Command::Join, editor);
    let join = ui.add_enabled(obstacle.is_none(), egui::Button::new("Join"));
    let hint =
        "Join these triangles and meshes into one mesh with the name and color pack of the first";
    if join.hint_unless(obstacle, hint).clicked() {
        out.commands.push(Command::Join);
    }
    if selected.len() <= MAX_COMPARED {
        keys::key_buttons(ui, editor, &keys::keyable_values(scene, selected), out);
    } else {
        ui.weak(format!(
            "Keys can be set for up to {MAX_COMPARED} items at once."
        ));
    }
    ui.add_space(GRID);
    let mut requests = UiRequests::default();
    let chosen = items::item(ui, scene, (last, false), &mut requests);
    // Members of a group keep their own positions, rotations and so on; otherwise they would end up in one place.
    let is_shared = |chosen: &(Edit, EditedPart)| {
        let is_pack = matches!(chosen.0, Edit::Pack(..));
        group.is_none() || is_pack || ["radius", items::COLOR_PACK].contains(&chosen.1.field)
    };
    if let Some(chosen) = chosen.filter(is_shared) {
        out.edit(chosen_for_all(scene, selected, chosen));
    }
    // A group moves as a whole. Other items move together in a drag or by steps only: a click elsewhere that ends
    // typing is none.
    let is_relative = ui.input(|input| {
        let is_stepping = input.key_down(Key::ArrowUp) || input.key_down(Key::ArrowDown);
        is_stepping || input.pointer.is_decidedly_dragging()
    });
    let is_together = group.is_some() || is_relative;
    for action in requests.actions {
        out.actions.push(match action {
            Action::Edit(edit) => match group.and_then(|_| transform_group(scene, selected, &edit))
            {
                Some(Ok(all)) => Action::Edit(all),
                Some(Err(why)) => Action::Tell(why.to_owned()),
                None => Action::Edit(for_all(scene, selected, edit, is_together)),
            },
            other => other,
        });
    }
}

/// The editable name of a group.
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

/// The properties in which others differ from `last`.
fn differences(scene: &Scene, selected: &[Item], last: Item) -> Vec<&'static str> {
    let selected = &selected[selected.len().saturating_sub(MAX_COMPARED)..];
    let mut names = match last.kind {
        ItemKind::Light => light_differences(scene, selected),
        ItemKind::Object => object_differences(scene, selected, last),
        ItemKind::Pack => Vec::new(),
    };
    if last.kind != ItemKind::Light {
        names.extend(pack_differences(scene, selected));
    }
    names
}

/// The properties in which the color packs that are selected or used differ.
fn pack_differences(scene: &Scene, selected: &[Item]) -> Vec<&'static str> {
    let packs = packs_of(scene, selected).filter_map(|index| scene.color_packs.get_index(index));
    let packs: Vec<&ColorPack> = packs.map(|(_, pack)| pack).collect();
    differing(
        &packs,
        &[
            ("ambient", |a, b| a.ambient == b.ambient),
            ("diffuse", |a, b| a.diffuse == b.diffuse),
            ("specular", |a, b| a.specular == b.specular),
            ("phong", |a, b| a.phong_exponent == b.phong_exponent),
            ("reflective", |a, b| a.reflective == b.reflective),
        ],
    )
}

/// The properties in which other objects differ from the last one.
fn object_differences(scene: &Scene, selected: &[Item], last: Item) -> Vec<&'static str> {
    let object_of = |item: &Item| scene.objects.get(item.index);
    let Some(object) = object_of(&last) else {
        return Vec::new();
    };
    let objects: Vec<&Object> = selected
        .iter()
        .filter(|item| item.kind == ItemKind::Object)
        .filter_map(object_of)
        .collect();
    let other_values: Vec<_> = objects.iter().map(|other| values(&other.shape)).collect();
    let mut names = Vec::new();
    for (name, value) in values(&object.shape) {
        let differs = |(other_name, other): &(&str, DVec3)| *other_name == name && *other != value;
        if other_values.iter().flatten().any(differs) {
            names.push(name);
        }
    }
    names.extend(differing(
        &objects,
        &[
            ("visible", |a, b| a.visible == b.visible),
            (items::COLOR_PACK, |a, b| a.color_pack == b.color_pack),
        ],
    ));
    names
}

/// The properties in which the selected lights differ.
fn light_differences(scene: &Scene, selected: &[Item]) -> Vec<&'static str> {
    let lights: Vec<&Light> = selected
        .iter()
        .filter(|item| item.kind == ItemKind::Light)
        .filter_map(|item| scene.lights.get(item.index))
        .collect();
    differing(
        &lights,
        &[
            ("position", |a, b| a.position == b.position),
            ("intensity", |a, b| a.intensity == b.intensity),
            ("on", |a, b| a.visible == b.visible),
            ("marker", |a, b| a.marker == b.marker),
        ],
    )
}
