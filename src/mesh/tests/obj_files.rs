//! OBJ as programs write it, with MTL.

use glam::DVec3;

use super::{Sample, error_of};

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
        "newmtl red\nKd 1 0.5 0\nKs 2 2 2\nKa 0.1 0.1\nNs 30\nnewmtl none\nKs 1 1 1\n",
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
    let all = sample.triangles();
    assert_eq!(
        all.points(),
        [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y]
    );
    // The first triangle is in the other parts too.
    assert_eq!(all.faces(), [[0, 2, 1], [0, 3, 2]]);
}

#[test]
fn what_programs_write_is_read() {
    let expected = Sample::new("m.obj", format!("{SQUARE}f 1 2 3 4")).triangles();
    assert_eq!(expected.faces().len(), 2);
    for text in [
        // Colours at some points only, weights, Windows, a byte order mark, no last line break.
        "\u{feff}v 0 0 0 1 1 1\r\nv 1 0 0 0\r\nv 1 1 0\r\nv 0 1 0\r\nf 1 2 3 4",
        "vt 0 0\nvn 0 0 1\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1/1/1 2//1 3/1 4",
        "  v 0 0 0\n\tv 1 0 0\nv 1 1 \\\n 0\nv 0 1 0\nf 1 2\\\n3 4\n",
        // Numbers of texture coordinates are nobody's business.
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
            "this face names point 900, and there are only 4",
        ),
        (
            "f 1 2 -5",
            "this face names point -5, and there are only 4 before it",
        ),
        (
            "f 0 1 2",
            "this face names point 0; points are counted from 1",
        ),
        ("f 1 2 x", "the corner \"x\" of this face names no point"),
        (
            "f 1 2 99999999999999999999",
            "the corner \"99999999999999999999\" of this face names no point",
        ),
        (
            "f 1/x 2 3",
            "the corner \"1/x\" of this face is not written like 1, 1/2, 1//3 or 1/2/3",
        ),
        ("v 1 2", "a point needs three coordinates"),
        ("v 1 2 abc", "the coordinate \"abc\" is no finite number"),
    ] {
        assert_eq!(wrong(line), format!("m.obj:6: {sentence}"));
    }
    let not_finite = format!("{SQUARE}v 1 NaN 0\nf 1 2 5\n");
    assert_eq!(
        error_of("m.obj", not_finite),
        "m.obj:5: the coordinate \"NaN\" is no finite number"
    );
    assert_eq!(
        error_of("m.obj", SQUARE),
        "m.obj: there are no faces in this file"
    );
    assert_eq!(
        error_of("m.obj", ""),
        "m.obj: there are no faces in this file"
    );
}
