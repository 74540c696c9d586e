//! Objects that share a surface, where only rounding would decide which of them is seen.

use glam::DVec3;

use super::list::List;
pub use super::mesh_coincidence::{Coincidence, Overlap};
use super::mesh_coincidence::{boxes_overlap, mesh_coincidences, try_spend, widened};
use super::object::Object;
use super::shape::{Outline, PlanePiece, Shape, Sphere};

/// Largest number of objects that are examined: takes some ten milliseconds.
const MAX_OBJECTS: usize = 200_000;

/// Largest number of pairs of flat objects whose bounding boxes are compared, and of those with overlapping boxes
/// whose surfaces are: takes as long.
const MAX_PAIRS: usize = 4_000_000;
const MAX_COMPARED: usize = 200_000;

/// Returns all pairs of visible objects that share a surface, sorted. Coordinates are taken relative to `centre`.
/// With hundreds of thousands of objects, nothing is examined. Some pairs may be missed with thousands of flat
/// objects in one place, with large meshes, or with hundreds of meshes that overlap tens of thousands of other
/// objects.
pub fn coincidences(objects: &List<Object>, centre: DVec3) -> Vec<Coincidence> {
    if objects.len() > MAX_OBJECTS {
        return Vec::new();
    }
    let (mut comparisons, mut pairs) = (MAX_COMPARED, MAX_PAIRS);
    let mut found = Vec::new();
    let (mut balls, mut endless, mut pieces) = (Vec::new(), Vec::new(), Vec::new());
    for (index, object) in objects.visible() {
        if let Shape::Sphere(ball) = &object.shape {
            balls.push((index, ball));
        }
        if let Some(flat) = object.shape.plane_piece() {
            match object.shape.bounds() {
                Some(bounds) => pieces.push(FlatPiece {
                    index,
                    flat,
                    bounds: widened(bounds),
                }),
                None => endless.push((index, flat)),
            }
        }
    }
    add_balls(balls, &mut found);
    let mut add = |one: (usize, &PlanePiece), other: (usize, &PlanePiece)| {
        if one.1.coincides(other.1, centre) {
            let (earlier, later) = if one.0 < other.0 {
                (one, other)
            } else {
                (other, one)
            };
            found.push(Coincidence {
                later: later.0,
                earlier: earlier.0,
                extent: match earlier.1.outline {
                    Outline::Endless => Overlap::Whole,
                    Outline::Triangle(_) | Outline::Disc(_) => Overlap::Part,
                },
            });
        }
    };
    for (rank, (index, flat)) in endless.iter().enumerate() {
        let others = endless[..rank].iter().map(|(other, flat)| (*other, flat));
        let others = others.chain(pieces.iter().map(|piece| (piece.index, &piece.flat)));
        for other in others.take_while(|_| try_spend(&mut comparisons)) {
            add((*index, flat), other);
        }
    }
    pieces.sort_by(|a, b| a.bounds.0.x.total_cmp(&b.bounds.0.x));
    for (rank, one) in pieces.iter().enumerate() {
        let others = pieces[rank + 1..].iter();
        let near = others.take_while(|other| other.bounds.0.x <= one.bounds.1.x);
        for other in near.take_while(|_| try_spend(&mut pairs)) {
            if boxes_overlap(one.bounds, other.bounds) && try_spend(&mut comparisons) {
                add((one.index, &one.flat), (other.index, &other.flat));
            }
        }
    }
    found.extend(mesh_coincidences(objects, centre));
    found.sort_unstable();
    found
}

/// Adds the spheres that are identical up to rounding, each paired with the first of them in the list.
fn add_balls(mut balls: Vec<(usize, &Sphere)>, found: &mut Vec<Coincidence>) {
    balls.sort_by(|(_, one), (_, other)| one.along().total_cmp(&other.along()));
    let mut is_known = vec![false; balls.len()];
    let mut pairs = MAX_PAIRS;
    for rank in 0..balls.len() {
        if is_known[rank] {
            continue;
        }
        let (index, one) = balls[rank];
        let last = one.along() + one.along_tolerance();
        let others = balls.iter().enumerate().skip(rank + 1);
        let near = others.take_while(|(_, (_, other))| other.along() <= last);
        let near = near.take_while(|_| try_spend(&mut pairs));
        let same = near.filter(|(_, (_, other))| one.is_same(other));
        let same: Vec<(usize, usize)> = same.map(|(rank, (index, _))| (rank, *index)).collect();
        let all = same.iter().map(|(_, index)| *index).chain([index]);
        let earliest = all.clone().min().unwrap_or(index);
        let later = all.filter(|index| *index != earliest);
        found.extend(later.map(|later| Coincidence {
            later,
            earlier: earliest,
            extent: Overlap::Whole,
        }));
        for (rank, _) in same {
            is_known[rank] = true;
        }
    }
}

/// A bounded flat object.
struct FlatPiece {
    index: usize,
    flat: PlanePiece,
    /// Its bounding box, slightly widened.
    bounds: (DVec3, DVec3),
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Disc;

    #[test]
    fn balls_are_one_but_for_their_last_digits_and_the_earliest_stays() {
        let ball = |x: f64, radius: f64| {
            let center = DVec3::new(x, 0.7, -100.0);
            Object::new("Ball", "pack", Sphere { center, radius })
        };
        let same = [
            ball(0.1 + 0.2, 20.0),
            ball(0.3, 20.000_000_000_000_004),
            ball(0.3, 19.0),
            ball(0.3, 20.0),
            ball(0.300_001, 20.0),
        ];
        let found = coincidences(&same.into_iter().collect(), DVec3::ZERO);
        let pairs: Vec<_> = found
            .iter()
            .map(|pair| (pair.later, pair.earlier))
            .collect();
        assert_eq!(pairs, [(1, 0), (3, 0)]);
    }

    #[test]
    fn flat_pieces_fill_one_surface_whichever_way_they_face() {
        for normal in DVec3::AXES {
            let discs = [0.3, 0.1 + 0.2].map(|away| {
                let center = normal * away;
                let disc = Disc {
                    center,
                    normal,
                    radius: 1.0,
                };
                Object::new("Disc", "pack", disc)
            });
            let found = coincidences(&discs.into_iter().collect(), DVec3::ZERO);
            assert_eq!(found.len(), 1, "{normal}");
        }
    }
}
