//! glTF and GLB: the triangles of the default scene, transformed by its nodes.

use std::borrow::Cow;
use std::path::Path;

use glam::{DMat4, DQuat, Vec3};
use gltf::json::mesh::MorphTarget;
use gltf::json::validation::Checked;
use gltf::json::{Index, Root};
use gltf::material::AlphaMode;
use gltf::mesh::{Mode, Primitive};
use gltf::scene::Transform;
use gltf::{Document, Glb, Material, Node, Semantic};

use super::error::Fault;
use super::gltf_buffers::Buffers;
use super::gltf_skin::Placement;
use super::limits::{check, check_faces, check_groups, check_points};
use super::part::{
    MeshFile, NOTE_EMISSIVE, NOTE_POINT_COLORS, NOTE_TEXTURES, NOTE_TRANSPARENT, Part, PartColors,
};
use super::polygon::{fan, strip};
use super::triangles::Triangles;

/// Most objects and lists in the JSON: each can cost hundreds of bytes of memory.
const MAX_OBJECTS: usize = 1_000_000;
/// The points that are read may exceed the limit on points by this factor, because primitives may share an accessor.
const MAX_SCANS: usize = 100;
/// Extensions without which the triangles cannot be read.
const GEOMETRY_EXTENSIONS: [&str; 4] = [
    INSTANCES,
    "KHR_draco_mesh_compression",
    "EXT_meshopt_compression",
    "KHR_meshopt_compression",
];
/// The extension that draws a node in several places.
const INSTANCES: &str = "EXT_mesh_gpu_instancing";

/// Reads the primitives of the default scene; without one, of the first scene; without any, of all nodes.
pub(super) fn read(bytes: &[u8], folder: &Path, stem: &str) -> Result<MeshFile, Fault> {
    let (json, chunk) = split(bytes)?;
    let (document, has_animations) = document_of(&json)?;
    let buffers = Buffers::load(&document, chunk.as_deref(), folder)?;
    let mut walk = Walk {
        buffers,
        stem,
        parts: Vec::new(),
        points: 0,
        scanned: 0,
        faces: 0,
    };
    let mut visited = vec![false; document.nodes().len()];
    let mut transforms = vec![DMat4::IDENTITY; document.nodes().len()];
    let mut visited_nodes = Vec::new();
    let roots = roots(&document).into_iter();
    let mut stack: Vec<_> = roots.map(|node| (node, DMat4::IDENTITY)).collect();
    // The first node goes on top of the stack.
    stack.reverse();
    while let Some((node, outer)) = stack.pop() {
        let index = node.index();
        // A node that is its own ancestor would be followed for ever.
        if std::mem::replace(&mut visited[index], true) {
            return Err(Fault::new(format!(
                "node {index} is in the scene more than once"
            )));
        }
        let transform = outer * matrix_of(&node);
        transforms[index] = transform;
        let start = stack.len();
        stack.extend(node.children().map(|child| (child, transform)));
        stack[start..].reverse();
        visited_nodes.push(node);
    }
    for node in &visited_nodes {
        walk.add(node, &transforms)?;
    }
    Ok(MeshFile {
        parts: walk.parts,
        notes: notes(&document, has_animations),
    })
}

/// The root nodes of the scene that is read.
fn roots(document: &Document) -> Vec<Node<'_>> {
    let scene = document.default_scene();
    if let Some(scene) = scene.or_else(|| document.scenes().next()) {
        return scene.nodes().collect();
    }
    let mut is_child = vec![false; document.nodes().len()];
    for child in document.nodes().flat_map(|node| node.children()) {
        is_child[child.index()] = true;
    }
    let nodes = document.nodes();
    nodes.filter(|node| !is_child[node.index()]).collect()
}

