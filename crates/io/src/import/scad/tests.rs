//! Small texts against closed forms: which points are in.

mod classes;
#[cfg(feature = "scad-facets")]
mod facets;
mod left_out;
mod names;
mod twist;

use super::Facets;
use crate::import::{Import, Place, open, scad};
use crate::model::{Mesh, Primitive, Shape, Solid};
use glam::DVec3;
use std::f64::consts::TAU;

fn import(text: &str) -> Import {
    scad(text.as_bytes(), "t.csg", Facets::Round).expect("a solid")
}

fn refusal(text: &str) -> String {
    scad(text.as_bytes(), "t.csg", Facets::Round).expect_err("no solid").to_string()
}

/// Winding number of a mesh around a point: the sum of the solid angles of its triangles (A. van Oosterom, J. Strackee,
/// 1983).
fn holds(mesh: &Mesh, at: DVec3) -> bool {
    let angle = |t: usize| {
        let [a, b, c] = mesh.corners(t).map(|p| p - at);
        let (x, y, z) = (a.length(), b.length(), c.length());
        2.0 * a.dot(b.cross(c)).atan2(x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y)
    };
    (0..mesh.triangles().len()).map(angle).sum::<f64>() > TAU
}

fn inside(p: &Primitive, at: DVec3) -> bool {
    let shape = &p.shape;
    if let Shape::Mesh(mesh) = shape {
        return p.to_own().is_some_and(|own| holds(mesh, own.transform_point3(at)));
    }
    p.to_own().is_some_and(|own| shape.carriers().iter().all(|c| c.value(own.transform_point3(at)) <= 0.0))
}

fn contains(solid: &Solid, at: DVec3) -> bool {
    solid.tree().contains(|p| inside(&solid.primitives()[p as usize], at))
}

/// Compares a text's solid with a closed form on points of a low-discrepancy sequence in a cube of half
/// side `reach`; `near` says which points are too close to a border for rounded input.
fn same(text: &str, reach: f64, expected: impl Fn(DVec3) -> f64) {
    let import = import(text);
    let solid = &import.model.solids[0];
    let (mut held, mut tested) = (0, 0);
    for i in 0..20_000 {
        let k = f64::from(i) + 0.5;
        let step = DVec3::new(0.819_172_513_396_164_4, 0.671_043_606_703_789_3, 0.549_700_477_901_970_2);
        let at = ((step * k).fract() * 2.0 - 1.0) * reach;
        let distance = expected(at);
        if distance.abs() < 1e-4 * reach {
            continue;
        }
        tested += 1;
        held += u32::from(distance < 0.0);
        assert_eq!(contains(solid, at), distance < 0.0, "{text} at {at}");
    }
    assert!(held > 50 && tested > held + 50, "{held} of {tested} points inside: the test says nothing");
}

/// Volume of a mesh, and the winding of its edges: each is run through once each way.
fn volume(mesh: &Mesh) -> f64 {
    let mut edges = std::collections::HashMap::new();
    for t in mesh.triangles() {
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            *edges.entry((a.min(b), a.max(b))).or_insert(0) += if a < b { 1 } else { -1 };
        }
    }
    assert!(edges.values().all(|n| *n == 0), "it is open");
    let six = |t: usize| {
        let [a, b, c] = mesh.corners(t);
        a.dot(b.cross(c))
    };
    (0..mesh.triangles().len()).map(six).sum::<f64>() / 6.0
}

/// A ray would test half-spaces one by one. The volume is that of frusta whose bases are regular polygons.
#[test]
fn many_facets_are_a_mesh() {
    let polygon = |n: f64| 0.5 * n * (TAU / n).sin();
    let frustum = |n: f64, r: [f64; 2], h: f64| polygon(n) * h / 3.0 * (r[0] * r[0] + r[0] * r[1] + r[1] * r[1]);
    let ball = |n: f64| {
        let rings = (n / 2.0).ceil();
        let at = |k: f64| (0.5 * TAU * (k + 0.5) / rings).sin_cos();
        let part = |k: usize| {
            let ((r0, z0), (r1, z1)) = (at(k as f64), at(k as f64 + 1.0));
            frustum(n, [2.0 * r0, 2.0 * r1], 2.0 * (z0 - z1))
        };
        (0..rings as usize - 1).map(part).sum::<f64>()
    };
    let cases = [
        ("sphere(r = 2, $fn = 30);", ball(30.0)),
        ("sphere(r = 2, $fn = 31);", ball(31.0)),
        ("cylinder(r1 = 3, r2 = 1, h = 5, $fn = 200);", frustum(200.0, [3.0, 1.0], 5.0)),
        ("cylinder(r1 = 3, r2 = 0, h = 5, $fn = 200);", frustum(200.0, [3.0, 0.0], 5.0)),
        ("cylinder(r1 = 0, r2 = 3, h = 5, $fn = 200);", frustum(200.0, [0.0, 3.0], 5.0)),
    ];
    for (text, expected) in cases {
        let import = scad(text.as_bytes(), "t.csg", Facets::AsWritten).expect("a solid");
        let [Primitive { shape: Shape::Mesh(mesh), .. }] = import.model.solids[0].primitives() else {
            panic!("{text} is no mesh")
        };
        let found = volume(mesh);
        assert!((found - expected).abs() < 1e-9 * expected, "{text}: {found}, not {expected}");
    }
    let few = scad("sphere(r = 2, $fn = 12);".as_bytes(), "t.csg", Facets::AsWritten).expect("a solid");
    assert!(few.model.solids[0].primitives().iter().all(|p| !matches!(p.shape, Shape::Mesh(_))));
}

