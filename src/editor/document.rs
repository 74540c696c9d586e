//! The open document: all changes of it go through [`Editor::apply`].

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::DVec3;

use super::action::{Action, Message, Mode};
use super::animation_state::AnimationState;
use super::edit::Edit;
use super::fly::Flight;
use super::history::{History, Snapshot};
use super::item::Item;
use super::own_file::OwnFile;
use super::selection::Selection;
use super::timeline::{Time, Timeline};
use crate::animate::CameraPath;
use crate::files::{Stamp, absolute};
use crate::scene::{
    Document, EXAMPLES, Example, MeshSource, Orientation, Scene, SceneError, check_edit,
};

/// The open document and the state of editing it.
#[derive(Debug)]
pub struct Editor {
    pub(super) scene: Arc<Scene>,
    revision: u64,
    pub(super) header: Arc<str>,
    pub(super) path: Option<PathBuf>,
    /// The name of the document while it has no file.
    name: &'static str,
    pub(super) saved: Arc<Scene>,
    /// Content of the file when this window last read or wrote it.
    pub(super) stamp: Option<Stamp>,
    documents: u64,
    /// Revision at which the last message about a step was shown.
    pub(super) step_message_revision: u64,
    pub(super) is_dirty: bool,
    /// State of the document's file, as last observed.
    pub(super) own_file: OwnFile,
    /// Current contents of mesh files that other programs have written since the document was opened.
    pub(super) reread: Vec<MeshSource>,
    /// Mesh files that were read before, but can no longer be read since another program wrote them.
    pub(super) broken: BTreeSet<PathBuf>,
    pub(super) history: History,
    flight: Flight,
    pub(super) animation_state: AnimationState,
    pub(super) selection: Selection,
    /// What the picture area shows.
    pub mode: Mode,
    /// Messages for the user, oldest first; the window removes them when it shows them.
    pub messages: Vec<Message>,
    /// Whether the last edit was refused.
    pub(super) is_refused: bool,
}

impl Editor {
    /// Opens the demo scene, as a new document.
    pub fn demo() -> Self {
        let [demo, ..] = &EXAMPLES;
        Self {
            name: demo.name,
            ..Self::new(demo.document(), None)
        }
    }

    fn new(document: Document, path: Option<PathBuf>) -> Self {
        let scene = Arc::new(document.scene);
        Self {
            saved: Arc::clone(&scene),
            animation_state: AnimationState::new(&scene),
            scene,
            revision: 1,
            header: document.header.into(),
            path,
            name: "untitled",
            stamp: None,
            documents: 0,
            step_message_revision: 0,
            is_dirty: false,
            own_file: OwnFile::Whole,
            reread: Vec::new(),
            broken: BTreeSet::new(),
            history: History::default(),
            flight: Flight::default(),
            selection: Selection::default(),
            mode: Mode::default(),
            messages: Vec::new(),
            is_refused: false,
        }
    }

    /// The current scene.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// The scene as shown: at the time of the playhead, through the camera in use.
    pub fn shown(&self) -> &Arc<Scene> {
        &self.animation_state.shown
    }

    /// Revision of the shown scene; grows with every change.
    pub fn shown_revision(&self) -> u64 {
        self.animation_state.revision
    }

    /// The timeline.
    pub fn timeline(&self) -> &Timeline {
        &self.animation_state.timeline
    }

    /// The camera over time.
    pub fn path_of_camera(&self) -> &CameraPath {
        &self.animation_state.path
    }

    /// The time that is shown, in seconds.
    pub fn shown_time(&self) -> f64 {
        self.timeline().shown_time(&self.scene.animation)
    }

    /// Whether the picture is that of the shot camera.
    pub fn looks_through(&self) -> bool {
        self.timeline().looks_through(&self.scene.animation)
    }

