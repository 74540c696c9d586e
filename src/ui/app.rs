//! The window's frame: reads input, shows the panels, applies what they asked for, and hands the
//! scene to the render thread.

use egui::{CentralPanel, Context, Frame, Margin, Panel, Theme, Ui, ViewportCommand};

use super::autosave::Autosave;
use super::commands::{Command, is_about_files, pressed};
use super::exports::Exports;
use super::files::{FileOutcome, Files, Next};
use super::flying::Flying;
use super::lab::Lab;
use super::menu::Layout;
use super::outliner::Outliner;
use super::pictures::Pictures;
use super::reading::Reading;
use super::requests::UiRequests;
use super::screenshot::Screenshot;
use super::setup::Setup;
use super::theme::{GRID, INSPECTOR, LAB, OUTLINER, ROW, TIMELINE, palette};
use super::timeline::{Overlay, Thumbs, TimelinePanel};
use super::toasts::Toasts;
use super::viewport::{Place, describe, fit};
use super::{help, inspector, menu, status, theme};
use crate::editor::{Action, Editor, Mode, Time};
use crate::image::Image;
use crate::mesh::is_mesh_file;
use crate::worker::{Answer, RenderThreadError};

/// Where the list of recent files is kept between runs.
const RECENT_KEY: &str = "recent files";
/// Where the choice of the theme is kept between runs.
const THEME_KEY: &str = "theme";

/// The window.
pub struct App {
    pub(super) editor: Editor,
    pub(super) pictures: Pictures,
    pub(super) files: Files,
    pub(super) outliner: Outliner,
    pub(super) lab: Lab,
    pub(super) timeline: TimelinePanel,
    pub(super) exports: Exports,
    pub(super) overlay: Overlay,
    pub(super) thumbs: Thumbs,
    pub(super) toasts: Toasts,
    pub(super) flying: Flying,
    pub(super) layout: Layout,
    pub(super) shortcuts_open: bool,
    pub(super) keys_are_taken: bool,
    /// Commands for the next frame.
    pub(super) deferred: Vec<Command>,
    /// The revision at which the user said that the window may close.
    pub(super) closing: Option<u64>,
    pub(super) title: String,
    pub(super) theme: Theme,
    pub(super) autosave: Autosave,
    pub(super) screenshot: Option<Screenshot>,
}

impl App {
    /// Sets the window up: fonts, theme, render thread, and the document.
    ///
    /// # Errors
    /// [`RenderThreadError`] when the system starts no threads.
    pub fn new(cc: &eframe::CreationContext<'_>, setup: Setup) -> Result<Self, RenderThreadError> {
        let chosen = cc
            .storage
            .and_then(|storage| eframe::get_value(storage, THEME_KEY));
        theme::install(&cc.egui_ctx, chosen.unwrap_or(Theme::Dark));
        cc.egui_ctx.options_mut(|options| {
            options.quit_shortcuts.clear();
            options.zoom_with_keyboard = true;
        });
        let recent = cc
            .storage
            .and_then(|storage| eframe::get_value(storage, RECENT_KEY));
        let mut app = Self {
            editor: Editor::demo(),
            pictures: Pictures::new(&cc.egui_ctx)?,
            files: Files::new(setup.dialogs, recent.unwrap_or_default()),
            outliner: Outliner::default(),
            lab: Lab::default(),
            timeline: TimelinePanel::default(),
            exports: Exports::default(),
            overlay: Overlay::default(),
            thumbs: Thumbs::default(),
            toasts: Toasts::default(),
            flying: Flying::default(),
            layout: Layout {
                outliner: true,
                inspector: true,
                flight: true,
                shot: true,
                actual_size: false,
            },
            shortcuts_open: false,
            keys_are_taken: false,
            deferred: Vec::new(),
            closing: None,
            title: String::new(),
            theme: cc.egui_ctx.theme(),
            autosave: Autosave::default(),
            screenshot: setup.screenshot,
        };
        app.exports.is_open = setup.exports;
        if let Some(path) = setup.scene {
            app.files.open_now(&mut app.editor, &path);
        }
        app.autosave = Autosave::start(setup.data_folder.as_deref(), &mut app.editor);
        Ok(app)
    }

    /// The document.
    pub fn editor(&self) -> &Editor {
        &self.editor
    }

    /// Whether the picture on screen is the finished one of the newest scene.
    pub fn is_settled(&self) -> bool {
        self.pictures.is_settled(&self.editor)
            && self.editor.wanted_survey().is_none()
            && self.files.reading().is_none()
    }

    /// Whether frames are being exported, or a video of them made.
    pub fn is_exporting(&self) -> bool {
        self.exports.is_busy(&self.pictures)
    }

    /// The picture on screen.
    pub fn shown_picture(&self) -> Option<&Image> {
        self.pictures.shown(&self.editor).map(|frame| &*frame.image)
    }

