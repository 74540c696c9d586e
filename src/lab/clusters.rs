//! Ways of tracing that are one dot on the chart: nothing measured tells them apart.

use super::measure::ErrorMetrics;
use super::study::{Measurement, Study, Timing};

/// Errors that differ by less are equal.
const SAME_ERROR: f64 = 0.02;
/// Times that differ by less are equal, however little the runs differ.
const SAME_TIME: f64 = 0.03;

/// Groups of measurements, by their places, that differ neither in time nor in error by more than the runs of
/// each do; the first of a group is the first of the list. What is not fully measured is in no group.
pub fn clusters(study: &Study) -> Vec<Vec<usize>> {
    let known = |dot: &Measurement| Some((dot.timing()?, dot.metrics?));
    let mut clusters: Vec<((Timing, ErrorMetrics), Vec<usize>)> = Vec::new();
    for (place, dot) in study.measurements.iter().enumerate() {
        let Some(figures) = known(dot) else { continue };
        match clusters
            .iter_mut()
            .find(|(first, _)| is_same(*first, figures))
        {
            Some((_, cluster)) => cluster.push(place),
            None => clusters.push((figures, vec![place])),
        }
    }
    clusters.into_iter().map(|(_, cluster)| cluster).collect()
}

fn is_same((a, c): (Timing, ErrorMetrics), (b, d): (Timing, ErrorMetrics)) -> bool {
    // Half of the distance of the quartiles is what a median may well be off by.
    let apart = (a.median / b.median).ln().abs();
    let spread = f64::midpoint(a.spread, b.spread).max(SAME_TIME);
    let off = (c.rmse - d.rmse).abs();
    apart <= spread && off <= SAME_ERROR * c.rmse.max(d.rmse)
}
