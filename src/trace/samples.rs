//! The input and the output of tracing a tile, in columns of one number per sample.

use std::ops::Range;

use crate::simd::{Real, Vec3};

/// How much a trace finds out about its samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum EdgeDetail {
    /// Only colours.
    Ignored,
    /// Also signatures, which reveal edges.
    Signatures,
    /// Also the shadows that end near the samples, and the faces that they are on: between two of those may be
    /// others.
    Borders,
    /// Also things so thin that they may slip between samples.
    Thin,
}

/// Places in the picture to trace, in pixels from its left and upper edge; padded to whole packets.
#[derive(Clone, Debug, Default)]
pub struct Samples<R> {
    /// Columns.
    pub x: Vec<R>,
    /// Rows.
    pub y: Vec<R>,
    /// The number of places without the padding.
    pub count: usize,
}

/// The results of samples, followed by padding.
#[derive(Clone, Debug, Default)]
pub struct Traced<R> {
    /// The number of samples without the padding.
    pub count: usize,
    /// Linear red, 0–1.
    pub red: Vec<R>,
    /// Linear green.
    pub green: Vec<R>,
    /// Linear blue.
    pub blue: Vec<R>,
    /// Equal where the same things were hit and lit, directly and in mirrors. Only with edges.
    pub signature: Vec<u32>,
    /// Distance in pixels of the nearest thing that may slip between samples. Only with edges.
    pub thin_distance: Vec<R>,
    /// The shadows that the sample is in and that end near it, see [`super::shadows`]. Only with edges.
    pub shadows: Vec<u32>,
    /// The mark of the flat face that the sample is on, see [`super::faces`]; empty in scenes without. Only from
    /// [`EdgeDetail::Borders`] on.
    pub faces: Vec<u64>,
}

/// The bits of signatures that identify what is seen directly; the others also depend on which lights shine there
/// and on what is seen in mirrors.
pub const OBJECT_BITS: u32 = 0xFFFF_0000;

/// Factor that darkens the other samples where some are marked.
const DARKENED: f64 = 0.25;

/// Side of the squares that packets cover: sixteen rays, or two packets of eight.
const SQUARE: usize = 4;

/// Moves each number to the place that `order` has for it; `to` becomes empty if `from` is.
#[inline(always)]
fn sort<T: Copy + Default>(to: &mut Vec<T>, from: &[T], order: &[u32]) {
    to.resize(from.len(), T::default());
    for (&number, &index) in from.iter().zip(order) {
        to[index as usize] = number;
    }
}

/// Replaces the results at `indices`; nothing if there are no new ones.
fn replace<T: Copy, U>(old: &mut [U], new: &[T], indices: &[u32], convert: impl Fn(T) -> U) {
    for (&index, &new) in indices.iter().zip(new) {
        old[index as usize] = convert(new);
    }
}

impl<R: Real> Samples<R> {
    /// Removes all places.
    pub fn clear(&mut self) {
        self.x.clear();
        self.y.clear();
        self.count = 0;
    }

    /// Adds a place.
    #[inline(always)]
    pub fn push(&mut self, x: R, y: R) {
        self.x.push(x);
        self.y.push(y);
    }

    /// Sets the places to all crossings of columns with rows, row by row.
    #[inline(always)]
    pub fn set_grid(&mut self, columns: &[R], rows: impl ExactSizeIterator<Item = R>) {
        let (width, height) = (columns.len(), rows.len());
        self.x.resize(width * height, R::ZERO);
        self.y.resize(width * height, R::ZERO);
        let across = self.x.chunks_exact_mut(width);
        let down = self.y.chunks_exact_mut(width);
        for ((xs, ys), row) in across.zip(down).zip(rows) {
            for ((x, y), &column) in xs.iter_mut().zip(ys).zip(columns) {
                (*x, *y) = (column, row);
            }
        }
    }

    /// Does the same square by square, so that a packet covers places that are close together. `order` becomes the
    /// index of each place, counted row by row.
    #[inline(always)]
    pub fn set_grid_in_squares(&mut self, columns: &[R], rows: &[R], order: &mut Vec<u32>) {
        self.clear();
        order.clear();
        let (whole_columns, whole_rows) = (
            columns.len() / SQUARE * SQUARE,
            rows.len() / SQUARE * SQUARE,
        );
        let mut add = |across: Range<usize>, down: Range<usize>| {
            for row in down {
                for column in across.clone() {
                    self.x.push(columns[column]);
                    self.y.push(rows[row]);
                    order.push((row * columns.len() + column) as u32);
                }
            }
        };
        for top in (0..whole_rows).step_by(SQUARE) {
            for left in (0..whole_columns).step_by(SQUARE) {
                add(left..left + SQUARE, top..top + SQUARE);
            }
        }
        // The rest comes last, so that the squares are whole packets.
        add(whole_columns..columns.len(), 0..whole_rows);
        add(0..columns.len(), whole_rows..rows.len());
    }

