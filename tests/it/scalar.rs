//! The built-in referee: a second engine, written from the specification of the picture and not from the tracer,
//! with which it shares no code. It has no lanes, tiles, trees, plans or single precision: one ray at a time is
//! tested against everything, in `f64`, and secondary rays start a little off the surface. Where it and Glint
//! agree, two independent programs have read the same specification.
//!
//! It treats faces as flat, as the specification does not say how the normals of a curved surface are computed.

use glam::{DQuat, DVec3};
use glint::image::Image;
use glint::plan::RenderRequest;
use glint::scene::{
    Camera, ColorPack, EXAMPLES, Light, Mesh, Precision, Projection, Sampling, Scene, Shape,
};

use crate::pictures::picture;
use crate::random;

const WIDTH: u32 = 160;
const HEIGHT: u32 = 120;

/// One in this many pixels may differ, for double precision and for the precision that the plan chooses.
const ONE_OF: [(Precision, usize); 2] = [(Precision::Double, 1000), (Precision::Auto, 500)];

/// Fraction of a length that counts as nothing: millions of rounding errors, and far less than is visible.
const LITTLE: f64 = 1e-9;

/// Number of faces of a mesh that share a bounding sphere.
const GROUP: usize = 64;

/// A ray; `way` has length 1, so that parameters are distances.
struct Ray {
    origin: DVec3,
    way: DVec3,
}

impl Ray {
    /// The point at a distance along the ray.
    fn at(&self, distance: f64) -> DVec3 {
        self.origin + self.way * distance
    }

    /// The squared distance of a point from the line, and the distance along the ray.
    fn arm_to(&self, point: DVec3) -> (f64, f64) {
        let arm = point - self.origin;
        let ahead = arm.dot(self.way);
        ((arm - self.way * ahead).length_squared(), ahead)
    }
}

/// Where a ray hits something; the normal may be on either side.
struct Hit {
    distance: f64,
    normal: DVec3,
}

/// A few faces and their bounding sphere, without which a mesh would take minutes.
struct Group {
    faces: Vec<[DVec3; 3]>,
    center: DVec3,
    radius: f64,
}

impl Group {
    /// The sphere is centred at the mean of the corners and reaches the farthest one.
    fn of(faces: &[[DVec3; 3]]) -> Self {
        let corners = faces.as_flattened();
        let center = corners.iter().sum::<DVec3>() / corners.len() as f64;
        let reach = corners.iter().map(|corner| corner.distance(center));
        Self {
            faces: faces.to_vec(),
            center,
            radius: reach.fold(0.0, f64::max) * (1.0 + LITTLE),
        }
    }

    /// Leaves out only what cannot hit the ray, so that the sphere has no effect on the picture.
    fn may_meet(&self, ray: &Ray) -> bool {
        ray.arm_to(self.center).0 <= self.radius * self.radius
    }
}

/// What a ray can hit. A plane is an infinite disc, and a triangle is a mesh of one face.
enum Form {
    Ball(DVec3, f64),
    Disc(DVec3, DVec3, f64),
    Faces(Vec<Group>),
}

impl Form {
    /// Converts a shape of the file to world coordinates.
    fn of(shape: &Shape) -> Self {
        match shape {
            Shape::Sphere(ball) => Self::Ball(ball.center, ball.radius),
            Shape::Plane(plane) => Self::Disc(plane.point, plane.normal.normalize(), f64::INFINITY),
            Shape::Disc(disc) => Self::Disc(disc.center, disc.normal.normalize(), disc.radius),
            Shape::Triangle(it) => Self::Faces(vec![Group::of(&[[it.a, it.b, it.c]])]),
            Shape::Mesh(mesh) => Self::Faces(faces_of(mesh).chunks(GROUP).map(Group::of).collect()),
        }
    }

