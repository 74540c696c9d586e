//! OBJ files as other programs write them, with MTL.

use glam::DVec3;

use super::{PartColors, Sample, error_of};

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

#[test]
fn groups_are_parts_with_colors() {
    let sample = Sample::new(
        "two.obj",
        format!(
            "mtllib my colors.mtl\n{SQUARE}f 1 2 3\no box lid\nusemtl red\nf 1 2 3 4\ng\nusemtl none\nf -4 -3 -2\ng empty\nl 1 2\n"
        ),
    );
    let names = |sample: &Sample| {
        let name = |part: super::Part| (part.name, part.colors.map(|colors| colors.name));
        sample.parts().into_iter().map(name).collect::<Vec<_>>()
    };
    let part = |name: &str, color: Option<&str>| (name.to_owned(), color.map(str::to_owned));
    let plain = [part("two", None), part("box lid", None), part("two", None)];
    assert_eq!(names(&sample), plain, "without the material file");
    sample.beside(
        "my colors.mtl",
        "newmtl red\nKd 1 0.5 0\nKs 2 2 2\nKa 0.1 0.1\nNs 30\nillum 3\nnewmtl none\nKs 1 1 1\n",
    );
    let colored = [
        part("two", None),
        part("box lid", Some("red")),
        part("two", None),
    ];
    assert_eq!(names(&sample), colored);
    let red = sample.parts()[1].colors.clone().expect("colours");
    assert_eq!(red.diffuse, [1.0, 0.5, 0.0]);
    assert_eq!(red.specular, Some([1.0; 3]), "clamped");
    assert_eq!(red.exponent, Some(30.0));
    assert!(red.reflective, "a mirror");
    let all = sample.triangles();
    assert_eq!(
        all.points(),
        [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y]
    );
    // The first triangle occurs in the other parts too.
    assert_eq!(all.faces(), [[0, 2, 1], [0, 3, 2]]);
}

#[test]
fn what_programs_write_is_read() {
    let expected = Sample::new("m.obj", format!("{SQUARE}f 1 2 3 4")).triangles();
    assert_eq!(expected.faces().len(), 2);
    for text in [
        // Colours at some points only, weights, Windows line ends, a byte order mark, no final line break.
        "\u{feff}v 0 0 0 1 1 1\r\nv 1 0 0 0\r\nv 1 1 0\r\nv 0 1 0\r\nf 1 2 3 4",
        "vt 0 0\nvn 0 0 1\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1/1/1 2//1 3/1 4",
        "  v 0 0 0\n\tv 1 0 0\nv 1 1 \\\n 0\nv 0 1 0\nf 1 2\\\n3 4\n",
        // Indices of texture coordinates are ignored, even invalid ones.
        "vt 0 0\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1/-9223372036854775808 2/99 3/0 4",
    ] {
        assert_eq!(Sample::new("m.obj", text).triangles(), expected, "{text}");
    }
    let latin = [b"# caf\xe9\ng caf\xe9\n", SQUARE.as_bytes(), b"f 1 2 3 4\n"].concat();
    assert_eq!(Sample::new("m.obj", latin).triangles(), expected);
}

