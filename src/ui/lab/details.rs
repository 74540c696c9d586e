//! Details of the selected dot.

use egui::{Button, RichText, Ui};

use super::comparison::COMPARISON_MODES;
use super::dots::figures;
use super::panel::{DETAILS_WIDTH, Lab};
use crate::editor::{Edit, Editor};
use crate::lab::{Candidate, Family, account};
use crate::plan::Model;
use crate::scene::Render;
use crate::ui::hint::Hinted as _;
use crate::ui::requests::UiRequests;
use crate::ui::theme::GRID;

/// Whether the scene can adopt the settings of a candidate, with the label of the button and its hint.
fn adoption(candidate: &Candidate, is_used: bool) -> (bool, &'static str, &'static str) {
    let label = "Use this";
    if candidate.family == Family::Referee {
        let hint = "Another program, shown only for comparison";
        (false, label, hint)
    } else if candidate.model == Model::Unculled {
        (false, label, "The default method, with no work skipped")
    } else if candidate.upscale > 1 {
        (false, label, "A scene is never traced at a reduced size")
    } else if is_used {
        (false, "In use", "The scene is traced with these settings")
    } else if candidate.model == Model::Everything {
        let hint = "A scene cannot ask for unnecessary work; only the formulas are adopted";
        (true, label, hint)
    } else {
        let hint = "Trace the scene with these settings (one undo step)";
        (true, label, hint)
    }
}

impl Lab {
    /// Shows the settings and figures of the selected dot, and the choice of its picture.
    pub(super) fn show_details(
        &mut self,
        ui: &mut Ui,
        editor: &Editor,
        dots: &[Vec<usize>],
        out: &mut UiRequests,
    ) {
        ui.set_width(DETAILS_WIDTH - GRID);
        let chosen = self.chosen.zip(self.study.as_deref());
        let chosen = chosen.filter(|(index, study)| *index < study.measurements.len());
        let Some((index, study)) = chosen else {
            if !dots.is_empty() {
                ui.weak("Click a dot to see its picture.");
            }
            return;
        };
        let dot = &study.measurements[index];
        ui.label(RichText::new(&dot.candidate.name).strong());
        ui.horizontal_wrapped(|ui| {
            for (mode, name, hint) in COMPARISON_MODES {
                ui.selectable_value(&mut self.mode, mode, name).hint(hint);
            }
        });
        let candidate = &dot.candidate;
        let current = &editor.shown().render;
        let render = Render {
            width: current.width,
            height: current.height,
            ..candidate.render.clone()
        };
        let (can_adopt, label, hint) = adoption(candidate, render == *current);
        let adopt = ui.add_enabled(can_adopt, Button::new(label));
        if adopt.hint(hint).clicked() {
            out.edit(Edit::Render(render, "settings from the lab"));
        }
        ui.add_space(GRID / 2.0);
        ui.label(account(study, index)).hint(candidate.words());
        ui.add_space(GRID / 2.0);
        ui.label(RichText::new(figures(dot)).monospace());
        let same_dot = dots.iter().find(|dot| dot.contains(&index));
        let others = same_dot.into_iter().flatten();
        let mut others = others.filter(|other| **other != index).peekable();
        if others.peek().is_some() {
            ui.weak("Shares its dot with");
            ui.horizontal_wrapped(|ui| {
                for (number, &other) in others.enumerate() {
                    if number > 0 {
                        ui.weak("·");
                    }
                    let name = &study.measurements[other].candidate.name;
                    if ui.link(name).clicked() {
                        self.chosen = Some(other);
                    }
                }
            });
        }
    }
}
