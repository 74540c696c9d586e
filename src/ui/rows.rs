//! The rows of the inspector: label left, value right. Every number can be dragged, typed and stepped; a double-click
//! on its label restores the default; vectors can be pasted as `1, 2, 3`.

use std::cell::Cell;

use egui::{
    Align, ComboBox, DragValue, Label, Layout, Response, RichText, Sense, Stroke, StrokeKind, Ui,
    vec2,
};

use glam::DVec3;

use super::hint::Hinted as _;
pub use super::number::{Field, coordinate, fraction};
use super::number::{Number, drag, is_cancelled, note_refusal};
use super::theme::{GRID, HEX, LABEL, ROW, palette};
use crate::scene::format_number;
use crate::words::quoted;

/// A stack of rows that remembers which field was changed.
pub struct FieldRows<'u> {
    /// Where the rows go.
    pub ui: &'u mut Ui,
    changed: Option<&'static str>,
    chosen: Option<EditedPart>,
}

/// A value that the user chose in this frame, even if it was the same before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EditedPart {
    /// The field.
    pub field: &'static str,
    /// Index of one of three numbers; `None` for all of them, or for a single value.
    pub part: Option<usize>,
}

impl<'u> FieldRows<'u> {
    /// Creates a stack without rows.
    pub fn new(ui: &'u mut Ui) -> Self {
        let (changed, chosen) = (None, None);
        Self {
            ui,
            changed,
            chosen,
        }
    }

    /// Returns the field that changed in this frame, if any.
    pub fn changed(&self) -> Option<&'static str> {
        self.changed
    }

    /// Returns what was chosen in this frame, if anything: picked, confirmed with Enter, or reset.
    pub fn chosen(&self) -> Option<EditedPart> {
        self.chosen
    }

    fn note_change(&mut self, name: &'static str, changed: bool) {
        if changed {
            self.changed = Some(name);
        }
    }

    /// Adds a title above rows.
    pub fn heading(&mut self, text: &str) {
        self.ui.add_space(GRID);
        self.ui.label(RichText::new(text).strong());
    }

    /// Adds a row with a number.
    pub fn number(&mut self, field: &Field, value: &mut f64) {
        let (before, mut is_chosen) = (*value, false);
        // Computed defaults have more digits than anybody reads.
        let default = match field.default {
            small if small.abs() < 1.0 => small,
            default => (default * 1e4).round() / 1e4,
        };
        row(self.ui, field, &format_number(default), |ui, reset| {
            if reset {
                *value = field.default;
            }
            let number = Number {
                field,
                name: field.name,
                width: ui.available_width(),
                size: 0.0,
                pasted: None,
                axis: None,
            };
            is_chosen = drag(ui, &number, value) || reset;
        });
        self.note_change(field.name, *value != before);
        if is_chosen {
            let (field, part) = (field.name, None);
            self.chosen = Some(EditedPart { field, part });
        }
    }

    /// Adds a row with three numbers.
    pub fn vector(&mut self, field: &Field, default: DVec3, value: &mut DVec3) {
        let (before, mut chosen) = (*value, None);
        row(self.ui, field, &format_vec3(default), |ui, reset| {
            let part_of = |part| EditedPart {
                field: field.name,
                part,
            };
            if reset {
                *value = default;
                chosen = Some(part_of(None));
            }
            let pasted = Cell::new(None);
            let width = (ui.available_width() - 2.0 * ui.spacing().item_spacing.x) / 3.0;
            let parts = [
                ("x", &mut value.x),
                ("y", &mut value.y),
                ("z", &mut value.z),
            ];
            let colors = palette(ui.ctx()).axis_letters;
            let size = before.abs().max_element();
            for (index, ((axis, part), color)) in parts.into_iter().zip(colors).enumerate() {
                let name = format!("{} {axis}", field.name);
                let number = Number {
                    field,
                    name: &name,
                    width,
                    size,
                    pasted: Some(&pasted),
                    axis: Some((axis, color)),
                };
                if drag(ui, &number, part) {
                    chosen = Some(part_of(Some(index)));
                }
            }
            if let Some(whole) = pasted.get() {
                *value = whole;
                chosen = Some(part_of(None));
            }
        });
        self.note_change(field.name, *value != before);
        self.chosen = chosen.or(self.chosen);
    }

    /// Adds a row with a colour: a swatch that opens a picker, and channels 0–255, each with a name of its own.
    pub fn color(
        &mut self,
        (name, channels): (&'static str, [&'static str; 3]),
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
        let (mut changed, mut chosen) = (name, None);
        let whole_color = EditedPart {
            field: name,
            part: None,
        };
        row(self.ui, &field, &format_vec3(default), |ui, reset| {
            if reset {
                *value = default;
                chosen = Some(whole_color);
            }
            ui.spacing_mut().interact_size.x = ROW;
            swatch(ui, name, value);
            let gaps = 3.0 * ui.spacing().item_spacing.x;
            let width = (ui.available_width() - HEX - gaps) / 3.0;
            let pasted = Cell::new(None);
            let parts = [&mut value.x, &mut value.y, &mut value.z];
            for (index, (name, part)) in channels.into_iter().zip(parts).enumerate() {
                let previous = *part;
                let number = Number {
                    field: &field,
                    name,
                    width,
                    size: 0.0,
                    pasted: Some(&pasted),
                    axis: None,
                };
                if drag(ui, &number, part) {
                    let part = Some(index);
                    chosen = Some(EditedPart { field: name, part });
                }
                if *part != previous {
                    changed = name;
                }
            }
            if let Some(whole) = pasted.get() {
                (*value, changed, chosen) = (whole, name, Some(whole_color));
            }
            let previous = *value;
            hex_field(ui, name, value);
            if *value != previous {
                changed = name;
            }
        });
        self.note_change(changed, *value != before);
        self.chosen = chosen.or(self.chosen);
    }

    /// Adds a row with a tick box.
    pub fn toggle(&mut self, name: &'static str, hint: &str, value: &mut bool) {
        let changed = labelled(self.ui, name, hint, |ui, label| {
            let tick = ui.checkbox(value, "").labelled_by(label.id);
            tick.hint_beside(ui, hint);
            tick.changed()
        });
        self.note_change(name, changed);
    }

    /// Adds a row with a choice among named options.
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
            opened.response.labelled_by(label.id).hint_beside(ui, hint);
            opened.inner.flatten()
        });
        if let Some(option) = chosen {
            let changed = option != *value;
            *value = option;
            self.note_change(name, changed);
            let part = None;
            self.chosen = Some(EditedPart { field: name, part });
        }
    }
}

