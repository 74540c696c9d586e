//! Exporting the animation: what, where to and how, and how far the exports are.

mod fields;

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, TryRecvError};
use std::time::Duration;

use egui::{
    Button, Context, Grid, Image as Picture, ProgressBar, RichText, TextureHandle, TextureOptions,
    Ui, Window, vec2,
};

use self::fields::{FIELDS, Found, Settings, fields, forecast, presets};
use super::pictures::Pictures;
use super::requests::UiRequests;
use super::status::in_words;
use super::theme::{GRID, THUMB, palette};
use super::upload::whole;
use crate::editor::Editor;
use crate::export::{Sequence, Video, VideoError};
use crate::worker::{ExportState, run_in_background};

/// The window and its exports.
#[derive(Default)]
pub struct Exports {
    /// Whether the window is shown.
    pub is_open: bool,
    /// What is asked for, and of which document, see [`Editor::documents`].
    settings: Option<(u64, Settings)>,
    /// What was asked for last, for each document.
    kept: HashMap<u64, Settings>,
    /// What each export is called.
    names: Vec<(u64, String)>,
    /// What was found in the folder, for these settings, this state of the scene, and so many exports
    /// that have ended.
    found: Option<(Settings, (u64, usize), Option<Found>)>,
    looking: Option<Receiver<Found>>,
    /// Videos that follow their frames.
    videos: Vec<Following>,
    thumbs: Vec<(u64, usize, TextureHandle)>,
    /// Exports whose end was told.
    told: Vec<u64>,
}

/// A video that is made when its frames are there.
struct Following {
    id: u64,
    sequence: Sequence,
    path: PathBuf,
    video: Video,
    making: Option<Receiver<Result<(), VideoError>>>,
}

impl Exports {
    /// The folder that was chosen.
    pub fn choose_folder(&mut self, folder: &Path) {
        if let Some((_, settings)) = &mut self.settings {
            settings.folder = folder.display().to_string();
        }
    }

    /// Tells of exports that have ended, and makes their videos.
    pub fn update(&mut self, editor: &mut Editor, pictures: &Pictures) {
        for state in pictures.exports() {
            let Some(ended) = &state.ended else { continue };
            if self.told.contains(&state.id) {
                continue;
            }
            self.told.push(state.id);
            match ended {
                Ok(()) => editor.notify(format!(
                    "{} frames are in {}",
                    state.done.total,
                    state.folder.display()
                )),
                Err(error) => editor.report_error(format!(
                    "{error}; what is done stays, and exporting again goes on from there"
                )),
            }
            let is_done = ended.is_ok();
            self.videos.retain(|video| is_done || video.id != state.id);
            for video in self.videos.iter_mut().filter(|video| video.id == state.id) {
                let (kind, sequence, path) =
                    (video.video, video.sequence.clone(), video.path.clone());
                let make = move || kind.make(&sequence, &path, |_| ());
                video.making = Some(run_in_background("glint-video", make));
            }
        }
        // One whose export was given up is not made either.
        let states = pictures.exports();
        let is_wanted = |video: &Following| states.iter().any(|state| state.id == video.id);
        self.videos
            .retain(|video| video.making.is_some() || is_wanted(video));
        self.videos.retain(|video| {
            let made = video.making.as_ref().map(Receiver::try_recv);
            match made {
                Some(Ok(Ok(()))) => editor.notify(format!("Saved {}", video.path.display())),
                Some(Ok(Err(error))) => editor.report_error(error.to_string()),
                Some(Err(TryRecvError::Disconnected)) => {
                    editor.report_error("the video was not made".to_owned());
                }
                Some(Err(TryRecvError::Empty)) | None => return true,
            }
            false
        });
    }

    /// What is going on, in words; `None` if nothing is.
    pub fn describe(&self, pictures: &Pictures) -> Option<String> {
        let states = pictures.exports();
        let mut going = states.iter().filter(|state| state.ended.is_none());
        let Some(state) = going.next() else {
            return (!self.videos.is_empty()).then(|| "making a video".to_owned());
        };
        let done = state.done.kept + state.done.written;
        let left = match seconds_left(state) {
            Some(seconds) => format!(" · {} left", in_words(seconds)),
            None => String::new(),
        };
        let more = match going.count() {
            0 => String::new(),
            more => format!(" · {more} more"),
        };
        Some(format!("export {done}/{}{left}{more}", state.done.total))
    }

