//! Details that whole faces do not show, and loops that cannot be.

use super::super::law::{Axis, Law};
use super::*;
use crate::spline::arc::sin_cos;

#[test]
fn angles_become_half_tangents_inside_a_piece() {
    let axis = Axis::new(Law::Angle, 0.3, 0.3 + TAU);
    assert_eq!(axis.knots.len(), 5);
    for k in 0..=100 {
        let x = 0.3 + TAU * f64::from(k) / 100.0;
        let y = axis.to_carrier(x);
        assert!((axis.to_native(y) - x).abs() < 1e-14 * 10.0);
        let i = axis.knots.partition_point(|k| *k <= y).clamp(1, 4);
        let (a, b) = (axis.knots[i - 1], axis.knots[i]);
        let t = (y - a) / (b - a);
        let (m, h) = (0.5 * (a + b), 0.5 * (b - a));
        assert!((((x - m) / 2.0).tan() - (2.0 * t - 1.0) * (h / 2.0).tan()).abs() < 1e-14);
    }
    assert!(axis.knots.iter().all(|k| axis.to_carrier(*k) == *k && axis.to_native(*k) == *k));
}

#[test]
fn quarter_turns_are_exact() {
    for k in -9..=9 {
        let (s, c) = sin_cos(f64::from(k) * FRAC_PI_2);
        assert_eq!((s.abs() + c.abs(), s * c), (1.0, 0.0), "{k}");
    }
    assert_eq!(sin_cos(1.0), 1.0f64.sin_cos());
}

#[test]
fn a_loop_twice_around_is_named() {
    // two rims of a cylinder in one loop, both the same way around
    let f = Frame::WORLD;
    let mut edges = Vec::new();
    let rim = |z: f64| moved(f, [0.0, 0.0, z]);
    let a = full_circle(&mut edges, rim(0.0), 2.0);
    let up = segment(&mut edges, DVec3::X * 2.0, DVec3::new(2.0, 0.0, 1.0));
    let b = full_circle(&mut edges, rim(1.0), 2.0);
    let bound = vec![Boundary::Edges(vec![(a, true), (up, true), (b, true), (up, false)])];
    let error = build_face(&face(SurfaceGeometry::Cylinder { frame: f, radius: 2.0 }, bound), &edges, TOLERANCE);
    assert_eq!(error.unwrap_err(), BuildError::Winding { face: 7, u: 2, v: 0 });
}

#[test]
fn a_rim_alone_on_a_cylinder_is_named() {
    let f = odd_frame();
    let mut edges = Vec::new();
    full_circle(&mut edges, f, 2.0);
    let surface = SurfaceGeometry::Cylinder { frame: f, radius: 2.0 };
    let error = build_face(&face(surface, vec![Boundary::Edges(vec![(0, true)])]), &edges, TOLERANCE);
    assert_eq!(error.unwrap_err(), BuildError::OpenRim { face: 7 });
}

#[test]
fn senses_do_not_change_the_shape() {
    let f = odd_frame();
    let mut edges = Vec::new();
    full_circle(&mut edges, f, 2.0);
    let mut g = face(SurfaceGeometry::Plane { frame: f }, vec![Boundary::Edges(vec![(0, true)])]);
    let forward = build_face(&g, &edges, TOLERANCE).unwrap();
    g.same_sense = false;
    let backward = build_face(&g, &edges, TOLERANCE).unwrap();
    assert!(forward.face.same_sense && !backward.face.same_sense);
    assert_eq!(forward.face.loops, backward.face.loops);
}

/// Rectangles of every nesting and overlap, each against each.
#[test]
fn depths_are_those_of_all_pairs() {
    let mut random = crate::math::random::Random::new(5);
    for count in [1, 2, 7, 60] {
        let mut rectangle = || {
            let mut side = || {
                let (a, b) = (random.range(0.0, 20.0), random.range(0.0, 20.0));
                (a.min(b), a.max(b))
            };
            let ((u0, u1), (v0, v1)) = (side(), side());
            [(u0, v0), (u1, v0), (u1, v1), (u0, v1), (u0, v0)].map(|(u, v)| DVec2::new(u, v)).to_vec()
        };
        let polygons: Vec<Vec<DVec2>> = (0..count).map(|_| rectangle()).collect();
        // more than half of the sides' middles
        let holds = |a: &[DVec2], b: &[DVec2]| {
            let inside = |w: &&[DVec2]| {
                let p = 0.5 * (w[0] + w[1]);
                p.x > a[0].x && p.x < a[2].x && p.y > a[0].y && p.y < a[2].y
            };
            b.windows(2).filter(inside).count() > 2
        };
        let pairs = |i: usize| (0..count).filter(|j| *j != i && holds(&polygons[*j], &polygons[i])).count();
        assert_eq!(super::super::nest::depths(&polygons), (0..count).map(pairs).collect::<Vec<_>>());
    }
}

/// A row of holes along each axis, within a border of thousands of edges. Neither the pairs nor the edges that a hole is
/// compared with grow with all of them: a test of each with each takes minutes.
#[test]
fn depths_of_many_holes_within_a_long_border() {
    const EACH: u32 = 20_000;
    let square = |at: DVec2| {
        let corners = [(0.0, 0.0), (0.25, 0.0), (0.25, 0.25), (0.0, 0.25), (0.0, 0.0)];
        corners.map(|(u, v)| at + DVec2::new(u, v)).to_vec()
    };
    let reach = f64::from(EACH);
    let border = |k: u32| DVec2::from_angle(std::f64::consts::TAU * f64::from(k % EACH) / reach) * 2.0 * reach;
    let mut polygons = vec![(0..=EACH).map(border).collect()];
    polygons.extend((0..EACH).map(|k| square(DVec2::new(f64::from(k), 0.5))));
    polygons.extend((0..EACH).map(|k| square(DVec2::new(0.5, f64::from(k) + 1.0))));
    let depths = super::super::nest::depths(&polygons);
    assert!(depths[0] == 0 && depths[1..].iter().all(|depth| *depth == 1));
}
