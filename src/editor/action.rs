//! What panels ask for, and what the user is told.

use glam::DVec3;

use super::edit::Edit;
use super::fly::Motion;
use super::selection::Selection;
use super::timeline::Time;

/// What the picture area shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// The live view at the resolution of the screen.
    #[default]
    Live,
    /// The live view at 64 pixels, as in the original program.
    LowRes,
    /// The still picture; back to [`Mode::Live`] when the scene changes.
    HighRes,
}

/// Something that a panel asks for.
#[derive(Clone, Debug)]
pub enum Action {
    /// Change the scene.
    Edit(Edit),
    /// Move the camera as part of a flight.
    Fly(Motion),
    /// Move the camera around a point, turned to the right and upwards by so many radians.
    Orbit(DVec3, (f64, f64)),
    /// Select something, and show it, or the last of it, in the inspector.
    Select(Selection),
    /// What comes is a step of its own in the history.
    BeginGesture,
    /// Take back what was done since the gesture began.
    CancelGesture,
    /// Step back in the history.
    Undo,
    /// Step forward in the history.
    Redo,
    /// Show something else in the picture area.
    Show(Mode),
    /// Something about the timeline.
    Time(Time),
    /// Say what the last step has done besides what it is called; taken back with it.
    Tell(String),
}

/// What messages about what the last step has done are about.
pub const STEP: &str = "step";

/// Something the user should read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// Whether something went wrong.
    pub is_error: bool,
    /// What happened and, for errors, what to do; nothing, where an action was only begun again.
    pub text: String,
    /// The action that it is about: what was said of it is forgotten when it is begun again. Empty for none.
    pub about: &'static str,
}
