//! What the user is told.

use std::collections::HashSet;

use indexmap::IndexSet;

use super::action::{Message, STEP};
use super::document::Editor;
use crate::scene::{Animation, Object, Scene, Target};
use crate::words::{counted, listed};

/// What messages about edits are about.
const EDIT: &str = "edit";
/// What messages about meshes that are missing are about.
const MESHES: &str = "meshes";
/// What messages about meshes are about whose files are broken.
const BROKEN: &str = "broken meshes";

impl Editor {
    fn say(&mut self, is_error: bool, about: &'static str, text: String) {
        self.messages.push(Message {
            is_error,
            text,
            about,
        });
    }

    /// Tells the user something.
    pub fn notify(&mut self, text: String) {
        self.say(false, "", text);
    }

    /// Tells the user something, in place of what was said about the same before.
    pub fn notify_about(&mut self, about: &'static str, text: String) {
        self.begin(about);
        self.say(false, about, text);
    }

    /// Tells the user what the last step has done; nothing any more once that is undone.
    pub fn notify_of_step(&mut self, text: String) {
        self.told_of = self.revision();
        // Of the step before it, nothing is to be undone at once.
        self.notify_about(STEP, text);
    }

    /// What was said of the last step is forgotten, if there was no other since: it is undone.
    pub(super) fn forget_step(&mut self) {
        if self.told_of == self.revision() {
            self.begin(STEP);
        }
    }

    /// An action is begun: what was said of it before is forgotten.
    pub fn begin(&mut self, about: &'static str) {
        self.say(false, about, String::new());
    }

    /// Tells the user that something went wrong.
    pub fn report_error(&mut self, text: String) {
        self.report_error_in("", text);
    }

    /// Tells the user that something went wrong in an action, see [`Self::begin`].
    pub fn report_error_in(&mut self, about: &'static str, text: String) {
        self.say(true, about, text);
    }

    /// The last error of an action, if nobody was told of it yet: nobody is, then.
    pub fn take_error(&mut self, about: &str) -> Option<String> {
        let is_it = |message: &Message| message.is_error && message.about == about;
        let index = self.messages.iter().rposition(is_it)?;
        Some(self.messages.remove(index).text)
    }

    /// Says which meshes could not be read.
    pub fn tell_missing_meshes(&mut self) {
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
        let text = format!("{why}; the version read before is kept and saved with the scene");
        self.report_error_in(BROKEN, text);
    }

    /// One of those can be read again.
    pub(super) fn forget_broken_meshes(&mut self) {
        self.begin(BROKEN);
    }

    /// What is not there any more after a step of this name: things were deleted, or these objects joined or taken apart.
    pub(super) fn lost(&self, label: &str, joined: &[usize], next: &Scene) -> Option<String> {
        let lost: Vec<String> = self
            .lost_keys(next)
            .into_iter()
            .chain(self.lost_looks(joined))
            .collect();
        (!lost.is_empty()).then(|| format!("{label}: {}", lost.join("; ")))
    }

    fn lost_keys(&self, next: &Scene) -> Option<String> {
        let kept = next.animation.tracks.iter().map(|track| &track.target);
        let kept: HashSet<&Target> = kept.collect();
        let tracks = self.scene.animation.tracks.iter();
        let targets = tracks.map(|track| &track.target);
        let lost = targets.filter(|target| !kept.contains(target));
        let keys = listed(lost.map(Target::name));
        keys.map(|names| format!("keys were deleted too ({names}); undo brings them back"))
    }

    /// Color packs that all but the first wore, smoothness, and what was hidden among them.
    fn lost_looks(&self, joined: &[usize]) -> Vec<String> {
        let Some((first, others)) = joined.split_first() else {
            return Vec::new();
        };
        let pack = |index: &usize| Some(&self.scene.objects.get(*index)?.color_pack);
        let own = pack(first).map_or("", String::as_str);
        let packs: IndexSet<&String> = others.iter().filter_map(pack).collect();
        let packs = packs.into_iter().filter(|pack| *pack != own).cloned();
        let packs = listed(packs)
            .map(|names| format!("all of it uses {own} now, including what used {names}"));
        let flat = others.is_empty().then_some(*first).filter(|&index| {
            let object = self.scene.objects.get(index);
            object.is_some_and(Object::is_smooth)
        });
        let flat = flat.map(|_| "its faces are shaded flat now".to_owned());
        let objects = joined
            .iter()
            .filter_map(|&index| self.scene.objects.get(index));
        let (seen, hidden): (Vec<_>, Vec<_>) = objects.partition(|object| object.visible);
        let hidden = hidden.iter().map(|object| object.name.clone());
        let hidden = listed(hidden).filter(|_| !seen.is_empty());
        let hidden = hidden.map(|names| format!("what was hidden is visible now ({names})"));
        packs.into_iter().chain(flat).chain(hidden).collect()
    }

    /// Tells why an edit is not made; false, since it was not.
    pub(super) fn refuse(&mut self, why: String) -> bool {
        // One that is made anew with every step of a drag may be refused in other words each time.
        self.forget_refusal();
        self.is_refused = true;
        self.report_error_in(EDIT, why);
        false
    }

    /// An edit was made: why the last one was not is forgotten.
    pub(super) fn forget_refusal(&mut self) {
        if std::mem::take(&mut self.is_refused) {
            self.begin(EDIT);
        }
    }
}

/// What new keys of the camera, which `name` has brought, have replaced, in words; `None` if nothing.
pub fn replaced_flight(name: &str, animation: &Animation) -> Option<String> {
    let keys = counted(animation.keys.len(), "key");
    let recording = match animation.take {
        Some(_) => " and the recording",
        None => "",
    };
    let words =
        format!("{name} has replaced {keys} of the camera{recording}; undo brings them back");
    (!animation.keys.is_empty()).then_some(words)
}
