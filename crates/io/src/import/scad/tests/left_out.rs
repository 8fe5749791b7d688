//! Nodes that cannot be made are left out by name, and the rest is drawn.

use super::{block, import, same};
use crate::model::Shape;
use glam::DVec3;

/// Warnings of nodes that are left out.
fn told(text: &str) -> Vec<String> {
    import(text).warnings.iter().map(ToString::to_string).collect()
}

#[test]
fn each_is_named_with_its_line() {
    for (text, message) in [
        ("frobnicate();", "t.csg:1: node left out: frobnicate: such a node is not known"),
        ("cube();\n\nroof() { square(); }", "t.csg:3: node left out: roof: such a node is not known"),
        ("multmatrix([[1, 0], [0, 1]]) { cube(); }", "t.csg:1: node left out: multmatrix: not a matrix"),
        ("linear_extrude(height = 1, twist = nan) { square(); }", "t.csg:1: node left out: linear_extrude: a twist"),
        (
            "linear_extrude(height = 1, scale = [1, 0]) { square(); }",
            "t.csg:1: node left out: linear_extrude: an upper end",
        ),
        (
            "linear_extrude(height = 1, scale = [-1, 2]) { square(); }",
            "t.csg:1: node left out: linear_extrude: a scale",
        ),
        (
            "linear_extrude(twist = 1, slices = 1e9) { square(); }",
            "t.csg:1: node left out: square: 1000000000 slices of 4 corners",
        ),
        (
            "linear_extrude(twist = 1, slices = 100000) { square(); square(); }",
            "t.csg:1: node left out: square: 100000 slices of 4 corners are too many",
        ),
        ("linear_extrude(twist = 1e300) { circle($fn = 1e9); }", "t.csg:1: node left out: circle: "),
        ("rotate_extrude() { square(center = true); }", "t.csg:1: node left out: square: an outline across the axis"),
        (
            "polyhedron(points = [[0, 0, 0], [2, 0, 0], [0, 2, 0], [0, 0, 2]], faces = [[0, 1, 2], [0, 3, 1], [0, 2, 3]]);",
            "t.csg:1: node left out: polyhedron: the faces do not close",
        ),
        ("import(file = \"no such file.stl\");", "t.csg:1: node left out: import: "),
        ("surface(file = \"\");", "t.csg:1: node left out: surface: "),
    ] {
        let told = told(&format!("{text}\nsphere(r = 9);"));
        assert!(told.len() == 1 && told[0].starts_with(message), "{text}: {told:?}");
        // the sphere is still there
        let solid = &import(&format!("{text} sphere(r = 9);")).model.solids[0];
        assert!(solid.primitives().iter().any(|p| p.shape == Shape::Sphere { radius: 9.0 }), "{text}");
    }
}

#[test]
fn the_rest_of_a_boolean_is_drawn_where_that_says_something() {
    let cube = |p: DVec3| block(p, [0.0; 3], [2.0; 3]);
    same("union() { frobnicate() { sphere(r = 9); } cube(size = 2); }", 3.0, cube);
    same("difference() { cube(size = 2); frobnicate(); }", 3.0, cube);
    same("intersection() { cube(size = 2); frobnicate(); }", 3.0, cube);
    // a difference without its first operand is lost, and a lost first child is lost all the way up
    for text in [
        "difference() { frobnicate(); cube(size = 2); }",
        "difference() { group() { color([1, 0, 0, 1]) { frobnicate(); } } cube(size = 2); }",
        "difference() { difference() { frobnicate(); sphere(); } cube(size = 2); }",
    ] {
        let import = import(text);
        assert!(import.model.solids.is_empty() && import.warnings.len() == 1, "{text}");
    }
    // nodes that are only parsed give no warning
    assert!(told("*frobnicate(); cube();").is_empty());
    assert_eq!(told("frobnicate() { hull() { frobnicate(); } } cube();").len(), 1);
}
