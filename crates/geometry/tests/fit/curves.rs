//! Exact conics, chains and interpolating curves against their equations.

use glam::{DVec3, DVec4};
use proptest::prelude::*;
use selvedge_geometry::construct::ConstructError;
use selvedge_geometry::construct::curve::{
    CurveEnds, Parameters, chain, circle, ellipse, hyperbola, interpolate, line, parabola,
};
use selvedge_geometry::spline::{BSpline, Control};
use std::f64::consts::TAU;

fn samples(curve: &BSpline<DVec4>, n: usize) -> Vec<(f64, DVec3)> {
    let (a, b) = curve.domain();
    (0..=n).map(|i| a + (b - a) * (i as f64 / n as f64)).map(|t| (t, curve.point(t))).collect()
}

fn vector() -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(-1.0f64..1.0).prop_map(DVec3::from_array)
}

proptest! {
    #[test]
    fn circles_are_circles(centre in vector(), axis in vector(), start in vector(), log in -6.0f64..6.0, angle in 0.01f64..20.0) {
        prop_assume!(axis.length() > 0.1 && axis.cross(start).length() > 0.1);
        let radius = 10f64.powf(log);
        let centre = centre * radius;
        let c = circle(centre, axis, start, radius, angle).unwrap();
        let z = axis.normalize();
        for (_, q) in samples(&c, 200) {
            prop_assert!(((q - centre).length() - radius).abs() <= 1e-14 * 4.0 * radius);
            prop_assert!((q - centre).dot(z).abs() <= 4e-15 * radius);
        }
        // ends: the start, and the start turned by the angle
        let x = (start - z * start.dot(z)).normalize();
        let end = centre + (x * angle.cos() + z.cross(x) * angle.sin()) * radius;
        prop_assert!(c.point(0.0).distance(centre + x * radius) <= 1e-14 * radius);
        prop_assert!(c.point(angle).distance(end) <= 1e-13 * radius);
        prop_assert!(c.domain() == (0.0, angle));
    }

    #[test]
    fn ellipses_satisfy_their_equation(x in vector(), y in vector(), from in -10.0f64..10.0, sweep in 0.01f64..15.0) {
        prop_assume!(x.cross(y).length() > 0.05);
        let c = ellipse(DVec3::ONE, x, y, from, from + sweep).unwrap();
        let area = x.cross(y).length_squared();
        let mut last = from;
        for (i, (_, q)) in samples(&c, 100).into_iter().enumerate() {
            // coordinates along x and y by Cramer's rule in their plane
            let d = q - DVec3::ONE;
            let (a, b) = (d.cross(y).dot(x.cross(y)) / area, x.cross(d).dot(x.cross(y)) / area);
            prop_assert!((a.hypot(b) - 1.0).abs() < 1e-12, "{} {}", a, b);
            // and it runs from `from` on, forwards
            let angle = b.atan2(a);
            let step = (angle - last + 0.5).rem_euclid(TAU) - 0.5;
            prop_assert!(step > -1e-9 && step < 0.5, "step {} at {}", step, i);
            last += step;
        }
        prop_assert!((last - from - sweep).abs() < 1e-9);
    }

    #[test]
    fn parabolas_and_hyperbolas_satisfy_theirs(x in vector(), y in vector(), from in -4.0f64..4.0, sweep in 0.01f64..6.0) {
        prop_assume!(x.cross(y).length() > 0.05);
        let area = x.cross(y).length_squared();
        let along = |d: DVec3| (d.cross(y).dot(x.cross(y)) / area, x.cross(d).dot(x.cross(y)) / area);
        let p = parabola(DVec3::X, x, y, from, from + sweep).unwrap();
        for (t, q) in samples(&p, 50) {
            let (a, b) = along(q - DVec3::X);
            prop_assert!((b - t).abs() < 1e-11 && (a - t * t).abs() < 1e-10);
        }
        let h = hyperbola(DVec3::X, x, y, from, from + sweep).unwrap();
        let size = from.abs().max((from + sweep).abs()).cosh();
        let mut last = f64::NEG_INFINITY;
        for (_, q) in samples(&h, 50) {
            let (a, b) = along(q - DVec3::X);
            prop_assert!((a * a - b * b - 1.0).abs() < 1e-11 * size * size && a > 0.0 && b > last - 1e-9 * size);
            last = b;
        }
        let (a, b) = along(h.point(from + sweep) - DVec3::X);
        prop_assert!((a - (from + sweep).cosh()).abs() < 1e-11 * size && (b - (from + sweep).sinh()).abs() < 1e-11 * size);
    }

    /// The curve through samples of an interpolant is met at its parameters, whatever the ends.
    #[test]
    fn interpolants_meet_their_points(points in prop::collection::vec(vector(), 2..20), which in 0usize..3) {
        prop_assume!(points.windows(2).all(|w| w[0].distance(w[1]) > 0.05));
        let n = points.len();
        let parameters = [Parameters::Uniform, Parameters::ChordLength, Parameters::Centripetal][which].clone();
        let at = parameters.of(&points).unwrap();
        for ends in [CurveEnds::Natural, CurveEnds::NotAKnot, CurveEnds::Clamped(DVec3::X, DVec3::Y)] {
            let c = interpolate(&points, &parameters, ends).unwrap();
            prop_assert_eq!((c.point(at[0]), c.point(at[n - 1])), (points[0], points[n - 1]));
            for (t, p) in at.iter().zip(&points) {
                prop_assert!(c.point(*t).distance(*p) < 1e-9, "{:?}", ends);
            }
        }
        prop_assume!(n > 2 && points[0].distance(points[n - 1]) > 0.05);
        let c = interpolate(&points, &parameters, CurveEnds::Closed).unwrap();
        let (a, b) = c.domain();
        prop_assert_eq!(c.point(a), c.point(b));
        for (t, p) in at.iter().zip(&points) {
            prop_assert!(c.point(*t).distance(*p) < 1e-9);
        }
    }

    /// A chain's segment `i` is the Bézier curve of its control points, with the global parameter's fraction.
    #[test]
    fn chains_are_bezier(points in prop::collection::vec(vector(), 1..6), degree in 1usize..6, t in 0.0f64..1.0) {
        let segments = points.len();
        let all: Vec<DVec4> =
            (0..=segments * degree).map(|i| (points[i % segments] * (1.0 + i as f64)).extend(1.0)).collect();
        let c = chain(degree, all.clone()).unwrap();
        prop_assert_eq!(c.domain(), (0.0, segments as f64));
        for s in 0..segments {
            let mut work: Vec<DVec3> = all[s * degree..=(s + 1) * degree].iter().map(|p| p.truncate()).collect();
            while work.len() > 1 {
                work = work.windows(2).map(|w| w[0].lerp(w[1], t)).collect();
            }
            prop_assert!(c.point(s as f64 + t).distance(work[0]) < 1e-12);
        }
    }
}

