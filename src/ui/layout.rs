//! Which parts of the window are shown.

use std::ops::RangeInclusive;

use egui::Context;
use serde::{Deserialize, Serialize};

use crate::scene::Aspect;

/// Factors on the size of letters and buttons: smaller ones are unreadable, larger ones leave no room for the picture.
const ZOOM_RANGE: RangeInclusive<f32> = 0.6..=3.0;

/// Parts of the window that can be shown or hidden, and settings of the view.
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
    /// Whether the histogram of the picture is shown.
    pub histogram: bool,
    /// The panel below the picture.
    pub below: Below,
    /// Whether the picture is shown without any panel.
    #[serde(skip)]
    pub is_alone: bool,
    /// Factor on the usual speed of flying.
    pub fly_speed: f64,
    /// The part of the light that the live view shows.
    #[serde(skip)]
    pub aspect: Aspect,
}

/// A part of the window that is shown or hidden without a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WindowPart {
    /// The panel on the left.
    Outliner,
    /// The panel on the right.
    Inspector,
    /// The histogram of the picture.
    Histogram,
    /// The flight of the camera in the view.
    Flight,
    /// The shot in a corner of the view.
    Shot,
}

impl WindowPart {
    /// The panels, with their names.
    pub const PANELS: [(Self, &'static str); 2] =
        [(Self::Outliner, "Outliner"), (Self::Inspector, "Inspector")];
    /// The parts shown over the picture, with their names.
    pub const OVER_PICTURE: [(Self, &'static str); 3] = [
        (Self::Histogram, "Histogram"),
        (Self::Flight, "Flight in the view"),
        (Self::Shot, "Shot in a corner of the view"),
    ];
}

impl Layout {
    /// Shows the outliner, and the panels again if the picture was alone.
    pub fn show_outliner(&mut self) {
        (self.outliner, self.is_alone) = (true, false);
    }

    /// Returns the flag whether a part of the window is shown.
    pub fn part(&mut self, part: WindowPart) -> &mut bool {
        match part {
            WindowPart::Outliner => &mut self.outliner,
            WindowPart::Inspector => &mut self.inspector,
            WindowPart::Histogram => &mut self.histogram,
            WindowPart::Flight => &mut self.flight,
            WindowPart::Shot => &mut self.shot,
        }
    }
}

/// The panel below the picture: there is room for only one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Below {
    /// Nothing but the status line.
    Nothing,
    /// The timeline.
    #[default]
    Timeline,
    /// The lab.
    Lab,
}

impl Default for Layout {
    fn default() -> Self {
        Self {
            outliner: true,
            inspector: true,
            flight: true,
            shot: true,
            histogram: false,
            below: Below::default(),
            is_alone: false,
            fly_speed: 1.0,
            aspect: Aspect::All,
        }
    }
}

/// Keeps letters and buttons at a usable size.
pub fn keep_readable(ctx: &Context) {
    let zoom = ctx.zoom_factor();
    let clamped = zoom.clamp(*ZOOM_RANGE.start(), *ZOOM_RANGE.end());
    if clamped != zoom {
        ctx.set_zoom_factor(clamped);
    }
}
