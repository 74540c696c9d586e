//! Conversion of a study into the dots of its chart.

use super::chart::{Chart, ChartDot};
use crate::lab::{EIGHT_BIT_FLOOR, Family, Measurement, Study, account, clusters, finding};
use crate::plan::Model;
use crate::scene::{Render, Sampling};

/// Errors of 0 are drawn at half the smallest positive error, or at half of this if that is smaller.
const ZERO_ERROR_LIMIT: f64 = 1e-4;
/// Maximum number of characters per line in a tooltip.
const MAX_TOOLTIP_LETTERS: usize = 60;

/// Quantity of the horizontal axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CostAxis {
    /// Milliseconds per picture.
    Time,
    /// Rays per pixel.
    Rays,
}

/// Quantity of the vertical axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ErrorAxis {
    /// Root-mean-square error.
    Rmse,
    /// Error of the worst channel.
    Max,
    /// Share of the pixels that are visibly wrong.
    Visible,
}

/// How a study is shown.
#[derive(Clone, Debug)]
pub struct ChartView<'a> {
    /// The name of the scene.
    pub name: &'a str,
    /// Description of the machine it was measured on.
    pub machine: &'a str,
    /// Quantities of the two axes.
    pub axes: (CostAxis, ErrorAxis),
    /// The current render settings of the scene.
    pub render: &'a Render,
    /// Index of the selected measurement.
    pub chosen: Option<usize>,
}

/// Makes the chart of a study. Also returns, for each dot, the indices of the measurements it stands for.
pub fn chart(study: &Study, view: &ChartView) -> (Chart, Vec<Vec<usize>>) {
    let clusters = clusters(study);
    let error = |dot: &Measurement| {
        dot.metrics.map_or(f64::NAN, |metrics| match view.axes.1 {
            ErrorAxis::Rmse => metrics.rmse,
            ErrorAxis::Max => metrics.max,
            ErrorAxis::Visible => metrics.visible,
        })
    };
    let spots = clusters.iter().map(|members| {
        let dot = &study.measurements[members[0]];
        let (cost, quartiles) = match (view.axes.0, dot.timing()) {
            (CostAxis::Time, Some(timing)) => (timing.median, timing.quartiles),
            _ => (dot.rays_per_pixel, (dot.rays_per_pixel, dot.rays_per_pixel)),
        };
        ChartDot {
            name: name_of(dot, members.len() - 1),
            family: dot.candidate.family,
            cost,
            quartiles,
            error: error(dot),
            tooltip: format!("{}\n{}", wrapped(&account(study, members[0])), figures(dot)),
            is_doubtful: view.axes.0 == CostAxis::Time && dot.is_doubtful(),
        }
    });
    let mut spots: Vec<ChartDot> = spots.collect();
    // The axis is logarithmic and has no zero: dots without error are drawn below all others; the tooltip has the
    // figure.
    let errors = spots.iter().map(|spot| spot.error);
    let smallest = errors
        .filter(|error| *error > 0.0)
        .fold(ZERO_ERROR_LIMIT, f64::min);
    for spot in &mut spots {
        if spot.error == 0.0 {
            spot.error = smallest / 2.0;
        }
    }
    let (spots, clusters): (Vec<_>, Vec<_>) = spots
        .into_iter()
        .zip(clusters)
        .filter(|(spot, _)| spot.error.is_finite())
        .unzip();
    let spot_of = |index: usize| clusters.iter().position(|members| members.contains(&index));
    let (width, height) = study.size();
    let is_rmse = view.axes.1 == ErrorAxis::Rmse;
    let reference = study.reference.as_ref().filter(|_| is_rmse);
    let chart = Chart {
        title: match view.axes {
            (CostAxis::Time, ErrorAxis::Rmse) => finding(study, view.name),
            _ => view.name.to_owned(),
        },
        cost_label: match view.axes.0 {
            CostAxis::Time => format!("ms per {width}×{height} picture, {}", view.machine),
            CostAxis::Rays => "rays per pixel".to_owned(),
        },
        error_label: match view.axes.1 {
            ErrorAxis::Rmse => "RMSE against the reference (0–1)",
            ErrorAxis::Max => "worst channel (0–1)",
            ErrorAxis::Visible => "share of pixels off by > 4/255",
        },
        has_decibels: is_rmse,
        series: series(study, spot_of),
        levels: reference
            .map(|reference| ("the reference's own error", reference.rmse))
            .into_iter()
            .chain(is_rmse.then_some(("below 8-bit rounding", EIGHT_BIT_FLOOR)))
            .collect(),
        invisible_below: is_rmse.then_some(EIGHT_BIT_FLOOR),
        in_use: in_use(study, view.render).and_then(spot_of),
        chosen: view.chosen.and_then(spot_of),
        bounds: None,
        is_one_of_several: false,
        spots,
    };
    (chart, clusters)
}

