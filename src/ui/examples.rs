//! The menu of example scenes, each with a thumbnail.

use egui::{Button, Context, Image, TextureHandle, TextureOptions, Ui, load::SizedTexture, vec2};

use super::commands::{Command, Next};
use super::hint::Hinted as _;
use super::requests::UiRequests;
use super::upload::to_color_image;
use crate::scene::EXAMPLES;
use crate::worker::ThumbnailJob;

/// Thumbnail name of the first example; the others follow. Thumbnails of keys are named by their small indices.
const FIRST_THUMBNAIL: u64 = 1 << 48;
/// Size of the thumbnails, in points.
const SIZE: [u32; 2] = [96, 64];

/// The thumbnails of the examples.
#[derive(Default)]
pub struct Examples {
    pictures: [Option<TextureHandle>; EXAMPLES.len()],
    was_opened: bool,
    is_requested: bool,
}

impl Examples {
    /// Takes the finished thumbnails of examples out of `pictures`, which may contain others.
    pub fn take(&mut self, ctx: &Context, pictures: &mut Vec<(u64, crate::image::Image)>) {
        pictures.retain(|(name, image)| {
            let index = name
                .checked_sub(FIRST_THUMBNAIL)
                .map(|index| index as usize);
            let Some(picture) = index.and_then(|index| self.pictures.get_mut(index)) else {
                return true;
            };
            *picture =
                Some(ctx.load_texture("example", to_color_image(image), TextureOptions::LINEAR));
            false
        });
    }

    /// Returns the thumbnails to be traced, once the menu has been opened.
    pub fn thumbnail_jobs(&mut self, scale: f32) -> Vec<ThumbnailJob> {
        if !self.was_opened || std::mem::replace(&mut self.is_requested, true) {
            return Vec::new();
        }
        let size = SIZE.map(|side| (side as f32 * scale).round() as u32);
        let jobs = EXAMPLES.iter().zip(FIRST_THUMBNAIL..);
        let jobs = jobs.map(|(example, name)| ThumbnailJob {
            name,
            scene: example.document().scene.into(),
            size: (size[0], size[1]),
        });
        jobs.collect()
    }

    /// Shows the entries of the menu.
    pub fn menu(&mut self, ui: &mut Ui, out: &mut UiRequests) {
        self.was_opened = true;
        let size = vec2(SIZE[0] as f32, SIZE[1] as f32);
        for (index, (example, picture)) in EXAMPLES.iter().zip(&self.pictures).enumerate() {
            let (name, words) = (example.name, example.words());
            let button = match picture {
                Some(picture) => {
                    let picture = SizedTexture::new(picture.id(), size);
                    Button::image_and_text(Image::from_texture(picture), name)
                }
                None => Button::new(name),
            };
            let entry = ui.add(button.min_size(vec2(2.0 * size.x, size.y)));
            if entry.accessible_name(name).hint(words).clicked() {
                out.commands.push(Command::Leave(Next::Example(index)));
                ui.close();
            }
        }
    }
}
