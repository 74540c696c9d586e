//! GIF and APNG encoding, without ffmpeg.

use std::fs::File;
use std::io::{BufWriter, Write as _};
use std::path::Path;
use std::time::{Duration, Instant};

use gif::{DisposalMethod, Encoder, Frame, Repeat};
use image::RgbaImage;

use super::error::VideoError;
use super::frame_file::{prepare_in_order, read_frame};
use super::sequence::Sequence;
use crate::image::Image;

/// Pixels per frame that the palette of a GIF is learnt from: of larger frames, one pixel of `n` is sampled, with `n`
/// at most 10.
const GIF_PIXELS: u32 = 100_000;

/// Shortest time that a GIF shows a frame, in hundredths of a second.
const MIN_DELAY: u32 = 2;

/// Longest time that a GIF can show a frame, in seconds.
pub const MAX_GIF_DELAY: f64 = 655.35;

/// Longest time that an APNG can show a frame, in seconds.
pub const MAX_APNG_DELAY: f64 = 65_535.0;

/// Writes a GIF into `file`, which is to be moved to `path`. Reducing the frames to 256 colours takes several times
/// as long as tracing them; they are packed on the threads of the current rayon pool.
///
/// # Errors
/// [`VideoError`].
pub fn gif(
    sequence: &Sequence,
    (file, path): (&File, &Path),
    go_on: &mut impl FnMut(usize) -> bool,
) -> Result<(), VideoError> {
    let encoding_error = |error: gif::EncodingError| VideoError::disk(path, error);
    let (width, height) = sequence.size();
    let file = BufWriter::new(file);
    let mut encoder =
        Encoder::new(file, width as u16, height as u16, &[]).map_err(encoding_error)?;
    encoder
        .set_repeat(Repeat::Infinite)
        .map_err(encoding_error)?;
    let palette_step = palette_step(sequence);
    let mut start = 0;
    let ends = frame_ends(sequence.frames_per_second(), sequence.frames.count());
    let frames = sequence.frames.iter().zip(ends).enumerate();
    let shown = frames.filter_map(|(index, (frame, end))| {
        let hundredths = end - std::mem::replace(&mut start, end);
        (hundredths > 0).then_some((index + 1, (frame, hundredths)))
    });
    let pack = |(frame, hundredths)| {
        let image = read_frame(sequence, frame)?;
        Ok(gif_frame(image, palette_step, hundredths))
    };
    prepare_in_order(sequence, (shown, go_on), pack, |frame| {
        encoder
            .write_lzw_pre_encoded_frame(&frame)
            .map_err(encoding_error)
    })?;
    let mut file = encoder.into_inner().map_err(encoding_error)?;
    file.flush().map_err(|error| VideoError::disk(path, error))
}

/// Estimates how long `threads` threads take to pack the frames of a sequence, if all are like `image`.
pub fn estimate_gif_time(sequence: &Sequence, image: &Image, threads: usize) -> Duration {
    let (width, height) = sequence.size();
    // Thinned to about the size of the frames: per pixel, learning the palette takes longer for small pictures.
    let step = (image.width / width as usize).max(1);
    let small = image.decimated(step);
    let size = (small.width as u32, small.height as u32);
    let pixels = RgbaImage::from_raw(size.0, size.1, small.pixels.concat());
    let start = Instant::now();
    drop(gif_frame(
        pixels.unwrap_or_default(),
        palette_step(sequence),
        1,
    ));
    let seconds_per_pixel = start.elapsed().as_secs_f64() / f64::from(size.0 * size.1).max(1.0);
    let count = sequence.frames.count();
    let shown = count - left_out(sequence.frames_per_second(), count);
    let rounds = shown as f64 / sequence.at_once(threads) as f64;
    Duration::from_secs_f64(seconds_per_pixel * f64::from(width) * f64::from(height) * rounds)
}

/// Sampling step for the palette: one pixel of this many is looked at.
fn palette_step(sequence: &Sequence) -> i32 {
    let (width, height) = sequence.size();
    let palette_step = (width.saturating_mul(height) / GIF_PIXELS).clamp(1, 10);
    palette_step.cast_signed()
}

/// Packs a frame of a GIF that is shown for this many hundredths of a second.
fn gif_frame(image: RgbaImage, palette_step: i32, hundredths: u32) -> Frame<'static> {
    let (width, height) = image.dimensions();
    let mut pixels = image.into_raw();
    let mut frame = Frame::from_rgba_speed(width as u16, height as u16, &mut pixels, palette_step);
    frame.delay = u16::try_from(hundredths).unwrap_or(u16::MAX);
    frame.dispose = DisposalMethod::Background;
    frame.make_lzw_pre_encoded();
    frame
}

/// The number of frames, of `count`, that a GIF leaves out.
pub fn left_out(frames_per_second: f64, count: usize) -> usize {
    // Shortcut: at this rate, every frame lasts long enough. A window asks in every frame of its own, and there may
    // be a million frames here.
    if frames_per_second * f64::from(MIN_DELAY) <= 100.0 {
        return 0;
    }
    let mut start = 0;
    let ends = frame_ends(frames_per_second, count);
    let is_left_out = |end: &u32| std::mem::replace(&mut start, *end) == *end;
    ends.filter(is_left_out).count()
}

