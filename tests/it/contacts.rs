//! Contacts: coincident surfaces, lights and cameras on surfaces. The picture has no speckle, and is the same in
//! single and double precision, with a list and with a tree.

use glam::DVec3;
use glint::image::Image;
use glint::mesh::{SOLIDS, Triangles};
use glint::plan::RenderRequest;
use glint::scene::{
    Accelerator, Camera, ColorPack, Disc, Document, Light, Mesh, Object, Plane, Precision,
    Projection, Scene, Shape, Sphere, Triangle,
};

use crate::image_model::assert_same_but_for_edges;
use crate::pictures::picture;

pub const SIDE: u32 = 160;

fn pack(color: [f64; 3]) -> ColorPack {
    ColorPack {
        ambient: color.into(),
        diffuse: color.into(),
        specular: DVec3::splat(200.0),
        ..ColorPack::default()
    }
}

/// Objects that are alternately red and blue, seen from above.
pub fn scene(shapes: impl IntoIterator<Item = Shape>) -> Scene {
    let mut scene = Scene::empty();
    scene.packs_mut().clear();
    scene
        .packs_mut()
        .insert("red".to_owned(), pack([255.0, 0.0, 0.0]));
    scene
        .packs_mut()
        .insert("blue".to_owned(), pack([0.0, 0.0, 255.0]));
    scene.light_visualization = false;
    scene.camera = Camera {
        position: DVec3::new(1.0, 4.0, 7.0),
        look_at: DVec3::new(-0.1, -0.5, -1.0),
        up: DVec3::Y,
        projection_distance: 1.0,
        ..Camera::default()
    };
    let shapes = shapes.into_iter().enumerate();
    let objects = shapes.map(|(number, shape)| Object {
        name: format!("object {number}"),
        color_pack: ["red", "blue"][number % 2].to_owned(),
        shape,
        ..Scene::demo().objects[0].clone()
    });
    scene.objects = objects.collect();
    scene.lights = [lamp(3.0, 6.0, 4.0)].into_iter().collect();
    scene
}

pub fn lamp(x: f64, y: f64, z: f64) -> Light {
    Light {
        position: DVec3::new(x, y, z),
        intensity: 0.7,
        marker: None,
        ..Scene::demo().lights[0].clone()
    }
}

pub fn floor() -> Shape {
    let (point, normal) = (DVec3::ZERO, DVec3::Y);
    Plane { point, normal }.into()
}

fn ball() -> Shape {
    let (center, radius) = (DVec3::Y, 1.0);
    Sphere { center, radius }.into()
}

fn triangle(corners: [[f64; 3]; 3]) -> Shape {
    let [a, b, c] = corners.map(DVec3::from);
    Triangle { a, b, c }.into()
}

fn rug() -> Shape {
    triangle([[-3.0, 0.0, -3.0], [3.0, 0.0, -3.0], [0.0, 0.0, 3.0]])
}

fn ceiling() -> Shape {
    triangle([[-3.0, 5.0, -3.0], [3.0, 5.0, -3.0], [0.0, 5.0, 3.0]])
}

/// The picture in a precision, with the accelerator that the plan chooses.
pub fn at(scene: &Scene, precision: Precision) -> Image {
    let wanted = RenderRequest {
        precision,
        ..RenderRequest::sized(SIDE, SIDE)
    };
    picture(scene, &wanted).0
}

/// The picture, after asserting that all ways to compute it agree.
pub fn steady(scene: &Scene, what: &str) -> Image {
    let of = |precision, accelerator| {
        let wanted = RenderRequest {
            precision,
            accelerator,
            ..RenderRequest::sized(SIDE, SIDE)
        };
        picture(scene, &wanted).0
    };
    let double = of(Precision::Double, Accelerator::List);
    for precision in [Precision::Single, Precision::Double] {
        let list = of(precision, Accelerator::List);
        assert_same_but_for_edges(&list, &double, &format!("{what}, {precision:?}"));
        assert!(list == of(precision, Accelerator::Bvh), "{what}, in a tree");
    }
    double
}

/// The numbers of pixels that are more blue than red, and the other way round.
pub fn blue_and_red(image: &Image) -> (usize, usize) {
    let count = |is: fn(&[u8; 4]) -> bool| image.pixels.iter().filter(|pixel| is(pixel)).count();
    (count(|[r, _, b, _]| b > r), count(|[r, _, b, _]| r > b))
}

