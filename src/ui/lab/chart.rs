//! The chart itself: dots on logarithmic axes, the front through the best of them.

use std::ops::RangeInclusive;

use egui::{Pos2, Ui, Vec2b};
use egui_plot::{
    GridInput, GridMark, HLine, HoverPosition, Line, LineStyle, MarkerShape, Plot, PlotPoint,
    PlotPoints, Points, Text,
};

use super::super::raster::draw;
use super::super::theme::{GRID, palette};
use crate::image::Image;
use crate::lab::front;

/// Size of a picture of a chart, in points.
const PICTURE: (u32, u32) = (800, 480);
/// How near to a dot the pointer must be, in points.
const REACH: f32 = 14.0;
/// Names are written beside this many dots at most: the front's.
const MOST_NAMES: usize = 12;

/// What is drawn.
#[derive(Clone, Debug, Default)]
pub struct Chart {
    /// What the axis to the right measures.
    pub cost: &'static str,
    /// What the axis upwards measures.
    pub error: &'static str,
    /// The dots.
    pub spots: Vec<ChartDot>,
    /// Lines across: name and height.
    pub levels: Vec<(&'static str, f64)>,
    /// The dot that is looked at.
    pub chosen: Option<usize>,
}

/// One dot.
#[derive(Clone, Debug)]
pub struct ChartDot {
    /// Its name.
    pub name: String,
    /// To the right; NaN if it is not measured.
    pub cost: f64,
    /// Upwards; NaN if it is not measured.
    pub error: f64,
    /// Said when the pointer is on it.
    pub words: String,
    /// Whether its cost is not to be trusted.
    pub is_doubtful: bool,
}

impl Chart {
    /// The places of the dots that nothing beats.
    fn front(&self) -> Vec<usize> {
        let dots: Vec<(f64, f64)> = self
            .spots
            .iter()
            .map(|spot| (spot.cost, spot.error))
            .collect();
        front(&dots)
    }

    /// Draws it into all the room that there is. The dot that was clicked, if one was.
    pub fn show(&self, ui: &mut Ui) -> Option<usize> {
        let colors = palette(ui.ctx());
        let front = self.front();
        if self.spots.iter().all(|spot| spot.error.is_nan()) {
            ui.centered_and_justified(|ui| ui.weak("No dots yet"));
            return None;
        }
        let response = Plot::new("lab chart")
            .x_axis_label(self.cost)
            .y_axis_label(self.error)
            .x_axis_formatter(power_of_ten)
            .y_axis_formatter(power_of_ten)
            .x_grid_spacer(|input| decades(&input))
            .y_grid_spacer(|input| decades(&input))
            .y_axis_min_width(48.0)
            .set_margin_fraction(egui::vec2(0.08, 0.12))
            .auto_bounds(Vec2b::TRUE)
            .label_formatter(|hover| self.label(hover))
            .show(ui, |plot| {
                for &(name, level) in &self.levels {
                    let line = HLine::new(name, level.log10());
                    plot.hline(line.color(colors.muted).style(LineStyle::dashed_loose()));
                }
                if let Some(left) = self.left() {
                    for &(name, level) in &self.levels {
                        let name = egui::RichText::new(name).small();
                        let text = Text::new("level", PlotPoint::new(left, level.log10()), name);
                        plot.text(text.anchor(egui::Align2::LEFT_TOP).color(colors.muted));
                    }
                }
                let steps: Vec<[f64; 2]> = front.iter().map(|&index| self.at(index)).collect();
                plot.line(Line::new("front", steps).color(colors.accent).width(1.5));
                for (index, spot) in self.spots.iter().enumerate() {
                    if !(spot.cost.is_finite() && spot.error.is_finite()) {
                        continue;
                    }
                    let is_best = front.contains(&index);
                    let dot =
                        Points::new(spot.name.clone(), PlotPoints::from(vec![self.at(index)]))
                            .radius(if self.chosen == Some(index) { 7.0 } else { 4.0 })
                            .shape(if spot.is_doubtful {
                                MarkerShape::Diamond
                            } else {
                                MarkerShape::Circle
                            })
                            .filled(!spot.is_doubtful)
                            .color(if is_best { colors.accent } else { colors.muted });
                    plot.points(dot);
                }
                for &index in front.iter().take(MOST_NAMES) {
                    let [x, y] = self.at(index);
                    let name = egui::RichText::new(format!("  {}", self.spots[index].name));
                    let text = Text::new("name", PlotPoint::new(x, y), name.small());
                    plot.text(text.anchor(egui::Align2::LEFT_BOTTOM).color(colors.text));
                }
            });
        let click = response.response.clicked();
        let pointer = response.response.interact_pointer_pos().filter(|_| click)?;
        self.nearest(pointer, |point| {
            response.transform.position_from_point(&point)
        })
    }

    /// The cheapest dot's place on the axis to the right.
    fn left(&self) -> Option<f64> {
        let costs = self.spots.iter().map(|spot| spot.cost.log10());
        costs.filter(|cost| cost.is_finite()).min_by(f64::total_cmp)
    }

    /// Where a dot is on axes of powers of ten.
    fn at(&self, index: usize) -> [f64; 2] {
        let spot = &self.spots[index];
        [spot.cost.log10(), spot.error.log10()]
    }

    fn nearest(&self, pointer: Pos2, on_screen: impl Fn(PlotPoint) -> Pos2) -> Option<usize> {
        let distance = |index: usize| {
            let [x, y] = self.at(index);
            on_screen(PlotPoint::new(x, y)).distance(pointer)
        };
        (0..self.spots.len())
            .map(|index| (index, distance(index)))
            .filter(|(_, distance)| *distance <= REACH)
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .map(|(index, _)| index)
    }

    fn label(&self, hover: &HoverPosition) -> Option<String> {
        let HoverPosition::NearDataPoint { plot_name, .. } = hover else {
            return None;
        };
        let spot = self.spots.iter().find(|spot| spot.name == *plot_name);
        spot.map(|spot| format!("{}\n{}", spot.name, spot.words))
    }
}

/// A picture of a chart that is drawn into all of it.
pub fn picture(mut show: impl FnMut(&mut Ui)) -> Image {
    draw(PICTURE.0, PICTURE.1, 2.0, |ui| {
        let frame = egui::Frame::new().inner_margin(2.0 * GRID);
        frame.show(ui, &mut show);
    })
}

/// Marks at 1, 2, … 9 times every power of ten that is in sight.
pub fn decades(input: &GridInput) -> Vec<GridMark> {
    let (low, high) = (input.bounds.0.floor() as i32, input.bounds.1.ceil() as i32);
    // Zoomed far out, more marks than pixels would be of no use.
    if high - low > 40 {
        return Vec::new();
    }
    let decade = |exponent: i32| {
        (1..10).map(move |digit| GridMark {
            value: f64::from(exponent) + f64::from(digit).log10(),
            step_size: if digit == 1 { 1.0 } else { 0.1 },
        })
    };
    let in_sight = |mark: &GridMark| (input.bounds.0..=input.bounds.1).contains(&mark.value);
    (low..=high).flat_map(decade).filter(in_sight).collect()
}

/// What stands at a mark: the powers of ten alone.
pub fn power_of_ten(mark: GridMark, _: &RangeInclusive<f64>) -> String {
    if mark.step_size < 1.0 {
        return String::new();
    }
    let value = 10.0_f64.powf(mark.value);
    if (1e-3..1e5).contains(&value) {
        format!("{value:.3}")
            .trim_end_matches('0')
            .trim_end_matches('.')
            .to_owned()
    } else {
        format!("{value:.0e}")
    }
}
