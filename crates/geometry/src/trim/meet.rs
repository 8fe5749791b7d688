//! Pairs of boxes that meet, among many in the plane.
//!
//! ```text
//!   boxes ──halve at the median centre, along the longer side──▶ tree ──join with itself──▶ pairs of leaves that meet
//! ```
//!
//! Nearly linear where few boxes overlap, however they lie: a row of loops costs no more than loops far apart. Source: C.
//! Ericson, *Real-Time Collision Detection*, 2005, section 6.3: traversing two hierarchies at once.

use glam::DVec2;
use std::ops::Range;

/// A corner and the opposite one; borders belong to it.
pub type Box2 = (DVec2, DVec2);

/// Boxes of a subtree.
struct Node {
    bounds: Box2,
    /// The one box of a leaf.
    leaf: usize,
    /// Empty for a leaf.
    children: Range<usize>,
}

/// Calls `visit` with the numbers of each two boxes that meet, once, until it returns something.
pub fn each_pair<T>(boxes: &[Box2], mut visit: impl FnMut(usize, usize) -> Option<T>) -> Option<T> {
    let mut order: Vec<usize> = (0..boxes.len()).collect();
    let nodes = tree(boxes, &mut order);
    let mut open: Vec<(usize, usize)> = if nodes.is_empty() { Vec::new() } else { vec![(0, 0)] };
    while let Some((a, b)) = open.pop() {
        let (of_a, of_b) = (&nodes[a], &nodes[b]);
        if a == b {
            // with itself: its halves with themselves and with each other
            let children = of_a.children.clone();
            for (i, j) in [(0, 0), (1, 1), (0, 1)] {
                if !children.is_empty() {
                    open.push((children.start + i, children.start + j));
                }
            }
        } else if meet(of_a.bounds, of_b.bounds) {
            match (of_a.children.is_empty(), of_b.children.is_empty()) {
                (true, true) => {
                    let found = visit(of_a.leaf, of_b.leaf);
                    if found.is_some() {
                        return found;
                    }
                }
                (false, other) if other || span(of_a.bounds) >= span(of_b.bounds) => {
                    open.extend(of_a.children.clone().map(|child| (child, b)));
                }
                _ => open.extend(of_b.children.clone().map(|child| (a, child))),
            }
        }
    }
    None
}

/// The root first, the two children of a node side by side.
fn tree(boxes: &[Box2], order: &mut [usize]) -> Vec<Node> {
    let mut nodes = Vec::with_capacity(2 * boxes.len());
    let mut open = Vec::new();
    if !order.is_empty() {
        nodes.push(node(boxes, order));
        open.push((0, 0..order.len()));
    }
    while let Some((index, range)) = open.pop() {
        let part = &mut order[range.clone()];
        if part.len() < 2 {
            continue;
        }
        let (lo, hi) = nodes[index].bounds;
        let axis = usize::from((hi - lo).y > (hi - lo).x);
        let centre = |i: &usize| boxes[*i].0[axis] + boxes[*i].1[axis];
        let half = part.len() / 2;
        part.select_nth_unstable_by(half, |a, b| centre(a).total_cmp(&centre(b)));
        nodes[index].children = nodes.len()..nodes.len() + 2;
        let (low, high) = part.split_at(half);
        open.push((nodes.len(), range.start..range.start + half));
        nodes.push(node(boxes, low));
        open.push((nodes.len(), range.start + half..range.end));
        nodes.push(node(boxes, high));
    }
    nodes
}

fn node(boxes: &[Box2], part: &[usize]) -> Node {
    let union = |(lo, hi): Box2, i: &usize| (lo.min(boxes[*i].0), hi.max(boxes[*i].1));
    Node { bounds: part.iter().fold(boxes[part[0]], union), leaf: part[0], children: 0..0 }
}

fn meet(a: Box2, b: Box2) -> bool {
    a.0.max(b.0).cmple(a.1.min(b.1)).all()
}

fn span((lo, hi): Box2) -> f64 {
    (hi - lo).max_element()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    /// Against all pairs, over boxes of many sizes, points and lines among them, and some that only touch.
    #[test]
    fn every_pair_that_meets_is_visited_once() {
        let mut state = 7_u64;
        let mut below = |n: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((state >> 33) % n) as f64
        };
        for count in [0, 1, 2, 3, 17, 300] {
            let boxes: Vec<Box2> = (0..count)
                .map(|_| {
                    let lo = DVec2::new(below(40), below(40));
                    (lo, lo + DVec2::new(below(4), below(12)))
                })
                .collect();
            let mut found = BTreeSet::new();
            let none: Option<()> = each_pair(&boxes, |a, b| {
                assert!(found.insert((a.min(b), a.max(b))), "{a} and {b} twice");
                None
            });
            assert_eq!(none, None);
            let all = (0..count).flat_map(|a| (a + 1..count).map(move |b| (a, b)));
            let expected: BTreeSet<_> = all.filter(|&(a, b)| meet(boxes[a], boxes[b])).collect();
            assert_eq!(found, expected, "{count} boxes");
        }
    }

    #[test]
    fn the_first_answer_ends_it() {
        let boxes = [(DVec2::ZERO, DVec2::ONE); 9];
        let mut visits = 0;
        let answer = each_pair(&boxes, |_, _| {
            visits += 1;
            (visits == 3).then_some("here")
        });
        assert_eq!((answer, visits), (Some("here"), 3));
    }
}
