//! Triangulation of faces with more than three corners.

use glam::{DVec2, DVec3};

use crate::words::counted;

/// Most corners of a polygon that is cut by ear clipping, which usually takes quadratic time.
const MAX_CORNERS: usize = 4096;
/// Largest value of twice a triangle's area that counts as straight, as a share of the squared size of the polygon, to
/// allow for rounding.
const MAX_STRAIGHT_AREA: f64 = 1e-12;

/// The triangles of a fan: a polygon's first corner and each two consecutive others.
pub(super) fn fan<T: Copy>(corners: &[T]) -> impl Iterator<Item = [T; 3]> {
    let pairs = corners.get(1..).unwrap_or_default().array_windows();
    pairs.map(move |&[b, c]| [corners[0], b, c])
}

/// The triangles of a strip: each three consecutive corners, every other triangle turned over.
pub(super) fn strip<T: Copy>(corners: &[T]) -> impl Iterator<Item = [T; 3]> {
    let triples = corners.array_windows().enumerate();
    triples.map(|(index, &[a, b, c])| if index % 2 == 0 { [a, b, c] } else { [b, a, c] })
}

/// Replaces a fan around a polygon's first corner that leaves the outline, as in a concave polygon, by ear clipping
/// (Meisters, "Polygons have ears", American Mathematical Monthly 82, 1975). Keeps the fan if there is no ear because
/// the polygon crosses itself, or if it has more than [`MAX_CORNERS`] corners; returns `true` in the latter case.
pub(super) fn mend_fan(fan: &mut [[u32; 3]], point: impl Fn(u32) -> DVec3) -> bool {
    let area = |[a, b, c]: [u32; 3]| {
        let a = point(a);
        (point(b) - a).cross(point(c) - a)
    };
    let normal: DVec3 = fan.iter().map(|&face| area(face)).sum();
    // If all triangles face the same side, the first corner sees the whole outline.
    if fan.len() < 2 || fan.iter().all(|&face| area(face).dot(normal) >= 0.0) {
        return false;
    }
    let first = &fan[0][..2];
    let corners: Vec<u32> = first
        .iter()
        .copied()
        .chain(fan.iter().map(|face| face[2]))
        .collect();
    if corners.len() > MAX_CORNERS {
        return true;
    }
    let projected: Vec<DVec2> = corners
        .iter()
        .map(|&corner| project_along(normal, point(corner)))
        .collect();
    if let Some(ears) = ears(&projected) {
        for (face, ear) in fan.iter_mut().zip(ears) {
            *face = ear.map(|corner| corners[corner]);
        }
    }
    false
}

/// Returns the note about `count` faces that [`mend_fan`] found to have too many corners, or `None` if there are
/// none.
pub(super) fn note_of_uncut(count: usize) -> Option<String> {
    (count > 0).then(|| {
        let faces = counted(count, "face");
        format!(
            "{faces} with more than {MAX_CORNERS} corners may be filled in where they are concave"
        )
    })
}

/// Projects a point along the largest axis of the normal, so that what is counter-clockwise around it stays so.
fn project_along(normal: DVec3, point: DVec3) -> DVec2 {
    let size = normal.abs();
    if size.x >= size.y && size.x >= size.z {
        DVec2::new(point.y, point.z * normal.x.signum())
    } else if size.y >= size.z {
        DVec2::new(point.z, point.x * normal.y.signum())
    } else {
        DVec2::new(point.x, point.y * normal.z.signum())
    }
}