    /// Whether there is something that the window should be drawn again for.
    pub fn is_busy(&self, pictures: &Pictures) -> bool {
        pictures.is_exporting() || !self.videos.is_empty() || self.looking.is_some()
    }

    /// Draws the window, if it is open.
    pub fn show(
        &mut self,
        ctx: &Context,
        editor: &mut Editor,
        pictures: &Pictures,
        out: &mut UiRequests,
    ) {
        if self.is_busy(pictures) {
            ctx.request_repaint_after(Duration::from_millis(100));
        }
        let mut is_open = self.is_open;
        Window::new("Export animation")
            .open(&mut is_open)
            .collapsible(false)
            .resizable(false)
            .default_pos(egui::pos2(280.0, 60.0))
            .show(ctx, |ui| {
                self.show_settings(ui, editor, pictures, out);
                self.show_list(ui, pictures);
            });
        self.is_open = is_open && self.is_open;
        if !self.is_open {
            self.keep();
        }
    }

    /// Puts the settings away, for the next time that this document is exported.
    fn keep(&mut self) {
        if let Some((document, settings)) = self.settings.take() {
            self.kept.insert(document, settings);
        }
    }

    /// The settings that were put away, for the scene as it is now.
    fn settings(&self, editor: &Editor) -> Settings {
        let fresh = Settings::of(editor);
        match self.kept.get(&editor.documents()) {
            Some(kept) => kept.for_scene(fresh),
            None => fresh,
        }
    }

    fn show_settings(
        &mut self,
        ui: &mut Ui,
        editor: &mut Editor,
        pictures: &Pictures,
        out: &mut UiRequests,
    ) {
        let document = editor.documents();
        if self
            .settings
            .as_ref()
            .is_some_and(|(of, _)| *of != document)
        {
            self.keep();
        }
        let shown = self.settings.take().map(|(_, settings)| settings);
        let mut settings = shown.unwrap_or_else(|| self.settings(editor));
        presets(ui, &mut settings, editor.scene());
        Grid::new("export settings")
            .num_columns(2)
            .spacing([GRID, GRID / 2.0])
            .show(ui, |ui| fields(ui, &mut settings, out));
        let sequence = settings.sequence(editor.scene());
        let colors = palette(ui.ctx());
        match &sequence {
            Err(error) => {
                ui.colored_label(colors.error, error.to_string());
            }
            Ok(sequence) => {
                self.look(editor, &settings, sequence);
                let found = self.found.as_ref().and_then(|(.., found)| found.as_ref());
                let millis = pictures.millis_per_pixel(editor);
                ui.label(forecast(&settings, sequence, found, millis));
            }
        }
        let colors = palette(ui.ctx());
        let text = RichText::new("Export").color(colors.on_accent);
        let start = ui.add_enabled(sequence.is_ok(), Button::new(text).fill(colors.accent));
        if start.accessible_name("Start export").clicked()
            && let Ok(sequence) = sequence
        {
            self.found = None;
            match pictures.export(sequence.clone()) {
                Ok(id) => {
                    self.names.push((id, settings.describe(&editor.title())));
                    if let Some((path, video)) = settings.video(&sequence) {
                        self.videos.push(Following {
                            id,
                            sequence,
                            path,
                            video,
                            making: None,
                        });
                    }
                }
                Err(error) => editor.report_error(error.to_string()),
            }
        }
        self.settings = Some((document, settings));
    }

