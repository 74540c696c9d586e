use super::*;
use crate::scene::{EXAMPLES, Precision, SphereMethod};

const SIDE: usize = 40;

/// The number of channels that differ by more than a level from the picture of the tracer.
fn differences(scene: &Scene) -> usize {
    let request = RenderRequest {
        precision: Precision::Double,
        ..RenderRequest::sized(SIDE as u32, SIDE as u32)
    };
    let picture = render(scene, &request, &RenderControl::default());
    let picture = picture.expect("nobody stops it").0;
    let framing = scene.camera.framing().expect("a basis");
    let mut count = 0;
    for (index, pixel) in picture.pixels.iter().enumerate() {
        let middle = |place: usize| (place as f64 + 0.5) / SIDE as f64 - 0.5;
        let (x, y) = (middle(index % SIDE), -middle(index / SIDE));
        let (origin, direction) = framing.ray([x, y]);
        let color = explain(scene, origin, direction).color() * 255.0;
        let off = color.to_array().into_iter().zip(pixel);
        count += off
            .filter(|(channel, level)| (channel - f64::from(**level)).abs() > 0.51)
            .count();
    }
    count
}

#[test]
fn the_terms_add_up_to_what_the_tracer_draws() {
    for example in &EXAMPLES {
        let mut scene = example.document().scene;
        // Testing every ray against each of 24,000 faces takes too long.
        if scene.faces() > 1000 {
            continue;
        }
        scene.render.reflection_limit = 3;
        assert_eq!(differences(&scene), 0, "{}", example.name);
    }
    let mut wrong = Scene::demo();
    wrong.lights[0].intensity += 0.05;
    let Shape::Sphere(ball) = &mut wrong.objects[0].shape else {
        panic!("a ball");
    };
    ball.radius += 1.0;
    assert_eq!(differences(&wrong), 0);
}

#[test]
fn what_is_drawn_is_what_the_chosen_formulas_come_to() {
    let mut scene = Scene::demo();
    scene.render.reflection_limit = 3;
    let framing = scene.camera.framing().expect("a basis");
    let mut far = scene.clone();
    // At a distance of a thousand radii, the classic formula in single precision shades a ball wrongly.
    far.objects.retain(|object| object.name == "Sphere 1");
    far.objects[0].shape = crate::scene::Sphere {
        center: DVec3::new(0.0, 0.0, -30_000.0),
        radius: 30.0,
    }
    .into();
    far.camera.position = DVec3::ZERO;
    far.render.sphere = SphereMethod::Classic;
    far.render.precision = Precision::Single;
    let off = |scene: &Scene, (origin, direction)| {
        let sum = explain(scene, origin, direction).color();
        let drawn = drawn(scene, origin, direction).expect("drawn");
        (sum - drawn).abs().max_element() * 255.0
    };
    let (mut wrong, mut most) = (0, 0.0_f64);
    for place in 0..100 {
        let at = |step: usize| (step as f64 + 0.5) / 10.0 - 0.5;
        let [x, y] = [at(place % 10), at(place / 10)];
        most = most.max(off(&scene, framing.ray([x, y])));
        let target = DVec3::new(x * 40.0, y * 40.0, -30_000.0);
        let is_wrong = off(&far, (DVec3::ZERO, target.normalize())) > 2.0;
        wrong += usize::from(is_wrong);
    }
    assert!(most < 1.01, "{most}");
    assert!(wrong > 10, "{wrong}");
}

#[test]
fn what_stands_before_a_light_is_named() {
    let scene = Scene::demo();
    // A point on the floor with Sphere 1 between it and Light 1, which is above to the left.
    let lamp = scene.lights[0].position;
    let ball = scene.objects[0].shape.position();
    let towards = (ball - lamp).normalize();
    let floor = lamp + towards * (lamp.y / -towards.y);
    let eye = floor + DVec3::new(0.0, 1.0, 0.0);
    let Explanation::Surface(lit) = explain(&scene, eye, DVec3::NEG_Y) else {
        panic!("the floor");
    };
    assert_eq!(lit.object, "Plane");
    let first = &lit.lights[0];
    assert_eq!(
        (first.light.as_str(), first.blocker.as_deref()),
        ("Light 1", Some("Sphere 1"))
    );
    assert_eq!((first.diffuse, first.specular), (DVec3::ZERO, DVec3::ZERO));
    assert!(lit.mirror.is_some());
}

#[test]
fn of_what_fills_one_surface_the_first_is_named() {
    let mut scene = Scene::demo();
    scene.objects.retain(|object| object.name == "Plane");
    let normal = DVec3::new(0.3, 1.0, 0.2);
    let plane = crate::scene::Plane {
        point: DVec3::ZERO,
        normal,
    };
    scene.objects[0].shape = plane.into();
    let (along, across) = (normal.cross(DVec3::X), normal.cross(normal.cross(DVec3::X)));
    let [a, b, c] = [along, across, -along - across].map(|corner| corner * 50.0);
    let piece = crate::scene::Triangle { a, b, c };
    scene
        .objects
        .push(crate::scene::Object::new("Piece", "light", piece));
    for place in 0..40 {
        let place = f64::from(place);
        let target = along * (place * 0.7 - 10.0) + across * (place * 0.3);
        let origin = DVec3::new(3.0, 170.0, 11.0 + place);
        let direction = (target - origin).normalize();
        let Explanation::Surface(lit) = explain(&scene, origin, direction) else {
            panic!("the plane is met");
        };
        assert_eq!(lit.object, "Plane");
    }
}
