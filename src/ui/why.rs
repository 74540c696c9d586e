//! Explains why a point of the picture has its colour: shows the terms of its shading as numbers.

use std::sync::Arc;

use egui::{Color32, Context, Grid, Painter, Pos2, Rect, RichText, Sense, Ui, Window, vec2};
use glam::DVec3;

use super::theme::{GRID, ROW, palette};
use crate::editor::Editor;
use crate::lab::{Explanation, LightTerm, ShadingTerms, drawn, explain};
use crate::scene::{Aspect, Scene, format_number};
use crate::ui::rows::to_bytes;
use crate::worker::Background;

/// Radius of the ring around the point, in points.
const RING_RADIUS: f32 = 7.0;
/// Number of decimals shown.
const DECIMALS: usize = 3;
/// Scenes with more faces are not planned again just to trace one pixel.
const MAX_FACES: usize = 500_000;
/// Difference up to which an exact colour and that of a picture with 8 bits per channel count as equal.
const COLOR_TOLERANCE: f64 = 1.01 / 255.0;

/// Width of the window, and its distance from the explained point, in points.
const WIDTH: f32 = 480.0;
const POINT_DISTANCE: f32 = 60.0;

/// The question and its answer.
#[derive(Default)]
pub struct Why {
    /// Origin and direction of the ray, and the scene that was last asked about.
    asked: Option<(DVec3, DVec3, Arc<Scene>)>,
    answer: Option<Explanation>,
    waiting: Background<Explanation>,
    /// Colour of the picture at that point, once it is known.
    picture_color: Option<DVec3>,
    /// Task that finds that colour, which takes longer than the answer.
    drawing: Background<Option<DVec3>>,
    /// Whether the window has been positioned.
    is_placed: bool,
}

impl Why {
    /// Asks what a ray sees, and why. Another thread finds the answer, because a mesh may have many faces.
    pub fn ask(&mut self, scene: &Arc<Scene>, (origin, direction): (DVec3, DVec3)) {
        self.asked = Some((origin, direction, Arc::clone(scene)));
        let [seen, traced] = [Arc::clone(scene), Arc::clone(scene)];
        let explain_task = move || explain(&seen, origin, direction);
        self.waiting = Background::start("glint-why", explain_task);
        self.picture_color = None;
        self.drawing = Background::default();
        // For a single pixel, the whole scene is planned.
        if scene.faces() <= MAX_FACES {
            let draw_task = move || drawn(&traced, origin, direction);
            self.drawing = Background::start("glint-drawn", draw_task);
        }
    }

    /// Whether an answer is shown.
    pub fn is_open(&self) -> bool {
        self.answer.is_some()
    }

    /// Marks the explained point if it is on a surface; `on_screen` projects it.
    pub fn mark(&self, painter: &Painter, on_screen: impl FnOnce(DVec3) -> Option<Pos2>) {
        if let Some(Explanation::Surface(terms)) = &self.answer
            && let Some(at) = on_screen(terms.point)
        {
            let colors = palette(painter.ctx());
            // Visible on both light and dark ground.
            painter.circle_stroke(at, RING_RADIUS, (3.5, colors.halo));
            painter.circle_stroke(at, RING_RADIUS, (1.5, colors.on_picture));
        }
    }

    /// Drops the question and its answer, which closes the window.
    pub fn close(&mut self) {
        *self = Self::default();
    }

    /// Asks again if the scene has changed since.
    fn follow(&mut self, scene: &Arc<Scene>) {
        let Some((origin, direction, asked_scene)) = &self.asked else {
            return;
        };
        if !asked_scene.looks_same_as(scene) && !self.is_awaited() {
            self.ask(scene, (*origin, *direction));
        }
    }

    fn is_awaited(&self) -> bool {
        self.waiting.is_awaited() || self.drawing.is_awaited()
    }

    /// Shows the answer once it is known. It follows changes of the scene, but not while something moves.
    /// `on_screen` projects the explained point.
    pub fn show(
        &mut self,
        ctx: &Context,
        (editor, aspect): (&Editor, Aspect),
        on_screen: impl FnOnce(DVec3) -> Option<Pos2>,
    ) {
        if let Some(Ok(answer)) = self.waiting.take() {
            self.answer = Some(answer);
        }
        if let Some(Ok(picture_color)) = self.drawing.take() {
            self.picture_color = picture_color;
        }
        if !editor.is_moving() {
            self.follow(editor.shown());
        }
        if self.is_awaited() {
            ctx.request_repaint();
        }
        let Some(answer) = &self.answer else { return };
        let mut is_open = true;
        let mut window = Window::new("Why this colour")
            .collapsible(false)
            .default_width(WIDTH);
        if !std::mem::replace(&mut self.is_placed, true) {
            let asked = self.asked.as_ref();
            let at = asked.and_then(|(origin, direction, _)| on_screen(origin + direction));
            window = window.current_pos(beside(ctx.content_rect(), at));
        }
        window.open(&mut is_open).show(ctx, |ui| {
            egui::ScrollArea::vertical().show(ui, |ui| {
                if aspect != Aspect::default() {
                    ui.weak("For the complete picture, whatever the view is showing.");
                }
                show(ui, answer, 0);
                show_picture_color(ui, answer, self.picture_color);
            });
        });
        if !is_open {
            self.close();
        }
    }
}

