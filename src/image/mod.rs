//! Pictures: from a scene to pixels, conversion of light to 8 bits, file formats.

mod buffer;

mod rows;

mod encode;

mod render;

mod strips;

mod histogram;

mod film;

mod object_map;

pub use buffer::{Image, LinearImage, LinearRgb, Raster};
pub use encode::{Format, FormatError};
pub use film::Film;
pub use histogram::Histogram;
pub use object_map::{ObjectMap, ObjectMapper, Thing};
pub use render::{RenderCost, render, render_into, render_light_into};
pub use strips::{Drawing, Strips};
