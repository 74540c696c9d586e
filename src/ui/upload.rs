//! Uploads pictures to the graphics card: only the parts that have changed.

use egui::{Color32, ColorImage, Painter, Rect, TextureHandle, pos2};

use crate::image::Image;
use crate::plan::Region;

/// Side of the compared squares, in pixels.
const TILE_SIDE: usize = 64;
/// Share of changed pixels above which a picture is sent whole: one large upload is cheaper than many small ones.
const MAX_CHANGED_SHARE: f64 = 0.5;

/// Returns the parts in which `new` differs from `old`; `None` if `new` should be sent whole, because its size or
/// most of it has changed.
pub fn changed_parts(old: &Image, new: &Image) -> Option<Vec<Region>> {
    if (old.width, old.height) != (new.width, new.height) {
        return None;
    }
    let max_changed = (new.pixels.len() as f64 * MAX_CHANGED_SHARE) as usize;
    let mut parts: Vec<Region> = Vec::new();
    let mut changed = 0;
    for top in (0..new.height).step_by(TILE_SIDE) {
        let rows = (top, (top + TILE_SIDE).min(new.height));
        for left in (0..new.width).step_by(TILE_SIDE) {
            let columns = (left, (left + TILE_SIDE).min(new.width));
            let part = Region { columns, rows };
            if pixel_rows(old, part).eq(pixel_rows(new, part)) {
                continue;
            }
            changed += part.pixels();
            if changed > max_changed {
                return None;
            }
            match parts.last_mut() {
                Some(last) if last.rows == rows && last.columns.1 == left => {
                    last.columns.1 = columns.1;
                }
                _ => parts.push(part),
            }
        }
    }
    Some(parts)
}

/// The pixels of a part, row by row.
fn pixel_rows(image: &Image, part: Region) -> impl Iterator<Item = &[[u8; 4]]> {
    let (left, right) = part.columns;
    let starts = (part.rows.0..part.rows.1).map(|row| row * image.width);
    starts.map(move |start| &image.pixels[start + left..start + right])
}

/// Paints a whole texture into a rectangle.
pub fn paint(painter: &Painter, texture: &TextureHandle, place: Rect) {
    let all = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
    painter.image(texture.id(), place, all, Color32::WHITE);
}

/// Converts a whole picture for the graphics card.
pub fn to_color_image(image: &Image) -> ColorImage {
    let pixels = image.pixels.iter().copied().map(color);
    ColorImage::new([image.width, image.height], pixels.collect())
}

/// Converts a part of a picture for the graphics card.
pub fn part_to_color_image(image: &Image, part: Region) -> ColorImage {
    let size = [part.columns, part.rows].map(|(first, end)| end - first);
    let pixels = pixel_rows(image, part).flatten().copied().map(color);
    ColorImage::new(size, pixels.collect())
}

/// Converts a pixel. Pixels that are not traced are transparent.
fn color([red, green, blue, alpha]: [u8; 4]) -> Color32 {
    Color32::from_rgba_premultiplied(red, green, blue, alpha)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn another_size_is_sent_whole_and_the_same_picture_not_at_all() {
        let old = Image::new(300, 200);
        assert_eq!(changed_parts(&old, &Image::new(200, 300)), None);
        assert_eq!(changed_parts(&old, &old), Some(Vec::new()));
        let mut new = old.clone();
        new.pixels.fill([1; 4]);
        assert_eq!(changed_parts(&old, &new), None);
    }

    #[test]
    fn neighbours_go_together() {
        let old = Image::new(300, 200);
        let mut new = old.clone();
        for column in 60..70 {
            new.pixels[199 * 300 + column] = [9; 4];
        }
        let part = Region {
            columns: (0, 128),
            rows: (192, 200),
        };
        assert_eq!(changed_parts(&old, &new), Some(vec![part]));
    }

    proptest! {
        #[test]
        fn the_old_picture_with_the_changes_is_the_new_one(size in (1..200_usize, 1..200_usize),
                                                           spots in prop::collection::vec((0.0..1.0_f64, 1..=255_u8), 0..6)) {
            let old = Image::new(size.0, size.1);
            let mut new = old.clone();
            for (place, shade) in spots {
                let place = (place * new.pixels.len() as f64) as usize;
                new.pixels[place] = [shade; 4];
            }
            let mut card = to_color_image(&old);
            match changed_parts(&old, &new) {
                None => card = to_color_image(&new),
                Some(parts) => for part in parts {
                    let piece = part_to_color_image(&new, part);
                    for (row, pixels) in (part.rows.0..part.rows.1).zip(piece.pixels.chunks(piece.size[0])) {
                        let start = row * size.0 + part.columns.0;
                        card.pixels[start..start + pixels.len()].copy_from_slice(pixels);
                    }
                }
            }
            prop_assert_eq!(card.pixels, to_color_image(&new).pixels);
        }
    }
}
