//! The Pareto front of cost and error.

use std::cmp::Ordering;

/// Share to which the error must fall to justify a higher cost: smaller gains would vanish in the next measurement.
const MAX_ERROR_RATIO: f64 = 0.99;

/// Returns the indices of the dots (cost, error), by cost, whose error is clearly less than that of every cheaper
/// one. Dots with a number that is not finite are never on the front.
pub fn front(costs: &[(f64, f64)]) -> Vec<usize> {
    let is_finite = |&index: &usize| costs[index].0.is_finite() && costs[index].1.is_finite();
    let mut indices: Vec<usize> = (0..costs.len()).filter(is_finite).collect();
    indices.sort_by(|&a, &b| order(costs[a], costs[b]));
    let mut least_error = f64::INFINITY;
    indices.retain(|&index| {
        let is_better = costs[index].1 < least_error * MAX_ERROR_RATIO;
        if is_better {
            least_error = costs[index].1;
        }
        is_better
    });
    indices
}

/// Returns the index of the cheapest dot (cost, error) within both bounds, if there is one.
pub fn cheapest_within(costs: &[(f64, f64)], error: f64, cost: f64) -> Option<usize> {
    let fits = |&index: &usize| costs[index].1 <= error && costs[index].0 <= cost;
    let fitting = (0..costs.len()).filter(fits);
    fitting.min_by(|&a, &b| order(costs[a], costs[b]))
}

/// Orders dots (cost, error) by cost, and equal costs by error.
fn order(one: (f64, f64), other: (f64, f64)) -> Ordering {
    let by_cost = one.0.total_cmp(&other.0);
    by_cost.then(one.1.total_cmp(&other.1))
}

/// Returns the index of the dot (cost, error) with the least error among those of at most this cost:
/// [`cheapest_within`] with the axes swapped.
pub fn closest_within(costs: &[(f64, f64)], cost: f64) -> Option<usize> {
    let swapped: Vec<(f64, f64)> = costs.iter().map(|&(c, e)| (e, c)).collect();
    cheapest_within(&swapped, cost, f64::INFINITY)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_front_goes_down_from_left_to_right() {
        let measurements = [
            (3.0, 1.0),
            (1.0, 5.0),
            (2.0, 5.0),
            (2.0, 3.0),
            (4.0, 1.0),
            (0.5, f64::NAN),
        ];
        assert_eq!(front(&measurements), [1, 3, 0]);
        assert_eq!(front(&[(1.0, 5.0), (2.0, 4.99)]), [0], "not worth it");
        assert_eq!(cheapest_within(&measurements, 4.0, 10.0), Some(3));
        assert_eq!(cheapest_within(&measurements, 4.0, 1.5), None);
        assert_eq!(
            closest_within(&[(2.0, 1.0), (1.0, 1.0)], 9.0),
            Some(1),
            "as close, and cheaper"
        );
        assert_eq!(cheapest_within(&measurements, 0.5, 10.0), None);
        assert_eq!(closest_within(&measurements, 2.5), Some(3));
        assert_eq!(closest_within(&measurements, 0.9), None);
    }

    proptest! {
        #[test]
        fn what_is_not_on_the_front_is_beaten(measurements in prop::collection::vec((0.0..9.0_f64, 0.0..9.0_f64), 1..40)) {
            let front = front(&measurements);
            for (index, dot) in measurements.iter().enumerate() {
                let beats = |&other: &usize| measurements[other].0 <= dot.0 && measurements[other].1 * MAX_ERROR_RATIO <= dot.1;
                let beaten = front.iter().filter(|&&other| other != index).any(beats);
                prop_assert!(front.contains(&index) || beaten);
            }
            prop_assert!(front.windows(2).all(|pair| measurements[pair[0]].0 < measurements[pair[1]].0 && measurements[pair[0]].1 > measurements[pair[1]].1));
        }
    }
}
