//! The outliner, the panel on the left: everything in the scene by name. Only visible rows are laid out: without a
//! filter, which has to test all names, ten thousand objects cost no more than twenty.

mod entry;

mod lines;

mod drop;

mod groups;

mod walk;

use egui::{
    Align, Id, Layout, Rect, Response, ScrollArea, Sense, Stroke, StrokeKind, TextEdit, Ui,
    UiBuilder, pos2, vec2,
};

use self::drop::{accept_drop, accept_drop_at_end};
use self::entry::{Renaming, RowStyle, color_of, entry, eye_button, rename_field, row};
use self::groups::GroupRows;
use self::lines::{Entries, Groups, Line, Lines};
use self::walk::{Listed, Walk};
use super::add::add_menu;
use super::icons;
use super::menu_entry::{ITEM_COMMANDS, offer};
use super::requests::UiRequests;
use super::theme::{GRID, ROW, palette};
use crate::editor::{Action, Edit, Editor, Item, ItemKind, Selection};
use crate::scene::Scene;

/// Indentation of group members: they start at the group's name, which follows an arrow.
const MEMBER_INDENT: f32 = ROW + 2.0 * GRID;

/// The state of the panel between frames.
#[derive(Debug, Default)]
pub struct Outliner {
    filter: String,
    /// The document shown last (see [`Editor::documents`]), and the item selected in it.
    last_shown: (u64, Option<Item>),
    /// Scroll offset and visible height of the list, in points.
    scrolled: (f32, f32),
    folded: Vec<ItemKind>,
    /// The item that is being renamed, and its name when that began.
    renaming: Option<(Item, String)>,
    /// Whether to scroll to the selected item even if the selection has not changed.
    reveals_selection: bool,
    groups: Groups,
    group_rows: GroupRows,
    walk: Walk,
}

impl Outliner {
    /// Starts renaming the selected item or group in its row.
    pub fn rename(&mut self, scene: &Scene, selected: &Selection) {
        let Some(item) = selected.item() else { return };
        self.filter.clear();
        self.folded.retain(|kind| *kind != item.kind);
        self.reveals_selection = true;
        if selected.items().len() > 1 {
            self.group_rows.renaming = selected.group(scene).map(str::to_owned);
            return;
        }
        if let (ItemKind::Object, Some(object)) = (item.kind, scene.objects.get(item.index)) {
            self.group_rows
                .folded
                .retain(|group| *group != object.group);
        }
        self.renaming = item.name(scene).map(|name| (item, name.to_owned()));
    }

    fn is_filtered(&self) -> bool {
        !self.filter.trim().is_empty()
    }

    /// Clears the filter; returns whether there was one.
    pub fn clear_filter(&mut self) -> bool {
        let is_filtered = !self.filter.is_empty();
        self.filter.clear();
        is_filtered
    }

    /// Returns whether the arrow keys that are held move through the list.
    pub fn has_keys(&self, ui: &Ui) -> bool {
        self.walk.has_keys(ui)
    }

