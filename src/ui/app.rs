//! The window's frame: reads input, shows the panels, applies what they asked for, and hands the
//! scene to the render thread.

use egui::{
    Context, DragAndDrop, Event, Memory, Popup, SurrenderFocusOn, Theme, Ui, ViewportCommand,
};
use serde::de::DeserializeOwned;

use super::autosave::Autosave;
use super::commands::{Command, Next, is_about_files, pressed, works_during_popups};
use super::examples::Examples;
use super::exports::Exports;
use super::file_requests::FileOutcome;
use super::files::Files;
use super::finder::Finder;
use super::flying::Flying;
use super::histogram::Levels;
use super::inspector::Quality;
use super::lab::Lab;
use super::layout::{Layout, keep_readable};
use super::number::{DragStep, drag_step, take_refusal};
use super::outliner::Outliner;
use super::pictures::Pictures;
use super::requests::UiRequests;
use super::scene_check::SceneCheck;
use super::screenshot::Screenshot;
use super::setup::Setup;
use super::start::StartWatch;
use super::step_size::StepSize;
use super::still::Still;
use super::timeline::{Overlay, Thumbs, TimelinePanel, advance_playback, pause_for_typing};
use super::toasts::Toasts;
use super::tools::{Screen, Tools};
use super::why::Why;
use super::{help, theme};
use crate::editor::{Action, Editor, Mode};
use crate::image::Image;
use crate::scene::{Aspect, Scene};
use crate::worker::{Answer, RenderThreadError};

/// Message shown while saving a picture keeps the window open.
const CLOSING: &str = "Glint closes once the picture is saved; Cancel discards the picture";
/// Storage key of the list of recent files.
const RECENT_KEY: &str = "recent files";
/// Storage key of the layout: which panels are shown.
const LAYOUT_KEY: &str = "layout";
/// Storage key of the folders in which paths were chosen.
const FOLDERS_KEY: &str = "folders";
/// Storage key of the export settings.
const EXPORTS_KEY: &str = "exports";
/// Storage key of the theme.
const THEME_KEY: &str = "theme";

/// The window.
pub struct App {
    pub(super) editor: Editor,
    pub(super) pictures: Pictures,
    pub(super) files: Files,
    pub(super) outliner: Outliner,
    pub(super) lab: Lab,
    pub(super) quality: Quality,
    pub(super) timeline: TimelinePanel,
    pub(super) exports: Exports,
    pub(super) overlay: Overlay,
    pub(super) tools: Tools,
    pub(super) thumbs: Thumbs,
    pub(super) toasts: Toasts,
    pub(super) flying: Flying,
    pub(super) layout: Layout,
    pub(super) shortcuts_open: bool,
    pub(super) finder: Finder,
    pub(super) why: Why,
    pub(super) examples: Examples,
    pub(super) check: SceneCheck,
    pub(super) still: Still,
    step_size: StepSize,
    pub(super) levels: Levels,
    pub(super) keys_are_taken: bool,
    /// Commands that run in the next frame.
    pub(super) deferred: Vec<Command>,
    /// Answers of the render thread that wait until nothing is dragged.
    pub(super) answers: Vec<Answer>,
    /// Number of the document that was shown last, see [`Editor::documents`].
    pub(super) shown_document: u64,
    /// Revision at which the user agreed to close the window.
    pub(super) closing: Option<u64>,
    /// Text copied last, and the part of the scene that it describes.
    pub(super) copied: Option<(String, Scene)>,
    /// Time at which Escape was last pressed with nothing to leave, in seconds.
    pub(super) last_idle_escape: Option<f64>,
    pub(super) title: String,
    pub(super) theme: Theme,
    pub(super) autosave: Autosave,
    pub(super) screenshot: Option<Screenshot>,
    pub(super) start: Option<StartWatch>,
}

/// Returns the value that the window stored under this name when it was last closed.
fn load_setting<T: DeserializeOwned>(cc: &eframe::CreationContext<'_>, name: &str) -> Option<T> {
    eframe::get_value(cc.storage?, name)
}

