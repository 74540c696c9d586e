//! Errors, output and exit codes of commands.

use std::error::Error;
use std::io::{ErrorKind, Write as _};
use std::process::ExitCode;
use std::sync::OnceLock;

use crate::export::ExportError;
use crate::image::FormatError;
use crate::scene::SceneError;
use crate::trace::PoolError;

/// Exit code if the work failed.
const FAILED: u8 = 1;
/// Exit code if the arguments or the file were wrong.
pub const WRONG: u8 = 2;

/// The underlying error.
type Source = Box<dyn Error + Send + Sync>;

/// Error of a command.
#[derive(Debug, thiserror::Error)]
pub enum CliError {
    /// The arguments or the file were wrong: nothing was done.
    #[error(transparent)]
    Usage(Source),
    /// The work failed.
    #[error(transparent)]
    Failed(Source),
}

impl CliError {
    /// An error in the arguments or the file.
    pub fn usage(error: impl Into<Source>) -> Self {
        Self::Usage(error.into())
    }

    /// A failure of the work.
    pub fn failed(error: impl Into<Source>) -> Self {
        Self::Failed(error.into())
    }

    /// The failure of a trace that ended without a picture, although nothing stops one here.
    pub fn no_picture() -> Self {
        Self::failed("tracing ended without a picture")
    }

    /// Reports the error on stderr, and returns its exit code.
    pub fn report(&self) -> ExitCode {
        report_error(&self.to_string());
        match self {
            Self::Usage(_) => WRONG.into(),
            Self::Failed(_) => FAILED.into(),
        }
    }
}

impl From<SceneError> for CliError {
    fn from(error: SceneError) -> Self {
        Self::usage(error)
    }
}

impl From<FormatError> for CliError {
    fn from(error: FormatError) -> Self {
        Self::usage(error)
    }
}

impl From<ExportError> for CliError {
    fn from(error: ExportError) -> Self {
        Self::failed(error)
    }
}

impl From<PoolError> for CliError {
    fn from(error: PoolError) -> Self {
        Self::failed(error)
    }
}

impl From<csv::Error> for CliError {
    fn from(error: csv::Error) -> Self {
        Self::failed(error)
    }
}

impl From<serde_json::Error> for CliError {
    fn from(error: serde_json::Error) -> Self {
        Self::failed(error)
    }
}

/// Why a result could not be written to stdout.
static STDOUT_ERROR: OnceLock<String> = OnceLock::new();

/// Prints a line of results to stdout. A closed pipe is not an error; [`finish`] reports any other one.
pub fn say(line: &str) {
    if let Err(error) = writeln!(std::io::stdout(), "{line}")
        && error.kind() != ErrorKind::BrokenPipe
    {
        let _ = STDOUT_ERROR.set(error.to_string());
    }
}

/// Returns the exit code of a command: `code`, or a failure if a result could not be written.
pub fn finish(code: ExitCode) -> ExitCode {
    match STDOUT_ERROR.get() {
        None => code,
        Some(why) => {
            report_error(&format!("results could not be written to stdout: {why}"));
            FAILED.into()
        }
    }
}

/// Prints a line to stderr about something that is not as requested, although the command goes on.
pub fn report_warning(warning: &str) {
    report(&format!("warning: {warning}"));
}

/// Prints a line to stderr about an error.
pub fn report_error(error: &str) {
    report(&format!("error: {error}"));
}

/// Prints a line to stderr.
pub fn report(line: &str) {
    let _ = writeln!(std::io::stderr(), "{line}");
}
