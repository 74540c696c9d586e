//! Turning the parts of a mesh file into objects of a scene.

use std::collections::HashMap;
use std::path::Path;

use glam::DVec3;

use super::camera::Camera;
use super::list::List;
use super::material::{ColorPack, MAX_EXPONENT};
use super::names::{Names, without_number};
use super::object::{Light, Object};
use super::shape::{Mesh, MeshFiles, MeshSource, Shape};
use super::whole::{MAX_BYTES, Scene};
use crate::mesh::{MeshError, Part, PartColors, read_mesh_file};

/// Name of the color pack of parts without colours.
const PLAIN_PACK: &str = "mesh";

/// The color packs of a scene, for finding many of them.
struct PackIndex {
    names: Names,
    /// The first pack of each colour, by its name without a number and its [`ColorPack::key`].
    first_alike: HashMap<(String, ([u64; 10], bool)), String>,
}

impl PackIndex {
    fn of(scene: &Scene) -> Self {
        let mut first_alike = HashMap::new();
        for (name, pack) in scene.color_packs.iter() {
            let alike = (without_number(name).to_owned(), pack.key());
            first_alike.entry(alike).or_insert_with(|| name.clone());
        }
        let names = Names::new(scene.color_packs.keys().map(String::as_str));
        Self { names, first_alike }
    }
}

impl Scene {
    /// Creates a scene of a mesh file, with everything in view and lit from two sides. If the file has a single
    /// part, or is too large for a scene file, and is in `folder`, where the scene is to be saved, the scene refers to
    /// it; otherwise meshes are inline. Also returns [`MeshFile::notes`](crate::mesh::MeshFile::notes).
    ///
    /// # Errors
    /// [`MeshError`]: which file, where in it, and what is wrong.
    pub fn of_mesh_file(
        path: &Path,
        folder: Option<&Path>,
    ) -> Result<(Self, Vec<String>), MeshError> {
        let mut scene = Self::empty();
        scene.packs_mut().clear();
        scene.lights = List::new();
        let mut file = read_mesh_file(path)?;
        scene.add_parts(file.parts);
        let relative = folder.and_then(|folder| path.strip_prefix(folder).ok());
        let has_parts = scene.objects.len() > 1;
        if let Some(relative) = relative.and_then(reference_to)
            && (!has_parts || scene.own_bytes() > MAX_BYTES)
            && let Some(object) = scene.linked_to(relative, folder)
        {
            scene.objects = List::from(vec![object]);
            if has_parts {
                let note =
                    "its parts are one mesh of one colour, since a scene file could not hold them";
                file.notes.push(note.to_owned());
                let stem = path.file_stem().unwrap_or_default().to_string_lossy();
                scene.objects[0].name = valid_name(&stem);
                let pack = scene.objects[0].color_pack.clone();
                scene.packs_mut().retain(|name, _| *name == pack);
            }
        }
        scene.frame_and_light();
        Ok((scene, file.notes))
    }

    /// The first object with the mesh file at this path within `folder` as its mesh; `None` if that cannot be read.
    fn linked_to(&self, path: String, folder: Option<&Path>) -> Option<Object> {
        let object = self.objects.get(0)?;
        let Shape::Mesh(mesh) = &object.shape else {
            return None;
        };
        // The mesh keeps the coordinates of the file, which are not centred.
        let mut linked = Mesh {
            source: MeshSource::unread(path),
            position: DVec3::ZERO,
            ..mesh.clone()
        };
        linked.load(folder, &mut MeshFiles::new());
        linked.source.problem().is_none().then(|| Object {
            shape: linked.into(),
            ..object.clone()
        })
    }

    /// Appends parts as objects, with their colours as color packs. Returns the index of the first.
    pub fn add_parts(&mut self, parts: Vec<Part>) -> usize {
        let first = self.objects.len();
        let mut names = Names::new(self.objects.iter().map(|object| object.name.as_str()));
        let mut packs = PackIndex::of(self);
        for part in parts {
            let color_pack = self.pack_of(part.colors.as_ref(), &mut packs);
            let Part {
                name, triangles, ..
            } = part;
            self.objects.push(Object::new(
                names.take(&valid_name(&name)),
                color_pack,
                Mesh::of(triangles).centred(),
            ));
        }
        first
    }

