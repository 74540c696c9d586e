//! Pixels in which more things meet than can be told apart by looking for their edges: they become the mean of samples
//! all over them, as many as it takes. That is as right there, and comes sooner.

use std::ops::Range;

use super::lattice::{Cell, Inside, Lattice, Limits};
use super::samples::{Samples, Traced};
use super::thresholds::{CROWD_ERROR, FINEST};
use super::tile::{Tile, TileColors};
use crate::simd::Real;

/// Samples of a pixel that are looked at together: a packet, or two.
const ROUND: usize = 16;
/// Rounds after which a pixel may be known.
const FIRST: usize = 4;
/// Rounds after which it is left as it is: with as many samples as the smallest cells would take.
const LAST: usize = 16;
/// So many pixels are traced together.
const TOGETHER: usize = 16;
/// Quarters of a pixel in which many things meet: one is no more than a corner.
const QUARTERS: usize = 3;

/// Steps from each sample to the next, in pixels that wrap around: any first few of them are spread evenly (Roberts, "The
/// unreasonable effectiveness of quasirandom sequences", 2018).
const STEPS: [f64; 2] = [0.754_877_666_246_693, 0.569_840_290_998_053_2];

/// A pixel, and what is known of it.
#[derive(Debug)]
struct Pixel<R> {
    column: usize,
    row: usize,
    /// The sums of the means of its rounds, red, green and blue, and of their squares.
    sums: [[R; 2]; 3],
}

/// The pixels of a tile in which many things meet.
#[derive(Debug)]
pub struct Crowd<R> {
    /// Column and row of those that nobody has looked at yet.
    waiting: Vec<(usize, usize)>,
    /// Those that are looked at.
    pixels: Vec<Pixel<R>>,
    /// In these rounds.
    rounds: Range<usize>,
}

impl<R: Real> Crowd<R> {
    /// No pixels.
    pub fn new() -> Self {
        Self {
            waiting: Vec::new(),
            pixels: Vec::new(),
            rounds: 0..0,
        }
    }

    /// Takes a pixel, given its quarters, if many things meet in it that its samples do not tell apart. Nothing of it
    /// must be known yet.
    pub fn takes(&mut self, quarters: &[Cell], lattice: &Lattice<R>, limits: Limits<R>) -> bool {
        let Some(first) = quarters
            .first()
            .filter(|_| LAST <= limits.most_cells() / ROUND)
        else {
            return false;
        };
        if usize::from(first.side) * 2 != FINEST {
            return false;
        }
        let is_full = |cell: &&Cell| {
            let seen = lattice.corners(cell).map(|sample| sample.signature);
            are_many(seen) && !matches!(lattice.inside(cell, limits), Inside::Known)
        };
        let is_taken = quarters.iter().filter(is_full).count() >= QUARTERS;
        if is_taken {
            let [x, y] = [first.x, first.y].map(usize::from);
            self.waiting.push((x / FINEST, y / FINEST));
        }
        is_taken
    }

    /// `samples` become those that it needs next. Whether there are any.
    #[inline(never)]
    pub fn want(&mut self, tile: &Tile, samples: &mut Samples<R>) -> bool {
        let done = self.rounds.end;
        self.rounds = done..done * 2;
        if self.pixels.is_empty() {
            let new = self.waiting.len().saturating_sub(TOGETHER)..;
            let new = self.waiting.drain(new).map(|(column, row)| Pixel {
                column,
                row,
                sums: [[R::ZERO; 2]; 3],
            });
            self.pixels.extend(new);
            self.rounds = 0..FIRST;
        }
        samples.clear();
        for pixel in &self.pixels {
            let left = (tile.columns.start + pixel.column) as f64;
            let top = (tile.rows.start + pixel.row) as f64;
            for index in self.rounds.start * ROUND..self.rounds.end * ROUND {
                let [x, y] = STEPS.map(|step| (0.5 + step * index as f64).fract());
                samples.push(R::from_f64(left + x), R::from_f64(top + y));
            }
        }
        !self.pixels.is_empty()
    }

