//! How far primitives matter: boxes of expressions, and boxes that expressions leave of their parts.
//!
//! ```text
//!            A * B                    A - B
//!   ┌─────────────┐            ┌─────────────┐         reach of A:  what is asked of the pair, within the box of B
//!   │ A   ┌───────┼────┐       │ A   ┏━━━━━━━┿────┐                 (of !B in A - B)
//!   │     │ both  │    │       │     ┃ here  │    │    reach of B:  ..., within the box of A
//!   └─────┼───────┘    │       └─────╂───────┘    │
//!         │          B │             ┃    matters │
//!         └────────────┘             └────────────┘
//! ```
//!
//! *Leaves may be taken for their outsides wherever a point is beyond their reach; the whole stays what it is.* Boxes
//! only shrink when leaves are taken away, so a point outside the box of a node stays outside the node, and one outside
//! the box of its complement stays inside it. A node whose reach holds the point keeps its value: either both children
//! reach it, or the pair is decided by the child whose box does not hold it.

use super::Solid;
use crate::csg::Node;
use crate::csg::Op::{Difference, Intersection, SymmetricDifference, Union};
use crate::model::Bounds;
use glam::DVec3;

/// All of space.
const ALL: Bounds = Bounds { min: DVec3::NEG_INFINITY, max: DVec3::INFINITY };

/// Boxes around a node, and around all that it is not.
#[derive(Clone, Copy)]
pub(super) struct Boxes {
    pub of: Bounds,
    not: Bounds,
}

/// Of each node of the tree.
pub(super) fn boxes(solid: &Solid) -> Vec<Boxes> {
    let mut boxes: Vec<Boxes> = Vec::with_capacity(solid.tree.nodes().len());
    for node in solid.tree.nodes() {
        let at = |i: u32| boxes[i as usize];
        let (of, not) = match *node {
            Node::Constant(true) => (ALL, Bounds::EMPTY),
            Node::Constant(false) => (Bounds::EMPTY, ALL),
            Node::Leaf(p) => (solid.primitives[p as usize].bounds(), ALL),
            Node::Complement(a) => (at(a).not, at(a).of),
            Node::Pair(op, a, b) => {
                let (l, r) = (at(a), at(b));
                match op {
                    Union => (l.of.union(r.of), meet(l.not, r.not)),
                    Intersection => (meet(l.of, r.of), l.not.union(r.not)),
                    Difference => (meet(l.of, r.not), l.not.union(r.of)),
                    SymmetricDifference => {
                        (meet(l.of, r.not).union(meet(l.not, r.of)), meet(l.of, r.of).union(meet(l.not, r.not)))
                    }
                }
            }
        };
        boxes.push(Boxes { of, not });
    }
    boxes
}

/// See [`Solid::reaches`].
pub(super) fn reaches(solid: &Solid) -> Vec<Bounds> {
    let boxes = boxes(solid);
    let mut of_nodes = vec![ALL; boxes.len()];
    let mut of_primitives = vec![Bounds::EMPTY; solid.primitives.len()];
    for (i, node) in solid.tree.nodes().iter().enumerate().rev() {
        let asked = of_nodes[i];
        let at = |i: u32| boxes[i as usize];
        match *node {
            Node::Constant(_) => {}
            Node::Leaf(p) => {
                let all = &mut of_primitives[p as usize];
                *all = all.union(meet(asked, boxes[i].of));
            }
            Node::Complement(a) => of_nodes[a as usize] = asked,
            Node::Pair(op, a, b) => {
                // where the value of the one leaves the pair open
                let (by_a, by_b) = match op {
                    Union => (at(a).not, at(b).not),
                    Intersection => (at(a).of, at(b).of),
                    Difference => (at(a).of, at(b).not),
                    SymmetricDifference => (ALL, ALL),
                };
                of_nodes[a as usize] = meet(asked, by_b);
                of_nodes[b as usize] = meet(asked, by_a);
            }
        }
    }
    of_primitives
}

fn meet(a: Bounds, b: Bounds) -> Bounds {
    let both = Bounds { min: a.min.max(b.min), max: a.max.min(b.max) };
    if both.is_empty() { Bounds::EMPTY } else { both }
}