    /// Revision of the scene; grows with every change.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// The file of the document, if it has one.
    pub fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }

    /// Whether there are changes that are not in any file.
    pub fn is_dirty(&self) -> bool {
        self.is_dirty || self.has_lost_files() || self.is_making_keys()
    }

    /// The title of the document: its file name, the name of its example, or `untitled`.
    pub fn title(&self) -> String {
        let Some(path) = &self.path else {
            return self.name.to_owned();
        };
        let name = path.file_name().unwrap_or(path.as_os_str());
        name.to_string_lossy().into_owned()
    }

    /// The title without the extension `.ron`.
    pub fn stem(&self) -> String {
        let title = self.title();
        title.strip_suffix(".ron").unwrap_or(&title).to_owned()
    }

    /// The name of the step that undo would take back.
    pub fn undo_label(&self) -> Option<&str> {
        self.history.undo_label()
    }

    /// The name of the step that redo would repeat.
    pub fn redo_label(&self) -> Option<&str> {
        self.history.redo_label()
    }

    /// What is selected.
    pub fn selection(&self) -> &Selection {
        &self.selection
    }

    /// The middle of the selection, or of the whole scene if nothing with a position is selected; the origin if
    /// neither has one.
    pub fn middle(&self) -> DVec3 {
        let scene = self.shown();
        let selected = self.selection.middle(scene);
        selected.or_else(|| scene.middle()).unwrap_or_default()
    }

    /// Selects the objects and lights of these names.
    pub fn select_named(&mut self, names: &[String]) {
        let is_named = |item: &Item| {
            let name = item.name(&self.scene);
            name.is_some_and(|name| names.iter().any(|wanted| wanted == name))
        };
        let items = Selection::all(Item::everything(&self.scene).filter(is_named));
        if !items.items().is_empty() {
            self.apply(Action::Select(items));
        }
    }

    /// The angles of the camera, from its vectors.
    pub fn orientation(&self) -> Orientation {
        self.flight.orientation(&self.shown().camera)
    }

    /// Carries out an action; returns whether it changed the scene. If it was refused, the reason has been reported.
    pub fn changes(&mut self, action: Action) -> bool {
        let before = self.revision;
        self.apply(action);
        self.revision != before
    }

    /// Carries out an action requested by a panel.
    pub fn apply(&mut self, action: Action) {
        match action {
            Action::Edit(edit) => drop(self.edit(edit)),
            Action::Fly(motion) => {
                let camera = self
                    .flight
                    .step(&self.animation_state.shown.camera, &motion);
                self.edit(Edit::Camera(camera, "move"));
            }
            Action::Orbit(about, turn) => {
                let camera = &self.animation_state.shown.camera;
                let camera = self.flight.orbit(camera, about, turn);
                self.edit(Edit::Camera(camera, "move"));
            }
            Action::Select(selection) => self.select(selection),
            Action::BeginGesture => self.end_gesture(),
            Action::CancelGesture => {
                if let Some(before) = self.history.cancel_gesture() {
                    self.return_to(before);
                }
            }
            Action::Undo => {
                self.dismiss_step_message();
                self.travel(History::undo);
            }
            Action::Redo => self.travel(History::redo),
            Action::Show(mode) => {
                if mode == Mode::HighRes {
                    // A still picture of a moving scene would never be finished.
                    self.apply_time(Time::Play(false));
                }
                self.mode = mode;
            }
            Action::Time(time) => self.apply_time(time),
            Action::Tell(text) => self.notify_of_step(text),
        }
        self.animation_state.update(&self.scene);
    }

    /// Ends the gesture: the next edit is a new undo step. A gesture that ends in the scene it began with leaves no
    /// step.
    pub fn end_gesture(&mut self) {
        self.history.end_gesture(&self.scene);
    }

    /// Whether a gesture is going on, in which edits of the same name are one step.
    pub fn is_in_gesture(&self) -> bool {
        self.history.is_in_gesture()
    }

    /// Starts a document from an empty scene.
    pub fn start_new(&mut self) {
        self.replace(Document::of(Scene::empty()), None);
    }

    /// Starts a document from an example.
    pub fn start_example(&mut self, example: &Example) {
        self.replace_with(Self {
            name: example.name,
            ..Self::new(example.document(), None)
        });
    }

    /// Replaces the document with one that was read from a file.
    pub fn open(&mut self, (document, stamp): (Document, Stamp), path: &Path) {
        self.replace(document, Some(absolute(path)));
        self.stamp = Some(stamp);
    }

    /// Number of times that another document was opened in place of the current one.
    pub fn documents(&self) -> u64 {
        self.documents
    }

    /// Writes the document to `path`, which becomes its file.
    ///
    /// # Errors
    /// The reason why it could not be written; the document then still counts as changed.
    pub fn save(&mut self, path: &Path) -> Result<(), SceneError> {
        let path = &absolute(path);
        let document = self.document().for_path(path);
        let lost = self.lost_meshes(&document.scene);
        let (backup, stamp) = document.save_stamped(path)?;
        // Meshes that are stored in the scene file from now on no longer follow files of their own.
        if document.scene != *self.scene {
            self.set_scene(Arc::new(document.scene));
        }
        self.path = Some(path.clone());
        self.stamp = Some(stamp);
        self.saved = Arc::clone(&self.scene);
        (self.is_dirty, self.own_file) = (false, OwnFile::Whole);
        let kept = backup.map_or(String::new(), |backup| {
            format!(
                "; the previous file had other comments and is kept as {}",
                backup.display()
            )
        });
        self.notify(format!("Saved {}{kept}{lost}", path.display()));
        Ok(())
    }

    /// Content of the document's file when it was last read or written.
    pub fn stamp(&self) -> Option<&Stamp> {
        self.stamp.as_ref()
    }

    /// The text of the document as it would be saved.
    ///
    /// # Errors
    /// [`SceneError::Unwritable`], for a scene that cannot be serialized.
    pub fn to_text(&self) -> Result<String, SceneError> {
        self.document().to_text()
    }

    /// The document as it would be saved; the copy shares what it can with the scene.
    pub fn document(&self) -> Document {
        Document {
            header: self.header.to_string(),
            scene: self.scene.without_files(&self.broken),
        }
    }

    /// The document as it can be stored in any folder: meshes outside the scene's folder, which would not be found
    /// from there, are stored in it.
    pub fn document_to_keep(&self) -> Document {
        let folder = self.path().and_then(Path::parent);
        let Document { header, scene } = self.document();
        let scene = scene.inlined_for(folder.unwrap_or(Path::new("")));
        Document { header, scene }
    }

    pub(super) fn replace(&mut self, document: Document, path: Option<PathBuf>) {
        self.replace_with(Self::new(document, path));
    }

    /// Replaces the document with another one; revisions go on and messages stay.
    fn replace_with(&mut self, other: Self) {
        let revision = self.revision + 1;
        let documents = self.documents + 1;
        let messages = std::mem::take(&mut self.messages);
        let animation_state = self.animation_state.for_new_document(&other.scene);
        *self = Self {
            revision,
            documents,
            animation_state,
            messages,
            ..other
        };
        self.report_missing_meshes();
    }

    /// Makes an edit; returns false if it was refused. An edit that changes nothing counts as made.
    pub(super) fn edit(&mut self, edit: Edit) -> bool {
        let (label, before) = (edit.label(&self.scene), self.snapshot());
        let is_camera = edit.moves_view();
        // Joining or splitting moves the tracks of the objects along, so no keys are set for them.
        let joined = edit.joined().to_vec();
        let replaced = edit.replaced();
        let removes = !joined.is_empty() || matches!(edit, Edit::Delete(_));
        let posed = self.animation_state.posed(&self.scene, &joined);
        let mut next = posed.clone();
        let new = match edit.apply(&mut next) {
            Ok(new) => new,
            Err(error) => return self.refuse(error.to_string()),
        };
        let state = &self.animation_state;
        let is_keyed = joined.is_empty() && state.key_tracked(&self.scene, &mut next, &replaced);
        if next != posed
            && let Err(problem) = check_edit(&next, &self.scene)
        {
            return self.refuse(format!("{label}: {}", problem.sentence));
        }
        if is_camera {
            self.animation_state.switch_to_view();
        }
        self.dismiss_refusal();
        if next == posed {
            return true;
        }
        if is_keyed {
            self.animation_state.pause(&next.animation);
        }
        let lost = removes.then(|| self.lost(&label, &joined, &next)).flatten();
        self.history.record(label, before, &next);
        self.selection = if new.is_empty() {
            let followed = self.selection.followed(&self.scene, &next);
            // If the only selected item is deleted, the item that follows it at its index is selected.
            let is_gone = followed.items().is_empty() && self.selection.items().len() == 1;
            let keeps_index = removes && is_gone;
            if keeps_index {
                self.selection.clone()
            } else {
                followed
            }
        } else {
            Selection::all(new)
        };
        self.set_scene(Arc::new(next));
        if let Some(lost) = lost {
            self.notify_of_step(lost);
        }
        true
    }

    fn travel(&mut self, step: fn(&mut History, Snapshot) -> Option<Snapshot>) {
        let current = self.snapshot();
        if let Some(target) = step(&mut self.history, current) {
            self.return_to(target);
        }
    }

    pub(super) fn snapshot(&self) -> Snapshot {
        Snapshot {
            scene: Arc::clone(&self.scene),
            header: Arc::clone(&self.header),
            selection: self.selection.clone(),
            view: self.timeline().view_state(),
        }
    }

    fn return_to(&mut self, state: Snapshot) {
        let timeline = &mut self.animation_state.timeline;
        timeline.restore_view(state.view, &self.scene, &state.scene);
        (self.selection, self.header) = (state.selection, state.header);
        self.set_scene(self.refreshed(&state.scene));
    }

    /// Selects those of the items that the scene has.
    fn select(&mut self, selection: Selection) {
        self.selection = selection.within(&self.scene);
        self.history.note_selected(&self.selection);
    }

    pub(super) fn set_scene(&mut self, scene: Arc<Scene>) {
        self.is_dirty = *scene != *self.saved;
        self.scene = scene;
        self.revision += 1;
        let selection = std::mem::take(&mut self.selection);
        self.select(selection);
        self.show_scene();
    }
}
