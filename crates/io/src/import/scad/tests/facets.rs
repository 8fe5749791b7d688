//! Nodes that depend on facets, against closed forms.

use super::{block, import, polygon, same};
use crate::import::{Facets, Options, scad};
use crate::model::Shape;
use glam::DVec3;
use std::f64::consts::PI;

fn moved(x: f64, y: f64, z: f64, node: &str) -> String {
    format!("multmatrix([[1, 0, 0, {x}], [0, 1, 0, {y}], [0, 0, 1, {z}], [0, 0, 0, 1]]) {{ {node} }}")
}

#[test]
fn hulls() {
    let two = format!("hull() {{ cube(size = [1, 1, 1]); {} }}", moved(2.0, 0.0, 0.0, "cube(size = [1, 1, 3]);"));
    let side = [[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [2.0, 3.0], [0.0, 1.0]];
    same(&two, 3.5, |p| polygon(p.x, p.z, &side).max(-p.y).max(p.y - 1.0));
    let import = import(&two);
    // six sides, and a box around them
    assert_eq!(import.model.solids[0].primitives().len(), 1 + 7);
    assert!(import.warnings.is_empty());
    // of a difference: its hull counts only the remaining part
    let cut = "hull() { difference() { cube(size = 2); multmatrix([[1, 0, 0, 1], [0, 1, 0, -1], [0, 0, 1, -1], [0, 0, 0, 1]]) { cube(size = 4); } } }";
    same(cut, 2.5, |p| block(p, [0.0; 3], [1.0, 2.0, 2.0]));
    // in the plane
    let flat = "linear_extrude(height = 1) { hull() { square(size = 1); multmatrix([[1, 0, 0, 2], [0, 1, 0, 2], [0, 0, 1, 0], [0, 0, 0, 1]]) { square(size = 1); } } }";
    let six = [[0.0, 0.0], [1.0, 0.0], [3.0, 2.0], [3.0, 3.0], [2.0, 3.0], [0.0, 1.0]];
    same(flat, 3.5, |p| polygon(p.x, p.y, &six).max(-p.z).max(p.z - 1.0));
}

/// A mesh: rings of 100 corners at heights `r cos((i + ½) π / 50)`, the widest of radius `r cos(π / 100)`.
#[test]
fn a_ball_of_many_facets_has_the_box_of_its_corners() {
    let text = b"sphere($fn = 100, r = 10);";
    let ball = scad(text, "t.csg", Facets::AsWritten).unwrap().model;
    assert_eq!(ball.solids[0].primitives().len(), 1);
    let (found, far) = (ball.bounds(), 10.0 * (PI / 100.0).cos());
    let off = (found.max - far).abs().max((found.min + far).abs()).max_element();
    assert!(off < 1e-9, "{found:?}");
}

/// Half-spaces stand for facets, in a block that is wider; the box is that of the corners.
#[test]
fn boxes_are_those_of_corners() {
    let hull = format!("hull() {{ cube(size = 1); {} }}", moved(2.0, 3.0, 4.0, "cube(size = 1);"));
    let tetra = "polyhedron(points = [[0, 0, 0], [10, 0, 0], [0, 10, 0], [0, 0, 10]], \
        faces = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]);";
    let less = format!("difference() {{ {tetra} sphere(r = 1); }}");
    let (sine, ring) = (5.0 * 60_f64.to_radians().sin(), 2.0 * 22.5_f64.to_radians().cos());
    for (text, min, max) in [
        (hull.as_str(), [0.0; 3], [3.0, 4.0, 5.0]),
        (tetra, [0.0; 3], [10.0; 3]),
        ("cylinder($fn = 6, h = 4, r1 = 5, r2 = 2);", [-5.0, -sine, 0.0], [5.0, sine, 4.0]),
        ("sphere($fn = 8, r = 2);", [-ring; 3], [ring; 3]),
        (less.as_str(), [0.0; 3], [10.0; 3]),
    ] {
        let found = import(text).model.bounds();
        let off = (found.min - DVec3::from(min)).abs().max((found.max - DVec3::from(max)).abs()).max_element();
        assert!(off < 1e-12, "{text}: {found:?}");
    }
}

#[test]
fn minkowski_sums() {
    same("minkowski() { cube(size = [1, 2, 3]); cube(size = 1, center = true); }", 4.0, |p| {
        block(p, [-0.5; 3], [1.5, 2.5, 3.5])
    });
    // a square tube grown by a cube: by parts
    let tube = "difference() { cube(size = [6, 6, 1], center = true); cube(size = [4, 4, 2], center = true); }";
    same(&format!("minkowski() {{ {tube} cube(size = 1, center = true); }}"), 4.0, |p| {
        block(p, [-3.5, -3.5, -1.0], [3.5, 3.5, 1.0]).max(-block(p, [-1.5, -1.5, -9.0], [1.5, 1.5, 9.0]))
    });
    // a lost operand loses the sum
    let lost = import("minkowski() { cube(); frobnicate(); } cube();");
    assert!(lost.warnings.len() == 1 && lost.model.solids[0].primitives().len() == 1);
}

#[test]
fn offsets_and_projections() {
    let square = "square(size = 4, center = true);";
    let grown = |how: &str| format!("linear_extrude(height = 1) {{ offset({how}) {{ {square} }} }}");
    same(&grown("delta = 1"), 4.0, |p| block(p, [-3.0, -3.0, 0.0], [3.0, 3.0, 1.0]));
    same(&grown("r = -1"), 4.0, |p| block(p, [-1.0, -1.0, 0.0], [1.0, 1.0, 1.0]));
    // an octagon: the corners of a square of 6 are cut where |x| + |y| is 4 + sqrt 2
    same(&grown("delta = 1, chamfer = true"), 4.0, |p| {
        let diagonal = (p.x.abs() + p.y.abs() - 4.0 - 2.0_f64.sqrt()) / 2.0_f64.sqrt();
        block(p, [-3.0, -3.0, 0.0], [3.0, 3.0, 1.0]).max(diagonal)
    });
    let ring = "difference() { cube(size = 4, center = true); cube(size = [2, 2, 9], center = true); }";
    for cut in ["true", "false"] {
        same(&format!("linear_extrude(height = 1) {{ projection(cut = {cut}) {{ {ring} }} }}"), 3.0, |p| {
            block(p, [-2.0, -2.0, 0.0], [2.0, 2.0, 1.0]).max(-block(p, [-1.0, -1.0, -9.0], [1.0, 1.0, 9.0]))
        });
    }
    // above the plane: a shadow, but no cut
    let high = moved(0.0, 0.0, 5.0, "cube(size = 1);");
    same(&format!("linear_extrude(height = 1) {{ projection(cut = false) {{ {high} }} }}"), 2.0, |p| {
        block(p, [0.0; 3], [1.0; 3])
    });
    assert!(
        import(&format!("linear_extrude(height = 1) {{ projection(cut = true) {{ {high} }} }}"))
            .model
            .solids
            .is_empty()
    );
}

#[test]
fn what_is_resized_stays_exact() {
    // the box is that of eight facets: a radius of cos 22.5 degrees in y and z, where facets end in x a corner
    let text = "resize(newsize = [10, 0, 6], auto = [0, 0, 0]) { cube(size = [1, 2, 3]); }";
    same(text, 11.0, |p| block(p, [0.0; 3], [10.0, 2.0, 6.0]));
    let auto = "resize(newsize = [10, 0, 0], auto = [1, 1, 0]) { cube(size = [1, 2, 3]); }";
    same(auto, 21.0, |p| block(p, [0.0; 3], [10.0, 20.0, 3.0]));
    let ball = import("resize(newsize = [40, 40, 40]) { sphere(r = 10, $fn = 100); }");
    let solid = &ball.model.solids[0];
    assert_eq!(solid.primitives().len(), 1);
    assert_eq!(solid.primitives()[0].shape, Shape::Sphere { radius: 10.0 });
    // numbers of nodes, and counts, are those of one reading
    assert_eq!((solid.primitives()[0].id, ball.report.nodes["sphere"]), (2, 1));
    let twice = import("resize(newsize = [4, 4, 4]) { resize(newsize = [1, 2, 3]) { cube(); %cube(); } } cube();");
    assert_eq!((twice.report.nodes["cube"], twice.warnings.len()), (2, 1));
    // without children: the nodes after it have their warnings
    assert_eq!(import("resize(newsize = [1, 1, 1]); %cube();").warnings.len(), 1);
    // in the plane
    same("linear_extrude(height = 1) { resize(newsize = [4, 2, 0]) { square(size = 1, center = true); } }", 3.0, |p| {
        block(p, [-2.0, -1.0, 0.0], [2.0, 1.0, 1.0])
    });
}

#[test]
fn outlines_that_cross_themselves_hold_what_is_odd() {
    let tie = "linear_extrude(height = 1) { polygon(points = [[0, 0], [2, 2], [2, 0], [0, 2]]); }";
    same(tie, 2.5, |p| {
        let left = polygon(p.x, p.y, &[[0.0, 0.0], [1.0, 1.0], [0.0, 2.0]]);
        left.min(polygon(p.x, p.y, &[[2.0, 0.0], [2.0, 2.0], [1.0, 1.0]])).max(-p.z).max(p.z - 1.0)
    });
    assert!(import(tie).warnings.is_empty());
}

#[test]
fn few_segments_turn_by_an_angle() {
    // four segments of 90 degrees, two of which are made: squares of corners at 1 and 2
    let text = "rotate_extrude(angle = 180, $fn = 4) { multmatrix([[1, 0, 0, 1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) { square(size = 1); } }";
    same(text, 2.2, |p| {
        let out = (p.x.abs() + p.y.abs() - 2.0) / 2.0_f64.sqrt();
        let hole = (p.x.abs() + p.y.abs() - 1.0) / 2.0_f64.sqrt();
        out.max(-hole).max(-p.y).max(-p.z).max(p.z - 1.0)
    });
    // three, all around: OpenSCAD's first corner lies at negative x
    same("rotate_extrude($fn = 3) { square(size = 1); }", 1.2, |p| {
        let (s, c) = (0.75_f64.sqrt(), 0.5);
        polygon(p.x, p.y, &[[-1.0, 0.0], [c, -s], [c, s]]).max(-p.z).max(p.z - 1.0)
    });
}

#[test]
fn dimensions_that_do_not_fit_are_reported() {
    let mixed = import("hull() { cube(); square(); }");
    assert!(mixed.warnings[0].to_string().contains("mixed dimensions: `hull`: 1 children"), "{:?}", mixed.warnings);
    let told = |text: &str| import(text).warnings.iter().map(ToString::to_string).collect::<Vec<_>>();
    assert!(told("hull() { square(); }")[0].contains("2-D shape left out: `hull` outside of an extrusion"));
    assert!(told("linear_extrude(height = 1) { hull() { cube(); } }")[0].contains("solid left out: `hull` inside"));
    assert!(told("offset(r = nan) { square(); }")[0].contains("left out: offset: a distance that is not finite"));
    assert!(told("hull() { sphere($fn = 1e6); }")[0].contains("left out: sphere: 1000000 segments"));
    let far = DVec3::splat(1e300);
    let sum = format!("minkowski() {{ cube(size = 1e300); {} }}", moved(far.x, far.y, far.z, "cube(size = 1e300);"));
    let _ = import(&sum); // may be left out, but ends
}

/// Files beside the one that names them.
#[test]
fn imported_files() {
    let folder = std::env::temp_dir().join(format!("selvedge-scad-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.join(name), text).unwrap();
    write("t.off", "OFF\n4 4 0\n0 0 0\n2 0 0\n0 2 0\n0 0 2\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n");
    write("h.dat", "0 0\n0 0\n");
    write("open.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    let name = folder.join("t.csg").display().to_string();
    let read = |text: &str| crate::import::scad(text.as_bytes(), &name, super::Facets::Round).unwrap();
    let tetra = read("import(file = \"t.off\");");
    assert!(tetra.warnings.is_empty());
    assert_eq!(tetra.model.solids[0].primitives().len(), 5, "four half-spaces and the box around them");
    // eight planes or fewer: a square of one, one deep
    let flat = &read("surface(file = \"h.dat\");").model.solids[0];
    for (p, inside) in
        [([0.5, 0.5, -0.5], true), ([0.5, 0.5, 0.1], false), ([0.5, 0.5, -1.1], false), ([1.1, 0.5, -0.5], false)]
    {
        assert_eq!(super::contains(flat, DVec3::from_array(p)), inside, "{p:?}");
    }
    for x in [0.1, 0.9] {
        let inside = super::contains(&tetra.model.solids[0], DVec3::splat(x));
        assert_eq!(inside, x < 2.0 / 3.0);
    }
    for (text, message) in [
        ("import(file = \"open.off\");", "left out: import: the faces do not close"),
        ("import(file = \"gone.off\");", "left out: import: gone.off: "),
        ("import(file = \"t.xyz\");", "left out: import: t.xyz: "),
        ("import(file = \"../t.off\");", "left out: import: ../t.off: not beside the model"),
        ("surface(file = \"/etc/passwd\");", "left out: surface: /etc/passwd: not beside the model"),
        ("surface(file = \"t.off\");", "left out: surface: t.off: line 1 holds"),
    ] {
        let told = read(text).warnings;
        assert!(told.len() == 1 && told[0].message.contains(message), "{text}: {told:?}");
    }
    // inputs of their own, each once, under the limit on a file
    let both = "import(file = \"t.off\"); resize(newsize = [4, 0, 0]) { import(file = \"t.off\"); } \
                surface(file = \"h.dat\");";
    assert_eq!(read(both).report.files_read, [folder.join("t.off"), folder.join("h.dat")]);
    let options = Options { most_bytes: Some(20), ..Options::default() };
    let short = crate::import::scad_with(both.as_bytes(), &name, &options).unwrap();
    let why = "left out: import: t.off: larger than 20 bytes, the most that is read";
    assert!(short.warnings[0].message.contains(why), "{:?}", short.warnings);
    assert_eq!(short.report.files_read, [folder.join("h.dat")]);
    std::fs::remove_dir_all(&folder).unwrap();
}
