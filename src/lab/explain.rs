//! Explains the colour of a pixel: every term of the shading sum as a number, reflection by reflection.
//!
//! Written plainly and independently of the tracer, one ray at a time in double precision; a test compares the two.

use glam::DVec3;

use crate::image::render;
use crate::plan::RenderRequest;
use crate::scene::{
    Camera, ColorPack, CoordinateFrame, Projection, Sampling, Scene, Shape, coincidences, unit,
};
use crate::trace::RenderControl;

/// Least distance of a hit from the origin of its ray, relative to the largest coordinate: closer hits are the
/// surface that the ray starts on, found again because of rounding.
const MIN_HIT_DISTANCE: f64 = 1e-10;

/// Relative distance within which two hits are on the same surface: single precision cannot tell them apart.
const SAME_SURFACE_DISTANCE: f64 = 1e-6;

/// What a ray hits, with its colour.
#[derive(Clone, Debug, PartialEq)]
pub enum Explanation {
    /// Nothing: the colour of the background, linear 0–1.
    Sky(DVec3),
    /// The marker of the light with this name, in its full ambient colour.
    Marker(String, DVec3),
    /// A surface.
    Surface(Box<ShadingTerms>),
}

/// A point on an object, and the terms that add up to its colour: linear, 0–1 each.
#[derive(Clone, Debug, PartialEq)]
pub struct ShadingTerms {
    /// The object's name.
    pub object: String,
    /// The name of the color pack.
    pub pack: String,
    /// The position of the point, in world units.
    pub point: DVec3,
    /// The unit normal, facing the viewer.
    pub normal: DVec3,
    /// Whether it is a mesh whose faces the tracer shades as one curved surface. The normal and the terms here are
    /// those of the flat face.
    pub is_smooth: bool,
    /// Distance from the origin of the ray, in world units.
    pub distance: f64,
    /// Ambient intensity · ambient colour.
    pub ambient: DVec3,
    /// The contribution of each light that shines.
    pub lights: Vec<LightTerm>,
    /// The filter, Σ intensity · specular colour, and what is seen in the mirror; `None` if it does not reflect.
    pub mirror: Option<(DVec3, Explanation)>,
}

/// The contribution of a light.
#[derive(Clone, Debug, PartialEq)]
pub struct LightTerm {
    /// The light's name.
    pub light: String,
    /// Its intensity, 0–1.
    pub intensity: f64,
    /// Cosine of the angle between the normal and the direction of the light; if it is negative, the light adds
    /// nothing.
    pub cosine: f64,
    /// The name of the object that shadows the point, if there is one.
    pub blocker: Option<String>,
    /// Intensity · diffuse colour · cosine.
    pub diffuse: DVec3,
    /// Intensity · specular colour · (normal · half vector) ^ exponent.
    pub specular: DVec3,
}

impl Explanation {
    /// The colour: the sum of the terms, each channel at most 1.
    pub fn color(&self) -> DVec3 {
        match self {
            Self::Sky(color) | Self::Marker(_, color) => *color,
            Self::Surface(lit) => lit.color(),
        }
    }
}

impl ShadingTerms {
    fn color(&self) -> DVec3 {
        let lights = self.lights.iter().map(|term| term.diffuse + term.specular);
        let mirror = self.mirror.as_ref();
        let mirror = mirror.map_or(DVec3::ZERO, |(filter, seen)| *filter * seen.color());
        let sum = self.ambient + lights.sum::<DVec3>() + mirror;
        sum.clamp(DVec3::ZERO, DVec3::ONE)
    }
}

/// Explains what a ray with a unit direction sees in a scene, which must pass [`crate::scene::check`]. Faces of
/// meshes are shaded flat.
pub fn explain(scene: &Scene, origin: DVec3, direction: DVec3) -> Explanation {
    explain_ray(scene, (origin, direction), 0)
}

/// The colour that the tracer draws for this ray, linear 0–1, with the methods and the precision of the scene, but
/// without antialiasing; `None` if nothing is drawn.
pub fn drawn(scene: &Scene, origin: DVec3, direction: DVec3) -> Option<DVec3> {
    let camera = Camera {
        position: origin,
        look_at: direction,
        up: direction.any_orthogonal_vector(),
        projection: Projection::Perspective,
        ..scene.camera.clone()
    };
    let mut single_ray_scene = Scene {
        camera,
        ..scene.clone()
    };
    single_ray_scene.render.antialias = Sampling::Centres;
    let request = RenderRequest::of(&single_ray_scene, 1, 1);
    let (picture, _) = render(&single_ray_scene, &request, &RenderControl::default())?;
    let [red, green, blue, _] = picture.pixels.first()?.map(f64::from);
    Some(linear(DVec3::new(red, green, blue)))
}

