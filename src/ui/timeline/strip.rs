//! Strips of the line of time, and what is drawn on each of them.

use egui::{Color32, FontId, Pos2, Rect, Response, Sense, Shape, Stroke, Ui, pos2, vec2};

use super::scale::Scale;
use crate::scene::{KeyPlace, Keys, without_number};
use crate::ui::theme::{GRID, TRACK, palette};

/// Half the width of a key.
pub const KEY: f32 = 5.0;
/// Size of written times.
pub const SMALL: f32 = 10.0;

/// A strip as wide as the time, with the part for a label to its left.
pub fn band(ui: &mut Ui, scale: &Scale, sense: Sense) -> (Rect, Response) {
    let (whole, _) = ui.allocate_exact_size(vec2(ui.available_width(), TRACK), Sense::hover());
    let rect = Rect::from_x_y_ranges(scale.left..=scale.left + scale.width, whole.y_range());
    let id = ui.scope_id().with(("band", whole.top() as i32));
    // The first moment can be hit from a little to its left.
    let response = ui.interact(rect.expand2(vec2(GRID, 0.0)), id, sense);
    (rect, response)
}

/// Writes to the left of a strip what it is about. What a name is too long for is cut from the name, and not from its
/// number and what stands behind it.
pub fn label(ui: &Ui, rect: Rect, text: &str) {
    let colors = palette(ui.ctx());
    let room = Rect::from_min_max(pos2(ui.max_rect().left(), rect.top()), rect.left_bottom());
    let painter = ui.painter().with_clip_rect(room.shrink2(vec2(GRID, 0.0)));
    let at = room.left_center() + vec2(GRID, 0.0);
    let font = FontId::proportional(SMALL + 1.0);
    let layout = |text: String| painter.layout_no_wrap(text, font.clone(), colors.muted);
    let (name, what) = text.split_at(end_of_name(text));
    let (mut galley, width) = (layout(text.to_owned()), room.width() - 3.0 * GRID);
    let mut kept = name.chars().count();
    while galley.size().x > width && kept > 1 {
        // As many letters as would do if all were alike.
        kept = (kept - 1).min((kept as f32 * width / galley.size().x) as usize + 1);
        let name: String = name.chars().take(kept).collect();
        galley = layout(format!("{}…{what}", name.trim_end()));
    }
    let at = at - vec2(0.0, galley.size().y / 2.0);
    painter.galley(at, galley, colors.muted);
}

/// Where a name ends that may have a number, and its property behind it.
fn end_of_name(text: &str) -> usize {
    let end = text.rfind(": ").unwrap_or(text.len());
    without_number(&text[..end]).len()
}

/// What is selected by a click on a key: with `adds`, it is selected beside the others, or no more.
pub fn picked(selected: &Keys, place: KeyPlace, adds: bool) -> Keys {
    if !adds {
        return Keys::from([place]);
    }
    let mut places = selected.clone();
    if !places.remove(&place) {
        places.insert(place);
    }
    places
}

/// What a drag of a key is of: all that is selected, if it is among it.
pub fn held(selected: &Keys, place: KeyPlace) -> Keys {
    if selected.contains(&place) {
        selected.clone()
    } else {
        Keys::from([place])
    }
}

/// Draws a key: what is held is a square.
pub fn diamond(ui: &Ui, at: Pos2, fill: Color32, is_cut: bool) {
    let corners = if is_cut {
        let half = KEY * 0.8;
        [
            vec2(-half, -half),
            vec2(half, -half),
            vec2(half, half),
            vec2(-half, half),
        ]
    } else {
        [
            vec2(0.0, -KEY),
            vec2(KEY, 0.0),
            vec2(0.0, KEY),
            vec2(-KEY, 0.0),
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
