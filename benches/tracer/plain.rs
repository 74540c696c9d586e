//! The baseline: a straightforward implementation of the image model. One thread, double precision, one ray at a
//! time, a virtual call for every intersection test of every object, nothing skipped, secondary rays that start 0.1
//! away from their surface.

use glam::DVec3;
use glint::image::Image;
use glint::scene::{ColorPack, Plane, Projection, Scene, Shape, Sphere, Triangle};

type V = DVec3;

/// The original program's "distance away constant".
const AWAY: f64 = 0.1;

trait Thing {
    fn hit(&self, origin: V, direction: V) -> Option<f64>;
    fn normal(&self, point: V) -> V;
}

struct Ball {
    center: V,
    radius: f64,
}

impl Thing for Ball {
    fn hit(&self, origin: V, direction: V) -> Option<f64> {
        let x = origin - self.center;
        let b = direction.dot(x);
        let square = b * b - x.dot(x) + self.radius * self.radius;
        let root = if square >= 0.0 {
            square.sqrt()
        } else {
            return None;
        };
        [-b - root, -b + root].into_iter().find(|t| *t > 0.0)
    }

    fn normal(&self, point: V) -> V {
        (point - self.center) * (1.0 / self.radius)
    }
}

struct Flat {
    point: V,
    normal: V,
    corners: Option<[V; 3]>,
}

impl Thing for Flat {
    fn hit(&self, origin: V, direction: V) -> Option<f64> {
        let t = (self.point - origin).dot(self.normal) / direction.dot(self.normal);
        let is_inside = |[a, b, c]: &[V; 3]| {
            let p = origin + direction * t;
            [(a, b), (b, c), (c, a)]
                .iter()
                .all(|&(&from, &to)| (to - from).cross(p - from).dot(self.normal) <= 0.0)
        };
        (t > 0.0 && t.is_finite() && self.corners.as_ref().is_none_or(is_inside)).then_some(t)
    }

    fn normal(&self, _: V) -> V {
        self.normal
    }
}

struct Part<'a> {
    thing: Box<dyn Thing>,
    pack: &'a ColorPack,
    is_marker: bool,
}

struct World<'a> {
    scene: &'a Scene,
    parts: Vec<Part<'a>>,
}

fn thing(shape: &Shape) -> Box<dyn Thing> {
    let unit = |v: V| v.try_normalize().expect("a direction");
    match *shape {
        Shape::Sphere(Sphere { center, radius }) => Box::new(Ball { center, radius }),
        Shape::Plane(Plane { point, normal }) => Box::new(Flat {
            point,
            normal: unit(normal),
            corners: None,
        }),
        Shape::Triangle(Triangle { a, b, c }) => {
            let normal = unit((c - a).cross(b - a));
            Box::new(Flat {
                point: a,
                normal,
                corners: Some([a, b, c]),
            })
        }
        ref other @ (Shape::Disc(_) | Shape::Mesh(_)) => {
            panic!("the baseline draws the demo, which has no {}", other.kind())
        }
    }
}

impl World<'_> {
    fn nearest(&self, origin: V, direction: V) -> Option<(f64, &Part<'_>)> {
        let hits = self
            .parts
            .iter()
            .filter_map(|part| Some((part.thing.hit(origin, direction)?, part)));
        hits.min_by(|a, b| a.0.total_cmp(&b.0))
    }

    fn is_blocked(&self, origin: V, direction: V, distance: f64) -> bool {
        let casting = self.parts.iter().filter(|part| !part.is_marker);
        casting
            .filter_map(|part| part.thing.hit(origin, direction))
            .any(|t| t < distance)
    }

    fn color(&self, origin: V, direction: V, bounces: u32) -> V {
        let Some((t, part)) = self.nearest(origin, direction) else {
            return self.scene.background * (1.0 / 255.0);
        };
        let linear = |color: V| color * (1.0 / 255.0);
        if part.is_marker {
            return linear(part.pack.ambient);
        }
        let point = origin + direction * t;
        let mut normal = part.thing.normal(point);
        if normal.dot(direction) > 0.0 {
            normal = -normal;
        }
        let mut total = linear(part.pack.ambient) * self.scene.ambient_intensity;
        let (diffuse, specular) = (linear(part.pack.diffuse), linear(part.pack.specular));
        for light in &self.scene.lights {
            let l = (light.position - point)
                .try_normalize()
                .expect("not in the light");
            let cosine = normal.dot(l);
            let start = point + l * AWAY;
            let distance = (light.position - start).length();
            if cosine <= 0.0 || self.is_blocked(start, l, distance) {
                continue;
            }
            let h = (l - direction)
                .try_normalize()
                .expect("not against the light");
            let highlight = normal.dot(h).max(0.0).powf(part.pack.phong_exponent);
            total += (diffuse * cosine + specular * highlight) * light.intensity;
        }
        if part.pack.reflective && bounces < self.scene.render.reflection_limit {
            let mirrored = direction - normal * (2.0 * direction.dot(normal));
            let seen = self.color(point + mirrored * AWAY, mirrored, bounces + 1);
            let intensities: f64 = self.scene.lights.iter().map(|light| light.intensity).sum();
            total += specular * seen * intensities;
        }
        total.clamp(V::ZERO, V::ONE)
    }
}

/// The picture of a scene in perspective.
pub fn render(scene: &Scene, width: usize, height: usize) -> Image {
    assert_eq!(scene.camera.projection, Projection::Perspective);
    let object = |object: &'_ glint::scene::Object| thing(&object.shape);
    let mut parts: Vec<Part> = scene
        .objects
        .iter()
        .map(|o| Part {
            thing: object(o),
            pack: &scene.color_packs[&o.color_pack],
            is_marker: false,
        })
        .collect();
    for light in &scene.lights {
        let Some(marker) = &light.marker else {
            continue;
        };
        let ball = Ball {
            center: light.position,
            radius: marker.radius,
        };
        let pack = &scene.color_packs[&marker.color_pack];
        parts.push(Part {
            thing: Box::new(ball),
            pack,
            is_marker: true,
        });
    }
    let world = World { scene, parts };
    let basis = scene.camera.basis().expect("a basis");
    let (u, v, w) = (basis.x_axis, basis.y_axis, basis.z_axis);
    let mut image = Image::new(width, height);
    for (index, pixel) in image.pixels.iter_mut().enumerate() {
        let across = ((index % width) as f64 + 0.5 - width as f64 / 2.0) / height as f64;
        let upwards = (height as f64 / 2.0 - (index / width) as f64 - 0.5) / height as f64;
        let direction = -w * scene.camera.projection_distance + u * across + v * upwards;
        let direction = direction.try_normalize().expect("a direction");
        let color = world.color(scene.camera.position, direction, 0);
        let [r, g, b] = color
            .to_array()
            .map(|channel| (channel * 255.0 + 0.5) as u8);
        *pixel = [r, g, b, 255];
    }
    image
}
