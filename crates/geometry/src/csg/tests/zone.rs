//! Active zones, derivatives, redundancy, folding, covers.

use super::random::{ALL, POSITIVE, recursive, same, tree};
use crate::csg::{Blist, Node, Tree, covering_set, parse};
use crate::math::random::Random;

fn leaf_of(tree: &Tree, primitive: u32) -> u32 {
    tree.nodes().iter().position(|n| *n == Node::Leaf(primitive)).unwrap() as u32
}

#[test]
fn the_figure_of_the_module() {
    let tree = parse("AB+C").unwrap().tree;
    let path = tree.path(leaf_of(&tree, 0));
    assert_eq!((path.ancestors, path.i_nodes, path.u_nodes), (vec![2, 4], vec![1], vec![3]));
    assert!(same(&tree.zone(0), &parse("A-A+B-C").unwrap().tree, 3));
}

/// Every solid once: `Z = I * !U` is the derivative.
#[test]
fn zones_are_derivatives_where_solids_occur_once() {
    let mut random = Random::new(21);
    for _ in 0..500 {
        let leaves = random.integer(1, 8);
        let tree = tree(&mut random, leaves, leaves, &ALL[..3], 3).positive().unwrap();
        for p in 0..leaves {
            let zone = tree.zone(leaf_of(&tree, p));
            assert!(same(&zone, &tree.derivative(p).unwrap(), leaves), "{tree:?} {p}");
        }
    }
}

/// Where a solid occurs twice, a change of it outside the derivative changes nothing, and the zones of its
/// leaves alone would say too little: A*!B + !A*B is decided by A everywhere.
#[test]
fn repeated_solids_need_the_derivative() {
    let tree = parse("A^B").unwrap().tree;
    assert_eq!(tree.derivative(0).unwrap().positive().unwrap().is_redundant(1, 10), Some(true));
    assert!(same(&tree.derivative(0).unwrap(), &Tree::constant(true), 2));
    let positive = tree.positive().unwrap();
    assert!(!same(&positive.zone(leaf_of(&positive, 0)), &Tree::constant(true), 2));
}

#[test]
fn redundancy() {
    for (text, primitive, expected) in [
        ("A+AB", 1, true),
        ("A+AB", 0, false),
        ("A-A+B", 0, true),
        ("(A+B)(A+!B)", 1, true),
        ("A-(B-A)", 1, true),
        ("A-B", 1, false),
    ] {
        assert_eq!(parse(text).unwrap().tree.is_redundant(primitive, 100), Some(expected), "{text}");
    }
    assert_eq!(parse("A+AB").unwrap().tree.is_redundant(1, 0), None);
}

/// A primitive is redundant exactly when no truth assignment of the others lets it decide.
#[test]
fn redundancy_is_what_truth_tables_say() {
    let mut random = Random::new(22);
    let mut redundant = 0;
    for _ in 0..500 {
        let (leaves, primitives) = (random.integer(2, 8), 3);
        let tree = tree(&mut random, leaves, primitives, &ALL, 3);
        for p in 0..primitives {
            let expected = (0..8u64).all(|bits| {
                let value = |bits: u64| recursive(&tree, tree.root(), bits);
                value(bits | 1 << p) == value(bits & !(1 << p))
            });
            assert_eq!(tree.is_redundant(p, 1000), Some(expected));
            redundant += u32::from(expected);
        }
    }
    assert!(redundant > 50, "only {redundant} cases of it");
}

#[test]
fn folding_is_assignment() {
    let mut random = Random::new(23);
    for _ in 0..2000 {
        let leaves = random.integer(1, 10);
        let tree = tree(&mut random, leaves, leaves, &ALL, 3);
        let (known, values, bits) = (random.next(), random.next(), random.next());
        let bit = |word: u64, p: u32| word >> p & 1 == 1;
        let folded = tree.fold(|p| bit(known, p).then(|| bit(values, p)));
        assert!(folded.leaves().all(|p| !bit(known, p)));
        assert!(folded.as_constant().is_some() || !folded.nodes().iter().any(|n| matches!(n, Node::Constant(_))));
        let expected = recursive(&tree, tree.root(), bits & !known | values & known);
        assert_eq!(folded.contains(|p| bit(bits, p)), expected);
        assert_eq!(Blist::new(&folded).unwrap().contains(|p| bit(bits, p)), expected);
    }
}

#[test]
fn covers() {
    let weights = [5.0, 1.0, 2.0, 8.0];
    let cover = |text: &str| covering_set(&parse(text).unwrap().tree.positive().unwrap(), |p| weights[p as usize]);
    assert_eq!(cover("AB"), Some(vec![1]));
    assert_eq!(cover("A+B"), Some(vec![0, 1]));
    assert_eq!(cover("A(B+C)D"), Some(vec![1, 2]));
    assert_eq!(cover("A-B"), Some(vec![0]));
    assert_eq!(cover("!A+B"), None);
    assert_eq!(cover("A+A"), Some(vec![0]));
}

/// A point of the solid is in some primitive of its cover.
#[test]
fn covers_hold_the_solid() {
    let mut random = Random::new(24);
    let mut found = 0;
    for _ in 0..500 {
        let tree = tree(&mut random, 7, 7, &POSITIVE, 6).positive().unwrap();
        let weights: Vec<f64> = (0..7).map(|_| random.range(0.0, 1.0)).collect();
        let Some(cover) = covering_set(&tree, |p| weights[p as usize]) else { continue };
        found += 1;
        for bits in 0..128u64 {
            let in_cover = cover.iter().any(|p| bits >> p & 1 == 1);
            assert!(in_cover || !recursive(&tree, tree.root(), bits), "{tree:?} {cover:?}");
        }
    }
    assert!(found > 100, "only {found} bounded solids");
}
