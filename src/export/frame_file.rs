//! Reading frames to make a video of them.

use std::fs;
use std::io::Cursor;
use std::path::Path;

use image::{DynamicImage, ImageError, ImageReader, ImageResult, RgbaImage};
use rayon::iter::{IntoParallelIterator as _, ParallelIterator as _};

use super::error::VideoError;
use super::sequence::Sequence;
use crate::image::{Format, Image, LinearImage};
use crate::trace::Threads;

/// Prepares frames of a sequence on the threads of the current rayon pool, and passes them to `hand_on` in order.
/// Each comes with the number of frames done by then, which is passed to `go_on`; that returns whether to continue.
///
/// # Errors
/// The first one that occurs, after the frames before it were handed on; [`VideoError::Stopped`].
pub fn prepare_in_order<F: Send, P: Send>(
    sequence: &Sequence,
    (mut frames, go_on): (
        impl Iterator<Item = (usize, F)>,
        &mut impl FnMut(usize) -> bool,
    ),
    prepare: impl Fn(F) -> Result<P, VideoError> + Sync,
    mut hand_on: impl FnMut(P) -> Result<(), VideoError>,
) -> Result<(), VideoError> {
    let at_once = sequence.at_once(Threads::current());
    loop {
        let batch: Vec<(usize, F)> = frames.by_ref().take(at_once).collect();
        if batch.is_empty() {
            return Ok(());
        }
        let prepare = |(done, frame)| (done, prepare(frame));
        let prepared: Vec<_> = batch.into_par_iter().map(prepare).collect();
        for (done, frame) in prepared {
            hand_on(frame?)?;
            if !go_on(done) {
                return Err(VideoError::Stopped);
            }
        }
    }
}

/// Returns the bytes of a frame's file.
///
/// # Errors
/// [`VideoError::Export`], [`VideoError::Replaced`].
pub fn frame_bytes(sequence: &Sequence, frame: u64) -> Result<Vec<u8>, VideoError> {
    let path = sequence.path(frame);
    let unreadable = |source| VideoError::unreadable(&path, source);
    let bytes = fs::read(&path).map_err(|error| unreadable(error.into()))?;
    let reader = ImageReader::new(Cursor::new(&bytes[..])).with_guessed_format();
    let size = reader.map_err(ImageError::from);
    let size = size
        .and_then(ImageReader::into_dimensions)
        .map_err(unreadable)?;
    check_size(sequence, &path, size)?;
    Ok(bytes)
}

/// Checks the size of a frame: another export into the folder may have replaced it.
fn check_size(sequence: &Sequence, path: &Path, size: (u32, u32)) -> Result<(), VideoError> {
    if size == sequence.size() {
        return Ok(());
    }
    Err(VideoError::Replaced {
        path: path.to_owned(),
        size,
    })
}

/// Returns a frame as PPM.
///
/// # Errors
/// [`VideoError::Export`], [`VideoError::Replaced`].
pub fn as_ppm(sequence: &Sequence, frame: u64) -> Result<Vec<u8>, VideoError> {
    let path = sequence.path(frame);
    let image = Image::from(&read_frame(sequence, frame)?);
    let mut bytes = Cursor::new(Vec::new());
    let encoded = image.encode(Format::Ppm, &mut bytes);
    encoded.map_err(|source| VideoError::unreadable(&path, source))?;
    Ok(bytes.into_inner())
}

/// Reads a frame of any format, and converts it to 8 bits.
///
/// # Errors
/// [`VideoError::Export`], [`VideoError::Replaced`].
pub fn read_frame(sequence: &Sequence, frame: u64) -> Result<RgbaImage, VideoError> {
    let path = sequence.path(frame);
    let image = decode(&path).map_err(|source| VideoError::unreadable(&path, source))?;
    check_size(sequence, &path, (image.width(), image.height()))?;
    let Some(light) = image.as_rgb32f() else {
        return Ok(image.to_rgba8());
    };
    // Rounded as by the tracer: other libraries apply other curves.
    let (width, height) = light.dimensions();
    let levels = LinearImage {
        width: width as usize,
        height: height as usize,
        pixels: light.pixels().map(|pixel| pixel.0).collect(),
    };
    let levels = levels.to_levels().pixels.concat();
    Ok(RgbaImage::from_raw(width, height, levels).unwrap_or_default())
}

/// Decodes without limits: frames may be as large as scenes allow, which is beyond a decoder's default limits for
/// untrusted files.
fn decode(path: &Path) -> ImageResult<DynamicImage> {
    let mut reader = ImageReader::open(path)?;
    reader.no_limits();
    reader.decode()
}