fn block(p: DVec3, min: [f64; 3], max: [f64; 3]) -> f64 {
    (DVec3::from_array(min) - p).max(p - DVec3::from_array(max)).max_element()
}

/// Negative inside a convex polygon, given counter-clockwise.
fn polygon(x: f64, y: f64, corners: &[[f64; 2]]) -> f64 {
    let edge = |i: usize| {
        let ([ax, ay], [bx, by]) = (corners[i], corners[(i + 1) % corners.len()]);
        ((by - ay) * (x - ax) - (bx - ax) * (y - ay)) / (bx - ax).hypot(by - ay)
    };
    (0..corners.len()).map(edge).fold(f64::NEG_INFINITY, f64::max)
}

#[test]
fn operations_follow_their_closed_forms() {
    same("cube(size = [2, 3, 4], center = true); sphere(r = 1.8);", 3.0, |p| {
        block(p, [-1.0, -1.5, -2.0], [1.0, 1.5, 2.0]).min(p.length() - 1.8)
    });
    // the second child is the union of two
    same(
        "difference() { sphere(r = 3); group() { cube(size = 9); cylinder(h = 9, r1 = 1, r2 = 1, center = true); } }",
        3.2,
        |p| {
            let hole = (p.x.hypot(p.y) - 1.0).max(p.z.abs() - 4.5);
            (p.length() - 3.0).max(-block(p, [0.0; 3], [9.0; 3]).min(hole))
        },
    );
    // quarter turn about z, then moved: x' = 2 - y, y' = x
    same(
        "multmatrix([[0, -1, 0, 2], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) cube(size = [1, 2, 3]);"
            .replace(") cube", ") { cube")
            .replace("3]);", "3]); }")
            .as_str(),
        3.5,
        |p| block(p, [0.0, 0.0, 0.0], [2.0, 1.0, 3.0]),
    );
    // a cone: radius 2 at z = 0, 1 at z = 2
    same("cylinder(h = 2, r1 = 2, r2 = 1);", 2.5, |p| (p.x.hypot(p.y) - 2.0 + 0.5 * p.z).max(-p.z).max(p.z - 2.0));
}

#[test]
fn few_segments_are_facets() {
    let nut: Vec<[f64; 2]> =
        (0..6).map(|i| (TAU * f64::from(i) / 6.0).sin_cos()).map(|(s, c)| [2.0 * c, 2.0 * s]).collect();
    same("cylinder($fn = 6, h = 1, r1 = 2, r2 = 2);", 2.2, |p| polygon(p.x, p.y, &nut).max(-p.z).max(p.z - 1.0));
    // a pyramid: half the square's size at half the height
    same("cylinder($fn = 4, h = 2, r1 = 2, r2 = 0);", 2.2, |p| (p.x.abs() + p.y.abs() - 2.0 + p.z).max(-p.z));
    // two rings of four at 45 degrees: a prism
    same("sphere($fn = 4, r = 2);", 2.2, |p| {
        let half = 2.0 * 0.5_f64.sqrt();
        (p.x.abs() + p.y.abs() - half).max(p.z.abs() - half)
    });
    let kinds = |text| import(text).model.solids[0].primitives().len();
    assert_eq!(
        [kinds("cylinder($fn = 12, h = 1, r1 = 2, r2 = 2);"), kinds("cylinder($fn = 13, h = 1, r1 = 2, r2 = 2);")],
        [13, 1]
    );
    let written = scad(b"sphere($fn = 0, $fa = 30, $fs = 2, r = 10);", "t", Facets::AsWritten).unwrap();
    // 12 segments, 6 rings: 5 bands of 12 and the box
    assert_eq!(written.model.solids[0].primitives().len(), 61);
}

