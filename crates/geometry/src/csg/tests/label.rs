//! Labels: the figures of the literature, walks, and the optimum against all orders.

use super::random::{ALL, POSITIVE, recursive, tree};
use crate::csg::{Blist, Builder, Convention, Node, Op, Tree, parse};
use crate::math::random::Random;
use std::collections::BTreeSet;

const BOTH: [Convention; 2] = [Convention::WhenUsed, Convention::FromStart];

fn count(tree: &Tree, convention: Convention) -> u32 {
    Blist::new(tree).unwrap().labels(convention).count
}

/// J. Rossignac's example: 5 labels as given, 4 with the taller child first, 3 at best.
#[test]
fn fourteen_leaves() {
    let given = parse("(A+((B+((C+((D+E)+F))+G))+H))+(I+(J+(K+L)M)N)").unwrap().tree;
    assert_eq!(count(&given, Convention::FromStart), 5);
    assert_eq!(count(&given.with_taller_first(), Convention::FromStart), 4);
    assert_eq!(count(&given.with_fewest_labels(Convention::FromStart), Convention::FromStart), 3);
}

#[test]
fn trees_that_need_five() {
    for text in ["((AB+C)(DE+F)+G)((HI+J)(KL+M)+N)+O", "(A+(B+C)(D+E))(F+(G+H)(I+J))"] {
        let best = parse(text).unwrap().tree.with_fewest_labels(Convention::FromStart);
        assert_eq!(count(&best, Convention::FromStart), 5, "{text}");
    }
}

/// The smallest trees that need k labels at best: 3 * 2^(k-2) - 2 leaves when the ends take labels when
/// used, one label less for the same when they have them from the start. Every tree is some pair of
/// smaller trees, and of a tree only the four costs by context count: those sets stay small.
#[test]
fn the_smallest_tree_for_each_count() {
    type Costs = [u32; 4];
    let cost = |union: bool, a: &Costs, b: &Costs, t: usize, f: usize| {
        if union { (f as u32 + a[t]).max(b[1 + 2 * f]) } else { (t as u32 + a[2 * f]).max(b[t + 2]) }
    };
    let mut by_leaves: Vec<BTreeSet<Costs>> = vec![BTreeSet::new(), BTreeSet::from([[2; 4]])];
    for n in 2..=46 {
        let mut all = BTreeSet::new();
        for k in 1..=n / 2 {
            for (a, b) in by_leaves[k].iter().flat_map(|a| by_leaves[n - k].iter().map(move |b| (a, b))) {
                for union in [true, false] {
                    all.insert(std::array::from_fn(|c| {
                        cost(union, a, b, c & 1, c >> 1).min(cost(union, b, a, c & 1, c >> 1))
                    }));
                }
            }
        }
        by_leaves.push(all);
    }
    let smallest = |context: usize, k: u32| by_leaves.iter().position(|s| s.iter().any(|c| c[context] >= k));
    let when_used: Vec<_> = (2..=6).map(|k| smallest(0, k).unwrap()).collect();
    assert_eq!(when_used, [1, 4, 10, 22, 46]);
    let from_start: Vec<_> = (2..=7).map(|k| smallest(3, k).unwrap()).collect();
    assert_eq!(from_start, [1, 2, 4, 10, 22, 46]);
}

#[test]
fn label_walks_agree_with_trees() {
    let mut random = Random::new(11);
    for _ in 0..20_000 {
        let leaves = random.integer(1, 12);
        let tree = tree(&mut random, leaves, leaves, &ALL[..3], 4);
        let list = Blist::new(&tree).unwrap();
        for convention in BOTH {
            let labels = list.labels(convention);
            for _ in 0..4 {
                let bits = random.next();
                let inside = |p: u32| bits >> p & 1 == 1;
                assert_eq!(labels.contains(inside), recursive(&tree, tree.root(), bits), "{tree:?}");
            }
        }
    }
}

#[test]
fn constants_walk_too() {
    for value in [false, true] {
        let labels = Blist::new(&Tree::constant(value)).unwrap().labels(Convention::FromStart);
        assert_eq!(labels.contains(|_| unreachable!()), value);
    }
}

/// All orders of the children of all pairs.
fn all_orders(tree: &Tree) -> Vec<Tree> {
    let pairs: Vec<usize> = (0..tree.nodes().len()).filter(|i| matches!(tree.nodes()[*i], Node::Pair(..))).collect();
    let order = |mask: u32| {
        let mut b = Builder::new();
        for (i, node) in tree.nodes().iter().enumerate() {
            let swap = pairs.iter().position(|p| *p == i).is_some_and(|k| mask >> k & 1 == 1);
            b.push(match *node {
                Node::Pair(op, l, r) if swap => Node::Pair(op, r, l),
                node => node,
            });
        }
        b.finish(tree.root()).unwrap()
    };
    (0..1 << pairs.len()).map(order).collect()
}

#[test]
fn the_optimum_is_the_best_of_all_orders() {
    let mut random = Random::new(12);
    for _ in 0..200 {
        let leaves = random.integer(1, 8);
        let tree = tree(&mut random, leaves, leaves, &POSITIVE, 0);
        for convention in BOTH {
            let best = all_orders(&tree).iter().map(|t| count(t, convention)).min().unwrap();
            assert_eq!(count(&tree.with_fewest_labels(convention), convention), best, "{tree:?}");
        }
    }
}

/// 255 leaves in a balanced tree of alternating operations: the hard shape, still below 64 labels.
#[test]
fn worst_cases_fit_six_bits() {
    for n in 15..=255u32 {
        let mut b = Builder::new();
        let mut row: Vec<u32> = (0..n).map(|p| b.leaf(p)).collect();
        let mut op = Op::Union;
        while row.len() > 1 {
            row = row.chunks(2).map(|c| if c.len() == 2 { b.pair(op, c[0], c[1]) } else { c[0] }).collect();
            op = if op == Op::Union { Op::Intersection } else { Op::Union };
        }
        let tree = b.finish(row[0]).unwrap();
        let best = count(&tree.with_fewest_labels(Convention::WhenUsed), Convention::WhenUsed);
        assert!(best <= 8 && best <= count(&tree, Convention::WhenUsed), "{n}: {best}");
    }
}

#[test]
fn a_million_leaves_are_ordered_too() {
    let deep = super::random::chain(1_000_000, false, |i| POSITIVE[i as usize % 2]);
    assert_eq!(count(&deep.with_fewest_labels(Convention::FromStart), Convention::FromStart), 3);
}
