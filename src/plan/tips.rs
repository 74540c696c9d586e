//! Sharp corners in the picture: where triangles are narrower than a pixel that are wide elsewhere.

use std::ops::Range;

use glam::DVec3;

use super::request::RenderRequest;
use crate::primitive::Projector;

/// Where a triangle is narrower than so many pixels, it may pass between the corners of pixels: a strip that is one
/// pixel wide may, and a little for the rounding.
const NARROW: f64 = 1.1;

/// Triangles that are smaller than so many pixels are known to slip between samples.
const SMALL: f64 = 2.0;
/// Rows of the picture whose tips are listed together.
const BAND: usize = 16;

/// A corner of a triangle as far as it is narrower than 1.1 pixels, as a triangle in the picture: pixels from its left
/// and upper edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tip {
    corners: [[f64; 2]; 3],
    /// First and last column.
    columns: (f64, f64),
    /// First and last row.
    rows: (f64, f64),
}

impl Tip {
    /// The corner of a triangle, given the others; `None` where it has no area.
    fn of(corner: [f64; 2], others: [[f64; 2]; 2]) -> Option<Self> {
        let sides = others.map(|[x, y]| [x - corner[0], y - corner[1]]);
        let lengths = sides.map(|[x, y]| x.hypot(y));
        let [[ax, ay], [bx, by]] = sides;
        // As far along both sides as the way between them is so long: a chord of 2 sin(angle/2).
        let cosine = (ax * bx + ay * by) / (lengths[0] * lengths[1]);
        let chord = (2.0 * (1.0 - cosine).max(0.0)).sqrt();
        let end = |side: usize| {
            let part = (NARROW / chord / lengths[side]).min(1.0);
            [
                corner[0] + sides[side][0] * part,
                corner[1] + sides[side][1] * part,
            ]
        };
        let (first, second) = (end(0), end(1));
        let range = |axis: usize| {
            let [a, b, c] = [corner[axis], first[axis], second[axis]];
            (a.min(b).min(c), a.max(b).max(c))
        };
        let tip = Self {
            corners: [corner, first, second],
            columns: range(0),
            rows: range(1),
        };
        let is_finite = tip.corners.as_flattened().iter().all(|at| at.is_finite());
        (ax * by - ay * bx != 0.0 && is_finite).then_some(tip)
    }

    /// The same, seen from a place in the picture, in steps of which so many make a pixel.
    pub fn seen_from(&self, place: [f64; 2], steps: f64) -> Self {
        let seen = |axis: usize, at: f64| (at - place[axis]) * steps;
        let range = |axis: usize, (from, to): (f64, f64)| (seen(axis, from), seen(axis, to));
        Self {
            corners: self.corners.map(|[x, y]| [seen(0, x), seen(1, y)]),
            columns: range(0, self.columns),
            rows: range(1, self.rows),
        }
    }

    /// The columns and the rows that it is in.
    pub fn extent(&self) -> [(f64, f64); 2] {
        [self.columns, self.rows]
    }

    /// The columns that it is in between two rows; `None` where it is not.
    pub fn columns_in(&self, (top, bottom): (f64, f64)) -> Option<(f64, f64)> {
        let [a, b, c] = self.corners;
        let mut columns = (f64::INFINITY, f64::NEG_INFINITY);
        for ([x, y], [other_x, other_y]) in [(a, b), (b, c), (c, a)] {
            let (across, down) = (other_x - x, other_y - y);
            // Which part of the side is between the rows.
            let (from, to) = if down == 0.0 {
                (0.0, if top <= y && y <= bottom { 1.0 } else { -1.0 })
            } else {
                let (one, other) = ((top - y) / down, (bottom - y) / down);
                (one.min(other).max(0.0), one.max(other).min(1.0))
            };
            if from <= to {
                let (one, other) = (x + across * from, x + across * to);
                columns = (columns.0.min(one.min(other)), columns.1.max(one.max(other)));
            }
        }
        (columns.0 <= columns.1).then_some(columns)
    }

    /// Whether it meets a square: no side of either has all of the other beyond it (the separating axis theorem).
    pub fn meets(&self, [left, top]: [f64; 2], side: f64) -> bool {
        let Self { columns, rows, .. } = self;
        if columns.1 < left || left + side < columns.0 || rows.1 < top || top + side < rows.0 {
            return false;
        }
        let [a, b, c] = self.corners;
        [(a, b, c), (b, c, a), (c, a, b)].iter().all(|(p, q, r)| {
            let across = [p[1] - q[1], q[0] - p[0]];
            let off = |x: f64, y: f64| (x - p[0]) * across[0] + (y - p[1]) * across[1];
            let inside = off(r[0], r[1]).signum();
            let (right, bottom) = (left + side, top + side);
            let corners = [(left, top), (right, top), (left, bottom), (right, bottom)];
            corners.iter().any(|&(x, y)| off(x, y) * inside >= 0.0)
        })
    }
}

/// The tips in a picture, by the rows that they are in.
#[derive(Clone, Debug, Default)]
pub struct Tips {
    /// Those that are in each [`BAND`] of rows.
    bands: Vec<Vec<Tip>>,
}

