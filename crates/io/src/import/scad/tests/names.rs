//! Values without a name, diameters, and arguments that nothing uses.

use super::{import, same};
use crate::import::Import;
use crate::model::Shape;
use glam::DVec3;

fn told(import: &Import) -> Vec<String> {
    import.warnings.iter().map(ToString::to_string).collect()
}

fn shape(text: &str) -> Shape {
    let import = import(text);
    assert!(import.warnings.is_empty(), "{text}: {:?}", import.warnings);
    import.model.solids[0].primitives()[0].shape.clone()
}

#[test]
fn values_without_a_name_and_diameters() {
    for text in ["sphere(5);", "sphere(d = 10);", "sphere(r = 5);", "sphere(r = 9, d = 10);", "sphere(5, d = undef);"] {
        assert_eq!(shape(text), Shape::Sphere { radius: 5.0 }, "{text}");
    }
    let block = Shape::Block { min: DVec3::splat(-1.5), max: DVec3::splat(1.5) };
    assert_eq!(shape("cube(3, true);"), block);
    let round = shape("cylinder(h = 4, r1 = 2, r2 = 1);");
    for text in ["cylinder(4, 2, 1);", "cylinder(4, d1 = 4, d2 = 2);", "cylinder(4, r2 = 1, d = 4);"] {
        assert_eq!(shape(text), round, "{text}");
    }
}

/// An argument that the node does not have is a loss: the shape may not be what was meant.
#[test]
fn arguments_that_nothing_uses_are_reported() {
    for (text, what) in [
        ("cube(sizo = 3);", "`cube` has `sizo`, which is not known"),
        ("sphere(1, 2);", "`sphere` has more than 1 values without a name"),
        ("linear_extrude(height = 1, v = [1, 0, 1]) { square(); }", "`linear_extrude` has `v`, which is not known"),
    ] {
        let import = import(text);
        assert_eq!(told(&import), [format!("t.csg:1: argument left out: {what}")], "{text}");
        assert!(!import.summary().is_complete() && import.model.solids.len() == 1);
    }
    for text in [
        "cube(sizo = undef);",
        "cube(size = 2, segments = 0, id = \"\");",
        "*cube(sizo = 3); cube();",
        "linear_extrude(height = 1, segments = 8) { square(); }",
    ] {
        assert!(told(&import(text)).is_empty(), "{text}");
    }
}

#[test]
fn colours_of_three_and_four_numbers() {
    let colour = |text: &str| import(&format!("{text} {{ cube(); }}")).model.solids[0].primitives()[0].colour;
    assert_eq!(colour("color([1, 0, 0])"), [1.0, 0.0, 0.0, 1.0]);
    assert_eq!(colour("color(c = [1, 0, 0], alpha = 0.5)"), [1.0, 0.0, 0.0, 0.5]);
    let none = colour("color()");
    assert_eq!(colour("color([-1, -1, -1, 1])"), none);
    let named = import("color(\"red\") { cube(); }");
    assert_eq!(told(&named), ["t.csg:1: colour left out: color: `c` is neither three nor four numbers"]);
    assert_eq!(named.model.solids[0].primitives()[0].colour, none);
}

/// A quarter of a turn, from the y axis to the negative x axis, exactly and in facets.
#[test]
fn a_turn_starts_where_it_says() {
    let quarter = |p: DVec3| (p.z - 1.0).max(-p.z).max(p.truncate().length() - 2.0).max(p.x).max(-p.y);
    same("rotate_extrude(angle = 90, start = 90) { square(size = [2, 1]); }", 3.0, quarter);
    #[cfg(feature = "scad-facets")]
    {
        let hull = import("hull() { rotate_extrude(angle = 90, start = 90, $fn = 8) { square(size = [2, 1]); } }");
        let bounds = hull.model.bounds();
        // the box of a hull is that of its half-spaces, which reaches farther outwards
        assert!(bounds.max.x.abs() < 1e-9 && bounds.min.y.abs() < 1e-9, "{bounds:?}");
        assert!(bounds.min.x <= -2.0 && bounds.max.y >= 2.0, "{bounds:?}");
    }
}
