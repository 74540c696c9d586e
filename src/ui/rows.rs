//! The rows of the inspector: label left, value right. Every number drags, types and steps; a
//! double-click on its label brings the default back; vectors paste as `1, 2, 3`.

use std::cell::Cell;
use std::ops::RangeInclusive;

use egui::{Align, ComboBox, DragValue, Key, Label, Layout, Response, RichText, Sense, Ui, vec2};

use glam::DVec3;

use super::theme::{GRID, HEX, LABEL, ROW};
use crate::scene::{format_number, parse_vec3};

/// What a number may be, and what is said about it.
#[derive(Clone, Debug)]
pub struct Field {
    /// Label, and accessible name of the value.
    pub name: &'static str,
    /// Tooltip: meaning and range.
    pub hint: &'static str,
    /// Behind the number.
    pub unit: &'static str,
    /// What a double-click on the label brings back.
    pub default: f64,
    /// Values outside are pulled to its ends.
    pub range: RangeInclusive<f64>,
    /// Change per point of dragging; `None` follows the value's size.
    pub speed: Option<f64>,
}

/// A number without bounds, for positions.
pub fn coordinate(name: &'static str, hint: &'static str) -> Field {
    Field {
        name,
        hint,
        unit: "",
        default: 0.0,
        range: -1e12..=1e12,
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

/// A stack of rows that remembers which field was changed.
pub struct Rows<'u> {
    /// Where the rows go.
    pub ui: &'u mut Ui,
    changed: Option<&'static str>,
}

impl<'u> Rows<'u> {
    /// No rows yet.
    pub fn new(ui: &'u mut Ui) -> Self {
        Self { ui, changed: None }
    }

    /// The field that changed in this frame, if one did.
    pub fn changed(&self) -> Option<&'static str> {
        self.changed
    }

    fn note(&mut self, name: &'static str, changed: bool) {
        if changed {
            self.changed = Some(name);
        }
    }

    /// A title above rows.
    pub fn heading(&mut self, text: &str) {
        self.ui.add_space(GRID);
        self.ui.label(RichText::new(text).strong());
    }

    /// A number.
    pub fn number(&mut self, field: &Field, value: &mut f64) {
        let before = *value;
        row(
            self.ui,
            field,
            &format_number(field.default),
            |ui, reset| {
                if reset {
                    *value = field.default;
                }
                let number = Number {
                    field,
                    name: field.name,
                    width: ui.available_width(),
                    pasted: None,
                };
                drag(ui, &number, value);
            },
        );
        self.note(field.name, *value != before);
    }

    /// Three numbers in one row.
    pub fn vector(&mut self, field: &Field, default: DVec3, value: &mut DVec3) {
        let before = *value;
        row(self.ui, field, &format_vec3(default), |ui, reset| {
            if reset {
                *value = default;
            }
            let pasted = Cell::new(None);
            let width = (ui.available_width() - 2.0 * ui.spacing().item_spacing.x) / 3.0;
            for (axis, part) in [
                ("x", &mut value.x),
                ("y", &mut value.y),
                ("z", &mut value.z),
            ] {
                let name = format!("{} {axis}", field.name);
                let number = Number {
                    field,
                    name: &name,
                    width,
                    pasted: Some(&pasted),
                };
                drag(ui, &number, part);
            }
            if let Some(whole) = pasted.get() {
                *value = whole;
            }
        });
        self.note(field.name, *value != before);
    }

    /// A colour: a swatch that opens a picker, and its channels 0–255.
    pub fn color(
        &mut self,
        name: &'static str,
        hint: &'static str,
        default: DVec3,
        value: &mut DVec3,
    ) {
        let before = *value;
        let field = Field {
            name,
            hint,
            unit: "",
            default: 0.0,
            range: 0.0..=255.0,
            speed: Some(1.0),
        };
        row(self.ui, &field, &format_vec3(default), |ui, reset| {
            if reset {
                *value = default;
            }
            ui.spacing_mut().interact_size.x = ROW;
            swatch(ui, name, value);
            let gaps = 3.0 * ui.spacing().item_spacing.x;
            let width = (ui.available_width() - HEX - gaps) / 3.0;
            let pasted = Cell::new(None);
            for (channel, part) in [
                ("red", &mut value.x),
                ("green", &mut value.y),
                ("blue", &mut value.z),
            ] {
                let name = format!("{name} {channel}");
                let number = Number {
                    field: &field,
                    name: &name,
                    width,
                    pasted: Some(&pasted),
                };
                drag(ui, &number, part);
            }
            if let Some(whole) = pasted.get() {
                *value = whole.clamp(DVec3::ZERO, DVec3::splat(255.0));
            }
            hex(ui, name, value);
        });
        self.note(name, *value != before);
    }

    /// A tick box.
    pub fn toggle(&mut self, name: &'static str, hint: &str, value: &mut bool) {
        let changed = labelled(self.ui, name, hint, |ui, label| {
            ui.checkbox(value, "")
                .labelled_by(label.id)
                .on_hover_text(hint)
                .changed()
        });
        self.note(name, changed);
    }

    /// One of some words.
    pub fn choice<T: PartialEq>(
        &mut self,
        name: &'static str,
        hint: &str,
        value: &mut T,
        options: impl IntoIterator<Item = (T, String)>,
    ) {
        let options: Vec<(T, String)> = options.into_iter().collect();
        let shown = options
            .iter()
            .find(|(option, _)| option == value)
            .map_or("", |(_, word)| word);
        let shown = shown.to_owned();
        let chosen = labelled(self.ui, name, hint, |ui, label| {
            let combo = ComboBox::from_id_salt(name)
                .width(ui.available_width())
                .truncate();
            let opened = combo.selected_text(shown).show_ui(ui, |ui| {
                let is_on = |option: &T| option == value;
                options
                    .into_iter()
                    .filter_map(|(option, word)| {
                        let on = is_on(&option);
                        ui.selectable_label(on, word).clicked().then_some(option)
                    })
                    .last()
            });
            opened.response.labelled_by(label.id).on_hover_text(hint);
            opened.inner.flatten()
        });
        if let Some(option) = chosen {
            let changed = option != *value;
            *value = option;
            self.note(name, changed);
        }
    }
}

