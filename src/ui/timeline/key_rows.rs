//! The keys along the time axis: a row for the camera, and one for each animated value.

use std::sync::Arc;

use egui::{PointerButton, Pos2, Rect, Response, Sense, Stroke, Ui, pos2, vec2};

use super::key_menu::menu;
use super::scale::Scale;
use super::strip::{KEY_HALF_WIDTH, band, diamond, dragged_keys, label, selection_after_click};
use crate::editor::{Action, Edit, Editor, Selection};
use crate::scene::{Animation, Interpolation, Key, KeyId, Keys};
use crate::ui::hint::Hinted as _;
use crate::ui::inspector::replaced_keys_message;
use crate::ui::requests::UiRequests;
use crate::ui::theme::{GRID, TRACK, palette};

/// Keys nearer to the previous one than this, in points, are not shown.
const MIN_KEY_DISTANCE: f32 = 2.0;
/// Maximum number of selected keys that are shown regardless.
const MAX_ALWAYS_SHOWN: usize = 64;

/// The pointer gesture in progress on the rows.
#[derive(Default)]
pub struct KeyRows {
    drag: Option<KeyDrag>,
    marquee: Option<Marquee>,
}

/// A selection rectangle that is being drawn.
struct Marquee {
    /// Where it began.
    from: Pos2,
    /// The selection when it began.
    before: Selection,
    /// Whether the keys selected then stay selected.
    adds: bool,
    /// The keys within it.
    within: Keys,
}

/// A drag of keys.
struct KeyDrag {
    /// The animation before the drag.
    before: Arc<Animation>,
    /// The dragged keys in that animation.
    places: Keys,
    /// Original time of the key under the pointer.
    grabbed_time: f64,
    are_copies: bool,
}

impl KeyDrag {
    /// The message at the end of the drag if other keys were replaced.
    fn message(&self, now: &Animation) -> Option<String> {
        let copies = if self.are_copies {
            self.places.len()
        } else {
            0
        };
        let before = self.before.key_count() + copies;
        replaced_keys_message(before, now).filter(|_| *now != *self.before)
    }
}

impl KeyRows {
    /// Returns whether keys are being dragged or a marquee is being drawn.
    pub fn is_busy(&self) -> bool {
        self.drag.is_some() || self.marquee.is_some()
    }

    /// Cancels the gesture in progress.
    pub fn cancel(&mut self, editor: &Editor, out: &mut UiRequests) {
        if let Some(Marquee { before, .. }) = self.marquee.take()
            && before != *editor.selection()
        {
            out.select(before);
        }
        if self.drag.take().is_some() {
            out.actions.push(Action::CancelGesture);
        }
    }

    /// Shows all rows. Click, Shift-click, drag, Ctrl-drag, marquee and context menu work on them.
    pub fn show(&mut self, ui: &mut Ui, scale: &Scale, editor: &Editor, out: &mut UiRequests) {
        if let Some(marquee) = &mut self.marquee {
            marquee.within.clear();
        }
        let animation = &editor.scene().animation;
        if !animation.keys.is_empty() {
            self.row(ui, (scale, editor), (None, &animation.keys), out);
        }
        // Of tens of thousands of rows, only the visible ones are laid out.
        let row_height = TRACK + ui.spacing().item_spacing.y;
        let (top, visible) = (ui.cursor().top(), ui.clip_rect());
        let row_at = |y: f32| ((y - top) / row_height).max(0.0) as usize;
        let count = animation.tracks.len();
        let first = row_at(visible.top()).min(count);
        let last = (row_at(visible.bottom()) + 1).clamp(first, count);
        let skip = |ui: &mut Ui, rows: usize| {
            if rows > 0 {
                ui.add_space(rows as f32 * row_height);
            }
        };
        skip(ui, first);
        for (track, value_track) in (first..).zip(&animation.tracks[first..last]) {
            self.row(ui, (scale, editor), (Some(track), &value_track.keys), out);
        }
        skip(ui, count - last);
        self.drag_to_pointer(ui, (scale, editor), out);
    }

    /// Shows the space below the rows, where a marquee can start as well, and the marquee.
    pub fn show_space_below(&mut self, ui: &mut Ui, editor: &Editor, out: &mut UiRequests) {
        let room = ui.available_rect_before_wrap();
        if room.is_positive() {
            let response = ui.allocate_rect(room, Sense::click_and_drag());
            self.press_on_empty(ui, &response, editor, out);
        }
        self.show_marquee(ui, editor, out);
    }

