//! Actions requested by panels, and messages to the user.

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

/// A request of a panel.
#[derive(Clone, Debug)]
pub enum Action {
    /// Change the scene.
    Edit(Edit),
    /// Move the camera as part of a flight.
    Fly(Motion),
    /// Orbit the camera about a point; yaw to the right and pitch upwards, in radians.
    Orbit(DVec3, (f64, f64)),
    /// Select something. The inspector shows it, or the last of several items.
    Select(Selection),
    /// Start a gesture: the edits that follow form a new undo step.
    BeginGesture,
    /// Revert everything since the gesture began.
    CancelGesture,
    /// Step back in the history.
    Undo,
    /// Step forward in the history.
    Redo,
    /// Show something else in the picture area.
    Show(Mode),
    /// Change the timeline.
    Time(Time),
    /// Tell the user about side effects of the last step that its name does not mention; undoing the step dismisses
    /// the message.
    Tell(String),
}

/// Value of [`Message::about`] for messages about the effects of the last step.
pub const STEP: &str = "step";

/// A message for the user.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// Whether something went wrong.
    pub is_error: bool,
    /// What happened and, for errors, what to do. Empty if an action merely starts again: then earlier messages about
    /// it are dismissed.
    pub text: String,
    /// The action that the message is about: when the action starts again, the message is dismissed. Empty for none.
    pub about: &'static str,
}
