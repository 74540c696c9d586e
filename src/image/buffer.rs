//! Pixel buffers, of 8 bits or of linear light, and the conversion to 8 bits.

use image::RgbaImage;

use crate::simd::Real;
use crate::trace::{Pass, Pixel, Rays, RenderControl, Tracer};

/// An 8-bit picture: RGBA. Alpha is 255 where the pixel was traced; it has no other meaning.
pub type Image = Raster<[u8; 4]>;

/// A picture of linear light.
pub type LinearImage = Raster<LinearRgb>;

/// Linear red, green and blue, 0–1, before the conversion to 8 bits.
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
    /// A picture of which nothing is traced yet. The system provides zeroed pages of memory as they are first
    /// touched, so the tracing threads bear that cost and not the caller.
    pub fn new(width: usize, height: usize) -> Self {
        Self {
            width,
            height,
            pixels: vec![P::default(); width * height],
        }
    }

    /// Changes the size. The pixels are unspecified afterwards; the memory is kept, so that the system need not
    /// provide every page anew.
    pub fn resize(&mut self, width: usize, height: usize) {
        (self.width, self.height) = (width, height);
        self.pixels.resize(width * height, P::default());
    }

    /// The thinned picture that a pass with this step has filled: every `step`-th pixel of every `step`-th row.
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

// Not generic over the pixel, so that the tracer's kernels are compiled once here and not by every caller.
impl Image {
    /// Traces the pixels of `pass`; `None` if `control` was stopped.
    pub fn trace(&mut self, tracer: &Tracer, pass: Pass, control: &RenderControl) -> Option<Rays> {
        tracer.pass(&mut self.pixels, pass, control)
    }

    /// The linear light that the levels stand for, 0–1.
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
    /// The picture in 8 bits.
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
        // One integer, so that the compiler can vectorize over pixels.
        (level(red) | level(green) << 8 | level(blue) << 16 | 0xFF << 24).to_le_bytes()
    }
}

/// Converts linear 0–1 to 0–255, rounded to nearest; the model has no gamma. NaN becomes 0.
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
