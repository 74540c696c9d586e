//! Lists with structural sharing: cloning is free, and changing one item copies only its chunk and the table of
//! chunks, however long the list is.

use std::collections::HashSet;
use std::ops::{Index, IndexMut};
use std::sync::Arc;

use serde::de::{Deserialize, Deserializer};
use serde::ser::{Serialize, Serializer};

/// Largest number of items in a chunk, which is copied when any of them changes.
const MAX_CHUNK: usize = 128;

/// Estimated number of bytes of text that an item refers to.
const ITEM_TEXT_BYTES: usize = 32;

/// A list of scene items with structural sharing.
#[derive(Clone, Debug)]
pub struct List<T> {
    chunks: Arc<Vec<Chunk<T>>>,
}

#[derive(Clone, Debug)]
struct Chunk<T> {
    /// Index of the first item.
    start: usize,
    /// The items, at least one.
    items: Arc<Vec<T>>,
}

impl<T: Clone> List<T> {
    /// Creates an empty list.
    pub fn new() -> Self {
        Self {
            chunks: Arc::new(Vec::new()),
        }
    }

    /// Returns whether both share all their items, so that they are equal. May be `false` for equal lists.
    pub fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.chunks, &other.chunks)
    }

    /// The number of items.
    pub fn len(&self) -> usize {
        let last = self.chunks.last();
        last.map_or(0, |chunk| chunk.start + chunk.items.len())
    }

    /// Returns whether the list has no items.
    pub fn is_empty(&self) -> bool {
        self.chunks.is_empty()
    }

    /// Returns the item at `index`, if any.
    pub fn get(&self, index: usize) -> Option<&T> {
        let chunk = &self.chunks.get(self.chunk_of(index)?)?;
        chunk.items.get(index - chunk.start)
    }

    /// Returns the item at `index`, if any, for modification.
    pub fn get_mut(&mut self, index: usize) -> Option<&mut T> {
        let chunk = self.chunk_of(index)?;
        let chunk = Arc::make_mut(&mut self.chunks).get_mut(chunk)?;
        Arc::make_mut(&mut chunk.items).get_mut(index - chunk.start)
    }

    /// Returns the number of the chunk that contains `index`, or would.
    fn chunk_of(&self, index: usize) -> Option<usize> {
        let after = self.chunks.partition_point(|chunk| chunk.start <= index);
        after.checked_sub(1)
    }

    /// The first item.
    pub fn first(&self) -> Option<&T> {
        self.get(0)
    }

    /// The last item.
    pub fn last(&self) -> Option<&T> {
        self.chunks.last().and_then(|chunk| chunk.items.last())
    }

    /// Iterates over all items in order.
    pub fn iter(&self) -> Iter<'_, T> {
        Iter {
            chunks: self.chunks.iter(),
            items: [].iter(),
        }
    }

    /// Iterates over all items in order, for modification. Every shared chunk is copied.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = &mut T> {
        let chunks = Arc::make_mut(&mut self.chunks).iter_mut();
        chunks.flat_map(|chunk| Arc::make_mut(&mut chunk.items).iter_mut())
    }

    /// Appends an item.
    pub fn push(&mut self, item: T) {
        self.insert(self.len(), item);
    }

    /// Inserts an item before the one at `index` ≤ [`Self::len`].
    ///
    /// # Panics
    /// If `index` is too large.
    pub fn insert(&mut self, index: usize, item: T) {
        assert!(index <= self.len(), "no place {index} in the list");
        let Some(chunk_index) = self.chunk_of(index) else {
            *self = std::iter::once(item).collect();
            return;
        };
        let chunks = Arc::make_mut(&mut self.chunks);
        let chunk = &mut chunks[chunk_index];
        let items = Arc::make_mut(&mut chunk.items);
        items.insert(index - chunk.start, item);
        if items.len() > MAX_CHUNK {
            // Filling a list by appending leaves full chunks.
            let half = if index + 1 == chunk.start + items.len() {
                MAX_CHUNK
            } else {
                MAX_CHUNK / 2
            };
            let second = Arc::new(items.split_off(half));
            let start = chunk.start + half;
            chunks.insert(
                chunk_index + 1,
                Chunk {
                    start,
                    items: second,
                },
            );
        }
        renumber(chunks, chunk_index);
    }

    /// Removes and returns the item at `index`.
    ///
    /// # Panics
    /// If `index` is out of range.
    pub fn remove(&mut self, index: usize) -> T {
        assert!(index < self.len(), "no item {index} in the list");
        let chunk_index = self.chunk_of(index).unwrap_or_default();
        let chunks = Arc::make_mut(&mut self.chunks);
        let chunk = &mut chunks[chunk_index];
        let items = Arc::make_mut(&mut chunk.items);
        let item = items.remove(index - chunk.start);
        if items.is_empty() {
            chunks.remove(chunk_index);
        }
        renumber(chunks, chunk_index.saturating_sub(1));
        item
    }

    /// Keeps the first `count` items.
    pub fn truncate(&mut self, count: usize) {
        *self = self.iter().take(count).cloned().collect();
    }

    /// Keeps the items for which `is_wanted` returns true.
    pub fn retain(&mut self, mut is_wanted: impl FnMut(&T) -> bool) {
        *self = self
            .iter()
            .filter(|item| is_wanted(item))
            .cloned()
            .collect();
    }

    /// Removes all items.
    pub fn clear(&mut self) {
        *self = Self::new();
    }

    /// Estimates how many bytes of this list are not shared with another one.
    pub fn unshared_bytes(&self, other: &Self) -> usize {
        let address = |chunk: &Chunk<T>| Arc::as_ptr(&chunk.items);
        let shared: HashSet<_> = other.chunks.iter().map(address).collect();
        let own = self.chunks.iter();
        let own = own.filter(|chunk| !shared.contains(&address(chunk)));
        let items: usize = own.map(|chunk| chunk.items.len()).sum();
        let table = if Arc::ptr_eq(&self.chunks, &other.chunks) {
            0
        } else {
            self.chunks.len()
        };
        items * (size_of::<T>() + ITEM_TEXT_BYTES) + table * size_of::<Chunk<T>>()
    }

    /// Returns the items that may differ from those of `other` at the same index, with their indices; `None` if the
    /// lists are divided into different chunks.
    pub fn changes<'a>(&'a self, other: &'a Self) -> Option<Vec<(usize, &'a T)>> {
        if Arc::ptr_eq(&self.chunks, &other.chunks) {
            return Some(Vec::new());
        }
        if self.chunks.len() != other.chunks.len() {
            return None;
        }
        let mut changes = Vec::new();
        for (own, their) in self.chunks.iter().zip(other.chunks.iter()) {
            if (own.start, own.items.len()) != (their.start, their.items.len()) {
                return None;
            }
            if !Arc::ptr_eq(&own.items, &their.items) {
                changes.extend((own.start..).zip(own.items.iter()));
            }
        }
        Some(changes)
    }
}

