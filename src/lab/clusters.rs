//! Ways of tracing that are one dot on the chart: nothing measured tells them apart.

use super::study::{Measurement, Study};

/// Errors that differ by less are equal.
const SAME_ERROR: f64 = 0.02;
/// Times that differ by less are equal, however little the runs differ.
const SAME_TIME: f64 = 0.03;

/// Groups of measurements, by their places, that differ neither in time nor in error by more than the runs of
/// each do; the first of a group is the first of the list. What is not fully measured is in no group.
pub fn clusters(study: &Study) -> Vec<Vec<usize>> {
    let mut clusters: Vec<Vec<usize>> = Vec::new();
    let measurements = &study.measurements;
    for (place, dot) in measurements.iter().enumerate() {
        if dot.timing().is_none() || dot.metrics.is_none() {
            continue;
        }
        let same = clusters.iter_mut().find(|cluster| {
            let first = &measurements[cluster[0]];
            is_same(first, dot)
        });
        match same {
            Some(cluster) => cluster.push(place),
            None => clusters.push(vec![place]),
        }
    }
    clusters
}

fn is_same(one: &Measurement, other: &Measurement) -> bool {
    let (Some(a), Some(b)) = (one.timing(), other.timing()) else {
        return false;
    };
    let (Some(c), Some(d)) = (one.metrics, other.metrics) else {
        return false;
    };
    // Half of the distance of the quartiles is what a median may well be off by.
    let apart = (a.median / b.median).ln().abs();
    let spread = f64::midpoint(a.spread, b.spread).max(SAME_TIME);
    let off = (c.rmse - d.rmse).abs();
    apart <= spread && off <= SAME_ERROR * c.rmse.max(d.rmse)
}
