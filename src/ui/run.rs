//! Carries out commands.

use std::path::Path;

use egui::gui_zoom::{zoom_in, zoom_out};
use egui::{Context, Key, Popup, ViewportCommand};
use glam::DVec3;

use super::app::App;
use super::commands::{Command, Next, Zoom, description_of, has_selected_text};
use super::dropped::Dropped;
use super::interchange::import_path;
use super::layout::Below;
use super::obstacles::obstacle;
use super::on_selected::{
    delete, duplicate_all, move_step, objects_to_join, toggle_visible, with_same_pack,
};
use super::put_down::put_down;
use super::requests::UiRequests;
use super::timeline::actions;
use super::tools::{framing_camera, is_selection_out_of_view, looking_along, projected};
use crate::editor::{
    Action, Edit, Editor, Item, ItemKind, Mode, Selection, Time, excerpt, free_bookmark_name,
    free_group_name, read,
};
use crate::scene::{Aspect, Bookmark, Document, Projection};
use crate::words::counted;

/// Seconds within which a second press of Escape asks whether to quit.
const DOUBLE_ESCAPE_SECONDS: f64 = 3.0;

/// Most triangles that are copied as text.
const MAX_COPIED_FACES: usize = 100_000;

/// Subject of messages about commands that are not possible.
const OBSTACLE: &str = "obstacle";
/// Subject of messages about pasting.
const PASTE: &str = "paste";

impl App {
    /// Carries out the requests of panels and keys; `was_typing` says whether a text was edited when the frame began.
    pub(super) fn carry_out(&mut self, ctx: &Context, out: UiRequests, was_typing: bool) {
        let is_entered = ctx.input(|input| input.key_pressed(Key::Enter));
        if is_entered && !was_typing && !(out.commands.is_empty() && out.actions.is_empty()) {
            // egui closes a menu by itself only if its entry was chosen with the mouse.
            Popup::close_all(ctx);
        }
        let before = self.editor.revision();
        for action in out.actions {
            self.editor.apply(action);
        }
        if self.editor.timeline().recorded().is_some() {
            let now = ctx.input(|input| input.time);
            self.editor.apply(Action::Time(Time::Sample(now)));
            ctx.request_repaint();
        }
        for command in out.commands {
            self.run(ctx, command);
        }
        if self.editor.revision() != before {
            // What was measured before no longer matches the scene.
            self.lab.leave();
        }
    }

    /// Opens or imports files that are dropped onto the window.
    pub(super) fn take_dropped(&mut self, ctx: &Context) {
        let files = ctx.input(|input| input.raw.dropped_files.clone());
        let files: Vec<_> = files.iter().map(|file| file.path().to_owned()).collect();
        let dropped = Dropped::of(&files);
        let unused = dropped
            .as_ref()
            .map_or(0, |dropped| dropped.unused_count(&files));
        if unused > 0 {
            let files = counted(unused, "other file");
            self.editor.notify(format!(
                "Only one scene, or meshes and one path, can be dropped at a time: {files} ignored"
            ));
        }
        match dropped {
            None => {}
            Some(Dropped::Unknown(path)) => self.editor.notify(format!(
                "{} is no scene (.ron), mesh or camera path (.csv)",
                path.display()
            )),
            Some(Dropped::Scene(path)) => self.leave_to(ctx, Next::Open(path)),
            Some(Dropped::Parts { path: Some(_), .. }) if self.files.is_asking() => {
                self.editor
                    .notify("Answer the open question first".to_owned());
            }
            Some(Dropped::Parts { meshes, path }) => {
                for mesh in meshes {
                    self.files.import_mesh(ctx, &mut self.editor, &mesh);
                }
                if let Some(path) = path {
                    import_path(&mut self.editor, &path);
                }
            }
        }
    }

    /// Leaves the document, after a text that is being edited was taken over.
    pub(super) fn leave_to(&mut self, ctx: &Context, next: Next) {
        let command = Command::Leave(next);
        if ctx.text_edit_focused() && !self.files.is_asking() {
            self.commit_text_before(ctx, vec![command]);
        } else {
            self.run(ctx, command);
        }
    }

