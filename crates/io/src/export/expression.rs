//! Boolean expressions without complements, for files that have unions, intersections and differences.
//!
//! ```text
//!   each node as a term, or as everything but a term     a + !b = !(b - a)      !a * !b = !(a + b)
//!                                                        a * !b = a - b         !a ^ b  = !(a ^ b)
//!   a ^ b = (a - b) + (b - a): both sides name the same two terms, so nothing is written out twice
//! ```

use crate::csg::{Node, Op, Tree};

/// One term; it names earlier terms by their places.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Term {
    /// A primitive, by its index.
    Leaf(u32),
    /// Never a symmetric difference.
    Pair(Op, usize, usize),
}

/// An expression: the last term, or its complement.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Expression {
    /// At least one.
    pub terms: Vec<Term>,
    /// The solid is the complement of the last term.
    pub all_but: bool,
}

/// The terms of a tree that holds no constants; linear in its nodes.
///
/// # Panics
/// The tree holds a constant: fold it first.
pub(super) fn expression(tree: &Tree) -> Expression {
    let mut terms = Vec::with_capacity(tree.nodes().len());
    let mut push = |term| {
        terms.push(term);
        terms.len() - 1
    };
    // of each node: a term, and whether the node is everything but it
    let mut known: Vec<(usize, bool)> = Vec::with_capacity(tree.nodes().len());
    for node in tree.nodes() {
        known.push(match *node {
            Node::Constant(_) => panic!("constants are folded before an expression is written"),
            Node::Leaf(p) => (push(Term::Leaf(p)), false),
            Node::Complement(a) => (known[a as usize].0, !known[a as usize].1),
            Node::Pair(op, a, b) => {
                let ((a, not_a), (b, not_b)) = (known[a as usize], known[b as usize]);
                match op {
                    Op::Union => joined(&mut push, (a, !not_a), (b, !not_b), true),
                    Op::Intersection => joined(&mut push, (a, not_a), (b, not_b), false),
                    Op::Difference => joined(&mut push, (a, not_a), (b, !not_b), false),
                    Op::SymmetricDifference => {
                        let (left, right) =
                            (push(Term::Pair(Op::Difference, a, b)), push(Term::Pair(Op::Difference, b, a)));
                        (push(Term::Pair(Op::Union, left, right)), not_a != not_b)
                    }
                }
            }
        });
    }
    let (root, all_but) = known[known.len() - 1];
    debug_assert_eq!(root, terms.len() - 1, "a tree's root is its last node");
    Expression { terms, all_but }
}

/// The intersection of two terms or of their complements; `turned`: the complement of that.
fn joined(
    push: &mut impl FnMut(Term) -> usize,
    (a, not_a): (usize, bool),
    (b, not_b): (usize, bool),
    turned: bool,
) -> (usize, bool) {
    let (term, all_but) = match (not_a, not_b) {
        (false, false) => (Term::Pair(Op::Intersection, a, b), false),
        (false, true) => (Term::Pair(Op::Difference, a, b), false),
        (true, false) => (Term::Pair(Op::Difference, b, a), false),
        (true, true) => (Term::Pair(Op::Union, a, b), true),
    };
    (push(term), all_but != turned)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::csg::parse;
    use proptest::prelude::*;

    /// Whether the expression holds where the primitives of `inside` are.
    fn holds(e: &Expression, inside: u32) -> bool {
        let mut values: Vec<bool> = Vec::new();
        for term in &e.terms {
            values.push(match *term {
                Term::Leaf(p) => inside >> p & 1 == 1,
                Term::Pair(op, a, b) => op.apply(values[a], values[b]),
            });
        }
        values[values.len() - 1] != e.all_but
    }

    fn check(text: &str) -> Expression {
        let tree = parse(text).unwrap().tree;
        let e = expression(&tree);
        for inside in 0..64 {
            assert_eq!(holds(&e, inside), tree.contains(|p| inside >> p & 1 == 1), "{text} at {inside:b}");
        }
        e
    }

    #[test]
    fn complements_become_differences() {
        for (text, terms, all_but) in [
            ("A*!B", 3, false),
            ("!A*B", 3, false),
            ("A+!B", 3, true),
            ("!A+!B", 3, true),
            ("!(A*!B)", 3, true),
            ("A^B", 5, false),
            ("!A^B", 5, true),
            ("!A^!B", 5, false),
            ("(A+B)-(CD-E)^F", 13, false),
            ("!A-!B", 3, false),
        ] {
            let e = check(text);
            assert_eq!((e.terms.len(), e.all_but), (terms, all_but), "{text}");
            let plain = |t: &Term| !matches!(t, Term::Pair(Op::SymmetricDifference, ..));
            assert!(e.terms.iter().all(plain), "{text}");
        }
    }

    #[test]
    fn depth_does_not_matter() {
        let mut b = crate::csg::Builder::new();
        let mut root = b.leaf(0);
        for k in 0..200_000 {
            let leaf = b.leaf(k % 6);
            root = if k % 3 == 0 { b.complement(root) } else { b.pair(Op::Intersection, leaf, root) };
        }
        let tree = b.finish(root).unwrap();
        let e = expression(&tree);
        for inside in 0..64 {
            assert_eq!(holds(&e, inside), tree.contains(|p| inside >> p & 1 == 1));
        }
    }

    proptest! {
        /// Random words of the grammar: `A`, `!x`, `(x op y)`.
        #[test]
        fn every_tree_keeps_its_meaning(steps in prop::collection::vec((0..6u8, 0..4u8, any::<bool>()), 1..40)) {
            let mut text = "A".to_string();
            for (leaf, op, not) in steps {
                let letter = char::from(b'A' + leaf);
                let op = ['+', '*', '-', '^'][op as usize];
                text = if not { format!("!({text}){op}{letter}") } else { format!("{letter}{op}({text})") };
            }
            check(&text);
        }
    }
}
