//! Changes of the open file by other programs: the file is reloaded, or compared with unsaved changes.

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant, SystemTime};

use egui::{Context, Ui};

use super::prompts::{Reply, question, reply_on};
use super::theme::GRID;
use crate::editor::{Editor, OwnFile};
use crate::files::{Marks, Stamp, is_missing, time_of};
use crate::mesh::marks_of_mesh;
use crate::scene::{Document, List, Object, SceneError, differences};
use crate::worker::Background;

/// Subject of the messages about changes from outside.
pub const OUTSIDE: &str = "Changed outside";
/// Time between two checks of the open file.
const CHECK_INTERVAL: Duration = Duration::from_secs(1);
/// Number of checks after a change: the other program may not have finished writing.
const CHECKS_AFTER_CHANGE: u32 = 3;
/// Most lines of differences that are shown.
const MAX_LINES: usize = 8;

/// A scene file with its meshes and the stamp of the file's content, or why it was refused.
pub type LoadedScene = Result<(Document, Stamp), SceneError>;

/// The state of the open file and of its mesh files at the last check.
#[derive(Default)]
pub struct Watch {
    last_check: Option<Instant>,
    /// Number of checks left before the next guard is started.
    remaining_checks: u32,
    /// The watched files, the open one last.
    watched: Vec<Watched>,
    /// The same files, with their marks at the last check.
    last_marks: Vec<(Option<Marks>, Watched)>,
    /// Thread that watches while nothing changes, since a resting window draws no frames.
    guard: Option<Guard>,
    /// Path of the open file and time of its last known change.
    last_modified: Option<(PathBuf, SystemTime)>,
    /// Why it could not be read. Reported only if the file is the same at the next check, since it may be half written.
    pub broken: Option<String>,
    /// File that was missing at the last check.
    missing: Option<PathBuf>,
    /// Objects at the last check, and their mesh files.
    checked_objects: Option<(List<Object>, Vec<WatchedMesh>)>,
    /// Marks of those files at the last check, and marks of the state that was last handed out to be read.
    mesh_marks: HashMap<PathBuf, [Option<Marks>; 2]>,
    /// Mesh files that were reported as gone.
    gone_meshes: HashSet<PathBuf>,
}

impl Watch {
    /// Whether the files must be checked now.
    pub fn is_due(&mut self, ctx: &Context, editor: &Editor) -> bool {
        let Some(path) = editor.path() else {
            self.guard = None;
            return false;
        };
        self.update_meshes(editor);
        if self.watched.last().is_none_or(|(last, _)| last != path) {
            // Undo can bring back a mesh as it was read earlier, so what was read is compared too.
            let meshes = self.checked_objects.iter().flat_map(|(_, files)| files);
            let meshes = meshes.map(|file| (file.full_path(), file.read));
            self.watched = meshes.chain([(path.to_owned(), None)]).collect();
        }
        let has_changed = match &mut self.guard {
            Some(guard) => guard.files != self.watched || guard.alarm.take().is_some(),
            None => false,
        };
        if has_changed {
            (self.guard, self.remaining_checks, self.last_check) =
                (None, CHECKS_AFTER_CHANGE, None);
        }
        if self.guard.is_some() {
            return false;
        }
        let is_due = self
            .last_check
            .is_none_or(|last| last.elapsed() >= CHECK_INTERVAL);
        if is_due {
            self.last_check = Some(Instant::now());
            self.remaining_checks = self.remaining_checks.saturating_sub(1);
            let files = self.watched.iter().cloned();
            self.last_marks = files.map(|file| (marks_of_mesh(&file.0), file)).collect();
        } else if self.remaining_checks == 0 {
            self.guard = Some(Guard::new(ctx, std::mem::take(&mut self.last_marks)));
            return false;
        }
        // The guard is started in the frame after the last check.
        let is_last = is_due && self.remaining_checks == 0;
        ctx.request_repaint_after(if is_last {
            CHECK_INTERVAL / 10
        } else {
            CHECK_INTERVAL
        });
        is_due
    }

    /// Keeps checking for a while: what was found may be incomplete, or different at the next check.
    fn keep_checking(&mut self) {
        self.remaining_checks = CHECKS_AFTER_CHANGE;
    }

