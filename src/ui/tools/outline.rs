//! Outlines around the selection and around what is hovered.

use std::ops::Range;

use egui::{Color32, ColorImage};

use crate::image::{ObjectMap, Thing};

/// Width of an outline, in pixels.
const LINE_WIDTH: usize = 2;
/// Width of the outline with the dark edge around it, in pixels, which keeps it visible on any picture.
const REACH: usize = LINE_WIDTH + 1;

/// The part of the picture that contains an outline.
#[derive(Debug)]
pub struct OutlineImage {
    /// Column and row of its first pixel.
    pub corner: [usize; 2],
    /// The outline, transparent elsewhere.
    pub image: ColorImage,
}

/// What a pixel shows; the default is the sky, which is infinite.
#[derive(Clone, Copy, Debug, Default)]
pub struct PixelObject {
    /// Whether it belongs to the outlined things.
    pub is_wanted: bool,
    /// Whether it is finite. Infinite things count as being behind all finite ones.
    pub is_finite: bool,
}

/// Draws an outline and its edge around everything that is wanted; `None` if nothing of it is visible. The outline
/// of an infinite thing is interrupted where something finite is in front of it.
pub fn outline(
    map: &ObjectMap,
    (color, halo): (Color32, Color32),
    seen: impl Fn(Thing) -> PixelObject,
) -> Option<OutlineImage> {
    let (objects, columns, rows) = silhouette(map, seen)?;
    let columns = columns.start.saturating_sub(REACH)..(columns.end + REACH).min(map.width());
    let rows = rows.start.saturating_sub(REACH)..(rows.end + REACH).min(map.height());
    let (width, size) = (map.width(), [columns.len(), rows.len()]);
    let mut distances = vec![usize::MAX; size[0] * size[1]];
    for row in rows.clone() {
        for column in columns.clone() {
            if is_border(&objects, width, column, row) {
                let border_object = objects[row * width + column];
                let at = [column - columns.start, row - rows.start];
                let is_free = |[column, row]: [usize; 2]| {
                    let there = (row + rows.start) * width + column + columns.start;
                    border_object.is_finite || !objects[there].is_finite
                };
                spread(&mut distances, size, at, is_free);
            }
        }
    }
    let pixels = rows.clone().flat_map(|row| {
        let objects = &objects[row * width + columns.start..row * width + columns.end];
        let distances = &distances[(row - rows.start) * size[0]..][..size[0]];
        objects
            .iter()
            .zip(distances)
            .map(move |(seen, &distance)| match distance {
                _ if seen.is_wanted => Color32::TRANSPARENT,
                distance if distance <= LINE_WIDTH * LINE_WIDTH => color,
                distance if distance <= REACH * REACH => halo,
                _ => Color32::TRANSPARENT,
            })
    });
    Some(OutlineImage {
        corner: [columns.start, rows.start],
        image: ColorImage::new(size, pixels.collect()),
    })
}

/// Returns what each pixel shows, and the columns and rows that contain wanted pixels.
fn silhouette(
    map: &ObjectMap,
    seen: impl Fn(Thing) -> PixelObject,
) -> Option<(Vec<PixelObject>, Range<usize>, Range<usize>)> {
    let mut objects = Vec::with_capacity(map.width() * map.height());
    let (mut low, mut high) = ([usize::MAX; 2], [0; 2]);
    // Neighbouring pixels mostly show the same thing.
    let mut last = (None, PixelObject::default());
    for row in 0..map.height() {
        for (column, thing) in map.row(row).enumerate() {
            if thing != last.0 {
                last = (thing, thing.map_or(PixelObject::default(), &seen));
            }
            objects.push(last.1);
            if last.1.is_wanted {
                low = [low[0].min(column), low[1].min(row)];
                high = [high[0].max(column + 1), row + 1];
            }
        }
    }
    (high[0] > 0).then(|| (objects, low[0]..high[0], low[1]..high[1]))
}