#[test]
fn of_surfaces_in_each_other_the_first_is_seen() {
    let all = (SIDE * SIDE) as usize;
    let seen = |shapes: [Shape; 2], what| blue_and_red(&steady(&scene(shapes), what));
    let (blue, red) = seen([floor(), rug()], "a rug under the floor");
    assert!(blue == 0 && red > all / 2, "{blue} {red}");
    let (blue, red) = seen([rug(), floor()], "a rug on the floor");
    assert!(red > all / 20 && blue > all / 2, "{blue} {red}");
    assert_eq!(seen([ball(), ball()], "two balls in one place").0, 0);

    // A slanting plane, which after rounding is two different ones.
    let (point, normal) = (DVec3::new(0.3, 0.1, 0.7), DVec3::new(0.1, 1.0, 0.2));
    let disc = || {
        let (center, radius) = (point, 2.0);
        Disc {
            center,
            normal,
            radius,
        }
        .into()
    };
    let plane = || Plane { point, normal }.into();
    assert_eq!(seen([plane(), disc()], "a disc under a plane").0, 0);
    let (_, red) = seen([disc(), plane()], "a disc on a plane");
    assert!(red > all / 20, "{red}");
    let (blue, red) = seen([rug(), disc_of(0.0)], "a triangle on a disc");
    assert!(red > all / 20 && blue > all / 100, "{blue} {red}");
}

fn disc_of(height: f64) -> Shape {
    let (center, normal, radius) = (DVec3::Y * height, DVec3::Y, 3.0);
    Disc {
        center,
        normal,
        radius,
    }
    .into()
}

/// A planar sheet with this many squares per side, `width` units wide, about its centre.
pub fn sheet(squares: u32, width: f64, (position, rotation): (DVec3, DVec3)) -> Shape {
    let side = squares + 1;
    let place = |index: u32| (f64::from(index) / f64::from(squares) - 0.5) * width;
    let points = (0..side * side).map(|n| DVec3::new(place(n % side), 0.0, place(n / side)));
    let faces = (0..squares * squares).flat_map(|n| {
        let corner = n / squares * side + n % squares;
        let far = corner + side;
        [[corner, corner + 1, far], [corner + 1, far + 1, far]]
    });
    let triangles = Triangles::new(points.collect(), faces.collect()).expect("in range");
    let mesh = Mesh {
        position,
        rotation,
        ..Mesh::of(triangles)
    };
    mesh.into()
}

/// A box with these half extents about a point, rotated.
pub fn block(half: DVec3, (position, rotation): (DVec3, DVec3)) -> Shape {
    let mesh = Mesh {
        position,
        rotation,
        scale: half,
        ..Mesh::of((SOLIDS[0].make)(2.0))
    };
    mesh.into()
}

#[test]
fn of_faces_of_meshes_in_other_surfaces_the_first_is_seen() {
    let all = (SIDE * SIDE) as usize;
    let seen = |shapes: [Shape; 2], what| blue_and_red(&steady_mesh(&scene(shapes), what));
    let flat = (DVec3::ZERO, DVec3::ZERO);
    let (blue, red) = seen([floor(), sheet(7, 4.0, flat)], "a sheet under the floor");
    assert!(blue == 0 && red > all / 2, "{blue} {red}");
    let (blue, red) = seen([sheet(7, 4.0, flat), floor()], "a sheet on the floor");
    assert!(red > all / 20 && blue > all / 2, "{blue} {red}");
    let alone = blue_and_red(&steady_mesh(&scene([sheet(7, 4.0, flat)]), "a sheet")).1;
    assert_eq!(red, alone, "all of it is seen");

    let turned = (DVec3::new(0.3, 0.1, -0.2), DVec3::new(11.3, 23.7, 5.1));
    let (blue, red) = seen(
        [sheet(7, 4.0, turned), sheet(11, 3.0, turned)],
        "two sheets",
    );
    assert!(blue == 0 && red > all / 20, "{blue} {red}");
    let (blue, red) = seen(
        [sheet(11, 3.0, turned), sheet(7, 4.0, turned)],
        "the other way",
    );
    assert!(blue > all / 50 && red > all / 50, "{blue} {red}");
    let (_, red) = seen([disc_of(0.0), sheet(7, 2.0, flat)], "a sheet under a disc");
    assert!(red > all / 20);

    // A cross of two equally high boxes: the top of the first is uninterrupted.
    let (long, wide) = (DVec3::new(1.7, 0.6, 0.5), DVec3::new(0.5, 0.6, 1.7));
    let cross = [block(long, turned), block(wide, turned)];
    let (_, first) = seen(cross.clone(), "a cross");
    let alone = blue_and_red(&steady_mesh(&scene([cross[0].clone()]), "one arm")).1;
    assert!(first < alone, "the other arm stands before its side");
    let [one, other] = cross;
    assert!(first > seen([other, one], "a cross the other way").0 * 9 / 10);
}

