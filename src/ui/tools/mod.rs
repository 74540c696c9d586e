//! Mouse tools in the picture: a click selects; a drag moves what is grabbed, or the camera.

mod screen;

mod outline;

mod seen_objects;

mod subject;

mod navigate;

mod gizmo;

mod grip;

mod drag;

pub use gizmo::label;
pub use navigate::{framing_camera, is_selection_out_of_view, looking_along, projected};
pub use screen::Screen;

use egui::{CursorIcon, Modifiers, PointerButton, Popup, Pos2, Rect, Response, Ui};
use glam::DVec3;

use self::drag::{Drag, Pane};
use self::gizmo::{Handle, handle_at};
use self::navigate::dollied;
use self::seen_objects::{SeenObjects, is_finite, item_of, pixel, question, with_group};
use super::commands::Command;
use super::menu_entry::{ITEM_COMMANDS, entry, offer};
use super::pack_drag::{assign_pack_edit, dropped_pack};
use super::requests::UiRequests;
use super::viewport::Place;
use crate::editor::{Action, Edit, Editor, Item, ItemKind, Selection, Time};
use crate::image::{ObjectMap, Thing};
use crate::words::shortened;

/// Seconds that the pointer has to rest before the name of what it hovers is shown.
const HOVER_DELAY: f32 = 0.3;
/// Maximum number of letters of a name beside the pointer.
const MAX_NAME_LETTERS: usize = 32;
/// Maximum time between the two clicks of a double click, in seconds.
const MAX_DOUBLE_CLICK_SECONDS: f64 = 1.0;
/// Maximum distance between two clicks that count as being at the same place, in points.
const SAME_POSITION_DISTANCE: f32 = 4.0;

/// The state of the tools between frames.
#[derive(Default)]
pub struct Tools {
    seen_objects: SeenObjects,
    drag: Option<Drag>,
    /// The position of the pointer while the wheel is turned, and the point of the scene there.
    wheel: Option<(Pos2, DVec3)>,
    /// A click that waits to learn what is there: its position, its modifiers, and the revision of the picture.
    click: Option<(Pos2, Modifiers, u64)>,
    /// Time of the last click in the picture that was not the second of a double click.
    clicked_at: f64,
    /// For selecting what is behind other things: the position, the revision of the picture, and the things found
    /// there so far, front to back.
    behind: Option<(Pos2, u64, Vec<Thing>)>,
    /// The position at which the context menu was opened.
    menu_at: Option<Pos2>,
    /// Whether it is still unknown what is at that position.
    menu_waits: bool,
    /// Rectangle of the picture in the last frame.
    view: Option<Rect>,
}

impl Tools {
    /// Returns whether keys are meant for a drag.
    pub fn is_dragging(&self) -> bool {
        self.drag.is_some()
    }

    /// Drops all gestures in progress: the picture has been replaced, or there is none to interact with.
    pub fn rest(&mut self) {
        (self.drag, self.click, self.behind, self.wheel) = (None, None, None, None);
        self.menu_waits = false;
    }

    /// Takes over the map of what is seen in the picture of a revision, with the things in `without` left out.
    /// Returns the new selection, if the map was requested to select what is behind them.
    pub fn take(
        &mut self,
        editor: &Editor,
        (revision, map): (u64, ObjectMap),
        without: &[Thing],
    ) -> Option<Selection> {
        if without.is_empty() {
            self.seen_objects.take(revision, map);
            return None;
        }
        let (at, of, before) = self.behind.as_mut()?;
        let [column, row] = pixel(&map, self.view?, *at)?;
        if before != without || *of != revision {
            return None;
        }
        // After the last thing, start again with the first.
        let next = if let Some(next) = map.at(column, row) {
            before.extend(with_group(editor.scene(), next));
            next
        } else {
            let first = *before.first()?;
            *before = with_group(editor.scene(), first);
            first
        };
        let item = item_of(next);
        // Independent of what was selected on the way there.
        Some(Selection::default().picked(editor.scene(), &[item]))
    }

