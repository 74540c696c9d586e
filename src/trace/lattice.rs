//! The samples that the pixels of a tile share, and what those at the corners of a cell tell about its inside.

use super::cell::Cell;
use super::faces::may_hide_light;
use super::limits::Limits;
use super::points::PointTable;
use super::samples::{EdgeDetail, OBJECT_BITS, Samples, Traced};
use super::shadows::{DIRECT_MARKS, may_border_gap, may_leave_gap, may_swap_lights};
use super::thresholds::{FARTHEST_CORNER, MAX_TWIST, PIXEL_STEPS, UNEVEN};
use super::tile::{Tile, TileColors};
use crate::simd::{Real, SimdFloat};

/// Side of the smallest cells, in steps of the finest grid, that are searched for thin things although their corners
/// see different things: an edge is located better where it crosses larger cells.
const MIN_THIN_SIDE: u16 = (PIXEL_STEPS / 4) as u16;

/// Side of the smallest cells, in steps of the finest grid, that are searched for a gap between things of any
/// colours.
const MIN_GAP_SIDE: u16 = (PIXEL_STEPS / 8) as u16;

/// The result of a sample.
#[derive(Clone, Copy, Debug)]
pub struct CornerSample<R> {
    /// Red, green, blue and the distance in pixels of what may slip between samples: one row, so that they are
    /// computed in step.
    pub values: [R; 4],
    /// Equal where the same things were hit and lit.
    pub signature: u32,
    /// The shadows that the point is in and that end near it, see [`super::shadows`].
    pub shadows: u32,
}

impl<R: Real> CornerSample<R> {
    #[inline(always)]
    fn of(traced: &Traced<R>, i: usize) -> Self {
        let [red, green, blue] = traced.channels();
        Self {
            values: [red[i], green[i], blue[i], traced.thin_distance[i]],
            signature: traced.signature[i],
            shadows: traced.shadows[i],
        }
    }
}

/// Samples on the finest grid of a tile, shared by the cells around them.
#[derive(Debug, Default)]
pub struct Lattice<R> {
    /// The points that have a sample or for which one was requested.
    points: PointTable,
    /// In the order of their points.
    samples: Vec<CornerSample<R>>,
    /// The faces that the first samples are on, see [`super::faces`]; empty in scenes without faces.
    faces: Vec<u64>,
}

/// What the corners of a cell tell about its inside.
pub enum Inside {
    /// Close to the mean of the corners.
    Known,
    /// One thing, in several colours.
    One,
    /// Several things.
    Several,
    /// Possibly something that no corner sees.
    Anything,
}

/// Returns the largest difference between any two of four numbers.
#[inline(always)]
pub fn range<L: SimdFloat>(a: L, b: L, c: L, d: L) -> L {
    a.max(b).max(c.max(d)) - a.min(b).min(c.min(d))
}

impl<R: Real> Lattice<R> {
    /// Removes the samples of the previous tile.
    pub fn clear(&mut self) {
        self.points.clear();
        self.samples.clear();
        self.faces.clear();
    }

    /// Adds the corners of `pixels`, taken from those of the whole tile. No point may lack its sample when this is
    /// called.
    #[inline(always)]
    pub fn add(&mut self, tile: &Tile, corners: &Traced<R>, pixels: &mut [Cell]) {
        for pixel in pixels {
            let corner_points = pixel.corner_points();
            for (corner, (x, y)) in pixel.corners.iter_mut().zip(corner_points) {
                *corner = self.request(x, y);
                if *corner as usize == self.samples.len() {
                    let (column, row) = (x as usize / PIXEL_STEPS, y as usize / PIXEL_STEPS);
                    let index = row * (tile.width() + 1) + column;
                    self.samples.push(CornerSample::of(corners, index));
                    self.faces.extend(corners.faces.get(index));
                }
            }
        }
    }

    /// Requests a sample at a point of the grid and returns its index.
    #[inline(always)]
    pub fn request(&mut self, x: u16, y: u16) -> u32 {
        self.points.find_or_add(x, y)
    }