/// Notes on what is in a file but is not read.
fn notes(document: &Document, has_animations: bool) -> Vec<String> {
    let primitives = || document.meshes().flat_map(|mesh| mesh.primitives());
    let has_colors = |one: Primitive| one.get(&Semantic::Colors(0)).is_some();
    let uses = |extension| document.extensions_used().any(|name| name == extension);
    let is_transparent = |material: &Material| {
        let [.., alpha] = material.pbr_metallic_roughness().base_color_factor();
        material.alpha_mode() != AlphaMode::Opaque && alpha < 1.0
    };
    let is_emissive = |material: &Material| material.emissive_factor() != [0.0; 3];
    [
        (document.materials().any(|material| is_transparent(&material)), NOTE_TRANSPARENT),
        (document.materials().any(|material| is_emissive(&material)), NOTE_EMISSIVE),
        (primitives().any(has_colors), NOTE_POINT_COLORS),
        (
            primitives().any(|one| one.morph_targets().len() > 0),
            "its morph targets are left out",
        ),
        (document.textures().len() > 0, NOTE_TEXTURES),
        (document.cameras().len() > 0, "its cameras are left out"),
        (uses("KHR_lights_punctual"), "its lights are left out"),
        (has_animations, "its animations are left out"),
        (
            uses("KHR_materials_pbrSpecularGlossiness"),
            "some of its colours are left out: KHR_materials_pbrSpecularGlossiness is not supported",
        ),
        (
            uses("KHR_node_visibility"),
            "parts hidden by KHR_node_visibility are shown",
        ),
        (
            uses(INSTANCES),
            "meshes repeated by EXT_mesh_gpu_instancing appear only once",
        ),
    ]
    .into_iter()
    .filter(|(applies, _)| *applies)
    .map(|(_, note)| note.to_owned())
    .collect()
}

type Chunks<'a> = (Cow<'a, [u8]>, Option<Cow<'a, [u8]>>);

/// Returns the JSON, and the binary chunk if this is a GLB file.
fn split(bytes: &[u8]) -> Result<Chunks<'_>, Fault> {
    if !bytes.starts_with(b"glTF") {
        return Ok((Cow::Borrowed(bytes), None));
    }
    // The crate subtracts the header from this length without a check.
    let length = bytes.get(8..).and_then(<[u8]>::first_chunk);
    let length = length.map_or(0, |length| u32::from_le_bytes(*length) as usize);
    if length < 20 || length > bytes.len() {
        return Err(Fault::new(format!(
            "the header declares {length} bytes, but the file has {}",
            bytes.len()
        )));
    }
    let glb = Glb::from_slice(&bytes[..length])
        .map_err(|error| Fault::new(format!("not a valid GLB file: {error}")))?;
    Ok((glb.json, glb.bin))
}

/// Parses and validates the JSON; also returns whether the file has animations.
fn document_of(json: &[u8]) -> Result<(Document, bool), Fault> {
    let objects = json.iter().filter(|&&byte| byte == b'{' || byte == b'[');
    check("objects and lists", objects.count(), MAX_OBJECTS)?;
    let (mut root, has_animations) = root_of(json)?;
    root.animations.clear();
    // Required extensions for materials, lights or images do not prevent reading the triangles.
    let is_needed = |name: &String| GEOMETRY_EXTENSIONS.contains(&name.as_str());
    if let Some(name) = root.extensions_required.iter().find(|name| is_needed(name)) {
        return Err(Fault::new(format!(
            "its triangles need {name}, which is not supported"
        )));
    }
    root.extensions_required.clear();
    prepare_primitives(&mut root)?;
    let document = Document::from_json(root).map_err(|error| {
        let gltf::Error::Validation(errors) = &error else {
            return Fault::new(format!("not a valid glTF file: {error}"));
        };
        let first = errors.first();
        let message = first.map(|(path, error)| format!("{path}: {error}"));
        Fault::new(format!(
            "not a valid glTF file: {}",
            message.unwrap_or_default()
        ))
    })?;
    Ok((document, has_animations))
}

