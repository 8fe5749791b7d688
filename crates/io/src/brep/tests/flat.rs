//! Planar faces.

use super::*;
use crate::spline::BSpline;
use glam::DVec4;

/// A rectangle `a × b` around the frame's origin, counter-clockwise.
pub(super) fn rectangle(list: &mut Vec<Edge>, f: Frame, a: f64, b: f64) -> Vec<(usize, bool)> {
    let c = |x: f64, y: f64| f.world(DVec3::new(x * a / 2.0, y * b / 2.0, 0.0));
    let corners = [c(-1.0, -1.0), c(1.0, -1.0), c(1.0, 1.0), c(-1.0, 1.0)];
    (0..4).map(|i| (segment(list, corners[i], corners[(i + 1) % 4]), true)).collect()
}

#[test]
fn holes_of_any_direction_and_order_are_holes() {
    let f = odd_frame();
    for directions in [[true, true], [true, false], [false, false]] {
        for outer_first in [true, false] {
            let mut edges = Vec::new();
            let outer = Boundary::Edges(rectangle(&mut edges, f, 10.0, 6.0));
            let holes = [[-3.0, 1.0], [2.0, -1.0]].map(|p| full_circle(&mut edges, moved(f, [p[0], p[1], 0.0]), 0.8));
            let mut bounds: Vec<Boundary> = (0..2).map(|i| Boundary::Edges(vec![(holes[i], directions[i])])).collect();
            bounds.insert(if outer_first { 0 } else { 2 }, outer);
            let built = build(SurfaceGeometry::Plane { frame: f }, bounds, &edges);
            assert_area(&built, 60.0 - 2.0 * PI * 0.64, 1e-12);
            assert!(built.notes.is_empty() && built.deviation < 1e-13, "{}", built.deviation);
            let ((u0, u1), (v0, v1)) = built.face.surface.domain();
            assert!((u0 + 5.0).abs().max((u1 - 5.0).abs()) < 1e-12 && (v0 + 3.0).abs().max((v1 - 3.0).abs()) < 1e-12);
            let areas: Vec<f64> = built.face.loops.iter().map(TrimLoop::signed_area).collect();
            assert_eq!(areas.iter().filter(|a| **a > 0.0).count(), 1);
        }
    }
}

#[test]
fn a_disc_is_an_exact_circle_in_a_tight_square() {
    let f = odd_frame();
    let mut edges = Vec::new();
    let rim = full_circle(&mut edges, f, 2.5);
    let built = build(SurfaceGeometry::Plane { frame: f }, vec![Boundary::Edges(vec![(rim, false)])], &edges);
    assert_area(&built, PI * 6.25, 1e-12);
    assert!(farthest(&built, |p| from_circle(p, f, 2.5)) < 1e-14 * 20.0);
    let ((u0, u1), _) = built.face.surface.domain();
    assert!((u0 + 2.5).abs() < 1e-9 && (u1 - 2.5).abs() < 1e-9);
}

#[test]
fn spline_and_conic_edges_stay_exact_in_a_plane() {
    // a parabola cap: y from 0 to 2 under the quadratic spline through (-2, 0), (0, 4), (2, 0)
    let f = odd_frame();
    let at = |x: f64, y: f64| f.world(DVec3::new(x, y, 0.0));
    let h = |p: DVec3| DVec4::from_point(p, 1.0);
    let points = vec![h(at(2.0, 0.0)), h(at(0.0, 4.0)), h(at(-2.0, 0.0))];
    let spline = CurveGeometry::BSpline(BSpline::new(2, vec![0.0, 0.0, 0.0, 3.0, 3.0, 3.0], points).unwrap());
    let mut edges = Vec::new();
    let base = segment(&mut edges, at(-2.0, 0.0), at(2.0, 0.0));
    let cap = edge(&mut edges, spline.clone(), at(2.0, 0.0), at(-2.0, 0.0));
    let plane = SurfaceGeometry::Plane { frame: f };
    let built = build(plane.clone(), vec![Boundary::Edges(vec![(base, true), (cap, true)])], &edges);
    assert_area(&built, 16.0 / 3.0, 1e-12);

    // the same with the edge stored from the other end, and with its sense reversed
    for (start, end, same_sense, forward) in [(-2.0, 2.0, false, false), (2.0, -2.0, true, true)] {
        let mut edges = Vec::new();
        let base = segment(&mut edges, at(-2.0, 0.0), at(2.0, 0.0));
        let cap = edge(&mut edges, spline.clone(), at(start, 0.0), at(end, 0.0));
        edges[cap].same_sense = same_sense;
        let built = build(plane.clone(), vec![Boundary::Edges(vec![(base, true), (cap, forward)])], &edges);
        assert_area(&built, 16.0 / 3.0, 1e-12);
        assert!(built.notes.is_empty());
    }
}

