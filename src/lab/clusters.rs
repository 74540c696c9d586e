//! Groups ways of tracing that no measurement tells apart, each of which is one dot on the chart.

use super::candidates::{Candidate, Family};
use super::measure::ErrorMetrics;
use super::pareto_front::front;
use super::study::{Measurement, Study, Timing};
use crate::plan::Model;

/// Relative difference of errors below which they count as equal.
const SAME_ERROR: f64 = 0.02;
/// Relative difference of rays per pixel below which they count as equal.
const SAME_RAYS: f64 = 0.02;
/// Relative difference of times below which they count as equal, even if the runs vary less.
const SAME_TIME: f64 = 0.08;

impl Study {
    /// Milliseconds and RMSE of each measurement; NaN where they are not known yet.
    pub fn costs(&self) -> Vec<(f64, f64)> {
        let cost = |dot: &Measurement| dot.timing().map_or(f64::NAN, |timing| timing.median);
        let error = |dot: &Measurement| dot.metrics.map_or(f64::NAN, |metrics| metrics.rmse);
        self.measurements
            .iter()
            .map(|dot| (cost(dot), error(dot)))
            .collect()
    }

    /// The same, with NaN for doubtful times, which must not define a front.
    pub fn certain_costs(&self) -> Vec<(f64, f64)> {
        let mut costs = self.costs();
        for (cost, dot) in costs.iter_mut().zip(&self.measurements) {
            if dot.is_doubtful() {
                cost.0 = f64::NAN;
            }
        }
        costs
    }
}

/// Groups measurements, given by their indices, with equal errors and rays per pixel, whose times differ by no more
/// than their runs do. Certain and doubtful ones are grouped separately. Indices in a group are ascending. Incomplete
/// measurements are in no group.
pub fn clusters(study: &Study) -> Vec<Vec<usize>> {
    let figures_of = |dot: &Measurement| Some((dot.timing()?, dot.metrics?));
    let mut clusters: Vec<((Timing, ErrorMetrics), Vec<usize>)> = Vec::new();
    for (index, dot) in study.measurements.iter().enumerate() {
        let Some(figures) = figures_of(dot) else {
            continue;
        };
        // A certain measurement must not be represented by a doubtful one.
        let has_similar_rays = |index: usize| {
            let other = &study.measurements[index];
            let (most, least) = (
                other.rays_per_pixel.max(dot.rays_per_pixel),
                other.rays_per_pixel.min(dot.rays_per_pixel),
            );
            other.is_doubtful() == dot.is_doubtful() && most - least <= SAME_RAYS * most
        };
        match clusters
            .iter_mut()
            .find(|(first, cluster)| has_similar_rays(cluster[0]) && is_same(*first, figures))
        {
            Some((_, cluster)) => cluster.push(index),
            None => clusters.push((figures, vec![index])),
        }
    }
    clusters.into_iter().map(|(_, cluster)| cluster).collect()
}

/// Returns the indices of the Pareto-optimal ways. Only the first way of each group is considered, and doubtful ones
/// are ignored.
pub fn front_of(study: &Study) -> Vec<usize> {
    front(&costs_of_firsts(study, |_| true))
}

/// Milliseconds and RMSE of the first way of each group that can be chosen for a scene; NaN for the others. Doubtful
/// times count as their slowest run: a way that is faster even then is worth choosing. Excluded are other engines,
/// smaller pictures, and models that skip less or show other things, which serve for comparison only.
pub fn costs_of_choices(study: &Study) -> Vec<(f64, f64)> {
    let mut costs = costs_of_firsts(study, |candidate| {
        let Candidate {
            family,
            model,
            upscale,
            ..
        } = *candidate;
        family != Family::Referee && model == Model::Needed && upscale == 1
    });
    for (cost, measurement) in costs.iter_mut().zip(&study.measurements) {
        if cost.1.is_finite() && measurement.is_doubtful() {
            cost.0 = measurement.times.iter().copied().fold(0.0, f64::max);
        }
    }
    costs
}