    fn show_panels(
        &mut self,
        ui: &mut Ui,
        out: &mut UiRequests,
    ) -> Option<(Place, egui::Response)> {
        let side = Frame::side_top_panel(ui.style()).inner_margin(Margin::symmetric(GRID as i8, 0));
        Panel::top("menu").show(ui, |ui| {
            menu::show(ui, &self.editor, &self.files.recent, &mut self.layout, out);
        });
        Panel::bottom("status").exact_size(ROW).show(ui, |ui| {
            let frame = self.pictures.shown(&self.editor);
            let live = frame.map_or(String::new(), |frame| describe(frame, self.editor.shown()));
            let text = self.lab.describe().unwrap_or(live);
            let kept = self.autosave.kept_since();
            let reading = self.files.reading().map(Reading::describe);
            let note = reading.or_else(|| self.exports.describe(&self.pictures));
            let note = note.or_else(|| kept.map(status::autosaved));
            status::show(ui, &text, &self.pictures.activity(), note, out);
        });
        if self.lab.is_open {
            let panel = Panel::bottom("lab").frame(side).resizable(true);
            let shown = panel
                .default_size(LAB)
                .size_range(160.0..=600.0)
                .show(ui, |ui| self.lab.show(ui, &self.editor, out));
            if let Some(wish) = shown.inner {
                self.pictures.fulfil(wish);
            }
        }
        if self.timeline.is_open {
            let per_second = self.pictures.per_second();
            // Where nothing moves, the room is the picture's.
            let panel = if self.editor.scene().animation.is_still() {
                Panel::bottom("timeline without keys").exact_size(3.0 * ROW)
            } else {
                let panel = Panel::bottom("timeline").resizable(true);
                panel.default_size(TIMELINE).size_range(64.0..=600.0)
            };
            panel.frame(side).show(ui, |ui| {
                self.timeline
                    .show(ui, &self.editor, &self.thumbs, per_second, out);
            });
        }
        if self.layout.outliner {
            Panel::left("outliner")
                .frame(side)
                .default_size(OUTLINER)
                .size_range(160.0..=420.0)
                .show(ui, |ui| {
                    self.outliner.show(ui, &self.editor, out);
                });
        }
        if self.layout.inspector {
            Panel::right("inspector")
                .frame(side)
                .default_size(INSPECTOR)
                .size_range(INSPECTOR..=480.0)
                .show(ui, |ui| {
                    inspector::show(ui, &self.editor, out);
                });
        }
        let behind = Frame::new().fill(palette(ui.ctx()).window);
        CentralPanel::no_frame()
            .frame(behind)
            .show(ui, |ui| self.show_picture(ui, out))
            .inner
    }

    fn show_picture(
        &mut self,
        ui: &mut Ui,
        out: &mut UiRequests,
    ) -> Option<(Place, egui::Response)> {
        let area = ui.max_rect();
        let place = fit(
            area.shrink(GRID),
            self.editor.scene(),
            ui.pixels_per_point(),
        );
        if let Some(response) = self.lab.show_picture(ui, place) {
            return Some((place, response));
        }
        let is_still = self.pictures.shown_still(&self.editor).is_some();
        let response = if is_still && self.layout.actual_size {
            self.pictures.screen.show_still_at_actual_size(ui)?
        } else {
            self.pictures.screen.show(ui, place, is_still)
        };
        if !is_still && self.layout.flight {
            self.overlay.show(ui, &self.editor, place.rect, out);
        }
        if !is_still && self.layout.shot {
            self.thumbs.show_shot(ui, &self.editor, place.rect);
        }
        Some((place, response))
    }

    pub(super) fn act_on(&mut self, ctx: &Context, outcome: Option<FileOutcome>) {
        match outcome {
            None => {}
            Some(FileOutcome::Quit) => match self.exports.describe(&self.pictures) {
                Some(going) => self.files.ask_to_leave(going),
                None => self.act_on(ctx, Some(FileOutcome::Leave)),
            },
            Some(FileOutcome::Leave) => {
                self.closing = Some(self.editor.revision());
                if self.pictures.is_saving() {
                    self.editor
                        .notify("Glint closes when the picture is written".to_owned());
                }
                ctx.request_repaint();
            }
            Some(FileOutcome::ExportFolder(path)) => self.exports.choose_folder(&path),
            Some(FileOutcome::SaveImage(path)) => {
                self.editor.apply(Action::Show(Mode::HighRes));
                self.pictures.request_still(&self.editor, Some(path));
            }
        }
    }

    /// Closes the window once nothing is being written any more; an edit in the meantime keeps it
    /// open.
    fn close_if_meant(&mut self, ctx: &Context) {
        match self.closing {
            Some(revision) if revision != self.editor.revision() => self.closing = None,
            Some(_) if !self.pictures.is_saving() => {
                ctx.send_viewport_cmd(ViewportCommand::Close);
            }
            _ => {}
        }
    }

