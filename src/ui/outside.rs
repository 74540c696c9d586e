//! The open file, written by another program: read anew, or held against the own changes.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant, SystemTime};

use egui::{Context, Ui};

use super::prompts::{Reply, question};
use super::theme::GRID;
use crate::editor::{Editor, OwnFile};
use crate::files::{Marks, Stamp, is_missing, time_of};
use crate::mesh::marks_of_mesh;
use crate::scene::{Document, List, Object, SceneError, differences};
use crate::worker::Background;

/// What messages are about that tell of it.
pub const OUTSIDE: &str = "Changed outside";
/// How often the open file is looked at.
const RHYTHM: Duration = Duration::from_secs(1);
/// How often it is looked at once something has changed: whoever writes it may not be ready.
const LOOKS: u32 = 3;
/// Most lines of differences that are shown.
const MOST_LINES: usize = 8;

/// When the open file was looked at last, and how it was.
#[derive(Default)]
pub struct Watch {
    looked: Option<Instant>,
    /// How many looks there are before the next guard.
    left: u32,
    /// The files that are looked at, the open one last.
    watched: Vec<Watched>,
    /// How they were at the last look.
    marked: Vec<Marked>,
    /// Who looks while nothing changes: a window that rests draws nothing.
    guard: Option<Guard>,
    /// When it was written last, as far as is known.
    found: Option<(PathBuf, SystemTime)>,
    /// Why it could not be read: told if it is still so at the next look, since it may be half written.
    broken: Option<String>,
    /// What was not there at the last look.
    missing: Option<PathBuf>,
    /// The objects that were looked at last, and the files of their meshes.
    shown: Option<(List<Object>, Vec<WatchedMesh>)>,
    /// What marked those files at the last look, and when they were last to be read.
    seen: HashMap<PathBuf, [Option<Marks>; 2]>,
}

impl Watch {
    /// Whether files must be looked at again.
    pub fn is_due(&mut self, ctx: &Context, editor: &Editor) -> bool {
        let Some(path) = editor.path() else {
            self.guard = None;
            return false;
        };
        self.note_meshes(editor);
        if self.watched.last().is_none_or(|(last, _)| last != path) {
            // An undo brings back what was read of a mesh before.
            let meshes = self.shown.iter().flat_map(|(_, files)| files);
            let meshes = meshes.map(|file| (file.full(), file.read));
            self.watched = meshes.chain([(path.to_owned(), None)]).collect();
        }
        let has_news = match &mut self.guard {
            Some(guard) => guard.files != self.watched || guard.alarm.take().is_some(),
            None => false,
        };
        if has_news {
            (self.guard, self.left, self.looked) = (None, LOOKS, None);
        }
        if self.guard.is_some() {
            return false;
        }
        let is_due = self.looked.is_none_or(|looked| looked.elapsed() >= RHYTHM);
        if is_due {
            self.looked = Some(Instant::now());
            self.left = self.left.saturating_sub(1);
            let marked = self.watched.iter();
            self.marked = marked
                .map(|(file, read)| (marks_of_mesh(file), file.clone(), *read))
                .collect();
        } else if self.left == 0 {
            self.guard = Some(Guard::new(ctx, std::mem::take(&mut self.marked)));
            return false;
        }
        // The frame after the last look makes the guard.
        let is_last = is_due && self.left == 0;
        ctx.request_repaint_after(if is_last { RHYTHM / 10 } else { RHYTHM });
        is_due
    }

    /// What was found may not be all, or not be so at the next look.
    fn look_on(&mut self) {
        self.left = LOOKS;
    }

