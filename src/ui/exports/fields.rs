//! Export settings, and their fields in the window.

use std::error::Error;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use egui::{Align2, ComboBox, TextEdit, Ui};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::editor::Editor;
use crate::export::{Frames, Pattern, Sequence, Video};
use crate::files::absolute;
use crate::image::Format;
use crate::scene::{Animation, FRAME_RATES, MAX_SIDE, Method as _, Sampling, Scene};
use crate::ui::commands::Command;
use crate::ui::dialogs::Ask;
use crate::ui::hint::Hinted as _;
use crate::ui::icons;
use crate::ui::number::{Field, drag_unlabelled};
use crate::ui::prompts::typed_path;
use crate::ui::requests::UiRequests;
use crate::ui::theme::ROW;

/// Width of the window's fields, in points.
pub const FIELDS: f32 = 360.0;
/// The names of frames unless others are chosen: padded with zeros, they sort in playback order everywhere.
const PADDED_NAME: &str = "rayTrace%04d";
/// The word for "no video" in the window and in stored settings.
const NO_VIDEO: &str = "none";

/// The settings that follow from the scene itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct SceneDefaults {
    /// Length of its animation.
    #[serde(default)]
    seconds: f64,
    size: (u32, u32),
    fps: f64,
    /// Its antialiasing; absent from settings stored by older versions.
    #[serde(with = "crate::scene::method", default = "usual_sampling")]
    antialias: Sampling,
}

fn usual_sampling() -> Sampling {
    Sampling::ADAPTIVE
}

impl SceneDefaults {
    /// The range of all frames at a frame rate, in the notation of the field.
    fn frames(&self, fps: f64) -> String {
        match Animation::frames_in(self.seconds, fps) {
            1 => "1".to_owned(),
            count => format!("1-{count}"),
        }
    }
}

/// The settings of an export.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// The folder of the frames, as typed.
    pub folder: String,
    frames: String,
    name: String,
    /// File format of the frames.
    pub format: Format,
    /// Width of the frames in pixels.
    pub width: u32,
    /// Height of the frames in pixels.
    pub height: u32,
    /// Whether width and height are set independently, instead of keeping the scene's aspect ratio.
    #[serde(default)]
    is_free: bool,
    fps: f64,
    /// The scene's own settings when these were made.
    own: SceneDefaults,
    #[serde(with = "crate::scene::method")]
    antialias: Sampling,
    #[serde(serialize_with = "write_video", deserialize_with = "read_video")]
    /// The video that follows the frames.
    pub video: Option<Video>,
}

/// The file extension of a video, or [`NO_VIDEO`].
fn video_word(video: Option<Video>) -> &'static str {
    video.map_or(NO_VIDEO, Video::ending)
}

#[expect(
    clippy::ref_option,
    clippy::trivially_copy_pass_by_ref,
    reason = "serde passes a reference to the field"
)]
fn write_video<S: Serializer>(video: &Option<Video>, to: S) -> Result<S::Ok, S::Error> {
    video_word(*video).serialize(to)
}

fn read_video<'de, D: Deserializer<'de>>(from: D) -> Result<Option<Video>, D::Error> {
    String::deserialize(from).map(|word| Video::of_ending(&word))
}

impl Settings {
    /// The same settings without folder and file names, to compare what the files would contain.
    pub fn unnamed(&self) -> Self {
        let (folder, name) = (String::new(), String::new());
        Self {
            folder,
            name,
            ..self.clone()
        }
    }

    /// The default settings for the editor's scene.
    pub fn of(editor: &Editor) -> Self {
        let scene = editor.scene();
        // A path below the working directory is shown relative to it.
        let working_folder = std::env::current_dir().unwrap_or_default();
        let folder = editor
            .path()
            .and_then(Path::parent)
            .unwrap_or(&working_folder);
        let folder = folder.strip_prefix(&working_folder).unwrap_or(folder);
        let stem = editor.stem();
        let own = SceneDefaults {
            seconds: scene.animation.duration(),
            size: (scene.render.width, scene.render.height),
            fps: scene.animation.frames_per_second,
            antialias: scene.render.antialias,
        };
        Self {
            folder: folder.join(format!("{stem} frames")).display().to_string(),
            frames: own.frames(own.fps),
            own,
            name: PADDED_NAME.to_owned(),
            format: Format::Png,
            width: scene.render.width,
            height: scene.render.height,
            is_free: false,
            fps: scene.animation.frames_per_second,
            antialias: scene.render.antialias,
            video: None,
        }
    }

    /// The same settings with an absolute folder.
    pub fn with_absolute_folder(self) -> Self {
        let folder = absolute(&typed_path(&self.folder));
        let folder = folder.display().to_string();
        Self { folder, ..self }
    }

