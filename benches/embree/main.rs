//! Comparison with Embree 3, if that is installed: `cargo bench --bench embree`. Both draw the same scenes with the
//! same shading on two threads; Embree with ray packets of 8 and of 16 (`peer.cpp`, which is compiled on every run).
//! Compare columns within one row. After `--`, scene files can be named; `--growth=FILE.png` instead draws how cost
//! grows, with Embree and POV-Ray included, and writes the figures to FILE.csv.

#![allow(
    clippy::expect_used,
    clippy::print_stdout,
    reason = "a benchmark that cannot go on has failed, and the table is what it is for"
)]

use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use std::time::Instant;

use glam::DVec3;
use glint::export::{save_image, write_text};
use glint::image::{Film, Image, render_into};
use glint::lab::{Crowd, Figure, Growth, PictureLook, RenderMethod, csv_of};
use glint::plan::{Planner, RenderRequest};
use glint::scene::{Document, EXAMPLES, Plane, Projection, Sampling, Scene, Shape};
use glint::trace::{RenderControl, Threads};
use glint::ui::drawn;

/// The compiled program that draws with Embree.
const PEER: &str = concat!(env!("CARGO_TARGET_TMPDIR"), "/embree");
/// Side of the pictures in pixels.
const SIDE: u32 = 1024;
/// Threads of both programs.
const THREADS: usize = 2;
/// Runs of each, of which the fastest counts.
const ROUNDS: usize = 10;
/// Half the side, in world units, of the square that replaces a plane, which Embree lacks: far enough to reach the
/// last row of pixels below most horizons, and near enough for mirrors, in which the error grows with the size of the
/// square.
const ENDLESS: f64 = 1e5;

/// Most points: their indices are passed as `f32`, which is exact up to this number.
const MAX_POINTS: usize = 1 << 24;

fn main() {
    if !build_peer().is_ok_and(|built| built.status.success()) {
        println!("Embree 3 or a C++ compiler is not here (Debian: libembree-dev, g++)");
        return;
    }
    let words = || std::env::args().skip(1);
    if let Some(file) = words().find_map(|word| word.strip_prefix("--growth=").map(str::to_owned)) {
        chart_growth(file.as_ref());
        return;
    }
    println!(
        "{:<22} {:>9} {:>9} {:>11} {:>12} {:>10} {:>9}",
        "scene", "things", "Glint ms", "Embree 8 ms", "Embree 16 ms", "of faster", "alike"
    );
    // `cargo bench` itself adds an option.
    let mut files = words().filter(|word| !word.starts_with('-')).peekable();
    if files.peek().is_some() {
        for file in files {
            let document = Document::load(file.as_ref()).expect("a scene");
            print_row(&file, document.scene);
        }
        return;
    }
    for (name, scene) in scenes() {
        print_row(&name, scene);
    }
}

fn build_peer() -> std::io::Result<Output> {
    let source = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/embree/peer.cpp");
    let flags = [
        "-O3",
        "-march=native",
        "-ffast-math",
        "-fopenmp-simd",
        "-mprefer-vector-width=512",
        "-std=c++17",
        "-o",
    ];
    Command::new("c++")
        .args(flags)
        .args([PEER, source, "-lembree3", "-lpthread"])
        .output()
}

/// Draws how cost grows with the number of primitives, for all three engines.
fn chart_growth(file: &Path) {
    let threads = Threads::new(Some(THREADS)).expect("threads");
    let most = 1_000_000;
    let mut growth = Growth::new(SIDE, most)
        .with_povray()
        .with(RenderMethod::Embree, |scene| {
            by_embree(scene).map(|drawn| drawn.fastest())
        });
    while threads.run(|| growth.step()) {
        println!("{:.0} %", growth.progress() * 100.0);
    }
    for obstacle in &growth.obstacles {
        println!("{obstacle}");
    }
    let csv = csv_of(&growth.costs).expect("written");
    write_text(&file.with_extension("csv"), &csv).expect("written");
    let look = PictureLook {
        is_light: false,
        size: (1600, 960),
    };
    let picture = drawn(&Figure::Growth(growth, look));
    save_image(&Film::Levels(picture), file).expect("written");
}

