//! Files that are not what they claim are refused with a message, before they use up memory.

use std::path::Path;

use super::solid::{
    binary_ply, binary_stl, embedded_gltf, glb, gltf_json, ply_header, text_ply, text_stl,
};
use super::{MeshError, Sample, error_of, read_mesh_file};

#[test]
fn files_that_are_not_there_or_not_meshes() {
    let error = read_mesh_file(Path::new("/nowhere/m.obj")).expect_err("an error");
    assert!(matches!(error, MeshError::Disk { .. }), "{error}");
    assert!(
        error
            .to_string()
            .starts_with("cannot read /nowhere/m.obj: ")
    );
    let sample = Sample::new("m.txt", "");
    assert_eq!(
        sample.error(),
        "m.txt: not a mesh file; their names end in .obj, .stl, .ply, .gltf or .glb"
    );
    let folder = sample.folder.path().join("m.stl");
    std::fs::create_dir(&folder).expect("a folder");
    let error = read_mesh_file(&folder).expect_err("an error").to_string();
    assert!(error.ends_with("is not a file"), "{error}");
}

#[test]
fn files_that_are_too_large_are_not_read() {
    let sample = Sample::new("m.stl", "");
    // A sparse file takes no space on disk.
    let file = std::fs::File::create(&sample.path).expect("a file");
    file.set_len((2 << 30) + 1).expect("a long file");
    assert_eq!(
        sample.error(),
        "m.stl: a mesh file may have at most 2147483648 bytes; this one has more"
    );
    let many = "g\n".repeat(1_000_001);
    assert_eq!(
        error_of("m.obj", many),
        "m.obj: a mesh may have at most 1000000 groups; this one has more"
    );
    let polygon = format!("v 0 0 0\nf{}", " 1".repeat(16_000_003));
    assert_eq!(
        error_of("m.obj", polygon),
        "m.obj: a mesh may have at most 16000000 faces; this one has more"
    );
}

#[test]
fn broken_stl() {
    assert_eq!(
        error_of("m.stl", &binary_stl()[..700]),
        "m.stl: the header declares 20 triangles, which take 1084 bytes, but the file ends after 700"
    );
    let mut binary = binary_stl();
    binary[..80].fill(0);
    assert_eq!(
        error_of("m.stl", &binary[..700]),
        "m.stl: the header declares 20 triangles, which take 1084 bytes, but the file ends after 700"
    );
    binary[80..84].fill(255);
    let cut = error_of("m.stl", &binary[..700]);
    assert!(cut.contains("declares 4294967295 triangles"), "{cut}");
    assert!(error_of("m.stl", "").contains("too short"));
    let text = text_stl();
    assert_eq!(
        error_of("m.stl", &text[..text.len() / 2]),
        "m.stl:70: expected endloop"
    );
    assert_eq!(
        error_of("m.stl", text.replacen("vertex", "vertex x", 1)),
        "m.stl:4: error while parsing a float"
    );
    assert_eq!(
        error_of("m.stl", "solid a\nendsolid a\n"),
        "m.stl: this file has no faces with an area"
    );
    let mut binary = binary_stl();
    binary[96..100].copy_from_slice(&f32::NAN.to_le_bytes());
    assert_eq!(
        error_of("m.stl", binary),
        "m.stl: point 0, counted from 0, has a coordinate that is not a finite number within 1e12 of 0"
    );
}

