//! Frames that are read to become a video.

use std::io::Cursor;
use std::path::Path;

use image::{DynamicImage, ImageReader, ImageResult, RgbaImage};

use super::error::VideoError;
use crate::image::{Format, Image, LinearImage};

/// A frame as PPM.
///
/// # Errors
/// [`VideoError::Frame`].
pub fn as_ppm(path: &Path) -> Result<Vec<u8>, VideoError> {
    let frame = read(path)?;
    let image = Image {
        width: frame.width() as usize,
        height: frame.height() as usize,
        pixels: frame.pixels().map(|pixel| pixel.0).collect(),
    };
    let mut bytes = Cursor::new(Vec::new());
    let encoded = image.encode(Format::Ppm, &mut bytes);
    encoded.map_err(|source| VideoError::unreadable(path, source))?;
    Ok(bytes.into_inner())
}

/// A frame of 8 bits, of whatever format.
///
/// # Errors
/// [`VideoError::Frame`].
pub fn read(path: &Path) -> Result<RgbaImage, VideoError> {
    let image = decode(path).map_err(|source| VideoError::unreadable(path, source))?;
    let Some(light) = image.as_rgb32f() else {
        return Ok(image.to_rgba8());
    };
    // As the tracer rounds: other libraries know of other curves.
    let (width, height) = light.dimensions();
    let levels = LinearImage {
        width: width as usize,
        height: height as usize,
        pixels: light.pixels().map(|pixel| pixel.0).collect(),
    };
    let levels = levels.to_levels().pixels.concat();
    Ok(RgbaImage::from_raw(width, height, levels).unwrap_or_default())
}

/// Frames may be as large as scenes allow, which is more than a decoder expects of strangers.
fn decode(path: &Path) -> ImageResult<DynamicImage> {
    let mut reader = ImageReader::open(path)?;
    reader.no_limits();
    reader.decode()
}
