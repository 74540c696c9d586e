//! One file that moves, made of frames that are there: by ffmpeg, or as GIF or APNG without it.

use std::borrow::Cow;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use image::codecs::gif::{GifEncoder, Repeat};
use image::{Delay, Frame, RgbaImage};

use super::error::last_lines;
use super::sequence::Sequence;
use crate::files::{NewFile, remove_leftovers};
use crate::image::{Format, Image, LinearImage};

/// Pixels of a frame that the colours of a GIF are learnt from: of so many more, one of so many is looked at, but of
/// no more than ten.
const GIF_PIXELS: u32 = 100_000;

/// How a video is encoded; its ending says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Video {
    /// H.264 in MP4, by ffmpeg, with the settings of the original program.
    H264,
    /// `ProRes` 4444 in MOV, by ffmpeg.
    ProRes,
    /// Lossless FFV1 in Matroska, by ffmpeg.
    Lossless,
    /// Animated GIF, 256 colours in each frame.
    Gif,
    /// Animated PNG, lossless.
    Apng,
}

/// Why there is no video.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum VideoError {
    /// The ending says no known kind.
    #[error("{0:?} ends in no known video format; end it in .mp4, .mov, .mkv, .gif or .apng")]
    Unknown(String),
    /// There is no ffmpeg.
    #[error(
        "ffmpeg is not installed, or not on the PATH; the frames are there, and this makes the video of them:\n{command}\n.gif and .apng need no ffmpeg"
    )]
    NoFfmpeg {
        /// What to type.
        command: String,
    },
    /// It ended with an error.
    #[error("ffmpeg failed:\n{said}")]
    Ffmpeg {
        /// The end of what it said.
        said: String,
    },
    /// A frame could not be read.
    #[error("cannot read {path}: {source}", path = .path.display())]
    Frame {
        /// The frame's file.
        path: PathBuf,
        /// What the decoder said.
        source: image::ImageError,
    },
    /// The video could not be written.
    #[error("cannot write {path}: {why}", path = .path.display())]
    Disk {
        /// The video's file.
        path: PathBuf,
        /// What the system or the encoder answered.
        why: String,
    },
}

impl Video {
    /// The kind that a file's ending asks for.
    ///
    /// # Errors
    /// [`VideoError::Unknown`].
    pub fn of_path(path: &Path) -> Result<Self, VideoError> {
        let ending = path
            .extension()
            .map(|e| e.to_string_lossy().to_ascii_lowercase());
        match ending.as_deref() {
            Some("mp4") => Ok(Self::H264),
            Some("mov") => Ok(Self::ProRes),
            Some("mkv") => Ok(Self::Lossless),
            Some("gif") => Ok(Self::Gif),
            Some("apng") => Ok(Self::Apng),
            _ => Err(VideoError::Unknown(path.display().to_string())),
        }
    }

