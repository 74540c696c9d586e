//! Errors of pictures.

use crate::image::{Image, LinearImage, LinearRgb};
use crate::trace::{Pass, Rays, RenderControl, Tracer};

/// The error that rounding to 8 bits leaves in even the best picture: 1 / (255·√12), as the root mean square over
/// linear colours from 0 to 1.
pub const EIGHT_BIT_FLOOR: f64 = 1.0 / (255.0 * 3.464_101_615_137_754_4);

/// Error of a channel above which it is visible.
const VISIBLE_ERROR: f32 = 4.0 / 255.0;

/// The error of a picture over all channels of all pixels; colours are linear, 0–1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ErrorMetrics {
    /// Root mean square error.
    pub rmse: f64,
    /// Largest error of a channel.
    pub max: f64,
    /// Share of pixels with a channel whose error is above 4/255.
    pub visible: f64,
}

impl ErrorMetrics {
    /// Peak signal-to-noise ratio in decibels: -20·log₁₀(RMSE); infinite for equal pictures.
    pub fn psnr(self) -> f64 {
        decibels(self.rmse)
    }
}

/// An RMSE as peak signal-to-noise ratio in decibels, where white is 1.
pub fn decibels(error: f64) -> f64 {
    -20.0 * error.log10()
}

/// The error of `picture` against `reference`, which has the same size.
pub fn difference(picture: &[LinearRgb], reference: &[LinearRgb]) -> ErrorMetrics {
    let (mut squares, mut max, mut visible) = (0.0, 0.0_f32, 0_usize);
    for (a, b) in picture.iter().zip(reference) {
        let mut worst = 0.0_f32;
        for channel in 0..3 {
            let error = (a[channel] - b[channel]).abs();
            squares += f64::from(error) * f64::from(error);
            worst = worst.max(error);
        }
        max = max.max(worst);
        visible += usize::from(worst > VISIBLE_ERROR);
    }
    let pixels = reference.len().max(1) as f64;
    ErrorMetrics {
        rmse: (squares / (3.0 * pixels)).sqrt(),
        max: f64::from(max),
        visible: visible as f64 / pixels,
    }
}

/// The quantile of numbers in ascending order, such as 0.5 for the median; `None` if there are none. Interpolated
/// linearly between neighbours (Hyndman and Fan, "Sample quantiles in statistical packages", The American Statistician
/// 50(4), 1996, definition 7).
pub fn quantile(ascending: &[f64], share: f64) -> Option<f64> {
    let rank = ascending.len().checked_sub(1)? as f64 * share;
    let [below, above] = [rank.floor(), rank.ceil()].map(|rank| ascending[rank as usize]);
    Some(below + (above - below) * rank.fract())
}

/// The mean of two independent pictures of the same size, and its standard error.
pub fn mean_of_two(first: &[LinearRgb], second: &[LinearRgb]) -> (Vec<LinearRgb>, f64) {
    let pixels = first.iter().zip(second);
    let mean = pixels
        .map(|(a, b)| std::array::from_fn(|channel| 0.5 * (a[channel] + b[channel])))
        .collect();
    (mean, difference(first, second).rmse / 2.0)
}

/// Traces a picture as linear light on the current rayon pool; `None` if `control` stopped it.
pub fn trace_light(tracer: &Tracer, control: &RenderControl) -> Option<(Vec<LinearRgb>, Rays)> {
    let mut pixels = vec![[0.0; 3]; tracer.width() * tracer.height()];
    let rays = tracer.pass(&mut pixels, Pass::Whole, control)?;
    Some((pixels, rays))
}

/// Scales a picture by bilinear interpolation between the centres of its pixels.
pub fn scaled(
    from: &[LinearRgb],
    (width, height): (usize, usize),
    to: (usize, usize),
) -> Vec<LinearRgb> {
    if (width, height) == to {
        return from.to_vec();
    }
    let neighbours = |at: usize, count: usize, of: usize| {
        let at = (at as f32 + 0.5) * of as f32 / count as f32 - 0.5;
        let at = at.clamp(0.0, (of - 1) as f32);
        let first = at.floor() as usize;
        (first, (first + 1).min(of - 1), at.fract())
    };
    let mix = |a: LinearRgb, b: LinearRgb, share: f32| {
        let mut mixed = a;
        for (mixed, b) in mixed.iter_mut().zip(b) {
            *mixed += (b - *mixed) * share;
        }
        mixed
    };
    let mut pixels = Vec::with_capacity(to.0 * to.1);
    for row in 0..to.1 {
        let (top, bottom, down) = neighbours(row, to.1, height);
        for column in 0..to.0 {
            let (left, right, across) = neighbours(column, to.0, width);
            let at = |x: usize, y: usize| from[y * width + x];
            let upper = mix(at(left, top), at(right, top), across);
            let lower = mix(at(left, bottom), at(right, bottom), across);
            pixels.push(mix(upper, lower, down));
        }
    }
    pixels
}

/// Linear light as an 8-bit picture.
pub fn eight_bits(light: Vec<LinearRgb>, (width, height): (usize, usize)) -> Image {
    let light = LinearImage {
        width,
        height,
        pixels: light,
    };
    light.to_levels()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_is_what_it_says() {
        let reference = vec![[0.5; 3]; 4];
        let mut picture = reference.clone();
        assert_eq!(difference(&picture, &reference), ErrorMetrics::default());
        assert_eq!(difference(&picture, &reference).psnr(), f64::INFINITY);
        picture[1][2] = 0.75;
        let off = difference(&picture, &reference);
        assert!((off.rmse - (0.0625_f64 / 12.0).sqrt()).abs() < 1e-9);
        assert_eq!((off.max, off.visible), (0.25, 0.25));
    }

    #[test]
    fn rounding_to_eight_bits_costs_the_floor() {
        let light: Vec<LinearRgb> = (0..100_000)
            .map(|n| [0.0, 1.0, 2.0].map(|c| ((n as f32) * 0.618_034 + c * 0.37).fract()))
            .collect();
        let image = eight_bits(light.clone(), (1000, 100));
        let back = image.to_linear().pixels;
        let off = difference(&back, &light).rmse;
        assert!((off / EIGHT_BIT_FLOOR - 1.0).abs() < 0.01, "{off}");
    }

    #[test]
    fn a_slope_stays_one_when_it_is_scaled() {
        let from: Vec<LinearRgb> = (0..8 * 4).map(|n| [(n % 8) as f32, 1.0, 0.0]).collect();
        let to = scaled(&from, (8, 4), (16, 8));
        assert_eq!(to.len(), 128);
        for (n, pixel) in to.iter().enumerate() {
            let expected = ((n % 16) as f32 / 2.0 - 0.25).clamp(0.0, 7.0);
            assert!((pixel[0] - expected).abs() < 1e-5 && pixel[1] == 1.0);
        }
        assert_eq!(scaled(&from, (8, 4), (8, 4)), from);
    }
}
