//! The picture of how cost grows: lines on logarithmic axes.

use egui::{Align2, RichText, Ui};
use egui_plot::{Line, LineStyle, Plot, PlotPoint, PlotPoints, Points, Text};

use super::super::theme::{GRID, palette};
use super::axes::{decades, plain};
use super::pictures::picture;
use crate::image::Image;
use crate::lab::{Cost, Crowd, Growth, PictureLook, Way};

/// How far the name of a line is above its end, in decades.
const NAME_ABOVE: f64 = 0.06;

/// A picture of what was measured.
pub fn growth_picture(growth: &Growth, look: PictureLook) -> Image {
    picture(look, |ui| {
        ui.label(RichText::new(finding(growth)).heading());
        ui.add_space(GRID);
        show(ui, growth);
    })
}

/// What the chart says, in a sentence.
fn finding(growth: &Growth) -> String {
    let mut plain: Vec<&Cost> = growth.costs.iter().collect();
    plain.retain(|cost| cost.crowd == Crowd::Mesh && cost.way == Way::Plain);
    match (plain.first(), plain.last()) {
        (Some(first), Some(last)) if first.primitives < last.primitives => format!(
            "From {} to {} faces, a picture takes {:.1} times as long",
            first.primitives,
            last.primitives,
            last.ms / first.ms
        ),
        _ => "Time against primitives".to_owned(),
    }
}

fn show(ui: &mut Ui, growth: &Growth) {
    let colors = palette(ui.ctx());
    let mut lines: Vec<(&Cost, Vec<[f64; 2]>)> = Vec::new();
    for cost in &growth.costs {
        let at = [f64::from(cost.primitives).log10(), cost.ms.log10()];
        match lines
            .iter_mut()
            .find(|(first, _)| first.name() == cost.name())
        {
            Some((_, points)) => points.push(at),
            None => lines.push((cost, vec![at])),
        }
    }
    let side = growth.side();
    Plot::new("growth chart")
        .x_axis_label("primitives")
        .y_axis_label(format!("ms per {side}×{side} picture"))
        .x_axis_formatter(plain)
        .y_axis_formatter(plain)
        .x_grid_spacer(|input| decades(&input))
        .y_grid_spacer(|input| decades(&input))
        .y_axis_min_width(48.0)
        .set_margin_fraction(egui::vec2(0.06, 0.1))
        .show(ui, |plot| {
            for (cost, points) in lines {
                let name = cost.name();
                let color = match cost.crowd {
                    Crowd::Mesh => colors.accent,
                    Crowd::Balls => colors.text,
                };
                let style = match cost.way {
                    Way::Plain => LineStyle::Solid,
                    Way::Clean => LineStyle::dashed_loose(),
                    Way::Povray => LineStyle::dotted_dense(),
                    Way::Embree => LineStyle::dotted_loose(),
                };
                let dots = Points::new(name.clone(), PlotPoints::from(points.clone()));
                plot.points(dots.radius(4.0).color(color));
                if let Some([x, y]) = points.last() {
                    let at = PlotPoint::new(*x, y + NAME_ABOVE);
                    let text = Text::new(name.clone(), at, RichText::new(&name).size(14.0));
                    plot.text(text.color(color).anchor(Align2::RIGHT_BOTTOM));
                }
                plot.line(Line::new(name, points).color(color).style(style).width(1.5));
            }
        });
}