/// The name of a colour, and those of its channels.
macro_rules! color_names {
    ($name:literal) => {
        (
            $name,
            [
                concat!($name, " red"),
                concat!($name, " green"),
                concat!($name, " blue"),
            ],
        )
    };
}
pub(crate) use color_names;

/// Returns whether this is the name of a colour's channel.
pub fn is_channel(name: &str) -> bool {
    let (_, suffixes) = color_names!("");
    suffixes.iter().any(|end| name.ends_with(end))
}

/// Shows a row whose label resets it.
fn row(ui: &mut Ui, field: &Field, default: &str, add: impl FnOnce(&mut Ui, bool)) {
    let hint = format!(
        "{}\nDouble-click: reset to {default}{}",
        field.hint, field.unit
    );
    labelled(ui, field.name, &hint, |ui, label| {
        let reset = label.double_clicked();
        add(ui, reset);
    });
}

/// Shows a label of fixed width, then the rest of the row.
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
                    // Tab skips it and goes to the value.
                    .sense(Sense::CLICK),
            )
        });
        let label = label.inner;
        label.hint_beside(ui, hint);
        // Just enough to keep the digits of narrow fields clear of the borders.
        ui.spacing_mut().button_padding.x = GRID / 2.0;
        add(ui, &label)
    })
    .inner
}

fn format_vec3(v: DVec3) -> String {
    v.to_array().map(format_number).join(", ")
}

fn swatch(ui: &mut Ui, name: &str, value: &mut DVec3) {
    let mut bytes = to_bytes(*value);
    let response = ui
        .color_edit_button_srgb(&mut bytes)
        .accessible_name(format!("{name} swatch"));
    // Without a border, a swatch of the panel's colour would be invisible.
    let line = Stroke::new(1.0, palette(ui.ctx()).line);
    ui.painter()
        .rect_stroke(response.rect, 2, line, StrokeKind::Inside);
    // The button writes rounded colours back in every frame; only a pick counts.
    if response.changed() {
        *value = DVec3::from(bytes.map(f64::from));
    }
}

/// Shows the colour as `#RRGGBB`, to copy and to type.
fn hex_field(ui: &mut Ui, name: &str, value: &mut DVec3) {
    let [r, g, b] = to_bytes(*value);
    let packed = f64::from(u32::from_be_bytes([0, r, g, b]));
    let mut edited = packed;
    let refused = Cell::new(None);
    let widget = DragValue::new(&mut edited)
        .speed(0.0)
        .update_while_editing(false)
        .clip_text(true)
        .custom_formatter(|number, _| format!("#{:06X}", number as u32))
        .custom_parser(|text| {
            let color = parse_hex(text);
            let words = || format!("{} is not a color: write it like #FF8040", quoted(text));
            let is_wrong = color.is_none() && !text.trim().is_empty();
            refused.set(is_wrong.then(words));
            color.map(f64::from)
        });
    let response = ui
        .add_sized([HEX, ROW], widget)
        .accessible_name(format!("{name} hex"));
    let is_cancelled = is_cancelled(ui, &response);
    note_refusal(&response, is_cancelled, refused.take());
    if response.changed() && edited != packed && !is_cancelled {
        let [_, r, g, b] = (edited as u32).to_be_bytes();
        *value = DVec3::new(f64::from(r), f64::from(g), f64::from(b));
    }
    response.hint_beside(ui, "Click to type or copy, for example #FF8040");
}

/// Parses six hexadecimal digits, or three, of which each counts twice.
fn parse_hex(text: &str) -> Option<u32> {
    let digits = text.trim().trim_start_matches('#');
    if !digits.bytes().all(|digit| digit.is_ascii_hexdigit()) {
        return None; // `from_str_radix` would accept a sign.
    }
    let number = u32::from_str_radix(digits, 16).ok()?;
    match digits.len() {
        6 => Some(number),
        3 => Some(((number & 0xF00) << 8 | (number & 0xF0) << 4 | number & 0xF) * 0x11),
        _ => None,
    }
}

/// Returns the channels of a colour, rounded and clamped to 0–255.
pub fn to_bytes(color: DVec3) -> [u8; 3] {
    color.to_array().map(|channel| channel.round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hex_colours_are_read_with_or_without_hash() {
        assert_eq!(parse_hex("#FF8040"), Some(0x00FF_8040));
        assert_eq!(parse_hex(" ff8040 "), Some(0x00FF_8040));
        assert_eq!(parse_hex("#0fA"), Some(0x0000_FFAA));
        for text in ["", "#FFFF", "#GG8040", "#FF804000", "#+12345", "#+12"] {
            assert_eq!(parse_hex(text), None, "{text}");
        }
    }
}
