//! Every way in which a spline is refused, and the nearest one that is accepted.

use glam::{DVec3, DVec4};
use selvedge_geometry::spline::{BSpline, MAX_DEGREE, SplineError, Surface};

fn build(degree: usize, knots: &[f64], count: usize) -> Result<BSpline<DVec3>, SplineError> {
    BSpline::new(degree, knots.to_vec(), vec![DVec3::Z; count])
}

/// Clamped over `[0, 1]` without interior knots.
fn plain(degree: usize) -> Vec<f64> {
    [[0.0].repeat(degree + 1), [1.0].repeat(degree + 1)].concat()
}

#[test]
fn degree() {
    assert_eq!(build(0, &[0.0, 1.0], 1), Err(SplineError::Degree(0)));
    let above = MAX_DEGREE + 1;
    assert_eq!(build(above, &plain(above), above + 1), Err(SplineError::Degree(above)));
    assert!(build(MAX_DEGREE, &plain(MAX_DEGREE), MAX_DEGREE + 1).is_ok());
}

#[test]
fn number_of_points_and_knots() {
    assert_eq!(build(2, &plain(2), 2), Err(SplineError::TooFewPoints { points: 2, degree: 2 }));
    assert_eq!(build(2, &plain(2), 0), Err(SplineError::TooFewPoints { points: 0, degree: 2 }));
    assert_eq!(build(2, &plain(2), 4), Err(SplineError::KnotCount { knots: 6, points: 4, degree: 2 }));
    assert_eq!(build(2, &[], 3), Err(SplineError::KnotCount { knots: 0, points: 3, degree: 2 }));
}

#[test]
fn order_of_knots() {
    assert_eq!(build(1, &[0.0, 0.0, 1.0, 0.5, 2.0], 3), Err(SplineError::KnotOrder { index: 3 }));
    assert_eq!(build(1, &[0.0, f64::NAN, 1.0, 1.0], 2), Err(SplineError::KnotOrder { index: 1 }));
    assert_eq!(build(1, &[f64::NAN, 0.0, 1.0, 1.0], 2), Err(SplineError::KnotOrder { index: 0 }));
    assert_eq!(build(1, &[0.0, 0.0, 1.0, f64::INFINITY], 2), Err(SplineError::KnotOrder { index: 3 }));
}

#[test]
fn multiplicity_of_interior_knots() {
    let knots = |times: usize| [vec![0.0; 3], vec![0.5; times], vec![1.0; 3]].concat();
    assert!(build(2, &knots(2), 5).is_ok());
    let refused = SplineError::Multiplicity { value: 0.5, multiplicity: 3, degree: 2 };
    let torn = (0..6).map(|i| DVec3::new(f64::from(i), 0.0, 1.0)).collect();
    assert_eq!(BSpline::new(2, knots(3), torn), Err(refused));
    // the same point on both sides is one too many, and so is the knot
    assert_eq!(build(2, &knots(3), 6), build(2, &knots(2), 5));
    // more than degree + 1 at an end shifts the domain, and is no break inside it
    let long = [vec![0.0; 4], vec![1.0; 3]].concat();
    let curve = build(2, &long, 4).unwrap();
    assert_eq!((curve.domain(), curve.beziers().len()), ((0.0, 1.0), 1));
    assert_eq!(curve.homogeneous(0.5), DVec3::Z);
}

#[test]
fn empty_domain() {
    assert_eq!(build(1, &[0.0, 1.0, 1.0, 2.0], 2), Err(SplineError::EmptyDomain));
}

#[test]
fn control_points() {
    let with = |bad: DVec3| BSpline::new(1, plain(1), vec![DVec3::Z, bad]);
    let refused = Err(SplineError::ControlPoint { index: 1 });
    for bad in [
        DVec3::ZERO,
        DVec3::NEG_Z,
        DVec3::new(f64::NAN, 0.0, 1.0),
        DVec3::new(0.0, f64::INFINITY, 1.0),
        DVec3::splat(f64::NAN),
    ] {
        assert_eq!(with(bad), refused, "{bad}");
    }
    assert!(with(DVec3::new(-1.0, 0.0, 1e-300)).is_ok());
}

#[test]
fn surfaces_check_both_directions_and_the_net() {
    let make = |ku: &[f64], kv: &[f64], count| Surface::new((2, 1), ku.to_vec(), kv.to_vec(), vec![DVec4::W; count]);
    assert!(make(&plain(2), &plain(1), 6).is_ok());
    assert_eq!(make(&plain(2), &plain(1), 7), Err(SplineError::NetSize { points: 7, count_u: 3, count_v: 2 }));
    assert_eq!(make(&plain(2), &plain(1), 0), Err(SplineError::NetSize { points: 0, count_u: 3, count_v: 2 }));
    assert_eq!(make(&[], &plain(1), 6), Err(SplineError::TooFewPoints { points: 0, degree: 2 }));
    assert_eq!(make(&plain(2), &[1.0, 0.0, 1.0, 1.0], 6), Err(SplineError::KnotOrder { index: 1 }));
    let mut points = vec![DVec4::W; 6];
    points[4].w = -1.0;
    let refused = Surface::new((2, 1), plain(2), plain(1), points);
    assert_eq!(refused, Err(SplineError::ControlPoint { index: 4 }));
}

#[test]
fn messages_name_the_numbers() {
    let message = build(2, &plain(2), 4).unwrap_err().to_string();
    assert_eq!(message, "6 knots do not fit 4 control points of degree 2");
    let message = SplineError::NetSize { points: 7, count_u: 3, count_v: 2 }.to_string();
    assert_eq!(message, "7 control points do not make a net of 3 by 2");
}