#[test]
fn what_looks_alike_in_one_place_casts_no_shadow_there() {
    let turned = (DVec3::new(0.3, 0.1, -0.2), DVec3::new(11.3, 23.7, 5.1));
    let sheet = sheet(7, 4.0, turned);
    let Shape::Mesh(mesh) = &sheet else {
        panic!("a mesh");
    };
    let normal = mesh.turn() * DVec3::Y;
    let (center, radius) = (turned.0, 1.5);
    let disc = Disc {
        center,
        normal,
        radius,
    };
    let mut both = scene([sheet, disc.into()]);
    both.lights = vec![lamp(30.0, 60.0, 40.0), lamp(-50.0, 20.0, 10.0)].into();
    let mut alone = both.clone();
    both.objects[1].color_pack = both.objects[0].color_pack.clone();
    alone.objects.remove(1);
    let (both, alone) = (steady_mesh(&both, "both"), steady_mesh(&alone, "alone"));
    assert_same_but_for_edges(&both, &alone, "a disc in a sheet");
}

/// Asserts that both precisions agree on the picture, and returns it; meshes are never in a list.
pub fn steady_mesh(scene: &Scene, what: &str) -> Image {
    let double = at(scene, Precision::Double);
    let single = at(scene, Precision::Single);
    assert_same_but_for_edges(&single, &double, what);
    double
}

#[test]
fn a_solid_that_stands_on_a_floor_is_not_told_of_and_one_in_the_floor_is() {
    let told = |shapes: [Shape; 2]| {
        let hints = glint::scene::hints(&scene(shapes)).into_iter();
        hints
            .filter(|hint| hint.words.contains("shares faces"))
            .count()
    };
    let stands = |y: f64| block(DVec3::ONE, (DVec3::Y * y, DVec3::ZERO));
    assert_eq!(told([floor(), stands(1.0)]), 0);
    assert_eq!(
        told([floor(), sheet(2, 4.0, (DVec3::ZERO, DVec3::ZERO))]),
        1
    );
    // From below, box and floor coincide, and also from above with the box hanging under the floor.
    let mut below = scene([floor(), stands(1.0)]);
    below.camera.position.y = -4.0;
    below.camera.look_at.y = 0.5;
    assert_eq!(blue_and_red(&steady_mesh(&below, "from below")).0, 0);
    let under = scene([floor(), stands(-1.0)]);
    assert_eq!(
        blue_and_red(&steady_mesh(&under, "a box under the floor")).0,
        0
    );
    let under = scene([stands(-1.0), floor()]);
    let (blue, red) = blue_and_red(&steady_mesh(&under, "a box let into the floor"));
    assert!(blue > 0 && red > 0, "{blue} {red}");
}

#[test]
fn surfaces_all_but_in_each_other_cast_no_shadow_on_each_other() {
    for gap in [1e-9, 3e-7] {
        let disc = |y: f64, radius| {
            let (center, normal) = (DVec3::new(0.0, y, 0.0), DVec3::Y);
            Shape::from(Disc {
                center,
                normal,
                radius,
            })
        };
        let both = steady(&scene([disc(0.0, 3.0), disc(gap, 2.0)]), "two discs");
        let alone = steady(&scene([disc(0.0, 3.0)]), "a disc");
        assert_same_but_for_edges(&both, &alone, &format!("{gap} apart"));
    }
}

/// A mesh in the notation of scene files, seen from above.
fn faces_of(mesh: &str) -> Scene {
    let text = format!(
        r#"Scene(version: 1, light_visualization: false,
            camera: Camera(position: (1, 3, 4), look_at: (0, -0.6, -0.8), up: (0, 1, 0)),
            color_packs: {{"clay": ColorPack(ambient: (128, 60, 40), diffuse: (200, 120, 80))}},
            lights: [Light(name: "lamp", position: (30, 80, 40), intensity: 0.7)],
            objects: [Object(name: "mesh", color_pack: "clay", shape: Mesh({mesh}))])"#
    );
    Document::from_text(&text).expect("a scene").scene
}