    /// Fills `samples` with the points that were requested and have no sample yet.
    pub fn requested_samples(&self, tile: &Tile, samples: &mut Samples<R>) {
        samples.clear();
        let step = 1.0 / PIXEL_STEPS as f64;
        for &[x, y] in self.points.starting_at(self.samples.len()) {
            samples.push(
                R::from_f64(tile.columns.start as f64 + f64::from(x) * step),
                R::from_f64(tile.rows.start as f64 + f64::from(y) * step),
            );
        }
    }

    /// Appends the results for the points that were requested last.
    #[inline(always)]
    pub fn take_results(&mut self, traced: &Traced<R>) {
        let new = (0..traced.count).map(|index| CornerSample::of(traced, index));
        self.samples.extend(new);
        let faces = traced.faces.iter().take(traced.count);
        self.faces.extend(faces);
    }

    /// Notes for cells whose corners all see the same whether there may be light between them that no corner has
    /// seen. The corners must be among the first samples or those taken right after: only for them faces are known.
    pub fn note_hidden_light(&self, cells: &mut [Cell]) {
        for cell in cells {
            let [a, b, c, d] = self.corners(cell).map(|sample| sample.signature);
            let faces = cell.corners.map(|corner| self.faces[corner as usize]);
            cell.may_hide_face = a == b && a == c && a == d && may_hide_light(faces);
        }
    }

    /// The number of samples.
    pub fn len(&self) -> usize {
        self.samples.len()
    }

    /// Returns where a sample is on the finest grid.
    #[inline(always)]
    pub fn point(&self, index: usize) -> [u16; 2] {
        self.points.starting_at(index)[0]
    }

    /// Returns how far the colour of a sample lies outside of the range between the colours at two points, summed
    /// over the channels; 0 if one of those is unknown.
    pub fn excess(&self, sample: usize, ends: [[u16; 2]; 2]) -> R {
        let at = |[x, y]: [u16; 2]| Some(&self.samples[self.points.find(x, y)? as usize]);
        let [Some(a), Some(b)] = ends.map(at) else {
            return R::ZERO;
        };
        let seen = &self.samples[sample];
        let mut sum = R::ZERO;
        for ((seen, a), b) in seen.values.iter().zip(a.values).zip(b.values).take(3) {
            let beyond = (a.min(b) - *seen).max(*seen - a.max(b));
            sum = sum + beyond.max(R::ZERO);
        }
        sum
    }

    /// The sample with an index.
    #[inline(always)]
    pub fn sample(&self, index: u32) -> &CornerSample<R> {
        &self.samples[index as usize]
    }

    /// Returns the samples at the corners of a cell. Written out: mapping an array is a function call here.
    #[inline(always)]
    pub fn corners(&self, cell: &Cell) -> [&CornerSample<R>; 4] {
        let [a, b, c, d] = cell.corners;
        let at = |corner: u32| &self.samples[corner as usize];
        [at(a), at(b), at(c), at(d)]
    }

    /// Returns whether something may have slipped between the corners of a cell.
    #[inline(always)]
    pub fn is_near_thin(&self, cell: &Cell) -> bool {
        let [a, b, c, d] = self.corners(cell);
        let (a, b, c, d) = (a.values[3], b.values[3], c.values[3], d.values[3]);
        let least = a.min(b).min(c.min(d));
        cell.detail == EdgeDetail::Thin && least < R::from_f64(FARTHEST_CORNER * cell.width())
    }

    /// Returns whether any sample so far is in a shadow that ends near it.
    pub fn has_shadows(&self) -> bool {
        self.samples.iter().any(|sample| sample.shadows != 0)
    }

    /// Returns whether light may pass between the shadows at the corners of a cell where none of them or not all see
    /// it. In parts of pixels, only what is seen directly counts: which shadows in mirrors are noted at their corners
    /// depends on which samples were traced together.
    #[inline(always)]
    pub fn may_leave_gap(&self, cell: &Cell) -> bool {
        let [a, b, c, d] = self.corners(cell);
        let is_pixel = usize::from(cell.side) == PIXEL_STEPS;
        let marks = if is_pixel { !0 } else { DIRECT_MARKS };
        let shadows = [
            a.shadows & marks,
            b.shadows & marks,
            c.shadows & marks,
            d.shadows & marks,
        ];
        let is_one = differing_bits([a, b, c, d]) == 0;
        EdgeDetail::Borders <= cell.detail
            && (is_one && may_leave_gap(shadows) || !is_one && may_border_gap(shadows))
    }

