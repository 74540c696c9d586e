//! What the scene file holds: data, its checks and its door to the disk. No caches, no pixels.
//!
//! A new field gets a line here (with its default), a check in `check.rs` and, if a person edits it,
//! a row in the inspector. Colours are 0–255, lengths are world units, angles appear nowhere: the
//! camera stores direction vectors, as in the original program.

mod animation;
mod camera;
mod check;
mod file;
mod locate;
mod methods;
mod notation;
mod orientation;
mod parse_errors;
mod recovery;
mod shape;

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

pub use animation::{
    Animation, Easing, Interpolation, Key, Lens, MAX_SECONDS, Sample, Take, Target, Track, Value,
};
pub use camera::{Camera, Framing, Projection};
pub use check::{Problem, check};
pub use file::{Document, SceneError, read_text};
pub use locate::PathStep;
pub use methods::{
    Accelerator, HighlightMethod, MAX_GRID, MAX_HALVINGS, Method, MethodInfo, Methods, Precision,
    RayOffset, Sampling, SphereMethod, TriangleMethod,
};
pub use notation::{format_number, parse_vec3};
pub use orientation::Orientation;
pub use recovery::{Leftover, Recovery};
pub use shape::{Describe, Field, FieldValue, Plane, Shape, Sphere, Triangle};

use glam::DVec3;

/// The scene-file version that this program writes and the newest that it reads.
pub const VERSION: u32 = 1;

/// The RON text of the demo scene, as embedded in the program.
pub const DEMO_TEXT: &str = include_str!("../../scenes/demo.ron");

/// Largest picture side, in pixels.
pub const MAX_SIDE: u32 = 16_384;

/// Deepest chain of reflections that a scene may ask for.
pub const MAX_REFLECTIONS: u32 = 32;

/// Everything that makes a picture. What a file leaves out has the value that the demo scene has.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Version of the file format, see [`VERSION`].
    pub version: u32,
    /// Colour of a ray that hits nothing, 0–255.
    #[serde(default)]
    #[serde(with = "notation::vector")]
    pub background: DVec3,
    /// How much of every pack's ambient colour is seen without any light, 0–1.
    #[serde(default = "default_ambient_intensity", with = "notation::number")]
    pub ambient_intensity: f64,
    /// Whether the markers of the lights are part of the picture.
    #[serde(default = "yes")]
    pub light_visualization: bool,
    /// Where the picture is taken from.
    #[serde(default)]
    pub camera: Camera,
    /// Materials by name, shared by the objects that name them; the order is the file's.
    #[serde(default = "default_packs", deserialize_with = "notation::packs")]
    pub color_packs: IndexMap<String, ColorPack>,
    /// The things that are seen, mirrored and cast shadows.
    pub objects: Vec<Object>,
    /// The lights.
    #[serde(default = "default_lights")]
    pub lights: Vec<Light>,
    /// How the picture is made.
    #[serde(default)]
    pub render: Render,
    /// What moves, and when. Written with a layout of its own, one key in a line.
    #[serde(default, skip_serializing)]
    pub animation: Animation,
}

/// A material: colours are 0–255 per channel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ColorPack {
    /// Colour without any light, scaled by the scene's ambient intensity.
    #[serde(with = "notation::vector")]
    pub ambient: DVec3,
    /// Colour of matte reflection.
    #[serde(with = "notation::vector")]
    pub diffuse: DVec3,
    /// Colour of the highlight, and of the mirror image if reflective.
    #[serde(with = "notation::vector")]
    pub specular: DVec3,
    /// Sharpness of the highlight: 0 is flat, 16 soft, 1000 a pinpoint.
    #[serde(with = "notation::number")]
    pub phong_exponent: f64,
    /// Whether the surface mirrors the scene.
    pub reflective: bool,
}

/// A named shape with a material.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Object {
    /// Unique name, shown in the outliner.
    pub name: String,
    /// Name of its material in [`Scene::color_packs`].
    pub color_pack: String,
    /// Where and what it is.
    pub shape: Shape,
    /// An invisible object is not in the picture at all: no shadow, no reflection.
    #[serde(default = "yes", skip_serializing_if = "is_true")]
    pub visible: bool,
}

