//! Which entities belong to which, and the ones that nothing drawn leads to.
//!
//! ```text
//!   free ──▶ 144 ──▶ 142 ──▶ 126        reached: an entity that is drawn, or a part of one
//!   412 ──▶ 412 (itself)                a circle: all of it is part of something, so nothing of it is drawn
//!   308 ──▶ 144                         a subfigure that no 408 or array places
//! ```

use std::collections::{HashMap, HashSet};

/// Entities that nothing leads to.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Unreached {
    /// The first entity of each circle.
    pub circles: Vec<u32>,
    /// Subfigures that nothing drawn places.
    pub unplaced: Vec<u32>,
}

/// The entities that are not reached from `roots`. `pairs`: owner and member, in any order; `placeable`: the
/// subfigures. Cost: that of sorting the pairs, or one pass where no circle is possible.
pub(super) fn unreached(roots: &[u32], mut pairs: Vec<(u32, u32)>, placeable: &[u32]) -> Unreached {
    // most writers put every owner behind its members, or every one before
    let ordered =
        pairs.iter().all(|(owner, member)| member < owner) || pairs.iter().all(|(owner, member)| owner < member);
    if ordered && placeable.is_empty() {
        return Unreached::default();
    }
    pairs.sort_unstable();
    let members = |owner: u32| {
        let first = pairs.partition_point(|(o, _)| *o < owner);
        pairs[first..].iter().take_while(move |(o, _)| *o == owner).map(|(_, member)| *member)
    };
    let mut reached: HashSet<u32> = roots.iter().copied().collect();
    let mut waiting = roots.to_vec();
    while let Some(id) = waiting.pop() {
        waiting.extend(members(id).filter(|member| reached.insert(*member)));
    }
    // an unreached member has unreached owners only: the way from owner to owner ends in a circle or without an owner
    let left = pairs.iter().filter(|(_, member)| !reached.contains(member));
    let owner: HashMap<u32, u32> = left.map(|(owner, member)| (*member, *owner)).collect();
    let mut starts: Vec<u32> = owner.keys().copied().collect();
    starts.sort_unstable();
    let (mut seen, mut circles) = (HashSet::new(), Vec::new());
    for start in starts {
        let (mut way, mut at) = (Vec::new(), Some(start));
        while let Some(id) = at.filter(|id| seen.insert(*id)) {
            way.push(id);
            at = owner.get(&id).copied();
        }
        let circle = at.and_then(|end| way.iter().position(|id| *id == end));
        circles.extend(circle.and_then(|first| way[first..].iter().min().copied()));
    }
    circles.sort_unstable();
    let unplaced = placeable.iter().copied().filter(|id| !reached.contains(id)).collect();
    Unreached { circles, unplaced }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn circles_are_found_once_and_unplaced_subfigures_alone() {
        let of = |roots: &[u32], pairs: &[(u32, u32)], placeable: &[u32]| unreached(roots, pairs.to_vec(), placeable);
        assert_eq!(of(&[1, 7], &[(1, 3), (3, 5), (7, 3)], &[]), Unreached::default());
        // itself; two of each other, with a part that hangs on them; a circle that something drawn leads to
        let circles = of(&[1], &[(3, 3), (9, 7), (7, 9), (9, 11), (11, 13), (1, 5), (5, 5)], &[]).circles;
        assert_eq!(circles, [3, 7]);
        // 5 and its members are placed by nothing; 9 places itself only; 21 is placed
        let unplaced = of(&[1], &[(1, 21), (5, 7), (9, 11), (11, 9)], &[5, 9, 21]);
        assert_eq!(unplaced, Unreached { circles: vec![9], unplaced: vec![5, 9] });
    }
}