#[test]
fn polyhedra() {
    let points = "points = [[0, 0, 0], [2, 0, 0], [0, 2, 0], [0, 0, 2]]";
    let tetra = format!("polyhedron({points}, faces = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]);");
    let expected = |p: DVec3| (p.x + p.y + p.z - 2.0).max(-p.min_element());
    same(&tetra, 2.1, expected);
    let told = |text: &str| import(text).warnings.iter().map(ToString::to_string).collect::<Vec<_>>();
    assert_eq!(told(&tetra), [""; 0]);
    let inverted = format!("\npolyhedron({points}, faces = [[2, 1, 0], [1, 3, 0], [3, 2, 0], [2, 3, 1]]);");
    same(&inverted, 2.1, expected);
    let told = told(&inverted);
    assert!(
        told.len() == 1 && told[0].starts_with("t.csg:2: inverted faces: polyhedron: the faces are inside out"),
        "{told:?}"
    );
}

#[test]
fn extrusions() {
    // an L with a pocket, and a hole by a second path
    let ell = "linear_extrude(height = 2, center = true) { polygon(points = [[0, 0], [3, 0], [3, 1], [1, 1], [1, 3], [0, 3]], paths = undef); }";
    same(ell, 3.2, |p| block(p, [0.0, 0.0, -1.0], [3.0, 1.0, 1.0]).min(block(p, [0.0, 0.0, -1.0], [1.0, 3.0, 1.0])));
    let frame = "linear_extrude(height = 1) { polygon(points = [[-2, -2], [2, -2], [2, 2], [-2, 2], [-1, -1], [1, -1], [1, 1], [-1, 1]], paths = [[0, 1, 2, 3], [4, 5, 6, 7]]); }";
    same(frame, 2.2, |p| {
        block(p, [-2.0, -2.0, 0.0], [2.0, 2.0, 1.0]).max(-block(p, [-1.0, -1.0, -9.0], [1.0, 1.0, 9.0]))
    });
    // halved at the top, about the origin
    same(
        "linear_extrude(height = 2, scale = [0.5, 0.5]) { multmatrix([[1, 0, 0, 1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) { circle(r = 1); square(size = 1); } }",
        2.2,
        |p| {
            let s = 1.0 - 0.25 * p.z;
            let (x, y) = (p.x / s - 1.0, p.y / s);
            let flat = (x.hypot(y) - 1.0).min((-x).max(x - 1.0).max(-y).max(y - 1.0));
            flat.max(-p.z).max(p.z - 2.0)
        },
    );
    // a ring: torus about (2, 1) of radius 0.5
    same(
        "rotate_extrude() { multmatrix([[1, 0, 0, 2], [0, 1, 0, 1], [0, 0, 1, 0], [0, 0, 0, 1]]) { circle(r = 0.5); } }",
        2.6,
        |p| (p.x.hypot(p.y) - 2.0).hypot(p.z - 1.0) - 0.5,
    );
    // a slanted profile: outer and inner cones, three quarters around
    let corners = [[1.0, 0.0], [2.0, 0.5], [1.5, 2.0], [0.5, 1.0]];
    same("rotate_extrude(angle = 270) { polygon(points = [[1, 0], [2, 0.5], [1.5, 2], [0.5, 1]]); }", 2.2, |p| {
        polygon(p.x.hypot(p.y), p.z, &corners).max(p.x.min(-p.y))
    });
}

#[test]
fn modifiers() {
    let ball = |x: f64| move |p: DVec3| (p - DVec3::X * x).length() - 1.0;
    let at = |mods: &str| {
        let moved = "multmatrix([[1, 0, 0, 1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])";
        format!("{moved} {{ sphere(r = 1); {mods}{moved} {{ sphere(r = 1); }} }}")
    };
    same(&at("#"), 3.0, |p| ball(1.0)(p).min(ball(2.0)(p)));
    same(&at("%"), 3.0, ball(1.0));
    same(&at("*"), 3.0, ball(1.0));
    same(&at("!"), 3.0, ball(1.0)); // as if it stood at the top: moved once
    let import = import(&at("%"));
    assert_eq!(import.report.nodes["%"], 1);
    assert!(import.warnings[0].to_string().starts_with("t.csg:1: background not drawn"), "{:?}", import.warnings);
    // disabled nodes are only parsed
    assert!(super::super::scad(b"*hull() { text(); } cube();", "t", Facets::Round).is_ok());
}

