//! The picture: 8-bit pixels, and what light becomes in them.

use crate::simd::Real;
use crate::trace::{Pass, Pixel, Rays, RenderControl, Tracer};

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

    /// Makes room for another size. What the pixels show afterwards means nothing; memory that is
    /// there is kept, which saves the system handing out every page anew.
    pub fn resize(&mut self, width: usize, height: usize) {
        (self.width, self.height) = (width, height);
        self.pixels.resize(width * height, [0; 4]);
    }

    /// Traces the pixels of `pass`; `None` if `control` said stop.
    pub fn trace(&mut self, tracer: &Tracer, pass: Pass, control: &RenderControl) -> Option<Rays> {
        tracer.pass(&mut self.pixels, pass, control)
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