    pub(super) fn run(&mut self, ctx: &Context, command: Command) {
        match command {
            Command::Leave(next) => {
                let outcome = self.files.start(ctx, &mut self.editor, next);
                self.act_on(ctx, outcome);
            }
            // Nothing happens before the user answers.
            Command::Ask(ask) => self.files.ask(ctx, &mut self.editor, ask),
            Command::Save => {
                let outcome = self.files.save(ctx, &mut self.editor, None);
                self.act_on(ctx, outcome);
            }
            Command::Escape => self.escape(ctx),
            Command::Export => self.exports.is_open = !self.exports.is_open,
            Command::Live | Command::LowRes | Command::HighRes | Command::ActualSize
                if self.lab.leave() =>
            {
                self.run(ctx, command);
            }
            // The text is copied by the panel that shows it.
            Command::Copy | Command::Cut if has_selected_text(ctx) => {}
            Command::Copy | Command::Cut if obstacle(&command, &self.editor).is_none() => {
                if self.copy(ctx) && command == Command::Cut {
                    self.run(ctx, Command::Delete);
                }
            }
            Command::Copy | Command::Cut if !self.editor.selection().keys().is_empty() => {
                let notice = "Duplicate copies keys to the playhead; Ctrl-dragging copies them along their row";
                self.editor.notify(notice.to_owned());
            }
            Command::RequestPaste => ctx.send_viewport_cmd(ViewportCommand::RequestPaste),
            Command::Paste(text) => self.paste(&text),
            Command::Lab => self.toggle_below(Below::Lab),
            Command::Timeline => self.toggle_below(Below::Timeline),
            Command::SelectAll if self.selects_all_keys(ctx) => self.run(ctx, Command::SelectKeys),
            Command::SelectAll => {
                let all = Action::Select(Selection::all(Item::everything(self.editor.scene())));
                self.editor.apply(all);
            }
            Command::FrameAll if self.timeline.is_hovered(ctx.cumulative_frame_nr()) => {
                self.timeline.fit();
            }
            Command::Theme(theme) => ctx.set_theme(theme),
            Command::Zoom(Zoom::In) => zoom_in(ctx),
            Command::Zoom(Zoom::Out) => zoom_out(ctx),
            Command::Zoom(Zoom::Default) => ctx.set_zoom_factor(1.0),
            Command::PictureAlone => self.layout.is_alone = !self.layout.is_alone,
            Command::Aspect(aspect) => {
                self.lab.leave();
                self.layout.aspect = aspect;
                if self.editor.mode == Mode::HighRes {
                    // The still picture always shows all of the light.
                    self.editor.apply(Action::Show(Mode::Live));
                }
            }
            Command::Part(part) => {
                let is_shown = self.layout.part(part);
                *is_shown = !*is_shown;
            }
            Command::Why(origin, direction) => {
                self.why.ask(self.editor.shown(), (origin, direction));
            }
            Command::Find => self.finder.open(),
            Command::Shortcuts => self.shortcuts_open = !self.shortcuts_open,
            other => {
                // Menus show what is not possible, but keys need a message.
                if let Some(why) = obstacle(&other, &self.editor) {
                    let what = description_of(&other).unwrap_or_default();
                    return self.editor.notify_about(OBSTACLE, format!("{what}: {why}"));
                }
                for action in actions(&other, &self.editor) {
                    self.editor.apply(action);
                }
                let before = self.editor.revision();
                self.run_on_scene(&other);
                if other == Command::Duplicate && self.editor.revision() != before {
                    self.report_unseen("The copy");
                }
            }
        }
    }

    /// Tells the user how to see the new selection if it is outside the picture.
    fn report_unseen(&mut self, what: &str) {
        if is_selection_out_of_view(&self.editor) {
            let text = format!("{what} is outside the picture; F frames it");
            self.editor.notify_of_step(text);
        }
    }

    /// Shows this panel below the picture, or hides it. Hiding the lab brings the timeline back.
    fn toggle_below(&mut self, panel: Below) {
        self.lab.leave();
        if std::mem::take(&mut self.layout.is_alone) {
            // The panel was not visible, so it is shown rather than toggled.
            self.layout.below = panel;
            return;
        }
        self.layout.below = match panel {
            other if other != self.layout.below => other,
            Below::Lab => Below::Timeline,
            Below::Timeline | Below::Nothing => Below::Nothing,
        };
    }

    /// Whether *Select all* applies to keys, because the pointer is over the timeline.
    fn selects_all_keys(&self, ctx: &Context) -> bool {
        let is_over = self.timeline.is_hovered(ctx.cumulative_frame_nr());
        let has_keys = !self.editor.scene().animation.is_still();
        has_keys && is_over
    }

