//! Thumbnails: the views of the keys along the timeline, and the shot in a corner of the viewport.

use std::collections::HashMap;
use std::sync::Arc;

use egui::{Context, Id, Rect, Sense, TextureHandle, TextureOptions, Ui, pos2, vec2};

use super::scale::Scale;
use crate::animate::shot;
use crate::editor::Editor;
use crate::image::Image;
use crate::scene::{Animation, Scene};
use crate::ui::commands::Command;
use crate::ui::menu_entry::on_click;
use crate::ui::requests::UiRequests;
use crate::ui::theme::{GRID, THUMB, palette};
use crate::ui::upload::{paint, to_color_image};
use crate::worker::ThumbnailJob;

/// Name of the shot's thumbnail; those of keys are named by index.
const SHOT: u64 = u64::MAX;
/// Maximum number of keys with a thumbnail.
const MAX_KEY_THUMBNAILS: usize = 200;
/// Width of the shot's thumbnail, as a fraction of the viewport's.
const SHOT_WIDTH_SHARE: f32 = 0.28;

/// The thumbnails, and what they were requested for.
#[derive(Default)]
pub struct Thumbs {
    keys: Vec<Option<TextureHandle>>,
    shot: Option<TextureHandle>,
    /// Every `stride`-th key has a thumbnail.
    stride: usize,
    /// The scene whose keys were requested, and the scale of the screen in percent.
    requested: Option<(Arc<Scene>, u32)>,
    /// Scene, time and pixel height that the shot was requested for.
    requested_shot: Option<(Arc<Scene>, f64, u32)>,
}

impl Thumbs {
    /// Takes over finished thumbnails.
    pub fn take(&mut self, ctx: &Context, pictures: Vec<(u64, Image)>) {
        for (name, image) in pictures {
            let picture = to_color_image(&image);
            let texture = ctx.load_texture("small picture", picture, TextureOptions::LINEAR);
            if name == SHOT {
                self.shot = Some(texture);
                continue;
            }
            let index = name as usize;
            let slot = self.keys.get_mut(index);
            if let Some(slot) = slot.filter(|_| index.is_multiple_of(self.stride)) {
                *slot = Some(texture);
            }
        }
    }

    /// Returns the thumbnails to trace now, if any: the shot whenever it changes, the keys only when nothing is
    /// dragged, played or recorded.
    pub fn jobs(
        &mut self,
        ctx: &Context,
        editor: &Editor,
        view: Rect,
    ) -> Option<Vec<ThumbnailJob>> {
        let scene = editor.scene();
        let keys = &scene.animation.keys;
        if keys.is_empty() {
            *self = Self::default();
            return None;
        }
        let scale = ctx.pixels_per_point();
        let aspect = scene.render.aspect_ratio() as f32;
        let pixels = |height: f32| {
            let height = (height * scale).round().clamp(1.0, 512.0);
            (
                (height * aspect).round().clamp(1.0, 1024.0) as u32,
                height as u32,
            )
        };
        let mut jobs = Vec::new();
        if !editor.looks_through() {
            let size = pixels(shot_rect(view, aspect).height());
            let time = editor.shown_time();
            let requested = self.requested_shot.as_ref();
            if requested.is_none_or(|requested| {
                !shows_same(&requested.0, scene) || (requested.1, requested.2) != (time, size.1)
            }) {
                self.requested_shot = Some((Arc::clone(scene), time, size.1));
                jobs.push(ThumbnailJob {
                    name: SHOT,
                    scene: shot(scene, editor.path_of_camera(), time),
                    size,
                });
            }
        }
        let is_idle = !ctx.input(|input| input.pointer.any_down())
            && !editor.timeline().is_playing
            && editor.timeline().recorded().is_none();
        let (requested, scale) = (self.requested.as_ref(), (scale * 100.0) as u32);
        if is_idle
            && requested
                .is_none_or(|requested| !shows_same(&requested.0, scene) || requested.1 != scale)
        {
            let before = self.requested.replace((Arc::clone(scene), scale));
            // With very many keys, only every `stride`-th one has a thumbnail.
            let stride = keys.len().div_ceil(MAX_KEY_THUMBNAILS).max(1);
            if self.stride != stride {
                self.keys.clear();
                self.stride = stride;
            }
            if self.keys.len() != keys.len() {
                // Until they are traced again, keys keep their pictures, wherever they stand in the list by now.
                let before = before.iter().flat_map(|(scene, _)| &scene.animation.keys);
                let pictures = before.zip(self.keys.drain(..));
                let mut pictures: HashMap<_, _> =
                    pictures.map(|(key, it)| (key.time.to_bits(), it)).collect();
                let times = keys.iter().map(|key| key.time.to_bits());
                let kept = times.map(|time| pictures.remove(&time).flatten());
                self.keys.extend(kept);
            }
            let job_of = |(index, key): (usize, &crate::scene::Key<_>)| ThumbnailJob {
                name: index as u64,
                scene: shot(scene, editor.path_of_camera(), key.time),
                size: pixels(THUMB),
            };
            jobs.extend(keys.iter().enumerate().step_by(stride).map(job_of));
        }
        (!jobs.is_empty()).then_some(jobs)
    }

