//! The colours of the window, and the sizes and spacings that its parts share.

use egui::style::WidgetVisuals;
use egui::{
    Color32, Context, CornerRadius, FontFamily, FontId, Stroke, Style, TextStyle, Theme, Visuals,
    vec2,
};

use super::glyphs;

/// Height of a row of widgets, in points.
pub const ROW: f32 = 24.0;
/// The grid: spacings are multiples of half of it.
pub const GRID: f32 = 8.0;
/// Width of the labels in the inspector.
pub const LABEL: f32 = 80.0;
/// Least width of the outliner, and its first width in a wide window, in points.
pub const OUTLINER: (f32, f32) = (188.0, 224.0);
/// The same for the inspector, whose width does not follow its content.
pub const INSPECTOR: (f32, f32) = (300.0, 332.0);
/// Least width of a window in which side panels are first shown at full width.
pub const WIDE_WINDOW: f32 = 960.0;
/// Height of the lab when it is first shown.
pub const LAB: f32 = 280.0;
/// Height of the timeline when it is first shown, without tracks.
pub const TIMELINE: f32 = 216.0;
/// Height of a few tracks, which are visible at first.
pub const TRACKS: f32 = 3.0 * TRACK;
/// Least and largest width of the labels of the timeline's tracks.
pub const TRACK_LABEL: (f32, f32) = (112.0, 224.0);
/// Height of a track of the timeline.
pub const TRACK: f32 = 20.0;
/// Height of the thumbnails above keys.
pub const THUMB: f32 = 44.0;
/// Height of the graph of the camera's speed.
pub const GRAPH: f32 = 56.0;
/// Width of the field for a colour as `#RRGGBB`.
pub const HEX: f32 = 60.0;
/// Size of plain text.
pub const TEXT: f32 = 13.0;
/// Size of the icons.
pub const ICON: f32 = 16.0;

const RADIUS: CornerRadius = CornerRadius::same(4);

/// The colours by their roles.
#[derive(Clone, Copy, Debug)]
pub struct Palette {
    /// Background of the window, around the picture.
    pub window: Color32,
    /// Panels.
    pub panel: Color32,
    /// Fields and buttons.
    pub raised: Color32,
    /// Fields and buttons under the pointer.
    pub hovered: Color32,
    /// Lines between panels.
    pub line: Color32,
    /// Text.
    pub text: Color32,
    /// Explanatory text.
    pub muted: Color32,
    /// The one accent: selection, primary button.
    pub accent: Color32,
    /// Text on the accent.
    pub on_accent: Color32,
    /// Keys and curves.
    pub curve: Color32,
    /// The selected row.
    pub selected: Color32,
    /// Errors, and nothing else.
    pub error: Color32,
    /// Families of dots on a chart: distinguishable without colour vision too (after Okabe and Ito, "Color universal
    /// design", 2008), and also by their shapes.
    pub families: [Color32; 6],
    /// The x, y and z axes.
    pub axes: [Color32; 3],
    /// The letters of the axes, in fields.
    pub axis_letters: [Color32; 3],
    /// Lines and text drawn over pictures.
    pub on_picture: Color32,
    /// Outline of these, which makes them visible on any picture.
    pub halo: Color32,
}

const AXES: [Color32; 3] = [
    Color32::from_rgb(0xF0, 0x85, 0x5A),
    Color32::from_rgb(0x8F, 0xD1, 0x6A),
    Color32::from_rgb(0x6F, 0xA8, 0xF5),
];
const ON_PICTURE: Color32 = Color32::from_rgb(0xF4, 0xF5, 0xF8);
const HALO: Color32 = Color32::from_rgba_premultiplied(0, 0, 0, 150);

