//! The panel on the left: everything in the scene by name. Only the rows in sight are laid out, so
//! ten thousand objects cost no more than twenty.

use egui::text::{CCursor, CCursorRange};
use egui::{
    Align, Button, Id, Key, Layout, Rect, ScrollArea, Sense, TextEdit, Ui, UiBuilder, pos2, vec2,
};
use egui_material_icons::MaterialIcon;

use super::add::add_menu;
use super::icons;
use super::inspector::name_field;
use super::menu_entry::{ITEM_COMMANDS, entry as menu_entry};
use super::requests::UiRequests;
use super::theme::{GRID, ROW, palette};
use crate::editor::{Edit, Editor, Item, Kind, Selection};
use crate::scene::Scene;

/// What the panel remembers between frames.
#[derive(Debug, Default)]
pub struct Outliner {
    filter: String,
    folded: Vec<Kind>,
    renaming: Option<Item>,
}

/// One line of the list.
enum Line {
    Single(Selection, MaterialIcon, &'static str),
    Group(Kind, usize),
    Entry(Item),
}

/// Which entries of a group are listed.
enum Entries {
    /// The first so many: all of them, or none.
    All(usize),
    /// Those at these indices.
    Some(Vec<usize>),
}

/// All lines, made one by one as they are asked for: a list of ten thousand would take as long as
/// everything else together.
struct Lines([(Kind, usize, Entries); 3]);

/// What is above the groups.
const SINGLES: [(Selection, MaterialIcon, &str); 3] = [
    (Selection::Camera, icons::CAMERA, "Camera"),
    (Selection::World, icons::WORLD, "World"),
    (Selection::Render, icons::IMAGE, "Picture"),
];

impl Entries {
    fn len(&self) -> usize {
        match self {
            Self::All(count) => *count,
            Self::Some(indices) => indices.len(),
        }
    }

    fn get(&self, row: usize) -> Option<usize> {
        match self {
            Self::All(count) => (row < *count).then_some(row),
            Self::Some(indices) => indices.get(row).copied(),
        }
    }
}

impl Lines {
    fn len(&self) -> usize {
        let groups = self.0.iter().map(|(.., entries)| 1 + entries.len());
        SINGLES.len() + groups.sum::<usize>()
    }

    fn get(&self, index: usize) -> Option<Line> {
        if let Some((selection, icon, name)) = SINGLES.get(index) {
            return Some(Line::Single(*selection, *icon, name));
        }
        let mut row = index - SINGLES.len();
        for (kind, count, entries) in &self.0 {
            if row == 0 {
                return Some(Line::Group(*kind, *count));
            }
            row -= 1;
            if let Some(index) = entries.get(row) {
                return Some(Line::Entry(Item { kind: *kind, index }));
            }
            row -= entries.len();
        }
        None
    }
}

impl Outliner {
    /// Starts editing the name of an item in its row.
    pub fn rename(&mut self, item: Item) {
        self.filter.clear();
        self.folded.retain(|kind| *kind != item.kind);
        self.renaming = Some(item);
    }

    /// Shows the panel and pushes what is asked for.
    pub fn show(&mut self, ui: &mut Ui, editor: &Editor, out: &mut UiRequests) {
        ui.add_space(GRID / 2.0);
        ui.horizontal(|ui| {
            let width = ui.available_width() - ROW - GRID;
            let field = TextEdit::singleline(&mut self.filter).hint_text("Filter");
            ui.add_sized([width, ROW], field.align(egui::Align2::LEFT_CENTER))
                .accessible_name("Filter");
            let add = icons::button(ui, icons::ADD, "Add to scene");
            egui::Popup::menu(&add).show(|ui| add_menu(ui, editor.scene(), out));
        });
        let lines = self.lines(editor.scene());
        ui.spacing_mut().item_spacing.y = 0.0;
        ScrollArea::vertical()
            .auto_shrink(false)
            .show_rows(ui, ROW, lines.len(), |ui, range| {
                for index in range {
                    match lines.get(index) {
                        Some(Line::Single(selection, icon, name)) => {
                            let rect = row(ui);
                            let look = RowStyle {
                                icon,
                                is_bright: true,
                                is_selected: editor.selection == selection,
                            };
                            if entry(ui, rect, look, name).clicked() {
                                out.select(selection);
                            }
                        }
                        Some(Line::Group(kind, count)) => self.group(ui, kind, count),
                        Some(Line::Entry(item)) => self.item(ui, editor, item, out),
                        None => {}
                    }
                }
            });
    }

