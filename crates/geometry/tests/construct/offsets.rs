//! Offsets against closed forms and against the normal of the surface itself.

use crate::{EXACT, fractions, line, planar, points};
use glam::{DVec2, DVec3, DVec4};
use proptest::prelude::*;
use selvedge_geometry::construct::{ConstructError, extrude, lathe, offset};
use selvedge_geometry::spline::{BSpline, Control, Surface};
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, TAU};

/// A gentle hill over a square of side 4 or so, rational or not, its knots of any smoothness above C⁰.
fn hill() -> impl Strategy<Value = Surface> {
    let heights = prop::collection::vec((-0.15..0.15f64, 0.8..1.25f64), 25);
    (heights, any::<bool>(), any::<bool>()).prop_map(|(heights, rational, double)| {
        let point = |(i, (h, w)): (usize, &(f64, f64))| {
            let p = DVec3::new((i % 5) as f64, (i / 5) as f64, *h);
            DVec4::from_point(p, if rational { *w } else { 1.0 })
        };
        let knots = vec![0.0, 0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0, 1.0];
        let quadratic = if double {
            vec![0.0, 0.0, 0.0, 0.3, 0.3, 1.0, 1.0, 1.0]
        } else {
            vec![0.0, 0.0, 0.0, 0.3, 0.6, 1.0, 1.0, 1.0]
        };
        let net: Vec<DVec4> = heights.iter().enumerate().map(point).collect();
        // a double knot of degree 2 is an edge: degree 3 there is C¹
        if double {
            let knots_v = vec![0.0, 0.0, 0.0, 0.0, 0.4, 1.0, 1.0, 1.0, 1.0];
            return Surface::new((3, 3), knots, knots_v, net).unwrap();
        }
        Surface::new((3, 2), knots, quadratic, net).unwrap()
    })
}

proptest! {
    #[test]
    fn an_offset_keeps_its_tolerance(s in hill(), distance in -0.8..0.8f64, digits in 2.0..5.0f64) {
        let tolerance = 10f64.powf(-digits);
        let built = offset(&s, distance, tolerance);
        let grid = s.patches();
        // the offset runs along the surface times (1 - d k1) (1 - d k2), and backwards beyond a centre of curvature
        let backwards = |u: f64, v: f64, margin: f64| {
            let jet = s.jet2(u, v);
            let n = jet.du.cross(jet.dv).normalize();
            // d times the shape operator, by the first and second fundamental form; its larger eigenvalue
            let first = [jet.du.dot(jet.du), jet.du.dot(jet.dv), jet.dv.dot(jet.dv)];
            let second = [jet.duu.dot(n), jet.duv.dot(n), jet.dvv.dot(n)].map(|x| x * distance);
            let det = first[0] * first[2] - first[1] * first[1];
            let trace = (second[0] * first[2] - 2.0 * second[1] * first[1] + second[2] * first[0]) / det;
            let gauss = (second[0] * second[2] - second[1] * second[1]) / det;
            0.5 * trace + (0.25 * trace * trace - gauss).max(0.0).sqrt() >= margin
        };
        if let Err(ConstructError::FoldsAt { u, v, .. }) = built {
            prop_assert!(backwards(u, v, 1.0 - 1e-9), "refused at ({u}, {v})");
            return Ok(());
        }
        for (u, v) in fractions(31).flat_map(|u| fractions(29).map(move |v| (u, v))) {
            prop_assert!(!backwards(u, v, 1.02), "made, though it folds at ({u}, {v})");
        }
        let built = built.unwrap();
        prop_assert!(built.deviation <= tolerance);
        let made = built.surface.patches();
        for u in fractions(53) {
            for v in fractions(47) {
                let jet = grid.jet(u, v);
                let expected = jet.point + jet.du.cross(jet.dv).normalize() * distance;
                let off = made.point(u, v).distance(expected);
                prop_assert!(off <= built.deviation + EXACT, "{off:e} of {:e} at ({u}, {v})", built.deviation);
            }
        }
    }
}

/// A half circle from the south pole to the north one.
fn half_circle(r: f64) -> BSpline<DVec3> {
    let h = FRAC_1_SQRT_2;
    let points = [(0.0, -1.0, 1.0), (1.0, -1.0, h), (1.0, 0.0, 1.0), (1.0, 1.0, h), (0.0, 1.0, 1.0)];
    let points = points.iter().map(|&(x, y, w)| DVec3::from_point(DVec2::new(x, y) * r, w));
    BSpline::new(2, vec![0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 2.0], points.collect()).unwrap()
}

#[test]
fn a_sphere_becomes_a_sphere_up_to_its_poles() {
    let sphere = lathe(&half_circle(2.0), TAU).unwrap();
    for distance in [0.5, -1.5] {
        let built = offset(&sphere, distance, 1e-6).unwrap();
        let s = points(&built.surface);
        for u in fractions(61) {
            for v in fractions(53) {
                let off = (s(u, v).length() - 2.0 - distance).abs();
                assert!(off <= built.deviation + EXACT, "{off:e} of {:e}", built.deviation);
            }
            assert!(s(u, 0.0).distance(DVec3::NEG_Z * (2.0 + distance)) <= 1e-9, "the pole");
        }
        assert!(built.deviation <= 1e-6);
    }
    let Err(ConstructError::FoldsAt { reach, radius, .. }) = offset(&sphere, -2.5, 1e-3) else { panic!("it folds") };
    assert!(reach == 2.5 && (radius - 2.0).abs() < 1e-9);
}

#[test]
fn a_plane_is_moved_exactly() {
    let s = extrude(&line(&[DVec3::ZERO, DVec3::X]), DVec3::Y * 2.0).unwrap();
    let built = offset(&s, 0.25, 1e-6).unwrap();
    assert_eq!(built.deviation, 0.0);
    assert!(points(&built.surface)(0.5, 0.5).distance(DVec3::new(0.5, 1.0, 0.25)) <= EXACT);
}

#[test]
fn what_cannot_be_offset() {
    let roof = extrude(&line(&[DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0), DVec3::X * 2.0]), DVec3::Z).unwrap();
    assert_eq!(offset(&roof, 0.1, 1e-3), Err(ConstructError::Corner { what: "the surface", parameter: 1.0 }));
    let tube = lathe(&planar(&[(1.0, 0.0), (1.0, 1.0)]), FRAC_PI_2).unwrap();
    assert!(matches!(offset(&tube, f64::NAN, 1e-3), Err(ConstructError::NotFinite { .. })));
    assert!(matches!(offset(&tube, 0.1, -1.0), Err(ConstructError::Range { .. })));
    assert!(matches!(offset(&tube, 0.1, 1e-30), Err(ConstructError::Bound { .. })));
}
