//! Active zones: where a primitive matters.
//!
//! ```text
//!          +              path of A:  *, +            Z = I * !U
//!        ╱   ╲            i-nodes:    B    (siblings under intersections)   I = B
//!       *     C           u-nodes:    C    (siblings under unions)          U = C
//!     ╱   ╲
//!    A     B              changing A outside Z = B * !C changes nothing
//! ```
//!
//! Where every primitive occurs once, Z is the Boolean derivative `S|A=1 ^ S|A=0`; where one occurs
//! repeatedly, only the derivative is right. Source: J. Rossignac, H. Voelcker, *Active zones in CSG for
//! accelerating boundary evaluation, redundancy elimination, interference detection, and shading
//! algorithms*, ACM Transactions on Graphics 8, 1989.

use super::tree::{Builder, Node, Op, Tree, TreeError};

/// The way from a leaf to the root of a positive form, and the branches off it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Path {
    /// Pairs above the leaf, nearest first.
    pub ancestors: Vec<u32>,
    /// Siblings under intersections, nearest first.
    pub i_nodes: Vec<u32>,
    /// Siblings under unions, nearest first.
    pub u_nodes: Vec<u32>,
}

impl Tree {
    /// Path and branches of the node `leaf`.
    ///
    /// # Panics
    /// When the tree is not [positive](Tree::is_positive).
    pub fn path(&self, leaf: u32) -> Path {
        assert!(self.is_positive(), "paths belong to positive forms");
        let parents = self.parents();
        let mut path = Path { ancestors: Vec::new(), i_nodes: Vec::new(), u_nodes: Vec::new() };
        let mut node = leaf;
        while node != self.root() {
            let parent = parents[node as usize];
            if let Node::Pair(op, a, b) = self.nodes()[parent as usize] {
                let sibling = if a == node { b } else { a };
                path.ancestors.push(parent);
                let branches = if op == Op::Union { &mut path.u_nodes } else { &mut path.i_nodes };
                branches.push(sibling);
            }
            node = parent;
        }
        path
    }

    /// The active zone `Z = I * !U` of the leaf at node `leaf`, not positive itself.
    ///
    /// # Panics
    /// When the tree is not [positive](Tree::is_positive).
    pub fn zone(&self, leaf: u32) -> Self {
        let path = self.path(leaf);
        let mut b = Builder::new();
        let map = b.copy(self, |b, p| b.leaf(p));
        let branches = |nodes: &[u32]| nodes.iter().map(|n| map[*n as usize]).collect::<Vec<_>>();
        let i = b.fold(Op::Intersection, branches(&path.i_nodes));
        let u = b.fold(Op::Union, branches(&path.u_nodes));
        let zone = b.pair(Op::Difference, i, u);
        b.finish(zone).expect("no more nodes than twice the tree's")
    }

    /// The Boolean derivative `S|P=1 ^ S|P=0`: where primitive `P` decides, however often it occurs.
    ///
    /// # Errors
    /// [`TreeError::TooLarge`] when twice the tree is.
    pub fn derivative(&self, primitive: u32) -> Result<Self, TreeError> {
        let mut b = Builder::new();
        let [with, without] = [true, false].map(|value| {
            let map = b.copy(self, |b, p| if p == primitive { b.push(Node::Constant(value)) } else { b.leaf(p) });
            map[map.len() - 1]
        });
        let derivative = b.pair(Op::SymmetricDifference, with, without);
        b.finish(derivative)
    }

    /// Whether the solid can be written without `primitive`, whatever the primitives are. `None` when
    /// the answer takes more than `most_steps` case distinctions: the question is NP-hard.
    pub fn is_redundant(&self, primitive: u32, most_steps: u32) -> Option<bool> {
        let mut open = vec![self.derivative(primitive).ok()?];
        for _ in 0..=most_steps {
            let Some(case) = open.pop() else { return Some(true) };
            match (case.as_constant(), case.leaves().next()) {
                (Some(true), _) => return Some(false),
                (None, Some(first)) => {
                    let given = |value: bool| case.fold(|p| (p == first).then_some(value));
                    open.extend([given(false), given(true)]);
                }
                _ => {}
            }
        }
        None
    }
}
