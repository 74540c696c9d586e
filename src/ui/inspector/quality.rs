//! Which sampling a scene needs, chosen by measuring it.

use std::time::Duration;

use super::super::requests::UiRequests;
use super::super::rows::Rows;
use crate::editor::{Edit, Editor};
use crate::lab::{Choice, EIGHT_BIT_FLOOR, Goal};
use crate::scene::{Render, Scene};
use crate::worker::Question;

/// What a picture can be asked to keep to, in words.
const GOALS: [(Option<Goal>, &str); 5] = [
    (None, "as set below"),
    (
        Some(Goal::Within(EIGHT_BIT_FLOOR)),
        "automatic: below what 8 bits show",
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
/// 50 dB.
const FIFTY_DECIBELS: f64 = 3.162_277_660_168_379_5e-3;

/// What was asked for, and what was chosen last.
#[derive(Debug, Default)]
pub struct Quality {
    /// What is being measured for the document of this number.
    asked: Option<(Goal, u64)>,
    choice: Option<Choice>,
}

impl Quality {
    /// What was chosen, if the scene still has it.
    pub fn in_use(&self, scene: &Scene) -> Option<&Choice> {
        let choice = self.choice.as_ref();
        choice.filter(|choice| choice.sampling == scene.render.antialias)
    }

    /// A row to choose from.
    pub fn show(&mut self, rows: &mut Rows, editor: &Editor, out: &mut UiRequests) {
        // What was asked about a document that is gone is not answered.
        self.asked = self.asked.filter(|asked| asked.1 == editor.documents());
        let asked = self.asked.map(|(goal, _)| goal);
        let before = asked.or(self.in_use(editor.shown()).map(|choice| choice.goal));
        let mut goal = before;
        let hint = "Measures the samplings on this scene, in the size of its still picture, and takes the cheapest \
            that is close enough, or the closest that is fast enough (one undo step); Needs tells why";
        let options = GOALS.map(|(goal, words)| (goal, words.to_owned()));
        rows.choice("quality", hint, &mut goal, options);
        if goal != before {
            self.choice = None;
            self.asked = goal.map(|goal| (goal, editor.documents()));
            out.questions.extend(goal.map(Question::Quality));
        }
        if self.asked.is_some() {
            rows.ui.horizontal(|ui| {
                ui.spinner();
                ui.weak("measuring this scene");
            });
        }
    }

    /// Takes up what was chosen, if anything could be: the change of the document that it was asked for.
    pub fn take(&mut self, goal: Goal, choice: Option<Choice>, editor: &Editor) -> Option<Edit> {
        let asked = (goal, editor.documents());
        self.asked.take_if(|own| *own == asked)?;
        let choice = choice?;
        self.choice = Some(choice);
        let render = Render {
            antialias: choice.sampling,
            ..editor.shown().render.clone()
        };
        (render != editor.shown().render).then_some(Edit::Render(render, "quality"))
    }
}
