//! The corners of a triangle, by name.

/// One of the corners of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Vertex {
    /// The first one.
    A,
    /// The second one.
    B,
    /// The third one.
    C,
}

impl Vertex {
    /// All vertices, in order.
    pub const ALL: [Self; 3] = [Self::A, Self::B, Self::C];

    /// The same corner after B and C have changed places.
    #[must_use]
    pub fn flipped(self) -> Self {
        match self {
            Self::A => Self::A,
            Self::B => Self::C,
            Self::C => Self::B,
        }
    }
}