    /// Looks on a thread of its own what is in the folder already.
    fn look(&mut self, editor: &Editor, settings: &Settings, sequence: &Sequence) {
        if let Some(looking) = &self.looking {
            match looking.try_recv() {
                Err(TryRecvError::Empty) => return,
                Err(TryRecvError::Disconnected) => {}
                Ok(found) => {
                    if let Some((.., place)) = &mut self.found {
                        *place = Some(found);
                    }
                }
            }
            self.looking = None;
        }
        let state = (editor.revision(), self.told.len());
        let is_same =
            |(of, at, _): &(Settings, (u64, usize), Option<Found>)| of == settings && *at == state;
        if self.found.as_ref().is_some_and(is_same) {
            return;
        }
        self.found = Some((settings.clone(), state, None));
        let sequence = sequence.clone();
        self.looking = Some(run_in_background("glint-look", move || {
            // A folder that is not there has no frames; looking must not make it.
            let total = sequence.frames.count();
            if !sequence.folder.exists() {
                return Ok((total, 0, total));
            }
            let missing = sequence.missing().map_err(|error| error.to_string())?;
            let replaced = missing
                .iter()
                .filter(|frame| sequence.path(**frame).exists());
            Ok((missing.len(), replaced.count(), total))
        }));
    }

    fn show_list(&mut self, ui: &mut Ui, pictures: &Pictures) {
        let states = pictures.exports();
        self.thumbs
            .retain(|(id, ..)| states.iter().any(|state| state.id == *id));
        for state in &states {
            ui.separator();
            ui.horizontal(|ui| {
                self.show_thumb(ui, state);
                let name = self.names.iter().find(|(id, _)| *id == state.id);
                let name = name.map_or("", |(_, name)| name);
                ui.vertical(|ui| show_state(ui, (name, state), pictures));
            });
        }
    }

    fn show_thumb(&mut self, ui: &mut Ui, state: &ExportState) {
        if let Some(image) = &state.last {
            let at = state.done.written;
            let known = self.thumbs.iter_mut().find(|(id, ..)| *id == state.id);
            match known {
                Some((_, when, texture)) if *when != at => {
                    *when = at;
                    texture.set(whole(image), TextureOptions::LINEAR);
                }
                Some(_) => {}
                None => {
                    let picture = whole(image);
                    let texture =
                        ui.ctx()
                            .load_texture("exported", picture, TextureOptions::LINEAR);
                    self.thumbs.push((state.id, at, texture));
                }
            }
        }
        let thumb = self.thumbs.iter().find(|(id, ..)| *id == state.id);
        if let Some((.., texture)) = thumb {
            ui.add(Picture::new(texture).fit_to_exact_size(vec2(THUMB, THUMB)));
        }
    }
}

/// How long an export will still take; `None` before its first frame, and while it waits.
fn seconds_left(state: &ExportState) -> Option<f64> {
    let done = state.done.kept + state.done.written;
    let per_frame = state.busy.as_secs_f64() / state.done.written.max(1) as f64;
    let is_known = state.done.written > 0 && !state.is_paused;
    is_known.then_some((state.done.total - done) as f64 * per_frame)
}

/// How far an export is; what it waits for does not count as its time.
fn show_state(ui: &mut Ui, (name, state): (&str, &ExportState), pictures: &Pictures) {
    let done = state.done.kept + state.done.written;
    let share = done as f64 / state.done.total.max(1) as f64;
    let busy = state.busy.as_secs_f64();
    let rate = state.done.written as f64 / busy.max(1e-3);
    let text = match &state.ended {
        Some(Ok(())) => format!("{done} frames, {busy:.1} s"),
        Some(Err(_)) => format!("{done} of {}, failed", state.done.total),
        None if state.is_paused => format!("{done} of {}, paused", state.done.total),
        None => match seconds_left(state).map(in_words) {
            None => format!("{done} of {}", state.done.total),
            Some(left) => format!(
                "{done} of {} · {rate:.0} frames/s · {left} left",
                state.done.total
            ),
        },
    };
    ui.label(name)
        .on_hover_text(state.folder.display().to_string());
    ui.horizontal(|ui| {
        let bar = ProgressBar::new(share as f32).desired_width(FIELDS - 120.0);
        ui.add(bar.text(RichText::new(text).small().color(palette(ui.ctx()).text)));
        if state.ended.is_some() {
            if ui.button("Remove").clicked() {
                pictures.forget_export(state.id);
            }
            return;
        }
        let word = if state.is_paused { "Resume" } else { "Pause" };
        if ui.button(word).clicked() {
            pictures.pause_export(state.id, !state.is_paused);
        }
        let cancel = ui
            .button("Cancel")
            .on_hover_text("What is written stays; exporting again goes on from there");
        if cancel.clicked() {
            pictures.forget_export(state.id);
        }
    });
}
