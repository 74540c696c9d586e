//! What a study has found, in a sentence.

use super::clusters::front_of;
use super::measure::{EIGHT_BIT_FLOOR, decibels};
use super::pareto_front::cheapest_within;
use super::study::Study;

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
        let way = &study.measurements[place].candidate.name;
        let cost = costs[place].0;
        return format!(
            "{name}: {way} is as close as the default, in {cost:.1}\u{a0}ms and not {ms:.1}"
        );
    }
    if error <= EIGHT_BIT_FLOOR {
        return format!(
            "{name}: on average, the default is below what 8 bits show at {ms:.1}\u{a0}ms"
        );
    }
    let decibels = decibels(error);
    match within(EIGHT_BIT_FLOOR) {
        Some(place) => {
            let (way, cost) = (&study.measurements[place].candidate.name, costs[place].0);
            format!(
                "{name}: on average, {way} is below what 8 bits show at {cost:.1}\u{a0}ms; the default has {decibels:.0}\u{a0}dB at {ms:.1}"
            )
        }
        None => format!(
            "{name}: the default has {decibels:.0}\u{a0}dB at {ms:.1}\u{a0}ms, and {} ways are worth their time",
            front_of(study).len()
        ),
    }
}
