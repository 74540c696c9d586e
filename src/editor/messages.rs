//! Messages to the user.

use indexmap::IndexSet;

use super::action::{Message, STEP};
use super::document::Editor;
use crate::scene::{Animation, Object, Scene, Target};
use crate::words::{counted, listed};

/// Value of [`Message::about`] for messages about edits.
const EDIT: &str = "edit";
/// Value of [`Message::about`] for messages about missing meshes.
const MESHES: &str = "meshes";

impl Editor {
    fn push_message(&mut self, is_error: bool, about: &'static str, text: String) {
        self.messages.push(Message {
            is_error,
            text,
            about,
        });
    }

    /// Shows the user a message.
    pub fn notify(&mut self, text: String) {
        self.push_message(false, "", text);
    }

    /// Shows the user a message that replaces earlier ones about the same.
    pub fn notify_about(&mut self, about: &'static str, text: String) {
        self.begin(about);
        self.push_message(false, about, text);
    }

    /// Shows the user a message about the effects of the last step, which is dismissed when that is undone.
    pub fn notify_of_step(&mut self, text: String) {
        self.step_message_revision = self.revision();
        // It replaces the message about the step before, which undo would not revert first.
        self.notify_about(STEP, text);
    }

    /// Dismisses the message about the last step, if there was no other step since: it is being undone.
    pub(super) fn dismiss_step_message(&mut self) {
        if self.step_message_revision == self.revision() {
            self.begin(STEP);
        }
    }

    /// Notes that an action starts: earlier messages about it are dismissed.
    pub fn begin(&mut self, about: &'static str) {
        self.push_message(false, about, String::new());
    }

    /// Shows the user an error.
    pub fn report_error(&mut self, text: String) {
        self.report_error_in("", text);
    }

    /// Shows the user an error of an action, see [`Self::begin`].
    pub fn report_error_in(&mut self, about: &'static str, text: String) {
        self.push_message(true, about, text);
    }

    /// Removes and returns the last error of an action that has not been shown yet.
    pub fn take_error(&mut self, about: &str) -> Option<String> {
        let is_match = |message: &Message| message.is_error && message.about == about;
        let index = self.messages.iter().rposition(is_match)?;
        Some(self.messages.remove(index).text)
    }

    /// Reports meshes that could not be read.
    pub fn report_missing_meshes(&mut self) {
        self.begin(MESHES);
        let mut problems = self.scene.mesh_problems();
        let Some((index, why)) = problems.next() else {
            return;
        };
        let more = match problems.count() {
            0 => String::new(),
            more => format!(" ({more} more missing)"),
        };
        let name = &self.scene.objects[index].name;
        let text = format!("{name:?} is not in the picture: {why}{more}");
        self.report_error_in(MESHES, text);
    }

    /// Returns a message about what is lost by a step named `label` that deletes things, or joins or splits the
    /// objects `joined`; `None` if nothing is.
    pub(super) fn lost(&self, label: &str, joined: &[usize], next: &Scene) -> Option<String> {
        let losses: Vec<String> = self
            .lost_keys(next)
            .into_iter()
            .chain(self.lost_appearance(joined))
            .collect();
        (!losses.is_empty()).then(|| format!("{label}: {}", losses.join("; ")))
    }

    fn lost_keys(&self, next: &Scene) -> Option<String> {
        let lost = self.scene.animation.targets_lost_in(&next.animation);
        let keys = listed(lost.into_iter().map(Target::name));
        keys.map(|names| format!("keys were deleted too ({names}); undo brings them back"))
    }

    /// Returns clauses about lost appearance: color packs of all joined objects but the first, smoothness, and which
    /// of them were hidden.
    fn lost_appearance(&self, joined: &[usize]) -> Vec<String> {
        let objects = joined.iter();
        let objects = objects.filter_map(|&index| self.scene.objects.get(index));
        let objects: Vec<&Object> = objects.collect();
        let Some((first, others)) = objects.split_first() else {
            return Vec::new();
        };
        let own_pack = &first.color_pack;
        let packs: IndexSet<&String> = others.iter().map(|object| &object.color_pack).collect();
        let packs = packs.into_iter().filter(|pack| *pack != own_pack).cloned();
        let packs = listed(packs)
            .map(|names| format!("all of it uses {own_pack} now, including what used {names}"));
        let is_flat_now = others.is_empty() && first.is_smooth();
        let flat = is_flat_now.then(|| "its faces are shaded flat now".to_owned());
        let (seen, hidden): (Vec<_>, Vec<_>) =
            objects.into_iter().partition(|object| object.visible);
        let hidden = hidden.iter().map(|object| object.name.clone());
        let hidden = listed(hidden).filter(|_| !seen.is_empty());
        let hidden = hidden.map(|names| format!("what was hidden is visible now ({names})"));
        packs.into_iter().chain(flat).chain(hidden).collect()
    }

    /// Reports why an edit was refused; returns false for the caller to return.
    pub(super) fn refuse(&mut self, why: String) -> bool {
        // An edit repeated with every step of a drag may be refused with different words each time.
        self.dismiss_refusal();
        self.is_refused = true;
        self.report_error_in(EDIT, why);
        false
    }

    /// Dismisses the reason why the last edit was refused: another one was made.
    pub(super) fn dismiss_refusal(&mut self) {
        if std::mem::take(&mut self.is_refused) {
            self.begin(EDIT);
        }
    }
}

/// Returns a sentence that tells which keys of the camera, those of `animation`, were replaced by new ones from
/// `name`; `None` if there were none.
pub fn replaced_flight(name: &str, animation: &Animation) -> Option<String> {
    let keys = counted(animation.keys.len(), "key");
    let (recording, them) = match (&animation.take, animation.keys.len()) {
        (Some(_), _) => (" and the recording", "them"),
        (None, 1) => ("", "it"),
        (None, _) => ("", "them"),
    };
    let sentence =
        format!("{name} has replaced {keys} of the camera{recording}; undo brings {them} back");
    (!animation.keys.is_empty()).then_some(sentence)
}
