//! Every format yields the same solid, equal to the last bit.

use std::path::Path;

use glam::DVec3;

use super::solid::{all, embedded_gltf, gltf_bytes, gltf_json, icosahedron};
use super::{Sample, is_mesh_file, read_mesh_file};

#[test]
fn every_format_gives_the_same_mesh() {
    let (points, faces) = icosahedron();
    let mesh = Sample::new("m.obj", super::solid::obj()).triangles();
    assert_eq!((mesh.points().len(), mesh.faces().len()), (12, 20));
    for (face, from) in mesh.faces().iter().zip(&faces) {
        let places = face.map(|index| mesh.points()[index as usize]);
        let [a, c, b] = from.map(|index| DVec3::from_array(points[index as usize].map(f64::from)));
        assert_eq!(places, [a, b, c]);
        // Clockwise: the normal by the right-hand rule points inwards.
        let [a, b, c] = places;
        assert!((b - a).cross(c - a).dot(a) < 0.0);
    }
    for (name, bytes) in all() {
        let sample = Sample::new(name, bytes);
        assert!(is_mesh_file(&sample.path), "{name}");
        assert_eq!(sample.triangles(), mesh, "{name}");
        assert_eq!(sample.parts().len(), 1, "{name}");
    }
    assert!(!is_mesh_file(Path::new("m.obj.gz")) && !is_mesh_file(Path::new("obj")));
}

#[test]
fn parts_are_named_after_what_the_file_says_or_the_file() {
    let names = all().into_iter().map(|(name, bytes)| {
        let parts = Sample::new(name, bytes).parts();
        parts[0].name.clone()
    });
    let names: Vec<_> = names.collect();
    let expected = [
        "m",
        "ico sahedron",
        "binary",
        "m",
        "little",
        "big",
        "ico",
        "ico",
    ];
    assert_eq!(names, expected);
}

#[test]
fn nodes_move_turn_and_mirror_their_meshes() {
    let plain = Sample::new("m.gltf", embedded_gltf("")).triangles();
    let moved = |node: &str| Sample::new("m.gltf", embedded_gltf(node)).triangles();
    let same = |node: &str, place: &dyn Fn(DVec3) -> DVec3| {
        let mesh = moved(node);
        for (found, from) in mesh.points().iter().zip(plain.points()) {
            assert!((found - place(*from)).length() < 1e-7, "{node}");
        }
        mesh.faces().to_vec()
    };
    let faces = same(r#","translation":[1,2,3],"scale":[2,2,2]"#, &|p| {
        2.0 * p + DVec3::new(1.0, 2.0, 3.0)
    });
    assert_eq!(faces, plain.faces());
    // A quarter turn about z.
    let turn = r#","rotation":[0,0,0.70710678,0.70710678]"#;
    same(turn, &|p| DVec3::new(-p.y, p.x, p.z));
    let mirror = r#","matrix":[-1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]"#;
    let mirrored = moved(mirror);
    for face in mirrored.faces() {
        let [a, b, c] = face.map(|index| mirrored.points()[index as usize]);
        assert!((b - a).cross(c - a).dot(a) < 0.0, "still clockwise");
    }
}

#[test]
fn buffers_lie_in_the_file_beside_it_or_behind_its_json() {
    let json = gltf_json("", r#","uri":"a%20b.bin""#);
    let sample = Sample::new("m.gltf", json);
    let missing = sample.error();
    assert!(
        missing.starts_with("m.gltf: cannot read its buffer a b.bin: "),
        "{missing}"
    );
    sample.beside("a b.bin", gltf_bytes());
    let colors = sample.parts()[0].colors.clone().expect("colours");
    assert_eq!(colors.name, "gold");
    assert_eq!((colors.diffuse[0], colors.diffuse[2]), (1.0, 0.0));
    // The separators of another system work, too.
    let sample = Sample::new("m.gltf", gltf_json("", r#","uri":".%5Ca%20b.bin""#));
    sample.beside("a b.bin", gltf_bytes());
    assert_eq!(sample.parts().len(), 1);
    // Half of the light takes more than half of the sRGB value.
    assert!((colors.diffuse[1] - 0.735_36).abs() < 1e-4);
}

#[test]
fn nothing_beside_the_folder_is_read() {
    let outside = Sample::new("b.bin", gltf_bytes());
    outside.beside("c.mtl", "newmtl red\nKd 1 0 0\n");
    let folder = outside.folder.path().join("in");
    std::fs::create_dir(&folder).expect("a folder");
    let place = |name: &str, text: String| {
        let path = folder.join(name);
        std::fs::write(&path, text).expect("written");
        path
    };
    let absolute = outside.path.display();
    for name in ["../b.bin".to_owned(), absolute.to_string()] {
        let path = place("m.gltf", gltf_json("", &format!(r#","uri":"{name}""#)));
        let error = read_mesh_file(&path).expect_err("refused").to_string();
        assert!(
            error.contains("must be in the folder of the file"),
            "{error}"
        );
    }
    for name in ["../c.mtl", "..\\c.mtl"] {
        let text = format!("mtllib {name}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n");
        let parts = read_mesh_file(&place("m.obj", text)).expect("a mesh").parts;
        assert_eq!(parts[0].colors, None, "{name}");
    }
}
