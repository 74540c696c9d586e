//! How a picture is traced, where that is not left to the plan: one type for each step that has
//! competing ways, with one line for each way. Command line, scene file, window and lab read the same
//! lists. The default of each is the robust one; others are kept to match old pictures and to show
//! where they fail.

use std::fmt::Debug;

/// There is no method of such an id.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("expected {0}")]
pub struct UnknownMethod(String);

/// A choice between ways of doing one step.
pub trait Method: Copy + PartialEq + Debug + Sized + 'static {
    /// Every way, the default first; those with a number in them with a usual one.
    const ALL: &'static [MethodInfo<Self>];

    /// What the command line and the file call it.
    fn id(self) -> String {
        let method = Self::ALL.iter().find(|method| method.value == self);
        method.map_or(String::new(), |method| method.id.to_owned())
    }

    /// What can be asked for, for people.
    fn syntax() -> String {
        let ids: Vec<&str> = Self::ALL.iter().map(|method| method.id).collect();
        ids.join(", ")
    }

    /// The way of this word.
    ///
    /// # Errors
    /// [`UnknownMethod`], with what can be asked for.
    fn parse(id: &str) -> Result<Self, UnknownMethod> {
        let method = Self::ALL.iter().find(|method| method.id == id);
        let value = method.map(|method| method.value);
        value.ok_or_else(|| UnknownMethod(Self::syntax()))
    }
}

/// A way of doing a step.
#[derive(Clone, Copy, Debug)]
pub struct MethodInfo<T> {
    /// The choice.
    pub value: T,
    /// What the command line and the file call it.
    pub id: &'static str,
    /// What it does.
    pub what: &'static str,
    /// Where it comes from.
    pub source: &'static str,
}

const fn method<T>(
    value: T,
    id: &'static str,
    what: &'static str,
    source: &'static str,
) -> MethodInfo<T> {
    MethodInfo {
        value,
        id,
        what,
        source,
    }
}

const ORIGINAL: &str = "the original program";

/// The real type of the kernel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Precision {
    /// Single, unless the scene needs double, or a sample does.
    #[default]
    Auto,
    /// Single precision.
    Single,
    /// Double precision, the reference.
    Double,
}

impl Method for Precision {
    const ALL: &'static [MethodInfo<Self>] = &[
        method(
            Self::Auto,
            "auto",
            "f32, and f64 for scenes or samples where the difference may be visible",
            "Shewchuk, Adaptive precision floating-point arithmetic, Discrete & Computational Geometry 18, 1997",
        ),
        method(Self::Single, "f32", "single precision", "IEEE 754"),
        method(Self::Double, "f64", "double precision", "IEEE 754"),
    ];
}

/// Ray against sphere.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SphereMethod {
    /// The discriminant from the perpendicular: error grows with distance / radius.
    #[default]
    Stable,
    /// (d·x)² - x·x + R²: error grows with (distance / radius)².
    Classic,
}

impl Method for SphereMethod {
    const ALL: &'static [MethodInfo<Self>] = &[
        method(
            Self::Stable,
            "stable",
            "discriminant from the perpendicular: error grows with distance / radius",
            "Haines, Günther and Akenine-Möller, Ray Tracing Gems, 2019, ch. 7",
        ),
        method(
            Self::Classic,
            "classic",
            "(d·x)² - x·x + R²: error grows with the square of distance / radius",
            ORIGINAL,
        ),
    ];
}

/// Ray against triangle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TriangleMethod {
    /// Neighbours agree on their shared edge: nothing leaks through a mesh.
    #[default]
    Watertight,
    /// The plane's hit, then one cross product per edge: leaks along edges.
    Edges,
    /// Barycentric coordinates by Cramer's rule: leaks along edges.
    MollerTrumbore,
    /// Planes through the origin and each edge: agrees along edges, leaks at corners.
    EdgePlanes,
}

impl Method for TriangleMethod {
    const ALL: &'static [MethodInfo<Self>] = &[
        method(
            Self::Watertight,
            "watertight",
            "shear, then 2D edge functions: no leaks between neighbours",
            "Woop, Benthin and Wald, JCGT 2(1), 2013",
        ),
        method(
            Self::Edges,
            "edges",
            "intersection with the plane, then a cross product per edge: leaks along edges",
            ORIGINAL,
        ),
        method(
            Self::MollerTrumbore,
            "moller-trumbore",
            "barycentric coordinates by Cramer's rule: leaks along edges",
            "Möller and Trumbore, Journal of Graphics Tools 2(1), 1997",
        ),
        method(
            Self::EdgePlanes,
            "edge-planes",
            "planes through the ray's origin and each edge: leaks at corners",
            "Plücker; Davidovič et al., Graphics Interface 2012",
        ),
    ];
}

