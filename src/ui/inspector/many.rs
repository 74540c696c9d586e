//! Several things at once: what they have in common is changed for all.

use egui::Ui;
use glam::DVec3;

use super::items;
use super::title::title;
use crate::editor::{Action, Edit, Editor, Item, Kind};
use crate::scene::{FieldValue, Light, Object, Scene, Shape};
use crate::ui::hint::Hint as _;
use crate::ui::icons;
use crate::ui::requests::UiRequests;
use crate::ui::theme::GRID;

/// Most things that are compared, in every frame of the window.
const MOST: usize = 500;

/// The properties of what was selected last; a change is made to all that have the property.
pub fn show(ui: &mut Ui, editor: &Editor, out: &mut UiRequests) {
    let (scene, selected) = (editor.shown(), editor.selected().items());
    title(ui, icons::SELECTED, &format!("{} items", selected.len()));
    let Some(&last) = selected.last() else { return };
    let different = differences(scene, selected, last);
    if !different.is_empty() {
        ui.weak(format!("Not the same for all: {}", different.join(", ")));
    }
    ui.weak("A change is made to all that have the property. A position that is dragged moves them together.");
    let objects = of_kind(selected, Kind::Object);
    let is_joinable = |index: &usize| {
        let object = scene.objects.get(*index);
        object.is_some_and(|object| matches!(object.shape, Shape::Triangle(_) | Shape::Mesh(_)))
    };
    let can_join = objects.len() == selected.len() && objects.iter().all(is_joinable);
    let join = ui.add_enabled(can_join, egui::Button::new("Join"));
    let hint = "Make one mesh of these triangles and meshes";
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
        Kind::Pack => {}
    }
    let is_dragged = ui.input(|input| input.pointer.any_down());
    for action in own.actions {
        out.actions.push(match action {
            Action::Edit(edit) => {
                let moved = moved_by(scene, &edit).filter(|_| is_dragged);
                Action::Edit(match moved {
                    Some(by) => move_all(scene, selected, by),
                    None => for_all(scene, selected, edit),
                })
            }
            other => other,
        });
    }
}

/// The places of the items of a kind, in ascending order.
fn of_kind(items: &[Item], kind: Kind) -> Vec<usize> {
    let mut places: Vec<usize> = items
        .iter()
        .filter(|item| item.kind == kind)
        .map(|item| item.index)
        .collect();
    places.sort_unstable();
    places
}

/// By how much a change moves something, if it does nothing else.
fn moved_by(scene: &Scene, edit: &Edit) -> Option<DVec3> {
    let (by, is_all) = match edit {
        Edit::Object(index, new, _) => {
            let old = &scene.objects.get(*index)?.shape;
            let by = new.shape.position() - old.position();
            (by, old.moved(by) == new.shape)
        }
        Edit::Light(index, new, _) => (new.position - scene.lights.get(*index)?.position, true),
        _ => return None,
    };
    (is_all && by != DVec3::ZERO).then_some(by)
}

/// Moves everything that is selected.
fn move_all(scene: &Scene, selected: &[Item], by: DVec3) -> Edit {
    let edits = selected.iter().filter_map(|item| match item.kind {
        Kind::Object => {
            let mut object = scene.objects.get(item.index)?.clone();
            object.shape = object.shape.moved(by);
            Some(Edit::object(item.index, object, "position"))
        }
        Kind::Light => {
            let mut light = scene.lights.get(item.index)?.clone();
            light.position += by;
            Some(Edit::Light(item.index, light, "position"))
        }
        Kind::Pack => None,
    });
    Edit::Each(edits.collect(), format!("Move {} items", selected.len()))
}

/// The same change for everything that is selected.
fn for_all(scene: &Scene, selected: &[Item], edit: Edit) -> Edit {
    let count = selected.len();
    let (edits, field): (Vec<Edit>, &str) = match edit {
        Edit::Object(index, new, field) => {
            let Some(old) = scene.objects.get(index) else {
                return Edit::Object(index, new, field);
            };
            let edits = selected
                .iter()
                .filter_map(|item| like_object(scene, *item, (old, &new), field));
            (edits.collect(), field)
        }
        Edit::Light(index, new, field) => {
            let Some(old) = scene.lights.get(index) else {
                return Edit::Light(index, new, field);
            };
            let edits = selected
                .iter()
                .filter_map(|item| like_light(scene, *item, (old, &new), field));
            (edits.collect(), field)
        }
        other => return other,
    };
    Edit::Each(edits, format!("{count} items: {field}"))
}

