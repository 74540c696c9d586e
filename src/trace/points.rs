//! The points of a tile that have a sample, numbered in the order in which they are requested.

/// Least number of slots.
const MIN_SLOTS: u32 = 1 << 9;

/// Points of a grid and their numbers: a hash table with open addressing (Knuth, "The Art of Computer Programming",
/// vol. 3, 6.4, algorithm L), which fits into the first-level cache where an array of the whole grid would not.
#[derive(Debug)]
pub struct PointTable {
    /// Column and row of each point, in the order of their numbers.
    points: Vec<[u16; 2]>,
    /// A point in the upper half, 1 + its number in the lower half; 0 for an empty slot. The length is a power of
    /// two.
    slots: Vec<u64>,
}

impl Default for PointTable {
    fn default() -> Self {
        Self {
            points: Vec::new(),
            slots: vec![0; MIN_SLOTS as usize],
        }
    }
}

impl PointTable {
    /// Removes all points.
    pub fn clear(&mut self) {
        self.points.clear();
        self.slots.fill(0);
    }

    /// The points with this number and later ones.
    pub fn starting_at(&self, number: usize) -> &[[u16; 2]] {
        &self.points[number..]
    }

    /// Returns the number of a point, which becomes the next one if it has none yet.
    #[inline(always)]
    pub fn find_or_add(&mut self, x: u16, y: u16) -> u32 {
        let key = u64::from(x) << 16 | u64::from(y);
        let slot = self.slot(key);
        if self.slots[slot] != 0 {
            return self.slots[slot] as u32 - 1;
        }
        let number = self.points.len() as u32;
        self.points.push([x, y]);
        self.slots[slot] = key << 32 | u64::from(number + 1);
        if self.points.len() * 2 > self.slots.len() {
            self.grow();
        }
        number
    }

    /// Returns the number of a point, if it has one.
    #[inline(always)]
    pub fn find(&self, x: u16, y: u16) -> Option<u32> {
        let key = u64::from(x) << 16 | u64::from(y);
        (self.slots[self.slot(key)] as u32).checked_sub(1)
    }

    /// Returns the slot of a point, or the empty one for it.
    #[inline(always)]
    fn slot(&self, key: u64) -> usize {
        let last = self.slots.len() - 1;
        // Fibonacci hashing: the upper bits of a product with 2⁶⁴ over the golden ratio.
        let mixed = key.wrapping_mul(0x9E37_79B9_7F4A_7C15);
        let mut slot = (mixed >> 32) as usize & last;
        while self.slots[slot] != 0 && self.slots[slot] >> 32 != key {
            slot = (slot + 1) & last;
        }
        slot
    }

    #[cold]
    fn grow(&mut self) {
        let length = self.slots.len() * 2;
        for slot in std::mem::replace(&mut self.slots, vec![0; length]) {
            if slot != 0 {
                let index = self.slot(slot >> 32);
                self.slots[index] = slot;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_has_one_number() {
        let mut points = PointTable::default();
        for _ in 0..2 {
            for (x, y) in (0..70).flat_map(|y| (0..90).map(move |x| (x * 32, y * 32))) {
                let number = u32::from(y / 32 * 90 + x / 32);
                assert_eq!(points.find_or_add(x, y), number);
            }
        }
        assert_eq!(
            points.starting_at(6298),
            [[88 * 32, 69 * 32], [89 * 32, 69 * 32]]
        );
        assert_eq!(points.find(89 * 32, 69 * 32), Some(6299));
        assert_eq!(points.find(89 * 32, 70 * 32), None);
        points.clear();
        assert_eq!(points.find_or_add(5, 7), 0);
        assert_eq!(points.find_or_add(7, 5), 1);
        assert_eq!(points.find_or_add(5, 7), 0);
    }
}
