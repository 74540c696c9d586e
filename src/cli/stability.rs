//! `glint stability`: measures where formulas fail.

use std::path::PathBuf;

use clap::Args;

use super::action::CliAction;
use super::args::{MAX_TIMES, whole_number};
use super::error::{CliError, say};
use super::target::{check_table, picture_format};
use crate::export::write_text;
use crate::lab::Figure;
use crate::lab::stability::{cells_csv, maps, summary};

#[derive(Debug, Args)]
pub struct StabilityArgs {
    /// Write every cell of every map to this CSV file
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Save the maps as this picture (PNG, PPM or EXR)
    #[arg(long, value_name = "IMAGE")]
    png: Option<PathBuf>,
    /// Try this many times more rays in the maps of single rays; maps of pictures use the square root of this factor, or
    /// stay as they are
    #[arg(long, default_value = "1", value_parser = whole_number::<1, MAX_TIMES>, allow_negative_numbers = true)]
    effort: u32,
}

/// Measures, prints the summary, and writes the table. Drawing the picture is left to the caller.
///
/// # Errors
/// [`CliError`], if the picture has no known format, or if a file cannot be written.
pub fn run(args: &StabilityArgs) -> Result<CliAction, CliError> {
    // A bad file name is reported before anything is traced.
    picture_format(args.png.as_deref())?;
    check_table(args.csv.as_deref())?;
    let maps = maps(args.effort);
    say(summary(&maps).trim_end());
    if let Some(path) = &args.csv {
        write_text(path, &cells_csv(&maps)?)?;
    }
    Ok(CliAction::drawing(
        Figure::Stability(maps),
        args.png.clone(),
    ))
}
