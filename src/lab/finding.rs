//! What a study has found, in a sentence.

use super::clusters::front_of;
use super::measure::{EIGHT_BIT_FLOOR, decibels};
use super::pareto_front::cheapest_within;
use super::study::Study;
use crate::words::counted;

/// How much longer the chosen way must take than another one that is as close to be called beaten.
const BEATEN: f64 = 1.1;

/// What a study of a scene of this name has found about the plan's choice.
pub fn finding(study: &Study, name: &str) -> String {
    let costs = study.certain_costs();
    let own = study.costs().first().copied();
    let (Some((ms, error)), true) = (own, study.progress() >= 1.0) else {
        return format!("{name}: time against error");
    };
    let within = |error: f64| cheapest_within(&costs, error, f64::INFINITY);
    let quartiles = |place: usize| study.measurements[place].timing().map(|t| t.quartiles);
    // Its slower runs against the faster ones of the default: a busy machine beats nobody.
    let is_doubtful = study.measurements[0].is_doubtful();
    let is_certain = |place: usize| match (quartiles(place), quartiles(0)) {
        (Some((_, slow)), Some((fast, _))) => !is_doubtful && slow * BEATEN < fast,
        _ => false,
    };
    let better = within(error * 1.01).filter(|&place| is_certain(place));
    if let Some(place) = better {
        let (way, cost) = (
            &study.measurements[place].candidate.name,
            told(costs[place].0),
        );
        let own = told(ms);
        return format!(
            "{name}: {way} is as close as the default, in {cost}\u{a0}ms and not {own}"
        );
    }
    let ms = told(ms);
    if error <= EIGHT_BIT_FLOOR {
        return format!(
            "{name}: on average, the default is below what 8 bits show at {ms}\u{a0}ms"
        );
    }
    let decibels = decibels(error);
    match within(EIGHT_BIT_FLOOR) {
        Some(place) => {
            let (way, cost) = (
                &study.measurements[place].candidate.name,
                told(costs[place].0),
            );
            format!(
                "{name}: on average, {way} is below what 8 bits show at {cost}\u{a0}ms; the default has {decibels:.0}\u{a0}dB at {ms}"
            )
        }
        None => match counted(front_of(study).len(), "way") {
            one if one.starts_with("1 ") => format!(
                "{name}: the default has {decibels:.0}\u{a0}dB at {ms}\u{a0}ms, and {one} is worth its time"
            ),
            ways => format!(
                "{name}: the default has {decibels:.0}\u{a0}dB at {ms}\u{a0}ms, and {ways} are worth their time"
            ),
        },
    }
}

/// Milliseconds with a decimal, or with two digits where they are few.
fn told(ms: f64) -> String {
    let digits = if ms < 1.0 && ms > 0.0 {
        1 - ms.log10().floor() as i32
    } else {
        1
    };
    format!("{ms:.*}", digits.clamp(1, 9) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_milliseconds_are_some() {
        for (ms, words) in [
            (12.34, "12.3"),
            (1.0, "1.0"),
            (0.0444, "0.044"),
            (0.99, "0.99"),
            (0.0, "0.0"),
        ] {
            assert_eq!(told(ms), words);
        }
    }
}
