//! Placement of names beside dots without overlaps.

use egui::{Pos2, Rect, Vec2, pos2, vec2};

/// Directions from a dot, best first.
const DIRECTIONS: [Vec2; 8] = [
    vec2(1.0, -0.6),
    vec2(1.0, 0.6),
    vec2(-1.0, -0.6),
    vec2(-1.0, 0.6),
    vec2(0.0, -1.0),
    vec2(0.0, 1.0),
    vec2(1.0, 0.0),
    vec2(-1.0, 0.0),
];
/// Distances from a dot in points, nearest first.
const DISTANCES: [f32; 6] = [8.0, 16.0, 28.0, 44.0, 64.0, 90.0];
/// Margin around a name, in points.
const GAP: f32 = 2.0;
/// Step width of the search along a level's line, in points.
const LEVEL_STEP: f32 = 8.0;

/// Finds a place for each name, given by its dot and size, in this order; `None` if there is none within `frame`.
/// No name overlaps another one, a dot (of `radius`) or a rectangle of `taken`. Where possible, it is also nearest
/// to its own dot and does not cross any of `lines`.
pub fn place_names(
    names: &[(Pos2, Vec2)],
    (dots, radius): (&[Pos2], f32),
    (frame, taken, lines): (Rect, &[Rect], &[Rect]),
) -> Vec<Option<Rect>> {
    let mut blocked: Vec<Rect> = dots
        .iter()
        .map(|dot| Rect::from_center_size(*dot, Vec2::splat(2.0 * radius)))
        .collect();
    blocked.extend_from_slice(taken);
    let mut places: Vec<Option<Rect>> = Vec::with_capacity(names.len());
    for &(dot, size) in names {
        let candidates = DISTANCES.iter().flat_map(|&distance| {
            DIRECTIONS.map(|direction| label_rect(dot, size, direction, radius + distance))
        });
        let is_clear = |at: &Rect| {
            let own_distance = at.distance_to_pos(dot);
            let mut others = dots.iter().filter(|other| **other != dot);
            !lines.iter().any(|line| at.intersects(*line))
                && others.all(|other| own_distance < at.distance_to_pos(*other))
        };
        let is_free = |at: &Rect| {
            let mut others = blocked.iter();
            frame.contains_rect(*at)
                && !others.any(|other| at.expand(GAP).intersects(*other))
                && !places
                    .iter()
                    .flatten()
                    .any(|name| leader_line_crosses(dot, *at, *name))
        };
        let mut free = candidates.filter(is_free).peekable();
        let first = free.peek().copied();
        let found = free.find(is_clear).or(first);
        if let Some(at) = found {
            blocked.push(at);
            blocked.extend(
                leader_line_points(dot, at).map(|point| Rect::from_center_size(point, Vec2::ZERO)),
            );
        }
        places.push(found);
    }
    places
}

/// Finds a place for the name of a level: below or above its line, as far right as possible without overlapping
/// `taken`; `None` if there is none.
pub fn place_level_name(y: f32, size: Vec2, (frame, taken): (Rect, &[Rect])) -> Option<Rect> {
    let heights = [y + GAP, y - GAP - size.y];
    let steps = ((frame.width() - size.x) / LEVEL_STEP).max(0.0) as u32;
    let mut candidates = (0..=steps).flat_map(|step| {
        let left = frame.right() - size.x - step as f32 * LEVEL_STEP;
        heights.map(|top| Rect::from_min_size(pos2(left, top), size))
    });
    let is_free = |at: &Rect| !taken.iter().any(|other| at.expand(GAP).intersects(*other));
    candidates.find(|at| frame.contains_rect(*at) && is_free(at))
}

/// Returns whether the line from a dot to its name at `at` crosses another name.
fn leader_line_crosses(dot: Pos2, at: Rect, name: Rect) -> bool {
    leader_line_points(dot, at).any(|point| name.contains(point))
}

/// Sample points on the line from a dot to its name.
fn leader_line_points(dot: Pos2, at: Rect) -> impl Iterator<Item = Pos2> {
    let near = at.clamp(dot);
    (1..16_u8).map(move |step| dot + (near - dot) * (f32::from(step) / 16.0))
}

