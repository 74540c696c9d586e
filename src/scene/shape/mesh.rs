//! Triangle meshes, either written in the scene file or in a file of their own.

use std::path::Path;
use std::sync::Arc;

use glam::{BVec3, DAffine3, DMat3, DQuat, DVec3};
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::angles::{orientation_of, turned_about};
use super::describe::{Describe, Property, PropertyValue};
use super::mesh_source::{MeshFiles, MeshSource};
use super::plane_piece::PlanePiece;
use crate::mesh::{MAX_COORDINATE, Triangles, icosphere, is_in_bounds};
use crate::scene::notation;

/// A triangle mesh, which is moved, turned and scaled as a whole.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// The triangles in local coordinates: before scale, rotation and position are applied.
    pub source: MeshSource,
    /// Position of the local origin in world units.
    pub position: DVec3,
    /// Rotation in degrees about x, then y, then z.
    pub rotation: DVec3,
    /// Scale factors along x, y and z, applied before the rotation; none is 0.
    pub scale: DVec3,
    /// Angle in degrees between faces below which they are shaded as one curved surface, at most 180; 0 for flat
    /// shading.
    pub smooth: f64,
}

/// The serialized form of a mesh.
#[derive(Serialize, Deserialize)]
#[serde(rename = "Mesh", deny_unknown_fields)]
struct SerializedMesh {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    file: Option<String>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    points: Vec<Point>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    faces: Vec<[u32; 3]>,
    #[serde(
        default,
        with = "notation::vector",
        skip_serializing_if = "notation::is_default"
    )]
    position: DVec3,
    #[serde(
        default,
        with = "notation::vector",
        skip_serializing_if = "notation::is_default"
    )]
    rotation: DVec3,
    #[serde(
        default = "unscaled",
        serialize_with = "serialize_scale",
        deserialize_with = "notation::vector::one_or_three",
        skip_serializing_if = "is_unscaled"
    )]
    scale: DVec3,
    #[serde(
        default,
        with = "notation::number",
        skip_serializing_if = "notation::is_default"
    )]
    smooth: f64,
}

/// The serialized form of a mesh point.
#[derive(Serialize)]
#[serde(transparent)]
struct Point(#[serde(with = "notation::vector")] DVec3);

impl<'de> Deserialize<'de> for Point {
    /// Checks the coordinates here, where the parser knows the line.
    fn deserialize<D: Deserializer<'de>>(file: D) -> Result<Self, D::Error> {
        let point = notation::vector::deserialize(file)?;
        if is_in_bounds(point) {
            return Ok(Self(point));
        }
        Err(D::Error::custom(format!(
            "a point of a mesh has a coordinate that is not a finite number within {MAX_COORDINATE:e} of 0"
        )))
    }
}

fn unscaled() -> DVec3 {
    DVec3::ONE
}

fn is_unscaled(scale: &DVec3) -> bool {
    *scale == unscaled()
}

/// Writes scale factors, as a single number if all three are equal.
fn serialize_scale<S: Serializer>(scale: &DVec3, file: S) -> Result<S::Ok, S::Error> {
    let [x, y, z] = scale.to_array();
    if x == y && y == z {
        notation::number::serialize(&x, file)
    } else {
        notation::vector::serialize(scale, file)
    }
}

impl Serialize for Mesh {
    fn serialize<S: Serializer>(&self, file: S) -> Result<S::Ok, S::Error> {
        let (path, points, faces) = match &self.source {
            MeshSource::Inline(triangles) => (
                None,
                triangles.points().iter().copied().map(Point).collect(),
                triangles.faces().to_vec(),
            ),
            MeshSource::File { path, .. } => (Some(path.clone()), Vec::new(), Vec::new()),
        };
        let text = SerializedMesh {
            file: path,
            points,
            faces,
            position: self.position,
            rotation: self.rotation,
            scale: self.scale,
            smooth: self.smooth,
        };
        text.serialize(file)
    }
}

impl<'de> Deserialize<'de> for Mesh {
    fn deserialize<D: Deserializer<'de>>(file: D) -> Result<Self, D::Error> {
        let text = SerializedMesh::deserialize(file)?;
        let source = match text.file {
            Some(_) if !text.points.is_empty() || !text.faces.is_empty() => {
                return Err(D::Error::custom(
                    "a mesh has either a file or points and faces; this one has both",
                ));
            }
            Some(path) => MeshSource::unread(path),
            None => {
                let points = text.points.into_iter().map(|Point(point)| point).collect();
                let triangles = Triangles::new(points, text.faces);
                MeshSource::Inline(Arc::new(triangles.map_err(D::Error::custom)?))
            }
        };
        Ok(Self {
            source,
            position: text.position,
            rotation: text.rotation,
            scale: text.scale,
            smooth: text.smooth,
        })
    }
}

