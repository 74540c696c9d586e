//! The context menu of a key.

use egui::Ui;

use crate::editor::{Edit, Editor};
use crate::scene::{Easing, KeyId};
use crate::ui::commands::Command;
use crate::ui::inspector::interpolations_for;
use crate::ui::requests::UiRequests;

/// Shows entries for interpolation and easing of the selected keys, for copies and for deletion of them, one of which is at `place`.
pub fn menu(ui: &mut Ui, place: KeyId, editor: &Editor, out: &mut UiRequests) {
    let animation = &editor.scene().animation;
    let places = editor.selection().keys();
    let Some((_, (current_interpolation, current_easing))) = animation.time_and_pace_of(place)
    else {
        return;
    };
    for interpolation in interpolations_for(editor, places, current_interpolation) {
        if ui
            .radio(current_interpolation == interpolation, interpolation.name())
            .clicked()
        {
            out.edit(Edit::key_interpolation(animation, places, interpolation));
        }
    }
    ui.separator();
    for easing in Easing::ALL {
        if ui.radio(current_easing == easing, easing.name()).clicked() {
            out.edit(Edit::key_easing(animation, places, easing));
        }
    }
    ui.separator();
    if ui.button("Duplicate to the playhead").clicked() {
        out.commands.push(Command::Duplicate);
    }
    if ui.button("Delete").clicked() {
        // Keys only: an undo while the menu is open may have changed the selection to something else.
        out.edit(Edit::delete_keys(animation, places));
    }
}
