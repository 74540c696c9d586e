//! The command line: parses words, prints lines. Results go to stdout, errors to stderr; the exit
//! code is 0 for done, 1 for failed work, 2 for wrong words or a wrong file.

mod chart;

mod check;

mod fallback;

mod plan;

mod render;

mod export;

mod stability;

use std::ffi::OsString;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{CommandFactory as _, Parser, Subcommand};

pub use fallback::picture_instead_of_window;

use crate::image::Format;
use crate::lab::Study;
use crate::lab::stability::Map;

/// Exit code when the work failed.
const FAILED: u8 = 1;
/// Exit code when the words or the file were wrong.
const WRONG: u8 = 2;

#[derive(Debug, Parser)]
#[command(
    name = "glint",
    version,
    about = "A scene editor whose viewport is a CPU ray tracer",
    long_about = "A scene editor whose viewport is a CPU ray tracer.\n\nWithout a command, opens the editor on SCENE (on the demo scene if there is none).",
    args_conflicts_with_subcommands = true
)]
struct Words {
    /// The scene to open in the editor (RON)
    scene: Option<PathBuf>,
    /// Write a picture of the window once it is complete (PNG or PPM), and quit
    #[arg(long, value_name = "IMAGE")]
    screenshot: Option<PathBuf>,
    /// Open the window of exports first
    #[arg(long, requires = "screenshot")]
    exports: bool,
    #[command(subcommand)]
    command: Option<CliCommand>,
}

#[derive(Debug, Subcommand)]
enum CliCommand {
    /// Trace a scene into a picture
    Render(render::RenderArgs),
    /// Write the frames of an animation, going on where it was left
    Export(export::ExportArgs),
    /// Write a job for a render farm (Open Job Description)
    Job(export::JobArgs),
    /// Validate scene files
    Check(check::CheckArgs),
    /// Say what a scene needs of the tracer, and why
    Plan(plan::PlanArgs),
    /// Chart time against error for every way of tracing a scene
    Chart(chart::ChartArgs),
    /// Say how often every formula fails, and where most
    Stability(stability::StabilityArgs),
}

/// What the command line asked for.
#[derive(Debug)]
pub enum CliAction {
    /// Open the editor.
    Editor {
        /// The scene file; the demo if there is none.
        scene: Option<PathBuf>,
        /// Where to write a picture of the window, which then closes.
        screenshot: Option<PathBuf>,
        /// Whether the window of exports is opened first.
        exports: bool,
    },
    /// Draw the chart of a study into this file.
    Chart {
        /// The study.
        study: Box<Study>,
        /// The picture file; its ending is known to be good.
        path: PathBuf,
    },
    /// Draw these maps into this file.
    Stability {
        /// The maps.
        maps: Vec<Map>,
        /// The picture file; its ending is known to be good.
        path: PathBuf,
    },
    /// Nothing more: the command ran and ends with this code.
    Done(ExitCode),
}

/// Reads the command line and runs its command, if it has one.
pub fn run(words: impl IntoIterator<Item = OsString>) -> CliAction {
    let words: Vec<OsString> = words.into_iter().collect();
    if let Some(name) = unknown_command(&words) {
        return CliAction::Done(refuse(&format!(
            "there is no command {name:?}; there are render, export, job, check, plan, chart and stability, and `glint SCENE` opens the editor"
        )));
    }
    match Words::try_parse_from(words) {
        Ok(Words {
            command: Some(CliCommand::Render(words)),
            ..
        }) => CliAction::Done(render::run(&words)),
        Ok(Words {
            command: Some(CliCommand::Export(words)),
            ..
        }) => CliAction::Done(export::run(&words)),
        Ok(Words {
            command: Some(CliCommand::Job(words)),
            ..
        }) => CliAction::Done(export::run_job(&words)),
        Ok(Words {
            command: Some(CliCommand::Check(words)),
            ..
        }) => CliAction::Done(check::run(&words)),
        Ok(Words {
            command: Some(CliCommand::Plan(words)),
            ..
        }) => CliAction::Done(plan::run(&words)),
        Ok(Words {
            command: Some(CliCommand::Chart(words)),
            ..
        }) => chart::run(&words),
        Ok(Words {
            command: Some(CliCommand::Stability(words)),
            ..
        }) => stability::run(&words),
        Ok(Words {
            command: None,
            scene,
            screenshot,
            exports,
        }) => match screenshot.as_deref().map(Format::of_path) {
            Some(Err(error)) => CliAction::Done(refuse(&error.to_string())),
            _ => CliAction::Editor {
                scene,
                screenshot,
                exports,
            },
        },
        Err(error) => {
            // Help and version are "errors" of exit code 0 that go to stdout.
            let _ = error.print();
            CliAction::Done(if error.use_stderr() {
                WRONG.into()
            } else {
                ExitCode::SUCCESS
            })
        }
    }
}

/// The first of several plain words, if it is no command: the editor takes one scene only.
fn unknown_command(words: &[OsString]) -> Option<String> {
    let is_plain = |word: &OsString| !word.to_string_lossy().starts_with('-');
    let [_, first, second, ..] = words else {
        return None;
    };
    let is_command = Words::command().find_subcommand(first).is_some() || first == "help";
    (is_plain(first) && is_plain(second) && !is_command)
        .then(|| first.to_string_lossy().into_owned())
}

/// One result line on stdout. A reader that went away is no fault of ours.
fn say(line: &str) {
    use std::io::Write as _;
    let _ = writeln!(std::io::stdout(), "{line}");
}

fn report_error(error: &str) {
    use std::io::Write as _;
    let _ = writeln!(std::io::stderr(), "error: {error}");
}

fn refuse(error: &str) -> ExitCode {
    report_error(error);
    WRONG.into()
}

/// Says on stderr why the work failed, and gives the exit code for that.
pub fn fail(error: &str) -> ExitCode {
    report_error(error);
    FAILED.into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_words_are_consistent() {
        Words::command().debug_assert();
    }
}
