//! The flight drawn in the viewport: its path, a tick for each frame, and its keys, which can be dragged.

use std::collections::HashSet;

use egui::{Color32, Context, Painter, Pos2, Rect, Sense, Stroke, Ui, vec2};

use glam::DVec3;

use super::strip::{dragged_keys, selection_after_click};
use crate::editor::{Action, Edit, Editor};
use crate::scene::{Camera, KeyId, Projection, around};
use crate::ui::requests::UiRequests;
use crate::ui::theme::{Palette, picture_palette};
use crate::ui::tools::Screen;
use crate::worker::Question;

/// Maximum number of ticks.
const MAX_TICKS: u64 = 1500;
/// Length of a drawn camera, as a fraction of the flight's extent.
const CAMERA_SHARE: f64 = 0.06;
/// Half the size of the area around a key that reacts to the pointer, in points.
const HIT_REACH: f32 = 9.0;
/// Drawn cameras nearer to the eye than this fraction of the flight's extent fade.
const FADE_SHARE: f64 = 0.3;
/// Size in points of the grid cells in which only one key reacts to the pointer.
const HIT_CELL: f32 = 4.0;
/// Maximum number of selected keys for which each is drawn as a camera.
const MAX_SELECTED_DRAWN: usize = 64;
/// Minimum distance between drawn cameras in points; keys closer to one are drawn as dots.
const MIN_CAMERA_DISTANCE: f32 = 30.0;
/// Radius of the dot at a camera's eye, in points.
const EYE_RADIUS: f32 = 3.5;
/// Maximum width of a drawn camera, in points.
const MAX_CAMERA_WIDTH: f32 = 60.0;
/// Opacity of hidden parts.
const HIDDEN_OPACITY: f32 = 0.22;

/// The overlay's data for the last picture.
#[derive(Default)]
pub struct Overlay {
    made_for: Option<(u64, u64)>,
    /// The ticks in world space, each with whether it is visible from the camera.
    ticks: Vec<(DVec3, bool)>,
    /// The recorded positions, drawn to show how far the keys deviate from them.
    recorded: Vec<DVec3>,
    /// The dragged key, and its depth in the view.
    dragged: Option<(usize, f64)>,
}

impl Overlay {
    /// Draws the flight over the picture at `view`, unless the picture shows the shot itself.
    pub fn show(&mut self, ui: &mut Ui, editor: &Editor, view: Rect, out: &mut UiRequests) {
        let animation = &editor.scene().animation;
        if animation.keys.is_empty() || editor.looks_through() {
            self.dragged = None;
            return;
        }
        let Some(screen) = Screen::new(&editor.shown().camera, view) else {
            return;
        };
        self.update(editor, out);
        let painter = ui.painter().with_clip_rect(view);
        let colors = picture_palette();
        let thin = Stroke::new(1.0, colors.text.gamma_multiply(0.6));
        let recorded = self.recorded.iter().map(|&point| screen.place(point));
        for pair in recorded.collect::<Vec<_>>().windows(2) {
            if let (Some(from), Some(to)) = (pair[0], pair[1]) {
                painter.line_segment([from, to], thin);
            }
        }
        self.draw_path(&painter, &screen, &colors);
        let extent = self.extent();
        let size = extent * CAMERA_SHARE;
        let selected = editor.selection().keys();
        let mut drawn: Vec<Pos2> = Vec::new();
        let mut occupied_cells = HashSet::new();
        // Among few selected keys, each is drawn and can be grabbed even where it covers others.
        let are_few = selected.len() <= MAX_SELECTED_DRAWN;
        let near_view = view.expand(4.0 * MAX_CAMERA_WIDTH);
        for (index, key) in animation.keys.iter().enumerate() {
            let is_in_selection = selected.contains(&KeyId::of_camera(index));
            let is_selected = is_in_selection && are_few;
            let color = if is_in_selection {
                colors.accent
            } else {
                let fade = fade(&screen, extent, key.value.position);
                colors.curve.gamma_multiply(fade)
            };
            let is_dragged = self.dragged.is_some_and(|(dragged, _)| dragged == index);
            let eye = screen.place(key.value.position);
            if !(is_selected || is_dragged || eye.is_some_and(|eye| near_view.contains(eye))) {
                continue;
            }
            let is_apart = |eye: Pos2| {
                drawn
                    .iter()
                    .all(|other| other.distance(eye) > MIN_CAMERA_DISTANCE)
            };
            if is_selected || eye.is_some_and(is_apart) {
                drawn.extend(eye);
                draw_camera(&painter, &screen, &key.value, size, color);
            } else if let Some(eye) = eye {
                painter.circle_filled(eye, EYE_RADIUS, color);
            }
            let cell = |eye: Pos2| [eye.x, eye.y].map(|at| (at / HIT_CELL) as i32);
            let is_first = eye.is_some_and(|eye| occupied_cells.insert(cell(eye)));
            if is_first || is_selected || is_dragged {
                self.handle(ui, editor, &screen, index, out);
            }
        }
        if let Some(shot) = editor.path_of_camera().at(editor.shown_time()) {
            draw_camera(&painter, &screen, &shot, size * 1.6, colors.accent);
        }
    }

