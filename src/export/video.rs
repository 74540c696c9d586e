//! Videos made of exported frames: by ffmpeg, or as GIF or APNG without it.

use std::ffi::OsStr;
use std::path::Path;
use std::time::Duration;

use super::animated::{MAX_APNG_DELAY, MAX_GIF_DELAY, apng, estimate_gif_time, gif, left_out};
use super::error::{ExportError, VideoError};
use super::ffmpeg::make_with_ffmpeg;
use super::sequence::Sequence;
use crate::files::NewFile;
use crate::image::Image;

/// Codec arguments for ffmpeg. Both sides are made even, as H.264 needs. The conversion from RGB is recorded in the
/// file: players would otherwise guess it from the size.
const H264: &str = "-c:v libx264 -crf 25 -vf scale=trunc(iw/2)*2:trunc(ih/2)*2:out_color_matrix=bt709:out_range=tv,format=yuv420p,setparams=color_primaries=bt709:color_trc=bt709:colorspace=bt709:range=tv -movflags +faststart";
const PRORES: &str = "-c:v prores_ks -profile:v 4444 -vf scale=out_color_matrix=bt709:out_range=tv,format=yuv444p10le,setparams=color_primaries=bt709:color_trc=bt709:colorspace=bt709:range=tv";
/// Reproducible to the bit: without the random number that tells files apart.
const LOSSLESS: &str = "-c:v ffv1 -level 3 -pix_fmt bgr0 -fflags +bitexact";

/// A video format, chosen by the file extension.
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

impl Video {
    /// All formats, in the order in which they are offered.
    pub const ALL: [Self; 5] = [
        Self::H264,
        Self::ProRes,
        Self::Lossless,
        Self::Gif,
        Self::Apng,
    ];

