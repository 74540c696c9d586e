//! Undo and redo: whole scenes, which share what did not change.

use std::collections::VecDeque;
use std::sync::Arc;

use super::selection::Selection;
use super::timeline::ViewState;
use crate::scene::Scene;

/// Steps that can be taken back; older ones are forgotten.
const MOST_STEPS: usize = 500;
/// Memory that steps may keep for themselves, in bytes; older ones are forgotten, but for the last.
const MOST_BYTES: usize = 128 << 20;

/// A state to return to.
#[derive(Clone, Debug)]
pub struct Snapshot {
    /// The scene.
    pub scene: Arc<Scene>,
    /// What was selected.
    pub selection: Selection,
    /// What was looked at.
    pub look: ViewState,
}

/// A step that was done, or taken back.
#[derive(Clone, Debug)]
struct Step {
    label: String,
    /// The state on the other side of it.
    there: Snapshot,
    /// What was selected when it was done, if that was noted.
    selected: Option<Selection>,
    /// What the two states do not share.
    bytes: usize,
}

/// The steps before and after the present, each with the name of what was done.
#[derive(Debug, Default)]
pub struct History {
    done: VecDeque<Step>,
    undone: Vec<Step>,
    /// Those that were undone before the gesture that goes on: it may come to nothing.
    aside: Vec<Step>,
    /// The name of the step that edits are still joined to.
    gesture: Option<String>,
}

impl History {
    /// Notes that `before` was left for `after` by doing `label`. During a gesture, edits of the same
    /// name are one step. What was undone can be done again after a look from elsewhere.
    pub fn record(&mut self, label: String, before: Snapshot, after: &Scene) {
        let is_going_on = self.gesture.as_ref() == Some(&label);
        if !is_going_on {
            self.aside = self.undone.clone();
        }
        self.keep_undone(&before.scene, after);
        if is_going_on {
            return;
        }
        self.gesture = Some(label.clone());
        let bytes = before.scene.bytes_apart(after);
        self.done.push_back(Step {
            label,
            there: before,
            selected: None,
            bytes,
        });
        let mut bytes: usize = self.done.iter().map(|step| step.bytes).sum();
        while self.done.len() > MOST_STEPS || (bytes > MOST_BYTES && self.done.len() > 1) {
            let forgotten = self.done.pop_front();
            bytes -= forgotten.map_or(0, |step| step.bytes);
        }
    }

    /// Keeps what can be done again after a change: nothing, if it is one of more than the view. What was done where the
    /// camera was before is seen from where it is now.
    fn keep_undone(&mut self, before: &Scene, after: &Scene) {
        let looking = |scene: &Scene| Scene {
            camera: after.camera.clone(),
            ..scene.clone()
        };
        if self.undone.is_empty() || looking(before) != *after {
            return self.undone.clear();
        }
        let from_there = |step: &&mut Step| step.there.scene.camera == before.camera;
        for step in self.undone.iter_mut().rev().take_while(from_there) {
            step.there.scene = Arc::new(looking(&step.there.scene));
        }
    }

    /// Notes what the step that goes on has selected: doing it again selects that.
    pub fn note_selected(&mut self, selection: &Selection) {
        if let Some(step) = self.done.back_mut().filter(|_| self.gesture.is_some()) {
            step.selected = Some(selection.clone());
        }
    }

    /// Whether a gesture goes on.
    pub fn is_in_gesture(&self) -> bool {
        self.gesture.is_some()
    }

    /// The next edit is a step of its own. A gesture that ends `here`, where it began, was none.
    pub fn end_gesture(&mut self, here: &Scene) {
        let aside = std::mem::take(&mut self.aside);
        let was_any = self.gesture.take().is_some();
        if was_any
            && self
                .done
                .back()
                .is_some_and(|step| *step.there.scene == *here)
        {
            self.done.pop_back();
            self.undone = aside;
        }
    }

    /// The state before the gesture that goes on, which is forgotten; `None` if nothing was done in it.
    pub fn cancel_gesture(&mut self) -> Option<Snapshot> {
        self.gesture.take()?;
        self.undone = std::mem::take(&mut self.aside);
        self.done.pop_back().map(|step| step.there)
    }

    /// The name of the last step.
    pub fn undo_label(&self) -> Option<&str> {
        self.done.back().map(|step| step.label.as_str())
    }

    /// The name of the step that was taken back last.
    pub fn redo_label(&self) -> Option<&str> {
        self.undone.last().map(|step| step.label.as_str())
    }

    /// Takes the last step back from `here`.
    pub fn undo(&mut self, here: Snapshot) -> Option<Snapshot> {
        self.gesture = None;
        let step = self.done.pop_back()?;
        let selection = step.selected.unwrap_or(here.selection);
        self.undone.push(Step {
            there: Snapshot { selection, ..here },
            selected: None,
            ..step
        });
        Some(step.there)
    }

    /// Does the step again that was taken back last.
    pub fn redo(&mut self, here: Snapshot) -> Option<Snapshot> {
        self.gesture = None;
        let step = self.undone.pop()?;
        self.done.push_back(Step {
            there: here,
            selected: Some(step.there.selection.clone()),
            ..step
        });
        Some(step.there)
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
            selection: Selection::default(),
            look: ViewState::default(),
        }
    }

    /// As many objects as a file can hold, or so.
    fn large() -> Scene {
        let mut scene = Scene::empty();
        let shape = Shape::examples(DVec3::ZERO, 1.0).remove(0);
        scene.objects = (0..100_000)
            .map(|number| Object {
                name: format!("Object {number}"),
                color_pack: "pack 1".to_owned(),
                shape: shape.clone(),
                visible: true,
                group: String::new(),
            })
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
        // What is given up takes nothing away.
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
        assert_eq!(history.done.len(), MOST_STEPS);
        let bytes: usize = history.done.iter().map(|step| step.bytes).sum();
        assert!(bytes < 50 << 20, "{bytes} bytes for {MOST_STEPS} steps");
        for step in 0..12 {
            history.end_gesture(&scene);
            let before = snapshot(&scene);
            for object in scene.objects.iter_mut() {
                object.visible = !object.visible;
            }
            history.record(format!("Hide {step}"), before, &scene);
        }
        let bytes: usize = history.done.iter().map(|step| step.bytes).sum();
        assert!(bytes <= MOST_BYTES && history.done.len() < 12, "{bytes}");
    }
}
