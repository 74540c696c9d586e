//! Object maps: which object is visible at each pixel. The scene is rendered by the same tracer, with a colour for
//! each object that encodes its number.

use glam::DVec3;
use indexmap::IndexMap;

use super::buffer::Image;
use super::render::render_into;
use crate::plan::{Planner, RenderRequest};
use crate::scene::{ColorPack, Light, LightObj, List, Object, Sampling, Scene};
use crate::trace::RenderControl;

/// Something that a pixel can show, by index in the scene's list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Thing {
    /// The marker of a light.
    Light(usize),
    /// An object.
    Object(usize),
}

/// What is visible at the centre of each pixel of a picture.
#[derive(Clone, Debug, Default)]
pub struct ObjectMap {
    image: Image,
    lights: usize,
}

impl ObjectMap {
    /// Width in pixels.
    pub fn width(&self) -> usize {
        self.image.width
    }

    /// Height in pixels.
    pub fn height(&self) -> usize {
        self.image.height
    }

    /// What is visible at a pixel; `None` for the sky and outside the picture.
    pub fn at(&self, column: usize, row: usize) -> Option<Thing> {
        if column >= self.image.width {
            return None;
        }
        let pixel = self.image.pixels.get(row * self.image.width + column)?;
        self.thing(*pixel)
    }

    /// What is visible in a row, pixel by pixel; empty outside the picture.
    pub fn row(&self, row: usize) -> impl Iterator<Item = Option<Thing>> {
        let width = self.image.width;
        let pixels = self.image.pixels.get(row * width..(row + 1) * width);
        let pixels = pixels.unwrap_or_default().iter();
        pixels.map(|pixel| self.thing(*pixel))
    }

    fn thing(&self, [low, middle, high, _]: [u8; 4]) -> Option<Thing> {
        let number = u32::from_le_bytes([low, middle, high, 0]) as usize;
        let index = number.checked_sub(1)?;
        Some(match index.checked_sub(self.lights) {
            None => Thing::Light(index),
            Some(object) => Thing::Object(object),
        })
    }
}

/// Makes object maps; what consecutive maps have in common is reused.
#[derive(Debug, Default)]
pub struct ObjectMapper {
    planner: Planner,
    last: Option<NumberedScene>,
}

/// A scene in numbered colours, and what it was made from.
#[derive(Debug)]
struct NumberedScene {
    objects: List<Object>,
    lights: List<Light>,
    without: Vec<Thing>,
    scene: Scene,
}

impl ObjectMapper {
    /// Makes the map for the picture `request` of a scene, which must pass [`crate::scene::check`], with the things
    /// in `without` left out. Meshes that `planner` has prepared are reused. `None` if `control` was stopped.
    pub fn map(
        &mut self,
        scene: &Scene,
        request: &RenderRequest,
        without: &[Thing],
        (planner, control): (&Planner, &RenderControl),
    ) -> Option<ObjectMap> {
        let mut numbered = self.numbered(scene, without);
        numbered.camera = scene.camera.clone();
        numbered.light_visualization = scene.light_visualization;
        let request = RenderRequest {
            sampling: Sampling::Centres,
            ..*request
        };
        self.planner.share_meshes(planner);
        let mut image = Image::default();
        render_into(&mut image, &mut self.planner, &numbered, &request, control)?;
        Some(ObjectMap {
            image,
            lights: scene.lights.len(),
        })
    }

    fn numbered(&mut self, scene: &Scene, without: &[Thing]) -> Scene {
        if let Some(last) = &self.last
            && last.objects.is_same(&scene.objects)
            && last.lights.is_same(&scene.lights)
            && last.without == without
        {
            return last.scene.clone();
        }
        let numbered = numbered(scene, without);
        self.last = Some(NumberedScene {
            objects: scene.objects.clone(),
            lights: scene.lights.clone(),
            without: without.to_vec(),
            scene: numbered.clone(),
        });
        numbered
    }
}