    /// Sets `count`, and pads the last packet.
    #[inline(always)]
    pub fn pad(&mut self, lanes: usize) {
        self.count = self.x.len();
        if let (Some(&x), Some(&y)) = (self.x.last(), self.y.last()) {
            let full = self.count.next_multiple_of(lanes);
            self.x.resize(full, x);
            self.y.resize(full, y);
        }
    }
}

impl<R: Real> Traced<R> {
    /// Copies `other`, moving each sample to the place that `order` has for it.
    #[inline(always)]
    pub fn take_sorted(&mut self, other: &Self, order: &[u32]) {
        self.count = other.count;
        let columns = [
            (&mut self.red, &other.red),
            (&mut self.green, &other.green),
            (&mut self.blue, &other.blue),
            (&mut self.thin_distance, &other.thin_distance),
        ];
        for (to, from) in columns {
            sort(to, from, order);
        }
        sort(&mut self.signature, &other.signature, order);
        sort(&mut self.shadows, &other.shadows, order);
        sort(&mut self.faces, &other.faces, order);
    }

    /// Red, green and blue.
    pub fn channels(&self) -> [&[R]; 3] {
        [&self.red, &self.green, &self.blue]
    }

    /// Replaces the results of the samples at `indices` by those in double precision; both know the same of edges.
    pub fn replace(&mut self, indices: &[u32], retraced: &Traced<f64>) {
        let columns = [
            (&mut self.red, &retraced.red),
            (&mut self.green, &retraced.green),
            (&mut self.blue, &retraced.blue),
            (&mut self.thin_distance, &retraced.thin_distance),
        ];
        for (to, from) in columns {
            replace(to, from, indices, R::from_f64);
        }
        replace(&mut self.signature, &retraced.signature, indices, |new| new);
        replace(&mut self.shadows, &retraced.shadows, indices, |new| new);
        replace(&mut self.faces, &retraced.faces, indices, |new| new);
    }

    /// Makes these samples white, and darkens all others.
    pub fn mark(&mut self, indices: &[u32]) {
        for column in [&mut self.red, &mut self.green, &mut self.blue] {
            for number in column.iter_mut() {
                *number = *number * R::from_f64(DARKENED);
            }
            for &index in indices {
                column[index as usize] = R::ONE;
            }
        }
    }

    /// Sets all of `count` samples to a view of nothing but this colour; `length` includes the padding.
    pub fn fill(&mut self, count: usize, length: usize, edges: EdgeDetail, color: Vec3<R>) {
        self.resize(count, length, edges);
        self.red.fill(color.x);
        self.green.fill(color.y);
        self.blue.fill(color.z);
        self.thin_distance.fill(R::INFINITY);
        self.signature.fill(0);
        self.shadows.fill(0);
    }

    /// Makes room for `count` samples; `length` includes the padding of the last packet.
    pub fn resize(&mut self, count: usize, length: usize, edges: EdgeDetail) {
        self.count = count;
        for column in [&mut self.red, &mut self.green, &mut self.blue] {
            column.resize(length, R::ZERO);
        }
        let edge_length = if edges == EdgeDetail::Ignored {
            0
        } else {
            length
        };
        self.thin_distance.resize(edge_length, R::ZERO);
        self.signature.resize(edge_length, 0);
        self.shadows.resize(edge_length, 0);
    }

    /// Makes room for packets that begin at any sample; the values there are meaningless.
    #[inline(always)]
    pub fn lengthen(&mut self, lanes: usize) {
        let length = self.red.len() + lanes;
        for column in [
            &mut self.red,
            &mut self.green,
            &mut self.blue,
            &mut self.thin_distance,
        ] {
            column.resize(length, R::ZERO);
        }
        self.signature.resize(length, 0);
        self.shadows.resize(length, 0);
        if !self.faces.is_empty() {
            self.faces.resize(length, 0);
        }
    }
}
