//! Drawing of a stability map as coloured squares.

use egui::{Align2, Color32, FontId, Painter, Rect, Sense, Stroke, StrokeKind, Ui, pos2, vec2};

use super::ramp;
use crate::lab::stability::{Axis, Map, number};
use crate::ui::theme::palette;

/// Space for the numbers at the left and below.
const MARGIN: (f32, f32) = (40.0, 30.0);
/// Font size of the numbers.
const NUMBER_SIZE: f32 = 10.0;

/// Draws a map of the given size, with a ring at the position of the scene, if given.
pub fn show(ui: &mut Ui, map: &Map, size: egui::Vec2, marker: Option<(f64, f64)>) {
    let (area, response) = ui.allocate_exact_size(size, Sense::hover());
    let colors = palette(ui.ctx());
    let squares = Rect::from_min_max(
        pos2(area.left() + MARGIN.0, area.top()),
        pos2(area.right(), area.bottom() - MARGIN.1),
    );
    let square = |index: usize| square_of(map, squares, index);
    paint_squares(ui, map, squares);
    let painter = ui.painter();
    let font = FontId::proportional(NUMBER_SIZE);
    number_columns(painter, (&map.across, squares, 1), (&font, colors.muted));
    let names = if map.up.values.len() > 1 {
        number_rows(painter, (&map.up, squares, 1), (&font, colors.muted));
        format!("{}   (vertical: {})", map.across.name, map.up.name)
    } else {
        map.across.name.to_owned()
    };
    let below = pos2(squares.center().x, area.bottom());
    painter.text(below, Align2::CENTER_BOTTOM, names, font, colors.muted);
    if let Some((x, y)) = marker {
        let columns = map.across.values.len();
        let index = nearest(&map.up, y) * columns + nearest(&map.across, x);
        let ring = Stroke::new(2.0, colors.text);
        painter.rect_stroke(square(index), 2, ring, StrokeKind::Inside);
    }
    if let Some(pointer) = response.hover_pos() {
        let hovered = (0..map.cells.len()).find(|&index| square(index).contains(pointer));
        if let Some(index) = hovered {
            response.on_hover_text_at_pointer(describe(map, index));
        }
    }
}

/// Horizontal position of the middle of a column, one for each value of an axis.
pub fn middle_of_column(axis: &Axis, area: Rect, column: usize) -> f32 {
    area.left() + (column as f32 + 0.5) * area.width() / axis.values.len() as f32
}

/// Writes every `stride`-th number of a horizontal axis below the columns of an area.
pub fn number_columns(
    painter: &Painter,
    (axis, area, stride): (&Axis, Rect, usize),
    (font, color): (&FontId, Color32),
) {
    for (column, value) in axis.values.iter().enumerate().step_by(stride) {
        let at = pos2(middle_of_column(axis, area, column), area.bottom() + 2.0);
        let text = number(*value);
        painter.text(at, Align2::CENTER_TOP, text, font.clone(), color);
    }
}

/// Writes every `stride`-th number of a vertical axis to the left of the rows of an area.
pub fn number_rows(
    painter: &Painter,
    (axis, area, stride): (&Axis, Rect, usize),
    (font, color): (&FontId, Color32),
) {
    for (row, value) in axis.values.iter().enumerate().step_by(stride) {
        let y = area.bottom() - (row as f32 + 0.5) * area.height() / axis.values.len() as f32;
        let (at, text) = (pos2(area.left() - 4.0, y), number(*value));
        painter.text(at, Align2::RIGHT_CENTER, text, font.clone(), color);
    }
}

/// Returns whether a method fails anywhere within one step of the scene's position.
pub fn is_near_failing(map: &Map, (x, y): (f64, f64)) -> bool {
    let columns = map.across.values.len();
    let (column, row) = (nearest(&map.across, x), nearest(&map.up, y));
    map.cells.iter().enumerate().any(|(index, tries)| {
        let is_near_column = (index % columns).abs_diff(column) <= 1;
        is_near_column && (index / columns).abs_diff(row) <= 1 && tries.failures > 0
    })
}