/// The first object that a ray with a unit direction hits, as an index into the scene's list, and its distance;
/// `None` if a light's marker comes first. If several objects share the surface, any of them may be returned.
pub fn first_hit(scene: &Scene, origin: DVec3, direction: DVec3) -> Option<(usize, f64)> {
    let hit = nearest_hit(scene, origin, direction)?;
    match hit.kind {
        HitKind::Object(index) => Some((index, hit.t)),
        HitKind::Marker(..) => None,
    }
}

/// A hit of a ray.
struct RayHit<'a> {
    t: f64,
    normal: DVec3,
    kind: HitKind<'a>,
}

#[derive(Clone, Copy)]
enum HitKind<'a> {
    Object(usize),
    Marker(&'a str, &'a str),
}

fn linear(color: DVec3) -> DVec3 {
    color / 255.0
}

fn explain_ray(scene: &Scene, (origin, direction): (DVec3, DVec3), bounces: u32) -> Explanation {
    let Some(hit) = nearest_hit(scene, origin, direction) else {
        return Explanation::Sky(linear(scene.background));
    };
    let hit = earlier_coincident_hit(scene, &hit, (origin, direction)).unwrap_or(hit);
    let pack_of = |name: &str| scene.color_packs.get(name).cloned().unwrap_or_default();
    let index = match hit.kind {
        HitKind::Marker(light, pack) => {
            return Explanation::Marker(light.to_owned(), linear(pack_of(pack).ambient));
        }
        HitKind::Object(index) => index,
    };
    let object = &scene.objects[index];
    let pack = pack_of(&object.color_pack);
    let point = origin + direction * hit.t;
    let normal = if hit.normal.dot(direction) > 0.0 {
        -hit.normal
    } else {
        hit.normal
    };
    let shining = scene.visible_lights();
    let lights = shining.clone().filter(|light| light.intensity > 0.0);
    let lights = lights.map(|light| light_term(scene, &pack, light, (point, normal, direction)));
    let mirror = (pack.reflective && bounces < scene.render.reflection_limit).then(|| {
        let mirrored = direction - normal * (2.0 * direction.dot(normal));
        let intensities: f64 = shining.map(|light| light.intensity).sum();
        let seen = explain_ray(scene, (point, mirrored.normalize_or_zero()), bounces + 1);
        (linear(pack.specular) * intensities, seen)
    });
    Explanation::Surface(Box::new(ShadingTerms {
        object: object.name.clone(),
        pack: object.color_pack.clone(),
        point,
        normal,
        is_smooth: object.is_smooth(),
        distance: hit.t,
        ambient: linear(pack.ambient) * scene.ambient_intensity,
        lights: lights.collect(),
        mirror,
    }))
}

/// The contribution of a light by Phong's model with Blinn's half vector: "Models of light reflection for computer
/// synthesized pictures", SIGGRAPH 1977.
fn light_term(
    scene: &Scene,
    pack: &ColorPack,
    light: &crate::scene::Light,
    (point, normal, direction): (DVec3, DVec3, DVec3),
) -> LightTerm {
    let to_light = light.position - point;
    let towards = to_light.normalize_or_zero();
    let cosine = normal.dot(towards);
    let blocker = (cosine > 0.0)
        .then(|| blocker(scene, point, towards, to_light.length()))
        .flatten();
    let half = (towards - direction).normalize_or_zero();
    let highlight = normal.dot(half).max(0.0).powf(pack.phong_exponent);
    let received = if cosine > 0.0 && blocker.is_none() {
        light.intensity
    } else {
        0.0
    };
    LightTerm {
        light: light.name.clone(),
        intensity: light.intensity,
        cosine,
        blocker,
        diffuse: linear(pack.diffuse) * (received * cosine.max(0.0)),
        specular: linear(pack.specular) * (received * highlight),
    }
}

fn nearest_hit(scene: &Scene, origin: DVec3, direction: DVec3) -> Option<RayHit<'_>> {
    let objects = scene.objects.visible().filter_map(|(index, object)| {
        let (t, normal) = intersect_shape(&object.shape, origin, direction)?;
        let kind = HitKind::Object(index);
        Some(RayHit { t, normal, kind })
    });
    let lights = scene.visible_lights();
    let lights = lights.filter(|_| scene.light_visualization);
    let markers = lights.filter_map(|light| {
        let marker = light.marker.as_ref()?;
        let (t, normal) = intersect_sphere(light.position, marker.radius, origin, direction)?;
        let kind = HitKind::Marker(&light.name, &marker.color_pack);
        Some(RayHit { t, normal, kind })
    });
    objects
        .chain(markers)
        .min_by(|one, other| one.t.total_cmp(&other.t))
}

