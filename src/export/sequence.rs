//! An animation as a sequence of files: which frames, where, and what each of them shows.

use std::fs::File;
use std::io::{BufWriter, Seek as _};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use image::ImageError;

use super::error::ExportError;
use super::fingerprint::fingerprint;
use super::frames::{Frames, FramesError};
use super::manifest::{Hash, MANIFEST, Manifest, append_entry, hash_file};
use super::pattern::Pattern;
use super::save::{disk_error, write_beside};
use crate::animate::{CameraPath, shot};
use crate::files::{make_folder, remove_leftovers};
use crate::image::Format;
use crate::scene::{Method as _, Scene};
use crate::words::counted;

/// Most pixels of all frames that are traced at once; also of all that are being encoded meanwhile, and of all that
/// are being made into a video. It bounds the memory, however large the frames are and however many threads there
/// are.
const MAX_PIXELS_AT_ONCE: usize = 1 << 26;

/// The message about a video of a [`Sequence`] that is a loop.
pub const LOOP_HINT: &str = "its last frame repeats the first: leave it out for a smooth loop";

/// The frames to export, and where to.
#[derive(Clone, Debug)]
pub struct Sequence {
    scene: Arc<Scene>,
    path: Arc<CameraPath>,
    /// The frames.
    pub frames: Frames,
    /// The pattern of their file names.
    pub pattern: Pattern,
    /// Their file format.
    pub format: Format,
    /// The folder that they are written to.
    pub folder: PathBuf,
}

/// A frame beyond the last one was asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no frame {frame}: the animation has {}", counted(*count, "frame"))]
pub struct NoSuchFrame {
    /// The frame asked for.
    pub frame: u64,
    /// The number of frames.
    pub count: u64,
}

