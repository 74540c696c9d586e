//! The scene itself.

use std::collections::{BTreeSet, HashSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::DVec3;
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use crate::files::{Marks, is_same_file};
use crate::mesh::Triangles;

use super::animation::Animation;
use super::camera::{Bookmark, Camera};
use super::list::List;
use super::material::{ColorPack, Packs};
use super::notation;
use super::object::{Light, LightObj, Object, default_intensity, default_true};
use super::render::Render;
use super::shape::{Mesh, MeshFiles, MeshSource, Shape, unshared_triangle_bytes};

/// The scene-file version that is written, and the newest that is read.
pub const VERSION: u32 = 1;
/// Largest size in bytes of a scene file: enough for meshes of 4,000,000 faces or 1,500,000 objects.
pub const MAX_BYTES: u64 = 256 << 20;

/// A complete scene. Clones share unchanged parts. Fields missing in a file have the values of the demo scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Version of the file format, which is 1 so far.
    pub version: u32,
    /// Colour of a ray that hits nothing, 0–255.
    #[serde(default)]
    #[serde(with = "notation::vector")]
    pub background: DVec3,
    /// Share of each color pack's ambient colour that is visible without any light, 0–1.
    #[serde(default = "default_ambient_intensity", with = "notation::number")]
    pub ambient_intensity: f64,
    /// Whether the markers of the lights are part of the picture.
    #[serde(default = "default_true")]
    pub light_visualization: bool,
    /// The viewpoint of the picture.
    #[serde(default)]
    pub camera: Camera,
    /// Saved views.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bookmarks: Vec<Bookmark>,
    /// Color packs by name, in file order, shared by the objects that refer to them.
    #[serde(default = "default_packs")]
    pub color_packs: Packs,
    /// The objects, which are visible, are reflected and cast shadows.
    pub objects: List<Object>,
    /// The lights.
    #[serde(default = "default_lights")]
    pub lights: List<Light>,
    /// Settings for rendering the picture.
    #[serde(default)]
    pub render: Render,
    /// Keyframes of the camera and of other properties. Serialized separately, with one key per line.
    #[serde(default, skip_serializing)]
    pub animation: Arc<Animation>,
}

impl Scene {
    /// Returns whether objects, lights, color packs, background and ambient intensity are unchanged since one scene
    /// was cloned from the other. May be `false` for equal ones.
    pub fn shares_contents_with(&self, other: &Self) -> bool {
        self.objects.is_same(&other.objects)
            && self.lights.is_same(&other.lights)
            && self.color_packs.is_same(&other.color_packs)
            && self.background == other.background
            && self.ambient_intensity == other.ambient_intensity
    }

    /// Returns whether both look the same to the same camera. May be `false` for equal scenes.
    pub fn looks_same_as(&self, other: &Self) -> bool {
        self.shares_contents_with(other)
            && self.light_visualization == other.light_visualization
            && self.render == other.render
    }

    /// Creates an empty scene with the demo's camera, held level, and a color pack and a light to start with.
    pub fn empty() -> Self {
        let mut light = default_lights().remove(0);
        light.marker = Some(LightObj::default());
        Self {
            version: VERSION,
            background: DVec3::new(0.0, 0.0, 0.0),
            ambient_intensity: default_ambient_intensity(),
            light_visualization: true,
            camera: Camera {
                up: DVec3::Y,
                ..Camera::default()
            },
            bookmarks: Vec::new(),
            color_packs: Packs::from(IndexMap::from([
                ("pack 1".to_owned(), ColorPack::default()),
                ("light".to_owned(), light_pack()),
            ])),
            objects: List::new(),
            lights: List::from(vec![light]),
            render: Render::default(),
            animation: Arc::default(),
        }
    }

    /// Returns the color packs for modification, cloned first if they are shared.
    pub fn packs_mut(&mut self) -> &mut IndexMap<String, ColorPack> {
        self.color_packs.make_mut()
    }

    /// Returns the animation for modification, cloned first if it is shared.
    pub fn animation_mut(&mut self) -> &mut Animation {
        Arc::make_mut(&mut self.animation)
    }

