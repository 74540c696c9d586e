//! Which dots of a chart are worth having.

/// The places of the dots (cost, error) that no other dot beats in one and equals in the other, by
/// cost. Dots with a number that is not finite are on no front.
pub fn front(dots: &[(f64, f64)]) -> Vec<usize> {
    let finite = |&place: &usize| dots[place].0.is_finite() && dots[place].1.is_finite();
    let mut places: Vec<usize> = (0..dots.len()).filter(finite).collect();
    places.sort_by(|&a, &b| {
        let by_cost = dots[a].0.total_cmp(&dots[b].0);
        by_cost.then(dots[a].1.total_cmp(&dots[b].1))
    });
    let mut least = f64::INFINITY;
    places.retain(|&place| {
        let is_better = dots[place].1 < least;
        least = least.min(dots[place].1);
        is_better
    });
    places
}

/// The cheapest dot (cost, error) with no more error than `error`, or, where there is none within
/// `cost`, `None`.
pub fn cheapest_within(dots: &[(f64, f64)], error: f64, cost: f64) -> Option<usize> {
    let mut fitting = front(dots).into_iter();
    fitting.find(|&place| dots[place].1 <= error && dots[place].0 <= cost)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_front_goes_down_from_left_to_right() {
        let dots = [
            (3.0, 1.0),
            (1.0, 5.0),
            (2.0, 5.0),
            (2.0, 3.0),
            (4.0, 1.0),
            (0.5, f64::NAN),
        ];
        assert_eq!(front(&dots), [1, 3, 0]);
        assert_eq!(cheapest_within(&dots, 4.0, 10.0), Some(3));
        assert_eq!(cheapest_within(&dots, 4.0, 1.5), None);
        assert_eq!(cheapest_within(&dots, 0.5, 10.0), None);
    }

    proptest! {
        #[test]
        fn what_is_not_on_the_front_is_beaten(dots in prop::collection::vec((0.0..9.0_f64, 0.0..9.0_f64), 1..40)) {
            let front = front(&dots);
            for (place, dot) in dots.iter().enumerate() {
                let beats = |&other: &usize| dots[other].0 <= dot.0 && dots[other].1 <= dot.1;
                let beaten = front.iter().filter(|&&other| other != place).any(beats);
                prop_assert!(front.contains(&place) || beaten);
            }
            prop_assert!(front.windows(2).all(|pair| dots[pair[0]].0 < dots[pair[1]].0 && dots[pair[0]].1 > dots[pair[1]].1));
        }
    }
}
