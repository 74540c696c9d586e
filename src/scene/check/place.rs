//! Positions in a scene, and checks for common kinds of values.

use std::ops::RangeInclusive;

use glam::DVec3;

pub use crate::mesh::MAX_COORDINATE;
use crate::scene::direction::unit;
use crate::scene::locate::PathStep;
use crate::scene::notation::format_number;

/// Largest scale factor; the smallest is its reciprocal.
pub const MAX_FACTOR: f64 = 1e6;

/// Why a scene is invalid, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// Path from the scene to the invalid value.
    pub path: Vec<PathStep>,
    /// What is wrong, as a sentence without its full stop.
    pub sentence: String,
}

/// The result of a check.
pub type Check = Result<(), Problem>;

/// A position in the scene, with checks for common kinds of values. The path to it is only built when a check
/// fails.
pub struct At<'a> {
    parent: Option<&'a Self>,
    /// The step from the parent to here; `None` at the root.
    step: Option<PathStep>,
}

impl<'a> At<'a> {
    /// The scene itself.
    pub fn root() -> Self {
        Self {
            parent: None,
            step: None,
        }
    }

    fn child(&'a self, step: PathStep) -> Self {
        Self {
            parent: Some(self),
            step: Some(step),
        }
    }

    /// A field of this value.
    pub fn field(&'a self, name: &'static str) -> Self {
        self.child(PathStep::Field(name))
    }

    /// An item of this list, counted from 0.
    pub fn index(&'a self, index: usize) -> Self {
        self.child(PathStep::Index(index))
    }

    /// The value of a key of this map.
    pub fn key(&'a self, key: &str) -> Self {
        self.child(PathStep::Key(key.to_owned()))
    }

    fn name(&self) -> String {
        match &self.step {
            None => "the scene".to_owned(),
            Some(PathStep::Field(name)) => (*name).to_owned(),
            Some(PathStep::Index(index)) => format!("item {}", index + 1),
            Some(PathStep::Key(key)) => format!("{key:?}"),
        }
    }

    fn path(&self) -> Vec<PathStep> {
        let mut path = self.parent.map_or(Vec::new(), At::path);
        path.extend(self.step.clone());
        path
    }

    /// Returns a [`Problem`] at this position. The sentence has no full stop.
    pub fn refuse(&self, sentence: String) -> Check {
        Err(Problem {
            path: self.path(),
            sentence,
        })
    }

    /// Checks that numbers are finite.
    pub fn finite(&self, values: &[f64]) -> Check {
        match values.iter().find(|value| !value.is_finite()) {
            Some(value) => self.refuse(format!("{} must be finite, found {value}", self.name())),
            None => Ok(()),
        }
    }

    /// Checks that a number is within a range.
    pub fn within(&self, value: f64, range: RangeInclusive<f64>) -> Check {
        self.finite(&[value])?;
        if range.contains(&value) {
            return Ok(());
        }
        let (least, most) = range.into_inner();
        self.refuse(format!(
            "{} must be between {} and {}, found {}",
            self.name(),
            format_number(least),
            format_number(most),
            format_number(value)
        ))
    }

    /// Checks a length: positive and at most [`MAX_COORDINATE`].
    pub fn positive(&self, value: f64) -> Check {
        self.finite(&[value])?;
        if value > 0.0 && value <= MAX_COORDINATE {
            return Ok(());
        }
        let bound = if value > 0.0 {
            "at most 1e12"
        } else {
            "greater than 0"
        };
        self.refuse(format!(
            "{} must be {bound}, found {}",
            self.name(),
            format_number(value)
        ))
    }

    /// Checks a position in world units.
    pub fn point(&self, value: DVec3) -> Check {
        self.bounded(value, "must lie within 1e12 of the origin")
    }

    /// Checks rotation angles in degrees about three axes.
    pub fn angles(&self, value: DVec3) -> Check {
        self.bounded(value, "must have angles of at most 1e12 degrees")
    }

    fn bounded(&self, value: DVec3, words: &str) -> Check {
        self.each_component(value, |part| part.abs() <= MAX_COORDINATE, words)
    }

    /// Checks scale factors: no component may be close to zero.
    pub fn factors(&self, value: DVec3) -> Check {
        let is_factor = |factor: f64| (1.0 / MAX_FACTOR..=MAX_FACTOR).contains(&factor.abs());
        let words = "must have factors between 1e-6 and 1e6, or -1e6 and -1e-6";
        self.each_component(value, is_factor, words)
    }

    /// Checks that each component is finite and satisfies `is_valid`.
    fn each_component(&self, value: DVec3, is_valid: impl Fn(f64) -> bool, words: &str) -> Check {
        self.finite(&value.to_array())?;
        let mut parts = value.to_array().into_iter();
        match parts.find(|part| !is_valid(*part)) {
            None => Ok(()),
            Some(part) => {
                let found = format_number(part);
                self.refuse(format!("{} {words}, found {found}", self.name()))
            }
        }
    }

    /// Checks a direction: it must not be zero, and its components are limited like coordinates.
    pub fn direction(&self, value: DVec3) -> Check {
        self.bounded(value, "must have components of at most 1e12")?;
        match unit(value) {
            Some(_) => Ok(()),
            None => self.refuse(format!(
                "{} must have a direction, found (0, 0, 0)",
                self.name()
            )),
        }
    }

    /// Checks a colour, 0–255 per channel.
    pub fn color(&self, value: DVec3) -> Check {
        let is_channel = |channel: f64| (0.0..=255.0).contains(&channel);
        self.each_component(value, is_channel, "must have channels between 0 and 255")
    }
}

/// Largest number of names that a sentence lists.
const MAX_NAMES: usize = 8;

/// Returns the message that nothing of a kind has this name, with the names that exist.
pub fn no_such<'a>(kind: &str, name: &str, known: impl Iterator<Item = &'a str>) -> String {
    let mut known = known.map(|name| format!("{name:?}"));
    let first: Vec<String> = known.by_ref().take(MAX_NAMES).collect();
    if first.is_empty() {
        return format!("there is no {kind} named {name:?}: the scene has none");
    }
    let ellipsis = if known.next().is_some() { ", …" } else { "" };
    let first = first.join(", ");
    format!("there is no {kind} named {name:?}; there are {first}{ellipsis}")
}