#[test]
fn broken_lines_are_named() {
    let wrong = |line: &str| error_of("m.obj", format!("{SQUARE}f 1 2 3\n{line}\nf 2 3 4\n"));
    for (line, sentence) in [
        (
            "f 1 2 900",
            "this face names point 900, but there are only 4",
        ),
        (
            "f 1 2 -5",
            "this face names point -5, but there are only 4 before it",
        ),
        (
            "f 0 1 2",
            "this face names point 0; points are counted from 1",
        ),
        (
            "f 1 2 x",
            "the corner \"x\" of this face is not the number of a point",
        ),
        (
            "f 1 2 99999999999999999999",
            "the corner \"99999999999999999999\" of this face is not the number of a point",
        ),
        (
            "f 1/x 2 3",
            "the corner \"1/x\" of this face is not written like 1, 1/2, 1//3 or 1/2/3",
        ),
        ("v 1 2", "a point needs three coordinates"),
        ("v 1 2 abc", "the coordinate \"abc\" is not a finite number"),
    ] {
        assert_eq!(wrong(line), format!("m.obj:6: {sentence}"));
    }
    let remark = format!("{SQUARE}f 1 2 3#c\nf 1 2 9\n");
    assert_eq!(
        error_of("m.obj", remark),
        "m.obj:6: this face names point 9, but there are only 4"
    );
    let not_finite = format!("{SQUARE}v 1 NaN 0\nf 1 2 5\n");
    assert_eq!(
        error_of("m.obj", not_finite),
        "m.obj:5: the coordinate \"NaN\" is not a finite number"
    );
    assert_eq!(
        error_of("m.obj", SQUARE),
        "m.obj: this file has no faces with an area"
    );
    assert_eq!(
        error_of("m.obj", ""),
        "m.obj: this file has no faces with an area"
    );
}

#[test]
fn concave_polygons_keep_their_notches() {
    let outline = "0 0 0\n4 0 0\n4 4 0\n2 1 0\n0 4 0";
    let obj = format!("v {}\nf 5 1 2 3 4\n", outline.replace('\n', "\nv "));
    let ply = format!(
        "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n{outline}\n5 4 0 1 2 3\n"
    );
    for (name, text) in [("m.obj", obj), ("m.ply", ply)] {
        let triangles = Sample::new(name, text).triangles();
        let areas = triangles
            .corners()
            .map(|[a, b, c]| (b - a).cross(c - a).length() / 2.0);
        let area: f64 = areas.sum();
        assert!((area - 10.0).abs() < 1e-12, "{name}: {area}");
        assert_eq!(triangles.faces().len(), 3, "{name}");
    }
}

#[test]
fn colours_are_found_as_other_programs_write_them() {
    let square = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let sample = Sample::new(
        "m.obj",
        format!(
            "mtllib\tm.mtl more.mtl\n{square}usemtl\tred\nf 1 2 3 # all of it\ng b\nusemtl grey\nf 3 2 1\n"
        ),
    );
    sample.beside("m.mtl", "newmtl red\nKd 1 0 0\n");
    sample.beside("more.mtl", "newmtl grey\nKd 0.5\n");
    let parts = sample.parts();
    let colors = parts
        .iter()
        .map(|part| part.colors.as_ref().expect("colours").diffuse);
    assert_eq!(colors.collect::<Vec<_>>(), [[1.0, 0.0, 0.0], [0.5; 3]]);
    let far = Sample::new("m.obj", format!("v 1e13 0 0\n{square}f 1 2 3\n"));
    assert!(
        far.error().starts_with("m.obj:1: the coordinate 1e13"),
        "{}",
        far.error()
    );
}

#[test]
fn what_has_one_material_is_one_part_of_its_group() {
    let sample = Sample::new(
        "m.obj",
        format!(
            "mtllib m.mtl\n{SQUARE}usemtl red\nf 1 2 3\nusemtl blue\nf 2 3 4\nusemtl red\nf 1 3 4\ng a\nf 1 2 4\nusemtl blue\nl 1 2\nf 2 1 4\ng a\nf 2 1 3\nusemtl red\nf 1 2 3 4\nusemtl blue\nf 4 3 2\n"
        ),
    );
    sample.beside("m.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n");
    let parts = sample.parts().into_iter().map(|part| {
        let color = part.colors.map_or(String::new(), |colors| colors.name);
        let faces = part.triangles.faces().len();
        (part.name, color, faces)
    });
    let parts: Vec<_> = parts.collect();
    let part = |name: &str, color: &str, faces| (name.to_owned(), color.to_owned(), faces);
    let expected = [
        part("m", "red", 2),
        part("m", "blue", 1),
        part("a", "red", 1),
        part("a", "blue", 1),
        part("a", "blue", 2),
        part("a", "red", 2),
    ];
    assert_eq!(parts, expected);
    assert!(sample.notes().is_empty());
}

