//! The cells of a tile whose insides are examined. They are handled one by one, not in lanes: the code is compiled
//! once for each precision, not for every vector width.

use super::cell::Cell;
use super::coverage::{CellFinding, CrossedCell};
use super::lattice::{Inside, Lattice};
use super::limits::Limits;
use super::messages::{ALL, EdgeMessages};
use super::pixel_sides::PixelSides;
use super::samples::{EdgeDetail, Samples, Traced};
use super::thresholds::{MAX_EXCESS, PIXEL_STEPS};
use super::tile::{Tile, TileColors};
use crate::simd::Real;

/// Side of the quarters of pixels, in steps of the finest grid.
const QUARTER_SIDE: u16 = (PIXEL_STEPS / 2) as u16;
/// Number of parts of a pixel that is divided twice.
const PARTS: u8 = 16;
/// A pixel is crowded if all of its parts are to be divided, at least this many of them although their corners do
/// not differ.
const MIN_ALIKE_PARTS: u8 = 4;

/// The cells of a tile whose inside is not known. If one edge crosses a cell according to its corners,
/// [`CrossedCell`] takes a third of the samples that quarters would; if a cell shows one thing whose colour changes
/// evenly, [`Lattice::accumulate_even`] takes one.
#[derive(Debug, Default)]
pub struct Refinement<R> {
    lattice: Lattice<R>,
    cells: Vec<Cell>,
    to_divide: Vec<Cell>,
    crossed: Vec<CrossedCell<R>>,
    /// Cells whose colour may change evenly, and the samples in their middles.
    even: Vec<(Cell, u32)>,
    /// Which sides of the pixels are known.
    sides: PixelSides,
    /// Number of samples that have been checked for what they tell the pixels beside them.
    checked: usize,
    /// Pixels that have received a message and are not divided yet.
    notified_pixels: Vec<Cell>,
    /// Row and column in the tile of all pixels that have received one.
    notified: Vec<[usize; 2]>,
    /// For each pixel of the tile, row by row: how many of its sixteen parts are to be divided, and how many of
    /// these have corners that do not differ. Ends with the last pixel that has such parts.
    part_counts: Vec<[u8; 2]>,
    /// Row and column in the tile of the crowded pixels, which are divided no further.
    crowded: Vec<[usize; 2]>,
}

impl<R: Real> Refinement<R> {
    /// Removes the cells of the previous tile.
    pub fn clear(&mut self) {
        self.to_divide.clear();
        self.cells.clear();
        self.crossed.clear();
        self.even.clear();
        self.notified.clear();
        self.part_counts.clear();
        self.crowded.clear();
    }

    /// The crowded pixels, which are divided no further, by row and column in the tile.
    pub fn crowded(&self) -> &[[usize; 2]] {
        &self.crowded
    }

    /// The pixels that have received a message since the start, by row and column in the tile.
    pub fn notified(&self) -> &[[usize; 2]] {
        &self.notified
    }

    /// Adds a pixel of a tile, given whether it may show a face of a mesh that no corner is on.
    #[inline(always)]
    pub fn add(&mut self, column: usize, row: usize, may_hide_face: bool) {
        self.to_divide.push(Cell::pixel(column, row, may_hide_face));
    }

    /// Starts with the pixels that were added, which become black, and with the results at the corners of all
    /// pixels. Returns whether there are any.
    #[inline(never)]
    pub fn start(
        &mut self,
        tile: &Tile,
        (corners, messages): (&Traced<R>, &EdgeMessages),
        limits: Limits<R>,
        colors: &mut TileColors<R>,
    ) -> bool {
        if self.to_divide.is_empty() {
            return false;
        }
        self.lattice.clear();
        self.lattice.add(tile, corners, &mut self.to_divide);
        self.sides.start(tile, messages);
        self.checked = 0;
        self.cells.append(&mut self.to_divide);
        for pixel in &self.cells {
            colors.blacken(pixel.pixel_in(colors.stride));
        }
        self.classify(limits, colors);
        true
    }

