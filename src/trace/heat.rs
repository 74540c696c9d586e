//! Heat map: counts as colours.

use crate::simd::Real;

/// Colours at equal steps from black to white, each brighter than the previous one: red, green and blue, 0–1.
const STEPS: [[f64; 3]; 6] = [
    [0.0, 0.0, 0.02],
    [0.27, 0.04, 0.42],
    [0.65, 0.17, 0.38],
    [0.93, 0.41, 0.15],
    [0.98, 0.79, 0.28],
    [1.0, 1.0, 0.93],
];
/// The count that is shown white; 1 is black.
const WHITE_COUNT: f64 = 1000.0;

/// Returns the colour of a count, on a logarithmic scale.
pub fn heat<R: Real>(count: f64) -> [R; 3] {
    let last = STEPS.len() - 1;
    let at = (count.max(1.0).ln() / WHITE_COUNT.ln()).min(1.0) * last as f64;
    let below = (at as usize).min(last - 1);
    let share = at - below as f64;
    let mix = |channel: usize| {
        let (from, to) = (STEPS[below][channel], STEPS[below + 1][channel]);
        R::from_f64(from + (to - from) * share)
    };
    [mix(0), mix(1), mix(2)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_is_brighter_up_to_the_most() {
        let brightness = |count: f64| heat::<f64>(count).iter().sum::<f64>();
        let counts = [1.0, 2.0, 5.0, 10.0, 40.0, 100.0, 400.0, 1000.0];
        for pair in counts.windows(2) {
            assert!(brightness(pair[0]) < brightness(pair[1]), "{pair:?}");
        }
        assert_eq!(heat::<f64>(0.0), STEPS[0]);
        assert_eq!(heat::<f64>(1e9), STEPS[5]);
    }
}
