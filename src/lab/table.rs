//! A study as a table.

use std::fmt::Write as _;

use serde::Serialize;

use super::clusters::front_of;
use super::study::{REFERENCE_SAMPLES, Study};

/// The measurements by time, as readable text; those on the front are marked.
pub fn table(study: &Study) -> String {
    let costs = study.costs();
    let front = front_of(study);
    let mut order: Vec<usize> = (0..study.measurements.len()).collect();
    order.sort_by(|&a, &b| costs[a].0.total_cmp(&costs[b].0));
    let mut text = format!(
        "  {:<22} {:>9} {:>7} {:>9} {:>10} {:>7} {:>7} {:>8}\n",
        "method", "ms", "spread", "rays/px", "RMSE", "dB", "max", "> 4/255"
    );
    for index in order {
        let dot = &study.measurements[index];
        let (Some(timing), Some(metrics)) = (dot.timing(), dot.metrics) else {
            continue;
        };
        let mark = if front.contains(&index) { '*' } else { ' ' };
        let doubt = if dot.is_doubtful() { "?" } else { "" };
        let _ = writeln!(
            text,
            "{mark} {:<22} {:>9.3} {:>7} {:>9.2} {:>10.2e} {:>7.1} {:>7.4} {:>7.3}%",
            dot.candidate.name,
            timing.median,
            format!("{:.0}%{doubt}", timing.spread * 100.0),
            dot.rays_per_pixel,
            metrics.rmse,
            metrics.psnr(),
            metrics.max,
            metrics.visible * 100.0,
        );
    }
    let (width, height) = study.size();
    if let Some(reference) = &study.reference {
        let _ = writeln!(
            text,
            "{width}×{height}; reference: f64, {REFERENCE_SAMPLES} samples per pixel, with an error of {:.1e}; 8 bits cannot show errors below {:.1e}",
            reference.rmse,
            super::EIGHT_BIT_FLOOR
        );
    }
    text.push_str("* no measurably different method is both faster and more accurate   ? the runs differ by more than 20 %\n");
    text
}

/// A line of the CSV file.
#[derive(Serialize)]
struct Figures<'a> {
    name: &'a str,
    settings: String,
    width: u32,
    height: u32,
    median_ms: f64,
    spread: f64,
    runs: usize,
    rays_per_pixel: f64,
    rmse: f64,
    psnr_db: f64,
    max: f64,
    visible_share: f64,
    on_front: bool,
    reference_rmse: f64,
    lanes: &'a str,
    threads: usize,
    machine: &'a str,
    scene: &'a str,
}

/// All measurements of studies, each with the name of its scene, as comma-separated values: one line per measurement.
///
/// # Errors
/// None is known: everything is written to memory.
pub fn csv(
    studies: &[(String, Study)],
    machine: &str,
    threads: usize,
) -> Result<String, csv::Error> {
    let rows = studies.iter();
    csv_of(rows.flat_map(|(scene, study)| figures(scene, study, (machine, threads))))
}

/// One line per complete measurement.
fn figures<'a>(
    scene: &'a str,
    study: &'a Study,
    (machine, threads): (&'a str, usize),
) -> impl Iterator<Item = Figures<'a>> {
    let front = front_of(study);
    let reference = study.reference.as_ref();
    let reference_rmse = reference.map_or(f64::NAN, |reference| reference.rmse);
    let (width, height) = study.size();
    let dots = study.measurements.iter().enumerate();
    dots.filter_map(move |(index, dot)| {
        let (timing, metrics) = (dot.timing()?, dot.metrics?);
        Some(Figures {
            name: &dot.candidate.name,
            settings: dot.candidate.words(),
            width,
            height,
            median_ms: timing.median,
            spread: timing.spread,
            runs: timing.runs,
            rays_per_pixel: dot.rays_per_pixel,
            rmse: metrics.rmse,
            psnr_db: metrics.psnr(),
            max: metrics.max,
            visible_share: metrics.visible,
            on_front: front.contains(&index),
            reference_rmse,
            lanes: &dot.lanes,
            threads,
            machine,
            scene,
        })
    })
}

/// Formats rows as comma-separated values.
///
/// # Errors
/// None is known: everything is written to memory.
pub fn csv_of(rows: impl IntoIterator<Item: Serialize>) -> Result<String, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.serialize(row)?;
    }
    let bytes = writer
        .into_inner()
        .map_err(csv::IntoInnerError::into_error)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}