/// The reason why a sequence cannot be made.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SequenceError {
    /// A frame is beyond the end of the animation.
    #[error(transparent)]
    NoSuchFrame(#[from] NoSuchFrame),
    /// All of the animation's frames are too many.
    #[error(transparent)]
    Frames(#[from] FramesError),
}

impl Sequence {
    /// A sequence of frames of a scene, all of them if `frames` is `None`; size and sampling are those of the scene's
    /// `render`.
    ///
    /// # Errors
    /// [`SequenceError`], if a frame is beyond the end of the animation, or the animation has too many frames.
    pub fn new(
        scene: Arc<Scene>,
        frames: Option<Frames>,
        pattern: Pattern,
        format: Format,
        folder: PathBuf,
    ) -> Result<Self, SequenceError> {
        let count = scene.animation.frame_count();
        let frames = frames.map_or_else(|| Frames::up_to(count), Ok)?;
        if let Some(last) = frames.last().filter(|&last| last > count) {
            return Err(NoSuchFrame { frame: last, count }.into());
        }
        Ok(Self {
            path: Arc::new(CameraPath::new(&scene.animation.keys)),
            scene,
            frames,
            pattern,
            format,
            folder,
        })
    }

    /// The frame rate at which the exported frames play at the speed of the animation: lower if some frames are
    /// skipped.
    pub fn frames_per_second(&self) -> f64 {
        let animation_rate = self.scene.animation.frames_per_second;
        let (first, last) = (self.frames.iter().next(), self.frames.last());
        let steps = self.frames.count().saturating_sub(1);
        match (first, last) {
            (Some(first), Some(last)) if steps > 0 => {
                animation_rate * steps as f64 / (last - first) as f64
            }
            _ => animation_rate,
        }
    }

    /// Width and height in pixels.
    pub fn size(&self) -> (u32, u32) {
        (self.scene.render.width, self.scene.render.height)
    }

    /// The number of frames, of `wanted`, that may be processed at once with bounded memory.
    pub fn at_once(&self, wanted: usize) -> usize {
        let (width, height) = self.size();
        let pixels = (width as usize * height as usize).max(1);
        wanted.clamp(1, (MAX_PIXELS_AT_ONCE / pixels).max(1))
    }

    /// The identifier of the antialiasing method.
    pub fn antialias(&self) -> String {
        self.scene.render.antialias.id()
    }

    /// The scene that a frame shows.
    pub fn shown(&self, frame: u64) -> Arc<Scene> {
        shot(&self.scene, &self.path, self.scene.animation.time_of(frame))
    }

    /// The file name of a frame.
    pub fn file(&self, frame: u64) -> String {
        format!("{}.{}", self.pattern.name(frame), self.format.ending())
    }

    /// The path of a frame's file.
    pub fn path(&self, frame: u64) -> PathBuf {
        self.folder.join(self.file(frame))
    }

    /// The frames of the sequence that are missing or outdated.
    ///
    /// # Errors
    /// [`ExportError`], if the folder's manifest cannot be read.
    pub fn missing(&self) -> Result<Frames, ExportError> {
        let manifest = self.manifest()?;
        self.frames.without(|frame| self.is_valid(&manifest, frame))
    }

    /// Makes the folder if it does not exist, and removes unfinished files that killed programs have left there.
    ///
    /// # Errors
    /// [`ExportError::Disk`].
    pub fn prepare(&self) -> Result<(), ExportError> {
        make_folder(&self.folder).map_err(|source| disk_error(&self.folder, source))?;
        remove_leftovers(&self.folder);
        Ok(())
    }

    /// Reads the manifest of the folder.
    ///
    /// # Errors
    /// [`ExportError::Unreadable`].
    pub fn manifest(&self) -> Result<Manifest, ExportError> {
        let read = Manifest::read(&self.folder);
        read.map_err(|source| ExportError::Unreadable {
            path: self.folder.join(MANIFEST),
            source,
        })
    }

    /// Whether a frame exists, is complete and up to date.
    ///
    /// # Errors
    /// [`ExportError::Unwritable`], for a scene that cannot be serialized.
    pub fn is_valid(&self, manifest: &Manifest, frame: u64) -> Result<bool, ExportError> {
        let file = self.file(frame);
        // Checked first, as computing the fingerprint takes a while.
        if !manifest.has_file(&file) {
            return Ok(false);
        }
        let fingerprint = fingerprint(&self.shown(frame), self.format)?;
        Ok(manifest.is_valid(&file, &fingerprint))
    }

    /// Whether the last frame shows the same as the first, but the one before it does not: played in a loop, the picture
    /// would then stand still for a frame.
    pub fn is_loop(&self) -> bool {
        let count = self.frames.count();
        let mut frames = self.frames.iter();
        let (Some(first), Some(before), Some(last)) = (
            frames.next(),
            frames.nth(count.saturating_sub(3)),
            frames.next(),
        ) else {
            return false;
        };
        let first = self.shown(first);
        let fingerprint_of = |scene: &Scene| fingerprint(scene, self.format).ok();
        let is_like_first = |frame: u64| {
            let shown = self.shown(frame);
            shown.camera.is_like(&first.camera) && {
                let with_its_camera = Scene {
                    camera: first.camera.clone(),
                    ..Scene::clone(&shown)
                };
                let own = fingerprint_of(&first);
                own.is_some() && fingerprint_of(&with_its_camera) == own
            }
        };
        is_like_first(last) && !is_like_first(before)
    }

    /// Writes a frame: the output of `encode`, which returns how long the frame took to trace, goes to a new file,
    /// which then gets the frame's name and an entry in the manifest. It is not forced to the disk, which would cost
    /// more than tracing it: after a power cut, its hash shows whether it is whole.
    ///
    /// # Errors
    /// [`ExportError`]; an existing file is then untouched.
    pub fn write(
        &self,
        frame: u64,
        fingerprint: &Hash,
        encode: impl FnOnce(&mut BufWriter<&File>) -> Result<Duration, ImageError>,
    ) -> Result<(), ExportError> {
        let path = self.path(frame);
        let mut time = Duration::ZERO;
        let new_file = write_beside(&path, |file| {
            time = encode(file)?;
            Ok(())
        })?;
        // Read through the open file: on some systems, a locked file cannot be read otherwise.
        let mut file = new_file.as_file();
        let content = file.rewind().and_then(|()| hash_file(file));
        let placed = content.and_then(|content| new_file.place().map(|()| content));
        let content = placed.map_err(|source| disk_error(&path, source))?;
        append_entry(&self.folder, &self.file(frame), &content, fingerprint, time)
            .map_err(|source| disk_error(&self.folder.join(MANIFEST), source))
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::animate::Preset;
    use crate::scene::EXAMPLES;

    #[test]
    fn a_turntable_ends_as_it_begins() {
        let mut scene = Scene::demo();
        let camera = scene.camera.clone();
        let middle = DVec3::new(150.0, 30.0, -100.0);
        scene.animation_mut().keys = Preset::Turntable.keys(&camera, middle, 2.0);
        let is_loop = |scene: &Scene, frames: &str| {
            let scene = Arc::new(scene.clone());
            let frames = Some(Frames::parse(frames).expect("frames"));
            let (pattern, folder) = (Pattern::default(), PathBuf::new());
            let sequence = Sequence::new(scene, frames, pattern, Format::Png, folder);
            sequence.expect("they are there").is_loop()
        };
        assert_eq!(scene.animation.frame_count(), 29);
        assert!(is_loop(&scene, "1-29") && !is_loop(&scene, "1-28"));
        scene.animation_mut().keys.pop();
        assert!(!is_loop(&scene, "1-20"));
        // What stands still all the time is no loop.
        for key in &mut scene.animation_mut().keys {
            key.value = camera.clone();
        }
        assert!(!is_loop(&scene, "1-20"));
    }

    #[test]
    fn every_third_frame_plays_at_the_speed_of_all() {
        let flight = EXAMPLES.iter().find(|example| example.name == "flight");
        let scene = Arc::new(flight.expect("the flight").document().scene);
        for (frames, expected) in [("1-202", 14.0), ("1-202:3", 14.0 / 3.0), ("7", 14.0)] {
            let sequence = Sequence::new(
                Arc::clone(&scene),
                Some(Frames::parse(frames).expect("frames")),
                Pattern::default(),
                Format::Ppm,
                PathBuf::new(),
            );
            let found = sequence.expect("they are there").frames_per_second();
            assert!((found - expected).abs() < 1e-12, "{frames}: {found}");
        }
    }
}
