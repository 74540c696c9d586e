//! Cameras, view windows of parallel rays, and lights on faces of meshes: no speckle, and the same in any
//! precision.

use glam::{DMat3, DVec3};
use glint::image::Image;
use glint::mesh::Triangles;
use glint::scene::{Camera, Disc, Mesh, Precision, Projection, Scene, Shape};

use crate::contacts::{
    SIDE, at, block, blue_and_red, floor, lamp, scene, sheet, steady, steady_mesh,
};
use crate::image_model::assert_same_but_for_edges;

const ALL: usize = (SIDE * SIDE) as usize;

/// A rotation for which no face of a sheet has coordinates with few digits.
const TURNED: DVec3 = DVec3::new(11.0, 23.0, 5.0);
const HERE: DVec3 = DVec3::new(0.3, 1.7, 0.2);

fn turn() -> DMat3 {
    let Shape::Mesh(mesh) = leaning() else {
        unreachable!("a sheet is a mesh");
    };
    Mesh::linear_transform(&mesh)
}

/// A sheet of 18 faces over the floor.
fn leaning() -> Shape {
    sheet(3, 4.0, (HERE, TURNED))
}

fn with_camera(mut scene: Scene, change: impl FnOnce(&mut Camera)) -> Scene {
    change(&mut scene.camera);
    scene
}

#[test]
fn an_eye_on_a_face_does_not_see_it() {
    for (x, z) in [(0.4, 0.1), (-0.3, 0.9), (2.0 / 3.0, 0.1), (0.0, 0.0)] {
        let above = with_camera(scene([floor(), leaning()]), |camera| {
            camera.position = HERE + turn() * DVec3::new(x, 0.0, z);
            camera.look_at = DVec3::new(0.1, -1.0, -0.2);
        });
        let (blue, red) = blue_and_red(&steady_mesh(&above, "on a sheet"));
        assert_eq!(blue, 0, "{x}, {z}: the sheet itself");
        assert!(red > 0);
    }
    // From a little above it, nothing else is seen.
    let above = with_camera(scene([floor(), leaning()]), |camera| {
        camera.position = HERE + turn() * DVec3::new(0.4, 1e-4, 0.1);
        camera.look_at = turn() * DVec3::new(0.1, -1.0, -0.2);
    });
    let (automatic, double) = (at(&above, Precision::Auto), at(&above, Precision::Double));
    assert_same_but_for_edges(&automatic, &double, "just above a sheet");
    let (blue, red) = blue_and_red(&double);
    assert!(blue > ALL * 9 / 10 && red < ALL / 100, "{blue} {red}");
}

#[test]
fn an_eye_on_a_box_sees_its_other_sides_from_within() {
    let inside = with_camera(
        scene([floor(), block(DVec3::ONE, (HERE, TURNED))]),
        |camera| {
            camera.position = HERE + turn() * DVec3::new(0.3, 1.0, -0.2);
            camera.look_at = turn() * DVec3::new(0.2, -1.0, 0.1);
        },
    );
    assert_eq!(blue_and_red(&steady_mesh(&inside, "into a box")), (ALL, 0));
}

#[test]
fn from_within_a_solid_the_floor_is_seen_on_which_it_stands() {
    // A house around the camera, which stands on the floor.
    let house = block(DVec3::new(3.0, 2.0, 3.0), (DVec3::Y * 2.0, DVec3::ZERO));
    for position in [DVec3::new(1.0, 1.0, 1.0), DVec3::new(-0.5, 2.5, 0.5)] {
        let within = with_camera(scene([floor(), house.clone()]), |camera| {
            camera.position = position;
            camera.look_at = DVec3::new(0.1, -1.0, -0.2);
        });
        let picture = steady_mesh(&within, "in a house");
        assert_eq!(blue_and_red(&picture), (0, ALL), "{position}");
    }
}

#[test]
fn an_eye_on_a_slab_sees_the_floor_under_it() {
    let slab = block(DVec3::new(3.0, 0.15, 3.0), (DVec3::Y * 0.15, DVec3::ZERO));
    // On the top of the slab, and inside it by a rounding error.
    for height in [0.3, 0.3 - 5e-8] {
        let on = with_camera(scene([floor(), slab.clone()]), |camera| {
            camera.position = DVec3::new(0.3, height, 0.2);
            camera.look_at = DVec3::new(0.1, -1.0, -0.2);
        });
        let picture = steady_mesh(&on, "on a slab");
        assert_eq!(blue_and_red(&picture), (0, ALL), "{height}");
    }
}

