//! The state of the lab, and its panel.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use egui::{Align, Key, Layout, Response, ScrollArea, Ui};
use glam::DVec3;

use super::chart::Chart;
use super::comparison::{Comparison, ComparisonMode};
use super::dots::{ChartView, CostAxis, ErrorAxis, chart};
use super::stability::Stability;
use crate::editor::Editor;
use crate::lab::{EIGHT_BIT_FLOOR, Study, keep, kept};
use crate::machine::processor;
use crate::scene::{Light, LightObj, List, Object, Render, Scene, Shape};
use crate::trace::Threads;
use crate::ui::prompts::primary_button;
use crate::ui::requests::UiRequests;
use crate::ui::theme::{GRID, ROW};
use crate::ui::viewport::Place;
use crate::words::counted;
use crate::worker::Background;

/// Interval at which a stored study that is being read is polled.
const POLL_INTERVAL: Duration = Duration::from_millis(50);
/// Longer side of the measured pictures in pixels, small enough for a study to take seconds.
const PICTURE_SIDE: u32 = 256;
/// Width of the column with details of a dot.
pub(super) const DETAILS_WIDTH: f32 = 300.0;

/// The limits for choosing a dot before others are chosen: RMSE and milliseconds.
pub(super) const DEFAULT_BOUNDS: (f64, f64) = (EIGHT_BIT_FLOOR, 100.0);

/// A request of the lab to the render thread.
pub enum LabRequest {
    /// Measure this study.
    Measure(Box<Study>),
    /// Stop measuring.
    Stop,
}

/// The tabs of the panel.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Tab {
    /// The chart of time against error.
    Chart,
    /// The stability maps.
    Stability,
}

/// The state of the lab.
pub struct Lab {
    pub(super) study: Option<Box<Study>>,
    /// Whether the render thread is measuring.
    pub(super) is_running: bool,
    /// Number of the current study, to tell apart the textures of different ones.
    study_number: u64,
    /// Name of the measured document.
    name: String,
    pub(super) cost: CostAxis,
    pub(super) error: ErrorAxis,
    pub(super) chosen: Option<usize>,
    pub(super) mode: ComparisonMode,
    comparison: Comparison,
    /// The limits for choosing a dot: RMSE and milliseconds.
    pub(super) bounds: (f64, f64),
    /// Description of this machine.
    machine: String,
    /// The selected tab.
    pub(super) tab: Tab,
    stability: Stability,
    /// Whether POV-Ray is to be measured, too.
    pub(super) asks_povray: bool,
    /// The message if no dot is within the limit asked for.
    pub(super) notice: &'static str,
    /// The folder for studies; `None` if they are not stored.
    folder: Option<PathBuf>,
    /// The document whose stored study was last looked for.
    looked_for: Option<u64>,
    stored_study: Background<Option<Study>>,
}

impl Lab {
    /// Creates a lab that stores its studies in a folder, if there is one.
    pub fn new(folder: Option<PathBuf>) -> Self {
        Self {
            study: None,
            is_running: false,
            study_number: 0,
            name: String::new(),
            cost: CostAxis::Time,
            error: ErrorAxis::Rmse,
            chosen: None,
            mode: ComparisonMode::Picture,
            comparison: Comparison::default(),
            bounds: DEFAULT_BOUNDS,
            machine: format!(
                "{}, {}",
                counted(Threads::available(), "thread"),
                processor()
            ),
            tab: Tab::Chart,
            stability: Stability::default(),
            asks_povray: false,
            notice: "",
            folder,
            looked_for: None,
            stored_study: Background::default(),
        }
    }

    /// Takes over measurements of the render thread; `is_measuring` says whether it was still measuring just
    /// before.
    pub fn update(&mut self, is_measuring: bool, measured: Option<Study>) {
        if self.is_running {
            self.study = measured.map(Box::new).or(self.study.take());
            self.is_running = is_measuring;
            self.store_if_finished();
        }
    }

    /// Stores a finished study on disk.
    fn store_if_finished(&self) {
        let done = self
            .study
            .as_deref()
            .filter(|study| study.progress() >= 1.0);
        let folder = self.folder.as_ref().filter(|_| !self.is_running);
        if let (Some(study), Some(folder)) = (done, folder) {
            let (study, machine, folder) = (study.clone(), self.machine.clone(), folder.clone());
            // Runs in the background; the result is not needed.
            drop(Background::start("glint-lab", move || {
                keep(&study, &machine, &folder);
            }));
        }
    }

