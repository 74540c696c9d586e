//! What each command comes to.

use egui::Context;

use super::app::App;
use super::commands::{Command, is_enabled};
use super::dialogs::Ask;
use super::files::{FileOutcome, Next};
use super::timeline::actions;
use crate::editor::{Action, Edit, Editor, Mode, Selection, Time};
use crate::scene::Projection;

impl App {
    pub(super) fn run(&mut self, ctx: &Context, command: Command) {
        let outcome = match command {
            Command::New => self.files.start(ctx, &mut self.editor, Next::New),
            Command::OpenDemo => self.files.start(ctx, &mut self.editor, Next::Demo),
            Command::Open => self.files.start(ctx, &mut self.editor, Next::Choose),
            Command::OpenRecent(path) => self.files.start(ctx, &mut self.editor, Next::Open(path)),
            Command::Quit => self.files.start(ctx, &mut self.editor, Next::Quit),
            Command::Save => self.files.save(ctx, &mut self.editor),
            Command::SaveAs => self.ask(ctx, Ask::SaveScene),
            Command::SaveImage => self.ask(ctx, Ask::SaveImage),
            Command::Escape => {
                self.escape();
                None
            }
            Command::ImportMesh => self.ask(ctx, Ask::ImportMesh),
            Command::ImportPath => self.ask(ctx, Ask::ImportPath),
            Command::ExportPath => self.ask(ctx, Ask::ExportPath),
            Command::Export => {
                self.exports.is_open = !self.exports.is_open;
                None
            }
            Command::ExportJob => self.ask(ctx, Ask::ExportJob),
            Command::ExportFolder => self.ask(ctx, Ask::ExportFolder),
            // The two share the room below the picture.
            Command::Lab => {
                self.lab.is_open = !self.lab.is_open;
                self.timeline.is_open = !self.lab.is_open;
                None
            }
            Command::Timeline => {
                self.timeline.is_open = !self.timeline.is_open;
                self.lab.is_open = false;
                None
            }
            Command::Shortcuts => {
                self.shortcuts_open = !self.shortcuts_open;
                None
            }
            other => {
                for action in actions(&other, &self.editor) {
                    self.editor.apply(action);
                }
                self.run_on_scene(&other);
                None
            }
        };
        self.act_on(ctx, outcome);
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
                self.pictures.cancel_still();
                Action::Show(Mode::Live)
            }
            Command::Perspective => projected(editor, Projection::Perspective),
            Command::Orthographic => projected(editor, Projection::Orthographic),
            Command::MarkersOn => Action::Edit(Edit::LightVisualization(true)),
            Command::MarkersOff => Action::Edit(Edit::LightVisualization(false)),
            Command::Delete if editor.selection == Selection::Keys => {
                let kept = editor
                    .scene()
                    .animation
                    .without_keys(&editor.timeline().selected);
                Action::Edit(Edit::animation(kept, "Delete keys"))
            }
            on_item => match (on_item, editor.selection) {
                (Command::Rename, Selection::Item(item)) => {
                    self.layout.outliner = true;
                    return self.outliner.rename(item);
                }
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

    /// Asks for a path; nothing comes of it before it is answered.
    fn ask(&mut self, ctx: &Context, ask: Ask) -> Option<FileOutcome> {
        self.files.ask(ctx, &self.editor, ask);
        None
    }

    /// Leaves the innermost mode; in none, asks to quit.
    fn escape(&mut self) {
        if self.shortcuts_open {
            self.shortcuts_open = false;
        } else if self.lab.leave() {
            // The live view is back.
        } else if self.editor.timeline().recorded().is_some() {
            self.editor.apply(Action::Time(Time::Stop));
        } else if self.editor.timeline().is_playing {
            self.editor.apply(Action::Time(Time::Play(false)));
        } else if self.editor.mode != Mode::Live {
            self.pictures.cancel_still();
            self.editor.apply(Action::Show(Mode::Live));
        } else {
            self.files.ask_to_quit(&self.editor);
        }
    }
}

fn projected(editor: &Editor, projection: Projection) -> Action {
    let camera = crate::scene::Camera {
        projection,
        ..editor.shown().camera.clone()
    };
    Action::Edit(Edit::Camera(camera, "projection"))
}
