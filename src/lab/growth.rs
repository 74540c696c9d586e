//! Measures how the time of a picture grows with the content of the scene: a mesh of more and more faces, and more
//! and more balls, over a floor and lit from two sides.

use std::time::Instant;

use glam::DVec3;
use serde::Serialize;

use crate::export::by_povray;
use crate::image::LinearRgb;
use crate::mesh::globe;
use crate::plan::{Planner, RenderRequest};
use crate::scene::{Camera, ColorPack, Light, List, Mesh, Object, Plane, Sampling, Scene, Sphere};
use crate::trace::{Pass, RenderControl, Threads, Tracer};
use crate::words::milliseconds;

/// Numbers of primitives that are measured, up to a million.
const COUNTS: [u32; 5] = [100, 1_000, 10_000, 100_000, 1_000_000];
/// Runs for each scene, of which the fastest counts.
const ROUNDS: usize = 3;

/// Irrational step sizes along the axes of a cube that fill it evenly: powers of the root of x⁴ = x + 1.
const AXIS_STEPS: [f64; 3] = [0.819_172_513, 0.671_043_606, 0.549_700_477];

/// The content of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Crowd {
    /// Faces of one closed mesh.
    Mesh,
    /// Balls, none of them smaller than a pixel or two.
    Balls,
}

/// How a picture is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum RenderMethod {
    /// One sample per pixel.
    Plain,
    /// With clean edges.
    Clean,
    /// By POV-Ray, one sample per pixel.
    Povray,
    /// By Embree, one sample per pixel.
    Embree,
}

/// A measured picture.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Cost {
    /// The content of the scene.
    pub crowd: Crowd,
    /// How the picture was made.
    pub way: RenderMethod,
    /// Number of primitives.
    pub primitives: u32,
    /// Milliseconds of the fastest run, without planning.
    pub ms: f64,
    /// Milliseconds of planning, in one run; `None` if unknown.
    pub plan_ms: Option<f64>,
}

/// Draws a scene with another engine, one sample per pixel; returns the milliseconds of the fastest of
/// several runs, or why it failed.
pub type Engine = fn(&Scene) -> Result<f64, String>;

/// The engine that makes a picture.
#[derive(Clone, Copy, Debug)]
enum Renderer {
    Glint(Sampling),
    Other(Engine),
}

/// Measures all scenes, one picture after the other, on the current rayon pool.
#[derive(Debug)]
pub struct Growth {
    side: u32,
    max_primitives: u32,
    renderers: Vec<(RenderMethod, Renderer)>,
    /// The results so far.
    pub costs: Vec<Cost>,
    /// Why engines were left out.
    pub obstacles: Vec<String>,
}

impl Growth {
    /// Makes pictures of `side` × `side` pixels, of scenes with at most `max_primitives` primitives.
    pub fn new(side: u32, max_primitives: u32) -> Self {
        Self {
            side,
            max_primitives,
            renderers: vec![
                (RenderMethod::Plain, Renderer::Glint(Sampling::Centres)),
                (RenderMethod::Clean, Renderer::Glint(Sampling::ADAPTIVE)),
            ],
            costs: Vec::new(),
            obstacles: Vec::new(),
        }
    }

    /// Adds POV-Ray to the comparison.
    pub fn with_povray(self) -> Self {
        self.with(RenderMethod::Povray, povray)
    }

    /// Adds another engine to the comparison.
    pub fn with(mut self, way: RenderMethod, engine: Engine) -> Self {
        self.renderers.push((way, Renderer::Other(engine)));
        self
    }

    /// Side of the pictures in pixels.
    pub fn side(&self) -> u32 {
        self.side
    }

    /// All pictures in the order of measurement. Other engines come last; one that fails is left out.
    fn cases(&self) -> impl Iterator<Item = (&(RenderMethod, Renderer), Crowd, u32)> {
        let crowds = |renderer| [(renderer, Crowd::Mesh), (renderer, Crowd::Balls)];
        self.renderers
            .iter()
            .flat_map(crowds)
            .flat_map(|(renderer, crowd)| {
                let max_primitives = crowd.max_primitives().min(self.max_primitives);
                let counts = COUNTS
                    .into_iter()
                    .filter(move |&count| count <= max_primitives);
                counts.map(move |count| (renderer, crowd, count))
            })
    }

