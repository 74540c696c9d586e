//! Scenes in the language of POV-Ray, an independent engine that draws the same pictures, and what it makes of
//! them.

use std::fmt::Write as _;
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use glam::DVec3;

use super::error::last_lines;
use crate::image::Image;
use crate::plan::PackedMesh;
use crate::scene::{
    Camera, ColorPack, Disc, Light, Mesh, Plane, Projection, Render, Scene, Shape, Sphere,
    Triangle, unit,
};

/// The least of a colour that light is multiplied with: what is added to it has to be divided by it first.
const LEAST: f64 = 1e-6;

/// Why POV-Ray has drawn no picture.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PovrayError {
    /// It is not there.
    #[error(
        "POV-Ray is not installed, or not on the PATH: `apt install povray` on Debian and Ubuntu, `brew install povray` on macOS"
    )]
    Missing,
    /// It ended with an error.
    #[error("POV-Ray failed:\n{0}")]
    Failed(String),
    /// Its files could not be written or read.
    #[error("{path}: {source}", path = .path.display())]
    Disk {
        /// The file.
        path: PathBuf,
        /// What the system answered.
        source: io::Error,
    },
    /// Its picture could not be read.
    #[error("cannot read what POV-Ray has drawn: {0}")]
    Picture(#[from] image::ImageError),
}

/// The scene in POV-Ray's language. Highlights are grey there: of one in a colour the mean is taken. Colours above
/// white are cut off at the end there, and here at each mirror as well.
pub fn povray_text(scene: &Scene) -> String {
    let mut pov = String::new();
    let lights = || scene.lights.iter().filter(|light| light.visible);
    let total: f64 = lights().map(|light| light.intensity).sum();
    let level = scene.render.reflection_limit + 1;
    let Render { width, height, .. } = scene.render;
    let _ = writeln!(
        pov,
        "// By Glint. povray +Iscene.pov +W{width} +H{height} -A File_Gamma=1.0 Dither=off\n#version 3.7;\nglobal_settings {{ assumed_gamma 1 max_trace_level {level} adc_bailout 0 ambient_light rgb {:?} }}\nbackground {{ {} }}",
        scene.ambient_intensity,
        color(scene.background)
    );
    write_camera(
        &mut pov,
        &scene.camera,
        f64::from(width) / f64::from(height),
    );
    for light in lights() {
        write_light(&mut pov, scene, light);
    }
    for object in scene.objects.iter().filter(|object| object.visible) {
        let pack = scene.color_packs.get(&object.color_pack);
        let texture = pack.map_or(String::new(), |pack| texture(pack, total));
        write_shape(&mut pov, &object.shape, &texture);
    }
    pov
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

fn write_light(pov: &mut String, scene: &Scene, light: &Light) {
    let (at, intensity) = (vector(light.position), light.intensity);
    let _ = writeln!(pov, "light_source {{ {at} rgb {intensity:?} }}");
    let marker = light.marker.as_ref().filter(|_| scene.light_visualization);
    if let Some(marker) = marker
        && let Some(pack) = scene.color_packs.get(&marker.color_pack)
    {
        let (radius, color) = (marker.radius, color(pack.ambient));
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
            let (across, offset) = (vector(normal), normal.dot(*point));
            writeln!(pov, "plane {{ {across}, {offset:?} {texture} }}")
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
            let _ = writeln!(pov, "mesh {{");
            write_faces(pov, mesh);
            writeln!(pov, "{texture} }}")
        }
    };
}

/// The faces as the tracer has them: with the same normals where they are shaded as a curved surface.
fn write_faces(pov: &mut String, mesh: &Mesh) {
    let packed = PackedMesh::<f64>::new(mesh);
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
    // What a surface shows by itself is multiplied with its colour there.
    let pigment = pack.diffuse.max(DVec3::splat(LEAST * 255.0));
    let share = pack.ambient / pigment;
    let specular = pack.specular.element_sum() / (3.0 * 255.0);
    let mirror = if pack.reflective {
        pack.specular * (total_intensity / 255.0)
    } else {
        DVec3::ZERO
    };
    // A sharpness of nought is as wide as a highlight can be.
    let roughness = 1.0 / pack.phong_exponent.max(LEAST);
    format!(
        "pigment {{ {} }} finish {{ ambient rgb {} diffuse 1 specular {specular:?} roughness {roughness:?} reflection {{ rgb {} }} }}",
        color(pigment),
        vector(share),
        vector(mirror)
    )
}

/// What POV-Ray has drawn, and how long it took for all of it, reading the scene included.
#[derive(Debug)]
pub struct ByPovray {
    /// The picture, one ray through the middle of each pixel.
    pub picture: Image,
    /// From its start to its end.
    pub time: Duration,
}

/// Lets POV-Ray draw a scene, in a folder for its files.
///
/// # Errors
/// [`PovrayError`].
pub fn by_povray(scene: &Scene, folder: &Path, threads: usize) -> Result<ByPovray, PovrayError> {
    let path = folder.join("scene.pov");
    std::fs::write(&path, povray_text(scene))
        .map_err(|source| PovrayError::Disk { path, source })?;
    let Render { width, height, .. } = scene.render;
    let start = std::time::Instant::now();
    let run = Command::new("povray")
        .args(["+Iscene.pov", "+Oscene.png", "-D", "+FN8", "-A"])
        .args(["Dither=off", "File_Gamma=1.0"])
        .args([
            format!("+W{width}"),
            format!("+H{height}"),
            format!("+WT{threads}"),
        ])
        .current_dir(folder)
        .output();
    let time = start.elapsed();
    let output = run.map_err(|source| match source.kind() {
        io::ErrorKind::NotFound => PovrayError::Missing,
        _ => PovrayError::Disk {
            path: PathBuf::from("povray"),
            source,
        },
    })?;
    if !output.status.success() {
        return Err(PovrayError::Failed(last_lines(&output.stderr)));
    }
    let picture = image::open(folder.join("scene.png"))?.to_rgba8();
    Ok(ByPovray {
        picture: Image {
            width: width as usize,
            height: height as usize,
            pixels: picture.pixels().map(|pixel| pixel.0).collect(),
        },
        time,
    })
}
