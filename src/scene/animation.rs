//! The animation as stored in the file: keyframes of the camera and of other properties.

use std::ops::RangeInclusive;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use glam::DVec3;

use super::camera::{Camera, Projection};
use super::notation;
pub use super::notation::vector::Value;
use super::orientation::Orientation;

/// Valid frame rates, in frames per second.
pub const FRAME_RATES: RangeInclusive<f64> = 1.0..=240.0;
/// Largest duration of an animation, in seconds: a day.
pub const MAX_SECONDS: f64 = 86_400.0;
/// Difference in seconds below which two keys, or a key and a frame, count as simultaneous: files may be written by
/// hand.
pub const SAME_TIME: f64 = 1e-6;
/// Largest number of keys of the camera or of a track.
pub const MAX_KEYS: usize = 100_000;

/// Everything that is animated.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Animation {
    /// Frames per second of playback, within [`FRAME_RATES`]. The curves do not depend on it.
    #[serde(with = "notation::number")]
    pub frames_per_second: f64,
    /// Keys of the camera, in order of time.
    pub keys: Vec<Key<Camera>>,
    /// Keys of other properties.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub tracks: Vec<Track>,
    /// The recorded flight from which the camera keys were made, if any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub take: Option<Arc<Take>>,
}

/// A value at a time, and the transition to the next key.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename = "Key")]
pub struct Key<T> {
    /// Seconds from the start of the animation, 0–[`MAX_SECONDS`].
    #[serde(with = "notation::number")]
    pub time: f64,
    /// The value at that time.
    pub value: T,
    /// Interpolation up to the next key.
    #[serde(default, skip_serializing_if = "notation::is_default")]
    pub interpolation: Interpolation,
    /// Easing up to the next key.
    #[serde(default, skip_serializing_if = "notation::is_default")]
    pub easing: Easing,
}

/// Interpolation between a key and the next one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Interpolation {
    /// A smooth curve through the keys. Numbers and the pace do not overshoot; a path in space is rounded, so that it
    /// may swing past a key where it turns. Where a position rests, at two equal keys, it turns without a curve.
    #[default]
    Smooth,
    /// A straight line, at constant speed.
    Linear,
    /// The value stays constant, then jumps: a cut.
    Hold,
    /// An arc around the vertical axis through a point (cameras and positions only).
    Orbit {
        /// A point on the axis.
        #[serde(with = "notation::vector")]
        around: DVec3,
    },
}

/// Variation of speed between two keys.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Easing {
    /// As the interpolation defines it.
    #[default]
    Even,
    /// Slow start.
    In,
    /// Slow end.
    Out,
    /// Slow start and end.
    InOut,
}

/// The keys of one animated number or vector of the scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Track {
    /// The animated property.
    pub target: Target,
    /// Keys in order of time.
    pub keys: Vec<Key<Value>>,
}

/// A property that a track can animate.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Target {
    /// [`super::Scene::ambient_intensity`].
    AmbientIntensity,
    /// Brightness of the named light.
    LightIntensity(String),
    /// Position of the named light.
    LightPosition(String),
    /// Position of the named object, see [`super::Shape::position`].
    ObjectPosition(String),
    /// Rotation of the named object, which must be a mesh: degrees about x, then y, then z.
    ObjectRotation(String),
}

/// The light or object that a track belongs to, by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Owner<'a> {
    /// A light.
    Light(&'a str),
    /// An object.
    Object(&'a str),
}

/// A recorded flight: camera states at the times when they were shown.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Take {
    /// Samples in order of time.
    pub samples: Vec<Sample>,
    /// The camera's other properties, each from the sample where they start to apply.
    pub lenses: Vec<Lens>,
}

/// Compares addresses first: every step of every edit compares scenes, and there may be very many samples.
impl PartialEq for Take {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self, other)
            || (&self.samples, &self.lenses) == (&other.samples, &other.lenses)
    }
}