/// End times of the frames of a GIF, in hundredths of a second, the unit of its clock, rounded so that the frame rate
/// is kept on average. A frame that would be shown for less than two, which players take for ten, ends when the
/// previous one does: it is left out, except for the last one, which is shown for two.
fn frame_ends(frames_per_second: f64, count: usize) -> impl Iterator<Item = u32> {
    let mut last = 0;
    (1..=count).map(move |shown| {
        let end = (shown as f64 * 100.0 / frames_per_second).round() as u32;
        if end >= last + MIN_DELAY {
            last = end;
        } else if shown == count {
            last += MIN_DELAY;
        }
        last
    })
}

/// Returns the fraction of two `u16` nearest to a positive number: the last convergent of its continued fraction that
/// fits (Hardy and Wright, "An introduction to the theory of numbers", ch. 10).
fn nearest_fraction(number: f64) -> (u16, u16) {
    let (mut previous, mut best) = ((0.0, 1.0), (1.0, 0.0));
    let mut remainder = number;
    for _ in 0..32 {
        let whole = remainder.floor();
        let next = (whole * best.0 + previous.0, whole * best.1 + previous.1);
        if next.0.max(next.1) > f64::from(u16::MAX) {
            break;
        }
        (previous, best) = (best, next);
        // The remainder is rounding error.
        if (best.0 / best.1 - number).abs() < 1e-12 * number {
            break;
        }
        remainder = 1.0 / (remainder - whole);
    }
    (best.0 as u16, (best.1 as u16).max(1))
}

/// Writes an animated PNG into `file`, which is to be moved to `path`.
///
/// # Errors
/// [`VideoError`].
pub fn apng(
    sequence: &Sequence,
    (file, path): (&File, &Path),
    go_on: &mut impl FnMut(usize) -> bool,
) -> Result<(), VideoError> {
    let (width, height) = sequence.size();
    let encoding_error = |error: png::EncodingError| VideoError::disk(path, error);
    let mut file = BufWriter::new(file);
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Fast);
    let count = u32::try_from(sequence.frames.count()).unwrap_or(u32::MAX);
    encoder.set_animated(count, 0).map_err(encoding_error)?;
    let (numerator, denominator) = nearest_fraction(1.0 / sequence.frames_per_second());
    encoder
        .set_frame_delay(numerator, denominator)
        .map_err(encoding_error)?;
    let mut writer = encoder.write_header().map_err(encoding_error)?;
    let open = |frame| {
        let image = read_frame(sequence, frame)?;
        Ok(image::DynamicImage::from(image).to_rgb8())
    };
    let frames = sequence.frames.iter().enumerate();
    let frames = frames.map(|(index, frame)| (index + 1, frame));
    prepare_in_order(sequence, (frames, go_on), open, |image| {
        writer.write_image_data(&image).map_err(encoding_error)
    })?;
    writer.finish().map_err(encoding_error)?;
    file.flush().map_err(|error| VideoError::disk(path, error))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gif_keeps_time_and_leaves_out_what_is_too_short() {
        let rates = [
            1.0,
            14.0,
            14.0 / 3.0,
            23.976,
            24.0,
            30.0,
            50.0,
            60.0,
            120.0,
            240.0,
        ];
        for (fps, count) in rates
            .iter()
            .flat_map(|&fps| [1, 2, 3, 1000].map(|count| (fps, count)))
        {
            let ends: Vec<u32> = frame_ends(fps, count).collect();
            let exact = count as f64 * 100.0 / fps;
            let last = f64::from(*ends.last().expect("some"));
            assert!((last - exact).abs() <= 2.0, "{fps}: {last} of {exact}");
            assert!(last >= 2.0, "{fps}: {count} frames are no time");
            let mut shown = ends.clone();
            shown.dedup();
            shown.retain(|end| *end > 0);
            let longest = (100.0 / fps).ceil() as u32;
            let mut start = 0;
            for end in shown {
                assert!((2..=longest.max(3)).contains(&(end - start)), "{fps}");
                start = end;
            }
        }
        assert_eq!(
            [50.0, 100.0, 120.0].map(|fps| left_out(fps, 600)),
            [0, 300, 350]
        );
    }

    #[test]
    fn a_frame_of_an_apng_is_shown_for_a_fraction_that_is_exact_where_it_can_be() {
        for (fps, expected) in [
            (14.0, (1, 14)),
            (14.0 / 3.0, (3, 14)),
            (24_000.0 / 1001.0, (1001, 24_000)),
            (240.0, (1, 240)),
            (0.01, (100, 1)),
        ] {
            assert_eq!(nearest_fraction(1.0 / fps), expected, "{fps}");
        }
        let (numerator, denominator) = nearest_fraction(1.0 / 23.976);
        let off = f64::from(numerator) / f64::from(denominator) * 23.976 - 1.0;
        assert!(off.abs() < 1e-8, "{off}");
    }
}