#[test]
fn which_faces_are_one_curved_surface_is_the_same_in_any_precision() {
    let cube = "points: [(-1,-1,-1),(-1,-1,1),(-1,1,-1),(-1,1,1),(1,-1,-1),(1,-1,1),(1,1,-1),(1,1,1)], \
        faces: [(0,1,3),(0,3,2),(4,6,7),(4,7,5),(0,4,5),(0,5,1),(2,3,7),(2,7,6),(0,2,6),(0,6,4),(1,5,7),(1,7,3)], \
        rotation: (30, 20, 10)";
    let right = |smooth: f64| faces_of(&format!("{cube}, smooth: {smooth}"));
    // Faces that meet at exactly the limiting angle stay flat, however they are rotated.
    let flat = steady(&right(0.0), "a cube");
    assert!(flat == steady(&right(90.0), "a cube at its angle"));
    assert!(flat != steady(&right(91.0), "a round cube"));
    let seam = |off: &str| {
        let points = format!("(0,0,0),(0,2,0),(-1,0,-0.4),({off},0,0),({off},2,0),(2,0,-0.6)");
        faces_of(&format!(
            "points: [{points}], faces: [(0,2,1),(3,4,5)], smooth: 60"
        ))
    };
    let whole = steady(&seam("0"), "a seam");
    let noisy = steady(&seam("1e-9"), "a seam with noise");
    assert_same_but_for_edges(&noisy, &whole, "a seam");
}

#[test]
fn neighbours_that_share_a_border_are_not_held_against_each_other() {
    let half = triangle([[-3.0, 0.0, -3.0], [3.0, 0.0, -3.0], [-3.0, 0.0, 3.0]]);
    let other = triangle([[3.0, 0.0, -3.0], [3.0, 0.0, 3.0], [-3.0, 0.0, 3.0]]);
    let words = glint::scene::hints(&scene([half, other]));
    assert!(
        words.iter().all(|hint| !hint.words.contains("lies in")),
        "{words:?}"
    );
    let words = glint::scene::hints(&scene([floor(), rug()]));
    assert!(
        words.iter().any(|hint| hint.words
            == "object 1 lies in the surface of object 0, which comes first and is shown there"),
        "{words:?}"
    );
}

#[test]
fn a_light_on_a_surface_is_not_behind_it() {
    let lit_share = |scene: &Scene, what| {
        let image = steady(scene, what);
        let [r, _, _, _] = image.pixels[(SIDE * SIDE * 3 / 4 + SIDE / 2) as usize];
        r
    };
    let mut hung = scene([floor(), ceiling()]);
    hung.lights = [lamp(0.0, 5.0, -1.0)].into_iter().collect();
    let below = lit_share(&hung, "a lamp in the ceiling");
    hung.lights = [lamp(0.0, 5.0 - 1e-3, -1.0)].into_iter().collect();
    assert!(below.abs_diff(lit_share(&hung, "a lamp just below")) <= 1);
    hung.lights = [lamp(0.0, 5.0 + 1e-3, -1.0)].into_iter().collect();
    assert!(lit_share(&hung, "a lamp just above") + 20 < below);

    let mut lit = scene([floor(), ball()]);
    lit.lights = [lamp(0.6, 1.8, 0.0)].into_iter().collect();
    let automatic = at(&lit, Precision::Auto);
    let double = at(&lit, Precision::Double);
    assert_same_but_for_edges(&automatic, &double, "a lamp on a ball");
    let (_, red) = blue_and_red(&automatic);
    assert!(red > 0);
    lit.lights = [lamp(0.5, 0.0, 2.5)].into_iter().collect();
    steady(&lit, "a lamp on the floor");
}

