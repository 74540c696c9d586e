//! Messages from samples to the pixels beside them, across the borders of tiles: such a sample has seen something
//! that the colour of the pixel misses.
//!
//! Which pixels are divided because of messages depends on neither tiles nor threads: a pixel that receives any
//! message is divided in the same way, whatever the message was. That only adds samples, which may send more
//! messages. The outcome is the same in whichever order they are handled.

use std::collections::BTreeSet;
use std::mem::take;
use std::ops::Range;
use std::sync::atomic::{AtomicU8, Ordering};
use std::sync::{Mutex, PoisonError};

/// The bit of a pixel's upper side.
pub const ABOVE: u8 = 1;
/// The bit of the left side.
pub const LEFT: u8 = 2;
/// The bit of the lower side.
pub const BELOW: u8 = 4;
/// The bit of the right side.
pub const RIGHT: u8 = 8;
/// The bits of all sides.
pub const ALL: u8 = ABOVE | LEFT | BELOW | RIGHT;

/// A message to a pixel: its row and column, and the side that the message comes from.
type Message = ([usize; 2], u8);

/// The messages to the pixels of a picture, or of some rows of it, and what these pixels know already.
#[derive(Debug)]
pub struct EdgeMessages {
    width: usize,
    rows: Range<usize>,
    /// For each pixel, the sides from which it can learn nothing more, bit by bit.
    known: Vec<AtomicU8>,
    waiting: Mutex<Vec<Message>>,
}

/// The messages to the pixels of a band.
#[derive(Clone, Copy, Debug)]
pub struct BandMessages<'a> {
    /// The messages of the picture, or of the strip, that the band belongs to.
    pub messages: &'a EdgeMessages,
    /// The pixels that have received messages, by row and column, if only these are traced.
    pub only_pixels: Option<&'a [[usize; 2]]>,
}

impl<'a> BandMessages<'a> {
    /// For a band of which all pixels are traced.
    pub fn all(messages: &'a EdgeMessages) -> Self {
        Self {
            messages,
            only_pixels: None,
        }
    }
}

impl EdgeMessages {
    /// Creates an empty exchange for these rows, of `width` pixels each.
    pub fn new(width: usize, rows: Range<usize>) -> Self {
        let pixels = width * rows.len();
        Self {
            width,
            rows,
            known: (0..pixels).map(|_| AtomicU8::new(0)).collect(),
            waiting: Mutex::default(),
        }
    }

    /// The number of pixels in a row.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Returns whether a row is among these.
    pub fn has_row(&self, row: usize) -> bool {
        self.rows.contains(&row)
    }

    /// The sides from which the pixels in these columns of a row can learn nothing more.
    pub fn known_sides(&self, row: usize, columns: &Range<usize>) -> &[AtomicU8] {
        let first = (row - self.rows.start) * self.width;
        &self.known[first + columns.start..first + columns.end]
    }

    /// Sends a message to a pixel from one of its sides.
    pub fn send(&self, pixel: [usize; 2], side: u8) {
        let mut waiting = self.waiting.lock().unwrap_or_else(PoisonError::into_inner);
        waiting.push((pixel, side));
    }

    /// Takes the messages that are waiting and returns the pixels that learn something from them, row by row, each
    /// once.
    pub fn received(&mut self) -> BTreeSet<[usize; 2]> {
        let waiting = self
            .waiting
            .get_mut()
            .unwrap_or_else(PoisonError::into_inner);
        let mut waiting = take(waiting);
        waiting.retain(|&([row, column], side)| {
            let known = self.known_sides(row, &(column..column + 1))[0].load(Ordering::Relaxed);
            known & side == 0
        });
        waiting.into_iter().map(|(pixel, _)| pixel).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_from_unknown_sides_are_received_once() {
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
            messages.known_sides(row, &(column..column + 1))[0].store(sides, Ordering::Relaxed);
        };
        know(5, 1, LEFT);
        know(6, 2, LEFT | RIGHT);
        assert!(messages.has_row(6) && !messages.has_row(7) && !messages.has_row(4));
        let received: Vec<[usize; 2]> = messages.received().into_iter().collect();
        assert_eq!(received, [[5, 0], [6, 2]]);
        assert!(messages.received().is_empty());
    }
}
