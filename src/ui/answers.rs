//! Handles the answers of the render thread, and drops those about a document that is no longer open.

use std::time::Duration;

use egui::Context;

use super::app::App;
use super::inspector::Outcome;
use crate::editor::{Action, Time};
use crate::worker::Answer;

/// Time between two checks whether something is still being dragged.
const DRAG_POLL: Duration = Duration::from_millis(50);

impl App {
    /// Handles the render thread's answers. Those that change the document wait until nothing is dragged or flown: they
    /// would be an undo step of their own in the middle of another.
    pub(super) fn take_answers(&mut self, ctx: &Context) {
        let is_busy = self.is_gesture(ctx) || self.editor.is_in_gesture();
        let is_moving = is_busy || self.editor.is_moving();
        let mut answers = std::mem::take(&mut self.answers);
        answers.extend(self.pictures.worker().take_answers());
        for answer in answers {
            match answer {
                Answer::Survey(..) if is_busy => self.answers.push(answer),
                Answer::Quality(..) if is_moving => self.answers.push(answer),
                Answer::Survey(take, seen) => {
                    self.editor.apply(Action::Time(Time::Surveyed(take, seen)));
                }
                Answer::Visible(revision, ticks) => self.overlay.take_visible(revision, ticks),
                Answer::Objects(revision, map, without) => {
                    let selected = self.tools.take(&self.editor, (revision, map), &without);
                    if let Some(selected) = selected {
                        self.editor.apply(Action::Select(selected));
                    }
                }
                Answer::Quality(goal, choice) => {
                    match self.quality.take(goal, choice, &self.editor) {
                        Some(Outcome::Edit(edit)) => self.editor.apply(Action::Edit(edit)),
                        Some(Outcome::Ask(question)) => {
                            self.pictures.ask(&self.editor, vec![question]);
                        }
                        None => {}
                    }
                }
            }
        }
        if !self.answers.is_empty() {
            ctx.request_repaint_after(DRAG_POLL);
        }
    }

    /// Drops everything about the previous document if another one is open.
    pub(super) fn follow_document(&mut self) {
        let document = self.editor.documents();
        if std::mem::replace(&mut self.shown_document, document) != document {
            self.why.close();
            self.tools.rest();
            self.timeline.fit();
            let is_about = |answer: &Answer| matches!(answer, Answer::Quality(..));
            self.answers.retain(|answer| !is_about(answer));
            if let Some(request) = self.lab.forget() {
                self.pictures.handle_lab_request(request);
            }
        }
    }
}
