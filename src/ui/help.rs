//! Help → Shortcuts: every key, from the tables that drive the window.

use egui::{Context, Grid, Label, RichText, ScrollArea, Ui, Vec2, Window, vec2};

use super::commands::{SHORTCUTS, key_name};
use super::flight_keys::{FLIGHT, MOUSE};
use super::theme::{GRID, palette};

/// Size in which all lists are visible, in points.
const SIZE: Vec2 = vec2(1180.0, 640.0);
/// Greatest width of a description, in points.
const DESCRIPTION_WIDTH: f32 = 225.0;
/// Least window width for two columns, in points.
const TWO_COLUMN_WIDTH: f32 = 745.0;
/// Least window width for two columns of full width.
const FULL_COLUMNS_WIDTH: f32 = 845.0;
/// Width of a description in narrower columns.
const NARROW_DESCRIPTION_WIDTH: f32 = 170.0;

/// Shows the list of shortcuts while `open`.
pub fn show(ctx: &Context, open: &mut bool) {
    // In a small window, the list gets as much room as there is and scrolls.
    let room = ctx.content_rect().size() - vec2(6.0, 12.0) * GRID;
    Window::new("Shortcuts")
        .open(open)
        .default_size(room.min(SIZE))
        .collapsible(false)
        .resizable(false)
        .anchor(egui::Align2::CENTER_CENTER, [0.0, 0.0])
        .show(ctx, |ui| {
            ScrollArea::both()
                .max_width(room.x)
                .max_height(room.y)
                // Keeps the scroll bar at the edge of the window.
                .auto_shrink([false, true])
                .show(ui, |ui| {
                    lists(ui, room.x);
                });
        });
}

/// Shows all lists, in as many columns as fit: in a wide window, everything is visible without scrolling.
fn lists(ui: &mut Ui, width: f32) {
    let commands = SHORTCUTS.iter().map(|shortcut| {
        let keys: Vec<String> = shortcut.keys.iter().map(|key| key_name(ui, *key)).collect();
        (keys.join(", "), shortcut.what)
    });
    let mut commands: Vec<_> = commands.collect();
    if width < TWO_COLUMN_WIDTH {
        list(ui, ("Commands", DESCRIPTION_WIDTH), commands);
        ui.add_space(2.0 * GRID);
        flying_and_mouse(ui, DESCRIPTION_WIDTH);
        return;
    }
    let is_wide = width >= SIZE.x;
    // The columns are to be about equally long.
    let first = if is_wide {
        commands.len().div_ceil(2)
    } else {
        (commands.len() + FLIGHT.len() + MOUSE.len()).div_ceil(2)
    };
    let remaining = commands.split_off(first.min(commands.len()));
    let max_width = if width < FULL_COLUMNS_WIDTH {
        NARROW_DESCRIPTION_WIDTH
    } else {
        DESCRIPTION_WIDTH
    };
    ui.horizontal_top(|ui| {
        list(ui, ("Commands", max_width), commands);
        ui.add_space(2.0 * GRID);
        let more = |ui: &mut Ui| {
            list(ui, ("More commands", max_width), remaining);
            ui.add_space(2.0 * GRID);
        };
        if is_wide {
            more(ui);
            ui.vertical(|ui| flying_and_mouse(ui, max_width));
        } else {
            ui.vertical(|ui| {
                more(ui);
                flying_and_mouse(ui, max_width);
            });
        }
    });
}

fn flying_and_mouse(ui: &mut Ui, max_width: f32) {
    let flight = FLIGHT.iter().map(|key| (key.name().to_owned(), key.what));
    list(ui, ("Flying (hold)", max_width), flight.collect());
    ui.add_space(2.0 * GRID);
    let mouse = MOUSE.iter().map(|(name, what)| ((*name).to_owned(), *what));
    list(ui, ("Mouse", max_width), mouse.collect());
}

fn list(ui: &mut Ui, (title, max_width): (&str, f32), keys: Vec<(String, &str)>) {
    ui.vertical(|ui| {
        ui.label(RichText::new(title).strong());
        ui.spacing_mut().interact_size.y = 0.0;
        Grid::new(title)
            .num_columns(2)
            .spacing([GRID, GRID / 4.0])
            .max_col_width(max_width)
            .show(ui, |ui| {
                for (key, what) in keys {
                    ui.label(
                        RichText::new(key)
                            .monospace()
                            .color(palette(ui.ctx()).accent),
                    );
                    ui.add(Label::new(what).wrap());
                    ui.end_row();
                }
            });
    });
}
