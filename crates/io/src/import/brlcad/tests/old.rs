//! The older form: what it means is what the same solids mean in the newer one.

use super::{contains, import};
use crate::import::brlcad;
use crate::import::damage::{one_change_one_message, outcome, replaced};
use crate::model::Shape;
use glam::DVec3;

const HEAD: &str = "I 0 v4\nbox in the old form\n";
/// 10 x 20 x 30: corners after the first are relative to it.
const BOX: &str = "S 20 box.s 1 1 2 3 10 0 0 10 20 0 0 20 0 0 0 30 10 0 30 10 20 30 0 20 30\n";
const BALL: &str = "S 19 ball.s 4 0 0 0 2 0 0 0 2 0 0 0 2 0 0 0 0 0 0 0 0 0 0 0 0\n";
const STAY: &str = "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 0";

fn moved(x: f64) -> String {
    format!("1 0 0 {x} 0 1 0 0 0 0 1 0 0 0 0 1 0")
}

fn said(text: &str) -> Vec<String> {
    import(text).warnings.iter().map(ToString::to_string).collect()
}

#[test]
fn a_box() {
    let import = import(&format!("{HEAD}{BOX}"));
    assert!(import.warnings.is_empty(), "{:?}", import.warnings);
    assert_eq!((import.report.format.as_str(), import.report.units.len()), ("BRL-CAD asc, version 4", 0));
    assert_eq!(import.report.occurrences, ["box.s"]);
    let box_of = import.model.solids[0].bounds();
    assert!(box_of.min.cmple(DVec3::new(1.0, 2.0, 3.0)).all() && box_of.max.cmpge(DVec3::new(11.0, 22.0, 33.0)).all());
    // each side, from within and without
    let middle = DVec3::new(6.0, 12.0, 18.0);
    for (axis, half) in [(DVec3::X, 5.0), (DVec3::Y, 10.0), (DVec3::Z, 15.0)] {
        for sign in [-1.0, 1.0] {
            let at = |off: f64| (middle + axis * (sign * (half + off))).to_array();
            assert!(contains(&import, at(-1e-9)) && !contains(&import, at(1e-9)), "{axis} {sign}");
        }
    }
}

/// `S` lines and the `put` statements that mean the same.
#[test]
fn every_kind_of_solid_is_that_of_the_newer_form() {
    for (old, new) in [
        ("S 16 a 6 1 2 3 0 0 2 0 5 0 5 0 0", "tor V {1 2 3} H {0 0 2} r_a 5 r_h 2"),
        // the axis by rounding longer than the other radius
        ("S 16 a 6 1 2 3 0 0 5.1 0 5 0 5 0 0", "tor V {1 2 3} H {0 0 2} r_a 5 r_h 5"),
        (
            "S 18 a 5 0 0 0 0 0 9 1 0 0 0 2 0 2 0 0 0 4 0",
            "tgc V {0 0 0} H {0 0 9} A {1 0 0} B {0 2 0} C {2 0 0} D {0 4 0}",
        ),
        ("S 19 a 4 1 2 3 2 0 0 0 1 0 0 0 4", "ell V {1 2 3} A {2 0 0} B {0 1 0} C {0 0 4}"),
        ("S 24 a 0 0 0 1 -2", "half N {0 0 1} d -2"),
        ("S 26 a 0 0 0 0 0 0 5 2 0 0 3", "rpc V {0 0 0} H {0 0 5} B {2 0 0} r 3"),
        ("S 27 a 0 0 0 0 0 0 5 2 0 0 3 1", "rhc V {0 0 0} H {0 0 5} B {2 0 0} r 3 c 1"),
        ("S 28 a 0 0 0 0 0 0 5 1 0 0 3 2", "epa V {0 0 0} H {0 0 5} A {1 0 0} r_1 3 r_2 2"),
        ("S 29 a 0 0 0 0 0 0 5 1 0 0 3 2 1", "ehy V {0 0 0} H {0 0 5} A {1 0 0} r_1 3 r_2 2 c 1"),
        ("S 30 a 0 0 0 0 0 0 2 1 0 1 5 1", "eto V {0 0 0} N {0 0 2} C {1 0 1} r 5 r_d 1"),
        ("S 33 a 0 0 0 0 0 0 5 3 0 0 2 0.5", "hyp V {0 0 0} H {0 0 5} A {3 0 0} b 2 bnr 0.5"),
        ("p a 0 0 0 0 0 5 2 1", "part V {0 0 0} H {0 0 5} r_v 2 r_h 1"),
        ("w a\n1 2 3 0 0 0\n1 2 3 9 0 0\nEND_PIPE a", "pipe V0 {0 0 0} O0 2 I0 1 R0 3 V1 {9 0 0} O1 2 I1 1 R1 3"),
        (
            "t a 2 2 0 4 4\n\t0: 0 0 0\n\t1: 1 0 0\n\t2: 0 1 0\n\t3: 0 0 1\n\t0: 0 2 1\n\t1: 0 1 3\n\t2: 1 2 3\n\t3: 2 0 3",
            "bot mode volume orient rh V {{0 0 0} {1 0 0} {0 1 0} {0 0 1}} F {{0 2 1} {0 1 3} {1 2 3} {2 0 3}}",
        ),
    ] {
        // padded with zeros, as the converter does
        let old = if old.starts_with('S') { format!("{old} 0 0 0") } else { old.to_owned() };
        let (old, new) = (import(&format!("{HEAD}{old}\n")), import(&format!("put a {new}\n")));
        assert!(old.warnings.is_empty(), "{:?}", old.warnings);
        assert_eq!(old.model.solids, new.model.solids);
    }
}

