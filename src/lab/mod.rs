//! Ways of tracing one picture held against each other: what each costs, and how far it is off.
//!
//! A new way is a line in a list of [`crate::scene::Choice`] or in `candidates.rs`; measuring, chart
//! and tests pick it up.

mod candidates;
mod front;
mod measure;
pub mod stability;
mod study;
mod table;

pub use candidates::{Candidate, candidates};
pub use front::{cheapest_within, front};
pub use measure::{EIGHT_BIT_FLOOR, Failing, difference};
pub use study::{Dot, Study, Timing, Yardstick};
pub use table::{DOUBTFUL, csv, table};
