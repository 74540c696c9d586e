//! The picture of a selected dot, its reference, or the difference of the two, shown instead of the live view.

use egui::{Response, Sense, TextureHandle, TextureOptions, Ui};

use crate::image::Image;
use crate::ui::upload::{paint, to_color_image};
use crate::ui::viewport::Place;

/// What is shown of a dot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ComparisonMode {
    /// Its picture.
    Picture,
    /// The reference picture.
    Reference,
    /// The absolute difference of each channel, multiplied by this.
    Absolute(u32),
    /// The signed difference around middle grey, multiplied by this.
    Signed(u32),
}

/// The modes on offer, each with its label and hint.
pub const COMPARISON_MODES: [(ComparisonMode, &str, &str); 7] = [
    (ComparisonMode::Picture, "This", "The picture of the dot"),
    (
        ComparisonMode::Reference,
        "Reference",
        "What the picture should be; hold B to see it for a moment",
    ),
    (
        ComparisonMode::Absolute(1),
        "Difference ×1",
        "How far each channel is off",
    ),
    (
        ComparisonMode::Absolute(8),
        "×8",
        "How far each channel is off, magnified 8 times",
    ),
    (
        ComparisonMode::Absolute(64),
        "×64",
        "How far each channel is off, magnified 64 times",
    ),
    (
        ComparisonMode::Signed(8),
        "Signed ×8",
        "Above grey is too bright, below too dark; magnified 8 times",
    ),
    (
        ComparisonMode::Signed(64),
        "Signed ×64",
        "Above grey is too bright, below too dark; magnified 64 times",
    ),
];

/// Computes the picture of a mode.
pub fn compose(picture: &Image, reference: &Image, mode: ComparisonMode) -> Image {
    let channel = |a: u8, b: u8| {
        let difference = i64::from(a) - i64::from(b);
        let shown = match mode {
            ComparisonMode::Picture => i64::from(a),
            ComparisonMode::Reference => i64::from(b),
            ComparisonMode::Absolute(gain) => difference.abs() * i64::from(gain),
            ComparisonMode::Signed(gain) => 128 + difference * i64::from(gain),
        };
        shown.clamp(0, 255) as u8
    };
    let pixels = picture.pixels.iter().zip(&reference.pixels);
    Image {
        pixels: pixels
            .map(|(a, b)| {
                let [red, green, blue] = [0, 1, 2].map(|c| channel(a[c], b[c]));
                [red, green, blue, 255]
            })
            .collect(),
        ..*picture
    }
}

/// A picture of a dot: the dot, the mode and the study.
type ShownPicture = (usize, ComparisonMode, u64);

/// The picture on screen, with its texture.
#[derive(Default)]
pub struct Comparison(Option<(ShownPicture, TextureHandle)>);

impl Comparison {
    /// Draws a picture of a dot in the rectangle of the live view. A tooltip shows the pixel under the pointer.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        place: Place,
        wanted: ShownPicture,
        (picture, reference): (&Image, &Image),
    ) -> Response {
        let shown = self.0.take().filter(|(shown, _)| *shown == wanted);
        let (_, texture) = self.0.insert(shown.unwrap_or_else(|| {
            let image = to_color_image(&compose(picture, reference, wanted.1));
            let texture = ui.load_texture("lab picture", image, TextureOptions::NEAREST);
            (wanted, texture)
        }));
        let response = ui.allocate_rect(place.rect, Sense::click_and_drag());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "Lab picture"));
        paint(ui.painter(), texture, place.rect);
        if let Some(pointer) = response.hover_pos() {
            let text = describe_pixel(
                picture,
                reference,
                (pointer - place.rect.min) / place.rect.size(),
            );
            return response.on_hover_text_at_pointer(text);
        }
        response
    }
}

/// Describes a pixel and its reference; `at` is the position as fractions of width and height.
fn describe_pixel(picture: &Image, reference: &Image, at: egui::Vec2) -> String {
    let pixel_index = |share: f32, count: usize| ((share * count as f32) as usize).min(count - 1);
    let (x, y) = (
        pixel_index(at.x, picture.width),
        pixel_index(at.y, picture.height),
    );
    let [a, b] = [picture, reference].map(|image| image.pixels[y * image.width + x]);
    let difference = [0, 1, 2].map(|c| i32::from(a[c]) - i32::from(b[c]));
    format!(
        "pixel {x}, {y}\nthis {} {} {}\nreference {} {} {}\ndifference {:+} {:+} {:+}",
        a[0], a[1], a[2], b[0], b[1], b[2], difference[0], difference[1], difference[2]
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_show_what_they_say() {
        let one = |pixel: [u8; 4]| Image {
            width: 1,
            height: 1,
            pixels: vec![pixel],
        };
        let (a, b) = (one([10, 200, 30, 255]), one([12, 100, 30, 255]));
        let shown = |mode| compose(&a, &b, mode).pixels[0];
        assert_eq!(shown(ComparisonMode::Picture), [10, 200, 30, 255]);
        assert_eq!(shown(ComparisonMode::Reference), [12, 100, 30, 255]);
        assert_eq!(shown(ComparisonMode::Absolute(1)), [2, 100, 0, 255]);
        assert_eq!(shown(ComparisonMode::Absolute(8)), [16, 255, 0, 255]);
        assert_eq!(shown(ComparisonMode::Signed(8)), [112, 255, 128, 255]);
        assert!(describe_pixel(&a, &b, egui::vec2(0.9, 0.9)).ends_with("difference -2 +100 +0"));
    }
}
