//! Export of scenes to the language of POV-Ray, an independent ray tracer that draws the same pictures, and rendering
//! by it.

use std::collections::HashMap;
use std::fmt::Write as _;
use std::fs::File;
use std::io;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

use glam::DVec3;

use super::error::last_lines;
use super::program::wait_for_exit;
use crate::files::without_path;
use crate::image::Image;
use crate::plan::PackedMesh;
use crate::scene::{
    Camera, Coincidence, ColorPack, CoordinateFrame, Disc, Light, Mesh, Object, Plane, Projection,
    Render, Scene, Shape, Sphere, Triangle, coincidences, unit,
};
use crate::trace::RenderControl;

/// Least channel of a pigment: POV-Ray multiplies by the pigment, so what is added has to be divided by it first.
const MIN_CHANNEL: f64 = 1e-6;

/// The reason why POV-Ray has drawn no picture.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PovrayError {
    /// POV-Ray was not found.
    #[error(
        "POV-Ray is not installed, or not on the PATH: `apt install povray` on Debian and Ubuntu, `brew install povray` on macOS"
    )]
    Missing,
    /// It was stopped.
    #[error("POV-Ray was stopped")]
    Stopped,
    /// It ended with an error.
    #[error("POV-Ray failed:\n{0}")]
    Failed(String),
    /// Its files could not be written or read.
    #[error(
        "cannot use the folder for temporary files (TMPDIR), which POV-Ray's files go to: {path}: {source}",
        path = .path.display()
    )]
    Disk {
        /// The file.
        path: PathBuf,
        /// Error of the system.
        source: io::Error,
    },
    /// Its picture could not be read.
    #[error("cannot read the picture by POV-Ray: {0}")]
    Picture(#[from] image::ImageError),
}

/// Returns the scene in POV-Ray's language. POV-Ray's highlights have the colour of the light: objects whose
/// highlights have another colour go into a light group with lights of that colour. POV-Ray clips colours above white
/// once at the end; Glint also clips them at each mirror.
pub fn povray_text(scene: &Scene) -> String {
    let mut pov = String::new();
    let level = scene.render.reflection_limit + 1;
    let Render { width, height, .. } = scene.render;
    let _ = writeln!(
        pov,
        "// By Glint. Draw it with povray +W{width} +H{height} -A File_Gamma=1.0 Dither=off, and +I with its name.\n#version 3.7;\nglobal_settings {{ assumed_gamma 1 max_trace_level {level} adc_bailout 0 ambient_light rgb {:?} }}\nbackground {{ {} }}",
        scene.ambient_intensity,
        color(scene.background)
    );
    write_camera(
        &mut pov,
        &scene.camera,
        f64::from(width) / f64::from(height),
    );
    for light in scene.visible_lights() {
        write_light(&mut pov, light, DVec3::ONE);
        write_marker(&mut pov, scene, light);
    }
    let total: f64 = scene.visible_lights().map(|light| light.intensity).sum();
    let mut shapes_by_pack: HashMap<&str, Vec<&Shape>> = HashMap::new();
    for object in scene.visible_objects() {
        let shapes = shapes_by_pack.entry(&object.color_pack).or_default();
        shapes.push(&object.shape);
    }
    for (name, pack) in scene.color_packs.iter() {
        let Some(pack_shapes) = shapes_by_pack.get(name.as_str()) else {
            continue;
        };
        let texture = texture(pack, total);
        let mut shapes = String::new();
        for shape in pack_shapes {
            write_shape(&mut shapes, shape, &texture);
        }
        if shapes.is_empty() {
            continue; // A mesh may have no faces.
        }
        let highlight = Highlight::of(pack);
        if highlight.is_white() {
            pov.push_str(&shapes);
        } else {
            pov.push_str("light_group {\n");
            for light in scene.visible_lights() {
                write_light(&mut pov, light, highlight.color);
            }
            let _ = writeln!(pov, "{shapes}global_lights off }}");
        }
    }
    pov
}

/// Share of the light that a highlight reflects, and its colour.
struct Highlight {
    share: f64,
    color: DVec3,
}

impl Highlight {
    fn of(pack: &ColorPack) -> Self {
        let share = pack.specular.max_element() / 255.0;
        let color = if share > 0.0 {
            (pack.specular / (share * 255.0)).max(DVec3::splat(MIN_CHANNEL))
        } else {
            DVec3::ONE
        };
        Self { share, color }
    }

