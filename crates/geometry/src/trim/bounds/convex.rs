//! Corners of the convex parts of Boolean solids: blocks that half-spaces cut, and half-spaces by themselves.
//!
//! ```text
//!        ╱╲ half-spaces
//!    ┌──╱──╲──┐ block        Intersections, and differences of a half-space, make parts. Readers make such blocks
//!    │ ╱    ╲ │              larger than the part, so that no side of the block is one of the part. Half-spaces that
//!    └╱──────╲┘              enclose something by themselves are a part, too.
//! ```

use super::polyhedron::{self, Plane};
use crate::csg::{Node, Op};
use crate::model::{Primitive, Shape, Solid};
use glam::DVec3;

/// A convex part of a solid.
pub(super) struct Part {
    /// Its node in the tree.
    pub node: usize,
    /// Its corners, each at least three times; none where a block has nothing left.
    pub corners: Vec<DVec3>,
}

/// The parts of a solid that are blocks and half-spaces, each as large as possible, in the order of their nodes.
pub(super) fn parts(solid: &Solid) -> Vec<Part> {
    let nodes = solid.tree().nodes();
    let shape = |node: u32| match nodes[node as usize] {
        Node::Leaf(p) => Some(&solid.primitives()[p as usize].shape),
        _ => None,
    };
    let is_half_space = |node: u32| matches!(shape(node), Some(Shape::HalfSpace { .. }));
    // where the leaves of a convex node begin, whether it is within a larger one, and whether a leaf is taken away
    let mut first: Vec<Option<usize>> = Vec::with_capacity(nodes.len());
    let (mut is_within, mut is_taken) = (vec![false; nodes.len()], vec![false; nodes.len()]);
    for (i, node) in nodes.iter().enumerate() {
        let begin = match *node {
            Node::Leaf(_) => {
                matches!(shape(i as u32), Some(Shape::HalfSpace { .. } | Shape::Block { .. })).then_some(i)
            }
            Node::Pair(Op::Intersection, a, b) => first[a as usize].filter(|_| first[b as usize].is_some()),
            Node::Pair(Op::Difference, a, b) => first[a as usize].filter(|_| is_half_space(b)),
            _ => None,
        };
        if let (Node::Pair(op, a, b), true) = (node, begin.is_some()) {
            is_within[*a as usize] = true;
            is_within[*b as usize] = true;
            is_taken[*b as usize] = *op == Op::Difference;
        }
        first.push(begin);
    }
    let whole = first.iter().enumerate().filter(|(node, _)| !is_within[*node]);
    let several = whole.filter_map(|(node, first)| Some((*first)?..=node).filter(|range| range.start() < range.end()));
    let of = |range: std::ops::RangeInclusive<usize>| {
        let node = *range.end();
        let leaves = range.filter_map(|i| match nodes[i] {
            Node::Leaf(p) => Some((&solid.primitives()[p as usize], is_taken[i])),
            _ => None,
        });
        corners(leaves).map(|corners| Part { node, corners })
    };
    several.filter_map(of).collect()
}

/// The corners of the intersection of blocks and half-spaces, or of their complements; `None` where half-spaces alone
/// leave it open, and where they are too many.
fn corners<'p>(leaves: impl Iterator<Item = (&'p Primitive, bool)>) -> Option<Vec<DVec3>> {
    let (mut all, mut within): (Vec<Plane>, _) = (Vec::new(), None);
    for (primitive, is_taken) in leaves {
        let to_own = primitive.to_own()?;
        let mut push = |normal: DVec3, offset: f64| {
            let (normal, offset) = (to_own.matrix3.transpose() * normal, offset - normal.dot(to_own.translation));
            let sign = if is_taken { -1.0 } else { 1.0 };
            all.push((normal * sign / normal.length(), offset * sign / normal.length()));
        };
        match &primitive.shape {
            Shape::HalfSpace { normal, offset } => push(*normal, *offset),
            Shape::Block { min, max } => {
                within = Some(primitive.bounds());
                for axis in DVec3::AXES {
                    push(axis, axis.dot(*max));
                    push(-axis, -axis.dot(*min));
                }
            }
            _ => return None,
        }
    }
    let are_planes = all.iter().all(|(normal, offset)| normal.is_finite() && offset.is_finite());
    match within {
        _ if !are_planes => None,
        None => polyhedron::alone(&all),
        Some(within) if within.is_empty() => None,
        Some(within) => polyhedron::between(&all, within),
    }
}
