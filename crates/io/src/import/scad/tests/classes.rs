//! Every class of damage with the message that it must have, word for word.
//!
//! Text of another format refuses the file. A node with wrong values is left out, and so is a difference of which it is
//! the first operand.

use crate::import::damage::{one_change_one_message, outcome, primitives, replaced};
use crate::import::{Facets, scad};

const GOOD: &str = "group() {\n\tdifference() {\n\t\tcube(size = [4, 4, 4], center = true);\n\t\tsphere($fn = 0, $fa = 12, $fs = 2, r = 2.5);\n\t}\n\tmultmatrix([[1, 0, 0, 5], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) {\n\t\tpolyhedron(points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], faces = [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]], convexity = 1);\n\t}\n\tlinear_extrude(height = 2, $fn = 0, $fa = 12, $fs = 2) {\n\t\tpolygon(points = [[0, 0], [3, 0], [0, 3]], paths = undef, convexity = 1);\n\t}\n}\n";

fn first(text: &str) -> (String, usize) {
    outcome(scad(text.as_bytes(), "t.csg", Facets::Round), |_| true, primitives)
}

#[test]
fn every_change_has_its_message() {
    assert_eq!(first(GOOD).1, 11);
    let changes = [
        ("truncated", "size = [4", "", "error: t.csg:3: a value expected, not the end of the file", 0),
        ("truncated", "r = 2.5", "", "error: t.csg:4: a value expected, not the end of the file", 0),
        ("truncated", "}\n\tmult", "", "error: t.csg:5: the file ends 2 `}` too early", 0),
        ("truncated", "convexity = 1);\n\t}\n}", "", "error: t.csg:10: a value expected, not the end of the file", 0),
        // the form refers to points by their numbers, and to nothing else
        (
            "swapped",
            "[0, 3, 1]",
            "[0, 3, 4]",
            "t.csg:7: node left out: polyhedron: `faces` are not lists of indices below 4",
            6,
        ),
        (
            "swapped",
            "[0, 3, 1]",
            "[0, 1, 3]",
            "t.csg:7: node left out: polyhedron: the faces do not close, so there is no inside",
            6,
        ),
        (
            "swapped",
            "paths = undef",
            "paths = [[0, 1, 7]]",
            "t.csg:10: node left out: polygon: `paths` are not lists of indices below 3",
            7,
        ),
        ("swapped", "}\n\tmult", "mult", "error: t.csg:12: the file ends 1 `}` too early", 0),
        ("huge", "$fn = 0, $fa = 12, $fs = 2, r", "$fn = 1e9, $fa = 12, $fs = 2, r", "", 11),
        (
            "huge",
            "[0, 3, 1]",
            "[0, 3, 4294967297]",
            "t.csg:7: node left out: polyhedron: `faces` are not lists of indices below 4",
            6,
        ),
        ("huge", "r = 2.5", "r = 1e308", "", 11),
        ("NaN", "r = 2.5", "r = nan", "t.csg:4: empty solid: `sphere` has the dimension NaN", 10),
        (
            "NaN",
            "[1, 0, 0, 5]",
            "[1, 0, 0, nan]",
            "t.csg:7: empty solid: the matrices around `polyhedron` flatten it, or are not finite",
            6,
        ),
        (
            "NaN",
            "[0, 0, 1]], faces",
            "[0, 0, inf]], faces",
            "t.csg:7: node left out: polyhedron: `points` are not points of 3 finite numbers",
            6,
        ),
        (
            "NaN",
            "[3, 0], [0, 3]",
            "[3, 0], [nan, 3]",
            "t.csg:10: node left out: polygon: `points` are not points of 2 finite numbers",
            7,
        ),
        ("type", "r = 2.5", "r = true", "t.csg:4: node left out: sphere: `r` is not a number", 10),
        ("type", "r = 2.5", "r = [1, 2]", "t.csg:4: node left out: sphere: `r` is not a number", 10),
        ("type", "[4, 4, 4]", "\"4\"", "t.csg:3: node left out: cube: `size` is not 3 numbers", 9),
        (
            "type",
            "[0, 3, 1]",
            "[0, 3, \"1\"]",
            "t.csg:7: node left out: polyhedron: `faces` are not lists of indices below 4",
            6,
        ),
        ("type", "[1, 0, 0, 5]", "5", "t.csg:6: node left out: multmatrix: not a matrix of 4 rows of 4 numbers", 6),
        ("type", "sphere", "7", "error: t.csg:4: a node expected, not `7`", 0),
    ];
    one_change_one_message(GOOD, replaced, first, &changes);
}

/// A file is no solid that another one could take in, so none reads itself.
#[test]
#[cfg(feature = "scad-facets")]
fn cycles() {
    let path = std::env::temp_dir().join(format!("selvedge-cycle-{}.csg", std::process::id()));
    let name = path.file_name().unwrap().to_string_lossy().into_owned();
    let text = format!("group() {{ import(file = \"{name}\"); }} cube();");
    std::fs::write(&path, &text).unwrap();
    let read = scad(text.as_bytes(), &path.display().to_string(), Facets::Round).unwrap();
    std::fs::remove_file(&path).unwrap();
    assert!(read.warnings[0].message.contains("a kind of file that is not imported"), "{:?}", read.warnings);
    assert_eq!(read.model.solids[0].primitives().len(), 1);
}

#[test]
fn text_that_is_not_unicode() {
    let import = scad(b"// gr\xf6\xdfer f\xfcr Getriebe\ncube();", "t.csg", Facets::Round).unwrap();
    assert_eq!(import.warnings[0].to_string(), "t.csg: text: it is not UTF-8: read as windows-1252");
    assert_eq!(import.model.solids.len(), 1);
}
