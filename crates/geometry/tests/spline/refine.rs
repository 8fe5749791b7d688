//! More knots and higher degrees change nothing.

use crate::{gap, spline};
use glam::{DAffine3, DQuat, DVec3, DVec4};
use proptest::prelude::*;
use selvedge_geometry::spline::{BSpline, Control, Surface};

/// Of homogeneous coordinates up to 10: a few hundred ulp after repeated averaging.
const CLOSE: f64 = 1e-12;

/// Both curves at 40 equal parameters, by de Boor's algorithm.
fn same(a: &BSpline<DVec4>, b: &BSpline<DVec4>) -> Result<(), TestCaseError> {
    prop_assert_eq!(a.domain(), b.domain());
    let (lo, hi) = a.domain();
    for i in 0..=40 {
        let t = lo + (hi - lo) * f64::from(i) / 40.0;
        let off = gap(a.homogeneous(t), b.homogeneous(t));
        prop_assert!(off <= CLOSE, "{off:e} at {t}");
    }
    Ok(())
}

fn multiplicity(c: &BSpline<DVec4>, x: f64) -> usize {
    c.knots().iter().filter(|k| **k == x).count()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn knots_are_inserted_exactly(c in spline(7), new in prop::collection::vec(0.0..1.0f64, 0..8)) {
        let (lo, hi) = c.domain();
        let mut new: Vec<f64> = new.iter().map(|x| lo + (hi - lo) * x).collect();
        new.extend(c.knots()); // up to full multiplicity, never beyond
        let fine = c.with_knots(&new);
        same(&c, &fine)?;
        BSpline::new(fine.degree(), fine.knots().to_vec(), fine.points().to_vec()).unwrap();
        for x in new.iter().filter(|x| **x > lo && **x < hi) {
            prop_assert!(multiplicity(&fine, *x) >= 1 && multiplicity(&fine, *x) <= fine.degree());
        }
    }

    #[test]
    fn clamping_changes_nothing(c in spline(7)) {
        let clamped = c.clamped();
        same(&c, &clamped)?;
        let (lo, hi) = c.domain();
        prop_assert_eq!(multiplicity(&clamped, lo), c.degree() + 1);
        prop_assert_eq!(multiplicity(&clamped, hi), c.degree() + 1);
        prop_assert!(gap(clamped.points()[0], c.homogeneous(lo)) <= CLOSE);
        BSpline::new(clamped.degree(), clamped.knots().to_vec(), clamped.points().to_vec()).unwrap();
    }

    #[test]
    fn elevation_changes_nothing_but_the_degree(c in spline(6), up in 1..4usize) {
        let high = c.elevated_to(c.degree() + up).unwrap();
        prop_assert_eq!(high.degree(), c.degree() + up);
        same(&c, &high)?;
        BSpline::new(high.degree(), high.knots().to_vec(), high.points().to_vec()).unwrap();
        // the continuity stays: every interior knot gains as many copies as the degree
        let (lo, hi) = c.domain();
        for k in c.knots().iter().filter(|k| **k > lo && **k < hi) {
            prop_assert_eq!(multiplicity(&high, *k), multiplicity(&c, *k) + up);
        }
    }

    #[test]
    fn another_domain(c in spline(5), a in -3.0..3.0f64, length in 0.1..9.0f64) {
        let moved = c.over(a, a + length).unwrap();
        let (lo, hi) = c.domain();
        prop_assert_eq!(moved.domain(), (a, a + length));
        for i in 0..=10 {
            let f = f64::from(i) / 10.0;
            // a parameter's rounding times a steep curve's slope
            prop_assert!(gap(moved.homogeneous(a + length * f), c.homogeneous(lo + (hi - lo) * f)) <= 1e-10);
        }
    }
}

#[test]
fn nothing_beyond_the_largest_degree() {
    let line = BSpline::new(1, vec![0.0, 0.0, 1.0, 1.0], vec![DVec4::W, DVec4::ONE]).unwrap();
    assert!(line.elevated_to(15).is_ok());
    assert!(line.elevated_to(16).is_err());
    assert!(line.over(1.0, 1.0).is_err());
    assert!(line.over(f64::NAN, 1.0).is_err());
}

#[test]
fn surfaces_follow_their_rows() {
    let net =
        (0..6).map(|i| DVec4::from_point(DVec3::new(f64::from(i), f64::from(i * i % 5), 1.0), 1.0 + f64::from(i)));
    let s = Surface::new((1, 2), vec![0.0, 0.0, 1.0, 1.0], vec![0.0, 0.0, 0.0, 2.0, 2.0, 2.0], net.collect()).unwrap();
    assert_eq!(s.transposed().transposed(), s);
    let turn = DAffine3::from_rotation_translation(DQuat::from_rotation_x(0.3), DVec3::new(1.0, 2.0, 3.0));
    let fine = s.refined_u(3, &[0.25, 0.5]).unwrap();
    assert_eq!(fine.counts(), (6, 3));
    for (u, v) in [(0.0, 0.0), (0.3, 1.2), (1.0, 2.0), (0.7, 0.1)] {
        let p = s.jet(u, v).point;
        assert!(s.transposed().jet(v, u).point.distance(p) <= CLOSE);
        assert!(fine.jet(u, v).point.distance(p) <= CLOSE);
        assert!(s.transformed(&turn).jet(u, v).point.distance(turn.transform_point3(p)) <= CLOSE);
    }
}
