//! Markers of the chart: a shape and a colour for each family.

use egui::{Color32, Painter, Pos2, Shape, Stroke, Ui, Vec2, vec2};

use crate::lab::Family;
use crate::ui::theme::{GRID, palette};

/// Half the size of a marker, in points.
pub const RADIUS: f32 = 4.5;

/// The colour of a family's markers.
pub fn color(ui: &Ui, family: Family) -> Color32 {
    let colors = palette(ui.ctx()).families;
    let index = Family::ALL.iter().position(|(other, _)| *other == family);
    colors[index.unwrap_or(0)]
}

/// Draws a marker; a doubtful measurement is an outline only.
pub fn draw(painter: &Painter, at: Pos2, family: Family, color: Color32, is_doubtful: bool) {
    let stroke = Stroke::new(1.5, color);
    let fill = if is_doubtful {
        Color32::TRANSPARENT
    } else {
        color
    };
    let r = RADIUS;
    let polygon = |points: Vec<Vec2>| {
        let points = points.into_iter().map(|offset| at + offset).collect();
        Shape::convex_polygon(points, fill, stroke)
    };
    painter.add(match family {
        Family::Sampling => Shape::Circle(egui::epaint::CircleShape {
            center: at,
            radius: r,
            fill,
            stroke,
        }),
        Family::Formulas => polygon(vec![vec2(-r, -r), vec2(r, -r), vec2(r, r), vec2(-r, r)]),
        Family::Precision => {
            let r = r * 1.3;
            polygon(vec![
                vec2(0.0, -r),
                vec2(r, 0.0),
                vec2(0.0, r),
                vec2(-r, 0.0),
            ])
        }
        Family::Resolution => {
            let r = r * 1.2;
            polygon(vec![vec2(0.0, -r), vec2(r, r * 0.8), vec2(-r, r * 0.8)])
        }
        Family::Referee => {
            let r = r * 1.2;
            polygon(vec![vec2(0.0, r), vec2(-r, -r * 0.8), vec2(r, -r * 0.8)])
        }
        Family::Original => {
            let bold = Stroke::new(2.5, color);
            painter.line_segment([at + vec2(-r, -r), at + vec2(r, r)], bold);
            Shape::line_segment([at + vec2(-r, r), at + vec2(r, -r)], bold)
        }
    });
}

/// Shows the legend of the markers.
pub fn legend(ui: &mut Ui, families: &[Family]) {
    for (family, name) in Family::ALL {
        if !families.contains(&family) {
            continue;
        }
        // Keep a marker and its name on the same line.
        let small = egui::TextStyle::Small.resolve(ui.style());
        let text = ui
            .painter()
            .layout_no_wrap(name.to_owned(), small, Color32::WHITE);
        let mark = vec2(2.0 * GRID, 2.0 * GRID);
        let gap = ui.spacing().item_spacing.x;
        let room = vec2(mark.x + gap + text.size().x, mark.y.max(text.size().y));
        let layout = egui::Layout::left_to_right(egui::Align::Center);
        ui.allocate_ui_with_layout(room, layout, |ui| {
            let (area, _) = ui.allocate_exact_size(mark, egui::Sense::hover());
            draw(
                ui.painter(),
                area.center(),
                family,
                color(ui, family),
                false,
            );
            ui.label(egui::RichText::new(name).small());
        });
        ui.add_space(GRID);
    }
}