    /// Handles a press where no key is.
    fn press_on_empty(
        &mut self,
        ui: &Ui,
        response: &Response,
        editor: &Editor,
        out: &mut UiRequests,
    ) {
        let selected = editor.selection().keys();
        // If no keys are selected, the selection is something else and stays.
        if response.clicked() && !selected.is_empty() {
            out.select(Keys::new());
        }
        if response.drag_started_by(PointerButton::Primary) {
            let (from, adds) =
                ui.input(|input| (input.pointer.press_origin(), input.modifiers.shift));
            self.marquee = from.map(|from| Marquee {
                from,
                before: editor.selection().clone(),
                adds,
                within: Keys::new(),
            });
        }
    }

    fn row<T>(
        &mut self,
        ui: &mut Ui,
        (scale, editor): (&Scale, &Editor),
        (track, keys): (Option<usize>, &[Key<T>]),
        out: &mut UiRequests,
    ) {
        let (rect, response) = band(ui, scale);
        self.press_on_empty(ui, &response, editor, out);
        self.collect_in_marquee(ui, (scale, rect), (track, keys));
        let tracks = &editor.scene().animation.tracks;
        let value_track = track.and_then(|track| tracks.get(track));
        let name = value_track.map_or("Camera".to_owned(), |track| track.target.name());
        label(ui, rect, &name);
        // A marquee can start on the label, too.
        let label_area = Rect::from_min_max(
            pos2(ui.max_rect().left(), rect.top()),
            rect.left_bottom() - vec2(GRID, 0.0),
        );
        let id = ui.scope_id().with(("label", track));
        let label_response = ui.interact(label_area, id, Sense::click_and_drag());
        if label_response.clicked() {
            let mut all = Keys::new();
            if ui.input(|input| input.modifiers.shift) {
                all.clone_from(editor.selection().keys());
            }
            all.extend((0..keys.len()).map(|index| KeyId { track, index }));
            out.select(all);
        } else {
            self.press_on_empty(ui, &label_response, editor, out);
        }
        label_response.hint(format!("{name}\nClick to select its keys"));
        draw_segments(ui, scale, rect, keys);
        // Of keys at the same place on the screen, only one is shown and can be grabbed: there may be a hundred
        // thousand.
        let selected = editor.selection().keys();
        let are_few = selected.len() <= MAX_ALWAYS_SHOWN;
        let mut last = f32::NEG_INFINITY;
        for (index, key) in keys.iter().enumerate() {
            let (x, place) = (scale.x(key.time), KeyId { track, index });
            let is_apart = x - last >= MIN_KEY_DISTANCE || are_few && selected.contains(&place);
            if scale.shows(key.time) && is_apart {
                last = x;
                self.key(ui, (pos2(x, rect.center().y), editor), place, out);
            }
        }
    }