#[test]
fn arcs_run_the_stated_way_around() {
    let f = odd_frame();
    let at = |a: f64| f.world(DVec3::new(2.0 * a.cos(), 2.0 * a.sin(), 0.0));
    let (a, b) = (0.4, 1.9);
    // the segment of the circle between the two points, the short way and the long way
    for (same_sense, sweep) in [(true, b - a), (false, TAU - (b - a))] {
        let mut edges = Vec::new();
        let arc = edge(&mut edges, circle(f, 2.0), at(a), at(b));
        edges[arc].same_sense = same_sense;
        let chord = segment(&mut edges, at(b), at(a));
        let bounds = vec![Boundary::Edges(vec![(arc, true), (chord, true)])];
        let built = build(SurfaceGeometry::Plane { frame: f }, bounds, &edges);
        assert_area(&built, 2.0 * (sweep - sweep.sin()), 1e-12);
    }
}

#[test]
fn composite_edges_and_polylines() {
    let f = odd_frame();
    let at = |x: f64, y: f64| f.world(DVec3::new(x, y, 0.0));
    let line = |a: DVec3, b: DVec3| CurveGeometry::Trimmed {
        basis: Box::new(CurveGeometry::Line { origin: a, direction: (b - a).normalize() }),
        start: 0.0,
        end: a.distance(b),
        forward: true,
    };
    // half a disc on a box: up the right side, over the arc, down the left side
    let arc = CurveGeometry::Trimmed {
        basis: Box::new(circle(moved(f, [0.0, 3.0, 0.0]), 1.0)),
        start: 0.0,
        end: PI,
        forward: true,
    };
    let chain =
        CurveGeometry::Composite(vec![line(at(1.0, 0.0), at(1.0, 3.0)), arc, line(at(-1.0, 3.0), at(-1.0, 0.0))]);
    let mut edges = Vec::new();
    let base = segment(&mut edges, at(-1.0, 0.0), at(1.0, 0.0));
    let top = edge(&mut edges, chain, at(1.0, 0.0), at(-1.0, 0.0));
    let bounds = vec![Boundary::Edges(vec![(base, true), (top, true)])];
    let built = build(SurfaceGeometry::Plane { frame: f }, bounds, &edges);
    assert_area(&built, 6.0 + FRAC_PI_2, 1e-12);
}