    /// Looks for a stored study of the document that was opened, and shows it once it is read.
    fn load_stored_study(&mut self, ui: &Ui, editor: &Editor) {
        if self.is_running {
            // It would replace the study that is being measured.
            return;
        }
        let document = editor.documents();
        if let Some(folder) = self.folder.clone()
            && self.looked_for != Some(document)
        {
            self.looked_for = Some(document);
            // As for measuring: the scene with its keyed values at the current time.
            let (scene, machine) = (Arc::clone(editor.shown()), self.machine.clone());
            self.stored_study = Background::start("glint-lab", move || {
                kept(&scene, PICTURE_SIDE, &machine, &folder)
            });
        }
        let study = self.stored_study.take();
        if self.stored_study.is_awaited() {
            ui.request_repaint_after(POLL_INTERVAL);
        }
        if let Some(Ok(Some(study))) = study {
            self.set_study(Some(Box::new(study)), editor.stem());
        }
    }

    /// Shows another study, or none, of the document with this name.
    fn set_study(&mut self, study: Option<Box<Study>>, name: String) {
        (self.study, self.name) = (study, name);
        self.chosen = None;
        self.study_number += 1;
        self.notice = "";
        self.stored_study = Background::default();
    }

    /// Returns whether a dot's picture is shown instead of the live view.
    pub fn is_looking(&self) -> bool {
        self.chosen.is_some()
    }

    /// Text of the status line about the selected dot, if any.
    pub fn describe(&self) -> Option<String> {
        let index = self.chosen?;
        let dot = self.study.as_ref()?.measurements.get(index)?;
        let image = dot.picture.as_ref()?;
        let (name, words) = (&dot.candidate.name, dot.candidate.words());
        Some(format!(
            "lab: {name} · {}×{} · {words}",
            image.width, image.height
        ))
    }

    /// Title of the picture shown instead of the live view.
    pub fn name(&self, ui: &Ui) -> String {
        if asks_for_reference(ui) {
            return "Lab: the reference".to_owned();
        }
        let measured = self.study.as_ref().map(|study| &study.measurements);
        let dot = self.chosen.and_then(|index| measured?.get(index));
        dot.map_or(String::new(), |dot| format!("Lab: {}", dot.candidate.name))
    }

    /// Drops the study, as another document is open. Returns the request that stops the measuring, if necessary.
    pub fn forget(&mut self) -> Option<LabRequest> {
        self.set_study(None, String::new());
        std::mem::take(&mut self.is_running).then_some(LabRequest::Stop)
    }

    /// Deselects the dot; returns whether one was selected.
    pub fn leave(&mut self) -> bool {
        self.chosen.take().is_some()
    }

