//! Evaluates the animation of a scene at a time: interpolation of keys, conversion of takes to keys, retiming, and
//! preset flights.
//!
//! Positions follow centripetal splines ([`ArcLengthSpline`]), with speed given by monotone curves ([`Curve`]).
//! Orientations are interpolated as yaw, pitch and roll, each turning the shorter way. At the time of a key, all
//! values are exactly those of the key.

mod curve;

mod arc_length_spline;

mod path;

mod pose;

mod presets;

mod retime;

mod smoothing;

mod resample;

mod simplify;

mod table;

pub use arc_length_spline::ArcLengthSpline;
pub use curve::{Closing, Curve};
pub use path::CameraPath;
pub use pose::{CameraChange, motion_between, pose, shot, shot_of_frame};
pub use presets::Preset;
pub use resample::resampled;
pub use retime::{Retime, longest_flight, paused_seconds, stretched};
pub use simplify::{
    Landmark, Simplified, WorstDeviation, deviation, ends_of, simplify, worst_deviation,
};
pub use table::{TableError, from_table, from_text, to_table, to_text};

#[cfg(test)]
mod tests;
