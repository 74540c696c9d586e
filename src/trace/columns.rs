//! Vectors that are assembled lane by lane.

use crate::primitive::{CornerNormals, Curved, PackedTriangle};
use crate::simd::{MAX_LANES, Real, SimdFloat, Vec3};

/// The components x, y and z of one vector per lane.
#[derive(Clone, Copy, Debug)]
pub struct Columns<R>([[R; MAX_LANES]; 3]);

impl<R: Real> Columns<R> {
    /// Zero vectors.
    #[inline(always)]
    pub fn new() -> Self {
        Self([[R::ZERO; MAX_LANES]; 3])
    }

    /// Sets the vector of a lane.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, vector: Vec3<R>) {
        for (column, part) in self.0.iter_mut().zip(vector.to_array()) {
            column[lane] = part;
        }
    }

    /// Returns the vectors of all lanes.
    #[inline(always)]
    pub fn load<L: SimdFloat<Real = R>>(&self, token: L::Token) -> Vec3<L> {
        let [x, y, z] = &self.0;
        Vec3::new(L::load(token, x), L::load(token, y), L::load(token, z))
    }
}

/// The data of smoothly shaded faces, one per lane, that their hits need.
pub struct CurvedColumns<R> {
    corners: [Columns<R>; 3],
    normals: [Columns<R>; 3],
    curvature: [R; MAX_LANES],
}

impl<R: Real> CurvedColumns<R> {
    /// All zeros.
    #[inline(always)]
    pub fn new() -> Self {
        Self {
            corners: [Columns::new(); 3],
            normals: [Columns::new(); 3],
            curvature: [R::ZERO; MAX_LANES],
        }
    }

    /// Sets the face of a lane.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, triangle: &PackedTriangle<R>, smooth: &CornerNormals<R>) {
        for index in 0..3 {
            self.corners[index].set(lane, triangle.corners[index]);
            self.normals[index].set(lane, smooth.normals[index]);
        }
        self.curvature[lane] = smooth.curvature;
    }

    /// Returns the faces of all lanes.
    #[inline(always)]
    pub fn load<L: SimdFloat<Real = R>>(&self, token: L::Token) -> Curved<L> {
        let [a, b, c] = &self.corners;
        let [u, v, w] = &self.normals;
        Curved {
            corners: [a.load(token), b.load(token), c.load(token)],
            normals: [u.load(token), v.load(token), w.load(token)],
            curvature: L::load(token, &self.curvature),
        }
    }
}
