//! The panel on the right: every property of what is selected.

mod camera;

mod items;

mod keys;

mod needs;

mod world;

pub use keys::target;

use egui::{Align2, Id, RichText, ScrollArea, TextEdit, Ui};
use egui_material_icons::MaterialIcon;

use super::icons;
use super::requests::UiRequests;
use super::theme::{GRID, ROW};
use crate::editor::{Edit, Editor, Item, Kind, Selection};
use crate::scene::Target;

/// Shows the selection and pushes its changes.
pub fn show(ui: &mut Ui, editor: &Editor, out: &mut UiRequests) {
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        ui.add_space(GRID / 2.0);
        let scene = editor.shown();
        match editor.selection {
            Selection::Camera => camera::show(ui, editor, out),
            Selection::Keys => keys::show(ui, editor, out),
            Selection::World => {
                world::show(ui, scene, out);
                keys::of_values(ui, editor, &[("ambient", Target::AmbientIntensity)], out);
            }
            Selection::Render => world::show_picture(ui, scene, out),
            Selection::Item(Item {
                kind: Kind::Light,
                index,
            }) => {
                if let Some(value) = scene.lights.get(index) {
                    items::light(ui, scene, index, value, out);
                    let owner = value.name.clone();
                    let light = [
                        ("position", Target::LightPosition(owner.clone())),
                        ("intensity", Target::LightIntensity(owner)),
                    ];
                    keys::of_values(ui, editor, &light, out);
                }
            }
            Selection::Item(Item {
                kind: Kind::Object,
                index,
            }) => {
                if let Some(value) = scene.objects.get(index) {
                    items::object(ui, scene, index, value, out);
                    let owner = Target::ObjectPosition(value.name.clone());
                    keys::of_values(ui, editor, &[("position", owner)], out);
                }
            }
            Selection::Item(Item {
                kind: Kind::Pack,
                index,
            }) => {
                if let Some((name, value)) = scene.color_packs.get_index(index) {
                    title_field(ui, icons::PACK, Item::pack(index), name, out);
                    items::pack(ui, index, value, out);
                    items::used_by(ui, scene, name, out);
                }
            }
        }
        ui.add_space(GRID);
        needs::show(ui, editor);
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
fn title_field(ui: &mut Ui, icon: MaterialIcon, item: Item, name: &str, out: &mut UiRequests) {
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