    fn is_white(&self) -> bool {
        self.color == DVec3::ONE
    }
}

fn vector(v: DVec3) -> String {
    format!("<{:?},{:?},{:?}>", v.x, v.y, v.z)
}

fn color(v: DVec3) -> String {
    format!("rgb {}", vector(v * (1.0 / 255.0)))
}

fn write_camera(pov: &mut String, camera: &Camera, aspect: f64) {
    let Some(basis) = camera.basis() else { return };
    let (kind, scale, distance) = match camera.projection {
        Projection::Perspective => ("perspective", 1.0, camera.projection_distance),
        Projection::Orthographic => ("orthographic", camera.orthographic_height, 1.0),
    };
    let _ = writeln!(
        pov,
        "camera {{ {kind} location {} direction {} right {} up {} }}",
        vector(camera.position),
        vector(-basis.z_axis * distance),
        vector(basis.x_axis * (scale * aspect)),
        vector(basis.y_axis * scale)
    );
}

fn write_light(pov: &mut String, light: &Light, color: DVec3) {
    let (at, color) = (vector(light.position), vector(color * light.intensity));
    let _ = writeln!(pov, "light_source {{ {at} rgb {color} }}");
}

fn write_marker(pov: &mut String, scene: &Scene, light: &Light) {
    let marker = light.marker.as_ref().filter(|_| scene.light_visualization);
    if let Some(marker) = marker
        && let Some(pack) = scene.color_packs.get(&marker.color_pack)
    {
        let (at, radius, color) = (vector(light.position), marker.radius, color(pack.ambient));
        let _ = writeln!(
            pov,
            "sphere {{ {at}, {radius:?} pigment {{ {color} }} finish {{ ambient 0 diffuse 0 emission 1 }} no_shadow }}"
        );
    }
}

fn write_shape(pov: &mut String, shape: &Shape, texture: &str) {
    let _ = match shape {
        Shape::Sphere(Sphere { center, radius }) => {
            writeln!(
                pov,
                "sphere {{ {}, {radius:?} {texture} }}",
                vector(*center)
            )
        }
        Shape::Plane(Plane { point, normal }) => {
            let normal = unit(*normal).unwrap_or(DVec3::Y);
            let (direction, offset) = (vector(normal), normal.dot(*point));
            writeln!(pov, "plane {{ {direction}, {offset:?} {texture} }}")
        }
        Shape::Disc(Disc {
            center,
            normal,
            radius,
        }) => {
            let (center, normal) = (vector(*center), vector(*normal));
            writeln!(pov, "disc {{ {center}, {normal}, {radius:?} {texture} }}")
        }
        Shape::Triangle(Triangle { a, b, c }) => {
            let [a, b, c] = [a, b, c].map(|corner| vector(*corner));
            writeln!(pov, "triangle {{ {a}, {b}, {c} {texture} }}")
        }
        Shape::Mesh(mesh) => {
            let mut faces = String::new();
            write_faces(&mut faces, mesh);
            // POV-Ray accepts no mesh without faces.
            if faces.is_empty() {
                return;
            }
            writeln!(pov, "mesh {{\n{faces}{texture} }}")
        }
    };
}

/// Writes the faces as the tracer has them: with the same normals if they are shaded smoothly.
fn write_faces(pov: &mut String, mesh: &Mesh) {
    let packed = PackedMesh::new(mesh);
    let middle = packed.middle_of(mesh);
    for (index, triangle) in packed.triangles.iter().enumerate() {
        let [a, b, c] = triangle
            .corners
            .map(|corner| vector(corner.to_dvec3() + middle));
        let _ = match packed.smooth.get(index) {
            None => writeln!(pov, "triangle {{ {a}, {b}, {c} }}"),
            Some(smooth) => {
                let [k, l, m] = smooth.normals.map(|normal| vector(normal.to_dvec3()));
                writeln!(pov, "smooth_triangle {{ {a}, {k}, {b}, {l}, {c}, {m} }}")
            }
        };
    }
}

