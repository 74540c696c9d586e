//! Primary rays, one for each sample position.

use glam::{DMat3, DVec3};

use super::RenderRequest;
use crate::scene::{Camera, Projection, Sampling};
use crate::simd::{Real, SimdFloat, Vec3};

/// Shift of the sample positions of adaptive sampling, right and down, in pixels. Without it, in a floor plan whose
/// walls run along pixel sides, every sample would lie on an edge, where rounding decides what it sees. The shift
/// changes a picture by an eighth of a level at most. It runs along no slope that people draw, and it has few bits,
/// so that adding it to a position is exact.
const SAMPLE_SHIFT: (f64, f64) = (4.0 / 8192.0, 3.0 / 8192.0);

/// The camera prepared for tracing: turns pixel positions into rays with unit directions.
#[derive(Clone, Copy, Debug)]
pub struct View<R> {
    /// The eye, or the centre of the view window.
    origin: Vec3<R>,
    /// The right vector, one image height (perspective) or view height (orthographic) long.
    u: Vec3<R>,
    /// The up vector, of the same length.
    v: Vec3<R>,
    /// From the eye to the middle of the image plane, in image heights (perspective); the common unit direction
    /// (orthographic).
    forward: Vec3<R>,
    projection: Projection,
    /// Half the width and height in pixels, less [`SAMPLE_SHIFT`].
    half: (R, R),
    /// Image heights per pixel.
    pixel: R,
    /// See [`Self::footprint`].
    footprint: (R, R),
}

impl<R: Real> View<R> {
    /// Prepares `camera`, with coordinates relative to `centre`.
    pub fn new(camera: &Camera, request: &RenderRequest, centre: DVec3) -> Self {
        let basis = camera.basis().unwrap_or(DMat3::IDENTITY);
        let (u, v, w) = (basis.x_axis, basis.y_axis, basis.z_axis);
        let projection = request.projection_of(camera);
        let (scale, forward) = match projection {
            Projection::Perspective => (1.0, -w * camera.projection_distance),
            Projection::Orthographic => (camera.orthographic_height, -w),
        };
        let (width, height) = (f64::from(request.width), f64::from(request.height));
        let shift = match request.sampling {
            Sampling::Adaptive { .. } => SAMPLE_SHIFT,
            _ => (0.0, 0.0),
        };
        let half = (width / 2.0 - shift.0, height / 2.0 - shift.1);
        let pixel = R::from_f64(1.0 / height);
        let (right, ahead) = (Vec3::from_dvec3(u * scale), Vec3::from_dvec3(forward));
        Self {
            origin: Vec3::from_dvec3(camera.position - centre),
            u: right,
            v: Vec3::from_dvec3(v * scale),
            forward: ahead,
            projection,
            half: (R::from_f64(half.0), R::from_f64(half.1)),
            pixel,
            footprint: match projection {
                Projection::Orthographic => (right.length() * pixel, R::ZERO),
                Projection::Perspective => (R::ZERO, pixel / ahead.length()),
            },
        }
    }

    /// An upper bound of the coordinates of ray origins.
    pub fn farthest_start(&self) -> R {
        let (half_width, half_height) = self.half;
        self.origin.max_abs() + self.footprint.0 * (half_width + half_height)
    }

    /// Upper bounds of the width of a pixel at the eye, and of its increase per unit of distance.
    pub fn footprint(&self) -> (R, R) {
        self.footprint
    }

    /// The increase of a pixel's width per unit of distance; for parallel rays, that of a perspective picture as
    /// high as its distance.
    pub fn spread(&self) -> R {
        match self.projection {
            Projection::Orthographic => self.pixel,
            Projection::Perspective => self.footprint.1,
        }
    }

    /// An upper bound of a pixel's width within `reach` of a point.
    pub fn width_at(&self, point: Vec3<R>, reach: R) -> R {
        let (width, spread) = self.footprint;
        width + spread * ((point - self.origin).length() + reach)
    }

    /// Origins and unit directions of the rays through the positions (x, y) in the picture, in pixels from its left
    /// and upper edge. The centre of the first pixel is (½, ½).
    #[inline(always)]
    pub fn rays<L: SimdFloat<Real = R>>(&self, x: L, y: L) -> (Vec3<L>, Vec3<L>) {
        let (half_width, half_height) = self.half;
        let pixel = x.like(self.pixel);
        let across = (x - x.like(half_width)) * pixel;
        let upwards = (x.like(half_height) - y) * pixel;
        let right = Vec3::broadcast(x.token(), self.u) * across;
        let offset = right + right.like(self.v) * upwards;
        let origin = right.like(self.origin);
        let forward = right.like(self.forward);
        match self.projection {
            Projection::Orthographic => (origin + offset, forward),
            Projection::Perspective => {
                let direction = forward + offset;
                (origin, direction * (x.like(R::ONE) / direction.length()))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rays(request: &RenderRequest, camera: &Camera, x: f64, y: f64) -> (DVec3, DVec3) {
        let (origin, direction) = View::<f64>::new(camera, request, DVec3::ZERO).rays(x, y);
        (origin.to_dvec3(), direction.to_dvec3())
    }

    #[test]
    fn both_projections_look_along_the_camera_in_the_middle() {
        let camera = Camera::default();
        for projection in [Projection::Perspective, Projection::Orthographic] {
            let request = RenderRequest {
                projection: Some(projection),
                ..RenderRequest::sized(101, 51)
            };
            let (origin, direction) = rays(&request, &camera, 50.5, 25.5);
            let w = camera.basis().expect("valid").z_axis;
            assert!((origin - camera.position).length() < 1e-12);
            assert!((direction + w).length() < 1e-12);
        }
    }

    #[test]
    fn the_top_of_the_picture_is_half_a_field_of_view_up() {
        let camera = Camera::default();
        let basis = camera.basis().expect("valid");
        let (_, direction) = rays(&RenderRequest::sized(64, 64), &camera, 32.0, 0.0);
        let angle = direction.dot(basis.y_axis).asin();
        assert!((angle - camera.field_of_view_radians() / 2.0).abs() < 1e-12);
    }

    #[test]
    fn pictures_of_any_size_frame_the_same() {
        let camera = Camera {
            projection: Projection::Orthographic,
            ..Camera::default()
        };
        let small = rays(&RenderRequest::sized(20, 10), &camera, 5.0, 2.5);
        let large = rays(&RenderRequest::sized(2000, 1000), &camera, 500.0, 250.0);
        assert!((small.0 - large.0).length() < 1e-12);
    }
}