/// `a - b u c + d` is `(a - b) u (c + d)`, whatever the first member's operation says.
#[test]
fn unions_bind_last() {
    let member = |op: &str, x: f64| format!("M {op} ball.s {}\n", moved(x));
    let all = ["u", "-", "u", "+", "-"].iter().zip([0.0, 2.0, 9.0, 11.0, 10.0]).map(|(op, x)| member(op, x));
    let text = format!("{HEAD}{BALL}C N all 0 0 5 0 0 0 0 0 0 0\n{}", all.collect::<String>());
    let import = import(&text);
    for (x, inside) in [(-1.5, true), (-0.01, true), (0.5, false), (3.0, false), (9.5, false), (12.5, false)] {
        assert_eq!(contains(&import, [x, 0.0, 0.0]), inside, "{x}");
    }
    // within c and d, but beside the last that is taken away
    let import = super::import(&text.replacen(&member("-", 10.0), &member("-", 19.0), 1));
    assert!(contains(&import, [10.0, 0.0, 0.0]) && !contains(&import, [8.5, 0.0, 0.0]));
}

/// Member of a member: matrices from the outside in, colours of regions by their own, by the table, and by who holds.
#[test]
fn places_and_colours() {
    let text = |top: &str, region: &str, table: &str| {
        format!(
            "{HEAD}{BALL}{table}C Y r {region}\nshader\nM u ball.s {}\nC N all 0 0 1 0 0 0 {top}\nM u r 0 -1 0 5 1 0 0 0 0 0 1 0 0 0 0 1 0\n",
            moved(3.0)
        )
    };
    let red = [1.0, 0.0, 0.0, 1.0];
    let (green, blue, grey) = ([0.0, 1.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0], crate::model::GREY);
    let of = |text: &str| {
        let read = import(text);
        assert!(read.warnings.is_empty(), "{:?}", read.warnings);
        let ball = &read.model.solids[0].primitives()[0];
        // moved by 3 along x, then turned by a right angle and moved by 5
        assert_eq!(ball.transform.translation, DVec3::new(5.0, 3.0, 0.0));
        assert_eq!(ball.shape, Shape::Sphere { radius: 1.0 });
        ball.colour
    };
    let (own, none) = ("7 0 1 0 0 100 1 255 0 0 1 0 0", "7 0 1 0 0 100 0 0 0 0 1 0 0");
    assert_eq!(of(&text("0 0 0 0", none, "")), grey);
    assert_eq!(of(&text("0 0 0 0", own, "")), red);
    assert_eq!(of(&text("1 0 255 0", own, "")), red);
    assert_eq!(of(&text("1 0 255 0", none, "")), green);
    // the last number but one that follows says that the outer colour holds
    assert_eq!(of(&text("1 0 255 0 0 0 1", own, "")), green);
    assert_eq!(of(&text("0 0 0 0", own, "m 0 5 9 0 0 255\n")), blue);
    assert_eq!(of(&text("0 0 0 0", own, "m 0 8 9 0 0 255\n")), red);
}

