//! Clean edges: against many samples per pixel, in double precision, on the published views.

use glint::image::Image;
use glint::lanes::{Real, Vec3};
use glint::plan::{Picture, Precision, Sampling};
use glint::scene::{Object, Projection, Scene, Shape};
use glint::trace::{Pass, Pixel, Rays, Tracer, Watch};

/// A linear colour, before it is rounded to 8 bits.
#[derive(Clone, Copy, Default)]
struct Linear([f64; 3]);

impl Pixel for Linear {
    fn of<R: Real>(red: R, green: R, blue: R) -> Self {
        Self([red.to_f64(), green.to_f64(), blue.to_f64()])
    }
}

const SIDE: u32 = 128;

fn linear(scene: &Scene, picture: &Picture) -> (Vec<Linear>, Rays) {
    let tracer = Tracer::new(scene, picture);
    let mut pixels = vec![Linear::default(); tracer.width() * tracer.height()];
    let rays = tracer.pass(&mut pixels, Pass::Whole, &Watch::default());
    (pixels, rays.expect("not stopped"))
}

/// How far a picture is from the truth.
#[derive(Debug)]
struct Quality {
    /// Peak signal to noise, dB.
    psnr: f64,
    /// Largest error of a channel, in levels of 255, and where.
    worst: (f64, usize, usize),
    /// Camera rays per pixel.
    rays: f64,
}

fn quality(scene: &Scene, picture: &Picture) -> Quality {
    let (truth, _) = linear(
        scene,
        &Picture {
            sampling: Sampling::Grid(64),
            precision: Precision::Double,
            ..*picture
        },
    );
    let (got, rays) = linear(scene, picture);
    let (mut squares, mut worst) = (0.0, (0.0, 0, 0));
    for (index, (a, b)) in truth.iter().zip(&got).enumerate() {
        for channel in 0..3 {
            let error = (a.0[channel] - b.0[channel]).abs();
            squares += error * error;
            if error * 255.0 > worst.0 {
                worst = (
                    error * 255.0,
                    index % picture.width as usize,
                    index / picture.width as usize,
                );
            }
        }
    }
    let mean = squares / (3 * truth.len()) as f64;
    Quality {
        psnr: -10.0 * mean.log10(),
        worst,
        rays: rays.camera as f64 / truth.len() as f64,
    }
}

#[test]
fn probe() {
    for side in [128, 256, 512] {
        for projection in [Projection::Perspective, Projection::Orthographic] {
            let picture = Picture {
                sampling: Sampling::Adaptive,
                projection: Some(projection),
                ..Picture::sized(side, side)
            };
            println!(
                "Adap {side} {projection:?} {:?}",
                quality(&Scene::demo(), &picture)
            );
        }
    }
}
