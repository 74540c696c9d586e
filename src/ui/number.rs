//! A number field: to drag, to type into and to step through.

use std::cell::Cell;
use std::ops::RangeInclusive;

use egui::{
    Align, Atom, Color32, Context, DragValue, Id, Key, Layout, Response, RichText, Ui, vec2,
};
use glam::DVec3;

use super::arithmetic::calculate;
use super::hint::Hinted as _;
use super::prompts::select_letters;
use super::step_size::{MAX_STEP, step_size};
use super::theme::ROW;
use crate::scene::{MAX_COORDINATE, parse_vec3};
use crate::ui::commands::take_escape;
use crate::words::quoted;

/// Angle in degrees below which nothing but rounding is left of it.
pub const ROUNDED_ANGLE: f64 = 1e-9;
/// Characters that fit into one of three fields in a row.
const NARROW_CHARS: usize = 7;
/// The lower end of a range, if below this, only means that numbers must be above 0.
const POSITIVE_ONLY_BELOW: f64 = 0.5;
/// Characters for the ends of a range, in messages.
const RANGE_END_CHARS: usize = 9;
/// Characters that fit into a field with a row of its own.
const WIDE_CHARS: usize = 16;

/// The range and the description of a number.
#[derive(Clone, Debug)]
pub struct Field {
    /// Label, and accessible name of the value.
    pub name: &'static str,
    /// Tooltip: meaning and range.
    pub hint: &'static str,
    /// Unit, shown after the number.
    pub unit: &'static str,
    /// Value that a double-click on the label restores.
    pub default: f64,
    /// Range: typed numbers outside are refused, and a drag stops at its ends.
    pub range: RangeInclusive<f64>,
    /// Change per point of dragging; `None` follows the value's size.
    pub speed: Option<f64>,
}

/// The number that was dragged last.
#[derive(Clone, Copy)]
struct LastDrag {
    number: Id,
    /// Number of the window's frame in which this was noted.
    frame: u64,
    /// Value before the drag.
    start: f64,
    step: DragStep,
}

/// The state of a number's drag in this frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DragStep {
    /// The drag begins in this frame.
    Begins,
    /// The drag goes on.
    Continues,
    /// The drag was cancelled: its effect is to be undone.
    Cancelled,
}

fn last_drag_id() -> Id {
    Id::unique("number that was dragged last")
}

/// Notes whether a number is dragged. Returns the value before the drag if Escape, which ends it in egui, cancels it.
fn track_drag(ui: &Ui, response: &Response, value: f64) -> Option<f64> {
    let frame = ui.cumulative_frame_nr();
    let last = ui.data(|data| data.get_temp::<LastDrag>(last_drag_id()));
    // egui may lay out a frame twice.
    let is_this_number = |last: &LastDrag| {
        last.number == response.id && (last.frame..=last.frame + 1).contains(&frame)
    };
    let last = last.filter(is_this_number);
    let was_released = !response.dragged() && last.is_some();
    let is_cancelled = was_released && take_escape(ui);
    let start = last.map_or(value, |last| last.start);
    if response.dragged() || is_cancelled {
        let step = match last {
            _ if is_cancelled => DragStep::Cancelled,
            None => DragStep::Begins,
            Some(_) => DragStep::Continues,
        };
        let drag = LastDrag {
            number: response.id,
            frame,
            start,
            step,
        };
        ui.data_mut(|data| data.insert_temp(last_drag_id(), drag));
    }
    is_cancelled.then_some(start)
}

/// Returns the state of the drag, if a number is dragged in this frame.
pub fn drag_step(ctx: &Context) -> Option<DragStep> {
    let last: LastDrag = ctx.data(|data| data.get_temp(last_drag_id()))?;
    (last.frame == ctx.cumulative_frame_nr()).then_some(last.step)
}

fn refusal_id() -> Id {
    Id::unique("what was typed and not taken")
}

/// Notes why what was typed into a field is refused, once the focus leaves it.
pub fn note_refusal(response: &Response, is_cancelled: bool, words: Option<String>) {
    if let Some(words) = words.filter(|_| response.lost_focus() && !is_cancelled) {
        response
            .ctx
            .data_mut(|data| data.insert_temp(refusal_id(), words));
    }
}