    /// Adapts the settings to a scene whose default settings are `fresh`: those that equalled the scene's old ones
    /// follow it, the others stay.
    pub fn for_scene(&self, fresh: Self) -> Self {
        let mut settings = self.clone();
        settings.own = fresh.own;
        if (self.width, self.height) == self.own.size {
            (settings.width, settings.height) = settings.own.size;
        } else if self.own.size != settings.own.size && !self.is_free {
            settings.height = settings.height_of(self.width);
        }
        if self.fps == self.own.fps {
            settings.fps = fresh.fps;
        }
        if self.antialias == self.own.antialias {
            settings.antialias = fresh.antialias;
        }
        if self.has_all_frames() {
            settings.frames = settings.own.frames(settings.fps);
        }
        settings
    }

    /// Returns whether all frames are exported, however many there are.
    fn has_all_frames(&self) -> bool {
        self.frames == self.own.frames(self.fps)
    }

    /// Sets the size; unless `is_free`, the side that was not changed follows in the scene's aspect ratio.
    fn set_size(&mut self, (width, height): (u32, u32)) {
        let before = (self.width, self.height);
        (self.width, self.height) = (width, height);
        if self.is_free {
            return;
        }
        let (wide, high) = self.own.size;
        if width != before.0 {
            self.height = self.height_of(width);
        } else if height != before.1 {
            self.width = scaled(height, wide, high);
        }
    }

    /// The height that belongs to a width in the scene's aspect ratio.
    fn height_of(&self, width: u32) -> u32 {
        let (wide, high) = self.own.size;
        scaled(width, high, wide)
    }

    /// Sets the frame rate; the range is adjusted if it covered all frames.
    fn set_fps(&mut self, fps: f64) {
        let has_all_frames = self.has_all_frames();
        self.fps = fps;
        if has_all_frames {
            self.frames = self.own.frames(fps);
        }
    }

    /// The name of an export of a document.
    pub fn describe(&self, title: &str) -> String {
        let Self {
            frames,
            width,
            height,
            ..
        } = self;
        let video = self.video.map(|video| format!(" + {}", video.ending()));
        let video = video.unwrap_or_default();
        let ending = self.format.ending();
        format!("{title} · {frames} · {width}×{height} · {ending}{video}")
    }

    /// The frame sequence of these settings for a scene.
    ///
    /// # Errors
    /// Why these settings cannot be exported, in words for the user.
    pub fn sequence(&self, scene: &Scene) -> Result<Sequence, Box<dyn Error>> {
        let mut scene = scene.clone();
        (scene.render.width, scene.render.height) = (self.width, self.height);
        scene.render.antialias = self.antialias;
        scene.animation_mut().frames_per_second = self.fps;
        crate::scene::check(&scene).map_err(|problem| problem.sentence)?;
        let frames = Frames::parse(&self.frames)?;
        let pattern = Pattern::parse(&self.name)?;
        if self.folder.trim().is_empty() {
            return Err("choose a folder for the frames".into());
        }
        let folder = typed_path(&self.folder);
        let sequence = Sequence::new(Arc::new(scene), Some(frames), pattern, self.format, folder)?;
        if let Some((_, video)) = self.video(&sequence) {
            video.check(&sequence)?;
        }
        Ok(sequence)
    }

    /// The path and kind of the video made after the frames, if any.
    pub fn video(&self, sequence: &Sequence) -> Option<(PathBuf, Video)> {
        let video = self.video?;
        let folder = absolute(&sequence.folder);
        let name = folder.file_name();
        let name = name.map_or("frames".into(), |name| name.to_string_lossy());
        let path = folder.join(format!("{name}.{}", video.ending()));
        Some((path, video))
    }
}

/// `side * numerator / denominator`, rounded, within the limits of a picture's side.
fn scaled(side: u32, numerator: u32, denominator: u32) -> u32 {
    let length = f64::from(side) * f64::from(numerator) / f64::from(denominator);
    (length.round() as u32).clamp(1, MAX_SIDE)
}

/// Buttons for sets of settings that belong together.
pub fn presets(ui: &mut Ui, settings: &mut Settings, scene: &Scene) {
    ui.horizontal(|ui| {
        ui.weak("Presets");
        let scene_size = (scene.render.width, scene.render.height);
        for (name, hint, format, antialias, is_half) in [
            (
                "PPM",
                "Like the original program: one sample, rayTrace%d.ppm",
                Format::Ppm,
                Sampling::Centres,
                false,
            ),
            (
                "PNG",
                "Clean edges, compressed, four-digit numbers",
                Format::Png,
                Sampling::ADAPTIVE,
                false,
            ),
            (
                "Draft",
                "Half the size, one sample",
                Format::Png,
                Sampling::Centres,
                true,
            ),
        ] {
            if ui.button(name).hint(hint).clicked() {
                settings.format = format;
                settings.antialias = antialias;
                // A name and a size that were typed stay. The original program did not pad its numbers.
                let unpadded = Pattern::default().text();
                if [PADDED_NAME, &unpadded].contains(&&*settings.name) {
                    settings.name = match format {
                        Format::Ppm => unpadded,
                        Format::Png | Format::Exr => PADDED_NAME.to_owned(),
                    };
                }
                let half = (scene_size.0.div_ceil(2), scene_size.1.div_ceil(2));
                if is_half {
                    (settings.width, settings.height) = half;
                } else if (settings.width, settings.height) == half {
                    (settings.width, settings.height) = scene_size;
                }
            }
        }
    });
}