    fn lines(&self, scene: &Scene) -> Lines {
        let filter = self.filter.trim().to_lowercase();
        let groups = [
            (Kind::Light, scene.lights.len()),
            (Kind::Object, scene.objects.len()),
            (Kind::Pack, scene.color_packs.len()),
        ];
        let entries = |kind: Kind, count: usize| {
            if self.folded.contains(&kind) {
                return Entries::All(0);
            }
            if filter.is_empty() {
                return Entries::All(count);
            }
            let matches = |index: &usize| {
                let item = Item {
                    kind,
                    index: *index,
                };
                item.name(scene)
                    .is_some_and(|name| name.to_lowercase().contains(&filter))
            };
            Entries::Some((0..count).filter(matches).collect())
        };
        Lines(groups.map(|(kind, count)| (kind, count, entries(kind, count))))
    }

    fn group(&mut self, ui: &mut Ui, kind: Kind, count: usize) {
        let name = match kind {
            Kind::Light => "Lights",
            Kind::Object => "Objects",
            Kind::Pack => "ColorPacks",
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
            count,
            font,
            colors.muted,
        );
        if response.clicked() {
            if is_folded {
                self.folded.retain(|folded| *folded != kind);
            } else {
                self.folded.push(kind);
            }
        }
    }

    fn item(&mut self, ui: &mut Ui, editor: &Editor, item: Item, out: &mut UiRequests) {
        let scene = editor.scene();
        let Some(name) = item.name(scene) else { return };
        if self.renaming == Some(item) {
            self.rename_row(ui, scene, item, out);
            return;
        }
        let (icon, visible) = look(scene, item);
        let is_selected = editor.selection == Selection::Item(item);
        let (mut rect, mut eye_rect) = (row(ui), Rect::NOTHING);
        if visible.is_some() {
            (rect, eye_rect) = rect.split_left_right_at_x(rect.right() - ROW - GRID / 2.0);
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
            out.select(Selection::Item(item));
        }
        if response.double_clicked() {
            self.renaming = Some(item);
        }
        reorder(ui, &response, item, out);
        response.context_menu(|ui| {
            out.select(Selection::Item(item));
            for (text, command) in ITEM_COMMANDS {
                menu_entry(ui, text, command, true, out);
            }
        });
        if visible.is_some() {
            ui.scope_builder(UiBuilder::new().max_rect(eye_rect), |ui| {
                eye(ui, scene, item, name, out);
            });
        }
    }

