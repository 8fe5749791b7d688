//! Invariants: de Morgan's laws, repetition, rigid motion.

use super::shapes::*;
use crate::model::{Primitive, Shape};
use glam::{DAffine3, DQuat, DVec3};

/// Solids with coincident faces of every kind.
fn four() -> Vec<Primitive> {
    vec![
        block([-1.0, -1.0, -1.0], [1.0; 3]),
        cylinder(1.0, -1.0, 2.0),
        sphere(1.2, 0.5),
        placed(Shape::Torus { major: 1.0, minor: 0.5 }, at(0.0, 0.0, 0.5)),
    ]
}

/// Every pair is one solid, bit for bit, on lines through coincident faces.
#[test]
fn equal_expressions_are_equal_solids() {
    for (left, right) in [
        ("!(A+B)", "!A!B"),
        ("A-(B+C)", "(A-B)-C"),
        ("A-(A-B)", "AB"),
        ("A^B", "(A-B)+(B-A)"),
        ("(A+B)(C+D)", "AC+AD+BC+BD"),
        ("A+B+C+D", "D+C+B+A"),
        ("A-B+AB", "A"),
        ("(A^B)^B", "A"),
    ] {
        // the same surfaces for both: every primitive comes first, in one order
        let both = |text: &str| tracer(&format!("(A+B+C+D)-(A+B+C+D)+({text})"), four());
        let (l, r) = (both(left), both(right));
        for (o, d) in lines(9, 200, 2.0) {
            let (l, r) = (l.trace(o, d), r.trace(o, d));
            assert_eq!((l.inside_before, stops(&l)), (r.inside_before, stops(&r)), "{left} = {right}");
        }
    }
}

#[test]
fn traces_repeat() {
    let t = tracer("A-B+CD", four());
    for (o, d) in lines(10, 200, 2.0) {
        assert_eq!(t.trace(o, d), t.trace(o, d));
    }
}

/// Points between boundaries are inside where the primitives' values make them.
#[test]
fn membership_between_faces() {
    let inside = |p: DVec3| {
        let (r, x) = (p.x.hypot(p.y), p.abs());
        let a = x.max_element() < 1.0;
        let b = r < 1.0 && x.z < 1.0;
        let c = (p - DVec3::X * 0.5).length() < 1.2;
        let d = (r - 1.0).hypot(p.z - 0.5) < 0.5;
        (a && !b) || (c && d)
    };
    let t = tracer("(A-B)+CD", four());
    let mut changes = 0;
    for (o, d) in lines(11, 500, 2.0) {
        let trace = t.trace(o, d);
        changes += trace.boundaries.len();
        for k in 0..100 {
            let s = (f64::from(k) + 0.5) / 50.0;
            // not within rounding of a face
            if trace.boundaries.iter().all(|b| (b.t - s).abs() > 1e-9) {
                assert_eq!(trace.inside(s), inside(o + d * s), "{o} {d} {s}");
            }
        }
    }
    assert!(changes > 500, "only {changes} faces met");
}

#[test]
fn rigid_motions_move_the_solid() {
    let motion = DAffine3::from_rotation_translation(
        DQuat::from_euler(glam::EulerRot::XYZ, 0.4, 1.0, -2.0),
        DVec3::new(3.0, -70.0, 11.0),
    );
    let moved = four().into_iter().map(|p| Primitive { transform: motion * p.transform, ..p }).collect();
    let (still, moved) = (tracer("A-B+CD", four()), tracer("A-B+CD", moved));
    let mut equal = 0;
    for (o, d) in lines(12, 300, 2.0) {
        let (a, b) = (still.trace(o, d), moved.trace(motion.transform_point3(o), motion.transform_vector3(d)));
        assert_eq!(a.boundaries.len(), b.boundaries.len(), "{o} {d}");
        for (a, b) in a.boundaries.iter().zip(&b.boundaries) {
            // rounding of coordinates near 70 over the cosine at the face
            let cosine = a.normal.dot(d.normalize()).abs();
            assert!((a.t - b.t).abs() * cosine < 1e-12, "{} {}", a.t, b.t);
            equal += u32::from(a.primitive == b.primitive);
        }
    }
    assert!(equal > 300);
}