/// The rows of the settings grid.
pub fn fields(ui: &mut Ui, settings: &mut Settings, out: &mut UiRequests) {
    ui.weak("folder");
    ui.horizontal(|ui| folder(ui, settings, out));
    ui.end_row();
    ui.weak("frames");
    let frames = TextEdit::singleline(&mut settings.frames).align(Align2::LEFT_CENTER);
    ui.add_sized([FIELDS, ROW], frames)
        .hint("1-202, 1,4 or 1-10:3, counted from 1")
        .accessible_name("frames");
    ui.end_row();
    ui.weak("names");
    ui.horizontal(|ui| names(ui, settings));
    ui.end_row();
    ui.weak("picture");
    ui.horizontal(|ui| picture(ui, settings));
    ui.end_row();
    ui.weak("time");
    ui.horizontal(|ui| time_and_video(ui, settings));
    ui.end_row();
}

fn folder(ui: &mut Ui, settings: &mut Settings, out: &mut UiRequests) {
    let absolute_folder = absolute(&typed_path(&settings.folder));
    let field = TextEdit::singleline(&mut settings.folder).align(Align2::LEFT_CENTER);
    ui.add_sized([FIELDS - 90.0, ROW], field)
        .hint(absolute_folder.display().to_string())
        .accessible_name("folder");
    if ui.button("Browse…").clicked() {
        out.commands.push(Command::Ask(Ask::ExportFolder));
    }
}

fn names(ui: &mut Ui, settings: &mut Settings) {
    let name = TextEdit::singleline(&mut settings.name).align(Align2::LEFT_CENTER);
    ui.add_sized([140.0, ROW], name)
        .hint("%d is the frame number, %05d the same with five digits")
        .accessible_name("names");
    if let (Ok(pattern), Ok(frames)) = (
        Pattern::parse(&settings.name),
        Frames::parse(&settings.frames),
    ) {
        let ending = settings.format.ending();
        let file = |frame: u64| format!("{}.{ending}", pattern.name(frame));
        let first = frames.iter().next().map_or(String::new(), file);
        ui.weak(match frames.last() {
            Some(last) if frames.count() > 1 => format!("{first} … {}", file(last)),
            _ => first,
        });
    }
}

fn picture(ui: &mut Ui, settings: &mut Settings) {
    let mut size = (settings.width, settings.height);
    for (name, side) in [
        ("export width", &mut size.0),
        ("export height", &mut size.1),
    ] {
        let field = Field {
            name,
            hint: "In pixels",
            unit: " px",
            default: f64::from(*side),
            range: 1.0..=f64::from(MAX_SIDE),
            speed: None,
        };
        let mut pixels = f64::from(*side);
        drag_unlabelled(ui, &field, &mut pixels);
        *side = pixels.round() as u32;
    }
    settings.set_size(size);
    let mut keeps_shape = !settings.is_free;
    ui.toggle_value(&mut keeps_shape, icons::text(icons::LINK))
        .accessible_name("keep aspect ratio")
        .hint("Width and height follow each other, in the aspect ratio of the scene's picture");
    settings.is_free = !keeps_shape;
    ComboBox::from_id_salt("export antialias")
        .selected_text(settings.antialias.id())
        .show_ui(ui, |ui| {
            for method in Sampling::ALL {
                ui.selectable_value(&mut settings.antialias, method.value, method.id);
            }
        });
    for format in Format::ALL {
        ui.selectable_value(&mut settings.format, format, format.ending());
    }
}

fn time_and_video(ui: &mut Ui, settings: &mut Settings) {
    let mut fps = settings.fps;
    let field = Field {
        name: "export frames per second",
        hint: "Of the frames and the video; the flight does not change",
        unit: " fps",
        default: fps,
        range: FRAME_RATES,
        speed: Some(0.1),
    };
    drag_unlabelled(ui, &field, &mut fps);
    settings.set_fps(fps);
    ui.weak("video");
    for video in std::iter::once(None).chain(Video::ALL.map(Some)) {
        let hint = match video {
            None => "Frames only",
            Some(video) if video.needs_ffmpeg() => "Made by ffmpeg, if it is installed",
            Some(_) => "Made by Glint itself",
        };
        ui.selectable_value(&mut settings.video, video, video_word(video))
            .hint(hint);
    }
}

#[cfg(test)]
mod tests;
