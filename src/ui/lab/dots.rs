//! The dots of a study on the chart.

use super::chart::{Chart, ChartDot, picture};
use crate::image::Image;
use crate::lab::{DOUBTFUL, EIGHT_BIT_FLOOR, Measurement, Study};

/// What the axis to the right measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CostAxis {
    /// Milliseconds.
    Time,
    /// Rays per pixel.
    Rays,
}

/// What the axis upwards measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ErrorAxis {
    /// Root of the mean square.
    Rmse,
    /// The worst channel.
    Max,
    /// Share of the pixels that are visibly off.
    Visible,
}

/// A picture of the chart of time and RMSE, as the window would draw it.
pub fn chart_picture(study: &Study) -> Image {
    let chart = chart(Some(study), (CostAxis::Time, ErrorAxis::Rmse), None);
    picture(|ui| {
        chart.show(ui);
    })
}

/// The dots of a study, as far as they are measured.
pub fn chart(study: Option<&Study>, axes: (CostAxis, ErrorAxis), chosen: Option<usize>) -> Chart {
    let measurements = study.map_or(&[][..], |study| &study.measurements);
    let error = |dot: &Measurement| {
        dot.metrics.map_or(f64::NAN, |metrics| match axes.1 {
            ErrorAxis::Rmse => metrics.rmse,
            ErrorAxis::Max => metrics.max,
            ErrorAxis::Visible => metrics.visible,
        })
    };
    let cost = |dot: &Measurement| match axes.0 {
        CostAxis::Time => dot.timing().map_or(f64::NAN, |timing| timing.median),
        CostAxis::Rays => dot.rays_per_pixel,
    };
    let spots = measurements.iter().map(|dot| ChartDot {
        name: dot.candidate.name.clone(),
        cost: cost(dot),
        // A logarithm has no zero.
        error: Some(error(dot))
            .filter(|error| *error != 0.0)
            .unwrap_or(f64::NAN),
        words: format!("{}\n{}", dot.candidate.words(), figures(dot)),
        is_doubtful: axes.0 == CostAxis::Time
            && dot.timing().is_some_and(|timing| timing.spread > DOUBTFUL),
    });
    let truth = study.and_then(|study| study.reference.as_ref());
    let levels = match (axes.1, truth) {
        (ErrorAxis::Rmse, Some(truth)) => vec![
            ("8 bits show no less", EIGHT_BIT_FLOOR),
            ("the reference's own error", truth.rmse),
        ],
        _ => Vec::new(),
    };
    Chart {
        cost: match axes.0 {
            CostAxis::Time => "ms per picture",
            CostAxis::Rays => "rays per pixel",
        },
        error: match axes.1 {
            ErrorAxis::Rmse => "RMSE",
            ErrorAxis::Max => "worst",
            ErrorAxis::Visible => "share > 4/255",
        },
        spots: spots.collect(),
        levels,
        chosen,
    }
}

/// The numbers of a dot, one in each line.
pub fn figures(dot: &Measurement) -> String {
    let time = dot.timing().map_or("not timed yet".to_owned(), |timing| {
        let doubt = if timing.spread > DOUBTFUL {
            " (doubtful)"
        } else {
            ""
        };
        let spread = timing.spread * 100.0;
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
