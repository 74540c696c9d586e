//! The window's frame: reads input, shows the panels, applies what they asked for, and hands the
//! scene to the background lane.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use egui::{CentralPanel, Context, Frame, Margin, Panel, Ui, ViewportCommand};

use super::commands::{Command, is_enabled, pressed};
use super::dialogs::{Ask, Dialogs, Native};
use super::files::{Files, Next, Outcome};
use super::flying::Flying;
use super::menu::Layout;
use super::outliner::Outliner;
use super::theme::{GRID, INSPECTOR, OUTLINER, ROW, palette};
use super::toasts::Toasts;
use super::viewport::{Place, Screen, describe, fit, low_res};
use super::window::data_folder;
use super::{Out, help, inspector, menu, status, theme};
use crate::editor::{Action, Edit, Editor, Mode, Selection};
use crate::plan::Picture;
use crate::scene::{Projection, Recovery};
use crate::trace::PoolError;
use crate::worker::{Activity, Event, LiveJob, Pace, StillJob, Worker};

/// Where the list of recent files is kept between runs.
const RECENT_KEY: &str = "recent files";
/// Time between two autosaves of unsaved work.
const AUTOSAVE: Duration = Duration::from_secs(5);

/// What the program gives the window.
pub struct Setup {
    /// The scene to open; the demo if there is none.
    pub scene: Option<PathBuf>,
    /// How paths are asked for.
    pub dialogs: Box<dyn Dialogs>,
    /// Where unsaved work is kept; `None` keeps none.
    pub data_folder: Option<PathBuf>,
}

impl Setup {
    /// The desktop's dialogs and data folder.
    pub fn native(scene: Option<PathBuf>) -> Self {
        Self {
            scene,
            dialogs: Box::new(Native),
            data_folder: data_folder(),
        }
    }
}

/// The window.
pub struct App {
    editor: Editor,
    worker: Worker,
    files: Files,
    outliner: Outliner,
    screen: Screen,
    toasts: Toasts,
    flying: Flying,
    layout: Layout,
    shortcuts_open: bool,
    submitted: Option<(u64, (u32, u32), Pace)>,
    still_requested: Option<(u64, (u32, u32))>,
    may_close: bool,
    title: String,
    recovery: Option<Recovery>,
    autosave: Autosave,
}

/// The state of autosaving.
#[derive(Default)]
struct Autosave {
    /// What is kept: revision, and when.
    kept: Option<(u64, Instant)>,
    tried: Option<Instant>,
}

impl App {
    /// Sets the window up: fonts, theme, lane, and the document.
    ///
    /// # Errors
    /// [`PoolError`] when the system starts no threads.
    pub fn new(cc: &eframe::CreationContext<'_>, setup: Setup) -> Result<Self, PoolError> {
        theme::install(&cc.egui_ctx);
        cc.egui_ctx.options_mut(|options| {
            options.quit_shortcuts.clear();
            options.zoom_with_keyboard = true;
        });
        let wake = cc.egui_ctx.clone();
        let recent = cc
            .storage
            .and_then(|storage| eframe::get_value(storage, RECENT_KEY));
        let mut app = Self {
            editor: Editor::demo(),
            worker: Worker::new(None, move || wake.request_repaint())?,
            files: Files::new(setup.dialogs, recent.unwrap_or_default()),
            outliner: Outliner::default(),
            screen: Screen::default(),
            toasts: Toasts::default(),
            flying: Flying::default(),
            layout: Layout {
                outliner: true,
                inspector: true,
                actual_size: false,
            },
            shortcuts_open: false,
            submitted: None,
            still_requested: None,
            may_close: false,
            title: String::new(),
            recovery: None,
            autosave: Autosave::default(),
        };
        if let Some(path) = setup.scene {
            app.files.open(&mut app.editor, &path);
        }
        app.start_recovery(setup.data_folder.as_deref());
        Ok(app)
    }

    /// The document.
    pub fn editor(&self) -> &Editor {
        &self.editor
    }

