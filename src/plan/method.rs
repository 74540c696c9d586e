//! Which of the competing formulas a picture is traced with. The default of each is the robust one;
//! the others are those of the program that Glint grew from, kept to match its pictures and to show
//! where they fail.

/// One choice per step that has competing formulas.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Methods {
    /// Ray against sphere.
    pub sphere: SphereMethod,
    /// Ray against triangle.
    pub triangle: TriangleMethod,
    /// Where shadow and reflection rays start.
    pub offset: RayOffset,
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

/// Ray against triangle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TriangleMethod {
    /// Neighbours agree on their shared edge: nothing leaks through a mesh.
    #[default]
    Watertight,
    /// The plane's hit, then one cross product per edge: leaks along edges.
    Edges,
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
}
