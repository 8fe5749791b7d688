//! Small databases against closed forms.

mod classes;
mod old;
mod solids;

use crate::import::{Import, brlcad, open};
use crate::model::Shape;
use glam::DVec3;

fn import(text: &str) -> Import {
    brlcad(text.as_bytes(), "t.asc").expect("a solid")
}

fn contains(import: &Import, at: [f64; 3]) -> bool {
    let solid = &import.model.solids[0];
    solid.tree().contains(|p| {
        let p = &solid.primitives()[p as usize];
        let own = p.to_own().expect("not flat").transform_point3(DVec3::from_array(at));
        p.shape.carriers().iter().all(|c| c.value(own) <= 0.0)
    })
}

const BOX: &str =
    "put box arb8 V1 {0 0 0} V2 {4 0 0} V3 {4 4 0} V4 {0 4 0} V5 {0 0 4} V6 {4 0 4} V7 {4 4 4} V8 {0 4 4}\n";
const ROD: &str = "put rod tgc V {0 0 -1} H {0 0 9} A {1 0 0} B {0 1 0} C {1 0 0} D {0 1 0}\n";

/// What leaves no trace in the picture does so in the warnings.
#[test]
fn flat_solids_and_lost_colours_are_reported() {
    let told = |text: &str| import(text).warnings.iter().map(ToString::to_string).collect::<Vec<_>>();
    let whole = format!("title {{A box}}\nunits mm\n{BOX}");
    assert!(told(&whole).is_empty());
    let ball = "put ball ell V {0 0 0} A {0 0 0} B {0 2 0} C {0 0 3}\n";
    let flat = "t.asc:4: empty solid: the axes of `ball`, or matrices around it, are flat";
    assert_eq!(told(&format!("{whole}{ball}")), [flat]);
    for (line, message) in [
        ("put all comb rgb {255 0} tree {l box}", "colour left out: `255 0` is no red, green and blue"),
        ("attr set box rgb red", "colour left out: `red` is no red, green and blue"),
        ("attr set bux rgb {255 0 0}", "attributes not used: `bux` does not exist"),
    ] {
        assert_eq!(told(&format!("{whole}{line}\n")), [format!("t.asc:4: {message}")], "{line}");
    }
    assert!(told(&format!("{whole}attr set _GLOBAL units mm\n")).is_empty());
}

#[test]
fn a_drilled_box() {
    let moved = "{1 0 0 2 0 1 0 2 0 0 1 0 0 0 0 1}";
    let text = format!(
        "title {{A box}}\nunits mm\n{BOX}{ROD}put all comb region yes rgb {{255 0 0}} \\\n tree {{- {{l box}} {{l rod {moved}}}}}\n"
    );
    let import = import(&text);
    // six faces and the box around them, and the hole of radius 1 about (2, 2)
    assert_eq!(import.model.solids[0].primitives().len(), 8);
    for (at, expected) in [
        ([0.5, 0.5, 0.5], true),
        ([2.0, 2.0, 2.0], false),
        ([2.0, 3.01, 2.0], true),
        ([2.0, 2.99, 2.0], false),
        ([2.0, 3.5, 4.01], false),
        ([4.01, 2.0, 2.0], false),
        ([-0.01, 2.0, 2.0], false),
    ] {
        assert_eq!(contains(&import, at), expected, "{at:?}");
    }
    assert_eq!(import.model.solids[0].primitives()[0].colour, [1.0, 0.0, 0.0, 1.0]);
    assert_eq!(import.report.occurrences, ["all"]);
}

