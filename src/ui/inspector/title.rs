//! Titles of the inspected items, with editable names.

use egui::{Align2, Id, Label, RichText, TextEdit, Ui};
use egui_material_icons::MaterialIcon;

use crate::editor::{Edit, Item};
use crate::ui::icons;
use crate::ui::requests::UiRequests;
use crate::ui::theme::ROW;

/// Shows an icon and a heading.
pub fn title(ui: &mut Ui, icon: MaterialIcon, name: &str) {
    ui.horizontal(|ui| {
        ui.set_min_height(ROW);
        ui.label(icons::text(icon));
        ui.add(Label::new(RichText::new(name).heading()).truncate());
    });
}

/// Shows the title of an item: its icon, and its name as an editable field.
pub fn title_field(ui: &mut Ui, icon: MaterialIcon, item: Item, name: &str, out: &mut UiRequests) {
    ui.horizontal(|ui| {
        ui.set_min_height(ROW);
        ui.label(icons::text(icon));
        if let Some(new) = name_field(ui, "name", Id::unique(("title", item)), name) {
            out.edit(Edit::Rename(item, new));
        }
    });
}

/// A text field that returns the text when the user leaves it by Enter or a click elsewhere, and discards it on
/// Escape.
pub fn name_field(ui: &mut Ui, label: &str, id: Id, name: &str) -> Option<String> {
    // The typed text is stored with the name that it replaces: another item may be shown by now.
    let typed = ui.data(|data| data.get_temp::<(String, String)>(id));
    let typed = typed.filter(|(replaced, _)| replaced == name);
    let mut text = typed.map_or_else(|| name.to_owned(), |(_, text)| text);
    let field = TextEdit::singleline(&mut text)
        .id(id)
        .char_limit(200)
        .align(Align2::LEFT_CENTER);
    let response = ui
        .add_sized([ui.available_width(), ROW], field)
        .accessible_name(label);
    if response.lost_focus() {
        ui.data_mut(|data| data.remove::<(String, String)>(id));
        let is_cancelled = ui.input(|input| input.key_pressed(egui::Key::Escape));
        let text = text.trim();
        return (!is_cancelled && text != name).then(|| text.to_owned());
    }
    if response.changed() {
        ui.data_mut(|data| data.insert_temp(id, (name.to_owned(), text)));
    } else if !ui.memory(|memory| memory.has_focus(id)) {
        // Unlike the response, the memory keeps the focus while another window is in use.
        ui.data_mut(|data| data.remove::<(String, String)>(id));
    }
    None
}

/// Compares a property of two items.
type IsAlike<T> = fn(&T, &T) -> bool;

/// The properties, each given by name and comparison, that are not the same for all.
pub fn differing<T>(all: &[T], properties: &[(&'static str, IsAlike<T>)]) -> Vec<&'static str> {
    let differ = properties.iter().filter(|(_, is_alike)| {
        let mut pairs = all.windows(2);
        pairs.any(|pair| !is_alike(&pair[0], &pair[1]))
    });
    differ.map(|(name, _)| *name).collect()
}

/// Lists the properties in which the selected items differ.
pub fn list_differing(ui: &mut Ui, names: &[&str]) {
    if names.is_empty() {
        // The widgets below must keep the automatic ids that they have with the line, even during a drag.
        ui.skip_ahead_auto_ids(1);
    } else {
        ui.weak(format!("Not the same for all: {}", names.join(", ")));
    }
}
