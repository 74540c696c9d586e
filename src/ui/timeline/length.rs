//! How long the flight of the camera is.

use egui::Ui;

use crate::animate::{longest_flight, stretched};
use crate::editor::{Edit, Editor, Time};
use crate::scene::SAME_TIME;
use crate::ui::number::Field;
use crate::ui::requests::UiRequests;

/// The shortest flight that is asked for, in seconds.
const SHORTEST: f64 = 0.1;
/// Half of the last digit that is shown of times, in seconds.
const SHOWN: f64 = 5e-4;

/// How long the flight of the camera is; another length stretches it.
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
        hint: "Length of the flight; another one stretches it, and the keys of values with it",
        unit: " s",
        default: before,
        // Keys of values that are far behind it may leave it less.
        range: SHORTEST..=longest_flight(animation).max(SHORTEST),
        speed: Some(0.05),
    };
    number(ui, &field, &mut seconds);
    if seconds != before {
        seconds = to_frames(seconds + first.time, animation.frames_per_second) - first.time;
    }
    // What is typed as it was is the same but for its last bit.
    if (seconds - before).abs() > SAME_TIME {
        out.edit(Edit::animation(stretched(animation, seconds), "Stretch"));
        out.time(Time::Stretched(first.time, seconds / before));
    }
}

/// The time of a frame, where one is as near as what is shown of it tells: of 14.35714 s, 14.357 typed again would leave
/// out the last one.
fn to_frames(seconds: f64, frames_per_second: f64) -> f64 {
    let frame = (seconds * frames_per_second).round() / frames_per_second;
    if (frame - seconds).abs() < SHOWN {
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
        assert_eq!(to_frames(14.357, 14.0), length);
        assert_eq!(to_frames(length, 14.0), length);
        assert_eq!(to_frames(14.32, 14.0), 14.32);
    }
}