/// Milliseconds and RMSE of the first way of each group for which `is_wanted` holds; NaN for the others. Those of
/// doubtful ones are as in [`Study::certain_costs`].
fn costs_of_firsts(study: &Study, is_wanted: impl Fn(&Candidate) -> bool) -> Vec<(f64, f64)> {
    let all = study.certain_costs();
    let mut costs = vec![(f64::NAN, f64::NAN); all.len()];
    let is_wanted = |index: &usize| is_wanted(&study.measurements[*index].candidate);
    for cluster in clusters(study) {
        if let Some(first) = cluster.into_iter().find(is_wanted) {
            costs[first] = all[first];
        }
    }
    costs
}

fn is_same((a, c): (Timing, ErrorMetrics), (b, d): (Timing, ErrorMetrics)) -> bool {
    // A median may well be off by half of the interquartile range.
    let log_ratio = (a.median / b.median).ln().abs();
    let spread = f64::midpoint(a.spread, b.spread).max(SAME_TIME);
    let error_gap = (c.rmse - d.rmse).abs();
    log_ratio <= spread && error_gap <= SAME_ERROR * c.rmse.max(d.rmse)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::super::pareto_front::cheapest_within;
    use super::*;
    use crate::scene::Scene;

    /// A study with only these measurements: milliseconds of three runs, and the error.
    fn study(figures: &[([f64; 3], f64)]) -> Study {
        let mut study = Study::new(Arc::new(Scene::demo()), 8, 8);
        study.measurements.truncate(figures.len());
        for (dot, (times, rmse)) in study.measurements.iter_mut().zip(figures) {
            dot.times = times.to_vec();
            dot.metrics = Some(ErrorMetrics {
                rmse: *rmse,
                ..ErrorMetrics::default()
            });
        }
        study
    }

    #[test]
    fn ways_that_take_other_rays_are_told_apart() {
        let mut study = study(&[([10.0, 10.1, 10.2], 1e-3); 3]);
        for (dot, rays) in study.measurements.iter_mut().zip([2.64, 2.65, 2.89]) {
            dot.rays_per_pixel = rays;
        }
        assert_eq!(clusters(&study), [vec![0, 1], vec![2]]);
    }

    #[test]
    fn what_cannot_be_told_apart_is_one_and_stands_on_the_front_once() {
        let study = study(&[
            ([10.0, 10.1, 10.2], 1e-3),
            // Like the first within the variation of the runs, although slightly faster and closer.
            ([9.9, 10.0, 10.1], 0.985e-3),
            // Closer, but doubtful: its runs differ by more than a fifth.
            ([2.0, 3.0, 4.0], 1e-4),
            ([20.0, 20.1, 20.2], 5e-4),
            // Slower, with a larger error.
            ([30.0, 30.1, 30.2], 2e-3),
            // Possibly as fast as the fourth.
            ([12.0, 20.0, 29.0], 5e-4),
        ]);
        let apart = [vec![0, 1], vec![2], vec![3], vec![4], vec![5]];
        assert_eq!(clusters(&study), apart);
        assert_eq!(front_of(&study), [0, 3]);
    }

    #[test]
    fn a_way_that_can_be_chosen_is_not_hidden_by_one_that_cannot() {
        let mut study = study(&[([10.0, 10.1, 10.2], 1e-3); 2]);
        study.measurements[0].candidate.model = Model::Everything;
        study.measurements[1].candidate.model = Model::Needed;
        assert_eq!(clusters(&study), [vec![0, 1]]);
        let costs = costs_of_choices(&study);
        assert_eq!(cheapest_within(&costs, 2e-3, f64::INFINITY), Some(1));
    }

    #[test]
    fn a_doubtful_way_is_chosen_if_it_is_the_fastest_even_in_its_slowest_run() {
        let noisy = ([2.0, 3.0, 9.0], 1e-3);
        for (certain, chosen) in [(10.0, 0), (8.0, 1)] {
            let mut study = study(&[noisy, ([certain; 3], 0.9e-3)]);
            // One that can be chosen.
            study.measurements[1].candidate = study.measurements[0].candidate.clone();
            let costs = costs_of_choices(&study);
            assert_eq!(cheapest_within(&costs, 2e-3, f64::INFINITY), Some(chosen));
        }
    }
}
