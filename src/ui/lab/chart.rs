//! The chart: dots on logarithmic axes, and the Pareto front of the best of them.

use egui::{
    Color32, FontId, Painter, Pos2, Rangef, Rect, Stroke, TextStyle, Ui, Vec2, Vec2b, pos2, vec2,
};
use egui_plot::{
    AxisHints, HPlacement, HoverPosition, Plot, PlotPoint, PlotPoints, PlotTransform, Points,
};

use super::axes::{MAX_DECADES, decades, decibels, plain, power_of_ten, powers};
use super::labels::{place_level_name, place_names};
use super::marks;
use crate::lab::{Family, front};
use crate::ui::theme::{GRID, palette};

/// Spacing of axis labels in points, on small charts side by side, over which the labels fade in.
const COMPACT_LABEL_SPACING: Rangef = Rangef {
    min: 12.0,
    max: 18.0,
};
/// Maximum distance of the pointer from a dot that it selects, in points.
const SELECT_DISTANCE: f32 = 14.0;
/// Distance of a name from its dot, in points, beyond which a line connects the two.
const LEADER_LINE_DISTANCE: f32 = 14.0;
/// Height in points below which the axes have short names.
const LOW_HEIGHT: f32 = 220.0;
/// Margin around the dots, in decades.
const MARGIN_DECADES: (f64, f64) = (0.12, 0.2);

/// The content of a chart.
#[derive(Clone, Debug, Default)]
pub struct Chart {
    /// The title, which sums up the chart.
    pub title: String,
    /// Label of the horizontal axis.
    pub cost_label: String,
    /// Label of the vertical axis.
    pub error_label: &'static str,
    /// Whether there is an axis in decibels as well.
    pub has_decibels: bool,
    /// The dots.
    pub spots: Vec<ChartDot>,
    /// Sequences of dots, as indices, that are joined by thin lines.
    pub series: Vec<Vec<usize>>,
    /// Horizontal lines: name and error.
    pub levels: Vec<(&'static str, f64)>,
    /// The area of errors below this is shaded, as they are not visible.
    pub invisible_below: Option<f64>,
    /// The dot of the scene's current settings.
    pub in_use: Option<usize>,
    /// The selected dot.
    pub chosen: Option<usize>,
    /// Range of the axes if it is given instead of computed: cost and error.
    pub bounds: Option<[(f64, f64); 2]>,
    /// Whether it is one of several charts in a picture, whose common labels are written once.
    pub is_one_of_several: bool,
}

/// A dot.
#[derive(Clone, Debug)]
pub struct ChartDot {
    /// Its name.
    pub name: String,
    /// Its family, which determines the marker.
    pub family: Family,
    /// Horizontal coordinate.
    pub cost: f64,
    /// Lower and upper quartile of the cost.
    pub quartiles: (f64, f64),
    /// Vertical coordinate.
    pub error: f64,
    /// The text of its tooltip.
    pub tooltip: String,
    /// Whether its cost is unreliable.
    pub is_doubtful: bool,
}

impl Chart {
    /// Indices of the dots on the Pareto front. Doubtful ones are left out.
    fn front(&self) -> Vec<usize> {
        let reliable_cost = |spot: &ChartDot| {
            if spot.is_doubtful {
                f64::NAN
            } else {
                spot.cost
            }
        };
        let dots: Vec<_> = self
            .spots
            .iter()
            .map(|spot| (reliable_cost(spot), spot.error))
            .collect();
        front(&dots)
    }

    /// The ranges of cost and error that the dots cover, without margin.
    pub fn extent(&self) -> Option<[(f64, f64); 2]> {
        let costs = self.spots.iter().map(|spot| spot.cost);
        let levels = self.levels.iter().map(|(_, level)| *level);
        let errors = self.spots.iter().map(|spot| spot.error).chain(levels);
        Some([range(costs)?, range(errors)?])
    }

