//! What of the window is shown.

use serde::{Deserialize, Serialize};

use crate::scene::Aspect;

/// What of the window can be shown or hidden.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(default)]
#[expect(clippy::struct_excessive_bools, reason = "each is a tick in the menu")]
pub struct Layout {
    /// The panel on the left.
    pub outliner: bool,
    /// The panel on the right.
    pub inspector: bool,
    /// Whether the flight of the camera is drawn into the view.
    pub flight: bool,
    /// Whether the shot is shown in a corner of the view.
    pub shot: bool,
    /// Whether it is shown how bright the picture is.
    pub histogram: bool,
    /// Whether the timeline was shown when the window was closed.
    pub timeline: bool,
    /// Whether the lab was.
    pub lab: bool,
    /// How many times faster than usual the camera flies.
    pub fly_speed: f64,
    /// What of the light the live view shows.
    #[serde(skip)]
    pub aspect: Aspect,
}

/// What is shown of the panels that commands show and hide.
#[derive(Clone, Copy, Debug)]
pub struct Panels {
    /// The timeline.
    pub timeline: bool,
    /// The lab.
    pub lab: bool,
    /// Nothing but the picture.
    pub is_alone: bool,
}

impl Default for Layout {
    fn default() -> Self {
        Self {
            outliner: true,
            inspector: true,
            flight: true,
            shot: true,
            histogram: false,
            timeline: true,
            lab: false,
            fly_speed: 1.0,
            aspect: Aspect::All,
        }
    }
}