fn texture(pack: &ColorPack, total_intensity: f64) -> String {
    let highlight = Highlight::of(pack);
    // The lights have the colour of the highlight, and only the highlight is to have it, so the pigment is divided by
    // it. POV-Ray multiplies ambient light by the pigment, so that is divided by the pigment.
    let pigment = pack.diffuse.max(DVec3::splat(MIN_CHANNEL * 255.0)) / highlight.color;
    let share = pack.ambient / pigment;
    let specular = highlight.share;
    let mirror = if pack.reflective {
        pack.specular * (total_intensity / 255.0)
    } else {
        DVec3::ZERO
    };
    // An exponent of 0 is as wide as a highlight can be.
    let roughness = 1.0 / pack.phong_exponent.max(MIN_CHANNEL);
    format!(
        "pigment {{ {} }} finish {{ ambient rgb {} diffuse 1 specular {specular:?} roughness {roughness:?} reflection {{ rgb {} }} }}",
        color(pigment),
        vector(share),
        vector(mirror)
    )
}

/// Sizes of objects that POV-Ray draws, in world units: of triangles of size 1e-6 or 1e7, it draws nothing.
const DRAWN_SIZES: RangeInclusive<f64> = 1e-5..=1e6;

/// Describes, for the user, how the pictures of a scene by Glint and by POV-Ray differ beyond rounding because their
/// models differ.
pub fn povray_differences(scene: &Scene) -> Vec<&'static str> {
    let visible = || scene.visible_objects();
    let is_mirror = |object: &Object| {
        let pack = scene.color_packs.get(&object.color_pack);
        pack.is_some_and(|pack| pack.reflective)
    };
    let clipped = visible().any(is_mirror).then_some(
        "in mirrors, colours brighter than white are limited to white in Glint, and not in POV-Ray",
    );
    let lifted = visible().any(Object::is_smooth).then_some(
        "on smooth meshes, light ends at the curved surface in Glint, and at the flat faces in POV-Ray",
    );
    let is_drawn_by_povray = |object: &Object| {
        let size = object
            .shape
            .bounds()
            .map(|(low, high)| (high - low).max_element());
        size.is_none_or(|size| DRAWN_SIZES.contains(&size))
    };
    let undrawn = (!visible().all(is_drawn_by_povray)).then_some(
        "objects smaller than a hundred-thousandth of a unit, or larger than a million, may be missing in POV-Ray",
    );
    let centre = CoordinateFrame::of(scene).map_or(DVec3::ZERO, |frame| frame.centre);
    let is_visible_overlap = |found: &Coincidence| {
        !found.extent.is_hidden() && !scene.look_alike(found.later, found.earlier)
    };
    let found = coincidences(&scene.objects, centre);
    let coincident = found.iter().any(is_visible_overlap).then_some(
        "where surfaces coincide, Glint shows the first in the list, and POV-Ray either of them",
    );
    let all = [clipped, lifted, undrawn, coincident];
    all.into_iter().flatten().collect()
}

/// What POV-Ray has drawn.
#[derive(Debug)]
pub struct ByPovray {
    /// The picture, one ray through the middle of each pixel.
    pub picture: Image,
    /// Tracing time by its own clock, without startup and parsing.
    pub time: Duration,
    /// Number of rays of all kinds, shadow rays included.
    pub rays: u64,
}

/// Resolution of POV-Ray's clock: a time that it reports as 0 was at most this long.
const CLOCK_RESOLUTION: Duration = Duration::from_millis(1);

/// Parses POV-Ray's statistics: the tracing time and the number of rays.
fn statistics(log: &str) -> Option<(Duration, u64)> {
    let after = |word: &str| log.split_once(word).map(|(_, rest)| rest.trim_start());
    let number = |word: &str| {
        let digits = after(word)?.split(|c: char| !c.is_ascii_digit()).next()?;
        digits.parse::<u64>().ok()
    };
    let seconds = after("Trace Time:")?.split_once('(')?.1;
    let seconds = seconds.split_once(" seconds)")?.0.parse().ok()?;
    let time = Duration::try_from_secs_f64(seconds)
        .ok()?
        .max(CLOCK_RESOLUTION);
    // Without lights there are no shadow tests.
    let shadows = number("Shadow Ray Tests:").unwrap_or(0);
    Some((time, number("Rays:")? + shadows))
}

