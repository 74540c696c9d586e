//! Peculiarities of STL, PLY and glTF files.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use glam::DVec3;

use super::solid::{binary_stl, embedded_gltf, gltf_with, text_stl};
use super::{Sample, marks_of_mesh};

/// Programs that write in one pass do not know the number of triangles in advance, and leave a placeholder.
#[test]
fn stl_files_without_a_number_are_as_long_as_they_are() {
    let expected = Sample::new("m.stl", binary_stl()).triangles();
    for count in [0, u32::MAX] {
        let mut binary = binary_stl();
        binary[80..84].copy_from_slice(&count.to_le_bytes());
        assert_eq!(
            Sample::new("m.stl", binary).triangles(),
            expected,
            "{count}"
        );
    }
}

#[test]
fn stl_texts_differ() {
    let expected = Sample::new("m.stl", text_stl()).triangles();
    for text in [
        text_stl().to_uppercase(),
        text_stl().replace('\n', "\r\n"),
        text_stl().replace(" ico sahedron", ""),
        text_stl().replace("ico", "icö"),
        format!("\n {}", text_stl()),
    ] {
        let triangles = Sample::new("m.stl", &text).triangles();
        assert!(triangles == expected, "{text}");
    }
    // For a triangle without area, some programs write a normal that is not a number.
    let normal = text_stl()
        .lines()
        .find(|line| line.contains("normal"))
        .map(str::to_owned);
    let normal = normal.expect("a normal");
    for none in ["-nan(ind) -nan(ind) -nan(ind)", "-1.#IND 1.#QNAN 0", "0 0"] {
        let text = text_stl().replacen(normal.trim(), &format!("facet normal {none}"), 1);
        assert!(text != text_stl());
        let read = super::read_triangles(&Sample::new("m.stl", &text).path);
        assert_eq!(
            read.ok().as_ref() == Some(&expected),
            none != "0 0",
            "{none}"
        );
    }
    // Two solids become one part with the name of the first.
    let other = "solid b\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid b\n";
    let parts = Sample::new("m.stl", text_stl() + other).parts();
    assert_eq!(parts.len(), 1);
    assert_eq!(parts[0].triangles.faces().len(), 21);
    let unnamed = text_stl().replace(" ico sahedron", "") + &other.replace(" b\n", "\n");
    assert_eq!(Sample::new("m.stl", unnamed).triangles().faces().len(), 21);
    // Some programs append data after the triangles.
    let longer = [binary_stl(), b"behind".to_vec()].concat();
    let header: Vec<u8> = [vec![0; 80], longer[80..].to_vec()].concat();
    assert_eq!(Sample::new("m.stl", header.clone()).triangles(), expected);
    // If the data is long enough for a triangle, there is a note.
    let notes = |more: usize| {
        let bytes = [header.clone(), vec![0; more]].concat();
        Sample::new("m.stl", bytes).notes().concat()
    };
    assert_eq!(notes(10), "");
    assert!(notes(60).contains("66 bytes after the 20 triangles"));
}

#[test]
fn points_of_stl_texts_have_all_their_decimals() {
    let far = "\u{feff}solid a\nfacet normal 0 0 1\nouter loop\nvertex 500000.123456789 5400000.25 0\nvertex 500001.123456789 5400000.25 0\nvertex 500000.123456789 5400001.25 1e-3\nendloop\nendfacet\nendsolid a\n";
    let triangles = Sample::new("m.stl", far).triangles();
    let first = triangles.points()[0];
    assert_eq!(first.to_array(), [500_000.123_456_789, 5_400_000.25, 0.0]);
}

#[test]
fn numbers_of_ply_texts_that_nobody_asks_for_may_be_none() {
    let header = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
    let body = "0 0 0 -nan(ind)\n1 0 0 0\n0 1 0 0\n3 0 1 2\n";
    let triangles = Sample::new("m.ply", format!("\u{feff}{header}{body}")).triangles();
    assert_eq!(triangles.faces().len(), 1);
    let error = Sample::new(
        "m.ply",
        format!("{header}{}", body.replace("1 0 0", "1 a 0")),
    )
    .error();
    assert!(error.contains("\"a\" is not a number for y"), "{error}");
}

#[test]
fn ply_polygons_become_fans() {
    let header = "ply\r\nformat ascii 1.0\r\ncomment é\r\nelement face 3\r\nproperty uchar flags\r\nproperty list uint8 uint32 vertex_index\r\nelement edge 1\r\nproperty list int int other\r\nelement vertex 5\r\nproperty double z\r\nproperty double y\r\nproperty double x\r\nend_header\r\n";
    let body = "9 5 0 1 2 3 4\r\n\r\n9 3 0 0 1\r\n9 2 0 1\r\n2 8 8\r\n0 .5 0\r\n0 0. 1\r\n0 1e0 2\r\n0 2 1\r\n0 2 0";
    let latin: Vec<u8> = format!("{header}{body}").chars().map(|c| c as u8).collect();
    let parts = Sample::new("five.ply", latin).parts();
    assert_eq!(parts[0].name, "five");
    let mesh = &parts[0].triangles;
    assert_eq!(mesh.faces(), [[0, 2, 1], [0, 3, 2], [0, 4, 3]]);
    assert_eq!(mesh.points()[0].to_array(), [0.0, 0.5, 0.0]);
    assert_eq!(mesh.points()[2].to_array(), [2.0, 1.0, 0.0]);
}

