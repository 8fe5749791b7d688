//! The free ranges of one block of memory.
//!
//! ```text
//!   block   ████░░░░██████░░████████░░░░░░░░      ░ free: offset ─▶ bytes, neighbours joined
//!               └ the first range with room for an aligned piece
//! ```

use std::collections::BTreeMap;

/// Free ranges, by offset. None is empty, and no two touch.
#[derive(Debug)]
pub(super) struct FreeList {
    ranges: BTreeMap<u64, u64>,
    /// Bytes of the block.
    all: u64,
}

impl FreeList {
    /// A free block.
    pub(super) fn new(bytes: u64) -> Self {
        Self { ranges: BTreeMap::from([(0, bytes)]), all: bytes }
    }

    /// Where the first piece of so many bytes begins, at a multiple of `alignment`.
    pub(super) fn find(&self, bytes: u64, alignment: u64) -> Option<u64> {
        self.ranges.iter().find_map(|(&offset, &free)| {
            let at = offset.checked_next_multiple_of(alignment.max(1))?;
            (at - offset).checked_add(bytes).is_some_and(|end| end <= free).then_some(at)
        })
    }

    /// Takes that piece.
    pub(super) fn take(&mut self, bytes: u64, alignment: u64) -> Option<u64> {
        let at = self.find(bytes, alignment)?;
        let (&offset, &free) = self.ranges.range(..=at).next_back()?;
        let (end, last) = (at + bytes, offset + free);
        self.ranges.remove(&offset);
        for (from, to) in [(offset, at), (end, last)] {
            if from < to {
                self.ranges.insert(from, to - from);
            }
        }
        Some(at)
    }

    /// Takes a piece back.
    pub(super) fn give(&mut self, offset: u64, bytes: u64) {
        let before = self.ranges.range(..offset).next_back().map(|(&at, &free)| (at, at + free));
        let start = before.filter(|(_, end)| *end == offset).map_or(offset, |(at, _)| at);
        let end = offset + bytes;
        let end = self.ranges.remove(&end).map_or(end, |free| end + free);
        self.ranges.insert(start, end - start);
    }

    /// Free bytes.
    pub(super) fn free(&self) -> u64 {
        self.ranges.values().sum()
    }

    /// Bytes of the block.
    pub(super) fn all(&self) -> u64 {
        self.all
    }

    /// Nothing is taken.
    pub(super) fn is_whole(&self) -> bool {
        self.free() == self.all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_piece_is_aligned_and_the_first_that_fits() {
        let mut list = FreeList::new(1000);
        assert_eq!(list.take(10, 1), Some(0));
        assert_eq!(list.take(100, 64), Some(64));
        // between the two
        assert_eq!(list.take(20, 16), Some(16));
        assert_eq!(list.find(900, 1), None);
        assert_eq!(list.take(836, 1), Some(164));
        assert_eq!(list.free(), 1000 - 10 - 100 - 20 - 836);
        assert_eq!(list.take(29, 1), None, "6 and 28 bytes are left, apart");
        assert_eq!(list.take(28, 1), Some(36));
    }

    #[test]
    fn neighbours_join() {
        for order in [[0, 1, 2], [2, 1, 0], [0, 2, 1], [1, 0, 2]] {
            let mut list = FreeList::new(300);
            (0..3).for_each(|k| assert_eq!(list.take(100, 4), Some(100 * k)));
            assert_eq!((list.find(1, 1), list.is_whole()), (None, false));
            order.into_iter().for_each(|k| list.give(100 * k, 100));
            assert!(list.is_whole() && list.find(300, 1) == Some(0), "{order:?}");
        }
    }

    /// Pieces never overlap, and the block is whole when all have come back.
    #[test]
    fn pieces_do_not_overlap() {
        const BYTES: u64 = 4096;
        let (mut list, mut taken, mut random) = (FreeList::new(BYTES), Vec::<(u64, u64)>::new(), 1u64);
        let mut next = |below: u64| {
            random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (random >> 33) % below
        };
        let mut refused = 0;
        for _ in 0..2000 {
            if next(3) == 0 && !taken.is_empty() {
                let (at, bytes) = taken.swap_remove(next(taken.len() as u64) as usize);
                list.give(at, bytes);
                continue;
            }
            let (bytes, alignment) = (1 + next(200), 1 << next(8));
            let Some(at) = list.take(bytes, alignment) else {
                refused += 1;
                continue;
            };
            assert!(at % alignment == 0 && at + bytes <= BYTES);
            assert!(taken.iter().all(|(other, length)| at + bytes <= *other || other + length <= at), "{at}, {bytes}");
            taken.push((at, bytes));
            assert_eq!(list.free(), BYTES - taken.iter().map(|(_, bytes)| bytes).sum::<u64>());
        }
        assert!(refused > 10 && taken.len() > 5, "{refused}, {}", taken.len());
        taken.into_iter().for_each(|(at, bytes)| list.give(at, bytes));
        assert!(list.is_whole());
    }
}