    fn update(&mut self, editor: &Editor, out: &mut UiRequests) {
        let key = (editor.shown_revision(), editor.revision());
        if self.made_for == Some(key) {
            return;
        }
        self.made_for = Some(key);
        let animation = &editor.scene().animation;
        let stride = animation.frame_count().div_ceil(MAX_TICKS).max(1) as usize;
        let frames = (1..=animation.frame_count()).step_by(stride);
        let path = editor.path_of_camera();
        let places = frames.filter_map(|frame| path.at(animation.time_of(frame)));
        let places: Vec<DVec3> = places.map(|camera| camera.position).collect();
        let samples = animation
            .take
            .as_ref()
            .map_or(&[][..], |take| &take.samples);
        let stride = samples.len().div_ceil(MAX_TICKS as usize).max(1);
        self.recorded = samples
            .iter()
            .step_by(stride)
            .map(|sample| sample.1)
            .collect();
        // Visibility is determined by the worker; until the answer, ticks keep that of the old ones with the same
        // index.
        let is_known_clear =
            |index: usize| self.ticks.get(index).is_none_or(|(_, is_clear)| *is_clear);
        let ticks = places.iter().enumerate();
        self.ticks = ticks
            .map(|(index, &point)| (point, is_known_clear(index)))
            .collect();
        let camera = Box::new(editor.shown().camera.clone());
        out.questions.push(Question::Visible(key.0, camera, places));
    }

    /// Takes over the visibility of the ticks, if it belongs to the current picture.
    pub fn take_visible(&mut self, revision: u64, ticks: Vec<(DVec3, bool)>) {
        if self
            .made_for
            .is_some_and(|(made_for, _)| made_for == revision)
        {
            self.ticks = ticks;
        }
    }

    fn draw_path(&self, painter: &Painter, screen: &Screen, colors: &Palette) {
        let places: Vec<(Option<Pos2>, bool)> = self
            .ticks
            .iter()
            .map(|&(point, is_clear)| (screen.place(point), is_clear))
            .collect();
        let opacity = |is_clear: bool| if is_clear { 1.0 } else { HIDDEN_OPACITY };
        let shade = |is_clear: bool| colors.curve.gamma_multiply(opacity(is_clear));
        // A dark edge keeps it visible on light backgrounds.
        for (width, color) in [(3.0, colors.halo.gamma_multiply(0.5)), (1.5, colors.curve)] {
            for pair in places.windows(2) {
                if let (Some(from), Some(to)) = (pair[0].0, pair[1].0) {
                    let color = color.gamma_multiply(opacity(pair[0].1 && pair[1].1));
                    painter.line_segment([from, to], Stroke::new(width, color));
                }
            }
        }
        for (place, is_clear) in places {
            if let Some(place) = place {
                painter.circle_filled(place, 2.0, shade(is_clear));
            }
        }
    }

    /// Diagonal of the flight's bounding box in world units; 1 if it is a point.
    fn extent(&self) -> f64 {
        let all = around(self.ticks.iter().map(|(point, _)| (*point, *point)));
        let extent = all.map_or(0.0, |(low, high)| (high - low).length());
        if extent > 0.0 { extent } else { 1.0 }
    }

    /// Returns whether a key is being dragged; it may have left the picture.
    pub fn is_dragging(&mut self, ctx: &Context) -> bool {
        if !ctx.input(|input| input.pointer.any_down()) {
            self.dragged = None;
        }
        self.dragged.is_some()
    }