    /// The nearest hit in front of the ray's origin.
    fn meet(&self, ray: &Ray) -> Option<Hit> {
        match self {
            Self::Ball(center, radius) => meet_ball(*center, *radius, ray),
            Self::Disc(center, normal, radius) => meet_disc(*center, *normal, *radius, ray),
            Self::Faces(groups) => {
                let near = groups.iter().filter(|group| group.may_meet(ray));
                let hits = near.flat_map(|group| &group.faces);
                let hits = hits.filter_map(|face| meet_face(face, ray));
                hits.min_by(|a, b| a.distance.total_cmp(&b.distance))
            }
        }
    }
}

/// The faces of a mesh in world coordinates: scaled, rotated about x, then y, then z, then moved.
fn faces_of(mesh: &Mesh) -> Vec<[DVec3; 3]> {
    let [x, y, z] = mesh.rotation.to_array().map(f64::to_radians);
    let turn = DQuat::from_rotation_z(z) * DQuat::from_rotation_y(y) * DQuat::from_rotation_x(x);
    let triangles = mesh.source.triangles();
    let place = |&point: &DVec3| turn * (point * mesh.scale) + mesh.position;
    let points: Vec<DVec3> = triangles.points().iter().map(place).collect();
    let corners = |face: &[u32; 3]| face.map(|corner| points[corner as usize]);
    triangles.faces().iter().map(corners).collect()
}

/// A sphere is hit where the ray enters it or, from inside, where it leaves it.
fn meet_ball(center: DVec3, radius: f64, ray: &Ray) -> Option<Hit> {
    let (across, ahead) = ray.arm_to(center);
    // NaN for a ray that misses, which then fails the comparison below.
    let half = (radius * radius - across).sqrt();
    let mut ends = [ahead - half, ahead + half].into_iter();
    let distance = ends.find(|end| *end > 0.0)?;
    let normal = (ray.at(distance) - center) / radius;
    Some(Hit { distance, normal })
}

/// A disc is hit from both sides, but not edge-on.
fn meet_disc(center: DVec3, normal: DVec3, radius: f64, ray: &Ray) -> Option<Hit> {
    let distance = (center - ray.origin).dot(normal) / ray.way.dot(normal);
    let is_ahead = distance > 0.0 && distance.is_finite();
    let is_met = is_ahead && ray.at(distance).distance(center) <= radius;
    is_met.then_some(Hit { distance, normal })
}

/// A face is hit where no barycentric coordinate is negative, by Cramer's rule; slightly negative ones count, so
/// that there are no gaps between neighbours.
fn meet_face(&[a, b, c]: &[DVec3; 3], ray: &Ray) -> Option<Hit> {
    let (ab, ac, arm) = (b - a, c - a, ray.origin - a);
    let (beside, beyond) = (ray.way.cross(ac), arm.cross(ab));
    let volume = ab.dot(beside);
    let (of_b, of_c) = (arm.dot(beside) / volume, ray.way.dot(beyond) / volume);
    let distance = ac.dot(beyond) / volume;
    let is_ahead = distance > 0.0 && distance.is_finite();
    let is_met = is_ahead && of_b.min(of_c).min(1.0 - of_b - of_c) >= -LITTLE;
    is_met.then(|| Hit {
        distance,
        normal: ab.cross(ac).normalize(),
    })
}

/// An object with its material.
struct Thing<'a> {
    form: Form,
    pack: &'a ColorPack,
    is_marker: bool,
}

/// A visible point: the normal on its visible side, the direction it is seen from, and the start of secondary rays.
struct Spot<'a> {
    place: DVec3,
    start: DVec3,
    normal: DVec3,
    to_viewer: DVec3,
    pack: &'a ColorPack,
}

/// A scene prepared for tracing.
struct Engine<'a> {
    scene: &'a Scene,
    things: Vec<Thing<'a>>,
    lights: Vec<&'a Light>,
}

