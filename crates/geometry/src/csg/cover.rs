//! A few primitives that contain the whole solid.
//!
//! ```text
//!   cover(A * B) = the lighter of cover(A), cover(B)      cover(A + B) = both
//! ```
//!
//! Source: J. Hable, J. Rossignac, *Blister*, SIGGRAPH 2005.

use super::tree::{Node, Op, Tree};

/// Primitives, in tree order, whose union contains the solid, of little total `weight` (the volume or projected area of
/// a primitive). `None` when no finite set is found: a complement is unbounded.
///
/// # Panics
/// When the tree is not [positive](Tree::is_positive).
pub fn covering_set(tree: &Tree, weight: impl Fn(u32) -> f64) -> Option<Vec<u32>> {
    assert!(tree.is_positive(), "covers belong to positive forms");
    let nodes = tree.nodes();
    let mut weights: Vec<f64> = Vec::with_capacity(nodes.len());
    for node in nodes {
        weights.push(match *node {
            Node::Leaf(p) => weight(p),
            Node::Pair(Op::Union, a, b) => weights[a as usize] + weights[b as usize],
            Node::Pair(_, a, b) => weights[a as usize].min(weights[b as usize]),
            Node::Constant(false) => 0.0,
            Node::Complement(_) | Node::Constant(true) => f64::INFINITY,
        });
    }
    let root = nodes.len() - 1;
    if !weights[root].is_finite() {
        return None;
    }
    let mut wanted = vec![false; nodes.len()];
    wanted[root] = true;
    let mut cover = Vec::new();
    for (i, node) in nodes.iter().enumerate().rev().filter(|(i, _)| *i <= root) {
        match *node {
            _ if !wanted[i] => {}
            Node::Leaf(p) => cover.push(p),
            Node::Pair(Op::Union, a, b) => (wanted[a as usize], wanted[b as usize]) = (true, true),
            Node::Pair(_, a, b) => {
                let lighter = if weights[b as usize] < weights[a as usize] { b } else { a };
                wanted[lighter as usize] = true;
            }
            _ => {}
        }
    }
    cover.reverse();
    let mut seen = std::collections::HashSet::new();
    cover.retain(|p| seen.insert(*p));
    Some(cover)
}
