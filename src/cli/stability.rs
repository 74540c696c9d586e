//! `glint stability`: where formulas break.

use std::num::NonZeroU32;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;

use super::{fail, say};
use crate::lab::stability::{cells_csv, maps, summary};
use crate::scene::write_atomic;

#[derive(Debug, Args)]
pub struct StabilityWords {
    /// Write every cell of every map to this file
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Try so many times more rays than for a first look
    #[arg(long, default_value = "1")]
    effort: NonZeroU32,
}

/// Tries, prints the summary, and writes what was asked for.
pub fn run(words: &StabilityWords) -> ExitCode {
    let maps = maps(words.effort.get());
    say(summary(&maps).trim_end());
    match &words.csv {
        Some(path) => match write_atomic(path, cells_csv(&maps).as_bytes()) {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => fail(&format!("cannot write {}: {error}", path.display())),
        },
        None => ExitCode::SUCCESS,
    }
}
