//! Edges that are borders of their surface, and edges that have nothing to do with it.

use super::super::border::Border;
use super::super::edge::EdgeCurve;
use super::super::fit::Fitter;
use super::super::lines::Lines;
use super::super::spline::SplineForm;
use super::super::strand::Strand;
use super::super::support::Support;
use super::*;
use crate::spline::{BSpline, Surface};
use glam::DVec4;
use std::rc::Rc;

/// A cubic by quadratic sheet of 3 x 2 spans over `[0, 3] x [0, 2]`, weights from 1 to 2.
fn sheet() -> Surface {
    let (ku, kv) = (vec![0.0, 0.0, 0.0, 0.0, 1.0, 2.5, 3.0, 3.0, 3.0, 3.0], vec![0.0, 0.0, 0.0, 0.7, 2.0, 2.0, 2.0]);
    let point = |k: i32| {
        let (i, j) = (f64::from(k % 6), f64::from(k / 6));
        DVec4::from_point(
            DVec3::new(4.0 * i + 0.3 * j, 5.0 * j, (1.3 * i).sin() + (0.8 * j).cos()),
            1.0 + 0.04 * f64::from(k),
        )
    };
    Surface::new((3, 2), ku, kv, (0..24).map(point).collect()).unwrap()
}

/// The four borders, each moved by `off` at its inner control points, weights and knots changed by a factor: the
/// surface's own numbers, written as another program would.
fn borders(s: &Surface, off: DVec3, list: &mut Vec<Edge>) -> Vec<(usize, bool)> {
    let (nu, nv) = s.counts();
    let row = |j: usize| (0..nu).map(|i| s.points()[j * nu + i]).collect::<Vec<_>>();
    let column = |i: usize| (0..nv).map(|j| s.points()[j * nu + i]).collect::<Vec<_>>();
    let (ku, kv) = s.knots();
    // the last two are written from corner to corner the other way round
    let sides = [(3, ku, row(0)), (2, kv, column(nu - 1)), (3, ku, row(nv - 1)), (2, kv, column(0))];
    let written = sides.into_iter().map(|(degree, knots, points)| {
        let knots = knots.iter().map(|k| 10.0 + 3.0 * k).collect();
        let last = points.len() - 1;
        let moved = points.iter().enumerate().map(|(i, p)| {
            let by = if i == 0 || i == last { DVec3::ZERO } else { off };
            DVec4::from_point(p.point() + by, 0.5 * p.w)
        });
        let curve = BSpline::new(degree, knots, moved.collect()).unwrap();
        let (a, b) = (points[0].point(), points[last].point());
        edge(list, CurveGeometry::BSpline(curve), a, b)
    });
    written.zip([true, true, false, false]).collect()
}

#[test]
fn borders_are_known_from_their_control_points() {
    let s = sheet();
    let mut edges = Vec::new();
    let bound = borders(&s, DVec3::ZERO, &mut edges);
    let built = build(SurfaceGeometry::BSpline(s.clone()), vec![Boundary::Edges(bound)], &edges);
    // weights changed by a factor: an ulp of 20 mm
    assert!(built.deviation == 0.0 && built.gap < 1e-14, "{:e}, {:e}", built.deviation, built.gap);
    // twice the area of the domain
    assert!((built.face.loops[0].signed_area() - 12.0).abs() < 1e-13, "{}", built.face.loops[0].signed_area());
}

#[test]
fn a_border_within_the_target_reports_its_gap() {
    // the target is a hundredth of the tolerance; three fifths of it
    let off = DVec3::new(0.0, 0.0, 0.6e-2 * TOLERANCE);
    let (s, mut edges) = (sheet(), Vec::new());
    let bound = borders(&s, off, &mut edges);
    let built = build(SurfaceGeometry::BSpline(s), vec![Boundary::Edges(bound)], &edges);
    assert!((built.gap - off.length()).abs() < 1e-14, "{:e}", built.gap);
    assert!(built.deviation < 1e-12, "{:e}", built.deviation);
}

#[test]
fn a_border_farther_off_is_measured() {
    let off = DVec3::new(0.0, 0.0, 1e-3);
    let (s, mut edges) = (sheet(), Vec::new());
    let bound = borders(&s, off, &mut edges);
    let built = build(SurfaceGeometry::BSpline(s), vec![Boundary::Edges(bound)], &edges);
    // no inner control point moves the curve by all of its way
    assert!(built.gap > 2e-4 && built.gap < 1e-3, "{:e}", built.gap);
}

/// The border `v = 0` of the sheet, with its control points, its weights and its knots changed.
fn lower(s: &Surface, change: impl Fn(usize, &mut DVec4), knots: impl Fn(f64) -> f64) -> Option<Border> {
    let nu = s.counts().0;
    let mut points = s.points()[..nu].to_vec();
    points.iter_mut().enumerate().for_each(|(i, p)| change(i, p));
    let ends = [points[0].point(), points[nu - 1].point()];
    let curve = BSpline::new(s.degrees().0, s.knots().0.iter().map(|k| knots(*k)).collect(), points).unwrap();
    let mut list = Vec::new();
    edge(&mut list, CurveGeometry::BSpline(curve), ends[0], ends[1]);
    let edge = EdgeCurve::new(&list[0], true, TOLERANCE).unwrap().unwrap();
    Border::of(&SplineForm::new(s, TOLERANCE), &edge, TOLERANCE)
}

