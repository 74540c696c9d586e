//! Whether a scene means something: the checks that a file passes before it is loaded and an edit
//! before it is applied. Every refusal names the field, what it must be and what it is.

mod animation;

use std::collections::HashSet;

use glam::DVec3;

use super::locate::PathStep;
use super::notation::format_number;
use super::{
    Camera, Field, FieldValue, LightObj, MAX_REFLECTIONS, MAX_SIDE, Render, Scene, Shape, VERSION,
};

/// Largest coordinate or length, in world units: f32 squares of it are still finite.
const MAX_COORDINATE: f64 = 1e12;
/// Largest Phong exponent; the highlight is then a few ten-thousandths of a degree wide.
const MAX_EXPONENT: f64 = 1e7;
/// Projection distances (image heights) between which directions keep single-precision meaning.
const PROJECTION_DISTANCES: (f64, f64) = (1e-3, 1e5);
/// Most pixels in a picture: 1 GiB of 8-bit RGBA.
const MAX_PIXELS: u64 = 1 << 28;
/// Longest name, in characters.
const MAX_NAME: usize = 200;

/// Why a scene is refused, and where in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// The way from the scene to the offending value.
    pub path: Vec<PathStep>,
    /// What is wrong, as a sentence without its full stop.
    pub sentence: String,
}

type Check = Result<(), Problem>;

/// Refuses a scene that cannot be traced as it stands, naming the first problem in file order.
///
/// # Errors
/// The [`Problem`], which a file turns into line and column.
pub fn check(scene: &Scene) -> Result<(), Problem> {
    let root = At(Vec::new());
    check_version(&root, scene.version)?;
    root.field("background").color(scene.background)?;
    root.field("ambient_intensity")
        .within(scene.ambient_intensity, 0.0, 1.0)?;
    check_camera(&root.field("camera"), &scene.camera)?;
    check_packs(&root.field("color_packs"), scene)?;
    check_objects(&root.field("objects"), scene)?;
    check_lights(&root.field("lights"), scene)?;
    check_render(&root.field("render"), &scene.render)?;
    animation::check_animation(&root.field("animation"), scene)
}

fn check_version(root: &At, version: u32) -> Check {
    let at = root.field("version");
    match version {
        VERSION => Ok(()),
        0 => at.refuse(format!("version must be {VERSION}, found 0")),
        newer => at.refuse(format!(
            "version {newer} is newer than this program understands ({VERSION}); open it with a newer Glint"
        )),
    }
}

fn check_camera(at: &At, camera: &Camera) -> Check {
    at.field("position").point(camera.position)?;
    at.field("look_at").direction(camera.look_at)?;
    at.field("up").direction(camera.up)?;
    if camera.basis().is_none() {
        return at
            .field("up")
            .refuse("up must not be parallel to look_at".to_owned());
    }
    let (nearest, farthest) = PROJECTION_DISTANCES;
    at.field("projection_distance")
        .within(camera.projection_distance, nearest, farthest)?;
    at.field("orthographic_height")
        .positive(camera.orthographic_height)
}

fn check_packs(at: &At, scene: &Scene) -> Check {
    for (name, pack) in &scene.color_packs {
        let at = at.key(name);
        check_name(&at, name)?;
        at.field("ambient").color(pack.ambient)?;
        at.field("diffuse").color(pack.diffuse)?;
        at.field("specular").color(pack.specular)?;
        at.field("phong_exponent")
            .within(pack.phong_exponent, 0.0, MAX_EXPONENT)?;
    }
    Ok(())
}

fn check_objects(at: &At, scene: &Scene) -> Check {
    let mut names = HashSet::new();
    for (index, object) in scene.objects.iter().enumerate() {
        let at = at.index(index);
        check_name(&at.field("name"), &object.name)?;
        if !names.insert(&object.name) {
            return at
                .field("name")
                .refuse(format!("there is another object named {:?}", object.name));
        }
        check_pack_exists(&at.field("color_pack"), scene, &object.color_pack)?;
        check_shape(&at.field("shape"), &object.shape)?;
    }
    Ok(())
}

fn check_lights(at: &At, scene: &Scene) -> Check {
    let mut names = HashSet::new();
    for (index, light) in scene.lights.iter().enumerate() {
        let at = at.index(index);
        check_name(&at.field("name"), &light.name)?;
        if !names.insert(&light.name) {
            return at
                .field("name")
                .refuse(format!("there is another light named {:?}", light.name));
        }
        at.field("position").point(light.position)?;
        at.field("intensity").within(light.intensity, 0.0, 1.0)?;
        if let Some(LightObj { radius, color_pack }) = &light.marker {
            let at = at.field("marker");
            at.field("radius").positive(*radius)?;
            check_pack_exists(&at.field("color_pack"), scene, color_pack)?;
        }
    }
    Ok(())
}

fn check_shape(at: &At, shape: &Shape) -> Check {
    let mut result = Ok(());
    shape.clone().fields(&mut |Field { name, value, .. }| {
        if result.is_ok() {
            let at = at.field(name);
            result = match value {
                FieldValue::Point(point) => at.point(*point),
                FieldValue::Direction(direction) => at.direction(*direction),
                FieldValue::Length(length) => at.positive(*length),
            };
        }
    });
    result?;
    shape
        .problem()
        .map_or(Ok(()), |sentence| at.refuse(sentence))
}

