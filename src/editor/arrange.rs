//! The order of objects: a group is listed in the place of its first member, with all its members.

use std::collections::{HashMap, HashSet};
use std::ops::Range;

use super::item::Item;
use crate::scene::{List, Object, Scene};

/// A move of objects within their list, which is in display order afterwards.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Arrangement {
    /// Indices of the objects that move.
    pub objects: Vec<usize>,
    /// Index of the object next to which they are put; not one of `objects`.
    pub anchor: usize,
    /// Whether they are put after the anchor instead of before it.
    pub is_after: bool,
    /// The group that they are put into, empty for no group; `None` keeps the group of each.
    pub group: Option<String>,
}

impl Arrangement {
    /// Moves objects to the end of the list, into this group.
    pub fn at_end(objects: &List<Object>, moved: &[usize], group: Option<String>) -> Option<Self> {
        let moved_set: HashSet<&usize> = moved.iter().collect();
        let order = display_order(objects);
        let anchor = *order.iter().rfind(|index| !moved_set.contains(index))?;
        Some(Self {
            objects: moved.to_vec(),
            anchor,
            is_after: true,
            group,
        })
    }

    /// Moves an object one step up or down: among the members of its group, or past the neighbouring object or group.
    /// Several objects, all members of one group, move together. `None` if there is nothing to move past.
    pub fn step(objects: &List<Object>, moved: &[usize], is_down: bool) -> Option<Self> {
        let group = &objects.get(*moved.first()?)?.group;
        let members = objects.iter().filter(|object| object.group == *group);
        // The only member of a group moves as the whole group does.
        let moves_as_group = moved.len() > 1 || members.take(2).count() < 2;
        let own_group = if moves_as_group { "" } else { group };
        let moved_set: HashSet<&usize> = moved.iter().collect();
        let mut order = display_order(objects);
        if is_down {
            order.reverse();
        }
        let from = order.iter().position(|index| moved_set.contains(index))?;
        let before = &order[..from];
        let next = *before.last()?;
        let next_group = &objects[next].group;
        if !own_group.is_empty() && own_group != next_group.as_str() {
            return None;
        }
        let is_past_group = own_group.is_empty() && !next_group.is_empty();
        let mut passed = before.iter().copied();
        let anchor = passed
            .find(|&index| index == next || is_past_group && objects[index].group == *next_group)?;
        Some(Self {
            objects: moved.to_vec(),
            anchor,
            is_after: is_down,
            group: None,
        })
    }
}

/// Puts objects into the group of this name: after its members or, if the group is new, where the first of the
/// objects is. An empty name takes them out of their groups. Returns their items in the new order.
pub fn group(scene: &mut Scene, members: &[usize], name: &str) -> Vec<Item> {
    let mut members = put_in_order(scene, members);
    let member_set: HashSet<&usize> = members.iter().collect();
    let is_outsider = |index: &usize| !member_set.contains(index);
    let is_existing_member =
        |index: &usize| is_outsider(index) && scene.objects[*index].group == name;
    let count = scene.objects.len();
    let last = (0..count).rfind(is_existing_member);
    let before = last.or_else(|| members.first()?.checked_sub(1));
    let anchor = before.or_else(|| (0..count).find(is_outsider));
    if let Some(anchor) = anchor.filter(|_| !name.is_empty()) {
        let arrangement = Arrangement {
            objects: members,
            anchor,
            is_after: before.is_some(),
            group: Some(name.to_owned()),
        };
        let arranged = arrange(scene, arrangement).into_iter();
        members = arranged.map(|item| item.index).collect();
    } else {
        for index in &members {
            name.clone_into(&mut scene.objects[*index].group);
        }
    }
    let indices = put_in_order(scene, &members);
    indices.into_iter().map(Item::object).collect()
}

/// Sorts all objects into display order; returns the new indices of those at the indices `tracked`.
fn put_in_order(scene: &mut Scene, tracked: &[usize]) -> Vec<usize> {
    let order = display_order(&scene.objects);
    if !order.is_sorted() {
        reorder(scene, &order);
    }
    let tracked: HashSet<usize> = tracked.iter().copied().collect();
    let positions = order.iter().enumerate();
    let positions = positions.filter(|(_, old_index)| tracked.contains(old_index));
    positions.map(|(index, _)| index).collect()
}

