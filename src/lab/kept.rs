//! Studies stored on disk, so that they need not be measured again when a scene is reopened.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::candidates::{OWN_SETTINGS, POVRAY};
use super::measure::ErrorMetrics;
use super::study::{REFERENCE_SAMPLES, Reference, Study};
use crate::export::{fingerprint, save_image, write_text};
use crate::files::{make_folder, remove_oldest};
use crate::image::{Film, Format, Image};
use crate::scene::{Render, Scene, read_text};

/// Most studies that are stored, each in two files; older ones are removed.
const MAX_STUDIES: usize = 24;

/// A study as it is stored, except its pictures.
#[derive(Serialize, Deserialize)]
struct KeptStudy {
    /// The machine that it was measured on: times are not valid on another one.
    machine: String,
    width: u32,
    height: u32,
    /// Samples per pixel of the reference: errors are not valid for another one.
    reference_samples: u32,
    reference_rmse: f64,
    /// The scene's own settings, if they were measured as a separate way.
    #[serde(default)]
    own: Option<Render>,
    dots: Vec<KeptDot>,
}

/// A measurement as it is stored.
#[derive(Serialize, Deserialize)]
struct KeptDot {
    name: String,
    rmse: f64,
    max: f64,
    visible: f64,
    rays_per_pixel: f64,
    times: Vec<f64>,
    lanes: String,
}

/// The files for the study of a scene. Their names do not depend on the methods that the scene chooses, because those
/// are what is compared.
fn file_paths(folder: &Path, scene: &Scene) -> Option<(PathBuf, PathBuf)> {
    let neutral = Scene {
        render: Render {
            reflection_limit: scene.render.reflection_limit,
            width: scene.render.width,
            height: scene.render.height,
            ..Render::default()
        },
        ..scene.clone()
    };
    let name = fingerprint(&neutral, Format::Png).ok()?.to_hex();
    let file = |ending| folder.join(format!("{}.{ending}", &name[..32]));
    Some((file("ron"), file("png")))
}

/// The scene's own settings, if they were measured as a separate way. They may change later.
fn own_settings_of(study: &Study) -> Option<Render> {
    let mut dots = study.measurements.iter();
    let own = dots.find(|dot| dot.candidate.name == OWN_SETTINGS)?;
    Some(own.candidate.render.clone())
}

/// Stores a complete study, with its pictures stacked in one image. If that fails, it is measured again another time.
pub fn keep(study: &Study, machine: &str, folder: &Path) {
    // The error is ignored: nothing waits for the files, and nothing is lost without them.
    let _ = try_keep(study, machine, folder);
}

fn try_keep(study: &Study, machine: &str, folder: &Path) -> Option<()> {
    let (figures, pictures) = file_paths(folder, study.scene())?;
    let reference = study.reference.as_ref()?;
    let mut stacked = Image::clone(&reference.picture);
    let mut dots = Vec::new();
    for dot in &study.measurements {
        let (metrics, picture) = (dot.metrics?, dot.picture.as_ref()?);
        stacked.pixels.extend(&picture.pixels);
        dots.push(KeptDot {
            name: dot.candidate.name.clone(),
            rmse: metrics.rmse,
            max: metrics.max,
            visible: metrics.visible,
            rays_per_pixel: dot.rays_per_pixel,
            times: dot.times.clone(),
            lanes: dot.lanes.clone(),
        });
    }
    stacked.height *= 1 + dots.len();
    let (width, height) = study.size();
    let kept = KeptStudy {
        machine: machine.to_owned(),
        width,
        height,
        reference_samples: REFERENCE_SAMPLES,
        reference_rmse: reference.rmse,
        own: own_settings_of(study),
        dots,
    };
    make_folder(folder).ok()?;
    save_image(&Film::Levels(stacked), &pictures).ok()?;
    write_text(&figures, &ron::to_string(&kept).ok()?).ok()?;
    remove_oldest(folder, 2 * MAX_STUDIES);
    Some(())
}

