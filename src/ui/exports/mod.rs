//! Export of the animation: the settings window, and the list of exports with their progress.

mod fields;

mod kept;

mod order;

mod video_maker;

mod forecast;

mod progress;

mod entry;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use egui::{Context, Grid, Rect, ScrollArea, Ui, Window};

use self::entry::Entry;
use self::fields::{Settings, fields, presets};
use self::forecast::Forecast;
pub use self::kept::KeptSettings;
use self::kept::SettingsOwner;
use self::order::{EXPORT_TOPIC, ExportOrder, UNSTORED_TOPIC};
use self::progress::seconds_left;
use super::interchange::check_meshes;
use super::pictures::Pictures;
use super::requests::UiRequests;
use super::status::time_in_words;
use super::theme::{GRID, palette};
use crate::editor::Editor;
use crate::export::Sequence;
use crate::scene::Scene;
use crate::ui::hint::Hinted as _;
use crate::ui::prompts::primary_button;

/// Space left free below the list of exports, in points.
const LIST_MARGIN: f32 = 2.0 * GRID;
/// Minimum height of the list, in points.
const MIN_LIST_HEIGHT: f32 = 120.0;

/// The settings shown in the open window.
struct ShownSettings {
    /// See [`Editor::documents`].
    document: u64,
    /// The revision of the scene that the settings were last matched to.
    revision: u64,
    owner: SettingsOwner,
    settings: Settings,
}

/// The export window and its exports.
#[derive(Default)]
pub struct Exports {
    /// Whether the window is shown.
    pub is_open: bool,
    /// Rectangle of the window on the screen while it is shown.
    pub window_rect: Option<Rect>,
    /// The program's data folder, if there is one.
    folder: Option<PathBuf>,
    /// The current settings while the window is open.
    shown: Option<ShownSettings>,
    kept: KeptSettings,
    /// The document shown when the window was last closed, and its settings. Kept apart from `kept` because the
    /// document may since have been saved under another name.
    last_closed: Option<(u64, Settings)>,
    /// The listed exports.
    entries: Vec<Entry>,
    /// Exports that ended without being finished.
    interrupted: Vec<ExportOrder>,
    /// Cached frame sequence, or why there is none, with the settings and the scene it was made from.
    sequence: Option<(Settings, Arc<Scene>, Result<Sequence, String>)>,
    /// Estimates for the current settings.
    forecast: Forecast,
    /// Number of exports that have ended so far.
    ended: usize,
}

impl Exports {
    /// Starts with the settings kept by the previous run, and lists the unfinished exports that ended programs left
    /// in the data folder.
    pub fn new(folder: Option<PathBuf>, kept: KeptSettings, editor: &mut Editor) -> Self {
        let interrupted = folder
            .as_deref()
            .map_or(Vec::new(), ExportOrder::unfinished_in);
        // Exports that failed have already reported it.
        let unreported = || interrupted.iter().filter(|order| order.failure.is_none());
        if let Some(order) = unreported().next() {
            let name = &order.name;
            editor.notify(match unreported().count() {
                1 => format!("An export is not finished: {name}. Export animation in the File menu resumes it."),
                count => format!("{count} exports are not finished, among them {name}. Export animation in the File menu resumes them."),
            });
        }
        Self {
            folder,
            kept,
            interrupted,
            ..Self::default()
        }
    }

    /// The settings of all documents that have a file, to be kept for the next run.
    pub fn kept_settings(&mut self) -> KeptSettings {
        if let Some(shown) = &self.shown {
            let (owner, settings) = (shown.owner.clone(), shown.settings.clone());
            self.kept.keep(owner, settings);
        }
        self.kept.named()
    }

    /// Sets the folder that the user chose in the dialog, and shows the window if it was closed meanwhile.
    pub fn choose_folder(&mut self, editor: &Editor, folder: &Path) {
        let folder = folder.display().to_string();
        if let Some(ShownSettings { settings, .. }) = &mut self.shown {
            settings.folder = folder;
        } else {
            let mut settings = self.settings(editor);
            settings.folder = folder;
            self.kept.keep(SettingsOwner::of(editor), settings);
            self.is_open = true;
        }
    }

