//! Tooltips. They are never shown while a button is down, when they would cover what is being changed.

use egui::{Rect, RectAlign, Response, Tooltip, Ui};

use crate::words::capitalised;

/// Explains a widget while the pointer rests on it.
pub trait Hinted {
    /// Shows a tooltip below the widget.
    fn hint(self, text: impl Into<String>) -> Self;

    /// Shows what a widget does, or the obstacle for which it is disabled.
    fn hint_unless(self, obstacle: Option<&str>, text: impl Into<String>) -> Self
    where
        Self: Sized,
    {
        match obstacle {
            Some(why) => self.hint(capitalised(why)),
            None => self.hint(text),
        }
    }

    /// Shows a tooltip next to the panel that contains the widget, so that the panel's numbers stay visible.
    fn hint_beside(&self, ui: &Ui, text: &str);
}

impl Hinted for Response {
    fn hint(self, text: impl Into<String>) -> Self {
        if self.ctx.input(|input| input.pointer.any_down()) {
            return self;
        }
        let text = text.into();
        self.on_disabled_hover_text(&text).on_hover_text(text)
    }

    fn hint_beside(&self, ui: &Ui, text: &str) {
        if self.ctx.input(|input| input.pointer.any_down()) {
            return;
        }
        let panel_side = Rect::from_x_y_ranges(ui.clip_rect().x_range(), self.rect.y_range());
        let mut tooltip = Tooltip::for_enabled(self);
        tooltip.popup = tooltip
            .popup
            .anchor(panel_side)
            .align(RectAlign::LEFT_START);
        tooltip.show(|ui| {
            ui.set_max_width(ui.spacing().tooltip_width);
            ui.label(text);
        });
    }
}
