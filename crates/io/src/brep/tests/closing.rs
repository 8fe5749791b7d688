//! Loops of one curve whose ends nearly meet: the loop is closed, however large the gap.

use super::flat::rectangle;
use super::*;
use crate::spline::{BSpline, Surface};
use glam::DVec4;
use proptest::prelude::*;

const RADIUS: f64 = 2.0;

/// The kinds of curves that close by themselves.
#[derive(Clone, Copy, Debug)]
enum Kind {
    Circle,
    TrimmedCircle,
    CompositeOfOne,
    Ellipse,
    Clamped,
    Unclamped,
    Polyline,
}

/// A loop of one edge: the edge's curve, its ends, and the area within.
struct Ring {
    curve: CurveGeometry,
    ends: [DVec3; 2],
    area: f64,
}

/// The ends are `gap` apart: those of a circle on it, before or behind each other, those of a spline along `aside`.
fn ring(kind: Kind, f: Frame, gap: f64, aside: f64) -> Ring {
    let at = |a: f64, y: f64| f.world(DVec3::new(RADIUS * a.cos(), y * RADIUS * a.sin(), 0.0));
    let round = |curve: CurveGeometry, y: f64| {
        let angle = gap / RADIUS * aside.signum();
        Ring { curve, ends: [at(0.7, y), at(0.7 + angle, y)], area: PI * RADIUS * RADIUS * y }
    };
    let spline = |degree: usize, knots: Vec<f64>, mut points: Vec<DVec3>, share: f64| {
        let n = points.len();
        points[n - 1] += (f.x * aside.cos() + f.y * aside.sin()) * (gap / share);
        let points = points.into_iter().map(|p| p.extend(1.0)).collect();
        let spline = BSpline::new(degree, knots, points).unwrap();
        let (a, b) = spline.domain();
        let samples = 6000;
        let point = |i: usize| f.local(spline.point(a + (b - a) * i as f64 / samples as f64)).truncate();
        let area = (0..samples).map(|i| point(i).perp_dot(point(i + 1))).sum::<f64>() / 2.0;
        let ends = [spline.point(a), spline.point(b)];
        Ring { curve: CurveGeometry::BSpline(spline), ends, area }
    };
    let corner = |i: usize| at(TAU * i as f64 / 12.0, 1.0);
    match kind {
        Kind::Circle => round(circle(f, RADIUS), 1.0),
        Kind::Ellipse => round(CurveGeometry::Ellipse { frame: f, semi_x: RADIUS, semi_y: 0.5 * RADIUS }, 0.5),
        Kind::TrimmedCircle | Kind::CompositeOfOne => {
            let angle = (gap / RADIUS * aside.signum()).rem_euclid(TAU);
            let basis = Box::new(circle(f, RADIUS));
            let part = CurveGeometry::Trimmed { basis, start: 0.7, end: 0.7 + angle, forward: true };
            let one = matches!(kind, Kind::CompositeOfOne);
            round(if one { CurveGeometry::Composite(vec![part]) } else { part }, 1.0)
        }
        Kind::Clamped => {
            let knots = [0.0; 3].into_iter().chain((0..=10).map(f64::from)).chain([10.0; 3]).collect();
            spline(3, knots, (0..=12).map(corner).collect(), 1.0)
        }
        Kind::Unclamped => {
            let knots = (0..19).map(f64::from).collect();
            spline(3, knots, (0..15).map(corner).collect(), 1.0 / 6.0)
        }
        Kind::Polyline => {
            let knots = [0.0].into_iter().chain((0..=12).map(f64::from)).chain([12.0]).collect();
            spline(1, knots, (0..=12).map(corner).collect(), 1.0)
        }
    }
}

fn kinds() -> impl Strategy<Value = Kind> {
    use Kind::*;
    prop::sample::select(vec![Circle, TrimmedCircle, CompositeOfOne, Ellipse, Clamped, Unclamped, Polyline])
}

