//! Charts rendered to pictures: one study, or several with common axes.

use egui::{Theme, Ui, vec2};

use super::chart::Chart;
use super::dots::{ChartView, CostAxis, ErrorAxis, chart};
use super::marks;
use crate::image::Image;
use crate::lab::{PictureLook, Study};
use crate::ui::raster::{SCALE, draw};
use crate::ui::theme::GRID;

/// Renders a chart that fills the whole picture.
pub fn picture(look: PictureLook, mut show: impl FnMut(&mut Ui)) -> Image {
    let theme = if look.is_light {
        Theme::Light
    } else {
        Theme::Dark
    };
    let (width, height) = look.size;
    let points = (width.div_ceil(SCALE), height.div_ceil(SCALE));
    let drawn = draw(points, theme, |ui| {
        let frame = egui::Frame::new().inner_margin(2.0 * GRID);
        frame.show(ui, &mut show);
    });
    let (width, height) = (width as usize, height as usize);
    let rows = drawn.pixels.chunks(drawn.width).take(height);
    Image {
        width,
        height,
        pixels: rows.flat_map(|row| &row[..width]).copied().collect(),
    }
}

/// Draws the charts of time against RMSE of these studies, each given with the name of its scene, as the window
/// would draw them: several are arranged in a grid and share the extent of their axes.
pub fn chart_picture(studies: &[(String, Study)], machine: &str, look: PictureLook) -> Image {
    let charts = studies.iter().map(|(name, study)| {
        let view = ChartView {
            name,
            machine,
            axes: (CostAxis::Time, ErrorAxis::Rmse),
            render: &study.scene().render,
            chosen: None,
        };
        chart(study, &view).0
    });
    let mut charts: Vec<Chart> = charts.collect();
    let extents: Vec<_> = charts.iter().filter_map(Chart::extent).collect();
    let bounds = extents.into_iter().reduce(|[a, b], [c, d]| {
        let merged = |one: (f64, f64), other: (f64, f64)| (one.0.min(other.0), one.1.max(other.1));
        [merged(a, c), merged(b, d)]
    });
    for chart in &mut charts {
        chart.bounds = bounds;
        chart.is_one_of_several = studies.len() > 1;
    }
    let (columns, rows) = PictureLook::grid_of(charts.len());
    picture(look, |ui| {
        if studies.len() > 1 {
            show_common(ui, &charts);
        }
        let available = ui.available_size();
        let tile = vec2(
            available.x / columns as f32 - GRID,
            available.y / rows as f32 - GRID,
        );
        for row in charts.chunks(columns as usize) {
            ui.horizontal_top(|ui| {
                for chart in row {
                    ui.push_id(&chart.title, |ui| {
                        ui.allocate_ui(tile, |ui| {
                            ui.set_min_size(tile);
                            ui.vertical(|ui| chart.show(ui));
                        });
                    });
                }
            });
        }
    })
}

/// Shows what the charts have in common: the legend, and the quantities of the axes.
fn show_common(ui: &mut Ui, charts: &[Chart]) {
    ui.horizontal_wrapped(|ui| {
        let families: Vec<_> = charts.iter().flat_map(Chart::families).collect();
        marks::legend(ui, &families);
    });
    if let Some(chart) = charts.first() {
        let error = chart.error_label;
        let have_same_label = charts
            .iter()
            .all(|other| other.cost_label == chart.cost_label);
        let cost = if have_same_label {
            &chart.cost_label
        } else {
            "ms per picture"
        };
        ui.weak(format!("Horizontal: {cost}; vertical: {error}"));
    }
    ui.add_space(GRID);
}
