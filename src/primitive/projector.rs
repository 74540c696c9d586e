//! Positions in the picture, as pixel rectangles that are never too small.

use std::ops::Range;

use glam::{DMat3, DVec3};

use crate::scene::{Camera, Projection};

/// A range of pixels in one direction, both ends included; may be outside of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// First pixel.
    pub from: f32,
    /// Last pixel.
    pub to: f32,
}

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    /// From left to right.
    pub columns: Extent,
    /// From top to bottom.
    pub rows: Extent,
}

/// Share of a distance, or an angle, up to which something counts as beside the eye: far above rounding, and far below
/// a pixel.
const AT_THE_SIDE: f64 = 1e-6;

/// The range of anything that may be anywhere.
const ANYWHERE: Extent = Extent {
    from: f32::NEG_INFINITY,
    to: f32::INFINITY,
};

impl Extent {
    /// Returns whether the range contains any of these pixels.
    pub fn meets(self, pixels: &Range<usize>) -> bool {
        self.from < pixels.end as f32 && self.to >= pixels.start as f32
    }
}

/// A camera in double precision with the size of its picture.
#[derive(Clone, Debug)]
pub struct Projector {
    position: DVec3,
    basis: DMat3,
    projection: Projection,
    /// Pixels per unit of (lateral distance / depth), or per world unit.
    scale: f64,
    half_size: (f64, f64),
    margin: f64,
}

impl Projector {
    /// Creates the projector of a picture of `width × height` pixels that adds `margin` pixels to every rectangle
    /// on every side; `None` if the camera has no basis.
    pub fn new(camera: &Camera, (width, height): (u32, u32), margin: f64) -> Option<Self> {
        let height = f64::from(height);
        let scale = match camera.projection {
            Projection::Perspective => camera.projection_distance * height,
            Projection::Orthographic => height / camera.orthographic_height,
        };
        Some(Self {
            position: camera.position,
            basis: camera.basis()?,
            projection: camera.projection,
            scale,
            half_size: (f64::from(width) / 2.0, height / 2.0),
            margin,
        })
    }

    /// The position of a point to the right of, above and ahead of the camera.
    fn in_camera(&self, point: DVec3) -> [f64; 3] {
        let in_camera = self.basis.transpose_mul_vec3(point - self.position);
        [in_camera.x, in_camera.y, -in_camera.z]
    }

    /// The rectangle around a ball.
    pub fn ball(&self, center: DVec3, radius: f64) -> Rectangle {
        let [x, y, depth] = self.in_camera(center);
        let range = match self.projection {
            Projection::Orthographic => {
                |at: f64, _: f64, radius: f64| Some((at - radius, at + radius))
            }
            Projection::Perspective => tangents,
        };
        self.rectangle(range(x, depth, radius), range(y, depth, radius))
    }

    /// The rectangle around a triangle.
    pub fn triangle(&self, corners: [DVec3; 3]) -> Rectangle {
        let on_image_plane = self.on_image_plane(corners);
        let range =
            |axis: usize| on_image_plane.map(|corners| bounds(corners.map(|point| point[axis])));
        self.rectangle(range(0), range(1))
    }

    /// The corners of a triangle on the image plane, to the right of and above its middle; `None` if one is not
    /// ahead.
    fn on_image_plane(&self, corners: [DVec3; 3]) -> Option<[[f64; 2]; 3]> {
        let in_camera = corners.map(|corner| self.in_camera(corner));
        let size = in_camera
            .iter()
            .flatten()
            .fold(0.0, |size: f64, part| size.max(part.abs()));
        match self.projection {
            Projection::Orthographic => Some(in_camera.map(|[x, y, _]| [x, y])),
            Projection::Perspective => {
                let is_ahead = in_camera
                    .iter()
                    .all(|[_, _, depth]| *depth > size * AT_THE_SIDE);
                is_ahead.then(|| in_camera.map(|[x, y, depth]| [x / depth, y / depth]))
            }
        }
    }

    /// The rectangle of two ranges on the image plane, to the right of and above its middle; `None` stands for
    /// anywhere.
    fn rectangle(&self, across: Option<(f64, f64)>, up: Option<(f64, f64)>) -> Rectangle {
        let extent = |middle: f64, range: Option<(f64, f64)>| {
            range.map_or(ANYWHERE, |(from, to)| Extent {
                from: (middle + from * self.scale - self.margin).floor() as f32,
                to: (middle + to * self.scale + self.margin).ceil() as f32,
            })
        };
        let down = up.map(|(from, to)| (-to, -from));
        Rectangle {
            columns: extent(self.half_size.0, across),
            rows: extent(self.half_size.1, down),
        }
    }
}

fn bounds(values: [f64; 3]) -> (f64, f64) {
    let [a, b, c] = values;
    (a.min(b).min(c), a.max(b).max(c))
}

/// The slopes of the two tangents from the eye to a circle around (`at`, `depth`); `None` if the circle extends
/// around the eye or behind it.
fn tangents(at: f64, depth: f64, radius: f64) -> Option<(f64, f64)> {
    let distance = at.hypot(depth);
    if distance <= radius * (1.0 + AT_THE_SIDE) {
        return None;
    }
    let (middle, half) = (at.atan2(depth), (radius / distance).asin());
    let limit = std::f64::consts::FRAC_PI_2 - AT_THE_SIDE;
    let is_ahead = middle - half > -limit && middle + half < limit;
    is_ahead.then(|| ((middle - half).tan(), (middle + half).tan()))
}