impl Tips {
    /// Those of triangles with these corners, as the request's camera sees them. Of those that are narrow as a whole, or
    /// nearly so small, each ray knows that they may slip between samples.
    pub fn of(
        triangles: impl Iterator<Item = [DVec3; 3]>,
        request: &RenderRequest,
        projector: &Projector,
    ) -> Self {
        let bands = (request.height as usize).div_ceil(BAND);
        let mut tips = Self {
            bands: vec![Vec::new(); bands],
        };
        for corners in triangles {
            if let Some([a, b, c]) = projector.places(corners)
                && is_large([a, b, c])
            {
                let corners = [Tip::of(a, [b, c]), Tip::of(b, [c, a]), Tip::of(c, [a, b])];
                for tip in corners.into_iter().flatten() {
                    tips.add(tip, request.width.into());
                }
            }
        }
        tips
    }

    fn add(&mut self, tip: Tip, width: f64) {
        let [columns, (top, bottom)] = tip.extent();
        let band = |row: f64| (row / BAND as f64).max(0.0) as usize;
        if columns.1 < 0.0 || width < columns.0 || bottom < 0.0 {
            return;
        }
        let last = self.bands.len().min(band(bottom) + 1);
        for band in self.bands.iter_mut().take(last).skip(band(top)) {
            band.push(tip);
        }
    }

    /// Those that may be in these rows; some come more than once.
    pub fn in_rows(&self, rows: &Range<usize>) -> impl Iterator<Item = &Tip> {
        let bands = self.bands.iter().take(rows.end.div_ceil(BAND));
        bands.skip(rows.start / BAND).flatten()
    }
}

fn is_large(corners: [[f64; 2]; 3]) -> bool {
    let [a, b, c] = corners;
    [(a, b), (b, c), (c, a)]
        .iter()
        .any(|(a, b)| SMALL < (a[0] - b[0]).hypot(a[1] - b[1]))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::scene::{Scene, Shape};

    #[test]
    fn a_tip_ends_where_the_triangle_is_as_wide_as_a_pixel() {
        let tip = Tip::of([10.0, 10.0], [[20.0, 9.0], [20.0, 11.0]]).expect("some area");
        let [columns, rows] = tip.extent();
        assert_eq!(columns.0, 10.0);
        assert!((columns.1 - 15.5).abs() < 0.01, "{columns:?}");
        assert!((rows.1 - rows.0 - NARROW).abs() < 0.01, "{rows:?}");
        assert!(tip.meets([12.0, 9.5], 1.0));
        assert!(!tip.meets([12.0, 10.5], 1.0), "beside it");
        assert!(!tip.meets([16.0, 9.5], 1.0), "behind its end");
        // What is narrow everywhere is a tip as a whole.
        let thin = Tip::of([0.0, 0.0], [[50.0, 50.0], [50.5, 50.0]]).expect("some area");
        assert_eq!(thin.extent()[0], (0.0, 50.5));
        assert!(thin.meets([30.0, 29.6], 1.0));
        assert!(!thin.meets([30.0, 32.0], 1.0));
        assert_eq!(Tip::of([0.0; 2], [[1.0; 2], [2.0; 2]]), None);
        assert_eq!(Tip::of([0.0; 2], [[0.0; 2], [2.0; 2]]), None);
    }

    proptest! {
        /// Two ways to say where a tip is: by its columns row by row, and square by square.
        #[test]
        fn the_columns_of_a_row_are_those_of_the_squares_that_it_meets(
            at in prop::array::uniform6(0.0..9.0_f64),
            row in 0..9_u32,
            column in 0..9_u32,
        ) {
            let [a, b, c, d, e, f] = at;
            let tip = Tip::of([a, b], [[c, d], [e, f]]);
            prop_assume!(tip.is_some());
            let tip = tip.expect("some area");
            let [left, top] = [column, row].map(f64::from);
            let apart = match tip.columns_in((top, top + 1.0)) {
                None => f64::INFINITY,
                Some((from, to)) => (from - left - 1.0).max(left - to),
            };
            prop_assume!(apart.abs() > 1e-9);
            prop_assert_eq!(tip.meets([left, top], 1.0), apart < 0.0, "{:?}", tip);
        }
    }

    #[test]
    fn tips_are_found_in_their_rows() {
        let scene = Scene::demo();
        let camera = Projector::new(&scene.camera, (200, 100), 0.0).expect("a basis");
        let triangles = scene
            .objects
            .iter()
            .filter_map(|object| match &object.shape {
                Shape::Triangle(triangle) => Some(triangle.corners()),
                _ => None,
            });
        let tips = Tips::of(triangles, &RenderRequest::sized(200, 100), &camera);
        let all: Vec<_> = tips.in_rows(&(0..100)).collect();
        assert!(all.len() >= 18, "{} of six triangles", all.len());
        for rows in [0..7, 30..55, 90..100] {
            let found: Vec<_> = tips.in_rows(&rows).collect();
            for tip in &all {
                let (top, bottom) = tip.extent()[1];
                let is_there = top < rows.end as f64 && rows.start as f64 <= bottom;
                assert!(!is_there || found.contains(tip), "{tip:?} in {rows:?}");
            }
        }
    }
}