const DARK: Palette = Palette {
    window: Color32::from_rgb(0x16, 0x18, 0x1D),
    panel: Color32::from_rgb(0x1C, 0x1F, 0x26),
    raised: Color32::from_rgb(0x24, 0x28, 0x32),
    hovered: Color32::from_rgb(0x2F, 0x34, 0x40),
    line: Color32::from_rgb(0x2F, 0x34, 0x40),
    text: Color32::from_rgb(0xD7, 0xDB, 0xE4),
    muted: Color32::from_rgb(0x8B, 0x93, 0xA5),
    accent: Color32::from_rgb(0xF2, 0xB1, 0x34),
    on_accent: Color32::from_rgb(0x16, 0x18, 0x1D),
    curve: Color32::from_rgb(0x5C, 0xC8, 0xC2),
    selected: Color32::from_rgb(0x4A, 0x3D, 0x22),
    error: Color32::from_rgb(0xFF, 0x6B, 0x6B),
    families: [
        Color32::from_rgb(0xF2, 0xB1, 0x34),
        Color32::from_rgb(0x5B, 0xB8, 0xF0),
        Color32::from_rgb(0xD9, 0x8A, 0xC4),
        Color32::from_rgb(0x3F, 0xC3, 0x92),
        Color32::from_rgb(0xF4, 0xF5, 0xF8),
        Color32::from_rgb(0xE8, 0x7A, 0x3E),
    ],
    axes: AXES,
    axis_letters: AXES,
    on_picture: ON_PICTURE,
    halo: HALO,
};

const LIGHT: Palette = Palette {
    window: Color32::from_rgb(0xD9, 0xDC, 0xE2),
    panel: Color32::from_rgb(0xF4, 0xF5, 0xF8),
    raised: Color32::from_rgb(0xE6, 0xE9, 0xEF),
    hovered: Color32::from_rgb(0xD5, 0xDA, 0xE3),
    line: Color32::from_rgb(0xC9, 0xCE, 0xD8),
    text: Color32::from_rgb(0x22, 0x26, 0x2E),
    muted: Color32::from_rgb(0x56, 0x5E, 0x70),
    accent: Color32::from_rgb(0x85, 0x56, 0x00),
    on_accent: Color32::from_rgb(0xFF, 0xFF, 0xFF),
    curve: Color32::from_rgb(0x00, 0x86, 0x80),
    selected: Color32::from_rgb(0xF6, 0xE2, 0xB8),
    error: Color32::from_rgb(0xC6, 0x28, 0x28),
    families: [
        Color32::from_rgb(0xB0, 0x6A, 0x00),
        Color32::from_rgb(0x00, 0x6F, 0xB0),
        Color32::from_rgb(0xA8, 0x4B, 0x85),
        Color32::from_rgb(0x00, 0x80, 0x5B),
        Color32::from_rgb(0x22, 0x26, 0x2E),
        Color32::from_rgb(0xB4, 0x46, 0x0E),
    ],
    axes: AXES,
    axis_letters: [
        Color32::from_rgb(0xA6, 0x3A, 0x0C),
        Color32::from_rgb(0x2E, 0x6B, 0x10),
        Color32::from_rgb(0x1A, 0x55, 0xAD),
    ],
    on_picture: ON_PICTURE,
    halo: HALO,
};

/// Returns the palette of the current theme.
pub fn palette(ctx: &Context) -> Palette {
    palette_of(ctx.theme())
}

/// Returns the palette for lines in a picture, which is mostly dark, whatever the theme.
pub fn picture_palette() -> Palette {
    DARK
}

fn palette_of(theme: Theme) -> Palette {
    match theme {
        Theme::Dark => DARK,
        Theme::Light => LIGHT,
    }
}

/// Installs the fonts and both themes, with `chosen` as the current one.
pub fn install(ctx: &Context, chosen: Theme) {
    egui_material_icons::initialize(ctx);
    glyphs::install(ctx);
    for theme in [Theme::Dark, Theme::Light] {
        ctx.style_mut_of(theme, |style| restyle(style, theme));
    }
    ctx.set_theme(chosen);
}

