//! Extrusion, lathe and ruled surfaces against their closed forms.

use crate::{EXACT, at, curve, fractions, planar, points};
use glam::{DVec2, DVec3};
use proptest::prelude::*;
use selvedge_geometry::construct::{compatible, extrude, lathe, ruled};
use selvedge_geometry::spline::{BSpline, Control};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

proptest! {
    #[test]
    fn compatible_curves_are_the_same_curves(a in curve(5, 0.3..3.0), b in curve(4, 0.3..3.0), c in curve(1, 0.3..3.0)) {
        let all = [a, b, c];
        let same = compatible(&all).unwrap();
        prop_assert!(same.iter().all(|s| s.knots() == same[0].knots() && s.degree() == same[0].degree()));
        for (before, after) in all.iter().zip(&same) {
            for f in fractions(50) {
                prop_assert!(at(before, f).distance(at(after, f)) <= EXACT);
            }
        }
    }

    #[test]
    fn an_extrusion_is_the_curve_moved(c in curve(5, 0.3..3.0), d in prop::array::uniform3(-2.0..2.0f64)) {
        let d = DVec3::from(d);
        prop_assume!(d.length() > 0.1 && !(c.points().len() == 2 && c.points()[0] == c.points()[1]));
        let s = points(&extrude(&c, d).unwrap());
        for u in fractions(20) {
            for v in fractions(4) {
                prop_assert!(s(u, v).distance(at(&c, u) + d * v) <= EXACT);
            }
        }
    }

    #[test]
    fn ruled_surfaces_hold_both_curves_and_straight_lines(a in curve(4, 0.3..3.0), b in curve(3, 0.3..3.0)) {
        let s = points(&ruled(&a, &b).unwrap());
        for u in fractions(20) {
            let (p, q) = (at(&a, u), at(&b, u));
            prop_assert!(s(u, 0.0).distance(p) <= EXACT && s(u, 1.0).distance(q) <= EXACT);
            for v in fractions(4) {
                let x = s(u, v);
                prop_assert!((x.distance(p) + x.distance(q) - p.distance(q)).abs() <= EXACT, "on the line, between");
            }
        }
    }

    /// Radius and height of every point are the profile's, and angles run evenly at the ends of the pieces.
    #[test]
    fn a_lathe_keeps_radius_and_height(c in curve(4, 0.3..3.0), angle in 0.01..TAU, reach in 0.0..2.0f64) {
        let flat = c.points().iter().map(|p| DVec3::new(p.x + (1.0 + reach) * p.w, p.y, p.w));
        let profile = BSpline::new(c.degree(), c.knots().to_vec(), flat.collect()).unwrap();
        let surface = lathe(&profile, angle).unwrap();
        prop_assert_eq!(surface.domain().0, (0.0, angle));
        let s = points(&surface);
        let (a, b) = profile.domain();
        for v in fractions(20) {
            let p = profile.point(if v == 1.0 { b } else { a + (b - a) * v });
            for u in fractions(30) {
                let x = s(u, v);
                prop_assert!((x.truncate().length() - p.x).abs() <= 4.0 * EXACT && (x.z - p.y).abs() <= 4.0 * EXACT);
            }
            let end = s(1.0, v).truncate();
            prop_assert!(end.distance(DVec2::from_angle(angle) * p.x) <= 4.0 * EXACT);
        }
    }
}

/// A quarter arc of radius `r` about `(x, 0)`, from angle `from`, as a planar curve.
fn arc(x: f64, r: f64, from: f64, pieces: usize) -> BSpline<DVec3> {
    let h = std::f64::consts::FRAC_1_SQRT_2;
    let point = |i: usize| {
        let angle = DVec2::from_angle(from + i as f64 * FRAC_PI_2 / 2.0);
        let (length, w) = if i.is_multiple_of(2) { (r, 1.0) } else { (r / h, h) };
        DVec3::from_point(DVec2::new(x, 0.0) + angle * length, w)
    };
    let knots = [0].into_iter().chain((0..=pieces).flat_map(|k| [k, k])).chain([pieces]).map(|k| k as f64).collect();
    BSpline::new(2, knots, (0..=2 * pieces).map(point).collect()).unwrap()
}

#[test]
fn a_half_circle_makes_a_sphere_with_two_poles() {
    let sphere = lathe(&arc(0.0, 2.0, -FRAC_PI_2, 2), TAU).unwrap();
    let s = points(&sphere);
    for u in fractions(40) {
        for v in fractions(40) {
            assert!((s(u, v).length() - 2.0).abs() <= 2.0 * EXACT);
        }
        assert!(s(u, 0.0) == s(0.0, 0.0) && s(u, 1.0) == s(0.0, 1.0), "the poles are points, bit for bit");
        assert_eq!(s(0.0, u), s(1.0, u), "the seam closes bit for bit");
    }
    assert!(s(0.0, 0.0).distance(DVec3::new(0.0, 0.0, -2.0)) <= EXACT);
}

#[test]
fn a_circle_makes_a_torus() {
    let s = points(&lathe(&arc(3.0, 1.0, 0.0, 4), TAU).unwrap());
    for u in fractions(40) {
        for v in fractions(40) {
            let p = s(u, v);
            let off = DVec2::new(p.truncate().length() - 3.0, p.z).length() - 1.0;
            assert!(off.abs() <= 4.0 * EXACT);
        }
    }
}

#[test]
fn a_cone_over_part_of_a_turn() {
    let surface = lathe(&planar(&[(0.0, 1.0), (2.0, 0.0)]), PI).unwrap();
    let s = points(&surface);
    assert_eq!(surface.counts(), (5, 2));
    for u in fractions(20) {
        let p = s(u, 0.5);
        assert!((p.truncate().length() - 1.0).abs() <= EXACT && (p.z - 0.5).abs() <= EXACT && p.y >= -EXACT);
    }
    assert!(s(1.0, 1.0).distance(DVec3::new(-2.0, 0.0, 0.0)) <= EXACT);
    // the half plane opposite turns as well
    let other = points(&lathe(&planar(&[(0.0, 1.0), (-2.0, 0.0)]), PI).unwrap());
    assert!(other(0.0, 1.0).distance(DVec3::new(-2.0, 0.0, 0.0)) <= EXACT);
}