    /// Updates the listed exports: reports those that have ended, and starts their videos.
    pub fn update(&mut self, editor: &mut Editor, pictures: &Pictures) {
        let (states, ended) = (pictures.worker().exports(), self.ended);
        for entry in &mut self.entries {
            let state = states.iter().find(|state| state.id == entry.id);
            let was_over = entry.is_over();
            if let Some(failed_order) = entry.update(state, editor) {
                // It is listed as interrupted, from where it can be resumed.
                pictures.worker().forget_export(entry.id);
                self.interrupted.push(failed_order);
            }
            self.ended += usize::from(entry.is_over() && !was_over);
        }
        if self.ended > ended && self.entries.iter().all(Entry::is_over) {
            editor.begin(UNSTORED_TOPIC);
        }
        let is_listed = |entry: &Entry| states.iter().any(|state| state.id == entry.id);
        self.entries
            .retain(|entry| is_listed(entry) || !entry.is_over());
    }

    /// Describes the running export in words; `None` if there is none.
    pub fn describe(&self, pictures: &Pictures) -> Option<String> {
        let states = pictures.worker().exports();
        let running = || states.iter().filter(|state| state.ended.is_none());
        // Prefer an export that is not paused.
        let active = running().find(|state| !state.is_paused);
        let Some(state) = active.or_else(|| running().next()) else {
            return self.entries.iter().find_map(Entry::describe_after_frames);
        };
        let done = state.done.so_far();
        let time_left = match seconds_left(state) {
            Some(seconds) => format!(" · {} left", time_in_words(seconds)),
            None if state.is_paused => " · paused".to_owned(),
            None => String::new(),
        };
        let more = match running().count() - 1 {
            0 => String::new(),
            more => format!(" · {more} more"),
        };
        Some(format!(
            "export {done}/{}{time_left}{more}",
            state.done.total
        ))
    }

    /// Returns whether any export or estimate is still in progress.
    pub fn is_busy(&self, pictures: &Pictures) -> bool {
        pictures.worker().is_exporting()
            || self.entries.iter().any(|entry| !entry.is_over())
            || self.forecast.is_busy()
    }

    /// Draws the window, if it is open.
    pub fn show(
        &mut self,
        ctx: &Context,
        editor: &mut Editor,
        pictures: &Pictures,
        out: &mut UiRequests,
    ) {
        let states = pictures.worker().exports();
        let is_paused = |entry: &Entry| {
            let mut states = states.iter();
            states.any(|state| state.id == entry.id && state.is_paused && state.ended.is_none())
        };
        let mut running = self.entries.iter().filter(|entry| !entry.is_over());
        if self.forecast.is_busy() || running.any(|entry| !is_paused(entry)) {
            ctx.request_repaint_after(Duration::from_millis(100));
        }
        let mut is_open = self.is_open;
        let shown = Window::new("Export animation")
            .open(&mut is_open)
            .collapsible(false)
            .resizable(false)
            .default_pos(egui::pos2(280.0, 60.0))
            .show(ctx, |ui| {
                self.show_settings(ui, editor, pictures, out);
                let list_height = ctx.content_rect().bottom() - ui.cursor().top() - LIST_MARGIN;
                let list_height = list_height.max(MIN_LIST_HEIGHT);
                let list = ScrollArea::vertical().max_height(list_height);
                // Otherwise the auto-sized window would give the list less height.
                let list = list.min_scrolled_height(list_height);
                list.show(ui, |ui| {
                    self.show_list(ui, editor, pictures);
                    self.show_interrupted(ui, editor, pictures);
                });
            });
        self.window_rect = shown.map(|shown| shown.response.rect);
        self.is_open = is_open && self.is_open;
        if !self.is_open
            && let Some(shown) = self.shown.take()
        {
            // The results of the estimate are no longer needed.
            (self.forecast, self.sequence) = (Forecast::default(), None);
            self.last_closed = Some((shown.document, shown.settings.clone()));
            self.kept.keep(shown.owner, shown.settings);
        }
    }