#[test]
fn colours_that_are_not_found_are_told_and_those_that_can_be_are_found() {
    let text = format!(
        "mtllib Some.MTL\n{SQUARE}usemtl red # and blue\nf 1 2 3\ng b\nusemtl Material #25\nf 2 3 4\n"
    );
    let sample = Sample::new("m.obj", &text);
    let missing =
        "its colours are missing: there is no readable file Some.MTL beside it, of at most 4 MiB";
    assert_eq!(sample.notes(), [missing]);
    sample.beside(
        "some.mtl",
        "newmtl red\nKd 1 0 0\nnewmtl Material #25\nKd 0 0 1\n",
    );
    let colors = sample.parts().into_iter().filter_map(|part| part.colors);
    let colors: Vec<_> = colors.map(|colors| colors.diffuse).collect();
    assert_eq!(colors, [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]);
    assert!(sample.notes().is_empty());
    sample.beside("some.mtl", "newmtl red\nKd 1 0 0\n");
    let unknown = "it uses the material Material #25, which is in none of its material files";
    assert_eq!(sample.notes(), [unknown]);
    // A link that leads out of the folder is not followed, whatever the case of its name.
    #[cfg(unix)]
    {
        let outside = Sample::new("some.mtl", "newmtl red\nKd 0 1 0\n");
        let inside = Sample::new("m.obj", &text);
        let link = inside.path.with_file_name("some.mtl");
        std::os::unix::fs::symlink(&outside.path, link).expect("a link");
        assert_eq!(inside.notes(), [missing]);
    }
    sample.beside(
        "some.mtl",
        "newmtl red\nKd 1 1 1\nnewmtl Material #25\n map_Kd wood.png\n",
    );
    assert_eq!(sample.notes(), ["its textures are left out"]);
    let painted = "v 0 0 0 1 0 0\nv 1 0 0 1 1 0\nv 0 1 0 1 0 0\nf 1 2 3\n";
    let notes = Sample::new("m.obj", painted).notes();
    assert_eq!(notes, ["colours of points or faces are left out"]);
    let remark = "v 0 0 0 # first corner point\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    assert!(Sample::new("m.obj", remark).notes().is_empty());
}

#[test]
fn faces_without_corners_do_not_merge_groups() {
    let text = format!("{SQUARE}f\ng a\nf 1 2 3\nf\ng b\nf\nf 2 3 4\nf\ng c\nf 1 3 4\n");
    let parts = Sample::new("m.obj", text).parts();
    let names: Vec<_> = parts.iter().map(|part| part.name.as_str()).collect();
    assert_eq!(names, ["a", "b", "c"]);
}

#[test]
fn lines_end_as_on_old_machines_and_remarks_as_they_like() {
    let text = format!("# C:\\dir\\\nmtllib m.mtl\n{SQUARE}usemtl red\nf 1 2 3\nf 1 3 4\n");
    for text in [text.clone(), text.replace('\n', "\r")] {
        let sample = Sample::new("m.obj", &text);
        sample.beside("m.mtl", "newmtl red\rKd 1 0 0\r");
        let parts = sample.parts();
        assert_eq!(parts[0].triangles.faces().len(), 2);
        assert_eq!(parts[0].triangles.points().len(), 4);
        let colors = parts[0].colors.as_ref().expect("a colour");
        assert_eq!(colors.diffuse, [1.0, 0.0, 0.0]);
    }
    // Line numbers are right after comments, too.
    let sample = Sample::new("m.obj", "g a\\\n# b\\\nf 1 2 9\n");
    let said = sample.error();
    assert!(said.contains(":3:") || said.contains("line 3"), "{said}");
}

/// The colours of the parts of an OBJ file with this text, and with this material file in its folder.
fn colors(obj: &str, mtl: impl AsRef<[u8]>) -> Vec<PartColors> {
    let sample = Sample::new("m.obj", obj);
    sample.beside("m.mtl", mtl);
    let parts = sample.parts().into_iter();
    parts.filter_map(|part| part.colors).collect()
}

