//! Pictures as files: PNG, binary PPM and EXR.

use std::ffi::OsStr;
use std::io::{self, Seek, Write};
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use exr::image::write::WritableImage as _;
use exr::image::{Encoding, Image as ExrImage, SpecificChannels};
use exr::math::Vec2;
use image::ImageError;
use serde::{Deserialize, Serialize};

use super::buffer::{Image, LinearImage, LinearRgb};
use super::rows::{Rows, unwanted};

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

/// A file name whose extension is not that of a known format.
#[derive(Debug, thiserror::Error, PartialEq, Eq)]
#[error("{name:?} does not end in a known picture format; use .png, .ppm or .exr")]
pub struct FormatError {
    name: String,
}

impl Format {
    /// Every format.
    pub const ALL: [Self; 3] = [Self::Ppm, Self::Png, Self::Exr];

    /// The extension of such files.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Ppm => "ppm",
            Self::Exr => "exr",
        }
    }

    /// The format with this extension, in upper or lower case.
    pub fn of_ending(ending: &str) -> Option<Self> {
        let has_ending = |format: &Self| ending.eq_ignore_ascii_case(format.ending());
        Self::ALL.into_iter().find(has_ending)
    }

    /// The format for a file's extension.
    ///
    /// # Errors
    /// [`FormatError`] for any extension but `.png`, `.ppm` and `.exr`.
    pub fn of_path(path: &Path) -> Result<Self, FormatError> {
        let ending = path.extension().and_then(OsStr::to_str);
        ending.and_then(Self::of_ending).ok_or_else(|| FormatError {
            name: path.display().to_string(),
        })
    }
}

/// Writes linear light as an EXR file.
///
/// # Errors
/// Errors of the encoder or of the system; [`io::ErrorKind::Interrupted`] if the picture is no longer wanted.
pub fn write_light(
    rows: &mut (impl Rows<LinearRgb> + Send),
    file: &mut (impl Write + Seek),
) -> Result<(), ImageError> {
    let size = rows.size();
    // The encoder asks for pixels from one thread only, but does not promise it.
    let rows = Mutex::new((rows, true));
    let pixel = |Vec2(column, row): Vec2<usize>| {
        let (rows, is_wanted) = &mut *rows.lock().unwrap_or_else(PoisonError::into_inner);
        let pixels = if *is_wanted { rows.row(row) } else { None };
        *is_wanted = pixels.is_some();
        let [red, green, blue] = pixels.map_or([0.0; 3], |pixels| pixels[column]);
        (red, green, blue)
    };
    let channels = SpecificChannels::rgb(pixel);
    // Run-length encoding, the default, finds next to nothing in gradients.
    let image = ExrImage::from_encoded_channels(size, Encoding::SMALL_LOSSLESS, channels);
    let written = image.write().to_buffered(file);
    drop(image);
    let (_, is_wanted) = rows.into_inner().unwrap_or_else(PoisonError::into_inner);
    match written {
        _ if !is_wanted => Err(unwanted().into()),
        Ok(()) => Ok(()),
        Err(exr::error::Error::Io(error)) => Err(error.into()),
        Err(error) => Err(io::Error::other(error).into()),
    }
}

/// Writes 8-bit levels as a PNG or PPM file, without alpha.
///
/// # Errors
/// Errors of the encoder or of the system; an error for EXR, which holds linear light; [`io::ErrorKind::Interrupted`]
/// if the picture is no longer wanted.
pub fn write_levels(
    rows: &mut impl Rows<[u8; 4]>,
    format: Format,
    file: &mut impl Write,
) -> Result<(), ImageError> {
    match format {
        Format::Png => write_png(rows, file).map_err(|error| match error {
            png::EncodingError::IoError(error) => error,
            other => io::Error::other(other),
        })?,
        Format::Ppm => {
            let (width, height) = rows.size();
            write!(file, "P6\n{width} {height} 255\n")?;
            write_rows(rows, file)?;
        }
        Format::Exr => return Err(io::Error::other("EXR files hold light").into()),
    }
    Ok(())
}

/// Favours speed over size, as pictures are written while the next one is traced.
fn write_png(
    rows: &mut impl Rows<[u8; 4]>,
    file: &mut impl Write,
) -> Result<(), png::EncodingError> {
    let (width, height) = rows.size();
    let mut encoder = png::Encoder::new(file, to_u32(width), to_u32(height));
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Fast);
    encoder.set_filter(png::Filter::Adaptive);
    let mut writer = encoder.write_header()?;
    let mut stream = writer.stream_writer()?;
    write_rows(rows, &mut stream)?;
    stream.finish()?;
    writer.finish()
}

fn write_rows(rows: &mut impl Rows<[u8; 4]>, file: &mut impl Write) -> io::Result<()> {
    let (width, height) = rows.size();
    let mut bytes = Vec::with_capacity(width * 3);
    for row in 0..height {
        let pixels = rows.row(row).ok_or_else(unwanted)?;
        bytes.clear();
        bytes.extend(pixels.iter().flat_map(|&[r, g, b, _]| [r, g, b]));
        file.write_all(&bytes)?;
    }
    Ok(())
}

/// Converts a side to 32 bits; none comes close to the limit.
fn to_u32(side: usize) -> u32 {
    u32::try_from(side).unwrap_or(u32::MAX)
}

impl LinearImage {
    /// Writes the picture as an EXR file.
    ///
    /// # Errors
    /// Errors of the encoder or of the system.
    pub fn encode(&self, file: &mut (impl Write + Seek)) -> Result<(), ImageError> {
        write_light(&mut &*self, file)
    }
}

impl Image {
    /// Writes the picture in this format, without alpha, row by row.
    ///
    /// # Errors
    /// Errors of the encoder or of the system.
    pub fn encode(&self, format: Format, file: &mut (impl Write + Seek)) -> Result<(), ImageError> {
        match format {
            Format::Png | Format::Ppm => write_levels(&mut &*self, format, file),
            Format::Exr => self.to_linear().encode(file),
        }
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
            r#""b.jpg" does not end in a known picture format; use .png, .ppm or .exr"#
        );
    }
}