/// Moves objects; returns their items in the new order.
pub fn arrange(scene: &mut Scene, arrangement: Arrangement) -> Vec<Item> {
    let moved: HashSet<usize> = arrangement.objects.into_iter().collect();
    let order = display_order(&scene.objects);
    let (moved, mut order): (Vec<usize>, Vec<usize>) =
        order.into_iter().partition(|index| moved.contains(index));
    let is_in_display_order = order.is_sorted() && moved.is_sorted();
    let anchor = order.iter().position(|index| *index == arrangement.anchor);
    let Some(anchor) = anchor else {
        return Vec::new();
    };
    let at = anchor + usize::from(arrangement.is_after);
    let new_indices = at..at + moved.len();
    if is_in_display_order {
        move_within(&mut scene.objects, &moved, at);
    } else {
        order.splice(at..at, moved);
        reorder(scene, &order);
    }
    if let Some(group) = arrangement.group {
        let whole = if group.is_empty() {
            whole_groups(scene, &new_indices)
        } else {
            HashSet::new()
        };
        for index in new_indices.clone() {
            if !whole.contains(&scene.objects[index].group) {
                scene.objects[index].group.clone_from(&group);
            }
        }
    }
    new_indices.map(Item::object).collect()
}

/// Names of the groups of several objects that are all at these indices: they move as one and stay groups.
fn whole_groups(scene: &Scene, moved: &Range<usize>) -> HashSet<String> {
    let mut counts: HashMap<&str, (usize, usize)> = HashMap::new();
    for (index, object) in scene.objects.iter().enumerate() {
        let (all, inside) = counts.entry(object.group.as_str()).or_default();
        *all += 1;
        *inside += usize::from(moved.contains(&index));
    }
    let whole = counts
        .into_iter()
        .filter(|(_, (all, inside))| *all > 1 && all == inside);
    whole.map(|(group, _)| group.to_owned()).collect()
}

/// Takes out the items at these indices, in ascending order, and inserts them again before the one that is at index
/// `to` by then: one by one, so that the rest of the list stays shared with earlier undo states.
pub fn move_within<T: Clone>(list: &mut List<T>, indices: &[usize], to: usize) {
    let taken = indices.iter().rev().map(|index| list.remove(*index));
    for item in taken.collect::<Vec<_>>() {
        list.insert(to, item);
    }
}

fn reorder(scene: &mut Scene, order: &[usize]) {
    let objects = order.iter().map(|index| scene.objects[*index].clone());
    scene.objects = objects.collect();
}