/// A point light that does not fall off with distance.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Light {
    /// Unique name, shown in the outliner.
    pub name: String,
    /// Where it shines from.
    #[serde(with = "notation::vector")]
    pub position: DVec3,
    /// Brightness, 0–1.
    #[serde(default = "default_intensity", with = "notation::number")]
    pub intensity: f64,
    /// What shows where the light is, if anything does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub marker: Option<LightObj>,
    /// An invisible light is switched off, marker included.
    #[serde(default = "yes", skip_serializing_if = "is_true")]
    pub visible: bool,
}

/// The marker of a light: a sphere in the full ambient colour of its pack that casts no shadow.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct LightObj {
    /// Radius in world units, > 0.
    #[serde(with = "notation::number")]
    pub radius: f64,
    /// Name of its material in [`Scene::color_packs`].
    pub color_pack: String,
}

/// How the picture is made. What it is traced with is written to the file only where it differs from
/// the default, which is what the scene needs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Render {
    /// Width in pixels, 1–[`MAX_SIDE`].
    pub width: u32,
    /// Height in pixels, 1–[`MAX_SIDE`].
    pub height: u32,
    /// How often light may be mirrored on its way to the eye, 0–[`MAX_REFLECTIONS`].
    pub reflection_limit: u32,
    /// How edges are smoothed.
    #[serde(with = "notation::word", skip_serializing_if = "notation::is_default")]
    pub antialias: Sampling,
    /// The real type of the kernel.
    #[serde(with = "notation::word", skip_serializing_if = "notation::is_default")]
    pub precision: Precision,
    /// Ray against sphere.
    #[serde(with = "notation::word", skip_serializing_if = "notation::is_default")]
    pub sphere: SphereMethod,
    /// Ray against triangle.
    #[serde(with = "notation::word", skip_serializing_if = "notation::is_default")]
    pub triangle: TriangleMethod,
    /// Where shadow and reflection rays start.
    #[serde(with = "notation::word", skip_serializing_if = "notation::is_default")]
    pub offset: RayOffset,
    /// The power of a highlight.
    #[serde(with = "notation::word", skip_serializing_if = "notation::is_default")]
    pub specular: HighlightMethod,
    /// How primitives are found.
    #[serde(with = "notation::word", skip_serializing_if = "notation::is_default")]
    pub accelerator: Accelerator,
}

impl Render {
    /// The formulas.
    pub fn methods(&self) -> Methods {
        Methods {
            sphere: self.sphere,
            triangle: self.triangle,
            offset: self.offset,
            highlight: self.specular,
        }
    }
}

impl Scene {
    /// The demo scene: two spheres, a tetrahedron and a mirror under two lights.
    ///
    /// # Panics
    /// Never: a test reads the embedded text.
    #[expect(
        clippy::expect_used,
        reason = "the embedded text is tested to be a valid scene"
    )]
    pub fn demo() -> Self {
        Document::from_text(DEMO_TEXT)
            .expect("the embedded demo scene is valid")
            .scene
    }

    /// An empty scene with the demo's camera and a pack and a light to start from.
    pub fn empty() -> Self {
        let mut light = default_lights().swap_remove(0);
        light.marker = Some(LightObj::default());
        Self {
            version: VERSION,
            background: DVec3::new(0.0, 0.0, 0.0),
            ambient_intensity: default_ambient_intensity(),
            light_visualization: true,
            camera: Camera::default(),
            color_packs: IndexMap::from([
                ("pack 1".to_owned(), ColorPack::default()),
                ("light".to_owned(), light_pack()),
            ]),
            objects: Vec::new(),
            lights: vec![light],
            render: Render::default(),
            animation: Animation::default(),
        }
    }

    /// Smallest and largest corner of the box around everything visible that has an end, lights
    /// included; `None` if there is nothing.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let visible = self.objects.iter().filter(|object| object.visible);
        let lights = self.lights.iter().filter(|light| light.visible);
        let boxes = visible
            .filter_map(|object| object.shape.bounds())
            .chain(lights.map(|light| (light.position, light.position)));
        boxes.reduce(|(low, high), (other_low, other_high)| {
            (low.min(other_low), high.max(other_high))
        })
    }

    /// The names of the objects and lights that use the pack `name`, in outliner order.
    pub fn users_of_pack(&self, name: &str) -> Vec<&str> {
        let lights = self.lights.iter().filter(|light| {
            light
                .marker
                .as_ref()
                .is_some_and(|marker| marker.color_pack == name)
        });
        let objects = self
            .objects
            .iter()
            .filter(|object| object.color_pack == name);
        lights
            .map(|light| light.name.as_str())
            .chain(objects.map(|o| o.name.as_str()))
            .collect()
    }
}

