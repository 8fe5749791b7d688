//! Expressions as text.

use super::random::{recursive, same};
use crate::csg::{Builder, Op, ParseError, parse};

#[test]
fn juxtaposition_binds_tighter_than_plus_and_minus() {
    let e = parse("(A+B)-(CD-E)").unwrap();
    assert_eq!(e.names, ["A", "B", "C", "D", "E"]);
    let mut b = Builder::new();
    let [a, bb, c, d, ee] = [0, 1, 2, 3, 4].map(|p| b.leaf(p));
    let sum = b.pair(Op::Union, a, bb);
    let product = b.pair(Op::Intersection, c, d);
    let right = b.pair(Op::Difference, product, ee);
    let root = b.pair(Op::Difference, sum, right);
    assert_eq!(e.tree, b.finish(root).unwrap());
    assert_eq!(parse("((A+B)-((C*D)-E))").unwrap(), e);
}

/// Against the truth tables of the same formulas in Rust, operand by operand.
#[test]
fn meanings() {
    type Formula = fn(bool, bool, bool) -> bool;
    let table: [(&str, Formula); 7] = [
        ("A-B-C", |a, b, c| a && !b && !c),
        ("A-BC", |a, b, c| a && !(b && c)),
        ("!AB+C", |a, b, c| !a && b || c),
        ("!(A B)^C", |a, b, c| !(a && b) ^ c),
        ("A*!B!C", |a, b, c| a && !b && !c),
        ("!!A(B+C)", |a, b, c| a && (b || c)),
        ("A+B-C+B", |a, b, c| b || a && !c),
    ];
    for (text, formula) in table {
        let tree = parse(text).unwrap().tree;
        for bits in 0..8u64 {
            let bit = |i: u32| bits >> i & 1 == 1;
            assert_eq!(recursive(&tree, tree.root(), bits), formula(bit(0), bit(1), bit(2)), "{text} {bits:03b}");
        }
    }
}

#[test]
fn identities() {
    for (left, right) in [
        ("!(A+B)", "!A!B"),
        ("!(AB)", "!A+!B"),
        ("A-B", "A!B"),
        ("A^B", "A!B+!AB"),
        ("A-(B+C)+D-D", "(A-B)-C+D-D"),
        ("A-(A-B)", "AB"),
        ("(A+B)(A+C)", "A+BC"),
        ("A-A", "A!A"),
        ("A+A", "AA"),
    ] {
        let (l, r) = (parse(left).unwrap(), parse(right).unwrap());
        assert_eq!(l.names, r.names);
        assert!(same(&l.tree, &r.tree, l.names.len() as u32), "{left} = {right}");
    }
}

#[test]
fn names_have_digits() {
    assert_eq!(parse("A1A2+A1 B").unwrap().names, ["A1", "A2", "B"]);
}

#[test]
fn errors_name_the_column() {
    for (text, error) in [
        ("", ParseError::Operand { column: 1 }),
        ("A+", ParseError::Operand { column: 3 }),
        ("A1+", ParseError::Operand { column: 4 }),
        ("A+*B", ParseError::Operand { column: 3 }),
        ("()", ParseError::Operand { column: 2 }),
        ("A!", ParseError::Operand { column: 3 }),
        ("(A+B", ParseError::Open { column: 1 }),
        ("A+B)", ParseError::Close { column: 4 }),
        ("A/B", ParseError::Character { column: 2, found: '/' }),
        ("é", ParseError::Character { column: 1, found: 'é' }),
        ("3A", ParseError::Character { column: 1, found: '3' }),
    ] {
        assert_eq!(parse(text).unwrap_err(), error, "{text}");
    }
}

#[test]
fn a_million_brackets() {
    let n = 1_000_000;
    let nested = format!("{}Z{}", "(A+".repeat(n), ")".repeat(n));
    assert_eq!(parse(&nested).unwrap().tree.leaves().count(), n + 1);
    assert_eq!(parse(&"(".repeat(n)).unwrap_err(), ParseError::Operand { column: n + 1 });
    assert_eq!(parse(&format!("{}A", "!".repeat(n + 1))).unwrap().tree.nodes().len(), 2);
}