/// Index of the mark nearest to a value on a logarithmic axis.
fn nearest(axis: &Axis, value: f64) -> usize {
    let distance = |mark: f64| {
        if mark == 0.0 || value == 0.0 {
            // Zero is infinitely far away on a logarithmic axis: its mark stands for all values well below the next
            // one.
            let smallest_positive = axis.values.iter().copied().filter(|mark| *mark > 0.0);
            let smallest_positive = smallest_positive.min_by(f64::total_cmp);
            let is_below =
                smallest_positive.is_some_and(|smallest_positive| value < smallest_positive * 0.3);
            return if (mark == 0.0) == is_below {
                0.0
            } else {
                f64::INFINITY
            };
        }
        (mark.log10() - value.abs().log10()).abs()
    };
    let marks = axis.values.iter().enumerate();
    let nearest = marks.min_by(|a, b| distance(*a.1).total_cmp(&distance(*b.1)));
    nearest.map_or(0, |(index, _)| index)
}

/// Rectangle of a cell within the area of the map.
fn square_of(map: &Map, area: Rect, index: usize) -> Rect {
    let (columns, rows) = (map.across.values.len(), map.up.values.len());
    let cell = vec2(area.width() / columns as f32, area.height() / rows as f32);
    let (column, row) = (index % columns, index / columns);
    let corner = pos2(
        area.left() + column as f32 * cell.x,
        area.bottom() - (row + 1) as f32 * cell.y,
    );
    Rect::from_min_size(corner, cell)
}

/// Draws the squares of a map without axes.
pub fn paint_squares(ui: &Ui, map: &Map, area: Rect) {
    let colors = palette(ui.ctx());
    for (index, tries) in map.cells.iter().enumerate() {
        let square = square_of(map, area, index).shrink(0.5);
        if tries.tries == 0 {
            ramp::hatch(ui.painter(), square, Stroke::new(0.5, colors.muted));
            continue;
        }
        let color = match tries.failures {
            0 => colors.raised,
            _ => ramp::color(ui.theme(), tries.rate()),
        };
        ui.painter().rect_filled(square, 1, color);
    }
}

fn describe(map: &Map, index: usize) -> String {
    let columns = map.across.values.len();
    let cell = map.cells[index];
    let at = format!(
        "{} {}, {} {}",
        map.across.name,
        number(map.across.values[index % columns]),
        map.up.name,
        number(map.up.values[index / columns]),
    );
    if cell.failures == 0 {
        return format!(
            "{at}\nnone of {} failed: below {:.1e} with 95 % confidence",
            cell.tries,
            cell.bound()
        );
    }
    format!(
        "{at}\n{} of {} failed: {:.3} %, below {:.3} % with 95 % confidence",
        cell.failures,
        cell.tries,
        cell.rate() * 100.0,
        cell.bound() * 100.0
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::stability::{MapSubject, Tries};

    #[test]
    fn a_scene_stands_at_the_nearest_mark() {
        let axis = Axis {
            name: "away",
            values: vec![0.0, 1.0, 10.0, 100.0],
        };
        let places = [0.0, 0.1, 0.9, 4.0, 31.0, 33.0, 1e9].map(|value| nearest(&axis, value));
        assert_eq!(places, [0, 0, 1, 2, 2, 3, 3]);
        let only = |index: usize| Map {
            subject: MapSubject::Sphere,
            method: String::new(),
            is_default: true,
            failure: "",
            across: axis.clone(),
            up: Axis {
                name: "one",
                values: vec![1.0],
            },
            cells: (0..4)
                .map(|at| Tries {
                    tries: 10,
                    failures: u64::from(at == index),
                })
                .collect(),
        };
        assert!(is_near_failing(&only(2), (1.0, 1.0)));
        assert!(!is_near_failing(&only(3), (1.0, 1.0)));
        assert!(describe(&only(3), 3).contains("1 of 10 failed"));
        assert!(describe(&only(3), 0).contains("none of 10 failed: below 3.0e-1"));
    }
}
