//! The data model of the scene file: its types, their validation, reading and writing. No caches, no pixels.
//!
//! A new field needs a line in its type (with its default), a check in `check` and, if users edit it, a row in the
//! inspector. Colours are 0–255, lengths are in world units. The camera stores direction vectors, not angles, as in
//! the original program.
//!
//! # The file
//!
#![doc = include_str!("../../assets/scene_format.md")]

mod list;

mod names;

mod direction;

mod methods;

mod notation;

mod shape;

mod camera;

mod orientation;

mod material;

mod object;

mod mesh_coincidence;

mod coincidence;

mod render;

mod animation;

mod keys;

mod whole;

mod pack_usage;

mod frame;

mod differences;

mod aspect;

mod hints;

mod import;

mod join;

mod target;

mod locate;

mod check;

mod parse_errors;

mod refusal;

mod file;

mod examples;

mod recovery;

pub use animation::{
    Animation, Easing, FRAME_RATES, Interpolation, Key, Lens, MAX_KEYS, MAX_SECONDS, Owner,
    SAME_TIME, Sample, Take, Target, Track, Value,
};
pub use aspect::Aspect;
pub use camera::{
    Bookmark, Camera, Framing, MIN_ORTHOGRAPHIC_HEIGHT, Projection, field_of_view_radians,
};
pub use check::{MAX_COORDINATE, MAX_FACTOR, PROJECTION_DISTANCES, Problem, check, check_edit};
pub use coincidence::{Coincidence, Overlap, coincidences};
pub use differences::differences;
pub use direction::unit;
pub use examples::{EXAMPLES, Example};
pub use file::{DEMO_TEXT, Document, SceneError, messages_about_objects, read_text};
pub use frame::CoordinateFrame;
pub use hints::{About, Hint, camera_hints, hints, scene_hints};
pub use import::valid_name;
pub use join::MAX_SEPARATED;
pub use keys::{KeyId, Keys};
pub use list::List;
pub use locate::{PathStep, header, names_field};
pub use material::{ColorPack, MAX_EXPONENT, Packs};
pub use methods::{
    Accelerator, HighlightMethod, MAX_GRID, MAX_HALVINGS, Method, MethodInfo, Methods, Precision,
    RayOffset, Sampling, SphereMethod, TriangleMethod, UnknownMethod,
};
pub use names::{Names, without_number};
pub(crate) use notation::method;
pub use notation::{format_number, parse_vec3};
pub use object::{Light, LightObj, Object, default_intensity};
pub use orientation::{Orientation, wrapped_angle};
pub use recovery::{Leftover, Recovery};
pub use render::{Chosen, MAX_REFLECTIONS, MAX_SIDE, Render, Setting, VisitSetting};
pub use shape::{
    Describe, Disc, Mesh, MeshSource, Outline, Plane, PlanePiece, Property, PropertyValue, Shape,
    Sphere, Triangle, rotations_between,
};
pub use target::Owners;
pub use whole::{MAX_BYTES, Scene, around, default_ambient_intensity, light_pack};
