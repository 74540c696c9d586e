//! Settings for rendering a picture.

use serde::{Deserialize, Serialize};

use super::methods::{
    Accelerator, HighlightMethod, Method, Methods, Precision, RayOffset, Sampling, SphereMethod,
    TriangleMethod,
};
use super::notation;

/// Largest picture side, in pixels.
pub const MAX_SIDE: u32 = 16_384;

/// Largest reflection limit of a scene.
pub const MAX_REFLECTIONS: u32 = 64;

/// Settings for rendering a picture. Methods are written to the file only if they differ from the default, which
/// suits every scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Render {
    /// Width in pixels, 1–[`MAX_SIDE`].
    pub width: u32,
    /// Height in pixels, 1–[`MAX_SIDE`].
    pub height: u32,
    /// Largest number of reflections on a path to the eye, 0–[`MAX_REFLECTIONS`].
    pub reflection_limit: u32,
    /// Antialiasing.
    #[serde(
        with = "notation::method",
        skip_serializing_if = "notation::is_default"
    )]
    pub antialias: Sampling,
    /// The floating-point type of the kernels.
    #[serde(
        with = "notation::method",
        skip_serializing_if = "notation::is_default"
    )]
    pub precision: Precision,
    /// Ray–sphere intersection.
    #[serde(
        with = "notation::method",
        skip_serializing_if = "notation::is_default"
    )]
    pub sphere: SphereMethod,
    /// Ray–triangle intersection.
    #[serde(
        with = "notation::method",
        skip_serializing_if = "notation::is_default"
    )]
    pub triangle: TriangleMethod,
    /// Origin of shadow and reflection rays.
    #[serde(
        with = "notation::method",
        skip_serializing_if = "notation::is_default"
    )]
    pub offset: RayOffset,
    /// Computation of the power in a highlight.
    #[serde(
        with = "notation::method",
        skip_serializing_if = "notation::is_default"
    )]
    pub specular: HighlightMethod,
    /// Acceleration structure.
    #[serde(
        with = "notation::method",
        skip_serializing_if = "notation::is_default"
    )]
    pub accelerator: Accelerator,
}

/// A setting that selects one of several methods.
#[derive(Clone, Copy, Debug)]
pub struct Setting {
    /// Name in the file and on the command line.
    pub name: &'static str,
    /// Label in the inspector.
    pub label: &'static str,
    /// What the setting decides, as a phrase.
    pub what: &'static str,
    /// Text shown before a method's id that is not clear by itself.
    pub prefix: &'static str,
}

/// An operation applied to every setting.
pub trait VisitSetting {
    /// Handles one setting; may change `value`.
    fn visit<M: Method>(&mut self, setting: Setting, value: &mut M);
}

/// Selects the method `id` for the setting `name`.
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

/// The method selected by a setting.
#[derive(Clone, Debug)]
pub struct Chosen {
    /// The setting.
    pub setting: Setting,
    /// The method's id, with its parameter if it has one.
    pub id: String,
    /// What the method does, as a phrase.
    pub what: &'static str,
    /// The source of the method: a publication or a program.
    pub source: &'static str,
}

struct AllChosen(Vec<Chosen>);

impl VisitSetting for AllChosen {
    fn visit<M: Method>(&mut self, setting: Setting, value: &mut M) {
        let id = value.id();
        // The parameter does not matter here: `grid:4` and `grid:8` are the same method.
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
    /// Returns the selected methods of all settings.
    pub fn chosen(&self) -> Vec<Chosen> {
        let mut all = AllChosen(Vec::new());
        self.clone().visit_settings(&mut all);
        all.0
    }

    /// Width over height of the picture.
    pub fn aspect_ratio(&self) -> f64 {
        f64::from(self.width) / f64::from(self.height)
    }

    /// Selects a method by the name of its setting and its id. Unknown names and ids are ignored.
    pub fn choose(&mut self, name: &str, id: &str) {
        self.visit_settings(&mut Choose { name, id });
    }

    /// Visits every setting that has several methods. Command-line flags, rows of the inspector and candidates of
    /// the lab are created from this list.
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

    /// The selected formulas.
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
    /// Returns whether sphere hits and the origins of secondary rays are computed robustly.
    pub fn is_sound(&self) -> bool {
        self.sphere == SphereMethod::Stable && self.offset == RayOffset::Robust
    }

    /// Returns whether, in addition, no rays leak between adjacent triangles.
    pub fn is_tight(&self) -> bool {
        self.is_sound() && self.triangle == TriangleMethod::Watertight
    }
}
