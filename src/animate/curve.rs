//! Interpolation of a number over time without overshoot.

/// Boundary condition at the ends of a run of keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Closing {
    /// The run starts and stops.
    Open,
    /// The end is the start again: after the last key, it continues as after the first.
    Closed,
}

/// A monotone cubic interpolant of (time, value) pairs: between two keys it stays between their values.
///
/// Steffen, "A simple method for monotonic interpolation in one dimension", Astronomy and Astrophysics 239, 1990.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    times: Vec<f64>,
    values: Vec<f64>,
    slopes: Vec<f64>,
}

impl Curve {
    /// Creates a curve through `values` at strictly increasing `times`. There must be at least one of each.
    pub fn new(times: Vec<f64>, values: Vec<f64>, closing: Closing) -> Self {
        let last = times.len() - 1;
        let secant = |i: usize| (values[i + 1] - values[i]) / (times[i + 1] - times[i]);
        let step = |i: usize| times[i + 1] - times[i];
        let inner = |before: usize, after: usize| {
            steffen_slope(step(before), step(after), secant(before), secant(after))
        };
        let slope = |i: usize| match (i, closing) {
            _ if last == 0 => 0.0,
            (i, _) if i > 0 && i < last => inner(i - 1, i),
            _ if last == 1 => secant(0),
            (_, Closing::Closed) => inner(last - 1, 0),
            (0, Closing::Open) => end_slope(step(0), step(1), secant(0), secant(1)),
            _ => end_slope(
                step(last - 1),
                step(last - 2),
                secant(last - 1),
                secant(last - 2),
            ),
        };
        let slopes = (0..=last).map(slope).collect();
        Self {
            times,
            values,
            slopes,
        }
    }

    /// Returns the value at a share `along` (0–1) of the time from key `i` to the next.
    pub fn at(&self, i: usize, along: f64) -> f64 {
        let (from, to) = (self.values[i], self.values[i + 1]);
        let step = self.times[i + 1] - self.times[i];
        let remaining = 1.0 - along;
        // Cubic Hermite polynomial, written relative to the first value: between equal values with zero slopes it
        // is exact.
        let bend = remaining * self.slopes[i] - along * self.slopes[i + 1];
        from + (to - from) * along * along * (3.0 - 2.0 * along) + step * along * remaining * bend
    }
}

/// Returns the slope at an inner key, from the time steps and secant slopes on both sides.
fn steffen_slope(before: f64, after: f64, left: f64, right: f64) -> f64 {
    let parabola = (left * after + right * before) / (before + after);
    let steepest = left.abs().min(right.abs()).min(parabola.abs() / 2.0);
    let sign = |x: f64| if x == 0.0 { 0.0 } else { x.signum() };
    (sign(left) + sign(right)) * steepest
}

/// Returns the slope at an end: that of the parabola through the last three keys, limited like the others.
fn end_slope(near: f64, far: f64, secant: f64, next: f64) -> f64 {
    let slope = secant * (1.0 + near / (near + far)) - next * near / (near + far);
    if slope * secant <= 0.0 {
        0.0
    } else if slope.abs() > 2.0 * secant.abs() {
        2.0 * secant
    } else {
        slope
    }
}
