//! The scene itself.

use std::cell::RefCell;
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
use super::object::{Light, LightObj, Object, default_intensity, yes};
use super::render::Render;
use super::shape::{Mesh, MeshFiles, MeshSource, Shape};

/// The scene-file version that this program writes and the newest that it reads.
pub const VERSION: u32 = 1;
/// Longest scene file that is read, in bytes: room for meshes of 4,000,000 faces or 1,500,000 objects.
pub const MAX_BYTES: u64 = 256 << 20;

/// Everything that makes a picture. A copy shares what is not changed. What a file leaves out has the
/// value that the demo scene has.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Version of the file format, see [`VERSION`].
    pub version: u32,
    /// Colour of a ray that hits nothing, 0–255.
    #[serde(default)]
    #[serde(with = "notation::vector")]
    pub background: DVec3,
    /// How much of every pack's ambient colour is seen without any light, 0–1.
    #[serde(default = "default_ambient_intensity", with = "notation::number")]
    pub ambient_intensity: f64,
    /// Whether the markers of the lights are part of the picture.
    #[serde(default = "yes")]
    pub light_visualization: bool,
    /// Where the picture is taken from.
    #[serde(default)]
    pub camera: Camera,
    /// Views to come back to.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bookmarks: Vec<Bookmark>,
    /// Materials by name, shared by the objects that name them; the order is the file's.
    #[serde(default = "default_packs")]
    pub color_packs: Packs,
    /// The things that are seen, mirrored and cast shadows.
    pub objects: List<Object>,
    /// The lights.
    #[serde(default = "default_lights")]
    pub lights: List<Light>,
    /// How the picture is made.
    #[serde(default)]
    pub render: Render,
    /// What moves, and when. Written with a layout of its own, one key in a line.
    #[serde(default, skip_serializing)]
    pub animation: Arc<Animation>,
}

impl Scene {
    /// Whether both have the same things in the same light, unchanged since one was copied from the other, whatever
    /// looks at them; `false` may be wrong.
    pub fn has_same_things(&self, other: &Self) -> bool {
        self.objects.is_same(&other.objects)
            && self.lights.is_same(&other.lights)
            && self.color_packs.is_same(&other.color_packs)
            && self.background == other.background
            && self.ambient_intensity == other.ambient_intensity
    }

    /// Whether the same camera sees the same picture of both; `false` may be wrong.
    pub fn has_same_look(&self, other: &Self) -> bool {
        self.has_same_things(other)
            && self.light_visualization == other.light_visualization
            && self.render == other.render
    }

    /// An empty scene with the demo's camera, held level, and a pack and a light to start from.
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

    /// The colour packs, to be changed; copied if they are shared.
    pub fn packs_mut(&mut self) -> &mut IndexMap<String, ColorPack> {
        self.color_packs.make_mut()
    }

    /// What moves, to be changed; copied if it is shared.
    pub fn animation_mut(&mut self) -> &mut Animation {
        Arc::make_mut(&mut self.animation)
    }

    /// The objects that are seen, in order.
    pub fn visible_objects(&self) -> impl Iterator<Item = &Object> + Clone {
        self.objects.iter().filter(|object| object.visible)
    }

    /// The lights that shine, in order.
    pub fn visible_lights(&self) -> impl Iterator<Item = &Light> + Clone {
        self.lights.iter().filter(|light| light.visible)
    }

    /// About how many bytes this scene has that another one does not share.
    pub fn bytes_apart(&self, other: &Self) -> usize {
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
            self.objects.bytes_apart(&other.objects) + self.lights.bytes_apart(&other.lights);
        size_of::<Self>() + packs + animation + lists
    }

