//! Estimates of an export: frames to make, time, disk space.

use std::io::Cursor;
use std::sync::Arc;
use std::time::Instant;

use super::fields::Settings;
use super::video_maker::video_threads;
use crate::editor::{Editor, Mode};
use crate::export::{LOOP_HINT, Sequence, Video};
use crate::image::{Format, Image, render_into};
use crate::plan::{Planner, RenderRequest};
use crate::trace::{RenderControl, Threads};
use crate::ui::pictures::Pictures;
use crate::ui::status::time_in_words;
use crate::words::{counted, short_number};
use crate::worker::Background;

/// Approximate size of a PNG relative to a PPM, used until it is measured on a picture.
const PNG_SIZE_RATIO: f64 = 0.35;
/// Approximate size of an EXR relative to its channels in memory (32-bit floats).
const EXR_SIZE_RATIO: f64 = 0.6;

/// Maximum pixels of the frame that is traced to measure the time per frame; fewer if they would take more than a
/// second.
const MAX_SAMPLE_PIXELS: f64 = 1.5e6;
/// Minimum pixels of that frame.
const MIN_SAMPLE_PIXELS: f64 = 4096.0;
/// If [`MIN_SAMPLE_PIXELS`] pixels take less than this, in seconds, the measurement is repeated.
const REPEAT_BELOW_SECONDS: f64 = 2e-3;

/// Frames of a sequence that are missing from their folder or differ from what they should be.
struct Missing {
    /// Their number.
    count: usize,
    /// The number of them that replace other files.
    replaced: usize,
    /// Whether the video replaces an existing file.
    replaces_video: bool,
    /// Whether the last frame shows the same as the first.
    is_loop: bool,
}

/// Measurements on the viewport's picture and on one frame.
#[derive(Default)]
struct Speed {
    /// Size of a PNG relative to a PPM.
    png_size_ratio: Option<f64>,
    /// Seconds per frame.
    frame_seconds: Option<f64>,
    /// Seconds to encode the video.
    video_seconds: Option<f64>,
}

/// Estimates for the current export settings, computed on other threads.
#[derive(Default)]
pub struct Forecast {
    /// The settings, the scene's revision and the number of ended exports that the folder was last examined for.
    examined_for: Option<(Settings, u64, usize)>,
    examining: Background<Result<Missing, String>>,
    folder_state: Option<Result<Missing, String>>,
    /// Revision and width of the picture that is measured, and the export settings it is measured for.
    measured_for: Option<(u64, usize, Settings)>,
    measuring: Background<Speed>,
    speed: Speed,
}

impl Forecast {
    /// Returns whether anything is still being computed.
    pub fn is_busy(&self) -> bool {
        self.examining.is_awaited() || self.measuring.is_awaited()
    }

    /// Forgets what is known about the folder, as its content is about to change.
    pub fn forget_folder(&mut self) {
        (self.examined_for, self.folder_state) = (None, None);
    }

    /// Takes over results that have arrived.
    pub fn update(&mut self) {
        if let Some(answer) = self.examining.take() {
            self.folder_state = Some(answer.unwrap_or_else(|no_answer| Err(no_answer.to_string())));
        }
        if let Some(Ok(speed)) = self.measuring.take() {
            self.speed = speed;
        }
    }

    /// Examines what is already in the folder; `ended` is the number of exports that have ended and may have
    /// changed it.
    pub fn examine_folder(
        &mut self,
        (settings, sequence): (&Settings, &Sequence),
        editor: &Editor,
        ended: usize,
    ) {
        let examined_for = (settings.clone(), editor.revision(), ended);
        if self.examining.is_awaited() || self.examined_for.as_ref() == Some(&examined_for) {
            return;
        }
        (self.examined_for, self.folder_state) = (Some(examined_for), None);
        let (sequence, video) = (sequence.clone(), settings.video(sequence));
        let examine = move || {
            let (count, replaced) = missing(&sequence)?;
            Ok(Missing {
                count,
                replaced,
                replaces_video: video.as_ref().is_some_and(|(path, _)| path.exists()),
                is_loop: video.is_some() && sequence.is_loop(),
            })
        };
        self.examining = Background::start("glint-look", examine);
    }