    /// Measures the next picture, or leaves out an engine that fails. Returns whether there was one to measure.
    pub fn step(&mut self) -> bool {
        let Some((&(way, renderer), crowd, count)) = self.cases().nth(self.costs.len()) else {
            return false;
        };
        let mut scene = crowd.scene(count);
        (scene.render.width, scene.render.height) = (self.side, self.side);
        let timing = match renderer {
            Renderer::Glint(sampling) => Ok(time_glint(&scene, sampling)),
            Renderer::Other(draw) => draw(&scene).map(|ms| (ms, None)),
        };
        let (ms, plan_ms) = match timing {
            Ok(timing) => timing,
            Err(obstacle) => {
                self.obstacles.push(obstacle);
                self.renderers.retain(|(other, _)| *other != way);
                self.costs.retain(|cost| cost.way != way);
                return true;
            }
        };
        self.costs.push(Cost {
            crowd,
            way,
            primitives: match crowd {
                Crowd::Mesh => scene.faces() as u32,
                Crowd::Balls => count,
            },
            ms,
            plan_ms,
        });
        true
    }

    /// Share of the pictures that have been measured, 0–1.
    pub fn progress(&self) -> f64 {
        self.costs.len() as f64 / self.cases().count().max(1) as f64
    }
}

impl Cost {
    /// A short description of what was measured.
    pub fn name(&self) -> String {
        let crowd = match self.crowd {
            Crowd::Mesh => "a mesh",
            Crowd::Balls => "balls",
        };
        let way = match self.way {
            RenderMethod::Plain => "one sample",
            RenderMethod::Clean => "clean edges",
            RenderMethod::Povray => "POV-Ray",
            RenderMethod::Embree => "Embree",
        };
        format!("{crowd}, {way}")
    }
}

impl Crowd {
    /// Most primitives that are measured.
    fn max_primitives(self) -> u32 {
        match self {
            Self::Mesh => 1_000_000,
            // Each ball is an object with a name: with more of them, that overhead would dominate tracing.
            Self::Balls => 100_000,
        }
    }

    /// A scene with exactly or roughly this number of primitives.
    pub fn scene(self, count: u32) -> Scene {
        match self {
            Self::Mesh => mesh(count),
            Self::Balls => balls(count),
        }
    }
}

/// Milliseconds of the fastest run, and of planning.
fn time_glint(scene: &Scene, sampling: Sampling) -> (f64, Option<f64>) {
    let request = RenderRequest {
        sampling,
        ..RenderRequest::still(scene)
    };
    let mut planner = Planner::default();
    let since = Instant::now();
    let tracer = Tracer::planned(scene, &request, &mut planner);
    let plan_ms = milliseconds(since.elapsed());
    // Allocated once for all runs: otherwise obtaining memory would dominate small scenes.
    let mut light: Vec<LinearRgb> = vec![[0.0; 3]; tracer.width() * tracer.height()];
    let time = |_| {
        let since = Instant::now();
        // Nothing stops it.
        let _ = tracer.pass(&mut light, Pass::Whole, &RenderControl::default());
        milliseconds(since.elapsed())
    };
    let ms = (0..ROUNDS).map(time).fold(f64::INFINITY, f64::min);
    (ms, Some(plan_ms))
}

fn povray(scene: &Scene) -> Result<f64, String> {
    let mut fastest = f64::INFINITY;
    for _ in 0..ROUNDS {
        let drawn = by_povray(scene, Threads::current(), &RenderControl::default());
        let drawn = drawn.map_err(|error| error.to_string())?;
        fastest = fastest.min(milliseconds(drawn.time));
    }
    Ok(fastest)
}