#[test]
fn parallel_rays_go_on_from_the_face_that_their_window_lies_in() {
    let along = turn() * -DVec3::Y;
    // The centre of the view window need not be on the sheet.
    for beside in [0.0, 3.0] {
        let window = with_camera(scene([floor(), leaning()]), |camera| {
            camera.position = HERE + turn() * DVec3::X * beside;
            camera.look_at = along;
            camera.projection = Projection::Orthographic;
            camera.orthographic_height = 8.0;
        });
        let (blue, _) = blue_and_red(&steady_mesh(&window, "in a sheet"));
        assert_eq!(blue, 0, "{beside}");
        let before = with_camera(window, |camera| camera.position -= along * 1e-3);
        let (blue, _) = blue_and_red(&steady_mesh(&before, "before a sheet"));
        assert!(blue > ALL / 10, "{blue}");
    }
}

#[test]
fn a_face_casts_no_shadow_from_a_light_on_it_and_is_not_lit() {
    let mut hung = scene([floor(), leaning()]);
    for (x, z) in [(0.4, 0.1), (2.0 / 3.0, 0.1), (2.5, 0.3)] {
        let on = HERE + turn() * DVec3::new(x, 0.0, z);
        hung.lights = [lamp(on.x, on.y, on.z)].into_iter().collect();
        let what = format!("a lamp at {x}, {z} in a sheet");
        let lit = steady_mesh(&hung, &what);
        let automatic = at(&hung, Precision::Auto);
        assert_same_but_for_edges(&automatic, &lit, &what);
        // As if the sheet were absent, except where it is visible.
        let mut alone = hung.clone();
        alone.objects.remove(1);
        let alone = at(&alone, Precision::Double);
        let is_floor = |pixel: &[u8; 4]| pixel[2] == 0 || pixel[0] > 0;
        let pairs = lit.pixels.iter().zip(&alone.pixels);
        let pairs = pairs.filter(|(lit, alone)| is_floor(lit) && is_floor(alone));
        let differ = pairs.filter(|(lit, alone)| lit[0].abs_diff(alone[0]) > 1);
        assert_eq!(differ.count(), 0, "{what}");
    }
}

#[test]
fn a_lamp_a_rounding_below_the_ceiling_lights_the_room() {
    // Mesh files store heights in single precision, unlike scene files.
    let height = f64::from(2.7_f32);
    let ceiling = sheet(1, 8.0, (DVec3::Y * height, DVec3::ZERO));
    let hung = DVec3::new(3.0, height - 0.5, -3.0);
    let shelf = block(DVec3::new(0.3, 0.5, 0.3), (hung, DVec3::ZERO));
    let mut room = with_camera(scene([floor(), ceiling, shelf]), |camera| {
        camera.position = DVec3::new(0.5, 1.6, 2.3);
        camera.look_at = DVec3::new(-0.1, -1.0, -0.5);
    });
    room.lights = [lamp(0.0, 2.7, 0.3)].into_iter().collect();
    let (automatic, double) = (at(&room, Precision::Auto), at(&room, Precision::Double));
    assert_same_but_for_edges(&automatic, &double, "a room");
    room.objects.remove(1);
    let open = at(&room, Precision::Double);
    assert_same_but_for_edges(&double, &open, "without its ceiling");
}

#[test]
fn of_hundreds_of_things_in_a_surface_the_first_is_seen() {
    // Alternately red and blue rugs, all listed before their red floor or all after it.
    let rug = |place: u32, height: f64| -> Shape {
        let (x, z) = (f64::from(place % 20), f64::from(place / 20));
        let center = DVec3::new(x * 0.5 - 5.0, height, z * 0.5 - 6.0);
        Disc {
            center,
            normal: DVec3::Y,
            radius: 0.2,
        }
        .into()
    };
    for (count, is_first) in [(30, true), (400, true), (400, false)] {
        let rugs = (0..count).map(|place| rug(place, 0.0));
        let (before, behind) = if is_first {
            (Some(rugs), None)
        } else {
            (None, Some(rugs))
        };
        let before = before.into_iter().flatten();
        let of_all = scene(before.chain([floor()]).chain(behind.into_iter().flatten()));
        let picture = steady(&of_all, "rugs");
        if is_first {
            // As if they lay a little above it.
            let lifted = (0..count).map(|place| rug(place, 1e-4));
            let lifted = scene(lifted.chain([floor()]));
            assert_same_but_for_edges(&picture, &at(&lifted, Precision::Double), "lifted");
        }
        let (blue, red) = blue_and_red(&picture);
        assert_eq!(blue > 0, is_first, "{count}: {blue} {red}");
        assert!(red > ALL / 2, "{count}: {blue} {red}");
    }
}

