//! Bézier and B-spline curves.

use crate::{control, gap, knots, spline};
use glam::{DVec2, DVec3, DVec4};
use proptest::prelude::*;
use selvedge_geometry::spline::{BSpline, Bezier, Control, MAX_DEGREE, binomial};

/// Rounding of a value in a unit box: a few ulp per level of the triangle, weights up to 10.
const CLOSE: f64 = 1e-13;

fn bezier(max: usize) -> impl Strategy<Value = Bezier<DVec4>> {
    prop::collection::vec(control(), 2..=max + 1).prop_map(|points| Bezier { points })
}

/// de Casteljau's triangle, written independently of the library's Horner scheme.
fn casteljau(points: &[DVec4], t: f64) -> DVec4 {
    match points {
        [only] => *only,
        _ => casteljau(&points.windows(2).map(|w| w[0].lerp(w[1], t)).collect::<Vec<_>>(), t),
    }
}

#[test]
fn binomials() {
    for n in 0..=50usize {
        assert_eq!((0..=n).map(|k| binomial(n, k)).sum::<f64>(), 2f64.powi(n as i32), "row {n}");
        for k in 1..n {
            assert_eq!(binomial(n, k), binomial(n - 1, k - 1) + binomial(n - 1, k), "{n} over {k}");
        }
    }
}

#[test]
fn a_quarter_circle_is_exact() {
    let weighted = [(1.0, 0.0, 1.0), (1.0, 1.0, std::f64::consts::FRAC_1_SQRT_2), (0.0, 1.0, 1.0)];
    let arc = Bezier { points: weighted.iter().map(|&(x, y, w)| DVec3::from_point(DVec2::new(x, y), w)).collect() };
    for i in 0..=1000 {
        let t = f64::from(i) / 1000.0;
        assert!((arc.point(t).length() - 1.0).abs() <= 1e-15, "radius at {t}");
        assert!((arc.elevated().elevated().point(t).length() - 1.0).abs() <= 1e-15, "elevated, at {t}");
    }
}

#[test]
fn a_whole_circle_as_one_quadratic_spline() {
    let h = std::f64::consts::FRAC_1_SQRT_2;
    let ring = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)];
    let points = ring.iter().enumerate().map(|(i, &(x, y))| {
        DVec3::from_point(DVec2::new(f64::from(x), f64::from(y)), if i % 2 == 0 { 1.0 } else { h })
    });
    let knots = vec![0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0, 4.0];
    let circle = BSpline::new(2, knots, points.collect()).unwrap();
    assert!(!circle.is_polynomial());
    for i in 0..=4000 {
        let t = f64::from(i) / 1000.0;
        assert!((circle.point(t).length() - 1.0).abs() <= 1e-15, "radius at {t}");
    }
    assert_eq!(circle.beziers().len(), 4);
}

#[test]
fn multiplicity_of_the_degree_interpolates() {
    let points: Vec<DVec3> = (0..7).map(|i| DVec3::new(f64::from(i), f64::from(i * i % 5), 1.0)).collect();
    let knots = vec![0.0, 0.0, 0.0, 0.0, 0.3, 0.3, 0.3, 1.0, 1.0, 1.0, 1.0];
    let curve = BSpline::new(3, knots, points.clone()).unwrap();
    assert_eq!(curve.homogeneous(0.3), points[3]);
    let pieces = curve.beziers();
    assert_eq!(
        (pieces.len(), &pieces[0].piece.points[..], &pieces[1].piece.points[..]),
        (2, &points[..4], &points[3..])
    );
}

#[test]
fn an_unclamped_uniform_cubic() {
    // the midpoint rule of uniform cubics: value at a knot = (p0 + 4 p1 + p2) / 6
    let points: Vec<DVec3> = [1.0, 5.0, 2.0, 7.0, 3.0].iter().map(|&x| DVec3::new(x, -x, 1.0)).collect();
    let curve = BSpline::new(3, (0..9).map(f64::from).collect(), points).unwrap();
    assert_eq!(curve.domain(), (3.0, 5.0));
    for (t, x) in [(3.0, (1.0 + 20.0 + 2.0) / 6.0), (4.0, (5.0 + 8.0 + 7.0) / 6.0), (5.0, (2.0 + 28.0 + 3.0) / 6.0)] {
        assert!((curve.point(t).x - x).abs() < 1e-15, "at {t}");
    }
    assert_eq!((curve.point(2.0), curve.point(9.0)), (curve.point(3.0), curve.point(5.0)));
}