/// Recomputes the start indices of the chunks from `first` on.
fn renumber<T>(chunks: &mut [Chunk<T>], first: usize) {
    let mut start = chunks.get(first).map_or(0, |chunk| chunk.start);
    if first == 0 {
        start = 0;
    }
    for chunk in chunks.iter_mut().skip(first) {
        chunk.start = start;
        start += chunk.items.len();
    }
}

/// Iterator over the items of a [`List`].
#[derive(Clone, Debug)]
pub struct Iter<'a, T> {
    chunks: std::slice::Iter<'a, Chunk<T>>,
    items: std::slice::Iter<'a, T>,
}

impl<'a, T> Iterator for Iter<'a, T> {
    type Item = &'a T;

    fn next(&mut self) -> Option<&'a T> {
        loop {
            if let Some(item) = self.items.next() {
                return Some(item);
            }
            self.items = self.chunks.next()?.items.iter();
        }
    }
}

impl<T: Clone> Default for List<T> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T: Clone + PartialEq> PartialEq for List<T> {
    /// Compares only the chunks that are not shared.
    fn eq(&self, other: &Self) -> bool {
        match self.changes(other) {
            Some(changes) => changes
                .into_iter()
                .all(|(index, item)| other.get(index) == Some(item)),
            None => self.len() == other.len() && self.iter().eq(other.iter()),
        }
    }
}

impl<T: Clone> Index<usize> for List<T> {
    type Output = T;
    #[expect(clippy::expect_used, reason = "indexing panics if there is no item")]
    fn index(&self, index: usize) -> &T {
        self.get(index).expect("an item at the index")
    }
}

