//! Small pictures: what the keys see, above them, and the shot in a corner of the view.

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
use crate::ui::upload::{paint, whole};
use crate::worker::ThumbnailJob;

/// The name of the shot's picture; keys are named by their places.
const SHOT: u64 = u64::MAX;
/// Most keys that have a picture.
const MOST: usize = 200;
/// Width of the shot's picture, as a share of the view's.
const SHARE: f32 = 0.28;

/// The pictures, and what they were asked for.
#[derive(Default)]
pub struct Thumbs {
    keys: Vec<Option<TextureHandle>>,
    shot: Option<TextureHandle>,
    /// Every key of which there is one, counted by this, has a picture.
    stride: usize,
    /// The scene whose keys were asked for, and the screen's scale.
    asked: Option<(Arc<Scene>, u32)>,
    /// The scene, time, and size that the shot was asked for.
    asked_shot: Option<(Arc<Scene>, f64, u32)>,
}

impl Thumbs {
    /// Takes finished pictures up.
    pub fn take(&mut self, ctx: &Context, pictures: Vec<(u64, Image)>) {
        for (name, image) in pictures {
            let picture = whole(&image);
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

    /// What is to be traced now, if anything: the shot whenever it changes, the keys when the hand
    /// rests.
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
            // Where there are very many keys, some of them have pictures, evenly.
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

    /// The keys' pictures above them, as many as have room.
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

    /// The shot in a corner of the view, while the view is not the shot itself. What is behind it is not under the
    /// pointer.
    pub fn show_shot(&self, ui: &Ui, editor: &Editor, view: Rect, out: &mut UiRequests) {
        let Some(texture) = self.shot.as_ref().filter(|_| !editor.looks_through()) else {
            return;
        };
        let size = texture.size_vec2();
        let place = shot_place(view, size.x / size.y);
        paint(ui.painter(), texture, place);
        let response = ui.interact(place, Id::unique("shot"), Sense::click_and_drag());
        let words = "A click looks through the shot camera";
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

/// Whether pictures of the keys of one are those of the other. The camera of the view is in none of them.
fn shows_same(one: &Scene, other: &Scene) -> bool {
    one.has_same_look(other) && Arc::ptr_eq(&one.animation, &other.animation)
}

/// The lower right corner of the view.
fn shot_place(view: Rect, aspect: f32) -> Rect {
    let width = (view.width() * SHARE).round();
    let size = vec2(width, (width / aspect).round());
    Rect::from_min_size(view.max - size - vec2(GRID, GRID), size)
}
