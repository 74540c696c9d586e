//! Magnification of the still picture: the wheel enlarges it by whole factors, a drag moves it.

use egui::{Pos2, Rect, Vec2, vec2};

/// Greatest side of a picture pixel, in screen pixels.
const MAX_FACTOR: u32 = 32;

/// Magnification and position of a still picture.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Magnifier {
    /// Screen pixels per picture pixel; 0 shows the whole picture.
    pub factor: u32,
    /// The point of the picture in the middle of the window, in shares of the picture from its middle.
    middle: Vec2,
}

impl Magnifier {
    /// Returns where to draw a picture of `size` pixels, which as a whole would fill `fitting`.
    pub fn picture_rect(&self, fitting: Rect, size: (usize, usize), pixels_per_point: f32) -> Rect {
        if self.factor == 0 {
            return fitting;
        }
        let scale = self.factor as f32 / pixels_per_point;
        let size = vec2(size.0 as f32, size.1 as f32) * scale;
        let middle = fitting.center() - self.middle * size;
        let corner = (middle.to_vec2() - size / 2.0) * pixels_per_point;
        Rect::from_min_size((corner.round() / pixels_per_point).to_pos2(), size)
    }

    /// Doubles or halves the magnification around `at`. When it shrinks to fit the window, the whole picture is shown.
    pub fn zoom_step(
        &mut self,
        up: bool,
        at: Pos2,
        (fitting, size, pixels_per_point): (Rect, (usize, usize), f32),
    ) {
        let before = self.picture_rect(fitting, size, pixels_per_point);
        let anchor = (at - before.min) / before.size();
        let shown = before.width() * pixels_per_point / size.0.max(1) as f32;
        if up && shown >= MAX_FACTOR as f32 {
            return;
        }
        self.factor = if up {
            let next = if self.factor == 0 {
                (shown.floor() as u32 + 1).next_power_of_two()
            } else {
                self.factor * 2
            };
            next.min(MAX_FACTOR)
        } else {
            self.factor / 2
        };
        let fits = self.factor as f32 * size.0 as f32 / pixels_per_point <= fitting.width();
        if self.factor == 0 || (!up && fits) {
            *self = Self::default();
            return;
        }
        let after = self.picture_rect(fitting, size, pixels_per_point);
        let moved = at - (after.min + anchor * after.size());
        self.pan(moved, after);
    }

    /// Moves the picture, which is drawn to `rect`.
    pub fn pan(&mut self, by: Vec2, rect: Rect) {
        if self.factor > 0 {
            let half = Vec2::splat(0.5);
            self.middle = (self.middle - by / rect.size()).clamp(-half, half);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::pos2;

    #[test]
    fn what_is_under_the_pointer_stays_there() {
        let fitting = Rect::from_min_size(pos2(100.0, 50.0), vec2(500.0, 400.0));
        let (size, scale) = ((1000, 800), 1.0);
        let mut magnifier = Magnifier::default();
        assert_eq!(magnifier.picture_rect(fitting, size, scale), fitting);
        let at = pos2(220.0, 170.0);
        let pixel = |magnifier: &Magnifier| {
            let place = magnifier.picture_rect(fitting, size, scale);
            (at - place.min) / place.size() * vec2(1000.0, 800.0)
        };
        let before = pixel(&magnifier);
        for factor in [1, 2, 4, 8, 16, 32, 32] {
            magnifier.zoom_step(true, at, (fitting, size, scale));
            assert_eq!(magnifier.factor, factor);
            assert!((pixel(&magnifier) - before).length() < 2.0);
        }
        for factor in [16, 8, 4, 2, 1, 0] {
            magnifier.zoom_step(false, at, (fitting, size, scale));
            assert_eq!(magnifier.factor, factor);
        }
        assert_eq!(magnifier, Magnifier::default());
    }

    #[test]
    fn a_small_picture_is_enlarged_from_what_is_seen() {
        let fitting = Rect::from_min_size(pos2(0.0, 0.0), vec2(640.0, 640.0));
        let mut magnifier = Magnifier::default();
        magnifier.zoom_step(true, pos2(9.0, 9.0), (fitting, (64, 64), 1.0));
        assert_eq!(magnifier.factor, 16, "ten times as large is all of it");
        magnifier.zoom_step(false, pos2(9.0, 9.0), (fitting, (64, 64), 1.0));
        assert_eq!(magnifier.factor, 0);
    }
}
