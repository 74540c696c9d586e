//! The lab: time against error of every way of tracing the open scene, each a dot that can be looked
//! at and adopted.

mod labels;

mod marks;

mod chart;

mod dots;

mod pictures;

mod comparison;

mod growth;

mod ramp;

mod heat;

mod rates;

mod atlas;

mod stability;

use std::sync::Arc;

use egui::{Align, Button, DragValue, Key, Layout, Response, RichText, Ui};

pub use self::atlas::stability_picture;
pub use self::growth::growth_picture;
pub use self::pictures::chart_picture;

use self::chart::Chart;
use self::comparison::{Comparison, FACES, Face};
use self::dots::{ChartView, CostAxis, ErrorAxis, chart, figures};
use self::stability::Stability;
use super::commands::Command;
use super::requests::UiRequests;
use super::theme::{GRID, ROW, palette};
use super::viewport::Place;
use crate::editor::{Edit, Editor};
use crate::files::processor;
use crate::lab::{EIGHT_BIT_FLOOR, Study, cheapest_within};
use crate::plan::Model;
use crate::scene::{Render, Scene};
use crate::trace::Threads;
use crate::ui::hint::Hint as _;

/// Longer side of the pictures that are measured, in pixels: a study then takes seconds.
const SIDE: u32 = 256;
/// Width of the column that tells of a dot.
const DETAILS: f32 = 300.0;

/// What the lab asks of the render thread.
pub enum LabRequest {
    /// Measure this.
    Measure(Box<Study>),
    /// Give the measuring up.
    Stop,
}

/// The lab's state.
pub struct Lab {
    /// Whether it is shown.
    pub is_open: bool,
    study: Option<Box<Study>>,
    /// Whether the render thread is at it.
    is_running: bool,
    /// Counts the studies.
    number: u64,
    cost: CostAxis,
    error: ErrorAxis,
    chosen: Option<usize>,
    face: Face,
    look: Comparison,
    /// The bounds for the cheapest dot: RMSE and milliseconds.
    bounds: (f64, f64),
    /// What is measured on.
    machine: String,
    /// Whether the maps are shown in place of the chart.
    shows_maps: bool,
    stability: Stability,
}

impl Default for Lab {
    fn default() -> Self {
        Self {
            is_open: false,
            study: None,
            is_running: false,
            number: 0,
            cost: CostAxis::Time,
            error: ErrorAxis::Rmse,
            chosen: None,
            face: Face::Picture,
            look: Comparison::default(),
            bounds: (EIGHT_BIT_FLOOR, 100.0),
            machine: { format!("{} threads, {}", Threads::available(), processor()) },
            shows_maps: false,
            stability: Stability::default(),
        }
    }
}

impl Lab {
    /// Takes up what the render thread has measured, and whether it was still at it just before.
    pub fn update(&mut self, is_measuring: bool, news: Option<Study>) {
        if self.is_running {
            self.study = news.map(Box::new).or(self.study.take());
            self.is_running = is_measuring;
        }
    }

    /// Whether a dot is looked at in place of the live view.
    pub fn is_looking(&self) -> bool {
        self.is_open && self.chosen.is_some()
    }

    /// What the status line says about the dot that is looked at, if one is.
    pub fn describe(&self) -> Option<String> {
        let place = self.chosen.filter(|_| self.is_open)?;
        let dot = self.study.as_ref()?.measurements.get(place)?;
        let image = dot.picture.as_ref()?;
        let (name, words) = (&dot.candidate.name, dot.candidate.words());
        Some(format!(
            "lab: {name} · {}×{} · {words}",
            image.width, image.height
        ))
    }

    /// What is looked at in place of the live view.
    pub fn name(&self) -> String {
        let measured = self.study.as_ref().map(|study| &study.measurements);
        let dot = self.chosen.and_then(|place| measured?.get(place));
        dot.map_or(String::new(), |dot| format!("Lab: {}", dot.candidate.name))
    }

