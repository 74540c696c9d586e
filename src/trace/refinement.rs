//! The cells of a tile whose insides are looked at. What becomes of them is decided one by one, not in lanes: it is
//! compiled once for each precision, and not for every width of vectors.

use super::coverage::{CrossedCell, Found};
use super::lattice::{Cell, Inside, Lattice, Limits};
use super::samples::{Samples, Traced};
use super::tile::{Tile, TileColors};
use crate::simd::Real;

/// The cells of a tile whose inside is not known. Where their corners say that one edge crosses them, [`CrossedCell`]
/// takes a third of the samples of quarters, and where they show one thing whose colour changes evenly,
/// [`Lattice::accumulate_even`] takes one.
#[derive(Debug)]
pub struct Refinement<R> {
    lattice: Lattice<R>,
    cells: Vec<Cell>,
    split: Vec<Cell>,
    crossed: Vec<CrossedCell<R>>,
    /// Cells that may be even, and the samples in their middles.
    even: Vec<(Cell, u32)>,
}

impl<R: Real> Refinement<R> {
    /// No cells.
    pub fn new() -> Self {
        Self {
            lattice: Lattice::new(),
            cells: Vec::new(),
            split: Vec::new(),
            crossed: Vec::new(),
            even: Vec::new(),
        }
    }

    /// Forgets the tile before.
    pub fn clear(&mut self) {
        self.split.clear();
        self.cells.clear();
        self.crossed.clear();
        self.even.clear();
    }

    /// Adds a pixel of a tile, and whether it may show a face of a mesh that no corner is on.
    #[inline(always)]
    pub fn add(&mut self, column: usize, row: usize, may_hide_face: bool) {
        self.split.push(Cell::pixel(column, row, may_hide_face));
    }

    /// Starts with the pixels that were added, whose colours become nothing, and with what was seen at the corners of
    /// all. Whether there are any.
    #[inline(never)]
    pub fn start(
        &mut self,
        tile: &Tile,
        corners: &Traced<R>,
        limits: Limits<R>,
        colors: &mut TileColors<R>,
    ) -> bool {
        if self.split.is_empty() {
            return false;
        }
        self.lattice.start(tile, corners, &mut self.split);
        self.cells.append(&mut self.split);
        for channel in &mut colors.channels {
            for pixel in &self.cells {
                channel[pixel.pixel_in(colors.stride)] = R::ZERO;
            }
        }
        self.sort(limits, colors);
        self.subdivide();
        true
    }

    /// Wants the samples that decide what becomes of the cells. Whether there are any cells.
    #[inline(never)]
    pub fn want(&mut self) -> bool {
        for cell in &mut self.crossed {
            cell.want(&mut self.lattice);
        }
        for (cell, middle) in &mut self.even {
            *middle = self.lattice.want_middle(cell);
        }
        !(self.cells.is_empty() && self.crossed.is_empty() && self.even.is_empty())
    }

    /// `samples` become those that are wanted and not there yet.
    #[inline(never)]
    pub fn wanted_samples(&self, tile: &Tile, samples: &mut Samples<R>) {
        self.lattice.wanted_samples(tile, samples);
    }

    /// Takes what was seen there.
    #[inline(never)]
    pub fn take_results(&mut self, traced: &Traced<R>) {
        self.lattice.take_results(traced);
        // Of the quarters of pixels alone.
        if !traced.faces.is_empty() {
            self.lattice.note_hidden_light(&mut self.cells);
        }
    }

    /// Adds the colours of the cells that are known well enough, and notes what is to be done with the others.
    #[inline(never)]
    pub fn settle(&mut self, limits: Limits<R>, colors: &mut TileColors<R>) {
        let (lattice, split) = (&self.lattice, &mut self.split);
        self.crossed
            .retain_mut(|cell| match cell.take(lattice, colors) {
                Found::Nothing => true,
                Found::Color => false,
                Found::Disorder(cell) => {
                    split.push(cell);
                    false
                }
            });
        for (cell, middle) in self.even.drain(..) {
            if lattice.accumulate_even((&cell, middle), limits, colors) {
                continue;
            }
            match CrossedCell::of_colors(&cell, lattice, limits) {
                Some(crossed) => self.crossed.push(crossed),
                None => split.push(cell.unwatched()),
            }
        }
        self.sort(limits, colors);
        self.subdivide();
    }

    /// Adds the colours of the cells that are known by their corners, and puts the others where they belong: those that
    /// one edge crosses, those that may be even, and those to subdivide.
    fn sort(&mut self, limits: Limits<R>, colors: &mut TileColors<R>) {
        let lattice = &self.lattice;
        for cell in &self.cells {
            match lattice.inside(cell, limits) {
                Inside::Known => lattice.accumulate(cell, colors),
                Inside::One => self.even.push((*cell, 0)),
                Inside::Several => match CrossedCell::of(cell, lattice, limits) {
                    Some(crossed) => self.crossed.push(crossed),
                    None => self.split.push(*cell),
                },
                Inside::Anything => self.split.push(*cell),
            }
        }
    }

    /// Divides the cells that are to be divided.
    fn subdivide(&mut self) {
        self.cells.clear();
        for cell in &self.split {
            self.lattice.subdivide(cell, &mut self.cells);
        }
        self.split.clear();
    }
}
