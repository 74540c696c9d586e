//! Where things are in the picture: rectangles of pixels, never too small.

use glam::{DMat3, DVec3};

use super::{RenderRequest, Sampling};
use crate::scene::{Projection, Scene, Shape};

/// A range of pixels in one direction, ends included; may lie outside the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// First pixel.
    pub from: f32,
    /// Last pixel.
    pub to: f32,
}

/// The rectangles of a plan's spheres and triangles, by their places in its lists.
#[derive(Clone, Debug)]
pub struct ScreenExtents {
    /// Columns and rows of each sphere.
    pub spheres: Vec<(Extent, Extent)>,
    /// Columns and rows of each triangle.
    pub triangles: Vec<(Extent, Extent)>,
}

/// Pixels added on every side for the rounding of the kernel.
const MARGIN: f64 = 1.0;
/// The same where rays also look beside themselves: a pixel, as wide as in the middle of the
/// picture, where the picture's rays are closest to each other.
const SMOOTH_MARGIN: f64 = 4.0;
/// What may be anywhere.
const ANYWHERE: Extent = Extent {
    from: f32::NEG_INFINITY,
    to: f32::INFINITY,
};

impl Extent {
    /// Whether the pixels `from..to` and this range have one in common.
    pub fn meets(self, from: usize, to: usize) -> bool {
        self.from < to as f32 && self.to >= from as f32
    }
}

/// The camera in double precision.
struct Projector {
    position: DVec3,
    basis: DMat3,
    projection: Projection,
    /// Pixels per unit of (distance across / depth), or per world unit.
    scale: f64,
    half: (f64, f64),
    margin: f64,
}

impl ScreenExtents {
    /// The rectangles of what `Plan::new` packs, in the same order.
    pub fn new(scene: &Scene, request: &RenderRequest) -> Self {
        let mut screen = Self {
            spheres: Vec::new(),
            triangles: Vec::new(),
        };
        let Some(projector) = Projector::new(scene, request) else {
            return screen;
        };
        for object in scene.objects.iter().filter(|object| object.visible) {
            match object.shape {
                Shape::Sphere { center, radius } => {
                    screen.spheres.push(projector.sphere(center, radius));
                }
                Shape::Triangle { a, b, c } => {
                    screen.triangles.push(projector.triangle([a, b, c]));
                }
                Shape::Plane { .. } => {}
            }
        }
        if scene.light_visualization {
            let lights = scene.lights.iter().filter(|light| light.visible);
            let markers = lights.filter_map(|light| Some((light.position, light.marker.as_ref()?)));
            screen
                .spheres
                .extend(markers.map(|(at, marker)| projector.sphere(at, marker.radius)));
        }
        screen
    }
}

impl Projector {
    fn new(scene: &Scene, request: &RenderRequest) -> Option<Self> {
        let camera = &scene.camera;
        let projection = request.projection.unwrap_or(camera.projection);
        let height = f64::from(request.height);
        let scale = match projection {
            Projection::Perspective => camera.projection_distance * height,
            Projection::Orthographic => height / camera.orthographic_height,
        };
        let half = (f64::from(request.width) / 2.0, height / 2.0);
        Some(Self {
            position: camera.position,
            basis: camera.basis()?,
            projection,
            scale,
            half,
            margin: match request.sampling {
                Sampling::Adaptive { .. } => SMOOTH_MARGIN,
                Sampling::Centres | Sampling::Grid(_) => MARGIN,
            },
        })
    }

    /// Right, up and ahead of the camera.
    fn seen(&self, point: DVec3) -> [f64; 3] {
        let seen = self.basis.transpose_mul_vec3(point - self.position);
        [seen.x, seen.y, -seen.z]
    }

    fn sphere(&self, center: DVec3, radius: f64) -> (Extent, Extent) {
        let [x, y, depth] = self.seen(center);
        let range = match self.projection {
            Projection::Orthographic => {
                |at: f64, _: f64, radius: f64| Some((at - radius, at + radius))
            }
            Projection::Perspective => tangents,
        };
        (
            self.columns(range(x, depth, radius)),
            self.rows(range(y, depth, radius)),
        )
    }

    fn triangle(&self, corners: [DVec3; 3]) -> (Extent, Extent) {
        let seen = corners.map(|corner| self.seen(corner));
        let size = seen
            .iter()
            .flatten()
            .fold(0.0, |size: f64, part| size.max(part.abs()));
        let is_ahead = seen.iter().all(|[_, _, depth]| *depth > size * 1e-6);
        let range = |axis: usize| match self.projection {
            Projection::Orthographic => Some(bounds(seen.map(|point| point[axis]))),
            Projection::Perspective if is_ahead => {
                Some(bounds(seen.map(|point| point[axis] / point[2])))
            }
            Projection::Perspective => None,
        };
        (self.columns(range(0)), self.rows(range(1)))
    }

    fn extent(&self, from: f64, to: f64) -> Extent {
        Extent {
            from: (from - self.margin).floor() as f32,
            to: (to + self.margin).ceil() as f32,
        }
    }

    fn columns(&self, range: Option<(f64, f64)>) -> Extent {
        range.map_or(ANYWHERE, |(from, to)| {
            self.extent(
                self.half.0 + from * self.scale,
                self.half.0 + to * self.scale,
            )
        })
    }

    fn rows(&self, range: Option<(f64, f64)>) -> Extent {
        range.map_or(ANYWHERE, |(from, to)| {
            self.extent(
                self.half.1 - to * self.scale,
                self.half.1 - from * self.scale,
            )
        })
    }
}

fn bounds(values: [f64; 3]) -> (f64, f64) {
    let [a, b, c] = values;
    (a.min(b).min(c), a.max(b).max(c))
}

/// The slopes of the two lines from the eye that touch a circle at (`at`, `depth`); `None` where
/// the circle reaches around the eye or behind it.
fn tangents(at: f64, depth: f64, radius: f64) -> Option<(f64, f64)> {
    let distance = at.hypot(depth);
    if distance <= radius * 1.000_001 {
        return None;
    }
    let (middle, half) = (at.atan2(depth), (radius / distance).asin());
    let limit = std::f64::consts::FRAC_PI_2 - 1e-6;
    let is_ahead = middle - half > -limit && middle + half < limit;
    is_ahead.then(|| ((middle - half).tan(), (middle + half).tan()))
}