/// Takes the reason why what was typed last was refused.
pub fn take_refusal(ctx: &Context) -> Option<String> {
    ctx.data_mut(|data| data.remove_temp(refusal_id()))
}

/// Returns what is wrong with a text for a field: it is not a number, or it is out of range.
fn refusal(field: &Field, text: &str) -> Option<String> {
    match parse_expression(text) {
        None if text.is_empty() => None,
        None if is_ambiguous(text) => {
            let (short, long) = (text.replace(',', "."), text.replace(',', ""));
            let text = quoted(text);
            Some(format!(
                "{text} could mean {short} or {long}: write one of them"
            ))
        }
        None => Some(format!("{} is not a number", quoted(text))),
        Some(number) => out_of_range(field, number),
    }
}

/// Returns what is wrong with a number that is out of a field's range.
fn out_of_range(field: &Field, number: f64) -> Option<String> {
    if field.range.contains(&number) {
        return None;
    }
    let (name, least, most) = (field.name, *field.range.start(), *field.range.end());
    Some(
        if number <= 0.0 && 0.0 < least && least < POSITIVE_ONLY_BELOW {
            format!("{name} must be greater than 0")
        } else {
            let [least, most] = [least, most].map(|end| rounded(end, "", RANGE_END_CHARS));
            format!("{name} must be between {least} and {most}{}", field.unit)
        },
    )
}

/// Returns whether a comma stands before exactly three digits, which may be decimals or thousands.
fn is_ambiguous(text: &str) -> bool {
    let Some((before, after)) = text.split_once(',') else {
        return false;
    };
    let integer_part = before.trim_start_matches(['-', '+']);
    let are_digits = |text: &str| text.bytes().all(|letter| letter.is_ascii_digit());
    let is_thousands = (1..=3).contains(&integer_part.len()) && !integer_part.starts_with('0');
    is_thousands && after.len() == 3 && are_digits(integer_part) && are_digits(after)
}

/// Parses a number or an arithmetic expression.
fn parse_expression(text: &str) -> Option<f64> {
    parse_number(text).or_else(|| calculate(text, parse_number))
}

/// Parses a number, unless the text can be read as two different ones.
pub fn parse_number(text: &str) -> Option<f64> {
    if is_ambiguous(text) {
        return None;
    }
    // In many languages, the decimal separator is a comma.
    let number: Option<f64> = text.parse().ok();
    let number = number.or_else(|| text.replacen(',', ".", 1).parse().ok());
    number.filter(|number| number.is_finite())
}

/// A number without bounds, for positions.
pub fn coordinate(name: &'static str, hint: &'static str) -> Field {
    Field {
        name,
        hint,
        unit: "",
        default: 0.0,
        range: -MAX_COORDINATE..=MAX_COORDINATE,
        speed: None,
    }
}

/// A number from 0 to 1.
pub fn fraction(name: &'static str, hint: &'static str, default: f64) -> Field {
    Field {
        name,
        hint,
        unit: "",
        default,
        range: 0.0..=1.0,
        speed: Some(0.005),
    }
}

/// The appearance and the range of a draggable number.
pub struct Number<'a> {
    /// Range and description.
    pub field: &'a Field,
    /// Accessible name, since a field may consist of several numbers.
    pub name: &'a str,
    /// Width in points.
    pub width: f32,
    /// Largest absolute value of the numbers next to it: smaller ones are dragged as fast as that one.
    pub size: f64,
    /// Receives three numbers that are typed at once, a whole vector.
    pub pasted: Option<&'a Cell<Option<DVec3>>>,
    /// Letter and colour of the axis it belongs to.
    pub axis: Option<(&'static str, Color32)>,
}