    /// Starts with pixels that have received a message, by row and column in the picture.
    pub fn start_notified(
        &mut self,
        tile: &Tile,
        (corners, messages): (&Traced<R>, &EdgeMessages),
        pixels: &[[usize; 2]],
        colors: &mut TileColors<R>,
    ) {
        self.clear();
        self.lattice.clear();
        self.sides.start(tile, messages);
        self.checked = 0;
        for pixel in pixels {
            self.notify(*pixel);
        }
        self.divide_notified(tile, corners, colors);
    }

    /// Notes that a pixel of the tile, by its row and column in the picture, has received a message.
    fn notify(&mut self, pixel: [usize; 2]) {
        let pixel = self.sides.cell_of(pixel);
        self.sides.note(&pixel, ALL);
        self.notified_pixels.push(pixel);
    }

    /// Divides the pixels that are near something thin; the quarters of the others need not be searched for it.
    #[inline(never)]
    pub fn divide_near_thin(&mut self) {
        let (lattice, cells) = (&mut self.lattice, &mut self.cells);
        self.to_divide.retain(|pixel| {
            let is_near_thin = lattice.is_near_thin(pixel);
            if is_near_thin {
                self.sides.note(pixel, ALL);
                lattice.subdivide(pixel, cells);
            }
            !is_near_thin
        });
        for pixel in &mut self.to_divide {
            pixel.detail = EdgeDetail::Borders;
        }
    }

    /// Divides the quarters of pixels between whose corners light may pass: it is looked for between the corners of
    /// their parts once more.
    #[inline(never)]
    pub fn divide_gaps(&mut self, limits: Limits<R>) {
        let (lattice, cells) = (&self.lattice, &mut self.cells);
        if limits.least_side() < QUARTER_SIDE && lattice.has_shadows() {
            let gaps = cells.extract_if(.., |cell| lattice.may_leave_gap(cell));
            self.to_divide.extend(gaps);
            self.divide();
        }
    }

    /// Divides the cells that are put aside for it.
    #[inline(never)]
    pub fn divide(&mut self) {
        for cell in self.to_divide.drain(..) {
            self.sides.note(&cell, ALL);
            self.lattice.subdivide(&cell, &mut self.cells);
        }
    }

    /// Requests the samples that decide about the cells. Returns whether there are any cells.
    #[inline(never)]
    pub fn request_samples(&mut self) -> bool {
        for cell in &mut self.crossed {
            cell.request_samples(&mut self.lattice);
        }
        for (cell, middle) in &mut self.even {
            *middle = self.lattice.request_middle(cell);
        }
        !(self.cells.is_empty() && self.crossed.is_empty() && self.even.is_empty())
    }

    /// Fills `samples` with those that were requested and have no result yet.
    #[inline(never)]
    pub fn requested_samples(&self, tile: &Tile, samples: &mut Samples<R>) {
        self.lattice.requested_samples(tile, samples);
    }

    /// Takes the results of these samples.
    #[inline(never)]
    pub fn take_results(&mut self, traced: &Traced<R>) {
        self.lattice.take_results(traced);
        // Faces are only noted while the cells are quarters of pixels.
        if !traced.faces.is_empty() {
            self.lattice.note_hidden_light(&mut self.cells);
        }
    }

    /// Adds the colours of the cells that are known well enough, and decides what to do with the others.
    #[inline(never)]
    pub fn evaluate_samples(&mut self, limits: Limits<R>, colors: &mut TileColors<R>) {
        let (lattice, to_divide) = (&self.lattice, &mut self.to_divide);
        self.crossed
            .retain_mut(|cell| match cell.evaluate(lattice, colors) {
                CellFinding::Nothing => true,
                CellFinding::Color => false,
                CellFinding::NotOneEdge(cell) => {
                    to_divide.push(cell);
                    false
                }
            });
        for (cell, middle) in self.even.drain(..) {
            if lattice.accumulate_even((&cell, middle), limits, colors) {
                continue;
            }
            match CrossedCell::of_colors(&cell, lattice, limits) {
                Some(crossed) => {
                    self.sides.note(&cell, crossed.sides());
                    self.crossed.push(crossed);
                }
                None => to_divide.push(cell.signatures_only()),
            }
        }
        self.classify(limits, colors);
        self.set_crowded_aside(limits, colors.stride);
        self.divide();
    }

