//! Exporting the animation: what, where to and how, and how far the exports are.

mod fields;

mod kept;

mod order;

mod following;

mod progress;

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, TryRecvError};
use std::time::Duration;

use egui::{
    Button, Context, Grid, Image as Picture, RichText, TextureHandle, TextureOptions, Ui, Window,
    vec2,
};

use self::fields::{Found, Settings, fields, forecast, presets};
use self::following::Following;
pub use self::kept::KeptSettings;
use self::kept::Owner;
use self::order::Order;
use self::progress::{seconds_left, show_state};
use super::pictures::Pictures;
use super::requests::UiRequests;
use super::status::in_words;
use super::theme::{GRID, THUMB, palette};
use super::upload::whole;
use crate::editor::Editor;
use crate::export::Sequence;
use crate::ui::hint::Hint as _;
use crate::worker::{ExportState, run_in_background};

/// What messages about exports are about.
const EXPORT: &str = "export";

/// Settings on the screen.
struct Shown {
    /// See [`Editor::documents`].
    document: u64,
    /// The scene that the settings know.
    revision: u64,
    owner: Owner,
    settings: Settings,
}

/// The window and its exports.
#[derive(Default)]
pub struct Exports {
    /// Whether the window is shown.
    pub is_open: bool,
    /// The folder of the program's data, if there is one.
    folder: Option<PathBuf>,
    /// What is asked for.
    shown: Option<Shown>,
    kept: KeptSettings,
    /// What each export was ordered with.
    orders: Vec<(u64, Order)>,
    /// What ended without being finished.
    interrupted: Vec<Order>,
    /// What was found in the folder, for these settings, this state of the scene, and so many exports
    /// that have ended.
    found: Option<(Settings, (u64, usize), Option<Found>)>,
    looking: Option<Receiver<Found>>,
    /// Videos that follow their frames.
    videos: Vec<Following>,
    thumbs: Vec<(u64, usize, TextureHandle)>,
    /// Exports whose end was told.
    told: Vec<u64>,
    /// What those are called.
    ended: Vec<(u64, String)>,
}

impl Exports {
    /// With what was asked for before, and what programs that have ended left in the folder of the program's
    /// data.
    pub fn new(folder: Option<PathBuf>, kept: KeptSettings, editor: &mut Editor) -> Self {
        let interrupted = folder.as_deref().map_or(Vec::new(), Order::left_in);
        if let Some(order) = interrupted.first() {
            let more = match interrupted.len() {
                1 => String::new(),
                more => format!(" and {} more", more - 1),
            };
            editor.notify(format!(
                "An export was interrupted: {}{more}. Export animation in the File menu resumes it.",
                order.name
            ));
        }
        Self {
            folder,
            kept,
            interrupted,
            ..Self::default()
        }
    }

    /// The settings of all documents with a file, for the next run.
    pub fn kept_settings(&mut self) -> KeptSettings {
        if let Some(shown) = &self.shown {
            let (owner, settings) = (shown.owner.clone(), shown.settings.clone());
            self.kept.keep(owner, settings);
        }
        self.kept.named()
    }

    /// The folder that was chosen.
    pub fn choose_folder(&mut self, folder: &Path) {
        if let Some(Shown { settings, .. }) = &mut self.shown {
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
                Err(error) => editor.report_error_in(EXPORT, format!(
                    "{error}; what is done stays, and Resume in the window of exports goes on from there"
                )),
            }
            let is_done = ended.is_ok();
            let ordered = self.orders.iter().position(|(id, _)| *id == state.id);
            if let Some((_, order)) = ordered.map(|at| self.orders.remove(at)) {
                self.ended.push((state.id, order.name.clone()));
                let video = self.videos.iter_mut().find(|video| video.id == state.id);
                match video {
                    _ if !is_done => self.interrupted.push(order),
                    // It has not ended before its video is there.
                    Some(video) => video.order = Some(order),
                    None => order.end(),
                }
            }
            self.videos.retain(|video| is_done || video.id != state.id);
            let mut videos = self.videos.iter_mut();
            if let Some(video) = videos.find(|video| video.id == state.id) {
                video.make();
            }
        }
        // One whose export was given up is not made either.
        let states = pictures.exports();
        let is_wanted = |video: &Following| states.iter().any(|state| state.id == video.id);
        self.videos
            .retain(|video| video.is_making() || is_wanted(video));
        let interrupted = &mut self.interrupted;
        self.videos.retain_mut(|video| {
            let Some(made) = video.made() else {
                return true;
            };
            let order = video.order.take();
            match made {
                Ok(()) => {
                    editor.notify(format!("Saved {}", video.path.display()));
                    order.into_iter().for_each(Order::end);
                }
                Err(error) => {
                    editor.report_error_in(EXPORT, error);
                    interrupted.extend(order);
                }
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
                self.show_interrupted(ui, editor, pictures);
            });
        self.is_open = is_open && self.is_open;
        if !self.is_open
            && let Some(shown) = self.shown.take()
        {
            self.kept.keep(shown.owner, shown.settings);
        }
    }

