//! Lines around what is selected, and around what the pointer is over.

use std::ops::Range;

use egui::{Color32, ColorImage};

use crate::image::{ObjectMap, Thing};

/// Pixels that a line is wide.
const LINE: usize = 2;
/// Pixels of the dark edge around it, which makes it seen on any picture.
const HALO: usize = 1;

/// A part of the picture with lines in it.
#[derive(Debug)]
pub struct Outline {
    /// The first column and row of pixels.
    pub corner: [usize; 2],
    /// The lines, transparent elsewhere.
    pub image: ColorImage,
}

/// The lines of a colour, and their edges, around everything that is wanted; `None` if nothing of it is seen.
pub fn outline(
    map: &ObjectMap,
    (color, halo): (Color32, Color32),
    is_wanted: impl Fn(Thing) -> bool,
) -> Option<Outline> {
    let (inside, columns, rows) = silhouette(map, is_wanted)?;
    let reach = LINE + HALO;
    let columns = columns.start.saturating_sub(reach)..(columns.end + reach).min(map.width());
    let rows = rows.start.saturating_sub(reach)..(rows.end + reach).min(map.height());
    let (width, size) = (map.width(), [columns.len(), rows.len()]);
    let mut distances = vec![usize::MAX; size[0] * size[1]];
    for row in rows.clone() {
        for column in columns.clone() {
            if inside[row * width + column] && is_border(&inside, width, column, row) {
                let at = [column - columns.start, row - rows.start];
                spread(&mut distances, size, at);
            }
        }
    }
    let pixels = rows.clone().flat_map(|row| {
        let inside = &inside[row * width + columns.start..row * width + columns.end];
        let distances = &distances[(row - rows.start) * size[0]..][..size[0]];
        inside
            .iter()
            .zip(distances)
            .map(move |(&inside, &distance)| {
                let far = LINE + HALO;
                match distance {
                    _ if inside => Color32::TRANSPARENT,
                    distance if distance <= LINE * LINE => color,
                    distance if distance <= far * far => halo,
                    _ => Color32::TRANSPARENT,
                }
            })
    });
    Some(Outline {
        corner: [columns.start, rows.start],
        image: ColorImage::new(size, pixels.collect()),
    })
}

/// For each pixel whether something wanted is seen there, and the columns and rows with such pixels.
fn silhouette(
    map: &ObjectMap,
    is_wanted: impl Fn(Thing) -> bool,
) -> Option<(Vec<bool>, Range<usize>, Range<usize>)> {
    let mut inside = Vec::with_capacity(map.width() * map.height());
    let (mut low, mut high) = ([usize::MAX; 2], [0; 2]);
    // Neighbours are mostly alike.
    let mut last = (None, false);
    for row in 0..map.height() {
        for (column, thing) in map.row(row).enumerate() {
            if thing != last.0 {
                last = (thing, thing.is_some_and(&is_wanted));
            }
            inside.push(last.1);
            if last.1 {
                low = [low[0].min(column), low[1].min(row)];
                high = [high[0].max(column + 1), row + 1];
            }
        }
    }
    (high[0] > 0).then(|| (inside, low[0]..high[0], low[1]..high[1]))
}

/// Whether a neighbour of a pixel inside is outside.
fn is_border(inside: &[bool], width: usize, column: usize, row: usize) -> bool {
    let at = row * width + column;
    let is_out = |place: Option<usize>| place.and_then(|place| inside.get(place)) == Some(&false);
    is_out(at.checked_sub(width))
        || is_out(at.checked_add(width))
        || (column > 0 && !inside[at - 1])
        || (column + 1 < width && !inside[at + 1])
}

/// Notes the squares of the distances from a pixel.
fn spread(distances: &mut [usize], size: [usize; 2], at: [usize; 2]) {
    let reach = LINE + HALO;
    let around =
        |middle: usize, count: usize| middle.saturating_sub(reach)..(middle + reach + 1).min(count);
    for row in around(at[1], size[1]) {
        for column in around(at[0], size[0]) {
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
    fn a_line_runs_outside_all_around_a_ball() {
        let scene = Scene::demo();
        let request = RenderRequest::sized(200, 200);
        let context = (&Planner::default(), &RenderControl::default());
        let map = ObjectMapper::default().map(&scene, &request, &[], context);
        let map = map.expect("nobody stops it");
        let ball = Thing::Object(0);
        let colors = (Color32::WHITE, Color32::BLACK);
        let found = outline(&map, colors, |thing| thing == ball).expect("it is seen");
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
        assert!(outline(&map, colors, |thing| thing == Thing::Object(99)).is_none());
    }
}
