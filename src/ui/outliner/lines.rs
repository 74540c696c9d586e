//! The lines of the outliner, made one by one as they are asked for.

use egui_material_icons::MaterialIcon;

use crate::editor::{Item, Kind, Selection};
use crate::ui::icons;

/// One line of the list.
pub enum Line {
    Single(Selection, MaterialIcon, &'static str),
    Group(Kind, usize),
    Entry(Item),
}

/// Which entries of a group are listed.
pub enum Entries {
    /// The first so many: all of them, or none.
    All(usize),
    /// Those at these indices.
    Some(Vec<usize>),
}

/// All lines, made one by one as they are asked for: a list of ten thousand would take as long as
/// everything else together.
pub struct Lines(pub [(Kind, usize, Entries); 3]);

/// What is above the groups.
pub const SINGLES: [(Selection, MaterialIcon, &str); 3] = [
    (Selection::Camera, icons::CAMERA, "Camera"),
    (Selection::World, icons::WORLD, "World"),
    (Selection::Render, icons::IMAGE, "Picture"),
];

impl Entries {
    pub fn len(&self) -> usize {
        match self {
            Self::All(count) => *count,
            Self::Some(indices) => indices.len(),
        }
    }

    pub fn get(&self, row: usize) -> Option<usize> {
        match self {
            Self::All(count) => (row < *count).then_some(row),
            Self::Some(indices) => indices.get(row).copied(),
        }
    }

    pub fn row_of(&self, index: usize) -> Option<usize> {
        match self {
            Self::All(count) => (index < *count).then_some(index),
            Self::Some(indices) => indices.binary_search(&index).ok(),
        }
    }
}

impl Lines {
    pub fn len(&self) -> usize {
        let groups = self.0.iter().map(|(.., entries)| 1 + entries.len());
        SINGLES.len() + groups.sum::<usize>()
    }

    pub fn get(&self, index: usize) -> Option<Line> {
        if let Some((selection, icon, name)) = SINGLES.get(index) {
            return Some(Line::Single(*selection, *icon, name));
        }
        let mut row = index - SINGLES.len();
        for (kind, count, entries) in &self.0 {
            if row == 0 {
                return Some(Line::Group(*kind, *count));
            }
            row -= 1;
            if let Some(index) = entries.get(row) {
                return Some(Line::Entry(Item { kind: *kind, index }));
            }
            row -= entries.len();
        }
        None
    }
}

impl Lines {
    /// How many entries of a group are listed.
    pub fn listed(&self, kind: Kind) -> usize {
        let mut groups = self.0.iter();
        let group = groups.find(|(group, ..)| *group == kind);
        group.map_or(0, |(.., entries)| entries.len())
    }

    /// The row of an item, if it is listed.
    pub fn row_of(&self, item: Item) -> Option<usize> {
        let mut first = SINGLES.len();
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