/// Returns a position of the window where it does not cover the explained point, if there is room on either side of it.
fn beside(room: Rect, at: Option<Pos2>) -> Pos2 {
    let at = at.unwrap_or(room.center());
    let (left, right) = (at.x - WIDTH - POINT_DISTANCE, at.x + POINT_DISTANCE);
    let x = if left > room.left() { left } else { right };
    Pos2::new(x.min(room.right() - WIDTH), room.top() + POINT_DISTANCE)
}

/// Shows the colour of the picture if it differs from the explained one.
fn show_picture_color(ui: &mut Ui, explanation: &Explanation, picture_color: Option<DVec3>) {
    let is_different = |picture_color: &DVec3| {
        (picture_color - explanation.color()).abs().max_element() > COLOR_TOLERANCE
    };
    let Some(picture_color) = picture_color.filter(is_different) else {
        return;
    };
    ui.separator();
    term(ui, "is the colour in the picture", picture_color);
    ui.weak("The terms are computed with exact formulas and flat faces: other formulas, single precision or a smooth-shaded mesh may give something else.");
}

fn show(ui: &mut Ui, explanation: &Explanation, depth: usize) {
    match explanation {
        Explanation::Sky(color) => {
            term(ui, "background: the ray hits nothing", *color);
        }
        Explanation::Marker(light, color) => {
            term(
                ui,
                &format!("marker of {light}: its full ambient colour"),
                *color,
            );
        }
        Explanation::Surface(terms) => show_surface(ui, terms, explanation.color(), depth),
    }
}

fn show_surface(ui: &mut Ui, terms: &ShadingTerms, color: DVec3, depth: usize) {
    ui.horizontal(|ui| {
        swatch(ui, color);
        ui.label(RichText::new(channels(color)).monospace());
        ui.label(RichText::new(&terms.object).strong());
        ui.weak(format!(
            "uses {}, {} away",
            terms.pack,
            number(terms.distance)
        ));
    });
    let coordinates = |vector: DVec3| vector.to_array().map(number).join(", ");
    ui.weak(format!(
        "at {}, normal {}",
        coordinates(terms.point),
        coordinates(terms.normal)
    ));
    if terms.is_smooth {
        ui.weak("The picture shades this mesh smoothly; these are the numbers of the flat face.");
    }
    ui.indent(("why", depth), |ui| {
        term(ui, "ambient intensity · ambient", terms.ambient);
        for share in &terms.lights {
            show_light(ui, share);
        }
        if let Some((filter, seen)) = &terms.mirror {
            let what = format!(
                "mirror: sum of intensities · specular = {}",
                channels(*filter)
            );
            term(ui, &what, *filter * seen.color());
            ui.weak("times the colour seen there:");
            show(ui, seen, depth + 1);
        }
        ui.separator();
        term(ui, "sum, each channel limited to 1", color);
    });
}

fn show_light(ui: &mut Ui, share: &LightTerm) {
    let LightTerm {
        light,
        intensity,
        cosine,
        blocker,
        ..
    } = share;
    let intensity = number(*intensity);
    match blocker {
        Some(blocker) => {
            term(
                ui,
                &format!("{light}: in the shadow of {blocker}"),
                DVec3::ZERO,
            );
        }
        None if *cosine <= 0.0 => {
            let words = format!("{light}: behind the surface, cosine {}", number(*cosine));
            term(ui, &words, DVec3::ZERO);
        }
        None => {
            let words = format!(
                "{light}: {intensity} · diffuse · cosine {}",
                number(*cosine)
            );
            term(ui, &words, share.diffuse);
            let words = format!("{light}: {intensity} · specular · highlight");
            term(ui, &words, share.specular);
        }
    }
}

/// Shows a term with its colour, and its channels from 0 to 1.
fn term(ui: &mut Ui, words: &str, color: DVec3) {
    Grid::new(ui.next_auto_id()).num_columns(3).show(ui, |ui| {
        swatch(ui, color);
        ui.label(RichText::new(channels(color)).monospace());
        ui.add(egui::Label::new(words).wrap());
        ui.end_row();
    });
}

fn swatch(ui: &mut Ui, color: DVec3) {
    let (rect, _) = ui.allocate_exact_size(vec2(ROW, ROW - GRID / 2.0), Sense::hover());
    let [red, green, blue] = to_bytes(color * 255.0);
    let fill = Color32::from_rgb(red, green, blue);
    let line = egui::Stroke::new(1.0, palette(ui.ctx()).line);
    ui.painter()
        .rect(rect, 2, fill, line, egui::StrokeKind::Inside);
}

fn channels(color: DVec3) -> String {
    let channel = |value: f64| format!("{value:.DECIMALS$}");
    color.to_array().map(channel).join(" ")
}

fn number(value: f64) -> String {
    // Adding zero removes the sign of −0.
    format_number((value * 1e3).round() / 1e3 + 0.0)
}