    /// Measures the size and the encoding time of frames, taking the finished picture on screen as typical of them.
    pub fn measure(
        &mut self,
        (settings, sequence): (&Settings, &Sequence),
        editor: &Editor,
        pictures: &Pictures,
    ) {
        let frame = pictures.complete_frame(editor);
        // A picture of 64 pixels says little about larger ones, and during playback the estimate is not urgent.
        let is_wanted = editor.mode != Mode::LowRes && !editor.timeline().is_playing;
        let Some(frame) = frame.filter(|_| is_wanted && !self.measuring.is_awaited()) else {
            return;
        };
        let measured_for = (frame.revision, frame.image.width, settings.unnamed());
        if self.measured_for.as_ref() != Some(&measured_for) {
            (self.speed.frame_seconds, self.speed.video_seconds) = (None, None);
            self.measured_for = Some(measured_for);
            let (image, video) = (Arc::clone(&frame.image), settings.video);
            let sequence = sequence.clone();
            let measure = move || Speed::of(&image, &sequence, video);
            self.measuring = Background::start("glint-sample", measure);
        }
    }

    /// Describes the estimate in words.
    pub fn describe(&self, settings: &Settings, sequence: &Sequence) -> String {
        let total = sequence.frames.count();
        let (missing, frames_text) = match &self.folder_state {
            None => (
                total,
                format!("{}, checking the folder…", counted(total, "frame")),
            ),
            Some(Err(error)) => (total, error.clone()),
            Some(Ok(Missing { count: 0, .. })) => {
                (0, format!("all {} already exist", counted(total, "frame")))
            }
            Some(Ok(missing)) => (missing.count, missing.describe(total)),
        };
        let pixels = f64::from(settings.width) * f64::from(settings.height);
        let unnamed = settings.unnamed();
        let is_current = |(.., of): &(u64, usize, Settings)| *of == unnamed;
        let is_known = self.measured_for.as_ref().is_some_and(is_current);
        let about = |seconds: Option<f64>| {
            seconds.map_or(String::new(), |seconds| {
                format!(", about {}", time_in_words(seconds))
            })
        };
        let frames = if missing == 0 {
            String::new()
        } else {
            let megabytes = pixels * self.bytes(settings.format) * missing as f64 / 1e6;
            let frame = self.speed.frame_seconds.filter(|_| is_known);
            let seconds = frame.map(|seconds| seconds * missing as f64);
            format!("{}, {} MB", about(seconds), short_number(megabytes))
        };
        let video = settings.video(sequence).map(|(path, video)| {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let time = about(self.speed.video_seconds.filter(|_| is_known));
            let remark = video.check(sequence).ok().flatten();
            let remark = remark.map_or(String::new(), |remark| format!("; {remark}"));
            let missing = self
                .folder_state
                .as_ref()
                .and_then(|folder_state| folder_state.as_ref().ok());
            let replaced = match missing {
                Some(Missing {
                    replaces_video: true,
                    ..
                }) => " (replaces an older one)",
                _ => "",
            };
            let loop_hint = match missing {
                Some(Missing { is_loop: true, .. }) => format!("; {LOOP_HINT}"),
                _ => String::new(),
            };
            format!(", then {name}{replaced}{time}{remark}{loop_hint}")
        });
        format!("{frames_text}{frames}{}", video.unwrap_or_default())
    }

    /// Bytes per pixel of a file.
    fn bytes(&self, format: Format) -> f64 {
        match format {
            Format::Ppm => 3.0,
            Format::Png => 3.0 * self.speed.png_size_ratio.unwrap_or(PNG_SIZE_RATIO),
            Format::Exr => 12.0 * EXR_SIZE_RATIO,
        }
    }
}