/// Parses the JSON without validating it; also returns whether the file has animations. Animations may use features
/// that the crate does not know, such as pointers; if they are why parsing fails, they are removed.
fn root_of(json: &[u8]) -> Result<(Root, bool), Fault> {
    let error = match Root::from_slice(json) {
        Ok(root) => {
            let has_animations = !root.animations.is_empty();
            return Ok((root, has_animations));
        }
        Err(error) => error,
    };
    let values = serde_json::from_slice::<serde_json::Map<_, _>>(json);
    let mut values = values.unwrap_or_default();
    let version = values
        .get("asset")
        .and_then(|asset| asset["version"].as_str());
    if version.is_some_and(|version| version.starts_with("1.")) {
        let sentence = "this is a glTF file of version 1; only version 2 is supported";
        return Err(Fault::new(sentence));
    }
    if values.remove("animations").is_some()
        && let Ok(root) = serde_json::from_value(values.into())
    {
        return Ok((root, true));
    }
    let message = error.to_string();
    let why = message
        .rsplit_once(" at line ")
        .map_or(&*message, |(why, _)| why);
    let sentence = format!("not a valid glTF file: {why}");
    Err(Fault::in_line(error.line(), sentence))
}

/// Works around the `gltf` crate: it panics if the accessor of positions is missing, and refuses positions without
/// bounds, which are not needed here and which some exporters omit. It also refuses primitives without positions,
/// application-specific attributes, and morph targets without data, which stand for zeros; all of this is legal, and
/// morph targets are left out.
fn prepare_primitives(root: &mut Root) -> Result<(), Fault> {
    let primitives = root.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let targets = primitives.filter_map(|primitive| primitive.targets.as_ref());
    let offsets = targets.flatten().flat_map(|target| {
        let MorphTarget {
            positions,
            normals,
            tangents,
        } = target;
        [*positions, *normals, *tangents]
    });
    for index in offsets.flatten() {
        if let Some(accessor) = root.accessors.get_mut(index.value())
            && accessor.sparse.is_none()
        {
            accessor.buffer_view.get_or_insert(Index::new(0));
        }
    }
    for mesh in &mut root.meshes {
        for primitive in &mut mesh.primitives {
            let is_known = |semantic: &Checked<_>| matches!(semantic, Checked::Valid(_));
            primitive
                .attributes
                .retain(|semantic, _| is_known(semantic));
        }
        let positions = Checked::Valid(Semantic::Positions);
        mesh.primitives
            .retain(|primitive| primitive.attributes.contains_key(&positions));
    }
    let primitives = root.meshes.iter().flat_map(|mesh| &mesh.primitives);
    for primitive in primitives {
        let positions = Checked::Valid(Semantic::Positions);
        let Some(index) = primitive.attributes.get(&positions) else {
            continue;
        };
        let index = index.value();
        let Some(accessor) = root.accessors.get_mut(index) else {
            return Err(Fault::new(format!(
                "a mesh has its positions in accessor {index}, which does not exist"
            )));
        };
        accessor.min = Some(vec![0.0; 3].into());
        accessor.max = Some(vec![0.0; 3].into());
    }
    Ok(())
}

fn matrix_of(node: &Node) -> DMat4 {
    match node.transform() {
        Transform::Matrix { matrix } => {
            DMat4::from_cols_array_2d(&matrix.map(|c| c.map(f64::from)))
        }
        Transform::Decomposed {
            translation,
            rotation,
            scale,
        } => {
            let rotation = DQuat::from_array(rotation.map(f64::from));
            let is_rotation = rotation.length_squared() > 0.0;
            DMat4::from_scale_rotation_translation(
                Vec3::from(scale).as_dvec3(),
                // A quaternion in single precision is not exactly of unit length.
                if is_rotation {
                    rotation.normalize()
                } else {
                    DQuat::IDENTITY
                },
                Vec3::from(translation).as_dvec3(),
            )
        }
    }
}

/// State of the walk through the nodes.
struct Walk<'a> {
    buffers: Buffers<'a>,
    stem: &'a str,
    parts: Vec<Part>,
    points: usize,
    /// Points that were read for the parts, including those of shared accessors that a part does not use.
    scanned: usize,
    faces: usize,
}