    /// Tells if the file is not there, and was not at the last look either: whoever writes it anew may take it away first.
    /// Whether that is so.
    pub fn note_gone(&mut self, editor: &mut Editor, path: &Path) -> bool {
        let is_missing = is_missing(path);
        let was_missing = self.missing.as_deref() == Some(path);
        self.missing = is_missing.then(|| path.to_owned());
        if is_missing != was_missing {
            self.look_on();
        }
        let is_gone = is_missing && was_missing;
        if is_gone && editor.own_file() != OwnFile::Gone {
            let path = path.display();
            tell_lost(
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

    /// The files of meshes that were written since they were read, and are the same at two looks: they may have been
    /// half written at the first. Their folders, and the paths in those.
    pub fn changed_meshes(&mut self, editor: &Editor) -> Vec<(PathBuf, String)> {
        self.note_meshes(editor);
        let files = self.shown.iter().flat_map(|(_, files)| files);
        let seen = &mut self.seen;
        let mut is_moving = false;
        let changed = files.filter(|file| {
            let full = file.full();
            let now = marks_of_mesh(&full);
            let [found, asked] = seen.entry(full).or_default();
            let is_still = std::mem::replace(found, now) == now;
            is_moving |= !is_still;
            // What is gone stays as it is in the window. What was broken meanwhile may be as it was.
            let is_new = is_still && now.is_some() && now != asked.or(file.read);
            if is_new {
                *asked = now;
            }
            is_new
        });
        let places = changed.map(|file| (file.folder.clone(), file.path.clone()));
        let places = places.collect();
        if is_moving {
            self.look_on();
        }
        places
    }

    fn note_meshes(&mut self, editor: &Editor) {
        let objects = &editor.scene().objects;
        let is_other = |(of, _): &(List<Object>, _)| !of.is_same(objects);
        if self.shown.as_ref().is_none_or(is_other) {
            let files = editor.scene().mesh_files().into_iter();
            let files = files.map(|(folder, path, read)| WatchedMesh {
                folder: folder.to_owned(),
                path: path.to_owned(),
                read,
            });
            self.shown = Some((objects.clone(), files.collect()));
            self.watched.clear();
        }
    }

    /// Whether the file is another than when it was looked at last, by what the disk says of it: it is not read
    /// every second because it was touched, or cannot be read.
    pub fn is_news(&mut self, path: &Path) -> bool {
        let found = time_of(path).map(|time| (path.to_owned(), time));
        let is_news = found.is_none() || found != self.found;
        self.found = found;
        if is_news {
            self.look_on();
        }
        is_news
    }

    /// What was found is not there, or out of reach: it may be so next time.
    pub fn look_again(&mut self) {
        self.found = None;
    }

    /// What was found could not be read, for this reason.
    pub fn note_broken(&mut self, why: String) {
        self.broken = Some(why);
    }

    /// Why what was found before could not be read, once.
    pub fn take_broken(&mut self) -> Option<String> {
        self.broken.take()
    }
}

/// Tells that nothing but the window has what was in the file of the document, and why.
pub fn tell_lost(editor: &mut Editor, own_file: OwnFile, why: String) {
    editor.begin(OUTSIDE);
    editor.report_error_in(OUTSIDE, why);
    editor.set_own_file(own_file);
}

/// If something was wrong with that file, it is over.
pub fn forget_lost(editor: &mut Editor) {
    editor.begin(OUTSIDE);
    editor.set_own_file(OwnFile::Whole);
}

/// A file that meshes refer to.
struct WatchedMesh {
    folder: PathBuf,
    path: String,
    /// What marked it when it was read.
    read: Option<Marks>,
}

/// A file, and what marked it when its mesh was read.
type Watched = (PathBuf, Option<Marks>);
/// What marks a file now, the file, and what marked it when its mesh was read.
type Marked = (Option<Marks>, PathBuf, Option<Marks>);

impl WatchedMesh {
    fn full(&self) -> PathBuf {
        self.folder.join(&self.path)
    }
}

/// Looks at files beside the window, and wakes it if one of them has changed.
struct Guard {
    /// The files, and what marked them when they were read.
    files: Vec<Watched>,
    alarm: Background<()>,
    /// Gone with the guard.
    _alive: Arc<()>,
}

impl Guard {
    fn new(ctx: &Context, marked: Vec<Marked>) -> Self {
        let files = marked.iter().map(|(_, file, read)| (file.clone(), *read));
        let files = files.collect();
        let alive = Arc::new(());
        let is_wanted = Arc::downgrade(&alive);
        let is_there = move || {
            let mut marked = marked.iter();
            is_wanted.strong_count() == 0
                || marked.any(|(marks, file, _)| marks_of_mesh(file) != *marks)
        };
        let ctx = ctx.clone();
        let wake = move || ctx.request_repaint();
        Self {
            files,
            alarm: Background::look_out("glint-watch", RHYTHM, is_there, wake),
            _alive: alive,
        }
    }
}

/// What another program has written, and how it differs.
pub struct Theirs {
    /// What it has written.
    document: Result<(Document, Stamp), SceneError>,
    /// What tells it from the next, if it cannot be read as a scene.
    unread: Option<Stamp>,
    lines: Vec<String>,
}

impl Theirs {
    /// Beside the document in the editor.
    pub fn new(editor: &Editor, mut document: Result<(Document, Stamp), SceneError>) -> Self {
        let mut unread = None;
        if let Some(path) = editor.path().filter(|_| document.is_err()) {
            // Its stamp first: what is written from now on is news.
            unread = Stamp::read(path);
            document = Document::load_stamped(path);
        }
        let lines = match &document {
            Ok((theirs, _)) => differences(editor.scene(), &theirs.scene),
            Err(error) => vec![error.to_string()],
        };
        Self {
            document,
            unread,
            lines,
        }
    }

    /// The own scene stays; the next save replaces this.
    pub fn leave(self, editor: &mut Editor) {
        editor.begin(OUTSIDE);
        editor.keep_mine(self.document.ok(), self.unread);
    }

    /// This takes the place of the own scene, if it is one.
    pub fn take(self, editor: &mut Editor) {
        if let Ok(theirs) = self.document {
            editor.begin(OUTSIDE);
            editor.take_theirs(theirs);
        }
    }

    /// Asks which of both is to stay: Yes for the own, No for theirs, and Other for both.
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
                    // None of them is what Enter means.
                    if ui.button("Keep mine").clicked() {
                        *answer = Reply::Yes;
                    }
                    let can_take = self.document.is_ok();
                    let take = egui::Button::new("Take theirs");
                    if ui.add_enabled(can_take, take).clicked() {
                        *answer = Reply::No;
                    }
                    if ui.button("Save as…").clicked() {
                        *answer = Reply::Other;
                    }
                });
            },
        )
    }

    fn describe(&self, ui: &mut Ui) {
        ui.label(match &self.document {
            Ok(_) => "You have unsaved changes. In the file, compared with yours:",
            Err(_) => "The file can no longer be read:",
        });
        for line in self.lines.iter().take(MOST_LINES) {
            // Below a sentence stands what must keep its columns.
            let (sentence, excerpt) = line.split_once('\n').unwrap_or((line, ""));
            ui.weak(sentence);
            if !excerpt.is_empty() {
                ui.weak(egui::RichText::new(excerpt).monospace());
            }
        }
    }
}
