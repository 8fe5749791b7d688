//! Lists of switches against the trees they come from.

use super::random::{ALL, chain, recursive, same, tree};
use crate::csg::{Blist, Builder, Entry, Node, Op, Tree};
use crate::math::random::Random;

#[test]
fn the_figure_of_the_module() {
    let mut b = Builder::new();
    let leaves = [0, 1, 2].map(|p| b.leaf(p));
    let not = b.complement(leaves[2]);
    let sum = b.pair(Op::Union, leaves[1], not);
    let root = b.pair(Op::Intersection, leaves[0], sum);
    let list = Blist::new(&b.finish(root).unwrap()).unwrap();
    let next_in = Entry::NEXT_WHEN_IN;
    let expected = [(next_in, 3), (1, 4), (2 | Entry::NEGATIVE, 4)].map(|(what, other)| Entry { what, other });
    assert_eq!(list.entries(), expected);
    assert_eq!(std::mem::size_of::<Entry>(), 8);
}

#[test]
fn constants_have_no_entries() {
    for value in [false, true] {
        let list = Blist::new(&Tree::constant(value)).unwrap();
        assert!(list.entries().is_empty());
        assert_eq!(list.contains(|_| unreachable!()), value);
    }
}

/// 10^5 trees of all operations, each at 8 random points (small ones at every point).
#[test]
fn lists_and_trees_agree() {
    let mut random = Random::new(1);
    for _ in 0..100_000 {
        let leaves = random.integer(1, 10);
        let primitives = random.integer(1, leaves);
        let tree = tree(&mut random, leaves, primitives, &ALL, 4);
        let list = Blist::new(&tree).unwrap();
        let exhaustive = primitives <= 3;
        for i in 0..8 {
            let bits = if exhaustive { i } else { random.next() };
            let expected = recursive(&tree, tree.root(), bits);
            let inside = |p: u32| bits >> p & 1 == 1;
            assert_eq!(list.contains(inside), expected, "{tree:?} {bits:b}");
            assert_eq!(tree.contains(inside), expected);
        }
    }
}

#[test]
fn positive_forms_are_positive_and_the_same() {
    let mut random = Random::new(2);
    for _ in 0..2000 {
        let leaves = random.integer(1, 9);
        let primitives = random.integer(1, leaves);
        let tree = tree(&mut random, leaves, primitives, &ALL, 3);
        let positive = tree.positive().unwrap();
        assert!(positive.is_positive());
        assert!(same(&tree, &positive, primitives), "{tree:?}");
    }
}

/// A million levels to the left and to the right: built, wired, walked, folded and dropped.
#[test]
fn a_million_levels() {
    for left in [true, false] {
        let mixed = |i: u32| if i.is_multiple_of(3) { Op::Difference } else { ALL[i as usize % 2] };
        let deep = chain(1_000_000, left, mixed);
        assert_eq!(deep.heights()[deep.root() as usize], 999_999);
        let list = Blist::new(&deep).unwrap();
        assert_eq!(list.entries().len(), 1_000_000);
        let mut random = Random::new(3);
        for _ in 0..8 {
            let bits = random.next();
            let inside = |p: u32| bits >> p & 1 == 1;
            assert_eq!(list.contains(inside), deep.contains(inside));
        }
        let folded = deep.fold(|p| (p % 2 == 1).then_some(false));
        let bits = random.next();
        assert_eq!(folded.contains(|p| bits >> p & 1 == 1), deep.contains(|p| p % 2 == 0 && bits >> p & 1 == 1));
    }
}

#[test]
fn complements_of_complements_a_million_deep() {
    let mut b = Builder::new();
    let mut node = b.leaf(0);
    for _ in 0..1_000_001 {
        node = b.push(Node::Complement(node));
    }
    let positive = b.finish(node).unwrap().positive().unwrap();
    assert_eq!(positive.nodes(), [Node::Leaf(0), Node::Complement(0)]);
}

/// `n` nested symmetric differences have `2^n` leaves and more: refused before they take the memory.
#[test]
fn symmetric_differences_that_explode_are_refused() {
    let deep = chain(64, true, |_| Op::SymmetricDifference);
    assert!(deep.positive().is_err());
    assert!(Blist::new(&chain(12, true, |_| Op::SymmetricDifference)).is_ok());
}