impl Default for ColorPack {
    fn default() -> Self {
        Self {
            ambient: DVec3::new(255.0, 128.0, 128.0),
            diffuse: DVec3::new(255.0, 128.0, 128.0),
            specular: DVec3::new(255.0, 255.0, 255.0),
            phong_exponent: 16.0,
            reflective: false,
        }
    }
}

impl Default for LightObj {
    fn default() -> Self {
        Self {
            radius: 5.0,
            color_pack: "light".to_owned(),
        }
    }
}

impl Default for Render {
    fn default() -> Self {
        Self {
            width: 1024,
            height: 1024,
            reflection_limit: 1,
            antialias: Sampling::default(),
            precision: Precision::default(),
            sphere: SphereMethod::default(),
            triangle: TriangleMethod::default(),
            offset: RayOffset::default(),
            specular: HighlightMethod::default(),
            accelerator: Accelerator::default(),
        }
    }
}

fn yes() -> bool {
    true
}

#[expect(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde asks with a reference"
)]
fn is_true(value: &bool) -> bool {
    *value
}

fn default_ambient_intensity() -> f64 {
    0.5
}

fn default_intensity() -> f64 {
    0.2
}

fn light_pack() -> ColorPack {
    let yellow = DVec3::new(255.0, 255.0, 0.0);
    ColorPack {
        ambient: yellow,
        diffuse: yellow,
        ..ColorPack::default()
    }
}

fn default_packs() -> IndexMap<String, ColorPack> {
    let matte = |x, y, z| ColorPack {
        ambient: DVec3::new(x, y, z),
        diffuse: DVec3::new(x, y, z),
        ..ColorPack::default()
    };
    IndexMap::from([
        ("sphere 1".to_owned(), matte(255.0, 128.0, 255.0)),
        ("sphere 2".to_owned(), matte(255.0, 128.0, 128.0)),
        ("tetrahedron".to_owned(), matte(128.0, 255.0, 255.0)),
        (
            "plane".to_owned(),
            ColorPack {
                reflective: true,
                ..ColorPack::default()
            },
        ),
        ("light".to_owned(), light_pack()),
    ])
}

/// The demo's two lights without markers: a file that leaves its lights out need not have the pack
/// that the markers would name.
fn default_lights() -> Vec<Light> {
    let light = |name: &str, x, y, z| Light {
        name: name.to_owned(),
        position: DVec3::new(x, y, z),
        intensity: default_intensity(),
        marker: None,
        visible: true,
    };
    vec![
        light("Light 1", 100.0, 100.0, -50.0),
        light("Light 2", 231.0, 63.0, -127.0),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_file_leaves_out_is_what_the_demo_has() {
        let demo = Scene::demo();
        let sparse = Document::from_text("Scene(version: 1, objects: [])")
            .expect("valid")
            .scene;
        let mut expected = Scene {
            objects: Vec::new(),
            ..demo
        };
        for light in &mut expected.lights {
            light.marker = None;
        }
        assert_eq!(sparse, expected);
    }

    #[test]
    fn the_empty_scene_is_valid() {
        assert_eq!(check(&Scene::empty()), Ok(()));
    }
}