    /// Whether the picture on screen is the finished one of the newest scene.
    pub fn is_settled(&self) -> bool {
        let live = self.screen.live();
        let is_live = live.is_some_and(|f| f.revision == self.editor.revision() && f.step == 1);
        let is_shown = is_live || self.shown_still().is_some();
        self.worker.activity() == Activity::Idle && is_shown
    }

    /// Width and height of the picture on screen, in its own pixels.
    pub fn shown_size(&self) -> Option<(usize, usize)> {
        let frame = self.shown_still().or(self.screen.live())?;
        Some((frame.image.width, frame.image.height))
    }

    /// The pixels on screen.
    pub fn shown_pixels(&self) -> Option<&[[u8; 4]]> {
        let frame = self.shown_still().or(self.screen.live())?;
        Some(&frame.image.pixels)
    }

    fn shown_still(&self) -> Option<&crate::worker::Frame> {
        if self.editor.mode != Mode::HighRes {
            return None;
        }
        self.screen.still(self.editor.revision(), self.still_size())
    }

    fn still_size(&self) -> (u32, u32) {
        let render = &self.editor.scene().render;
        (render.width, render.height)
    }

    fn start_recovery(&mut self, folder: Option<&Path>) {
        self.recovery = folder.and_then(|folder| Recovery::new(folder).ok());
        let leftover = self.recovery.as_ref().and_then(Recovery::take_leftover);
        let Some(leftover) = leftover else { return };
        let name = leftover
            .path
            .as_ref()
            .map_or("a new scene".to_owned(), |p| p.display().to_string());
        self.editor.recover(leftover.document, leftover.path);
        self.editor.inform(format!(
            "Glint ended with unsaved changes to {name}; here they are. Save them, or open the file again to discard them."
        ));
    }

    fn show_panels(&mut self, ui: &mut Ui, out: &mut Out) -> Option<(Place, egui::Response)> {
        let side = Frame::side_top_panel(ui.style()).inner_margin(Margin::symmetric(GRID as i8, 0));
        Panel::top("menu").show(ui, |ui| {
            menu::show(ui, &self.editor, &self.files.recent, &mut self.layout, out);
        });
        Panel::bottom("status").exact_size(ROW).show(ui, |ui| {
            let frame = self.shown_still().or(self.screen.live());
            let text = frame.map_or(String::new(), |frame| describe(frame, self.editor.scene()));
            let kept = self
                .autosave
                .kept
                .map(|(_, at)| at)
                .filter(|_| self.editor.is_dirty());
            status::show(ui, &text, &self.worker.activity(), kept, out);
        });
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
            .show(ui, |ui| self.show_picture(ui))
            .inner
    }

    fn show_picture(&self, ui: &mut Ui) -> Option<(Place, egui::Response)> {
        let area = ui.max_rect();
        let place = fit(
            area.shrink(GRID),
            self.editor.scene(),
            ui.pixels_per_point(),
        );
        let is_still = self.shown_still().is_some();
        let response = if is_still && self.layout.actual_size {
            self.screen.show_still_at_actual_size(ui)?
        } else {
            self.screen.show(ui, place, is_still)
        };
        Some((place, response))
    }

    fn run(&mut self, ctx: &Context, command: Command) {
        let outcome = match command {
            Command::New => self.files.start(ctx, &mut self.editor, Next::New),
            Command::OpenDemo => self.files.start(ctx, &mut self.editor, Next::Demo),
            Command::Open => self.files.start(ctx, &mut self.editor, Next::Choose),
            Command::OpenRecent(path) => self.files.start(ctx, &mut self.editor, Next::Open(path)),
            Command::Quit => self.files.start(ctx, &mut self.editor, Next::Quit),
            Command::Save => self.files.save(ctx, &mut self.editor),
            Command::SaveAs => {
                self.files.ask(ctx, &self.editor, Ask::SaveScene);
                None
            }
            Command::SaveImage => {
                self.files.ask(ctx, &self.editor, Ask::SaveImage);
                None
            }
            Command::Escape => self.escape(ctx),
            Command::Shortcuts => {
                self.shortcuts_open = !self.shortcuts_open;
                None
            }
            other => {
                self.run_on_scene(&other);
                None
            }
        };
        self.follow(ctx, outcome);
    }

