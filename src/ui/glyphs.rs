//! A sign that a widget of the toolkit writes and no installed font has.

use egui::epaint::text::{GlyphBitmap, GlyphRasterizer, RasterizedGlyph};
use egui::{Color32, ColorImage, Context, vec2};

/// What the picker of colours writes on the button that copies a colour.
const COPY: &str = "📋";
/// Sides of the two sheets of paper, and how far they are apart, in font sizes.
const SHEET: (f32, f32) = (0.55, 0.7);
const APART: f32 = 0.18;

/// Draws the sign wherever it is written.
pub fn install(ctx: &Context) {
    ctx.add_glyph_rasterizer(GlyphRasterizer::new("glint copy", |request| {
        (request.cluster == COPY).then(|| two_sheets(request.font_size_px))
    }));
}

/// Two sheets of paper, one before the other.
fn two_sheets(size: f32) -> RasterizedGlyph {
    let pixels = |share: f32| (share * size).round().max(1.0) as usize;
    let (width, height, apart) = (pixels(SHEET.0), pixels(SHEET.1), pixels(APART));
    let whole = [width + apart, height + apart];
    let mut image = ColorImage::filled(whole, Color32::TRANSPARENT);
    for (left, top) in [(apart, 0), (0, apart)] {
        for row in 0..height {
            for column in 0..width {
                let is_edge = row == 0 || column == 0 || row + 1 == height || column + 1 == width;
                let pixel = &mut image.pixels[(top + row) * whole[0] + left + column];
                // The sheet in front hides what is behind it.
                *pixel = if is_edge {
                    Color32::WHITE
                } else {
                    Color32::TRANSPARENT
                };
            }
        }
    }
    RasterizedGlyph {
        advance_px: whole[0] as f32 + 1.0,
        bitmap: GlyphBitmap {
            image,
            offset_px: vec2(0.0, -(whole[1] as f32)),
            is_color: false,
        },
    }
}