    /// Draws the chart into all available space. Returns the dot that was clicked, if any.
    pub fn show(&self, ui: &mut Ui) -> Option<usize> {
        let Some(extent) = self.bounds.or_else(|| self.extent()) else {
            ui.centered_and_justified(|ui| ui.weak("No dots yet"));
            return None;
        };
        self.show_title(ui);
        let is_low = ui.available_height() < LOW_HEIGHT;
        let response = self.plot(is_low).show(ui, |plot| {
            // Invisible points, for the axis ranges and for hovering; the visible chart is drawn below.
            let corners = PlotPoints::from(corners(extent).to_vec());
            let transparent = Color32::TRANSPARENT;
            plot.points(
                Points::new("", corners)
                    .color(transparent)
                    .allow_hover(false),
            );
            for (index, spot) in self.spots.iter().enumerate() {
                let at = PlotPoints::from(vec![self.log_position(index)]);
                plot.points(
                    Points::new(spot.name.clone(), at)
                        .color(transparent)
                        .radius(0.5),
                );
            }
        });
        self.draw(ui, &response.transform);
        // The plot learns the width of its axes one frame late.
        let (id, frame) = (
            response.response.id.with("frame"),
            *response.transform.frame(),
        );
        let before =
            ui.data_mut(|data| std::mem::replace(data.get_temp_mut_or(id, Rect::NOTHING), frame));
        if before != frame {
            ui.request_repaint();
        }
        let click = response.response.clicked();
        let pointer = response.response.interact_pointer_pos().filter(|_| click)?;
        self.nearest(pointer, |point| {
            response.transform.position_from_point(&point)
        })
    }

    fn show_title(&self, ui: &mut Ui) {
        let title = egui::RichText::new(&self.title);
        if self.is_one_of_several {
            // Two lines for each title, so that neighbouring charts start at the same height.
            let size = vec2(
                ui.available_width(),
                2.0 * ui.text_style_height(&TextStyle::Small),
            );
            ui.allocate_ui(size, |ui| {
                ui.set_min_size(size);
                ui.label(title.small());
            });
            return;
        }
        ui.horizontal_wrapped(|ui| {
            ui.label(title.strong());
            ui.add_space(GRID);
            marks::legend(ui, &self.families());
        });
    }

    /// The families of its dots.
    pub fn families(&self) -> Vec<Family> {
        self.spots.iter().map(|spot| spot.family).collect()
    }

    fn plot(&self, is_low: bool) -> Plot<'_> {
        let full_label = self.error_label;
        let error = if is_low || self.is_one_of_several {
            full_label.split(' ').next().unwrap_or(full_label)
        } else {
            full_label
        };
        let mut error_axis = AxisHints::new_y().label(error).formatter(power_of_ten);
        if self.is_one_of_several {
            error_axis = error_axis.label_spacing(COMPACT_LABEL_SPACING);
        }
        let mut vertical_axes = vec![error_axis];
        if self.has_decibels && !self.is_one_of_several {
            let decibels = AxisHints::new_y().label("dB").formatter(decibels);
            vertical_axes.push(decibels.placement(HPlacement::Right));
        }
        let mut cost_axis = AxisHints::new_x().label(&self.cost_label).formatter(plain);
        if self.is_one_of_several {
            let unit = self
                .cost_label
                .split(' ')
                .next()
                .unwrap_or(&self.cost_label);
            cost_axis = cost_axis.label(unit).label_spacing(COMPACT_LABEL_SPACING);
        }
        Plot::new("lab chart")
            .custom_x_axes(vec![cost_axis])
            .custom_y_axes(vertical_axes)
            .x_grid_spacer(|input| decades(&input))
            .y_grid_spacer(|input| powers(&input))
            .show_grid(false)
            .show_background(false)
            .y_axis_min_width(40.0)
            .set_margin_fraction(egui::Vec2::ZERO)
            .auto_bounds(Vec2b::TRUE)
            .label_formatter(|hover| self.label(hover))
    }

