//! The flight in the view: its way, a tick for each frame, and its keys, which can be dragged.

use std::collections::HashSet;

use egui::{Color32, Context, Painter, Pos2, Rect, Sense, Stroke, Ui, vec2};

use glam::DVec3;

use super::strip::{held, picked};
use crate::editor::{Action, Edit, Editor};
use crate::scene::{Camera, KeyPlace, Projection};
use crate::ui::requests::UiRequests;
use crate::ui::theme::{Palette, in_picture};
use crate::ui::tools::Screen;
use crate::worker::Question;

/// Most ticks that are drawn.
const MOST_TICKS: u64 = 1500;
/// Length of a drawn camera, as a share of the flight's extent.
const CAMERA_SHARE: f64 = 0.06;
/// How near to a key the pointer must be, in points.
const REACH: f32 = 9.0;
/// Cameras nearer than this share of the flight's extent fade.
const FADING: f64 = 0.3;
/// Of keys within so many points, one can be taken.
const CELL: f32 = 4.0;
/// Most selected keys that are all drawn as cameras.
const FEW: usize = 64;
/// Between cameras nearer to each other, in points, only dots are drawn.
const APART: f32 = 30.0;
/// Radius of the dot where a camera stands, in points.
const EYE: f32 = 3.5;
/// Most points that a drawn camera is wide.
const LARGEST: f32 = 60.0;
/// How strongly what is hidden is drawn.
const HIDDEN: f32 = 0.22;

/// What was found for the last picture.
#[derive(Default)]
pub struct Overlay {
    made_for: Option<(u64, u64)>,
    /// Each tick in world space, and whether nothing stands before it.
    ticks: Vec<(DVec3, bool)>,
    /// The flight as it was recorded, for how far the keys are off it.
    recorded: Vec<DVec3>,
    /// The key that is dragged, and how deep it is in the view.
    dragged: Option<(usize, f64)>,
}

