//! Every class of damage with the message that it must have, word for word.

use super::damage::GOOD;
use crate::import::damage::{faces, one_change_one_message, outcome, replaced};
use crate::import::step;

#[test]
fn truncated_files() {
    let cut = |before: &str| {
        let text = &GOOD[..GOOD.find(before).unwrap()];
        match step(text.as_bytes(), "good.step") {
            Ok(import) => import.warnings.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"),
            Err(error) => format!("error: {error}"),
        }
    };
    for (before, message) in [
        ("10303-21", "error: good.step:1: not STEP: no `ISO-10303-21;` at the start"),
        ("HEADER;", "error: good.step:2: the file ends without a DATA section"),
        ("ENDSEC;", "error: good.step:6: the file ends without a DATA section"),
        ("#1=", "good.step:8: truncated: the file ends without END-ISO-10303-21"),
        (
            "LAR_ARC",
            "good.step:31: #31: record skipped: an enumeration value is not closed, and the file ends\ngood.step:31: truncated: the file ends without END-ISO-10303-21",
        ),
        ("END-ISO", "good.step:91: truncated: the file ends without END-ISO-10303-21"),
    ] {
        assert_eq!(cut(before), message, "before {before}");
    }
}

#[test]
fn every_change_has_its_message() {
    let first = |text: &str| outcome(step(text.as_bytes(), "good.step"), |_| true, faces);
    assert_eq!(first(GOOD).1, 3);
    let changes = [
        // swapped references
        (
            "swapped",
            "('',#24,5.)",
            "('',#57,5.)",
            "good.step:57: #61: face left out: #57 is EDGE_LOOP, not AXIS2_PLACEMENT_3D",
            1,
        ),
        (
            "swapped",
            "(#59),#43",
            "(#43),#59",
            "good.step:57: #61: face left out: #43 is CYLINDRICAL_SURFACE, not FACE_OUTER_BOUND",
            2,
        ),
        (
            "swapped",
            "'',#40,#41,#34",
            "'',#41,#40,#34",
            "good.step:57: #61: face repaired: face #61: edge #48 runs against its stated sense",
            3,
        ),
        // cycles
        (
            "cycle",
            "LINE('',#10,#23)",
            "TRIMMED_CURVE('',#33,(#10),(#11),.T.,.CARTESIAN.)",
            "good.step:57: #61: face left out: #33 refers to itself",
            2,
        ),
        (
            "cycle",
            "('can',#64)",
            "('can',#65)",
            "good.step:60: #64: shell without body: drawn with the file's first units",
            3,
        ),
        (
            "cycle",
            "PLANE('',#25)",
            "SURFACE_REPLICA('',#45,#92)",
            "good.step:59: #63: face left out: #45 refers to itself",
            2,
        ),
        ("cycle", "(.BOTH.,#103)", "(.BOTH.,#102)", "good.step:82: #100: colour ignored: #102 refers to itself", 3),
        // counts
        (
            "huge",
            "B_SPLINE_CURVE(2,",
            "B_SPLINE_CURVE(999999999,",
            "good.step:57: #61: face left out: #31: attribute 1 is not a degree from 1 to 15",
            1,
        ),
        (
            "huge",
            "((3,2,2,2,3)",
            "((3,2,2,2,3000000000)",
            "good.step:57: #61: face left out: #31: the knots do not fit the control points",
            1,
        ),
        (
            "huge",
            "((3,2,2,2,3)",
            "((3,2,2,2,300000000)",
            "good.step:57: #61: face left out: #31: the knots do not fit the control points",
            1,
        ),
        // not numbers
        (
            "NaN",
            "(5.,0.,8.)",
            "(5.,NaN,8.)",
            "good.step:57: #61: face left out: #11: a coordinate is not a finite number",
            1,
        ),
        (
            "NaN",
            "CIRCLE('',#24,5.)",
            "CIRCLE('',#24,1E999)",
            "good.step:57: #61: face left out: #30: attribute 2 is not a length other than 0",
            1,
        ),
        (
            "NaN",
            "(0.,1.,2.,3.,4.)",
            "(0.,1.,NaN,3.,4.)",
            "good.step:57: #61: face left out: #31: attribute 2 is not a list of finite numbers",
            1,
        ),
        (
            "NaN",
            "0.7071067811865476",
            "-0.7071067811865476",
            "good.step:57: #61: face left out: #31: control point 1 has a coordinate that is not finite or a weight that is not positive",
            1,
        ),
        // types
        (
            "type",
            "(5.,0.,0.)",
            "('5',0.,0.)",
            "good.step:57: #61: face left out: #10: a coordinate is not a finite number",
            1,
        ),
        ("type", "(#51,#52,#53,#49)", "'#51'", "good.step:57: #61: face left out: #56: attribute 1 is not a list", 2),
        (
            "type",
            "(#51,#52,#53,#49)",
            "(#51,52,#53,#49)",
            "good.step:57: #61: face left out: #56: attribute 1 is not a list of references",
            2,
        ),
        (
            "type",
            "(#61,#62,#63)",
            "#61",
            "good.step:58: #62: face without shell: 2 of them are drawn as one open shell",
            2,
        ),
        (
            "type",
            "COLOUR_RGB('',0.2",
            "COLOUR_RGB('',.T.",
            "good.step:82: #100: colour ignored: #107: attribute 1 is not a finite number",
            3,
        ),
        (
            "type",
            "'can:1','',#77",
            "'can:1','',77",
            "good.step:78: #84: occurrence left out: #80: attribute 4 is not a reference",
            3,
        ),
        // missing
        ("missing", "#44=PLANE", "#944=PLANE", "good.step:58: #62: face left out: #44 does not exist", 2),
    ];
    one_change_one_message(GOOD, replaced, first, &changes);
}
