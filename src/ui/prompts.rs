//! The questions over the window: about unsaved changes, about quitting, and for a path where the
//! desktop offers no dialog.

use std::path::{Path, PathBuf};

use egui::{Button, Context, Frame, Id, Key, Modal, RichText, TextEdit, Ui};

use super::dialogs::Ask;
use super::theme::{GRID, palette};

/// What the user said.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answer {
    /// Nothing yet.
    Open,
    /// The primary button.
    Yes,
    /// The other way to go on.
    No,
    /// A third one.
    Other,
    /// Not at all.
    Cancel,
}

/// Asks what becomes of unsaved changes: saved, lost, or neither.
pub fn ask_about_changes(ctx: &Context, title: &str) -> Answer {
    question(ctx, "unsaved changes", 380.0, |ui, answer| {
        ui.heading(format!("Save changes to {title}?"));
        ui.add_space(GRID);
        ui.label("Without saving, the changes since the last save are lost.");
        ui.add_space(2.0 * GRID);
        ui.horizontal(|ui| {
            if primary(ui, "Save changes").clicked() {
                *answer = Answer::Yes;
            }
            if ui.button("Don't save").clicked() {
                *answer = Answer::No;
            }
            if ui.button("Keep editing").clicked() {
                *answer = Answer::Cancel;
            }
        });
    })
}

/// Asks whether quitting is meant.
pub fn ask_to_quit(ctx: &Context) -> Answer {
    question(ctx, "quit", 160.0, |ui, answer| {
        ui.heading("Quit Glint?");
        ui.add_space(2.0 * GRID);
        ui.horizontal(|ui| {
            let entered = ui.input(|input| input.key_pressed(Key::Enter));
            if primary(ui, "Quit now").clicked() || entered {
                *answer = Answer::Yes;
            }
            if ui.button("Stay").clicked() {
                *answer = Answer::Cancel;
            }
        });
    })
}

/// Asks whether exports that are going on are to be given up: Yes to stay, No to leave.
pub fn ask_to_leave(ctx: &Context, going: &str) -> Answer {
    question(ctx, "exports", 380.0, |ui, answer| {
        ui.heading("Quit while exporting?");
        ui.add_space(GRID);
        ui.label(format!(
            "Going on: {going}. What is done stays, and exporting again goes on from there."
        ));
        ui.add_space(2.0 * GRID);
        ui.horizontal(|ui| {
            let entered = ui.input(|input| input.key_pressed(Key::Enter));
            if primary(ui, "Stay").clicked() || entered {
                *answer = Answer::Yes;
            }
            if ui.button("Quit now").clicked() {
                *answer = Answer::No;
            }
        });
    })
}

/// A path that is being typed.
pub struct PathPrompt {
    ask: Ask,
    text: String,
    is_new: bool,
}

impl PathPrompt {
    /// Starts from a path that is likely meant.
    pub fn new(ask: Ask, suggested: &Path) -> Self {
        Self {
            ask,
            text: suggested.display().to_string(),
            is_new: true,
        }
    }

    /// The path that was typed, with `~` for the home folder and the ending that files have.
    pub fn path(&self) -> PathBuf {
        let text = self.text.trim();
        let path = match (text.strip_prefix("~/"), std::env::home_dir()) {
            (Some(rest), Some(home)) => home.join(rest),
            _ => PathBuf::from(text),
        };
        self.ask.with_ending(path)
    }

    /// Draws the prompt.
    pub fn show(&mut self, ctx: &Context) -> Answer {
        question(ctx, "path prompt", 480.0, |ui, answer| {
            ui.heading(self.ask.title());
            ui.add_space(GRID);
            let label = ui.weak("Path (this desktop offers no file dialog)");
            let field = TextEdit::singleline(&mut self.text).desired_width(f32::INFINITY);
            let field = ui.add(field).labelled_by(label.id);
            if self.is_new {
                field.request_focus();
                self.is_new = false;
            }
            let warning = self.warning().unwrap_or_default();
            ui.colored_label(palette(ui.ctx()).accent, warning);
            ui.add_space(GRID);
            ui.horizontal(|ui| {
                let entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
                let word = if self.ask.writes() {
                    "Save file"
                } else {
                    "Open file"
                };
                let is_done = primary(ui, word).clicked() || entered;
                if is_done && !self.text.trim().is_empty() {
                    *answer = Answer::Yes;
                }
                if ui.button("Cancel").clicked() {
                    *answer = Answer::Cancel;
                }
            });
        })
    }

    fn warning(&self) -> Option<String> {
        let path = self.path();
        match (self.ask.writes(), path.is_file()) {
            (true, true) => Some(format!("Replaces {}", path.display())),
            (false, false) if !self.text.ends_with('/') => {
                Some(format!("There is no {}", path.display()))
            }
            _ => None,
        }
    }
}

/// A question over the window, which Escape answers with [`Answer::Cancel`].
pub fn question(
    ctx: &Context,
    name: &str,
    width: f32,
    add: impl FnOnce(&mut Ui, &mut Answer),
) -> Answer {
    let mut answer = Answer::Open;
    let frame = Frame::popup(&ctx.global_style()).inner_margin(2.0 * GRID);
    let modal = Modal::new(Id::unique(name)).frame(frame).show(ctx, |ui| {
        ui.set_width(width);
        add(ui, &mut answer);
    });
    if answer == Answer::Open && modal.should_close() {
        answer = Answer::Cancel;
    }
    answer
}

/// The button that is meant to be pressed.
pub fn primary(ui: &mut Ui, text: &str) -> egui::Response {
    let colors = palette(ui.ctx());
    ui.add(Button::new(RichText::new(text).color(colors.on_accent)).fill(colors.accent))
}
