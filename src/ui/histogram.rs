//! The histogram of the picture, in a corner of it.

use std::sync::Arc;

use egui::{Color32, Rect, Shape, Stroke, StrokeKind, TextStyle, Ui, pos2, vec2};

use super::theme::{GRID, palette};
use crate::image::{Histogram, Image};
use crate::scene::Scene;
use crate::ui::rows::to_bytes;
use crate::worker::Frame;

/// Width and height of the graph in points.
const SIZE: (f32, f32) = (192.0, 64.0);
/// Height of the text below, in points.
const TEXT_HEIGHT: f32 = 18.0;
/// Least width beside the histogram that has room for something, in points.
const MIN_WIDTH_BESIDE: f32 = 280.0;

/// The histogram of the last finished picture.
#[derive(Default)]
pub struct Levels {
    image: Option<Arc<Image>>,
    histogram: Option<Histogram>,
}

impl Levels {
    /// Counts a finished picture, unless it is the same as before. Returns the share of its pixels that clip.
    pub fn update(&mut self, frame: &Frame, scene: &Scene) -> Option<f64> {
        let is_same = |image: &Arc<Image>| Arc::ptr_eq(image, &frame.image);
        if frame.step != 1 || self.image.as_ref().is_some_and(is_same) {
            return None;
        }
        self.image = Some(Arc::clone(&frame.image));
        let histogram = Histogram::of(&frame.image, to_bytes(scene.background));
        let clipped = histogram.clipped;
        self.histogram = Some(histogram);
        Some(clipped)
    }

    /// Draws the histogram over the lower left corner of the picture.
    pub fn show(&self, ui: &Ui, picture: Rect) {
        let Some(histogram) = &self.histogram else {
            return;
        };
        let colors = palette(ui.ctx());
        let frame = frame_in(picture);
        let painter = ui.painter().with_clip_rect(picture);
        let line = Stroke::new(1.0, colors.line);
        let fill = colors.panel.gamma_multiply(0.9);
        painter.rect(frame, 4, fill, line, StrokeKind::Inside);
        let graph = Rect::from_min_size(frame.min + vec2(GRID, GRID), SIZE.into());
        // The channels have the colours of the axes.
        for (counts, color) in histogram.counts.iter().zip(colors.axes) {
            painter.extend(curve(counts, histogram.highest(), graph, color));
        }
        let words = format!("{:.1} % at full brightness", histogram.clipped * 100.0);
        let font = TextStyle::Small.resolve(ui.style());
        let at = graph.left_bottom() + vec2(0.0, GRID / 2.0);
        painter.text(at, egui::Align2::LEFT_TOP, words, font, colors.text);
    }
}

/// Returns where the histogram is in a picture.
fn frame_in(picture: Rect) -> Rect {
    let size = vec2(SIZE.0, SIZE.1 + TEXT_HEIGHT) + vec2(GRID, GRID) * 2.0;
    let corner = picture.left_bottom() + vec2(GRID, -GRID - size.y);
    Rect::from_min_size(corner, size)
}

/// Returns the part of a picture to the right of the histogram, or above it if that is too narrow for words.
pub fn beside_histogram(picture: Rect) -> Rect {
    let frame = frame_in(picture);
    let right = picture.with_min_x(frame.right());
    if right.width() < MIN_WIDTH_BESIDE {
        picture.with_max_y(frame.top())
    } else {
        right
    }
}

/// Returns the curve of a channel: the square root of the counts, so that small counts are visible next to large ones.
fn curve(counts: &[u32; 256], highest: u32, graph: Rect, color: Color32) -> Vec<Shape> {
    let height = |count: u32| {
        (f64::from(count) / f64::from(highest.max(1)))
            .sqrt()
            .min(1.0)
    };
    let points = counts.iter().enumerate().map(|(level, count)| {
        let x = graph.left() + graph.width() * level as f32 / 255.0;
        pos2(x, graph.bottom() - graph.height() * height(*count) as f32)
    });
    let points: Vec<_> = points.collect();
    let stroke = Stroke::new(1.0, color);
    let pairs = points.windows(2);
    pairs
        .map(|pair| Shape::line_segment([pair[0], pair[1]], stroke))
        .collect()
}