/// The change of an item that makes it like an object that has changed.
fn like_object(
    scene: &Scene,
    item: Item,
    (old, new): (&Object, &Object),
    field: &'static str,
) -> Option<Edit> {
    let Item { kind, index } = item;
    match kind {
        Kind::Object => {
            let mut object = scene.objects.get(index)?.clone();
            if new.color_pack != old.color_pack {
                object.color_pack.clone_from(&new.color_pack);
            }
            if new.visible != old.visible {
                object.visible = new.visible;
            }
            take_changes(&mut object.shape, &old.shape, &new.shape);
            Some(Edit::object(index, object, field))
        }
        Kind::Light => {
            let mut light = scene.lights.get(index)?.clone();
            if new.visible != old.visible {
                light.visible = new.visible;
            }
            if let (true, Some(marker)) = (new.color_pack != old.color_pack, &mut light.marker) {
                marker.color_pack.clone_from(&new.color_pack);
            }
            Some(Edit::Light(index, light, field))
        }
        Kind::Pack => None,
    }
}

/// The change of an item that makes it like a light that has changed.
fn like_light(
    scene: &Scene,
    item: Item,
    (old, new): (&Light, &Light),
    field: &'static str,
) -> Option<Edit> {
    let Item { kind, index } = item;
    match kind {
        Kind::Light => {
            let mut light = scene.lights.get(index)?.clone();
            light.position = changed(light.position, old.position, new.position);
            if new.intensity != old.intensity {
                light.intensity = new.intensity;
            }
            if new.visible != old.visible {
                light.visible = new.visible;
            }
            if new.marker != old.marker {
                light.marker.clone_from(&new.marker);
            }
            Some(Edit::Light(index, light, field))
        }
        Kind::Object => {
            let mut object = scene.objects.get(index)?.clone();
            if new.visible != old.visible {
                object.visible = new.visible;
            }
            Some(Edit::object(index, object, field))
        }
        Kind::Pack => None,
    }
}

/// `own` with those coordinates that have changed.
fn changed(own: DVec3, old: DVec3, new: DVec3) -> DVec3 {
    DVec3::select(new.cmpne(old), new, own)
}

/// Every property of a shape by its name; one number stands for three.
fn values(shape: &Shape) -> Vec<(&'static str, DVec3)> {
    let mut values = Vec::new();
    shape.clone().fields(&mut |field| {
        values.push((field.name, value_of(&field.value)));
    });
    values
}

fn value_of(value: &FieldValue) -> DVec3 {
    match value {
        FieldValue::Point(vector)
        | FieldValue::Direction(vector)
        | FieldValue::Angles(vector)
        | FieldValue::Factors(vector) => **vector,
        FieldValue::Length(number) | FieldValue::Angle(number) => DVec3::splat(**number),
    }
}

/// Changes the properties of a shape that have changed from `old` to `new`, where it has them.
fn take_changes(shape: &mut Shape, old: &Shape, new: &Shape) {
    let (old, new) = (values(old), values(new));
    shape.fields(&mut |field| {
        let of = |values: &[(&str, DVec3)]| {
            let mut named = values.iter().filter(|(name, _)| *name == field.name);
            named.next().map(|(_, value)| *value)
        };
        let (Some(old), Some(new)) = (of(&old), of(&new)) else {
            return;
        };
        match field.value {
            FieldValue::Point(own)
            | FieldValue::Direction(own)
            | FieldValue::Angles(own)
            | FieldValue::Factors(own) => *own = changed(*own, old, new),
            FieldValue::Length(own) | FieldValue::Angle(own) => {
                *own = changed(DVec3::splat(*own), old, new).x;
            }
        }
    });
}

/// The properties of `last` that others of its kind do not have, or have otherwise.
fn differences(scene: &Scene, selected: &[Item], last: Item) -> Vec<&'static str> {
    if last.kind != Kind::Object {
        return Vec::new();
    }
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
        if !theirs.iter().all(|values| values.contains(&(name, value))) {
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
