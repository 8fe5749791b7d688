//! Positive form: unions and intersections of primitives and complemented primitives.
//!
//! ```text
//!   A-B = A * !B      !(A+B) = !A * !B      !(AB) = !A + !B      A^B = A*!B + !A*B      !!A = A
//! ```
//!
//! Complements move down by de Morgan's laws. A symmetric difference needs both senses of both sides:
//! each level of nesting doubles the leaves.

use super::tree::{Builder, Node, Op, Tree, TreeError};

/// Senses in which a node is needed.
const AS_IS: u8 = 1;
const COMPLEMENTED: u8 = 2;

impl Tree {
    /// Holds unions, intersections and complemented leaves only, and constants only as a whole.
    pub fn is_positive(&self) -> bool {
        let nodes = self.nodes();
        self.as_constant().is_some()
            || nodes.iter().all(|node| match *node {
                Node::Constant(_) => false,
                Node::Leaf(_) => true,
                Node::Complement(a) => matches!(nodes[a as usize], Node::Leaf(_)),
                Node::Pair(op, ..) => matches!(op, Op::Union | Op::Intersection),
            })
    }

    /// The equivalent positive form; leaves keep their order (a symmetric difference repeats them).
    ///
    /// # Errors
    /// [`TreeError::TooLarge`] when nested symmetric differences make more than [`Tree::MOST_NODES`]
    /// nodes.
    pub fn positive(&self) -> Result<Self, TreeError> {
        let nodes = self.nodes();
        let swapped = |needs: u8| needs >> 1 | (needs & 1) << 1;
        let mut needs = vec![0u8; nodes.len()];
        needs[nodes.len() - 1] = AS_IS;
        for (i, node) in nodes.iter().enumerate().rev() {
            let (here, both) = (needs[i], AS_IS | COMPLEMENTED);
            match *node {
                Node::Constant(_) | Node::Leaf(_) => {}
                Node::Complement(a) => needs[a as usize] |= swapped(here),
                Node::Pair(op, a, b) => {
                    let (left, right) = match op {
                        Op::Union | Op::Intersection => (here, here),
                        Op::Difference => (here, swapped(here)),
                        Op::SymmetricDifference => (both, both),
                    };
                    needs[a as usize] |= left;
                    needs[b as usize] |= right;
                }
            }
        }
        let mut b = Builder::new();
        // the node as it is and complemented, where needed
        let mut made: Vec<[u32; 2]> = Vec::with_capacity(nodes.len());
        for (node, needs) in nodes.iter().zip(&needs) {
            let mut pair = [u32::MAX; 2];
            for (sense, place) in pair.iter_mut().enumerate().filter(|(sense, _)| needs >> sense & 1 == 1) {
                let of = |child: u32, complemented: bool| made[child as usize][sense ^ usize::from(complemented)];
                // de Morgan: the complement of a union is an intersection of complements
                let op = |as_is: bool| if as_is == (sense == 0) { Op::Union } else { Op::Intersection };
                *place = match *node {
                    Node::Constant(value) => b.push(Node::Constant(value == (sense == 0))),
                    Node::Leaf(p) => {
                        let leaf = b.leaf(p);
                        if sense == 0 { leaf } else { b.complement(leaf) }
                    }
                    Node::Complement(a) => of(a, true),
                    Node::Pair(Op::Union, l, r) => b.pair(op(true), of(l, false), of(r, false)),
                    Node::Pair(Op::Intersection, l, r) => b.pair(op(false), of(l, false), of(r, false)),
                    Node::Pair(Op::Difference, l, r) => b.pair(op(false), of(l, false), of(r, true)),
                    Node::Pair(Op::SymmetricDifference, l, r) => {
                        let [l, l_not] = made[l as usize];
                        let [r, r_not] = made[r as usize];
                        let (r, r_not) = if sense == 0 { (r, r_not) } else { (r_not, r) };
                        let (only_left, only_right) =
                            (b.pair(Op::Intersection, l, r_not), b.pair(Op::Intersection, l_not, r));
                        b.pair(Op::Union, only_left, only_right)
                    }
                };
            }
            made.push(pair);
        }
        b.finish(made[nodes.len() - 1][0])
    }
}
