//! The limits above which a cell between samples is subdivided.

use super::thresholds::{EDGE_ERROR, PIXEL_STEPS, SPREAD_OUT};
use crate::scene::MAX_HALVINGS;
use crate::simd::Real;

/// The limits above which cells are subdivided.
#[derive(Clone, Copy, Debug)]
pub struct Limits<R> {
    /// Difference between the corners of a cell, summed over the channels, above which it is subdivided.
    contrast: R,
    /// The same for corners that see different things, times the side of the cell in pixels.
    edge_contrast: R,
    /// How often a pixel is subdivided, not counting the last time.
    depth: u32,
}

impl<R: Real> Limits<R> {
    /// Creates limits from the contrast for cells whose corners see the same, and the depth.
    pub fn new(contrast: f64, depth: u32) -> Self {
        Self {
            contrast: R::from_f64(contrast),
            edge_contrast: R::from_f64(contrast.min(EDGE_ERROR)),
            depth: depth.min(MAX_HALVINGS),
        }
    }

    /// Returns the limits for cells of a side in pixels: the smaller they are, the more their corners may differ.
    #[inline(always)]
    pub fn at(self, side: R) -> Self {
        let edge_contrast = self.edge_contrast / side;
        Self {
            contrast: self.contrast.max(edge_contrast),
            edge_contrast,
            ..self
        }
    }

    /// Returns the side of the smallest cells, in steps of the finest grid.
    pub fn least_side(self) -> u16 {
        (PIXEL_STEPS >> (self.depth + 1)) as u16
    }

    /// Returns how many samples are taken in a pixel that is too crowded to be divided, and the step between them,
    /// see [`SPREAD_OUT`].
    pub fn spread_out(self) -> (usize, usize) {
        let cells = PIXEL_STEPS / usize::from(self.least_side());
        let mut lattices = SPREAD_OUT.iter();
        let lattice = lattices.find(|(side, _)| *side <= cells);
        lattice.map_or((1, 1), |(_, lattice)| *lattice)
    }

    /// Returns the contrast above which a cell whose corners see the same is subdivided, by its side in pixels.
    pub fn contrast_of_same(self, side: f64) -> R {
        self.at(R::from_f64(side)).contrast(true)
    }

    /// Returns the contrast of a cell's corners above which its inside must be examined, by whether they see the
    /// same. Near something thin it must be examined at any contrast: corners tell nothing about what passes between
    /// them, whether they see the same thing, others of the same kind, or neither.
    #[inline(always)]
    pub fn contrast(self, is_same: bool) -> R {
        if is_same {
            self.contrast
        } else {
            self.edge_contrast
        }
    }
}