/// Loads the study of this scene on this machine; `None` if there is none, or if other ways were measured.
pub fn kept(scene: &Arc<Scene>, side: u32, machine: &str, folder: &Path) -> Option<Study> {
    let (figures, pictures) = file_paths(folder, scene)?;
    let kept: KeptStudy = ron::from_str(&read_text(&figures).ok()?).ok()?;
    let mut study = Study::of_side(Arc::clone(scene), side);
    if kept.dots.last().is_some_and(|dot| dot.name == POVRAY) {
        study = study.with_povray();
    }
    let has_same_settings = own_settings_of(&study) == kept.own;
    let is_counted = |name: &str| has_same_settings || name != OWN_SETTINGS;
    study
        .measurements
        .retain(|dot| is_counted(&dot.candidate.name));
    let names = kept.dots.iter().map(|dot| &dot.name);
    let names = names.filter(|name| is_counted(name));
    let is_same = names.eq(study.measurements.iter().map(|dot| &dot.candidate.name))
        && kept.machine == machine
        && kept.reference_samples == REFERENCE_SAMPLES
        && (kept.width, kept.height) == study.size();
    if !is_same {
        return None;
    }
    let stacked = Image::from(&image::open(&pictures).ok()?.to_rgba8());
    let (width, height) = (kept.width as usize, kept.height as usize);
    let mut images = stacked.pixels.chunks_exact(width * height).map(|pixels| {
        Arc::new(Image {
            width,
            height,
            pixels: pixels.to_vec(),
        })
    });
    study.reference = Some(Reference {
        rmse: kept.reference_rmse,
        picture: images.next()?,
    });
    if images.len() < kept.dots.len() {
        return None;
    }
    let figures = kept.dots.into_iter().zip(images);
    let figures = figures.filter(|(dot, _)| is_counted(&dot.name));
    for (dot, (kept, picture)) in study.measurements.iter_mut().zip(figures) {
        dot.metrics = Some(ErrorMetrics {
            rmse: kept.rmse,
            max: kept.max,
            visible: kept.visible,
        });
        dot.rays_per_pixel = kept.rays_per_pixel;
        dot.times = kept.times;
        dot.lanes = kept.lanes;
        dot.picture = Some(picture);
    }
    Some(study)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Sampling, SphereMethod};
    use crate::trace::RenderControl;

    #[test]
    fn a_study_is_there_again_for_its_scene_and_machine_alone() {
        let folder = tempfile::tempdir().expect("a folder");
        let folder = folder.path().join("lab");
        let scene = Arc::new(Scene::demo());
        let mut study = Study::of_side(Arc::clone(&scene), 16);
        while study.step(&RenderControl::default()) {}
        keep(&study, "here", &folder);
        let again = kept(&scene, 16, "here", &folder).expect("it was kept");
        assert_eq!(again.progress(), 1.0);
        assert_eq!(again.costs(), study.costs());
        let pictures = |study: &Study| {
            let dots = study.measurements.iter();
            let pictures: Vec<_> = dots.map(|dot| dot.picture.clone()).collect();
            (
                pictures,
                study.reference.as_ref().map(|r| r.picture.clone()),
            )
        };
        assert_eq!(pictures(&again), pictures(&study));
        assert!(kept(&scene, 16, "there", &folder).is_none());
        assert!(kept(&scene, 24, "here", &folder).is_none());
        let mut other = Scene::demo();
        other.ambient_intensity += 0.01;
        assert!(kept(&Arc::new(other), 16, "here", &folder).is_none());
        // The study of the scene's own settings is found again as long as the scene has them.
        let mut own = Scene::clone(&scene);
        own.render.sphere = SphereMethod::Classic;
        own.render.antialias = Sampling::Grid(3);
        let own = Arc::new(own);
        let mut study = Study::of_side(Arc::clone(&own), 16);
        while study.step(&RenderControl::default()) {}
        keep(&study, "here", &folder);
        let again = kept(&own, 16, "here", &folder).expect("it was kept");
        assert!(own_settings_of(&again).is_some());
        assert_eq!(again.costs(), study.costs());
        assert_eq!(pictures(&again), pictures(&study));
        let without = kept(&scene, 16, "here", &folder).expect("it was kept");
        assert!(own_settings_of(&without).is_none());
        assert_eq!(without.progress(), 1.0);
        let (_, pictures) = file_paths(&folder, &scene).expect("files");
        std::fs::write(pictures, "no picture").expect("written");
        assert!(kept(&scene, 16, "here", &folder).is_none());
    }
}
