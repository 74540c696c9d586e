//! Time from left to right: the ruler, the camera's keys, and those of other values.

use std::collections::BTreeSet;
use std::sync::Arc;

use egui::{Align2, FontId, Rect, Response, Sense, Shape, Stroke, Ui, pos2, vec2};

use super::scale::Scale;
use super::strip::{KEY, SMALL, band, diamond, label};
use crate::editor::{Action, Edit, Editor, Time};
use crate::scene::{Animation, Easing, Interpolation, Target};
use crate::ui::hint::Hint as _;
use crate::ui::inspector::target;
use crate::ui::requests::UiRequests;
use crate::ui::theme::{GRID, TRACK, palette};

/// Least room between two times that are written out.
const APART: f32 = 64.0;
/// Least room between two marks of frames.
const FRAME_APART: f32 = 4.0;
/// Steps of written times, in seconds.
const STEPS: [f64; 11] = [
    0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0, 60.0, 600.0, 3600.0,
];

/// Keys on their way.
#[derive(Clone, Debug)]
pub struct Drag {
    /// What they are keys of, and which of them is held; `None` for the camera.
    target: Option<(Target, usize)>,
    /// The animation before.
    before: Arc<Animation>,
    /// Places of the camera's keys.
    indices: BTreeSet<usize>,
    /// Time of the key that the pointer holds.
    from: f64,
    are_copies: bool,
}

/// Seconds, frames, and the playhead, which follows the pointer.
pub fn ruler(ui: &mut Ui, scale: &Scale, editor: &Editor, out: &mut UiRequests) {
    let (rect, response) = band(ui, scale, Sense::click_and_drag());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Slider, true, "Playhead"));
    if let Some(pointer) = response.interact_pointer_pos() {
        out.time(Time::Seek(
            scale.time(pointer.x).clamp(scale.start, scale.end),
        ));
    }
    let colors = palette(ui.ctx());
    let painter = ui.painter();
    let animation = &editor.scene().animation;
    let per_second = scale.width / scale.seconds() as f32;
    let step = STEPS
        .iter()
        .find(|step| **step as f32 * per_second >= APART);
    let step = step.copied().unwrap_or(scale.end);
    let line = Stroke::new(1.0, colors.line);
    for n in (scale.start / step).ceil().max(0.0) as u32..=(scale.end / step) as u32 {
        let x = scale.x(f64::from(n) * step);
        painter.vline(x, rect.y_range(), line);
        let text = format!("{} s", (f64::from(n) * step * 100.0).round() / 100.0);
        let at = pos2(x + GRID / 2.0, rect.top());
        painter.text(
            at,
            Align2::LEFT_TOP,
            text,
            FontId::proportional(SMALL),
            colors.muted,
        );
    }
    if per_second / animation.frames_per_second as f32 >= FRAME_APART {
        let frame_at = |time: f64| (time.max(0.0) * animation.frames_per_second) as u64 + 1;
        let last = animation.frame_count().min(frame_at(scale.end));
        for frame in frame_at(scale.start)..=last {
            let x = scale.x(animation.time_of(frame));
            painter.vline(x, rect.bottom() - GRID / 2.0..=rect.bottom(), line);
        }
    }
    playhead(ui, scale, rect, editor);
    if !scale.shows(editor.shown_time()) {
        return;
    }
    let x = scale.x(editor.shown_time());
    let tip = pos2(x, rect.bottom());
    let corners = vec![tip + vec2(-KEY, -KEY), tip + vec2(KEY, -KEY), tip];
    ui.painter()
        .add(Shape::convex_polygon(corners, colors.accent, Stroke::NONE));
}

fn playhead(ui: &Ui, scale: &Scale, rect: Rect, editor: &Editor) {
    let time = editor.shown_time();
    if scale.shows(time) {
        let stroke = Stroke::new(1.0, palette(ui.ctx()).accent);
        ui.painter().vline(scale.x(time), rect.y_range(), stroke);
    }
}