    /// Reports the file as gone if it is missing in two checks in a row, since a program that rewrites it may delete it
    /// first. Returns whether it is gone.
    pub fn note_gone(&mut self, editor: &mut Editor, path: &Path) -> bool {
        let is_missing = is_missing(path);
        let was_missing = self.missing.as_deref() == Some(path);
        self.missing = is_missing.then(|| path.to_owned());
        if is_missing != was_missing {
            self.keep_checking();
        }
        let is_gone = is_missing && was_missing;
        if is_gone && editor.own_file() != OwnFile::Gone {
            let path = path.display();
            report_lost(
                editor,
                OwnFile::Gone,
                format!(
                    "{path} no longer exists: it was moved or deleted. The open scene is in no file until it is saved again"
                ),
            );
        }
        if !is_gone && editor.own_file() == OwnFile::Gone {
            editor.set_own_file(OwnFile::Whole);
        }
        is_gone
    }

    /// Returns the folders and paths of mesh files that were written since they were read and are the same in two
    /// checks in a row: in the first one, they may be half written.
    pub fn changed_meshes(&mut self, editor: &Editor) -> Vec<(PathBuf, String)> {
        self.update_meshes(editor);
        let files = self.checked_objects.iter().flat_map(|(_, files)| files);
        let (mesh_marks, gone_meshes) = (&mut self.mesh_marks, &mut self.gone_meshes);
        let mut is_any_changing = false;
        let changed = files.filter(|file| {
            let full_path = file.full_path();
            let now = marks_of_mesh(&full_path);
            let [last, requested] = mesh_marks.entry(full_path.clone()).or_default();
            let is_unchanged = std::mem::replace(last, now) == now;
            is_any_changing |= !is_unchanged;
            // Reading a deleted file reports it once; its mesh stays in the window. A file that was broken or gone in
            // between may be as it was read.
            let must_read = is_unchanged
                && match now {
                    None => file.read.is_some() && gone_meshes.insert(full_path.clone()),
                    Some(_) => gone_meshes.remove(&full_path) || now != requested.or(file.read),
                };
            if must_read {
                *requested = now;
            }
            must_read
        });
        let mesh_paths = changed.map(|file| (file.folder.clone(), file.path.clone()));
        let mesh_paths = mesh_paths.collect();
        if is_any_changing {
            self.keep_checking();
        }
        mesh_paths
    }

    fn update_meshes(&mut self, editor: &Editor) {
        let objects = &editor.scene().objects;
        let is_other = |(of, _): &(List<Object>, _)| !of.is_same(objects);
        if self.checked_objects.as_ref().is_none_or(is_other) {
            let files = editor.scene().mesh_files().into_iter();
            let files = files.map(|(folder, path, read)| WatchedMesh {
                folder: folder.to_owned(),
                path: path.to_owned(),
                read,
            });
            self.checked_objects = Some((objects.clone(), files.collect()));
            self.watched.clear();
        }
    }

    /// Returns whether the file was written since the last check, by its time on disk, so that it is not read every
    /// second just because it was touched or is unreadable.
    pub fn is_changed(&mut self, path: &Path) -> bool {
        let modified = time_of(path).map(|time| (path.to_owned(), time));
        let is_changed = modified.is_none() || modified != self.last_modified;
        self.last_modified = modified;
        if is_changed {
            self.keep_checking();
        }
        is_changed
    }

    /// Makes the next check count the file as changed, because it was missing or unreachable.
    pub fn forget_modified(&mut self) {
        self.last_modified = None;
    }
}

/// Reports why the content of the document now exists only in the window.
pub fn report_lost(editor: &mut Editor, own_file: OwnFile, why: String) {
    editor.begin(OUTSIDE);
    editor.report_error_in(OUTSIDE, why);
    editor.set_own_file(own_file);
}

/// Clears a report about the document's file.
pub fn clear_lost(editor: &mut Editor) {
    editor.begin(OUTSIDE);
    editor.set_own_file(OwnFile::Whole);
}

/// A mesh file that the scene refers to.
struct WatchedMesh {
    folder: PathBuf,
    path: String,
    /// Its marks when it was read.
    read: Option<Marks>,
}