    /// Copies what is selected to the clipboard. Returns whether that succeeded.
    fn copy(&mut self, ctx: &Context) -> bool {
        let part = excerpt(self.editor.scene(), self.editor.selection());
        // Another window looks for mesh files in another folder, so only large meshes are copied as file names.
        let whole = if part.faces() <= MAX_COPIED_FACES {
            part.inlined()
        } else {
            part.clone()
        };
        match Document::of(whole).to_text() {
            Ok(text) => {
                ctx.copy_text(text.clone());
                self.copied = Some((text, part));
                true
            }
            Err(error) => {
                self.editor.report_error(error.to_string());
                false
            }
        }
    }

    /// Adds what a text describes, and selects it.
    fn paste(&mut self, text: &str) {
        let copied = self.copied.as_ref().filter(|(copied, _)| copied == text);
        let pasted = match copied {
            Some((_, scene)) => Ok(self.editor.up_to_date(scene)),
            None => read(text, self.editor.scene()).map(|mut scene| {
                let path = self.editor.path();
                scene.load_meshes(path.and_then(Path::parent));
                scene
            }),
        };
        let pasted = match pasted {
            Ok(pasted) => pasted,
            Err(error) => {
                let problem = format!("The clipboard holds no objects or lights: {error}");
                return self.editor.report_error_in(PASTE, problem);
            }
        };
        self.editor.begin(PASTE);
        let is_whole = pasted.mesh_problems().next().is_none();
        let paste = Edit::Paste(Box::new(pasted), "Paste");
        if self.editor.changes(Action::Edit(paste)) {
            self.report_unseen("The pasted selection");
            if !is_whole {
                self.editor.report_missing_meshes();
            }
        }
    }

    /// Runs the commands that are actions of the editor.
    fn run_on_scene(&mut self, command: &Command) {
        // Each is an undo step of its own, even while keys are held.
        self.editor.end_gesture();
        if let Some(action) = self.action_of(command)
            && self.editor.changes(action)
            && let Some(message) = message_after(command)
        {
            self.editor.notify_of_step(message.to_owned());
        }
    }

    /// Returns the action that a command is; `None` if it is none, or has been carried out here.
    fn action_of(&mut self, command: &Command) -> Option<Action> {
        let editor = &mut self.editor;
        Some(match command {
            Command::Undo => Action::Undo,
            Command::Redo => Action::Redo,
            Command::Live => Action::Show(Mode::Live),
            Command::LowRes => Action::Show(Mode::LowRes),
            Command::HighRes => Action::Show(Mode::HighRes),
            Command::ActualSize => {
                self.still.show_actual_size(editor.mode == Mode::HighRes);
                Action::Show(Mode::HighRes)
            }
            Command::CancelStill => {
                self.pictures.cancel_still();
                Action::Show(Mode::Live)
            }
            Command::FrameSelected | Command::FrameAll => {
                let only_selected = *command == Command::FrameSelected;
                let camera = framing_camera(editor, only_selected)?;
                Action::Edit(Edit::Camera(camera, "frame"))
            }
            Command::ViewFront => view_along(editor, DVec3::NEG_Z),
            Command::ViewRight => view_along(editor, DVec3::NEG_X),
            Command::ViewTop => view_along(editor, DVec3::NEG_Y),
            Command::Projection(projection) => change_projection(editor, *projection)?,
            Command::Markers(are_shown) => Action::Edit(Edit::LightVisualization(*are_shown)),
            Command::Delete => Action::Edit(delete(editor)?),
            Command::ToggleVisible => Action::Edit(toggle_visible(editor)),
            Command::Group => Action::Edit(Edit::Group(
                editor.selection().indices(ItemKind::Object),
                free_group_name(editor.scene(), "Group 1"),
            )),
            Command::Ungroup => {
                let objects = editor.selection().indices(ItemKind::Object);
                Action::Edit(Edit::Group(objects, String::new()))
            }
            Command::MergePacks => Action::Edit(Edit::MergePacks),
            Command::Join => Action::Edit(Edit::Join(objects_to_join(editor))),
            Command::Separate => Action::Edit(Edit::Separate(editor.selection().item()?.index)),
            Command::PutDown => match put_down(editor.shown(), editor.selection()) {
                Ok(edit) => Action::Edit(edit),
                Err(why) => {
                    editor.notify(why.to_owned());
                    return None;
                }
            },
            Command::AddBookmark => add_bookmark(editor),
            Command::GoToBookmark(index) => {
                let bookmark = editor.scene().bookmarks.get(*index)?;
                Action::Edit(Edit::Camera(bookmark.camera.clone(), "bookmark"))
            }
            Command::SelectSamePack => {
                Action::Select(with_same_pack(editor.scene(), editor.selection()))
            }
            Command::Rename => {
                self.layout.show_outliner();
                self.outliner.rename(editor.scene(), editor.selection());
                return None;
            }
            Command::MoveUp | Command::MoveDown => {
                let is_down = *command == Command::MoveDown;
                let Some(edit) = move_step(editor, is_down) else {
                    let side = if is_down { "below" } else { "above" };
                    editor.notify(format!("Nothing is {side} it in its list or group"));
                    return None;
                };
                Action::Edit(edit)
            }
            Command::Duplicate => match editor.selection().items() {
                [] => return None,
                [item] => Action::Edit(Edit::Duplicate(*item)),
                _ => {
                    duplicate_all(editor);
                    return None;
                }
            },
            _ => return None,
        })
    }