/// Where shadow and reflection rays start, so that a surface does not shadow itself.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum RayOffset {
    /// At the refined hit, ignoring the own primitive; a few roundings off it if it belongs to a
    /// mesh. Has no length in it and so works at every scale.
    #[default]
    Robust,
    /// This many world units along the new ray.
    Fixed(f64),
    /// This share of the scene's diagonal along the new ray.
    Relative(f64),
    /// 256 roundings of the hit's coordinates along the normal.
    WachterBinder,
}

impl Method for RayOffset {
    const ALL: &'static [MethodInfo<Self>] = &[
        method(
            Self::Robust,
            "robust",
            "at the hit, ignoring the primitive that was hit; on meshes, a few rounding steps away from it",
            "Glint",
        ),
        method(
            Self::Fixed(0.1),
            "fixed:0.1",
            "this many world units along the new ray: suits scenes of one size only",
            ORIGINAL,
        ),
        method(
            Self::Relative(1e-4),
            "relative:0.0001",
            "this fraction of the scene's diagonal along the new ray",
            "common practice",
        ),
        method(
            Self::WachterBinder,
            "wachter-binder",
            "256 rounding steps of the hit's coordinates along the normal",
            "Wächter and Binder, Ray Tracing Gems, 2019, ch. 6",
        ),
    ];

    fn id(self) -> String {
        match self {
            Self::Robust => "robust".to_owned(),
            Self::Fixed(distance) => format!("fixed:{distance}"),
            Self::Relative(share) => format!("relative:{share}"),
            Self::WachterBinder => "wachter-binder".to_owned(),
        }
    }

    fn parse(id: &str) -> Result<Self, UnknownMethod> {
        let length = |number: &str| {
            let number = number.parse::<f64>().ok();
            number.filter(|d| d.is_finite() && *d >= 0.0)
        };
        let found = match id.split_once(':') {
            None if id == "robust" => Some(Self::Robust),
            None if id == "wachter-binder" => Some(Self::WachterBinder),
            Some(("fixed", number)) => length(number).map(Self::Fixed),
            Some(("relative", number)) => length(number).map(Self::Relative),
            _ => None,
        };
        found.ok_or_else(|| UnknownMethod(Self::syntax()))
    }

    fn syntax() -> String {
        "robust, wachter-binder, fixed:DISTANCE with a distance ≥ 0 such as fixed:0.1, or relative:FRACTION of the scene's diagonal such as relative:0.0001".to_owned()
    }
}

/// The power of a highlight.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum HighlightMethod {
    /// The plain power for small exponents, the other form for large ones.
    #[default]
    Auto,
    /// (n·h)^p: error grows with p.
    Power,
    /// exp(p·log1p(-|n - h|²/2)).
    Log1p,
}

impl Method for HighlightMethod {
    const ALL: &'static [MethodInfo<Self>] = &[
        method(
            Self::Auto,
            "auto",
            "pow for exponents up to 256, log1p above",
            "Glint's plan",
        ),
        method(Self::Power, "pow", "(n·h)^p: error grows with p", ORIGINAL),
        method(
            Self::Log1p,
            "log1p",
            "exp(p·log1p(-|n - h|²/2)): keeps the digits that 1 - n·h loses",
            "Glint, after Kahan's log1p",
        ),
    ];
}

/// How what rays can meet is found. All show the same picture, but for a last level on clean edges of dense crowds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Accelerator {
    /// A list, or a tree where there are many.
    #[default]
    Auto,
    /// One by one.
    List,
    /// A tree of boxes.
    Bvh,
}

impl Method for Accelerator {
    const ALL: &'static [MethodInfo<Self>] = &[
        method(
            Self::Auto,
            "auto",
            "a tree for meshes, and for many shapes that fill a volume or share few pixels; otherwise a list",
            "Glint's plan",
        ),
        method(
            Self::List,
            "list",
            "one by one, for each tile; meshes for every ray",
            "Glint",
        ),
        method(
            Self::Bvh,
            "bvh",
            "a tree of boxes, 16 in each, traversed by packets of rays",
            "after Wald, Benthin and Boulos, RT 2008",
        ),
    ];
}

/// Largest number of samples along a side of a pixel.
pub const MAX_GRID: u32 = 256;
/// How often a pixel can be halved, not counting the last time, for the strongest edges.
pub const MAX_HALVINGS: u32 = 3;

