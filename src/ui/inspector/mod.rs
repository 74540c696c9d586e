//! The inspector, the panel on the right: every property of the selection.

mod title;

mod camera;

mod items;

mod alike;

mod as_one;

mod keys;

mod many;

mod quality;

mod needs;

mod world;

pub use keys::{interpolations_for, replaced_keys_message};
pub use quality::{Outcome, Quality};
pub use title::name_field;

use std::mem::discriminant;

use egui::{ScrollArea, Ui};

use super::requests::UiRequests;
use super::theme::GRID;
use crate::editor::{Editor, Selection};
use crate::scene::Target;

/// Shows the properties of the selection and pushes the user's changes.
pub fn show(ui: &mut Ui, editor: &Editor, quality: &mut Quality, out: &mut UiRequests) {
    keys::report_replaced_keys(ui, editor, out);
    // One scroll area per selected thing, so that each is shown from its top.
    let selection = editor.selection();
    let area = ScrollArea::vertical().id_salt((discriminant(selection), selection.item()));
    area.auto_shrink(false).show(ui, |ui| {
        ui.add_space(GRID / 2.0);
        let scene = editor.shown();
        match selection {
            Selection::Camera => camera::show(ui, editor, out),
            Selection::Keys(keys) => keys::show(ui, editor, keys, out),
            Selection::World => {
                world::show(ui, scene, out);
                let ambient = ("ambient", vec![Target::AmbientIntensity]);
                keys::key_buttons(ui, editor, &[ambient], out);
            }
            Selection::Render => world::show_picture(ui, editor, quality, out),
            Selection::Items(items) => match items[..] {
                [item] => {
                    items::item(ui, scene, (item, true), out);
                    keys::key_buttons(ui, editor, &keys::keyable_values(scene, &[item]), out);
                }
                _ => many::show(ui, editor, out),
            },
        }
        ui.add_space(GRID);
        needs::show(ui, editor, quality.in_use(editor));
        ui.add_space(GRID);
    });
}