    /// Shows the panel.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        editor: &Editor,
        out: &mut UiRequests,
    ) -> Option<LabRequest> {
        self.load_stored_study(ui, editor);
        ui.add_space(GRID / 2.0);
        let request = ui.horizontal_wrapped(|ui| self.show_controls(ui, editor, out));
        let request = request.inner;
        if self.tab == Tab::Stability {
            self.stability.show(ui, editor.shown());
            return request;
        }
        let Some((chart, members)) = self.chart(&editor.shown().render) else {
            return self.show_invitation(ui, editor).or(request);
        };
        ui.horizontal_top(|ui| {
            let width = (ui.available_width() - DETAILS_WIDTH - 5.0 * GRID).max(120.0);
            let size = egui::vec2(width, ui.available_height());
            ui.allocate_ui_with_layout(size, Layout::top_down(Align::Min), |ui| {
                if let Some(chosen) = chart.show(ui) {
                    self.chosen = members
                        .get(chosen)
                        .and_then(|members| members.first().copied());
                }
            });
            // The panel keeps its height, however much text there is.
            let details = ScrollArea::vertical().id_salt("details").auto_shrink(false);
            details.show(ui, |ui| {
                // The scroll area inherits the horizontal layout of its parent.
                ui.vertical(|ui| self.show_details(ui, editor, &members, out));
            });
        });
        request
    }

    /// Starts to measure the scene on screen.
    pub(super) fn measure(&mut self, editor: &Editor) -> LabRequest {
        let mut study = Study::of_side(Arc::clone(editor.shown()), PICTURE_SIDE);
        if self.asks_povray {
            study = study.with_povray();
        }
        let study = Box::new(study);
        self.set_study(Some(study.clone()), editor.stem());
        self.is_running = true;
        LabRequest::Measure(study)
    }

    /// Shown instead of the chart before anything is measured.
    fn show_invitation(&mut self, ui: &mut Ui, editor: &Editor) -> Option<LabRequest> {
        let mut request = None;
        ui.vertical_centered(|ui| {
            ui.take_available_height();
            ui.add_space((ui.available_height() / 2.0 - 2.0 * ROW).max(0.0));
            ui.weak("Every rendering method as a dot: how long it takes on this scene, and how large its error is. Measuring the demo takes half a minute.");
            ui.add_space(GRID);
            if primary_button(ui, "Measure the scene").clicked() {
                request = Some(self.measure(editor));
            }
        });
        request
    }

    /// Draws the selected dot's picture in the rectangle of the live view; `None` if no dot is selected.
    pub fn show_picture(&mut self, ui: &mut Ui, place: Place) -> Option<Response> {
        let dot_index = self.chosen?;
        let study = self.study.as_ref()?;
        let picture = study.measurements.get(dot_index)?.picture.as_ref()?;
        let reference = &study.reference.as_ref()?.picture;
        let mode = if asks_for_reference(ui) {
            ComparisonMode::Reference
        } else {
            self.mode
        };
        let key = (dot_index, mode, self.study_number);
        Some(self.comparison.show(ui, place, key, (picture, reference)))
    }

    /// Returns whether the scene has changed since it was measured. Render settings do not count, as they are what
    /// is compared; nor does a reflection limit that was measured.
    pub(super) fn is_stale(&self, editor: &Editor) -> bool {
        let limit = editor.shown().render.reflection_limit;
        self.study.as_ref().is_some_and(|study| {
            let mut renders = study.measurements.iter().map(|dot| &dot.candidate.render);
            !Arc::ptr_eq(study.scene(), editor.shown())
                && (renders.all(|render| render.reflection_limit != limit)
                    || !looks_like(study.scene(), editor.shown()))
        })
    }

    fn chart(&self, render: &Render) -> Option<(Chart, Vec<Vec<usize>>)> {
        let view = ChartView {
            name: &self.name,
            machine: &self.machine,
            axes: (self.cost, self.error),
            render,
            chosen: self.chosen,
        };
        Some(chart(self.study.as_deref()?, &view))
    }
}

/// Returns whether the key that shows the reference is held.
fn asks_for_reference(ui: &Ui) -> bool {
    !ui.text_edit_focused() && ui.input(|input| input.key_down(Key::B))
}

/// Returns whether two scenes have the same picture, ignoring how it is traced, and the names and groups of lights and
/// objects.
fn looks_like(one: &Scene, other: &Scene) -> bool {
    fn surface(object: &Object) -> (bool, &str, &Shape) {
        (object.visible, &object.color_pack, &object.shape)
    }
    fn source(light: &Light) -> (bool, DVec3, f64, Option<&LightObj>) {
        let marker = light.marker.as_ref();
        (light.visible, light.position, light.intensity, marker)
    }
    let without_lists = |scene: &Scene| Scene {
        objects: List::new(),
        lights: List::new(),
        bookmarks: Vec::new(),
        animation: Arc::default(),
        render: Render {
            width: scene.render.width,
            height: scene.render.height,
            ..Render::default()
        },
        ..scene.clone()
    };
    let (objects, lights) = (other.objects.iter(), other.lights.iter());
    without_lists(one) == without_lists(other)
        && (one.objects.is_same(&other.objects)
            || one.objects.iter().map(surface).eq(objects.map(surface)))
        && one.lights.iter().map(source).eq(lights.map(source))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_change_nothing_that_was_measured() {
        let scene = Scene::demo();
        let mut named = scene.clone();
        named.objects[0].name = "Moon".to_owned();
        named.objects[1].group = "Planets".to_owned();
        named.lights[0].name = "Sun".to_owned();
        assert!(looks_like(&scene, &named) && looks_like(&named, &scene));
        let Shape::Sphere(ball) = &mut named.objects[1].shape else {
            panic!("a ball");
        };
        ball.radius += 1.0;
        assert!(!looks_like(&scene, &named));
    }
}
