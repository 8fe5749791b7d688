//! Binary space partitions: decision trees over half-spaces.
//!
//! ```text
//!        H1                 inside H1 to the left, outside to the right;
//!      ╱    ╲               leaves are cells, in or out of the solid
//!     H2     out
//!   ╱   ╲                   seen from a point: the far child, H1's own faces, the near child
//!  in    out
//! ```
//!
//! Source: H. Fuchs, Z. Kedem, B. Naylor, *On visible surface generation by a priori tree structures*,
//! SIGGRAPH 1980; W. Thibault, B. Naylor, *Set operations on polyhedra using binary space partitioning
//! trees*, SIGGRAPH 1987.

use super::tree::{Builder, Node, Op, Tree, TreeError};

/// A node of a partition.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BspNode {
    /// A cell, in the solid or not.
    Cell(bool),
    /// A half-space and the children inside and outside it, which stand further on.
    Split {
        /// Index of the half-space.
        primitive: u32,
        /// The child for points inside.
        inside: u32,
        /// The child for points outside.
        outside: u32,
    },
}

/// The next item, from back to front.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Visit {
    /// A cell.
    Cell(u32),
    /// The border of the half-space of a split, as far as the split's region goes.
    Border(u32),
}

/// A partition; the first node is the root.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bsp {
    nodes: Vec<BspNode>,
}

/// Cells that `n` lines cut a plane into, at most: `1 + n (n + 1) / 2`.
pub fn most_cells(n: u64) -> u64 {
    1 + n * (n + 1) / 2
}

impl Bsp {
    /// Decides the half-spaces of `tree` one after the other, in the order of its leaves. `possible` receives the
    /// decisions on the way to a child, and returns whether any point satisfies them; with `|_| true` there may be
    /// `2^n` cells.
    ///
    /// # Errors
    /// [`TreeError::TooLarge`] when there are more than `most_nodes` nodes.
    pub fn new(
        tree: &Tree,
        most_nodes: usize,
        mut possible: impl FnMut(&[(u32, bool)]) -> bool,
    ) -> Result<Self, TreeError> {
        let mut nodes = vec![BspNode::Cell(false)];
        let mut open = vec![(0, tree.clone(), Vec::new())];
        while let Some((place, rest, decided)) = open.pop() {
            let Some(primitive) = rest.leaves().next() else {
                nodes[place] = BspNode::Cell(rest.as_constant() == Some(true));
                continue;
            };
            let mut child = |value: bool| {
                let mut decided = decided.clone();
                decided.push((primitive, value));
                possible(&decided).then(|| (rest.fold(|p| (p == primitive).then_some(value)), decided))
            };
            match (child(true), child(false)) {
                (Some((a, in_a)), Some((b, in_b))) => {
                    if nodes.len() + 2 > most_nodes {
                        return Err(TreeError::TooLarge);
                    }
                    let first = nodes.len();
                    nodes[place] = BspNode::Split { primitive, inside: first as u32, outside: first as u32 + 1 };
                    nodes.extend([BspNode::Cell(false); 2]);
                    open.extend([(first + 1, b, in_b), (first, a, in_a)]);
                }
                (Some((only, known)), None) | (None, Some((only, known))) => open.push((place, only, known)),
                (None, None) => {}
            }
        }
        Ok(Self { nodes })
    }

    /// The nodes, the root first, children behind their parents.
    pub fn nodes(&self) -> &[BspNode] {
        &self.nodes
    }

    /// Whether a point is in the solid, for `inside(primitive)`.
    pub fn contains(&self, mut inside: impl FnMut(u32) -> bool) -> bool {
        let mut at = 0;
        loop {
            match self.nodes[at as usize] {
                BspNode::Cell(value) => return value,
                BspNode::Split { primitive, inside: yes, outside: no } => at = if inside(primitive) { yes } else { no },
            }
        }
    }

    /// The same solid as an expression: `H * inside + !H * outside` for each split.
    ///
    /// # Errors
    /// [`TreeError::TooLarge`] when the expression is.
    pub fn to_tree(&self) -> Result<Tree, TreeError> {
        let mut b = Builder::new();
        let mut made = vec![0; self.nodes.len()];
        for (i, node) in self.nodes.iter().enumerate().rev() {
            made[i] = match *node {
                BspNode::Cell(value) => b.push(Node::Constant(value)),
                BspNode::Split { primitive, inside, outside } => {
                    let plane = b.leaf(primitive);
                    let left = b.pair(Op::Intersection, plane, made[inside as usize]);
                    let beyond = b.complement(plane);
                    let right = b.pair(Op::Intersection, beyond, made[outside as usize]);
                    b.pair(Op::Union, left, right)
                }
            };
        }
        b.finish(made[0])
    }

    /// All cells and borders in an order in which none hides a later one, for a viewpoint for which `inside(primitive)`
    /// holds.
    pub fn back_to_front(&self, mut inside: impl FnMut(u32) -> bool) -> Vec<Visit> {
        let mut order = Vec::with_capacity(self.nodes.len());
        let mut open = vec![Visit::Cell(0)]; // a `Cell` here is any node still to be entered
        while let Some(visit) = open.pop() {
            match visit {
                Visit::Border(_) => order.push(visit),
                Visit::Cell(node) => match self.nodes[node as usize] {
                    BspNode::Cell(_) => order.push(visit),
                    BspNode::Split { primitive, inside: yes, outside: no } => {
                        let (near, far) = if inside(primitive) { (yes, no) } else { (no, yes) };
                        open.extend([Visit::Cell(near), Visit::Border(node), Visit::Cell(far)]);
                    }
                },
            }
        }
        order
    }
}
