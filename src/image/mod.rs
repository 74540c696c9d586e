//! What happens to a pixel once its light is known: the buffer, 8-bit conversion, file formats.

mod encode;

use std::time::{Duration, Instant};

pub use encode::{Format, FormatError};

use crate::plan::Picture;
use crate::scene::Scene;
use crate::trace::{Grid, Rays, Tracer, Watch};

/// An 8-bit picture: RGBA, row by row from the top. Alpha is 255 where it was traced and says
/// nothing else.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Image {
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// `width × height` pixels.
    pub pixels: Vec<[u8; 4]>,
}

/// What a picture cost.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cost {
    /// Wall time, planning included.
    pub time: Duration,
    /// Rays traced.
    pub rays: Rays,
    /// The kernel's real type and width, see [`Tracer::lanes`].
    pub lanes: String,
}

impl Image {
    /// A picture of which nothing is traced yet. The system hands out zeroed memory page by page as
    /// it is first touched, so that this costs the tracing threads and not the caller.
    pub fn new(width: usize, height: usize) -> Self {
        Self {
            width,
            height,
            pixels: vec![[0; 4]; width * height],
        }
    }

    /// Traces the pixels of `grid`; `None` if `watch` said stop.
    pub fn trace(&mut self, tracer: &Tracer, grid: Grid, watch: &Watch) -> Option<Rays> {
        tracer.pass(&mut self.pixels, grid, watch, quantize)
    }

    /// The picture that a pass with this step has filled: every `step`-th pixel of every
    /// `step`-th row.
    #[must_use]
    pub fn thinned(&self, step: usize) -> Self {
        let rows = self.pixels.chunks(self.width.max(1)).step_by(step);
        let pixels = rows
            .flat_map(|row| row.iter().copied().step_by(step))
            .collect();
        Self {
            width: self.width.div_ceil(step),
            height: self.height.div_ceil(step),
            pixels,
        }
    }
}

/// Traces a whole picture on the current rayon pool: the one way from a scene to pixels.
/// `None` if `watch` said stop.
pub fn render(scene: &Scene, picture: &Picture, watch: &Watch) -> Option<(Image, Cost)> {
    let start = Instant::now();
    let tracer = Tracer::new(scene, picture);
    let mut image = Image::new(tracer.width(), tracer.height());
    let rays = image.trace(&tracer, Grid::ALL, watch)?;
    Some((
        image,
        Cost {
            time: start.elapsed(),
            rays,
            lanes: tracer.lanes(),
        },
    ))
}

/// Linear 0–1 to 0–255, rounded to nearest; there is no gamma in the model.
fn quantize(color: [f64; 3]) -> [u8; 4] {
    // The cast takes the whole part, NaN as 0, and what is beyond 0–255 as 0 or 255.
    let [r, g, b] = color.map(|channel| (channel * 255.0 + 0.5) as u8);
    [r, g, b, 255]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_rounded_to_nearest() {
        assert_eq!(quantize([0.0, 0.5, 1.0]), [0, 128, 255, 255]);
        assert_eq!(quantize([-1.0, 2.0, 1.49 / 255.0]), [0, 255, 1, 255]);
        assert_eq!(
            quantize([1.51 / 255.0, f64::NAN, 254.49 / 255.0]),
            [2, 0, 254, 255]
        );
    }

    #[test]
    fn thinning_takes_the_coarse_grid() {
        let mut image = Image::new(5, 3);
        for (index, pixel) in image.pixels.iter_mut().enumerate() {
            pixel[0] = u8::try_from(index).expect("small");
        }
        let thin = image.thinned(2);
        assert_eq!((thin.width, thin.height), (3, 2));
        let reds: Vec<u8> = thin.pixels.iter().map(|pixel| pixel[0]).collect();
        assert_eq!(reds, [0, 2, 4, 10, 12, 14]);
    }
}
