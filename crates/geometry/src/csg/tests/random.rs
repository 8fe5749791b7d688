//! Random expressions, the same on every machine.

use crate::csg::{Builder, Node, Op, Tree};
use crate::math::random::Random;

pub const ALL: [Op; 4] = [Op::Union, Op::Intersection, Op::Difference, Op::SymmetricDifference];
pub const POSITIVE: [Op; 2] = [Op::Union, Op::Intersection];

/// An expression of `leaves` leaves over `primitives` primitives, each node complemented one time in
/// `complements` (never for 0): random neighbours are joined until one is left.
pub fn tree(random: &mut Random, leaves: u32, primitives: u32, ops: &[Op], complements: u32) -> Tree {
    let mut b = Builder::new();
    let mut parts: Vec<u32> =
        (0..leaves).map(|i| b.leaf(if primitives == leaves { i } else { random.integer(0, primitives - 1) })).collect();
    loop {
        let at = random.integer(0, parts.len() as u32 - 1) as usize;
        if complements > 0 && random.integer(1, complements) == 1 {
            parts[at] = b.push(Node::Complement(parts[at]));
        }
        if parts.len() == 1 {
            return b.finish(parts[0]).unwrap();
        }
        let at = random.integer(0, parts.len() as u32 - 2) as usize;
        parts[at] = b.push(Node::Pair(random.pick(ops), parts[at], parts[at + 1]));
        parts.remove(at + 1);
    }
}

/// A chain of `n` leaves: `((0 op 1) op 2) …`, or `0 op (1 op (2 …))`, over primitives `i % 64`.
pub fn chain(n: u32, left: bool, op: impl Fn(u32) -> Op) -> Tree {
    let mut b = Builder::new();
    let mut whole = b.leaf(if left { 0 } else { (n - 1) % 64 });
    for i in 1..n {
        let leaf = b.leaf(if left { i } else { n - 1 - i } % 64);
        let (l, r) = if left { (whole, leaf) } else { (leaf, whole) };
        whole = b.pair(op(i), l, r);
    }
    b.finish(whole).unwrap()
}

/// The value by recursion over the definition: for small trees, and independent of [`Tree::contains`].
pub fn recursive(tree: &Tree, node: u32, bits: u64) -> bool {
    match tree.nodes()[node as usize] {
        Node::Constant(value) => value,
        Node::Leaf(p) => bits >> p & 1 == 1,
        Node::Complement(a) => !recursive(tree, a, bits),
        Node::Pair(op, a, b) => {
            let (l, r) = (recursive(tree, a, bits), recursive(tree, b, bits));
            match op {
                Op::Union => l | r,
                Op::Intersection => l & r,
                Op::Difference => l & !r,
                Op::SymmetricDifference => l ^ r,
            }
        }
    }
}

/// Same function of `primitives` primitives.
pub fn same(a: &Tree, b: &Tree, primitives: u32) -> bool {
    (0..1u64 << primitives).all(|bits| recursive(a, a.root(), bits) == recursive(b, b.root(), bits))
}
