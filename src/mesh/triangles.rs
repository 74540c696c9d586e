//! Points and triangles, and how they are made from the contents of a file.

use std::collections::HashMap;
use std::sync::OnceLock;

use glam::DVec3;

use super::error::Fault;
use super::limits::{check_faces, check_points};

/// Points and triangles. Faces are wound clockwise seen from outside: the readers turn the counter-clockwise faces of
/// files.
#[derive(Clone, Debug, Default)]
pub struct Triangles {
    points: Vec<DVec3>,
    faces: Vec<[u32; 3]>,
    bounds: Option<(DVec3, DVec3)>,
    fingerprint: OnceLock<blake3::Hash>,
}

impl PartialEq for Triangles {
    fn eq(&self, other: &Self) -> bool {
        self.points == other.points && self.faces == other.faces
    }
}

impl Triangles {
    /// Makes triangles of points and faces as they are: faces clockwise seen from outside.
    ///
    /// # Errors
    /// A sentence without its full stop, if there are no faces or too many, if a face refers to a missing point, or
    /// if a coordinate is not finite or out of range.
    pub fn new(points: Vec<DVec3>, faces: Vec<[u32; 3]>) -> Result<Self, String> {
        check_points(points.len()).map_err(|fault| fault.to_string())?;
        check_faces(faces.len()).map_err(|fault| fault.to_string())?;
        if faces.is_empty() {
            return Err("a mesh needs at least one face".to_owned());
        }
        for (number, face) in faces.iter().enumerate() {
            if let Some(wrong) = face.iter().find(|&&point| point as usize >= points.len()) {
                let fault = out_of_range(number, wrong, points.len());
                return Err(fault.to_string());
            }
        }
        match points.iter().position(|&point| !is_in_bounds(point)) {
            Some(wrong) => Err(out_of_bounds(wrong)),
            None => Ok(Self::of(points, faces)),
        }
    }

    pub(super) fn of(points: Vec<DVec3>, faces: Vec<[u32; 3]>) -> Self {
        // Points without a face do not count.
        let corners = faces.as_flattened().iter();
        let boxes = corners.map(|&corner| (points[corner as usize], points[corner as usize]));
        let bounds = boxes.reduce(|(low, high), (point, _)| (low.min(point), high.max(point)));
        Self {
            points,
            faces,
            bounds,
            fingerprint: OnceLock::new(),
        }
    }

    /// A hash of the triangles, computed once.
    pub fn fingerprint(&self) -> &blake3::Hash {
        self.fingerprint.get_or_init(|| {
            let mut hasher = blake3::Hasher::new();
            let mut bytes = Vec::new();
            for points in self.points.chunks(HASH_CHUNK) {
                bytes.clear();
                let parts = points.iter().flat_map(DVec3::to_array);
                bytes.extend(parts.flat_map(f64::to_le_bytes));
                hasher.update(&bytes);
            }
            for faces in self.faces.chunks(HASH_CHUNK) {
                bytes.clear();
                bytes.extend(faces.as_flattened().iter().flat_map(|i| i.to_le_bytes()));
                hasher.update(&bytes);
            }
            hasher.finalize()
        })
    }

    /// The positions of the points.
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// The three point indices of each triangle.
    pub fn faces(&self) -> &[[u32; 3]] {
        &self.faces
    }

    /// Number of bytes that they take in memory.
    pub fn bytes(&self) -> usize {
        size_of_val(self.points()) + size_of_val(self.faces())
    }

    /// Estimated number of bytes that they take as text in a scene file.
    pub fn bytes_of_text(&self) -> u64 {
        // Digits of points are averaged over a sample; those of faces are taken from the largest index.
        let step = self.points.len() / MEASURED_POINTS + 1;
        let digits = |point: &DVec3| format!("{}{}{}", point.x, point.y, point.z).len();
        let sampled = self.points.iter().step_by(step);
        let (count, bytes) = sampled.fold((0, 0), |(count, bytes), point| {
            (count + 1, bytes + digits(point) + SEPARATOR_BYTES)
        });
        let points = self.points.len() as u64 * bytes as u64 / count.max(1);
        let digits = self.points.len().max(1).ilog10() as usize + 1;
        points + (self.faces.len() * (3 * digits + SEPARATOR_BYTES)) as u64
    }

    /// The corners of each triangle.
    pub fn corners(&self) -> impl ExactSizeIterator<Item = [DVec3; 3]> {
        let corners = |face: &[u32; 3]| face.map(|point| self.points[point as usize]);
        self.faces.iter().map(corners)
    }