    /// Handles the tools for the picture at `place`, whose response is `response`; `wheel` is the wheel movement
    /// over it, and `is_busy` says whether a gesture is in progress elsewhere.
    pub fn show(
        &mut self,
        ui: &Ui,
        editor: &Editor,
        (place, response): (Place, &Response),
        (wheel, is_busy): (f64, bool),
        out: &mut UiRequests,
    ) {
        let Some(screen) = Screen::new(&editor.shown().camera, place.rect) else {
            return;
        };
        self.view = Some(place.rect);
        let view = Pane {
            editor,
            place,
            screen,
            painter: ui.painter().with_clip_rect(place.rect),
        };
        // During playback and through the shot camera, a drag would set a key in every frame.
        let is_playing = editor.timeline().is_playing;
        let has_gizmo = !(editor.looks_through() || is_playing);
        let hovered = response.hover_pos().filter(|_| self.drag.is_none());
        let target_handle = hovered
            .filter(|_| has_gizmo)
            .and_then(|at| handle_at(&view.screen, editor.selection(), editor.shown(), at));
        self.start(ui, &view, response, has_gizmo, out);
        let show_gizmo = |target_handle| {
            if has_gizmo {
                gizmo::show(&view.painter, &view.screen, editor, target_handle);
            }
        };
        if let Some(drag) = &mut self.drag {
            // Drawn before the value beside the pointer, which covers it.
            show_gizmo(drag.handle());
            if !drag.advance(ui, &view, &self.seen_objects, response, out) {
                self.drag = None;
            }
        } else {
            // Drawn before the name beside the pointer, which covers it.
            show_gizmo(target_handle);
            self.hover(ui, &view, hovered, target_handle);
        }
        if self.drag.is_none() {
            self.turn_wheel(&view, response, wheel, out);
        }
        self.show_menu(ui, &view, response, out);
        let needs_map = matches!(self.drag, Some(Drag::Undecided(..))) || self.menu_waits;
        if needs_map || (!is_busy && self.drag.is_none()) {
            out.questions
                .extend(self.seen_objects.request_map(editor, place));
        }
        if !is_busy && self.drag.is_none() {
            self.wheel = None;
        }
        let modifiers = ui.input(|input| input.modifiers);
        let now = ui.input(|input| input.time);
        let is_second = response.double_clicked() && modifiers.is_none();
        // The first of two clicks may have hit something in front of the picture that is gone by now, or may still
        // be pending.
        let is_first_done =
            now - self.clicked_at < MAX_DOUBLE_CLICK_SECONDS && self.click.is_none();
        if response.clicked() && (!is_second || is_first_done) {
            let (at, revision) = (response.interact_pointer_pos(), editor.shown_revision());
            self.click = at.map(|at| (at, modifiers, revision));
            self.clicked_at = if is_second { f64::NEG_INFINITY } else { now };
        }
        if is_playing && (response.clicked() || response.secondary_clicked()) {
            // What is here is known only once the picture rests.
            out.time(Time::Play(false));
        }
        self.select(&view, out);
        self.take_pack(ui, &view, response, out);
    }

    /// Assigns a color pack dropped on the picture to the item at that position.
    fn take_pack(&mut self, ui: &Ui, view: &Pane, response: &Response, out: &mut UiRequests) {
        let dragged = response.dnd_hover_payload::<Item>();
        let is_over = dragged.is_some_and(|item| item.kind == ItemKind::Pack);
        let dropped = dropped_pack(response);
        if !is_over && dropped.is_none() {
            return;
        }
        let at = ui.input(|input| input.pointer.latest_pos());
        let seen = at.and_then(|at| self.seen_objects.at(view.editor, view.place.rect, at));
        let item = seen.map(item_of);
        if let Some(pack) = dropped {
            let edit = item.and_then(|item| assign_pack_edit(view.editor, pack, item));
            out.actions.extend(edit.map(Action::Edit));
        } else {
            let item = item.into_iter().collect();
            self.seen_objects
                .show(&view.painter, view.editor, view.place.rect, item);
        }
    }

    /// Shows the context menu: selects the item at the pointer, and lists the commands for it.
    fn show_menu(&mut self, ui: &Ui, view: &Pane, response: &Response, out: &mut UiRequests) {
        if response.secondary_clicked() {
            self.menu_at = ui.input(|input| input.pointer.interact_pos());
            self.menu_waits = true;
        }
        if self.menu_waits && self.seen_objects.map(view.editor).is_some() {
            self.menu_waits = false;
            let seen = self.menu_at;
            let seen = seen.and_then(|at| self.seen_objects.at(view.editor, view.place.rect, at));
            if let Some(item) = seen.map(item_of)
                && !view.editor.selection().has(item)
            {
                let selected = view.editor.selection().picked(view.editor.scene(), &[item]);
                out.select(selected);
            }
        }
        let menu = response.context_menu(|ui| {
            if let Some(at) = self.menu_at
                && ui.button("Why this colour").clicked()
            {
                let (origin, direction) = view.screen.ray(at);
                out.commands.push(Command::Why(origin, direction));
            }
            ui.separator();
            // The current selection may be another item.
            if self.menu_waits {
                ui.weak("Looking up what is here");
            } else {
                for (text, command) in ITEM_COMMANDS {
                    offer(ui, view.editor, text, command, out);
                }
            }
            ui.separator();
            entry(ui, "Paste", Command::RequestPaste, out);
            entry(ui, "Frame selection", Command::FrameSelected, out);
            entry(ui, "Frame everything", Command::FrameAll, out);
        });
        // Once the menu is closed, its item no longer matters.
        self.menu_waits &= menu.is_some();
    }

