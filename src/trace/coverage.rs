//! Cells that are crossed by one edge. A search finds where the edge crosses the sides of the cell; from this
//! follows how much of the cell lies on either side of it, and two colours are then enough.

use super::cell::Cell;
use super::crossing::{Crossing, EdgeSide, contrast};
use super::lattice::{CornerSample, Lattice};
use super::limits::Limits;
use super::samples::OBJECT_BITS;
use super::thresholds::{EDGE_ERROR, GAP_CONTRAST, PIXEL_STEPS, UNEVEN};
use super::tile::TileColors;
use crate::simd::Real;

/// Greatest uncertainty of an edge's position, in steps of the finest grid, at which its shape matters: an edge that
/// may stay more uncertain is too faint.
const FAINT_EDGE_STEPS: u16 = 2;
/// Distances from an edge at which a sample checks whether it is straight, in multiples of the width within which
/// the edge is located: the first of these is used whose nearest point of the finest grid is at least
/// [`MIN_CHECK_DISTANCE`] away.
const CHECK_DISTANCES: [f64; 3] = [1.1, 1.6, 2.1];
/// Least distance of that sample from the edge, in the same unit: the edge's ends are off by up to a half.
const MIN_CHECK_DISTANCE: f64 = 0.6;

/// A cell that is crossed by one edge.
#[derive(Clone, Copy, Debug)]
pub struct CrossedCell<R> {
    cell: Cell,
    /// The corners on the first side of the edge, as bits.
    first_corners: u8,
    /// What is seen on both sides.
    sides_seen: [EdgeSide<R>; 2],
    crossings: [Crossing; 2],
    /// Whether `check_points` is set: the points whose samples show if the edge is straight.
    has_check_points: bool,
    check_points: [Option<[u16; 2]>; 2],
    /// Indices of the samples at these points.
    check_samples: [u32; 2],
}

/// What has been found out about a cell.
pub enum CellFinding {
    /// Not enough yet.
    Nothing,
    /// It is not crossed by one straight edge.
    NotOneEdge(Cell),
    /// Its colour, which was added to its pixel.
    Color,
}

impl<R: Real> CrossedCell<R> {
    /// The cell, if its corners show that it is crossed by one edge, with a single colour on either side.
    pub fn of(cell: &Cell, lattice: &Lattice<R>, limits: Limits<R>) -> Option<Self> {
        let limit = limits.contrast_of_same(cell.width());
        let is_like = |a: &CornerSample<R>, b: &CornerSample<R>| a.signature == b.signature;
        Self::new(cell, lattice, limits, (limit, is_like))
    }

    /// The same for a cell whose corners all see one thing in two colours, like two faces of a mesh.
    pub fn of_colors(cell: &Cell, lattice: &Lattice<R>, limits: Limits<R>) -> Option<Self> {
        let [a, b, c, d] = lattice.corners(cell);
        let difference = contrast(a, b).max(contrast(a, c)).max(contrast(a, d));
        let limit = difference * R::from_f64(UNEVEN);
        let is_like = |a: &CornerSample<R>, b: &CornerSample<R>| contrast(a, b) <= limit;
        Self::new(cell, lattice, limits, (limit, is_like))
    }

    /// The cell, if its corners fall clearly into two sides, on each of which colours differ by no more than
    /// `limit`.
    #[inline(always)]
    fn new(
        cell: &Cell,
        lattice: &Lattice<R>,
        limits: Limits<R>,
        (limit, is_like): (R, impl Fn(&CornerSample<R>, &CornerSample<R>) -> bool),
    ) -> Option<Self> {
        let corners = lattice.corners(cell);
        let mut like_first = 0_u8;
        for (corner, sample) in corners.iter().enumerate() {
            like_first |= u8::from(is_like(sample, corners[0])) << corner;
        }
        let (first_corners, sides) = sides_of(like_first)?;
        // Written out: `map` on an array would not be inlined here.
        let crossing = |(corner, axis): (usize, usize)| {
            let (one, other) = (corners[corner], corners[corner ^ (1 << axis)]);
            let mut difference = contrast(one, other);
            if (one.signature ^ other.signature) & OBJECT_BITS != 0 || cell.swaps_lights {
                difference = difference.max(R::from_f64(GAP_CONTRAST));
            }
            Crossing::new(cell, (corner, axis), tolerance(cell, difference, limits))
        };
        let [(corner, axis), other] = sides;
        let edge_side = |corner: usize| EdgeSide {
            sample: *corners[corner],
            limit,
        };
        let sides_seen = [edge_side(corner), edge_side(corner ^ (1 << axis))];
        for (corner, sample) in corners.iter().enumerate() {
            let is_first = first_corners >> corner & 1 == 1;
            if !sides_seen[usize::from(!is_first)].matches(sample) {
                return None;
            }
        }
        Some(Self {
            cell: *cell,
            first_corners,
            sides_seen,
            crossings: [crossing(sides[0]), crossing(other)],
            has_check_points: false,
            check_points: [None; 2],
            check_samples: [0; 2],
        })
    }

