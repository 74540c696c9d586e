//! An icosahedron, written in each format.

use std::fmt::Write as _;

use base64::Engine as _;

pub type Point = [f32; 3];
pub type Face = [u32; 3];

/// Points and faces, counter-clockwise seen from outside.
pub fn icosahedron() -> (Vec<Point>, Vec<Face>) {
    // The golden ratio is irrational, so that single precision is not exact by luck.
    let long = f32::midpoint(1.0, 5_f32.sqrt());
    let mut points = Vec::new();
    for a in [-1.0, 1.0] {
        for b in [-long, long] {
            points.extend([[0.0, a, b], [a, b, 0.0], [b, 0.0, a]]);
        }
    }
    let length = |a: u32, b: u32| {
        let (a, b) = (points[a as usize], points[b as usize]);
        a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f32>()
    };
    let is_edge = |a, b| (length(a, b) - 4.0).abs() < 0.01;
    let mut faces = Vec::new();
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                if is_edge(a, b) && is_edge(b, c) && is_edge(c, a) {
                    let is_outward = volume(&points, [a, b, c]) > 0.0;
                    faces.push(if is_outward { [a, b, c] } else { [a, c, b] });
                }
            }
        }
    }
    (points, faces)
}

/// Six times the volume between a face and the origin; positive if it is counter-clockwise.
fn volume(points: &[Point], face: Face) -> f32 {
    let [a, b, c] = face.map(|index| points[index as usize]);
    a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}

/// The same point with all its digits, for text files, which are read in double precision.
fn exact(point: Point) -> [f64; 3] {
    point.map(f64::from)
}

pub fn obj() -> String {
    let (points, faces) = icosahedron();
    let mut text = String::new();
    for [x, y, z] in points.into_iter().map(exact) {
        let _ = writeln!(text, "v {x} {y} {z}");
    }
    for face in faces {
        let [a, b, c] = face.map(|index| index + 1);
        let _ = writeln!(text, "f {a} {b} {c}");
    }
    text
}

pub fn text_stl() -> String {
    let (points, faces) = icosahedron();
    let mut text = "solid ico sahedron\n".to_owned();
    for face in faces {
        text += "facet normal 0 0 0\n outer loop\n";
        for [x, y, z] in face.map(|index| exact(points[index as usize])) {
            let _ = writeln!(text, "  vertex {x:e} {y:e} {z:e}");
        }
        text += " endloop\nendfacet\n";
    }
    text + "endsolid ico sahedron\n"
}

pub fn binary_stl() -> Vec<u8> {
    let (points, faces) = icosahedron();
    let mut bytes = format!("{:80}", "solid in name only").into_bytes();
    bytes.extend((faces.len() as u32).to_le_bytes());
    for face in faces {
        bytes.extend([0; 12]);
        for number in face.map(|index| points[index as usize]).as_flattened() {
            bytes.extend(number.to_le_bytes());
        }
        bytes.extend([0; 2]);
    }
    bytes
}

pub fn ply_header(format: &str, float: &str, list: &str) -> String {
    format!(
        "ply\nformat {format} 1.0\ncomment made by a test\nelement vertex 12\nproperty {float} x\nproperty {float} y\nproperty {float} z\nproperty uchar red\nelement face 20\nproperty list uchar int {list}\nend_header\n"
    )
}

pub fn text_ply() -> String {
    let (points, faces) = icosahedron();
    let mut text = ply_header("ascii", "float", "vertex_index");
    for [x, y, z] in points.into_iter().map(exact) {
        let _ = writeln!(text, "{x} {y} {z} 255");
    }
    for [a, b, c] in faces {
        let _ = writeln!(text, "3 {a} {b} {c}");
    }
    text
}

pub fn binary_ply(is_big: bool) -> Vec<u8> {
    let (points, faces) = icosahedron();
    let (format, float) = if is_big {
        ("binary_big_endian", "double")
    } else {
        ("binary_little_endian", "float")
    };
    let mut bytes = ply_header(format, float, "vertex_indices").into_bytes();
    for point in points {
        for number in point {
            if is_big {
                bytes.extend(f64::from(number).to_be_bytes());
            } else {
                bytes.extend(number.to_le_bytes());
            }
        }
        bytes.push(255);
    }
    for face in faces {
        bytes.push(3);
        for index in face {
            bytes.extend(if is_big {
                index.to_be_bytes()
            } else {
                index.to_le_bytes()
            });
        }
    }
    bytes
}

/// The points, then the indices.
pub fn gltf_bytes() -> Vec<u8> {
    let (points, faces) = icosahedron();
    let numbers = points.as_flattened().iter().flat_map(|x| x.to_le_bytes());
    let indices = faces
        .as_flattened()
        .iter()
        .flat_map(|i| (*i as u16).to_le_bytes());
    numbers.chain(indices).collect()
}

/// The JSON of a glTF file; `node` and `uri` are JSON members with a leading comma, or empty.
pub fn gltf_json(node: &str, uri: &str) -> String {
    format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],
"nodes":[{{"mesh":0,"name":"ico"{node}}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1,"material":0}}]}}],
"materials":[{{"name":"gold","pbrMetallicRoughness":{{"baseColorFactor":[1,0.5,0,1]}}}}],
"accessors":[{{"bufferView":0,"componentType":5126,"count":12,"type":"VEC3","min":[-2,-2,-2],"max":[2,2,2]}},
{{"bufferView":1,"componentType":5123,"count":60,"type":"SCALAR"}}],
"bufferViews":[{{"buffer":0,"byteLength":144}},{{"buffer":0,"byteOffset":144,"byteLength":120}}],
"buffers":[{{"byteLength":264{uri}}}]}}"#
    )
}

pub fn embedded_gltf(node: &str) -> String {
    let text = base64::engine::general_purpose::STANDARD.encode(gltf_bytes());
    let uri = format!(r#","uri":"data:application/octet-stream;base64,{text}""#);
    gltf_json(node, &uri)
}

/// A glTF file with this further member at its top.
pub fn gltf_with(member: &str) -> String {
    embedded_gltf("").replacen('{', &format!("{{{member},"), 1)
}

pub fn glb(json: &str, chunk: &[u8]) -> Vec<u8> {
    let json = format!("{json}{}", &"   "[..(4 - json.len() % 4) % 4]);
    let mut bytes = b"glTF".to_vec();
    let length = 28 + json.len() + chunk.len();
    bytes.extend(
        [2, length as u32, json.len() as u32]
            .map(u32::to_le_bytes)
            .as_flattened(),
    );
    bytes.extend(b"JSON");
    bytes.extend(json.as_bytes());
    bytes.extend((chunk.len() as u32).to_le_bytes());
    bytes.extend(b"BIN\0");
    bytes.extend(chunk);
    bytes
}

/// The icosahedron in a file of each kind.
pub fn all() -> Vec<(&'static str, Vec<u8>)> {
    vec![
        ("m.obj", obj().into_bytes()),
        ("m.stl", text_stl().into_bytes()),
        ("binary.STL", binary_stl()),
        ("m.ply", text_ply().into_bytes()),
        ("little.ply", binary_ply(false)),
        ("big.Ply", binary_ply(true)),
        ("m.gltf", embedded_gltf("").into_bytes()),
        ("m.glb", glb(&gltf_json("", ""), &gltf_bytes())),
    ]
}