/// A sample of a take: time in seconds, position, and yaw, pitch and roll in radians.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sample(
    #[serde(with = "notation::number")] pub f64,
    #[serde(with = "notation::vector")] pub DVec3,
    #[serde(with = "notation::number")] pub f64,
    #[serde(with = "notation::number")] pub f64,
    #[serde(with = "notation::number")] pub f64,
);

/// The properties of the camera other than position and orientation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Lens {
    /// Index of the first sample that these apply to.
    pub from: usize,
    /// As in [`Camera`].
    pub projection: Projection,
    /// As in [`Camera`].
    #[serde(with = "notation::number")]
    pub projection_distance: f64,
    /// As in [`Camera`].
    #[serde(with = "notation::number")]
    pub orthographic_height: f64,
}

impl Default for Animation {
    fn default() -> Self {
        Self {
            frames_per_second: 14.0,
            keys: Vec::new(),
            tracks: Vec::new(),
            take: None,
        }
    }
}

impl Animation {
    /// Estimates the memory in bytes, without the take, which clones share.
    pub fn bytes(&self) -> usize {
        let tracks = self.tracks.iter().map(|track| track.keys.len());
        size_of::<Self>()
            + self.keys.len() * size_of::<Key<Camera>>()
            + tracks.sum::<usize>() * size_of::<Key<Value>>()
    }

    /// Returns whether nothing is animated.
    pub fn is_still(&self) -> bool {
        self.keys.is_empty() && self.tracks.is_empty()
    }

    /// The time of the last key in seconds; 0 without keys.
    pub fn duration(&self) -> f64 {
        let last = self.keys.last().map_or(0.0, |key| key.time);
        let tracks = self.tracks.iter().filter_map(|track| track.keys.last());
        tracks.map(|key| key.time).fold(last, f64::max)
    }

    /// Returns the duration in seconds of one loop of repeated playback. If the animation ends as it starts, this
    /// is [`Self::duration`]; otherwise the last frame is shown as long as every other.
    pub fn loop_duration(&self) -> f64 {
        fn is_closed<T: PartialEq>(keys: &[Key<T>]) -> bool {
            let ends = keys.first().zip(keys.last());
            ends.is_none_or(|(first, last)| first.value == last.value)
        }
        let mut tracks = self.tracks.iter();
        if is_closed(&self.keys) && tracks.all(|track| is_closed(&track.keys)) {
            return self.duration();
        }
        self.time_of(self.frame_count() + 1)
    }

    /// The number of frames: one at the start and one every 1/fps seconds, up to the last key.
    pub fn frame_count(&self) -> u64 {
        Self::frames_in(self.duration(), self.frames_per_second)
    }

    /// Returns the number of frames in a duration in seconds, including the one at zero.
    pub fn frames_in(seconds: f64, frames_per_second: f64) -> u64 {
        ((seconds + SAME_TIME) * frames_per_second).floor() as u64 + 1
    }

    /// Returns the time of a frame in seconds; frames are counted from 1.
    pub fn time_of(&self, frame: u64) -> f64 {
        frame.saturating_sub(1) as f64 / self.frames_per_second
    }

    /// Returns the frame nearest to a time, counted from 1; close to the last key, it may be one past the last
    /// frame.
    pub fn nearest_frame(&self, time: f64) -> u64 {
        self.frame_at(time + 0.5 / self.frames_per_second)
    }

    /// Returns the frame shown at a time, counted from 1.
    pub fn frame_at(&self, time: f64) -> u64 {
        Self::frames_in(time.max(0.0), self.frames_per_second)
    }
}

impl<T> Key<T> {
    /// Creates a key with the default interpolation and easing.
    pub fn new(time: f64, value: T) -> Self {
        Self {
            time,
            value,
            interpolation: Interpolation::default(),
            easing: Easing::default(),
        }
    }
}

impl Interpolation {
    /// The name shown in lists.
    pub fn name(self) -> &'static str {
        match self {
            Self::Smooth => "smooth",
            Self::Linear => "linear",
            Self::Hold => "hold",
            Self::Orbit { .. } => "orbit",
        }
    }
}