impl Walk<'_> {
    fn add(&mut self, node: &Node, transforms: &[DMat4]) -> Result<(), Fault> {
        let Some(mesh) = node.mesh() else {
            return Ok(());
        };
        let placement = match node.skin() {
            Some(skin) => {
                // Many nodes may share a skin.
                let matrices = skin.inverse_bind_matrices().map_or(0, |all| all.count());
                let joints = skin.joints().count();
                self.scanned = self.scanned.saturating_add(joints.max(matrices));
                check_points(self.scanned / MAX_SCANS)?;
                Placement::of_skin(&skin, transforms, &self.buffers)?
            }
            None => Placement::Whole(transforms[node.index()]),
        };
        let name = node.name().or(mesh.name()).unwrap_or(self.stem);
        for primitive in mesh.primitives() {
            let mode = primitive.mode();
            if !matches!(
                mode,
                Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan
            ) {
                continue;
            }
            let triangles = self.triangles(&primitive, mode, &placement)?;
            check_groups(self.parts.len() + 1)?;
            self.parts.push(Part {
                name: name.to_owned(),
                colors: colors_of(&primitive.material()),
                triangles,
            });
        }
        Ok(())
    }

    fn triangles(
        &mut self,
        primitive: &Primitive,
        mode: Mode,
        placement: &Placement,
    ) -> Result<Triangles, Fault> {
        let Some(accessor) = primitive.get(&Semantic::Positions) else {
            return Ok(Triangles::default());
        };
        let corners = primitive
            .indices()
            .map_or(accessor.count(), |indices| indices.count());
        // Many nodes may show the same mesh, so a small file can be a large scene. If primitives share an accessor,
        // each counts for the points that it uses, and for those that are scanned to find them.
        self.points = self.points.saturating_add(corners.min(accessor.count()));
        self.scanned = self.scanned.saturating_add(accessor.count());
        check_points(self.scanned / MAX_SCANS)?;
        self.faces = self.faces.saturating_add(match mode {
            Mode::Triangles => corners / 3,
            _ => corners.saturating_sub(2),
        });
        check_points(self.points)?;
        check_faces(self.faces)?;
        let points = self.buffers.positions(&accessor)?;
        let corners = match primitive.indices() {
            Some(indices) => self.buffers.indices(&indices)?,
            None => (0..points.len() as u32).collect(),
        };
        let mut faces = triangles_of(&corners, mode);
        // A reflection turns faces inside out; two reflections cancel out.
        if placement.is_mirror() {
            for [_, b, c] in &mut faces {
                std::mem::swap(b, c);
            }
        }
        let skin_weights = placement.read_weights(primitive, points.len(), &self.buffers)?;
        let position = |index: usize| {
            let point = Vec3::from(points[index]).as_dvec3();
            placement.position(point, index, skin_weights.as_ref())
        };
        Triangles::weld(points.len(), position, faces.into_iter())
    }
}

fn triangles_of(corners: &[u32], mode: Mode) -> Vec<[u32; 3]> {
    match mode {
        Mode::TriangleStrip => strip(corners).collect(),
        Mode::TriangleFan => fan(corners).collect(),
        _ => corners.as_chunks().0.to_vec(),
    }
}

fn colors_of(material: &Material) -> Option<PartColors> {
    // The default material is not in the file.
    let index = material.index()?;
    let [red, green, blue, _] = material.pbr_metallic_roughness().base_color_factor();
    Some(PartColors {
        name: material
            .name()
            .map_or_else(|| format!("material {index}"), str::to_owned),
        diffuse: [red, green, blue].map(|channel| srgb_of(channel.into())),
        specular: None,
        exponent: None,
        reflective: false,
    })
}

/// Converts linear light to sRGB.
fn srgb_of(light: f64) -> f64 {
    match light {
        ..=0.0 => 0.0,
        ..=0.003_130_8 => 12.92 * light,
        ..1.0 => 1.055 * light.powf(1.0 / 2.4) - 0.055,
        _ => 1.0,
    }
}