/// Indices of the objects in display order.
fn display_order(objects: &List<Object>) -> Vec<usize> {
    let mut firsts: HashMap<&str, usize> = HashMap::new();
    let keys = objects.iter().enumerate().map(|(index, object)| {
        let first = match object.group.as_str() {
            "" => index,
            group => *firsts.entry(group).or_insert(index),
        };
        (first, index)
    });
    let mut keys: Vec<(usize, usize)> = keys.collect();
    keys.sort_unstable();
    keys.into_iter().map(|(_, index)| index).collect()
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::scene::Sphere;

    /// Objects of these names, with an optional group in front: `g:a` is `a` in group `g`.
    fn scene(names: &[&str]) -> Scene {
        let mut scene = Scene::empty();
        let ball = Sphere {
            center: DVec3::ZERO,
            radius: 1.0,
        };
        for name in names {
            let (group, name) = name.split_once(':').unwrap_or(("", name));
            let object = Object::new(name, "pack 1", ball);
            scene.objects.push(Object {
                group: group.to_owned(),
                ..object
            });
        }
        scene
    }

    fn names(scene: &Scene) -> Vec<String> {
        let name = |object: &Object| match object.group.as_str() {
            "" => object.name.clone(),
            group => format!("{group}:{}", object.name),
        };
        scene.objects.iter().map(name).collect()
    }

    fn after(objects: &[usize], anchor: usize, group: Option<&str>) -> Arrangement {
        Arrangement {
            objects: objects.to_vec(),
            anchor,
            is_after: true,
            group: group.map(str::to_owned),
        }
    }

    #[test]
    fn the_rest_of_a_group_stays_where_it_is_shown() {
        // Shown: g (a, c), b, d.
        let mut scene = scene(&["g:a", "b", "g:c", "d"]);
        let moved = arrange(&mut scene, after(&[0], 1, Some("")));
        assert_eq!(names(&scene), ["g:c", "b", "a", "d"]);
        assert_eq!(moved, [Item::object(2)]);
    }

    #[test]
    fn a_whole_group_stays_one_wherever_it_goes_with_others() {
        let mut scene = scene(&["g:a", "g:b", "c", "d", "h:e", "h:f"]);
        // All of g and c go behind d, and so does one of h, which leaves it.
        arrange(&mut scene, after(&[0, 1, 2, 4], 3, Some("")));
        assert_eq!(names(&scene), ["d", "g:a", "g:b", "c", "e", "h:f"]);
    }

    #[test]
    fn several_go_together_and_into_the_group_of_what_they_stand_beside() {
        let mut scene = scene(&["a", "g:b", "c", "g:d"]);
        let moved = arrange(&mut scene, after(&[2, 0], 1, Some("g")));
        assert_eq!(names(&scene), ["g:b", "g:a", "g:c", "g:d"]);
        assert_eq!(moved, [1, 2].map(Item::object));
        // One member moves past the others; the group stays.
        let moved = arrange(&mut scene, after(&[0], 3, None));
        assert_eq!(names(&scene), ["g:a", "g:c", "g:d", "g:b"]);
        assert_eq!(moved, [Item::object(3)]);
        assert!(arrange(&mut scene, after(&[0], 9, None)).is_empty());
    }

    #[test]
    fn a_step_goes_past_a_group_and_stays_within_its_own() {
        let mut scene = scene(&["g:a", "b", "g:c", "d"]);
        let mut step = |moved: &[usize], is_down: bool| {
            let step = Arrangement::step(&scene.objects, moved, is_down);
            step.map(|step| arrange(&mut scene, step));
            names(&scene).join(" ")
        };
        assert_eq!(step(&[1], false), "b g:a g:c d");
        assert_eq!(step(&[0], false), "b g:a g:c d", "it is the first");
        assert_eq!(
            step(&[1], false),
            "b g:a g:c d",
            "it is the first of its group"
        );
        assert_eq!(step(&[1], true), "b g:c g:a d");
        assert_eq!(
            step(&[2], true),
            "b g:c g:a d",
            "it is the last of its group"
        );
        assert_eq!(step(&[0], true), "g:c g:a b d");
        assert_eq!(step(&[2], true), "g:c g:a d b");
        // A group moves with all its members.
        assert_eq!(step(&[0, 1], true), "d g:c g:a b");
        assert_eq!(step(&[1, 2], false), "g:c g:a d b");
        assert_eq!(step(&[0, 1], false), "g:c g:a d b", "it is the first");
    }

    #[test]
    fn what_stays_in_its_place_is_shared_with_the_list_before() {
        let names: Vec<String> = (0..10_000).map(|number| format!("Ball {number}")).collect();
        let mut scene = scene(&names.iter().map(String::as_str).collect::<Vec<_>>());
        let before = scene.objects.clone();
        let moved = arrange(&mut scene, after(&[7, 3], 40, None));
        assert_eq!(moved, [39, 40].map(Item::object));
        let moved = [39, 40].map(|index| scene.objects[index].name.clone());
        assert_eq!(moved, ["Ball 3", "Ball 7"]);
        let all = scene.objects.unshared_bytes(&List::new());
        assert!(scene.objects.unshared_bytes(&before) * 4 < all);
        group(&mut scene, &[9_000, 20], "g");
        assert_eq!(scene.objects[21].name, "Ball 9000");
        assert!(scene.objects.unshared_bytes(&before) * 4 < all);
    }

    #[test]
    fn members_of_a_group_stand_where_they_are_listed() {
        let mut other = scene(&["g:a", "g:b", "g:c", "g:d"]);
        let mut scene = scene(&["a", "b", "c", "d"]);
        assert_eq!(group(&mut scene, &[0, 2], "g"), [0, 1].map(Item::object));
        assert_eq!(names(&scene), ["g:a", "g:c", "b", "d"]);
        assert_eq!(group(&mut scene, &[3], "g"), [Item::object(2)]);
        assert_eq!(names(&scene), ["g:a", "g:c", "g:d", "b"]);
        assert_eq!(group(&mut scene, &[1], ""), [Item::object(2)]);
        assert_eq!(names(&scene), ["g:a", "g:d", "c", "b"]);
        assert_eq!(group(&mut scene, &[3, 1], "h"), [1, 2].map(Item::object));
        assert_eq!(names(&scene), ["g:a", "h:d", "h:b", "c"]);
        // Members from the middle of another group go after that group; then all objects form one group.
        assert_eq!(group(&mut other, &[1, 3], "h"), [2, 3].map(Item::object));
        assert_eq!(names(&other), ["g:a", "g:c", "h:b", "h:d"]);
        assert_eq!(group(&mut other, &[0, 1, 2, 3], "i").len(), 4);
        assert_eq!(names(&other), ["i:a", "i:c", "i:b", "i:d"]);
        // In a file, members of a group may be apart.
        scene.objects[3].group = "g".to_owned();
        assert_eq!(group(&mut scene, &[1], ""), [Item::object(2)]);
        assert_eq!(names(&scene), ["g:a", "g:c", "d", "h:b"]);
    }
}