    /// Returns the name of the color pack for a part. An existing equal pack is reused, see [`Self::pack_like`].
    fn pack_of(&mut self, colors: Option<&PartColors>, packs: &mut PackIndex) -> String {
        let (wanted, pack) = match colors {
            None => (PLAIN_PACK.to_owned(), plain_pack()),
            Some(colors) => (valid_name(&colors.name), color_pack(colors)),
        };
        if self.color_packs.get(&wanted) == Some(&pack) {
            return wanted;
        }
        let alike = (without_number(&wanted).to_owned(), pack.key());
        let PackIndex { names, first_alike } = packs;
        let name = first_alike.entry(alike).or_insert_with(|| {
            let name = names.take(&wanted);
            self.packs_mut().insert(name.clone(), pack);
            name
        });
        name.clone()
    }

    /// Places the camera in front and a little above, so that everything is in view, and adds two lights.
    fn frame_and_light(&mut self) {
        let Some((low, high)) = self.objects_bounds() else {
            return;
        };
        let (middle, size) = (low.midpoint(high), (high - low).length());
        let view_side = DVec3::new(0.35, 0.3, 1.0).normalize();
        self.camera = Camera {
            position: middle + view_side * size * 1.3,
            look_at: -view_side,
            up: DVec3::Y,
            projection_distance: 1.0,
            orthographic_height: size,
            ..Camera::default()
        };
        for (name, direction, intensity) in [
            ("Light 1", DVec3::new(1.0, 1.2, 1.0), 0.5),
            ("Light 2", DVec3::new(-1.4, 0.6, 0.7), 0.25),
        ] {
            self.lights.push(Light {
                name: name.to_owned(),
                position: middle + direction * size,
                intensity,
                marker: None,
                visible: true,
            });
        }
    }
}

/// Returns the path of a file as written in a scene: with `/` as the separator on every system.
fn reference_to(path: &Path) -> Option<String> {
    let parts = path.components().map(|part| part.as_os_str().to_str());
    Some(parts.collect::<Option<Vec<_>>>()?.join("/"))
}

fn plain_pack() -> ColorPack {
    let clay = DVec3::new(214.0, 200.0, 184.0);
    ColorPack {
        specular: DVec3::splat(60.0),
        ..ColorPack::of_color(clay)
    }
}

fn color_pack(colors: &PartColors) -> ColorPack {
    let color = |[red, green, blue]: [f64; 3]| (DVec3::new(red, green, blue) * 255.0).round();
    let diffuse = color(colors.diffuse);
    let plain = plain_pack();
    ColorPack {
        // Most files leave the ambient colour black or white; what only ambient light reaches would then be lost.
        ambient: diffuse,
        diffuse,
        specular: colors.specular.map_or(plain.specular, color),
        phong_exponent: colors
            .exponent
            .map_or(plain.phong_exponent, |exponent| exponent.min(MAX_EXPONENT)),
        reflective: colors.reflective,
    }
}