impl Missing {
    /// Describes the missing frames, out of `total`.
    fn describe(&self, total: usize) -> String {
        let kept = match total - self.count {
            0 => String::new(),
            1 => ", 1 exists and is kept".to_owned(),
            existing => format!(", {existing} exist and are kept"),
        };
        let replacing = match self.replaced {
            0 => String::new(),
            1 => ", 1 replaces an older file".to_owned(),
            replaced => format!(", {replaced} replace older files"),
        };
        format!("{} to make{kept}{replacing}", counted(self.count, "frame"))
    }
}

impl Speed {
    /// Measures for an export whose frames resemble `image`.
    fn of(image: &Image, sequence: &Sequence, video: Option<Video>) -> Self {
        let pixels = image.pixels.len().max(1) as f64;
        let mut file = Cursor::new(Vec::new());
        let since = Instant::now();
        let encoded = image.encode(Format::Png, &mut file);
        // Encoding takes one thread, while the others trace.
        let encoding = since.elapsed().as_secs_f64() / pixels / Threads::available() as f64;
        let encoding = match sequence.format {
            Format::Ppm => 0.0,
            Format::Png | Format::Exr => encoding,
        };
        let (width, height) = sequence.size();
        let pixel_count = f64::from(width) * f64::from(height);
        let frame_seconds =
            seconds_of_frame(sequence).map(|seconds| seconds + encoding * pixel_count);
        let time = video.and_then(|video| video.forecast(sequence, image, video_threads()));
        Self {
            png_size_ratio: encoded
                .ok()
                .map(|()| file.into_inner().len() as f64 / (3.0 * pixels)),
            frame_seconds,
            video_seconds: time.map(|time| time.as_secs_f64()),
        }
    }
}

/// Seconds to trace one frame, after planning what all frames share: the middle one, in its own size or, if that
/// would take long, in a smaller one.
fn seconds_of_frame(sequence: &Sequence) -> Option<f64> {
    let (width, height) = sequence.size();
    let pixel_count = f64::from(width) * f64::from(height);
    let (mut planner, mut image) = (Planner::default(), Image::default());
    let mut seconds_of = |frame: u64, max_pixels: f64| {
        let shown = sequence.shown(frame);
        let reduction = (max_pixels / pixel_count).sqrt().min(1.0);
        let side = |side: u32| (f64::from(side) * reduction).ceil() as u32;
        let request = RenderRequest::of(&shown, side(width), side(height));
        let control = RenderControl::default();
        let cost = render_into(&mut image, &mut planner, &shown, &request, &control)?;
        Some(cost.time.as_secs_f64())
    };
    let mut frames = sequence.frames.iter().skip(sequence.frames.count() / 2);
    let first = frames.next()?;
    let next = frames.next().unwrap_or(first);
    seconds_of(first, MIN_SAMPLE_PIXELS)?;
    // Mostly the planning that each frame needs.
    let base_seconds = seconds_of(next, MIN_SAMPLE_PIXELS)?;
    let sample_pixels = (MIN_SAMPLE_PIXELS / base_seconds)
        .clamp(MIN_SAMPLE_PIXELS, MAX_SAMPLE_PIXELS)
        .min(pixel_count);
    // One short measurement may be slow by chance, so it is repeated where that is cheap.
    let repeated = (base_seconds < REPEAT_BELOW_SECONDS)
        .then(|| seconds_of(first, sample_pixels))
        .flatten();
    let seconds = seconds_of(next, sample_pixels)?;
    let seconds = repeated.map_or(seconds, |repeated| repeated.min(seconds));
    let scale = (pixel_count / sample_pixels).max(1.0);
    Some(base_seconds + (seconds - base_seconds).max(0.0) * scale)
}

/// The number of missing frames, and of those among them that replace other files.
fn missing(sequence: &Sequence) -> Result<(usize, usize), String> {
    // A missing folder holds no frames; examining it must not create it.
    if !sequence.folder.exists() {
        return Ok((sequence.frames.count(), 0));
    }
    let missing = sequence.missing().map_err(|error| error.to_string())?;
    let exists = |frame: &u64| sequence.path(*frame).exists();
    Ok((missing.count(), missing.iter().filter(exists).count()))
}