    /// Returns what the corners of a cell tell about its inside.
    #[inline(always)]
    pub fn inside(&self, cell: &Cell, limits: Limits<R>) -> Inside {
        if cell.side <= limits.least_side() {
            return Inside::Known;
        }
        let [a, b, c, d] = self.corners(cell);
        let diff = differing_bits([a, b, c, d]);
        let is_one = diff == 0;
        if (is_one || MIN_THIN_SIDE <= cell.side) && self.is_near_thin(cell) {
            return Inside::Anything;
        }
        if cell.may_hide_face || self.may_leave_gap(cell) {
            return Inside::Anything;
        }
        let may_hide =
            MIN_GAP_SIDE <= cell.side && (diff & OBJECT_BITS != 0 || !is_one && cell.swaps_lights);
        let has_contrast = self.has_contrast(cell, (limits, is_one));
        match (has_contrast || may_hide, is_one) {
            (false, _) => Inside::Known,
            (true, true) => Inside::One,
            (true, false) => Inside::Several,
        }
    }

    /// Returns whether the colours at the corners of a cell differ by more than allowed, given whether they see the
    /// same.
    #[inline(always)]
    fn has_contrast(&self, cell: &Cell, (limits, is_one): (Limits<R>, bool)) -> bool {
        let [a, b, c, d] = self.corners(cell);
        let mut ranges = [R::ZERO; 4];
        for (index, span) in ranges.iter_mut().enumerate() {
            let (a, b) = (a.values[index], b.values[index]);
            let (c, d) = (c.values[index], d.values[index]);
            *span = range(a, b, c, d);
        }
        let contrast = ranges[0] + ranges[1] + ranges[2];
        let limit = limits.at(R::from_f64(cell.width())).contrast(is_one);
        limit < contrast
    }

    /// Returns whether the corners of a cell see different things, or colours that differ by more than allowed.
    pub fn differs(&self, cell: &Cell, limits: Limits<R>) -> bool {
        let diff = differing_bits(self.corners(cell));
        diff & OBJECT_BITS != 0 || self.has_contrast(cell, (limits, diff == 0))
    }

    /// Returns whether light of two lights or of neither may be hidden between the corners of a pixel. Unknown for
    /// smaller cells, see [`Self::may_leave_gap`].
    #[inline(always)]
    pub fn may_swap_lights(&self, pixel: &Cell) -> bool {
        let [a, b, c, d] = self.corners(pixel);
        let shadows = [a.shadows, b.shadows, c.shadows, d.shadows];
        EdgeDetail::Borders <= pixel.detail && shadows != [0; 4] && may_swap_lights(shadows)
    }

    /// Requests a sample in the middle of a cell and returns its index.
    pub fn request_middle(&mut self, cell: &Cell) -> u32 {
        self.request(cell.x + cell.side / 2, cell.y + cell.side / 2)
    }

    /// Adds the colour of a cell whose corners see the same to its pixel, if the colour changes evenly: the middle
    /// sees the same in nearly their mean colour, and no corner stands out. Returns whether it does.
    pub fn accumulate_even(
        &self,
        (cell, middle): (&Cell, u32),
        limits: Limits<R>,
        colors: &mut TileColors<R>,
    ) -> bool {
        let [a, b, c, d] = self.corners(cell);
        let middle = self.sample(middle);
        let quarter = R::from_f64(0.25);
        let [mut ranges, mut twists, mut offs, mut means] = [[R::ZERO; 4]; 4];
        for index in 0..4 {
            let (a, b) = (a.values[index], b.values[index]);
            let (c, d) = (c.values[index], d.values[index]);
            let mean = ((a + b) + (c + d)) * quarter;
            ranges[index] = range(a, b, c, d);
            twists[index] = ((a + d) - (b + c)).abs();
            offs[index] = (middle.values[index] - mean).abs();
            // Exact for polynomials of degree 2.
            means[index] = mean + (middle.values[index] - mean) * R::from_f64(2.0 / 3.0);
        }
        let [contrast, twist, off] =
            [ranges, twists, offs].map(|[red, green, blue, _]| red + green + blue);
        let limit = limits.contrast_of_same(cell.width());
        let is_even = middle.signature == a.signature
            && off <= limit.min(contrast * R::from_f64(UNEVEN))
            && twist <= contrast * R::from_f64(MAX_TWIST);
        if is_even {
            cell.add_color(means, colors);
        }
        is_even
    }

