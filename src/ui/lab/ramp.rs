//! The colours of failure rates.

use egui::{Color32, Painter, Rect, Stroke, pos2};

/// The lowest rate that has a colour of its own; each decade above it is a step brighter.
pub const LOWEST: f64 = 1e-5;

/// From rare to always: the upper part of *cividis*, which is as even for eyes without red or green.
///
/// Nuñez, Anderton and Renslow, "Optimizing colormaps with consideration for color vision deficiency", PLOS
/// ONE 13(7), 2018.
const STOPS: [Color32; 6] = [
    Color32::from_rgb(0x2A, 0x3F, 0x6D),
    Color32::from_rgb(0x4D, 0x56, 0x6D),
    Color32::from_rgb(0x70, 0x71, 0x73),
    Color32::from_rgb(0x98, 0x91, 0x77),
    Color32::from_rgb(0xC3, 0xB3, 0x69),
    Color32::from_rgb(0xFE, 0xE8, 0x38),
];

/// How far along the colours a rate is, 0–1.
pub fn share(rate: f64) -> f64 {
    (1.0 - rate.log10() / LOWEST.log10()).clamp(0.0, 1.0)
}

/// The colour of a rate above 0.
pub fn color(rate: f64) -> Color32 {
    let at = share(rate) * (STOPS.len() - 1) as f64;
    let first = (at.floor() as usize).min(STOPS.len() - 2);
    STOPS[first].lerp_to_gamma(STOPS[first + 1], (at - first as f64) as f32)
}

/// Slanting lines: nothing was tried there.
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
    fn more_failures_are_brighter() {
        let brightness = |rate: f64| {
            let [r, g, b, _] = color(rate).to_array().map(u32::from);
            2 * r + 3 * g + b
        };
        let rates = [1e-7, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.5, 1.0];
        for pair in rates.windows(2) {
            assert!(brightness(pair[0]) <= brightness(pair[1]), "{pair:?}");
        }
        assert_eq!((share(1.0), share(1e-9)), (1.0, 0.0));
    }
}
