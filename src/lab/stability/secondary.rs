//! Shadow rays that hit the surface that they start on, or miss what is close to it: pictures of a ball and a card on
//! a floor, at every scale and place. The ball is a sphere or a mesh.

use super::map::{Map, Tries, offset_axis, placed, scale_axis};
use super::stage::light;
use super::subject::MapSubject;
use crate::plan::{Model, RenderRequest};
use crate::scene::{
    Camera, ColorPack, Light, List, Method as _, Methods, Object, Plane, Precision, RayOffset,
    Sampling, Scene, Shape, Sphere, Triangle,
};
use glam::DVec3;

/// Side of the pictures in pixels.
const SIDE: u32 = 48;
/// Brightness below which a lit pixel counts as dark: its light is almost parallel to the surface.
const MAX_DARK: f32 = 0.03;

/// An offset larger than the scene: rays that start there hit nothing.
const BEYOND_SCENE: f64 = 1e6;

/// What the ball is made of.
#[derive(Clone, Copy, PartialEq)]
enum BallKind {
    Sphere,
    Mesh,
}

/// Two maps for each way and ball: lit points that are dark (acne), and points in shadow that are lit (leak). Pixels
/// at the edge of a shadow or of an object are not tried.
pub fn maps() -> Vec<Map> {
    let mut maps = maps_of(
        BallKind::Sphere,
        [MapSubject::ShadowAcne, MapSubject::ShadowLeak],
    );
    maps.extend(maps_of(
        BallKind::Mesh,
        [MapSubject::MeshAcne, MapSubject::MeshLeak],
    ));
    maps
}

fn maps_of(ball: BallKind, [acne, leak]: [MapSubject; 2]) -> Vec<Map> {
    let reference_scene = scene(ball, 0.0, 1.0);
    let double = |offset| lit(&reference_scene, (offset, Precision::Double), Model::Needed);
    let (truth, facing) = (
        double(RayOffset::Robust),
        double(RayOffset::Fixed(BEYOND_SCENE)),
    );
    let inner = |index: &usize| is_inner(&truth, *index) && is_inner(&facing, *index);
    let inner: Vec<usize> = (0..truth.len()).filter(inner).collect();
    let (bright, shadowed): (Vec<usize>, Vec<usize>) = inner
        .into_iter()
        .filter(|&index| facing[index])
        .partition(|&index| truth[index]);
    let map = |(subject, failure), setup: &OffsetSetup, tried: &[usize]| {
        Map::measure(
            (subject, failure),
            (setup.name.clone(), setup.is_default()),
            (offset_axis(), scale_axis()),
            |away, scale| {
                let pixels = lit(
                    &scene(ball, away, scale),
                    (setup.offset, Precision::Single),
                    setup.model,
                );
                Tries::count(tried.iter().map(|&index| pixels[index] != truth[index]))
            },
        )
    };
    let setups = setups();
    let acne = setups
        .iter()
        .map(|setup| map((acne, "lit point that is dark"), setup, &bright));
    let leak = setups
        .iter()
        .map(|setup| map((leak, "point in shadow that is lit"), setup, &shadowed));
    acne.chain(leak).collect()
}

/// How rays are moved off a surface, and in which coordinates.
struct OffsetSetup {
    name: String,
    offset: RayOffset,
    model: Model,
}

impl OffsetSetup {
    fn is_default(&self) -> bool {
        self.offset == RayOffset::default() && self.model == Model::Needed
    }
}

/// Every method, and those that depend on the place also without rebasing, which removes that dependence.
fn setups() -> Vec<OffsetSetup> {
    let setup = |offset: RayOffset, model| OffsetSetup {
        name: match model {
            Model::Unrebased => format!("{} (not rebased)", offset.id()),
            _ => offset.id(),
        },
        offset,
        model,
    };
    let all = RayOffset::ALL.iter().map(|method| method.value);
    let is_scaled = |offset: &RayOffset| !matches!(offset, RayOffset::Fixed(_));
    let unrebased = all.clone().filter(is_scaled);
    all.map(|offset| setup(offset, Model::Needed))
        .chain(unrebased.map(|offset| setup(offset, Model::Unrebased)))
        .collect()
}

/// Returns for each pixel whether it is lit.
fn lit(scene: &Scene, (offset, precision): (RayOffset, Precision), model: Model) -> Vec<bool> {
    let request = RenderRequest {
        methods: Methods {
            offset,
            ..Methods::default()
        },
        precision,
        sampling: Sampling::Centres,
        model,
        ..RenderRequest::sized(SIDE, SIDE)
    };
    let light = light(scene, &request);
    light.iter().map(|pixel| pixel[0] > MAX_DARK).collect()
}

/// Returns whether all pixels around this one are lit or dark like it.
fn is_inner(lit: &[bool], index: usize) -> bool {
    let side = SIDE as usize;
    let (x, y) = (index % side, index / side);
    if x == 0 || y == 0 || x == side - 1 || y == side - 1 {
        return false;
    }
    let rows = [index - side, index, index + side];
    rows.iter()
        .all(|row| (row - 1..=row + 1).all(|near| lit[near] == lit[index]))
}

/// A floor, a ball on it, a thin card beside it, and one light; scaled by `scale`, and `away` sizes from the origin.
fn scene(ball: BallKind, away: f64, scale: f64) -> Scene {
    let point = |x: f64, y: f64, z: f64| placed(DVec3::new(x, y, z), away, scale);
    let mut scene = Scene::empty();
    let white = DVec3::splat(255.0);
    let black = DVec3::splat(0.0);
    let chalk = ColorPack {
        ambient: black,
        diffuse: white,
        specular: black,
        reflective: false,
        ..ColorPack::default()
    };
    scene.packs_mut().insert("chalk".to_owned(), chalk);
    scene.background = black;
    let chalk = |name: &str, shape: Shape| Object::new(name, "chalk", shape);
    scene.objects = List::from(vec![
        chalk(
            "Floor",
            Shape::Plane(Plane {
                point: point(0.0, 0.0, 0.0),
                normal: DVec3::new(0.0, 1.0, 0.0),
            }),
        ),
        chalk(
            "Card",
            Shape::Triangle(Triangle {
                a: point(0.7, 0.0, 0.1),
                b: point(0.9, 0.8, -0.1),
                c: point(1.1, 0.0, -0.3),
            }),
        ),
    ]);
    match ball {
        BallKind::Sphere => scene.objects.push(chalk(
            "Ball",
            Shape::Sphere(Sphere {
                center: point(0.0, 0.5, 0.0),
                radius: 0.5 * scale,
            }),
        )),
        BallKind::Mesh => {
            for (n, face) in super::triangle::ball().into_iter().enumerate() {
                let corner = |v: DVec3| point(v.x * 0.5, v.y * 0.5 + 0.5, v.z * 0.5);
                let [a, b, c] = face.map(corner);
                let face = Shape::Triangle(Triangle { a, b, c });
                scene.objects.push(chalk(&format!("Face {n}"), face));
            }
        }
    }
    scene.lights = List::from(vec![Light {
        name: "Light".to_owned(),
        position: point(1.6, 1.9, 1.3),
        intensity: 1.0,
        visible: true,
        marker: None,
    }]);
    scene.camera = Camera {
        position: point(0.4, 1.3, 2.6),
        look_at: DVec3::new(0.0, -0.4, -1.0),
        up: DVec3::new(0.0, 1.0, 0.0),
        projection_distance: 1.0,
        ..Camera::default()
    };
    scene
}
