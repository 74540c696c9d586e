//! The command line: parses arguments, prints lines. Results go to stdout, errors to stderr. The exit code is 0 for
//! success, 1 for failed work, 2 for wrong arguments or a wrong file.

mod error;

mod args;

mod bar;

mod scene;

mod target;

mod action;

mod goal;

mod settings;

mod check;

mod plan;

mod render;

mod export;

mod convert;

mod chart;

mod stability;

mod referee;

mod desktop;

mod fallback;

use std::ffi::OsString;
use std::io::{IsTerminal as _, stdout};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{CommandFactory as _, Parser, Subcommand};

pub use action::CliAction;
use error::WRONG;
pub use error::{CliError, finish, say};
pub use fallback::picture_instead_of_window;
use target::picture_format;

use crate::scene::{Document, Scene};

#[derive(Debug, Parser)]
#[command(
    name = "glint",
    version,
    about = "A scene editor whose viewport is a CPU ray tracer",
    long_about = "A scene editor whose viewport is a CPU ray tracer.\n\nWithout a command, opens the editor on SCENE (the demo scene if none is given).",
    args_conflicts_with_subcommands = true
)]
struct CliArgs {
    /// The scene to open in the editor (RON)
    scene: Option<PathBuf>,
    /// Save a picture of the window once it is complete (PNG, PPM or EXR), and quit
    #[arg(long, value_name = "IMAGE")]
    screenshot: Option<PathBuf>,
    /// With --screenshot: open the export window first
    #[arg(long, requires = "screenshot")]
    exports: bool,
    /// Open the editor, wait until its first traced picture is on the screen, print the time that took and the memory
    /// used as JSON, and quit
    #[arg(long, conflicts_with = "screenshot")]
    stats_start: bool,
    /// Install a menu entry, icon, manual page and shell completions for the current user
    #[arg(long, exclusive = true)]
    install_desktop: bool,
    /// With --screenshot: select the object or light with this name first; may be repeated
    #[arg(long, value_name = "NAME", requires = "screenshot")]
    select: Vec<String>,
    #[command(subcommand)]
    command: Option<CliCommand>,
}

#[derive(Debug, Subcommand)]
enum CliCommand {
    /// Trace a scene and save the picture
    Render(render::RenderArgs),
    /// Write the frames of an animation, resuming where an earlier export stopped
    Export(export::ExportArgs),
    /// Write a job for a render farm (Open Job Description)
    Job(export::JobArgs),
    /// Validate scene files
    Check(check::CheckArgs),
    /// Convert a mesh file to a scene, or a scene to a POV-Ray file
    Convert(convert::ConvertArgs),
    /// Show what the tracer computes for a scene, what it skips, and why
    Plan(plan::PlanArgs),
    /// Chart time against error of every rendering method
    Chart(chart::ChartArgs),
    /// Show how often each formula fails, and where most
    Stability(stability::StabilityArgs),
    /// Render a scene with POV-Ray too, and show how far its picture differs
    Referee(referee::RefereeArgs),
}

/// Parses the command line and runs its command, if there is one.
pub fn run(words: impl IntoIterator<Item = OsString>) -> CliAction {
    let result = run_words(words.into_iter().collect());
    match result.unwrap_or_else(|error| CliAction::Done(error.report())) {
        CliAction::Done(code) => CliAction::Done(finish(code)),
        action => action,
    }
}