impl<'a> Engine<'a> {
    /// Invisible objects are left out, and so are the markers of lights that are off.
    fn new(scene: &'a Scene) -> Self {
        let thing = |form, pack: &str, is_marker| Thing {
            form,
            pack: scene.color_packs.get(pack).expect("a checked scene"),
            is_marker,
        };
        let objects = scene.objects.iter().filter(|object| object.visible);
        let objects = objects.map(|it| thing(Form::of(&it.shape), &it.color_pack, false));
        let mut things: Vec<Thing> = objects.collect();
        let lights: Vec<&Light> = scene.lights.iter().filter(|light| light.visible).collect();
        for light in &lights {
            if let (true, Some(marker)) = (scene.light_visualization, &light.marker) {
                let form = Form::Ball(light.position, marker.radius);
                things.push(thing(form, &marker.color_pack, true));
            }
        }
        Self {
            scene,
            things,
            lights,
        }
    }

    /// The nearest hit. Of coincident surfaces, the first in the file wins.
    fn nearest(&self, ray: &Ray) -> Option<(Hit, &Thing<'a>)> {
        let mut nearest: Option<(Hit, &Thing)> = None;
        for thing in &self.things {
            let end = nearest.as_ref().map_or(f64::INFINITY, |it| it.0.distance);
            let hit = thing.form.meet(ray);
            if let Some(hit) = hit.filter(|hit| hit.distance < end * (1.0 - LITTLE)) {
                nearest = Some((hit, thing));
            }
        }
        nearest
    }

    /// The colour seen along a ray, 0–1, with this many reflections left.
    fn color(&self, ray: &Ray, mirrors_left: u32) -> DVec3 {
        let Some((hit, thing)) = self.nearest(ray) else {
            return self.scene.background / 255.0;
        };
        let pack = thing.pack;
        if thing.is_marker {
            return pack.ambient / 255.0;
        }
        let (place, to_viewer) = (ray.at(hit.distance), -ray.way);
        let normal = hit.normal * hit.normal.dot(to_viewer).signum();
        let spot = Spot {
            place,
            start: place + normal * (LITTLE * (place.abs().max_element() + hit.distance)),
            normal,
            to_viewer,
            pack,
        };
        let by_lights = self.lights.iter().map(|light| self.light_at(&spot, light));
        let mut color = pack.ambient * self.scene.ambient_intensity + by_lights.sum::<DVec3>();
        if pack.reflective && mirrors_left > 0 {
            let (origin, way) = (spot.start, ray.way - normal * (2.0 * ray.way.dot(normal)));
            let intensity: f64 = self.lights.iter().map(|light| light.intensity).sum();
            color += pack.specular * intensity * self.color(&Ray { origin, way }, mirrors_left - 1);
        }
        (color / 255.0).min(DVec3::ONE)
    }

    /// What a light adds to the colour of a point, 0–255: nothing from behind or if it is blocked.
    fn light_at(&self, spot: &Spot, light: &Light) -> DVec3 {
        let arm = light.position - spot.place;
        let (distance, way) = (arm.length(), arm.normalize_or_zero());
        let facing = spot.normal.dot(way);
        let origin = spot.start;
        if facing <= 0.0 || self.is_blocked(&Ray { origin, way }, distance) {
            return DVec3::ZERO;
        }
        let halfway = (way + spot.to_viewer).normalize_or_zero();
        let highlight = spot.normal.dot(halfway).max(0.0);
        let highlight = highlight.powf(spot.pack.phong_exponent);
        (spot.pack.diffuse * facing + spot.pack.specular * highlight) * light.intensity
    }

    /// Whether the point is in shadow. A surface on which the light itself lies does not block it.
    fn is_blocked(&self, ray: &Ray, distance: f64) -> bool {
        let mut others = self.things.iter().filter(|thing| !thing.is_marker);
        let end = distance * (1.0 - LITTLE);
        others.any(|thing| thing.form.meet(ray).is_some_and(|hit| hit.distance < end))
    }

