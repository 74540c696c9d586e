//! Interaction with the still picture: the wheel magnifies it, a drag moves it, and a drag with Shift marks the part
//! that is traced again.

use egui::{
    Event, Key, MouseWheelUnit, PointerButton, Pos2, Rect, Response, Stroke, StrokeKind, Ui,
};

use super::magnifier::Magnifier;
use super::pictures::Pictures;
use super::theme::palette;
use super::viewport::Place;
use crate::plan::Region;

/// Points of a touchpad that count as one step of a wheel.
const POINTS_PER_STEP: f32 = 50.0;
/// Steps that two fingers make by moving apart to twice their distance.
const STEPS_PER_DOUBLING: f32 = 1.0;
/// Least time between two steps, in seconds.
const MIN_STEP_INTERVAL: f64 = 0.08;

/// The state of the view of the still picture.
#[derive(Default)]
pub struct Still {
    magnifier: Magnifier,
    /// Steps that the wheel has turned since the last change of magnification.
    wheel_steps: f32,
    /// Time of that change, in seconds.
    stepped_at: f64,
    /// Corner at which a part that is being marked begins.
    mark_start: Option<Pos2>,
    /// Whether the marking was cancelled while its button is still held.
    is_cancelled: bool,
}

impl Still {
    /// Shows one picture pixel per screen pixel; or the whole picture, if that is already so and the picture is shown.
    pub fn show_actual_size(&mut self, is_shown: bool) {
        let is_actual = is_shown && self.magnifier.factor == 1;
        self.magnifier = Magnifier::default();
        self.magnifier.factor = u32::from(!is_actual);
    }

    /// Resets the view, so that the next picture is shown as a whole.
    pub fn leave(&mut self) {
        (self.magnifier, self.mark_start) = (Magnifier::default(), None);
    }

    /// Whether a part of the picture is being marked, which Escape cancels.
    pub fn is_marking(&self) -> bool {
        self.mark_start.is_some()
    }

    /// Returns the name that is shown on the picture.
    pub fn name(&self, is_part: bool) -> String {
        match (is_part, self.magnifier.factor) {
            (true, _) => "High-res, partial".to_owned(),
            (false, 0) => "High-res picture".to_owned(),
            (false, factor) => format!("High-res picture {factor}:1"),
        }
    }

    /// Draws the still picture of `size` pixels, and handles the pointer over it.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        place: Place,
        pictures: &mut Pictures,
        size: (usize, usize),
    ) -> Response {
        let scale = ui.pixels_per_point();
        let drawn_rect = self.magnifier.picture_rect(place.rect, size, scale);
        let response = pictures.screen.show_still(ui, place, drawn_rect);
        if let Some(at) = response.hover_pos() {
            self.wheel_steps += wheel(ui);
            let now = ui.input(|input| input.time);
            if now - self.stepped_at < MIN_STEP_INTERVAL {
                // A single notch of a wheel can arrive as several events.
                self.wheel_steps = 0.0;
            } else if self.wheel_steps.abs() >= 1.0 {
                let up = self.wheel_steps > 0.0;
                (self.wheel_steps, self.stepped_at) = (0.0, now);
                self.magnifier.zoom_step(up, at, (place.rect, size, scale));
            }
        }
        if response.double_clicked() {
            self.magnifier = Magnifier::default();
        }
        let is_shifted = ui.input(|input| input.modifiers.shift);
        if response.drag_started_by(PointerButton::Primary) && is_shifted {
            self.mark_start = ui.input(|input| input.pointer.press_origin());
        }
        if self.is_marking() && ui.input(|input| input.key_pressed(Key::Escape)) {
            (self.mark_start, self.is_cancelled) = (None, true);
        }
        self.is_cancelled &= ui.input(|input| input.pointer.any_down());
        if let Some(from) = self.mark_start {
            self.mark(ui, (from, drawn_rect), &response, (pictures, size));
        } else if response.dragged() && !self.is_cancelled {
            self.magnifier.pan(response.drag_delta(), drawn_rect);
        }
        response
    }

    fn mark(
        &mut self,
        ui: &Ui,
        (from, drawn_rect): (Pos2, Rect),
        response: &Response,
        (pictures, size): (&mut Pictures, (usize, usize)),
    ) {
        let at = response.interact_pointer_pos().unwrap_or(from);
        let marked = Rect::from_two_pos(from, at).intersect(response.rect);
        if response.dragged() {
            let line = Stroke::new(1.0, palette(ui.ctx()).accent);
            ui.painter()
                .rect_stroke(marked, 0, line, StrokeKind::Inside);
            return;
        }
        self.mark_start = None;
        if let Some(region) = region(marked, drawn_rect, size) {
            pictures.region = Some(region);
        }
    }
}

/// Returns how far the wheel was turned in this frame, in steps; up is positive.
fn wheel(ui: &Ui) -> f32 {
    ui.input(|input| {
        let wheel_steps = input.events.iter().map(|event| match event {
            Event::MouseWheel { unit, delta, .. } => match unit {
                MouseWheelUnit::Point => delta.y / POINTS_PER_STEP,
                MouseWheelUnit::Line | MouseWheelUnit::Page => delta.y.signum(),
            },
            Event::Zoom(factor) => factor.log2() * STEPS_PER_DOUBLING,
            _ => 0.0,
        });
        wheel_steps.sum()
    })
}

/// Returns the pixels under a marked rectangle, of a picture of `size` pixels drawn to `drawn_rect`; `None` if there
/// are none.
fn region(marked: Rect, drawn_rect: Rect, size: (usize, usize)) -> Option<Region> {
    let pixel = |at: f32, from: f32, length: f32, count: usize| {
        let share = ((at - from) / length).clamp(0.0, 1.0);
        (f64::from(share) * count as f64).round() as usize
    };
    let column = |x: f32| pixel(x, drawn_rect.left(), drawn_rect.width(), size.0);
    let row = |y: f32| pixel(y, drawn_rect.top(), drawn_rect.height(), size.1);
    let region = Region {
        columns: (column(marked.left()), column(marked.right())),
        rows: (row(marked.top()), row(marked.bottom())),
    };
    let is_something = region.columns.0 < region.columns.1 && region.rows.0 < region.rows.1;
    is_something.then_some(region)
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::{pos2, vec2};

    #[test]
    fn what_is_marked_are_the_pixels_under_it() {
        let drawn_rect = Rect::from_min_size(pos2(-100.0, 50.0), vec2(800.0, 400.0));
        let marked = Rect::from_min_max(pos2(0.0, 150.0), pos2(100.0, 9999.0));
        let found = region(marked, drawn_rect, (1600, 800)).expect("some pixels");
        assert_eq!((found.columns, found.rows), ((200, 400), (200, 800)));
        let outside = Rect::from_min_max(pos2(-300.0, 0.0), pos2(-200.0, 10.0));
        assert_eq!(region(outside, drawn_rect, (1600, 800)), None);
    }
}
