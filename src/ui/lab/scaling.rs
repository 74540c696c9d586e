//! Chart of how tracing one picture would scale with the number of cores.

use egui::Ui;
use egui_plot::{Corner, GridMark, Legend, Line, LineStyle, Plot, PlotPoints, Points};

use super::axes::{GRID_FADE, plain};
use super::pictures::picture;
use crate::image::Image;
use crate::lab::{PictureLook, SharedPicture};
use crate::ui::theme::{GRID, palette};

/// The number of workers that the heading reports on.
const REPORTED_WORKERS: usize = 64;

/// Draws the simulated scaling of one or more scenes.
pub fn scaling_picture(pictures: &[SharedPicture], look: PictureLook) -> Image {
    picture(look, |ui| {
        ui.label(egui::RichText::new(finding(pictures)).heading());
        ui.add_space(GRID);
        show(ui, pictures);
    })
}

/// The heading, which sums up the chart.
fn finding(pictures: &[SharedPicture]) -> String {
    let reported = pictures
        .iter()
        .filter(|picture| picture.workers == REPORTED_WORKERS);
    let reported = reported.map(|picture| {
        let share = picture.efficiency * 100.0;
        format!("{} {:.2} ms ({share:.0} %)", picture.scene, picture.ms)
    });
    format!(
        "{REPORTED_WORKERS} cores: {}",
        reported.collect::<Vec<_>>().join(", ")
    )
}

fn show(ui: &mut Ui, pictures: &[SharedPicture]) {
    let colors = palette(ui.ctx()).families;
    let at =
        |picture: &SharedPicture| [(picture.workers as f64).log10(), picture.efficiency * 100.0];
    let first = pictures
        .chunk_by(|one, next| one.scene == next.scene)
        .next();
    let marks = |_| {
        let mark = |picture: &SharedPicture| GridMark {
            value: (picture.workers as f64).log10(),
            step_size: std::f64::consts::LOG10_2,
        };
        first.unwrap_or_default().iter().map(mark).collect()
    };
    Plot::new("cores chart")
        .legend(Legend::default().position(Corner::LeftBottom))
        .x_axis_label("cores, simulated")
        .y_axis_label("cores busy, %")
        .x_axis_formatter(plain)
        .x_grid_spacer(marks)
        .y_axis_min_width(48.0)
        .grid_spacing(GRID_FADE)
        .show_background(false)
        .include_y(0.0)
        .include_y(105.0)
        .set_margin_fraction(egui::vec2(0.06, 0.0))
        .show(ui, |plot| {
            let is_same = |one: &SharedPicture, next: &SharedPicture| {
                one.scene == next.scene && one.workers < next.workers
            };
            let scenes = pictures.chunk_by(is_same).enumerate();
            for ((number, scene), color) in scenes.zip(colors.into_iter().cycle()) {
                // When the colours repeat, lines are dashed.
                let style = match number / colors.len() {
                    0 => LineStyle::Solid,
                    cycle => LineStyle::Dashed {
                        length: 6.0 * cycle as f32,
                    },
                };
                let name = scene[0].scene.clone();
                let points: Vec<[f64; 2]> = scene.iter().map(at).collect();
                let dots = Points::new(name.clone(), PlotPoints::from(points.clone()));
                plot.points(dots.radius(4.0).color(color));
                plot.line(Line::new(name, points).color(color).width(1.5).style(style));
            }
        });
}
