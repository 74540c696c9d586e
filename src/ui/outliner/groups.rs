//! The rows of groups in the list of objects.

use std::collections::HashSet;

use egui::{Id, Rect, Response, Ui, UiBuilder};

use super::drop::accept_drop_on_group;
use super::entry::{Renaming, RowStyle, entry, eye_button, rename_field, row};
use super::lines::Group;
use crate::editor::{Edit, Editor, Item, Selection};
use crate::ui::commands::Command;
use crate::ui::icons;
use crate::ui::menu_entry::{ITEM_COMMANDS, offer};
use crate::ui::requests::UiRequests;
use crate::ui::theme::{GRID, ROW};

/// The state of the group rows.
#[derive(Debug, Default)]
pub struct GroupRows {
    /// Names of the groups whose members are hidden in the list.
    pub folded: Vec<String>,
    /// The group that is being renamed.
    pub renaming: Option<String>,
}

impl GroupRows {
    /// Shows the row of a group, which can fold, select, show and hide its members and take objects dropped on it.
    /// `None` while it is being renamed.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        editor: &Editor,
        (group, is_selected): (&Group, bool),
        out: &mut UiRequests,
    ) -> Option<Response> {
        if self.renaming.as_ref() == Some(&group.name) {
            self.rename(ui, editor, group, out);
            return None;
        }
        let scene = editor.shown();
        let is_seen = |item: Item| item.is_visible(scene) == Some(true);
        let is_bright = group.items().any(is_seen);
        let (rect, eye) = row(ui).split_left_right_at_x(ui.max_rect().right() - ROW - GRID / 2.0);
        let (fold, rect) = rect.split_left_right_at_x(rect.left() + ROW);
        let is_folded = self.fold_button(ui, fold, &group.name);
        let style = RowStyle {
            icon: icons::GROUP,
            is_bright,
            is_selected,
        };
        let response = entry(ui, rect, style, &group.name);
        if response.clicked() {
            let selected = selection_after_click(ui, editor.selection(), group.items());
            out.select(selected);
        }
        if response.double_clicked() {
            self.renaming = Some(group.name.clone());
        }
        accept_drop_on_group(ui, editor, &response, (group, is_folded), out);
        response.context_menu(|ui| {
            if !is_selected {
                out.select(Selection::all(group.items()));
            }
            for (text, command) in ITEM_COMMANDS {
                if command != Command::Rename {
                    offer(ui, editor, text, command, out);
                } else if ui.button(text).clicked() {
                    self.renaming = Some(group.name.clone());
                }
            }
        });
        ui.scope_builder(UiBuilder::new().max_rect(eye), |ui| {
            if eye_button(ui, is_bright, &group.name) {
                let verb = if is_bright { "Hide" } else { "Show" };
                let edits = group.items();
                let edits = edits.filter_map(|item| Edit::visible(scene, item, !is_bright));
                let label = format!("{verb} {}", group.name);
                out.edit(Edit::Each(edits.collect(), label));
            }
        });
        Some(response)
    }

    /// A button that folds and unfolds the group; returns whether it was folded before.
    fn fold_button(&mut self, ui: &mut Ui, rect: Rect, name: &str) -> bool {
        let is_folded = self.folded.iter().any(|folded| folded == name);
        let (icon, verb) = if is_folded {
            (icons::FORWARD, "Unfold")
        } else {
            (icons::MORE, "Fold")
        };
        let button = ui.scope_builder(UiBuilder::new().max_rect(rect), |ui| {
            icons::button(ui, icon, &format!("{verb} {name}"))
        });
        if button.inner.clicked() {
            if is_folded {
                self.folded.retain(|folded| folded != name);
            } else {
                self.folded.push(name.to_owned());
            }
        }
        is_folded
    }

    fn rename(&mut self, ui: &mut Ui, editor: &Editor, group: &Group, out: &mut UiRequests) {
        let rect = row(ui);
        ui.scope_builder(UiBuilder::new().max_rect(rect), |ui| {
            let id = Id::unique(("name of the group", &group.name));
            let label = "new name of the group";
            match rename_field(ui, rect, (label, id), &group.name) {
                Renaming::Ongoing => return,
                Renaming::Cancelled => {}
                Renaming::To(new) if new.trim().is_empty() => {}
                Renaming::To(new) => {
                    let name = new.trim().to_owned();
                    // Renaming to the name of another group is refused.
                    let mut groups = editor.scene().objects.iter().map(|object| &object.group);
                    let is_free = !groups.any(|other| *other == name);
                    if is_free {
                        let renamed = self
                            .folded
                            .iter_mut()
                            .filter(|folded| **folded == group.name);
                        renamed.for_each(|folded| folded.clone_from(&name));
                    }
                    out.edit(Edit::RenameGroup(group.name.clone(), name));
                }
            }
            self.renaming = None;
        });
    }
}

/// The selection after a click on a group: Shift adds it, Ctrl toggles it, a plain click selects it alone.
fn selection_after_click(
    ui: &Ui,
    selected: &Selection,
    members: impl ExactSizeIterator<Item = Item> + Clone,
) -> Selection {
    let modifiers = ui.input(|input| input.modifiers);
    if !modifiers.shift && !modifiers.command {
        return Selection::all(members);
    }
    let member_set: HashSet<Item> = members.clone().collect();
    let others = selected.items().iter().copied();
    let others = others.filter(|item| !member_set.contains(item));
    if !modifiers.shift && selected.has_all(members.clone()) {
        Selection::all(others)
    } else {
        Selection::all(others.chain(members))
    }
}
