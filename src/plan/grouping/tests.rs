use super::*;

/// How often each member is held, and the depth of the deepest node.
fn found(groups: &[WideNode], length: usize) -> (Vec<u32>, usize) {
    let (mut found, mut max_depth) = (vec![0; length], 0);
    let mut waiting = vec![(0, 1)];
    while let Some((index, depth)) = waiting.pop() {
        let group: &WideNode = &groups[index as usize];
        max_depth = max_depth.max(depth);
        for child in &group.children[..group.count] {
            match *child {
                Child::Node(node) => waiting.push((node, depth + 1)),
                Child::Member(member) => found[member as usize] += 1,
            }
        }
    }
    (found, max_depth)
}

#[test]
fn boxes_in_one_place_go_together_two_by_two_and_not_one_by_one() {
    let alike = vec![Aabb::new(Vec3A::ZERO, Vec3A::ONE); 3_000];
    assert!(are_many_coincident(&alike));
    let groups = widen(&build_pairs(alike), MAX_DEPTH).expect("a tree that is not deep");
    let (found, max_depth) = found(&groups, 3_000);
    assert!(found.iter().all(|&times| times == 1));
    assert!(max_depth <= 12, "{max_depth}");
    let apart = (0..3_000_u16).map(|x| Vec3A::X * f32::from(x));
    let apart: Vec<_> = apart.map(|at| Aabb::new(at, at + Vec3A::ONE)).collect();
    assert!(!are_many_coincident(&apart));
}

#[test]
fn boxes_of_which_few_are_joined_at_a_time_are_parted() {
    let count = 3_000_u16;
    let unit = |at: Vec3A| Aabb::new(at, at + Vec3A::ONE);
    let row = |x: u16| unit(Vec3A::X * f32::from(x));
    let nested = |x: u16| Aabb::new(Vec3A::ZERO, Vec3A::splat(1.0 + f32::from(x)));
    let grid = |x: u16| unit(Vec3A::new(f32::from(x % 50), f32::from(x / 50), 0.0) * 1.5);
    let makes: [(&dyn Fn(u16) -> Aabb, bool); 3] = [(&row, true), (&nested, true), (&grid, false)];
    for (make, is_slow) in makes {
        let boxes: Vec<Aabb> = (0..count).map(make).collect();
        let members: Vec<u32> = (0..count.into()).collect();
        assert_eq!(
            are_joined_singly(&boxes, &members),
            is_slow,
            "{:?}",
            boxes[1]
        );
        let (found, max_depth) = found(&group_boxes(&boxes), boxes.len());
        assert!(found.iter().all(|&times| times == 1));
        assert!(max_depth <= MAX_DEPTH, "{max_depth}");
    }
}

#[test]
fn very_many_boxes_are_parted_first_and_all_of_them_found() {
    let count = PARTITION_THRESHOLD + 1_000;
    let place = |at: usize| Vec3A::new((at % 371) as f32, (at / 371) as f32, 0.0);
    let boxes: Vec<_> = (0..count).map(place).collect();
    let boxes: Vec<_> = boxes.iter().map(|&at| Aabb::new(at, at + 0.5)).collect();
    let groups = group_boxes(&boxes);
    let (found, max_depth) = found(&groups, count);
    assert!(found.iter().all(|&times| times == 1));
    assert!(max_depth <= 9, "{max_depth}");
    assert_eq!(groups[0].count, GROUP);
    // Adjacent parts overlap no more than by an edge.
    let mut members: Vec<u32> = (0..count as u32).collect();
    let around = split_into_parts(&boxes, &mut members)
        .into_iter()
        .map(|part| {
            let own = part.iter().map(|&member| boxes[member as usize]);
            own.fold(Aabb::empty(), |around, one| around.union(&one))
        });
    let areas: f32 = around.map(|around| around.half_area()).sum();
    let all = boxes.iter().fold(Aabb::empty(), |all, one| all.union(one));
    assert!(areas < 1.05 * all.half_area(), "{areas}");
}

#[test]
fn a_list_becomes_a_flat_tree() {
    for length in [1, 2, 15, 16, 17, 255, 256, 257, 2999] {
        let order: Vec<u32> = (0..length).collect();
        let (found, max_depth) = found(&group_by_order(&order), length as usize);
        assert!(found.iter().all(|&times| times == 1), "{length}");
        assert!(max_depth <= 4, "{length}: {max_depth}");
    }
}