    /// Leaves the dot that is looked at; whether there was one.
    pub fn leave(&mut self) -> bool {
        self.is_open && self.chosen.take().is_some()
    }

    /// Shows the panel.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        editor: &Editor,
        out: &mut UiRequests,
    ) -> Option<LabRequest> {
        ui.add_space(GRID / 2.0);
        let wish = ui.horizontal(|ui| self.show_head(ui, editor, out)).inner;
        if self.shows_maps {
            self.stability.show(ui, editor.shown());
            return wish;
        }
        let Some((chart, members)) = self.chart(editor) else {
            return self.show_invitation(ui, editor).or(wish);
        };
        ui.horizontal_top(|ui| {
            let width = (ui.available_width() - DETAILS - GRID).max(120.0);
            let size = egui::vec2(width, ui.available_height());
            ui.allocate_ui_with_layout(size, Layout::top_down(Align::Min), |ui| {
                if let Some(chosen) = chart.show(ui) {
                    self.chosen = members
                        .get(chosen)
                        .and_then(|members| members.first().copied());
                }
            });
            ui.vertical(|ui| self.show_details(ui, editor, &members, out));
        });
        wish
    }

    fn show_head(
        &mut self,
        ui: &mut Ui,
        editor: &Editor,
        out: &mut UiRequests,
    ) -> Option<LabRequest> {
        let timeline = ui.selectable_label(false, "Timeline");
        if timeline.hint("Keys and playing (Ctrl+T)").clicked() {
            out.commands.push(Command::Timeline);
        }
        for (maps, name, hint) in [
            (
                false,
                "Chart",
                "Time against error of every way of tracing the scene",
            ),
            (
                true,
                "Stability",
                "Where formulas break, and where the scene stands",
            ),
        ] {
            ui.selectable_value(&mut self.shows_maps, maps, name)
                .hint(hint);
        }
        ui.separator();
        if self.shows_maps {
            return None;
        }
        let mut wish = None;
        if self.is_running {
            let done = self.study.as_ref().map_or(0.0, |study| study.progress());
            if ui.button("Cancel measuring").clicked() {
                self.is_running = false;
                wish = Some(LabRequest::Stop);
            }
            let left = self.study.as_ref().and_then(|study| study.remaining());
            let left = left.map_or(String::new(), |left| {
                format!(", {:.0} s left", left.as_secs_f64().ceil())
            });
            ui.label(format!("{:.0} %{left}", (done * 100.0).floor()));
        } else if ui
            .button("Measure")
            .hint("Trace the scene in every way there is, and compare: a few seconds")
            .clicked()
        {
            wish = Some(self.measure(editor));
        }
        ui.separator();
        for (cost, name, hint) in [
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
        ] {
            ui.selectable_value(&mut self.cost, cost, name).hint(hint);
        }
        ui.separator();
        for (error, name, hint) in [
            (
                ErrorAxis::Rmse,
                "RMSE",
                "Root of the mean square of the error, linear, 0–1",
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
        ] {
            ui.selectable_value(&mut self.error, error, name).hint(hint);
        }
        ui.separator();
        self.show_bounds(ui);
        if self.is_stale(editor) {
            let hint = "The scene has changed since; measure again";
            ui.colored_label(palette(ui.ctx()).accent, "stale")
                .hint(hint);
        }
        wish
    }

    fn measure(&mut self, editor: &Editor) -> LabRequest {
        let study = Box::new(Study::of_side(Arc::clone(editor.shown()), SIDE));
        self.study = Some(study.clone());
        self.chosen = None;
        self.number += 1;
        self.is_running = true;
        LabRequest::Measure(study)
    }

    /// What stands in place of the chart before anything is measured.
    fn show_invitation(&mut self, ui: &mut Ui, editor: &Editor) -> Option<LabRequest> {
        let mut wish = None;
        ui.vertical_centered(|ui| {
            ui.add_space((ui.available_height() / 2.0 - 2.0 * ROW).max(0.0));
            ui.weak("Every way of tracing this scene, each a dot: how long it takes, and how far it is off.");
            ui.add_space(GRID);
            let colors = palette(ui.ctx());
            let text = RichText::new("Measure (about 30 s)").color(colors.on_accent);
            let start = ui.add(Button::new(text).fill(colors.accent));
            if start.clicked() {
                wish = Some(self.measure(editor));
            }
        });
        wish
    }

    fn show_bounds(&mut self, ui: &mut Ui) {
        let pick = ui.add_enabled(self.study.is_some(), Button::new("Cheapest within"));
        let hint = "Choose the fastest dot whose RMSE and time are within these";
        let is_asked = pick.hint(hint).clicked();
        let rmse = DragValue::new(&mut self.bounds.0)
            .speed(1e-5)
            .range(1e-6..=1.0);
        ui.add(rmse.max_decimals(5)).accessible_name("RMSE at most");
        let time = DragValue::new(&mut self.bounds.1)
            .speed(0.1)
            .range(0.01..=1e5);
        ui.add(time.suffix(" ms")).accessible_name("time at most");
        if is_asked && let Some(study) = &self.study {
            self.chosen = cheapest_within(&study.costs(), self.bounds.0, self.bounds.1);
        }
    }

    fn show_details(
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
        ui.weak(dot.candidate.words());
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
        ui.horizontal(|ui| {
            for (face, name, hint) in FACES {
                ui.selectable_value(&mut self.face, face, name).hint(hint);
            }
        });
        let obstacle = match &dot.candidate {
            candidate if candidate.upscale > 1 => {
                Some("A scene is never traced smaller than it is")
            }
            candidate if candidate.model == Model::Everything => Some(
                "A scene cannot ask for what it does not need; its formulas are used without that",
            ),
            _ => None,
        };
        let is_possible = dot.candidate.upscale == 1;
        let adopt = ui.add_enabled(is_possible, Button::new("Use this"));
        let hint = obstacle.unwrap_or("Trace the scene with these settings (one undo step)");
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

    /// Draws what is looked at into the place of the live view; `None` if nothing is.
    pub fn show_picture(&mut self, ui: &mut Ui, place: Place) -> Option<Response> {
        let place_of_dot = self.chosen.filter(|_| self.is_open)?;
        let study = self.study.as_ref()?;
        let picture = study.measurements.get(place_of_dot)?.picture.as_ref()?;
        let reference = &study.reference.as_ref()?.picture;
        let is_flipped = !ui.text_edit_focused() && ui.input(|input| input.key_down(Key::B));
        let face = if is_flipped {
            Face::Reference
        } else {
            self.face
        };
        let key = (place_of_dot, face, self.number);
        Some(self.look.show(ui, place, key, (picture, reference)))
    }

    /// Whether the scene is not any more what was measured. Settings do not count: they are what is
    /// compared.
    fn is_stale(&self, editor: &Editor) -> bool {
        let bare = |scene: &Scene| Scene {
            render: Render {
                reflection_limit: scene.render.reflection_limit,
                ..Render::default()
            },
            animation: Arc::default(),
            ..scene.clone()
        };
        self.study.as_ref().is_some_and(|study| {
            !Arc::ptr_eq(study.scene(), editor.shown())
                && bare(study.scene()) != bare(editor.shown())
        })
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

    fn chart(&self, editor: &Editor) -> Option<(Chart, Vec<Vec<usize>>)> {
        let title = editor.title();
        let view = ChartView {
            name: title.strip_suffix(".ron").unwrap_or(&title),
            machine: &self.machine,
            axes: (self.cost, self.error),
            chosen: self.chosen,
        };
        Some(chart(self.study.as_deref()?, &view))
    }
}