    /// Iterates over the visible objects, in order.
    pub fn visible_objects(&self) -> impl Iterator<Item = &Object> + Clone {
        self.objects.visible().map(|(_, object)| object)
    }

    /// Iterates over the lights that are switched on, in order.
    pub fn visible_lights(&self) -> impl Iterator<Item = &Light> + Clone {
        self.lights.iter().filter(|light| light.visible)
    }

    /// Estimates how many bytes of this scene are not shared with another one.
    pub fn unshared_bytes(&self, other: &Self) -> usize {
        let packs = if self.color_packs.is_same(&other.color_packs) {
            0
        } else {
            self.color_packs.len() * size_of::<ColorPack>()
        };
        let animation = if Arc::ptr_eq(&self.animation, &other.animation) {
            0
        } else {
            self.animation.bytes()
        };
        let lists =
            self.objects.unshared_bytes(&other.objects) + self.lights.unshared_bytes(&other.lights);
        let meshes = if self.objects.is_same(&other.objects) {
            0
        } else {
            unshared_triangle_bytes(self.mesh_sources(), other.mesh_sources())
        };
        size_of::<Self>() + packs + animation + lists + meshes
    }

    /// Returns the lowest and highest corner of the bounding box of all visible bounded objects and visible lights;
    /// `None` if there are none.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let lights = self.visible_lights();
        let lights = lights.map(|light| (light.position, light.position));
        around(self.objects_bounds().into_iter().chain(lights))
    }

    /// Like [`Self::bounds`], without lights.
    pub fn objects_bounds(&self) -> Option<(DVec3, DVec3)> {
        let visible = self.visible_objects();
        around(visible.filter_map(|object| object.shape.bounds()))
    }

    /// Reads the mesh files in `folder`, the folder of the scene file. A mesh that cannot be read is empty and
    /// holds the problem; see [`Self::mesh_problems`].
    pub fn load_meshes(&mut self, folder: Option<&Path>) {
        // A file that several objects refer to is read once, and its triangles are shared.
        let mut files = MeshFiles::new();
        self.change_meshes(|mesh| {
            let mut loaded = mesh.clone();
            loaded.load(folder, &mut files);
            Some(loaded)
        });
    }

    /// Returns the scene for saving in `folder`: meshes whose files are missing, in another folder or in the program
    /// itself become inline.
    #[must_use]
    pub fn inlined_for(&self, folder: &Path) -> Self {
        let missing = self.gone_mesh_files();
        let references = self.mesh_sources().filter_map(MeshSource::reference);
        let mut elsewhere: BTreeSet<&Path> = references.map(|(own_folder, _)| own_folder).collect();
        // The same folder can be spelled in several ways.
        elsewhere.retain(|own_folder| !is_same_file(own_folder, folder));
        self.with_sources(|source| {
            let is_available = |(own_folder, path): (&Path, &str)| {
                !missing.contains(path) && !elsewhere.contains(own_folder)
            };
            if source.file().is_some_and(is_available) {
                return None;
            }
            source.inlined()
        })
    }

    /// Returns the scene for saving in `folder`: mesh files that could not be read in another folder are looked for
    /// there.
    #[must_use]
    pub fn reloaded_from(&self, folder: &Path) -> Self {
        let mut files = MeshFiles::new();
        self.with_sources(|source| {
            source.problem()?;
            let own_folder = source.reference().map(|(own_folder, _)| own_folder);
            if own_folder.is_some_and(|own_folder| is_same_file(own_folder, folder)) {
                return None;
            }
            let mut new = source.clone();
            new.load(Some(folder), &mut files);
            Some(new)
        })
    }

    /// Returns the relative paths of all mesh files that were read.
    pub fn mesh_paths(&self) -> BTreeSet<&str> {
        let files = self.mesh_sources().filter_map(MeshSource::file);
        files.map(|(_, path)| path).collect()
    }

    /// Returns the relative paths of mesh files that were read but no longer exist. Each file is checked once, even
    /// if several meshes refer to it.
    pub fn gone_mesh_files(&self) -> BTreeSet<&str> {
        let files: BTreeSet<_> = self.mesh_sources().filter_map(MeshSource::file).collect();
        let missing = files
            .into_iter()
            .filter(|(folder, path)| !folder.join(path).exists());
        missing.map(|(_, path)| path).collect()
    }

    /// Returns the scene with all meshes inline that were read from one of these files.
    #[must_use]
    pub fn without_files(&self, files: &BTreeSet<PathBuf>) -> Self {
        self.with_sources(|source| {
            let (folder, path) = source.file()?;
            let is_listed = files.contains(&folder.join(path));
            is_listed.then(|| source.inlined()).flatten()
        })
    }

    /// Returns those of `files` from which some mesh was read.
    pub fn files_in_use<'f>(&self, files: &'f BTreeSet<PathBuf>) -> BTreeSet<&'f Path> {
        if files.is_empty() {
            return BTreeSet::new();
        }
        let sources = self.mesh_sources().filter_map(MeshSource::file);
        let sources: HashSet<_> = sources.collect();
        let sources = sources.into_iter();
        let found = sources.filter_map(|(folder, path)| files.get(&folder.join(path)));
        found.map(PathBuf::as_path).collect()
    }

    /// Returns all files that meshes refer to, whether they could be read or not: folder, relative path, and
    /// modification time and length when it was read.
    pub fn mesh_files(&self) -> HashSet<(&Path, &str, Option<Marks>)> {
        let referring = self.mesh_sources().filter_map(|source| {
            let (folder, path) = source.reference()?;
            Some((folder, path, source.marks()))
        });
        referring.collect()
    }

    /// Returns a mesh file that was read again; if it puts a mesh of this scene too far from the origin, as one that
    /// could not be read.
    pub fn checked_read(&self, read: MeshSource) -> MeshSource {
        let mut with_new = self
            .objects
            .iter()
            .filter_map(|object| match &object.shape {
                Shape::Mesh(mesh) if mesh.source.reference() == read.reference() => {
                    Some(mesh.with_read(read.clone()).source)
                }
                _ => None,
            });
        let refused = with_new.find(|source| source.problem().is_some());
        refused.unwrap_or(read)
    }

    /// Returns the scene with its mesh files replaced by newly read ones, except for those that can no longer be
    /// read or would put the mesh too far from the origin; `None` if nothing changes.
    pub fn with_read(&self, read: &[MeshSource]) -> Option<Self> {
        let new = |source: &MeshSource| {
            let own = source.reference()?;
            let read = read.iter().find(|read| read.reference() == Some(own))?;
            let is_loss = read.problem().is_some() && source.problem().is_none();
            (read != source && !is_loss).then(|| read.clone())
        };
        let has_changes = self.mesh_sources().any(|source| new(source).is_some());
        has_changes.then(|| {
            let mut scene = self.clone();
            scene.change_meshes(|mesh| {
                let source = new(&mesh.source)?;
                let is_readable = source.problem().is_none();
                let changed = mesh.with_read(source);
                // What would be too far away here stays as it is.
                (changed.source.problem().is_none() == is_readable).then_some(changed)
            });
            scene
        })
    }

    fn mesh_sources(&self) -> impl Iterator<Item = &MeshSource> {
        let shapes = self.objects.iter().map(|object| &object.shape);
        shapes.filter_map(|shape| match shape {
            Shape::Mesh(mesh) => Some(&mesh.source),
            _ => None,
        })
    }

    /// Returns the scene with all meshes inline, so that it needs no other files.
    #[must_use]
    pub fn inlined(&self) -> Self {
        self.with_sources(MeshSource::inlined)
    }

    /// Returns the scene with a short identifier in place of the triangles of each mesh, different for different
    /// triangles, so that scenes can be compared without writing them out in full.
    #[must_use]
    pub fn abridged(&self) -> Self {
        self.with_sources(|source| Some(source.abridged()))
    }

    /// Returns the scene with each mesh source replaced for which `change` returns another one. Everything else
    /// stays shared.
    fn with_sources(&self, mut change: impl FnMut(&MeshSource) -> Option<MeshSource>) -> Self {
        let mut scene = self.clone();
        scene.change_meshes(|mesh| {
            let source = change(&mesh.source)?;
            Some(Mesh {
                source,
                ..mesh.clone()
            })
        });
        scene
    }

    /// Replaces each mesh for which `change` returns another one.
    pub(super) fn change_meshes(&mut self, mut change: impl FnMut(&Mesh) -> Option<Mesh>) {
        for index in 0..self.objects.len() {
            let Shape::Mesh(mesh) = &self.objects[index].shape else {
                continue;
            };
            if let Some(new) = change(mesh) {
                self.objects[index].shape = new.into();
            }
        }
    }

    /// The number of triangles of all meshes, including hidden ones.
    pub fn faces(&self) -> usize {
        self.objects.iter().map(Object::faces).sum()
    }

    /// Estimates how many bytes the triangles of inline meshes take in the scene file.
    pub fn own_bytes(&self) -> u64 {
        let own = self.own_triangles();
        own.map(|triangles| triangles.bytes_of_text()).sum()
    }

    /// The number of triangles of inline meshes.
    pub fn own_faces(&self) -> usize {
        let own = self.own_triangles();
        own.map(|triangles| triangles.faces().len()).sum()
    }

    fn own_triangles(&self) -> impl Iterator<Item = &Arc<Triangles>> {
        let inline = |source: &&MeshSource| matches!(source, MeshSource::Inline(_));
        self.mesh_sources()
            .filter(inline)
            .map(MeshSource::triangles)
    }

    /// Returns whether any mesh refers to a file.
    pub fn has_mesh_files(&self) -> bool {
        let mut sources = self.mesh_sources();
        sources.any(|source| matches!(source, MeshSource::File { .. }))
    }

    /// Returns the indices of objects whose meshes could not be read, and why.
    pub fn mesh_problems(&self) -> impl Iterator<Item = (usize, &str)> {
        let objects = self.objects.iter().enumerate();
        objects.filter_map(|(index, object)| match &object.shape {
            Shape::Mesh(mesh) => Some((index, mesh.source.problem()?)),
            _ => None,
        })
    }

    /// Returns the bounding box of all visible bounded objects. If there are none, it is that of the lights.
    pub fn surroundings(&self) -> Option<(DVec3, DVec3)> {
        self.objects_bounds().or_else(|| self.bounds())
    }

    /// The centre of [`Self::surroundings`].
    pub fn middle(&self) -> Option<DVec3> {
        self.surroundings().map(|(low, high)| low.midpoint(high))
    }
}

