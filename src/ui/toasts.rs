//! Messages in the lower right corner of the picture: notices stay until read, errors until dismissed.

use egui::{Align2, Area, Context, Frame, Id, Margin, Rect, RichText, ScrollArea, Stroke, vec2};

use super::icons;
use super::theme::{GRID, ROW, palette};
use crate::editor::Message;

/// Lifetime of messages that are not errors, in seconds: the base, the reading time per character, and the maximum.
const BASE_LIFETIME: f64 = 4.0;
const SECONDS_PER_CHARACTER: f64 = 0.06;
const MAX_LIFETIME: f64 = 30.0;
/// Width of a message in points: the excerpt of a refused file fits in.
const WIDTH: f32 = 560.0;
/// Least width of a message that makes room for a window, and the width left free for margins and gaps, in points.
const MIN_WIDTH: f32 = 200.0;
const SIDE_MARGINS: f32 = 6.0 * GRID;
/// Greatest height of a message's sentence, as a share of the window's height.
const MAX_HEIGHT_SHARE: f32 = 0.25;
/// Most messages on screen; older ones are removed.
const MAX_TOASTS: usize = 3;

/// The messages on screen.
#[derive(Debug, Default)]
pub struct Toasts {
    shown: Vec<Toast>,
}

#[derive(Debug)]
struct Toast {
    message: Message,
    /// Time at which it appeared, in seconds on the clock of `Context`.
    since: f64,
}

impl Toast {
    /// Time at which it disappears by itself.
    fn end(&self) -> f64 {
        let reading = SECONDS_PER_CHARACTER * self.message.text.chars().count() as f64;
        self.since + (BASE_LIFETIME + reading).min(MAX_LIFETIME)
    }
}

impl Toasts {
    /// Shows messages. One that is already shown is renewed; one without text removes those about the same subject.
    pub fn push(&mut self, ctx: &Context, messages: Vec<Message>) {
        let since = ctx.input(|input| input.time);
        for message in messages {
            if message.text.is_empty() {
                self.shown
                    .retain(|toast| toast.message.about != message.about);
                continue;
            }
            self.shown.retain(|toast| toast.message != message);
            self.shown.push(Toast { message, since });
        }
        while self.shown.len() > MAX_TOASTS {
            // Errors stay until they are dismissed, if possible, but the newest message is always shown.
            let mut older = self.shown[..MAX_TOASTS].iter();
            let oldest = older.position(|toast| !toast.message.is_error);
            self.shown.remove(oldest.unwrap_or(0));
        }
    }

    /// Draws the messages at the lower edge of the picture area, beside `window` if there is room.
    pub fn show(&mut self, ctx: &Context, area: Rect, window: Option<Rect>) {
        let now = ctx.input(|input| input.time);
        self.shown
            .retain(|toast| toast.message.is_error || now < toast.end());
        let next = self
            .shown
            .iter()
            .filter(|toast| !toast.message.is_error)
            .map(|toast| toast.end() - now);
        if let Some(seconds) = next.reduce(f64::min) {
            ctx.request_repaint_after_secs(seconds as f32);
        }
        let window_area = ctx.content_rect();
        // In a small picture, they would cover the panel on the left.
        let max_width = WIDTH.min(area.width() - 4.0 * GRID).max(MIN_WIDTH);
        let room_beside =
            |right: f32| window.map_or(max_width, |window| right - window.right() - SIDE_MARGINS);
        // If the picture has no room beside the window, the messages may cover the panel on the right.
        let mut corner = area.max;
        if room_beside(corner.x) < MIN_WIDTH && room_beside(window_area.right()) >= MIN_WIDTH {
            corner.x = window_area.right();
        }
        let room = room_beside(corner.x);
        let width = if room < MIN_WIDTH {
            max_width
        } else {
            room.min(max_width)
        };
        let mut height = 2.0 * GRID;
        let mut dismissed = None;
        for (index, toast) in self.shown.iter().enumerate().rev() {
            let shown = Area::new(Id::unique(("toast", index)))
                .pivot(Align2::RIGHT_BOTTOM)
                .fixed_pos(corner - vec2(2.0 * GRID, height))
                .order(egui::Order::Foreground)
                .show(ctx, |ui| draw(ui, width, &toast.message));
            if shown.inner {
                dismissed = Some(index);
            }
            height += shown.response.rect.height() + GRID;
        }
        if let Some(index) = dismissed {
            self.shown.remove(index);
        }
    }
}

/// Draws one message of this width. Returns whether it was dismissed.
fn draw(ui: &mut egui::Ui, width: f32, message: &Message) -> bool {
    let colors = palette(ui.ctx());
    let (icon, color, border) = if message.is_error {
        (icons::ERROR, colors.error, colors.error)
    } else {
        (icons::INFO, colors.accent, colors.line)
    };
    let frame = Frame::new()
        .fill(colors.raised)
        .stroke(Stroke::new(1.0, border))
        .corner_radius(4)
        .inner_margin(Margin::same(10));
    frame
        .show(ui, |ui| {
            ui.set_width(width);
            // A single line is centred on the buttons beside it.
            let padding = (ROW - ui.text_style_height(&egui::TextStyle::Body)) / 2.0;
            ui.horizontal_top(|ui| {
                ui.vertical(|ui| {
                    ui.add_space(padding);
                    ui.label(icons::text(icon).color(color));
                });
                ui.vertical(|ui| {
                    ui.add_space(padding);
                    ui.set_width(ui.available_width() - 2.0 * ROW - 2.0 * GRID);
                    body(ui, &message.text);
                });
                if icons::button(ui, icons::COPY, "Copy message").clicked() {
                    ui.copy_text(message.text.clone());
                }
                icons::button(ui, icons::CLOSE, "Dismiss").clicked()
            })
            .inner
        })
        .inner
}

/// Shows a message: a wrapped sentence and, below it, an excerpt that must keep its columns, such as the line and the
/// caret of a refused file.
fn body(ui: &mut egui::Ui, text: &str) {
    let (sentence, excerpt) = text.split_once('\n').unwrap_or((text, ""));
    // A long quotation scrolls instead of hiding the picture.
    let height = ui.ctx().content_rect().height() * MAX_HEIGHT_SHARE;
    let area = ScrollArea::vertical()
        .id_salt("sentence")
        .max_height(height);
    area.show(ui, |ui| {
        ui.add(egui::Label::new(sentence).wrap().selectable(true))
    });
    if !excerpt.is_empty() {
        ScrollArea::horizontal().show(ui, |ui| {
            ui.add(
                egui::Label::new(RichText::new(excerpt).monospace())
                    .extend()
                    .selectable(true),
            );
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_stay_and_the_newest_is_seen() {
        let (ctx, mut toasts) = (Context::default(), Toasts::default());
        let mut push = |text: &str, is_error: bool| {
            let (text, about) = (text.to_owned(), "");
            let message = Message {
                is_error,
                text,
                about,
            };
            toasts.push(&ctx, vec![message]);
            let shown = toasts.shown.iter().map(|toast| &*toast.message.text);
            shown.collect::<Vec<_>>().join(" ")
        };
        push("a", true);
        push("b", false);
        assert_eq!(push("c", false), "a b c");
        assert_eq!(push("d", false), "a c d", "the error stays");
        push("e", true);
        assert_eq!(push("f", true), "a e f");
        assert_eq!(push("g", false), "e f g", "there is room for the newest");
    }
}
