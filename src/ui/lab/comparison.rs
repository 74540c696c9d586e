//! The picture of a selected dot, its reference, or the difference of the two, shown instead of the live view.

use egui::{Context, Response, Sense, TextureHandle, TextureOptions, Ui};

use super::super::upload::{paint, to_color_image};
use super::super::viewport::Place;
use crate::image::Image;

/// What is shown of a dot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Face {
    /// Its picture.
    Picture,
    /// The reference picture.
    Reference,
    /// The absolute difference of each channel, multiplied by this.
    Off(u32),
    /// The signed difference around middle grey, multiplied by this.
    Signed(u32),
}

/// The faces on offer, each with its label and hint.
pub const FACES: [(Face, &str, &str); 7] = [
    (Face::Picture, "This", "The picture of the dot"),
    (
        Face::Reference,
        "Reference",
        "What the picture should be; hold B to see it for a moment",
    ),
    (Face::Off(1), "Difference ×1", "How far each channel is off"),
    (
        Face::Off(8),
        "×8",
        "How far each channel is off, magnified 8 times",
    ),
    (
        Face::Off(64),
        "×64",
        "How far each channel is off, magnified 64 times",
    ),
    (
        Face::Signed(8),
        "Signed ×8",
        "Above grey is too bright, below too dark; magnified 8 times",
    ),
    (
        Face::Signed(64),
        "Signed ×64",
        "Above grey is too bright, below too dark; magnified 64 times",
    ),
];

/// Computes the picture of a face.
pub fn compose(picture: &Image, reference: &Image, face: Face) -> Image {
    let channel = |a: u8, b: u8| {
        let off = i64::from(a) - i64::from(b);
        let shown = match face {
            Face::Picture => i64::from(a),
            Face::Reference => i64::from(b),
            Face::Off(gain) => off.abs() * i64::from(gain),
            Face::Signed(gain) => 128 + off * i64::from(gain),
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

/// The texture of the face on screen.
#[derive(Default)]
pub struct Comparison {
    texture: Option<TextureHandle>,
    /// The dot, the face and the study that the texture shows.
    shown: Option<(usize, Face, u64)>,
}

impl Comparison {
    /// Draws a face in the rectangle of the live view. A tooltip shows the pixel under the pointer.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        place: Place,
        (dot, face, study): (usize, Face, u64),
        (picture, reference): (&Image, &Image),
    ) -> Response {
        self.upload(ui.ctx(), (dot, face, study), picture, reference);
        let response = ui.allocate_rect(place.rect, Sense::click_and_drag());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "Lab picture"));
        if let Some(texture) = &self.texture {
            paint(ui.painter(), texture, place.rect);
        }
        if let Some(pointer) = response.hover_pos() {
            let text = pixel(
                picture,
                reference,
                (pointer - place.rect.min) / place.rect.size(),
            );
            return response.on_hover_text_at_pointer(text);
        }
        response
    }

    fn upload(
        &mut self,
        ctx: &Context,
        key: (usize, Face, u64),
        picture: &Image,
        reference: &Image,
    ) {
        if self.shown == Some(key) {
            return;
        }
        let image = to_color_image(&compose(picture, reference, key.1));
        match &mut self.texture {
            Some(texture) => texture.set(image, TextureOptions::NEAREST),
            None => {
                self.texture =
                    Some(ctx.load_texture("lab picture", image, TextureOptions::NEAREST));
            }
        }
        self.shown = Some(key);
    }
}

/// Describes a pixel and its reference; `at` is the position as fractions of width and height.
fn pixel(picture: &Image, reference: &Image, at: egui::Vec2) -> String {
    let place = |share: f32, count: usize| ((share * count as f32) as usize).min(count - 1);
    let (x, y) = (place(at.x, picture.width), place(at.y, picture.height));
    let [a, b] = [picture, reference].map(|image| image.pixels[y * image.width + x]);
    let off = [0, 1, 2].map(|c| i32::from(a[c]) - i32::from(b[c]));
    format!(
        "pixel {x}, {y}\nthis {} {} {}\nreference {} {} {}\ndifference {:+} {:+} {:+}",
        a[0], a[1], a[2], b[0], b[1], b[2], off[0], off[1], off[2]
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
        let shown = |face| compose(&a, &b, face).pixels[0];
        assert_eq!(shown(Face::Picture), [10, 200, 30, 255]);
        assert_eq!(shown(Face::Reference), [12, 100, 30, 255]);
        assert_eq!(shown(Face::Off(1)), [2, 100, 0, 255]);
        assert_eq!(shown(Face::Off(8)), [16, 255, 0, 255]);
        assert_eq!(shown(Face::Signed(8)), [112, 255, 128, 255]);
        assert!(pixel(&a, &b, egui::vec2(0.9, 0.9)).ends_with("difference -2 +100 +0"));
    }
}
