//! The meaning of a view's colours, in a corner of the picture: a scale for *Rays per pixel*, a text for the others.

use egui::{
    Align2, Color32, Mesh, Painter, Rect, Shape, Stroke, StrokeKind, TextStyle, Ui, Vec2, pos2,
    vec2,
};

use super::theme::{GRID, palette};
use crate::trace::heat;

/// Width and height of the strip in points.
const STRIP: (f32, f32) = (192.0, 10.0);
/// Height of the text below, in points.
const TEXT_HEIGHT: f32 = 16.0;
/// Number of columns that the strip is drawn with.
const COLUMNS: u32 = 96;
/// Counts that are labelled, from one end of the strip to the other.
const LABELLED_COUNTS: [f64; 4] = [1.0, 10.0, 100.0, 1000.0];

/// Draws the description of a view over the lower right corner of the picture.
pub fn show_words(ui: &Ui, picture: Rect, words: &str) {
    let font = TextStyle::Small.resolve(ui.style());
    let max_width = (picture.width() - 4.0 * GRID).max(0.0);
    let color = palette(ui.ctx()).text;
    let words = ui
        .painter()
        .layout(words.to_owned(), font, color, max_width);
    let (painter, frame) = frame(ui, picture, words.size() + vec2(GRID, GRID / 2.0) * 2.0);
    painter.galley(frame.min + vec2(GRID, GRID / 2.0), words, color);
}

/// Draws a frame of this size in the lower right corner; returns it, and a painter for its contents.
fn frame(ui: &Ui, picture: Rect, size: Vec2) -> (Painter, Rect) {
    let colors = palette(ui.ctx());
    let corner = picture.right_bottom() - size - vec2(GRID, GRID);
    let frame = Rect::from_min_size(corner, size);
    let painter = ui.painter().with_clip_rect(picture);
    let line = Stroke::new(1.0, colors.line);
    painter.rect(frame, 4, colors.panel, line, StrokeKind::Inside);
    (painter, frame)
}

/// Draws the scale over the lower right corner of the picture.
pub fn show(ui: &Ui, picture: Rect) {
    let colors = palette(ui.ctx());
    let size = vec2(STRIP.0, STRIP.1 + TEXT_HEIGHT) + vec2(3.0, 1.0) * 2.0 * GRID;
    let (painter, frame) = frame(ui, picture, size);
    let strip = Rect::from_min_size(frame.min + vec2(3.0 * GRID, GRID), STRIP.into());
    painter.add(heat_strip(strip));
    let font = TextStyle::Small.resolve(ui.style());
    for (count, index) in LABELLED_COUNTS.into_iter().zip(0_u8..) {
        let fraction = f32::from(index) / (LABELLED_COUNTS.len() - 1) as f32;
        let at = pos2(
            strip.left() + fraction * strip.width(),
            strip.bottom() + GRID / 2.0,
        );
        let words = match count {
            1.0 => "1 ray".to_owned(),
            count => format!("{count}"),
        };
        painter.text(at, Align2::CENTER_TOP, words, font.clone(), colors.text);
    }
}

/// Returns the strip, with a logarithmic scale like that of the picture.
fn heat_strip(strip: Rect) -> Shape {
    let mut mesh = Mesh::default();
    let [first, .., last] = LABELLED_COUNTS;
    for column in 0..COLUMNS {
        let fraction = f64::from(column) / f64::from(COLUMNS - 1);
        let [red, green, blue] = heat::<f64>(first * (last / first).powf(fraction))
            .map(|channel| (channel * 255.0) as u8);
        let width = strip.width() / COLUMNS as f32;
        let left = strip.left() + column as f32 * width;
        let rect = Rect::from_x_y_ranges(left..=left + width, strip.y_range());
        mesh.add_colored_rect(rect, Color32::from_rgb(red, green, blue));
    }
    Shape::mesh(mesh)
}
