//! Undo and redo: whole scenes, which share what did not change only as `Arc`s; a scene is small.

use std::sync::Arc;

use super::Selection;
use crate::scene::Scene;

/// Steps that can be taken back; older ones are forgotten.
const DEPTH: usize = 500;

/// A state to return to.
#[derive(Clone, Debug)]
pub struct Snapshot {
    pub scene: Arc<Scene>,
    pub selection: Selection,
}

/// The steps before and after the present, each with the name of what was done.
#[derive(Debug, Default)]
pub struct History {
    done: Vec<(String, Snapshot)>,
    undone: Vec<(String, Snapshot)>,
    /// The name of the step that edits are still joined to.
    gesture: Option<String>,
}

impl History {
    /// Notes that `before` was left by doing `label`. During a gesture, edits of the same name are
    /// one step.
    pub fn record(&mut self, label: String, before: Snapshot) {
        self.undone.clear();
        if self.gesture.as_ref() == Some(&label) {
            return;
        }
        if self.done.len() == DEPTH {
            self.done.remove(0);
        }
        self.gesture = Some(label.clone());
        self.done.push((label, before));
    }

    pub fn end_gesture(&mut self) {
        self.gesture = None;
    }

    pub fn undo_label(&self) -> Option<&str> {
        self.done.last().map(|(label, _)| label.as_str())
    }

    pub fn redo_label(&self) -> Option<&str> {
        self.undone.last().map(|(label, _)| label.as_str())
    }

    pub fn undo(&mut self, here: Snapshot) -> Option<Snapshot> {
        self.gesture = None;
        let (label, there) = self.done.pop()?;
        self.undone.push((label, here));
        Some(there)
    }

    pub fn redo(&mut self, here: Snapshot) -> Option<Snapshot> {
        self.gesture = None;
        let (label, there) = self.undone.pop()?;
        self.done.push((label, here));
        Some(there)
    }
}
