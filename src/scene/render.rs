//! How a picture is made.

use serde::{Deserialize, Serialize};

use super::methods::{
    Accelerator, HighlightMethod, Method, Methods, Precision, RayOffset, Sampling, SphereMethod,
    TriangleMethod,
};
use super::notation;

/// Largest picture side, in pixels.
pub const MAX_SIDE: u32 = 16_384;

/// Deepest chain of reflections that a scene may ask for.
pub const MAX_REFLECTIONS: u32 = 64;

/// How the picture is made. What it is traced with is written to the file only where it differs from
/// the default, which is what the scene needs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Render {
    /// Width in pixels, 1–[`MAX_SIDE`].
    pub width: u32,
    /// Height in pixels, 1–[`MAX_SIDE`].
    pub height: u32,
    /// How often light may be mirrored on its way to the eye, 0–[`MAX_REFLECTIONS`].
    pub reflection_limit: u32,
    /// How edges are smoothed.
    #[serde(
        with = "notation::method",
        skip_serializing_if = "notation::is_default"
    )]
    pub antialias: Sampling,
    /// The real type of the kernel.
    #[serde(
        with = "notation::method",
        skip_serializing_if = "notation::is_default"
    )]
    pub precision: Precision,
    /// Ray against sphere.
    #[serde(
        with = "notation::method",
        skip_serializing_if = "notation::is_default"
    )]
    pub sphere: SphereMethod,
    /// Ray against triangle.
    #[serde(
        with = "notation::method",
        skip_serializing_if = "notation::is_default"
    )]
    pub triangle: TriangleMethod,
    /// Where shadow and reflection rays start.
    #[serde(
        with = "notation::method",
        skip_serializing_if = "notation::is_default"
    )]
    pub offset: RayOffset,
    /// The power of a highlight.
    #[serde(
        with = "notation::method",
        skip_serializing_if = "notation::is_default"
    )]
    pub specular: HighlightMethod,
    /// How primitives are found.
    #[serde(
        with = "notation::method",
        skip_serializing_if = "notation::is_default"
    )]
    pub accelerator: Accelerator,
}

/// A setting that has competing methods.
#[derive(Clone, Copy, Debug)]
pub struct Setting {
    /// What the file and the command line call it.
    pub name: &'static str,
    /// What the inspector calls it.
    pub label: &'static str,
    /// What it decides, in a phrase.
    pub what: &'static str,
    /// What comes before a method's id where the id alone says too little.
    pub prefix: &'static str,
}

/// Something done with every setting.
pub trait VisitSetting {
    /// Does it with one; `value` may be changed.
    fn visit<M: Method>(&mut self, setting: Setting, value: &mut M);
}

/// Chooses the method of this id for the setting of this name.
struct Choose<'a> {
    name: &'a str,
    id: &'a str,
}

impl VisitSetting for Choose<'_> {
    fn visit<M: Method>(&mut self, setting: Setting, value: &mut M) {
        if setting.name == self.name
            && let Ok(method) = M::parse(self.id)
        {
            *value = method;
        }
    }
}

/// A method that a setting stands at.
#[derive(Clone, Debug)]
pub struct Chosen {
    /// The setting.
    pub setting: Setting,
    /// The method's id, with its number if it has one.
    pub id: String,
    /// What the method does, in a phrase.
    pub what: &'static str,
    /// Whose it is.
    pub source: &'static str,
}

struct AllChosen(Vec<Chosen>);

impl VisitSetting for AllChosen {
    fn visit<M: Method>(&mut self, setting: Setting, value: &mut M) {
        let id = value.id();
        // Numbers differ, and the method is the same: `grid:4` and `grid:8`.
        let name = |id: &str| id.split(':').next().map(str::to_owned);
        let mut methods = M::ALL.iter();
        let method = methods.find(|method| name(method.id) == name(&id));
        self.0.push(Chosen {
            setting,
            what: method.map_or("", |method| method.what),
            source: method.map_or("", |method| method.source),
            id,
        });
    }
}

impl Render {
    /// What all settings stand at.
    pub fn chosen(&self) -> Vec<Chosen> {
        let mut all = AllChosen(Vec::new());
        self.clone().visit_settings(&mut all);
        all.0
    }

    /// Width over height of the picture.
    pub fn aspect_ratio(&self) -> f64 {
        f64::from(self.width) / f64::from(self.height)
    }

    /// Chooses a method by the name of its setting and its id; without such ones, nothing changes.
    pub fn choose(&mut self, name: &str, id: &str) {
        self.visit_settings(&mut Choose { name, id });
    }

    /// Shows every setting that has competing methods: flags, rows of the inspector and the lab's
    /// candidates are made from this list.
    pub fn visit_settings(&mut self, visitor: &mut impl VisitSetting) {
        let setting = |name, label, what, prefix| Setting {
            name,
            label,
            what,
            prefix,
        };
        visitor.visit(
            setting("antialias", "edges", "Antialiasing of edges", ""),
            &mut self.antialias,
        );
        visitor.visit(
            setting(
                "precision",
                "precision",
                "Floating-point precision of the tracer",
                "",
            ),
            &mut self.precision,
        );
        visitor.visit(
            setting(
                "sphere",
                "sphere",
                "Intersection of rays and spheres",
                "sphere ",
            ),
            &mut self.sphere,
        );
        visitor.visit(
            setting(
                "triangle",
                "triangle",
                "Intersection of rays and triangles",
                "",
            ),
            &mut self.triangle,
        );
        visitor.visit(
            setting(
                "offset",
                "offset",
                "Where shadow and reflection rays start",
                "offset ",
            ),
            &mut self.offset,
        );
        visitor.visit(
            setting(
                "specular",
                "specular",
                "How the power in highlights is computed",
                "highlight ",
            ),
            &mut self.specular,
        );
        visitor.visit(
            setting("accelerator", "accelerator", "How rays find primitives", ""),
            &mut self.accelerator,
        );
    }

    /// The formulas.
    pub fn methods(&self) -> Methods {
        Methods {
            sphere: self.sphere,
            triangle: self.triangle,
            offset: self.offset,
            highlight: self.specular,
        }
    }
}

impl Default for Render {
    fn default() -> Self {
        Self {
            width: 1024,
            height: 1024,
            reflection_limit: 1,
            antialias: Sampling::default(),
            precision: Precision::default(),
            sphere: SphereMethod::default(),
            triangle: TriangleMethod::default(),
            offset: RayOffset::default(),
            specular: HighlightMethod::default(),
            accelerator: Accelerator::default(),
        }
    }
}

impl Methods {
    /// Whether spheres are hit where they are, and new rays start where they should.
    pub fn is_sound(&self) -> bool {
        self.sphere == SphereMethod::Stable && self.offset == RayOffset::Robust
    }

    /// Whether, besides, nothing leaks between triangles.
    pub fn is_tight(&self) -> bool {
        self.is_sound() && self.triangle == TriangleMethod::Watertight
    }
}
