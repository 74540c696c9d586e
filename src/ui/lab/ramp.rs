//! Colour scale of failure rates.

use egui::{Align2, Color32, Painter, Pos2, Rect, Stroke, TextStyle, Theme, Ui, pos2, vec2};

use crate::ui::theme::palette;

/// The lowest rate that is distinguished from rarer ones; the scale from here to 1 is logarithmic.
pub const LOWEST_RATE: f64 = 1e-5;

/// From rare to always: the upper part of *cividis*, which stays perceptually uniform under red-green colour
/// blindness.
///
/// Nuñez, Anderton and Renslow, "Optimizing colormaps with consideration for color vision deficiency", PLOS ONE
/// 13(7), 2018.
const STOPS: [Color32; 6] = [
    Color32::from_rgb(0x2A, 0x3F, 0x6D),
    Color32::from_rgb(0x4D, 0x56, 0x6D),
    Color32::from_rgb(0x70, 0x71, 0x73),
    Color32::from_rgb(0x98, 0x91, 0x77),
    Color32::from_rgb(0xC3, 0xB3, 0x69),
    Color32::from_rgb(0xFE, 0xE8, 0x38),
];

/// Position of a rate on the scale, 0–1.
pub fn scale_position(rate: f64) -> f64 {
    (1.0 - rate.log10() / LOWEST_RATE.log10()).clamp(0.0, 1.0)
}

/// The colour of a rate above 0: the higher, the more it contrasts with the background.
pub fn color(theme: Theme, rate: f64) -> Color32 {
    let position = match theme {
        Theme::Dark => scale_position(rate),
        Theme::Light => 1.0 - scale_position(rate),
    };
    let at = position * (STOPS.len() - 1) as f64;
    let first = (at.floor() as usize).min(STOPS.len() - 2);
    STOPS[first].lerp_to_gamma(STOPS[first + 1], (at - first as f64) as f32)
}

/// Draws the scale as a bar with labels at its ends.
pub fn show_bar(ui: &Ui, bar: Rect) {
    let painter = ui.painter();
    let steps = 80_u16;
    for step in 0..steps {
        let at = f32::from(step) / f32::from(steps);
        let rate = LOWEST_RATE.powf(1.0 - f64::from(at));
        let left = bar.left() + at * bar.width();
        let part = Rect::from_min_size(
            pos2(left, bar.top()),
            vec2(bar.width() / f32::from(steps) + 0.5, bar.height()),
        );
        painter.rect_filled(part, 0, color(ui.theme(), rate));
    }
    let small = TextStyle::Small.resolve(ui.style());
    let write = |at: Pos2, anchor: Align2, text: &str| {
        painter.text(at, anchor, text, small.clone(), palette(ui.ctx()).muted);
    };
    let gap = vec2(4.0, 0.0);
    write(bar.left_center() - gap, Align2::RIGHT_CENTER, "10⁻⁵");
    write(bar.right_center() + gap, Align2::LEFT_CENTER, "always");
}

/// Hatches an area in which nothing was tested.
pub fn hatch(painter: &Painter, area: Rect, line: Stroke) {
    let painter = painter.with_clip_rect(area.intersect(painter.clip_rect()));
    let mut x = area.left() - area.height();
    while x < area.right() {
        let slant = [pos2(x, area.bottom()), pos2(x + area.height(), area.top())];
        painter.line_segment(slant, line);
        x += 5.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_failures_are_farther_from_the_background() {
        let brightness = |theme: Theme, rate: f64| {
            let [r, g, b, _] = color(theme, rate).to_array().map(u32::from);
            2 * r + 3 * g + b
        };
        let rates = [1e-7, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.5, 1.0];
        for pair in rates.windows(2) {
            let dark = |rate: f64| brightness(Theme::Dark, rate);
            assert!(dark(pair[0]) <= dark(pair[1]), "{pair:?}");
            let light = |rate: f64| brightness(Theme::Light, rate);
            assert!(light(pair[0]) >= light(pair[1]), "{pair:?}");
        }
        assert_eq!((scale_position(1.0), scale_position(1e-9)), (1.0, 0.0));
    }
}