#[test]
fn a_light_in_the_plane_of_a_face_does_not_light_it_wherever_that_is() {
    for offset in [0.0, 1e4, 1e5, 1e6] {
        let there = HERE + DVec3::new(offset, -offset, 0.3 * offset);
        let mut lit = with_camera(scene([sheet(3, 4.0, (there, TURNED))]), |camera| {
            camera.position = there + turn() * DVec3::new(0.5, 4.0, 1.0);
            camera.look_at = turn() * DVec3::new(-0.1, -1.0, -0.2);
        });
        // Beside the sheet, outside its bounding box.
        let on = there + turn() * DVec3::new(2.5, 0.0, 0.3);
        lit.lights = [lamp(on.x, on.y, on.z)].into_iter().collect();
        let what = format!("a lamp beside a sheet {offset} away");
        let double = at(&lit, Precision::Double);
        let automatic = at(&lit, Precision::Auto);
        assert_same_but_for_edges(&automatic, &double, &what);
        lit.lights = glint::scene::List::new();
        let dark = at(&lit, Precision::Double);
        assert_same_but_for_edges(&double, &dark, &what);
    }
}

#[test]
fn a_light_a_little_above_a_large_face_lights_it() {
    let ground = sheet(1, 8000.0, (DVec3::ZERO, DVec3::ZERO));
    let mut near = with_camera(scene([ground]), |camera| {
        camera.position = DVec3::new(1000.0, 0.02, 700.0);
        camera.look_at = DVec3::new(0.01, -1.0, 0.02);
    });
    near.lights = [lamp(1000.0, 1e-3, 700.0)].into_iter().collect();
    let (automatic, double) = (at(&near, Precision::Auto), at(&near, Precision::Double));
    assert_same_but_for_edges(&automatic, &double, "a lamp just above the ground");
    let bright = |image: &Image| image.pixels.iter().map(|pixel| pixel[0]).max();
    near.lights = glint::scene::List::new();
    assert!(bright(&at(&near, Precision::Double)) < bright(&double));
}

#[test]
fn what_is_just_above_an_eye_on_a_face_is_seen() {
    let corners = |height: f64| {
        [(-1.0, -1.0), (1.0, -1.0), (0.0, 1.0)].map(|(x, z)| DVec3::new(x * 1e3, height, z * 1e3))
    };
    let points = [corners(0.0), corners(1e-4)].concat();
    let layers = Triangles::new(points, vec![[0, 1, 2], [3, 4, 5]]).expect("in range");
    let under = with_camera(scene([floor(), Mesh::of(layers).into()]), |camera| {
        camera.position = DVec3::new(3.0, 0.0, 5.0);
        camera.look_at = DVec3::new(0.1, 1.0, 0.2);
    });
    let (automatic, double) = (at(&under, Precision::Auto), at(&under, Precision::Double));
    assert_eq!(blue_and_red(&double), (ALL, 0));
    assert_same_but_for_edges(&automatic, &double, "under a roof");
}

#[test]
fn what_is_smooth_and_what_is_flat_in_one_place_do_not_look_alike() {
    // The visible sides of the boxes coincide.
    let smooth = |wide: f64| {
        let mut shape = block(DVec3::new(wide, 1.0, 1.0), (HERE, DVec3::Z * 5.0));
        if let Shape::Mesh(mesh) = &mut shape {
            mesh.smooth = 180.0;
        }
        shape
    };
    let mut of_two = scene([block(DVec3::ONE, (HERE, DVec3::Z * 5.0)), smooth(2.0)]);
    let red = of_two.color_packs["red"].clone();
    if let Some(blue) = of_two.packs_mut().get_mut("blue") {
        *blue = red;
    }
    let mut of_one = of_two.clone();
    if let Some(object) = of_one.objects.get_mut(1) {
        object.color_pack = "red".to_owned();
    }
    let two = steady_mesh(&of_two, "two packs");
    assert!(two == steady_mesh(&of_one, "one pack"));
}
