//! Draws widgets into a picture, without a window and without a graphics card.

use std::collections::HashMap;

use egui::epaint::{ClippedPrimitive, ImageData, Mesh, Primitive, Vertex};
use egui::{Color32, ColorImage, Context, Pos2, RawInput, Rect, TextureId, Theme, Ui, vec2};

use super::theme::{install, palette};
use crate::image::Image;

/// Number of frames that layouts take to settle.
const FRAMES: usize = 4;
/// Pixels per point.
pub const SCALE: u32 = 2;

/// Draws what `show` puts into a window of `width × height` points, each of them [`SCALE`] pixels wide.
pub fn draw((width, height): (u32, u32), theme: Theme, mut show: impl FnMut(&mut Ui)) -> Image {
    let scale = SCALE as f32;
    let ctx = Context::default();
    install(&ctx, theme);
    let size = vec2(width as f32, height as f32);
    let mut textures = HashMap::new();
    let mut primitives = Vec::new();
    for _ in 0..FRAMES {
        ctx.set_pixels_per_point(scale);
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, size)),
            ..RawInput::default()
        };
        let mut output = ctx.run_ui(input, &mut show);
        for (id, deltas) in output.textures_delta.set.drain() {
            for delta in deltas {
                update_texture(&mut textures, id, &delta.image, delta.pos);
            }
        }
        output.textures_delta.free.clear();
        primitives = ctx.tessellate(output.shapes, scale);
    }
    let pixels = size * scale;
    let mut canvas =
        ColorImage::filled([pixels.x as usize, pixels.y as usize], palette(&ctx).panel);
    for ClippedPrimitive {
        clip_rect,
        primitive,
    } in &primitives
    {
        if let Primitive::Mesh(mesh) = primitive
            && let Some(texture) = textures.get(&mesh.texture_id)
        {
            fill(&mut canvas, mesh, *clip_rect, texture, scale);
        }
    }
    Image {
        width: canvas.size[0],
        height: canvas.size[1],
        pixels: canvas
            .pixels
            .iter()
            .map(|color| {
                let [red, green, blue, _] = color.to_array();
                [red, green, blue, 255]
            })
            .collect(),
    }
}

fn update_texture(
    textures: &mut HashMap<TextureId, ColorImage>,
    id: TextureId,
    image: &ImageData,
    position: Option<[usize; 2]>,
) {
    let ImageData::Color(part) = image;
    let (Some([left, top]), Some(whole)) = (position, textures.get_mut(&id)) else {
        textures.insert(id, ColorImage::clone(part));
        return;
    };
    let stride = whole.size[0];
    for (row, pixels) in part.pixels.chunks(part.size[0]).enumerate() {
        let start = (top + row) * stride + left;
        whole.pixels[start..start + pixels.len()].copy_from_slice(pixels);
    }
}

fn fill(canvas: &mut ColorImage, mesh: &Mesh, clip: Rect, texture: &ColorImage, scale: f32) {
    let clip = Rect::from_min_max(
        (clip.min.to_vec2() * scale).round().to_pos2(),
        (clip.max.to_vec2() * scale).round().to_pos2(),
    );
    for corners in mesh.indices.chunks_exact(3) {
        let at = |corner: usize| mesh.vertices[corners[corner] as usize];
        fill_triangle(canvas, [at(0), at(1), at(2)], clip, texture, scale);
    }
}

/// Colours the pixels whose centres are inside a triangle.
fn fill_triangle(
    canvas: &mut ColorImage,
    corners: [Vertex; 3],
    clip: Rect,
    texture: &ColorImage,
    scale: f32,
) {
    let [a, b, c] = corners.map(|corner| corner.pos.to_vec2() * scale);
    let doubled_area = |p: egui::Vec2, q: egui::Vec2, r: egui::Vec2| {
        (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x)
    };
    let area = doubled_area(a, b, c);
    if area == 0.0 {
        return;
    }
    let [width, height] = canvas.size;
    let range = |low: f32, high: f32, from: f32, to: f32, limit: usize| {
        let first = (low.max(from) - 0.5).ceil().max(0.0) as usize;
        first..((high.min(to) + 0.5).ceil().max(0.0) as usize).min(limit)
    };
    let (low, high) = (a.min(b).min(c), a.max(b).max(c));
    for y in range(low.y, high.y, clip.min.y, clip.max.y, height) {
        for x in range(low.x, high.x, clip.min.x, clip.max.x, width) {
            let p = vec2(x as f32 + 0.5, y as f32 + 0.5);
            if !clip.contains(p.to_pos2()) {
                continue;
            }
            let weights = [
                doubled_area(p, b, c),
                doubled_area(a, p, c),
                doubled_area(a, b, p),
            ];
            let weights = weights.map(|weight| weight / area);
            // A pixel centre on the common edge of two triangles belongs to only one of them.
            let edges = [(b, c), (c, a), (a, b)];
            let inside = weights.iter().zip(edges).all(|(&weight, (from, to))| {
                let (from, to) = if area > 0.0 { (from, to) } else { (to, from) };
                let is_upper_left = to.y < from.y || (to.y == from.y && to.x > from.x);
                weight > 0.0 || (weight == 0.0 && is_upper_left)
            });
            if inside {
                let color = interpolated_color(corners, weights, texture);
                let below = &mut canvas.pixels[y * width + x];
                *below = blend_over(color, *below);
            }
        }
    }
}

