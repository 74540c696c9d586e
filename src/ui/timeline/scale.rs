//! From time to place on the screen, and back.

/// From time to place on the screen.
#[derive(Clone, Copy, Debug)]
pub struct Scale {
    /// Where it begins, in points.
    pub left: f32,
    /// Width of all of it, in points.
    pub width: f32,
    /// The time at its left end, in seconds.
    pub start: f64,
    /// The time at its right end, in seconds.
    pub end: f64,
}

impl Scale {
    /// Place of a time.
    pub fn x(&self, time: f64) -> f32 {
        self.left + ((time - self.start) / self.seconds()) as f32 * self.width
    }

    /// The time of a place.
    pub fn time(&self, x: f32) -> f64 {
        self.start + f64::from((x - self.left) / self.width) * self.seconds()
    }

    /// Whether a time is shown.
    pub fn shows(&self, time: f64) -> bool {
        (self.start..=self.end).contains(&time)
    }

    /// How much time is shown.
    pub fn seconds(&self) -> f64 {
        self.end - self.start
    }
}