fn check_render(at: &At, render: &Render) -> Check {
    for (name, side) in [("width", render.width), ("height", render.height)] {
        if side == 0 || side > MAX_SIDE {
            return at.field(name).refuse(format!(
                "{name} must be between 1 and {MAX_SIDE} pixels, found {side}"
            ));
        }
    }
    let pixels = u64::from(render.width) * u64::from(render.height);
    if pixels > MAX_PIXELS {
        return at.field("width").refuse(format!(
            "a picture may have at most {MAX_PIXELS} pixels, found {} × {}",
            render.width, render.height
        ));
    }
    if render.reflection_limit > MAX_REFLECTIONS {
        return at.field("reflection_limit").refuse(format!(
            "reflection_limit must be between 0 and {MAX_REFLECTIONS}, found {}",
            render.reflection_limit
        ));
    }
    Ok(())
}

fn check_name(at: &At, name: &str) -> Check {
    if name.trim().is_empty() {
        return at.refuse("a name must not be empty".to_owned());
    }
    if name.chars().any(char::is_control) {
        return at.refuse(format!(
            "a name must not hold control characters, found {name:?}"
        ));
    }
    if name.chars().count() > MAX_NAME {
        return at.refuse(format!(
            "a name must not be longer than {MAX_NAME} characters"
        ));
    }
    Ok(())
}

fn check_pack_exists(at: &At, scene: &Scene, name: &str) -> Check {
    if scene.color_packs.contains_key(name) {
        return Ok(());
    }
    let known: Vec<String> = scene
        .color_packs
        .keys()
        .take(8)
        .map(|k| format!("{k:?}"))
        .collect();
    let more = if scene.color_packs.len() > known.len() {
        ", …"
    } else {
        ""
    };
    at.refuse(match known.len() {
        0 => format!("there is no color pack named {name:?}: the scene has none"),
        _ => format!(
            "there is no color pack named {name:?}; there are {}{more}",
            known.join(", ")
        ),
    })
}

/// A place in the scene, with the checks that values of the same kind share.
struct At(Vec<PathStep>);

impl At {
    fn then(&self, step: PathStep) -> Self {
        Self(self.0.iter().cloned().chain([step]).collect())
    }

    fn field(&self, name: &'static str) -> Self {
        self.then(PathStep::Field(name))
    }

    fn index(&self, index: usize) -> Self {
        self.then(PathStep::Index(index))
    }

    fn key(&self, key: &str) -> Self {
        self.then(PathStep::Key(key.to_owned()))
    }

    fn name(&self) -> String {
        match self.0.last() {
            Some(PathStep::Field(name)) => (*name).to_owned(),
            Some(PathStep::Index(index)) => format!("item {}", index + 1),
            Some(PathStep::Key(key)) => format!("{key:?}"),
            None => "the scene".to_owned(),
        }
    }

    fn refuse(&self, sentence: String) -> Check {
        Err(Problem {
            path: self.0.clone(),
            sentence,
        })
    }

    fn finite(&self, values: &[f64]) -> Check {
        match values.iter().find(|value| !value.is_finite()) {
            Some(value) => self.refuse(format!("{} must be finite, found {value}", self.name())),
            None => Ok(()),
        }
    }

    fn within(&self, value: f64, least: f64, most: f64) -> Check {
        self.finite(&[value])?;
        if (least..=most).contains(&value) {
            return Ok(());
        }
        self.refuse(format!(
            "{} must be between {} and {}, found {}",
            self.name(),
            format_number(least),
            format_number(most),
            format_number(value)
        ))
    }

    fn positive(&self, value: f64) -> Check {
        self.finite(&[value])?;
        if value > 0.0 && value <= MAX_COORDINATE {
            return Ok(());
        }
        let bound = if value > 0.0 {
            "at most 1e12"
        } else {
            "greater than 0"
        };
        self.refuse(format!(
            "{} must be {bound}, found {}",
            self.name(),
            format_number(value)
        ))
    }

    fn point(&self, value: DVec3) -> Check {
        self.finite(&value.to_array())?;
        if value.abs().max_element() <= MAX_COORDINATE {
            return Ok(());
        }
        self.refuse(format!(
            "{} must lie within 1e12 of the origin, found {}",
            self.name(),
            format_number(value.abs().max_element())
        ))
    }

    fn direction(&self, value: DVec3) -> Check {
        self.point(value)?;
        match value.try_normalize() {
            Some(_) => Ok(()),
            None => self.refuse(format!(
                "{} must have a direction, found (0, 0, 0)",
                self.name()
            )),
        }
    }

    fn color(&self, value: DVec3) -> Check {
        self.finite(&value.to_array())?;
        match value
            .to_array()
            .into_iter()
            .find(|channel| !(0.0..=255.0).contains(channel))
        {
            None => Ok(()),
            Some(channel) => self.refuse(format!(
                "{} must have channels between 0 and 255, found {}",
                self.name(),
                format_number(channel)
            )),
        }
    }
}