/// A row whose label resets it.
fn row(ui: &mut Ui, field: &Field, default: &str, add: impl FnOnce(&mut Ui, bool)) {
    let hint = format!(
        "{}\nDouble-click: back to {default}{}",
        field.hint, field.unit
    );
    labelled(ui, field.name, &hint, |ui, label| {
        let reset = label.double_clicked();
        add(ui, reset);
    });
}

/// A label of fixed width, then the rest of the row.
fn labelled<T>(
    ui: &mut Ui,
    name: &str,
    hint: &str,
    add: impl FnOnce(&mut Ui, &Response) -> T,
) -> T {
    ui.horizontal(|ui| {
        let layout = Layout::left_to_right(Align::Center);
        let label = ui.allocate_ui_with_layout(vec2(LABEL, ROW), layout, |ui| {
            ui.set_min_width(LABEL);
            ui.add(
                Label::new(RichText::new(name).weak())
                    .truncate()
                    .sense(Sense::click()),
            )
        });
        let label = label.inner.on_hover_text(hint);
        // Narrow fields keep their digits clear of their borders, and no more.
        ui.spacing_mut().button_padding.x = GRID / 2.0;
        add(ui, &label)
    })
    .inner
}

/// How a draggable number looks and what it takes.
struct Number<'a> {
    field: &'a Field,
    /// What it is called; the field may have several.
    name: &'a str,
    width: f32,
    /// Where three numbers go that are typed at once: a whole vector.
    pasted: Option<&'a Cell<Option<DVec3>>>,
}