/// The hit with an object that is in the same surface and earlier in the list, if there is one: the earlier object is
/// visible.
fn earlier_coincident_hit<'a>(
    scene: &'a Scene,
    hit: &RayHit<'a>,
    (origin, direction): (DVec3, DVec3),
) -> Option<RayHit<'a>> {
    let HitKind::Object(later) = hit.kind else {
        return None;
    };
    let frame = CoordinateFrame::of(scene);
    let centre = frame.map_or(scene.camera.position, |frame| frame.centre);
    let pairs = coincidences(&scene.objects, centre).into_iter();
    let mut earlier = pairs.filter(|pair| pair.later == later);
    earlier.find_map(|pair| {
        let (t, normal) = intersect_shape(&scene.objects[pair.earlier].shape, origin, direction)?;
        // The ray may hit a mesh somewhere else than in the shared surface.
        let gap = (t - hit.t).abs() * normal.dot(direction).abs();
        if gap > SAME_SURFACE_DISTANCE * (hit.t + (origin - centre).length()) {
            return None;
        }
        let kind = HitKind::Object(pair.earlier);
        Some(RayHit { t, normal, kind })
    })
}

/// The name of an object that is between a point and a light.
fn blocker(scene: &Scene, point: DVec3, towards: DVec3, distance: f64) -> Option<String> {
    let mut objects = scene.visible_objects();
    let found = objects.find(|object| {
        let hit = intersect_shape(&object.shape, point, towards);
        hit.is_some_and(|(t, _)| t < distance * (1.0 - MIN_HIT_DISTANCE))
    });
    found.map(|object| object.name.clone())
}

/// The distance at which a ray with a unit direction hits a shape, and the unit normal there: that of a ball points
/// outwards.
pub fn intersect_shape(shape: &Shape, origin: DVec3, direction: DVec3) -> Option<(f64, DVec3)> {
    match shape {
        Shape::Sphere(ball) => intersect_sphere(ball.center, ball.radius, origin, direction),
        Shape::Plane(plane) => intersect_plane(plane.point, plane.normal, origin, direction),
        Shape::Disc(disc) => {
            let hit = intersect_plane(disc.center, disc.normal, origin, direction)?;
            let radial_distance = (origin + direction * hit.0 - disc.center).length();
            (radial_distance <= disc.radius).then_some(hit)
        }
        Shape::Triangle(triangle) => intersect_triangle(triangle.corners(), origin, direction),
        Shape::Mesh(mesh) => {
            let faces = mesh.world_corners();
            let hits = faces.filter_map(|corners| intersect_triangle(corners, origin, direction));
            hits.min_by(|one, other| one.0.total_cmp(&other.0))
        }
    }
}

/// Least distance of a hit from `origin`, to allow for rounding.
fn least_hit_distance(origin: DVec3) -> f64 {
    MIN_HIT_DISTANCE * (1.0 + origin.abs().max_element())
}

fn intersect_sphere(
    center: DVec3,
    radius: f64,
    origin: DVec3,
    direction: DVec3,
) -> Option<(f64, DVec3)> {
    let x = origin - center;
    let along = direction.dot(x);
    let squared_distance = (x - direction * along).length_squared();
    let root = (radius * radius - squared_distance).max(0.0).sqrt();
    if squared_distance > radius * radius {
        return None;
    }
    let min_t = least_hit_distance(origin) + MIN_HIT_DISTANCE * radius;
    let t = [-along - root, -along + root]
        .into_iter()
        .find(|t| *t > min_t)?;
    Some((t, (origin + direction * t - center) / radius))
}

fn intersect_plane(
    point: DVec3,
    normal: DVec3,
    origin: DVec3,
    direction: DVec3,
) -> Option<(f64, DVec3)> {
    let normal = unit(normal)?;
    let t = (point - origin).dot(normal) / direction.dot(normal);
    (t.is_finite() && t > least_hit_distance(origin)).then_some((t, normal))
}

fn intersect_triangle(
    [a, b, c]: [DVec3; 3],
    origin: DVec3,
    direction: DVec3,
) -> Option<(f64, DVec3)> {
    let (t, normal) = intersect_plane(a, (c - a).cross(b - a), origin, direction)?;
    let p = origin + direction * t;
    let is_inside = [(a, b), (b, c), (c, a)]
        .iter()
        .all(|&(from, to)| (to - from).cross(p - from).dot(normal) <= 0.0);
    is_inside.then_some((t, normal))
}

#[cfg(test)]
mod tests;