    /// Leaves the innermost mode or window. If there is none, a second press asks whether to quit.
    fn escape(&mut self, ctx: &Context) {
        let time = ctx.input(|input| input.time);
        let last = self.last_idle_escape.take();
        if self.layout.is_alone {
            self.layout.is_alone = false;
        } else if self.shortcuts_open {
            self.shortcuts_open = false;
        } else if self.why.is_open() {
            self.why.close();
        } else if self.exports.is_open {
            self.exports.is_open = false;
        } else if self.lab.leave() {
            // The live view is back.
        } else if self.layout.aspect != Aspect::All && self.editor.mode != Mode::HighRes {
            self.layout.aspect = Aspect::All;
        } else if self.outliner.clear_filter() {
            // Everything is listed.
        } else if self.editor.timeline().recorded().is_some() {
            self.editor.apply(Action::Time(Time::Stop));
        } else if self.editor.timeline().is_playing {
            self.editor.apply(Action::Time(Time::Play(false)));
        } else if self.editor.mode == Mode::HighRes && self.pictures.region.take().is_some() {
            // All of the picture is traced again.
        } else if self.editor.mode != Mode::Live {
            self.pictures.leave_still();
            self.editor.apply(Action::Show(Mode::Live));
        } else if self.editor.looks_through() {
            self.editor.apply(Action::Time(Time::LookThrough(false)));
        } else if *self.editor.selection() != Selection::Camera {
            self.editor.apply(Action::Select(Selection::Camera));
        } else if last.is_some_and(|last| time - last < DOUBLE_ESCAPE_SECONDS) {
            self.files.ask_to_quit(&mut self.editor);
        } else {
            self.last_idle_escape = Some(time);
            self.editor
                .notify("Esc once more asks whether to quit".to_owned());
        }
    }
}

/// Returns a message for commands on a letter or digit key that change the whole picture: the key may have been
/// meant for a text field.
fn message_after(command: &Command) -> Option<&'static str> {
    Some(match command {
        Command::Projection(Projection::Orthographic) => {
            "Orthographic projection; P switches to perspective"
        }
        Command::Projection(Projection::Perspective) => {
            "Perspective projection; O switches to orthographic"
        }
        Command::Markers(true) => "Light markers are shown; U hides them",
        Command::Markers(false) => "Light markers are hidden; I shows them",
        _ => return None,
    })
}

/// Returns the action that adds this view as a bookmark.
fn add_bookmark(editor: &mut Editor) -> Action {
    let mut bookmarks = editor.scene().bookmarks.clone();
    let name = free_bookmark_name(&bookmarks, "View 1");
    editor.notify(format!(
        "{name} is bookmarked; Bookmarked views in the View menu returns to it"
    ));
    let camera = editor.shown().camera.clone();
    bookmarks.push(Bookmark { name, camera });
    Action::Edit(Edit::Bookmarks(bookmarks, "Add bookmark"))
}

fn view_along(editor: &Editor, direction: DVec3) -> Action {
    let camera = looking_along(&editor.shown().camera, editor.middle(), direction);
    Action::Edit(Edit::Camera(camera, "view"))
}

/// Returns the action that switches to a projection; `None` if the camera has it.
fn change_projection(editor: &Editor, projection: Projection) -> Option<Action> {
    let scene = editor.shown();
    (scene.camera.projection != projection).then(|| {
        let camera = projected(&scene.camera, scene.middle(), projection);
        Action::Edit(Edit::Camera(camera, "projection"))
    })
}