    /// Draws onto the empty plot, from back to front.
    fn draw(&self, ui: &Ui, transform: &PlotTransform) {
        let colors = palette(ui.ctx());
        let frame = *transform.frame();
        let painter = ui.painter().with_clip_rect(frame);
        let on_screen = |[x, y]: [f64; 2]| transform.position_from_point(&PlotPoint::new(x, y));
        let height = |error: f64| on_screen([0.0, error.log10()]).y;
        if let Some(error) = self.invisible_below {
            let below = Rect::from_min_max(pos2(frame.left(), height(error)), frame.max);
            painter.rect_filled(below, 0, colors.raised.gamma_multiply(0.6));
        }
        draw_decades(&painter, transform, Stroke::new(0.5, colors.line));
        let small = TextStyle::Small.resolve(ui.style());
        let dots: Vec<Pos2> = (0..self.spots.len())
            .map(|index| on_screen(self.log_position(index)))
            .collect();
        let front = self.front();
        let stairs = stairs(frame, front.iter().map(|&index| dots[index]));
        let mut occupied: Vec<Rect> = stairs
            .windows(2)
            .map(|step| Rect::from_two_pos(step[0], step[1]))
            .collect();
        let marker_rect =
            |dot: &Pos2| Rect::from_center_size(*dot, Vec2::splat(2.0 * marks::RADIUS));
        let mut level_obstacles: Vec<Rect> = dots
            .iter()
            .map(marker_rect)
            .chain(occupied.clone())
            .collect();
        for &(name, level) in &self.levels {
            let y = height(level);
            let dashes = [pos2(frame.left(), y), pos2(frame.right(), y)];
            let line = Stroke::new(1.0, colors.muted);
            painter.extend(egui::Shape::dashed_line(&dashes, line, 6.0, 5.0));
            occupied.push(Rect::from_two_pos(dashes[0], dashes[1]));
            let text = painter.layout_no_wrap(name.to_owned(), small.clone(), colors.muted);
            let within = frame.shrink2(vec2(GRID, 0.0));
            if let Some(label_rect) = place_level_name(y, text.size(), (within, &level_obstacles)) {
                painter.galley(label_rect.min, text, colors.muted);
                occupied.push(label_rect);
                level_obstacles.push(label_rect);
            }
        }
        for series in &self.series {
            let line: Vec<Pos2> = series.iter().map(|&index| dots[index]).collect();
            let family = series.first().map(|&index| self.spots[index].family);
            let color = marks::color(ui, family.unwrap_or(Family::Sampling));
            painter.line(line, Stroke::new(0.75, color.gamma_multiply(0.6)));
        }
        painter.line(stairs, Stroke::new(1.5, colors.accent));
        let mut bars = Vec::new();
        for (index, (spot, at)) in self.spots.iter().zip(&dots).enumerate() {
            let color = marks::color(ui, spot.family);
            let x = |cost: f64| on_screen([cost.log10(), 0.0]).x;
            let (low, high) = (x(spot.quartiles.0), x(spot.quartiles.1));
            painter.hline(low..=high, at.y, Stroke::new(1.0, color));
            bars.push(Rect::from_x_y_ranges(low..=high, at.y..=at.y));
            marks::draw(&painter, *at, spot.family, color, spot.is_doubtful);
            if self.in_use == Some(index) {
                painter.circle_stroke(*at, marks::RADIUS + 4.0, Stroke::new(1.5, colors.text));
            }
            if self.chosen == Some(index) {
                painter.circle_stroke(*at, marks::RADIUS + 7.0, Stroke::new(2.0, colors.accent));
            }
        }
        self.write_names(
            &painter,
            (&dots, &front),
            (&occupied, &bars, small),
            [colors.text, colors.muted],
        );
    }

    /// Writes names beside the dots: first those of the front, then as many as fit.
    fn write_names(
        &self,
        painter: &Painter,
        (dots, front): (&[Pos2], &[usize]),
        (occupied, bars, font): (&[Rect], &[Rect], FontId),
        [strong, weak]: [Color32; 2],
    ) {
        let frame = painter.clip_rect();
        let rank = |index: &usize| {
            let is_first = self.in_use == Some(*index) || self.chosen == Some(*index);
            (!is_first, !front.contains(index))
        };
        let is_weak = |index: &usize| rank(index) == (true, true);
        let is_named = |index: &usize| !self.is_one_of_several || !is_weak(index);
        let mut order: Vec<usize> = (0..dots.len())
            .filter(|index| frame.contains(dots[*index]) && is_named(index))
            .collect();
        order.sort_by_key(rank);
        let color = |index: usize| if is_weak(&index) { weak } else { strong };
        let texts: Vec<_> = order
            .iter()
            .map(|&index| {
                let name = self.spots[index].name.clone();
                painter.layout_no_wrap(name, font.clone(), color(index))
            })
            .collect();
        let names: Vec<_> = order
            .iter()
            .zip(&texts)
            .map(|(&index, text)| (dots[index], text.size()))
            .collect();
        let frame = frame.shrink(GRID / 2.0);
        let label_rects = place_names(&names, (dots, marks::RADIUS + 2.0), (frame, occupied, bars));
        for ((index, text), label_rect) in order.into_iter().zip(texts).zip(label_rects) {
            let Some(label_rect) = label_rect else {
                continue;
            };
            let line_end = label_rect.clamp(dots[index]);
            if line_end.distance(dots[index]) > LEADER_LINE_DISTANCE {
                let line = Stroke::new(0.5, weak);
                painter.line_segment([dots[index], line_end], line);
            }
            painter.galley(label_rect.min, text, color(index));
        }
    }

