//! Hand-made patches with known points, and damaged text.

mod classes;

use super::PALETTE;
use crate::import::damage::random::assert_sound;
use crate::import::damage::replaced;
use crate::import::{Import, bv, open};
use crate::model::Face;
use glam::DVec3;
use proptest::prelude::*;

fn import(text: &str) -> Import {
    bv(text.as_bytes(), "t.bv").expect("a BezierView file")
}

fn told(import: &Import) -> Vec<String> {
    import.warnings.iter().map(ToString::to_string).collect()
}

#[track_caller]
fn face(text: &str) -> Face {
    let read = import(text);
    assert!(read.warnings.is_empty(), "{:?}", told(&read));
    read.model.parts[0].faces[0].clone()
}

/// A parabolic trough: straight along u, `z = 2 v (1 - v)` across.
const TROUGH: &str = "5\n1 2\n-2 -2 0\n-2 0 1\n-2 2 0\n2 -2 0\n2 0 1\n2 2 0\n";

#[test]
fn rows_of_points_run_along_v() {
    let trough = face(TROUGH);
    assert_eq!(trough.surface.degrees(), (1, 2));
    for (u, v) in [(0.0, 0.0), (0.25, 0.5), (1.0, 0.75)] {
        let expected = DVec3::new(4.0 * u - 2.0, 4.0 * v - 2.0, 2.0 * v * (1.0 - v));
        assert_eq!(trough.surface.jet(u, v).point, expected);
    }
    assert!(trough.loops.is_empty());
    let square = face("4 1 0 0 0  0 1 0  1 0 0  1 1 5");
    assert_eq!(square.surface.jet(0.5, 0.5).point, DVec3::new(0.5, 0.5, 1.25));
}

/// A quarter of a cylinder: weights stand with the coordinates multiplied by them.
#[test]
fn rational_points_are_homogeneous() {
    let w = std::f64::consts::FRAC_1_SQRT_2;
    let cylinder = face(&format!("8 2 1\n1 0 0 1  1 0 3 1\n{w} {w} 0 {w}  {w} {w} {} {w}\n0 1 0 1  0 1 3 1", 3.0 * w));
    for i in 0..=10 {
        let p = cylinder.surface.jet(f64::from(i) / 10.0, 0.5).point;
        assert!((p.x.hypot(p.y) - 1.0).abs() < 1e-15 && (p.z - 1.5).abs() < 1e-15, "{p}");
    }
}

/// A triangle of a paraboloid `z = x² + y²` over the right triangle of side 2.
#[test]
fn triangles_keep_their_half() {
    // polar form of x² + y² at pairs of corners
    let triangle = face("3\n2\n0 0 0\n1 0 0\n2 0 4\n0 1 0\n1 1 0\n0 2 4\n");
    for (u, v) in [(0.0, 0.0), (0.5, 0.5), (0.25, 0.125), (0.0, 1.0)] {
        let (x, y) = (2.0 * u, 2.0 * v);
        assert!((triangle.surface.jet(u, v).point - DVec3::new(x, y, x * x + y * y)).length() < 1e-15);
    }
    let [trim] = &triangle.loops[..] else { panic!("one loop") };
    assert_eq!((trim.signed_area(), trim.curves().len()), (1.0, 3));
}

#[test]
fn normals_are_read_over_and_counted() {
    let normals = "0 0 1\n0 0 1\n0 0 1\n";
    let text =
        format!("9 1 1\n0 0 0\n1 0 0\n0 1 0\n{normals}10 1 1 1 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n0 0 1\n{TROUGH}");
    let read = import(&text);
    assert_eq!(
        told(&read),
        ["t.bv:1: normals not used: a field of degree 1", "t.bv:8: normals not used: a field of degree 1"]
    );
    let degrees: Vec<_> = read.model.parts[0].faces.iter().map(|f| (f.id, f.surface.degrees())).collect();
    assert_eq!(degrees, [(1, (1, 1)), (2, (1, 1)), (3, (1, 2))]);
}

#[test]
fn groups_have_a_name_and_a_colour() {
    let tetrahedron = "1\n4 4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
    let read = import(&format!("group 1 first #3\n{tetrahedron}Group 10 second\n{TROUGH}group 1 first\n{TROUGH}"));
    assert!(read.warnings.is_empty(), "{:?}", told(&read));
    let parts: Vec<_> =
        read.model.parts.iter().map(|p| (p.name.as_str(), p.faces.len(), p.meshes.len(), p.closed)).collect();
    assert_eq!(parts, [("second", 1, 0, false), ("first", 1, 0, false), ("first", 0, 1, true)]);
    assert_eq!(read.model.parts[0].faces[0].colour, Some(PALETTE[2]));
    let mesh = &read.model.parts[2].meshes[0];
    assert_eq!((mesh.colour, mesh.triangles().len(), mesh.id), (Some(PALETTE[1]), 4, 1));
}

