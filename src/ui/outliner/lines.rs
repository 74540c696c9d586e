//! The lines of the outliner, created on demand.

use std::collections::HashMap;

use egui_material_icons::MaterialIcon;

use crate::editor::{Item, ItemKind, Selection};
use crate::scene::{List, Object};
use crate::ui::icons;

/// A line of the list.
#[derive(Clone, Copy, Debug)]
pub enum Line {
    Fixed(&'static Selection, MaterialIcon, &'static str),
    /// The title of a list: the number of items in it, and of its rows.
    Title(ItemKind, usize, usize),
    /// A group of objects, by its index in [`Groups`].
    Group(usize),
    /// An item, and whether it is listed as a member of a group.
    Entry(Item, bool),
}

/// A group of objects.
#[derive(Debug, Default)]
pub struct Group {
    /// Its name.
    pub name: String,
    /// Indices of its members.
    pub members: Vec<usize>,
}

impl Group {
    /// Its members as items.
    pub fn items(&self) -> impl ExactSizeIterator<Item = Item> + Clone {
        self.members.iter().map(|&index| Item::object(index))
    }
}

/// The groups of a scene's objects.
#[derive(Debug, Default)]
pub struct Groups {
    /// In the order of their first members.
    pub all: Vec<Group>,
    /// The rows in the list of objects, if some are in groups: groups and objects.
    rows: Vec<Line>,
    objects: List<Object>,
    folded: Vec<String>,
}

impl Groups {
    /// Recomputes the groups and rows if objects or folds have changed; members of groups in `folded` have no rows,
    /// and there are no rows at all without groups. Names of groups that no longer exist are removed from `folded`:
    /// a later group may have the same name.
    pub fn update(&mut self, objects: &List<Object>, folded: &mut Vec<String>) {
        if self.objects.is_same(objects) && self.folded == *folded {
            return;
        }
        *self = Self {
            objects: objects.clone(),
            ..Self::default()
        };
        let mut group_indices: HashMap<&str, usize> = HashMap::new();
        let mut top_rows = Vec::new();
        for (index, object) in objects.iter().enumerate() {
            if object.group.is_empty() {
                top_rows.push(Line::Entry(Item::object(index), false));
                continue;
            }
            let group_index = *group_indices.entry(&object.group).or_insert_with(|| {
                top_rows.push(Line::Group(self.all.len()));
                self.all.push(Group {
                    name: object.group.clone(),
                    members: Vec::new(),
                });
                self.all.len() - 1
            });
            self.all[group_index].members.push(index);
        }
        folded.retain(|name| group_indices.contains_key(name.as_str()));
        self.folded.clone_from(folded);
        if self.all.is_empty() {
            return;
        }
        for row in top_rows {
            self.rows.push(row);
            if let Line::Group(group_index) = row {
                let group = &self.all[group_index];
                if !folded.contains(&group.name) {
                    let members = group.items().map(|item| Line::Entry(item, true));
                    self.rows.extend(members);
                }
            }
        }
    }
}

/// Which items of a kind are listed.
pub enum Entries<'a> {
    /// This many items from the first: all or none.
    All(usize),
    /// Those with these indices, in ascending order.
    Filtered(Vec<usize>),
    /// All objects, some of them in groups.
    Grouped(&'a Groups),
}

/// All lines, created on demand: building a list of ten thousand would take as long as everything else together.
pub struct Lines<'a>(pub [(ItemKind, usize, Entries<'a>); 3]);

/// The rows above the lists of items.
pub static FIXED_ROWS: [(Selection, MaterialIcon, &str); 3] = [
    (Selection::Camera, icons::CAMERA, "Camera"),
    (Selection::World, icons::WORLD, "World"),
    (Selection::Render, icons::IMAGE, "Picture"),
];

impl Entries<'_> {
    pub fn len(&self) -> usize {
        match self {
            Self::All(count) => *count,
            Self::Filtered(indices) => indices.len(),
            Self::Grouped(groups) => groups.rows.len(),
        }
    }

    fn get(&self, kind: ItemKind, row: usize) -> Option<Line> {
        let entry = |index| Line::Entry(Item { kind, index }, false);
        match self {
            Self::All(count) => (row < *count).then_some(row).map(entry),
            Self::Filtered(indices) => indices.get(row).copied().map(entry),
            Self::Grouped(groups) => groups.rows.get(row).copied(),
        }
    }

    pub fn row_of(&self, index: usize) -> Option<usize> {
        match self {
            Self::All(count) => (index < *count).then_some(index),
            Self::Filtered(indices) => indices.binary_search(&index).ok(),
            Self::Grouped(groups) => {
                let mut rows = groups.rows.iter();
                rows.position(|row| matches!(row, Line::Entry(item, _) if item.index == index))
            }
        }
    }
}

impl Lines<'_> {
    pub fn len(&self) -> usize {
        let groups = self.0.iter().map(|(.., entries)| 1 + entries.len());
        FIXED_ROWS.len() + groups.sum::<usize>()
    }

    pub fn get(&self, index: usize) -> Option<Line> {
        if let Some((selection, icon, name)) = FIXED_ROWS.get(index) {
            return Some(Line::Fixed(selection, *icon, name));
        }
        let mut row = index - FIXED_ROWS.len();
        for (kind, count, entries) in &self.0 {
            if row == 0 {
                return Some(Line::Title(*kind, *count, entries.len()));
            }
            row -= 1;
            let line = entries.get(*kind, row);
            if line.is_some() {
                return line;
            }
            row -= entries.len();
        }
        None
    }

    /// The row of an item, if it is listed.
    pub fn row_of(&self, item: Item) -> Option<usize> {
        let mut first = FIXED_ROWS.len();
        for (kind, _, entries) in &self.0 {
            first += 1;
            if *kind == item.kind {
                return Some(first + entries.row_of(item.index)?);
            }
            first += entries.len();
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    #[test]
    fn a_group_that_comes_later_is_not_folded_as_one_that_is_gone() {
        let mut scene = Scene::demo();
        scene.objects[0].group = "pair".to_owned();
        scene.objects[1].group = "pair".to_owned();
        let (mut groups, mut folded) = (Groups::default(), vec!["pair".to_owned()]);
        groups.update(&scene.objects, &mut folded);
        assert_eq!(folded, ["pair"]);
        let grouped = scene.objects.clone();
        scene.objects[0].group.clear();
        scene.objects[1].group.clear();
        groups.update(&scene.objects, &mut folded);
        assert!(folded.is_empty());
        groups.update(&grouped, &mut folded);
        let is_listed = |row: &&Line| matches!(row, Line::Entry(_, true));
        assert_eq!(groups.rows.iter().filter(is_listed).count(), 2);
    }
}