    /// Takes what was seen there. Pixels that are known well enough get their colours.
    #[inline(never)]
    pub fn take(&mut self, traced: &Traced<R>, colors: &mut TileColors<R>) {
        let Range { start, end } = self.rounds;
        let mut first = 0;
        self.pixels.retain_mut(|pixel| {
            let samples = first..first + (end - start) * ROUND;
            first = samples.end;
            for (sums, seen) in pixel.sums.iter_mut().zip(traced.channels()) {
                for round in seen[samples.clone()].chunks_exact(ROUND) {
                    let sum = round.iter().fold(R::ZERO, |sum, &color| sum + color);
                    let mean = sum * R::from_f64(1.0 / ROUND as f64);
                    *sums = [sums[0] + mean, sums[1] + mean * mean];
                }
            }
            let is_known = end >= LAST || pixel.variance(end) <= CROWD_ERROR * CROWD_ERROR;
            if is_known {
                let share = R::from_f64(1.0 / end as f64);
                for (channel, [sum, _]) in colors.channels.iter_mut().zip(pixel.sums) {
                    channel[pixel.row * colors.stride + pixel.column] = sum * share;
                }
            }
            !is_known
        });
    }
}

impl<R: Real> Pixel<R> {
    /// Of the mean of so many rounds: that of the rounds, over their number, as if they knew nothing of each other. The
    /// largest of the channels.
    fn variance(&self, rounds: usize) -> f64 {
        let rounds = rounds as f64;
        let of_mean = self.sums.map(|sums| {
            let [sum, squares] = sums.map(R::to_f64);
            (squares - sum * sum / rounds) / (rounds * (rounds - 1.0))
        });
        of_mean.into_iter().fold(0.0, f64::max)
    }
}

/// Whether at least three of these are different.
fn are_many([a, b, c, d]: [u32; 4]) -> bool {
    let other = if b == a { c } else { b };
    let is_third = |seen: u32| seen != a && seen != other;
    other != a && (is_third(c) || is_third(d))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_are_many() {
        for (seen, expected) in [
            ([1, 1, 1, 1], false),
            ([1, 1, 1, 2], false),
            ([1, 2, 1, 2], false),
            ([1, 2, 2, 1], false),
            ([1, 1, 2, 2], false),
            ([1, 2, 2, 2], false),
            ([1, 1, 2, 3], true),
            ([1, 2, 1, 3], true),
            ([1, 2, 3, 1], true),
            ([1, 2, 2, 3], true),
            ([1, 2, 3, 4], true),
        ] {
            assert_eq!(are_many(seen), expected, "{seen:?}");
        }
    }

    /// How bright pixels become that see this, and how many samples they take.
    fn look(count: usize, see: impl Fn(f64, f64) -> f64) -> (Vec<f64>, usize) {
        let tile = Tile {
            columns: 10..10 + count,
            rows: 20..22,
        };
        let mut crowd = Crowd::<f64>::new();
        crowd.waiting = (0..count).map(|column| (column, 1)).collect();
        let (mut samples, mut traced) = (Samples::default(), Traced::default());
        let mut colors = TileColors::default();
        colors.clear(count + 1, (count + 1) * 2);
        let mut taken = 0;
        while crowd.want(&tile, &mut samples) {
            samples.pad(1);
            taken += samples.count;
            let places = samples.x.iter().zip(&samples.y);
            traced.red = places.map(|(&x, &y)| see(x, y - 21.0)).collect();
            traced.green = vec![0.25; samples.count];
            traced.blue = vec![0.0; samples.count];
            crowd.take(&traced, &mut colors);
        }
        let [red, green, _] = colors.channels;
        assert!(green[count + 1..][..count].iter().all(|&seen| seen == 0.25));
        (red[count + 1..][..count].to_vec(), taken)
    }

    #[test]
    fn pixels_take_as_many_samples_as_they_need() {
        // Each pixel its own brightness, and more of them than are looked at together.
        let (seen, taken) = look(40, |x, _| x.floor());
        assert_eq!(taken, 40 * FIRST * ROUND);
        assert!((0..40).all(|column| seen[column] == column as f64 + 10.0));
        let fine = |x: f64, y: f64| f64::from(u8::from((x * 37.0 + y * 23.0).sin() > 0.0));
        let (seen, taken) = look(3, fine);
        assert!(
            taken > 3 * FIRST * ROUND && taken <= 3 * LAST * ROUND,
            "{taken}"
        );
        assert!(
            seen.iter().all(|seen| (seen - 0.5).abs() < 0.03),
            "{seen:?}"
        );
    }
}
