//! What goes into the tracing of a tile, and what comes out of it, one number per sample in each
//! column.

use std::ops::Range;

use crate::simd::{Real, Vec3};

/// What a trace finds out about its samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum EdgeDetail {
    /// Colours alone.
    Ignored,
    /// Also signatures, which tell edges.
    Signed,
    /// Also the shadows and the faces that end near them: between two of those may be others.
    Bordered,
    /// Also what is so thin that it may slip between samples.
    Near,
}

/// Places in the picture to be traced, in pixels from its left and upper edge; filled up to whole
/// packets.
#[derive(Clone, Debug, Default)]
pub struct Samples<R> {
    /// Columns.
    pub x: Vec<R>,
    /// Rows.
    pub y: Vec<R>,
    /// How many are wanted.
    pub count: usize,
}

/// What was seen at each sample, and some more at the end.
#[derive(Clone, Debug, Default)]
pub struct Traced<R> {
    /// How many samples there are.
    pub count: usize,
    /// Linear red, 0–1.
    pub red: Vec<R>,
    /// Linear green.
    pub green: Vec<R>,
    /// Linear blue.
    pub blue: Vec<R>,
    /// Equal where the same things were hit and lit, directly and in mirrors. Only with edges.
    pub signature: Vec<u32>,
    /// How many pixels away the next thing is that may slip between samples. Only with edges.
    pub near: Vec<R>,
    /// Which shadows it is in that end near it, see [`super::shadows`]. Only with edges.
    pub shadows: Vec<u32>,
    /// Which flat face it is on, see [`super::faces`]; empty in scenes without. Only with [`EdgeDetail::Bordered`].
    pub faces: Vec<u64>,
}

/// The bits of signatures that tell things apart which are seen directly; the others also tell which lights shine on
/// them and what is seen in mirrors.
pub const THING: u32 = 0xFFFF_0000;

/// What is left of the light where others are marked.
const DARKENED: f64 = 0.25;

/// Side of the squares that packets look at: sixteen rays, or two packets of eight.
const SQUARE: usize = 4;

/// Puts numbers into the places that `order` has for them; none if there are none.
#[inline(always)]
fn sort<T: Copy + Default>(to: &mut Vec<T>, from: &[T], order: &[u32]) {
    to.resize(from.len(), T::default());
    for (&number, &index) in from.iter().zip(order) {
        to[index as usize] = number;
    }
}

impl<R: Real> Samples<R> {
    /// Forgets all.
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

    /// Becomes all crossings of columns with rows, row by row.
    #[inline(always)]
    pub fn cross(&mut self, columns: &[R], rows: impl ExactSizeIterator<Item = R>) {
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

    /// The same, square by square: a packet then looks at what is close together. `order` becomes which
    /// crossing, counted row by row, each sample is.
    #[inline(always)]
    pub fn cross_in_squares(&mut self, columns: &[R], rows: &[R], order: &mut Vec<u32>) {
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
        // What is left over comes last, so that the squares are whole packets.
        add(whole_columns..columns.len(), 0..whole_rows);
        add(0..columns.len(), whole_rows..rows.len());
    }

    /// Counts the places, and fills the last packet up.
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
    /// Becomes what `other` is, each sample in the place that `order` has for it.
    #[inline(always)]
    pub fn take_sorted(&mut self, other: &Self, order: &[u32]) {
        self.count = other.count;
        let columns = [
            (&mut self.red, &other.red),
            (&mut self.green, &other.green),
            (&mut self.blue, &other.blue),
            (&mut self.near, &other.near),
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

    /// What was seen at these samples becomes what was seen in double precision.
    pub fn replace(&mut self, places: &[u32], seen: &Traced<f64>, edges: EdgeDetail) {
        let columns = [
            (&mut self.red, &seen.red),
            (&mut self.green, &seen.green),
            (&mut self.blue, &seen.blue),
            (&mut self.near, &seen.near),
        ];
        let noted = if edges == EdgeDetail::Ignored { 3 } else { 4 };
        for (to, from) in columns.into_iter().take(noted) {
            for (&index, &number) in places.iter().zip(from) {
                to[index as usize] = R::from_f64(number);
            }
        }
        if edges != EdgeDetail::Ignored {
            for (&index, &signature) in places.iter().zip(&seen.signature) {
                self.signature[index as usize] = signature;
            }
            for (&index, &shadows) in places.iter().zip(&seen.shadows) {
                self.shadows[index as usize] = shadows;
            }
            for (&index, &face) in places.iter().zip(&seen.faces) {
                self.faces[index as usize] = face;
            }
        }
    }

    /// Makes these samples white, and all others darker.
    pub fn mark(&mut self, places: &[u32]) {
        for column in [&mut self.red, &mut self.green, &mut self.blue] {
            for number in column.iter_mut() {
                *number = *number * R::from_f64(DARKENED);
            }
            for &index in places {
                column[index as usize] = R::ONE;
            }
        }
    }

    /// Becomes so many views of nothing but this colour.
    pub fn fill(&mut self, count: usize, length: usize, edges: EdgeDetail, color: Vec3<R>) {
        self.resize(count, length, edges);
        self.red.fill(color.x);
        self.green.fill(color.y);
        self.blue.fill(color.z);
        self.near.fill(R::INFINITY);
        self.signature.fill(0);
        self.shadows.fill(0);
    }

    /// Makes room for so many samples, `length` with those that fill the last packet up.
    pub fn resize(&mut self, count: usize, length: usize, edges: EdgeDetail) {
        self.count = count;
        for column in [&mut self.red, &mut self.green, &mut self.blue] {
            column.resize(length, R::ZERO);
        }
        let noted = if edges == EdgeDetail::Ignored {
            0
        } else {
            length
        };
        self.near.resize(noted, R::ZERO);
        self.signature.resize(noted, 0);
        self.shadows.resize(noted, 0);
    }

    /// Makes room for packets that begin at any sample; what is seen there means nothing.
    #[inline(always)]
    pub fn lengthen(&mut self, lanes: usize) {
        let length = self.red.len() + lanes;
        for column in [
            &mut self.red,
            &mut self.green,
            &mut self.blue,
            &mut self.near,
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
