//! Glyphs that the window needs and no installed font has.

use egui::epaint::text::{GlyphBitmap, GlyphRasterizer, RasterizedGlyph};
use egui::{Color32, ColorImage, Context, vec2};

/// The character that the color picker writes on the button that copies a colour.
const COPY: &str = "📋";
/// Width and height of each of the two sheets of paper, and their distance, in font sizes.
const SHEET: (f32, f32) = (0.55, 0.7);
const SHEET_OFFSET: f32 = 0.18;

/// The minus sign of exponents.
const RAISED_MINUS: &str = "⁻";
/// Its advance width, its height above the baseline and its thickness, in font sizes.
const MINUS_BAR: (f32, f32, f32) = (0.36, 0.56, 0.06);

/// Registers rasterizers for these glyphs.
pub fn install(ctx: &Context) {
    ctx.add_glyph_rasterizer(GlyphRasterizer::new("glint raised minus", |request| {
        (request.cluster == RAISED_MINUS).then(|| raised_minus(request.font_size_px))
    }));
    ctx.add_glyph_rasterizer(GlyphRasterizer::new("glint copy", |request| {
        (request.cluster == COPY).then(|| two_sheets(request.font_size_px))
    }));
}

fn raised_minus(size: f32) -> RasterizedGlyph {
    let (advance, up, thickness) = MINUS_BAR;
    let pixels = |share: f32| (share * size).round().max(1.0);
    let bar = [pixels(advance * 0.8) as usize, pixels(thickness) as usize];
    RasterizedGlyph {
        advance_px: pixels(advance),
        bitmap: GlyphBitmap {
            image: ColorImage::filled(bar, Color32::WHITE),
            offset_px: vec2(pixels(advance * 0.1), -pixels(up)),
            is_color: false,
        },
    }
}

/// Draws two sheets of paper, one in front of the other.
fn two_sheets(size: f32) -> RasterizedGlyph {
    let pixels = |share: f32| (share * size).round().max(1.0) as usize;
    let (width, height, offset) = (pixels(SHEET.0), pixels(SHEET.1), pixels(SHEET_OFFSET));
    let whole = [width + offset, height + offset];
    let mut image = ColorImage::filled(whole, Color32::TRANSPARENT);
    for (left, top) in [(offset, 0), (0, offset)] {
        for row in 0..height {
            for column in 0..width {
                let is_edge = row == 0 || column == 0 || row + 1 == height || column + 1 == width;
                let pixel = &mut image.pixels[(top + row) * whole[0] + left + column];
                // The sheet in front is drawn last and covers the other one.
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
