//! Chart of how cost grows with the number of primitives, on logarithmic axes.

use egui::{Align2, RichText, Ui};
use egui_plot::{Line, LineStyle, Plot, PlotPoint, PlotPoints, Points, Text};
use indexmap::IndexMap;

use super::axes::{GRID_FADE, decades, plain};
use super::pictures::picture;
use crate::image::Image;
use crate::lab::{Cost, Crowd, Growth, PictureLook, RenderMethod};
use crate::ui::theme::{GRID, palette};

/// Distance of a line's name above or below its end, in decades.
const NAME_OFFSET: f64 = 0.06;
/// If another line ends less than this far above, in decades, the name is written below the line.
const NAME_CLEARANCE: f64 = 0.25;

/// Draws what was measured.
pub fn growth_picture(growth: &Growth, look: PictureLook) -> Image {
    picture(look, |ui| {
        ui.label(RichText::new(finding(growth)).heading());
        ui.add_space(GRID);
        show(ui, growth);
    })
}

/// The heading, which sums up the chart.
fn finding(growth: &Growth) -> String {
    let first_and_last = |way: RenderMethod| {
        let mut costs = growth.costs.iter();
        let is_of_line = |cost: &&Cost| cost.crowd == Crowd::Mesh && cost.way == way;
        let first = costs.find(is_of_line)?;
        let last = costs.rfind(is_of_line)?;
        Some((first, last, last.ms / first.ms))
    };
    let Some((first, last, ratio)) = first_and_last(RenderMethod::Plain) else {
        return "Time against primitives".to_owned();
    };
    let preparation = last.plan_ms;
    let preparation =
        preparation.map(|ms| format!(" (plus {:.1} s once, to prepare the mesh)", ms / 1e3));
    let embree = first_and_last(RenderMethod::Embree)
        .map(|(.., ratio)| format!(", with Embree {ratio:.1} times"));
    format!(
        "From {} to {} faces, a picture takes {ratio:.1} times as long{}{}",
        first.primitives,
        last.primitives,
        preparation.unwrap_or_default(),
        embree.unwrap_or_default()
    )
}

fn show(ui: &mut Ui, growth: &Growth) {
    let colors = palette(ui.ctx());
    let mut lines: IndexMap<String, (&Cost, Vec<[f64; 2]>)> = IndexMap::new();
    for cost in &growth.costs {
        let (_, points) = lines.entry(cost.name()).or_insert((cost, Vec::new()));
        points.push([f64::from(cost.primitives).log10(), cost.ms.log10()]);
    }
    let side = growth.side();
    Plot::new("growth chart")
        .x_axis_label("primitives")
        .y_axis_label(format!("ms per {side}×{side} picture, without preparation"))
        .x_axis_formatter(plain)
        .y_axis_formatter(plain)
        .x_grid_spacer(|input| decades(&input))
        .y_grid_spacer(|input| decades(&input))
        .y_axis_min_width(48.0)
        .grid_spacing(GRID_FADE)
        .show_background(false)
        .set_margin_fraction(egui::vec2(0.06, 0.1))
        .show(ui, |plot| {
            let ends = lines.values().filter_map(|(_, points)| points.last());
            let ends: Vec<[f64; 2]> = ends.copied().collect();
            for (name, (cost, points)) in lines {
                let color = match cost.crowd {
                    Crowd::Mesh => colors.accent,
                    Crowd::Balls => colors.text,
                };
                let style = match cost.way {
                    RenderMethod::Plain => LineStyle::Solid,
                    RenderMethod::Clean => LineStyle::dashed_loose(),
                    RenderMethod::Povray => LineStyle::dotted_dense(),
                    RenderMethod::Embree => LineStyle::dotted_loose(),
                };
                let dots = Points::new(name.clone(), PlotPoints::from(points.clone()));
                plot.points(dots.radius(4.0).color(color));
                if let Some([x, y]) = points.last() {
                    let is_close_above =
                        |end: &[f64; 2]| end[0] == *x && end[1] > *y && end[1] < y + NAME_CLEARANCE;
                    let (offset, anchor) = if ends.iter().any(is_close_above) {
                        (-NAME_OFFSET, Align2::RIGHT_TOP)
                    } else {
                        (NAME_OFFSET, Align2::RIGHT_BOTTOM)
                    };
                    let at = PlotPoint::new(*x, y + offset);
                    let text = Text::new(name.clone(), at, RichText::new(&name).size(14.0));
                    plot.text(text.color(color).anchor(anchor));
                }
                plot.line(Line::new(name, points).color(color).style(style).width(1.5));
            }
        });
}