fn scenes() -> impl Iterator<Item = (String, Scene)> {
    let published = EXAMPLES
        .iter()
        .filter(|example| ["demo", "mirrors"].contains(&example.name));
    let published = published.map(|example| (example.name.to_owned(), example.document().scene));
    let crowds = [
        (
            Crowd::Mesh,
            "mesh",
            &[100, 1_000, 10_000, 100_000, 1_000_000][..],
        ),
        (Crowd::Balls, "balls", &[100, 1_000, 10_000, 100_000]),
    ];
    let crowds = crowds.into_iter().flat_map(|(crowd, name, counts)| {
        let scenes = counts.iter().map(move |&count| crowd.scene(count));
        scenes.map(move |scene| (name.to_owned(), scene))
    });
    published.chain(crowds)
}

/// Embree's result for a scene.
struct Drawn {
    /// Milliseconds with packets of 8 and of 16 rays.
    times: [f64; 2],
    /// Red, green and blue of each pixel.
    picture: Vec<u8>,
}

impl Drawn {
    fn fastest(&self) -> f64 {
        self.times[0].min(self.times[1])
    }
}

fn by_embree(scene: &Scene) -> Result<Drawn, String> {
    let numbers = numbers_of(scene)
        .ok_or("it is not for this benchmark: discs, parallel rays, or too many points")?;
    let folder = tempfile::tempdir().expect("a folder");
    let (file, picture) = (folder.path().join("scene"), folder.path().join("picture"));
    let bytes: Vec<u8> = numbers.iter().flat_map(|it| it.to_le_bytes()).collect();
    fs::write(&file, bytes).expect("written");
    let output = Command::new(PEER).args([&file, &picture]).output();
    let output = output.expect("it was built");
    assert!(output.status.success(), "{output:?}");
    let times = String::from_utf8_lossy(&output.stdout);
    let mut times = times
        .split_whitespace()
        .map(|time| time.parse().expect("a time"));
    Ok(Drawn {
        times: [(); 2].map(|()| times.next().expect("two times")),
        picture: fs::read(&picture).expect("written"),
    })
}

fn print_row(name: &str, mut scene: Scene) {
    (scene.render.width, scene.render.height) = (SIDE, SIDE);
    scene.light_visualization = false;
    let drawn = match by_embree(&scene) {
        Ok(drawn) => drawn,
        Err(obstacle) => {
            println!("{name:<22} {obstacle}");
            return;
        }
    };
    let (ours, image) = by_glint(&scene);
    let is_alike = |(ours, theirs): &(&[u8; 4], &[u8])| {
        ours.iter().zip(*theirs).all(|(a, b)| a.abs_diff(*b) <= 1)
    };
    let alike = image
        .pixels
        .iter()
        .zip(drawn.picture.chunks(3))
        .filter(is_alike)
        .count();
    println!(
        "{name:<22} {:>9} {ours:>9.2} {:>11.2} {:>12.2} {:>10.2} {:>7.3} %",
        scene.objects.len() + scene.faces(),
        drawn.times[0],
        drawn.times[1],
        ours / drawn.fastest(),
        alike as f64 / f64::from(SIDE * SIDE) * 100.0
    );
}

/// Returns the milliseconds of the fastest run, and the picture.
fn by_glint(scene: &Scene) -> (f64, Image) {
    let request = RenderRequest {
        sampling: Sampling::Centres,
        ..RenderRequest::still(scene)
    };
    let threads = Threads::new(Some(THREADS)).expect("threads");
    // Reuses the image of the last run, as the window does.
    let (mut image, mut planner) = (Image::default(), Planner::default());
    let mut draw = || {
        let since = Instant::now();
        let control = RenderControl::default();
        let drawn =
            threads.run(|| render_into(&mut image, &mut planner, scene, &request, &control));
        drawn.expect("not stopped");
        since.elapsed().as_secs_f64() * 1e3
    };
    draw();
    let milliseconds = (0..ROUNDS).map(|_| draw()).fold(f64::INFINITY, f64::min);
    (milliseconds, image)
}

