use super::*;
use crate::mesh::{SOLIDS, Solid, icosphere};

fn packed(triangles: Triangles, smooth: f64) -> PackedMesh<f64> {
    PackedMesh::new(&Mesh {
        smooth,
        ..Mesh::of(triangles)
    })
}

#[test]
fn a_ball_of_triangles_has_the_normals_of_a_ball() {
    let mesh = packed(icosphere(2.0), 60.0);
    for (face, smooth) in mesh.triangles.iter().zip(&mesh.smooth) {
        for (corner, normal) in face.corners.into_iter().zip(smooth.normals) {
            let cosine = corner.dot(normal) / corner.length();
            assert!(cosine > 0.9999, "{normal:?}");
        }
        assert!(
            (0.4..0.6).contains(&smooth.curvature),
            "{}",
            smooth.curvature
        );
    }
}

#[test]
fn a_mesh_is_the_same_whichever_way_it_was_turned_before() {
    let source = Mesh::of(icosphere(2.0));
    let posed = |rotation: [f64; 3]| Mesh {
        rotation: rotation.into(),
        scale: DVec3::new(1.0, -2.0, 0.5),
        smooth: 60.0,
        ..source.clone()
    };
    let (level, here) = (posed([0.0; 3]), posed([10.0, -70.0, 200.0]));
    let fresh = PackedMesh::new(&here);
    for before in [level, posed([90.0, 0.0, 3.0])] {
        let before = PackedMesh::new(&before);
        for turned in [before.turned(&here), before.rounded::<f64>().turned(&here)] {
            let turned = turned.expect("no face is lost");
            assert_eq!(
                format!("{:?}", turned.triangles),
                format!("{:?}", fresh.triangles)
            );
            assert_eq!(
                format!("{:?}", turned.smooth),
                format!("{:?}", fresh.smooth)
            );
            assert_eq!(format!("{:?}", turned.bvh), format!("{:?}", fresh.bvh));
            assert_eq!((turned.middle, turned.key), (fresh.middle, fresh.key));
        }
    }
    // The same as when packed with its rotation, but for the order of the faces. Of the faces in a node, only some
    // are measured for all, so that thicknesses agree on the whole.
    let sorted = |mesh: &PackedMesh<f64>| {
        let faces = mesh.triangles.iter();
        let mut faces: Vec<_> = faces
            .map(|face| (format!("{:?}", face.corners), face.tip, face.thickness))
            .collect();
        faces.sort_by(|a, b| a.0.cmp(&b.0));
        faces
    };
    assert_eq!(fresh.triangles.len(), PackedMesh::of(&here).triangles.len());
    for (one, other) in sorted(&fresh).iter().zip(&sorted(&PackedMesh::of(&here))) {
        assert_eq!((&one.0, one.1), (&other.0, other.1));
    }
    let thickness =
        |mesh: &PackedMesh<f64>| -> f64 { mesh.triangles.iter().map(|face| face.thickness).sum() };
    let share = thickness(&fresh) / thickness(&PackedMesh::of(&here));
    assert!((0.7..1.4).contains(&share), "{share}");
    let single = fresh.rounded::<f32>();
    let turned = single.turned(&posed([0.0; 3])).expect("no face is lost");
    let level = PackedMesh::new(&posed([0.0; 3])).rounded::<f32>();
    let turned = turned.rounded::<f32>();
    assert_eq!(
        format!("{:?}", turned.triangles),
        format!("{:?}", level.triangles)
    );
    let six_volumes = six_volumes(&fresh.triangles);
    assert!(fresh.is_solid && six_volumes > 0.0, "{six_volumes}");
}

#[test]
fn faces_that_meet_at_a_larger_angle_stay_flat() {
    let Solid { name, make, .. } = SOLIDS[0];
    let mesh = packed(make(1.0), 89.0);
    for (face, smooth) in mesh.triangles.iter().zip(&mesh.smooth) {
        let is_flat = |normal: &Vec3<f64>| (*normal - face.normal).length() < 1e-12;
        assert!(smooth.normals.iter().all(is_flat), "{name}");
    }
    let round = packed(make(1.0), 91.0);
    assert!(round.smooth.iter().all(|smooth| smooth.curvature > 0.5));
    assert!(packed(make(1.0), 0.0).smooth.is_empty());
}

#[test]
fn the_boxes_of_narrow_faces_are_as_small_whichever_way_they_are_wound() {
    let rim = |side: u32| {
        let angle = f64::from(side) / 300.0 * std::f64::consts::TAU;
        DVec3::new(angle.cos() * 5.0, 0.0, angle.sin() * 5.0)
    };
    let points: Vec<DVec3> = (0..300)
        .map(rim)
        .chain([DVec3::ZERO, DVec3::Y * 9.0])
        .collect();
    let side = |side: u32| [[side, 301, (side + 1) % 300], [(side + 1) % 300, 300, side]];
    let faces: Vec<[u32; 3]> = (0..300).flat_map(side).collect();
    let turned_over = faces.iter().map(|&[a, b, c]| [a, c, b]).collect();
    let boxes = [faces, turned_over].map(|faces| {
        let mesh = PackedMesh::new(&Mesh {
            rotation: DVec3::new(20.0, 0.0, 35.0),
            ..Mesh::of(Triangles::new(points.clone(), faces).expect("a cone"))
        });
        let nodes = mesh.bvh.nodes.iter();
        let boxes = nodes.flat_map(|node| (0..node.count).map(|index| node.bounds::<f64>(index)));
        let sizes = boxes.map(|bounds| (bounds.high - bounds.low).length());
        // A face counts once, however many of its slices a line meets.
        let is_seen = |point| is_outside(&mesh.triangles, &mesh.bvh, mesh.to_local(point));
        for at in [0.1, 1.0, 4.0] {
            assert!(!is_seen(DVec3::new(0.3, at, -0.2)), "{at}");
            assert!(is_seen(DVec3::new(at - 9.0, 7.0, at)), "{at}");
        }
        (mesh.is_inside_out, sizes.sum::<f64>())
    });
    let [(one_way, one), (other_way, other)] = boxes;
    assert_ne!(one_way, other_way);
    assert!((one / other - 1.0).abs() < 0.05, "{one} {other}");
}

#[test]
fn few_boxes_in_a_cone_of_many_sides_hold_a_point_of_it() {
    let rim = |side: usize| {
        let angle = side as f64 / 1000.0 * std::f64::consts::TAU;
        Vec3::new(angle.cos() * 5.0, -8.0, angle.sin() * 5.0)
    };
    let face = |side: usize| [Vec3::splat(0.0), rim(side), rim(side + 1)];
    let holders = |slicings: &[Slicing]| {
        let bvh = tree(slicings, 1000, face);
        let held = (0..1000).step_by(10).map(|side| {
            let [a, b, c] = face(side);
            let middle = BoundingBox::around(&[(a + b + c) * (1.0 / 3.0)]);
            bvh.members_where(|bounds| bounds.union(&middle) == *bounds)
                .len()
        });
        held.sum::<usize>()
    };
    let (whole, sliced) = (holders(&[]), holders(&slicings(1000, face)));
    assert!(sliced * 10 < whole, "{sliced} of {whole}");
}
