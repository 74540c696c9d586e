//! Files of other programs: meshes, camera paths, jobs for render farms, scenes for POV-Ray.

use std::error::Error;
use std::path::{Path, PathBuf};

use glam::DVec3;

use super::dialogs::Ask;
use crate::animate::{from_table, from_text, to_table, to_text};
use crate::editor::{Action, Edit, Editor, Item, Selection, free_group_name, replaced_flight};
use crate::export::{JobFiles, Pattern, Sequence, povray_text, write_job, write_text};
use crate::files::{has_ending, is_same_file};
use crate::image::Format;
use crate::mesh::{MeshFile, Part};
use crate::scene::{
    Animation, Camera, Key, MAX_BYTES, Scene, around, check, read_text, valid_name,
};
use crate::words::{counted, for_shell};

/// Factor between the sizes of a mesh and of the scene from which on the size is reported.
const ODD_SIZE_FACTOR: f64 = 20.0;

/// Reads the keys of a file; values that a table leaves out are those of `camera`.
fn read_path(path: &Path, camera: &Camera) -> Result<Vec<Key<Camera>>, String> {
    let text = read_text(path).map_err(|error| error.to_string())?;
    let keys = if is_table(path) {
        from_table(&text, camera)
    } else {
        from_text(&text)
    };
    let keys = keys.map_err(|error| format!("{}: {error}", path.display()))?;
    if keys.is_empty() {
        return Err(format!("{}: the file contains no keys", path.display()));
    }
    Ok(keys)
}

/// Replaces the camera's keys by those of a file.
pub fn import_path(editor: &mut Editor, path: &Path) {
    match read_path(path, &editor.shown().camera) {
        Ok(keys) if keys == editor.scene().animation.keys => {
            let keys = counted(keys.len(), "key");
            editor.notify(format!(
                "The camera already has the {keys} from {}",
                path.display()
            ));
        }
        Ok(keys) => {
            let count = keys.len();
            let animation = Animation {
                keys,
                take: None,
                ..Animation::clone(&editor.scene().animation)
            };
            let edit = Edit::animation(animation, "Import path");
            let replaced = replaced_flight("it", &editor.scene().animation);
            if editor.changes(Action::Edit(edit)) {
                let replaced = replaced.map_or(String::new(), |words| format!("; {words}"));
                let keys = counted(count, "key");
                editor.notify_of_step(format!("{keys} from {}{replaced}", path.display()));
            }
        }
        Err(why) => editor.report_error_in(Ask::ImportPath.title(), why),
    }
}

/// Writes the camera's keys, as CSV or RON by the ending of the file, which [`Ask::accepts`] has checked.
pub fn export_path(editor: &mut Editor, path: &Path) {
    let keys = &editor.scene().animation.keys;
    let text = if is_table(path) {
        Ok(to_table(keys.iter().map(|key| (key.time, &key.value))))
    } else {
        to_text(keys).map_err(Box::<dyn Error>::from)
    };
    let defaults = Default::default();
    let has_easing = keys
        .iter()
        .any(|key| (key.interpolation, key.easing) != defaults);
    // Someone who exports for another program may know this; someone who takes the file for a copy does not.
    let omission = if is_table(path) && has_easing {
        " without interpolation and easing of the keys; a RON file keeps them"
    } else {
        ""
    };
    match text.and_then(|text| Ok(write_text(path, &text)?)) {
        Ok(()) => editor.notify(format!("Saved {}{omission}", path.display())),
        Err(error) => editor.report_error_in(Ask::ExportPath.title(), error.to_string()),
    }
}

/// Writes the scene as the window shows it, at the playhead's time and through its camera, in POV-Ray's language.
pub fn export_povray(editor: &mut Editor, path: &Path) {
    match write_text(path, &povray_text(editor.shown())) {
        Ok(()) => editor.notify(format!("Saved {}", path.display())),
        Err(error) => editor.report_error_in(Ask::ExportPovray.title(), error.to_string()),
    }
}

/// Writes the job template, and next to it the scene in its current state, unless its own saved file is there.
pub fn export_job(editor: &mut Editor, path: &Path) {
    match write_job_files(editor, path) {
        Ok(JobFiles {
            scene,
            is_copied,
            replaced,
        }) => {
            let kept = replaced.iter().map(|(file, backup)| {
                let (file, backup) = (file.display(), backup.display());
                format!("; the previous {file} is kept as {backup}")
            });
            let kept: String = kept.collect();
            let scene = if is_copied {
                format!(" and {}", scene.display())
            } else {
                String::new()
            };
            editor.notify(format!("Saved {}{scene}{kept}", path.display()));
        }
        Err(error) => editor.report_error_in(Ask::ExportJob.title(), error.to_string()),
    }
}

