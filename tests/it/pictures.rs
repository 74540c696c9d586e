//! Pictures, and how far they differ.

use glint::image::{Image, render};
use glint::plan::RenderRequest;
use glint::scene::Scene;
use glint::trace::{Rays, RenderControl};

/// The picture of a scene, and the rays that it took.
pub fn picture(scene: &Scene, request: &RenderRequest) -> (Image, Rays) {
    let (image, cost) = render(scene, request, &RenderControl::default()).expect("not stopped");
    (image, cost.rays)
}

/// How many pixels differ by more than so many levels of 255 in some channel.
pub fn differing(one: &Image, other: &Image, levels: u8) -> usize {
    assert_eq!(one.pixels.len(), other.pixels.len());
    let is_off = |(a, b): &(&[u8; 4], &[u8; 4])| (0..4).any(|c| a[c].abs_diff(b[c]) > levels);
    one.pixels.iter().zip(&other.pixels).filter(is_off).count()
}
