//! `glint stability`: where formulas break.

use std::num::NonZeroU32;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;

use super::{CliAction, fail, refuse, say};
use crate::files::write_atomic;
use crate::image::Format;
use crate::lab::stability::{cells_csv, maps, summary};

#[derive(Debug, Args)]
pub struct StabilityArgs {
    /// Write every cell of every map to this file
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Draw the maps into this picture (PNG or PPM)
    #[arg(long, value_name = "IMAGE")]
    png: Option<PathBuf>,
    /// Try so many times more rays than for a first look
    #[arg(long, default_value = "1")]
    effort: NonZeroU32,
}

/// Tries, prints the summary, and writes what was asked for. The picture is left to whoever can draw.
pub fn run(words: &StabilityArgs) -> CliAction {
    if let Some(Err(error)) = words.png.as_deref().map(Format::of_path) {
        return CliAction::Done(refuse(&error.to_string()));
    }
    let maps = maps(words.effort.get());
    say(summary(&maps).trim_end());
    if let Some(path) = &words.csv
        && let Err(error) = write_atomic(path, cells_csv(&maps).as_bytes())
    {
        return CliAction::Done(fail(&format!("cannot write {}: {error}", path.display())));
    }
    match words.png.clone() {
        Some(path) => CliAction::Stability { maps, path },
        None => CliAction::Done(ExitCode::SUCCESS),
    }
}
