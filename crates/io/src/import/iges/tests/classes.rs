//! Every class of damage with the message that it must have, word for word; the faces it does not touch stay.

use super::structure::CYLINDER;
use super::{GLOBAL, e, file};
use crate::import::damage::{faces, one_change_one_message, outcome, replaced_in_columns};
use crate::import::iges;

fn first(text: &str) -> (String, usize) {
    outcome(iges(text.as_bytes(), "c.igs"), |_| true, faces)
}

#[test]
fn truncated_files() {
    let lines: Vec<&str> = CYLINDER.lines().collect();
    let mut wrong = Vec::new();
    for (kept, message, faces) in [
        (0, "error: c.igs:1: not IGES: column 73 holds no section letter", 0),
        (1, "error: c.igs:1: the file ends without a directory section", 0),
        (5, "error: c.igs:5: the file ends without a directory section", 0),
        (7, "c.igs:7: file cut short: there is no terminate section", 0),
        (66, "c.igs:66: file cut short: there is no terminate section", 0),
        (80, "c.igs:80: file cut short: there is no terminate section", 1),
        (96, "c.igs:96: file cut short: there is no terminate section", 3),
    ] {
        let text: String = lines[..kept].iter().map(|l| format!("{l}\n")).collect();
        let found = first(&text);
        if found != (message.to_owned(), faces) {
            wrong.push(format!("{kept} lines: {found:?}"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn every_change_has_its_message() {
    let changes = [
        // swapped references: surface and loop, direction and point, a face that is a shell
        (
            "swapped",
            "510,7,1,1,15;",
            "510,15,1,1,7;",
            "c.igs:68: #5: face left out: type 508 form 1 is not supported (#15)",
            2,
        ),
        (
            "swapped",
            "192,9,11,2.,13; ",
            "192,11,9,2.,13; ",
            "c.igs:68: #5: face left out: #11 is of type 123, not 116, a point",
            2,
        ),
        (
            "swapped",
            "514,3,5,1,37,1,49,0;",
            "514,3,5,1,3,1,49,0;",
            "c.igs:67: #3: face left out: #3 refers to itself",
            2,
        ),
        // cycles
        ("cycle", "186,3,1,0;", "186,1,1,0;", "c.igs:67: #3: entity without its owner not drawn: type 514", 0),
        ("cycle", "190,41,43,45;", "190,39,43,45;", "c.igs:85: #37: face left out: #39 refers to itself", 2),
        (
            "cycle",
            "508,1,0,17,1,1,0;",
            "508,1,1,47,1,1,0;",
            "c.igs:85: #37: face left out: #47 is of type 508, not 502, a vertex list",
            2,
        ),
        // counts
        (
            "huge",
            "502,2,2.,-4.898587197E-16",
            "502,2000000000,-4.899E-16",
            "c.igs:68: #5: face left out: #23: parameter 1 is not a count that its record can hold",
            0,
        ),
        (
            "huge",
            "514,3,5,1,37,1,49,0;",
            "514,3000000000,5,37; ",
            "c.igs:66: #1: body left out: #3: parameter 1 is not a count that its record can hold",
            0,
        ),
        (
            "huge",
            "508,4,0,17,1,0,1,0,29",
            "508,40000000,0,17,1,0",
            "c.igs:68: #5: face left out: #15: parameter 1 is not a count that its record can hold",
            2,
        ),
        (
            "huge",
            "510,7,1,1,15;",
            "510,7,1E9,1,15;",
            "c.igs:68: #5: face left out: #5: parameter 2 is not a count that its record can hold",
            2,
        ),
        // not numbers
        (
            "NaN",
            "116,0.,0.,5.,0;",
            "116,NaN,0.,5.,0;",
            "c.igs:85: #37: face left out: #41: parameter 1 is not a finite number",
            2,
        ),
        (
            "NaN",
            "192,9,11,2.,13; ",
            "192,9,11,1E999,13;",
            "c.igs:68: #5: face left out: #7: parameter 3 is not a length above 0",
            2,
        ),
        (
            "NaN",
            "502,2,2.,-4.898587197E-16,5.",
            "502,2,1E999,-4.898587E-16,5.",
            "c.igs:68: #5: face left out: #23: parameter 2 is not a finite number",
            1,
        ),
        (
            "NaN",
            "124,1.,0.,0.,0.,0.,1.",
            "124,1E999,0.,0.,0.,1.",
            "c.igs:68: #5: face left out: #21: parameter 1 is not a finite number",
            1,
        ),
        // types
        (
            "type",
            "192,9,11,2.,13; ",
            "192,9,11,3Hxyz,13;",
            "c.igs:68: #5: face left out: #7: parameter 3 is not a length above 0",
            2,
        ),
        ("type", "186,3,1,0;", "186,3.5,1,0;", "c.igs:66: #1: body left out: #1: parameter 1 is not an integer", 0),
        (
            "type",
            "116,0.,0.,5.,0;",
            "117,0.,0.,5.,0;",
            "c.igs:87: #41: entity without parameters: its parameters are of type 117, not of type 116",
            2,
        ),
        // missing
        ("missing", "510,7,1,1,15;", "510,7,1,1,99;", "c.igs:68: #5: face left out: #99 does not exist", 2),
    ];
    one_change_one_message(CYLINDER, replaced_in_columns, first, &changes);
}

/// Twenty squares that stand alone; one surface, one loop or one curve of them is bad.
#[test]
fn one_bad_face_leaves_the_others() {
    let square = |z: usize| {
        format!(
            "128,1,1,1,1,0,0,1,0,0,0.,0.,1.,1.,0.,0.,1.,1.,1.,1.,1.,1.,0.,0.,{z}.,1.,0.,{z}.,0.,1.,{z}.,1.,1.,{z}.;"
        )
    };
    let mut wrong = Vec::new();
    for (bad, why) in [
        (
            square(3).replace("1.,1.,1.,1.,0.,0.,3.", "1.,-1.,1.,1.,0.,0.,3."),
            "c.igs:50: #7: face left out: #7: control point 1 has a coordinate that is not finite or a weight that is not positive",
        ),
        (
            square(3).replace("0.,0.,3.", "0.,NaN,3."),
            "c.igs:50: #7: face left out: #7: parameter 23 is not a finite number",
        ),
        (
            square(3).replace("128,1,1", "128,9,1"),
            "c.igs:50: #7: face left out: #7: parameter 34 is not there, the record is too short",
        ),
        (
            square(3).replace("128,1,1,1,1", "128,1,1,1,99"),
            "c.igs:50: #7: face left out: #7: parameter 4 is not a count that its record can hold",
        ),
    ] {
        assert_ne!(bad, square(3));
        let mut all: Vec<_> = (0..20).map(|z| e(&square(z))).collect();
        all[3] = e(&bad);
        let found = first(&file(GLOBAL, &all));
        if found != (why.to_owned(), 19) {
            wrong.push(format!("{bad}: {found:?}"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