    /// What ffmpeg is told about the codec.
    fn codec(self) -> &'static [&'static str] {
        match self {
            // Both sides even, as the codec needs them.
            Self::H264 => &[
                "-c:v",
                "libx264",
                "-crf",
                "25",
                "-vf",
                "scale=trunc(iw/2)*2:trunc(ih/2)*2,format=yuv420p",
                "-movflags",
                "+faststart",
            ],
            Self::ProRes => &[
                "-c:v",
                "prores_ks",
                "-profile:v",
                "4444",
                "-pix_fmt",
                "yuv444p10le",
            ],
            Self::Lossless | Self::Gif | Self::Apng => {
                &["-c:v", "ffv1", "-level", "3", "-pix_fmt", "bgr0"]
            }
        }
    }

    /// Makes a video of the frames of a sequence, all of which must be there, and puts it in place
    /// when it is whole. `done` is told how many frames are in it.
    ///
    /// # Errors
    /// [`VideoError`]; a file that was there is then untouched.
    pub fn make(
        self,
        sequence: &Sequence,
        path: &Path,
        mut done: impl FnMut(usize),
    ) -> Result<(), VideoError> {
        let beside = NewFile::beside(path).map_err(|error| disk(path, &error))?;
        match self {
            Self::Gif => gif(sequence, (beside.as_file(), path), &mut done)?,
            Self::Apng => apng(sequence, (beside.as_file(), path), &mut done)?,
            Self::H264 | Self::ProRes | Self::Lossless => {
                self.by_ffmpeg(sequence, path, beside.path(), &mut done)?;
            }
        }
        beside.place().map_err(|error| disk(path, &error))
    }

    /// Whether there could be a video at this path: asked before its frames are made.
    ///
    /// # Errors
    /// [`VideoError::Disk`].
    pub fn check_place(path: &Path) -> Result<(), VideoError> {
        let beside = NewFile::beside(path).map_err(|error| disk(path, &error))?;
        if let Some(folder) = beside.path().parent() {
            remove_leftovers(folder);
        }
        Ok(())
    }

    fn by_ffmpeg(
        self,
        sequence: &Sequence,
        path: &Path,
        unfinished_path: &Path,
        done: &mut impl FnMut(usize),
    ) -> Result<(), VideoError> {
        let fps = sequence.frames_per_second().to_string();
        let codec = match sequence.format {
            Format::Png => "png",
            Format::Ppm | Format::Exr => "ppm",
        };
        let mut command = Command::new("ffmpeg");
        command
            .args([
                "-hide_banner",
                "-loglevel",
                "error",
                "-y",
                "-f",
                "image2pipe",
            ])
            .args(["-c:v", codec, "-framerate", &fps, "-i", "-"])
            .args(self.codec())
            .arg(unfinished_path)
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::piped());
        let mut ffmpeg = match command.spawn() {
            Ok(ffmpeg) => ffmpeg,
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                let command = self.command(sequence, path);
                return Err(VideoError::NoFfmpeg { command });
            }
            Err(error) => return Err(disk(path, &error)),
        };
        if let Some(mut pipe) = ffmpeg.stdin.take() {
            for (index, frame) in sequence.frames.iter().enumerate() {
                let file = sequence.path(frame);
                let bytes = match sequence.format {
                    // No pipe tells where one of these ends.
                    Format::Exr => as_ppm(&file)?,
                    Format::Png | Format::Ppm => {
                        fs::read(&file).map_err(|error| unreadable(&file, error.into()))?
                    }
                };
                // It hangs up when it fails; why, it says below.
                if pipe.write_all(&bytes).is_err() {
                    break;
                }
                done(index + 1);
            }
        }
        let output = ffmpeg
            .wait_with_output()
            .map_err(|error| disk(path, &error))?;
        if output.status.success() {
            return Ok(());
        }
        let mut said = last_lines(&output.stderr);
        if output.status.code().is_none() {
            said = format!("it was killed ({})\n{said}", output.status);
        }
        Err(VideoError::Ffmpeg { said })
    }

    /// What one would type to make the video by hand.
    pub fn command(self, sequence: &Sequence, path: &Path) -> String {
        let fps = sequence.frames_per_second();
        let codec: Vec<String> = self.codec().iter().map(|word| quoted(word)).collect();
        let (codec, output) = (codec.join(" "), quoted(&path.display().to_string()));
        let first = sequence.frames.iter().next().unwrap_or(1);
        if sequence
            .frames
            .iter()
            .eq(first..first + sequence.frames.count() as u64)
        {
            let names = format!("{}.{}", sequence.pattern.text(), sequence.format.ending());
            let input = quoted(&sequence.folder.join(names).display().to_string());
            return format!(
                "ffmpeg -framerate {fps} -start_number {first} -i {input} {codec} {output}"
            );
        }
        let files = sequence.frames.iter();
        let files = files.map(|frame| quoted(&sequence.path(frame).display().to_string()));
        let files = files.collect::<Vec<String>>().join(" ");
        format!("cat {files} | ffmpeg -f image2pipe -framerate {fps} -i - {codec} {output}")
    }
}

/// As a shell needs it. No path has a zero byte in it, which is all that cannot be quoted.
fn quoted(word: &str) -> String {
    shlex::try_quote(word).map_or_else(|_| word.to_owned(), Cow::into_owned)
}

fn disk(path: &Path, why: &dyn std::error::Error) -> VideoError {
    VideoError::Disk {
        path: path.to_owned(),
        why: why.to_string(),
    }
}

fn unreadable(path: &Path, source: image::ImageError) -> VideoError {
    VideoError::Frame {
        path: path.to_owned(),
        source,
    }
}

fn as_ppm(path: &Path) -> Result<Vec<u8>, VideoError> {
    let frame = read(path)?;
    let image = Image {
        width: frame.width() as usize,
        height: frame.height() as usize,
        pixels: frame.pixels().map(|pixel| pixel.0).collect(),
    };
    let mut bytes = Vec::new();
    let encoded = image.encode(Format::Ppm, &mut bytes);
    encoded.map_err(|source| unreadable(path, source))?;
    Ok(bytes)
}