#[test]
fn colours_are_linear_and_the_outermost_wins() {
    let import =
        import("color([1, 0.5, 0, 0.25]) { color([0, 0, 1, 1]) { cube(); } } color([-1, -1, -1, 1]) { cube(); }");
    let colours: Vec<_> = import.model.solids[0].primitives().iter().map(|p| p.colour).collect();
    // sRGB 0.5 is 0.21404 in linear light (IEC 61966-2-1)
    assert!((colours[0][1] - 0.214_041).abs() < 1e-5 && colours[0][0] == 1.0 && colours[0][3] == 0.25);
    assert_eq!(colours[1], crate::model::GREY);
}

#[test]
fn bad_text_is_named_with_its_line() {
    for (text, message) in [
        ("group() {\n cube();\n", "t.csg:3: the file ends 1 `}` too early"),
        ("cube(); }", "t.csg:1: a node expected, not `}`"),
        ("cube(size = 1.2.3);", "t.csg:1: `1.2.3` is not a number"),
        ("cube(size = \"a);", "t.csg:1: a text does not end"),
        ("cube(size = [1, 2);", "t.csg:1: `,` or `]` expected, not `)`"),
        ("hull() { cube();", "t.csg:1: the file ends 1 `}` too early"),
        ("resize(newsize = [1, 1, 1]) {\n cube(; }", "t.csg:2: "),
    ] {
        let found = refusal(text);
        assert!(found.starts_with(message), "{text}: {found}");
    }
    let deep = format!("cube(size = {});", "[".repeat(1_000_000));
    assert!(refusal(&deep).contains("lists nested"));
}

#[test]
fn an_operand_without_volume_is_empty_and_reported() {
    let flat = "multmatrix([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0, 0], [0, 0, 0, 1]]) { sphere(r = 1); }";
    for text in [flat, "sphere(r = nan);", "cube(size = [1, inf, 1]);", "cylinder(h = -1);"] {
        let import = import(text);
        assert!(import.model.solids.iter().all(|s| s.tree().as_constant() == Some(false)), "{text}");
        assert!(import.warnings[0].to_string().starts_with("t.csg:1: empty solid"), "{text}");
        assert!(matches!(import.warnings[0].place, Place::Line(1)));
    }
    // undef is absent: the default of 1
    assert_eq!(import("sphere(r = undef);").model.solids[0].primitives()[0].shape, Shape::Sphere { radius: 1.0 });
    // empty nodes count: a difference from nothing is empty, and so is an intersection with nothing
    for text in ["difference() { group(); cube(); }", "intersection() { cube(); group(); }"] {
        assert!(import(text).model.solids.is_empty(), "{text}");
    }
    assert_eq!(import("union() { group(); cube(); }").model.solids[0].primitives().len(), 1);
    assert_eq!(import("difference() { cube(); group(); }").model.solids[0].primitives().len(), 1);
    // nodes that are no part of the solid do not
    for text in ["difference() { *group(); cube(); }", "difference() { %sphere(); cube(); }"] {
        assert_eq!(import(text).model.solids[0].primitives().len(), 1, "{text}");
    }
    assert!(import("").model.solids.is_empty() && import("group() { }").model.solids.is_empty());
}

/// Deeper than any call stack: groups, and differences that each add an operation.
#[test]
fn a_million_nodes_deep() {
    let text = format!("{}cube();{}", "group(){".repeat(1_000_000), "}".repeat(1_000_000));
    assert_eq!(import(&text).model.solids[0].tree().nodes().len(), 1);
    let text = format!("{}cube();{}", "difference(){cube();".repeat(300_000), "}".repeat(300_000));
    assert_eq!(import(&text).model.solids[0].tree().heights().last(), Some(&300_000));
}

/// The files of a folder are read; without a font, text is left out by name.
#[test]
fn files_of_a_folder() {
    let Some(folder) = std::env::var_os("SELVEDGE_MODELS").map(std::path::PathBuf::from) else {
        eprintln!("skipped: SELVEDGE_MODELS names no folder");
        return;
    };
    let Ok(files) = std::fs::read_dir(folder.join("../csg")) else {
        eprintln!("skipped: no folder csg beside SELVEDGE_MODELS");
        return;
    };
    let mut read = 0;
    for path in files.map(|f| f.unwrap().path()).filter(|p| p.extension().is_some_and(|e| e == "csg")) {
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        let import = open(&path).unwrap_or_else(|e| panic!("{name}: {e}"));
        eprintln!("{name}: {:?}", import.report.nodes);
        let told =
            |w: &&crate::import::Warning| w.message.contains("is not installed") || w.message.contains("surface");
        let other: Vec<_> = import.warnings.iter().filter(|w| !told(w)).collect();
        assert!(other.is_empty(), "{name}: {other:?}");
        assert!(import.model.bounds().diagonal() > 0.0 || !import.warnings.is_empty(), "{name}");
        read += 1;
    }
    assert!(read >= 10, "{read} files");
}