/// Shows a draggable number. Returns whether it was confirmed with Enter, changed or not.
pub fn drag(ui: &mut Ui, number: &Number, value: &mut f64) -> bool {
    let Number {
        field,
        name,
        width,
        size,
        pasted,
        axis,
    } = *number;
    // A number that is not a length gets its least step from its default.
    let least = step_size(ui.ctx()).max((field.default.abs() * 1e-3).min(MAX_STEP));
    let speed = (value.abs().max(size) * 0.01).max(least);
    let add = |ui: &mut Ui, widget: DragValue| {
        let widget = widget
            .speed(field.speed.unwrap_or(speed))
            .clip_text(true)
            .prefix(Atom::grow());
        let widget = match axis {
            Some((letter, color)) => widget.prefix(RichText::new(letter).color(color)),
            None => widget,
        };
        let widget = match field.unit {
            "" => widget,
            unit => widget.suffix(RichText::new(unit).weak()),
        };
        let room = vec2(width.max(8.0), ROW);
        let layout = Layout::right_to_left(Align::Center)
            .with_main_justify(true)
            .with_main_align(Align::Max);
        let placed = ui.allocate_ui_with_layout(room, layout, |ui| {
            ui.add(widget.min_size(room)).accessible_name(name)
        });
        placed.inner
    };
    let (response, is_confirmed) = edit_value(ui, (field, pasted), value, add);
    response.hint_beside(ui, field.hint);
    is_confirmed
}

/// Shows a draggable number in a bar, without a label.
pub fn drag_unlabelled(ui: &mut Ui, field: &Field, value: &mut f64) {
    let add = |ui: &mut Ui, widget: DragValue| {
        let speed = field.speed.unwrap_or(1.0);
        let widget = ui.add(widget.speed(speed).suffix(field.unit));
        widget.accessible_name(field.name)
    };
    edit_value(ui, (field, None), value, add).0.hint(field.hint);
}

/// Shows a number with `add`. Typed text counts when the field is left. Also returns whether Enter confirmed it.
fn edit_value(
    ui: &mut Ui,
    (field, pasted): (&Field, Option<&Cell<Option<DVec3>>>),
    value: &mut f64,
    add: impl FnOnce(&mut Ui, DragValue) -> Response,
) -> (Response, bool) {
    // Three in a row have less room each.
    let max_chars = if pasted.is_some() {
        NARROW_CHARS
    } else {
        WIDE_CHARS
    };
    let format_value = |value: f64| rounded(value, field.unit, max_chars);
    let (shown_text, refused, is_as_shown) =
        (format_value(*value), Cell::new(None), Cell::new(false));
    let parser = |text: &str| {
        let text = text.trim();
        let text = text.strip_suffix(field.unit.trim()).unwrap_or(text);
        // Nobody writes 000 for a coordinate: those are thousands.
        let is_grouped = text.split(',').skip(1).any(|part| part == "000");
        if let (Some(pasted), Some(vector)) = (pasted, parse_vec3(text).filter(|_| !is_grouped)) {
            let parts = vector.to_array();
            refused.set(parts.iter().find_map(|part| out_of_range(field, *part)));
            let is_within = parts.iter().all(|part| field.range.contains(part));
            pasted.set(is_within.then_some(vector));
            return is_within.then_some(vector.x);
        }
        let text = text.trim();
        is_as_shown.set(text == shown_text);
        // Leaving a field unchanged is never an error.
        refused.set(refusal(field, text).filter(|_| text != shown_text));
        // A number out of range is taken for a mistake, and not moved to the nearest end.
        parse_expression(text).filter(|number| field.range.contains(number))
    };
    let mut edited = *value;
    let widget = DragValue::new(&mut edited)
        .range(field.range.clone())
        .clamp_existing_to_range(false)
        .update_while_editing(false)
        .custom_formatter(|number, _| format_value(number))
        .custom_parser(parser);
    let response = add(ui, widget);
    if response.double_clicked() {
        // egui selects only the digits up to the decimal point.
        select_letters(ui, response.id, 0..usize::MAX);
    }
    if let Some(start) = track_drag(ui, &response, *value) {
        // For the scene, the whole step is undone as well, see [`drag_step`]; other numbers are only restored here.
        *value = start;
        return (response, false);
    }
    // What is shown is rounded: the value may change only if the user changed it.
    let is_cancelled = is_cancelled(ui, &response);
    if let Some(pasted) = pasted.filter(|_| is_cancelled) {
        pasted.set(None);
    }
    let refused = refused.take();
    let is_confirmed = response.lost_focus()
        && refused.is_none()
        && ui.input(|input| input.key_pressed(Key::Enter));
    note_refusal(&response, is_cancelled, refused);
    // If the text is the shown one, the value keeps its hidden digits.
    let is_as_shown = !response.dragged() && is_as_shown.get();
    if response.changed() && edited.is_finite() && !is_cancelled && !is_as_shown {
        *value = edited.clamp(*field.range.start(), *field.range.end());
    }
    (response, is_confirmed)
}