    /// The extension of such files.
    pub fn ending(self) -> &'static str {
        match self {
            Self::H264 => "mp4",
            Self::ProRes => "mov",
            Self::Lossless => "mkv",
            Self::Gif => "gif",
            Self::Apng => "apng",
        }
    }

    /// Whether making it needs ffmpeg.
    pub fn needs_ffmpeg(self) -> bool {
        self.codec().is_some()
    }

    /// The codec with which ffmpeg makes it; `None` if it is made without ffmpeg.
    fn codec(self) -> Option<&'static str> {
        match self {
            Self::H264 => Some(H264),
            Self::ProRes => Some(PRORES),
            Self::Lossless => Some(LOSSLESS),
            Self::Gif | Self::Apng => None,
        }
    }

    /// The format with this extension, in any case.
    pub fn of_ending(ending: &str) -> Option<Self> {
        let has_ending = |video: &Self| ending.eq_ignore_ascii_case(video.ending());
        Self::ALL.into_iter().find(has_ending)
    }

    /// The format for a file's extension.
    ///
    /// # Errors
    /// [`VideoError::Unknown`].
    pub fn of_path(path: &Path) -> Result<Self, VideoError> {
        let ending = path.extension().and_then(OsStr::to_str);
        let video = ending.and_then(Self::of_ending);
        video.ok_or_else(|| VideoError::Unknown(path.display().to_string()))
    }

    /// Estimates how long `threads` threads take to make it of frames like `image`; `None` if ffmpeg makes it, or if
    /// that takes little time compared to tracing.
    pub fn forecast(self, sequence: &Sequence, image: &Image, threads: usize) -> Option<Duration> {
        (self == Self::Gif).then(|| estimate_gif_time(sequence, image, threads))
    }

    /// Makes a video of the frames of a sequence, all of which must exist, and puts it in place once it is complete.
    /// `go_on` is told how many frames are in it, and returns whether to continue.
    ///
    /// # Errors
    /// [`VideoError`]; an existing file is then untouched.
    pub fn make(
        self,
        sequence: &Sequence,
        path: &Path,
        mut go_on: impl FnMut(usize) -> bool,
    ) -> Result<(), VideoError> {
        let before = sequence.manifest()?;
        let new_file = NewFile::beside(path).map_err(|error| VideoError::disk(path, error))?;
        match self.codec() {
            Some(codec) => make_with_ffmpeg(sequence, (new_file.lend(), path), codec, &mut go_on)?,
            None if self == Self::Gif => gif(sequence, (new_file.as_file(), path), &mut go_on)?,
            None => apng(sequence, (new_file.as_file(), path), &mut go_on)?,
        }
        // It may have been cancelled at the last moment.
        if !go_on(sequence.frames.count()) {
            return Err(VideoError::Stopped);
        }
        // Another export may have replaced some frames while they were read.
        let after = sequence.manifest()?;
        let mut changed = sequence.frames.iter().filter(|frame| {
            let file = sequence.file(*frame);
            before.is_rewritten(&after, &file)
        });
        if let Some(frame) = changed.next() {
            let path = sequence.path(frame);
            return Err(ExportError::Changed { path }.into());
        }
        // No hash would tell that it was damaged, as that of a frame does.
        let placed = new_file.place_durably();
        placed.map_err(|error| VideoError::disk(path, error))
    }

    /// Describes in a sentence how a video will differ from the frames of a sequence, if it does.
    ///
    /// # Errors
    /// [`VideoError::Unfit`] if it cannot show them.
    pub fn check(self, sequence: &Sequence) -> Result<Option<String>, VideoError> {
        let (width, height) = sequence.size();
        let (fps, count) = (sequence.frames_per_second(), sequence.frames.count());
        let unfit = |why: String| Err(VideoError::Unfit { why });
        let too_long = |kind: &str, longest: f64| {
            let seconds = 1.0 / fps;
            unfit(format!(
                "{kind} can show a frame for at most {longest} seconds, not for {seconds:.0}; choose more frames per second, or .mkv"
            ))
        };
        let uneven = (!sequence.frames.are_even()).then(|| {
            "the frames are not equally far apart, but the video shows each of them for the same time"
                .to_owned()
        });
        let with_uneven = |remark: Option<String>| {
            let remarks: Vec<String> = remark.into_iter().chain(uneven).collect();
            Ok((!remarks.is_empty()).then(|| remarks.join("; ")))
        };
        match self {
            Self::H264 | Self::Lossless if width.min(height) < 2 => unfit(format!(
                "an .mp4 or .mkv needs at least 2 × 2 pixels, not {width} × {height}; .gif, .apng and .mov can have any size"
            )),
            Self::H264 if width % 2 + height % 2 > 0 => {
                let [width, height] = [width, height].map(|side| side / 2 * 2);
                with_uneven(Some(format!(
                    "an .mp4 has an even width and height: it shows {width} × {height} pixels"
                )))
            }
            Self::Gif if 1.0 / fps > MAX_GIF_DELAY => too_long("a .gif", MAX_GIF_DELAY),
            Self::Apng if 1.0 / fps > MAX_APNG_DELAY => too_long("an .apng", MAX_APNG_DELAY),
            Self::Gif => with_uneven(match left_out(fps, count) {
                0 => None,
                out => Some(format!(
                    "a .gif shows at most 50 frames per second: {out} of {count} are left out"
                )),
            }),
            _ => with_uneven(None),
        }
    }

    /// The number of frames of a sequence that it shows.
    pub fn frames_of(self, sequence: &Sequence) -> usize {
        let count = sequence.frames.count();
        match self {
            Self::Gif => count - left_out(sequence.frames_per_second(), count),
            _ => count,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;
    use std::sync::Arc;

    use super::*;
    use crate::export::{Frames, Pattern};
    use crate::image::Format;
    use crate::scene::{Key, Scene};

    #[test]
    fn endings_name_the_kind() {
        let kind = |name: &str| Video::of_path(Path::new(name)).ok();
        assert_eq!(kind("a/b.MP4"), Some(Video::H264));
        assert_eq!(kind("b.gif"), Some(Video::Gif));
        assert_eq!(kind("b.apng"), Some(Video::Apng));
        assert_eq!(kind("b.avi"), None);
    }

    #[test]
    fn no_frame_is_shown_for_longer_than_a_clock_counts() {
        let mut scene = Scene::demo();
        let key = |time| Key::new(time, scene.camera.clone());
        let keys = vec![key(0.0), key(200_000.0)];
        scene.animation_mut().frames_per_second = 1.0;
        scene.animation_mut().keys = keys;
        let check = |frames: &str, video: Video| {
            let (scene, frames) = (Arc::new(scene.clone()), Frames::parse(frames).ok());
            let (name, folder) = (Pattern::default(), PathBuf::new());
            let sequence = Sequence::new(scene, frames, name, Format::Ppm, folder);
            video.check(&sequence.expect("they are there"))
        };
        for (video, longest) in [(Video::Gif, 655), (Video::Apng, 65_535)] {
            let frames = |apart: u32| format!("1,{}", apart + 1);
            assert!(matches!(check(&frames(longest), video), Ok(None)));
            let refused = check(&frames(longest + 1), video);
            let said = refused.map_or_else(|error| error.to_string(), |_| String::new());
            assert!(said.contains(&format!("not for {}", longest + 1)), "{said}");
        }
    }
}
