//! Compares ways of tracing one picture: what each costs, and how large its error is.
//!
//! A new way is a line in a list of [`crate::scene::Method`] or in `candidates.rs`; measuring, chart and tests
//! include it automatically.

mod candidates;

mod measure;

mod pareto_front;

mod study;

mod quality;

mod clusters;

mod finding;

mod table;

mod account;

mod kept;

mod growth;

mod scaling;

mod explain;

pub mod stability;

mod figure;

pub use account::account;
pub use candidates::{Candidate, Family, candidates};
pub use clusters::{clusters, costs_of_choices};
pub use explain::{
    Explanation, LightTerm, ShadingTerms, drawn, explain, first_hit, intersect_shape,
};
pub use figure::{Figure, PictureLook};
pub use finding::finding;
pub use growth::{Cost, Crowd, Growth, RenderMethod};
pub use kept::{keep, kept};
pub use measure::{EIGHT_BIT_FLOOR, ErrorMetrics, difference, mean_of_two, quantile, trace_light};
pub use pareto_front::{cheapest_within, closest_within, front};
pub use quality::{Choice, Goal, choose};
pub use scaling::{SharedPicture, scaling};
pub use study::{Measurement, Reference, Study, Timing};
pub use table::{csv, csv_of, table};