#[test]
fn broken_ply() {
    let text = text_ply();
    let bytes = binary_ply(false);
    for (bytes, sentence) in [
        (
            b"plywood".to_vec(),
            ":1: this is not a valid line of a PLY header",
        ),
        (
            b"solid".to_vec(),
            ": not a PLY file: it does not begin with `ply`",
        ),
        (
            b"ply\nformat ascii 1.0\n".to_vec(),
            ": the header has no `end_header`",
        ),
        (
            text.replace("float x", "float q").into(),
            ": the element `vertex` in the header has no number `x`",
        ),
        (
            text.replace("vertex_index", "corners").into(),
            ": the element `face` in the header has no list `vertex_indices` or `vertex_index`",
        ),
        (
            text.replace("\n3 0 ", "\n3 12 ").into(),
            ":24: face 1 names point 12, but there are only 12, counted from 0",
        ),
        (
            text.replace("\n3 0 ", "\n3 -1 ").into(),
            ":24: face 1 names point -1, but there are only 12, counted from 0",
        ),
        (
            text.replace("\n3 0 ", "\n3 zero ").into(),
            ":24: \"zero\" is not a number for vertex_index of this face",
        ),
        (
            text.replace("\n3 0 ", "\n4 0 ").into(),
            ":24: the face ends before its vertex_index",
        ),
        (
            text.replace("vertex 12", "vertex 99999999999").into(),
            ": a mesh may have at most 48000000 points; this one has more",
        ),
        (
            text.replace("face 20", "face 15000000").into(),
            ": the header declares 15000000 of `face`, which take at least 30000000 bytes, but the file has 170 left",
        ),
        (
            bytes[..bytes.len() - 1].to_vec(),
            ": the file ends within face 20 of 20",
        ),
    ] {
        assert_eq!(error_of("m.ply", bytes), format!("m.ply{sentence}"));
    }
    // A list that claims four billion corners.
    let header = ply_header("binary_little_endian", "float", "vertex_indices");
    let list = header.replace("list uchar", "list uint");
    let long = [list.as_bytes(), &[0; 12 * 13], &[255; 100]].concat();
    assert_eq!(
        error_of("m.ply", long),
        "m.ply: the file ends within face 1 of 20"
    );
}

#[test]
fn broken_gltf() {
    let json = embedded_gltf("");
    for (from, to, sentence) in [
        (
            "\"scene\":0",
            "\"scene\":7",
            ": not a valid glTF file: scene: Index out of bounds",
        ),
        (
            "\"scene\":0",
            "\"scene\"0",
            ":1: not a valid glTF file: expected `:`",
        ),
        (
            "\"count\":60",
            "\"count\":6000",
            ": accessor 1 declares 6000 items of 2 bytes, more than its buffer holds",
        ),
        (
            "\"count\":12",
            "\"count\":4",
            ": face 2 names point 7, but there are only 4, counted from 0",
        ),
        (
            "\"count\":12",
            "\"count\":18446744073709551615",
            ": a mesh may have at most 48000000 points; this one has more",
        ),
        (
            "\"POSITION\":0",
            "\"POSITION\":9",
            ": a mesh has its positions in accessor 9, which does not exist",
        ),
        (
            "5123",
            "5126",
            ": accessor 1 holds indices that are not whole numbers",
        ),
        (
            "5126",
            "5121",
            ": accessor 0 holds positions that are not three floats each",
        ),
        (
            "\"byteOffset\":144",
            "\"byteOffset\":18446744073709551615",
            ": accessor 1 declares 60 items of 2 bytes, more than its buffer holds",
        ),
        (
            ";base64,",
            ";base64,*",
            ": an embedded buffer is broken: Invalid symbol 42, offset 0.",
        ),
        ("data:app", "https://app", ": its buffer https://app"),
        (
            "\"mesh\":0,",
            "\"mesh\":0,\"children\":[0],",
            ": node 0 is in the scene more than once",
        ),
    ] {
        let error = error_of("m.gltf", json.replacen(from, to, 1));
        assert!(error.starts_with(&format!("m.gltf{sentence}")), "{error}");
    }
    let mut bytes = glb(&gltf_json("", ""), &[0; 264]);
    assert_eq!(
        error_of("m.glb", &bytes),
        "m.glb: this file has no faces with an area"
    );
    assert!(error_of("m.glb", &bytes[..50]).contains("but the file has 50"));
    bytes[8..12].fill(0);
    assert!(error_of("m.glb", &bytes).contains("the header declares 0 bytes"));
    let none = error_of("m.gltf", gltf_json("", ""));
    assert_eq!(
        none,
        "m.gltf: accessor 0 names a buffer that does not exist"
    );
}
