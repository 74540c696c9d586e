//! Mapping between times and positions on the screen.

/// Linear mapping from times to horizontal positions on the screen.
#[derive(Clone, Copy, Debug)]
pub struct Scale {
    /// Left end, in points.
    pub left: f32,
    /// Width, in points.
    pub width: f32,
    /// The time at its left end, in seconds.
    pub start: f64,
    /// The time at its right end, in seconds.
    pub end: f64,
}

impl Scale {
    /// The position of a time.
    pub fn x(&self, time: f64) -> f32 {
        self.left + ((time - self.start) / self.seconds()) as f32 * self.width
    }

    /// The time at a position.
    pub fn time(&self, x: f32) -> f64 {
        self.start + f64::from((x - self.left) / self.width) * self.seconds()
    }

    /// Returns whether a time is within the range shown.
    pub fn shows(&self, time: f64) -> bool {
        (self.start..=self.end).contains(&time)
    }

    /// Length of the range shown, in seconds.
    pub fn seconds(&self) -> f64 {
        self.end - self.start
    }
}