    /// Returns the stored settings of the open document, matched to the scene as it is now.
    fn settings(&self, editor: &Editor) -> Settings {
        let (fresh, owner) = (Settings::of(editor), SettingsOwner::of(editor));
        let last_closed = self.last_closed.as_ref();
        let last_closed = last_closed.filter(|(document, _)| *document == editor.documents());
        let kept = self.kept.of(&owner);
        match kept.or(last_closed.map(|(_, settings)| settings)) {
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
        let sequence = self.sequence(&settings, editor.scene());
        let is_being_written = sequence
            .as_ref()
            .is_ok_and(|sequence| self.is_being_written(&settings, sequence));
        let colors = palette(ui.ctx());
        self.forecast.update();
        match &sequence {
            Err(error) => {
                ui.colored_label(colors.error, error);
            }
            Ok(_) if is_being_written => {
                ui.label("These files are being written, see below");
            }
            Ok(sequence) => {
                let forecast = &mut self.forecast;
                forecast.examine_folder((&settings, sequence), editor, self.ended);
                forecast.measure((&settings, sequence), editor, pictures);
                ui.label(forecast.describe(&settings, sequence));
            }
        }
        let can_start = sequence.is_ok() && !is_being_written;
        let start = ui.add_enabled_ui(can_start, |ui| primary_button(ui, "Export"));
        let start = start.inner;
        if start.accessible_name("Start export").clicked()
            && let Ok(sequence) = sequence
        {
            let order = ExportOrder::new(settings.clone(), editor, self.folder.as_deref());
            self.queue(order, sequence, editor, pictures);
        }
        self.shown = Some(ShownSettings {
            document,
            revision,
            owner: SettingsOwner::of(editor),
            settings,
        });
    }

    /// Returns the frame sequence of the settings. It is cached, as making it anew in every UI frame is slow for
    /// large scenes.
    fn sequence(&mut self, settings: &Settings, scene: &Arc<Scene>) -> Result<Sequence, String> {
        let cached = self.sequence.take();
        let cached = cached.filter(|(of, from, _)| of == settings && Arc::ptr_eq(from, scene));
        let (.., sequence) = self.sequence.insert(cached.unwrap_or_else(|| {
            let made = check_meshes(scene)
                .and_then(|()| settings.sequence(scene).map_err(|error| error.to_string()));
            (settings.clone(), Arc::clone(scene), made)
        }));
        sequence.clone()
    }

    /// Returns whether a listed export writes the same files: the two would overwrite each other's.
    fn is_being_written(&self, settings: &Settings, sequence: &Sequence) -> bool {
        let video = settings.video(sequence).map(|(path, _)| path);
        let mut entries = self.entries.iter();
        entries.any(|entry| entry.conflicts_with(sequence, video.as_deref()))
    }

    /// Queues an export.
    fn queue(
        &mut self,
        order: ExportOrder,
        sequence: Sequence,
        editor: &mut Editor,
        pictures: &Pictures,
    ) {
        self.forecast.forget_folder();
        editor.begin(EXPORT_TOPIC);
        match pictures.worker().export(sequence.clone()) {
            Ok(id) => {
                let replaced = self.entries.iter();
                // Their files may be replaced by the new export.
                let replaced =
                    replaced.filter(|entry| entry.is_over() && entry.writes_files_of(&sequence));
                replaced.for_each(|entry| pictures.worker().forget_export(entry.id));
                self.entries.push(Entry::new(id, order, sequence));
            }
            Err(error) => {
                // Listed as interrupted, as a missing folder may reappear later.
                let failure = error.to_string();
                editor.report_error_in(EXPORT_TOPIC, failure.clone());
                self.interrupted.push(order.failed(failure));
            }
        }
    }

    fn show_list(&mut self, ui: &mut Ui, editor: &mut Editor, pictures: &Pictures) {
        let states = pictures.worker().exports();
        for entry in &mut self.entries {
            if let Some(state) = states.iter().find(|state| state.id == entry.id) {
                ui.separator();
                entry.show(ui, state, pictures, editor);
            }
        }
    }

    /// Lists the exports that ended without being finished.
    fn show_interrupted(&mut self, ui: &mut Ui, editor: &mut Editor, pictures: &Pictures) {
        let mut resumed = None;
        let mut removed = None;
        for (index, order) in self.interrupted.iter().enumerate() {
            ui.separator();
            ui.label(&order.name).hint(&order.settings.folder);
            match &order.failure {
                Some(failure) => ui.colored_label(palette(ui.ctx()).error, failure),
                None => ui.weak("Not finished"),
            };
            ui.horizontal(|ui| {
                let resume = ui
                    .button("Resume")
                    .hint("Uses the scene as it was then; finished frames are kept");
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
                Ok(sequence) if self.is_being_written(&order.settings, &sequence) => {
                    editor.notify("Another export is writing these files: wait for it".to_owned());
                    self.interrupted.push(order);
                }
                Ok(sequence) => self.queue(order, sequence, editor, pictures),
                Err(error) => {
                    editor.report_error_in(EXPORT_TOPIC, format!("{}: {error}", order.name));
                    self.interrupted.insert(index, order);
                }
            }
        } else if let Some(index) = removed {
            self.interrupted.remove(index).end();
            if self.interrupted.iter().all(|order| order.failure.is_none()) {
                // No failed export is left: clear the error messages.
                editor.begin(EXPORT_TOPIC);
            }
        }
    }
}