/// A wedge by corners that coincide, an oblique cone by its small end first, a stretched ball, a ring.
#[test]
fn solids_against_closed_forms() {
    let wedge = "put w arb8 V1 {0 0 0} V2 {2 0 0} V3 {2 2 0} V4 {0 2 0} V5 {0 0 2} V6 {0 0 2} V7 {0 2 2} V8 {0 2 2}";
    let cone = "put c tgc V {4 0 2} H {-4 0 -2} A {1 0 0} B {0 1 0} C {2 0 0} D {0 2 0}";
    let ball = "put b ell V {1 2 3} A {2 0 0} B {0 1 0} C {0 0 1}";
    let ring = "put t tor V {1 0 0} H {5 0 0} r_a 3 r_h 1";
    let points = |i: u32| {
        let k = f64::from(i) + 0.5;
        (DVec3::new(0.819_172_5, 0.671_043_6, 0.549_700_5) * k).fract() * 10.0 - 4.0
    };
    let check = |text: &str, expected: &dyn Fn(DVec3) -> bool| {
        let import = import(text);
        let inside = (0..20_000).map(points).filter(|p| {
            assert_eq!(contains(&import, p.to_array()), expected(*p), "{text} at {p}");
            expected(*p)
        });
        assert!(inside.count() > 50, "{text}");
    };
    check(wedge, &|p| p.min_element() >= 0.0 && p.y <= 2.0 && p.x + p.z <= 2.0);
    check(cone, &|p| (0.0..=2.0).contains(&p.z) && (p.x - 2.0 * p.z).hypot(p.y) <= 2.0 - 0.5 * p.z);
    check(ball, &|p| ((p.x - 1.0) / 2.0).hypot(p.y - 2.0).hypot(p.z - 3.0) <= 1.0);
    check(ring, &|p| (p.y.hypot(p.z) - 3.0).hypot(p.x - 1.0) <= 1.0);
}

#[test]
fn refusals_name_line_and_object() {
    let line = |text: &str| brlcad(text.as_bytes(), "t.asc").expect_err("no solid").to_string();
    for (text, message) in [
        ("put a comb tree {l b}\nput b comb tree {l a}\n", "t.asc:1: every combination is part of another"),
        ("put c comb tree {l a}\nput a comb tree {u {l a} {l a}}\n", "t.asc:2: `a` is part of itself"),
        ("put a comb tree {l nobody}\n", "t.asc:1: `nobody` does not exist"),
        ("\nput e superell V {0 0 0}\n", "t.asc:2: e superell: such a solid has no exact counterpart"),
        ("put e ell V {0 0 0} A {1 0}\n", "t.asc:1: e ell: `A` is not 3 finite numbers"),
        ("put e ell V {0 0 0\n", "t.asc:1: a brace or quote does not close"),
        ("put a comb tree {x {l b}}\n", "t.asc:1: tree: `x` with 1 operands"),
        (
            "put c tgc V {0 0 0} H {0 0 1} A {1 0 0} B {0 1 0} C {0 .5 0} D {-.5 0 0}",
            "t.asc:1: c tgc: ends that are turned against each other",
        ),
    ] {
        let found = line(text);
        assert!(found.starts_with(message), "{found}");
    }
    // forty combinations, each twice the one before
    let mut bomb = "put c0 ell V {0 0 0} A {1 0 0} B {0 1 0} C {0 0 1}\n".to_owned();
    (1..40).for_each(|i| bomb += &format!("put c{i} comb tree {{u {{l c{0}}} {{l c{0}}}}}\n", i - 1));
    assert!(line(&bomb).contains("placed members"));
}

#[test]
fn a_tree_of_a_million_levels() {
    let n = 1_000_000;
    let tree = format!("{}l a{}", "u {".repeat(n), "} {l a}".repeat(n));
    let text = format!("put a ell V {{0 0 0}} A {{1 0 0}} B {{0 1 0}} C {{0 0 1}}\nput all comb tree {{{tree}}}\n");
    assert_eq!(import(&text).model.solids[0].tree().leaves().count(), n + 1);
}

#[test]
fn chosen_by_content() {
    let path = std::env::temp_dir().join(format!("selvedge-brlcad-{}.txt", std::process::id()));
    std::fs::write(&path, format!("title {{x}}\nunits mm\n{ROD}")).unwrap();
    let import = open(&path);
    std::fs::remove_file(&path).unwrap();
    let import = import.unwrap();
    let shape = &import.model.solids[0].primitives()[0].shape;
    assert_eq!(*shape, Shape::Cylinder { radius: 1.0, height: 1.0 });
}