    /// Adds the mean of a cell's corners to its pixel, weighted by the area of the cell.
    #[inline(always)]
    pub fn accumulate(&self, cell: &Cell, colors: &mut TileColors<R>) {
        let quarter = R::from_f64(0.25);
        let [a, b, c, d] = self.corners(cell);
        let mut mean = [R::ZERO; 4];
        for (index, mean) in mean.iter_mut().enumerate() {
            let upper = a.values[index] + b.values[index];
            let lower = c.values[index] + d.values[index];
            *mean = (upper + lower) * quarter;
        }
        cell.add_color(mean, colors);
    }

    /// Appends the four quarters of a cell to `cells` and requests their corners.
    #[inline(always)]
    pub fn subdivide(&mut self, cell: &Cell, cells: &mut Vec<Cell>) {
        let half = cell.side / 2;
        let (left, top) = (cell.x, cell.y);
        let (middle, centre) = (left + half, top + half);
        let (right, bottom) = (middle + half, centre + half);
        let [a, b, c, d] = cell.corners;
        let above = self.request(middle, top);
        let before = self.request(left, centre);
        let inside = self.request(middle, centre);
        let behind = self.request(right, centre);
        let below = self.request(middle, bottom);
        let quarter = |x: u16, y: u16, corners: [u32; 4]| Cell {
            x,
            y,
            side: half,
            detail: cell.detail,
            swaps_lights: cell.swaps_lights,
            may_hide_face: false,
            corners,
        };
        cells.extend([
            quarter(left, top, [a, above, before, inside]),
            quarter(middle, top, [above, b, inside, behind]),
            quarter(left, centre, [before, inside, c, below]),
            quarter(middle, centre, [inside, behind, below, d]),
        ]);
    }
}

/// Returns the bits of the signatures in which the corners of a cell differ.
#[inline(always)]
fn differing_bits<R>([a, b, c, d]: [&CornerSample<R>; 4]) -> u32 {
    (a.signature ^ b.signature) | (a.signature ^ c.signature) | (a.signature ^ d.signature)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Sampling;

    /// Returns whether a pixel with these levels at its corners and in its middle counts as changing evenly.
    fn is_even(corners: [f64; 4], middle: f64) -> bool {
        let Sampling::Adaptive { contrast, depth } = Sampling::ADAPTIVE else {
            unreachable!("it is adaptive")
        };
        let traced = |levels: &[f64]| {
            let mut traced = Traced::default();
            traced.resize(levels.len(), levels.len(), EdgeDetail::Signatures);
            traced.red.copy_from_slice(levels);
            traced.green.fill(0.0);
            traced.blue.fill(0.0);
            traced.thin_distance.fill(f64::INFINITY);
            traced.signature.fill(5);
            traced
        };
        let tile = Tile {
            columns: 0..1,
            rows: 0..1,
        };
        let (mut lattice, mut pixel) = (Lattice::default(), [Cell::pixel(0, 0, false)]);
        lattice.add(&tile, &traced(&corners), &mut pixel);
        let [pixel] = pixel;
        let at = lattice.request_middle(&pixel);
        lattice.take_results(&traced(&[middle]));
        let mut colors = TileColors::default();
        colors.clear(1, 1);
        lattice.accumulate_even((&pixel, at), Limits::new(contrast, depth), &mut colors)
    }

    #[test]
    fn a_corner_that_stands_out_is_no_even_change_however_the_middle_is() {
        assert!(is_even([0.2, 0.3, 0.2, 0.3], 0.25));
        assert!(is_even([0.2, 0.3, 0.3, 0.4], 0.31));
        assert!(!is_even([0.2, 0.3, 0.2, 0.3], 0.3), "bent");
        // By chance the middle has the mean colour.
        assert!(!is_even([0.2, 0.2, 0.2, 0.4], 0.25), "a highlight");
        assert!(!is_even([0.2, 0.4, 0.4, 0.2], 0.3), "a saddle");
    }
}
