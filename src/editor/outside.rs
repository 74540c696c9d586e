//! Files written by other programs, and by other runs of this one.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::document::Editor;
use super::own_file::OwnFile;
use crate::files::{Stamp, is_same_file};
use crate::scene::{Document, Leftover, MeshSource, Scene};

/// Value of `Message::about` for messages about meshes whose files are broken.
const BROKEN: &str = "broken meshes";

impl Editor {
    /// Opens unsaved work that another run of the program left behind. If others have written its file since, the
    /// user is asked, as for any change from outside.
    pub fn recover(&mut self, leftover: Leftover) {
        self.replace(leftover.document, leftover.path);
        self.stamp = leftover.stamp;
        self.saved = Arc::new(Scene::empty());
        self.is_dirty = true;
    }

    /// State of the document's file, as last observed.
    pub fn own_file(&self) -> OwnFile {
        self.own_file
    }

    /// Sets the state of the document's file: content that is in no file counts as unsaved.
    pub fn set_own_file(&mut self, own_file: OwnFile) {
        self.own_file = own_file;
    }

    /// Whether another program has written the document's file since this window read or wrote it.
    pub fn is_changed_outside(&self) -> bool {
        let known = self.path.as_ref().zip(self.stamp.as_ref());
        known.is_some_and(|(path, stamp)| stamp.is_touched(path) && stamp.is_outdated(path))
    }

    /// Whether saving to `path` would replace something in the document's own file that this window has not
    /// seen.
    pub fn would_lose(&self, path: &Path) -> bool {
        let known = self.path.as_ref().zip(self.stamp.as_ref());
        known.is_some_and(|(own, stamp)| is_same_file(own, path) && stamp.is_outdated(own))
    }

    /// Replaces the scene with what another program has written, as a step that can be undone.
    pub fn take_theirs(&mut self, (document, stamp): (Document, Stamp)) {
        let before = self.snapshot();
        let theirs = Arc::new(document.scene);
        self.header = document.header.into();
        (self.stamp, self.own_file) = (Some(stamp), OwnFile::Whole);
        self.saved = Arc::clone(&theirs);
        if theirs == self.scene {
            // The file differs, but describes the same scene.
            self.is_dirty = false;
            return;
        }
        self.history.end_gesture(&self.scene);
        self.history.record("Reload".to_owned(), before, &theirs);
        self.history.end_gesture(&theirs);
        self.selection = self.selection.followed(&self.scene, &theirs);
        self.set_scene(theirs);
        self.notify_of_step(format!(
            "{} was changed by another program and reloaded; undo brings yours back",
            self.title()
        ));
        self.report_missing_meshes();
    }

    /// Takes mesh files that another program has written into the document: into the current scene and into every
    /// undo and redo state. Meshes whose files can no longer be read stay as they are.
    pub fn take_meshes(&mut self, read: Vec<MeshSource>) {
        let before = self.broken.len();
        let mut names = Vec::new();
        for read in read {
            let read = self.scene.checked_read(read);
            let Some((folder, path)) = read.reference() else {
                continue;
            };
            let full = folder.join(path);
            if let Some(why) = read.problem() {
                self.note_broken_mesh(full, why);
            } else {
                self.broken.remove(&full);
                names.push(path.to_owned());
            }
            let (reference, is_readable) = (read.reference(), read.problem().is_none());
            // A file that has become unreadable does not replace what was last read from it successfully.
            let is_replaced = |old: &MeshSource| {
                old.reference() == reference && (is_readable || old.problem().is_some())
            };
            self.reread.retain(|old| !is_replaced(old));
            self.reread.push(read);
        }
        if self.broken.len() < before {
            // One of them can be read again.
            self.begin(BROKEN);
        }
        let scene = self.refreshed(&self.scene);
        if Arc::ptr_eq(&scene, &self.scene) {
            return;
        }
        self.saved = if Arc::ptr_eq(&self.scene, &self.saved) {
            Arc::clone(&scene)
        } else {
            self.refreshed(&self.saved)
        };
        self.set_scene(scene);
        let subject = match &names[..] {
            [] => String::new(),
            [one] => format!("{one} was"),
            [one, more @ ..] => format!("{one} and {} more were", more.len()),
        };
        if !subject.is_empty() {
            self.notify(format!("{subject} changed by another program and reloaded"));
        }
        self.report_missing_meshes();
    }

    /// Whether the document is the only place that still has the content of a file: its own file is gone or
    /// unreadable, or the file of a mesh in use is unreadable.
    pub(super) fn has_lost_files(&self) -> bool {
        self.own_file != OwnFile::Whole || !self.scene.files_in_use(&self.broken).is_empty()
    }

    /// Notes that another program has overwritten a mesh file with something that is no mesh.
    fn note_broken_mesh(&mut self, full: PathBuf, why: &str) {
        let one = BTreeSet::from([full]);
        if !self.scene.files_in_use(&one).is_empty() {
            self.broken.extend(one);
            let text = format!("{why}; the version read before is kept and saved with the scene");
            self.report_error_in(BROKEN, text);
        }
    }

    /// Returns a clause that names the meshes that saving has taken into the scene file, because their own files are
    /// gone, broken or in another folder; empty for none.
    pub(super) fn lost_meshes(&self, saved: &Scene) -> String {
        let broken = self.scene.files_in_use(&self.broken).into_iter();
        let broken = broken.filter_map(|path| path.file_name()?.to_str());
        let gone = self.scene.gone_mesh_files().into_iter();
        let lost: BTreeSet<&str> = gone.chain(broken).collect();
        let elsewhere = &self.scene.mesh_paths() - &saved.mesh_paths();
        let elsewhere = &elsewhere - &lost;
        let clause = |names: BTreeSet<&str>, why| {
            let names = names.into_iter().collect::<Vec<_>>().join(", ");
            let text =
                format!("; the contents of {names} are in the scene file now, because {why}");
            if names.is_empty() {
                String::new()
            } else {
                text
            }
        };
        clause(lost, "they are missing or no longer readable")
            + &clause(
                elsewhere,
                "they are in another folder, and are no longer followed",
            )
    }

    /// Returns a copied part of the scene with the current contents of mesh files.
    pub fn up_to_date(&self, part: &Scene) -> Scene {
        let new = part.with_read(&self.reread);
        new.unwrap_or_else(|| part.clone())
    }

    /// Returns the scene with the current contents of mesh files.
    pub(super) fn refreshed(&self, scene: &Arc<Scene>) -> Arc<Scene> {
        let new = scene.with_read(&self.reread);
        new.map_or_else(|| Arc::clone(scene), Arc::new)
    }

    /// Keeps the scene although another program has written its file; the next save replaces that. If the file cannot
    /// be read, `unread` is its stamp.
    pub fn keep_mine(&mut self, theirs: Option<(Document, Stamp)>, unread: Option<Stamp>) {
        let (theirs, stamp) = theirs.map_or((None, unread), |(theirs, stamp)| {
            (Some(Arc::new(theirs.scene)), Some(stamp))
        });
        self.is_dirty = theirs.as_ref() != Some(&self.scene);
        self.saved = theirs.unwrap_or_else(|| Arc::clone(&self.saved));
        (self.stamp, self.own_file) = (stamp, OwnFile::Whole);
    }
}
