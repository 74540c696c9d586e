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
use crate::words::counted;
use crate::worker::Background;

/// Approximate size of a PNG relative to a PPM, used until it is measured on a picture.
const PNG_SHARE: f64 = 0.35;
/// Approximate size of an EXR relative to its channels in memory (32-bit floats).
const EXR_SHARE: f64 = 0.6;

/// Maximum pixels of the frame that is traced to measure the time per frame; fewer if they would take more than a
/// second.
const MEASURED: f64 = 1.5e6;
/// Minimum pixels of that frame.
const LEAST: f64 = 4096.0;
/// If [`LEAST`] pixels take less than this, in seconds, the measurement is repeated.
const SHORT: f64 = 2e-3;

/// Frames of a sequence that are missing from their folder or differ from what they should be.
#[derive(Default)]
struct Missing {
    /// Their number.
    count: usize,
    /// The number of them that replace other files.
    replaced: usize,
    /// Whether the video replaces an existing file.
    has_video: bool,
    /// Whether the last frame shows the same as the first.
    is_loop: bool,
}

/// Measurements on the viewport's picture and on one frame.
#[derive(Default)]
struct Speed {
    /// Size of a PNG relative to a PPM.
    png_share: Option<f64>,
    /// Seconds per frame.
    frame: Option<f64>,
    /// Seconds to encode the video.
    video: Option<f64>,
}

/// Estimates for the current export settings, computed on other threads.
#[derive(Default)]
pub struct Forecast {
    /// The settings, the scene's revision and the number of ended exports that the folder was last examined for.
    sought: Option<(Settings, u64, usize)>,
    looking: Background<Result<Missing, String>>,
    found: Option<Result<Missing, String>>,
    /// Revision and width of the picture that is measured, and the export settings it is measured for.
    subject: Option<(u64, usize, Settings)>,
    measuring: Background<Speed>,
    sample: Speed,
}

impl Forecast {
    /// Returns whether anything is still being computed.
    pub fn is_busy(&self) -> bool {
        self.looking.is_awaited() || self.measuring.is_awaited()
    }

    /// Forgets what is known about the folder, as its content is about to change.
    pub fn forget_folder(&mut self) {
        (self.sought, self.found) = (None, None);
    }

    /// Takes over results that have arrived.
    pub fn update(&mut self) {
        if let Some(answer) = self.looking.take() {
            self.found = Some(answer.unwrap_or_else(|no_answer| Err(no_answer.to_string())));
        }
        if let Some(Ok(sample)) = self.measuring.take() {
            self.sample = sample;
        }
    }

    /// Examines what is already in the folder; `ended` is the number of exports that have ended and may have
    /// changed it.
    pub fn look(
        &mut self,
        (settings, sequence): (&Settings, &Sequence),
        editor: &Editor,
        ended: usize,
    ) {
        let sought = (settings.clone(), editor.revision(), ended);
        if self.looking.is_awaited() || self.sought.as_ref() == Some(&sought) {
            return;
        }
        (self.sought, self.found) = (Some(sought), None);
        let (sequence, video) = (sequence.clone(), settings.video(sequence));
        let look = move || {
            let has_video = video.as_ref().is_some_and(|(path, _)| path.exists());
            let is_loop = video.is_some() && sequence.is_loop();
            let missing = missing(&sequence)?;
            Ok(Missing {
                has_video,
                is_loop,
                ..missing
            })
        };
        self.looking = Background::start("glint-look", look);
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
        let is_meant = editor.mode != Mode::LowRes && !editor.timeline().is_playing;
        let Some(frame) = frame.filter(|_| is_meant && !self.measuring.is_awaited()) else {
            return;
        };
        let subject = (frame.revision, frame.image.width, settings.unnamed());
        if self.subject.as_ref() != Some(&subject) {
            (self.sample.frame, self.sample.video) = (None, None);
            self.subject = Some(subject);
            let (image, video) = (Arc::clone(&frame.image), settings.video);
            let sequence = sequence.clone();
            let measure = move || Speed::of(&image, &sequence, video);
            self.measuring = Background::start("glint-sample", measure);
        }
    }