    /// The commands that are actions of the editor.
    fn run_on_scene(&mut self, command: &Command) {
        let editor = &mut self.editor;
        if !is_enabled(command, editor) {
            return;
        }
        let action = match command {
            Command::Undo => Action::Undo,
            Command::Redo => Action::Redo,
            Command::Live => Action::Show(Mode::Live),
            Command::LowRes => Action::Show(Mode::LowRes),
            Command::HighRes => Action::Show(Mode::HighRes),
            Command::CancelStill => {
                self.worker.cancel_still();
                Action::Show(Mode::Live)
            }
            Command::Perspective => projected(editor, Projection::Perspective),
            Command::Orthographic => projected(editor, Projection::Orthographic),
            Command::MarkersOn => Action::Edit(Edit::LightVisualization(true)),
            Command::MarkersOff => Action::Edit(Edit::LightVisualization(false)),
            on_item => match (on_item, editor.selection) {
                (Command::Rename, Selection::Item(item)) => return self.outliner.rename(item),
                (Command::Duplicate, Selection::Item(item)) => Action::Edit(Edit::Duplicate(item)),
                (Command::Delete, Selection::Item(item)) => Action::Edit(Edit::Delete(item)),
                (Command::MoveUp, Selection::Item(item)) => {
                    Action::Edit(Edit::Move(item, item.index.saturating_sub(1)))
                }
                (Command::MoveDown, Selection::Item(item)) => {
                    Action::Edit(Edit::Move(item, item.index + 1))
                }
                _ => return,
            },
        };
        editor.apply(action);
    }

    /// Leaves the innermost mode; in none, asks to quit.
    fn escape(&mut self, ctx: &Context) -> Option<Outcome> {
        if self.shortcuts_open {
            self.shortcuts_open = false;
        } else if self.editor.mode != Mode::Live {
            self.worker.cancel_still();
            self.editor.apply(Action::Show(Mode::Live));
        } else {
            return self.files.ask_to_quit(ctx, &mut self.editor);
        }
        None
    }

    fn follow(&mut self, ctx: &Context, outcome: Option<Outcome>) {
        match outcome {
            None => {}
            Some(Outcome::Quit) => {
                self.may_close = true;
                ctx.send_viewport_cmd(ViewportCommand::Close);
            }
            Some(Outcome::SaveImage(path)) => {
                self.editor.apply(Action::Show(Mode::HighRes));
                self.request_still(Some(path));
            }
        }
    }

    fn request_still(&mut self, save_to: Option<PathBuf>) {
        let scene = self.editor.scene();
        self.still_requested = Some((self.editor.revision(), self.still_size()));
        self.worker.request_still(StillJob {
            revision: self.editor.revision(),
            scene: scene.clone(),
            picture: Picture::still(scene),
            save_to,
        });
    }

    /// Hands the lane what the picture area needs and does not have.
    fn submit(&mut self, pixels: (u32, u32)) {
        let revision = self.editor.revision();
        if self.editor.mode == Mode::HighRes {
            let wanted = (revision, self.still_size());
            if self.shown_still().is_none() && self.still_requested != Some(wanted) {
                self.request_still(None);
            }
            return;
        }
        self.still_requested = None;
        let (size, pace) = match self.editor.mode {
            Mode::LowRes => (low_res(pixels), Pace::Whole),
            _ => (pixels, Pace::Progressive),
        };
        if self.submitted == Some((revision, size, pace)) {
            return;
        }
        self.submitted = Some((revision, size, pace));
        self.worker.submit(LiveJob {
            revision,
            scene: self.editor.scene().clone(),
            picture: Picture::sized(size.0, size.1),
            pace,
        });
    }

