//! The ruler above the keys, with seconds, frames and the playhead.

use egui::{Align2, FontId, PointerButton, Rect, Shape, Stroke, Ui, pos2, vec2};

use super::scale::Scale;
use super::strip::{KEY_HALF_WIDTH, TIME_FONT_SIZE, band};
use crate::editor::{Editor, Time};
use crate::ui::requests::UiRequests;
use crate::ui::theme::{GRID, palette};

/// Minimum distance between two labelled times, in points.
const MIN_LABEL_DISTANCE: f32 = 64.0;
/// Minimum distance between two frame marks, in points.
const MIN_FRAME_MARK_DISTANCE: f32 = 4.0;
/// Possible intervals of labelled times, in seconds.
const STEPS: [f64; 13] = [
    0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0, 60.0, 600.0, 3600.0, 14_400.0, 43_200.0,
];

/// Shows seconds, frames and the playhead, which can be clicked and dragged to a time.
pub fn show(ui: &mut Ui, scale: &Scale, editor: &Editor, out: &mut UiRequests) {
    let (rect, response) = band(ui, scale);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Slider, true, "Playhead"));
    let is_primary = response.clicked_by(PointerButton::Primary)
        || response.dragged_by(PointerButton::Primary)
        || response.is_pointer_button_down_on() && ui.input(|input| input.pointer.primary_down());
    if let Some(pointer) = response.interact_pointer_pos().filter(|_| is_primary) {
        out.time(Time::Seek(
            scale.time(pointer.x).clamp(scale.start, scale.end),
        ));
    }
    let colors = palette(ui.ctx());
    let painter = ui.painter();
    let animation = &editor.scene().animation;
    let points_per_second = scale.width / scale.seconds() as f32;
    let step = STEPS
        .iter()
        .find(|step| **step as f32 * points_per_second >= MIN_LABEL_DISTANCE);
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
            FontId::proportional(TIME_FONT_SIZE),
            colors.muted,
        );
    }
    if points_per_second / animation.frames_per_second as f32 >= MIN_FRAME_MARK_DISTANCE {
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
    let corners = vec![
        tip + vec2(-KEY_HALF_WIDTH, -KEY_HALF_WIDTH),
        tip + vec2(KEY_HALF_WIDTH, -KEY_HALF_WIDTH),
        tip,
    ];
    ui.painter()
        .add(Shape::convex_polygon(corners, colors.accent, Stroke::NONE));
}

/// Draws a vertical line at the time on screen.
pub fn playhead(ui: &Ui, scale: &Scale, rect: Rect, editor: &Editor) {
    let time = editor.shown_time();
    if scale.shows(time) {
        let stroke = Stroke::new(1.0, palette(ui.ctx()).accent);
        ui.painter().vline(scale.x(time), rect.y_range(), stroke);
    }
}