impl App {
    /// Sets the window up: fonts, theme, render thread, and the document.
    ///
    /// # Errors
    /// [`RenderThreadError`] when the system starts no threads.
    pub fn new(cc: &eframe::CreationContext<'_>, setup: Setup) -> Result<Self, RenderThreadError> {
        let chosen = load_setting(cc, THEME_KEY);
        theme::install(&cc.egui_ctx, chosen.unwrap_or(Theme::Dark));
        cc.egui_ctx.options_mut(|options| {
            options.quit_shortcuts.clear();
            options.zoom_with_keyboard = true;
            // Commit typed text before the click that ends editing has an effect of its own.
            options.input_options.surrender_focus_on = SurrenderFocusOn::Presses;
        });
        let recent = load_setting(cc, RECENT_KEY).unwrap_or_default();
        let folders = load_setting(cc, FOLDERS_KEY).unwrap_or_default();
        let mut app = Self {
            editor: Editor::demo(),
            pictures: Pictures::new(&cc.egui_ctx)?,
            files: Files::new(setup.dialogs, recent, folders),
            outliner: Outliner::default(),
            lab: Lab::new(setup.data_folder.as_ref().map(|folder| folder.join("lab"))),
            quality: Quality::default(),
            timeline: TimelinePanel::default(),
            exports: Exports::default(),
            overlay: Overlay::default(),
            tools: Tools::default(),
            thumbs: Thumbs::default(),
            toasts: Toasts::default(),
            flying: Flying::default(),
            layout: load_setting(cc, LAYOUT_KEY).unwrap_or_default(),
            shortcuts_open: false,
            finder: Finder::default(),
            why: Why::default(),
            examples: Examples::default(),
            check: SceneCheck::default(),
            still: Still::default(),
            step_size: StepSize::default(),
            levels: Levels::default(),
            keys_are_taken: false,
            deferred: Vec::new(),
            answers: Vec::new(),
            shown_document: 0,
            closing: None,
            copied: None,
            last_idle_escape: None,
            title: String::new(),
            theme: cc.egui_ctx.theme(),
            autosave: Autosave::default(),
            screenshot: setup.screenshot,
            start: setup.start,
        };
        let folder = setup.data_folder.clone();
        let exports = load_setting(cc, EXPORTS_KEY).unwrap_or_default();
        app.exports = Exports::new(folder, exports, &mut app.editor);
        app.exports.is_open = setup.exports;
        if let Some(path) = setup.scene {
            app.files.open_now(&mut app.editor, &path);
        }
        app.editor.select_named(&setup.select);
        app.autosave = Autosave::start(setup.data_folder.as_deref(), &mut app.editor);
        Ok(app)
    }

    /// The document.
    pub fn editor(&self) -> &Editor {
        &self.editor
    }

    /// Whether the picture on screen is finished and shows the newest scene.
    pub fn is_settled(&self) -> bool {
        self.pictures.is_settled(&self.editor)
            && self.editor.wanted_survey().is_none()
            && self.files.reading().is_none()
    }

    /// Whether a question or the finder is open over the window.
    pub fn is_asking(&self) -> bool {
        self.files.is_asking() || self.finder.is_open
    }

    /// Whether frames are being exported, or a video is being made of them.
    pub fn is_exporting(&self) -> bool {
        self.exports.is_busy(&self.pictures)
    }

    /// Whether something is being dragged or flown.
    pub(super) fn is_gesture(&self, ctx: &Context) -> bool {
        ctx.input(|input| input.pointer.any_down()) || self.flying.is_gesture(ctx)
    }

    /// The picture on screen.
    pub fn shown_picture(&self) -> Option<&Image> {
        self.pictures.shown(&self.editor).map(|frame| &*frame.image)
    }

    /// Returns the commands whose keys were pressed, as far as keys are free for them.
    fn take_commands(&mut self, ui: &Ui, keys_are_free: bool) -> Vec<Command> {
        let mut commands = std::mem::take(&mut self.deferred);
        if keys_are_free {
            commands.extend(pressed(ui, self.flying.is_flying(), |_| true));
        } else if Popup::is_any_open(ui)
            && !(ui.text_edit_focused() || self.is_asking())
            && !ui.input(|input| input.pointer.any_down())
        {
            // Popups such as the color picker and the list of hints stay open meanwhile.
            commands.extend(pressed(ui, false, works_during_popups));
        } else if ui.text_edit_focused() && !self.files.is_asking() {
            let about_files = pressed(ui, false, is_about_files);
            if !about_files.is_empty() {
                self.commit_text_before(ui, about_files);
            }
        }
        commands
    }

    /// Ends typing, so that the text is committed, and runs `commands` in the next frame.
    pub(super) fn commit_text_before(&mut self, ctx: &Context, commands: Vec<Command>) {
        self.deferred.extend(commands);
        ctx.memory_mut(Memory::stop_text_input);
        ctx.request_repaint();
    }

