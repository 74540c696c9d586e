//! Histograms of pictures.

use super::buffer::Image;

/// Counts of the levels of each channel, and the share of clipped pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Histogram {
    /// Number of pixels by level, for red, green and blue.
    pub counts: [[u32; 256]; 3],
    /// Share of the traced pixels with a channel at its maximum, 0–1. Pixels of exactly the background colour do not
    /// count as clipped.
    pub clipped: f64,
}

impl Histogram {
    /// Counts the traced pixels of a picture; `background` is the colour of pixels that show nothing.
    pub fn of(image: &Image, background: [u8; 3]) -> Self {
        let mut counts = [[0; 256]; 3];
        let (mut clipped, mut traced) = (0_u64, 0_u64);
        for &[red, green, blue, alpha] in &image.pixels {
            if alpha == 0 {
                continue;
            }
            traced += 1;
            let channels = [red, green, blue];
            for (counts, level) in counts.iter_mut().zip(channels) {
                counts[usize::from(level)] += 1;
            }
            clipped += u64::from(channels.contains(&u8::MAX) && channels != background);
        }
        Self {
            counts,
            clipped: clipped as f64 / traced.max(1) as f64,
        }
    }

    /// The largest count of any level but the darkest and the brightest.
    pub fn highest(&self) -> u32 {
        let inner = self.counts.iter().flat_map(|counts| &counts[1..255]);
        inner.copied().max().unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_counted_and_the_background_clips_nothing() {
        let image = Image {
            width: 5,
            height: 1,
            pixels: vec![
                [255, 255, 255, 255],
                [255, 0, 7, 255],
                [9, 0, 7, 255],
                [9, 0, 8, 255],
                [1, 2, 3, 0],
            ],
        };
        let histogram = Histogram::of(&image, [255; 3]);
        assert_eq!(histogram.counts[0][255], 2);
        assert_eq!((histogram.counts[2][7], histogram.counts[0][1]), (2, 0));
        assert_eq!((histogram.clipped, histogram.highest()), (0.25, 2));
        assert_eq!(Histogram::of(&image, [0; 3]).clipped, 0.5);
    }
}