impl<T: Clone> IndexMut<usize> for List<T> {
    #[expect(clippy::expect_used, reason = "indexing panics if there is no item")]
    fn index_mut(&mut self, index: usize) -> &mut T {
        self.get_mut(index).expect("an item at the index")
    }
}

impl<T: Clone> FromIterator<T> for List<T> {
    fn from_iter<I: IntoIterator<Item = T>>(items: I) -> Self {
        let mut items = items.into_iter();
        let mut chunks = Vec::new();
        let mut start = 0;
        loop {
            let chunk: Vec<T> = items.by_ref().take(MAX_CHUNK).collect();
            let count = chunk.len();
            if count == 0 {
                break;
            }
            let items = Arc::new(chunk);
            chunks.push(Chunk { start, items });
            start += count;
        }
        Self {
            chunks: Arc::new(chunks),
        }
    }
}

impl<T: Clone> From<Vec<T>> for List<T> {
    fn from(items: Vec<T>) -> Self {
        items.into_iter().collect()
    }
}

impl<'a, T: Clone> IntoIterator for &'a List<T> {
    type Item = &'a T;
    type IntoIter = Iter<'a, T>;
    fn into_iter(self) -> Iter<'a, T> {
        self.iter()
    }
}

impl<T: Clone + Serialize> Serialize for List<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        // Serializers need the length before the items.
        let items: Vec<&T> = self.iter().collect();
        items.serialize(serializer)
    }
}

impl<'de, T: Clone + Deserialize<'de>> Deserialize<'de> for List<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Vec::deserialize(deserializer).map(Self::from)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// A list behaves like a vector under any operations, and its clones keep their contents.
        #[test]
        fn a_list_is_a_vector_that_shares(start in 0..400_usize, steps in prop::collection::vec((0..5_u8, 0..1000_usize), 0..60)) {
            let mut list: List<usize> = (0..start).collect();
            let mut vector: Vec<usize> = (0..start).collect();
            let (copy, kept) = (list.clone(), vector.clone());
            for (step, number) in steps {
                let index = number % vector.len().max(1);
                match step {
                    0 => { list.push(number); vector.push(number); }
                    1 => { let at = number % (vector.len() + 1); list.insert(at, number); vector.insert(at, number); }
                    2 if !vector.is_empty() => { prop_assert_eq!(list.remove(index), vector.remove(index)); }
                    3 if !vector.is_empty() => { list[index] = number; vector[index] = number; }
                    4 => { list.retain(|item| item % 7 != 3); vector.retain(|item| item % 7 != 3); }
                    _ => {}
                }
                prop_assert_eq!(list.len(), vector.len());
                prop_assert!(list.iter().eq(vector.iter()));
                prop_assert!((0..vector.len()).all(|index| list.get(index) == vector.get(index)));
                prop_assert_eq!(list.get(vector.len()), None);
                prop_assert_eq!(list.last(), vector.last());
            }
            prop_assert!(copy.iter().eq(kept.iter()), "a copy has changed");
            prop_assert_eq!(list == copy, vector == kept);
        }
    }

    #[test]
    fn a_step_of_undo_weighs_what_it_changed() {
        let before: List<u32> = (0..100_000).collect();
        let mut after = before.clone();
        assert_eq!(after.unshared_bytes(&before), 0);
        after.insert(50, 1);
        after.remove(77_777);
        let changed = 3 * MAX_CHUNK * (size_of::<u32>() + ITEM_TEXT_BYTES);
        let table = after.chunks.len() * size_of::<Chunk<u32>>();
        assert!(after.unshared_bytes(&before) <= changed + table);
        assert!(after.unshared_bytes(&before) > table);
    }

    #[test]
    fn a_change_touches_one_chunk() {
        let before: List<u32> = (0..100_000).collect();
        let mut after = before.clone();
        *after.get_mut(77_777).expect("an item") = 0;
        let changes = after.changes(&before).expect("laid out alike");
        assert!(changes.len() <= MAX_CHUNK && changes.contains(&(77_777, &0)));
        let shared = after.chunks.iter().zip(before.chunks.iter());
        let copied = shared.filter(|(a, b)| !Arc::ptr_eq(&a.items, &b.items));
        assert_eq!(copied.count(), 1);
    }
}
