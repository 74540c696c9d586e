//! Joining triangles and meshes into one mesh, and separating a mesh into triangles.

use std::collections::{HashMap, HashSet};
use std::ops::Range;

use glam::DVec3;

use super::animation::{Owner, Target, Track};
use super::list::List;
use super::names::Names;
use super::object::Object;
use super::shape::{Mesh, Shape, Triangle};
use super::whole::Scene;
use crate::mesh::{Triangles, position_key};

/// Largest number of faces of a mesh that can be separated: each becomes an object with a name.
pub const MAX_SEPARATED: usize = 10_000;

impl Mesh {
    /// Returns whether the mesh has triangles, and few enough to be separated.
    pub fn is_separable(&self) -> bool {
        (1..=MAX_SEPARATED).contains(&self.source.triangles().faces().len())
    }
}

impl Scene {
    /// Returns the indices of all triangles connected to the one at `index` by shared corners, itself included;
    /// empty if that object is not a triangle.
    pub fn connected_triangles(&self, index: usize) -> Vec<usize> {
        let corners = |object: &Object| match &object.shape {
            Shape::Triangle(triangle) => Some(triangle.corners().map(position_key)),
            _ => None,
        };
        let mut users: HashMap<[u64; 3], Vec<usize>> = HashMap::new();
        for (user, object) in self.objects.iter().enumerate() {
            for corner in corners(object).into_iter().flatten() {
                users.entry(corner).or_default().push(user);
            }
        }
        let visibility = |object: usize| self.objects.get(object).map(|object| object.visible);
        let mut found = vec![false; self.objects.len()];
        let mut waiting = vec![index];
        while let Some(object) = waiting.pop() {
            let Some(own) = self.objects.get(object).and_then(corners) else {
                continue;
            };
            if std::mem::replace(&mut found[object], true) {
                continue;
            }
            // Each corner is followed only once.
            waiting.extend(
                own.iter()
                    .filter_map(|corner| users.remove(corner))
                    .flatten()
                    // Hidden triangles are not connected to visible ones.
                    .filter(|&other| visibility(other) == visibility(index)),
            );
        }
        (0..found.len()).filter(|&object| found[object]).collect()
    }

    /// Replaces the triangles and meshes at these indices (ascending) by one mesh with the name and the color pack
    /// of the first. Returns the index of the mesh, or `None` if any other shape is among them, or a mesh whose file
    /// could not be read.
    pub fn join(&mut self, joined: &[usize]) -> Option<usize> {
        let first = *joined.first()?;
        let (mut numbers, mut points) = (HashMap::new(), Vec::new());
        let mut number = |point: DVec3| {
            *numbers.entry(position_key(point)).or_insert_with(|| {
                points.push(point);
                points.len() as u32 - 1
            })
        };
        let (mut faces, mut smooth) = (Vec::new(), 0.0_f64);
        for &index in joined {
            match &self.objects.get(index)?.shape {
                Shape::Triangle(triangle) => faces.push(triangle.corners().map(&mut number)),
                Shape::Mesh(mesh) if mesh.source.problem().is_some() => return None,
                Shape::Mesh(mesh) => {
                    smooth = smooth.max(mesh.smooth);
                    let corners = outer_corners(mesh);
                    faces.extend(corners.map(|corners| corners.map(&mut number)));
                }
                _ => return None,
            }
        }
        let mesh = Mesh {
            smooth,
            ..Mesh::of(Triangles::new(points, faces).ok()?).centred()
        };
        let before = self.objects.clone();
        let own: Vec<&Object> = joined.iter().map(|&index| &before[index]).collect();
        let is_in_group = |object: &&Object| object.group == own[0].group;
        let members = before.iter().filter(is_in_group).count();
        let position = mesh.position;
        let mut joint = Object {
            shape: mesh.into(),
            visible: own.iter().any(|object| object.visible),
            ..own[0].clone()
        };
        // If all members of the group are joined, the mesh is in no group.
        if own.iter().copied().filter(is_in_group).count() == members {
            joint.group.clear();
        }
        let removed: HashSet<usize> = joined[1..].iter().copied().collect();
        let kept = before.iter().enumerate();
        let kept = kept.filter(|(index, _)| !removed.contains(index));
        self.objects = kept.map(|(_, object)| object.clone()).collect();
        self.objects[first] = joint;
        self.keep_tracks_of(own[0], position, own[1..].iter().copied());
        Some(first)
    }