impl Mesh {
    /// Creates a mesh whose local coordinates are world coordinates, inline in the scene.
    pub fn of(triangles: Triangles) -> Self {
        Self {
            source: MeshSource::Inline(Arc::new(triangles)),
            position: DVec3::ZERO,
            rotation: DVec3::ZERO,
            scale: DVec3::ONE,
            smooth: 0.0,
        }
    }

    /// Returns the same geometry with `position` at the middle of its triangles, so that it is turned about it. The
    /// mesh must be neither turned nor scaled.
    #[must_use]
    pub fn centred(self) -> Self {
        let triangles = self.source.triangles();
        let Some((low, high)) = triangles.bounds() else {
            return self;
        };
        // Shifting by whole numbers leaves the digits of the coordinates unchanged. For small meshes these are too
        // coarse, and binary fractions change the coordinates least.
        let size = (high - low).max_element();
        let step = (size / 8.0).log2().floor().exp2().min(1.0);
        let step = if step > 0.0 { step } else { 1.0 };
        let middle = (low.midpoint(high) / step).round() * step;
        let points = triangles.points().iter().map(|&point| point - middle);
        match Triangles::new(points.collect(), triangles.faces().to_vec()) {
            Ok(moved) => Self {
                position: self.position + middle,
                smooth: self.smooth,
                ..Self::of(moved)
            },
            Err(_) => self,
        }
    }

    /// Reads the triangles of the mesh file, if the mesh refers to one, see [`MeshSource::load`]. On failure, the
    /// problem is stored with the reference and the mesh is empty.
    pub fn load(&mut self, folder: Option<&Path>, files: &mut MeshFiles) {
        self.source.load(folder, files);
        self.refuse_if_too_far();
    }

    /// The mesh with the triangles of its file as they were read again, refused as by [`Self::load`].
    #[must_use]
    pub fn with_read(&self, source: MeshSource) -> Self {
        let mut new = Self {
            source,
            ..self.clone()
        };
        new.refuse_if_too_far();
        new
    }

    /// Replaces the triangles of the mesh file by the reason why they are refused, if they lie too far from the
    /// origin: the extent is known only once the file is read.
    fn refuse_if_too_far(&mut self) {
        if let MeshSource::File { path, .. } = &self.source
            && let Some(sentence) = self.problem()
        {
            let problem = format!("{path}: {sentence}");
            self.source.set_read(Err(problem));
        }
    }

    /// The linear part of [`Self::transform`]: scale, then rotation.
    pub fn linear_transform(&self) -> DMat3 {
        let [x, y, z] = self.rotation.to_array().map(f64::to_radians);
        DMat3::from_rotation_z(z)
            * DMat3::from_rotation_y(y)
            * DMat3::from_rotation_x(x)
            * DMat3::from_diagonal(self.scale)
    }

    /// The rotation as a quaternion.
    pub fn orientation(&self) -> DQuat {
        orientation_of(self.rotation)
    }

    /// Returns the mesh turned about a point, by an angle in degrees about a unit axis. Its rotation angles keep
    /// count of full turns.
    #[must_use]
    pub fn turned_by(&self, about: DVec3, (axis, degrees): (DVec3, f64)) -> Self {
        let by = DQuat::from_axis_angle(axis, degrees.to_radians());
        Self {
            rotation: turned_about(self.rotation, axis, degrees),
            ..self.turned(about, by)
        }
    }

    /// The transform from local to world coordinates.
    pub fn transform(&self) -> DAffine3 {
        DAffine3 {
            matrix3: self.linear_transform(),
            translation: self.position,
        }
    }

    /// Returns the corners of each face in world coordinates.
    pub fn world_corners(&self) -> impl Iterator<Item = [DVec3; 3]> {
        let transform = self.transform();
        let corners = self.source.triangles().corners();
        corners.map(move |corners| corners.map(|corner| transform.transform_point3(corner)))
    }

    /// Returns the faces in world coordinates, without those that have no area.
    pub fn pieces(&self) -> impl Iterator<Item = PlanePiece> {
        self.world_corners().filter_map(PlanePiece::between)
    }
}

impl Describe for Mesh {
    const KIND: &'static str = "Mesh";

    fn example(at: DVec3, size: f64) -> Self {
        Self {
            position: at,
            ..Self::of(icosphere(size / 2.0))
        }
    }

    fn fields<'a>(&'a mut self, visit: &mut dyn FnMut(Property<'a>)) {
        visit(Property {
            name: "position",
            hint: "Position of the origin of the mesh, in world units",
            value: PropertyValue::Point(&mut self.position),
        });
        visit(Property {
            name: "rotation",
            hint: "Degrees about x, then y, then z",
            value: PropertyValue::Angles(&mut self.rotation),
        });
        visit(Property {
            name: "scale",
            hint: "Factors along x, y and z, applied before the rotation; not 0",
            value: PropertyValue::Factors(&mut self.scale),
        });
        visit(Property {
            name: "smooth",
            hint: "Faces that meet at less than this angle, in degrees, are shaded as one curved surface; 0 shows them flat",
            value: PropertyValue::Angle(&mut self.smooth),
        });
    }

