//! One figure of all stability maps: a row per subject, a column per method.

use egui::{Align2, FontId, Painter, Pos2, Rect, TextStyle, Theme, Ui, pos2, vec2};

use super::super::raster::draw;
use super::super::theme::{GRID, palette};
use super::heat;
use super::ramp;
use super::rates;
use crate::image::Image;
use crate::lab::stability::{Map, number};
use crate::words::capitalised;

/// Width of the figure in points, and pixels per point.
const WIDTH: f32 = 800.0;
const SCALE: f32 = 2.0;
/// Maximum number of maps side by side; further ones wrap to the next line.
const COLUMNS: usize = 4;
/// Space for the numbers to the left of a map and below it.
const BESIDE: f32 = 34.0;
const BELOW: f32 = 34.0;
/// Heights of a map, of a line chart over one axis, and of a line of text.
const MAP: f32 = 92.0;
const LINES: f32 = 120.0;
const LINE: f32 = 15.0;
/// Height of a map with the text above and below it.
const MAP_WITH_WORDS: f32 = 3.0 * LINE + MAP + BELOW;

/// Draws all maps into one picture.
pub fn stability_picture(maps: &[Map]) -> Image {
    let rows: Vec<&[Map]> = maps
        .chunk_by(|one, other| one.subject == other.subject)
        .collect();
    let height = rows.iter().map(|row| height_of(row)).sum::<f32>() + 6.0 * GRID + LINE;
    draw(
        (WIDTH as u32, height.ceil() as u32),
        SCALE,
        Theme::Dark,
        |ui| {
            let area = ui.max_rect().shrink(2.0 * GRID);
            let mut top = area.top() + show_scale(ui, area);
            for row in &rows {
                let rest = Rect::from_min_max(pos2(area.left(), top), area.max);
                show_row(ui, rest, row);
                top += height_of(row);
            }
        },
    )
}

fn is_flat(map: &Map) -> bool {
    map.up.values.len() == 1
}

fn has_failures(map: &Map) -> bool {
    map.total().failures > 0
}

fn height_of(row: &[Map]) -> f32 {
    let head = 2.0 * LINE + GRID;
    if !row.iter().any(has_failures) {
        return head + LINE;
    }
    if is_flat(&row[0]) {
        return head + LINES + BELOW + GRID;
    }
    head + row.len().div_ceil(COLUMNS) as f32 * MAP_WITH_WORDS
}

/// Draws the colour scale; returns its height.
fn show_scale(ui: &Ui, area: Rect) -> f32 {
    let (painter, colors) = (ui.painter(), palette(ui.ctx()));
    let small = TextStyle::Small.resolve(ui.style());
    let words = painter.text(
        area.min,
        Align2::LEFT_TOP,
        "Share of trials that fail in single precision (32 bits). The default method comes first.",
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
    let top = area.top() + LINE + GRID / 2.0;
    if is_flat(&row[0]) && row.iter().any(has_failures) {
        let room = Rect::from_min_size(pos2(area.left(), top), vec2(area.width(), LINES + BELOW));
        return rates::show(ui, room, row);
    }
    let width = area.width() / COLUMNS as f32;
    let mut beside = BESIDE;
    for (index, map) in row.iter().enumerate() {
        let (line, column) = (index / COLUMNS, index % COLUMNS);
        let top = top + line as f32 * MAP_WITH_WORDS;
        if column == 0 {
            beside = BESIDE;
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
        let has_squares = has_failures(map) && !is_flat(map);
        let below = if has_squares {
            top + LINE
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
        let corner = pos2(left + beside, top + 3.0 * LINE);
        let squares = Rect::from_min_size(corner, vec2(width - beside - 2.0 * GRID, MAP));
        heat::paint_squares(ui, map, squares);
        label_axes(painter, map, squares, (&small, colors.muted), beside > GRID);
        // The vertical axis is labelled once per line of maps.
        beside = GRID;
    }
}

fn label_axes(
    painter: &Painter,
    map: &Map,
    squares: Rect,
    (font, color): (&FontId, egui::Color32),
    has_up: bool,
) {
    let font = FontId::new(font.size * 0.85, font.family.clone());
    let write = |at: Pos2, anchor: Align2, text: String| {
        painter.text(at, anchor, text, font.clone(), color);
    };
    let (columns, rows) = (map.across.values.len(), map.up.values.len());
    let every = columns.div_ceil(6);
    for (column, value) in map.across.values.iter().enumerate().step_by(every) {
        let x = squares.left() + (column as f32 + 0.5) * squares.width() / columns as f32;
        write(
            pos2(x, squares.bottom() + 2.0),
            Align2::CENTER_TOP,
            number(*value),
        );
    }
    let below = pos2(squares.center().x, squares.bottom() + 2.0 + LINE * 0.85);
    write(below, Align2::CENTER_TOP, map.across.name.to_owned());
    if !has_up {
        return;
    }
    let every = rows.div_ceil(6);
    for (row, value) in map.up.values.iter().enumerate().step_by(every) {
        let y = squares.bottom() - (row as f32 + 0.5) * squares.height() / rows as f32;
        write(
            pos2(squares.left() - 4.0, y),
            Align2::RIGHT_CENTER,
            number(*value),
        );
    }
    let above = pos2(squares.left() - BESIDE, squares.top() - 2.0);
    write(above, Align2::LEFT_BOTTOM, map.up.name.to_owned());
}