#[test]
fn ply_strips_are_triangles() {
    let header = "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n";
    let points = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n";
    let mesh = Sample::new("m.ply", format!("{header}{points}8 0 1 2 3 -1 2 3 4\n")).triangles();
    // The second triangle of a strip is turned over, so that all have the same orientation: clockwise, as in a mesh.
    assert_eq!(mesh.faces(), [[0, 2, 1], [2, 3, 1], [2, 4, 3]]);
    let error = Sample::new("m.ply", format!("{header}{points}4 0 1 2 9\n")).error();
    assert!(error.contains('9'), "{error}");
}

#[test]
fn what_is_only_about_looks_or_programs_does_not_keep_gltf_from_being_read() {
    let json = embedded_gltf("");
    let expected = Sample::new("m.gltf", &json).triangles();
    // An image in a format of an extension, and an animation of a texture.
    let texture = gltf_with(r#""textures":[{"extensions":{"EXT_texture_webp":{"source":0}}}]"#);
    let pointer = gltf_with(
        r#""animations":[{"channels":[{"sampler":0,"target":{"path":"pointer"}}],"samplers":[]}]"#,
    );
    let pointed = gltf_with(
        r#""animations":[{"channels":[{"sampler":0,"target":{"node":0,"path":"pointer"}}],"samplers":[]}]"#,
    );
    let attribute = json.replacen(r#""POSITION":0"#, r#""POSITION":0,"_BATCHID":0"#, 1);
    let pointless = json.replacen(
        r#""primitives":["#,
        r#""primitives":[{"attributes":{}},"#,
        1,
    );
    let lights = gltf_with(r#""extensionsUsed":["KHR_lights_punctual"]"#);
    for (text, note) in [
        (texture, Some("its textures are left out")),
        (pointer, Some("its animations are left out")),
        (pointed, Some("its animations are left out")),
        (attribute, None),
        (pointless, None),
        (lights, Some("its lights are left out")),
    ] {
        assert!(text != json);
        let sample = Sample::new("m.gltf", &text);
        assert_eq!(sample.triangles(), expected, "{text:.200}");
        assert_eq!(sample.notes(), note.into_iter().collect::<Vec<_>>());
    }
    let broken = json.replacen(r#""meshes":["#, r#""animations":3,"meshes":7,"more":["#, 1);
    let error = Sample::new("m.gltf", broken).error();
    assert!(error.contains("not a valid glTF file"), "{error}");
}

#[test]
fn what_gltf_and_mtl_files_show_otherwise_is_told() {
    let looks = r#"{"alphaMode":"BLEND","emissiveFactor":[1,1,0.8],"name":"gold""#;
    let gltf = gltf_with(r#""extensionsUsed":["KHR_node_visibility"]"#)
        .replace(r#"{"name":"gold""#, looks)
        .replace("[1,0.5,0,1]", "[1,0.5,0,0.1]");
    let notes = Sample::new("m.gltf", &gltf).notes().join("; ");
    let obj = "mtllib m.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let sample = Sample::new("m.obj", obj);
    sample.beside("m.mtl", "newmtl a\nKd 1 0 0\nd 0.1\nKe 1 1 1\n");
    for notes in [&notes, &sample.notes().join("; ")] {
        assert!(
            notes.contains("transparent") && notes.contains("glowing"),
            "{notes}"
        );
    }
    assert!(notes.contains("KHR_node_visibility"), "{notes}");
    let old = r#"{"asset":{"version":"1.0"},"meshes":{"a":{}}}"#;
    let error = Sample::new("m.gltf", old).error();
    assert!(error.contains("version 1;"), "{error}");
}

#[test]
fn strips_and_fans_of_gltf_are_triangles() {
    // The first corners also form a valid strip and a valid fan.
    let count = |mode: &str, count: &str| {
        let json = embedded_gltf("")
            .replace(r#""indices":1"#, &format!(r#""indices":1,"mode":{mode}"#))
            .replace(r#""count":60"#, &format!(r#""count":{count}"#));
        let sample = Sample::new("m.gltf", json);
        super::read_triangles(&sample.path).map(|mesh| mesh.faces().len())
    };
    assert_eq!(count("4", "60").expect("a mesh"), 20);
    assert_eq!(count("5", "3").expect("a mesh"), 1);
    assert_eq!(count("6", "3").expect("a mesh"), 1);
    assert!(count("1", "60").is_err(), "lines are no faces");
}

#[test]
fn extensions_about_looks_do_not_matter() {
    let with = |name: &str| {
        let required = format!(r#""extensionsRequired":["{name}"]"#);
        Sample::new("m.gltf", gltf_with(&required))
    };
    assert_eq!(with("KHR_materials_unlit").triangles().faces().len(), 20);
    assert_eq!(
        with("KHR_draco_mesh_compression").error(),
        "m.gltf: its triangles need KHR_draco_mesh_compression, which is not supported"
    );
}

#[test]
fn morph_targets_without_data_are_left_out_like_others() {
    let json = embedded_gltf("");
    let expected = Sample::new("m.gltf", &json).triangles();
    let zeros = r#""accessors":[{"componentType":5126,"type":"VEC3","count":12},"#;
    let with = json
        .replace(r#""accessors":["#, zeros)
        .replace(r#""POSITION":0"#, r#""POSITION":1"#)
        .replace(
            r#""indices":1"#,
            r#""indices":2,"targets":[{"POSITION":0}]"#,
        );
    let sample = Sample::new("m.gltf", with);
    assert_eq!(sample.triangles(), expected);
    assert_eq!(sample.notes(), ["its morph targets are left out"]);
}

#[test]
fn without_a_scene_all_nodes_are_shown() {
    let json = embedded_gltf("");
    let expected = Sample::new("m.gltf", &json).triangles();
    let (start, rest) = json.split_once("\"scenes\":[").expect("a scene");
    let (_, rest) = rest.split_once("]}],").expect("its nodes");
    let without = format!("{start}{rest}").replace("\"scene\":0,", "");
    assert_eq!(Sample::new("m.gltf", without).triangles(), expected);
}

#[test]
fn a_gltf_file_is_another_one_once_its_numbers_are_written() {
    let sample = Sample::new("m.gltf", embedded_gltf(""));
    let marks = || marks_of_mesh(&sample.path);
    let alone = marks();
    sample.beside("other.bin", "numbers of another one");
    assert_eq!(marks(), alone);
    sample.beside("m.bin", "half");
    let half = marks();
    assert!(alone.is_some() && half != alone);
    sample.beside("m.bin", "half and half");
    assert_ne!(marks(), half);
}

#[test]
fn what_is_left_out_of_a_file_is_told() {
    let sample = Sample::new("m.gltf", embedded_gltf(""));
    assert!(sample.notes().is_empty());
    let with = gltf_with(
        r#""cameras":[{"type":"orthographic","orthographic":{"xmag":1,"ymag":1,"zfar":2,"znear":1}}]"#,
    );
    assert_eq!(
        Sample::new("m.gltf", with).notes(),
        ["its cameras are left out"]
    );
    let with = gltf_with(r#""extensionsUsed":["EXT_mesh_gpu_instancing"]"#);
    let told = "meshes repeated by EXT_mesh_gpu_instancing appear only once";
    assert_eq!(Sample::new("m.gltf", with).notes(), [told]);
    let header = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
    let notes = Sample::new(
        "m.ply",
        format!("{header}0 0 0 9\n1 0 0 9\n0 1 0 9\n3 0 1 2\n"),
    )
    .notes();
    assert_eq!(notes, ["colours of points or faces are left out"]);
}

/// The sorted corners of a triangle in a glTF file with these bytes as its buffer and these accessors (positions
/// first), views, attributes and further members; the first node shows it.
fn corners(
    bytes: &[u8],
    accessors: &str,
    views: &[(usize, usize)],
    attributes: &str,
    more: &str,
) -> Vec<DVec3> {
    let views = views.iter().map(|(start, length)| {
        format!(r#"{{"buffer":0,"byteOffset":{start},"byteLength":{length}}}"#)
    });
    let views = views.collect::<Vec<_>>().join(",");
    let (text, length) = (STANDARD.encode(bytes), bytes.len());
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"accessors":[{accessors}],"bufferViews":[{views}],
"buffers":[{{"byteLength":{length},"uri":"data:application/octet-stream;base64,{text}"}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0{attributes}}}}}]}}],{more}}}"#
    );
    let triangles = Sample::new("m.gltf", json).triangles();
    let mut corners = triangles.points().to_vec();
    corners.sort_by(|a, b| a.to_array().partial_cmp(&b.to_array()).expect("numbers"));
    corners
}

fn bytes_of(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|x| x.to_le_bytes()).collect()
}

const TRIANGLE: [f32; 9] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
const FLOATS: &str = r#"{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3""#;
const ALONE: &str = r#""nodes":[{"mesh":0}]"#;

#[test]
fn positions_may_be_quantized_or_replaced_one_by_one() {
    let quantized = |kind: u32, bytes: &[u8]| {
        let accessor = format!(
            r#"{{"bufferView":0,"componentType":{kind},"normalized":true,"count":3,"type":"VEC3"}}"#
        );
        let more = r#""extensionsUsed":["KHR_mesh_quantization"],"extensionsRequired":["KHR_mesh_quantization"],"nodes":[{"mesh":0,"scale":[2,2,2]}]"#;
        corners(bytes, &accessor, &[(0, bytes.len())], "", more)
    };
    let expected = [DVec3::ZERO, DVec3::Y * 2.0, DVec3::new(2.0, -2.0, 0.0)];
    let small = [0_i8, 0, 0, 127, -128, 0, 0, 127, 0].map(|n| n.to_le_bytes()[0]);
    assert_eq!(quantized(5120, &small), expected);
    let large = [0_i16, 0, 0, 32767, -32768, 0, 0, 32767, 0].map(i16::to_le_bytes);
    assert_eq!(quantized(5122, large.as_flattened()), expected);

    let bytes = [
        bytes_of(&TRIANGLE),
        vec![2, 0, 0, 0],
        bytes_of(&[0.0, 5.0, 7.0]),
    ]
    .concat();
    let sparse = r#","sparse":{"count":1,"indices":{"bufferView":1,"componentType":5121},"values":{"bufferView":2}}}"#;
    let replaced = corners(
        &bytes,
        &format!("{FLOATS}{sparse}"),
        &[(0, 36), (36, 1), (40, 12)],
        "",
        ALONE,
    );
    assert_eq!(replaced, [DVec3::ZERO, DVec3::new(0.0, 5.0, 7.0), DVec3::X]);
    // All points are zeros except those that are replaced.
    let bytes = [vec![1, 2, 0, 0], bytes_of(&[0.0, 5.0, 7.0, 1.0, 0.0, 0.0])].concat();
    let alone = r#"{"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":2,"indices":{"bufferView":0,"componentType":5121},"values":{"bufferView":1}}}"#;
    let replaced = corners(&bytes, alone, &[(0, 2), (4, 24)], "", ALONE);
    assert_eq!(replaced, [DVec3::ZERO, DVec3::new(0.0, 5.0, 7.0), DVec3::X]);
}

#[test]
fn skins_put_points_where_their_joints_are() {
    // The first point follows one joint, the second the other, the third both.
    let joints = [[0, 1, 0, 0], [1, 0, 0, 0], [0, 1, 0, 0]].concat();
    let weights = [[255, 0, 0, 0], [255, 0, 0, 0], [100, 100, 0, 0]].concat();
    let mut bind = [glam::Mat4::IDENTITY; 2];
    bind[1] = glam::Mat4::from_translation(glam::Vec3::Z);
    let bind = bind.map(|matrix| matrix.to_cols_array()).concat();
    let more_weights = [[0; 4], [0, 255, 0, 0], [0; 4]].concat();
    let bytes = [
        bytes_of(&TRIANGLE),
        joints,
        weights,
        bytes_of(&bind),
        more_weights,
    ]
    .concat();
    let weights_in = |view: u32| {
        format!(
            r#"{{"bufferView":{view},"componentType":5121,"normalized":true,"count":3,"type":"VEC4"}}"#
        )
    };
    let accessors = format!(
        r#"{FLOATS}}},{{"bufferView":1,"componentType":5121,"count":3,"type":"VEC4"}},{},
{{"bufferView":3,"componentType":5126,"count":2,"type":"MAT4"}},{}"#,
        weights_in(2),
        weights_in(4),
    );
    // The transform of the mesh's own node does not matter.
    let more = r#""skins":[{"joints":[1,2],"inverseBindMatrices":3}],
"nodes":[{"mesh":0,"skin":0,"translation":[50,0,0]},{"translation":[10,0,0],"children":[2]},{"translation":[0,20,0]}]"#;
    let views = [(0, 36), (36, 12), (48, 12), (60, 128), (188, 12)];
    let one_set = r#","JOINTS_0":1,"WEIGHTS_0":2"#;
    let found = corners(&bytes, &accessors, &views, one_set, more);
    let expected = [
        DVec3::new(10.0, 0.0, 0.0),
        DVec3::new(10.0, 11.0, 0.5),
        DVec3::new(11.0, 20.0, 1.0),
    ];
    assert_eq!(found, expected);
    // A second set of four: the second point follows the first joint as well.
    let two_sets = r#","JOINTS_0":1,"WEIGHTS_0":2,"JOINTS_1":1,"WEIGHTS_1":4"#;
    let found = corners(&bytes, &accessors, &views, two_sets, more);
    assert_eq!(
        found,
        [expected[0], expected[1], DVec3::new(11.0, 10.0, 0.5)]
    );
}
