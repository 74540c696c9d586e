//! How a command ends, and what it says.

use std::error::Error;
use std::io::{ErrorKind, Write as _};
use std::process::ExitCode;
use std::sync::OnceLock;

use crate::export::ExportError;
use crate::image::FormatError;
use crate::scene::SceneError;
use crate::trace::PoolError;

/// Exit code when the work failed.
const FAILED: u8 = 1;
/// Exit code when the arguments or the file were wrong.
pub const WRONG: u8 = 2;

/// What went wrong, whatever it is.
type Source = Box<dyn Error + Send + Sync>;

/// Why a command did not do what it was asked for.
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
    /// The arguments or the file were wrong.
    pub fn usage(error: impl Into<Source>) -> Self {
        Self::Usage(error.into())
    }

    /// The work failed.
    pub fn failed(error: impl Into<Source>) -> Self {
        Self::Failed(error.into())
    }

    /// Nobody asked a trace to stop, and it did.
    pub fn no_picture() -> Self {
        Self::failed("tracing ended without a picture")
    }

    /// Says it on stderr; the exit code for it.
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

/// Why a result could not be written.
static LOST: OnceLock<String> = OnceLock::new();

/// One result line on stdout. A reader that went away is no fault of ours; [`finish`] tells of what else went wrong.
pub fn say(line: &str) {
    if let Err(error) = writeln!(std::io::stdout(), "{line}")
        && error.kind() != ErrorKind::BrokenPipe
    {
        let _ = LOST.set(error.to_string());
    }
}

/// The exit code of a command that would end with this one: another, if a result was lost.
pub fn finish(code: ExitCode) -> ExitCode {
    match LOST.get() {
        None => code,
        Some(why) => {
            report_error(&format!("results could not be written to stdout: {why}"));
            FAILED.into()
        }
    }
}

/// One line on stderr about what is not as it was asked for, though the command goes on.
pub fn report_warning(warning: &str) {
    let _ = writeln!(std::io::stderr(), "warning: {warning}");
}

/// One line about what went wrong on stderr.
pub fn report_error(error: &str) {
    let _ = writeln!(std::io::stderr(), "error: {error}");
}