    /// Draws the thumbnails at their keys, skipping those that would overlap.
    pub fn show(&self, ui: &mut Ui, scale: &Scale, animation: &Animation) {
        let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), THUMB), Sense::hover());
        let mut next_free_x = f32::NEG_INFINITY;
        for (key, texture) in animation.keys.iter().zip(&self.keys) {
            let Some(texture) = texture else { continue };
            let size = texture.size_vec2();
            let width = THUMB * size.x / size.y;
            if !scale.shows(key.time) {
                continue;
            }
            let left = scale.x(key.time) - width / 2.0;
            if left < next_free_x {
                continue;
            }
            next_free_x = left + width + 2.0;
            let thumb_rect = Rect::from_min_size(pos2(left, rect.top()), vec2(width, THUMB));
            paint(ui.painter(), texture, thumb_rect);
        }
    }

    /// Draws the shot in a corner of the viewport, unless the viewport itself shows it. It takes the pointer from
    /// what is behind it.
    pub fn show_shot(&self, ui: &Ui, editor: &Editor, view: Rect, out: &mut UiRequests) {
        let Some(texture) = self.shot.as_ref().filter(|_| !editor.looks_through()) else {
            return;
        };
        let size = texture.size_vec2();
        let rect = shot_rect(view, size.x / size.y);
        paint(ui.painter(), texture, rect);
        let response = ui.interact(rect, Id::unique("shot"), Sense::click_and_drag());
        let response = response.accessible_name("Shot");
        let words = "Click to look through the shot camera";
        on_click(ui, response, (words, Command::LookThrough), out);
        let colors = palette(ui.ctx());
        let stroke = egui::Stroke::new(1.0, colors.accent);
        ui.painter()
            .rect_stroke(rect, 0, stroke, egui::StrokeKind::Outside);
        let font = egui::FontId::proportional(11.0);
        let at = rect.left_top() + vec2(GRID / 2.0, 2.0);
        ui.painter()
            .text(at, egui::Align2::LEFT_TOP, "Shot", font, colors.on_picture);
    }
}

/// Returns whether the thumbnails of two scenes are the same. The viewport's camera does not matter.
fn shows_same(one: &Scene, other: &Scene) -> bool {
    one.looks_same_as(other) && Arc::ptr_eq(&one.animation, &other.animation)
}

/// Rectangle of the shot in the lower right corner of the viewport.
fn shot_rect(view: Rect, aspect: f32) -> Rect {
    let width = (view.width() * SHOT_WIDTH_SHARE).round();
    let size = vec2(width, (width / aspect).round());
    Rect::from_min_size(view.max - size - vec2(GRID, GRID), size)
}