    /// Describes the estimate in words.
    pub fn describe(&self, settings: &Settings, sequence: &Sequence) -> String {
        let total = sequence.frames.count();
        let (missing, what) = match &self.found {
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
        let own = settings.unnamed();
        let is_of_this = |(.., of): &(u64, usize, Settings)| *of == own;
        let is_known = self.subject.as_ref().is_some_and(is_of_this);
        let about = |seconds: Option<f64>| {
            seconds.map_or(String::new(), |seconds| {
                format!(", about {}", time_in_words(seconds))
            })
        };
        let frames = if missing == 0 {
            String::new()
        } else {
            let megabytes = pixels * self.bytes(settings.format) * missing as f64 / 1e6;
            let frame = self.sample.frame.filter(|_| is_known);
            let seconds = frame.map(|seconds| seconds * missing as f64);
            format!("{}, {megabytes:.0} MB", about(seconds))
        };
        let video = settings.video(sequence).map(|(path, video)| {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let time = about(self.sample.video.filter(|_| is_known));
            let remark = video.check(sequence).ok().flatten();
            let remark = remark.map_or(String::new(), |remark| format!("; {remark}"));
            let missing = self.found.as_ref().and_then(|found| found.as_ref().ok());
            let replaced = match missing {
                Some(Missing {
                    has_video: true, ..
                }) => " (replaces an older one)",
                _ => "",
            };
            let looped = match missing {
                Some(Missing { is_loop: true, .. }) => format!("; {LOOP_HINT}"),
                _ => String::new(),
            };
            format!(", then {name}{replaced}{time}{remark}{looped}")
        });
        format!("{what}{frames}{}", video.unwrap_or_default())
    }

    /// Bytes per pixel of a file.
    fn bytes(&self, format: Format) -> f64 {
        match format {
            Format::Ppm => 3.0,
            Format::Png => 3.0 * self.sample.png_share.unwrap_or(PNG_SHARE),
            Format::Exr => 12.0 * EXR_SHARE,
        }
    }
}

impl Missing {
    /// Describes the missing frames, out of `total`.
    fn describe(&self, total: usize) -> String {
        let stay = match total - self.count {
            0 => String::new(),
            1 => ", 1 exists and is kept".to_owned(),
            there => format!(", {there} exist and are kept"),
        };
        let replace = match self.replaced {
            0 => String::new(),
            1 => ", 1 replaces an older file".to_owned(),
            replaced => format!(", {replaced} replace older files"),
        };
        format!("{} to make{stay}{replace}", counted(self.count, "frame"))
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
        let packing = since.elapsed().as_secs_f64() / pixels / Threads::available() as f64;
        let packing = match sequence.format {
            Format::Ppm => 0.0,
            Format::Png | Format::Exr => packing,
        };
        let (width, height) = sequence.size();
        let whole = f64::from(width) * f64::from(height);
        let frame = seconds_of_frame(sequence).map(|seconds| seconds + packing * whole);
        let time = video.and_then(|video| video.forecast(sequence, image, video_threads()));
        Self {
            png_share: encoded
                .ok()
                .map(|()| file.into_inner().len() as f64 / (3.0 * pixels)),
            frame,
            video: time.map(|time| time.as_secs_f64()),
        }
    }
}

/// Seconds to trace one frame, after planning what all frames share: the middle one, in its own size or, if that
/// would take long, in a smaller one.
fn seconds_of_frame(sequence: &Sequence) -> Option<f64> {
    let (width, height) = sequence.size();
    let whole = f64::from(width) * f64::from(height);
    let (mut planner, mut image) = (Planner::default(), Image::default());
    let mut seconds_of = |frame: u64, most: f64| {
        let shown = sequence.shown(frame);
        let smaller = (most / whole).sqrt().min(1.0);
        let side = |side: u32| (f64::from(side) * smaller).ceil() as u32;
        let request = RenderRequest::of(&shown, side(width), side(height));
        let control = RenderControl::default();
        let cost = render_into(&mut image, &mut planner, &shown, &request, &control)?;
        Some(cost.time.as_secs_f64())
    };
    let mut frames = sequence.frames.iter().skip(sequence.frames.count() / 2);
    let first = frames.next()?;
    let next = frames.next().unwrap_or(first);
    seconds_of(first, LEAST)?;
    // Mostly the planning that each frame needs.
    let least = seconds_of(next, LEAST)?;
    let most = (LEAST / least).clamp(LEAST, MEASURED).min(whole);
    // One short measurement may be slow by chance, so it is repeated where that is cheap.
    let again = (least < SHORT).then(|| seconds_of(first, most)).flatten();
    let seconds = seconds_of(next, most)?;
    let seconds = again.map_or(seconds, |again| again.min(seconds));
    let scale = (whole / most).max(1.0);
    Some(least + (seconds - least).max(0.0) * scale)
}

fn missing(sequence: &Sequence) -> Result<Missing, String> {
    // A missing folder holds no frames; examining it must not create it.
    if !sequence.folder.exists() {
        let count = sequence.frames.count();
        return Ok(Missing {
            count,
            ..Missing::default()
        });
    }
    let missing = sequence.missing().map_err(|error| error.to_string())?;
    let is_there = |frame: &u64| sequence.path(*frame).exists();
    Ok(Missing {
        count: missing.count(),
        replaced: missing.iter().filter(is_there).count(),
        ..Missing::default()
    })
}