#[test]
fn damage_is_reported_with_its_line() {
    let told = |text: &str| told(&import(text)).join("\n");
    let rest = "the rest of the file left out";
    assert_eq!(told(&format!("{TROUGH}5 1")), format!("t.bv:9: {rest}: the file ends where a degree should stand"));
    assert_eq!(told(&TROUGH.replace("2 0 1\n2 2", "2 x 1\n2 2")), format!("t.bv:7: {rest}: x is not a number"));
    assert_eq!(told(&format!("{TROUGH}7\n1 2 3")), format!("t.bv:9: {rest}: 7 is no kind of patch"));
    assert_eq!(
        told(&format!("{TROUGH}5\n99999999999 2\n1 2 3")),
        format!("t.bv:11: {rest}: the file ends where a number should stand")
    );
    assert_eq!(
        told(&format!("{TROUGH}3\n{}\n1 2 3", u64::MAX)),
        format!("t.bv:11: {rest}: the file ends where a number should stand")
    );
    assert_eq!(told(&format!("{TROUGH}5\n-1 2\n")), format!("t.bv:10: {rest}: -1 is not a degree"));
    assert_eq!(told(&format!("4\n0\n0 0 0\n{TROUGH}")), "t.bv:1: face left out: degree 0 is not between 1 and 15");
    let high = format!("5\n16 1\n{}{TROUGH}", "0 0 0\n".repeat(34));
    assert_eq!(told(&high), "t.bv:1: face left out: degree 16 is not between 1 and 15");
    let nan = replaced(TROUGH, "-2 0 1", "-2 nan 1");
    assert!(told(&nan).starts_with("t.bv:1: face left out: control point 2 has a coordinate that is not finite"));
    let poly = |facet: &str| told(&format!("1\n4 2\n0 0 0\n1 0 0\n0 1 0\nnan 0 1\n3 0 1 2\n{facet}\n"));
    assert_eq!(poly("3 0 1 4"), "t.bv:8: polygon left out: vertex 4 of 4");
    assert_eq!(poly("3 0 1 3"), "t.bv:8: polygon left out: vertex 3 is not finite");
    assert_eq!(poly("2 0 1"), "t.bv:8: polygon left out: 2 corners");
    assert_eq!(poly("3 0 1 -1"), format!("t.bv:8: {rest}: -1 is not the number of a vertex"));
    assert_eq!(
        poly("4000000000 0 1"),
        format!("t.bv:9: {rest}: the file ends where the number of a vertex should stand")
    );
    for text in ["", "hello", "2 3 4", "group", "group 1 a", "\u{0}"] {
        let error = bv(text.as_bytes(), "t.bv").unwrap_err();
        assert_eq!(error.to_string(), "t.bv: holds nothing that is BezierView");
    }
}

#[test]
fn the_extension_and_the_first_word_tell_the_format() {
    let folder = std::env::temp_dir().join(format!("selvedge-bv-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let (by_name, by_word) = (folder.join("a.bv"), folder.join("b"));
    std::fs::write(&by_name, TROUGH).unwrap();
    std::fs::write(&by_word, format!("Group 0 all\n{TROUGH}")).unwrap();
    let read = [open(&by_name), open(&by_word)];
    std::fs::remove_dir_all(&folder).unwrap();
    assert!(read.into_iter().all(|r| r.unwrap().model.face_count() == 1));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn no_damage_panics(
        changes in prop::collection::vec((any::<usize>(), prop::sample::select(vec!["nan", "-1", "9", "10", "1", "1e400", "18446744073709551615", "group", ""])), 1..5),
    ) {
        let text = format!("group 1 a\n{TROUGH}1 4 1 0 0 0 1 0 0 1 1 0 0 1 0 4 0 1 2 3 9 1 1 0 0 0 1 0 0 0 1 0 0 0 1 0 0 1 0 0 1");
        let mut words: Vec<&str> = text.split_whitespace().collect();
        for (at, word) in changes {
            let at = at % words.len();
            words[at] = word;
        }
        if let Ok(read) = bv(words.join(" ").as_bytes(), "t.bv") {
            assert_sound(&read);
        }
    }

    #[test]
    fn no_bytes_panic(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        let _ = bv(&[b"group 1 a 3 ".as_slice(), &bytes].concat(), "t.bv");
    }
}
