//! The picture: 8-bit pixels, and what light becomes in them.

use image::RgbaImage;

use crate::simd::Real;
use crate::trace::{Pass, Pixel, Rays, RenderControl, Tracer};

/// An 8-bit picture: RGBA. Alpha is 255 where it was traced and says nothing else.
pub type Image = Raster<[u8; 4]>;

/// A picture of the light itself.
pub type LinearImage = Raster<LinearRgb>;

/// Linear red, green and blue, 0–1, before they become 8 bits.
pub type LinearRgb = [f32; 3];

/// A picture, row by row from the top.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Raster<P> {
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// `width × height` pixels.
    pub pixels: Vec<P>,
}

impl<P: Copy + Default> Raster<P> {
    /// A picture of which nothing is traced yet. The system hands out zeroed memory page by page as
    /// it is first touched, so that this costs the tracing threads and not the caller.
    pub fn new(width: usize, height: usize) -> Self {
        Self {
            width,
            height,
            pixels: vec![P::default(); width * height],
        }
    }

    /// Makes room for another size. What the pixels show afterwards means nothing; memory that is
    /// there is kept, which saves the system handing out every page anew.
    pub fn resize(&mut self, width: usize, height: usize) {
        (self.width, self.height) = (width, height);
        self.pixels.resize(width * height, P::default());
    }

    /// The picture that a pass with this step has filled: every `step`-th pixel of every
    /// `step`-th row.
    #[must_use]
    pub fn decimated(&self, step: usize) -> Self {
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

// Not for any pixel: the tracer's kernels are compiled here, once, and not by everyone who calls them.
impl Image {
    /// Traces the pixels of `pass`; `None` if `control` said stop.
    pub fn trace(&mut self, tracer: &Tracer, pass: Pass, control: &RenderControl) -> Option<Rays> {
        tracer.pass(&mut self.pixels, pass, control)
    }

    /// The light that the levels stand for, 0–1.
    pub fn to_linear(&self) -> LinearImage {
        let pixels = self.pixels.iter();
        let share = |level: u8| f32::from(level) / 255.0;
        LinearImage {
            width: self.width,
            height: self.height,
            pixels: pixels.map(|&[r, g, b, _]| [r, g, b].map(share)).collect(),
        }
    }
}

impl From<&RgbaImage> for Image {
    fn from(decoded: &RgbaImage) -> Self {
        Self {
            width: decoded.width() as usize,
            height: decoded.height() as usize,
            pixels: decoded.pixels().map(|pixel| pixel.0).collect(),
        }
    }
}

impl LinearImage {
    /// The same in 8 bits.
    pub fn to_levels(&self) -> Image {
        let pixels = self.pixels.iter();
        Image {
            width: self.width,
            height: self.height,
            pixels: pixels.map(|&[r, g, b]| Pixel::of(r, g, b)).collect(),
        }
    }
}

impl Pixel for LinearRgb {
    fn of<R: Real>(red: R, green: R, blue: R) -> Self {
        [red, green, blue].map(|channel| channel.to_f64() as f32)
    }
}

impl Pixel for [u8; 4] {
    #[inline(always)]
    fn of<R: Real>(red: R, green: R, blue: R) -> Self {
        // One number, so that the compiler can do many pixels in step.
        (level(red) | level(green) << 8 | level(blue) << 16 | 0xFF << 24).to_le_bytes()
    }
}

/// Linear 0–1 to 0–255, rounded to nearest; there is no gamma in the model. NaN is 0.
#[inline(always)]
fn level<R: Real>(channel: R) -> u32 {
    (channel.max(R::ZERO).min(R::ONE) * R::from_f64(255.0)).nearest()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_rounded_to_nearest() {
        assert_eq!(<[u8; 4]>::of(0.0, 0.5, 1.0), [0, 128, 255, 255]);
        assert_eq!(<[u8; 4]>::of(-1.0, 2.0, 1.49 / 255.0), [0, 255, 1, 255]);
        assert_eq!(
            <[u8; 4]>::of(1.51 / 255.0, f64::NAN, 254.49 / 255.0),
            [2, 0, 254, 255]
        );
    }

    #[test]
    fn thinning_takes_the_coarse_grid() {
        let mut image = Image::new(5, 3);
        for (index, pixel) in image.pixels.iter_mut().enumerate() {
            pixel[0] = u8::try_from(index).expect("small");
        }
        let thin = image.decimated(2);
        assert_eq!((thin.width, thin.height), (3, 2));
        let reds: Vec<u8> = thin.pixels.iter().map(|pixel| pixel[0]).collect();
        assert_eq!(reds, [0, 2, 4, 10, 12, 14]);
    }
}
