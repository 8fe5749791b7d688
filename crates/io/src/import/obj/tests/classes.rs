//! Every class of damage with the message that it must have, word for word; the faces it does not touch stay.

use crate::import::damage::{faces_and_triangles, one_change_one_message, outcome, replaced};
use crate::import::obj;

const SPEC: &str = include_str!("spec.obj");

/// A tetrahedron of four triangles; its sides have numbers of vertices and normals.
const SOLID: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0 0 -1\nf 1//1 3//1 2//1\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

/// The first warning that is not about the special curve of the example, or the error; faces and triangles.
fn first(text: &str) -> (String, (usize, usize)) {
    outcome(obj(text.as_bytes(), "t.obj", None), |warning| !warning.contains("`scrv`"), faces_and_triangles)
}

#[test]
fn every_change_of_the_example_has_its_message() {
    let changes = [
        // truncated: from here on nothing
        ("truncated", "v -1.350", "", "", (0, 0)),
        ("truncated", "parm v", "", "t.obj:32: face left out: parm v: fewer than two parameter values", (0, 0)),
        (
            "truncated",
            "2.00 2.00 2.00\ntrim",
            "",
            "t.obj:32: face left out: parm v: too few knots for the degree",
            (0, 0),
        ),
        ("truncated", "scrv", "", "", (1, 0)),
        // swapped references
        ("swapped", "-9 -8 -7", "-7 -8 -90", "t.obj:32: face left out: vertex -90 of 9", (0, 0)),
        (
            "swapped",
            "trim 0.0 2.0 1",
            "trim 0.0 2.0 2",
            "t.obj:32: face left out: trim curve 2 has no part from 0 to 2",
            (0, 0),
        ),
        // counts
        (
            "huge",
            "deg 2 2",
            "deg 999999999999 2",
            "t.obj:32: face left out: parm u: degree 999999999999 is not between 1 and 15",
            (0, 0),
        ),
        ("huge", "-9 -8 -7", "-9999999999 -8 -7", "t.obj:32: face left out: vertex -9999999999 of 9", (0, 0)),
        (
            "huge",
            "trim 0.0 2.0 1",
            "trim 0.0 2.0 99999999999999999999",
            "t.obj:35: face left out: curve 99999999999999999999 is no whole number",
            (0, 0),
        ),
        // not numbers
        ("NaN", "v  0.130", "v nan", "t.obj:22: vertex not read: v nan -1.030 0.432 7.600", (0, 0)),
        (
            "NaN",
            "parm v -2.00",
            "parm v inf",
            "t.obj:34: face left out: no finite numbers: inf -2.00 -2.00 2.00 2.00 2.00",
            (0, 0),
        ),
        ("NaN", "vp  0.915", "vp nan", "t.obj:4: parameter vertex not read: vp nan 1.930", (0, 0)),
        // types
        ("type", "cstype rat bspline", "cstype rat 7", "t.obj:30: unknown cstype: rat 7", (0, 0)),
        ("type", "surf -1.0", "surf u", "t.obj:32: face left out: no finite numbers: u 2.5 -2.0 2.0", (0, 0)),
        ("type", "-9 -8", "-9.5 -8", "t.obj:32: face left out: vertex -9.5 is no whole number", (0, 0)),
    ];
    one_change_one_message(SPEC, replaced, first, &changes);
}

#[test]
fn every_change_of_polygons_has_its_message() {
    let changes = [
        ("truncated", " 2//1", "", "t.obj:6: polygon left out: 2 corners", (0, 0)),
        ("truncated", " 4\nf 3", "", "t.obj:8: polygon left out: 2 corners", (0, 2)),
        ("swapped", "f 1 2 4", "f 4 2 5", "t.obj:7: polygon left out: vertex 5 of 4", (0, 3)),
        ("swapped", "3//1", "3//4", "t.obj:6: normals not used: f 1//1 3//4 2//1", (0, 4)),
        ("huge", "f 1 2 4", "f 1 2 4294967297", "t.obj:7: polygon left out: vertex 4294967297 of 4", (0, 3)),
        ("NaN", "v 0 0 1", "v 0 0 1e999", "t.obj:4: vertex not read: v 0 0 1e999", (0, 1)),
        ("NaN", "vn 0 0 -1", "vn 0 0 nan", "t.obj:5: normal not read: vn 0 0 nan", (0, 4)),
        ("type", "f 1 2 4", "f one 2 4", "t.obj:7: polygon left out: vertex one is no whole number", (0, 3)),
        ("type", "v 1 0 0", "v 1 zero 0", "t.obj:2: vertex not read: v 1 zero 0", (0, 1)),
    ];
    one_change_one_message(SOLID, replaced, first, &changes);
}

/// `call` names another file, and none is read: that is a loss.
#[test]
fn files_that_call_themselves() {
    let text = format!("call t.obj\ncall t.obj\n{SOLID}");
    assert_eq!(first(&text), ("t.obj:1: external file not followed: t.obj".to_owned(), (0, 4)));
    let summary = crate::import::obj(text.as_bytes(), "t.obj", None).unwrap().summary();
    assert!(summary.elsewhere == ["t.obj"] && !summary.is_complete());
}

/// Three surfaces, the second of which is bad.
#[test]
fn one_bad_face_leaves_the_others() {
    let one = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\ncstype bezier\ndeg 1 1\nsurf 0 1 0 1 -4 -3 -2 -1\nparm u 0 1\nparm v 0 1\nend\n";
    let mut wrong = Vec::new();
    for (from, to, why) in [
        ("v 1 1 0", "v 1 nan 0", "t.obj:14: vertex not read: v 1 nan 0"),
        ("-4 -3 -2 -1", "-4 -3 -2", "t.obj:17: face left out: 3 control points where parm asks for 4"),
        ("deg 1 1", "deg 1 99", "t.obj:17: face left out: parm v: degree 99 is not between 1 and 15"),
        (
            "parm u 0 1",
            "parm u 1 0",
            "t.obj:17: face left out: knot 2 is smaller than the one before it, or not a number",
        ),
    ] {
        let bad = one.replacen(from, to, 1);
        let found = first(&format!("{one}{bad}{one}{SOLID}"));
        if found != (why.to_owned(), (2, 4)) {
            wrong.push(format!("{from} -> {to}: {found:?}"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