    /// Smallest and largest corner of the bounding box; `None` if there are no faces.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        self.bounds
    }

    /// Makes a mesh of the triangles of a file, which are wound counter-clockwise: equal points are merged, faces
    /// without an area and exact duplicates are dropped.
    ///
    /// `point` is called for indices below `count` only.
    pub(super) fn weld(
        count: usize,
        point: impl Fn(usize) -> DVec3,
        faces: impl ExactSizeIterator<Item = [u32; 3]>,
    ) -> Result<Self, Fault> {
        check_points(count)?;
        check_faces(faces.len())?;
        let mut welder = Welder {
            points: Vec::new(),
            faces: Vec::new(),
            new_indices: vec![UNKNOWN; count],
            // Grown on demand: an oversized table scatters its entries in memory, which is slow.
            index_of_position: HashMap::new(),
        };
        for (number, corners) in faces.enumerate() {
            let indices = corners.map(|corner| corner as usize);
            if let Some(wrong) = indices.iter().find(|&&index| index >= count) {
                return Err(out_of_range(number + 1, wrong, count));
            }
            let points = indices.map(&point);
            for (index, point) in indices.iter().zip(points) {
                if !is_in_bounds(point) {
                    return Err(Fault::new(out_of_bounds(*index)));
                }
            }
            let [a, b, c] = points;
            if (b - a).cross(c - a) != DVec3::ZERO {
                welder.add(indices, points);
            }
        }
        let Welder {
            points, mut faces, ..
        } = welder;
        drop_duplicates(&mut faces);
        Ok(Self::of(points, faces))
    }

    /// Merges meshes into one; a single one stays as it is.
    pub(super) fn join(parts: Vec<Self>) -> Result<Self, Fault> {
        let parts = match <[_; 1]>::try_from(parts) {
            Ok([only]) => return Ok(only),
            Err(parts) => parts,
        };
        let (mut points, mut faces) = (Vec::new(), Vec::new());
        for part in parts {
            let first = points.len() as u32;
            points.extend_from_slice(&part.points);
            // Counter-clockwise as in a file, because welding turns them.
            faces.extend(
                part.faces
                    .iter()
                    .map(|&[a, c, b]| [a + first, b + first, c + first]),
            );
        }
        Self::weld(points.len(), |index| points[index], faces.into_iter())
    }
}

/// Number of points, roughly, whose digits are counted.
const MEASURED_POINTS: usize = 100;
/// Bytes of brackets, commas and spaces around three numbers in a scene file.
const SEPARATOR_BYTES: usize = 8;
/// Points or faces that are hashed at once.
const HASH_CHUNK: usize = 1024;

/// Largest absolute coordinate or length in a scene, in world units, and largest absolute angle in degrees.
pub const MAX_COORDINATE: f64 = 1e12;

/// Returns whether a point is finite and in range.
pub fn is_in_bounds(point: DVec3) -> bool {
    point.is_finite() && point.abs().max_element() <= MAX_COORDINATE
}

/// The error message for a point that is not, by its number, counted from 0.
fn out_of_bounds(point: usize) -> String {
    format!(
        "point {point}, counted from 0, has a coordinate that is not a finite number within {MAX_COORDINATE:e} of 0"
    )
}

/// The fault of a face that refers to a missing point; both numbers are as they are counted in the file.
pub(super) fn out_of_range(face: usize, point: impl std::fmt::Display, count: usize) -> Fault {
    Fault::new(format!(
        "face {face} names point {point}, but there are only {count}, counted from 0"
    ))
}

/// Returns whether the triangles, given by their corners, form closed surfaces: every edge occurs once in each
/// direction. Points at the same position are the same.
pub fn are_closed(triangles: impl Iterator<Item = [DVec3; 3]>) -> bool {
    let mut edges: HashMap<([u64; 3], [u64; 3]), u32> = HashMap::new();
    for corners in triangles {
        let [a, b, c] = corners.map(position_key);
        for edge in [(a, b), (b, c), (c, a)] {
            *edges.entry(edge).or_default() += 1;
        }
    }
    edges
        .iter()
        .all(|(&(from, to), &count)| count == 1 && edges.contains_key(&(to, from)))
}

/// A hash key for a position: equal positions have equal keys.
pub fn position_key(point: DVec3) -> [u64; 3] {
    // Adding zero turns −0 into 0, which is the same position.
    (point + DVec3::ZERO).to_array().map(f64::to_bits)
}

