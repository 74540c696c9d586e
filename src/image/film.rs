//! The buffer that a picture is traced into before it becomes a file: as precise as the file format.

use std::io::{Seek, Write};

use image::ImageError;

use super::buffer::{Image, LinearImage};
use super::encode::Format;
use super::render::{RenderCost, render_into, render_light_into};
use super::strips::{Drawing, Strips};
use crate::plan::{Planner, RenderRequest};
use crate::scene::Scene;
use crate::trace::RenderControl;

/// A picture for a file, in 8 bits or in linear light.
#[derive(Clone, Debug, PartialEq)]
pub enum Film {
    /// For 8-bit formats.
    Levels(Image),
    /// For formats that hold linear light.
    Linear(LinearImage),
}

impl Film {
    /// An empty film for this format.
    pub fn new(format: Format) -> Self {
        match format {
            Format::Png | Format::Ppm => Self::Levels(Image::default()),
            Format::Exr => Self::Linear(LinearImage::default()),
        }
    }

    /// Traces a whole picture into the film, see [`render_into`]; `None` if `control` was stopped.
    pub fn expose(
        &mut self,
        planner: &mut Planner,
        scene: &Scene,
        request: &RenderRequest,
        control: &RenderControl,
    ) -> Option<RenderCost> {
        match self {
            Self::Levels(image) => render_into(image, planner, scene, request, control),
            Self::Linear(image) => render_light_into(image, planner, scene, request, control),
        }
    }

    /// Begins a picture that is traced strip by strip while it is written, in the memory of the film, whose contents
    /// are unspecified afterwards.
    pub fn draw<'a>(
        &'a mut self,
        planner: &mut Planner,
        picture: (&Scene, &RenderRequest),
        control: &'a RenderControl,
    ) -> Drawing<'a> {
        match self {
            Self::Levels(image) => {
                Drawing::Levels(Strips::new(&mut image.pixels, planner, picture, control))
            }
            Self::Linear(image) => {
                Drawing::Linear(Strips::new(&mut image.pixels, planner, picture, control))
            }
        }
    }

    /// Width and height in pixels.
    pub fn size(&self) -> (usize, usize) {
        match self {
            Self::Levels(image) => (image.width, image.height),
            Self::Linear(image) => (image.width, image.height),
        }
    }

    /// Every `step`-th pixel of every `step`-th row, in 8 bits.
    pub fn decimated(&self, step: usize) -> Image {
        match self {
            Self::Levels(image) => image.decimated(step),
            Self::Linear(image) => image.decimated(step).to_levels(),
        }
    }

    /// Converts the film into the picture in 8 bits, as a screen shows it.
    pub fn into_levels(self) -> Image {
        match self {
            Self::Levels(image) => image,
            Self::Linear(image) => image.to_levels(),
        }
    }

    /// Writes the picture as a file in this format.
    ///
    /// # Errors
    /// Errors of the encoder or of the system.
    pub fn encode(&self, format: Format, file: &mut (impl Write + Seek)) -> Result<(), ImageError> {
        match (self, format) {
            (Self::Levels(image), _) => image.encode(format, file),
            (Self::Linear(image), Format::Exr) => image.encode(file),
            (Self::Linear(image), _) => image.to_levels().encode(format, file),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    #[test]
    fn a_film_of_light_holds_more_than_eight_bits_and_shows_the_same() {
        let scene = Scene::demo();
        let request = RenderRequest::sized(40, 30);
        let films = [Format::Png, Format::Exr].map(|format| {
            let mut film = Film::new(format);
            let control = RenderControl::default();
            film.expose(&mut Planner::default(), &scene, &request, &control)
                .expect("nobody stops it");
            film
        });
        let [levels, rounded] = films.clone().map(Film::into_levels);
        assert_eq!(levels, rounded);
        let Film::Linear(light) = &films[1] else {
            panic!("EXR holds light");
        };
        let is_between = |channel: &&f32| (**channel * 255.0).fract() != 0.0;
        let between = light.pixels.iter().flatten().filter(is_between).count();
        assert!(between > 100, "{between}");
        let mut bytes = Cursor::new(Vec::new());
        films[1].encode(Format::Exr, &mut bytes).expect("encodes");
        let back = image::load_from_memory(bytes.get_ref()).expect("decodes");
        assert_eq!(back.to_rgb32f().into_raw(), light.pixels.concat());
    }
}
