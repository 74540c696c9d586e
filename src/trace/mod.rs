//! Everything that runs per ray and per tile. Independent of files and pixel formats.
//!
//! The modules are listed in the order of their dependencies. From the bottom: counters, control and thresholds;
//! tiles and samples; the choice of primitives to test, the tests, the properties of a hit, the footprint of a pixel
//! and the search for what is thin in it; packets of rays, what a beam of them can meet, and their colours; one
//! bounce, all bounces, the pixels; the tracer, which shares tiles between threads; and queries of a scene that need
//! no picture.

mod stats;

mod control;

mod thresholds;

mod tile;

mod samples;

mod shadows;

mod thin_margin;

mod bundle;

mod passing;

mod entry_points;

mod thin_cull;

mod candidates;

mod walk;

mod paths;

mod doubt;

mod slender;

mod scan;

mod intersect;

mod stretch;

mod coincident;

mod columns;

mod footprint;

mod mixed_materials;

mod hit_material;

mod gather;

mod surface;

mod thin;

mod packet;

mod beam;

mod order;

mod outcome;

mod cull;

mod gaps;

mod mirrored;

mod shade;

mod faces;

mod bounce;

mod forward;

mod engine;

mod points;

mod cell;

mod messages;

mod pixel_sides;

mod limits;

mod lattice;

mod crossing;

mod coverage;

mod refinement;

mod sampler;

mod heat;

mod threads;

mod workspace_pool;

mod retrace;

mod canvas;

mod band;

mod tracer;

mod query;

pub use control::{RenderControl, Stopwatch};
pub use heat::heat;
pub use query::{CachedQuery, SceneQuery, survey, visible};
pub use stats::Rays;
pub use threads::{PoolError, Threads};
pub use tile::{Grid, Pass, Pixel};
pub use tracer::Tracer;