/// Returns the scene without lighting, each thing in the colour of its number; numbers start at 1, with lights first.
fn numbered(scene: &Scene, without: &[Thing]) -> Scene {
    let is_included = |thing: Thing| !without.contains(&thing);
    let lights = scene.lights.iter().enumerate().map(|(index, light)| Light {
        intensity: 0.0,
        visible: light.visible && is_included(Thing::Light(index)),
        marker: light.marker.as_ref().map(|marker| LightObj {
            color_pack: (index + 1).to_string(),
            ..marker.clone()
        }),
        ..light.clone()
    });
    let first = scene.lights.len() + 1;
    let objects = scene
        .objects
        .iter()
        .enumerate()
        .map(|(index, object)| Object {
            color_pack: (first + index).to_string(),
            visible: object.visible && is_included(Thing::Object(index)),
            ..object.clone()
        });
    let packs = (1..first + scene.objects.len()).map(|number| (number.to_string(), pack(number)));
    let mut numbered = Scene {
        background: DVec3::ZERO,
        ambient_intensity: 1.0,
        lights: lights.collect(),
        objects: objects.collect(),
        ..scene.clone()
    };
    *numbered.packs_mut() = packs.collect::<IndexMap<_, _>>();
    numbered.render.reflection_limit = 0;
    numbered
}

/// A color pack whose visible colour encodes a number below 2²⁴.
fn pack(number: usize) -> ColorPack {
    let [low, middle, high, ..] = (number as u32).to_le_bytes().map(f64::from);
    ColorPack {
        ambient: DVec3::new(low, middle, high),
        diffuse: DVec3::ZERO,
        specular: DVec3::ZERO,
        reflective: false,
        ..ColorPack::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(scene: &Scene, without: &[Thing]) -> ObjectMap {
        let request = RenderRequest::sized(64, 64);
        let context = (&Planner::default(), &RenderControl::default());
        let map = ObjectMapper::default().map(scene, &request, without, context);
        map.expect("nobody stops it")
    }

    /// A picture in which only the object at this index is white, and nothing is lit.
    fn silhouette(scene: &Scene, object: usize) -> Image {
        let mut scene = scene.clone();
        for light in scene.lights.iter_mut() {
            light.intensity = 0.0;
        }
        for pack in scene.packs_mut().values_mut() {
            pack.ambient = DVec3::ZERO;
        }
        let white = ColorPack {
            ambient: DVec3::splat(255.0),
            ..ColorPack::default()
        };
        scene.packs_mut().insert("white".to_owned(), white);
        "white".clone_into(&mut scene.objects[object].color_pack);
        (scene.ambient_intensity, scene.background) = (1.0, DVec3::ZERO);
        let request = RenderRequest::sized(64, 64);
        let picture = crate::image::render(&scene, &request, &RenderControl::default());
        picture.expect("nobody stops it").0
    }

    #[test]
    fn each_object_is_seen_where_it_alone_is_white() {
        let scene = Scene::demo();
        let map = map(&scene, &[]);
        for object in 0..scene.objects.len() {
            let white = silhouette(&scene, object);
            for (n, pixel) in white.pixels.iter().enumerate() {
                let is_seen = map.at(n % 64, n / 64) == Some(Thing::Object(object));
                assert_eq!(is_seen, pixel[0] == 255, "{object}, {n}");
            }
        }
        let all = || (0..64).flat_map(|row| map.row(row));
        assert!(all().any(|thing| thing.is_none()));
        assert!(all().any(|thing| thing == Some(Thing::Light(0))));
    }

    #[test]
    fn behind_what_is_left_out_is_the_next() {
        let mut scene = Scene::demo();
        scene.light_visualization = false;
        let first = map(&scene, &[]);
        let at = (0..64 * 64).find_map(|n| Some((n, first.at(n % 64, n / 64)?)));
        let (place, seen) = at.expect("something is seen");
        let behind = map(&scene, &[seen]);
        assert_ne!(behind.at(place % 64, place / 64), Some(seen));
        assert_eq!(first.at(64, 0), None);
        assert_eq!(first.at(0, 64), None);
    }
}
