//! A row of the outliner.

use egui::{AtomExt as _, Button, Color32, Id, Rect, Sense, Ui, vec2};
use egui_material_icons::MaterialIcon;

use crate::editor::{Item, ItemKind};
use crate::scene::Scene;
use crate::ui::hint::Hinted as _;
use crate::ui::icons;
use crate::ui::inspector::name_field;
use crate::ui::prompts::select_letters;
use crate::ui::rows::to_bytes;
use crate::ui::theme::{ROW, palette};

/// Approximate number of letters that fit into a row; longer names have a tooltip.
const MAX_LETTERS: usize = 18;

/// The colour of an object's or a color pack's matte reflection; the ambient colour if that is black.
pub fn color_of(scene: &Scene, item: Item) -> Option<Color32> {
    let name = item
        .color_pack(scene)
        .filter(|_| item.kind != ItemKind::Light)?;
    let pack = scene.color_packs.get(name)?;
    let is_matte = pack.diffuse.abs().max_element() > 0.0;
    let color = if is_matte { pack.diffuse } else { pack.ambient };
    let [red, green, blue] = to_bytes(color);
    Some(Color32::from_rgb(red, green, blue))
}

/// Allocates the next row of the list, over its whole width.
pub fn row(ui: &mut Ui) -> Rect {
    ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::hover())
        .0
}

/// The appearance of an entry.
#[derive(Clone, Copy)]
pub struct RowStyle {
    /// Its icon.
    pub icon: MaterialIcon,
    /// Whether it is drawn in full brightness, as visible in the picture.
    pub is_bright: bool,
    /// Whether it is selected.
    pub is_selected: bool,
}

/// Draws an entry that can be selected and dragged.
pub fn entry(ui: &mut Ui, rect: Rect, style: RowStyle, name: &str) -> egui::Response {
    let colors = palette(ui.ctx());
    let color = if style.is_bright {
        colors.text
    } else {
        colors.muted
    };
    let texts = (
        icons::text(style.icon).color(color),
        // Long names are truncated, not the icon.
        egui::RichText::new(name).color(color).atom_shrink(true),
    );
    let button = Button::selectable(style.is_selected, texts)
        .right_text("")
        .truncate()
        .sense(Sense::click_and_drag())
        .min_size(rect.size());
    let shown = ui.put(rect, button).accessible_name(name);
    if name.chars().count() > MAX_LETTERS {
        return shown.hint(name);
    }
    shown
}

/// A button that hides what is visible and shows what is hidden. Returns whether it was pressed.
pub fn eye_button(ui: &mut Ui, visible: bool, name: &str) -> bool {
    let (icon, verb) = if visible {
        (icons::VISIBLE, "Hide")
    } else {
        (icons::HIDDEN, "Show")
    };
    icons::button(ui, icon, &format!("{verb} {name}")).clicked()
}

/// The state of a rename field.
pub enum Renaming {
    /// Editing goes on.
    Ongoing,
    /// The user left it without a new name.
    Cancelled,
    /// The new name.
    To(String),
}

/// A text field in a row for a new name.
pub fn rename_field(ui: &mut Ui, row: Rect, (label, id): (&str, Id), name: &str) -> Renaming {
    let has_lost_focus =
        |ui: &Ui| ui.memory(|memory| memory.had_focus_last_frame(id) && !memory.has_focus(id));
    // A field that has just lost the focus must not get it back: its text is taken over or discarded.
    if !ui.memory(|memory| memory.has_focus(id)) && !has_lost_focus(ui) {
        ui.memory_mut(|memory| memory.request_focus(id));
        // Selected, so that typing replaces the old name.
        select_letters(ui, id, 0..name.chars().count());
    }
    if let Some(new) = name_field(ui, label, id, name) {
        return Renaming::To(new);
    }
    let is_left = ui.input(|input| {
        let at = input.pointer.interact_pos();
        let is_within = at.is_some_and(|at| row.contains(at));
        input.pointer.any_pressed() && !is_within
    });
    if is_left || has_lost_focus(ui) {
        Renaming::Cancelled
    } else {
        Renaming::Ongoing
    }
}