/// The camera's keys: click, Shift-click, drag, Ctrl-drag, and a menu.
pub fn keys(
    ui: &mut Ui,
    scale: &Scale,
    editor: &Editor,
    drag: &mut Option<Drag>,
    out: &mut UiRequests,
) {
    let (rect, response) = band(ui, scale, Sense::click_and_drag());
    if response.clicked() {
        out.time(Time::SelectKeys(BTreeSet::new()));
    }
    select_between(ui, (scale, rect), &response, &editor.scene().animation, out);
    label(ui, rect, "Camera");
    let colors = palette(ui.ctx());
    let animation = &editor.scene().animation;
    ways(ui, scale, rect, animation);
    playhead(ui, scale, rect, editor);
    let selected = &editor.timeline().selected;
    let keys = animation.keys.iter().enumerate();
    for (index, key) in keys.filter(|(_, key)| scale.shows(key.time)) {
        let at = pos2(scale.x(key.time), rect.center().y);
        let near = Rect::from_center_size(at, vec2(2.0 * KEY + 2.0, TRACK));
        let response = ui.interact(
            near,
            ui.scope_id().with(("key", index)),
            Sense::click_and_drag(),
        );
        let name = format!("Key {}", index + 1);
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &name));
        let is_on = selected.contains(&index);
        let fill = match (is_on, response.hovered()) {
            (true, _) => colors.accent,
            (false, true) => colors.text,
            (false, false) => colors.curve,
        };
        diamond(ui, at, fill, key.interpolation == Interpolation::Hold);
        pick(&response, index, editor, drag, out);
        response.context_menu(|ui| menu(ui, index, editor, out));
        response.hint(format!(
            "{name}: {:.3} s, {}\nDrag to move, Ctrl-drag to copy, Shift-click for several",
            key.time,
            key.interpolation.name()
        ));
    }
    drag_to_pointer(ui, scale, editor, drag, out);
}

/// A drag from where no key is selects those that it passes.
fn select_between(
    ui: &Ui,
    (scale, rect): (&Scale, Rect),
    response: &Response,
    animation: &Animation,
    out: &mut UiRequests,
) {
    let from = ui.input(|input| input.pointer.press_origin());
    let is_dragged = response.dragged_by(egui::PointerButton::Primary);
    let span = from.zip(response.interact_pointer_pos());
    let Some((from, to)) = span.filter(|_| is_dragged) else {
        return;
    };
    let (first, last) = (from.x.min(to.x), from.x.max(to.x));
    let keys = animation.keys.iter().enumerate();
    let within = keys.filter(|(_, key)| (first..=last).contains(&scale.x(key.time)));
    out.time(Time::SelectKeys(within.map(|(index, _)| index).collect()));
    let part = Rect::from_x_y_ranges(first..=last, rect.y_range()).intersect(rect);
    let fill = palette(ui.ctx()).accent.gamma_multiply(0.2);
    ui.painter().rect_filled(part, 0, fill);
}