fn run_words(words: Vec<OsString>) -> Result<CliAction, CliError> {
    let done = |()| CliAction::Done(ExitCode::SUCCESS);
    if let Some(name) = unknown_command(&words) {
        if !is_word(Path::new(&name)) || Path::new(&name).is_file() {
            let sentence = format!("the editor opens one scene: remove what follows {name:?}");
            return Err(CliError::usage(sentence));
        }
        let commands = CliArgs::command();
        let command_names: Vec<&str> = commands
            .get_subcommands()
            .map(clap::Command::get_name)
            .collect();
        let command_names = command_names.join(", ");
        return Err(CliError::usage(format!(
            "there is no command {name:?}; the commands are {command_names}, and `glint SCENE` opens the editor"
        )));
    }
    let words = match CliArgs::try_parse_from(words) {
        Ok(words) => words,
        Err(error) => {
            // clap returns help and version as "errors" that go to stdout and have exit code 0.
            if error.use_stderr() {
                let _ = error.print();
                return Ok(CliAction::Done(WRONG.into()));
            }
            let text = error.render();
            let text = if stdout().is_terminal() && has_colors() {
                text.ansi().to_string()
            } else {
                text.to_string()
            };
            say(text.trim_end());
            return Ok(done(()));
        }
    };
    match &words.command {
        Some(CliCommand::Render(args)) => render::run(args).map(done),
        Some(CliCommand::Export(args)) => export::run(args).map(done),
        Some(CliCommand::Job(args)) => export::run_job(args).map(done),
        Some(CliCommand::Check(args)) => Ok(CliAction::Done(check::run(args))),
        Some(CliCommand::Convert(args)) => convert::run(args).map(done),
        Some(CliCommand::Plan(args)) => plan::run(args).map(done),
        Some(CliCommand::Chart(args)) => chart::run(args),
        Some(CliCommand::Stability(args)) => stability::run(args),
        Some(CliCommand::Referee(args)) => referee::run(args).map(done),
        None if words.install_desktop => desktop::install(CliArgs::command()).map(done),
        None => words.editor(),
    }
}

impl CliArgs {
    fn editor(self) -> Result<CliAction, CliError> {
        if self.stats_start {
            return Ok(CliAction::TimeStart { scene: self.scene });
        }
        // A bad file name is reported before the window opens.
        picture_format(self.screenshot.as_deref())?;
        if self.screenshot.is_some() {
            self.check_selection()?;
        }
        Ok(CliAction::Editor {
            scene: self.scene,
            screenshot: self.screenshot,
            exports: self.exports,
            select: self.select,
        })
    }

    /// Checks that the scene for a screenshot is valid and has the objects to be selected: nobody would read an error
    /// in the window.
    fn check_selection(&self) -> Result<(), CliError> {
        let shown = self.scene.as_deref().map(Document::load).transpose()?;
        let shown = shown.map_or_else(Scene::demo, |shown| shown.scene);
        let lights = shown.lights.iter().map(|light| &light.name);
        let names: Vec<_> = lights
            .chain(shown.objects.iter().map(|object| &object.name))
            .collect();
        match self.select.iter().find(|name| !names.contains(name)) {
            None => Ok(()),
            Some(name) => Err(CliError::usage(format!(
                "there is no object or light named {name:?} to select"
            ))),
        }
    }
}

/// Returns whether text may be coloured, by the environment variables that turn colours off (<https://no-color.org>).
fn has_colors() -> bool {
    let variable = |name| std::env::var_os(name).unwrap_or_default();
    variable("NO_COLOR").is_empty() && variable("TERM") != "dumb"
}

/// Returns whether a path is a bare name, without folder and extension.
fn is_word(path: &Path) -> bool {
    path.components().count() == 1 && path.extension().is_none()
}

/// Returns the first argument if it was probably meant as a command that does not exist: it is followed by another
/// word, or it is a bare name and no such file exists.
fn unknown_command(words: &[OsString]) -> Option<String> {
    let is_plain = |word: &OsString| !word.to_string_lossy().starts_with('-');
    let [_, first, others @ ..] = words else {
        return None;
    };
    let is_command = CliArgs::command().find_subcommand(first).is_some() || first == "help";
    let looks_like_command = others.first().is_some_and(is_plain)
        || (is_word(Path::new(first)) && !Path::new(first).exists());
    (is_plain(first) && looks_like_command && !is_command)
        .then(|| first.to_string_lossy().into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_words_are_consistent() {
        CliArgs::command().debug_assert();
    }
}