    fn key(
        &mut self,
        ui: &mut Ui,
        (at, editor): (Pos2, &Editor),
        place: KeyId,
        out: &mut UiRequests,
    ) {
        let animation = &editor.scene().animation;
        let Some((time, (interpolation, _))) = animation.time_and_pace_of(place) else {
            return;
        };
        let near = Rect::from_center_size(at, vec2(2.0 * KEY_HALF_WIDTH + 2.0, TRACK));
        let id = ui.scope_id().with(("key", place.track, place.index));
        let response = ui.interact(near, id, Sense::click_and_drag());
        let name = || animation.name_of(place);
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, name()));
        let is_selected = editor.selection().keys().contains(&place);
        let colors = palette(ui.ctx());
        let fill = match (is_selected, response.hovered()) {
            (true, _) => colors.accent,
            (false, true) => colors.text,
            (false, false) => colors.curve,
        };
        diamond(ui, at, fill, interpolation == Interpolation::Hold);
        self.handle_key(&response, (place, time), editor, out);
        response.context_menu(|ui| menu(ui, place, editor, out));
        if response.hovered() {
            let (name, interpolation) = (name(), interpolation.name());
            response.hint(format!(
                "{name}: {time:.3} s, {interpolation}\nDrag to move, Ctrl-drag to copy, Shift-click for several"
            ));
        }
    }

    /// A click selects a key, a drag starts to move it.
    fn handle_key(
        &mut self,
        response: &Response,
        (place, time): (KeyId, f64),
        editor: &Editor,
        out: &mut UiRequests,
    ) {
        let selected = editor.selection().keys();
        let modifiers = response.ctx.input(|input| input.modifiers);
        if response.secondary_clicked() && !selected.contains(&place) {
            out.select(Keys::from([place]));
        }
        if response.clicked() {
            out.select(selection_after_click(selected, place, modifiers.shift));
        }
        if response.drag_started() {
            let places = dragged_keys(selected, place);
            // Earlier edits are not part of the drag, and stay if it is cancelled.
            out.actions.push(Action::BeginGesture);
            self.drag = Some(KeyDrag {
                before: Arc::clone(&editor.scene().animation),
                places,
                grabbed_time: time,
                are_copies: modifiers.command,
            });
        }
    }

    /// Moves the dragged keys to the frame at the pointer.
    fn drag_to_pointer(
        &mut self,
        ui: &Ui,
        (scale, editor): (&Scale, &Editor),
        out: &mut UiRequests,
    ) {
        let Some(drag) = &self.drag else { return };
        let (is_down, at) =
            ui.input(|input| (input.pointer.primary_down(), input.pointer.latest_pos()));
        if !is_down {
            let message = drag.message(&editor.scene().animation);
            out.actions.extend(message.map(Action::Tell));
            self.drag = None;
            return;
        }
        // Nothing moves while the pointer is outside the window.
        let Some(at) = at else { return };
        let before = &drag.before;
        let to = before.time_of(before.nearest_frame(scale.time(at.x)));
        let offset = to - drag.grabbed_time;
        let (moved, new) = drag
            .before
            .with_moved(&drag.places, offset, drag.are_copies);
        if moved != *editor.scene().animation {
            let label = if drag.are_copies {
                "Copy keys"
            } else {
                "Move keys"
            };
            out.edit(Edit::animation(moved, label));
        }
        if new != *editor.selection().keys() {
            out.select(new);
        }
    }

    /// Collects the keys of a visible row that are within the marquee.
    fn collect_in_marquee<T>(
        &mut self,
        ui: &Ui,
        (scale, rect): (&Scale, Rect),
        (track, keys): (Option<usize>, &[Key<T>]),
    ) {
        let Some(marquee) = &mut self.marquee else {
            return;
        };
        let Some(bounds) = marquee.rect(ui) else {
            return;
        };
        let is_crossed = bounds.y_range().intersects(rect.y_range());
        if !is_crossed || !ui.is_rect_visible(rect) {
            return;
        }
        let is_within = |time: f64| scale.shows(time) && bounds.x_range().contains(scale.x(time));
        let keys = keys.iter().enumerate();
        let within = keys.filter(|(_, key)| is_within(key.time));
        let places = within.map(|(index, _)| KeyId { track, index });
        marquee.within.extend(places);
    }

    /// Selects the keys within the marquee, and draws it.
    fn show_marquee(&mut self, ui: &Ui, editor: &Editor, out: &mut UiRequests) {
        let Some(marquee) = &self.marquee else { return };
        let mut places = marquee.within.clone();
        if marquee.adds {
            places.extend(marquee.before.keys());
        }
        if places != *editor.selection().keys() {
            out.select(places);
        }
        if let Some(bounds) = marquee.rect(ui) {
            let fill = palette(ui.ctx()).accent.gamma_multiply(0.2);
            ui.painter().rect_filled(bounds, 0, fill);
        }
        if !ui.input(|input| input.pointer.primary_down()) {
            self.marquee = None;
        }
    }
}

impl Marquee {
    /// The rectangle from its start to the pointer.
    fn rect(&self, ui: &Ui) -> Option<Rect> {
        let to = ui.input(|input| input.pointer.latest_pos())?;
        Some(Rect::from_two_pos(self.from, to))
    }
}

/// Draws lines between keys: thin for linear interpolation, thick for curves, none if the value is held.
fn draw_segments<T>(ui: &Ui, scale: &Scale, rect: Rect, keys: &[Key<T>]) {
    let color = palette(ui.ctx()).line;
    for pair in keys.windows(2) {
        let width = match pair[0].interpolation {
            Interpolation::Hold => continue,
            Interpolation::Linear => 1.0,
            Interpolation::Smooth | Interpolation::Orbit { .. } => 3.0,
        };
        let ends = [pair[0].time, pair[1].time].map(|time| time.clamp(scale.start, scale.end));
        let span = scale.x(ends[0])..=scale.x(ends[1]);
        ui.painter()
            .hline(span, rect.center().y, Stroke::new(width, color));
    }
}