/// Returns the bounding box of boxes given by their lowest and highest corners; `None` if there are none.
pub fn around(boxes: impl Iterator<Item = (DVec3, DVec3)>) -> Option<(DVec3, DVec3)> {
    boxes.reduce(|(low, high), (other_low, other_high)| (low.min(other_low), high.max(other_high)))
}

/// Ambient intensity of a scene whose file leaves it out.
pub fn default_ambient_intensity() -> f64 {
    0.5
}

/// Default color pack of light markers.
pub fn light_pack() -> ColorPack {
    ColorPack::of_color(DVec3::new(255.0, 255.0, 0.0))
}

fn default_packs() -> Packs {
    let matte = |x, y, z| ColorPack::of_color(DVec3::new(x, y, z));
    Packs::from(IndexMap::from([
        ("sphere 1".to_owned(), matte(255.0, 128.0, 255.0)),
        ("sphere 2".to_owned(), matte(255.0, 128.0, 128.0)),
        ("tetrahedron".to_owned(), matte(128.0, 255.0, 255.0)),
        (
            "plane".to_owned(),
            ColorPack {
                reflective: true,
                ..ColorPack::default()
            },
        ),
        ("light".to_owned(), light_pack()),
    ]))
}

/// The demo's two lights without markers: a file that leaves out its lights need not have the color pack that the
/// markers would refer to.
fn default_lights() -> List<Light> {
    let light = |name: &str, x, y, z| Light {
        name: name.to_owned(),
        position: DVec3::new(x, y, z),
        intensity: default_intensity(),
        marker: None,
        visible: true,
    };
    List::from(vec![
        light("Light 1", 100.0, 100.0, -50.0),
        light("Light 2", 231.0, 63.0, -127.0),
    ])
}