/// A file, and its marks when its mesh was read.
type Watched = (PathBuf, Option<Marks>);

impl WatchedMesh {
    fn full_path(&self) -> PathBuf {
        self.folder.join(&self.path)
    }
}

/// Watches files on a thread, and wakes the window if one of them changes.
struct Guard {
    /// The files, and their marks when they were read.
    files: Vec<Watched>,
    alarm: Background<()>,
    /// Dropped with the guard, which ends the thread.
    _alive: Arc<()>,
}

impl Guard {
    fn new(ctx: &Context, marked: Vec<(Option<Marks>, Watched)>) -> Self {
        let files = marked.iter().map(|(_, file)| file.clone()).collect();
        let alive = Arc::new(());
        let is_wanted = Arc::downgrade(&alive);
        let has_change = move || {
            let mut marked = marked.iter();
            is_wanted.strong_count() == 0
                || marked.any(|(marks, (file, _))| marks_of_mesh(file) != *marks)
        };
        let ctx = ctx.clone();
        let wake = move || ctx.request_repaint();
        Self {
            files,
            alarm: Background::poll_until("glint-watch", CHECK_INTERVAL, has_change, wake),
            _alive: alive,
        }
    }
}

/// The version of the file that another program has written, and how it differs.
pub struct ExternalVersion {
    /// What was read of the file.
    document: LoadedScene,
    /// Stamp of the file if it cannot be read as a scene, to recognise the next change.
    unreadable_stamp: Option<Stamp>,
    lines: Vec<String>,
}

impl ExternalVersion {
    /// Compares it with the document in the editor. If reading failed, it is read once more.
    pub fn new(editor: &Editor, mut document: LoadedScene) -> Self {
        let mut unreadable_stamp = None;
        if let Some(path) = editor.path().filter(|_| document.is_err()) {
            // The stamp is taken first: whatever is written after that counts as a new change.
            unreadable_stamp = Stamp::read(path);
            document = Document::load_stamped(path);
        }
        let lines = match &document {
            Ok((theirs, _)) => differences(editor.scene(), &theirs.scene),
            Err(error) => vec![error.to_string()],
        };
        Self {
            document,
            unreadable_stamp,
            lines,
        }
    }

    /// Keeps the scene of the editor; the next save replaces the other version.
    pub fn reject(self, editor: &mut Editor) {
        editor.begin(OUTSIDE);
        editor.keep_mine(self.document.ok(), self.unreadable_stamp);
    }

    /// Replaces the scene of the editor by this version, if it is readable.
    pub fn accept(self, editor: &mut Editor) {
        if let Ok(theirs) = self.document {
            editor.begin(OUTSIDE);
            editor.take_theirs(theirs);
        }
    }

    /// Asks which version to keep: Yes for that of the editor, No for the other one, and Other for both.
    pub fn ask(&self, ctx: &Context, title: &str) -> Reply {
        question(
            ctx,
            ("changed outside", 460.0, Reply::Open),
            |ui, answer| {
                ui.heading(format!("{title} was changed by another program"));
                ui.add_space(GRID);
                self.describe(ui);
                ui.add_space(2.0 * GRID);
                ui.horizontal(|ui| {
                    // Enter chooses none of them.
                    reply_on(&ui.button("Keep mine"), Reply::Yes, answer);
                    let take = egui::Button::new("Take theirs");
                    let take = ui.add_enabled(self.document.is_ok(), take);
                    reply_on(&take, Reply::No, answer);
                    reply_on(&ui.button("Save as…"), Reply::Other, answer);
                });
            },
        )
    }

    fn describe(&self, ui: &mut Ui) {
        ui.label(match &self.document {
            Ok(_) => "You have unsaved changes. In the file, compared with yours:",
            Err(_) => "The file can no longer be read:",
        });
        for line in self.lines.iter().take(MAX_LINES) {
            // The first line is a sentence; the lines below must keep their columns.
            let (sentence, excerpt) = line.split_once('\n').unwrap_or((line, ""));
            ui.weak(sentence);
            if !excerpt.is_empty() {
                ui.weak(egui::RichText::new(excerpt).monospace());
            }
        }
    }
}
