//! The context menu of a key.

use egui::Ui;

use crate::editor::{Edit, Editor};
use crate::scene::{Easing, KeyPlace};
use crate::ui::inspector::key_ways;
use crate::ui::requests::UiRequests;

/// Shows entries for way, pace and deletion of the selected keys, one of which is at `place`.
pub fn menu(ui: &mut Ui, place: KeyPlace, editor: &Editor, out: &mut UiRequests) {
    let animation = &editor.scene().animation;
    let places = editor.selection().keys();
    let Some((_, (own_way, own_pace))) = animation.at_place(place) else {
        return;
    };
    for way in key_ways(editor, places, own_way) {
        if ui.radio(own_way == way, way.name()).clicked() {
            let changed = animation.with_pace(places, |(each, _)| *each = way);
            out.edit(Edit::animation(changed, "Key: interpolation"));
        }
    }
    ui.separator();
    for pace in Easing::ALL {
        if ui.radio(own_pace == pace, pace.name()).clicked() {
            let changed = animation.with_pace(places, |(_, each)| *each = pace);
            out.edit(Edit::animation(changed, "Key: easing"));
        }
    }
    ui.separator();
    if ui.button("Delete").clicked() {
        // Keys only: an undo while the menu is open may have changed the selection to something else.
        out.edit(Edit::delete_keys(animation, places));
    }
}
