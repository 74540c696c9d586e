//! The row of controls above the chart: tabs, measuring, axes and limits.

use egui::{Button, Id, Label, RichText, Ui};

use super::dots::{CostAxis, ErrorAxis};
use super::panel::{DEFAULT_BOUNDS, Lab, LabRequest, Tab};
use crate::editor::Editor;
use crate::lab::{cheapest_within, closest_within, costs_of_choices};
use crate::ui::commands::Command;
use crate::ui::hint::Hinted as _;
use crate::ui::menu_entry::on_click;
use crate::ui::number::{Field, drag_unlabelled};
use crate::ui::requests::UiRequests;
use crate::ui::theme::palette;

/// A value to choose, with its label and hint.
type Choice<T> = (T, &'static str, &'static str);

const TABS: [Choice<Tab>; 2] = [
    (
        Tab::Chart,
        "Chart",
        "Time against error of every rendering method",
    ),
    (
        Tab::Stability,
        "Stability",
        "Where formulas fail, and how close the scene is to that",
    ),
];

const COSTS: [Choice<CostAxis>; 2] = [
    (
        CostAxis::Time,
        "time",
        "Milliseconds per picture: the median of interleaved runs",
    ),
    (
        CostAxis::Rays,
        "rays",
        "Rays per pixel: the same on every machine",
    ),
];

const ERRORS: [Choice<ErrorAxis>; 3] = [
    (
        ErrorAxis::Rmse,
        "RMSE",
        "Root mean square error, linear, 0–1",
    ),
    (
        ErrorAxis::Max,
        "worst",
        "The worst channel of all pixels, 0–1",
    ),
    (
        ErrorAxis::Visible,
        "visible",
        "Share of the pixels that are off by more than 4/255",
    ),
];

fn choose<T: PartialEq, const N: usize>(ui: &mut Ui, chosen: &mut T, choices: [Choice<T>; N]) {
    for (choice, name, hint) in choices {
        ui.selectable_value(chosen, choice, name).hint(hint);
    }
    ui.separator();
}

impl Lab {
    /// Shows the row; returns a request to the render thread, if any.
    pub(super) fn show_controls(
        &mut self,
        ui: &mut Ui,
        editor: &Editor,
        out: &mut UiRequests,
    ) -> Option<LabRequest> {
        let timeline = ui.selectable_label(false, "Timeline");
        on_click(ui, timeline, ("Keys and playback", Command::Timeline), out);
        choose(ui, &mut self.tab, TABS);
        if self.tab == Tab::Stability {
            return None;
        }
        let request = self.show_measuring(ui, editor);
        if self.is_stale(editor) {
            let stale = RichText::new("stale: measure again").color(palette(ui.ctx()).accent);
            ui.add(Label::new(stale).extend())
                .hint("The scene has changed since it was measured");
        }
        ui.separator();
        choose(ui, &mut self.cost, COSTS);
        choose(ui, &mut self.error, ERRORS);
        self.show_bounds(ui);
        ui.add(Label::new(RichText::new(self.notice).weak()).extend());
        let study = self.study.as_ref();
        if let Some(obstacle) = study.and_then(|study| study.obstacle.as_ref()) {
            ui.weak("no POV-Ray").hint(obstacle);
        }
        request
    }

    /// Shows the buttons that start and stop measuring, and the progress.
    fn show_measuring(&mut self, ui: &mut Ui, editor: &Editor) -> Option<LabRequest> {
        let hint = "Trace the scene with every method and compare: about half a minute";
        let measure = ui.add_enabled(!self.is_running, Button::new("Measure"));
        if measure.hint(hint).clicked() {
            return Some(self.measure(editor));
        }
        if !self.is_running {
            let hint = "Include POV-Ray, an independent renderer, if it is installed";
            ui.checkbox(&mut self.asks_povray, "POV-Ray").hint(hint);
            return None;
        }
        let stop = ui.button("Cancel measuring").clicked();
        let study = self.study.as_ref();
        let done = study.map_or(0.0, |study| study.progress());
        let time_left = study.and_then(|study| study.remaining());
        let time_left = time_left.map_or(String::new(), |time_left| {
            format!(", {:.0} s left", time_left.as_secs_f64().ceil())
        });
        ui.label(format!("{:.0} %{time_left}", (done * 100.0).floor()));
        self.is_running = !stop;
        stop.then_some(LabRequest::Stop)
    }

    fn show_bounds(&mut self, ui: &mut Ui) {
        let costs = self.study.as_deref().map(costs_of_choices);
        let costs = costs.filter(|costs| costs.iter().any(|(_, error)| error.is_finite()));
        // Keeps each button with its limit when the row wraps, which a nested row does not do by itself.
        let mut limit = |words: &str, hint: &str, (field, value): (&Field, &mut f64)| {
            let id = Id::unique(words);
            let last_width = ui.data(|data| data.get_temp::<f32>(id));
            if last_width.is_some_and(|width| ui.available_size_before_wrap().x < width) {
                ui.end_row();
            }
            if last_width.is_none() {
                ui.request_repaint();
            }
            let row = ui.horizontal(|ui| {
                let button = ui.add_enabled(costs.is_some(), Button::new(words));
                drag_unlabelled(ui, field, value);
                let obstacle = costs.is_none().then_some("measure the scene first");
                button.hint_unless(obstacle, hint).clicked()
            });
            ui.data_mut(|data| data.insert_temp(id, row.response.rect.width()));
            row.inner
        };
        let hint = "Choose the fastest dot whose error is no larger than this";
        let rmse = Field {
            name: "RMSE at most",
            hint: "Root mean square error, where 1 is white (0.000001–1)",
            unit: "",
            default: DEFAULT_BOUNDS.0,
            range: 1e-6..=1.0,
            speed: Some(1e-5),
        };
        let by_error = limit("Fastest below", hint, (&rmse, &mut self.bounds.0));
        let hint = "Choose the most accurate dot that takes no longer than this";
        let time = Field {
            name: "time at most",
            hint: "Milliseconds for a picture (0.01–100000)",
            unit: " ms",
            default: DEFAULT_BOUNDS.1,
            range: 0.01..=1e5,
            speed: Some(0.1),
        };
        let by_time = limit("Most accurate within", hint, (&time, &mut self.bounds.1));
        let Some(costs) = costs else { return };
        let found = if by_error {
            cheapest_within(&costs, self.bounds.0, f64::INFINITY)
        } else if by_time {
            closest_within(&costs, self.bounds.1)
        } else {
            return;
        };
        self.notice = match found {
            Some(_) => "",
            None if by_error => "no method is this accurate",
            None => "no method is this fast",
        };
        self.chosen = found;
    }
}
