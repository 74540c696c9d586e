//! One export in the list: its frames, then its video.

use std::path::{Path, PathBuf};

use egui::{Image as Picture, TextureHandle, TextureOptions, Ui, vec2};

use super::order::{EXPORT_TOPIC, ExportOrder, UNSTORED_TOPIC};
use super::progress::show_state;
use super::video_maker::{VideoMaker, VideoState};
use crate::editor::Editor;
use crate::export::Sequence;
use crate::files::absolute;
use crate::ui::pictures::Pictures;
use crate::ui::theme::THUMB;
use crate::ui::upload::to_color_image;
use crate::words::counted;
use crate::worker::ExportState;

/// An export in the list.
pub struct Entry {
    /// The worker's id of this export.
    pub id: u64,
    /// The name shown in the list.
    name: String,
    /// The order it was started from; `None` once the export is over.
    order: Option<ExportOrder>,
    /// The video made after the frames, if any.
    video: Option<VideoMaker>,
    /// The folder of the frames, and their name pattern with file extension.
    files: (PathBuf, String),
    /// The first and the last frame number.
    frames: (u64, u64),
    /// Thumbnail of the last frame written, with the value of `done.written` it was made for.
    thumb: Option<(usize, TextureHandle)>,
}

impl Entry {
    /// Creates the entry of an order whose frames are `sequence`.
    pub fn new(id: u64, order: ExportOrder, sequence: Sequence) -> Self {
        let (video, files) = (order.settings.video(&sequence), files_of(&sequence));
        let frames = frame_range(&sequence);
        let video = video.map(|(path, video)| VideoMaker::new(sequence, path, video));
        Self {
            id,
            name: order.name.clone(),
            order: Some(order),
            video,
            files,
            frames,
            thumb: None,
        }
    }

    /// Returns whether the export has ended, video included.
    pub fn is_over(&self) -> bool {
        self.order.is_none()
    }

    /// Describes what follows the frames, in words; `None` if the export is over.
    pub fn describe_after_frames(&self) -> Option<String> {
        self.order.as_ref()?;
        let Some(video) = &self.video else {
            return Some("export".to_owned());
        };
        let done = match video.state {
            VideoState::Making(done) => done,
            _ => 0,
        };
        Some(format!("video {done}/{}", video.frames()))
    }

    /// Returns whether its frames use the same folder and name pattern, whatever their numbers.
    pub fn writes_files_of(&self, sequence: &Sequence) -> bool {
        self.files == files_of(sequence)
    }

    /// Returns whether this export is still running and writes files that the given frames or video would write as
    /// well.
    pub fn conflicts_with(&self, sequence: &Sequence, video: Option<&Path>) -> bool {
        let frames = frame_range(sequence);
        let overlaps = self.frames.0 <= frames.1 && frames.0 <= self.frames.1;
        let own_video = self.video.as_ref().map(|video| video.path.as_path());
        let is_same_video = video.is_some() && own_video == video;
        !self.is_over() && (is_same_video || overlaps && self.writes_files_of(sequence))
    }

    /// Advances to the next step. `state` is the worker's state of the frames, `None` if they were cancelled.
    /// Returns the order if the export failed.
    pub fn update(
        &mut self,
        state: Option<&ExportState>,
        editor: &mut Editor,
    ) -> Option<ExportOrder> {
        let order = self.order.as_mut()?;
        if let Some(why) = order.take_problem() {
            let name = &self.name;
            editor.report_error_in(
                UNSTORED_TOPIC,
                format!("{name} cannot be stored ({why}): if Glint quits before it is done, it must be started again"),
            );
        }
        if let Some(video) = &mut self.video
            && !matches!(video.state, VideoState::Waiting)
        {
            match video.update() {
                VideoState::Made => {
                    editor.notify(format!("Saved {}", video.path.display()));
                    self.end();
                }
                VideoState::Stopped => {
                    let path = video.path.display();
                    editor.notify(format!("{path} was cancelled; its frames are kept"));
                    self.end();
                }
                VideoState::Failed(error) => {
                    let error = error.clone();
                    editor.report_error_in(EXPORT_TOPIC, error.clone());
                    return self.order.take().map(|order| order.failed(error));
                }
                VideoState::Waiting | VideoState::Making(_) => {}
            }
            return None;
        }
        let Some(state) = state else {
            let (name, folder) = (&self.name, &order.settings.folder);
            editor.notify(format!(
                "{name} was cancelled; finished frames are kept in {folder}"
            ));
            self.end();
            return None;
        };
        match state.ended.as_ref()? {
            Ok(()) => {
                let (total, folder) = (counted(state.done.total, "frame"), state.folder.display());
                editor.notify(format!("Saved {total} in {folder}"));
                match &mut self.video {
                    Some(video) => video.make(),
                    None => self.end(),
                }
                None
            }
            Err(error) => {
                let resume_hint = "finished frames are kept; Resume in the Export animation window continues from there";
                editor.report_error_in(EXPORT_TOPIC, format!("{error}; {resume_hint}"));
                let why = error.clone();
                self.order.take().map(|order| order.failed(why))
            }
        }
    }

    /// Marks the export as over; nothing is left to resume.
    fn end(&mut self) {
        if let Some(order) = self.order.take() {
            order.end();
        }
    }

    /// Draws the export's row; opens its folder if the user asks for that.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        state: &ExportState,
        pictures: &Pictures,
        editor: &mut Editor,
    ) {
        let row = ui.horizontal(|ui| {
            self.show_thumb(ui, state);
            let video = self.video.as_ref();
            let shown = ui.vertical(|ui| show_state(ui, &self.name, state, video, pictures));
            shown.inner
        });
        let opens_folder = row.inner;
        let video_folder = self.video.as_ref().and_then(|video| video.path.parent());
        let folder = video_folder.unwrap_or(&state.folder);
        if opens_folder && open::that_detached(folder).is_err() {
            let folder = folder.display();
            editor.report_error_in(
                EXPORT_TOPIC,
                format!("This desktop has no program to open {folder}"),
            );
        }
    }

    fn show_thumb(&mut self, ui: &mut Ui, state: &ExportState) {
        let Some(image) = &state.last else {
            // Reserve the space, so that the rest of the row does not move when the picture appears.
            ui.allocate_space(vec2(THUMB, THUMB));
            return;
        };
        let written = state.done.written;
        let thumb = self.thumb.take().filter(|(of, _)| *of == written);
        let (_, texture) = self.thumb.insert(thumb.unwrap_or_else(|| {
            let image = to_color_image(image);
            let texture = ui.load_texture("exported", image, TextureOptions::LINEAR);
            (written, texture)
        }));
        ui.add(Picture::new(&*texture).fit_to_exact_size(vec2(THUMB, THUMB)));
    }
}

/// The first and the last frame number of a sequence.
fn frame_range(sequence: &Sequence) -> (u64, u64) {
    let first = sequence.frames.iter().next().unwrap_or(1);
    (first, sequence.frames.last().unwrap_or(first))
}

/// The folder of a sequence's frames, and their name pattern with file extension.
fn files_of(sequence: &Sequence) -> (PathBuf, String) {
    let names = format!("{}.{}", sequence.pattern.text(), sequence.format.ending());
    (absolute(&sequence.folder), names)
}