    /// Smallest and largest corner of the box around everything visible that has an end, lights
    /// included; `None` if there is nothing.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let lights = self.visible_lights();
        let lights = lights.map(|light| (light.position, light.position));
        around(self.objects_bounds().into_iter().chain(lights))
    }

    /// The same without lights.
    pub fn objects_bounds(&self) -> Option<(DVec3, DVec3)> {
        let visible = self.visible_objects();
        around(visible.filter_map(|object| object.shape.bounds()))
    }

    /// Reads the meshes that are files in `folder`, where the scene file is. What cannot be read is noted
    /// with the mesh, which is then empty; see [`Self::mesh_problems`].
    pub fn load_meshes(&mut self, folder: Option<&Path>) {
        // What several objects refer to is read once, and shared by them.
        let mut files = MeshFiles::new();
        self.change_meshes(|mesh| {
            let mut loaded = mesh.clone();
            loaded.load(folder, &mut files);
            Some(loaded)
        });
    }

    /// The same scene for a file in this folder: meshes that lie elsewhere, or whose files are gone, are taken in.
    #[must_use]
    pub fn taken_to(&self, folder: &Path) -> Self {
        let gone = self.gone_mesh_files();
        let references = self.mesh_sources().filter_map(MeshSource::reference);
        let mut elsewhere: BTreeSet<&Path> = references.map(|(own, _)| own).collect();
        // A folder has many spellings.
        elsewhere.retain(|own| !is_same_file(own, folder));
        self.with_sources(|source| {
            let (own, path) = source.file()?;
            let is_lost = gone.contains(path) || elsewhere.contains(own);
            is_lost.then(|| source.taken_in()).flatten()
        })
    }

    /// The same scene for a file in this folder: those files of meshes that could not be read elsewhere are looked for
    /// there.
    #[must_use]
    pub fn looking_in(&self, folder: &Path) -> Self {
        let files = RefCell::new(MeshFiles::new());
        self.with_sources(|source| {
            source.problem()?;
            let own = source.reference().map(|(own, _)| own);
            if own.is_some_and(|own| is_same_file(own, folder)) {
                return None;
            }
            let mut new = source.clone();
            new.load(Some(folder), &mut files.borrow_mut());
            Some(new)
        })
    }

    /// The files of meshes that were read, by their paths.
    pub fn mesh_paths(&self) -> BTreeSet<&str> {
        let files = self.mesh_sources().filter_map(MeshSource::file);
        files.map(|(_, path)| path).collect()
    }

    /// The files of meshes that were read, and are not there any more. Each is looked for once, however many show it.
    pub fn gone_mesh_files(&self) -> BTreeSet<&str> {
        let files: BTreeSet<_> = self.mesh_sources().filter_map(MeshSource::file).collect();
        let gone = files
            .into_iter()
            .filter(|(folder, path)| !folder.join(path).exists());
        gone.map(|(_, path)| path).collect()
    }

    /// The same scene with the meshes that were read of these files in itself.
    #[must_use]
    pub fn without_files(&self, files: &BTreeSet<PathBuf>) -> Self {
        self.with_sources(|source| {
            let (folder, path) = source.file()?;
            let is_meant = files.contains(&folder.join(path));
            is_meant.then(|| source.taken_in()).flatten()
        })
    }

    /// Those of these files that were read for some mesh.
    pub fn shown_of<'f>(&self, files: &'f BTreeSet<PathBuf>) -> BTreeSet<&'f Path> {
        if files.is_empty() {
            return BTreeSet::new();
        }
        let shown = self.mesh_sources().filter_map(MeshSource::file);
        let shown: HashSet<_> = shown.collect();
        let shown = shown.into_iter();
        let found = shown.filter_map(|(folder, path)| files.get(&folder.join(path)));
        found.map(PathBuf::as_path).collect()
    }

    /// The files that meshes refer to, whether they could be read or not: the folder, the path in it, and what marked
    /// the file when it was read.
    pub fn mesh_files(&self) -> HashSet<(&Path, &str, Option<Marks>)> {
        let referring = self.mesh_sources().filter_map(|source| {
            let (folder, path) = source.reference()?;
            Some((folder, path, source.marks()))
        });
        referring.collect()
    }

    /// The same scene with what was read anew of the files that its meshes refer to, but for what cannot be read any
    /// more; `None` where that is in it already.
    pub fn with_read(&self, read: &[MeshSource]) -> Option<Self> {
        let new = |source: &MeshSource| {
            let own = source.reference()?;
            let read = read.iter().find(|read| read.reference() == Some(own))?;
            let is_loss = read.problem().is_some() && source.problem().is_none();
            (read != source && !is_loss).then(|| read.clone())
        };
        let is_other = self.mesh_sources().any(|source| new(source).is_some());
        is_other.then(|| self.with_sources(new))
    }

    fn mesh_sources(&self) -> impl Iterator<Item = &MeshSource> {
        let shapes = self.objects.iter().map(|object| &object.shape);
        shapes.filter_map(|shape| match shape {
            Shape::Mesh(mesh) => Some(&mesh.source),
            _ => None,
        })
    }

    /// The same scene with the triangles of all meshes: it needs no other files.
    #[must_use]
    pub fn taken_in(&self) -> Self {
        self.with_sources(MeshSource::taken_in)
    }

    /// The same scene with a word in place of the triangles of each mesh, which is another word for other
    /// triangles: what tells scenes apart without writing them down.
    #[must_use]
    pub fn abridged(&self) -> Self {
        self.with_sources(|source| Some(source.abridged()))
    }

    /// The same scene with other sources of its meshes, where there are some; what is left shares its room with this one.
    fn with_sources(&self, change: impl Fn(&MeshSource) -> Option<MeshSource>) -> Self {
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

    /// Puts another mesh in place of each that shall have one.
    pub(super) fn change_meshes(&mut self, mut change: impl FnMut(&Mesh) -> Option<Mesh>) {
        for index in 0..self.objects.len() {
            let Shape::Mesh(mesh) = &self.objects[index].shape else {
                continue;
            };
            if let Some(new) = change(mesh)
                && let Some(object) = self.objects.get_mut(index)
            {
                object.shape = new.into();
            }
        }
    }

    /// How many triangles the meshes have, hidden ones as well.
    pub fn faces(&self) -> usize {
        self.objects.iter().map(Object::faces).sum()
    }

    /// About how many bytes the triangles take that are written into the file of the scene.
    pub fn own_bytes(&self) -> u64 {
        let own = self.own_triangles();
        own.map(|triangles| triangles.bytes_of_text()).sum()
    }

    /// How many of them there are.
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

    /// Whether the triangles of some mesh are in a file of their own.
    pub fn has_mesh_files(&self) -> bool {
        let mut sources = self.mesh_sources();
        sources.any(|source| matches!(source, MeshSource::File { .. }))
    }

    /// The objects whose meshes could not be read, and why.
    pub fn mesh_problems(&self) -> impl Iterator<Item = (usize, &str)> {
        let objects = self.objects.iter().enumerate();
        objects.filter_map(|(index, object)| match &object.shape {
            Shape::Mesh(mesh) => Some((index, mesh.source.problem()?)),
            _ => None,
        })
    }

    /// The box around everything that ends, or around where endless planes are known to be.
    pub fn surroundings(&self) -> Option<(DVec3, DVec3)> {
        self.objects_bounds().or_else(|| self.bounds())
    }

    /// The middle of that.
    pub fn middle(&self) -> Option<DVec3> {
        self.surroundings().map(|(low, high)| low.midpoint(high))
    }
}

/// The box around boxes, each by its lowest and highest corner; `None` for none.
pub fn around(boxes: impl Iterator<Item = (DVec3, DVec3)>) -> Option<(DVec3, DVec3)> {
    boxes.reduce(|(low, high), (other_low, other_high)| (low.min(other_low), high.max(other_high)))
}

/// Ambient intensity of a scene whose file says nothing about it.
pub fn default_ambient_intensity() -> f64 {
    0.5
}

/// What shows where lights are.
pub fn light_pack() -> ColorPack {
    let yellow = DVec3::new(255.0, 255.0, 0.0);
    ColorPack {
        ambient: yellow,
        diffuse: yellow,
        ..ColorPack::default()
    }
}

fn default_packs() -> Packs {
    let matte = |x, y, z| ColorPack {
        ambient: DVec3::new(x, y, z),
        diffuse: DVec3::new(x, y, z),
        ..ColorPack::default()
    };
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

/// The demo's two lights without markers: a file that leaves its lights out need not have the pack
/// that the markers would name.
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