fn write_job_files(editor: &Editor, path: &Path) -> Result<JobFiles, Box<dyn Error>> {
    let scene_path = editor.path();
    let job_scene = path.with_extension("ron");
    let needs_copy = editor.is_dirty() && !editor.scene().has_mesh_files();
    if needs_copy && scene_path.is_some_and(|scene_path| is_same_file(scene_path, &job_scene)) {
        let sentence = format!(
            "The job renders {} as it is on disk: save it first",
            job_scene.display()
        );
        return Err(sentence.into());
    }
    check_meshes(editor.scene())?;
    let (pattern, folder) = (Pattern::default(), PathBuf::from("frames"));
    let sequence = Sequence::new(editor.scene().clone(), None, pattern, Format::Ppm, folder)?;
    let scene_path = scene_path.filter(|_| !editor.is_dirty());
    Ok(write_job(&editor.document(), scene_path, &sequence, path)?)
}

/// Refuses to make frames of a scene with a mesh that could not be read: in a thousand files, nobody would notice.
pub fn check_meshes(scene: &Scene) -> Result<(), String> {
    let problem = scene.mesh_problems().next();
    problem.map_or(Ok(()), |(index, why)| {
        let name = &scene.objects[index].name;
        Err(format!(
            "{name:?} cannot be shown, and no frame is made without it: {why}"
        ))
    })
}

fn is_table(path: &Path) -> bool {
    has_ending(path, "csv")
}

/// Returns the camera that sees all of a box; `None` if it would be too far away.
fn camera_around(scene: &Scene, bounds: (DVec3, DVec3)) -> Option<Camera> {
    let camera = scene.camera.around(scene.render.aspect_ratio(), bounds);
    let camera_only = Scene {
        camera: camera.clone(),
        ..Scene::empty()
    };
    check(&camera_only).is_ok().then_some(camera)
}

/// Adds the parts of a mesh file as objects.
pub fn import_parts(editor: &mut Editor, path: &Path, file: MeshFile) {
    let MeshFile { parts, notes } = file;
    let count: usize = parts.iter().map(|part| part.triangles.faces().len()).sum();
    let (first, last) = (
        editor.scene().objects.len(),
        editor.scene().objects.len() + parts.len(),
    );
    let bytes = parts.iter().map(|part| part.triangles.bytes_of_text());
    if editor.scene().own_bytes() + bytes.sum::<u64>() > MAX_BYTES {
        let (name, limit) = (path.display(), MAX_BYTES >> 20);
        let quoted = for_shell(&name.to_string());
        let scene = for_shell(&path.with_file_name("NAME.ron").display().to_string());
        let why = format!(
            "{name} has {count} triangles, too many for the {limit} MiB of a scene file; `glint convert {quoted} -o {scene}` makes a scene next to it that refers to it"
        );
        return editor.report_error_in(Ask::ImportMesh.title(), why);
    }
    // If nothing else is in the scene, the camera moves to show the parts.
    let framed = if first == 0 { &parts[..] } else { &[] };
    let bounds = around(framed.iter().filter_map(|part| part.triangles.bounds()));
    let size_note = size_note(editor.shown(), &parts);
    let import = Edit::Import(parts);
    let label = import.label(editor.scene());
    let mut edits = vec![import];
    if last - first > 1 {
        // The parts of one file form a group.
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let group = free_group_name(editor.scene(), &valid_name(&stem));
        edits.push(Edit::Group((first..last).collect(), group));
    }
    let camera = bounds.and_then(|bounds| camera_around(editor.shown(), bounds));
    let frame_hint = if camera.is_some() {
        ""
    } else {
        "; F frames them"
    };
    edits.extend(camera.map(|camera| Edit::Camera(camera, "frame")));
    if !editor.changes(Action::Edit(Edit::Each(edits, label))) {
        return;
    }
    let parts = Selection::all((first..last).map(Item::object));
    editor.apply(Action::Select(parts));
    let path = path.display();
    let count = counted(count, "triangle");
    let notes = notes.iter().map(|note| format!("; {note}"));
    let notes: String = notes.collect();
    editor.notify_of_step(format!("{count} from {path}{frame_hint}{size_note}{notes}"));
}

/// Reports the size of a mesh that is far from that of the scene: mostly, it was in other units.
fn size_note(scene: &Scene, parts: &[Part]) -> String {
    let size = |(low, high): (DVec3, DVec3)| (high - low).max_element();
    let parts = around(parts.iter().filter_map(|part| part.triangles.bounds()));
    let sizes = parts.map(size).zip(scene.objects_bounds().map(size));
    let is_odd = |(parts_size, scene_size): &(f64, f64)| {
        parts_size * ODD_SIZE_FACTOR < *scene_size || *parts_size > scene_size * ODD_SIZE_FACTOR
    };
    let rounded = |size: f64| format!("{size:.2e}").parse::<f64>().unwrap_or(size);
    sizes
        .filter(is_odd)
        .map_or(String::new(), |(parts_size, scene_size)| {
            let (parts_size, scene_size) = (rounded(parts_size), rounded(scene_size));
            format!("; they measure {parts_size} units, the scene {scene_size}")
        })
}