/// The rectangle of a name at a distance from a dot in a direction.
fn label_rect(dot: Pos2, size: Vec2, dir: Vec2, distance: f32) -> Rect {
    let to_middle = vec2(
        dir.x.signum() * if dir.x == 0.0 { 0.0 } else { size.x / 2.0 },
        dir.y.signum() * if dir.y == 0.0 { 0.0 } else { size.y / 2.0 },
    );
    Rect::from_center_size(dot + dir.normalized() * distance + to_middle, size)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn no_name_lies_over_another_or_over_a_dot(dots in prop::collection::vec((0.0..600.0_f32, 0.0..300.0_f32, 20.0..140.0_f32), 1..40)) {
            let frame = Rect::from_min_size(Pos2::ZERO, vec2(600.0, 300.0));
            let names: Vec<_> = dots.iter().map(|&(x, y, width)| (pos2(x, y), vec2(width, 12.0))).collect();
            let at: Vec<Pos2> = names.iter().map(|(dot, _)| *dot).collect();
            let taken = [Rect::from_min_size(pos2(250.0, 100.0), vec2(80.0, 20.0))];
            let places = place_names(&names, (&at, 5.0), (frame, &taken, &[]));
            prop_assert_eq!(places.len(), names.len());
            let found: Vec<Rect> = places.into_iter().flatten().collect();
            for (index, one) in found.iter().enumerate() {
                prop_assert!(frame.contains_rect(*one));
                prop_assert!(found[..index].iter().chain(&taken).all(|other| !one.intersects(*other)));
                prop_assert!(at.iter().all(|dot| !one.contains(*dot)));
            }
        }
    }

    #[test]
    fn the_name_of_a_level_gives_way_to_what_is_there() {
        let frame = Rect::from_min_size(Pos2::ZERO, vec2(600.0, 300.0));
        let size = vec2(100.0, 12.0);
        let place = |taken: &[Rect]| place_level_name(150.0, size, (frame, taken));
        let place = |taken: &[Rect]| place(taken).expect("room enough");
        assert_eq!(place(&[]).right_top(), pos2(600.0, 152.0));
        let below = Rect::from_min_size(pos2(540.0, 155.0), vec2(8.0, 8.0));
        assert_eq!(place(&[below]).right_bottom(), pos2(600.0, 148.0));
        let both = Rect::from_min_size(pos2(540.0, 140.0), vec2(8.0, 20.0));
        let beside = place(&[both]);
        assert!(beside.right() < 540.0 && beside.right() > 500.0, "{beside}");
        assert_eq!(place_level_name(150.0, size, (frame, &[frame])), None);
    }

    #[test]
    fn a_lonely_dot_has_its_name_close_by() {
        let frame = Rect::from_min_size(Pos2::ZERO, vec2(600.0, 300.0));
        let dot = pos2(300.0, 150.0);
        let place = place_names(&[(dot, vec2(60.0, 12.0))], (&[dot], 5.0), (frame, &[], &[]));
        let place = place[0].expect("room enough");
        assert!(place.distance_to_pos(dot) < 16.0);
    }

    #[test]
    fn a_name_is_closest_to_its_own_dot_and_beside_lines_where_there_is_room() {
        let frame = Rect::from_min_size(Pos2::ZERO, vec2(600.0, 300.0));
        // The preferred place of the first name would be beside the second dot.
        let dots = [pos2(300.0, 150.0), pos2(370.0, 140.0)];
        let names = dots.map(|dot| (dot, vec2(60.0, 12.0)));
        let line = Rect::from_two_pos(pos2(250.0, 140.0), pos2(299.0, 140.0));
        let places = place_names(&names, (&dots, 5.0), (frame, &[], &[line]));
        for (place, own) in places.iter().zip(dots) {
            let place = place.expect("room enough");
            let away = |dot: Pos2| place.distance_to_pos(dot);
            assert!(dots.iter().all(|&dot| dot == own || away(own) < away(dot)));
            assert!(!place.intersects(line), "{place}");
        }
    }
}