/// Returns the interpolated vertex colour times that of the texture, premultiplied, 0–1.
fn interpolated_color(corners: [Vertex; 3], weights: [f32; 3], texture: &ColorImage) -> [f32; 4] {
    let mut color = [0.0; 4];
    let mut uv = egui::Vec2::ZERO;
    for (corner, weight) in corners.iter().zip(weights) {
        for (sum, part) in color.iter_mut().zip(corner.color.to_array()) {
            *sum += f32::from(part) / 255.0 * weight;
        }
        uv += corner.uv.to_vec2() * weight;
    }
    let texel = bilinear(texture, uv);
    [0, 1, 2, 3].map(|channel| color[channel] * texel[channel])
}

fn bilinear(texture: &ColorImage, uv: egui::Vec2) -> [f32; 4] {
    let [width, height] = texture.size;
    let (x, y) = (uv.x * width as f32 - 0.5, uv.y * height as f32 - 0.5);
    let at = |x: f32, y: f32| {
        let column = (x.max(0.0) as usize).min(width - 1);
        let row = (y.max(0.0) as usize).min(height - 1);
        texture.pixels[row * width + column].to_array()
    };
    let (left, top) = (x.floor(), y.floor());
    let (right, down) = (x - left, y - top);
    let corners = [
        (at(left, top), (1.0 - right) * (1.0 - down)),
        (at(left + 1.0, top), right * (1.0 - down)),
        (at(left, top + 1.0), (1.0 - right) * down),
        (at(left + 1.0, top + 1.0), right * down),
    ];
    [0, 1, 2, 3].map(|channel| {
        let parts = corners.iter();
        parts
            .map(|(texel, weight)| f32::from(texel[channel]) / 255.0 * weight)
            .sum()
    })
}

/// Blends a premultiplied colour over an opaque one.
fn blend_over(color: [f32; 4], below: Color32) -> Color32 {
    let background_share = 1.0 - color[3];
    let [red, green, blue, _] = below.to_array();
    let mix = |channel: usize, below: u8| {
        (color[channel] * 255.0 + f32::from(below) * background_share).round() as u8
    };
    Color32::from_rgb(mix(0, red), mix(1, green), mix(2, blue))
}

#[cfg(test)]
mod tests {
    use egui::{Pos2, pos2};

    use super::*;

    const WHITE: [u8; 4] = [255; 4];

    fn texture(size: [usize; 2], texels: &[[u8; 4]]) -> ColorImage {
        let pixels = texels.iter();
        let pixels = pixels.map(|&[r, g, b, a]| Color32::from_rgba_premultiplied(r, g, b, a));
        ColorImage::new(size, pixels.collect())
    }

    /// Makes a half-transparent square of two triangles.
    fn square(from: Pos2, to: Pos2) -> Mesh {
        let mut mesh = Mesh::default();
        mesh.add_colored_rect(
            Rect::from_min_max(from, to),
            Color32::from_rgba_premultiplied(100, 100, 100, 128),
        );
        mesh
    }

    fn painted(mesh: &Mesh, clip: Rect, scale: f32) -> ColorImage {
        let mut canvas = ColorImage::filled([12, 12], Color32::BLACK);
        fill(&mut canvas, mesh, clip, &texture([1, 1], &[WHITE]), scale);
        canvas
    }

    #[test]
    fn two_triangles_paint_every_pixel_of_their_square_once() {
        let canvas = painted(
            &square(pos2(2.0, 3.0), pos2(9.0, 11.0)),
            Rect::EVERYTHING,
            1.0,
        );
        for (index, pixel) in canvas.pixels.iter().enumerate() {
            let (x, y) = (index % 12, index / 12);
            let is_inside = (2..9).contains(&x) && (3..11).contains(&y);
            let expected = if is_inside { 100 } else { 0 };
            assert_eq!(pixel.r(), expected, "pixel {x}, {y}");
        }
    }

    #[test]
    fn nothing_is_painted_outside_the_clip_and_points_are_scaled() {
        let clip = Rect::from_min_max(pos2(0.0, 0.0), pos2(2.0, 6.0));
        let canvas = painted(&square(pos2(1.0, 1.0), pos2(4.0, 4.0)), clip, 2.0);
        let lit = |x: usize, y: usize| canvas.pixels[y * 12 + x].r() > 0;
        assert!(lit(2, 2) && lit(3, 7), "from twice 1 to the clip's twice 2");
        assert!(!lit(1, 2) && !lit(4, 4) && !lit(2, 8));
    }

    #[test]
    fn textures_are_even_between_their_texels() {
        let ramp = texture([2, 1], &[[0, 0, 0, 255], [255, 255, 255, 255]]);
        let at = |x: f32| bilinear(&ramp, vec2(x, 0.5))[0];
        assert_eq!(
            [at(0.0), at(0.25), at(0.5), at(0.75), at(1.0)],
            [0.0, 0.0, 0.5, 1.0, 1.0]
        );
    }

    #[test]
    fn a_part_of_a_texture_is_replaced_in_its_place() {
        let id = TextureId::default();
        let mut textures = HashMap::new();
        let image = |size, texels: &[[u8; 4]]| ImageData::Color(texture(size, texels).into());
        update_texture(&mut textures, id, &image([2, 2], &[[0; 4]; 4]), None);
        update_texture(&mut textures, id, &image([1, 1], &[WHITE]), Some([1, 0]));
        let reds: Vec<u8> = textures[&id].pixels.iter().map(egui::Color32::r).collect();
        assert_eq!(reds, [0, 255, 0, 0]);
    }
}