#[test]
fn full_circles_close_bit_for_bit() {
    for angle in [TAU, 2.0 * TAU, 5.0 * TAU] {
        let c = circle(DVec3::new(0.1, 0.2, 0.3), DVec3::new(0.3, -1.0, 2.0), DVec3::X, 0.7, angle).unwrap();
        assert_eq!(c.points()[0], c.points()[c.points().len() - 1]);
    }
    // a quarter from the axes: the textbook net
    let c = circle(DVec3::ZERO, DVec3::Z, DVec3::X, 1.0, TAU / 4.0).unwrap();
    let w = std::f64::consts::FRAC_1_SQRT_2;
    let expected = [DVec4::new(1.0, 0.0, 0.0, 1.0), DVec4::new(w, w, 0.0, w), DVec4::new(0.0, 1.0, 0.0, 1.0)];
    for (a, b) in c.points().iter().zip(expected) {
        assert!((*a - b).max_abs() < 1e-15);
    }
}

#[test]
fn what_is_wrong_has_a_name() {
    let (o, x, y) = (DVec3::ZERO, DVec3::X, DVec3::Y);
    let nan = DVec3::new(0.0, f64::NAN, 0.0);
    assert_eq!(line(o, nan), Err(ConstructError::NotFinite { what: "the line's end" }));
    assert_eq!(line(x, x), Err(ConstructError::ZeroLength { what: "the line" }));
    assert!(matches!(ellipse(o, x, x, 0.0, 1.0), Err(ConstructError::ZeroLength { .. })));
    for (a, b) in [(0.0, 0.0), (1.0, 0.0), (0.0, f64::NAN), (0.0, f64::INFINITY), (0.0, 1e9)] {
        assert!(matches!(ellipse(o, x, y, a, b), Err(ConstructError::Range { what: "the angle of the arc", .. })));
    }
    assert!(matches!(circle(o, o, x, 1.0, 1.0), Err(ConstructError::ZeroLength { what: "the axis" })));
    assert!(matches!(circle(o, x, x, 1.0, 1.0), Err(ConstructError::ZeroLength { .. })));
    assert!(matches!(circle(o, x, y, -1.0, 1.0), Err(ConstructError::Range { what: "the radius", .. })));
    assert!(matches!(hyperbola(o, x, y, 0.0, 900.0), Err(ConstructError::Range { .. })));
    assert!(matches!(parabola(o, x, o, 0.0, 1.0), Err(ConstructError::ZeroLength { .. })));
    let repeated = [o, x, x, y];
    let e = interpolate(&repeated, &Parameters::ChordLength, CurveEnds::Natural);
    assert_eq!(e, Err(ConstructError::CoincidentPoints { first: 1, second: 2 }));
    let e = interpolate(&[o, x, o], &Parameters::Centripetal, CurveEnds::Closed);
    assert_eq!(e, Err(ConstructError::CoincidentPoints { first: 2, second: 3 }));
    let e = interpolate(&[o], &Parameters::Uniform, CurveEnds::Natural);
    assert_eq!(e, Err(ConstructError::TooFew { what: "points", got: 1, needed: 2 }));
    let e = interpolate(&[o, x, y], &Parameters::Given(vec![0.0, 2.0, 1.0]), CurveEnds::Natural);
    assert_eq!(e, Err(ConstructError::Order { what: "parameter", index: 2 }));
    assert!(interpolate(&[o, nan], &Parameters::Uniform, CurveEnds::Natural).is_err());
    assert!(matches!(chain(3, vec![DVec4::W; 6]), Err(ConstructError::Count { needed: 4, .. })));
    assert!(chain(0, vec![DVec4::W; 6]).is_err() && chain(2, Vec::<DVec4>::new()).is_err());
}