/// Has POV-Ray draw a scene, in a temporary folder that is removed afterwards. `control` can stop it.
///
/// # Errors
/// [`PovrayError`].
pub fn by_povray(
    scene: &Scene,
    threads: usize,
    control: &RenderControl,
) -> Result<ByPovray, PovrayError> {
    let disk = |path: &Path| {
        let path = path.to_owned();
        move |source| PovrayError::Disk { path, source }
    };
    let folder = tempfile::tempdir().map_err(without_path);
    let folder = folder.map_err(disk(&std::env::temp_dir()))?;
    let folder = folder.path();
    let path = folder.join("scene.pov");
    std::fs::write(&path, povray_text(scene)).map_err(disk(&path))?;
    // To a file: a pipe could fill up and block it.
    let path = folder.join("said.txt");
    let log = File::create(&path).map_err(disk(&path))?;
    let Render { width, height, .. } = scene.render;
    let run = Command::new("povray")
        .args(["+Iscene.pov", "+Oscene.png", "-D", "+FN8", "-A"])
        .args(["Dither=off", "File_Gamma=1.0"])
        .args([
            format!("+W{width}"),
            format!("+H{height}"),
            format!("+WT{threads}"),
        ])
        .current_dir(folder)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(log)
        .spawn();
    let mut child = run.map_err(|source| match source.kind() {
        io::ErrorKind::NotFound => PovrayError::Missing,
        _ => PovrayError::Failed(format!("it cannot be started: {source}")),
    })?;
    let is_wanted = || !control.is_stopped();
    let status = wait_for_exit(&mut child, is_wanted).map_err(disk(Path::new("povray")))?;
    let status = status.ok_or(PovrayError::Stopped)?;
    let log = std::fs::read(&path).map_err(disk(&path))?;
    let failed = || PovrayError::Failed(last_lines(&log));
    if !status.success() {
        return Err(failed());
    }
    let (time, rays) = statistics(&String::from_utf8_lossy(&log)).ok_or_else(failed)?;
    let picture = image::open(folder.join("scene.png"))?.to_rgba8();
    Ok(ByPovray {
        picture: Image::from(&picture),
        time,
        rays,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_povray_tells_is_understood() {
        let said = "Parse Time:   0 minutes (1.500 seconds)\nRays:    382467   Saved: 0\n\
            Shadow Ray Tests:   309295   Succeeded: 104923\n\
            Trace Time:   0 hours  0 minutes  0 seconds (0.079 seconds)\n using 2 thread(s)";
        let expected = (Duration::from_millis(79), 691_762);
        assert_eq!(statistics(said), Some(expected));
        let quick = said.replace("0.079", "0.000");
        let least = (Duration::from_millis(1), 691_762);
        assert_eq!(statistics(&quick), Some(least));
        assert_eq!(statistics("POV-Ray finished"), None);
    }

    #[test]
    fn surfaces_that_lie_in_each_other_are_known_to_differ() {
        let mut scene = Scene::demo();
        let say_so = |scene: &Scene| {
            let said = povray_differences(scene);
            said.iter().any(|words| words.contains("surfaces coincide"))
        };
        assert!(!say_so(&scene));
        let copy = Object {
            name: "copy".to_owned(),
            ..scene.objects[0].clone()
        };
        scene.objects.push(copy.clone());
        assert!(!say_so(&scene), "they look alike");
        let index = scene.objects.len() - 1;
        scene.objects[index] = Object {
            color_pack: "sphere 2".to_owned(),
            ..copy
        };
        assert!(say_so(&scene));
    }

    #[test]
    fn what_has_highlights_in_a_colour_has_lights_of_its_own() {
        let mut scene = Scene::demo();
        for pack in scene.packs_mut().values_mut() {
            pack.specular = DVec3::splat(90.0);
        }
        assert!(!povray_text(&scene).contains("light_group"));
        let pack = scene.objects[0].color_pack.clone();
        if let Some(pack) = scene.packs_mut().get_mut(&pack) {
            pack.specular = DVec3::new(200.0, 100.0, 0.0);
        }
        let text = povray_text(&scene);
        assert_eq!(text.matches("light_group").count(), 1);
        let visible = scene.visible_lights().count();
        assert_eq!(text.matches("light_source").count(), 2 * visible);
    }
}
