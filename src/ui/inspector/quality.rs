//! Which sampling a scene needs, chosen by measuring it.

use std::sync::Arc;
use std::time::Duration;

use super::super::requests::UiRequests;
use super::super::rows::FieldRows;
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
    /// What is being measured.
    asked: Option<Asked>,
    /// What was chosen, for the document of this number.
    choice: Option<(Choice, u64)>,
}

/// What is being measured, of which scene, for the document of this number.
#[derive(Debug)]
struct Asked {
    goal: Goal,
    scene: Arc<Scene>,
    document: u64,
}

/// What an answer comes to.
pub enum Outcome {
    /// The change of the document that was asked for.
    Edit(Edit),
    /// It was about the scene as it was: to be asked again.
    Ask(Question),
}

impl Quality {
    /// What was chosen, if the scene still has it.
    pub fn in_use(&self, editor: &Editor) -> Option<&Choice> {
        let (choice, document) = self.choice.as_ref()?;
        let antialias = editor.shown().render.antialias;
        (choice.sampling == antialias && *document == editor.documents()).then_some(choice)
    }

    /// A row to choose from.
    pub fn show(&mut self, rows: &mut FieldRows, editor: &Editor, out: &mut UiRequests) {
        // What was asked about a document that is gone is not answered.
        self.asked
            .take_if(|asked| asked.document != editor.documents());
        let asked = self.asked.as_ref().map(|asked| asked.goal);
        let before = asked.or(self.in_use(editor).map(|choice| choice.goal));
        let mut goal = before;
        let hint = "Measures the samplings on this scene, in the size of its still picture, and takes the cheapest \
            that is close enough, or the closest that is fast enough (one undo step); Needs tells why";
        let options = GOALS.map(|(goal, words)| (goal, words.to_owned()));
        rows.choice("quality", hint, &mut goal, options);
        if goal != before {
            self.choice = None;
            self.asked = goal.map(|goal| Asked {
                goal,
                scene: Arc::clone(editor.shown()),
                document: editor.documents(),
            });
            out.questions.extend(goal.map(Question::Quality));
        }
        if self.asked.is_some() {
            rows.ui.horizontal(|ui| {
                ui.spinner();
                ui.weak("measuring this scene");
            });
        }
    }

    /// Takes up what was chosen, if anything could be. The view may be another one by now: it is so all the time.
    pub fn take(&mut self, goal: Goal, choice: Option<Choice>, editor: &Editor) -> Option<Outcome> {
        let (scene, document) = (editor.shown(), editor.documents());
        let asked = self
            .asked
            .take_if(|own| own.goal == goal && own.document == document)?;
        let choice = choice?;
        if asked.scene.render.antialias != scene.render.antialias {
            // Another one was chosen by hand meanwhile.
            return None;
        }
        if !asked.scene.has_same_look(scene) {
            let scene = Arc::clone(scene);
            self.asked = Some(Asked { scene, ..asked });
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
