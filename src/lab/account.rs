//! Describes in two sentences what a way of tracing does, where it comes from, and what it costs and gains here.

use super::candidates::{Candidate, Family, UNCULLED};
use super::study::{Measurement, Study};
use crate::scene::{Chosen, SphereMethod};
use crate::words::capitalised;

/// Relative difference below which ratios count as 1.
const SAME_RATIO: f64 = 0.05;

/// Describes a measured way, and compares it with the first, which is the default.
pub fn account(study: &Study, index: usize) -> String {
    let (Some(measured), Some(default)) =
        (study.measurements.get(index), study.measurements.first())
    else {
        return String::new();
    };
    let what = what(&measured.candidate, &default.candidate);
    if index == 0 {
        return what;
    }
    compared(measured, default).map_or(what.clone(), |figures| format!("{what} {figures}"))
}

/// Describes how it differs from the default, with the source of each method.
fn what(candidate: &Candidate, default: &Candidate) -> String {
    match candidate.family {
        Family::Original => {
            return "Every step as in the original program, without skipping what the scene does not need."
                .to_owned();
        }
        Family::Referee => {
            return "The picture by POV-Ray (povray.org), an independent renderer that shares no code with Glint."
                .to_owned();
        }
        Family::Resolution => {
            let share = candidate.upscale * candidate.upscale;
            return format!(
                "The default for one pixel in {share}, scaled up smoothly: sharp edges become soft."
            );
        }
        _ => {}
    }
    if candidate.name == UNCULLED {
        return "Every primitive is tested for every ray, wherever it is.".to_owned();
    }
    let (own, usual) = (candidate.render.chosen(), default.render.chosen());
    let differing = own
        .into_iter()
        .zip(usual)
        .filter(|(own, usual)| own.id != usual.id);
    let mut parts: Vec<String> = differing.map(|(own, _)| setting_in_words(&own)).collect();
    let (bounces, usual) = (
        candidate.render.reflection_limit,
        default.render.reflection_limit,
    );
    if bounces != usual {
        parts.push(format!("reflection limit of {bounces} instead of {usual}"));
    }
    if candidate.render.sphere != SphereMethod::Stable {
        parts.push(format!(
            "its wrong hits are visible, since every primitive is tested, as in \"{UNCULLED}\""
        ));
    }
    if parts.is_empty() {
        return "The default: for each step, the method that is reliable everywhere.".to_owned();
    }
    format!("{}.", capitalised(&parts.join("; ")))
}

/// Compares its time, rays and error with those of the default.
fn compared(measured: &Measurement, default: &Measurement) -> Option<String> {
    let (time, usual) = (measured.timing()?.median, default.timing()?.median);
    let (error, usual_error) = (measured.metrics?.rmse, default.metrics?.rmse);
    let rays = measured.rays_per_pixel / default.rays_per_pixel;
    let speed = ratio_in_words(
        time / usual,
        " as fast as the default",
        " slower than the default",
    );
    let speed = speed.unwrap_or("as fast as the default".to_owned());
    let closeness = match (error > 0.0, usual_error > 0.0) {
        (true, true) => ratio_in_words(error / usual_error, " smaller", " larger"),
        (true, false) => Some("not zero, as that of the default is".to_owned()),
        (false, true) => Some("zero".to_owned()),
        (false, false) => None,
    };
    let closeness = closeness.unwrap_or("about the same".to_owned());
    let rays = match rays {
        ratio if (ratio - 1.0).abs() <= SAME_RATIO => "as many rays".to_owned(),
        ratio if ratio < 1.0 => format!("{ratio:.2}× as many rays"),
        ratio => format!("{} as many rays", times(ratio)),
    };
    Some(format!(
        "On this scene it is {speed}, with {rays}, and its error is {closeness}."
    ))
}

/// A ratio in words, with `less` or `more` added; `None` if it is about 1.
fn ratio_in_words(ratio: f64, less: &str, more: &str) -> Option<String> {
    match ratio {
        ratio if ratio < 1.0 - SAME_RATIO => Some(times(1.0 / ratio) + less),
        ratio if ratio > 1.0 + SAME_RATIO => Some(times(ratio) + more),
        _ => None,
    }
}

fn times(ratio: f64) -> String {
    if ratio < 10.0 {
        format!("{ratio:.1}×")
    } else {
        format!("{ratio:.0}×")
    }
}

fn setting_in_words(chosen: &Chosen) -> String {
    let Chosen {
        setting,
        id,
        what,
        source,
    } = chosen;
    format!("{} {id}: {what} ({source})", setting.label)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::lab::candidates;
    use crate::scene::Scene;
    use crate::trace::RenderControl;

    #[test]
    fn every_way_is_told_apart_from_the_default_with_its_source() {
        let scene = Scene::demo();
        let all = candidates(&scene, 64, 64);
        for candidate in &all[1..] {
            let words = what(candidate, &all[0]);
            assert_ne!(words, what(&all[0], &all[0]), "{}", candidate.name);
            assert!(words.ends_with('.') && words.len() > 20, "{words}");
        }
        let named = |name: &str| all.iter().find(|candidate| candidate.name == name);
        let grid = what(named("grid:8").expect("a grid"), &all[0]);
        assert!(
            grid.contains("grid:8: a square of rays in every pixel"),
            "{grid}"
        );
        assert!(grid.contains("(common practice)"), "{grid}");
    }

    #[test]
    fn what_it_gives_is_what_was_measured() {
        let mut study = Study::new(Arc::new(Scene::demo()), 24, 18);
        while study.step(&RenderControl::default()) {}
        let place = |name: &str| {
            let names = study.measurements.iter().map(|dot| &dot.candidate.name);
            names
                .clone()
                .position(|other| other == name)
                .expect("it is measured")
        };
        let one = account(&study, place("none"));
        assert!(
            one.contains("× as many rays") && one.contains("larger"),
            "{one}"
        );
        assert!(!account(&study, 0).contains("On this scene it is"));
    }
}
