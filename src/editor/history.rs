//! Undo and redo: each state is a whole scene, which shares unchanged parts with the others.

use std::collections::VecDeque;
use std::sync::Arc;

use super::selection::Selection;
use super::timeline::ViewState;
use crate::scene::Scene;

/// Most steps that can be undone; older ones are dropped.
const MAX_STEPS: usize = 500;
/// Most memory, in bytes, that undo steps may take beyond what they share; older ones are dropped, except for the
/// last step.
const MAX_BYTES: usize = 128 << 20;

/// A state that undo or redo can return to.
#[derive(Clone, Debug)]
pub struct Snapshot {
    /// The scene.
    pub scene: Arc<Scene>,
    /// The comments before it in the file.
    pub header: Arc<str>,
    /// What was selected.
    pub selection: Selection,
    /// What was looked at, and at which time.
    pub view: ViewState,
}

/// A step that was done or undone.
#[derive(Clone, Debug)]
struct Step {
    label: String,
    /// The state on the other side of the step: before it if it was done, after it if it was undone.
    other_side: Snapshot,
    /// What was selected after the step, if that was noted.
    selected: Option<Selection>,
    /// Bytes that the two states do not share.
    bytes: usize,
}

/// The undo and redo steps, each with its name.
#[derive(Debug, Default)]
pub struct History {
    done: VecDeque<Step>,
    undone: Vec<Step>,
    /// The redo steps from before the current gesture, to be restored if that changes nothing.
    undone_before_gesture: Vec<Step>,
    /// Name of the step that further edits of the current gesture are merged into.
    gesture: Option<String>,
}

impl History {
    /// Notes that the step `label` led from `before` to `after`. During a gesture, edits of the same name are merged
    /// into one step. Redo stays possible after a mere move of the camera.
    pub fn record(&mut self, label: String, before: Snapshot, after: &Scene) {
        let continues_gesture = self.gesture.as_ref() == Some(&label);
        if !continues_gesture {
            self.undone_before_gesture = self.undone.clone();
        }
        self.keep_undone(&before.scene, after);
        if continues_gesture {
            return;
        }
        self.gesture = Some(label.clone());
        // About as much is selected after the step, which may be noted as well.
        let selected = size_of_val(before.selection.items()) * 2;
        let bytes = before.scene.unshared_bytes(after) + selected;
        self.done.push_back(Step {
            label,
            other_side: before,
            selected: None,
            bytes,
        });
        let mut bytes: usize = self.done.iter().map(|step| step.bytes).sum();
        while self.done.len() > MAX_STEPS || (bytes > MAX_BYTES && self.done.len() > 1) {
            let forgotten = self.done.pop_front();
            bytes -= forgotten.map_or(0, |step| step.bytes);
        }
    }

    /// Keeps the redo steps if a change was only one of the camera, and drops them otherwise. The next redo states,
    /// as far as they have the camera of before the change, get the new camera.
    fn keep_undone(&mut self, before: &Scene, after: &Scene) {
        let with_new_camera = |scene: &Scene| Scene {
            camera: after.camera.clone(),
            ..scene.clone()
        };
        if self.undone.is_empty() || with_new_camera(before) != *after {
            return self.undone.clear();
        }
        let has_old_camera = |step: &&mut Step| step.other_side.scene.camera == before.camera;
        for step in self.undone.iter_mut().rev().take_while(has_old_camera) {
            step.other_side.scene = Arc::new(with_new_camera(&step.other_side.scene));
        }
    }

    /// Notes the selection of the current step, which redo restores.
    pub fn note_selected(&mut self, selection: &Selection) {
        if let Some(step) = self.done.back_mut().filter(|_| self.gesture.is_some()) {
            step.selected = Some(selection.clone());
        }
    }

    /// Whether a gesture is going on.
    pub fn is_in_gesture(&self) -> bool {
        self.gesture.is_some()
    }

    /// Ends the gesture: the next edit is a new step. A gesture that ends `here`, in the scene it began with, leaves
    /// no step.
    pub fn end_gesture(&mut self, here: &Scene) {
        let undone = std::mem::take(&mut self.undone_before_gesture);
        let was_in_gesture = self.gesture.take().is_some();
        if was_in_gesture
            && self
                .done
                .back()
                .is_some_and(|step| *step.other_side.scene == *here)
        {
            self.done.pop_back();
            self.undone = undone;
        }
    }

    /// Drops the current gesture and returns the state before it; `None` if nothing was done in it.
    pub fn cancel_gesture(&mut self) -> Option<Snapshot> {
        self.gesture.take()?;
        self.undone = std::mem::take(&mut self.undone_before_gesture);
        self.done.pop_back().map(|step| step.other_side)
    }

    /// The name of the step that undo would take back.
    pub fn undo_label(&self) -> Option<&str> {
        self.done.back().map(|step| step.label.as_str())
    }

    /// The name of the step that redo would repeat.
    pub fn redo_label(&self) -> Option<&str> {
        self.undone.last().map(|step| step.label.as_str())
    }

    /// Undoes the last step, with `here` as the current state; returns the state before that step.
    pub fn undo(&mut self, here: Snapshot) -> Option<Snapshot> {
        self.gesture = None;
        let step = self.done.pop_back()?;
        let selection = step.selected.unwrap_or(here.selection);
        self.undone.push(Step {
            other_side: Snapshot { selection, ..here },
            selected: None,
            ..step
        });
        Some(step.other_side)
    }

