//! Horizontal strips along the time axis, and what is drawn on them.

use egui::{Color32, FontId, Pos2, Rect, Response, Sense, Shape, Stroke, Ui, pos2, vec2};

use super::scale::Scale;
use crate::scene::{KeyId, Keys, without_number};
use crate::ui::theme::{GRID, TRACK, palette};

/// Half the width of a key's symbol, in points.
pub const KEY_HALF_WIDTH: f32 = 5.0;
/// Font size of times, in points.
pub const TIME_FONT_SIZE: f32 = 10.0;

/// Allocates a strip along the time axis, with space for a label to its left. Returns its rectangle and response.
pub fn band(ui: &mut Ui, scale: &Scale) -> (Rect, Response) {
    let (full_width, _) = ui.allocate_exact_size(vec2(ui.available_width(), TRACK), Sense::hover());
    let rect = Rect::from_x_y_ranges(scale.left..=scale.left + scale.width, full_width.y_range());
    let id = ui.scope_id().with(("band", full_width.top() as i32));
    // Widened a little, so that the first moment is easy to hit.
    let response = ui.interact(rect.expand2(vec2(GRID, 0.0)), id, Sense::click_and_drag());
    (rect, response)
}

/// Writes the label to the left of a strip. If it is too long, the name is shortened, but not its number or the
/// property that follows.
pub fn label(ui: &Ui, rect: Rect, text: &str) {
    let colors = palette(ui.ctx());
    let label_area = Rect::from_min_max(pos2(ui.max_rect().left(), rect.top()), rect.left_bottom());
    let painter = ui
        .painter()
        .with_clip_rect(label_area.shrink2(vec2(GRID, 0.0)));
    let at = label_area.left_center() + vec2(GRID, 0.0);
    let font = FontId::proportional(TIME_FONT_SIZE + 1.0);
    let layout = |text: String| painter.layout_no_wrap(text, font.clone(), colors.muted);
    let (name, suffix) = text.split_at(end_of_name(text));
    let (mut galley, width) = (layout(text.to_owned()), label_area.width() - 3.0 * GRID);
    let mut letter_count = name.chars().count();
    while galley.size().x > width && letter_count > 1 {
        // An estimate that assumes letters of equal width.
        letter_count =
            (letter_count - 1).min((letter_count as f32 * width / galley.size().x) as usize + 1);
        let name: String = name.chars().take(letter_count).collect();
        galley = layout(format!("{}…{suffix}", name.trim_end()));
    }
    let at = at - vec2(0.0, galley.size().y / 2.0);
    painter.galley(at, galley, colors.muted);
}

/// Byte index at which a name ends that may be followed by a number and a property.
fn end_of_name(text: &str) -> usize {
    let end = text.rfind(": ").unwrap_or(text.len());
    without_number(&text[..end]).len()
}

/// The selection after a click on a key; `adds` toggles the key in the current selection.
pub fn selection_after_click(selected: &Keys, place: KeyId, adds: bool) -> Keys {
    if !adds {
        return Keys::from([place]);
    }
    let mut places = selected.clone();
    if !places.remove(&place) {
        places.insert(place);
    }
    places
}

/// The keys that a drag of a key moves: the whole selection, if the key is part of it.
pub fn dragged_keys(selected: &Keys, place: KeyId) -> Keys {
    if selected.contains(&place) {
        selected.clone()
    } else {
        Keys::from([place])
    }
}

/// Draws a key as a diamond; as a square if its value is held until the next key.
pub fn diamond(ui: &Ui, at: Pos2, fill: Color32, is_cut: bool) {
    let corners = if is_cut {
        let half = KEY_HALF_WIDTH * 0.8;
        [
            vec2(-half, -half),
            vec2(half, -half),
            vec2(half, half),
            vec2(-half, half),
        ]
    } else {
        [
            vec2(0.0, -KEY_HALF_WIDTH),
            vec2(KEY_HALF_WIDTH, 0.0),
            vec2(0.0, KEY_HALF_WIDTH),
            vec2(-KEY_HALF_WIDTH, 0.0),
        ]
    };
    let corners = corners.map(|corner| at + corner).to_vec();
    ui.painter()
        .add(Shape::convex_polygon(corners, fill, Stroke::NONE));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_names_stay() {
        for (text, name) in [
            ("Sphere 12: position", "Sphere"),
            ("Roof: rotation", "Roof"),
            ("Ambient intensity", "Ambient intensity"),
            ("Größe 3", "Größe"),
        ] {
            assert_eq!(&text[..end_of_name(text)], name);
        }
    }
}