impl Easing {
    /// All variants.
    pub const ALL: [Self; 4] = [Self::Even, Self::In, Self::Out, Self::InOut];

    /// The name shown in lists.
    pub fn name(self) -> &'static str {
        match self {
            Self::Even => "even",
            Self::In => "slow start",
            Self::Out => "slow end",
            Self::InOut => "slow start and end",
        }
    }
}

impl Target {
    /// Returns the light or object that the property belongs to; `None` for the ambient intensity.
    pub fn owner(&self) -> Option<Owner<'_>> {
        match self {
            Self::AmbientIntensity => None,
            Self::LightIntensity(name) | Self::LightPosition(name) => Some(Owner::Light(name)),
            Self::ObjectPosition(name) | Self::ObjectRotation(name) => Some(Owner::Object(name)),
        }
    }

    /// Returns whether the property is a position.
    pub fn is_position(&self) -> bool {
        matches!(self, Self::LightPosition(_) | Self::ObjectPosition(_))
    }

    /// Returns the same property of a light or object with another name.
    #[must_use]
    pub fn renamed(&self, to: &str) -> Self {
        let to = to.to_owned();
        match self {
            Self::AmbientIntensity => Self::AmbientIntensity,
            Self::LightIntensity(_) => Self::LightIntensity(to),
            Self::LightPosition(_) => Self::LightPosition(to),
            Self::ObjectPosition(_) => Self::ObjectPosition(to),
            Self::ObjectRotation(_) => Self::ObjectRotation(to),
        }
    }

    /// Returns a label: the name of the light or object, and the property.
    pub fn name(&self) -> String {
        match self {
            Self::AmbientIntensity => "Ambient intensity".to_owned(),
            Self::LightIntensity(name) => format!("{name}: intensity"),
            Self::LightPosition(name) | Self::ObjectPosition(name) => format!("{name}: position"),
            Self::ObjectRotation(name) => format!("{name}: rotation"),
        }
    }
}

impl Take {
    /// Returns the camera at a sample; `None` if there is no such sample.
    pub fn camera(&self, index: usize) -> Option<Camera> {
        let &Sample(_, position, yaw, pitch, roll) = self.samples.get(index)?;
        let after = self.lenses.partition_point(|lens| lens.from <= index);
        let lens = &self.lenses[after.checked_sub(1)?];
        let (look_at, up) = Orientation { yaw, pitch, roll }.vectors();
        Some(Camera {
            position,
            look_at,
            up,
            projection: lens.projection,
            projection_distance: lens.projection_distance,
            orthographic_height: lens.orthographic_height,
        })
    }

    /// Appends a sample, rounded: time to a tenth of a millisecond, lengths to nine digits, angles to a
    /// ten-millionth of a radian. A sample that is not later than the last one is dropped.
    pub fn push(&mut self, time: f64, camera: &Camera, angles: Orientation) {
        let time = (time * 1e4).round() / 1e4;
        if self.samples.last().is_some_and(|last| last.0 >= time) {
            return;
        }
        let lens = Lens {
            from: self.samples.len(),
            projection: camera.projection,
            projection_distance: camera.projection_distance,
            orthographic_height: camera.orthographic_height,
        };
        let from = self.lenses.last().map_or(usize::MAX, |last| last.from);
        if self.lenses.last() != Some(&Lens { from, ..lens }) {
            self.lenses.push(lens);
        }
        let angle = |radians: f64| (radians * 1e7).round() / 1e7;
        let position = DVec3::from(camera.position.to_array().map(nine_digits));
        self.samples.push(Sample(
            time,
            position,
            angle(angles.yaw),
            angle(angles.pitch),
            angle(angles.roll),
        ));
    }
}

fn nine_digits(value: f64) -> f64 {
    format!("{value:.8e}").parse().unwrap_or(value)
}
