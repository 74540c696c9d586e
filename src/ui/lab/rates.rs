//! Failure rates over one axis: lines with confidence intervals.

use egui::{Align2, FontId, Rect, Stroke, TextStyle, Ui, pos2};

use super::heat::{middle_of_column, number_columns};
use super::ramp;
use crate::lab::stability::{Map, Tries};
use crate::ui::theme::{GRID, palette};

/// Space for the numbers at the left and below.
const MARGIN: (f32, f32) = (34.0, 30.0);
/// Width of the column that names the methods.
const NAMES_WIDTH: f32 = 250.0;

/// Draws the rates of methods that were tested over the same axis.
pub fn show(ui: &Ui, area: Rect, row: &[Map]) {
    let (painter, colors) = (ui.painter(), palette(ui.ctx()));
    let small = TextStyle::Small.resolve(ui.style());
    let font = FontId::new(small.size * 0.85, small.family.clone());
    let frame = Rect::from_min_max(
        pos2(area.left() + MARGIN.0, area.top() + GRID / 2.0),
        pos2(area.right() - NAMES_WIDTH, area.bottom() - MARGIN.1),
    );
    let height = |rate: f64| frame.bottom() - ramp::scale_position(rate) as f32 * frame.height();
    for (power, name) in [
        (0, "always"),
        (-1, "10⁻¹"),
        (-2, "10⁻²"),
        (-3, "10⁻³"),
        (-4, "10⁻⁴"),
        (-5, "10⁻⁵"),
    ] {
        let y = height(10.0_f64.powi(power));
        painter.hline(frame.x_range(), y, Stroke::new(0.5, colors.line));
        let at = pos2(frame.left() - 4.0, y);
        painter.text(at, Align2::RIGHT_CENTER, name, font.clone(), colors.muted);
    }
    let axis = &row[0].across;
    number_columns(painter, (axis, frame, 1), (&font, colors.muted));
    let below = pos2(frame.center().x, frame.bottom() + 2.0 + small.size);
    painter.text(below, Align2::CENTER_TOP, axis.name, font, colors.muted);
    for (method_index, map) in row.iter().enumerate() {
        let color = colors.families[method_index % colors.families.len()];
        // Shifted sideways, so that equal rates do not cover each other.
        let shift = (method_index as f32 - (row.len() as f32 - 1.0) / 2.0) * 5.0;
        let at = |index: usize, rate: f64| {
            pos2(middle_of_column(axis, frame, index) + shift, height(rate))
        };
        let points = map.cells.iter().enumerate();
        let points: Vec<_> = points.map(|(index, cell)| at(index, cell.rate())).collect();
        painter.line(points.clone(), Stroke::new(1.0, color.gamma_multiply(0.6)));
        for ((index, cell), point) in map.cells.iter().enumerate().zip(&points) {
            let (low, high) = interval(*cell);
            let ends = [at(index, low), at(index, high)];
            painter.line_segment(ends, Stroke::new(1.0, color));
            if cell.failures > 0 {
                painter.circle_filled(*point, 3.0, color);
            } else {
                painter.circle_stroke(*point, 3.0, Stroke::new(1.0, color));
            }
        }
        let y = frame.top() + method_index as f32 * 2.0 * (small.size + 3.0);
        let name = pos2(frame.right() + 2.0 * GRID, y);
        painter.circle_filled(pos2(name.x, y + small.size / 2.0 + 1.0), 3.5, color);
        let text = pos2(name.x + GRID, y);
        painter.text(
            text,
            Align2::LEFT_TOP,
            &map.method,
            small.clone(),
            colors.text,
        );
        let text = pos2(name.x + GRID, y + small.size + 2.0);
        painter.text(
            text,
            Align2::LEFT_TOP,
            map.sentence(),
            small.clone(),
            colors.muted,
        );
    }
}

/// The interval that holds the true rate with a confidence of 90 %.
fn interval(tries: Tries) -> (f64, f64) {
    let successes = Tries {
        tries: tries.tries,
        failures: tries.tries - tries.failures,
    };
    (1.0 - successes.bound(), tries.bound())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interval_holds_the_rate_that_was_seen() {
        for failures in [0, 1, 50, 99, 100] {
            let tries = Tries {
                tries: 100,
                failures,
            };
            let (low, high) = interval(tries);
            assert!((0.0..=tries.rate()).contains(&low) && (tries.rate()..=1.0).contains(&high));
            assert!(high - low > 0.02 && high - low < 0.2, "{low} {high}");
        }
    }
}