    fn rename_row(&mut self, ui: &mut Ui, scene: &Scene, item: Item, out: &mut UiRequests) {
        let rect = row(ui);
        let name = item.name(scene).unwrap_or_default();
        ui.scope_builder(
            UiBuilder::new()
                .max_rect(rect)
                .layout(Layout::left_to_right(Align::Center)),
            |ui| {
                ui.add_space(GRID);
                ui.label(icons::text(look(scene, item).0));
                let id = Id::unique(("rename", item));
                if !ui.memory(|memory| memory.has_focus(id)) {
                    ui.memory_mut(|memory| memory.request_focus(id));
                    select_all(ui, id, name);
                }
                let new = name_field(ui, "new name", id, name);
                let is_left = ui.input(|input| {
                    input.key_pressed(Key::Enter)
                        || input.key_pressed(Key::Escape)
                        || input.pointer.any_click()
                });
                if let Some(new) = new {
                    out.edit(Edit::Rename(item, new));
                    self.renaming = None;
                } else if is_left {
                    self.renaming = None;
                }
            },
        );
    }
}

/// Typing shall replace the old name.
fn select_all(ui: &Ui, id: Id, text: &str) {
    let mut state = TextEdit::load_state(ui.ctx(), id).unwrap_or_default();
    let end = CCursor::new(text.chars().count());
    state
        .cursor
        .set_char_range(Some(CCursorRange::two(CCursor::new(0), end)));
    state.store(ui.ctx(), id);
}

/// The symbol of an item, and whether it is visible if it can be hidden.
fn look(scene: &Scene, item: Item) -> (MaterialIcon, Option<bool>) {
    match item.kind {
        Kind::Light => (
            icons::LIGHT,
            scene.lights.get(item.index).map(|light| light.visible),
        ),
        Kind::Object => {
            let object = scene.objects.get(item.index);
            let icon = object.map_or(icons::SPHERE, |object| icons::of_shape(&object.shape));
            (icon, object.map(|object| object.visible))
        }
        Kind::Pack => (icons::PACK, None),
    }
}

/// The next row of the list, over its whole width.
fn row(ui: &mut Ui) -> Rect {
    ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::hover())
        .0
}

/// How an entry looks.
#[derive(Clone, Copy)]
struct RowStyle {
    icon: MaterialIcon,
    is_bright: bool,
    is_selected: bool,
}

/// An entry that can be selected and dragged.
fn entry(ui: &mut Ui, rect: Rect, look: RowStyle, name: &str) -> egui::Response {
    let colors = palette(ui.ctx());
    let color = if look.is_bright {
        colors.text
    } else {
        colors.muted
    };
    let texts = (
        icons::text(look.icon).color(color),
        egui::RichText::new(name).color(color),
    );
    let button = Button::selectable(look.is_selected, texts)
        .right_text("")
        .truncate()
        .sense(Sense::click_and_drag())
        .min_size(rect.size());
    ui.put(rect, button).accessible_name(name)
}

/// Drag a row onto another to put it there.
fn reorder(ui: &Ui, response: &egui::Response, item: Item, out: &mut UiRequests) {
    response.dnd_set_drag_payload(item);
    let fits = |dragged: &Item| dragged.kind == item.kind && dragged.index != item.index;
    if let Some(dragged) = response
        .dnd_hover_payload::<Item>()
        .filter(|dragged| fits(dragged))
    {
        let y = if dragged.index < item.index {
            response.rect.bottom()
        } else {
            response.rect.top()
        };
        ui.painter()
            .hline(response.rect.x_range(), y, (2.0, palette(ui.ctx()).accent));
    }
    if let Some(dragged) = response
        .dnd_release_payload::<Item>()
        .filter(|dragged| fits(dragged))
    {
        out.edit(Edit::Move(*dragged, item.index));
    }
}

/// Shows or hides an item by this name.
fn eye(ui: &mut Ui, scene: &Scene, item: Item, name: &str, out: &mut UiRequests) {
    let visible = match item.kind {
        Kind::Light => scene.lights[item.index].visible,
        Kind::Object => scene.objects[item.index].visible,
        Kind::Pack => return,
    };
    let (icon, verb) = if visible {
        (icons::VISIBLE, "Hide")
    } else {
        (icons::HIDDEN, "Show")
    };
    if !icons::button(ui, icon, &format!("{verb} {name}")).clicked() {
        return;
    }
    let field = if visible { "hide" } else { "show" };
    match item.kind {
        Kind::Light => {
            let light = crate::scene::Light {
                visible: !visible,
                ..scene.lights[item.index].clone()
            };
            out.edit(Edit::Light(item.index, light, field));
        }
        Kind::Object => {
            let object = crate::scene::Object {
                visible: !visible,
                ..scene.objects[item.index].clone()
            };
            out.edit(Edit::Object(item.index, object, field));
        }
        Kind::Pack => {}
    }
}