/// The light ends at the line where the floor meets the plane that touches the ball at the light, exact to the
/// pixel: rounding nowhere decides whether the ball hides a light on its surface.
#[test]
fn a_light_on_a_ball_shines_up_to_the_plane_that_touches_it_there() {
    let outwards = DVec3::new(0.48, 0.6, 0.64);
    for (radius, x, z) in [(1.0, 0.0, 0.0), (50.0, 125.0, -150.0), (1.37, 100.0, 99.0)] {
        let center = DVec3::new(x, radius, z);
        let light = center + outwards * radius;
        let mut lit = scene([floor(), Sphere { center, radius }.into()]);
        lit.lights = [lamp(light.x, light.y, light.z)].into_iter().collect();
        lit.camera = Camera {
            position: center + DVec3::Y * (20.0 * radius),
            look_at: DVec3::NEG_Y,
            up: DVec3::NEG_Z,
            projection: Projection::Orthographic,
            orthographic_height: 8.0 * radius,
            ..Camera::default()
        };
        let both = [Accelerator::List, Accelerator::Bvh];
        let precisions = [Precision::Auto, Precision::Single, Precision::Double];
        for (precision, accelerator) in precisions.into_iter().flat_map(|p| both.map(|a| (p, a))) {
            let wanted = RenderRequest {
                precision,
                accelerator,
                ..RenderRequest::sized(SIDE, SIDE)
            };
            let image = picture(&lit, &wanted).0;
            let [dark, ..] = image.pixels[0];
            let mut checked = 0;
            for (index, [red, ..]) in image.pixels.iter().enumerate() {
                let place = |at: usize| ((at as f64 + 0.5) / f64::from(SIDE) - 0.5) * 8.0 * radius;
                let (right, back) = (index % SIDE as usize, index / SIDE as usize);
                let off = DVec3::new(place(right), -radius, place(back));
                let height = outwards.dot(center + off - light);
                if off.length() > 1.5 * radius && height.abs() > 1e-5 * radius {
                    let what = format!("{precision:?}, radius {radius}, {off}");
                    assert_eq!(*red > dark, height > 0.0, "{what}");
                    checked += 1;
                }
            }
            assert!(checked > 24_000, "{checked}");
        }
    }
}

#[test]
fn an_eye_on_a_surface_sees_what_it_looks_at() {
    let mut outside = scene([floor(), ball()]);
    outside.camera.position = DVec3::new(0.6, 1.8, 0.0);
    outside.camera.look_at = DVec3::new(0.6, 0.2, -0.3);
    steady(&outside, "out of a ball");
    outside.camera.look_at = DVec3::new(-0.6, -0.2, -0.3);
    let (blue, _) = blue_and_red(&steady(&outside, "into a ball"));
    assert!(
        blue > (SIDE * SIDE / 2) as usize,
        "the far side fills the picture: {blue}"
    );

    let tilted = triangle([[-3.0, 4.0, -3.0], [3.0, 4.25, -3.0], [0.0, 3.75, 3.0]]);
    let mut above = scene([floor(), tilted]);
    above.camera.position = DVec3::new(0.0, 4.125, -3.0);
    let (blue, red) = blue_and_red(&steady(&above, "in a triangle"));
    assert!(blue == 0 && red > 0, "{blue} {red}");
}

#[test]
fn parallel_rays_that_start_in_a_surface_go_on_from_there() {
    let look_at = DVec3::new(-0.2, -1.0, -3.0);
    let wall = |point: DVec3| {
        let normal = -look_at;
        Plane { point, normal }.into()
    };
    let mut window = scene([wall(DVec3::ZERO), wall(look_at)]);
    window.camera = Camera {
        position: DVec3::ZERO,
        look_at,
        projection: glint::scene::Projection::Orthographic,
        orthographic_height: 20.0,
        ..window.camera
    };
    let (blue, red) = blue_and_red(&steady(&window, "in a wall"));
    assert_eq!((blue, red), ((SIDE * SIDE) as usize, 0));
    window.camera.position = DVec3::new(0.1, 0.5, 1.5);
    let (blue, red) = blue_and_red(&steady(&window, "before a wall"));
    assert_eq!((blue, red), (0, (SIDE * SIDE) as usize));
}

#[test]
fn parallel_rays_from_far_away_need_digits() {
    for away in [1e3, 1e5, 1e7] {
        let wall = Plane {
            point: DVec3::ZERO,
            normal: DVec3::new(1.0, 0.2, 0.0),
        };
        let mut far = scene([floor(), wall.into()]);
        far.camera = Camera {
            position: DVec3::new(0.0, 0.3 * away, away),
            look_at: DVec3::new(0.0, -0.3, -1.0),
            projection: glint::scene::Projection::Orthographic,
            orthographic_height: 4.0,
            ..far.camera
        };
        let (automatic, double) = (at(&far, Precision::Auto), at(&far, Precision::Double));
        assert_same_but_for_edges(&automatic, &double, &format!("from {away}"));
    }
}