    /// Keeps unsaved work on disk, every few seconds while there is new work.
    fn autosave(&mut self, ctx: &Context) {
        let Some(recovery) = &self.recovery else {
            return;
        };
        let revision = self.editor.revision();
        if !self.editor.is_dirty() {
            if self.autosave.kept.take().is_some() {
                recovery.clear();
            }
            return;
        }
        if self.autosave.kept.is_some_and(|(kept, _)| kept == revision) {
            return;
        }
        if let Some(wait) = self
            .autosave
            .tried
            .and_then(|at| AUTOSAVE.checked_sub(at.elapsed()))
        {
            ctx.request_repaint_after(wait);
            return;
        }
        self.autosave.tried = Some(Instant::now());
        match recovery.keep(&self.editor.to_text(), self.editor.path()) {
            Ok(()) => self.autosave.kept = Some((revision, Instant::now())),
            Err(error) => self.editor.complain(format!(
                "Unsaved changes cannot be kept safe: {error}. Save your work and make room on the disk."
            )),
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

fn projected(editor: &Editor, projection: Projection) -> Action {
    let camera = crate::scene::Camera {
        projection,
        ..editor.scene().camera.clone()
    };
    Action::Edit(Edit::Camera(camera, "projection"))
}

impl eframe::App for App {
    fn logic(&mut self, ctx: &Context, _frame: &mut eframe::Frame) {
        if let Some(frame) = self.worker.take_frame() {
            self.screen.take(ctx, frame);
        }
        for event in self.worker.take_events() {
            match event {
                Event::Saved(path) => self.editor.inform(format!("Saved {}", path.display())),
                Event::Failed(reason) => self.editor.complain(reason),
            }
        }
        let outcome = self.files.poll(ctx, &mut self.editor);
        self.follow(ctx, outcome);
        for file in ctx.input(|input| input.raw.dropped_files.clone()) {
            let next = Next::Open(file.path().to_owned());
            let outcome = self.files.start(ctx, &mut self.editor, next);
            self.follow(ctx, outcome);
        }
        if ctx.input(|input| input.viewport().close_requested()) && !self.may_close {
            if self.editor.is_dirty() {
                ctx.send_viewport_cmd(ViewportCommand::CancelClose);
            }
            let outcome = self.files.start(ctx, &mut self.editor, Next::Quit);
            self.follow(ctx, outcome);
        }
        self.autosave(ctx);
        self.show_title(ctx);
    }

    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        let mut out = Out::default();
        let keys_are_free = !self.files.is_asking() && !ui.text_edit_focused();
        if keys_are_free {
            out.commands = pressed(ui);
        }
        let picture = self.show_panels(ui, &mut out);
        if let Some((_, response)) = &picture
            && let Some(motion) = self
                .flying
                .step(ui, response, keys_are_free, self.editor.scene())
        {
            out.actions.push(Action::Fly(motion));
        }
        for action in out.actions {
            self.editor.apply(action);
        }
        let ctx = ui.ctx().clone();
        for command in out.commands {
            self.run(&ctx, command);
        }
        let outcome = self.files.show(ui, &mut self.editor);
        self.follow(&ctx, outcome);
        help::show(&ctx, &mut self.shortcuts_open);
        let is_gesture =
            ui.input(|input| input.pointer.any_down()) || self.flying.is_any_key_down(&ctx);
        if !is_gesture {
            self.editor.end_gesture();
        }
        let messages = std::mem::take(&mut self.editor.messages);
        self.toasts.push(&ctx, messages);
        self.toasts.show(&ctx);
        if let Some((place, _)) = picture {
            self.submit(place.pixels);
        }
    }

    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        eframe::set_value(storage, RECENT_KEY, &self.files.recent);
    }

    fn on_exit(&mut self, _gl: Option<&eframe::glow::Context>) {
        if let Some(recovery) = &self.recovery {
            recovery.clear();
        }
    }
}