/// Returns whether the field was left with Escape, which discards what was typed. egui reports the loss of focus for
/// two frames, and in the second one the key is gone, so the first is remembered.
pub fn is_cancelled(ui: &Ui, response: &Response) -> bool {
    if !response.lost_focus() {
        return false;
    }
    let (id, now) = (response.id.with("cancelled"), ui.cumulative_frame_nr());
    if ui.input(|input| input.key_pressed(Key::Escape)) {
        ui.data_mut(|data| data.insert_temp(id, now));
        return true;
    }
    ui.data(|data| data.get_temp::<u64>(id))
        .is_some_and(|then| now <= then + 2)
}

/// Formats a number with enough decimals to show the effect of a drag, but without a long tail of digits, in at most
/// `max_chars` characters.
fn rounded(value: f64, unit: &str, max_chars: usize) -> String {
    let decimals = match value.abs() {
        size if unit == "°" && size >= 0.01 => 2,
        size if size >= 100.0 => 2,
        size if size >= 1.0 => 3,
        size if size >= 1e-3 => 5,
        size if size == 0.0 || (unit == "°" && size < ROUNDED_ANGLE) => return "0".to_owned(),
        // All its digits would be wider than the field.
        _ => return format!("{value:.1e}"),
    };
    let plain = (0..=decimals).rev().map(|decimals: usize| {
        let text = format!("{value:.decimals$}");
        let text = match decimals {
            0 => &text,
            _ => text.trim_end_matches('0').trim_end_matches('.'),
        };
        if text == "-0" {
            "0".to_owned()
        } else {
            text.to_owned()
        }
    });
    let mut fitting = plain.filter(|text| text.len() <= max_chars);
    fitting.next().unwrap_or_else(|| format!("{value:.1e}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_comma_that_may_be_either_is_not_taken() {
        for text in ["1,000", "-2,500", "12,345", "999,999"] {
            assert_eq!(parse_expression(text), None, "{text}");
        }
        let field = coordinate("x", "");
        let message = refusal(&field, "1,000");
        assert_eq!(
            message.as_deref(),
            Some("“1,000” could mean 1.000 or 1000: write one of them")
        );
        for (text, number) in [
            ("1,5", 1.5),
            ("1,5 * 2", 3.0),
            ("0,125", 0.125),
            ("1,0000", 1.0),
            ("1234,567", 1234.567),
            ("-0,5", -0.5),
        ] {
            assert_eq!(parse_expression(text), Some(number), "{text}");
        }
    }

    #[test]
    fn numbers_stay_within_their_fields() {
        for (value, narrow, wide) in [
            (0.0, "0", "0"),
            (-0.123_456_7, "-0.1235", "-0.12346"),
            (-1234.567, "-1234.6", "-1234.57"),
            (-12_345.678, "-12346", "-12345.68"),
            (12_345_678.9, "1.2e7", "12345678.9"),
            (-123_456_789.0, "-1.2e8", "-123456789"),
            (-1.234e-10, "-1.2e-10", "-1.2e-10"),
            (100.0, "100", "100"),
            (-0.000_1, "-1.0e-4", "-1.0e-4"),
        ] {
            assert_eq!(rounded(value, "", NARROW_CHARS), narrow);
            assert_eq!(rounded(value, "", WIDE_CHARS), wide);
        }
    }
}