/// Returns whether a pixel is wanted and has a neighbour that is neither wanted nor in front of it.
fn is_border(objects: &[PixelObject], width: usize, column: usize, row: usize) -> bool {
    let at = row * width + column;
    let border_object = objects[at];
    let is_outside =
        |there: &PixelObject| !there.is_wanted && (border_object.is_finite || !there.is_finite);
    let is_outside_at = |index: Option<usize>| {
        index
            .and_then(|index| objects.get(index))
            .is_some_and(is_outside)
    };
    border_object.is_wanted
        && (is_outside_at(at.checked_sub(width))
            || is_outside_at(at.checked_add(width))
            || (column > 0 && is_outside(&objects[at - 1]))
            || (column + 1 < width && is_outside(&objects[at + 1])))
}

/// Lowers the squared distances around a border pixel where they are greater, in the pixels that are free.
fn spread(
    distances: &mut [usize],
    size: [usize; 2],
    at: [usize; 2],
    is_free: impl Fn([usize; 2]) -> bool,
) {
    let around =
        |middle: usize, count: usize| middle.saturating_sub(REACH)..(middle + REACH + 1).min(count);
    for row in around(at[1], size[1]) {
        for column in around(at[0], size[0]) {
            if !is_free([column, row]) {
                continue;
            }
            let (x, y) = (column.abs_diff(at[0]), row.abs_diff(at[1]));
            let distance = &mut distances[row * size[0] + column];
            *distance = (*distance).min(x * x + y * y);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::ObjectMapper;
    use crate::plan::{Planner, RenderRequest};
    use crate::scene::Scene;
    use crate::trace::RenderControl;

    #[test]
    fn lines_run_outside_all_around_a_ball_and_along_the_end_of_the_floor() {
        let scene = Scene::demo();
        let request = RenderRequest::sized(200, 200);
        let context = (&Planner::default(), &RenderControl::default());
        let map = ObjectMapper::default().map(&scene, &request, &[], context);
        let map = map.expect("nobody stops it");
        let (ball, floor) = (Thing::Object(0), Thing::Object(8));
        let colors = (Color32::WHITE, Color32::BLACK);
        let seen = |wanted: Thing| {
            move |thing: Thing| PixelObject {
                is_wanted: thing == wanted,
                is_finite: thing != floor,
            }
        };
        let found = outline(&map, colors, seen(ball)).expect("it is seen");
        let [left, top] = found.corner;
        let [width, height] = found.image.size;
        assert!(width < 200 && height < 200);
        let mut lines = 0;
        for row in 0..height {
            for column in 0..width {
                let is_line = found.image.pixels[row * width + column] == Color32::WHITE;
                lines += usize::from(is_line);
                let near = |reach: usize| {
                    let rows = (top + row).saturating_sub(reach)..=top + row + reach;
                    rows.flat_map(|y| {
                        let columns = (left + column).saturating_sub(reach)..=left + column + reach;
                        columns.map(move |x| (x, y))
                    })
                    .any(|(x, y)| map.at(x, y) == Some(ball))
                };
                assert!(!is_line || (!near(0) && near(2)), "{column} {row}");
                assert!(is_line || near(0) || !near(1), "{column} {row}");
            }
        }
        assert!(lines > 100, "{lines}");
        assert!(outline(&map, colors, seen(Thing::Object(99))).is_none());
        // The outline of the floor runs along the horizon, and not around what stands on it.
        let found = outline(&map, colors, seen(floor)).expect("it is seen");
        let [left, top] = found.corner;
        let size = found.image.size[0];
        let mut is_long = false;
        for (index, pixel) in found.image.pixels.iter().enumerate() {
            let (column, row) = (left + index % size, top + index / size);
            if *pixel == Color32::WHITE {
                let mut around = (row.saturating_sub(3)..=row + 3)
                    .flat_map(|y| (column.saturating_sub(3)..=column + 3).map(move |x| (x, y)));
                // The outline covers nothing that stands there.
                assert!([None, Some(floor)].contains(&map.at(column, row)));
                assert!(
                    around.any(|(x, y)| map.at(x, y).is_none()),
                    "{column} {row}"
                );
                is_long |= column > 190;
            }
        }
        assert!(is_long);
    }
}