fn read(path: &Path) -> Result<RgbaImage, VideoError> {
    let image = image::open(path).map_err(|source| unreadable(path, source))?;
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

/// Writes a GIF into a file that is to be that of this path.
fn gif(
    sequence: &Sequence,
    (file, path): (&File, &Path),
    done: &mut impl FnMut(usize),
) -> Result<(), VideoError> {
    let mut file = BufWriter::new(file);
    let (width, height) = sequence.size();
    let speed = (width.saturating_mul(height) / GIF_PIXELS).clamp(1, 10);
    let mut encoder = GifEncoder::new_with_speed(&mut file, speed.cast_signed());
    let wrong = |error: image::ImageError| disk(path, &error);
    encoder.set_repeat(Repeat::Infinite).map_err(wrong)?;
    let ends = clock_ends(sequence.frames_per_second(), sequence.frames.count());
    let mut start = 0;
    for ((index, frame), end) in sequence.frames.iter().enumerate().zip(ends) {
        if end > start {
            let image = read(&sequence.path(frame))?;
            let delay = Delay::from_numer_denom_ms((end - start) * 10, 1);
            let frame = Frame::from_parts(image, 0, 0, delay);
            encoder.encode_frame(frame).map_err(wrong)?;
            start = end;
        }
        done(index + 1);
    }
    // It writes its end when it is dropped, and cannot tell then that the disk is full.
    drop(encoder);
    file.flush().map_err(|error| disk(path, &error))
}

/// When the frames of a GIF end, in hundredths of a second, its clock: as many pass in a second as shall. Where
/// a frame would be shown for less than two, which players take for ten, it ends when the one before does: it
/// is left out.
fn clock_ends(frames_per_second: f64, count: usize) -> impl Iterator<Item = u32> {
    let mut last = 0;
    (1..=count).map(move |shown| {
        let end = (shown as f64 * 100.0 / frames_per_second).round() as u32;
        if end >= last + 2 {
            last = end;
        }
        last
    })
}

/// The fraction of two short whole numbers that is nearest to a number above 0: the last convergent of its
/// continued fraction that they can hold (Hardy and Wright, "An introduction to the theory of numbers", ch. 10).
fn nearest_fraction(number: f64) -> (u16, u16) {
    let (mut before, mut best) = ((0.0, 1.0), (1.0, 0.0));
    let mut rest = number;
    for _ in 0..32 {
        let whole = rest.floor();
        let next = (whole * best.0 + before.0, whole * best.1 + before.1);
        if next.0.max(next.1) > f64::from(u16::MAX) {
            break;
        }
        (before, best) = (best, next);
        // What is left is rounding.
        if (best.0 / best.1 - number).abs() < 1e-12 * number {
            break;
        }
        rest = 1.0 / (rest - whole);
    }
    (best.0 as u16, (best.1 as u16).max(1))
}

/// Writes an animated PNG into a file that is to be that of this path.
fn apng(
    sequence: &Sequence,
    (file, path): (&File, &Path),
    done: &mut impl FnMut(usize),
) -> Result<(), VideoError> {
    let (width, height) = sequence.size();
    let wrong = |error: png::EncodingError| disk(path, &error);
    let mut file = BufWriter::new(file);
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Fast);
    let count = u32::try_from(sequence.frames.count()).unwrap_or(u32::MAX);
    encoder.set_animated(count, 0).map_err(wrong)?;
    let (part, whole) = nearest_fraction(1.0 / sequence.frames_per_second());
    encoder.set_frame_delay(part, whole).map_err(wrong)?;
    let mut writer = encoder.write_header().map_err(wrong)?;
    for (index, frame) in sequence.frames.iter().enumerate() {
        let image = image::DynamicImage::from(read(&sequence.path(frame))?).to_rgb8();
        writer.write_image_data(&image).map_err(wrong)?;
        done(index + 1);
    }
    writer.finish().map_err(wrong)?;
    file.flush().map_err(|error| disk(path, &error))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gif_keeps_time_and_leaves_out_what_is_too_short() {
        for fps in [1.0, 14.0, 14.0 / 3.0, 23.976, 24.0, 30.0, 50.0, 60.0, 120.0] {
            let ends: Vec<u32> = clock_ends(fps, 1000).collect();
            let exact = 1000.0 * 100.0 / fps;
            let last = f64::from(*ends.last().expect("a thousand"));
            assert!((last - exact).abs() <= 2.0, "{fps}: {last} of {exact}");
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
        let (part, whole) = nearest_fraction(1.0 / 23.976);
        let off = f64::from(part) / f64::from(whole) * 23.976 - 1.0;
        assert!(off.abs() < 1e-8, "{off}");
    }

    #[test]
    fn endings_name_the_kind() {
        let kind = |name: &str| Video::of_path(Path::new(name)).ok();
        assert_eq!(kind("a/b.MP4"), Some(Video::H264));
        assert_eq!(kind("b.gif"), Some(Video::Gif));
        assert_eq!(kind("b.apng"), Some(Video::Apng));
        assert_eq!(kind("b.avi"), None);
    }
}
