//! The order in which leaves are drawn if each is drawn by itself.

use crate::abi::constants::trimmed_leaf::UNOWNED;
use crate::abi::{LEAF_NEGATIVE, Leaf};

/// The order of drawing. Of faces at the same depth the first wins, so leaves that add come before leaves that
/// subtract; within both, the order of the tree. If leaves share a surface (`shared`), all of them come again, for
/// faces that no leaf owns.
pub(crate) fn order(leaves: &[Leaf], shared: bool) -> Vec<u32> {
    let negative = |of: bool| {
        (0..).zip(leaves).filter(move |(_, leaf)| (leaf.flags & LEAF_NEGATIVE != 0) == of).map(|(i, _): (u32, _)| i)
    };
    let once: Vec<u32> = negative(false).chain(negative(true)).collect();
    let again = once.iter().map(|i| i | UNOWNED);
    if shared { once.iter().copied().chain(again).collect() } else { once }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn those_that_add_come_first() {
        let leaf = |flags| Leaf { flags, ..Leaf::default() };
        let leaves = [leaf(LEAF_NEGATIVE), leaf(0), leaf(LEAF_NEGATIVE), leaf(0)];
        assert_eq!(order(&leaves, false), [1, 3, 0, 2]);
        assert_eq!(order(&leaves, true), [1, 3, 0, 2, 1 | UNOWNED, 3 | UNOWNED, UNOWNED, 2 | UNOWNED]);
    }
}