    /// Stops dividing the pixels of which all parts are to be divided, some of them only because something thin is
    /// near: smaller parts are not searched for that. Which pixels these are depends only on what is seen in each of
    /// them.
    fn set_crowded_aside(&mut self, limits: Limits<R>, stride: usize) {
        let before = self.crowded.len();
        for cell in &self.to_divide {
            if usize::from(cell.side) != PIXEL_STEPS / 4 {
                continue;
            }
            let pixel = cell.pixel_in(stride);
            if self.part_counts.len() <= pixel {
                self.part_counts.resize(pixel + 1, [0; 2]);
            }
            let [parts, alike] = &mut self.part_counts[pixel];
            *parts += 1;
            *alike += u8::from(!self.lattice.differs(cell, limits));
            if *parts == PARTS && *alike >= MIN_ALIKE_PARTS {
                self.crowded.push(cell.row_and_column());
            }
        }
        if self.crowded.len() == before {
            return;
        }
        let part_counts = &self.part_counts;
        let is_kept = |cell: &Cell| {
            let part_counts = part_counts.get(cell.pixel_in(stride));
            part_counts.is_none_or(|&[parts, alike]| parts < PARTS || alike < MIN_ALIKE_PARTS)
        };
        self.to_divide.retain(is_kept);
        self.crossed.retain(|crossed| is_kept(crossed.cell()));
        self.even.retain(|(cell, _)| is_kept(cell));
    }

    /// Divides the pixels for which a sample on one of their sides shows that the samples behind their colour have
    /// not seen everything: the corner of something ends in them, say. Those of other tiles get a message. Returns
    /// whether any pixel was divided.
    #[inline(never)]
    pub fn exchange_messages(
        &mut self,
        tile: &Tile,
        (corners, messages): (&Traced<R>, &EdgeMessages),
        colors: &mut TileColors<R>,
    ) -> bool {
        for index in self.checked..self.lattice.len() {
            let Some(side) = self.sides.side_of(self.lattice.point(index)) else {
                continue;
            };
            if R::from_f64(MAX_EXCESS) < self.lattice.excess(index, side.ends) {
                for (index, side) in side.notified_pixels.into_iter().flatten() {
                    let pixel = self.sides.pixel(index);
                    if self.sides.is_inside(index) {
                        self.notify(pixel);
                    } else {
                        messages.send(pixel, side);
                    }
                }
            }
        }
        self.checked = self.lattice.len();
        self.divide_notified(tile, corners, colors);
        let is_done = self.cells.is_empty();
        if is_done {
            self.sides.finish(tile, messages);
        }
        !is_done
    }

    /// Divides the pixels that have received a message, twice: the end of something may be in a single quarter.
    fn divide_notified(&mut self, tile: &Tile, corners: &Traced<R>, colors: &mut TileColors<R>) {
        self.lattice.add(tile, corners, &mut self.notified_pixels);
        for pixel in self.notified_pixels.drain(..) {
            colors.blacken(pixel.pixel_in(colors.stride));
            if let Some(part_counts) = self.part_counts.get_mut(pixel.pixel_in(colors.stride)) {
                *part_counts = [0; 2];
            }
            self.notified.push(pixel.row_and_column());
            let first = self.to_divide.len();
            self.lattice.subdivide(&pixel, &mut self.to_divide);
            for quarter in self.to_divide.drain(first..) {
                self.lattice.subdivide(&quarter, &mut self.cells);
            }
        }
    }

    /// Adds the colours of the cells that are known by their corners, and sorts the others: those that one edge
    /// crosses, those whose colour may change evenly, and those to divide.
    fn classify(&mut self, limits: Limits<R>, colors: &mut TileColors<R>) {
        let lattice = &self.lattice;
        for mut cell in self.cells.drain(..) {
            if usize::from(cell.side) == PIXEL_STEPS {
                cell.swaps_lights = lattice.may_swap_lights(&cell);
            }
            match lattice.inside(&cell, limits) {
                Inside::Known => lattice.accumulate(&cell, colors),
                Inside::One => self.even.push((cell, 0)),
                Inside::Several => match CrossedCell::of(&cell, lattice, limits) {
                    Some(crossed) => {
                        self.sides.note(&cell, crossed.sides());
                        self.crossed.push(crossed);
                    }
                    None => self.to_divide.push(cell),
                },
                Inside::Anything => self.to_divide.push(cell),
            }
        }
    }
}
