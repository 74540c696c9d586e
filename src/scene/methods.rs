//! Choice of methods for tracing a picture, where it is not left to the planner: one type per step that has several
//! methods, one entry per method. Command line, scene file, user interface and lab use the same lists. The default
//! of each step is the robust method; the others are kept to reproduce old pictures and to show where they fail.

use std::fmt::Debug;

/// An unknown method id; holds the accepted ones.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("expected {0}")]
pub struct UnknownMethod(String);

/// A choice of method for one step.
pub trait Method: Copy + PartialEq + Debug + Sized + 'static {
    /// All methods, the default first; those with a parameter have a typical value.
    const ALL: &'static [MethodInfo<Self>];

    /// The id in the command line and the file.
    fn id(self) -> String {
        let method = Self::ALL.iter().find(|method| method.value == self);
        method.map_or(String::new(), |method| method.id.to_owned())
    }

    /// Describes the accepted ids to users.
    fn syntax() -> String {
        let ids: Vec<&str> = Self::ALL.iter().map(|method| method.id).collect();
        ids.join(", ")
    }

    /// Finds the method with this id.
    ///
    /// # Errors
    /// [`UnknownMethod`], which describes the accepted ids.
    fn parse(id: &str) -> Result<Self, UnknownMethod> {
        let method = Self::ALL.iter().find(|method| method.id == id);
        let value = method.map(|method| method.value);
        value.ok_or_else(|| UnknownMethod(Self::syntax()))
    }
}

/// A method with its description.
#[derive(Clone, Copy, Debug)]
pub struct MethodInfo<T> {
    /// The method.
    pub value: T,
    /// The id in the command line and the file.
    pub id: &'static str,
    /// A short explanation.
    pub what: &'static str,
    /// The source of the method: a publication or a program.
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

/// The floating-point type of the kernels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Precision {
    /// Single precision, unless the scene or a sample needs double.
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

/// Ray–sphere intersection.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SphereMethod {
    /// Discriminant from the perpendicular: the error grows with distance / radius.
    #[default]
    Stable,
    /// (d·x)² - x·x + R²: the error grows with (distance / radius)².
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

/// Ray–triangle intersection.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TriangleMethod {
    /// Adjacent triangles agree on their shared edge: nothing leaks through a mesh.
    #[default]
    Watertight,
    /// Plane hit, then one cross product per edge: leaks along edges.
    Edges,
    /// Barycentric coordinates by Cramer's rule: leaks along edges.
    MollerTrumbore,
    /// Planes through the ray's origin and each edge: consistent along edges, leaks at corners.
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

/// Origin of shadow and reflection rays, chosen so that a surface does not shadow itself.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum RayOffset {
    /// At the refined hit, ignoring its own primitive; for meshes, offset by a few rounding errors. Contains no
    /// absolute length, so it works at every scale.
    #[default]
    Robust,
    /// This many world units along the new ray.
    Fixed(f64),
    /// This share of the scene's diagonal along the new ray.
    Relative(f64),
    /// Along the normal by 256 units in the last place of the hit's coordinates.
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

/// Computation of the power in a highlight.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum HighlightMethod {
    /// [`Self::Power`] for small exponents, [`Self::Log1p`] for large ones.
    #[default]
    Auto,
    /// (n·h)^p: the error grows with p.
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

/// Acceleration structure. All give the same picture, up to one level of 255 on smooth edges in dense crowds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Accelerator {
    /// A BVH for meshes and many shapes, otherwise a list.
    #[default]
    Auto,
    /// Each primitive in turn.
    List,
    /// A bounding volume hierarchy.
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

/// Largest number of samples along one side of a pixel.
pub const MAX_GRID: u32 = 256;
/// Largest number of times a pixel is halved, not counting one more halving at the strongest edges.
pub const MAX_HALVINGS: u32 = 3;

/// Positions of the samples in a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sampling {
    /// One sample in the centre of the pixel: edges are jagged.
    Centres,
    /// A regular grid with this many samples per side, at most [`MAX_GRID`].
    Grid(u32),
    /// Samples at the corners of the pixel, and inside where the corners differ.
    Adaptive {
        /// Difference of the corners, summed over the channels, above which they count as different.
        contrast: f64,
        /// How often a pixel is halved, at most [`MAX_HALVINGS`]; once more at the strongest edges.
        depth: u32,
    },
}

impl Sampling {
    /// The default adaptive sampling.
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

/// One choice for each step that has several formulas.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Methods {
    /// Ray–sphere intersection.
    pub sphere: SphereMethod,
    /// Ray–triangle intersection.
    pub triangle: TriangleMethod,
    /// Origin of shadow and reflection rays.
    pub offset: RayOffset,
    /// Computation of the power in a highlight.
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
