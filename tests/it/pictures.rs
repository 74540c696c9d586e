//! Rendering pictures, and comparing them.

use glint::image::{Image, render};
use glint::plan::RenderRequest;
use glint::scene::Scene;
use glint::trace::{Rays, RenderControl};

/// Renders a scene; returns the picture and the rays traced for it.
pub fn picture(scene: &Scene, request: &RenderRequest) -> (Image, Rays) {
    let (image, cost) = render(scene, request, &RenderControl::default()).expect("not stopped");
    (image, cost.rays)
}

/// The number of pixels that differ by more than `levels` of 255 in some channel.
pub fn differing(one: &Image, other: &Image, levels: u8) -> usize {
    assert_eq!(one.pixels.len(), other.pixels.len());
    let is_off = |(a, b): &(&[u8; 4], &[u8; 4])| (0..4).any(|c| a[c].abs_diff(b[c]) > levels);
    one.pixels.iter().zip(&other.pixels).filter(is_off).count()
}