    /// Shows the panel and pushes the user's requests; `keys_are_free` says whether it may handle keys.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        editor: &Editor,
        keys_are_free: bool,
        out: &mut UiRequests,
    ) {
        ui.add_space(GRID / 2.0);
        if self.last_shown.0 != editor.documents() {
            // Filter and renaming belong to the previous document.
            self.clear_filter();
            self.renaming = None;
            self.group_rows = GroupRows::default();
        }
        ui.horizontal(|ui| self.show_filter(ui, editor, out));
        let mut groups = std::mem::take(&mut self.groups);
        groups.update(&editor.scene().objects, &mut self.group_rows.folded);
        let lines = self.lines(editor.scene(), &groups);
        // Computed once for all rows: there may be many large groups, with many selected objects.
        let marks = editor
            .selection()
            .object_marks(editor.scene().objects.len());
        let listed = Listed {
            lines: &lines,
            groups: &groups.all,
            marks: &marks,
        };
        let walked = self.walk.step(ui, (editor, listed), keys_are_free);
        let walked = walked.map(|(row, action)| {
            out.actions.push(action);
            row
        });
        ui.spacing_mut().item_spacing.y = 0.0;
        let mut area = ScrollArea::vertical().auto_shrink(false);
        let row_to_reveal = walked.or_else(|| self.row_to_reveal(editor, listed));
        if let Some(to) = row_to_reveal.and_then(|row| self.reveal_offset(row)) {
            area = area.vertical_scroll_offset(to);
        }
        self.last_shown = (editor.documents(), editor.selection().item());
        let mut rows = 0..0;
        let shown = area.show_rows(ui, ROW, lines.len(), |ui, range| {
            rows = range.clone();
            for index in range {
                self.show_line(ui, editor, (listed, index), out);
            }
        });
        // Renaming ends when its row is scrolled out of sight; otherwise it would take the keys once it is back.
        if !std::mem::take(&mut self.reveals_selection)
            && !rows.any(|row| self.is_renamed(listed, row))
        {
            self.renaming = None;
            self.group_rows.renaming = None;
        }
        self.groups = groups;
        self.scrolled = (shown.state.clamped_offset().y, shown.inner_rect.height());
    }

    /// Returns whether the name in a row is being edited.
    fn is_renamed(&self, listed: Listed, row: usize) -> bool {
        match listed.lines.get(row) {
            Some(Line::Entry(item, _)) => {
                self.renaming.as_ref().is_some_and(|(own, _)| *own == item)
            }
            Some(Line::Group(group_index)) => {
                self.group_rows.renaming.as_ref() == Some(&listed.groups[group_index].name)
            }
            _ => false,
        }
    }

    fn show_filter(&mut self, ui: &mut Ui, editor: &Editor, out: &mut UiRequests) {
        // As many buttons as were there before the text changed in this frame, or the list would be too wide.
        let is_filtered = !self.filter.is_empty();
        let buttons = if is_filtered { 2.0 } else { 1.0 };
        let width = ui.available_width() - (ROW + GRID) * buttons;
        let field = TextEdit::singleline(&mut self.filter).hint_text("Filter");
        ui.add_sized([width, ROW], field.align(egui::Align2::LEFT_CENTER))
            .accessible_name("Filter");
        if is_filtered && icons::button(ui, icons::CLOSE, "Clear the filter").clicked() {
            self.clear_filter();
        }
        let add = icons::button(ui, icons::ADD, "Add to scene");
        egui::Popup::menu(&add).show(|ui| add_menu(ui, editor.shown(), out));
    }

    fn show_line(
        &mut self,
        ui: &mut Ui,
        editor: &Editor,
        (listed, index): (Listed, usize),
        out: &mut UiRequests,
    ) {
        match listed.lines.get(index) {
            Some(Line::Fixed(selection, icon, name)) => {
                let rect = row(ui);
                let style = RowStyle {
                    icon,
                    is_bright: true,
                    is_selected: editor.selection() == selection,
                };
                let response = entry(ui, rect, style, name);
                self.walk.track_focus(ui, index, &response);
                if response.clicked() {
                    out.select(selection.clone());
                }
            }
            Some(Line::Title(kind, count, listed_count)) => {
                let is_all = self.filter.is_empty() || self.folded.contains(&kind);
                let words = if is_all {
                    count.to_string()
                } else {
                    format!("{listed_count} of {count}")
                };
                self.title(ui, editor, (kind, &words), out);
            }
            Some(Line::Group(group_index)) => {
                let group = &listed.groups[group_index];
                let is_marked = |member| listed.is_marked(editor, member);
                let is_selected = group.items().all(is_marked);
                let row = (group, is_selected);
                if let Some(response) = self.group_rows.show(ui, editor, row, out) {
                    self.walk.track_focus(ui, index, &response);
                }
            }
            Some(Line::Entry(item, is_in_group)) => {
                let entry = (listed, item, is_in_group);
                if let Some(response) = self.item(ui, editor, entry, out) {
                    self.walk.track_focus(ui, index, &response);
                }
            }
            None => {}
        }
    }

    /// The row of the item that was just selected elsewhere.
    fn row_to_reveal(&self, editor: &Editor, listed: Listed) -> Option<usize> {
        let item = editor.selection().item();
        let is_new = self.reveals_selection || self.last_shown != (editor.documents(), item);
        (is_new && item.is_some())
            .then(|| listed.row_of(editor))
            .flatten()
    }

    /// The scroll offset that makes a row visible; `None` if it already is.
    fn reveal_offset(&self, row: usize) -> Option<f32> {
        let top = row as f32 * ROW;
        let (from, height) = self.scrolled;
        let is_seen = top >= from && top + ROW <= from + height;
        (!is_seen).then(|| (top - (height - ROW) / 2.0).max(0.0))
    }

    fn lines<'a>(&self, scene: &Scene, groups: &'a Groups) -> Lines<'a> {
        let filter = self.filter.trim().to_lowercase();
        let entries = |kind: ItemKind, count: usize| {
            if self.folded.contains(&kind) {
                return Entries::All(0);
            }
            if filter.is_empty() && kind == ItemKind::Object && !groups.all.is_empty() {
                return Entries::Grouped(groups);
            }
            if filter.is_empty() {
                return Entries::All(count);
            }
            let matches = |&index: &usize| {
                let item = Item { kind, index };
                let mut names = item.name(scene).into_iter().chain(item.group(scene));
                names.any(|name| name.to_lowercase().contains(&filter))
            };
            Entries::Filtered((0..count).filter(matches).collect())
        };
        let kinds = [ItemKind::Light, ItemKind::Object, ItemKind::Pack];
        Lines(kinds.map(|kind| {
            let count = kind.count(scene);
            (kind, count, entries(kind, count))
        }))
    }

    fn title(
        &mut self,
        ui: &mut Ui,
        editor: &Editor,
        (kind, words): (ItemKind, &str),
        out: &mut UiRequests,
    ) {
        let name = match kind {
            ItemKind::Light => "Lights",
            ItemKind::Object => "Objects",
            ItemKind::Pack => "ColorPacks",
        };
        let is_folded = self.folded.contains(&kind);
        let (rect, response) =
            ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::click());
        response
            .widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, true, !is_folded, name));
        let colors = palette(ui.ctx());
        let mut arrow =
            Rect::from_center_size(pos2(rect.left() + 8.0, rect.center().y), vec2(8.0, 8.0));
        if is_folded {
            arrow = arrow.translate(vec2(-1.0, 0.0));
        }
        egui::collapsing_header::paint_default_icon(
            &mut ui.new_child(UiBuilder::new().max_rect(arrow)),
            if is_folded { 0.0 } else { 1.0 },
            &response.clone().with_new_rect(arrow),
        );
        let font = egui::TextStyle::Body.resolve(ui.style());
        let painter = ui.painter();
        painter.text(
            pos2(rect.left() + 20.0, rect.center().y),
            egui::Align2::LEFT_CENTER,
            name,
            font.clone(),
            colors.muted,
        );
        painter.text(
            pos2(rect.right() - GRID, rect.center().y),
            egui::Align2::RIGHT_CENTER,
            words,
            font,
            colors.muted,
        );
        if kind == ItemKind::Pack {
            accept_drop_at_end(ui, editor, (&response, self.is_filtered()), out);
        }
        if response.clicked() {
            if is_folded {
                self.folded.retain(|folded| *folded != kind);
            } else {
                self.folded.push(kind);
            }
        }
    }

    fn item(
        &mut self,
        ui: &mut Ui,
        editor: &Editor,
        (listed, item, is_in_group): (Listed, Item, bool),
        out: &mut UiRequests,
    ) -> Option<Response> {
        let scene = editor.shown();
        let name = item.name(scene)?;
        // The index may belong to another item by now.
        self.renaming
            .take_if(|(own, before)| *own == item && before != name);
        if self.renaming.as_ref().is_some_and(|(own, _)| *own == item) {
            self.rename_row(ui, scene, (item, is_in_group), out);
            return None;
        }
        let (icon, visible) = (icons::of_item(scene, item), item.is_visible(scene));
        let is_selected = listed.is_marked(editor, item);
        let (mut rect, mut eye_rect) = (row(ui), Rect::NOTHING);
        if is_in_group {
            rect.min.x += MEMBER_INDENT;
        }
        if visible.is_some() {
            (rect, eye_rect) = rect.split_left_right_at_x(rect.right() - ROW - GRID / 2.0);
        }
        if let Some(color) = color_of(scene, item) {
            let swatch_area;
            (rect, swatch_area) = rect.split_left_right_at_x(rect.right() - 2.0 * GRID);
            let square = Rect::from_center_size(swatch_area.center(), vec2(GRID, GRID) * 1.25);
            let line = Stroke::new(1.0, palette(ui.ctx()).line);
            ui.painter()
                .rect(square, 2, color, line, StrokeKind::Outside);
        }
        let response = entry(
            ui,
            rect,
            RowStyle {
                icon,
                is_bright: visible != Some(false),
                is_selected,
            },
            name,
        );
        if response.clicked() {
            select_on_click(ui, editor, (listed, item), out);
        }
        if response.double_clicked() {
            self.renaming = Some((item, name.to_owned()));
        }
        accept_drop(ui, editor, &response, (item, self.is_filtered()), out);
        response.context_menu(|ui| {
            if !is_selected {
                out.select(item);
            }
            for (text, command) in ITEM_COMMANDS {
                offer(ui, editor, text, command, out);
            }
        });
        if let Some(visible) = visible {
            ui.scope_builder(UiBuilder::new().max_rect(eye_rect), |ui| {
                if eye_button(ui, visible, name) {
                    let edit = Edit::visible(scene, item, !visible);
                    out.actions.extend(edit.map(Action::Edit));
                }
            });
        }
        Some(response)
    }

    fn rename_row(
        &mut self,
        ui: &mut Ui,
        scene: &Scene,
        (item, is_in_group): (Item, bool),
        out: &mut UiRequests,
    ) {
        let mut rect = row(ui);
        if is_in_group {
            rect.min.x += MEMBER_INDENT;
        }
        let name = item.name(scene).unwrap_or_default();
        ui.scope_builder(
            UiBuilder::new()
                .max_rect(rect)
                .layout(Layout::left_to_right(Align::Center)),
            |ui| {
                ui.add_space(GRID);
                ui.label(icons::text(icons::of_item(scene, item)));
                let id = Id::unique(("rename", item));
                match rename_field(ui, rect, ("new name", id), name) {
                    Renaming::Ongoing => return,
                    Renaming::Cancelled => {}
                    Renaming::To(new) => out.edit(Edit::Rename(item, new)),
                }
                self.renaming = None;
            },
        );
    }
}

/// Handles a click on an item: it is selected alone; with Ctrl, toggled; with Shift, everything between the last
/// selected item and this one is added, if both are in the same list.
fn select_on_click(ui: &Ui, editor: &Editor, (listed, item): (Listed, Item), out: &mut UiRequests) {
    let modifiers = ui.input(|input| input.modifiers);
    let selected = editor.selection();
    let selected = if modifiers.shift {
        let items = selected.items();
        let last = items.last().filter(|last| last.kind == item.kind);
        let between = last.and_then(|last| listed.between(editor.scene(), *last, item));
        let between = between.into_iter().flatten();
        let others = items.iter().copied().chain(between);
        Selection::all(others.filter(|other| *other != item).chain([item]))
    } else if modifiers.command {
        selected.toggled(item)
    } else {
        Selection::all([item])
    };
    out.select(selected);
}