    /// While it plays, time passes as on the clock; the window is drawn again for the next frame.
    fn pass_time(&mut self, ctx: &Context) {
        if !self.editor.timeline().is_playing {
            return;
        }
        let passed = ctx.input(|input| input.unstable_dt);
        self.editor
            .apply(Action::Time(Time::Tick(f64::from(passed))));
        let timeline = self.editor.timeline();
        let animation = &self.editor.scene().animation;
        let frame = 1.0 / animation.frames_per_second;
        let left = timeline.shown_time(animation) + frame - timeline.playhead;
        ctx.request_repaint_after_secs((left / timeline.speed).clamp(0.002, frame) as f32);
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
    fn logic(&mut self, ctx: &Context, _frame: &mut eframe::Frame) {
        self.pictures.poll(ctx, &mut self.editor);
        let is_measuring = self.pictures.is_measuring();
        self.lab.update(is_measuring, self.pictures.take_study());
        self.thumbs.take(ctx, self.pictures.take_thumbnails());
        for answer in self.pictures.take_answers() {
            match answer {
                Answer::Survey(take, seen) => {
                    self.editor.apply(Action::Time(Time::Surveyed(take, seen)));
                }
                Answer::Visible(revision, ticks) => self.overlay.take_visible(revision, ticks),
            }
        }
        self.exports.update(&mut self.editor, &self.pictures);
        self.pass_time(ctx);
        self.close_if_meant(ctx);
        let outcome = self.files.poll(ctx, &mut self.editor);
        self.act_on(ctx, outcome);
        for file in ctx.input(|input| input.raw.dropped_files.clone()) {
            if is_mesh_file(file.path()) {
                self.files.import_mesh(ctx, &mut self.editor, file.path());
                continue;
            }
            let next = Next::Open(file.path().to_owned());
            let outcome = self.files.start(ctx, &mut self.editor, next);
            self.act_on(ctx, outcome);
        }
        let is_closing = ctx.input(|input| input.viewport().close_requested());
        if is_closing && self.closing.is_none() {
            ctx.send_viewport_cmd(ViewportCommand::CancelClose);
            let outcome = self.files.start(ctx, &mut self.editor, Next::Quit);
            self.act_on(ctx, outcome);
        }
        self.autosave.tick(ctx, &mut self.editor);
        self.theme = ctx.theme();
        self.show_title(ctx);
    }

    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        let mut out = UiRequests::default();
        // What had the keys when this frame's were pressed: a field loses its focus to Escape, and a
        // menu closes, before this is asked.
        let keys_are_free = !self.keys_are_taken && !ui.text_edit_focused();
        out.commands = std::mem::take(&mut self.deferred);
        if keys_are_free {
            let pressed = pressed(ui, self.flying.is_flying(), |_| true);
            out.commands.extend(pressed);
        } else if ui.text_edit_focused() && !self.files.is_asking() {
            // The text is taken over first, and the command runs when that is done.
            self.deferred = pressed(ui, false, is_about_files);
            if !self.deferred.is_empty() {
                ui.memory_mut(egui::Memory::stop_text_input);
                ui.request_repaint();
            }
        }
        let picture = self.show_panels(ui, &mut out);
        let ctx = ui.ctx().clone();
        self.exports
            .show(&ctx, &mut self.editor, &self.pictures, &mut out);
        // Still pictures are looked at, not flown through: they would be gone.
        let flown = picture.as_ref().map(|(_, response)| response);
        let is_still = self.editor.mode == Mode::HighRes || self.lab.is_looking();
        let flown = flown.filter(|_| !is_still);
        let motion = self
            .flying
            .step(ui, flown, keys_are_free, self.editor.scene());
        out.actions.extend(motion.map(Action::Fly));
        let questions = std::mem::take(&mut out.questions);
        for action in out.actions {
            self.editor.apply(action);
        }
        if self.editor.timeline().recorded().is_some() {
            let now = ui.input(|input| input.time);
            self.editor.apply(Action::Time(Time::Sample(now)));
            ctx.request_repaint();
        }
        for command in out.commands {
            self.run(&ctx, command);
        }
        let outcome = self.files.show(ui, &mut self.editor);
        self.act_on(&ctx, outcome);
        help::show(&ctx, &mut self.shortcuts_open);
        let is_gesture = ui.input(|input| input.pointer.any_down()) || self.flying.is_gesture(&ctx);
        if !is_gesture {
            self.editor.end_gesture();
        }
        self.keys_are_taken =
            ui.text_edit_focused() || egui::Popup::is_any_open(&ctx) || self.files.is_asking();
        let messages = std::mem::take(&mut self.editor.messages);
        self.toasts.push(&ctx, messages);
        self.toasts.show(&ctx);
        if let Some((place, _)) = picture {
            self.pictures.submit(&self.editor, place.pixels);
            if let Some(wishes) = self.thumbs.wishes(&ctx, &self.editor, place.rect) {
                self.pictures.request_thumbnails(wishes);
            }
        }
        // A question would keep the live view waiting.
        self.pictures.ask(&self.editor, questions);
        let is_settled = self.is_settled();
        if let Some(screenshot) = &mut self.screenshot
            && screenshot.tick(&ctx, is_settled)
        {
            self.closing = Some(self.editor.revision());
        }
    }

    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        eframe::set_value(storage, RECENT_KEY, &self.files.recent);
        eframe::set_value(storage, THEME_KEY, &self.theme);
    }

    fn on_exit(&mut self, _gl: Option<&eframe::glow::Context>) {
        self.autosave.end();
    }
}