    /// The settings that were put away, for the scene as it is now.
    fn settings(&self, editor: &Editor) -> Settings {
        let (fresh, owner) = (Settings::of(editor), Owner::of(editor));
        match self.kept.of(&owner) {
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
        let (document, revision) = (editor.documents(), editor.revision());
        let mut settings = match self.shown.take() {
            Some(shown) if (shown.document, shown.revision) == (document, revision) => {
                shown.settings
            }
            Some(shown) if shown.document == document => {
                shown.settings.for_scene(Settings::of(editor))
            }
            Some(other) => {
                self.kept.keep(other.owner, other.settings);
                self.settings(editor)
            }
            None => self.settings(editor),
        };
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
            let order = Order::new(settings.clone(), editor, self.folder.as_deref());
            self.begin(order, sequence, editor, pictures);
        }
        self.shown = Some(Shown {
            document,
            revision,
            owner: Owner::of(editor),
            settings,
        });
    }

    /// Puts an order into the queue.
    fn begin(
        &mut self,
        order: Order,
        sequence: Sequence,
        editor: &mut Editor,
        pictures: &Pictures,
    ) {
        self.found = None;
        editor.begin(EXPORT);
        match pictures.export(sequence.clone()) {
            Ok(id) => {
                if let Some((path, video)) = order.settings.video(&sequence) {
                    let following = Following::new(id, sequence, path, video);
                    self.videos.push(following);
                }
                self.orders.push((id, order));
            }
            Err(error) => {
                // A folder that is not there now may be there later.
                self.interrupted.push(order);
                editor.report_error_in(EXPORT, error.to_string());
            }
        }
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
        let mut given_up = None;
        let is_listed = |id: u64| states.iter().any(|state| state.id == id);
        self.thumbs.retain(|(id, ..)| is_listed(*id));
        self.ended.retain(|(id, _)| is_listed(*id));
        for state in &states {
            ui.separator();
            ui.horizontal(|ui| {
                self.show_thumb(ui, state);
                let going = self.orders.iter().find(|(id, _)| *id == state.id);
                let ended = self.ended.iter().find(|(id, _)| *id == state.id);
                let name = going.map(|(_, order)| &order.name);
                let name = name.or(ended.map(|(_, name)| name));
                let name = name.map_or("", |name| name);
                let is_given_up = ui
                    .vertical(|ui| show_state(ui, (name, state), pictures))
                    .inner;
                if is_given_up {
                    given_up = Some(state.id);
                }
            });
        }
        let at = |id| self.orders.iter().position(|(of, _)| *of == id);
        if let Some(at) = given_up.and_then(at) {
            self.orders.remove(at).1.end();
        }
    }

    /// What ended without being finished.
    fn show_interrupted(&mut self, ui: &mut Ui, editor: &mut Editor, pictures: &Pictures) {
        let mut resumed = None;
        let mut removed = None;
        for (index, order) in self.interrupted.iter().enumerate() {
            ui.separator();
            ui.label(&order.name).hint(&order.settings.folder);
            ui.horizontal(|ui| {
                ui.weak("Interrupted");
                let resume = ui
                    .button("Resume")
                    .hint("With the scene as it was then; what is done stays");
                if resume.clicked() {
                    resumed = Some(index);
                }
                if ui.button("Remove").clicked() {
                    removed = Some(index);
                }
            });
        }
        if let Some(index) = resumed {
            let order = self.interrupted.remove(index);
            match order.sequence() {
                Ok(sequence) => self.begin(order, sequence, editor, pictures),
                Err(error) => {
                    editor.report_error_in(EXPORT, format!("{}: {error}", order.name));
                    self.interrupted.insert(index, order);
                }
            }
        } else if let Some(index) = removed {
            self.interrupted.remove(index).end();
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