    /// The cell.
    pub fn cell(&self) -> &Cell {
        &self.cell
    }

    /// The sides of the cell that the edge crosses, as bits.
    pub fn sides(&self) -> u8 {
        self.crossings[0].side(&self.cell) | self.crossings[1].side(&self.cell)
    }

    /// Requests the samples that are needed next.
    pub fn request_samples(&mut self, lattice: &mut Lattice<R>) {
        for crossing in &mut self.crossings {
            crossing.request_samples(lattice);
        }
        for (check, index) in self.check_points.into_iter().zip(&mut self.check_samples) {
            if let Some([x, y]) = check {
                *index = lattice.request(x, y);
            }
        }
    }

    /// Evaluates the requested samples. If the colour is found, adds it to `colors`.
    pub fn evaluate(&mut self, lattice: &Lattice<R>, colors: &mut TileColors<R>) -> CellFinding {
        let not_one_edge = CellFinding::NotOneEdge(self.cell.signatures_only());
        for crossing in &mut self.crossings {
            if !crossing.narrow(lattice, &self.sides_seen) {
                return not_one_edge;
            }
        }
        for (side, check) in self.check_points.iter().enumerate() {
            let seen = lattice.sample(self.check_samples[side]);
            if check.is_some() && !self.sides_seen[side].matches(seen) {
                return not_one_edge;
            }
        }
        if !self.crossings.iter().all(Crossing::is_found) {
            return CellFinding::Nothing;
        }
        if !self.has_check_points {
            self.has_check_points = true;
            self.check_points = self.find_check_points();
            if self.check_points != [None; 2] {
                return CellFinding::Nothing;
            }
        }
        self.accumulate(
            self.mean_color(lattice, 0),
            self.mean_color(lattice, 1),
            colors,
        );
        CellFinding::Color
    }

    /// Returns points close to the middle of the edge, on its first and on its second side, whose samples show
    /// whether the edge is straight; `None` where that cannot or need not be checked.
    fn find_check_points(&self) -> [Option<[u16; 2]>; 2] {
        let [p, q] = &self.crossings;
        let uncertainty = (p.high - p.low).max(q.high - q.low);
        if uncertainty > FAINT_EDGE_STEPS {
            return [None; 2];
        }
        let uncertainty = f64::from(uncertainty);
        let ([px, py], [qx, qy]) = (p.position(), q.position());
        let (along_x, along_y) = (qx - px, qy - py);
        let length = (along_x * along_x + along_y * along_y).sqrt();
        if length <= uncertainty {
            return [None; 2]; // It cuts off a tiny corner, which does not matter.
        }
        // Perpendicular to the edge, away from the corner that the first crossing is measured from.
        let mut across = [-along_y / length, along_x / length];
        if (across[p.axis] < 0.0) != p.is_back {
            across = across.map(|part| -part);
        }
        let middle = [(px + qx) * 0.5, (py + qy) * 0.5];
        let low = [self.cell.x, self.cell.y].map(f64::from);
        let side = f64::from(self.cell.side);
        let check_point = |sign: f64, distance: f64| {
            let point = [0, 1]
                .map(|axis| (middle[axis] + across[axis] * sign * distance * uncertainty).round());
            let off = (point[0] - middle[0]) * across[0] + (point[1] - middle[1]) * across[1];
            (off * sign >= MIN_CHECK_DISTANCE * uncertainty).then_some(point)
        };
        let is_inside = |axis: usize, point: f64| low[axis] <= point && point <= low[axis] + side;
        [-1.0, 1.0].map(|sign| {
            let point = CHECK_DISTANCES
                .iter()
                .find_map(|steps| check_point(sign, *steps))?;
            let is_inside = is_inside(0, point[0]) && is_inside(1, point[1]);
            is_inside.then(|| point.map(|point| point as u16))
        })
    }