/// A floor, two lights and a camera.
fn stage() -> Scene {
    let mut scene = Scene::empty();
    scene.light_visualization = false;
    let pack = |diffuse: f64| ColorPack {
        ambient: DVec3::splat(diffuse),
        diffuse: DVec3::splat(diffuse),
        reflective: false,
        ..ColorPack::default()
    };
    scene.packs_mut().insert("floor".to_owned(), pack(120.0));
    scene.packs_mut().insert("thing".to_owned(), pack(220.0));
    let floor = Plane {
        point: DVec3::ZERO,
        normal: DVec3::Y,
    };
    scene.objects = List::from(vec![Object::new("Floor", "floor", floor)]);
    let light = |name: &str, x: f64| Light {
        name: name.to_owned(),
        position: DVec3::new(x, 220.0, 160.0),
        intensity: 0.5,
        visible: true,
        marker: None,
    };
    scene.lights = List::from(vec![light("Left", -150.0), light("Right", 180.0)]);
    scene.camera = Camera {
        position: DVec3::new(0.0, 80.0, 190.0),
        look_at: DVec3::new(0.0, -0.25, -1.0),
        up: DVec3::Y,
        ..Camera::default()
    };
    scene
}

/// A ball with bumps that has roughly this number of faces.
fn mesh(faces: u32) -> Scene {
    let rings = (f64::from(faces) / 4.0).sqrt().round().max(2.0) as u32;
    let radius =
        |polar: f64, azimuth: f64| 42.0 + 4.0 * (6.0 * azimuth).sin() * (5.0 * polar).sin();
    let mut scene = stage();
    let mesh = Mesh {
        position: DVec3::new(0.0, 50.0, 0.0),
        ..Mesh::of(globe(rings, radius))
    };
    scene.objects.push(Object::new("Ball", "thing", mesh));
    scene
}

/// Balls in a cube. The more there are, the smaller they are, so that together they always cover roughly the same
/// area.
fn balls(count: u32) -> Scene {
    let mut scene = stage();
    let radius = 60.0 / f64::from(count).sqrt();
    for number in 0..count {
        // Additive recurrence with a different irrational step for each axis.
        let share = |axis: usize| (f64::from(number) * AXIS_STEPS[axis]).fract();
        let center = DVec3::new(
            (share(0) - 0.5) * 150.0,
            radius + share(1) * 90.0,
            (share(2) - 0.5) * 120.0,
        );
        let ball = Sphere { center, radius };
        scene
            .objects
            .push(Object::new(format!("Ball {number}"), "thing", ball));
    }
    scene
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::csv_of;
    use crate::scene::check;

    #[test]
    fn crowds_are_scenes_of_so_many_primitives() {
        for count in [100, 1_000] {
            let (mesh, balls) = (mesh(count), balls(count));
            assert!(check(&mesh).is_ok() && check(&balls).is_ok());
            assert!(
                mesh.faces().abs_diff(count as usize) * 4 <= count as usize,
                "{}",
                mesh.faces()
            );
            assert_eq!(balls.objects.len(), count as usize + 1);
        }
    }

    #[test]
    fn an_engine_that_fails_leaves_the_others() {
        let draw = |scene: &Scene| match scene.objects.len() {
            2 => Ok(1.0),
            _ => Err("no balls".to_owned()),
        };
        let mut growth = Growth::new(16, 100)
            .with(RenderMethod::Povray, draw)
            .with(RenderMethod::Embree, |_| Ok(2.0));
        while growth.step() {}
        let ways = growth.costs.iter().map(|cost| cost.way);
        let [plain, clean, embree] = [
            RenderMethod::Plain,
            RenderMethod::Clean,
            RenderMethod::Embree,
        ]
        .map(|way| [way, way]);
        assert_eq!(ways.collect::<Vec<_>>(), [plain, clean, embree].concat());
        assert_eq!(growth.obstacles, ["no balls"]);
        assert_eq!(growth.progress(), 1.0);
    }

    #[test]
    fn every_crowd_is_measured_once() {
        let mut growth = Growth::new(16, 1_000);
        while growth.step() {}
        assert_eq!((growth.costs.len(), growth.progress()), (8, 1.0));
        assert!(
            growth
                .costs
                .iter()
                .all(|cost| cost.ms > 0.0 && cost.plan_ms.is_some_and(|ms| ms > 0.0))
        );
        let text = csv_of(&growth.costs).expect("written");
        assert!(
            text.starts_with("crowd,way,primitives,ms,plan_ms\nmesh,plain,80,"),
            "{text}"
        );
    }
}
