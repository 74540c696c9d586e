//! The picture in the middle of the window: exact pixels, letterboxed.

use egui::{
    Color32, Context, Painter, Pos2, Rect, Response, Sense, Stroke, StrokeKind, TextureFilter,
    TextureHandle, TextureOptions, TextureWrapMode, Ui, UiBuilder, Vec2, pos2, vec2,
};

use super::hint::Hinted as _;
use super::icons;
use super::theme::{GRID, ROW, palette};
use super::upload::{changed_parts, part_to_color_image, to_color_image};
use crate::image::Image;
use crate::plan::Region;
use crate::scene::{Sampling, Scene};
use crate::words::{counted, milliseconds};
use crate::worker::Frame;

/// Enlarged picture pixels are sharp squares; a reduced picture is averaged instead of skipping pixels.
const SHARP: TextureOptions = TextureOptions {
    magnification: TextureFilter::Nearest,
    minification: TextureFilter::Linear,
    wrap_mode: TextureWrapMode::ClampToEdge,
    mipmap_mode: None,
};

/// The newest picture of each kind, as a texture on the graphics card.
#[derive(Default)]
pub struct Display {
    live: Option<DisplayedFrame>,
    still: Option<DisplayedFrame>,
}

struct DisplayedFrame {
    frame: Frame,
    texture: TextureHandle,
}

/// Position of the picture, and its size in screen pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Position on the screen, in points, aligned to whole pixels.
    pub rect: Rect,
    /// Width and height in pixels.
    pub pixels: (u32, u32),
}

impl Display {
    /// Takes a picture, unless a newer one is shown.
    pub fn take(&mut self, ctx: &Context, frame: Frame) {
        let (place, name) = if frame.is_still {
            (&mut self.still, "still picture")
        } else {
            (&mut self.live, "live view")
        };
        if place
            .as_ref()
            .is_some_and(|shown| shown.frame.revision > frame.revision)
        {
            return;
        }
        // A graphics card limits the size of textures. The file that is written keeps its full size.
        let longest = ctx.input(|input| input.max_texture_side).max(1);
        let side = frame.image.width.max(frame.image.height);
        let step = side.div_ceil(longest).max(1);
        let texture = |image: &Image| match step {
            1 => to_color_image(image),
            _ => to_color_image(&image.decimated(step)),
        };
        match place {
            Some(shown) => {
                let parts = changed_parts(&shown.frame.image, &frame.image);
                match parts.filter(|_| step == 1) {
                    None => shown.texture.set(texture(&frame.image), SHARP),
                    Some(parts) => {
                        for part in parts {
                            let place = [part.columns.0, part.rows.0];
                            let image = part_to_color_image(&frame.image, part);
                            shown.texture.set_partial(place, image, SHARP);
                        }
                    }
                }
                shown.frame = frame;
            }
            None => {
                *place = Some(DisplayedFrame {
                    texture: ctx.load_texture(name, texture(&frame.image), SHARP),
                    frame,
                });
            }
        }
    }

    /// Returns the still picture of this revision and size, if there is one.
    pub fn still(&self, revision: u64, size: (u32, u32)) -> Option<&Frame> {
        let frame = &self.still.as_ref()?.frame;
        let (width, height) = (size.0 as usize, size.1 as usize);
        (frame.revision == revision && frame.full_size == (width, height)).then_some(frame)
    }

    /// Returns the newest live picture.
    pub fn live(&self) -> Option<&Frame> {
        self.live.as_ref().map(|shown| &shown.frame)
    }

    /// Draws the still picture to `rect`, clipped to the place of pictures. If only a part of it is traced, the newest
    /// live picture is drawn below it.
    pub fn show_still(&self, ui: &mut Ui, place: Place, rect: Rect) -> Response {
        let response = ui.allocate_rect(place.rect, Sense::click_and_drag());
        response
            .widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "High-res picture"));
        let painter = ui.painter().with_clip_rect(place.rect);
        if let Some(still) = &self.still {
            if let Some(live) = self.live.as_ref().filter(|_| still.frame.region.is_some()) {
                paint(&painter, live, rect);
            }
            paint(&painter, still, rect);
        }
        frame(ui, place);
        response
    }

    /// Draws the newest live picture into its place.
    pub fn show(&self, ui: &mut Ui, place: Place) -> Response {
        let response = ui.allocate_rect(place.rect, Sense::click_and_drag());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "Live view"));
        if let Some(shown) = &self.live {
            paint(ui.painter(), shown, place.rect);
        }
        frame(ui, place);
        response
    }
}

/// Draws a border, which separates a black sky from the dark window.
fn frame(ui: &Ui, place: Place) {
    let line = Stroke::new(1.0, palette(ui.ctx()).line);
    ui.painter()
        .rect_stroke(place.rect, 0, line, StrokeKind::Outside);
}

