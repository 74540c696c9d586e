//! Tooltips: never while a button is down, when they would cover what is being changed.

use egui::{Rect, RectAlign, Response, Tooltip, Ui};

/// Says what a widget does while the pointer rests on it.
pub trait Hinted {
    /// Below the widget.
    fn hint(self, text: impl Into<String>) -> Self;

    /// Beside the panel that the widget is in, whose numbers stay in sight.
    fn hint_beside(&self, ui: &Ui, text: &str);
}

impl Hinted for Response {
    fn hint(self, text: impl Into<String>) -> Self {
        if self.ctx.input(|input| input.pointer.any_down()) {
            return self;
        }
        self.on_hover_text(text.into())
    }

    fn hint_beside(&self, ui: &Ui, text: &str) {
        if self.ctx.input(|input| input.pointer.any_down()) {
            return;
        }
        let beside = Rect::from_x_y_ranges(ui.clip_rect().x_range(), self.rect.y_range());
        let mut tooltip = Tooltip::for_enabled(self);
        tooltip.popup = tooltip.popup.anchor(beside).align(RectAlign::LEFT_START);
        tooltip.show(|ui| {
            ui.set_max_width(ui.spacing().tooltip_width);
            ui.label(text);
        });
    }
}
