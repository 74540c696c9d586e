//! The resolution of the first picture after an edit: as fine as fits into the frame budget.

use std::time::Duration;

/// Time that a picture may take during a drag: 30 pictures per second.
pub const BUDGET: Duration = Duration::from_millis(33);
/// Least number of pixels along the longer side of a first picture: better late than unreadable.
const MIN_PIXELS: usize = 128;
/// Largest step, for pictures of any size.
const MAX_STEP: usize = 16;
/// Consecutive pictures with time to spare after which the step becomes finer.
const PATIENCE: u32 = 3;
/// Share of the budget that a finer picture must fit into, so that a cost at the border between two steps does not
/// cause flicker between them.
const SPARE_SHARE: f64 = 0.75;
/// Weight of the newest measurement in the moving average.
const NEWEST_WEIGHT: f64 = 0.35;

/// Measures the cost of a pixel and chooses steps by it.
#[derive(Clone, Debug)]
pub struct Budget {
    nanos_per_pixel: f64,
    step: usize,
    spare_streak: u32,
}

impl Budget {
    /// Starts coarse, as no cost is known yet.
    pub fn new() -> Self {
        Self {
            nanos_per_pixel: 0.0,
            step: 8,
            spare_streak: 0,
        }
    }

    /// Chooses the step of the first pass over a picture of this size that may take this time.
    pub fn choose(&mut self, width: usize, height: usize, time: Duration) -> usize {
        let max_ratio = (width.max(height) / MIN_PIXELS).clamp(1, MAX_STEP);
        let max_step = 1 << max_ratio.ilog2();
        let needed = self.finest_step((width, height), time).min(max_step);
        self.step = self.step.max(needed).min(max_step);
        if self.finest_step((width, height), time.mul_f64(SPARE_SHARE)) < self.step {
            self.spare_streak += 1;
        } else {
            self.spare_streak = 0;
        }
        if self.spare_streak >= PATIENCE {
            self.step /= 2;
            self.spare_streak = 0;
        }
        self.step
    }

    /// Updates the cost of a pixel with a first pass of `pixels` pixels.
    pub fn learn(&mut self, pixels: u64, time: Duration) {
        let nanos = time.as_nanos() as f64 / pixels.max(1) as f64;
        self.nanos_per_pixel = match self.nanos_per_pixel {
            0.0 => nanos,
            old => old + (nanos - old) * NEWEST_WEIGHT,
        };
    }

    /// The finest step whose picture is expected to take no more than this time.
    fn finest_step(&self, (width, height): (usize, usize), time: Duration) -> usize {
        let budget = time.as_nanos() as f64;
        let fits = |step: &usize| {
            let pixels = (width.div_ceil(*step) * height.div_ceil(*step)) as f64;
            pixels * self.nanos_per_pixel <= budget
        };
        [1, 2, 4, 8].into_iter().find(fits).unwrap_or(MAX_STEP)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIDE: usize = 1024;

    fn after(nanos_per_pixel: u64, frames: usize) -> (Budget, Vec<usize>) {
        let mut budget = Budget::new();
        let steps = (0..frames)
            .map(|_| {
                budget.learn(1000, Duration::from_nanos(nanos_per_pixel * 1000));
                budget.choose(SIDE, SIDE, BUDGET)
            })
            .collect();
        (budget, steps)
    }

    #[test]
    fn a_cheap_scene_becomes_sharp_one_step_at_a_time() {
        let (_, steps) = after(10, 12);
        assert_eq!(steps, [8, 8, 4, 4, 4, 2, 2, 2, 1, 1, 1, 1]);
    }

    #[test]
    fn an_expensive_scene_stops_at_the_floor() {
        let (mut budget, steps) = after(1_000_000, 4);
        assert_eq!(steps, [8, 8, 8, 8], "128 pixels are left");
        assert_eq!(
            budget.choose(200, 100, BUDGET),
            1,
            "a small picture has nothing to save"
        );
        assert_eq!(budget.choose(4096, 100, BUDGET), MAX_STEP);
    }

    #[test]
    fn a_cost_at_the_border_does_not_flicker() {
        let border = BUDGET.as_nanos() as u64 / (SIDE * SIDE / 4) as u64;
        let (mut budget, _) = after(border, 20);
        let mut changes = 0;
        let mut last = budget.choose(SIDE, SIDE, BUDGET);
        for n in 0..300_u64 {
            budget.learn(1000, Duration::from_nanos((border - 3 + n % 7) * 1000));
            let step = budget.choose(SIDE, SIDE, BUDGET);
            changes += usize::from(step != last);
            last = step;
        }
        assert!(changes <= 1, "{changes} changes in 300 frames");
    }
}