/// Names the picture in its corner if it is not the live view. Returns whether the user wants to leave it.
pub fn badge(ui: &mut Ui, place: Place, name: &str) -> bool {
    let corner = place.rect.min + vec2(GRID, GRID);
    let size = vec2(place.rect.width() - 2.0 * GRID, ROW);
    let layout = egui::Layout::left_to_right(egui::Align::Center);
    let room = UiBuilder::new().max_rect(Rect::from_min_size(corner, size));
    let words = (name, icons::text(icons::CLOSE));
    let shown = ui.scope_builder(room.layout(layout), |ui| {
        let button = egui::Button::new(words).fill(palette(ui.ctx()).panel);
        ui.add(button)
            .accessible_name(format!("Leave {name}"))
            .hint("Back to the live view (Esc)")
    });
    shown.inner.clicked()
}

/// Draws a picture. A coarse one has every `step`-th pixel: each is drawn as a square around its own position, so that
/// nothing moves when the picture becomes finer.
fn paint(painter: &Painter, shown: &DisplayedFrame, rect: Rect) {
    let Frame {
        image,
        full_size,
        step,
        ..
    } = &shown.frame;
    let texture_range = |coarse: usize, full: usize| {
        let covered = (coarse * step) as f32;
        let half = (step / 2) as f32;
        (half / covered, (full as f32 + half) / covered)
    };
    let (left, right) = texture_range(image.width, full_size.0);
    let (top, bottom) = texture_range(image.height, full_size.1);
    let part = Rect::from_min_max(pos2(left, top), pos2(right, bottom));
    painter.image(shown.texture.id(), rect, part, Color32::WHITE);
}

/// Returns the largest place with the picture's aspect in `area`, on whole screen pixels.
pub fn fit(area: Rect, scene: &Scene, pixels_per_point: f32) -> Place {
    let aspect = scene.render.aspect_ratio() as f32;
    let space = area.size() * pixels_per_point;
    let width = space.x.min(space.y * aspect).floor().max(1.0);
    let height = (width / aspect)
        .round()
        .clamp(1.0, space.y.floor().max(1.0));
    let size = Vec2::new(width, height);
    let corner = (area.center().to_vec2() * pixels_per_point - size / 2.0).round();
    let rect = Rect::from_min_size(
        Pos2::ZERO + corner / pixels_per_point,
        size / pixels_per_point,
    );
    Place {
        rect,
        pixels: (width as u32, height as u32),
    }
}

/// Returns the size of the low-res view: 64 pixels along the longer side.
pub fn low_res(pixels: (u32, u32)) -> (u32, u32) {
    const LONGER: f32 = 64.0;
    let scale = LONGER / pixels.0.max(pixels.1) as f32;
    let side = |side: u32| ((side as f32 * scale).round() as u32).max(1);
    (side(pixels.0), side(pixels.1))
}

/// Describes a picture for the status line.
pub fn describe(frame: &Frame, scene: &Scene) -> String {
    let (width, height) = frame.full_size;
    let (coarse_width, coarse_height) = (frame.image.width, frame.image.height);
    let size = if frame.step == 1 {
        format!("{width}×{height}")
    } else {
        format!("{coarse_width}×{coarse_height} of {width}×{height}")
    };
    let all = frame.image.pixels.len();
    let pixels = frame.region.map_or(all, Region::pixels).max(1) as f64;
    let per_pixel = frame.cost.rays.total() as f64 / pixels;
    let edges = match frame.sampling {
        Sampling::Centres => "",
        Sampling::Grid(_) | Sampling::Adaptive { .. } => " · clean edges",
    };
    let bounces = counted(scene.render.reflection_limit, "bounce");
    let objects = counted(scene.objects.len(), "object");
    format!(
        "{size}{edges} · {:.1} ms · {per_pixel:.1} rays/px · {} · {bounces} · {objects}",
        milliseconds(frame.cost.time),
        frame.cost.lanes,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_picture_keeps_its_aspect_and_sits_on_whole_pixels() {
        let mut scene = Scene::demo();
        scene.render.width = 1920;
        scene.render.height = 1080;
        for scale in [1.0, 1.25, 2.0] {
            let area = Rect::from_min_size(pos2(10.3, 33.7), vec2(701.3, 650.2));
            let Place { rect, pixels } = fit(area, &scene, scale);
            assert!(area.expand(1.0).contains_rect(rect));
            let aspect = pixels.0 as f32 / pixels.1 as f32;
            assert!((aspect - 16.0 / 9.0).abs() < 0.01, "{pixels:?}");
            let corner = rect.min.to_vec2() * scale;
            assert!((corner - corner.round()).length() < 1e-3, "{corner:?}");
        }
    }

    #[test]
    fn low_res_is_64_pixels() {
        assert_eq!(low_res((700, 700)), (64, 64));
        assert_eq!(low_res((1920, 1080)), (64, 36));
        assert_eq!(low_res((1, 5000)), (1, 64));
    }
}