    /// Keeps the position tracks of `object` for the mesh at `position` that took over its name, shifted
    /// accordingly. Removes its rotation tracks, and all tracks of the objects in `removed`.
    fn keep_tracks_of<'a>(
        &mut self,
        object: &Object,
        position: DVec3,
        removed: impl Iterator<Item = &'a Object>,
    ) {
        if self.animation.tracks.is_empty() {
            return;
        }
        let animation = self.animation_mut();
        animation.forget(&removed.map(|object| Owner::Object(&object.name)).collect());
        let turns = Target::ObjectRotation(object.name.clone());
        animation.tracks.retain(|track| track.target != turns);
        let moves = Target::ObjectPosition(object.name.clone());
        let offset = position - object.shape.position();
        let tracks = animation.tracks.iter_mut();
        tracks
            .filter(|track| track.target == moves)
            .for_each(|track| track.shift(offset));
    }

    /// Replaces the mesh at `index`, if it is separable, by its triangles; if it is in no group, they form one
    /// named after it. Returns their indices.
    pub fn separate(&mut self, index: usize) -> Range<usize> {
        let object = self.objects.get(index);
        let Some((object, Shape::Mesh(mesh))) = object.map(|object| (object, &object.shape)) else {
            return 0..0;
        };
        if !mesh.is_separable() {
            return 0..0;
        }
        let is_single = mesh.source.triangles().faces().len() == 1;
        let group = if object.group.is_empty() && !is_single {
            let groups = self.objects.iter().map(|object| object.group.as_str());
            Names::new(groups).take(&object.name)
        } else {
            object.group.clone()
        };
        let name = object.name.clone();
        let others = self
            .objects
            .iter()
            .filter(|other| other.name != object.name);
        let mut names = Names::new(others.map(|other| other.name.as_str()));
        // Faces without area are invisible and would be invalid triangles: they are left out.
        let triangles = outer_corners(mesh).map(|[a, b, c]| Shape::from(Triangle { a, b, c }));
        let pieces: Vec<Object> = triangles
            .filter(|triangle| triangle.problem().is_none())
            .map(|triangle| Object {
                name: names.take(&object.name),
                shape: triangle,
                group: group.clone(),
                ..object.clone()
            })
            .collect();
        if pieces.is_empty() {
            return 0..0;
        }
        let new_indices = index..index + pieces.len();
        let before = self.objects.iter().take(index).cloned();
        let after = self.objects.iter().skip(index + 1).cloned();
        self.objects = before.chain(pieces).chain(after).collect::<List<_>>();
        // Tracks of the mesh would move only the triangle that inherits its name.
        let own = Owner::Object(&name);
        let is_moved = |track: &Track| track.target.owner() == Some(own);
        if self.animation.tracks.iter().any(is_moved) {
            self.animation_mut().forget(&HashSet::from([own]));
        }
        new_indices
    }
}

/// Returns the corners of each face in world space, clockwise seen from outside.
fn outer_corners(mesh: &Mesh) -> impl Iterator<Item = [DVec3; 3]> {
    let is_mirrored = mesh.linear_transform().determinant() < 0.0;
    let outward = move |[a, b, c]: [DVec3; 3]| if is_mirrored { [a, c, b] } else { [a, b, c] };
    mesh.world_corners().map(outward)
}

#[cfg(test)]
mod tests {
    use std::path::Path;
    use std::sync::Arc;

    use super::*;
    use crate::scene::animation::Value;
    use crate::scene::{Animation, MeshSource, check};

    #[test]
    fn what_is_hidden_is_not_joined_unasked_and_hides_nothing() {
        let mut scene = Scene::demo();
        let is_triangle = |object: &Object| matches!(object.shape, Shape::Triangle(_));
        let first = scene.objects.iter().position(is_triangle);
        let first = first.expect("a triangle");
        let all = scene.connected_triangles(first);
        scene.objects[first].visible = false;
        assert_eq!(scene.connected_triangles(first), [first]);
        let others = scene.connected_triangles(first + 1);
        assert_eq!(others.len(), all.len() - 1);
        assert_eq!(scene.join(&all), Some(first));
        assert!(scene.objects[first].visible);
    }