    /// The mean of what is seen on a side, at the corners and next to the crossings.
    #[inline(always)]
    fn mean_color(&self, lattice: &Lattice<R>, side: usize) -> [R; 4] {
        let (mut sum, mut count) = ([R::ZERO; 4], 0);
        let mut add = |sample: &CornerSample<R>| {
            for (sum, &value) in sum.iter_mut().zip(&sample.values) {
                *sum = *sum + value;
            }
            count += 1;
        };
        for (corner, sample) in lattice.corners(&self.cell).into_iter().enumerate() {
            if (self.first_corners >> corner & 1 == 1) == (side == 0) {
                add(sample);
            }
        }
        for crossing in &self.crossings {
            add(lattice.sample(crossing.samples[side]));
        }
        let share = R::from_f64(1.0 / f64::from(count));
        let [red, green, blue, rest] = sum;
        [red * share, green * share, blue * share, rest]
    }

    /// Adds the colours of both sides to the cell's pixel, weighted by their areas.
    fn accumulate(&self, first: [R; 4], second: [R; 4], colors: &mut TileColors<R>) {
        let side = f64::from(self.cell.side);
        let [p, q] = &self.crossings;
        let (p, q) = (p.distance() / side, q.distance() / side);
        let is_pair = self.crossings[0].axis == self.crossings[1].axis;
        let covered = if is_pair { p + q } else { p * q } * 0.5;
        let (covered, rest) = (R::from_f64(covered), R::from_f64(1.0 - covered));
        let mut mean = first;
        for (first, second) in mean.iter_mut().zip(second) {
            *first = *first * covered + second * rest;
        }
        self.cell.add_color(mean, colors);
    }
}

/// Returns the corners (upper left and right, lower left and right) on the first side of an edge, as bits, and the
/// two cell sides that it crosses, each by its corner on the first side of the edge and the axis along which it
/// runs from there. `like_first` has the bits of the corners that see the same as the first; `None` if that is not
/// one edge.
fn sides_of(like_first: u8) -> Option<(u8, [(usize, usize); 2])> {
    let single_corner = |corner: usize| Some((1 << corner, [(corner, 0), (corner, 1)]));
    match like_first {
        0b0001 => single_corner(0),
        0b1101 => single_corner(1),
        0b1011 => single_corner(2),
        0b0111 => single_corner(3),
        0b0011 => Some((0b0011, [(0, 1), (1, 1)])),
        0b0101 => Some((0b0101, [(0, 0), (2, 0)])),
        _ => None,
    }
}