fn name_of(dot: &Measurement, others: usize) -> String {
    let name = &dot.candidate.name;
    match others {
        0 => name.clone(),
        1 => format!("{name}, and 1 equal method"),
        _ => format!("{name}, and {others} equal methods"),
    }
}

/// The measurement of the scene's current settings, if it was made.
fn in_use(study: &Study, render: &Render) -> Option<usize> {
    let (width, height) = study.size();
    let current = Render {
        width,
        height,
        ..render.clone()
    };
    let is_current = |dot: &Measurement| {
        let candidate = &dot.candidate;
        let is_possible = candidate.upscale == 1 && candidate.model == Model::Needed;
        is_possible && candidate.family != Family::Referee && candidate.render == current
    };
    study.measurements.iter().position(is_current)
}

/// The dots to be joined by lines: grids ordered by sample count, and adaptive samplings by cost.
fn series(study: &Study, spot_of: impl Fn(usize) -> Option<usize>) -> Vec<Vec<usize>> {
    let sorted_dots = |is_in: fn(Sampling) -> bool| {
        let measurements = study.measurements.iter().enumerate();
        let mut steps: Vec<(f64, usize)> = measurements
            .filter(|(_, dot)| {
                dot.candidate.family == Family::Sampling
                    && dot.candidate.render.reflection_limit
                        == study.scene().render.reflection_limit
                    && is_in(dot.candidate.render.antialias)
            })
            .filter_map(|(index, dot)| Some((dot.rays_per_pixel, spot_of(index)?)))
            .collect();
        steps.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut spots: Vec<usize> = steps.into_iter().map(|(_, spot)| spot).collect();
        spots.dedup();
        spots
    };
    vec![
        sorted_dots(|sampling| !matches!(sampling, Sampling::Adaptive { .. })),
        sorted_dots(|sampling| matches!(sampling, Sampling::Adaptive { .. })),
    ]
}

/// Breaks a text into lines that fit a tooltip.
fn wrapped(text: &str) -> String {
    let mut lines = String::new();
    let mut length = 0;
    for word in text.split(' ') {
        let count = word.chars().count();
        if length > 0 && length + 1 + count > MAX_TOOLTIP_LETTERS {
            lines.push('\n');
            length = 0;
        } else if length > 0 {
            lines.push(' ');
            length += 1;
        }
        lines.push_str(word);
        length += count;
    }
    lines
}

/// The figures of a measurement, one per line.
pub fn figures(dot: &Measurement) -> String {
    let time = dot.timing().map_or("not timed yet".to_owned(), |timing| {
        let doubt = if dot.is_doubtful() { " (noisy)" } else { "" };
        // As a deviation to either side of the median.
        let spread = timing.spread * 50.0;
        format!(
            "{:.3} ms ± {spread:.0} %{doubt}, {} runs",
            timing.median, timing.runs
        )
    });
    let Some(metrics) = dot.metrics else {
        return time;
    };
    format!(
        "{time}\n{:.2} rays/px\nRMSE {:.2e}, {:.1} dB\nworst {:.4}, {:.3} % > 4/255",
        dot.rays_per_pixel,
        metrics.rmse,
        metrics.psnr(),
        metrics.max,
        metrics.visible * 100.0,
    )
}