/// One draggable number.
fn drag(ui: &mut Ui, number: &Number, value: &mut f64) {
    let Number {
        field,
        name,
        width,
        pasted,
    } = *number;
    let by_size = || (value.abs() * 0.01).max(0.01);
    let speed = field.speed.unwrap_or_else(by_size);
    let parser = |text: &str| {
        let text = text.trim().trim_end_matches(field.unit);
        if let (Some(pasted), Some(whole)) = (pasted, parse_vec3(text)) {
            pasted.set(Some(whole));
            return Some(whole.x);
        }
        text.trim().parse().ok()
    };
    let mut edited = *value;
    let widget = DragValue::new(&mut edited)
        .speed(speed)
        .range(field.range.clone())
        .clamp_existing_to_range(false)
        .update_while_editing(false)
        .custom_formatter(|number, _| rounded(number, field.unit))
        .suffix(field.unit)
        .clip_text(true)
        .custom_parser(parser);
    let response = ui
        .add_sized([width.max(8.0), ROW], widget)
        .accessible_name(name);
    // Formatting rounds what is shown; only a change by hand may reach the scene.
    let is_cancelled = is_cancelled(ui, &response);
    // A field that is left as it was entered gives back what it showed.
    let is_as_shown =
        !response.dragged() && rounded(edited, field.unit) == rounded(*value, field.unit);
    if response.changed() && edited.is_finite() && !is_cancelled && !is_as_shown {
        *value = edited.clamp(*field.range.start(), *field.range.end());
    }
    response.on_hover_text(field.hint);
}

fn format_vec3(v: DVec3) -> String {
    v.to_array().map(format_number).join(", ")
}

/// Whether the field was left with Escape, which gives what was typed up. A field counts as left
/// for two frames, and in the second the key is gone: the first is remembered.
fn is_cancelled(ui: &Ui, response: &Response) -> bool {
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

/// The number with enough decimals to see what dragging changes, without a tail of digits.
fn rounded(value: f64, unit: &str) -> String {
    let decimals = match value.abs() {
        _ if unit == "°" => 2,
        size if size >= 100.0 => 2,
        size if size >= 1.0 => 3,
        size if size >= 1e-3 => 5,
        0.0 => return "0".to_owned(),
        // All its digits would be wider than the field.
        _ => return format!("{value:.2e}"),
    };
    let text = format!("{value:.decimals$}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" {
        "0".to_owned()
    } else {
        text.to_owned()
    }
}

fn swatch(ui: &mut Ui, name: &str, value: &mut DVec3) {
    let mut bytes = to_bytes(*value);
    let response = ui
        .color_edit_button_srgb(&mut bytes)
        .accessible_name(format!("{name} swatch"));
    // The button writes rounded colours back in every frame; only a pick counts.
    if response.changed() {
        *value = DVec3::from(bytes.map(f64::from));
    }
}

/// The colour as `#RRGGBB`, to copy and to type.
fn hex(ui: &mut Ui, name: &str, value: &mut DVec3) {
    let [r, g, b] = to_bytes(*value);
    let packed = f64::from(u32::from_be_bytes([0, r, g, b]));
    let mut edited = packed;
    let widget = DragValue::new(&mut edited)
        .speed(0.0)
        .update_while_editing(false)
        .custom_formatter(|number, _| format!("#{:06X}", number as u32))
        .custom_parser(|text| parse_hex(text).map(f64::from));
    let response = ui
        .add_sized([HEX, ROW], widget)
        .accessible_name(format!("{name} hex"));
    let is_cancelled = is_cancelled(ui, &response);
    if response.changed() && edited != packed && !is_cancelled {
        let [_, r, g, b] = (edited as u32).to_be_bytes();
        *value = DVec3::new(f64::from(r), f64::from(g), f64::from(b));
    }
    response.on_hover_text("Click to type or copy, for example #FF8040");
}

fn parse_hex(text: &str) -> Option<u32> {
    let digits = text.trim().trim_start_matches('#');
    (digits.len() == 6)
        .then(|| u32::from_str_radix(digits, 16).ok())
        .flatten()
}

fn to_bytes(color: DVec3) -> [u8; 3] {
    color.to_array().map(|channel| channel.round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hex_colours_are_read_with_or_without_hash() {
        assert_eq!(parse_hex("#FF8040"), Some(0x00FF_8040));
        assert_eq!(parse_hex(" ff8040 "), Some(0x00FF_8040));
        for text in ["", "#FFF", "#GG8040", "#FF804000"] {
            assert_eq!(parse_hex(text), None, "{text}");
        }
    }
}