/// Number of steps within which the crossing of an edge of this contrast must be located.
fn tolerance<R: Real>(cell: &Cell, contrast: R, limits: Limits<R>) -> u16 {
    let least = limits.least_side() / 2;
    let mut tolerance = cell.side / 4;
    let error = |steps: u16| contrast * R::from_f64(f64::from(steps) / PIXEL_STEPS as f64);
    while tolerance > least && R::from_f64(EDGE_ERROR / 2.0) < error(tolerance) {
        tolerance /= 2;
    }
    tolerance.max(1)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::samples::{EdgeDetail, Samples, Traced};
    use super::super::tile::Tile;
    use super::*;
    use crate::scene::Sampling;

    const PIXEL: Tile = Tile {
        columns: 0..1,
        rows: 0..1,
    };

    /// Traces the samples of a pixel: white where `is_white`, black elsewhere.
    fn see(samples: &Samples<f64>, is_white: impl Fn(f64, f64) -> bool) -> Traced<f64> {
        let mut traced = Traced::default();
        traced.resize(samples.count, samples.count, EdgeDetail::Signatures);
        for index in 0..samples.count {
            let is_white = is_white(samples.x[index], samples.y[index]);
            let value = f64::from(u8::from(is_white));
            for channel in [&mut traced.red, &mut traced.green, &mut traced.blue] {
                channel[index] = value;
            }
            traced.signature[index] = u32::from(is_white) + 5;
            traced.thin_distance[index] = f64::INFINITY;
        }
        traced
    }

    /// The white share of a pixel, if it is found to be crossed by one edge, and the number of additional samples.
    fn found(is_white: impl Fn(f64, f64) -> bool) -> Option<(f64, usize)> {
        let Sampling::Adaptive { contrast, depth } = Sampling::ADAPTIVE else {
            return None;
        };
        let limits = Limits::new(contrast, depth);
        let (mut lattice, mut samples) = (Lattice::default(), Samples::default());
        for (x, y) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
            samples.push(x, y);
        }
        samples.pad(1);
        let mut pixel = [Cell::pixel(0, 0, false)];
        lattice.add(&PIXEL, &see(&samples, &is_white), &mut pixel);
        let mut colors = TileColors::default();
        colors.clear(1, 1);
        let mut crossed = CrossedCell::of(&pixel[0], &lattice, limits)?;
        let mut taken = 0;
        loop {
            crossed.request_samples(&mut lattice);
            lattice.requested_samples(&PIXEL, &mut samples);
            samples.pad(1);
            taken += samples.count;
            lattice.take_results(&see(&samples, &is_white));
            match crossed.evaluate(&lattice, &mut colors) {
                CellFinding::Nothing => {}
                CellFinding::NotOneEdge(_) => return None,
                CellFinding::Color => return Some((colors.channels[0][0], taken)),
            }
        }
    }

    /// The white share by many samples.
    fn counted(is_white: impl Fn(f64, f64) -> bool) -> f64 {
        let side = 256;
        let place = |index: usize| (index as f64 + 0.5) / side as f64;
        let white = (0..side * side).filter(|at| is_white(place(at % side), place(at / side)));
        white.count() as f64 / (side * side) as f64
    }

    /// A ball whose edge passes through a point.
    fn round(radius: f64, turn: f64, (x, y): (f64, f64)) -> impl Fn(f64, f64) -> bool {
        let (sine, cosine) = turn.to_radians().sin_cos();
        move |u, v| (u - x - radius * cosine).hypot(v - y - radius * sine) < radius
    }

    proptest! {
        #[test]
        fn a_straight_edge_covers_what_is_beside_it(turn in 0.0..360.0_f64, x in 0.0..1.0_f64, y in 0.0..1.0_f64) {
            let (sine, cosine) = turn.to_radians().sin_cos();
            let is_white = |u: f64, v: f64| (u - x) * cosine + (v - y) * sine > 0.0;
            let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)].map(|(u, v)| is_white(u, v));
            prop_assume!(corners.contains(&true) && corners.contains(&false));
            let (got, taken) = found(is_white).expect("one straight edge");
            prop_assert!((got - counted(is_white)).abs() < 1.0 / 32.0, "{got}");
            prop_assert!(taken <= 2 * (3 + 3 + 1) + 2, "{taken} samples");
        }

        #[test]
        fn what_is_found_of_a_round_edge_is_right_too(radius in 0.3..30.0_f64, turn in 0.0..360.0_f64, x in 0.0..1.0_f64, y in 0.0..1.0_f64) {
            let is_white = round(radius, turn, (x, y));
            if let Some((got, _)) = found(&is_white) {
                prop_assert!((got - counted(&is_white)).abs() < 0.08, "{got} of {}", counted(&is_white));
            }
        }
    }

    #[test]
    fn a_small_ball_beside_the_corners_is_not_taken_for_a_straight_edge() {
        // Found by chance: a sample beside the edge was rounded onto it, and showed nothing.
        for (radius, turn, x, y) in [
            (
                0.985_138_781_292_264_8,
                185.768_878_358_694_8,
                0.522_026_115_972_804_7,
                0.242_494_875_284_706_2,
            ),
            (
                1.186_274_122_035_918_8,
                195.820_809_815_718_32,
                0.580_782_581_670_605_7,
                0.356_721_644_060_226_3,
            ),
        ] {
            let is_white = round(radius, turn, (x, y));
            if let Some((got, _)) = found(&is_white) {
                assert!((got - counted(&is_white)).abs() < 0.08, "{got}");
            }
        }
    }

    #[test]
    fn a_corner_is_not_taken_for_a_straight_edge() {
        let is_white = |u: f64, v: f64| u > 0.2 && v > 0.3;
        assert_eq!(found(is_white), None);
        assert_eq!(found(|u, _| u > 0.4 && u < 0.7), None, "unseen at corners");
        assert_eq!(found(|u, v| (u > 0.5) != (v > 0.5)), None, "two edges");
    }
}
