use super::*;
use crate::scene::{Disc, Mesh, Plane};

/// Returns a sheet of `squares` × `squares` squares, `width` units wide, centred at `at` and turned by
/// `rotation` in degrees.
fn sheet(squares: u32, width: f64, at: DVec3, rotation: DVec3) -> Mesh {
    let side = squares + 1;
    let place = |index: u32| (f64::from(index) / f64::from(squares) - 0.5) * width;
    let points = (0..side * side).map(|n| DVec3::new(place(n % side), 0.0, place(n / side)));
    let faces = (0..squares * squares).flat_map(|n| {
        let corner = n / squares * side + n % squares;
        [
            [corner, corner + 1, corner + side],
            [corner + 1, corner + side + 1, corner + side],
        ]
    });
    let triangles = Triangles::new(points.collect(), faces.collect()).expect("in range");
    Mesh {
        position: at,
        rotation,
        ..Mesh::of(triangles)
    }
}

fn found(one: impl Into<Shape>, other: impl Into<Shape>) -> Option<Overlap> {
    let objects = [
        Object::new("one", "red", one.into()),
        Object::new("other", "blue", other.into()),
    ];
    let found = mesh_coincidences(&objects.into_iter().collect(), DVec3::ZERO);
    assert!(found.len() <= 1);
    found.first().map(|found| {
        assert_eq!((found.earlier, found.later), (0, 1));
        found.extent
    })
}

fn floor() -> Plane {
    Plane {
        point: DVec3::ZERO,
        normal: DVec3::Y,
    }
}

#[test]
fn a_sheet_lies_in_a_floor_and_a_box_stands_on_it() {
    let flat = sheet(7, 50.0, DVec3::ZERO, DVec3::ZERO);
    assert_eq!(found(flat.clone(), floor()), Some(Overlap::Faces));
    assert_eq!(found(floor(), flat.clone()), Some(Overlap::Faces));
    let higher = sheet(7, 50.0, DVec3::Y * 1e-3, DVec3::ZERO);
    assert_eq!(found(higher, floor()), None);
    let turned = sheet(7, 50.0, DVec3::ZERO, DVec3::X);
    assert_eq!(found(turned, floor()), None);
    let cube = |y: f64| Mesh {
        position: DVec3::Y * y,
        ..Mesh::of((crate::mesh::SOLIDS[0].make)(2.0))
    };
    let half = cube(0.0).bounds().map_or(0.0, |(_, high)| high.y);
    assert_eq!(found(cube(half), floor()), Some(Overlap::Standing));
    assert_eq!(found(cube(-half), floor()), Some(Overlap::Standing));
    assert_eq!(found(cube(0.3 * half), floor()), None);
    assert_eq!(found(cube(9.0), floor()), None);
}

#[test]
fn solids_that_stand_on_each_other_touch_and_one_in_a_side_of_another_lies_there() {
    let cube = |x: f64, y: f64| Mesh {
        position: DVec3::new(x, y, 0.0),
        ..Mesh::of((crate::mesh::SOLIDS[0].make)(2.0))
    };
    let side = cube(0.0, 0.0)
        .bounds()
        .map_or(0.0, |(low, high)| (high - low).y);
    let lower = cube(0.0, 0.0);
    assert_eq!(
        found(lower.clone(), cube(0.3, side)),
        Some(Overlap::Touching)
    );
    // Their front faces are in one plane.
    assert_eq!(found(lower.clone(), cube(0.3, 0.3)), Some(Overlap::Faces));
    let mirrored = Mesh {
        scale: DVec3::new(1.0, -1.0, 1.0),
        ..cube(0.3, side)
    };
    assert_eq!(found(lower.clone(), mirrored), Some(Overlap::Touching));
    // A sheet is no solid.
    let lid = sheet(1, 1.0, DVec3::Y * side / 2.0, DVec3::X * 180.0);
    assert_eq!(found(lower, lid), Some(Overlap::Faces));
}

#[test]
fn sheets_that_share_an_area_coincide_however_they_are_cut_and_turned() {
    let turned = DVec3::new(11.0, 23.0, 5.0);
    let at = DVec3::new(1.0, 3.0, 2.0);
    let sheets = |other: DVec3| found(sheet(7, 50.0, at, turned), sheet(11, 30.0, other, turned));
    assert_eq!(sheets(at), Some(Overlap::Faces));
    let one = sheet(7, 50.0, at, turned);
    let (across, along) = (
        one.linear_transform() * DVec3::Y,
        one.linear_transform() * DVec3::X,
    );
    assert_eq!(sheets(at + across * 1e-3), None);
    assert_eq!(sheets(at + along * 39.9), Some(Overlap::Faces));
    assert_eq!(sheets(at + along * 40.1), None, "beside it");
    let disc = |center: DVec3| Disc {
        center,
        normal: across,
        radius: 1.0,
    };
    assert_eq!(found(disc(at), one.clone()), Some(Overlap::Faces));
    assert_eq!(found(disc(at + across), one), None);
}