#[test]
fn other_weights_and_other_knots_are_no_border() {
    let s = sheet();
    let linear = |k: f64| 7.0 - 2.0 * (3.0 - k);
    let found = lower(&s, |_, p| *p *= 0.25, linear).unwrap();
    assert_eq!((found.axis, found.value), (1, 0.0));
    assert!(found.at(linear(1.0)).distance(DVec2::new(1.0, 0.0)) < 1e-15);
    // an inner point stays where it is and draws harder; one span, so that the pieces have the same points
    let points = (0..6).map(|k| DVec4::new(f64::from(k % 3), f64::from(k / 3), f64::from(k % 2), 1.0)).collect();
    let arch = Surface::new((2, 1), vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0], vec![0.0, 0.0, 1.0, 1.0], points).unwrap();
    assert!(lower(&arch, |_, _| {}, |k| k).is_some());
    assert_eq!(lower(&arch, |i, p| *p *= if i == 1 { 1.001 } else { 1.0 }, |k| k), None);
    // three straight pieces: the same image, passed at another pace
    let points = (0..8).map(|k| DVec4::new(f64::from(k % 4), f64::from(k / 4), 0.0, 1.0)).collect();
    let knots = (vec![0.0, 0.0, 1.0, 2.0, 3.0, 3.0], vec![0.0, 0.0, 1.0, 1.0]);
    let straight = Surface::new((1, 1), knots.0, knots.1, points).unwrap();
    assert!(lower(&straight, |_, _| {}, |k| k).is_some());
    assert_eq!(lower(&straight, |_, _| {}, |k| if k == 1.0 { 1.1 } else { k }), None);
}

/// A trough, open at the top: a search that begins at one wall also finds a foot on the other wall.
#[test]
fn inversion_takes_bounded_work() {
    let row = |y: f64| [(0.0, 20.0), (5.0, -20.0), (10.0, 20.0)].map(|(x, z)| DVec4::new(x, y, z, 1.0));
    let points = row(0.0).into_iter().chain(row(10.0)).collect();
    let trough = Surface::new((2, 1), vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0], vec![0.0, 0.0, 1.0, 1.0], points).unwrap();
    let support = Support::new(&SurfaceGeometry::BSpline(trough), 1e-6).unwrap();
    let (p, hint) = (DVec3::new(1.0, 5.0, 15.0), DVec2::new(0.92, 0.5));
    let (near, far) = (support.invert(p, Some(hint), f64::INFINITY), support.invert(p, Some(hint), 0.0));
    assert!(near.x > 0.9 && far.x < 0.1, "{near}, {far}");
    support.allow(1);
    let mut searches = 0;
    while !support.exhausted() {
        assert_eq!(support.invert(p, Some(hint), 0.0), far);
        searches += 1;
    }
    // some ten evaluations each
    assert!((1 << 10..1 << 17).contains(&searches), "{searches}");
    assert_eq!(support.invert(p, Some(hint), 0.0), near, "the first answer is taken");
}

/// Found by fuzzing: a long spline far off its surface that wanders without aim. Its pre-image is no curve, Newton's
/// method creeps to each point of it, and every fit would be halved to the end.
#[test]
fn an_edge_far_off_its_surface_takes_bounded_work() {
    let support = Support::new(&SurfaceGeometry::BSpline(sheet()), TOLERANCE).unwrap();
    let mut state = 1u64;
    let mut random = || {
        // the top bits of Knuth's linear congruence
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        1e3 * ((state >> 40) as f64 / (1u64 << 24) as f64 - 0.5)
    };
    let points: Vec<DVec4> = (0..6003).map(|_| DVec3::new(random(), random(), random()).extend(1.0)).collect();
    let ends = [points[0].truncate(), points[6002].truncate()];
    let knots = (0..6007).map(|i| f64::from(i - 3).clamp(0.0, 6000.0)).collect();
    let mut list = Vec::new();
    edge(&mut list, CurveGeometry::BSpline(BSpline::new(3, knots, points).unwrap()), ends[0], ends[1]);
    let edge = EdgeCurve::new(&list[0], true, TOLERANCE).unwrap().unwrap();
    let nodes = edge.node_count as u64;
    assert_eq!(nodes, 3 * 6000 + 1);
    support.allow(edge.node_count);
    let strands = Strand::of_edge(&support, &Rc::new(edge), None, &mut Lines::default());
    let carrier = support.carrier([(0.0, 3.0), (0.0, 2.0)]).unwrap();
    let fitter = Fitter { support: &support, carrier: &carrier };
    let curves: usize = strands.iter().map(|s| fitter.curves(s).curves.len()).sum();
    // the allowance of nodes and patches, that of any face, and a quarter more for the loose work after it
    let allowed = (1 << 18) + 256 * (nodes + 6);
    assert!(support.spent.get() < allowed + allowed / 4, "{} of {allowed}", support.spent.get());
    assert!(support.exhausted());
    assert!(curves > 1);
}