impl Overlay {
    /// Draws the flight over the picture at `view`, unless the picture is the flight's own.
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
        let colors = in_picture();
        let thin = Stroke::new(1.0, colors.text.gamma_multiply(0.6));
        let recorded = self.recorded.iter().map(|&point| screen.place(point));
        for pair in recorded.collect::<Vec<_>>().windows(2) {
            if let (Some(from), Some(to)) = (pair[0], pair[1]) {
                painter.line_segment([from, to], thin);
            }
        }
        self.draw_way(&painter, &screen, &colors);
        let extent = self.extent();
        let size = extent * CAMERA_SHARE;
        let selected = editor.selection().keys();
        let mut drawn: Vec<Pos2> = Vec::new();
        let mut taken = HashSet::new();
        // One that is selected among few is drawn where it is on others, and taken there.
        let are_few = selected.len() <= FEW;
        for (place, key) in animation.keys.iter().enumerate() {
            let is_on = selected.contains(&KeyPlace::of_camera(place));
            let is_selected = is_on && are_few;
            let color = if is_on {
                colors.accent
            } else {
                let fade = fade(&screen, extent, key.value.position);
                colors.curve.gamma_multiply(fade)
            };
            let eye = screen.place(key.value.position);
            let is_apart = |eye: Pos2| drawn.iter().all(|other| other.distance(eye) > APART);
            if is_selected || eye.is_some_and(is_apart) {
                drawn.extend(eye);
                draw_camera(&painter, &screen, &key.value, size, color);
            } else if let Some(eye) = eye {
                painter.circle_filled(eye, EYE, color);
            }
            let cell = |eye: Pos2| [eye.x, eye.y].map(|at| (at / CELL) as i32);
            let is_first = eye.is_some_and(|eye| taken.insert(cell(eye)));
            let is_held = self.dragged.is_some_and(|(held, _)| held == place);
            if is_first || is_selected || is_held {
                self.handle(ui, editor, &screen, place, out);
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
        let stride = animation.frame_count().div_ceil(MOST_TICKS).max(1) as usize;
        let frames = (1..=animation.frame_count()).step_by(stride);
        let path = editor.path_of_camera();
        let places = frames.filter_map(|frame| path.at(animation.time_of(frame)));
        let places: Vec<DVec3> = places.map(|camera| camera.position).collect();
        let samples = animation
            .take
            .as_ref()
            .map_or(&[][..], |take| &take.samples);
        let stride = samples.len().div_ceil(MOST_TICKS as usize).max(1);
        self.recorded = samples
            .iter()
            .step_by(stride)
            .map(|sample| sample.1)
            .collect();
        // What is hidden is found out elsewhere; until then, ticks that were there stay as they were.
        let known = |index: usize| self.ticks.get(index).is_none_or(|(_, is_clear)| *is_clear);
        let ticks = places.iter().enumerate();
        self.ticks = ticks.map(|(index, &point)| (point, known(index))).collect();
        let camera = Box::new(editor.shown().camera.clone());
        out.questions.push(Question::Visible(key.0, camera, places));
    }

    /// Takes up which ticks are hidden in the picture of this revision.
    pub fn take_visible(&mut self, revision: u64, ticks: Vec<(DVec3, bool)>) {
        if self
            .made_for
            .is_some_and(|(made_for, _)| made_for == revision)
        {
            self.ticks = ticks;
        }
    }

    fn draw_way(&self, painter: &Painter, screen: &Screen, colors: &Palette) {
        let places: Vec<(Option<Pos2>, bool)> = self
            .ticks
            .iter()
            .map(|&(point, is_clear)| (screen.place(point), is_clear))
            .collect();
        let share = |is_clear: bool| if is_clear { 1.0 } else { HIDDEN };
        let shade = |is_clear: bool| colors.curve.gamma_multiply(share(is_clear));
        // On a light ground, a dark edge.
        for (width, color) in [(3.0, colors.halo.gamma_multiply(0.5)), (1.5, colors.curve)] {
            for pair in places.windows(2) {
                if let (Some(from), Some(to)) = (pair[0].0, pair[1].0) {
                    let color = color.gamma_multiply(share(pair[0].1 && pair[1].1));
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

    /// Size of the flight in world units.
    fn extent(&self) -> f64 {
        let points = self.ticks.iter().map(|(point, _)| (*point, *point));
        let all = points.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        let extent = all.map_or(0.0, |(low, high)| (high - low).length());
        if extent > 0.0 { extent } else { 1.0 }
    }

    /// Whether a key is being dragged, which may be out of sight by now.
    pub fn is_dragging(&mut self, ctx: &Context) -> bool {
        if !ctx.input(|input| input.pointer.any_down()) {
            self.dragged = None;
        }
        self.dragged.is_some()
    }

    /// A key is clicked to be selected, with Shift besides others, and dragged in the plane of the view with all that is
    /// selected; Esc takes that back.
    fn handle(
        &mut self,
        ui: &Ui,
        editor: &Editor,
        screen: &Screen,
        place: usize,
        out: &mut UiRequests,
    ) {
        let animation = &editor.scene().animation;
        let position = animation.keys[place].value.position;
        let Some(at) = screen.place(position) else {
            return;
        };
        // One that is dragged out of the picture may be brought back.
        let is_held = self.dragged.is_some_and(|(held, _)| held == place);
        if !is_held && !screen.view.contains(at) {
            return;
        }
        let near = Rect::from_center_size(at, vec2(2.0, 2.0) * REACH);
        let id = ui.scope_id().with(("key in the view", place));
        let response = ui.interact(near, id, Sense::click_and_drag());
        let name = format!("Key {} in the view", place + 1);
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &name));
        let (selected, own) = (editor.selection().keys(), KeyPlace::of_camera(place));
        if response.clicked() {
            out.select(picked(
                selected,
                own,
                ui.input(|input| input.modifiers.shift),
            ));
        }
        if response.drag_started_by(egui::PointerButton::Primary) {
            let (origin, direction) = screen.ray(at);
            self.dragged = Some((place, (position - origin).dot(direction)));
            out.select(held(selected, own));
        }
        let Some((dragged, depth)) = self.dragged.filter(|(dragged, _)| *dragged == place) else {
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
        // As deep in the view as it was: along the ray by as much more as that leans.
        let (_, straight) = screen.ray(screen.view.center());
        let (_, before) = screen.ray(at);
        let (origin, direction) = screen.ray(pointer);
        let depth = depth * before.dot(straight) / direction.dot(straight);
        self.dragged = Some((dragged, depth));
        let by = origin + direction * depth - position;
        let moved = animation.with_each(&held(selected, own), |key| key.value.position += by);
        out.edit(Edit::animation(moved, "Move key in the view"));
    }
}

/// How strongly a camera is drawn: what is near to the eye covers much of the picture and says little.
fn fade(screen: &Screen, extent: f64, position: DVec3) -> f32 {
    let (eye, _) = screen.ray(screen.view.center());
    let far = extent * FADING;
    (eye.distance(position) / far).clamp(f64::from(HIDDEN), 1.0) as f32
}

/// A pyramid from the eye to the frame of the picture, or the frame alone where rays run side by side.
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
    if width > LARGEST {
        corners = frame(size * f64::from(LARGEST / width));
    }
    // What runs side by side has no size to choose.
    if Rect::from_points(&corners).size().max_elem() > 4.0 * LARGEST {
        corners.clear();
    }
    if let (Some(eye), Projection::Perspective) = (eye, camera.projection) {
        for corner in &corners {
            painter.line_segment([eye, *corner], stroke);
        }
    }
    // One by one: the corners of a line through points that nearly coincide would be spikes.
    for (n, corner) in corners.iter().enumerate() {
        painter.line_segment([*corner, corners[(n + 1) % corners.len()]], stroke);
    }
    if let Some(eye) = eye {
        painter.circle_filled(eye, EYE, color);
    }
}