/// The plane of a frame, as a plane or as a spline.
fn carrier(f: Frame, spline: bool) -> SurfaceGeometry {
    if !spline {
        return SurfaceGeometry::Plane { frame: f };
    }
    let corner = |x: f64, y: f64| DVec4::from_point(f.world(DVec3::new(x, y, 0.0)), 1.0);
    let net = vec![corner(-6.0, -6.0), corner(6.0, -6.0), corner(-6.0, 6.0), corner(6.0, 6.0)];
    let knots = vec![0.0, 0.0, 1.0, 1.0];
    SurfaceGeometry::BSpline(Surface::new((1, 1), knots.clone(), knots, net).unwrap())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

    #[test]
    fn a_loop_of_one_curve_is_there(
        kind in kinds(),
        exponent in -16.0..-3.0f64,
        aside in -PI..PI,
        (hole, on_spline, same_sense, forward) in any::<(bool, bool, bool, bool)>(),
    ) {
        let (f, gap) = (odd_frame(), RADIUS * 10f64.powf(exponent));
        let ring = ring(kind, f, gap, aside);
        let ends = if same_sense { ring.ends } else { [ring.ends[1], ring.ends[0]] };
        let mut edges = vec![Edge { id: 101, curve: ring.curve, start: ends[0], end: ends[1], same_sense }];
        let mut bounds = vec![Boundary::Edges(vec![(0, forward)])];
        let mut wanted = ring.area;
        if hole {
            bounds.push(Boundary::Edges(rectangle(&mut edges, f, 10.0, 8.0)));
            wanted = 80.0 - ring.area;
        }
        let built = build_face(&face(carrier(f, on_spline), bounds), &edges, TOLERANCE);
        let built = built.map_err(|e| TestCaseError::fail(e.to_string()))?;
        prop_assert_eq!((built.face.loops.len(), built.lost.len()), (1 + usize::from(hole), 0), "{:?}", built.notes);
        // a gap takes or gives a triangle from the middle to it; samples and fits are good to 1e-6
        let area = surface_area(&built.face);
        prop_assert!((area - wanted).abs() <= RADIUS * gap + 1e-6 * wanted, "area {}, not {}", area, wanted);
    }
}

#[test]
fn an_edge_along_all_of_a_curve_that_nearly_closes_is_one_of_several() {
    // the curve of 13 points, and a line that closes its gap
    let f = odd_frame();
    let ring = ring(Kind::Clamped, f, 1e-8, 0.4);
    let mut edges = Vec::new();
    let all = edge(&mut edges, ring.curve, ring.ends[0], ring.ends[1]);
    let back = segment(&mut edges, ring.ends[1], ring.ends[0]);
    let bounds =
        vec![Boundary::Edges(rectangle(&mut edges, f, 10.0, 8.0)), Boundary::Edges(vec![(all, true), (back, true)])];
    let built = build_face(&face(SurfaceGeometry::Plane { frame: f }, bounds), &edges, TOLERANCE).unwrap();
    assert_eq!((built.face.loops.len(), built.lost.len()), (2, 0), "{:?}", built.notes);
    assert_area(&built, 80.0 - ring.area, 1e-6);
}

#[test]
fn a_loop_that_encloses_nothing_is_reported() {
    // a hole whose only edge is a point: the rest of the face is there
    let f = odd_frame();
    let mut edges = Vec::new();
    let point = f.world(DVec3::new(1.0, 1.0, 0.0));
    let nothing = edge(&mut edges, CurveGeometry::Line { origin: point, direction: f.x }, point, point);
    let outer = Boundary::Edges(rectangle(&mut edges, f, 10.0, 8.0));
    let plane = SurfaceGeometry::Plane { frame: f };
    let bounds = vec![outer, Boundary::Edges(vec![(nothing, true)])];
    let built = build_face(&face(plane, bounds), &edges, TOLERANCE).unwrap();
    assert_eq!(built.face.loops.len(), 1);
    assert_eq!(built.lost, ["face #7: a loop without length, edge #101, was left out"]);
    // nothing else bounds the spline: it is not shown whole
    for bound in [vec![(nothing, true)], Vec::new()] {
        let alone = build_face(&face(carrier(f, true), vec![Boundary::Edges(bound)]), &edges, TOLERANCE);
        assert_eq!(alone.unwrap_err(), BuildError::EmptyLoop { face: 7 });
    }
    // an arc whose ends are farther apart than those of a loop may be is no loop
    let [start, end] = [0.0, 0.4].map(|a: f64| f.world(DVec3::new(RADIUS * a.cos(), RADIUS * a.sin(), 0.0)));
    let arc = edge(&mut edges, circle(f, RADIUS), start, end);
    let open = build_face(&face(carrier(f, false), vec![Boundary::Edges(vec![(arc, true)])]), &edges, TOLERANCE);
    assert!(matches!(open, Err(BuildError::OpenLoop { face: 7, .. })), "{open:?}");
}
