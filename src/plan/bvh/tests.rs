use super::super::grouping::MAX_DEPTH;
use super::*;
use glam::DVec3;
use proptest::prelude::*;

fn vector() -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(-50.0..50.0_f64).prop_map(DVec3::from)
}

fn member((center, reach): (DVec3, f64)) -> Member<f64> {
    Member {
        bounds: BoundingBox {
            low: Vec3::from_dvec3(center - reach),
            high: Vec3::from_dvec3(center + reach),
        },
        thickness: reach,
    }
}

fn tree(members: &[Member<f64>]) -> Bvh<f64> {
    Bvh::new(members.len(), |n| members[n])
}

fn holds(outer: &BoundingBox<f64>, inner: &BoundingBox<f64>) -> bool {
    outer.union(inner) == *outer
}

#[test]
fn numbers_are_rounded_down_by_less_than_a_digit() {
    for number in [0.1, 1e12 / 3.0, 1e300, 1e-45, 1e-300, 0.0, 16_777_217.0] {
        for number in [number, -number] {
            let found = below(number);
            assert!(f64::from(found) <= number, "{found} {number}");
            assert!(f64::from(found.next_up()) > number, "{found} {number}");
        }
    }
}

/// Returns whether a box is no larger than rounding to single precision requires.
fn is_near(outer: &BoundingBox<f64>, inner: &BoundingBox<f64>) -> bool {
    let off = (outer.low - inner.low)
        .max_abs()
        .max((outer.high - inner.high).max_abs());
    off <= 100.0 * f64::from(f32::EPSILON)
}

/// Returns whether every member is held once, and contained in all boxes above it.
fn is_whole(bvh: &Bvh<f64>, members: &[Member<f64>]) -> bool {
    let mut found = vec![0; members.len()];
    let mut waiting: Vec<(u32, BoundingBox<f64>, usize)> = vec![(0, bvh.bounds, 1)];
    while let Some((index, around, depth)) = waiting.pop() {
        let node = &bvh.nodes[index as usize];
        for slot in 0..node.count {
            let fitted = node.get(slot);
            if depth > MAX_DEPTH || !holds(&around, &fitted.bounds) {
                return false;
            }
            match node.child(slot) {
                Child::Node(node) => waiting.push((node, fitted.bounds, depth + 1)),
                Child::Member(member) => {
                    found[member as usize] += 1;
                    let own = &members[member as usize].bounds;
                    if !holds(&fitted.bounds, own) || !is_near(&fitted.bounds, own) {
                        return false;
                    }
                }
            }
        }
    }
    found.iter().all(|&times| times == 1)
}

proptest! {
    #[test]
    fn every_member_is_held_by_all_boxes_above_it(places in prop::collection::vec((vector(), 0.0..5.0_f64), 1..700)) {
        let mut members: Vec<_> = places.into_iter().map(member).collect();
        let mut bvh = tree(&members);
        prop_assert!(is_whole(&bvh, &members));
        let thinnest = members.iter().map(|member| member.thickness).fold(f64::INFINITY, f64::min);
        prop_assert_eq!(bvh.thinnest, f64::from(below(thinnest)));
        for moved in &mut members {
            moved.bounds.high = moved.bounds.high + Vec3::new(1.0, 2.0, 0.0);
        }
        bvh.refit(|n, _| members[n]);
        prop_assert!(is_whole(&bvh, &members));
    }
}

#[test]
fn a_tree_is_kept_while_little_moves() {
    let place = |at: usize| DVec3::new((at % 32) as f64, (at / 32) as f64, 0.0) * 10.0;
    let mut members: Vec<_> = (0..1000).map(|at| member((place(at), 1.0))).collect();
    let bvh = tree(&members);
    members[17] = member((place(40), 1.0));
    let moved = bvh.refitted(|n| members[n]).expect("hardly larger");
    assert!(is_whole(&moved, &members));
    let scattered: Vec<_> = (0..1000)
        .map(|at| member((place(at * 367 % 1000), 1.0)))
        .collect();
    assert!(moved.refitted(|n| scattered[n]).is_none());
}

#[test]
fn a_thousand_members_in_one_place_are_found() {
    let members = vec![member((DVec3::ONE, 1.0)); 1000];
    assert!(is_whole(&tree(&members), &members));
    // Each box contains the previous one: a chain of pairs.
    let nested: Vec<_> = (0..2000)
        .map(|at| member((DVec3::ZERO, f64::from(at))))
        .collect();
    assert!(is_whole(&tree(&nested), &nested));
}

#[test]
fn nodes_are_well_filled() {
    let grid = (0..4096).map(|at| {
        let (x, y) = (f64::from(at % 64), f64::from(at / 64));
        member((DVec3::new(x, y, 0.0), 0.5))
    });
    let bvh = tree(&grid.collect::<Vec<_>>());
    assert!(bvh.nodes.len() < 4096 / 8, "{} nodes", bvh.nodes.len());
}
