//! Preset flights around or along the selection.

use std::f64::consts::TAU;

use glam::DVec3;

use crate::scene::{Camera, Interpolation, Key, Orientation};

/// Number of segments of a closed path of splines. A centripetal spline through this many points of a circle
/// deviates from it by 1/9000 of its radius.
const LOOP_SEGMENTS: usize = 24;
/// Ratio of width to depth of the ellipse; the figure eight is half as wide.
const ELLIPSE_RATIO: f64 = 1.6;
/// Length of dolly and crane moves, as a share of the distance to the target.
const TRAVEL_SHARE: f64 = 0.5;

/// A flight that starts from the current camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Preset {
    /// Once around the target on an exact circle, always looking at it.
    Turntable,
    /// Straight towards the target.
    Dolly,
    /// Straight up, looking at the target.
    Crane,
    /// Around the target on an ellipse.
    Ellipse,
    /// A figure eight in front of the target, looking at it.
    FigureEight,
}

impl Preset {
    /// All presets.
    pub const ALL: [Self; 5] = [
        Self::Turntable,
        Self::Dolly,
        Self::Crane,
        Self::Ellipse,
        Self::FigureEight,
    ];

    /// Name and description.
    pub fn words(self) -> (&'static str, &'static str) {
        match self {
            Self::Turntable => (
                "Turntable",
                "Once around the selection on an exact circle, always looking at it",
            ),
            Self::Dolly => ("Dolly", "Straight towards the selection, half the distance"),
            Self::Crane => ("Crane", "Straight up, looking at the selection"),
            Self::Ellipse => ("Ellipse", "Around the selection on an ellipse"),
            Self::FigureEight => ("Figure eight", "A figure eight in front of the selection"),
        }
    }

    /// Returns the keys of a flight that starts from `camera`, goes around or towards `target` and takes `seconds`.
    /// If the path has no extent, all keys have the same position: for an ellipse seen from straight above or
    /// below, and for any preset that starts at the target itself.
    pub fn keys(self, camera: &Camera, target: DVec3, seconds: f64) -> Vec<Key<Camera>> {
        let arm = camera.position - target;
        let is_upright = arm.x.hypot(arm.z) < arm.length() * 1e-9;
        let heading = heading(camera).filter(|_| is_upright);
        match self {
            Self::Turntable => {
                let position_at = |share: f64| target + turned(arm, share * TAU);
                let mut keys = keys_along(camera, target, 4, seconds, position_at);
                // From straight above or below, the picture rotates.
                for key in &mut keys {
                    key.interpolation = Interpolation::Orbit { around: target };
                    if let Some(heading) = heading {
                        let angle = key.time / seconds % 1.0 * TAU;
                        key.value.look_at = -arm;
                        key.value.up = turned(heading, angle);
                    }
                }
                keys
            }
            Self::Dolly => {
                let remaining = |share: f64| 1.0 - TRAVEL_SHARE * share;
                let position_at = |share| target + arm * remaining(share);
                let mut keys = keys_along(camera, target, 1, seconds, position_at);
                for key in &mut keys {
                    // In orthographic projection, only the height of the window changes the size of things.
                    key.value.orthographic_height *= remaining(key.time / seconds);
                }
                keys
            }
            Self::Crane => {
                let rise = arm.length() * TRAVEL_SHARE;
                keys_along(camera, target, 6, seconds, |share| {
                    camera.position + DVec3::new(0.0, rise * share, 0.0)
                })
            }
            Self::Ellipse => keys_along(camera, target, LOOP_SEGMENTS, seconds, |share| {
                let (sine, cosine) = (share * TAU).sin_cos();
                let sideways = turned(DVec3::new(arm.x, 0.0, arm.z), TAU / 4.0);
                target
                    + DVec3::new(arm.x * cosine, arm.y, arm.z * cosine)
                    + sideways * (ELLIPSE_RATIO * sine)
            }),
            Self::FigureEight => {
                let level = heading.map_or(DVec3::new(arm.x, 0.0, arm.z), |direction| {
                    direction * arm.length()
                });
                let sideways = turned(level, TAU / 4.0);
                let mut keys = keys_along(camera, target, LOOP_SEGMENTS, seconds, |share| {
                    // Lemniscate of Gerono, in front of the target.
                    let (sine, cosine) = (share * TAU).sin_cos();
                    camera.position + sideways * (0.5 * ELLIPSE_RATIO * sine)
                        - arm * (0.25 * sine * cosine)
                });
                // From straight above or below, the direction of the upper edge stays constant.
                if let Some(heading) = heading {
                    for key in &mut keys {
                        key.value.look_at = target - key.value.position;
                        key.value.up = heading;
                    }
                }
                keys
            }
        }
    }
}

/// Returns the horizontal direction of the camera: its viewing direction or, if that is steep, its up vector.
fn heading(camera: &Camera) -> Option<DVec3> {
    let basis = camera.basis()?;
    let [up, ahead] =
        [basis.y_axis, -basis.z_axis].map(|direction| DVec3::new(direction.x, 0.0, direction.z));
    let direction = if up.length() < ahead.length() {
        ahead
    } else {
        up
    };
    direction.try_normalize()
}

/// Rotates a vector about the vertical axis by an angle in radians.
fn turned(v: DVec3, angle: f64) -> DVec3 {
    let (sine, cosine) = angle.sin_cos();
    DVec3::new(v.x * cosine - v.z * sine, v.y, v.x * sine + v.z * cosine)
}

/// Returns keys at equal time steps along a path, looking at the target. If the path returns to its start, the last
/// position is exactly the first.
fn keys_along(
    camera: &Camera,
    target: DVec3,
    segments: usize,
    seconds: f64,
    position_at: impl Fn(f64) -> DVec3,
) -> Vec<Key<Camera>> {
    let extent = (camera.position - target).length();
    let key = |n: usize| {
        let share = n as f64 / segments as f64;
        let mut position = position_at(share);
        if (position - position_at(0.0)).length() <= extent * 1e-9 {
            position = position_at(0.0);
        }
        let facing = Camera {
            look_at: target - position,
            up: DVec3::new(0.0, 1.0, 0.0),
            position,
            ..camera.clone()
        };
        let level = Orientation {
            roll: 0.0,
            ..Orientation::of(&facing)
        };
        // At the target there is no direction to it: the camera keeps its own.
        let value = match facing.basis() {
            Some(_) => level.apply(&facing),
            None => Camera {
                position,
                ..camera.clone()
            },
        };
        Key::new(seconds * share, value)
    };
    (0..=segments).map(key).collect()
}