/// The scene in the format that `peer.cpp` reads; `None` if that does not support all of it.
fn numbers_of(scene: &Scene) -> Option<Vec<f32>> {
    let camera = &scene.camera;
    if camera.projection != Projection::Perspective {
        return None;
    }
    let back = -camera.look_at.normalize();
    let right = camera.up.cross(back).normalize();
    let (up, forward) = (back.cross(right), -back * camera.projection_distance);
    let counts = [
        SIDE as usize,
        SIDE as usize,
        scene.render.reflection_limit as usize,
        THREADS,
        ROUNDS,
    ];
    let mut numbers: Vec<f32> = counts.map(|count| count as f32).to_vec();
    for vector in [camera.position, right, up, forward, scene.background] {
        numbers.extend(vector.as_vec3().to_array());
    }
    numbers.push(scene.color_packs.len() as f32);
    for pack in scene.color_packs.values() {
        for color in [
            pack.ambient * scene.ambient_intensity,
            pack.diffuse,
            pack.specular,
        ] {
            numbers.extend(color.as_vec3().to_array());
        }
        numbers.extend([
            pack.phong_exponent as f32,
            f32::from(u8::from(pack.reflective)),
        ]);
    }
    let lights: Vec<_> = scene.lights.iter().filter(|light| light.visible).collect();
    numbers.push(lights.len() as f32);
    for light in lights {
        numbers.extend(light.position.as_vec3().to_array());
        numbers.push(light.intensity as f32);
    }
    numbers.extend(shapes_of(scene)?);
    Some(numbers)
}

/// The numbers of all balls, then points, then triangles between points, each with its material.
fn shapes_of(scene: &Scene) -> Option<Vec<f32>> {
    let (mut balls, mut points, mut faces) = (Vec::new(), Vec::new(), Vec::new());
    for object in scene.objects.iter().filter(|object| object.visible) {
        let pack = scene
            .color_packs
            .get_index_of(&object.color_pack)
            .expect("a checked scene");
        let mut add = |corners: [DVec3; 3]| {
            let first = points.len() as u32;
            points.extend(corners);
            faces.push(([first, first + 1, first + 2], pack));
        };
        match &object.shape {
            Shape::Sphere(ball) => balls.push((ball.center, ball.radius, pack)),
            Shape::Triangle(triangle) => add(triangle.corners()),
            Shape::Plane(plane) => square(plane).into_iter().for_each(add),
            Shape::Mesh(mesh) => {
                let first = points.len() as u32;
                let triangles = mesh.source.triangles();
                let transform = mesh.transform();
                let places = triangles.points().iter();
                points.extend(places.map(|&point| transform.transform_point3(point)));
                let own = triangles.faces().iter();
                faces.extend(own.map(|face| (face.map(|corner| corner + first), pack)));
            }
            Shape::Disc(_) => return None,
        }
    }
    if points.len() > MAX_POINTS {
        return None;
    }
    let mut numbers = vec![balls.len() as f32];
    for (center, radius, pack) in balls {
        numbers.extend(center.as_vec3().to_array());
        numbers.extend([radius as f32, pack as f32]);
    }
    numbers.extend([points.len() as f32, faces.len() as f32]);
    numbers.extend(points.iter().flat_map(|point| point.as_vec3().to_array()));
    for (corners, pack) in faces {
        numbers.extend(corners.map(|corner| corner as f32));
        numbers.push(pack as f32);
    }
    Some(numbers)
}

/// A large square in place of a plane.
fn square(plane: &Plane) -> [[DVec3; 3]; 2] {
    let (aside, along) = plane.normal.normalize().any_orthonormal_pair();
    let signs = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let corner = |(x, y): (f64, f64)| plane.point + (aside * x + along * y) * ENDLESS;
    let [a, b, c, d] = signs.map(corner);
    [[a, b, c], [a, c, d]]
}
