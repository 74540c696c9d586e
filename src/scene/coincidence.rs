//! Objects that fill the same surface: which of them is seen there, rounding would decide.

use std::collections::HashMap;

use glam::DVec3;

use super::list::List;
pub use super::mesh_coincidence::{Coincidence, Extent};
use super::mesh_coincidence::{counts_down, meet, mesh_coincidences, widened};
use super::object::Object;
use super::shape::{Outline, PlanePiece, Shape};

/// Most objects that are looked at: some ten milliseconds.
const MOST_OBJECTS: usize = 200_000;

/// Most pairs of flat objects whose boxes are held against each other, and most of those that meet which are: as long.
const MOST_PAIRS: usize = 4_000_000;
const MOST_COMPARED: usize = 200_000;

/// All pairs of visible objects that fill the same surface, sorted; coordinates count from `centre`. Where there are
/// hundreds of thousands of objects, none is looked at; of thousands of flat ones in the same place, faces of large
/// meshes, or hundreds of meshes across tens of thousands of others, some may be missed.
pub fn coincidences(objects: &List<Object>, centre: DVec3) -> Vec<Coincidence> {
    if objects.len() > MOST_OBJECTS {
        return Vec::new();
    }
    let (mut left, mut pairs) = (MOST_COMPARED, MOST_PAIRS);
    let visible = objects.iter().enumerate();
    let visible = visible.filter(|(_, object)| object.visible);
    let mut found = Vec::new();
    let mut balls: HashMap<[u64; 4], usize> = HashMap::new();
    let (mut endless, mut pieces) = (Vec::new(), Vec::new());
    for (index, object) in visible {
        if let Shape::Sphere(ball) = &object.shape {
            let [x, y, z] = ball.center.to_array();
            let same = balls.entry([x, y, z, ball.radius].map(f64::to_bits));
            let earlier = *same.or_insert(index);
            if earlier != index {
                found.push(Coincidence {
                    later: index,
                    earlier,
                    extent: Extent::Whole,
                });
            }
        }
        if let Some(flat) = object.shape.plane_piece() {
            match object.shape.bounds() {
                Some(bounds) => pieces.push(Piece {
                    index,
                    flat,
                    around: widened(bounds),
                }),
                None => endless.push((index, flat)),
            }
        }
    }
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
                    Outline::Endless => Extent::Whole,
                    Outline::Triangle(_) | Outline::Disc(_) => Extent::Part,
                },
            });
        }
    };
    for (place, (index, flat)) in endless.iter().enumerate() {
        let others = endless[..place].iter().map(|(other, flat)| (*other, flat));
        let others = others.chain(pieces.iter().map(|piece| (piece.index, &piece.flat)));
        for other in others.take_while(|_| counts_down(&mut left)) {
            add((*index, flat), other);
        }
    }
    pieces.sort_by(|a, b| a.around.0.x.total_cmp(&b.around.0.x));
    for (place, one) in pieces.iter().enumerate() {
        let others = pieces[place + 1..].iter();
        let near = others.take_while(|other| other.around.0.x <= one.around.1.x);
        for other in near.take_while(|_| counts_down(&mut pairs)) {
            if meet(one.around, other.around) && counts_down(&mut left) {
                add((one.index, &one.flat), (other.index, &other.flat));
            }
        }
    }
    found.extend(mesh_coincidences(objects, centre));
    found.sort_unstable();
    found
}

/// A flat object that ends.
struct Piece {
    index: usize,
    flat: PlanePiece,
    /// The box around it, a little wider than it is.
    around: (DVec3, DVec3),
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Disc;

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