/// Where in its pixels a picture is sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sampling {
    /// Once, in the middle: edges are jagged.
    Centres,
    /// So many times so many (at most [`MAX_GRID`]), evenly.
    Grid(u32),
    /// At the corners, and inside where those differ.
    Adaptive {
        /// Difference of the corners, summed over the channels, from which on they differ.
        contrast: f64,
        /// How often a pixel is halved, at most [`MAX_HALVINGS`]; once more at the strongest edges.
        depth: u32,
    },
}

impl Sampling {
    /// The usual adaptive sampling.
    pub const ADAPTIVE: Self = Self::Adaptive {
        contrast: 0.06,
        depth: MAX_HALVINGS,
    };
}

impl Default for Sampling {
    fn default() -> Self {
        Self::ADAPTIVE
    }
}

impl Method for Sampling {
    const ALL: &'static [MethodInfo<Self>] = &[
        method(
            Self::ADAPTIVE,
            "adaptive",
            "at the corners of pixels, and more where these differ",
            "Whitted, CACM 23(6), 1980",
        ),
        method(Self::Centres, "none", "one ray per pixel", ORIGINAL),
        method(
            Self::Grid(4),
            "grid:4",
            "a square of rays in every pixel, this many per side",
            "common practice",
        ),
    ];

    fn id(self) -> String {
        match self {
            Self::Centres => "none".to_owned(),
            Self::Grid(side) => format!("grid:{side}"),
            Self::ADAPTIVE => "adaptive".to_owned(),
            Self::Adaptive { contrast, depth } => format!("adaptive:{contrast}:{depth}"),
        }
    }

    fn parse(id: &str) -> Result<Self, UnknownMethod> {
        let mut parts = id.split(':');
        let found = match (parts.next(), parts.next(), parts.next(), parts.next()) {
            (Some("none"), None, ..) => Some(Self::Centres),
            (Some("adaptive"), None, ..) => Some(Self::ADAPTIVE),
            (Some("grid"), Some(side), None, _) => {
                let side = side.parse().ok();
                side.filter(|side| (1..=MAX_GRID).contains(side))
                    .map(Self::Grid)
            }
            (Some("adaptive"), Some(contrast), Some(depth), None) => {
                let contrast = contrast.parse().ok().filter(|c| (0.0..=3.0).contains(c));
                let depth = depth.parse().ok().filter(|depth| *depth <= MAX_HALVINGS);
                contrast
                    .zip(depth)
                    .map(|(contrast, depth)| Self::Adaptive { contrast, depth })
            }
            _ => None,
        };
        found.ok_or_else(|| UnknownMethod(Self::syntax()))
    }

    fn syntax() -> String {
        format!(
            "none, adaptive, grid:N with N from 1 to {MAX_GRID} such as grid:4, or adaptive:CONTRAST:DEPTH with a contrast from 0 to 3 and a depth from 0 to {MAX_HALVINGS} such as adaptive:0.1:{MAX_HALVINGS}"
        )
    }
}

/// One choice per step that has competing formulas.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Methods {
    /// Ray against sphere.
    pub sphere: SphereMethod,
    /// Ray against triangle.
    pub triangle: TriangleMethod,
    /// Where shadow and reflection rays start.
    pub offset: RayOffset,
    /// The power of a highlight.
    pub highlight: HighlightMethod,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words_are_read_back<T: Method + Default>() {
        assert_eq!(T::ALL[0].value, T::default());
        for method in T::ALL {
            assert_eq!(method.value.id(), method.id);
            assert_eq!(T::parse(method.id), Ok(method.value));
            assert!(!method.what.is_empty() && !method.source.is_empty());
        }
        for wrong in [
            "",
            "nonsense",
            "fixed:-1",
            "fixed:",
            "grid:0",
            "grid:257",
            "adaptive:9:1",
            "adaptive:0.1:4",
            "none:1",
        ] {
            let error = T::parse(wrong).expect_err("nonsense").to_string();
            assert!(error.starts_with("expected "), "{error}");
        }
    }

    #[test]
    fn every_word_is_read_back() {
        words_are_read_back::<Precision>();
        words_are_read_back::<SphereMethod>();
        words_are_read_back::<TriangleMethod>();
        words_are_read_back::<RayOffset>();
        words_are_read_back::<HighlightMethod>();
        words_are_read_back::<Accelerator>();
        words_are_read_back::<Sampling>();
        assert_eq!(
            Sampling::parse("adaptive:0.3:2").map(Sampling::id),
            Ok("adaptive:0.3:2".to_owned())
        );
        assert_eq!(
            RayOffset::parse("relative:0.5").map(RayOffset::id),
            Ok("relative:0.5".to_owned())
        );
    }
}
