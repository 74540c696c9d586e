//! What the user is told.

use super::action::Message;
use super::document::Editor;
use crate::scene::{Scene, Track};

/// What messages about edits are about.
const EDIT: &str = "edit";
/// What messages about meshes that are missing are about.
const MESHES: &str = "meshes";

impl Editor {
    /// Tells the user something.
    pub fn notify(&mut self, text: String) {
        self.messages.push(Message {
            is_error: false,
            text,
            about: "",
        });
    }

    /// An action is begun: what went wrong in it before is forgotten.
    pub fn begin(&mut self, about: &'static str) {
        self.messages.push(Message {
            is_error: false,
            text: String::new(),
            about,
        });
    }

    /// Tells the user that something went wrong.
    pub fn report_error(&mut self, text: String) {
        self.report_error_in("", text);
    }

    /// Tells the user that something went wrong in an action, see [`Self::begin`].
    pub fn report_error_in(&mut self, about: &'static str, text: String) {
        self.messages.push(Message {
            is_error: true,
            text,
            about,
        });
    }

    /// Says which meshes could not be read.
    pub(super) fn tell_missing_meshes(&mut self) {
        self.begin(MESHES);
        let mut problems = self.scene.mesh_problems();
        let Some((index, why)) = problems.next() else {
            return;
        };
        let more = match problems.count() {
            0 => String::new(),
            more => format!(" ({more} more are missing)"),
        };
        let name = &self.scene.objects[index].name;
        let text = format!("{name:?} is not in the picture: {why}{more}");
        self.report_error_in(MESHES, text);
    }

    /// Says that a mesh file was written by another program, and is none any more.
    pub(super) fn tell_broken_mesh(&mut self, why: &str) {
        self.begin(MESHES);
        self.report_error_in(MESHES, format!("{why}; what was read of it before stays"));
    }

    /// Says which values have no keys any more after an edit of this name.
    pub(super) fn tell_lost_keys(&mut self, label: &str, next: &Scene) {
        let is_lost = |track: &&Track| next.animation.track(&track.target).is_none();
        let lost = self.scene.animation.tracks.iter().filter(is_lost);
        let names: Vec<String> = lost.map(|track| track.target.name()).collect();
        if !names.is_empty() {
            let names = names.join(", ");
            self.notify(format!("{label}: it has no keys of {names} any more"));
        }
    }

    /// Tells why an edit is not made.
    pub(super) fn refuse(&mut self, why: String) {
        self.is_refused = true;
        self.report_error_in(EDIT, why);
    }

    /// An edit was made: why the last one was not is forgotten.
    pub(super) fn forget_refusal(&mut self) {
        if std::mem::take(&mut self.is_refused) {
            self.begin(EDIT);
        }
    }
}
