//! Spatial curves through points, parameterized by arc length.

use glam::DVec3;

use super::Closing;

/// Number of pieces of a segment whose lengths are stored.
const PIECES: usize = 16;

/// A centripetal Catmull–Rom spline, the only one of its family without cusps and loops within a segment.
/// Consecutive equal points count as one.
///
/// Yuksel, Schaefer and Keyser, "Parameterization and applications of Catmull–Rom curves", Computer-Aided Design
/// 43, 2011.
#[derive(Clone, Debug)]
pub struct ArcLengthSpline {
    segments: Vec<Segment>,
    /// Arc length up to each of the given points, in world units.
    lengths_at_points: Vec<f64>,
}

/// A cubic from one point to the next, with tabulated arc lengths.
#[derive(Clone, Debug)]
struct Segment {
    ends: [DVec3; 2],
    /// Derivatives at the ends, with respect to the parameter from 0 to 1.
    tangents: [DVec3; 2],
    /// Arc length of all segments before it.
    start: f64,
    /// Arc length from the start of the segment to the end of each piece; the first entry is 0.
    lengths: [f64; PIECES + 1],
}

impl ArcLengthSpline {
    /// Creates a curve through `points`, of which there must be at least one.
    pub fn new(points: &[DVec3], closing: Closing) -> Self {
        Self::through(points, closing, false)
    }

    /// Creates an open curve through `points`, of which there must be at least one. It may turn sharply at equal
    /// consecutive points, where it approaches and leaves as at an end: what falls and rests does not sink.
    pub fn with_rests(points: &[DVec3]) -> Self {
        Self::through(points, Closing::Open, true)
    }

    fn through(points: &[DVec3], closing: Closing, turns_at_rests: bool) -> Self {
        let mut stops: Vec<DVec3> = Vec::new();
        let mut stop_indices = Vec::new();
        let mut is_corner = Vec::new();
        for &point in points {
            // A distance whose square underflows counts as zero.
            if stops
                .last()
                .is_none_or(|last| (point - *last).length() > 0.0)
            {
                stops.push(point);
                is_corner.push(false);
            } else if let Some(is_corner) = is_corner.last_mut() {
                *is_corner = turns_at_rests;
            }
            stop_indices.push(stops.len() - 1);
        }
        let last = stops.len() - 1;
        let is_closed = closing == Closing::Closed && last > 1 && stops[0] == stops[last];
        let mut start = 0.0;
        let mut segments: Vec<Segment> = Vec::new();
        for i in 0..last {
            let (from, to) = (stops[i], stops[i + 1]);
            let before = match i {
                0 if is_closed => stops[last - 1],
                _ if i == 0 || is_corner[i] => from * 2.0 - to,
                _ => stops[i - 1],
            };
            let after = match i + 2 {
                next if next <= last && !is_corner[i + 1] => stops[next],
                _ if is_closed => stops[1],
                _ => to * 2.0 - from,
            };
            let segment = Segment::new([before, from, to, after], start);
            start += segment.length();
            segments.push(segment);
        }
        let ends = segments
            .iter()
            .map(|segment| segment.start + segment.length());
        let stops: Vec<f64> = std::iter::once(0.0).chain(ends).collect();
        let lengths_at_points = stop_indices.into_iter().map(|index| stops[index]).collect();
        Self {
            segments,
            lengths_at_points,
        }
    }

    /// Arc length up to each of the given points, in world units.
    pub fn lengths_at_points(&self) -> &[f64] {
        &self.lengths_at_points
    }

    /// Returns the position at an arc length; `None` for a curve through a single point.
    pub fn at(&self, length: f64) -> Option<DVec3> {
        let after = self
            .segments
            .partition_point(|segment| segment.start <= length);
        let segment = self.segments.get(after.saturating_sub(1))?;
        Some(segment.at(segment.parameter_at((length - segment.start).max(0.0))))
    }
}

impl Segment {
    fn new([before, from, to, after]: [DVec3; 4], start: f64) -> Self {
        // Distances between knots are the square roots of the distances between points.
        let knot = |a: DVec3, b: DVec3| (b - a).length().sqrt();
        let (left, here, right) = (knot(before, from), knot(from, to), knot(to, after));
        let slope = |a: DVec3, b: DVec3, c: DVec3, ab: f64, bc: f64| {
            (b - a) * (1.0 / ab) - (c - a) * (1.0 / (ab + bc)) + (c - b) * (1.0 / bc)
        };
        let mut segment = Self {
            ends: [from, to],
            tangents: [
                slope(before, from, to, left, here) * here,
                slope(from, to, after, here, right) * here,
            ],
            start,
            lengths: [0.0; PIECES + 1],
        };
        for piece in 0..PIECES {
            let (from, to) = (parameter_of(piece), parameter_of(piece + 1));
            segment.lengths[piece + 1] = segment.lengths[piece] + segment.length_between(from, to);
        }
        segment
    }

    fn length(&self) -> f64 {
        self.lengths[PIECES]
    }

    /// Returns the position at a parameter from 0 to 1: a cubic Hermite polynomial.
    fn at(&self, parameter: f64) -> DVec3 {
        let [from, to] = self.ends;
        if parameter >= 1.0 {
            return to;
        }
        let remaining = 1.0 - parameter;
        let tangent_part = self.tangents[0] * remaining - self.tangents[1] * parameter;
        from + (to - from) * (parameter * parameter * (3.0 - 2.0 * parameter))
            + tangent_part * (parameter * remaining)
    }

    fn speed(&self, parameter: f64) -> f64 {
        let [from, to] = self.ends;
        let [out, into] = self.tangents;
        let direct = (to - from) * (6.0 * parameter * (1.0 - parameter));
        let out = out * (1.0 + parameter * (3.0 * parameter - 4.0));
        (direct + out + into * (parameter * (3.0 * parameter - 2.0))).length()
    }

    /// Returns the arc length between two parameters, by three-point Gauss–Legendre quadrature.
    fn length_between(&self, from: f64, to: f64) -> f64 {
        let (half, middle) = ((to - from) / 2.0, f64::midpoint(from, to));
        let offset = half * 0.6_f64.sqrt();
        let outer = self.speed(middle - offset) + self.speed(middle + offset);
        half * (5.0 * outer + 8.0 * self.speed(middle)) / 9.0
    }

    /// Returns the parameter at which an arc length is reached.
    fn parameter_at(&self, length: f64) -> f64 {
        if length >= self.length() {
            return 1.0;
        }
        let piece = self.lengths.partition_point(|&reached| reached <= length) - 1;
        let (start, end) = (self.lengths[piece], self.lengths[piece + 1]);
        let (low, high) = (parameter_of(piece), parameter_of(piece + 1));
        let mut parameter = low + (high - low) * (length - start) / (end - start);
        for _ in 0..3 {
            let speed = self.speed(parameter);
            if speed > 0.0 {
                let missing = length - start - self.length_between(low, parameter);
                parameter = (parameter + missing / speed).clamp(low, high);
            }
        }
        parameter
    }
}

fn parameter_of(piece: usize) -> f64 {
    piece as f64 / PIECES as f64
}