fn restyle(style: &mut Style, theme: Theme) {
    let spacing = &mut style.spacing;
    spacing.item_spacing = vec2(GRID / 2.0, GRID / 2.0);
    spacing.button_padding = vec2(GRID, GRID / 4.0);
    spacing.interact_size = vec2(40.0, ROW);
    spacing.combo_width = 0.0;
    // Scroll bars get room of their own and do not cover the content.
    spacing.scroll.floating_allocated_width = spacing.scroll.bar_width;
    style.text_styles = [
        (TextStyle::Small, 11.0, FontFamily::Proportional),
        (TextStyle::Body, TEXT, FontFamily::Proportional),
        (TextStyle::Button, TEXT, FontFamily::Proportional),
        (TextStyle::Heading, 16.0, FontFamily::Proportional),
        (TextStyle::Monospace, 12.0, FontFamily::Monospace),
    ]
    .into_iter()
    .map(|(name, size, family)| (name, FontId::new(size, family)))
    .collect();
    style.drag_value_text_style = TextStyle::Monospace;
    style.interaction.selectable_labels = false;
    style.interaction.tooltip_delay = 0.5;
    style.visuals = visuals(theme);
}

fn visuals(theme: Theme) -> Visuals {
    let p = palette_of(theme);
    let mut visuals = theme.default_visuals();
    visuals.override_text_color = None;
    visuals.weak_text_color = Some(p.muted);
    visuals.panel_fill = p.panel;
    visuals.window_fill = p.panel;
    visuals.window_stroke = Stroke::new(1.0, p.line);
    visuals.extreme_bg_color = p.window;
    visuals.text_edit_bg_color = Some(p.raised);
    visuals.faint_bg_color = p.raised;
    visuals.error_fg_color = p.error;
    visuals.warn_fg_color = p.accent;
    visuals.hyperlink_color = p.accent;
    visuals.selection.bg_fill = p.selected;
    visuals.selection.stroke = Stroke::new(1.0, p.accent);
    visuals.window_corner_radius = RADIUS;
    visuals.menu_corner_radius = RADIUS;
    let state = |fill: Color32, text: Color32, border: Color32| WidgetVisuals {
        bg_fill: fill,
        weak_bg_fill: fill,
        bg_stroke: Stroke::new(1.0, border),
        corner_radius: RADIUS,
        fg_stroke: Stroke::new(1.0, text),
        expansion: 0.0,
    };
    visuals.widgets.noninteractive = state(p.panel, p.text, p.line);
    visuals.widgets.inactive = state(p.raised, p.text, p.line);
    visuals.widgets.hovered = state(p.hovered, p.text, Color32::TRANSPARENT);
    visuals.widgets.active = state(p.hovered, p.text, p.accent);
    visuals.widgets.open = state(p.hovered, p.text, Color32::TRANSPARENT);
    visuals
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the relative luminance of a colour; Web Content Accessibility Guidelines 2.2.
    fn luminance(color: Color32) -> f64 {
        let linear = |channel: u8| {
            let share = f64::from(channel) / 255.0;
            if share <= 0.040_45 {
                share / 12.92
            } else {
                ((share + 0.055) / 1.055).powf(2.4)
            }
        };
        0.2126 * linear(color.r()) + 0.7152 * linear(color.g()) + 0.0722 * linear(color.b())
    }

    fn contrast(one: Color32, other: Color32) -> f64 {
        let (one, other) = (luminance(one), luminance(other));
        (one.max(other) + 0.05) / (one.min(other) + 0.05)
    }

    #[test]
    fn text_is_readable_in_both_themes() {
        for theme in [Theme::Dark, Theme::Light] {
            let p = palette_of(theme);
            let mut pairs = vec![
                ("accent on panel", p.accent, p.panel),
                ("accent on selected", p.accent, p.selected),
                ("text on selected", p.text, p.selected),
                ("on accent", p.on_accent, p.accent),
                ("error on panel", p.error, p.panel),
                ("error on raised", p.error, p.raised),
            ];
            for ground in [p.window, p.panel, p.raised, p.hovered] {
                pairs.push(("text", p.text, ground));
            }
            for ground in [p.window, p.panel, p.raised] {
                pairs.push(("muted", p.muted, ground));
            }
            for letter in p.axis_letters {
                pairs.push(("axis letter", letter, p.raised));
            }
            for (what, one, other) in pairs {
                let contrast = contrast(one, other);
                assert!(contrast >= 4.5, "{theme:?}, {what}: {contrast:.2}");
            }
        }
    }
}
