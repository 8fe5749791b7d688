//! A solid as a union: its operands.
//!
//! ```text
//!   (A + (B - C)) + D       operands: A, B - C, D
//!   nodes  A B C - + D +    each a range of nodes that ends with its root
//! ```

use super::{Primitive, Solid, SolidError};
use crate::csg::{Builder, Node, Op};
use std::collections::BTreeMap;

/// The operands of unions at a solid's root.
pub struct Operands<'a> {
    solid: &'a Solid,
    /// First node below each node.
    starts: Vec<u32>,
    roots: Vec<u32>,
}

impl<'a> Operands<'a> {
    pub fn of(solid: &'a Solid) -> Self {
        let nodes = solid.tree().nodes();
        let mut starts: Vec<u32> = Vec::with_capacity(nodes.len());
        for (i, node) in (0..).zip(nodes) {
            starts.push(match *node {
                Node::Pair(_, a, _) | Node::Complement(a) => starts[a as usize],
                Node::Leaf(_) | Node::Constant(_) => i,
            });
        }
        let (mut roots, mut open) = (Vec::new(), vec![solid.tree().root()]);
        while let Some(root) = open.pop() {
            match nodes[root as usize] {
                Node::Pair(Op::Union, a, b) => open.extend([b, a]),
                _ => roots.push(root),
            }
        }
        Self { solid, starts, roots }
    }

    /// Their roots, in the order of the expression.
    pub fn roots(&self) -> &[u32] {
        &self.roots
    }

    fn below(&self, root: u32) -> &'a [Node] {
        &self.solid.tree().nodes()[self.starts[root as usize] as usize..=root as usize]
    }

    /// The primitives of an operand.
    pub fn primitives(&self, root: u32) -> impl Iterator<Item = &'a Primitive> {
        let leaves = self.below(root).iter().filter_map(|n| if let Node::Leaf(p) = n { Some(*p) } else { None });
        leaves.map(|p| &self.solid.primitives()[p as usize])
    }

    /// The union of some operands, with their primitives alone.
    ///
    /// # Errors
    /// [`SolidError`] when the expression becomes too large.
    pub fn union(&self, roots: &[u32]) -> Result<Solid, SolidError> {
        let mut place: BTreeMap<u32, u32> = BTreeMap::new();
        let mut primitives = Vec::new();
        let mut builder = Builder::new();
        let mut tops = Vec::with_capacity(roots.len());
        for &root in roots {
            let first = self.starts[root as usize];
            let mut map: Vec<u32> = Vec::new();
            for node in self.below(root) {
                let of = |child: u32, map: &[u32]| map[(child - first) as usize];
                let new = match *node {
                    Node::Constant(_) => builder.push(*node),
                    Node::Leaf(p) => {
                        let to = *place.entry(p).or_insert_with(|| {
                            primitives.push(self.solid.primitives()[p as usize].clone());
                            primitives.len() as u32 - 1
                        });
                        builder.leaf(to)
                    }
                    Node::Complement(a) => builder.complement(of(a, &map)),
                    Node::Pair(op, a, b) => builder.pair(op, of(a, &map), of(b, &map)),
                };
                map.push(new);
            }
            tops.extend(map.last());
        }
        let root = builder.fold(Op::Union, tops);
        Solid::new(primitives, builder.finish(root)?)
    }
}
