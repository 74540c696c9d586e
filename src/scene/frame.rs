//! Where the coordinates of pictures count from: near most of a scene, so that they are small and exact there.

use glam::DVec3;

use super::whole::Scene;

/// So many times as far as half of the objects, others may be for the middle of all to be near them. What counts as
/// one surface is a share of the coordinates: the middle between a table and the moon would put all that is on the
/// table into its plane.
const FAR: f64 = 1e3;

/// Of more objects, so many are looked at, evenly spread over the list.
const LOOKED_AT: usize = 1000;

/// Where most of a scene is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoordinateFrame {
    /// Where coordinates count from.
    pub centre: DVec3,
    /// The largest coordinate of what is visible and has an end.
    pub farthest: f64,
    /// The same without what is much farther away than most.
    pub extent: f64,
}

impl CoordinateFrame {
    /// The middle of the box around everything visible that has an end; where a few things are so far away that it
    /// would be far from all others, the median of theirs and of the lights. `None` if nothing has an end.
    pub fn of(scene: &Scene) -> Option<Self> {
        let (low, high) = scene.objects_bounds()?;
        let (middle, half) = (low * 0.5 + high * 0.5, high * 0.5 - low * 0.5);
        let half = half.max_element();
        let visible = scene.visible_objects();
        let boxes = visible.filter_map(|object| object.shape.bounds());
        let step = scene.objects.len().div_ceil(LOOKED_AT);
        let boxes: Vec<_> = boxes.step_by(step).collect();
        let places = boxes.iter().map(|(low, high)| *low * 0.5 + *high * 0.5);
        let lights = scene.lights.iter().take(LOOKED_AT);
        let places: Vec<_> = places.chain(lights.map(|light| light.position)).collect();
        let median_along = |axis: usize| median(places.iter().map(|place| place[axis]));
        let centre = DVec3::new(median_along(0)?, median_along(1)?, median_along(2)?);
        let reach =
            |(low, high): &(DVec3, DVec3)| (*high - centre).max(centre - *low).max_element();
        let near = FAR * median(boxes.iter().map(reach))?;
        Some(if half <= near {
            Self {
                centre: middle,
                farthest: half,
                extent: half,
            }
        } else {
            Self {
                centre,
                farthest: half + (centre - middle).abs().max_element(),
                extent: near,
            }
        })
    }
}

/// The middle one of some numbers, the lower of two.
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
        assert_eq!(demo.centre, low * 0.5 + high * 0.5);
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
        scene.objects = [].into_iter().collect();
        assert_eq!(CoordinateFrame::of(&scene), None);
    }
}
