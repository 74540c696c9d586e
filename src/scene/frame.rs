//! The origin of the coordinates in which pictures are traced: near most of a scene, so that coordinates are small
//! and accurate there.

use glam::DVec3;

use super::whole::Scene;

/// Largest ratio between the half size of the scene and the median reach of its objects for which the middle of the
/// scene is the origin. The tolerance for coincident surfaces is a share of the coordinates: with an origin midway
/// between a table and the moon, everything on the table would count as in its plane.
const MAX_SIZE_RATIO: f64 = 1e3;

/// Number of objects that are examined, evenly spread over the list, if there are more.
const MAX_SAMPLED: usize = 1000;

/// The origin and extent of the main part of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoordinateFrame {
    /// The origin of coordinates.
    pub centre: DVec3,
    /// Largest coordinate, relative to the origin, of the visible bounded objects.
    pub farthest: f64,
    /// The same without objects much farther away than most.
    pub extent: f64,
}

impl CoordinateFrame {
    /// Returns the frame of a scene, or `None` if no visible object is bounded. The origin is the centre of the
    /// bounding box of all visible bounded objects; if a few distant objects move that far away from all others, it
    /// is the median of the centres of objects and of the lights.
    pub fn of(scene: &Scene) -> Option<Self> {
        let (low, high) = scene.objects_bounds()?;
        let (middle, half) = (low.midpoint(high), high * 0.5 - low * 0.5);
        let half = half.max_element();
        let visible = scene.visible_objects();
        let mut boxes: Vec<_> = visible.filter_map(|object| object.shape.bounds()).collect();
        let step = boxes.len().div_ceil(MAX_SAMPLED);
        boxes = boxes.into_iter().step_by(step).collect();
        let positions = boxes.iter().map(|(low, high)| low.midpoint(*high));
        let lights = scene.lights.iter().take(MAX_SAMPLED);
        let positions: Vec<_> = positions
            .chain(lights.map(|light| light.position))
            .collect();
        let median_along = |axis: usize| median(positions.iter().map(|position| position[axis]));
        let centre = DVec3::new(median_along(0)?, median_along(1)?, median_along(2)?);
        let reach =
            |(low, high): &(DVec3, DVec3)| (*high - centre).max(centre - *low).max_element();
        let near_extent = MAX_SIZE_RATIO * median(boxes.iter().map(reach))?;
        Some(if half <= near_extent {
            Self {
                centre: middle,
                farthest: half,
                extent: half,
            }
        } else {
            Self {
                centre,
                farthest: half + (centre - middle).abs().max_element(),
                extent: near_extent,
            }
        })
    }
}

/// Returns the median, the lower of two if the count is even.
fn median(numbers: impl Iterator<Item = f64>) -> Option<f64> {
    let mut numbers: Vec<f64> = numbers.collect();
    let middle = numbers.len().checked_sub(1)? / 2;
    Some(*numbers.select_nth_unstable_by(middle, f64::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Object, Sphere};

    #[test]
    fn coordinates_count_from_the_middle_of_the_demo_also_with_a_moon() {
        let mut scene = Scene::demo();
        let demo = CoordinateFrame::of(&scene).expect("it ends");
        let (low, high) = scene.objects_bounds().expect("it ends");
        assert_eq!(demo.centre, low.midpoint(high));
        assert_eq!(demo.extent, demo.farthest);
        let size = (high - low).length();
        for center in [DVec3::X * 1e9, DVec3::new(-1e12, 3e5, 7.0)] {
            let moon = Sphere {
                center,
                radius: 3e5,
            };
            scene.objects.push(Object::new("Moon", "sphere 1", moon));
            let frame = CoordinateFrame::of(&scene).expect("it ends");
            assert!((frame.centre - demo.centre).length() < size, "{frame:?}");
            assert!(frame.extent < 1e5 * size, "{frame:?}");
            assert!(frame.farthest > center.length(), "{frame:?}");
        }
        // Hidden objects do not thin out those that are examined.
        let frame = CoordinateFrame::of(&scene);
        for number in 0..20 * MAX_SAMPLED {
            let ball = Sphere {
                center: DVec3::ZERO,
                radius: 1.0,
            };
            scene.objects.push(Object {
                visible: false,
                ..Object::new(format!("Hidden {number}"), "sphere 1", ball)
            });
        }
        assert_eq!(CoordinateFrame::of(&scene), frame);
        scene.objects = [].into_iter().collect();
        assert_eq!(CoordinateFrame::of(&scene), None);
    }
}
