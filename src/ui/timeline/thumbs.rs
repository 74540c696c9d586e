//! Thumbnails: the views of the keys along the timeline, and the shot in a corner of the viewport.

use std::sync::Arc;

use egui::{Context, Id, Rect, Sense, TextureHandle, TextureOptions, Ui, pos2, vec2};

use super::scale::Scale;
use crate::animate::shot;
use crate::editor::Editor;
use crate::image::Image;
use crate::scene::{Animation, Scene};
use crate::ui::commands::{Command, with_key};
use crate::ui::hint::Hinted as _;
use crate::ui::requests::UiRequests;
use crate::ui::theme::{GRID, THUMB, palette};
use crate::ui::upload::{paint, to_color_image};
use crate::worker::ThumbnailJob;

/// Name of the shot's thumbnail; those of keys are named by index.
const SHOT: u64 = u64::MAX;
/// Maximum number of keys with a thumbnail.
const MOST: usize = 200;
/// Width of the shot's thumbnail, as a fraction of the viewport's.
const SHARE: f32 = 0.28;

/// The thumbnails, and what they were requested for.
#[derive(Default)]
pub struct Thumbs {
    keys: Vec<Option<TextureHandle>>,
    shot: Option<TextureHandle>,
    /// Every `stride`-th key has a thumbnail.
    stride: usize,
    /// The scene whose keys were requested, and the scale of the screen in percent.
    asked: Option<(Arc<Scene>, u32)>,
    /// Scene, time and pixel height that the shot was requested for.
    asked_shot: Option<(Arc<Scene>, f64, u32)>,
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
            let own = self.keys.get_mut(index);
            if let Some(own) = own.filter(|_| index.is_multiple_of(self.stride)) {
                *own = Some(texture);
            }
        }
    }

    /// Returns the thumbnails to trace now, if any: the shot whenever it changes, the keys only when nothing is
    /// dragged, played or recorded.
    pub fn wishes(
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
        let mut wishes = Vec::new();
        if !editor.looks_through() {
            let size = pixels(shot_place(view, aspect).height());
            let time = editor.shown_time();
            let asked = self.asked_shot.as_ref();
            if asked.is_none_or(|asked| {
                !shows_same(&asked.0, scene) || (asked.1, asked.2) != (time, size.1)
            }) {
                self.asked_shot = Some((Arc::clone(scene), time, size.1));
                wishes.push(ThumbnailJob {
                    name: SHOT,
                    scene: shot(scene, editor.path_of_camera(), time),
                    size,
                });
            }
        }
        let is_resting = !ctx.input(|input| input.pointer.any_down())
            && !editor.timeline().is_playing
            && editor.timeline().recorded().is_none();
        let (asked, scale) = (self.asked.as_ref(), (scale * 100.0) as u32);
        if is_resting && asked.is_none_or(|asked| !shows_same(&asked.0, scene) || asked.1 != scale)
        {
            self.asked = Some((Arc::clone(scene), scale));
            // With very many keys, only every `stride`-th one has a thumbnail.
            let stride = keys.len().div_ceil(MOST).max(1);
            if self.stride != stride {
                self.keys.clear();
                self.stride = stride;
            }
            self.keys.resize(keys.len(), None);
            let sketch = |(index, key): (usize, &crate::scene::Key<_>)| ThumbnailJob {
                name: index as u64,
                scene: shot(scene, editor.path_of_camera(), key.time),
                size: pixels(THUMB),
            };
            wishes.extend(keys.iter().enumerate().step_by(stride).map(sketch));
        }
        (!wishes.is_empty()).then_some(wishes)
    }

    /// Draws the thumbnails at their keys, skipping those that would overlap.
    pub fn show(&self, ui: &mut Ui, scale: &Scale, animation: &Animation) {
        let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), THUMB), Sense::hover());
        let mut free = f32::NEG_INFINITY;
        for (key, texture) in animation.keys.iter().zip(&self.keys) {
            let Some(texture) = texture else { continue };
            let size = texture.size_vec2();
            let width = THUMB * size.x / size.y;
            if !scale.shows(key.time) {
                continue;
            }
            let left = scale.x(key.time) - width / 2.0;
            if left < free {
                continue;
            }
            free = left + width + 2.0;
            let place = Rect::from_min_size(pos2(left, rect.top()), vec2(width, THUMB));
            paint(ui.painter(), texture, place);
        }
    }

    /// Draws the shot in a corner of the viewport, unless the viewport itself shows it. It takes the pointer from
    /// what is behind it.
    pub fn show_shot(&self, ui: &Ui, editor: &Editor, view: Rect, out: &mut UiRequests) {
        let Some(texture) = self.shot.as_ref().filter(|_| !editor.looks_through()) else {
            return;
        };
        let size = texture.size_vec2();
        let place = shot_place(view, size.x / size.y);
        paint(ui.painter(), texture, place);
        let response = ui.interact(place, Id::unique("shot"), Sense::click_and_drag());
        let words = "Click to look through the shot camera";
        let response = response.hint(with_key(ui, words, &Command::LookThrough));
        if response.accessible_name("Shot").clicked() {
            out.commands.push(Command::LookThrough);
        }
        let colors = palette(ui.ctx());
        let stroke = egui::Stroke::new(1.0, colors.accent);
        ui.painter()
            .rect_stroke(place, 0, stroke, egui::StrokeKind::Outside);
        let font = egui::FontId::proportional(11.0);
        let at = place.left_top() + vec2(GRID / 2.0, 2.0);
        ui.painter()
            .text(at, egui::Align2::LEFT_TOP, "Shot", font, colors.on_picture);
    }
}

/// Returns whether the thumbnails of two scenes are the same. The viewport's camera does not matter.
fn shows_same(one: &Scene, other: &Scene) -> bool {
    one.has_same_look(other) && Arc::ptr_eq(&one.animation, &other.animation)
}

/// Rectangle of the shot in the lower right corner of the viewport.
fn shot_place(view: Rect, aspect: f32) -> Rect {
    let width = (view.width() * SHARE).round();
    let size = vec2(width, (width / aspect).round());
    Rect::from_min_size(view.max - size - vec2(GRID, GRID), size)
}