#[test]
fn material_files_are_found_by_the_paths_of_other_machines() {
    for name in [
        "C:\\Users\\x\\m.mtl",
        "/home/x/m.mtl",
        "\"m.mtl\"",
        "sub/M.MTL",
    ] {
        let obj = format!("mtllib {name}\n{SQUARE}usemtl red\nf 1 2 3\n");
        for mtl in [
            "newmtl red\nKd 1 0 0\n",
            "\u{feff}newmtl red # warm\nKd 1 0 0\n",
        ] {
            let colors = colors(&obj, mtl);
            assert_eq!(colors[0].diffuse, [1.0, 0.0, 0.0], "{name} {mtl}");
            assert_eq!(colors[0].name, "red", "{name} {mtl}");
        }
    }
    let early = format!("{SQUARE}usemtl red\nf 1 2 3\nmtllib m.mtl\n");
    let sample = Sample::new("m.obj", early);
    sample.beside("m.mtl", "newmtl red\nKd 1 0 0\n");
    let told = "some colours are missing: it uses red before naming its material file";
    assert_eq!(sample.notes(), [told]);
}

#[test]
fn names_that_differ_in_a_letter_of_another_encoding_are_two() {
    let latin = |text: &str| -> Vec<u8> { text.chars().map(|c| c as u8).collect() };
    let obj = latin(&format!(
        "mtllib m.mtl\n{SQUARE}usemtl rotä\nf 1 2 3\nusemtl rotö\nf 2 3 4\n"
    ));
    let sample = Sample::new("m.obj", obj);
    sample.beside(
        "m.mtl",
        latin("newmtl rotä\nKd 1 0 0\nnewmtl rotö\nKd 0 1 0\n"),
    );
    let colors = sample.parts().into_iter().filter_map(|part| part.colors);
    let names: Vec<_> = colors.map(|colors| (colors.name, colors.diffuse)).collect();
    let expected = [("rotä", [1.0, 0.0, 0.0]), ("rotö", [0.0, 1.0, 0.0])];
    assert_eq!(
        names,
        expected.map(|(name, color)| (name.to_owned(), color))
    );
}

#[test]
fn what_is_matte_has_no_highlight() {
    let highlight = |lines: &str| {
        let sample = Sample::new(
            "m.obj",
            format!("mtllib m.mtl\n{SQUARE}usemtl a\nf 1 2 3\n"),
        );
        sample.beside(
            "m.mtl",
            format!("newmtl a\nKd 1 0 0\nKs 0.5 0.5 0.5\n{lines}"),
        );
        let colors = sample.parts().remove(0).colors.expect("colours");
        colors.specular
    };
    for matte in ["Ns 0\nillum 2\n", "Ns 50\nillum 1\n", "illum 0\n"] {
        assert_eq!(highlight(matte), Some([0.0; 3]), "{matte}");
    }
    for shiny in ["Ns 50\nillum 2\n", "Ns 1\n", ""] {
        assert_eq!(highlight(shiny), Some([0.5; 3]), "{shiny}");
    }
}

#[test]
fn faces_with_too_many_corners_to_be_cut_are_told() {
    let star = |corners: u32| {
        let corner = |at: u32| {
            let angle = f64::from(at) / f64::from(corners) * std::f64::consts::TAU;
            let radius = if at.is_multiple_of(2) { 3.0 } else { 1.0 };
            format!("v {} {} 0\n", angle.cos() * radius, angle.sin() * radius)
        };
        let points: String = (0..corners).map(corner).collect();
        let face: Vec<String> = (1..=corners).map(|number| number.to_string()).collect();
        Sample::new("m.obj", format!("{points}f {}\n", face.join(" "))).notes()
    };
    assert!(star(2000).is_empty());
    let told = "1 face with more than 4096 corners may be filled in where they are concave";
    assert_eq!(star(4098), [told]);
}