#[test]
fn faults_are_repaired_and_named() {
    let f = odd_frame();
    let plane = SurfaceGeometry::Plane { frame: f };
    let mut edges = Vec::new();
    let mut bound = rectangle(&mut edges, f, 4.0, 2.0);
    // an edge listed against the loop
    bound[2].1 = false;
    let built = build(plane.clone(), vec![Boundary::Edges(bound.clone())], &edges);
    assert_area(&built, 8.0, 1e-12);
    assert!(built.notes.iter().any(|n| n.contains("#103") && n.contains("turned around")), "{:?}", built.notes);
    // a vertex that misses its neighbour by 5 micrometres
    bound[2].1 = true;
    edges[1].end += f.x * 5e-3;
    let built = build(plane.clone(), vec![Boundary::Edges(bound.clone())], &edges);
    assert!((surface_area(&built.face) - 8.0).abs() < 0.01);
    assert!(built.notes.iter().any(|n| n.contains("gap")), "{:?}", built.notes);
    // half the loop is missing
    let open = build_face(&face(plane.clone(), vec![Boundary::Edges(bound[..2].to_vec())]), &edges, TOLERANCE);
    assert!(matches!(open.unwrap_err(), BuildError::OpenLoop { face: 7, edge: 101, .. }));
    let absent = build_face(&face(plane.clone(), vec![Boundary::Edges(vec![(9, true)])]), &edges, TOLERANCE);
    assert_eq!(absent.unwrap_err(), BuildError::EdgeIndex { face: 7, index: 9 });
    // there and back along one line
    let slit = build_face(&face(plane, vec![Boundary::Edges(vec![(0, true), (0, false)])]), &edges, TOLERANCE);
    assert_eq!(slit.unwrap_err(), BuildError::NoArea { face: 7 });
}

/// A hole across the border takes its part of the face, and a note says so. A hole that touches the border crosses
/// nothing.
#[test]
fn loops_that_cross_are_reported() {
    let f = odd_frame();
    for (x, told) in [(5.0, true), (4.2, false)] {
        let mut edges = Vec::new();
        let outer = Boundary::Edges(rectangle(&mut edges, f, 10.0, 6.0));
        let hole = Boundary::Edges(vec![(full_circle(&mut edges, moved(f, [x, 0.0, 0.0]), 0.8), true)]);
        let built = build(SurfaceGeometry::Plane { frame: f }, vec![outer, hole], &edges);
        let notes: Vec<&String> = built.notes.iter().filter(|n| n.contains("trim loops cross near")).collect();
        assert_eq!(notes.len(), usize::from(told), "{:?}", built.notes);
    }
}

#[test]
fn an_edge_off_its_plane_is_measured() {
    let f = odd_frame();
    let mut edges = Vec::new();
    let rim = full_circle(&mut edges, moved(f, [0.0, 0.0, 0.02]), 2.0);
    let built = build(SurfaceGeometry::Plane { frame: f }, vec![Boundary::Edges(vec![(rim, true)])], &edges);
    assert!((built.gap - 0.02).abs() < 1e-9 && built.deviation < 1e-13, "{} {}", built.gap, built.deviation);
    assert!(built.notes.iter().any(|n| n.contains("#101") && n.contains("2.000e-2 mm")), "{:?}", built.notes);
}

#[test]
fn islands_in_holes_are_outer_again() {
    let f = odd_frame();
    let mut edges = Vec::new();
    let bounds = [3.0, 2.0, 1.0].map(|r| Boundary::Edges(vec![(full_circle(&mut edges, f, r), true)])).to_vec();
    let built = build(SurfaceGeometry::Plane { frame: f }, bounds, &edges);
    assert_area(&built, PI * (9.0 - 4.0 + 1.0), 1e-12);
}

#[test]
fn curves_stay_true_where_vertices_miss_them() {
    // two half circles whose common vertices lie 0.1 mm too far out
    let f = odd_frame();
    let mut edges = Vec::new();
    let (a, b) = (f.origin + f.x * 2.1, f.origin - f.x * 2.1);
    let upper = edge(&mut edges, circle(f, 2.0), a, b);
    let lower = edge(&mut edges, circle(f, 2.0), b, a);
    let bounds = vec![Boundary::Edges(vec![(upper, true), (lower, true)])];
    let built = build_face(&face(SurfaceGeometry::Plane { frame: f }, bounds), &edges, TOLERANCE).unwrap();
    // the straight pieces to the vertices and back enclose nothing
    assert_area(&built, PI * 4.0, 1e-12);
    assert!(built.deviation < 1e-13);
    let off = farthest(&built, |p| from_circle(p, f, 2.0));
    assert!((off - 0.1).abs() < 1e-9, "{off}");
}
