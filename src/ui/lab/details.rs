//! What is known of the dot that is looked at.

use egui::{Button, RichText, Ui};

use super::super::requests::UiRequests;
use super::super::theme::GRID;
use super::comparison::FACES;
use super::dots::figures;
use super::panel::{DETAILS, Lab};
use crate::editor::{Edit, Editor};
use crate::lab::{Family, account};
use crate::plan::Model;
use crate::scene::Render;
use crate::ui::hint::Hint as _;

impl Lab {
    /// Its settings, its figures, and which of its pictures is shown.
    pub(super) fn show_details(
        &mut self,
        ui: &mut Ui,
        editor: &Editor,
        dots: &[Vec<usize>],
        out: &mut UiRequests,
    ) {
        ui.set_width(DETAILS - GRID);
        let chosen = self
            .chosen
            .and_then(|place| self.study.as_ref()?.measurements.get(place));
        let Some(dot) = chosen else {
            ui.weak("Click a dot to look at its picture.");
            return;
        };
        let equals = self.equals_of_chosen(dots);
        ui.label(RichText::new(&dot.candidate.name).strong());
        let study = self.study.as_deref();
        let account = study
            .zip(self.chosen)
            .map(|(study, place)| account(study, place));
        ui.label(account.unwrap_or_default())
            .hint(dot.candidate.words());
        ui.add_space(GRID / 2.0);
        ui.label(RichText::new(figures(dot)).monospace());
        if equals.len() > 1 {
            ui.weak("One dot with");
            ui.horizontal_wrapped(|ui| {
                let chosen = self.chosen;
                for (place, name) in equals.iter().filter(|(place, _)| Some(*place) != chosen) {
                    if ui.link(name).clicked() {
                        self.chosen = Some(*place);
                    }
                }
            });
        }
        ui.add_space(GRID / 2.0);
        ui.horizontal_wrapped(|ui| {
            for (face, name, hint) in FACES {
                ui.selectable_value(&mut self.face, face, name).hint(hint);
            }
        });
        let candidate = &dot.candidate;
        let (is_possible, hint) = if candidate.family == Family::Referee {
            (false, "It is another program, and only looked at here")
        } else if candidate.model == Model::Unculled {
            (false, "It is the default, with nothing spared")
        } else if candidate.upscale > 1 {
            (false, "A scene is never traced smaller than it is")
        } else if candidate.model == Model::Everything {
            let words =
                "A scene cannot ask for what it does not need; its formulas are used without that";
            (true, words)
        } else {
            (true, "Trace the scene with these settings (one undo step)")
        };
        let adopt = ui.add_enabled(is_possible, Button::new("Use this"));
        let adopt = adopt.hint(hint).on_disabled_hover_text(hint);
        if adopt.clicked() {
            let own = &editor.shown().render;
            let render = Render {
                width: own.width,
                height: own.height,
                ..dot.candidate.render.clone()
            };
            out.edit(Edit::Render(render, "settings from the lab"));
        }
    }

    /// The measurements that share the dot of the chosen one, with their names.
    fn equals_of_chosen(&self, dots: &[Vec<usize>]) -> Vec<(usize, String)> {
        let (Some(chosen), Some(study)) = (self.chosen, &self.study) else {
            return Vec::new();
        };
        let dot = dots.iter().find(|dot| dot.contains(&chosen));
        let name = |&place: &usize| (place, study.measurements[place].candidate.name.clone());
        dot.into_iter().flatten().map(name).collect()
    }
}