/// Returns a valid name for what is in a scene.
pub fn valid_name(name: &str) -> String {
    let plain: String = name.chars().filter(|c| !c.is_control()).take(100).collect();
    let plain = plain.trim();
    if plain.is_empty() { PLAIN_PACK } else { plain }.to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Document, check};

    const OBJ: &str = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\no left\nusemtl red\nf 1 2 3\no left\nf 1 2 4\n";
    const MTL: &str = "newmtl red\nKd 1 0.5 0\nKs 0.2 0.2 0.2\nNs 40\n";

    #[test]
    fn groups_become_objects_and_materials_packs() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("m.obj");
        std::fs::write(&path, OBJ).expect("written");
        std::fs::write(folder.path().join("m.mtl"), MTL).expect("written");
        let (scene, _) = Scene::of_mesh_file(&path, Some(folder.path())).expect("read");
        assert_eq!(check(&scene), Ok(()));
        let names: Vec<_> = scene.objects.iter().map(|o| o.name.as_str()).collect();
        assert_eq!(names, ["left", "left 2"]);
        let pack = &scene.color_packs["red"];
        assert_eq!(pack.diffuse, DVec3::new(255.0, 128.0, 0.0));
        assert_eq!(pack.phong_exponent, 40.0);
        assert_eq!(scene.objects[1].color_pack, "red");
        // Meshes of two parts are inline, and are read back unchanged.
        let document = Document::of(scene);
        let text = document.to_text().expect("a text");
        let again = Document::from_text(&text).expect("a scene");
        assert_eq!(again, document);
    }

    #[test]
    fn parts_of_one_colour_share_a_pack_whatever_it_is_called() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("m.obj");
        std::fs::write(&path, OBJ).expect("written");
        std::fs::write(folder.path().join("m.mtl"), MTL).expect("written");
        let mut scene = Scene::demo();
        let other = ColorPack::default();
        scene.packs_mut().insert("red".to_owned(), other);
        let first = scene.add_parts(read_mesh_file(&path).expect("read").parts);
        let packs = [0, 1].map(|part| scene.objects[first + part].color_pack.as_str());
        assert_eq!(packs, ["red 2", "red 2"]);
        let first = scene.add_parts(read_mesh_file(&path).expect("read").parts);
        assert_eq!(scene.objects[first].color_pack, "red 2", "imported again");
    }

    #[test]
    fn a_file_that_several_objects_show_is_read_once() {
        let folder = tempfile::tempdir().expect("a folder");
        std::fs::write(
            folder.path().join("m.obj"),
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        )
        .expect("written");
        let object = |name: &str| {
            format!("Object(name: {name:?}, color_pack: \"plane\", shape: Mesh(file: \"m.obj\"))")
        };
        let text = format!(
            "Scene(version: 1, objects: [{}, {}])",
            object("a"),
            object("b")
        );
        let path = folder.path().join("two.ron");
        std::fs::write(&path, text).expect("written");
        let scene = Document::load(&path).expect("a scene").scene;
        let triangles = |index: usize| match &scene.objects[index].shape {
            Shape::Mesh(mesh) => mesh.source.triangles(),
            _ => panic!("a mesh"),
        };
        assert_eq!(triangles(0).faces().len(), 1);
        assert!(std::sync::Arc::ptr_eq(triangles(0), triangles(1)));
    }

    #[test]
    fn one_part_beside_the_scene_is_referred_to() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("m.obj");
        std::fs::write(&path, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("written");
        let (scene, _) = Scene::of_mesh_file(&path, Some(folder.path())).expect("read");
        let document = Document::of(scene);
        let file = folder.path().join("s.ron");
        document.save(&file).expect("saved");
        let text = std::fs::read_to_string(&file).expect("there");
        assert!(text.contains("Mesh(file: \"m.obj\")"), "{text}");
        assert_eq!(Document::load(&file).expect("read").scene, document.scene);
        // In another folder there is no such file: the mesh becomes inline.
        let elsewhere = tempfile::tempdir().expect("a folder");
        let file = elsewhere.path().join("s.ron");
        document.save(&file).expect("saved");
        std::fs::remove_file(&path).expect("removed");
        let there = Document::load(&file).expect("read").scene;
        assert_eq!(there.mesh_problems().count(), 0);
        assert_eq!(there.objects_bounds(), document.scene.objects_bounds());
        // The file is missing in its own folder as well now.
        assert!(document.scene.gone_mesh_files().into_iter().eq(["m.obj"]));
        let file = folder.path().join("s.ron");
        document.save(&file).expect("saved");
        let again = Document::load(&file).expect("read").scene;
        assert_eq!(again.mesh_problems().count(), 0);
        assert_eq!(again.objects_bounds(), document.scene.objects_bounds());
    }

    #[test]
    fn a_missing_file_is_named_and_the_rest_is_there() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("s.ron");
        let text = "Scene(version: 1, color_packs: {\"p\": ColorPack()}, objects: [Object(name: \"a\", color_pack: \"p\", shape: Mesh(file: \"gone.ply\", position: (1, 2, 3))), Object(name: \"b\", color_pack: \"p\", shape: Sphere(center: (0, 0, 0), radius: 1))])";
        std::fs::write(&file, text).expect("written");
        let document = Document::load(&file).expect("the rest opens");
        let problems: Vec<_> = document.scene.mesh_problems().collect();
        assert_eq!(problems.len(), 1);
        assert!(problems[0].1.contains("gone.ply"), "{problems:?}");
        assert!(
            document
                .to_text()
                .expect("a text")
                .contains("Mesh(file: \"gone.ply\", position: (1, 2, 3))")
        );
    }
}
