//! The field for the length of the camera flight.

use egui::Ui;

use crate::animate::{longest_flight, stretched};
use crate::editor::{Edit, Editor, Time};
use crate::scene::SAME_TIME;
use crate::ui::number::Field;
use crate::ui::requests::UiRequests;

/// The shortest flight that can be set, in seconds.
const MIN_FLIGHT_SECONDS: f64 = 0.1;
/// Half of the last digit shown of times, in seconds.
const DISPLAY_TOLERANCE: f64 = 5e-4;

/// Shows the length of the camera flight; changing it stretches the flight in time.
pub fn show_length(
    ui: &mut Ui,
    editor: &Editor,
    number: impl Fn(&mut Ui, &Field, &mut f64),
    out: &mut UiRequests,
) {
    let animation = &editor.scene().animation;
    let [first, .., last] = &animation.keys[..] else {
        return;
    };
    let before = last.time - first.time;
    let mut seconds = before;
    let field = Field {
        name: "length of the flight",
        hint: "Length of the flight; changing it stretches the flight and the keys of values",
        unit: " s",
        default: before,
        // Value keys far behind the flight may limit it to less than that.
        range: MIN_FLIGHT_SECONDS..=longest_flight(animation).max(MIN_FLIGHT_SECONDS),
        speed: Some(0.05),
    };
    number(ui, &field, &mut seconds);
    if seconds != before {
        seconds = snapped_to_frame(seconds + first.time, animation.frames_per_second) - first.time;
    }
    // Retyping the shown value may change its last bit.
    if (seconds - before).abs() > SAME_TIME {
        out.edit(Edit::animation(stretched(animation, seconds), "Stretch"));
        out.time(Time::Stretched(first.time, seconds / before));
    }
}

/// Snaps a time to a frame within the precision of the display: with a flight of 14.35714 s, retyping the 14.357
/// shown would otherwise drop the last frame.
fn snapped_to_frame(seconds: f64, frames_per_second: f64) -> f64 {
    let frame = (seconds * frames_per_second).round() / frames_per_second;
    if (frame - seconds).abs() < DISPLAY_TOLERANCE {
        frame
    } else {
        seconds
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_length_as_it_is_shown_has_all_of_its_frames() {
        let length = 201.0 / 14.0;
        assert_eq!(snapped_to_frame(14.357, 14.0), length);
        assert_eq!(snapped_to_frame(length, 14.0), length);
        assert_eq!(snapped_to_frame(14.32, 14.0), 14.32);
    }
}
