//! How far primitives matter: boxes of expressions, and the boxes in which their operands matter.
//!
//! ```text
//!            A * B                    A - B
//!   ┌─────────────┐            ┌─────────────┐         reach of A:  the reach of the pair, within the box of B
//!   │ A   ┌───────┼────┐       │ A   ┏━━━━━━━┿────┐                 (of !B in A - B)
//!   │     │ both  │    │       │     ┃ here  │    │    reach of B:  ..., within the box of A
//!   └─────┼───────┘    │       └─────╂───────┘    │
//!         │          B │             ┃    matters │
//!         └────────────┘             └────────────┘
//! ```
//!
//! *A leaf may be taken as absent at any point beyond its reach; the whole stays the same.* Boxes only shrink when
//! leaves are removed. So a point outside the box of a node stays outside the node, and one outside the box of its
//! complement stays inside it. A node whose reach holds the point keeps its value: either both children reach it, or
//! the child whose box does not hold it decides the pair.

use super::{Primitive, Solid};
use crate::csg::Node;
use crate::csg::Op::{Difference, Intersection, SymmetricDifference, Union};
use crate::model::Bounds;

/// Boxes around a node and around its complement; and one that is within the node, or empty.
#[derive(Clone, Copy)]
pub(crate) struct Boxes {
    pub of: Bounds,
    pub not: Bounds,
    pub within: Bounds,
}

impl Boxes {
    /// The boxes of a primitive, which is within its [bounds](Primitive::bounds).
    pub(super) fn of(primitive: &Primitive) -> Self {
        Self::around(primitive.bounds())
    }

    /// The boxes of a set within a box, about which no more is known.
    pub fn around(of: Bounds) -> Self {
        Self { of, not: Bounds::ALL, within: Bounds::EMPTY }
    }
}

/// The boxes of each node of the tree. `primitive` says those of a leaf. `known` has tighter boxes of some nodes, each
/// with the node's number, the least number first.
pub(super) fn boxes(solid: &Solid, primitive: impl Fn(&Primitive) -> Boxes, known: &[(usize, Bounds)]) -> Vec<Boxes> {
    let mut boxes: Vec<Boxes> = Vec::with_capacity(solid.tree.nodes().len());
    let mut known = known.iter().peekable();
    for (i, node) in solid.tree.nodes().iter().enumerate() {
        let at = |i: u32| boxes[i as usize];
        let none = Bounds::EMPTY;
        let (of, not, within) = match *node {
            Node::Constant(true) => (Bounds::ALL, none, Bounds::ALL),
            Node::Constant(false) => (none, Bounds::ALL, none),
            Node::Leaf(p) => {
                let Boxes { of, not, within } = primitive(&solid.primitives[p as usize]);
                (of, not, within)
            }
            Node::Complement(a) => (at(a).not, at(a).of, none),
            Node::Pair(op, a, b) => {
                let (l, r) = (at(a), at(b));
                match op {
                    Union => (l.of.union(r.of), meet(l.not, r.not), larger(l.within, r.within)),
                    Intersection => (meet(l.of, r.of), l.not.union(r.not), meet(l.within, r.within)),
                    Difference => (without(meet(l.of, r.not), r.within), l.not.union(r.of), none),
                    SymmetricDifference => {
                        (meet(l.of, r.not).union(meet(l.not, r.of)), meet(l.of, r.of).union(meet(l.not, r.not)), none)
                    }
                }
            }
        };
        let of = known.next_if(|(node, _)| *node == i).map_or(of, |(_, bounds)| meet(of, *bounds));
        boxes.push(Boxes { of, not, within });
    }
    boxes
}

/// See [`Solid::reaches`].
pub(super) fn reaches(solid: &Solid) -> Vec<Bounds> {
    let boxes = boxes(solid, Boxes::of, &[]);
    let mut of_nodes = vec![Bounds::ALL; boxes.len()];
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
                // where one operand leaves the pair's value open
                let (by_a, by_b) = match op {
                    Union => (at(a).not, at(b).not),
                    Intersection => (at(a).of, at(b).of),
                    Difference => (at(a).of, at(b).not),
                    SymmetricDifference => (Bounds::ALL, Bounds::ALL),
                };
                of_nodes[a as usize] = meet(asked, by_b);
                of_nodes[b as usize] = meet(asked, by_a);
            }
        }
    }
    of_primitives
}

/// The intersection of two boxes.
pub(crate) fn meet(a: Bounds, b: Bounds) -> Bounds {
    let both = Bounds { min: a.min.max(b.min), max: a.max.min(b.max) };
    if both.is_empty() { Bounds::EMPTY } else { both }
}

/// The box with the longer diagonal.
fn larger(a: Bounds, b: Bounds) -> Bounds {
    if b.diagonal() > a.diagonal() { b } else { a }
}

/// A box around the rest of a box without a hole: smaller where the hole goes right through it and takes one of its
/// ends.
fn without(of: Bounds, hole: Bounds) -> Bounds {
    if hole.is_empty() {
        return of;
    }
    let (covers_min, covers_max) = (hole.min.cmple(of.min), hole.max.cmpge(of.max));
    let mut left = of;
    for axis in 0..3 {
        let across = (0..3).filter(|a| *a != axis).all(|a| covers_min.test(a) && covers_max.test(a));
        if across && covers_min.test(axis) {
            left.min[axis] = left.min[axis].max(hole.max[axis]);
        }
        if across && covers_max.test(axis) {
            left.max[axis] = left.max[axis].min(hole.min[axis]);
        }
    }
    let nothing = left != of && !left.min.cmplt(left.max).all();
    if nothing { Bounds::EMPTY } else { left }
}
