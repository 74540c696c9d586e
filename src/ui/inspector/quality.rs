//! Automatic choice of the sampling for a scene, by measuring it.

use std::sync::Arc;
use std::time::Duration;

use crate::editor::{Edit, Editor};
use crate::lab::{Choice, EIGHT_BIT_FLOOR, Goal};
use crate::scene::{Render, Scene};
use crate::ui::requests::UiRequests;
use crate::ui::rows::FieldRows;
use crate::worker::Question;

/// The goals on offer, with their labels.
const GOALS: [(Option<Goal>, &str); 5] = [
    (None, "as set below"),
    (
        Some(Goal::Within(EIGHT_BIT_FLOOR)),
        "automatic: below 8-bit rounding",
    ),
    (
        Some(Goal::Within(FIFTY_DECIBELS)),
        "automatic: 50 dB, hardly visible",
    ),
    (
        Some(Goal::Budget(Duration::from_millis(16))),
        "automatic: within 16 ms",
    ),
    (
        Some(Goal::Budget(Duration::from_millis(100))),
        "automatic: within 100 ms",
    ),
];
/// The error that corresponds to 50 dB.
const FIFTY_DECIBELS: f64 = 3.162_277_660_168_379_5e-3;

/// The pending request for a sampling, and the last one chosen.
#[derive(Debug, Default)]
pub struct Quality {
    /// The measurement in progress.
    pending: Option<PendingMeasurement>,
    /// The last choice, and the document it was made for (see [`Editor::documents`]).
    choice: Option<(Choice, u64)>,
}

/// A measurement in progress: its goal, its scene, and the document (see [`Editor::documents`]).
#[derive(Debug)]
struct PendingMeasurement {
    goal: Goal,
    scene: Arc<Scene>,
    document: u64,
}

/// The outcome of an answer.
pub enum Outcome {
    /// The edit that applies the choice.
    Edit(Edit),
    /// The scene has changed since: the question is to be asked again.
    Ask(Question),
}

impl Quality {
    /// The last choice, if the scene still uses it.
    pub fn in_use(&self, editor: &Editor) -> Option<&Choice> {
        let (choice, document) = self.choice.as_ref()?;
        let antialias = editor.shown().render.antialias;
        (choice.sampling == antialias && *document == editor.documents()).then_some(choice)
    }

    /// Shows the row to choose a goal.
    pub fn show(&mut self, rows: &mut FieldRows, editor: &Editor, out: &mut UiRequests) {
        // The document that was asked about is no longer open.
        self.pending
            .take_if(|pending| pending.document != editor.documents());
        let pending = self.pending.as_ref().map(|pending| pending.goal);
        let before = pending.or(self.in_use(editor).map(|choice| choice.goal));
        let mut goal = before;
        let hint = "Measures the samplings on this scene at the size of its still picture and uses the cheapest \
            that is accurate enough, or the most accurate that is fast enough (one undo step); Needs tells why";
        let options = GOALS.map(|(goal, words)| (goal, words.to_owned()));
        rows.choice("quality", hint, &mut goal, options);
        if goal != before {
            self.choice = None;
            self.pending = goal.map(|goal| PendingMeasurement {
                goal,
                scene: Arc::clone(editor.shown()),
                document: editor.documents(),
            });
            out.questions.extend(goal.map(Question::Quality));
        }
        if self.pending.is_some() {
            rows.ui.horizontal(|ui| {
                ui.spinner();
                ui.weak("measuring this scene");
            });
        }
    }

    /// Applies the answer to the question about `goal`, if a sampling was found. The camera may have moved since,
    /// as it does all the time.
    pub fn take(&mut self, goal: Goal, choice: Option<Choice>, editor: &Editor) -> Option<Outcome> {
        let (scene, document) = (editor.shown(), editor.documents());
        let pending = self
            .pending
            .take_if(|pending| pending.goal == goal && pending.document == document)?;
        let choice = choice?;
        if pending.scene.render.antialias != scene.render.antialias {
            // The user has meanwhile chosen another sampling.
            return None;
        }
        if !pending.scene.looks_same_as(scene) {
            let scene = Arc::clone(scene);
            self.pending = Some(PendingMeasurement { scene, ..pending });
            return Some(Outcome::Ask(Question::Quality(goal)));
        }
        self.choice = Some((choice, document));
        let render = Render {
            antialias: choice.sampling,
            ..editor.shown().render.clone()
        };
        (render != editor.shown().render).then_some(Outcome::Edit(Edit::Render(render, "quality")))
    }
}