    fn problem(&self) -> Option<String> {
        let (low, high) = self.bounds()?;
        let farthest = low.abs().max(high.abs()).max_element();
        (farthest > MAX_COORDINATE)
            .then(|| format!("the mesh must lie within {MAX_COORDINATE:e} of the origin"))
    }

    /// Returns the bounds of the transformed local bounding box, which may be larger than those of the triangles.
    fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let (low, high) = self.source.triangles().bounds()?;
        let transform = self.transform();
        let corners = (0..8).map(|corner| {
            let is_high = BVec3::from([0, 1, 2].map(|axis| corner >> axis & 1 == 1));
            let corner = transform.transform_point3(DVec3::select(is_high, high, low));
            (corner, corner)
        });
        corners.reduce(|(low, high), (corner, _)| (low.min(corner), high.max(corner)))
    }

    fn position(&self) -> DVec3 {
        self.position
    }

    /// Describes the mesh as a whole: the size of single triangles does not matter, since their neighbours are
    /// displaced along with them.
    fn feature(&self) -> Option<(DVec3, f64)> {
        let (low, high) = self.bounds()?;
        Some((low.midpoint(high), (high - low).length()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_scaled_then_turned_about_x_y_and_z_then_moved() {
        let mesh = Mesh {
            position: DVec3::new(0.0, 0.0, 7.0),
            rotation: DVec3::new(90.0, 90.0, 0.0),
            scale: DVec3::new(1.0, 2.0, 3.0),
            ..Mesh::example(DVec3::ZERO, 1.0)
        };
        // The y axis becomes twice as long, then turns to z about x, then to x about y.
        let turned = mesh.transform().transform_point3(DVec3::Y);
        assert!(
            (turned - DVec3::new(2.0, 0.0, 7.0)).length() < 1e-12,
            "{turned}"
        );
        let (low, high) = mesh.bounds().expect("it has an end");
        assert!(low.x < -0.9 && high.x > 0.9 && low.z > 6.0 && high.z < 8.0);
    }

    #[test]
    fn turned_twice_it_is_where_its_points_were_turned_to() {
        let mut mesh = Mesh {
            position: DVec3::new(3.0, -2.0, 7.0),
            rotation: DVec3::new(20.0, -70.0, 130.0),
            scale: DVec3::new(1.0, 2.0, 3.0),
            ..Mesh::example(DVec3::ZERO, 1.0)
        };
        let (about, corner) = (DVec3::new(1.0, 1.0, 1.0), DVec3::new(0.3, 0.2, -0.4));
        let mut expected = mesh.transform().transform_point3(corner);
        for axis in [DVec3::X, DVec3::new(0.6, 0.0, -0.8)] {
            let by = DQuat::from_axis_angle(axis, 1.3);
            expected = about + by * (expected - about);
            mesh = mesh.turned(about, by);
        }
        let found = mesh.transform().transform_point3(corner);
        assert!((found - expected).length() < 1e-12, "{found} {expected}");
    }

    /// Returns a mesh whose file is not read yet.
    fn of_file(path: &str) -> Mesh {
        Mesh {
            source: MeshSource::unread(path.to_owned()),
            ..Mesh::example(DVec3::ZERO, 1.0)
        }
    }

    #[test]
    fn nothing_outside_the_folder_is_read() {
        for path in ["/etc/passwd", "../up.ply", "a/../../b.ply"] {
            let mut mesh = of_file(path);
            mesh.load(Some(Path::new("/tmp")), &mut MeshFiles::new());
            let MeshSource::File { problem, .. } = mesh.source else {
                panic!("still a file");
            };
            assert!(problem.is_some_and(|said| said.contains("must be in the folder")));
        }
    }

    #[test]
    fn a_file_that_reaches_too_far_is_not_in_the_scene() {
        let folder = tempfile::tempdir().expect("a folder");
        let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
        std::fs::write(folder.path().join("a.obj"), text).expect("written");
        for (x, is_there) in [(3.0, true), (1e12, false)] {
            let mut mesh = of_file("a.obj").moved(DVec3::X * x);
            mesh.load(Some(folder.path()), &mut MeshFiles::new());
            assert_eq!(mesh.source.problem().is_none(), is_there);
            assert_eq!(mesh.source.triangles().faces().len(), usize::from(is_there));
        }
    }

    #[test]
    fn a_turn_about_one_axis_is_shown_as_one() {
        for axis in DVec3::AXES {
            let mut mesh = Mesh::example(DVec3::ZERO, 1.0);
            for step in 1..=60 {
                mesh = mesh.turned(
                    DVec3::ZERO,
                    DQuat::from_axis_angle(axis, 7_f64.to_radians()),
                );
                let expected = axis * 7.0 * f64::from(step);
                assert!(
                    (mesh.rotation - expected).length() < 1e-6,
                    "{} for {expected}",
                    mesh.rotation
                );
            }
        }
    }
}
