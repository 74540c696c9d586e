//! What pixels are told by samples beside them, across the borders of tiles.
//!
//! Which pixels are divided for that does not depend on tiles or threads: a pixel that was told something is divided in
//! one way, whatever it was, which only adds samples, and these may tell others. Where that ends is the same in whichever
//! order it is done.

use std::collections::BTreeSet;
use std::mem::take;
use std::ops::Range;
use std::sync::atomic::{AtomicU8, Ordering};
use std::sync::{Mutex, PoisonError};

/// The bit of the upper side of a pixel.
pub const ABOVE: u8 = 1;
/// That of the left one.
pub const LEFT: u8 = 2;
/// That of the lower one.
pub const BELOW: u8 = 4;
/// That of the right one.
pub const RIGHT: u8 = 8;
/// All of them.
pub const ALL: u8 = ABOVE | LEFT | BELOW | RIGHT;

/// Something for a pixel: its row and column, and the side that tells.
type Message = ([usize; 2], u8);

/// What the pixels of a picture, or of rows of it, know and are told.
#[derive(Debug)]
pub struct EdgeMessages {
    width: usize,
    rows: Range<usize>,
    /// The sides of each that have nothing more to tell, bit by bit.
    known: Vec<AtomicU8>,
    waiting: Mutex<Vec<Message>>,
}

/// What the pixels of a band are told.
#[derive(Clone, Copy, Debug)]
pub struct BandMessages<'a> {
    /// By whom.
    pub messages: &'a EdgeMessages,
    /// Those that were told something, by row and column, if only these are traced.
    pub those: Option<&'a [[usize; 2]]>,
}

impl<'a> BandMessages<'a> {
    /// Of all pixels.
    pub fn all(messages: &'a EdgeMessages) -> Self {
        Self {
            messages,
            those: None,
        }
    }
}

impl EdgeMessages {
    /// Nothing yet, for these rows of so many pixels.
    pub fn new(width: usize, rows: Range<usize>) -> Self {
        let pixels = width * rows.len();
        Self {
            width,
            rows,
            known: (0..pixels).map(|_| AtomicU8::new(0)).collect(),
            waiting: Mutex::default(),
        }
    }

    /// How many pixels there are in a row.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Whether there is a row.
    pub fn has(&self, row: usize) -> bool {
        self.rows.contains(&row)
    }

    /// The sides of the pixels in these columns of a row that have nothing more to tell.
    pub fn row(&self, row: usize, columns: &Range<usize>) -> &[AtomicU8] {
        let first = (row - self.rows.start) * self.width;
        &self.known[first + columns.start..first + columns.end]
    }

    /// Tells a pixel something from one of its sides.
    pub fn send(&self, pixel: [usize; 2], side: u8) {
        let mut waiting = self.waiting.lock().unwrap_or_else(PoisonError::into_inner);
        waiting.push((pixel, side));
    }

    /// The pixels that were told what they do not know, row by row, once.
    pub fn received(&mut self) -> BTreeSet<[usize; 2]> {
        let waiting = self
            .waiting
            .get_mut()
            .unwrap_or_else(PoisonError::into_inner);
        let mut waiting = take(waiting);
        waiting.retain(|&([row, column], side)| {
            let known = self.row(row, &(column..column + 1))[0].load(Ordering::Relaxed);
            known & side == 0
        });
        waiting.into_iter().map(|(pixel, _)| pixel).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_hear_once_what_they_do_not_know() {
        let mut messages = EdgeMessages::new(3, 5..7);
        for (pixel, side) in [
            ([6, 2], LEFT),
            ([5, 0], ABOVE),
            ([6, 2], ABOVE),
            ([5, 1], LEFT),
        ] {
            messages.send(pixel, side);
        }
        let know = |row: usize, column: usize, sides: u8| {
            messages.row(row, &(column..column + 1))[0].store(sides, Ordering::Relaxed);
        };
        know(5, 1, LEFT);
        know(6, 2, LEFT | RIGHT);
        assert!(messages.has(6) && !messages.has(7) && !messages.has(4));
        let received: Vec<[usize; 2]> = messages.received().into_iter().collect();
        assert_eq!(received, [[5, 0], [6, 2]]);
        assert!(messages.received().is_empty());
    }
}
