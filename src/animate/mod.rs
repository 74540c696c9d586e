//! From keys and a time to a scene that stands still: interpolation, takes and their keys, timing,
//! ready-made flights.
//!
//! Positions follow centripetal splines ([`ArcLengthSpline`]) at a pace that is monotone in time ([`Curve`]);
//! directions are yaw, pitch and roll, turned the shorter way. At the time of a key, everything is
//! exactly what the key says.

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
pub use pose::{CameraChange, motion_between, pose, shot};
pub use presets::Preset;
pub use resample::resampled;
pub use retime::{Retime, longest_flight, paused_seconds, stretched};
pub use simplify::{Landmark, Simplified, Worst, deviation, ends_of, simplify, worst_off};
pub use table::{TableError, from_table, from_text, to_table, to_text};

#[cfg(test)]
mod tests;
