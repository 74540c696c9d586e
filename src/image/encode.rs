//! Pictures as files: PNG, binary PPM and EXR.

use std::io::{self, Seek, Write};
use std::path::Path;

use image::codecs::openexr::OpenExrEncoder;
use image::{ExtendedColorType, ImageEncoder as _, ImageError};
use serde::{Deserialize, Serialize};

use super::buffer::{Image, LinearImage};

/// A file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Format {
    /// Portable Network Graphics, lossless and compressed.
    Png,
    /// Binary portable pixmap (P6), lossless and plain.
    Ppm,
    /// EXR: linear light in single precision, lossless and compressed.
    Exr,
}

/// A file name that says no known format.
#[derive(Debug, thiserror::Error, PartialEq, Eq)]
#[error("{name:?} ends in no known picture format; end it in .png, .ppm or .exr")]
pub struct FormatError {
    name: String,
}

impl Format {
    /// Every format.
    pub const ALL: [Self; 3] = [Self::Ppm, Self::Png, Self::Exr];

    /// The ending of such files.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Ppm => "ppm",
            Self::Exr => "exr",
        }
    }

    /// The format with this ending, in lower case.
    pub fn of_ending(ending: &str) -> Option<Self> {
        Self::ALL
            .into_iter()
            .find(|format| format.ending() == ending)
    }

    /// The format that a file's ending asks for, in any case.
    ///
    /// # Errors
    /// [`FormatError`] for any ending but `.png`, `.ppm` and `.exr`.
    pub fn of_path(path: &Path) -> Result<Self, FormatError> {
        let ending = path
            .extension()
            .map(|e| e.to_string_lossy().to_ascii_lowercase());
        ending
            .as_deref()
            .and_then(Self::of_ending)
            .ok_or_else(|| FormatError {
                name: path.display().to_string(),
            })
    }
}

impl LinearImage {
    /// The bytes of an EXR file.
    ///
    /// # Errors
    /// What the encoder says, or the system.
    pub fn encode(&self, file: &mut (impl Write + Seek)) -> Result<(), ImageError> {
        // As they are: a large picture is gigabytes.
        let bytes = bytemuck::cast_slice(&self.pixels);
        let (width, height) = (short(self.width), short(self.height));
        OpenExrEncoder::new(file).write_image(bytes, width, height, ExtendedColorType::Rgb32F)
    }
}

/// Sides are far below what is cut off here.
fn short(side: usize) -> u32 {
    u32::try_from(side).unwrap_or(u32::MAX)
}

impl Image {
    /// Writes it as a file in this format, without alpha, row by row.
    ///
    /// # Errors
    /// What the encoder says, or the system.
    pub fn encode(&self, format: Format, file: &mut (impl Write + Seek)) -> Result<(), ImageError> {
        match format {
            Format::Png => self.write_png(file).map_err(io::Error::from)?,
            Format::Ppm => {
                write!(file, "P6\n{} {} 255\n", self.width, self.height)?;
                self.write_rows(file)?;
            }
            Format::Exr => self.to_linear().encode(file)?,
        }
        Ok(())
    }

    /// Fast rather than small, as pictures are written while the next one is traced.
    fn write_png(&self, file: &mut impl Write) -> Result<(), png::EncodingError> {
        let mut encoder = png::Encoder::new(file, short(self.width), short(self.height));
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::Fast);
        encoder.set_filter(png::Filter::Adaptive);
        let mut writer = encoder.write_header()?;
        let mut rows = writer.stream_writer()?;
        self.write_rows(&mut rows)?;
        rows.finish()?;
        writer.finish()
    }

    fn write_rows(&self, file: &mut impl Write) -> io::Result<()> {
        let mut row = Vec::with_capacity(self.width * 3);
        for pixels in self.pixels.chunks(self.width.max(1)) {
            row.clear();
            row.extend(pixels.iter().flat_map(|&[r, g, b, _]| [r, g, b]));
            file.write_all(&row)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    #[test]
    fn files_read_back_as_the_picture() {
        let mut image = Image::new(7, 3);
        image.pixels.fill([0, 0, 0, 255]);
        image.pixels[4] = [1, 2, 250, 255];
        for format in Format::ALL {
            let mut bytes = Cursor::new(Vec::new());
            image.encode(format, &mut bytes).expect("encodes");
            let back = image::load_from_memory(bytes.get_ref())
                .expect("decodes")
                .to_rgba8();
            assert_eq!(back.into_raw(), image.pixels.concat());
        }
    }

    #[test]
    fn endings_name_the_format() {
        assert_eq!(Format::of_path(Path::new("a/b.PNG")), Ok(Format::Png));
        assert_eq!(Format::of_path(Path::new("b.ppm")), Ok(Format::Ppm));
        let refused = Format::of_path(Path::new("b.jpg")).expect_err("not a known format");
        assert_eq!(
            refused.to_string(),
            r#""b.jpg" ends in no known picture format; end it in .png, .ppm or .exr"#
        );
    }
}