/// What a damaged neighbour says, and what is left.
#[test]
fn damage_is_reported() {
    let region = format!("C N all 0 0 2 0 0 0 0 0 0 0\nM u box.s {STAY}\nM - ball.s {STAY}\n");
    let good = format!("{HEAD}{BOX}{BALL}{region}");
    // a line per record, from 3 on: box, ball, the combination and its members; a ball that nobody names is drawn
    let changes = [
        (
            "type",
            "I 0",
            "I 77",
            "t.asc:1: record left out: I 77 v4: not a number of a unit; lengths are millimetres",
            (),
        ),
        ("type", "C N", "X N", "t.asc:5: record left out: X N all 0 0 2 0 0 0 0 0 0 0", ()),
        ("swapped", "M - ball.s", "M - bell.s", "t.asc:7: solid left out: `bell.s` does not exist", ()),
        (
            "type",
            "M - ball.s",
            "M ? ball.s",
            "t.asc:7: solid left out: a member of `all` without operation or matrix",
            (),
        ),
        (
            "type",
            "0 0 0 1 0\nM - ball",
            "0 1e-5 0 1 0\nM - ball",
            "t.asc:6: solid left out: a member of `all` without operation or matrix",
            (),
        ),
        (
            "type",
            "M - ball.s 1 0",
            "M - ball.s x 0",
            "t.asc:7: solid left out: a member of `all` without operation or matrix",
            (),
        ),
        ("cycle", "M u box.s", "M u all", "error: t.asc:5: `all` is part of itself", ()),
        ("type", "S 20", "S 21", "error: t.asc:3: box.s 21: such a solid has no exact counterpart and is not read", ()),
        ("missing", " 30 0 20 30", " 30 0 20", "error: t.asc:3: box.s arb8: `V8` is not 3 finite numbers", ()),
        (
            "NaN",
            "S 19 ball.s 4 0 0 0 2",
            "S 19 ball.s 4 0 0 0 inf",
            "error: t.asc:4: ball.s ell: `A` is not 3 finite numbers",
            (),
        ),
        (
            "type",
            BALL,
            "A 21 ball.s 2 3 1 2\nB 22 1 1 0 0 0\n",
            "error: t.asc:4: ball.s ars: such a solid has no exact counterpart and is not read",
            (),
        ),
        ("type", "C N all 0 0", "C Y all 7 1", "t.asc:5: region of air not drawn: all", ()),
        ("swapped", BALL, &BALL.repeat(2), "t.asc:5: name given twice: `ball.s` of line 4 is replaced", ()),
    ];
    one_change_one_message(
        &good,
        replaced,
        |text| outcome(brlcad(text.as_bytes(), "t.asc"), |_| true, |_| ()),
        &changes,
    );
    // rounding, which no perspective is
    let rounded = replaced(&good, "0 0 0 1 0\nM - ball", "0 1e-9 0 1 0\nM - ball");
    assert!(said(&rounded).is_empty());
    // a union shows what is left of it
    let left = replaced(&good, "M - ball.s", "M u bell.s");
    assert_eq!(said(&left), ["t.asc:7: solid left out: `bell.s` does not exist"]);
    assert!(contains(&import(&left), [6.0, 12.0, 18.0]));
}

#[test]
fn known_by_its_first_line() {
    assert!(super::super::recognise("I 0 v4\ntitle\n") && super::super::recognise("# made by hand\nI 1 v4\n"));
    for other in ["I am no such file\n", "I v4\n", "0\nI 0 v4\n", ""] {
        assert!(!super::super::recognise(other), "{other}");
    }
}
