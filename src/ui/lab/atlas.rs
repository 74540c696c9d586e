//! One figure of all stability maps: a row per subject, a column per method.

use egui::{Align2, FontId, Painter, Rect, TextStyle, Theme, Ui, pos2, vec2};

use super::heat;
use super::ramp;
use super::rates;
use crate::image::Image;
use crate::lab::stability::{Axis, Map};
use crate::ui::raster::draw;
use crate::ui::theme::{GRID, palette};
use crate::words::capitalised;

/// Width of the figure in points.
const WIDTH: f32 = 800.0;
/// Maximum number of maps side by side; further ones wrap to the next line.
const COLUMNS: usize = 4;
/// Space for the numbers to the left of a map and below it.
const LEFT_MARGIN: f32 = 34.0;
const BOTTOM_MARGIN: f32 = 34.0;
/// Heights of a map, of a line chart over one axis, and of a line of text.
const MAP_HEIGHT: f32 = 92.0;
const CHART_HEIGHT: f32 = 120.0;
const LINE_HEIGHT: f32 = 15.0;
/// Height of a map with the text above and below it.
const LABELLED_MAP_HEIGHT: f32 = 3.0 * LINE_HEIGHT + MAP_HEIGHT + BOTTOM_MARGIN;

/// Draws all maps into one picture.
pub fn stability_picture(maps: &[Map]) -> Image {
    let rows: Vec<&[Map]> = maps
        .chunk_by(|one, other| one.subject == other.subject)
        .collect();
    let height = rows.iter().map(|row| height_of(row)).sum::<f32>() + 6.0 * GRID + LINE_HEIGHT;
    let size = (WIDTH as u32, height.ceil() as u32);
    draw(size, Theme::Dark, |ui| {
        let area = ui.max_rect().shrink(2.0 * GRID);
        let mut top = area.top() + show_scale(ui, area);
        for row in &rows {
            let remaining = Rect::from_min_max(pos2(area.left(), top), area.max);
            show_row(ui, remaining, row);
            top += height_of(row);
        }
    })
}

fn has_single_row(map: &Map) -> bool {
    map.up.values.len() == 1
}

fn has_failures(map: &Map) -> bool {
    map.total().failures > 0
}

fn height_of(row: &[Map]) -> f32 {
    let header = 2.0 * LINE_HEIGHT + GRID;
    if !row.iter().any(has_failures) {
        return header + LINE_HEIGHT;
    }
    if has_single_row(&row[0]) {
        return header + CHART_HEIGHT + BOTTOM_MARGIN + GRID;
    }
    header + row.len().div_ceil(COLUMNS) as f32 * LABELLED_MAP_HEIGHT
}

/// Draws the colour scale; returns its height.
fn show_scale(ui: &Ui, area: Rect) -> f32 {
    let (painter, colors) = (ui.painter(), palette(ui.ctx()));
    let small = TextStyle::Small.resolve(ui.style());
    let words = painter.text(
        area.min,
        Align2::LEFT_TOP,
        "Share of trials that fail; in single precision (32 bits) unless it says otherwise. The default method comes first.",
        small.clone(),
        colors.text,
    );
    let bar = Rect::from_min_size(
        pos2(area.right() - 220.0, words.top() + 2.0),
        vec2(160.0, words.height() - 4.0),
    );
    ramp::show_bar(ui, bar);
    words.height() + 2.0 * GRID
}

fn show_row(ui: &Ui, area: Rect, row: &[Map]) {
    let (painter, colors) = (ui.painter(), palette(ui.ctx()));
    let strong = TextStyle::Body.resolve(ui.style());
    let small = TextStyle::Small.resolve(ui.style());
    let name = capitalised(row[0].subject.name());
    let title = painter.text(area.min, Align2::LEFT_TOP, name, strong, colors.text);
    painter.text(
        pos2(title.right() + GRID, title.bottom() - 1.0),
        Align2::LEFT_BOTTOM,
        format!("fails: {}", row[0].failure),
        small.clone(),
        colors.muted,
    );
    let top = area.top() + LINE_HEIGHT + GRID / 2.0;
    if has_single_row(&row[0]) && row.iter().any(has_failures) {
        let chart_area = Rect::from_min_size(
            pos2(area.left(), top),
            vec2(area.width(), CHART_HEIGHT + BOTTOM_MARGIN),
        );
        return rates::show(ui, chart_area, row);
    }
    let width = area.width() / COLUMNS as f32;
    let mut left_margin = LEFT_MARGIN;
    for (index, map) in row.iter().enumerate() {
        let (line, column) = (index / COLUMNS, index % COLUMNS);
        let top = top + line as f32 * LABELLED_MAP_HEIGHT;
        if column == 0 {
            left_margin = LEFT_MARGIN;
        }
        let left = area.left() + column as f32 * width;
        let at = pos2(left, top);
        let method = painter.text(
            at,
            Align2::LEFT_TOP,
            &map.method,
            small.clone(),
            colors.text,
        );
        let color = if has_failures(map) {
            colors.text
        } else {
            colors.muted
        };
        let has_squares = has_failures(map) && !has_single_row(map);
        let below = if has_squares {
            top + LINE_HEIGHT
        } else {
            method.bottom() + 1.0
        };
        painter.text(
            pos2(left, below),
            Align2::LEFT_TOP,
            map.sentence(),
            small.clone(),
            color,
        );
        if !has_squares {
            continue;
        }
        let corner = pos2(left + left_margin, top + 3.0 * LINE_HEIGHT);
        let squares =
            Rect::from_min_size(corner, vec2(width - left_margin - 2.0 * GRID, MAP_HEIGHT));
        heat::paint_squares(ui, map, squares);
        label_axes(
            painter,
            map,
            squares,
            (&small, colors.muted),
            left_margin > GRID,
        );
        // The vertical axis is labelled once per line of maps.
        left_margin = GRID;
    }
}

fn label_axes(
    painter: &Painter,
    map: &Map,
    squares: Rect,
    (font, color): (&FontId, egui::Color32),
    has_vertical_labels: bool,
) {
    let font = FontId::new(font.size * 0.85, font.family.clone());
    let stride = |axis: &Axis| axis.values.len().div_ceil(6);
    let across = (&map.across, squares, stride(&map.across));
    heat::number_columns(painter, across, (&font, color));
    let below = pos2(
        squares.center().x,
        squares.bottom() + 2.0 + LINE_HEIGHT * 0.85,
    );
    let name = map.across.name;
    painter.text(below, Align2::CENTER_TOP, name, font.clone(), color);
    if has_vertical_labels {
        heat::number_rows(painter, (&map.up, squares, stride(&map.up)), (&font, color));
        let above = pos2(squares.left() - LEFT_MARGIN, squares.top() - 2.0);
        painter.text(above, Align2::LEFT_BOTTOM, map.up.name, font, color);
    }
}