/// Twice the signed area of a triangle, positive if it is counter-clockwise.
fn double_area(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Cuts a counter-clockwise polygon into triangles, which are given by indices into `points`; `None` if it cannot be
/// cut.
fn ears(points: &[DVec2]) -> Option<Vec<[usize; 3]>> {
    let tolerance = straight_tolerance(points);
    let mut remaining: Vec<usize> = (0..points.len()).collect();
    let mut ears = Vec::with_capacity(points.len());
    let (mut index, mut tried) = (0, 0);
    while remaining.len() > 3 {
        let count = remaining.len();
        let triangle_at = |index: usize| {
            [(index + count - 1) % count, index, (index + 1) % count].map(|index| remaining[index])
        };
        let double_area_at = |index: &usize| double_area_of(points, triangle_at(*index)).abs();
        let is_ear = is_ear(points, &remaining, triangle_at(index), tolerance);
        if is_ear || tried == count {
            // Without an ear, a corner on a straight line is cut off, as a triangle without area.
            let straightest =
                || (0..count).min_by(|a, b| double_area_at(a).total_cmp(&double_area_at(b)));
            let cut = if is_ear { Some(index) } else { straightest() };
            let cut = cut.filter(|index| is_ear || double_area_at(index) <= tolerance)?;
            ears.push(triangle_at(cut));
            remaining.remove(cut);
            // The corner before it may have become an ear, as along an arc.
            index = cut.checked_sub(1).unwrap_or(remaining.len() - 1);
            tried = 0;
        } else {
            index += 1;
            tried += 1;
        }
        index %= remaining.len();
    }
    ears.push([remaining[0], remaining[1], remaining[2]]);
    Some(ears)
}

/// Returns the largest double area of three points that counts as straight, for a polygon of this size.
fn straight_tolerance(points: &[DVec2]) -> f64 {
    let start = points.first().copied().unwrap_or_default();
    let bounds = points.iter().fold((start, start), |(least, most), &point| {
        (least.min(point), most.max(point))
    });
    let size = (bounds.1 - bounds.0).element_sum();
    MAX_STRAIGHT_AREA * size * size
}

fn double_area_of(points: &[DVec2], [a, b, c]: [usize; 3]) -> f64 {
    double_area(points[a], points[b], points[c])
}

/// Returns whether a corner can be cut off: it is convex, and no other corner lies in its triangle.
fn is_ear(points: &[DVec2], remaining: &[usize], ear: [usize; 3], tolerance: f64) -> bool {
    let [a, b, c] = ear.map(|corner| points[corner]);
    let is_within = |&other: &usize| {
        let p = points[other];
        // Points equal to a corner of the ear come from bridge edges that lead to holes.
        p != a
            && p != b
            && p != c
            && double_area(a, b, p) >= -tolerance
            && double_area(b, c, p) >= -tolerance
            && double_area(c, a, p) >= -tolerance
    };
    double_area(a, b, c) > tolerance && !remaining.iter().any(is_within)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mended(points: &[DVec3]) -> Vec<[u32; 3]> {
        let count = points.len() as u32;
        let mut fan: Vec<[u32; 3]> = (1..count - 1)
            .map(|corner| [0, corner, corner + 1])
            .collect();
        mend_fan(&mut fan, |corner| points[corner as usize]);
        fan
    }

    fn areas(points: &[DVec3], faces: &[[u32; 3]]) -> Vec<DVec3> {
        let corner = |index: u32| points[index as usize];
        let area =
            |&[a, b, c]: &[u32; 3]| (corner(b) - corner(a)).cross(corner(c) - corner(a)) / 2.0;
        faces.iter().map(area).collect()
    }

    /// Total area of the triangles of a mended polygon, and the length of their summed area vectors: equal if no
    /// triangle covers another.
    fn sizes(points: &[DVec3]) -> (f64, f64) {
        let areas = areas(points, &mended(points));
        let whole: DVec3 = areas.iter().sum();
        (areas.iter().map(|area| area.length()).sum(), whole.length())
    }

    #[test]
    fn a_notch_stays_open_seen_from_anywhere() {
        // Its area is 10 of the square's 16, and the fan around its first corner covers the notch.
        let outline = [(0.0, 4.0), (0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (2.0, 1.0)];
        for start in 0..outline.len() {
            for (x, y) in [
                (DVec3::X, DVec3::Y),
                (DVec3::Y, DVec3::Z),
                (DVec3::NEG_Z, DVec3::X),
            ] {
                for is_turned in [false, true] {
                    let place = |place: usize| {
                        let (u, v) = outline[(start + place) % outline.len()];
                        x * u + y * v
                    };
                    let mut points: Vec<DVec3> = (0..outline.len()).map(place).collect();
                    if is_turned {
                        points.reverse();
                    }
                    let areas = areas(&points, &mended(&points));
                    let whole: DVec3 = areas.iter().sum();
                    let sum: f64 = areas.iter().map(|area| area.length()).sum();
                    assert!((sum - 10.0).abs() < 1e-12, "{start}: {sum}");
                    assert!(areas.iter().all(|area| area.dot(whole) > 0.0));
                }
            }
        }
    }

    #[test]
    fn corners_on_straight_edges_are_rounded_and_cut() {
        // An L with extra corners in the middle of its edges, rotated, with eight decimals; its area is 4.
        let outline = [
            (1.782_414_72, -0.907_192_24),
            (0.891_207_36, -0.453_596_12),
            (0.0, 0.0),
            (-0.891_207_36, 0.453_596_12),
            (-0.437_611_24, 1.344_803_48),
            (0.015_984_88, 2.236_010_84),
            (0.907_192_24, 1.782_414_72),
            (0.453_596_12, 0.891_207_36),
            (1.344_803_48, 0.437_611_24),
            (2.236_010_84, -0.015_984_88),
        ];
        let points = outline.map(|(x, y)| DVec3::new(x, y, 0.0));
        let (sum, whole) = sizes(&points);
        assert!((sum - whole).abs() < 1e-6, "{sum} {whole}");
    }

    #[test]
    fn arcs_are_cut_in_a_moment() {
        // A strip along half a circle. If every cut restarted the search at the first corner, this would take
        // seconds.
        let corner = |at: u32| {
            let (along, radius) = if at < 2000 {
                (at, 10.0)
            } else {
                (3999 - at, 9.999)
            };
            let angle = f64::from(along) / 1999.0 * std::f64::consts::PI;
            DVec3::new(angle.cos(), angle.sin(), 0.0) * radius
        };
        let points: Vec<DVec3> = (0..4000).map(corner).collect();
        let (sum, whole) = sizes(&points);
        assert!((sum - whole).abs() < 1e-9, "{sum} {whole}");
    }

    #[test]
    fn stars_are_cut_and_what_is_convex_or_crosses_itself_stays_a_fan() {
        let star = |sides: u32| -> Vec<DVec3> {
            let corner = |at: u32| {
                let angle = f64::from(at) / f64::from(2 * sides) * std::f64::consts::TAU;
                let radius = if at.is_multiple_of(2) { 3.0 } else { 1.0 };
                DVec3::new(angle.cos(), angle.sin(), 0.0) * radius
            };
            (0..2 * sides).map(corner).collect()
        };
        for sides in [3, 5, 40] {
            let points = star(sides);
            let (sum, whole) = sizes(&points);
            assert!((sum - whole).abs() < 1e-9, "{sides}: {sum} {whole}");
        }
        let square = [DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Y, DVec3::Y];
        assert_eq!(mended(&square), [[0, 1, 2], [0, 2, 3]]);
        let bow = [DVec3::ZERO, DVec3::X + DVec3::Y, DVec3::X, DVec3::Y * 0.5];
        assert_eq!(mended(&bow).len(), 2);
    }
}
