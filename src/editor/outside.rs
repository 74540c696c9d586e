//! What other programs, and other runs of this one, have written.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::document::Editor;
use super::own_file::OwnFile;
use crate::files::{Stamp, is_same_file};
use crate::scene::{Document, Leftover, MeshSource, Scene};

impl Editor {
    /// Takes up unsaved work that another run of the program left behind. What others have written to its file since
    /// is asked about like other changes from outside.
    pub fn recover(&mut self, leftover: Leftover) {
        self.replace(leftover.document, leftover.path);
        self.stamp = leftover.stamp;
        self.saved = Arc::new(Scene::empty());
        self.is_dirty = true;
    }

    /// How the document's file is, as far as is known.
    pub fn own_file(&self) -> OwnFile {
        self.own_file
    }

    /// How it is: what no file has counts as unsaved.
    pub fn set_own_file(&mut self, own_file: OwnFile) {
        self.own_file = own_file;
    }

    /// Whether another program has written the document's file since this window read or wrote it.
    pub fn is_changed_outside(&self) -> bool {
        match (&self.path, &self.stamp) {
            (Some(path), Some(stamp)) => stamp.is_touched(path) && stamp.is_outdated(path),
            _ => false,
        }
    }

    /// Whether saving to `path` would replace something in the document's own file that this window has not
    /// seen.
    pub fn would_lose(&self, path: &Path) -> bool {
        match (&self.path, &self.stamp) {
            (Some(own), Some(stamp)) => is_same_file(own, path) && stamp.is_outdated(own),
            _ => false,
        }
    }

    /// Takes what another program has written in place of the scene, as a step that can be undone.
    pub fn take_theirs(&mut self, (document, stamp): (Document, Stamp)) {
        let before = self.here();
        let theirs = Arc::new(document.scene);
        self.header = document.header;
        (self.stamp, self.own_file) = (Some(stamp), OwnFile::Whole);
        self.saved = Arc::clone(&theirs);
        if theirs == self.scene {
            // Other words for the same.
            self.is_dirty = false;
            return;
        }
        self.history.end_gesture(&self.scene);
        self.history.record("Reload".to_owned(), before, &theirs);
        self.history.end_gesture(&theirs);
        self.selection = self.followed(&theirs);
        self.set_scene(theirs);
        self.notify_of_step(format!(
            "{} was changed by another program and reloaded; undo brings yours back",
            self.title()
        ));
        self.tell_missing_meshes();
    }

    /// Takes what another program has written to files of meshes, wherever the document shows them: now, and before or
    /// after any step that is undone or done again. What cannot be read any more stays as it is.
    pub fn take_meshes(&mut self, read: Vec<MeshSource>) {
        let before = self.broken.len();
        let mut names = Vec::new();
        for read in read {
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
            let (own, is_good) = (read.reference(), read.problem().is_none());
            // What was read last of what is broken is what is shown of it.
            let is_replaced =
                |old: &MeshSource| old.reference() == own && (is_good || old.problem().is_some());
            self.reread.retain(|old| !is_replaced(old));
            self.reread.push(read);
        }
        if self.broken.len() < before {
            self.forget_broken_meshes();
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
        let who = match &names[..] {
            [] => String::new(),
            [one] => format!("{one} was"),
            [one, more @ ..] => format!("{one} and {} more were", more.len()),
        };
        if !who.is_empty() {
            self.notify(format!("{who} changed by another program and reloaded"));
        }
        self.tell_missing_meshes();
    }

    /// Whether the document alone has what was in a file: its own is not there any more, or it or that of a mesh that is
    /// shown holds something else now that cannot be read.
    pub(super) fn has_lost_files(&self) -> bool {
        self.own_file != OwnFile::Whole || !self.scene.shown_of(&self.broken).is_empty()
    }

    fn note_broken_mesh(&mut self, full: PathBuf, why: &str) {
        let one = BTreeSet::from([full]);
        if !self.scene.shown_of(&one).is_empty() {
            self.broken.extend(one);
            self.tell_broken_mesh(why);
        }
    }

    /// Says which meshes are in the scene file once it is saved like this, because their own files are gone, broken, or
    /// in another folder; nothing for none.
    pub(super) fn lost_meshes(&self, saved: &Scene) -> String {
        let broken = self.scene.shown_of(&self.broken).into_iter();
        let broken = broken.filter_map(|path| path.file_name()?.to_str());
        let gone = self.scene.gone_mesh_files().into_iter();
        let lost: BTreeSet<&str> = gone.chain(broken).collect();
        let elsewhere = &self.scene.mesh_paths() - &saved.mesh_paths();
        let elsewhere = &elsewhere - &lost;
        let told = |names: BTreeSet<&str>, why| {
            let names = names.into_iter().collect::<Vec<_>>().join(", ");
            let words = format!("; the contents of {names} are in the scene file now: {why}");
            if names.is_empty() {
                String::new()
            } else {
                words
            }
        };
        told(lost, "missing, or no longer readable")
            + &told(elsewhere, "in another folder, and no longer followed")
    }

    /// A part of the scene, as it was copied, with what mesh files hold now.
    pub fn up_to_date(&self, part: &Scene) -> Scene {
        let new = part.with_read(&self.reread);
        new.unwrap_or_else(|| part.clone())
    }

    /// The scene with what mesh files hold now.
    pub(super) fn refreshed(&self, scene: &Arc<Scene>) -> Arc<Scene> {
        let new = scene.with_read(&self.reread);
        new.map_or_else(|| Arc::clone(scene), Arc::new)
    }

    /// Keeps the scene beside what another program has written; the next save replaces that. What cannot be read of it
    /// has a stamp all the same.
    pub fn keep_mine(&mut self, theirs: Option<(Document, Stamp)>, unread: Option<Stamp>) {
        let (theirs, stamp) = theirs.map_or((None, unread), |(theirs, stamp)| {
            (Some(Arc::new(theirs.scene)), Some(stamp))
        });
        self.is_dirty = theirs.as_ref() != Some(&self.scene);
        self.saved = theirs.unwrap_or_else(|| Arc::clone(&self.saved));
        (self.stamp, self.own_file) = (stamp, OwnFile::Whole);
    }
}