    pub(super) fn act_on(&mut self, ctx: &Context, outcome: Option<FileOutcome>) {
        match outcome {
            None => {}
            Some(FileOutcome::AskToQuit) if self.exports.describe(&self.pictures).is_some() => {
                self.files.ask_to_quit(&mut self.editor);
            }
            Some(FileOutcome::AskToQuit | FileOutcome::Quit) => {
                self.closing = Some(self.editor.revision());
                if self.pictures.worker().is_saving() {
                    self.editor.notify(CLOSING.to_owned());
                }
                ctx.request_repaint();
            }
            Some(FileOutcome::ExportFolder(path)) => {
                self.exports.choose_folder(&self.editor, &path);
            }
            Some(FileOutcome::SaveImage(path)) => {
                self.lab.leave();
                self.editor.apply(Action::Show(Mode::HighRes));
                self.pictures.request_still(&self.editor, Some(path));
            }
        }
    }

    /// Closes the window once nothing is being written any more. An edit in the meantime keeps it open.
    fn close_if_requested(&mut self, ctx: &Context) {
        match self.closing {
            Some(revision) if revision != self.editor.revision() => self.closing = None,
            Some(_) if !self.pictures.worker().is_saving() => {
                ctx.send_viewport_cmd(ViewportCommand::Close);
            }
            _ => {}
        }
    }

    fn show_title(&mut self, ctx: &Context) {
        let dot = if self.editor.is_dirty() { " ●" } else { "" };
        let title = format!("Glint — {}{dot}", self.editor.title());
        if title != self.title {
            ctx.send_viewport_cmd(ViewportCommand::Title(title.clone()));
            self.title = title;
        }
    }
}