    #[test]
    fn the_pyramid_of_the_demo_becomes_a_mesh_and_triangles_again() {
        let demo = Scene::demo();
        let is_triangle = |object: &Object| matches!(object.shape, Shape::Triangle(_));
        let first = demo
            .objects
            .iter()
            .position(is_triangle)
            .expect("a triangle");
        let mut scene = demo.clone();
        let connected = scene.connected_triangles(first + 2);
        assert_eq!(scene.join(&connected), Some(first));
        assert_eq!(scene.objects.len(), demo.objects.len() - 5);
        assert_eq!(check(&scene), Ok(()));
        assert_eq!(scene.objects[first].name, demo.objects[first].name);
        assert_eq!(scene.faces(), 6);
        assert!(!scene.separate(first).is_empty());
        assert_eq!(check(&scene), Ok(()));
        let shapes = |scene: &Scene| -> Vec<_> {
            scene
                .objects
                .iter()
                .map(|object| object.shape.clone())
                .collect()
        };
        assert_eq!(shapes(&scene), shapes(&demo));
        assert!(demo.connected_triangles(0).is_empty(), "a sphere");
    }

    #[test]
    fn slivers_without_an_area_are_left_out() {
        let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::X * 2.0];
        let faces = vec![[0, 1, 2], [0, 1, 3]];
        let triangles = Triangles::new(points.to_vec(), faces).expect("a mesh");
        let mut scene = Scene::demo();
        scene.objects = [Object {
            shape: Shape::Mesh(Mesh::of(triangles)),
            ..scene.objects[0].clone()
        }]
        .into_iter()
        .collect();
        assert!(!scene.separate(0).is_empty());
        assert_eq!(scene.objects.len(), 1);
        assert_eq!(check(&scene), Ok(()));
    }

    #[test]
    fn what_moves_goes_on_where_it_can() {
        let mut scene = Scene::demo();
        let moves = |place: usize| Target::ObjectPosition(scene.objects[place].name.clone());
        let (first, second) = (moves(2), moves(3));
        let start = scene.objects[2].shape.position();
        let mut animation = Animation::default();
        for (target, time, point) in [
            (&first, 0.0, start),
            (&first, 1.0, start + DVec3::X),
            (&second, 0.0, DVec3::ZERO),
        ] {
            animation = animation.with_value(target, time, Value::Point(point));
        }
        scene.animation = Arc::new(animation);
        assert_eq!(scene.join(&[2, 3]), Some(2));
        assert_eq!(check(&scene), Ok(()));
        let tracks = &scene.animation.tracks;
        assert_eq!(tracks.len(), 1);
        let place = scene.objects[2].shape.position();
        let there = [place, place + DVec3::X].map(Value::Point);
        for (key, there) in tracks[0].keys.iter().zip(there) {
            let (Value::Point(key), Value::Point(there)) = (key.value, there) else {
                panic!("a place");
            };
            assert!((key - there).length() < 1e-9, "{key} {there}");
        }
        assert!(!scene.separate(2).is_empty());
        assert_eq!(check(&scene), Ok(()));
        assert!(scene.animation.tracks.is_empty());
    }

    #[test]
    fn meshes_and_triangles_become_one_mesh_where_they_are() {
        let mut scene = Scene::demo();
        assert_eq!(scene.join(&[0, 2]), None, "a sphere");
        assert_eq!(scene.join(&[2, 3, 4]), Some(2));
        let Shape::Mesh(mesh) = &mut scene.objects[2].shape else {
            panic!("a mesh");
        };
        let joined = mesh.clone();
        (mesh.rotation, mesh.scale) = (DVec3::new(10.0, 20.0, 30.0), DVec3::new(-1.0, 2.0, 1.0));
        let (low, high) = scene.objects[2].shape.bounds().expect("it ends");
        assert_eq!(scene.join(&[2, 3]), Some(2));
        assert_eq!((scene.faces(), check(&scene)), (4, Ok(())));
        // The bounds of a turned mesh enclose its turned local box. The joined mesh is not turned, so its bounds
        // are within those of its parts.
        let (own_low, own_high) = Scene::demo().objects[5].shape.bounds().expect("it ends");
        let (low, high) = (low.min(own_low), high.max(own_high));
        let (new_low, new_high) = scene.objects[2].shape.bounds().expect("it ends");
        assert!(new_low.cmpge(low - 1e-9).all() && new_high.cmple(high + 1e-9).all());
        assert!((new_high - new_low).min_element() > 20.0);
        // The reference to a file that is missing would be lost.
        let gone = MeshSource::read_anew(Path::new("nowhere"), "gone.ply".to_owned());
        let mesh = Mesh {
            source: gone,
            ..joined
        };
        scene.objects.push(Object::new("Gone", "plane", mesh));
        let last = scene.objects.len() - 1;
        assert_eq!(scene.join(&[2, last]), None);
    }
}