#[test]
fn a_knot_span_of_a_billionth() {
    let points = [0.0, 1.0, -1.0, 2.0, 0.0].map(|y| DVec3::new(y * 0.5, y, 1.0)).to_vec();
    let curve = BSpline::new(2, vec![0.0, 0.0, 0.0, 0.5, 0.5 + 1e-9, 1.0, 1.0, 1.0], points).unwrap();
    let pieces = curve.beziers();
    assert_eq!(pieces.len(), 3);
    for s in &pieces {
        for x in [0.0, 0.25, 0.5, 1.0] {
            let t = s.start + (s.end - s.start) * x;
            assert!(gap(s.piece.homogeneous(x), curve.homogeneous(t)) < 1e-6, "at {t}"); // 1e-16 / 1e-9 of the span
        }
    }
    assert_eq!(pieces[0].piece.points[2], pieces[1].piece.points[0]);
    assert_eq!(pieces[1].piece.points[2], pieces[2].piece.points[0]);
}

proptest! {
    #[test]
    fn bernstein_polynomials_sum_to_one(degree in 1..=MAX_DEGREE, t in 0f64..=1.0) {
        let ones = Bezier { points: vec![DVec4::ONE; degree + 1] };
        prop_assert!(gap(ones.homogeneous(t), DVec4::ONE) < 1e-14);
        prop_assert!(ones.jet(t).1.max_abs() < 1e-12);
    }

    #[test]
    fn basis_functions_sum_to_one_and_stay_positive(
        (degree, knots) in (1..=MAX_DEGREE).prop_flat_map(|d| (Just(d), knots(d))),
        x in 0f64..=1.0,
    ) {
        let count = knots.len() - degree - 1;
        let basis = |which: usize| {
            // one control point raised in the first coordinate; weights one
            let points = (0..count).map(|i| DVec3::new(f64::from(u8::from(i == which)), 0.0, 1.0)).collect();
            let curve = BSpline::new(degree, knots.clone(), points).expect("valid by construction");
            let (a, b) = curve.domain();
            curve.homogeneous(a + (b - a) * x)
        };
        let values: Vec<DVec3> = (0..count).map(basis).collect();
        prop_assert!((values.iter().map(|p| p.x).sum::<f64>() - 1.0).abs() < 1e-13);
        prop_assert!(values.iter().all(|p| p.x >= 0.0 && (p.z - 1.0).abs() < 1e-13));
        prop_assert!(values.iter().filter(|p| p.x > 0.0).count() <= degree + 1);
    }

    #[test]
    fn horner_is_de_casteljau(curve in bezier(MAX_DEGREE), t in 0f64..=1.0) {
        prop_assert!(gap(curve.homogeneous(t), casteljau(&curve.points, t)) < CLOSE);
    }

    #[test]
    fn ends_are_met_bit_for_bit(curve in bezier(MAX_DEGREE), clamped in spline(MAX_DEGREE)) {
        let n = curve.degree();
        prop_assert_eq!((curve.homogeneous(0.0), curve.homogeneous(1.0)), (curve.points[0], curve.points[n]));
        let (degree, k) = (clamped.degree(), clamped.knots());
        let (a, b) = clamped.domain();
        if k[0] == a && k[k.len() - 1] == b {
            let (first, last) = (clamped.points()[0], clamped.points()[clamped.points().len() - 1]);
            prop_assert_eq!((clamped.homogeneous(a), clamped.homogeneous(b)), (first, last));
            let pieces = clamped.beziers();
            prop_assert_eq!(pieces[0].piece.points[0], first);
            prop_assert_eq!(pieces[pieces.len() - 1].piece.points[degree], last);
        }
    }

    #[test]
    fn de_boor_is_the_bezier_pieces(curve in spline(9), x in prop::collection::vec(0f64..=1.0, 8)) {
        let pieces = curve.beziers();
        let (a, b) = curve.domain();
        prop_assert_eq!((pieces[0].start, pieces[pieces.len() - 1].end), (a, b));
        for w in pieces.windows(2) {
            prop_assert_eq!(w[0].end, w[1].start);
            prop_assert_eq!(w[0].piece.points[curve.degree()], w[1].piece.points[0]);
        }
        for s in &pieces {
            for &x in &x {
                let t = s.start + (s.end - s.start) * x;
                // knots 0.05 apart next to spans of 1: the triangles amplify rounding by the ratio of spans
                prop_assert!(gap(s.piece.homogeneous(x), curve.homogeneous(t)) < 1e-9);
            }
        }
    }

    #[test]
    fn halves_and_segments_are_the_curve(curve in bezier(MAX_DEGREE), a in 0f64..0.9, len in 0.05f64..1.0, x in 0f64..=1.0) {
        let b = (a + len).min(1.0);
        let (left, right) = curve.split(a);
        prop_assert_eq!(left.points[curve.degree()], right.points[0]);
        prop_assert_eq!((left.points[0], right.points[curve.degree()]), (curve.points[0], curve.points[curve.degree()]));
        prop_assert!(gap(left.homogeneous(x), curve.homogeneous(a * x)) < CLOSE);
        prop_assert!(gap(right.homogeneous(x), curve.homogeneous(a + (1.0 - a) * x)) < CLOSE);
        let part = curve.segment(a, b);
        prop_assert!(gap(part.homogeneous(x), curve.homogeneous(a + (b - a) * x)) < CLOSE);
        prop_assert_eq!(curve.segment(0.0, 1.0), curve);
    }

    #[test]
    fn a_segment_ending_at_one_may_start_anywhere(curve in bezier(5), x in 0f64..=1.0) {
        // the second branch of `segment`: a at the end, b beyond it
        let part = curve.segment(1.0, 1.5);
        let beyond = casteljau(&curve.points, 1.0 + 0.5 * x);
        prop_assert!(gap(part.homogeneous(x), beyond) < 1e-10);
    }

    #[test]
    fn parts_of_a_spline(curve in spline(5), x in 0f64..0.8, len in 0.1f64..1.0, y in 0f64..=1.0) {
        let (a, b) = curve.domain();
        let (lo, hi) = (a + (b - a) * x, (a + (b - a) * (x + len)).min(b));
        let parts = curve.beziers_between(lo, hi);
        prop_assert_eq!((parts[0].start, parts[parts.len() - 1].end), (lo, hi));
        for s in parts {
            let t = s.start + (s.end - s.start) * y;
            // a span may be cut to a sliver: its parameter is then known to 1e-16 over its length
            prop_assert!(gap(s.piece.homogeneous(y), curve.homogeneous(t)) < 1e-9);
        }
    }

    #[test]
    fn derivative_is_the_central_difference(curve in bezier(9), t in 0.01f64..0.99) {
        let h = 1e-5;
        let slope = (curve.homogeneous(t + h) - curve.homogeneous(t - h)) * (0.5 / h);
        let (value, exact) = curve.jet(t);
        prop_assert!(gap(value, curve.homogeneous(t)) < CLOSE);
        // h² p''' / 6 with |p'''| <= 9·8·7 · 8 · 10, and 1e-15 · 10 / h of rounding
        prop_assert!(gap(exact, slope) < 1e-6 + 1e-8);
    }

    #[test]
    fn elevation_changes_nothing(curve in bezier(9), t in 0f64..=1.0) {
        let raised = curve.elevated();
        prop_assert_eq!(raised.degree(), curve.degree() + 1);
        prop_assert_eq!((raised.points[0], raised.points[raised.degree()]), (curve.points[0], curve.points[curve.degree()]));
        prop_assert!(gap(raised.homogeneous(t), curve.homogeneous(t)) < CLOSE);
    }

    #[test]
    fn reversal_keeps_the_domain_and_the_points(curve in spline(7), x in 0f64..=1.0) {
        let (a, b) = curve.domain();
        let back = curve.reversed();
        prop_assert_eq!(back.domain(), (a, b));
        prop_assert!(BSpline::new(back.degree(), back.knots().to_vec(), back.points().to_vec()).is_ok());
        let t = a + (b - a) * x;
        prop_assert!(gap(back.homogeneous(a + (b - t)), curve.homogeneous(t)) < 1e-9);
        let piece = &curve.beziers()[0].piece;
        prop_assert!(gap(piece.clone().reversed().homogeneous(1.0 - x), piece.homogeneous(x)) < CLOSE);
    }

    #[test]
    fn one_bezier_as_a_spline(curve in bezier(MAX_DEGREE), x in 0f64..=1.0) {
        let spline = BSpline::from_bezier(curve.clone(), -2.0, 2.0).unwrap();
        prop_assert!(gap(spline.homogeneous(4.0 * x - 2.0), curve.homogeneous(x)) < CLOSE);
        prop_assert_eq!(&spline.beziers()[0].piece, &curve);
    }
}
