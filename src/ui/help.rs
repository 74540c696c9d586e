//! Help → Shortcuts: every key, from the tables that drive the window.

use egui::{Context, Grid, RichText, Ui, Window};

use super::commands::{FLIGHT, MOUSE, SHORTCUTS};
use super::theme::{GRID, palette};

/// Shows the list while `open`.
pub fn show(ctx: &Context, open: &mut bool) {
    Window::new("Shortcuts")
        .open(open)
        .collapsible(false)
        .resizable(false)
        .anchor(egui::Align2::CENTER_CENTER, [0.0, 0.0])
        .show(ctx, |ui| {
            ui.horizontal_top(|ui| {
                let commands = SHORTCUTS.iter().map(|shortcut| {
                    let keys: Vec<String> = shortcut
                        .keys
                        .iter()
                        .map(|key| ui.format_shortcut(key))
                        .collect();
                    (keys.join(", "), shortcut.what)
                });
                let commands: Vec<_> = commands.collect();
                list(ui, "Commands", commands);
                ui.add_space(3.0 * GRID);
                ui.vertical(|ui| {
                    let flight = FLIGHT.iter().map(|key| (key.name().to_owned(), key.what));
                    list(ui, "Flying (hold)", flight.collect());
                    ui.add_space(2.0 * GRID);
                    let mouse = MOUSE.iter().map(|(name, what)| ((*name).to_owned(), *what));
                    list(ui, "Mouse in the picture", mouse.collect());
                });
            });
        });
}

fn list(ui: &mut Ui, title: &str, keys: Vec<(String, &str)>) {
    ui.vertical(|ui| {
        ui.label(RichText::new(title).strong());
        Grid::new(title)
            .num_columns(2)
            .spacing([2.0 * GRID, GRID / 2.0])
            .show(ui, |ui| {
                for (key, what) in keys {
                    ui.label(
                        RichText::new(key)
                            .monospace()
                            .color(palette(ui.ctx()).accent),
                    );
                    ui.label(what);
                    ui.end_row();
                }
            });
    });
}