    fn start(
        &mut self,
        ui: &Ui,
        view: &Pane,
        response: &Response,
        has_gizmo: bool,
        out: &mut UiRequests,
    ) {
        let origin = ui.input(|input| input.pointer.press_origin());
        let Some(at) = origin.filter(|_| self.drag.is_none()) else {
            return;
        };
        if response.drag_started_by(PointerButton::Primary) {
            let handle = handle_at(
                &view.screen,
                view.editor.selection(),
                view.editor.shown(),
                at,
            );
            let handle = handle.filter(|_| has_gizmo);
            let is_shifted = ui.input(|input| input.modifiers.shift);
            out.actions.push(Action::BeginGesture);
            self.drag = Drag::start(view, &self.seen_objects, (at, handle, is_shifted), out);
        } else if response.drag_started_by(PointerButton::Middle) {
            out.actions.push(Action::BeginGesture);
            self.drag = Some(Drag::Pan(view.point_at(&self.seen_objects, at)));
        }
    }

    /// Shows what the pointer is over.
    fn hover(&mut self, ui: &Ui, view: &Pane, at: Option<Pos2>, target_handle: Option<Handle>) {
        let seen = at.and_then(|at| self.seen_objects.at(view.editor, view.place.rect, at));
        let item = seen.map(item_of).filter(|_| target_handle.is_none());
        // An outline of the floor would surround everything that stands on it.
        let outlined = seen.filter(|thing| is_finite(view.editor.shown(), *thing));
        let outlined = outlined.map(item_of).filter(|_| target_handle.is_none());
        let (scene, selected) = (view.editor.scene(), view.editor.selection());
        let outlined = outlined.map(|item| selected.picked(scene, &[item]));
        let group = outlined.as_ref().and_then(|picked| picked.group(scene));
        let outlined = outlined.as_ref().map_or(&[][..], Selection::items);
        self.seen_objects.show(
            &view.painter,
            view.editor,
            view.place.rect,
            outlined.to_vec(),
        );
        if target_handle.is_some() {
            ui.set_cursor_icon(CursorIcon::Grab);
        }
        let name = group.or_else(|| item?.name(scene));
        let (is_down, idle_seconds) = ui.input(|input| {
            let idle_seconds = input.pointer.time_since_last_movement();
            (input.pointer.any_down(), idle_seconds)
        });
        let is_covered = is_down || Popup::is_any_open(ui.ctx());
        let Some((at, name)) = at.zip(name).filter(|_| !is_covered) else {
            return;
        };
        if idle_seconds >= HOVER_DELAY {
            label(&view.painter, at, &shortened(name, MAX_NAME_LETTERS));
        } else {
            ui.request_repaint_after_secs(HOVER_DELAY - idle_seconds);
        }
    }

    fn turn_wheel(&mut self, view: &Pane, response: &Response, wheel: f64, out: &mut UiRequests) {
        let at = response.hover_pos().filter(|_| wheel != 0.0);
        let Some(at) = at else { return };
        let known = self
            .wheel
            .filter(|(before, _)| (*before - at).length() < SAME_POSITION_DISTANCE);
        let point = known.map_or_else(|| view.point_at(&self.seen_objects, at), |(_, point)| point);
        self.wheel = Some((at, point));
        let camera = dollied(&view.editor.shown().camera, point, wheel);
        out.edit(Edit::Camera(camera, "move"));
    }

    /// Selects the clicked item, once it is known.
    fn select(&mut self, view: &Pane, out: &mut UiRequests) {
        // A click in a picture that has since been replaced is dropped.
        let revision = view.editor.shown_revision();
        self.click = self
            .click
            .filter(|(.., of)| *of == revision && self.drag.is_none());
        let Some((at, modifiers, _)) = self.click else {
            return;
        };
        if self.seen_objects.map(view.editor).is_none() {
            return;
        }
        self.click = None;
        let seen = self.seen_objects.at(view.editor, view.place.rect, at);
        if modifiers.alt {
            return self.select_behind(view, at, seen, out);
        }
        self.behind = None;
        let item = seen.map(item_of);
        let before = view.editor.selection();
        let scene = view.editor.scene();
        let selected = match (item, modifiers.shift || modifiers.command) {
            (Some(item), true) => before.toggled_at(scene, item),
            (None, true) => return,
            (Some(item), false) => before.picked(scene, &[item]),
            (None, false) => Selection::default(),
        };
        out.select(selected);
    }

    fn select_behind(&mut self, view: &Pane, at: Pos2, seen: Option<Thing>, out: &mut UiRequests) {
        let Some(first) = seen else { return };
        let revision = view.editor.shown_revision();
        let known = self.behind.take().filter(|(before, of, things)| {
            let is_same_click = (*before - at).length() < SAME_POSITION_DISTANCE && *of == revision;
            is_same_click && things.first() == Some(&first)
        });
        let scene = view.editor.scene();
        let (at, _, before) = known.unwrap_or_else(|| (at, revision, with_group(scene, first)));
        out.questions
            .push(question(view.editor, view.place, before.clone()));
        self.behind = Some((at, revision, before));
    }
}