/// Marks a point that no face has used yet.
const UNKNOWN: u32 = u32::MAX;

/// A mesh that is being welded.
struct Welder {
    points: Vec<DVec3>,
    faces: Vec<[u32; 3]>,
    /// For each point of the file, its index in the mesh.
    new_indices: Vec<u32>,
    index_of_position: HashMap<[u64; 3], u32>,
}

impl Welder {
    fn add(&mut self, indices: [usize; 3], points: [DVec3; 3]) {
        let mut face = [0; 3];
        for ((corner, index), point) in face.iter_mut().zip(indices).zip(points) {
            if self.new_indices[index] == UNKNOWN {
                self.new_indices[index] = self.number_of(point);
            }
            *corner = self.new_indices[index];
        }
        let [a, b, c] = face;
        self.faces.push([a, c, b]);
    }

    fn number_of(&mut self, point: DVec3) -> u32 {
        let next = self.points.len() as u32;
        let number = *self
            .index_of_position
            .entry(position_key(point))
            .or_insert(next);
        if number == next {
            self.points.push(point + DVec3::ZERO);
        }
        number
    }
}

/// Keeps the first of equal faces. Sorting takes half as long as a hash set, whose entries are scattered in memory.
fn drop_duplicates(faces: &mut Vec<[u32; 3]>) {
    let key = |&[a, b, c]: &[u32; 3]| match a.min(b).min(c) {
        // Equal triangles may start at different corners.
        least if least == b => [b, c, a],
        least if least == c => [c, a, b],
        _ => [a, b, c],
    };
    let mut keys: Vec<_> = faces.iter().map(key).zip(0_u32..).collect();
    keys.sort_unstable();
    let pairs = keys.array_windows();
    let mut repeated: Vec<u32> = pairs
        .filter(|[(before, _), (key, _)]| before == key)
        .map(|[_, (_, number)]| *number)
        .collect();
    drop(keys);
    repeated.sort_unstable();
    let mut repeated = repeated.into_iter().peekable();
    let mut number = 0;
    faces.retain(|_| {
        let is_first = repeated.next_if_eq(&number).is_none();
        number += 1;
        is_first
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    fn weld(points: &[DVec3], faces: &[[u32; 3]]) -> Result<Triangles, Fault> {
        Triangles::weld(points.len(), |index| points[index], faces.iter().copied())
    }

    #[test]
    fn faces_are_turned_and_only_good_ones_stay() {
        let points = [DVec3::ONE, DVec3::ZERO, DVec3::X, DVec3::Y, -DVec3::ZERO];
        let faces = [
            [1, 2, 3],
            // The same face, from another corner and with the other zero.
            [3, 4, 2],
            // No area.
            [1, 4, 2],
            [1, 1, 3],
            // The other side is a different face.
            [3, 2, 1],
        ];
        let triangles = weld(&points, &faces).expect("a mesh");
        assert_eq!(triangles.points(), [DVec3::ZERO, DVec3::X, DVec3::Y]);
        assert_eq!(triangles.faces(), [[0, 2, 1], [2, 0, 1]]);
        let again = Triangles::join(vec![triangles.clone(); 2]).expect("a mesh");
        assert_eq!(again, triangles);
    }

    #[test]
    fn a_point_that_no_face_has_is_nowhere() {
        let points = vec![DVec3::ZERO, DVec3::X, DVec3::splat(1e9), DVec3::Y];
        let triangles = Triangles::new(points, vec![[0, 1, 3]]).expect("a mesh");
        let corner = DVec3::new(1.0, 1.0, 0.0);
        assert_eq!(triangles.bounds(), Some((DVec3::ZERO, corner)));
        assert_eq!(triangles.points().len(), 4, "it is kept");
    }

    #[test]
    fn wrong_faces_and_points_are_named() {
        let said = |points: &[DVec3], faces: &[[u32; 3]]| match weld(points, faces) {
            Err(Fault::Refused { why, .. }) => why,
            other => panic!("{other:?}"),
        };
        let points = [DVec3::ZERO, DVec3::X, DVec3::NAN];
        assert_eq!(
            said(&points, &[[0, 1, 9]]),
            "face 1 names point 9, but there are only 3, counted from 0"
        );
        assert_eq!(
            said(&points, &[[0, 1, 2]]),
            "point 2, counted from 0, has a coordinate that is not a finite number within 1e12 of 0"
        );
    }
}