    /// Position of a dot on the logarithmic axes.
    fn log_position(&self, index: usize) -> [f64; 2] {
        let spot = &self.spots[index];
        [spot.cost.log10(), spot.error.log10()]
    }

    fn nearest(&self, pointer: Pos2, on_screen: impl Fn(PlotPoint) -> Pos2) -> Option<usize> {
        let distance = |index: usize| {
            let [x, y] = self.log_position(index);
            on_screen(PlotPoint::new(x, y)).distance(pointer)
        };
        (0..self.spots.len())
            .map(|index| (index, distance(index)))
            .filter(|(_, distance)| *distance <= SELECT_DISTANCE)
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .map(|(index, _)| index)
    }

    fn label(&self, hover: &HoverPosition) -> Option<String> {
        let HoverPosition::NearDataPoint { plot_name, .. } = hover else {
            return None;
        };
        let mut spots = self.spots.iter().enumerate();
        let (index, spot) = spots.find(|(_, spot)| spot.name == *plot_name)?;
        // The panel beside the chart shows the selected one.
        let is_told = self.chosen == Some(index);
        (!is_told).then(|| format!("{}\n{}", spot.name, spot.tooltip))
    }
}

/// The ends of the axes, as powers of ten, with a margin.
fn corners([costs, errors]: [(f64, f64); 2]) -> [[f64; 2]; 2] {
    let (across, up) = MARGIN_DECADES;
    [
        [costs.0.log10() - across, errors.0.log10() - up],
        [costs.1.log10() + across, errors.1.log10() + up],
    ]
}

/// Smallest and largest of the positive, finite values; `None` if there are none.
fn range(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    let values = values.filter(|value| value.is_finite() && *value > 0.0);
    values.fold(None, |range: Option<(f64, f64)>, value| {
        let (low, high) = range.unwrap_or((value, value));
        Some((low.min(value), high.max(value)))
    })
}

/// The staircase of the front: down to each dot, then to the right. For any point above it, some dot is both faster
/// and more accurate.
fn stairs(frame: Rect, dots: impl Iterator<Item = Pos2>) -> Vec<Pos2> {
    let mut stairs = Vec::new();
    for dot in dots {
        let above = stairs.last().map_or(frame.top(), |last: &Pos2| last.y);
        stairs.push(pos2(dot.x, above));
        stairs.push(dot);
    }
    if let Some(last) = stairs.last().copied() {
        stairs.push(pos2(frame.right(), last.y));
    }
    stairs
}

/// Draws faint lines at the powers of ten.
fn draw_decades(painter: &Painter, transform: &PlotTransform, line: Stroke) {
    let (frame, bounds) = (*transform.frame(), transform.bounds());
    let on_screen = |x: f64, y: f64| transform.position_from_point(&PlotPoint::new(x, y));
    let within = |low: f64, high: f64| (low.ceil() as i32)..=(high.floor() as i32);
    if bounds.width().max(bounds.height()) > MAX_DECADES {
        return;
    }
    for power in within(bounds.min()[0], bounds.max()[0]) {
        painter.vline(on_screen(f64::from(power), 0.0).x, frame.y_range(), line);
    }
    for power in within(bounds.min()[1], bounds.max()[1]) {
        painter.hline(frame.x_range(), on_screen(0.0, f64::from(power)).y, line);
    }
    painter.rect_stroke(frame, 0, line, egui::StrokeKind::Inside);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_is_a_staircase_that_doubtful_dots_do_not_carry() {
        let frame = Rect::from_min_max(pos2(0.0, 0.0), pos2(10.0, 10.0));
        let steps = stairs(frame, [pos2(1.0, 3.0), pos2(4.0, 8.0)].into_iter());
        let expected = [[1.0, 0.0], [1.0, 3.0], [4.0, 3.0], [4.0, 8.0], [10.0, 8.0]];
        assert_eq!(steps, expected.map(|[x, y]| pos2(x, y)));
        let dot = |cost: f64, error: f64, is_doubtful: bool| ChartDot {
            name: String::new(),
            family: Family::Sampling,
            cost,
            quartiles: (cost, cost),
            error,
            tooltip: String::new(),
            is_doubtful,
        };
        let chart = Chart {
            spots: vec![
                dot(1.0, 0.1, false),
                dot(2.0, 0.01, true),
                dot(3.0, 0.02, false),
            ],
            ..Chart::default()
        };
        assert_eq!(chart.front(), [0, 2]);
    }
}
