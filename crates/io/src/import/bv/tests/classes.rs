//! Every class of damage with the message that it must have, word for word; the patches it does not touch stay.

use super::TROUGH;
use crate::import::bv;
use crate::import::damage::{faces_and_triangles, one_change_one_message, outcome, replaced};

/// A tetrahedron: four corners, four triangles.
const SOLID: &str = "1\n4 4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";

/// A triangle of degree 2.
const TRIANGLE: &str = "3\n2\n0 0 0\n1 0 0\n2 0 4\n0 1 0\n1 1 0\n0 2 4\n";

fn first(text: &str) -> (String, (usize, usize)) {
    outcome(bv(text.as_bytes(), "t.bv"), |_| true, faces_and_triangles)
}

#[test]
fn every_change_has_its_message() {
    let good = format!("{TROUGH}{SOLID}{TRIANGLE}");
    assert_eq!(first(&good).1, (2, 4));
    let changes = [
        (
            "truncated",
            "1 2\n-2 -2",
            "",
            "t.bv:2: the rest of the file left out: the file ends where a degree should stand",
            (0, 0),
        ),
        (
            "truncated",
            "2 2 0\n1\n4 4",
            "",
            "t.bv:8: the rest of the file left out: the file ends where a number should stand",
            (0, 0),
        ),
        (
            "truncated",
            "0 1 3\n",
            "",
            "t.bv:16: the rest of the file left out: the file ends where the number of a vertex should stand",
            (1, 0),
        ),
        (
            "truncated",
            "2 0 4\n",
            "",
            "t.bv:23: the rest of the file left out: the file ends where a number should stand",
            (1, 4),
        ),
        // the form refers to vertices by their numbers, and to nothing else
        ("swapped", "3 0 2 1", "3 0 2 4", "t.bv:15: polygon left out: vertex 4 of 4", (2, 3)),
        ("swapped", "3 0 2 1", "3 0 2 2", "", (2, 4)),
        (
            "huge",
            "1 2\n-2 -2",
            "1000000000000 2\n-2 -2",
            "t.bv:27: the rest of the file left out: the file ends where a number should stand",
            (0, 0),
        ),
        ("huge", "4 4\n", "4 18446744073709551615\n", "t.bv:21: polygon left out: 0 corners", (1, 0)),
        (
            "huge",
            "4 4\n",
            "18446744073709551616 4\n",
            "t.bv:10: the rest of the file left out: 18446744073709551616 is not the number of vertices",
            (1, 0),
        ),
        (
            "huge",
            "3\n2\n0 0 0",
            "3\n4000000000\n0 0 0",
            "t.bv:27: the rest of the file left out: the file ends where a number should stand",
            (1, 4),
        ),
        (
            "huge",
            "3 0 2 1",
            "9999999999 0 2 1",
            "t.bv:27: the rest of the file left out: the file ends where the number of a vertex should stand",
            (1, 0),
        ),
        (
            "NaN",
            "2 0 1",
            "nan 0 1",
            "t.bv:1: face left out: control point 2 has a coordinate that is not finite or a weight that is not positive",
            (1, 4),
        ),
        (
            "NaN",
            "2 0 4\n",
            "2 0 inf\n",
            "t.bv:19: face left out: control point 2 has a coordinate that is not finite or a weight that is not positive",
            (1, 4),
        ),
        ("NaN", "0 0 1\n3 0", "0 0 1e999\n3 0", "t.bv:16: polygon left out: vertex 3 is not finite", (2, 1)),
        ("type", "1 2\n-2 -2", "1 two\n-2 -2", "t.bv:2: the rest of the file left out: two is not a degree", (0, 0)),
        ("type", "1 2\n-2 -2", "1.5 2\n-2 -2", "t.bv:2: the rest of the file left out: 1.5 is not a degree", (0, 0)),
        (
            "type",
            "0 1 0\n0 0 1",
            "0 one 0\n0 0 1",
            "t.bv:13: the rest of the file left out: one is not a number",
            (1, 0),
        ),
        ("type", "1\n4 4", "17\n4 4", "t.bv:9: the rest of the file left out: 17 is no kind of patch", (1, 0)),
    ];
    one_change_one_message(&good, replaced, first, &changes);
}

/// Only its numbers say where a patch ends: a word in place of one loses all that follows, a number that cannot be
/// drawn loses its own patch only.
#[test]
fn one_bad_patch_leaves_the_others() {
    let bad = TROUGH.replacen("-2 0 1", "-2 nan 1", 1);
    assert_eq!(first(&format!("{TROUGH}{bad}{TROUGH}{TRIANGLE}")), ("t.bv:9: face left out: control point 2 has a coordinate that is not finite or a weight that is not positive".to_owned(), (3, 0)));
    let degree = format!("5\n16 1\n{}", "0 0 0\n".repeat(34));
    assert_eq!(
        first(&format!("{TROUGH}{degree}{TROUGH}")),
        ("t.bv:9: face left out: degree 16 is not between 1 and 15".to_owned(), (2, 0))
    );
    let weight = "8\n1 1\n0 0 0 1\n1 0 0 -1\n0 1 0 1\n1 1 0 1\n";
    assert_eq!(first(&format!("{TROUGH}{weight}{TROUGH}")), ("t.bv:9: face left out: control point 2 has a coordinate that is not finite or a weight that is not positive".to_owned(), (2, 0)));
}
