//! Summarises the result of a study in a sentence.

use super::clusters::front_of;
use super::measure::{EIGHT_BIT_FLOOR, decibels};
use super::pareto_front::cheapest_within;
use super::study::Study;
use crate::words::{counted, short_number};

/// Factor by which the default must be slower than another way that is as close, to count as beaten.
const MIN_SLOWDOWN: f64 = 1.1;

/// The result of a study of the scene called `name` about the plan's choice.
pub fn finding(study: &Study, name: &str) -> String {
    let costs = study.certain_costs();
    let own = study.costs().first().copied();
    let (Some((ms, error)), true) = (own, study.progress() >= 1.0) else {
        return format!("{name}: time against error");
    };
    let cheapest = |error: f64| cheapest_within(&costs, error, f64::INFINITY);
    let quartiles = |index: usize| study.measurements[index].timing().map(|t| t.quartiles);
    // Compares its slow quartile with the fast one of the default, so that a busy machine does not decide.
    let is_doubtful = study.measurements[0].is_doubtful();
    let is_certain = |index: usize| match (quartiles(index), quartiles(0)) {
        (Some((_, slow)), Some((fast, _))) => !is_doubtful && slow * MIN_SLOWDOWN < fast,
        _ => false,
    };
    let better = cheapest(error * 1.01).filter(|&index| is_certain(index));
    if let Some(index) = better {
        let way = &study.measurements[index].candidate.name;
        let [cost, own] = [costs[index].0, ms].map(short_number);
        return format!(
            "{name}: {way} is as accurate as the default, in {cost}\u{a0}ms instead of {own}"
        );
    }
    let ms = short_number(ms);
    if error <= EIGHT_BIT_FLOOR {
        return format!(
            "{name}: the default's average error is below 8-bit precision in {ms}\u{a0}ms"
        );
    }
    let decibels = decibels(error);
    if let Some(index) = cheapest(EIGHT_BIT_FLOOR) {
        let way = &study.measurements[index].candidate.name;
        let cost = short_number(costs[index].0);
        return format!(
            "{name}: the average error of {way} is below 8-bit precision in {cost}\u{a0}ms; the default has {decibels:.0}\u{a0}dB in {ms}"
        );
    }
    let ways = front_of(study).len();
    let are = if ways == 1 { "is" } else { "are" };
    format!(
        "{name}: the default has {decibels:.0}\u{a0}dB in {ms}\u{a0}ms; {} {are} on the Pareto front",
        counted(ways, "method")
    )
}