    /// Renders the picture row by row from the top, with a ray through the centre of each pixel.
    fn picture(&self) -> Vec<[u8; 3]> {
        let (width, height) = (f64::from(WIDTH), f64::from(HEIGHT));
        let pixels = (0..HEIGHT).flat_map(|row| (0..WIDTH).map(move |column| (column, row)));
        let colors = pixels.map(|(column, row)| {
            let x = (f64::from(column) + 0.5 - width / 2.0) / height;
            let y = (height / 2.0 - f64::from(row) - 0.5) / height;
            let ray = through(&self.scene.camera, x, y);
            self.color(&ray, self.scene.render.reflection_limit) * 255.0
        });
        let bytes = colors.map(|color| color.round().to_array().map(|channel| channel as u8));
        bytes.collect()
    }
}

/// The ray through a position in the picture, in image heights from its centre, y up.
fn through(camera: &Camera, x: f64, y: f64) -> Ray {
    let w = -camera.look_at.normalize();
    let u = camera.up.cross(w).normalize();
    let aside = u * x + w.cross(u) * y;
    let (origin, way) = match camera.projection {
        Projection::Perspective => (camera.position, aside - w * camera.projection_distance),
        Projection::Orthographic => (camera.position + aside * camera.orthographic_height, -w),
    };
    let way = way.normalize();
    Ray { origin, way }
}

/// The picture by the engine under test.
fn by_glint(scene: &Scene, precision: Precision) -> Image {
    let wanted = RenderRequest {
        precision,
        sampling: Sampling::Centres,
        ..RenderRequest::sized(WIDTH, HEIGHT)
    };
    picture(scene, &wanted).0
}

/// The number of pixels that differ by more than one level of 255 in some channel.
fn differing(ours: &[[u8; 3]], theirs: &Image) -> usize {
    assert_eq!(ours.len(), theirs.pixels.len());
    let pairs = ours.iter().zip(&theirs.pixels);
    pairs
        .filter(|(a, b)| (0..3).any(|c| a[c].abs_diff(b[c]) > 1))
        .count()
}

/// Asserts that both engines agree on a scene, in both projections.
pub fn assert_agreed(name: &str, mut scene: Scene) {
    for projection in [Projection::Perspective, Projection::Orthographic] {
        scene.camera.projection = projection;
        let ours = Engine::new(&scene).picture();
        for (precision, one_of) in ONE_OF {
            let differ = differing(&ours, &by_glint(&scene, precision));
            let case = format!("{name}, {projection:?}, {precision:?}");
            assert!(differ * one_of <= ours.len(), "{case}: {differ} pixels");
        }
    }
}

#[test]
fn a_second_engine_draws_the_examples_alike() {
    for example in &EXAMPLES {
        let mut scene = example.document().scene;
        for object in scene.objects.iter_mut() {
            if let Shape::Mesh(mesh) = &mut object.shape {
                mesh.smooth = 0.0;
            }
        }
        assert_agreed(example.name, scene);
    }
}

#[test]
fn a_second_engine_draws_random_scenes_alike() {
    for seed in 0..15 {
        assert_agreed(&format!("random {seed}"), random::scene(seed));
        let name = format!("random {seed} with discs");
        assert_agreed(&name, random::with_discs(seed));
    }
}

/// A change of a scene: its description, and the function.
type Change = (&'static str, fn(&mut Scene));

#[test]
fn a_second_engine_objects_to_another_scene() {
    let changes: [Change; 6] = [
        ("a light moved", |it| it.lights[0].position.x += 5.0),
        ("a dimmer light", |it| it.lights[1].intensity *= 0.9),
        ("no markers", |it| it.light_visualization = false),
        ("a bounce fewer", |it| it.render.reflection_limit -= 1),
        ("a sharper highlight", |it| {
            it.packs_mut()["sphere 1"].phong_exponent *= 1.5;
        }),
        ("an object gone", |it| it.objects[1].visible = false),
    ];
    let demo = Scene::demo();
    for (what, change) in changes {
        let mut changed = demo.clone();
        change(&mut changed);
        let ours = Engine::new(&changed).picture();
        for (precision, one_of) in ONE_OF {
            let differ = differing(&ours, &by_glint(&demo, precision));
            assert!(differ * one_of > ours.len(), "{what}: {differ} pixels");
        }
    }
}