impl eframe::App for App {
    /// Panels may leave gaps of a pixel when the window is scaled.
    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        visuals.panel_fill.to_normalized_gamma_f32()
    }

    fn logic(&mut self, ctx: &Context, _frame: &mut eframe::Frame) {
        if self.pictures.poll(ctx, &mut self.editor) {
            // Keep the window open, so that the error can be read.
            self.closing = None;
        }
        let is_measuring = self.pictures.worker().is_measuring();
        self.lab
            .update(is_measuring, self.pictures.worker().take_study());
        let mut thumbnails = self.pictures.worker().take_thumbnails();
        self.examples.take(ctx, &mut thumbnails);
        self.thumbs.take(ctx, thumbnails);
        let jobs = self.examples.thumbnail_jobs(ctx.pixels_per_point());
        if !jobs.is_empty() {
            self.pictures.worker().request_thumbnails(jobs);
        }
        self.take_answers(ctx);
        self.exports.update(&mut self.editor, &self.pictures);
        if !self.finder.is_open {
            pause_for_typing(ctx, &mut self.editor);
        }
        advance_playback(ctx, &mut self.editor);
        self.close_if_requested(ctx);
        let outcome = self.files.poll(ctx, &mut self.editor);
        self.act_on(ctx, outcome);
        self.take_dropped(ctx);
        let is_closing = ctx.input(|input| input.viewport().close_requested());
        if is_closing && self.closing.is_some() && self.pictures.worker().is_saving() {
            // A second request to close must not abort the save that the first one waits for.
            ctx.send_viewport_cmd(ViewportCommand::CancelClose);
            self.editor.notify(CLOSING.to_owned());
        } else if is_closing && self.closing.is_none() {
            ctx.send_viewport_cmd(ViewportCommand::CancelClose);
            self.leave_to(ctx, Next::Quit);
        }
        self.follow_document();
        self.autosave.tick(ctx, &mut self.editor);
        let is_busy = self.is_gesture(ctx);
        self.check.update(&self.editor, is_busy);
        if let Some(frame) = self.pictures.shown(&self.editor).filter(|_| !is_busy)
            && let Some(clipped) = self.levels.update(frame, self.editor.shown())
            && self.layout.aspect == Aspect::All
        {
            self.check.take_clipped(clipped);
        }
        self.theme = ctx.theme();
        self.show_title(ctx);
    }

    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        keep_readable(ui);
        self.step_size.update(ui.ctx(), self.editor.scene());
        // Whether a text field has the keys. `keys_are_taken` is from the end of the last frame: by now Escape may have
        // taken the focus off a field or closed a menu.
        let was_typing = ui.text_edit_focused();
        let keys_are_free = !self.keys_are_taken && !was_typing;
        // A recorded flight stays as it was flown.
        let is_recording = self.editor.timeline().recorded().is_some();
        let cancels_look = !is_recording && self.flying.cancels_look(ui);
        let commands = self.take_commands(ui, keys_are_free);
        let takes_back = !is_recording && self.flying.is_sinking() && !commands.is_empty();
        let mut out = UiRequests {
            actions: (cancels_look || takes_back)
                .then_some(Action::CancelGesture)
                .into_iter()
                .collect(),
            commands,
            ..UiRequests::default()
        };
        let picture = self.show_panels(ui, &mut out);
        let ctx = ui.ctx().clone();
        if let Some(words) = take_refusal(&ctx) {
            self.editor.notify(words);
        }
        match drag_step(&ctx) {
            // A value typed before is its own undo step, even if the press that ended typing also starts this drag.
            Some(DragStep::Begins) => out.actions.insert(0, Action::BeginGesture),
            Some(DragStep::Cancelled) => out.actions.push(Action::CancelGesture),
            Some(DragStep::Continues) | None => {}
        }
        self.exports
            .show(&ctx, &mut self.editor, &self.pictures, &mut out);
        if self.files.is_asking() {
            // Its text field would take the keys of the question.
            self.finder.is_open = false;
        }
        self.finder
            .show(&ctx, &self.editor, &self.files.recent, &mut out);
        // Still pictures cannot be flown through: moving the camera would discard them.
        let (place, flight_area) = picture;
        let is_still = self.editor.mode == Mode::HighRes || self.lab.is_looking();
        let screen = Screen::new(&self.editor.shown().camera, place.rect);
        let explained = (&self.editor, self.layout.aspect);
        self.why
            .show(&ctx, explained, |point| screen.as_ref()?.place(point));
        if let Some(screen) = screen.filter(|_| !is_still) {
            self.why
                .mark(&ui.painter().with_clip_rect(place.rect), |point| {
                    screen.place(point)
                });
        }
        let flight_area = Some(&flight_area).filter(|_| !is_still && !self.tools.is_dragging());
        // Space presses the focused button and must not move the camera up as well.
        let is_free = ui.memory(|memory| memory.focused().is_none());
        let can_fly = keys_are_free && is_free && !self.outliner.has_keys(ui);
        let speed = (&**self.editor.scene(), self.layout.fly_speed);
        let motion = self.flying.step(ui, flight_area, can_fly, speed);
        if self.flying.begins_looking() {
            out.actions.push(Action::BeginGesture);
        }
        out.actions.extend(motion.map(Action::Fly));
        let questions = std::mem::take(&mut out.questions);
        self.carry_out(&ctx, out, was_typing);
        let asked = self.files.is_asking().then_some(&self.exports);
        let running = asked.and_then(|exports| exports.describe(&self.pictures));
        let outcome = self.files.show(ui, &mut self.editor, running.as_deref());
        self.act_on(&ctx, outcome);
        help::show(&ctx, &mut self.shortcuts_open);
        if !self.is_gesture(&ctx) {
            self.editor.end_gesture();
        }
        self.keys_are_taken = ui.text_edit_focused()
            || Popup::is_any_open(&ctx)
            || self.files.is_asking()
            || self.finder.is_open
            || drag_step(&ctx).is_some()
            // A drag payload refers to its item by its index in a list, which commands may change.
            || DragAndDrop::has_any_payload(&ctx)
            || self.tools.is_dragging()
            || self.still.is_marking()
            || self.timeline.is_dragging()
            || self.overlay.is_dragging(&ctx);
        let messages = std::mem::take(&mut self.editor.messages);
        self.toasts.push(&ctx, messages);
        self.toasts.show(&ctx, place.rect, self.exports.window_rect);
        self.pictures
            .submit(&self.editor, place.pixels, self.layout.aspect);
        if let Some(jobs) = self.thumbs.jobs(&ctx, &self.editor, place.rect) {
            self.pictures.worker().request_thumbnails(jobs);
        }
        // Asked after the live view was submitted: a question would keep it waiting.
        self.pictures.ask(&self.editor, questions);
        let is_settled = self.is_settled();
        let screenshot = self.screenshot.as_mut();
        let is_taken = screenshot.is_some_and(|screenshot| screenshot.tick(&ctx, is_settled));
        let has_picture = self.pictures.shown(&self.editor).is_some();
        let start = self.start.as_mut();
        let is_timed = start.is_some_and(|start| start.tick(&ctx, has_picture));
        if is_taken || is_timed {
            self.closing = Some(self.editor.revision());
        }
    }

    /// Ignores pointer movement during a screenshot, which must not show where the pointer happens to be.
    fn raw_input_hook(&mut self, _ctx: &Context, input: &mut egui::RawInput) {
        if self.screenshot.is_some() {
            let is_pointer = |event: &Event| matches!(event, Event::PointerMoved(_));
            input.events.retain(|event| !is_pointer(event));
        }
    }

    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        eframe::set_value(storage, RECENT_KEY, &self.files.recent);
        eframe::set_value(storage, THEME_KEY, &self.theme);
        eframe::set_value(storage, LAYOUT_KEY, &self.layout);
        eframe::set_value(storage, FOLDERS_KEY, &self.files.folders);
        eframe::set_value(storage, EXPORTS_KEY, &self.exports.kept_settings());
    }

    fn on_exit(&mut self, _gl: Option<&eframe::glow::Context>) {
        self.autosave.end();
    }
}