/// Lines between keys: straight ones thin, curves thick, none where it is held.
fn ways(ui: &Ui, scale: &Scale, rect: Rect, animation: &Animation) {
    let color = palette(ui.ctx()).line;
    for pair in animation.keys.windows(2) {
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

/// A click selects, a drag starts to move.
fn pick(
    response: &Response,
    index: usize,
    editor: &Editor,
    drag: &mut Option<Drag>,
    out: &mut UiRequests,
) {
    let selected = &editor.timeline().selected;
    let modifiers = response.ctx.input(|input| input.modifiers);
    if response.secondary_clicked() && !selected.contains(&index) {
        out.time(Time::SelectKeys(BTreeSet::from([index])));
    }
    if response.clicked() {
        let mut indices = selected.clone();
        if modifiers.shift {
            if !indices.remove(&index) {
                indices.insert(index);
            }
        } else {
            indices = BTreeSet::from([index]);
        }
        out.time(Time::SelectKeys(indices));
    }
    if response.drag_started() {
        let indices = if selected.contains(&index) {
            selected.clone()
        } else {
            BTreeSet::from([index])
        };
        let before = Arc::clone(&editor.scene().animation);
        // What was done before is none of it, and stays where it is taken back.
        out.actions.push(Action::BeginGesture);
        *drag = Some(Drag {
            target: None,
            from: before.keys[index].time,
            before,
            indices,
            are_copies: modifiers.command,
        });
    }
}

/// Moves what is dragged to the frame at the pointer.
fn drag_to_pointer(
    ui: &Ui,
    scale: &Scale,
    editor: &Editor,
    drag: &mut Option<Drag>,
    out: &mut UiRequests,
) {
    let Some(held) = drag.as_ref().filter(|drag| drag.target.is_none()) else {
        return;
    };
    let Some(to) = pointed(ui, scale, &held.before) else {
        *drag = None;
        return;
    };
    let (moved, new) = held
        .before
        .with_moved(&held.indices, to - held.from, held.are_copies);
    if moved != *editor.scene().animation {
        let label = if held.are_copies {
            "Copy keys"
        } else {
            "Move keys"
        };
        out.edit(Edit::animation(moved, label));
    }
    if new != editor.timeline().selected {
        out.time(Time::SelectKeys(new));
    }
}

/// The frame's time at the pointer; `None` once it is let go.
fn pointed(ui: &Ui, scale: &Scale, animation: &Animation) -> Option<f64> {
    let (is_down, at) =
        ui.input(|input| (input.pointer.primary_down(), input.pointer.latest_pos()));
    let at = at.filter(|_| is_down)?;
    let fps = animation.frames_per_second;
    Some((scale.time(at.x).max(0.0) * fps).round() / fps)
}

fn menu(ui: &mut Ui, index: usize, editor: &Editor, out: &mut UiRequests) {
    let animation = &editor.scene().animation;
    let mut indices = editor.timeline().selected.clone();
    if !indices.contains(&index) {
        indices = BTreeSet::from([index]);
    }
    let Some(key) = animation.keys.get(index) else {
        return;
    };
    let around = match key.interpolation {
        Interpolation::Orbit { around } => around,
        _ => target(editor),
    };
    for way in [
        Interpolation::Smooth,
        Interpolation::Linear,
        Interpolation::Hold,
        Interpolation::Orbit { around },
    ] {
        if ui.radio(key.interpolation == way, way.name()).clicked() {
            let changed = animation.with_each(&indices, |key| key.interpolation = way);
            out.edit(Edit::animation(changed, "Key: way"));
        }
    }
    ui.separator();
    for easing in Easing::ALL {
        if ui.radio(key.easing == easing, easing.name()).clicked() {
            let changed = animation.with_each(&indices, |key| key.easing = easing);
            out.edit(Edit::animation(changed, "Key: pace"));
        }
    }
    ui.separator();
    if ui.button("Delete").clicked() {
        out.edit(Edit::animation(
            animation.without_keys(&indices),
            "Delete keys",
        ));
        out.time(Time::SelectKeys(BTreeSet::new()));
    }
}

/// A key of a value: its track, and its place in it.
pub type ValueKey = (Target, usize);

/// The keys of lights, objects and the ambience, one track for each value; the one that was clicked last is chosen until
/// something else is pressed.
pub fn tracks(
    ui: &mut Ui,
    scale: &Scale,
    editor: &Editor,
    (drag, chosen): (&mut Option<Drag>, &mut Option<ValueKey>),
    out: &mut UiRequests,
) {
    let animation = &editor.scene().animation;
    if ui.input(|input| input.pointer.any_pressed()) {
        *chosen = None;
    }
    let colors = palette(ui.ctx());
    for track in &animation.tracks {
        let (rect, _) = band(ui, scale, Sense::hover());
        label(ui, rect, &track.target.name());
        playhead(ui, scale, rect, editor);
        let keys = track.keys.iter().enumerate();
        for (index, key) in keys.filter(|(_, key)| scale.shows(key.time)) {
            let at = pos2(scale.x(key.time), rect.center().y);
            let near = Rect::from_center_size(at, vec2(2.0 * KEY + 2.0, TRACK));
            let id = ui.scope_id().with(("value", &track.target.name(), index));
            let response = ui.interact(near, id, Sense::click_and_drag());
            let name = format!("{} key {}", track.target.name(), index + 1);
            response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &name));
            let own = (track.target.clone(), index);
            let fill = match (chosen.as_ref() == Some(&own), response.hovered()) {
                (true, _) => colors.accent,
                (false, true) => colors.text,
                (false, false) => colors.curve,
            };
            diamond(ui, at, fill, key.interpolation == Interpolation::Hold);
            if response.clicked() {
                out.time(Time::Seek(key.time));
                *chosen = Some(own);
            }
            if response.drag_started() {
                out.actions.push(Action::BeginGesture);
                *drag = Some(Drag {
                    target: Some((track.target.clone(), index)),
                    before: Arc::clone(animation),
                    indices: BTreeSet::new(),
                    from: key.time,
                    are_copies: ui.input(|input| input.modifiers.command),
                });
            }
            response.context_menu(|ui| value_menu(ui, animation, &track.target, index, out));
            response.hint(format!(
                "{name}: {:.3} s, {}\nDrag to move, Ctrl-drag to copy, Delete after a click",
                key.time,
                key.interpolation.name()
            ));
        }
    }
    let Some(held) = drag.as_ref() else { return };
    let Some((target, index)) = &held.target else {
        return;
    };
    let Some(to) = pointed(ui, scale, &held.before) else {
        *drag = None;
        return;
    };
    let (moved, label) = if held.are_copies {
        (
            held.before.with_value_copied(target, *index, to),
            "Copy key",
        )
    } else {
        (held.before.with_value_moved(target, *index, to), "Move key")
    };
    if moved != **animation {
        out.edit(Edit::animation(moved, label));
    }
}

fn value_menu(
    ui: &mut Ui,
    animation: &Animation,
    target: &Target,
    index: usize,
    out: &mut UiRequests,
) {
    let mut changed = animation.clone();
    let Some(track) = changed
        .tracks
        .iter_mut()
        .find(|track| track.target == *target)
    else {
        return;
    };
    let key = &mut track.keys[index];
    for way in [
        Interpolation::Smooth,
        Interpolation::Linear,
        Interpolation::Hold,
    ] {
        if ui.radio(key.interpolation == way, way.name()).clicked() {
            key.interpolation = way;
        }
    }
    ui.separator();
    if ui.button("Delete").clicked() {
        changed = animation.without_value(target, index);
    }
    if changed != *animation {
        out.edit(Edit::animation(changed, "Key value"));
    }
}