    /// Handles the pointer at a key: a click selects it (Shift: toggles it in the selection), and a drag moves it,
    /// with the rest of the selection, parallel to the picture plane. Escape cancels the drag.
    fn handle(
        &mut self,
        ui: &Ui,
        editor: &Editor,
        screen: &Screen,
        index: usize,
        out: &mut UiRequests,
    ) {
        let animation = &editor.scene().animation;
        let position = animation.keys[index].value.position;
        let Some(at) = screen.place(position) else {
            return;
        };
        // A key dragged out of the picture can still be dragged back.
        let is_dragged = self.dragged.is_some_and(|(dragged, _)| dragged == index);
        if !is_dragged && !screen.view.contains(at) {
            return;
        }
        let near = Rect::from_center_size(at, vec2(2.0, 2.0) * HIT_REACH);
        let id = ui.scope_id().with(("key in the view", index));
        let response = ui.interact(near, id, Sense::click_and_drag());
        let name = format!("Key {} in the view", index + 1);
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &name));
        let (selected, key_place) = (editor.selection().keys(), KeyId::of_camera(index));
        if response.clicked() {
            out.select(selection_after_click(
                selected,
                key_place,
                ui.input(|input| input.modifiers.shift),
            ));
        }
        if response.drag_started_by(egui::PointerButton::Primary) {
            let (origin, direction) = screen.ray(at);
            // Earlier edits are not part of the drag, and stay if it is cancelled.
            out.actions.push(Action::BeginGesture);
            self.dragged = Some((index, (position - origin).dot(direction)));
            out.select(dragged_keys(selected, key_place));
        }
        let Some((dragged, depth)) = self.dragged.filter(|(dragged, _)| *dragged == index) else {
            return;
        };
        let pointer = response.interact_pointer_pos();
        let Some(pointer) = pointer.filter(|_| response.dragged()) else {
            self.dragged = None;
            if ui.input(|input| input.key_pressed(egui::Key::Escape)) {
                out.actions.push(Action::CancelGesture);
            }
            return;
        };
        // Keeps the depth along the view axis; the distance along the ray depends on the ray's angle to it.
        let (_, forward) = screen.ray(screen.view.center());
        let (_, old_direction) = screen.ray(at);
        let (origin, direction) = screen.ray(pointer);
        let depth = depth * old_direction.dot(forward) / direction.dot(forward);
        self.dragged = Some((dragged, depth));
        let offset = origin + direction * depth - position;
        let moved = animation.with_each(&dragged_keys(selected, key_place), |key| {
            key.value.position += offset;
        });
        out.edit(Edit::animation(moved, "Move key in the view"));
    }
}

/// Opacity of a camera: one near the eye would cover much of the picture without being informative.
fn fade(screen: &Screen, extent: f64, position: DVec3) -> f32 {
    let (eye, _) = screen.ray(screen.view.center());
    let fade_distance = extent * FADE_SHARE;
    (eye.distance(position) / fade_distance).clamp(f64::from(HIDDEN_OPACITY), 1.0) as f32
}

/// Draws a camera as a pyramid from its eye to its frame; if it is orthographic, as the frame alone.
fn draw_camera(painter: &Painter, screen: &Screen, camera: &Camera, size: f64, color: Color32) {
    let Some(framing) = camera.framing() else {
        return;
    };
    let frame = |size: f64| -> Vec<Pos2> {
        let depth = match camera.projection {
            Projection::Perspective => size,
            Projection::Orthographic => 0.0,
        };
        let corners = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]].into_iter();
        let places: Option<Vec<Pos2>> = corners
            .map(|at| {
                let (origin, direction) = framing.ray(at);
                screen.place(origin + direction * depth)
            })
            .collect();
        places.unwrap_or_default()
    };
    let stroke = Stroke::new(1.0, color);
    let (eye, mut corners) = (screen.place(camera.position), frame(size));
    let width = Rect::from_points(&corners).size().max_elem();
    if width > MAX_CAMERA_WIDTH {
        corners = frame(size * f64::from(MAX_CAMERA_WIDTH / width));
    }
    // The size of an orthographic frame is fixed: leave it out if it is too large.
    if Rect::from_points(&corners).size().max_elem() > 4.0 * MAX_CAMERA_WIDTH {
        corners.clear();
    }
    if let (Some(eye), Projection::Perspective) = (eye, camera.projection) {
        for corner in &corners {
            painter.line_segment([eye, *corner], stroke);
        }
    }
    // Separate segments, as the joins of a polyline through nearly coinciding points would form spikes.
    for (n, corner) in corners.iter().enumerate() {
        painter.line_segment([*corner, corners[(n + 1) % corners.len()]], stroke);
    }
    if let Some(eye) = eye {
        painter.circle_filled(eye, EYE_RADIUS, color);
    }
}