    /// Repeats the step that was undone last, with `here` as the current state; returns the state after that step.
    pub fn redo(&mut self, here: Snapshot) -> Option<Snapshot> {
        self.gesture = None;
        let step = self.undone.pop()?;
        self.done.push_back(Step {
            other_side: here,
            selected: Some(step.other_side.selection.clone()),
            ..step
        });
        Some(step.other_side)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Object, Shape};
    use glam::DVec3;

    fn snapshot(scene: &Scene) -> Snapshot {
        Snapshot {
            scene: Arc::new(scene.clone()),
            header: "".into(),
            selection: Selection::default(),
            view: ViewState::default(),
        }
    }

    /// A scene of 100 000 objects, about as many as a file can hold.
    fn large() -> Scene {
        let mut scene = Scene::empty();
        let shape = Shape::examples(DVec3::ZERO, 1.0).remove(0);
        scene.objects = (0..100_000)
            .map(|number| Object::new(format!("Object {number}"), "pack 1", shape.clone()))
            .collect();
        scene
    }

    #[test]
    fn a_gesture_that_comes_to_nothing_leaves_what_can_be_done_again() {
        let scene = Scene::demo();
        let mut darker = scene.clone();
        darker.ambient_intensity = 0.1;
        for is_cancelled in [true, false] {
            let mut history = History::default();
            history.record("Darker".to_owned(), snapshot(&scene), &darker);
            history.end_gesture(&darker);
            assert!(history.undo(snapshot(&darker)).is_some());
            history.record("Move".to_owned(), snapshot(&scene), &darker);
            history.record("Move".to_owned(), snapshot(&darker), &scene);
            if is_cancelled {
                assert!(history.cancel_gesture().is_some());
            } else {
                history.end_gesture(&scene);
            }
            assert_eq!(
                (history.undo_label(), history.redo_label()),
                (None, Some("Darker"))
            );
            history.record("Move".to_owned(), snapshot(&scene), &darker);
            history.end_gesture(&darker);
            assert_eq!(
                (history.undo_label(), history.redo_label()),
                (Some("Move"), None)
            );
        }
    }

    #[test]
    fn what_was_undone_is_done_again_after_a_look_from_elsewhere() {
        let scene = Scene::demo();
        let with = |ambient: f64, x: f64| {
            let mut scene = Scene::demo();
            scene.ambient_intensity = ambient;
            scene.camera.position.x = x;
            scene
        };
        let x = scene.camera.position.x;
        let mut history = History::default();
        // Darker, and then seen from elsewhere.
        history.record("Darker".to_owned(), snapshot(&scene), &with(0.1, x));
        history.end_gesture(&with(0.1, x));
        history.record("Fly".to_owned(), snapshot(&with(0.1, x)), &with(0.1, 7.0));
        history.end_gesture(&with(0.1, 7.0));
        for here in [with(0.1, 7.0), with(0.1, x)] {
            assert!(history.undo(snapshot(&here)).is_some());
        }
        // A cancelled gesture drops no redo steps.
        history.record("Lighter".to_owned(), snapshot(&scene), &with(0.5, 1.0));
        history.cancel_gesture();
        // A drag of the camera, in two parts.
        let ambient = scene.ambient_intensity;
        let here = [with(ambient, x), with(ambient, 1.0), with(ambient, 2.0)];
        for pair in here.windows(2) {
            history.record("Orbit".to_owned(), snapshot(&pair[0]), &pair[1]);
        }
        history.end_gesture(&here[2]);
        assert_eq!(history.undo_label(), Some("Orbit"));
        let again = history.redo(snapshot(&here[2])).expect("darker");
        assert_eq!(*again.scene, with(0.1, 2.0));
        let again = history.redo(snapshot(&again.scene)).expect("flown");
        assert_eq!(*again.scene, with(0.1, 7.0));
        for scene in [with(0.1, 2.0), here[2].clone(), here[0].clone()] {
            let before = history.undo(snapshot(&again.scene)).expect("a step");
            assert_eq!(*before.scene, scene);
        }
        history.record("Lighter".to_owned(), snapshot(&here[0]), &with(0.9, x));
        assert_eq!(history.redo_label(), None);
    }

    #[test]
    fn moving_an_object_keeps_little_and_changing_all_is_forgotten_early() {
        let mut history = History::default();
        let mut scene = large();
        for step in 0..600 {
            history.end_gesture(&scene);
            let before = snapshot(&scene);
            let shape = scene.objects[777].shape.moved(DVec3::X);
            scene.objects[777].shape = shape;
            history.record(format!("Move {step}"), before, &scene);
        }
        assert_eq!(history.done.len(), MAX_STEPS);
        let bytes: usize = history.done.iter().map(|step| step.bytes).sum();
        assert!(bytes < 50 << 20, "{bytes} bytes for {MAX_STEPS} steps");
        for step in 0..12 {
            history.end_gesture(&scene);
            let before = snapshot(&scene);
            for object in scene.objects.iter_mut() {
                object.visible = !object.visible;
            }
            history.record(format!("Hide {step}"), before, &scene);
        }
        let bytes: usize = history.done.iter().map(|step| step.bytes).sum();
        assert!(bytes <= MAX_BYTES && history.done.len() < 12, "{bytes}");
    }
}
