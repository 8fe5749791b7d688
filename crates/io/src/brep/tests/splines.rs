//! Faces on B-spline, extruded and turned surfaces.

use super::super::support::Support;
use super::*;
use crate::spline::{BSpline, Surface};
use glam::DVec4;

fn spline(degree: usize, knots: &[f64], points: &[[f64; 3]]) -> BSpline<DVec4> {
    let points = points.iter().map(|p| DVec4::from_point(DVec3::from(*p), 1.0)).collect();
    BSpline::new(degree, knots.to_vec(), points).unwrap()
}

/// A bicubic sheet of 2 × 2 spans over `[0, 10]²`, bent by up to 2 mm.
fn sheet() -> Surface {
    let knots = vec![0.0, 0.0, 0.0, 0.0, 0.4, 1.0, 1.0, 1.0, 1.0];
    let points = (0..25).map(|k| {
        let (i, j) = (f64::from(k % 5), f64::from(k / 5));
        let greville = [0.0, 0.4 / 3.0, 1.4 / 3.0, 2.4 / 3.0, 1.0];
        let z = (0.9 * i).sin() + (0.7 * j + 0.4).cos();
        DVec4::from_point(DVec3::new(10.0 * greville[i as usize], 10.0 * greville[j as usize], z), 1.0)
    });
    Surface::new((3, 3), knots.clone(), knots, points.collect()).unwrap()
}

/// The curve `S(c(t))` for a line `c` in the domain, interpolated so finely by cubic Bézier pieces
/// that it lies within `4e-8` of the surface.
fn lifted(s: &Surface, a: DVec2, b: DVec2) -> CurveGeometry {
    let grid = s.patches();
    let n = 96;
    let at = |t: f64| {
        let p = a.lerp(b, t);
        let jet = grid.jet(p.x, p.y);
        (jet.point, jet.du * (b - a).x + jet.dv * (b - a).y)
    };
    let mut points = vec![DVec4::from_point(at(0.0).0, 1.0)];
    let mut knots = vec![0.0; 4];
    for i in 0..n {
        let (t0, t1) = (f64::from(i) / f64::from(n), f64::from(i + 1) / f64::from(n));
        let ((p0, d0), (p1, d1)) = (at(t0), at(t1));
        let h = (t1 - t0) / 3.0;
        points.extend([p0 + d0 * h, p1 - d1 * h, p1].map(|p| DVec4::from_point(p, 1.0)));
        knots.extend([t1; 3]);
    }
    knots.push(1.0);
    CurveGeometry::BSpline(BSpline::new(3, knots, points).unwrap())
}

#[test]
fn edges_on_a_sheet_come_back_as_the_lines_they_were() {
    let s = sheet();
    let corners = [DVec2::new(0.13, 0.21), DVec2::new(0.83, 0.1), DVec2::new(0.7, 0.95), DVec2::new(0.2, 0.71)];
    let mut edges = Vec::new();
    let grid = s.patches();
    let at = |p: DVec2| grid.point(p.x, p.y);
    let bound = (0..4)
        .map(|i| {
            let (a, b) = (corners[i], corners[(i + 1) % 4]);
            (edge(&mut edges, lifted(&s, a, b), at(a), at(b)), true)
        })
        .collect();
    let built = build(SurfaceGeometry::BSpline(s.clone()), vec![Boundary::Edges(bound)], &edges);
    assert_eq!(built.face.surface, s, "kept whole");
    assert!(built.deviation < 1e-6, "{:e}", built.deviation);
    // in the domain the loop is the quadrilateral
    let expected: f64 = (0..4).map(|i| corners[i].perp_dot(corners[(i + 1) % 4])).sum();
    assert!((built.face.loops[0].signed_area() - expected).abs() < 1e-6);
    for c in built.face.loops[0].curves() {
        for k in 0..=10 {
            let p = c.point(f64::from(k) / 10.0);
            let off = (0..4).map(|i| to_line(p, corners[i], corners[(i + 1) % 4])).fold(f64::INFINITY, f64::min);
            assert!(off < 1e-7, "{off:e}");
        }
    }
}

fn to_line(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    to_segment(p.extend(0.0), a.extend(0.0), b.extend(0.0))
}

#[test]
fn borders_of_a_sheet_are_borders_exactly() {
    let s = sheet();
    let corners = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
    let mut edges = Vec::new();
    let grid = s.patches();
    let at = |p: DVec2| grid.point(p.x, p.y);
    let bound = (0..4)
        .map(|i| {
            let (a, b) = (corners[i], corners[(i + 1) % 4]);
            (edge(&mut edges, lifted(&s, a, b), at(a), at(b)), true)
        })
        .collect();
    let built = build(SurfaceGeometry::BSpline(s), vec![Boundary::Edges(bound)], &edges);
    let curves: Vec<_> = built.face.loops[0].curves().collect();
    assert_eq!(curves.len(), 4);
    assert!(curves.iter().all(|c| c.degree() == 1));
    assert!((0..4).all(|i| (curves[i].point(0.0) - corners[i]).length() < 1e-9));
}

/// A tube around the x axis, closed in `u`: a rational circle of radius 2, straight in `v` from
/// 0 to 5, with its seam at angle 0.
fn tube() -> Surface {
    let k = 0.5f64.sqrt();
    let circle = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)];
    let points = [0.0, 5.0].into_iter().flat_map(|x| {
        circle.into_iter().enumerate().map(move |(i, (y, z))| {
            let p = DVec3::new(x, 2.0 * f64::from(y), 2.0 * f64::from(z));
            DVec4::from_point(p, if i % 2 == 1 { k } else { 1.0 })
        })
    });
    let knots = vec![0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0, 4.0];
    Surface::new((2, 1), knots, vec![0.0, 0.0, 5.0, 5.0], points.collect()).unwrap()
}

fn around_x(x: f64) -> Frame {
    Frame { origin: DVec3::X * x, x: DVec3::Y, y: DVec3::Z, z: DVec3::X }
}

#[test]
fn a_closed_spline_with_and_without_a_seam() {
    let surface = SurfaceGeometry::BSpline(tube());
    let mut edges = Vec::new();
    let low = full_circle(&mut edges, around_x(1.0), 2.0);
    let high = full_circle(&mut edges, around_x(4.0), 2.0);
    let rims = vec![Boundary::Edges(vec![(low, true)]), Boundary::Edges(vec![(high, false)])];
    let built = build(surface.clone(), rims, &edges);
    assert_area(&built, TAU * 2.0 * 3.0, 1e-9);
    assert_eq!(built.face.surface, tube());

    let seam = segment(&mut edges, DVec3::new(1.0, 2.0, 0.0), DVec3::new(4.0, 2.0, 0.0));
    let bound = vec![Boundary::Edges(vec![(low, true), (seam, true), (high, false), (seam, false)])];
    assert_area(&build(surface, bound, &edges), TAU * 2.0 * 3.0, 1e-9);
}

#[test]
fn a_loop_across_the_seam_of_a_spline_moves_the_seam() {
    let mut edges = Vec::new();
    let at = |a: f64, x: f64| DVec3::new(x, 2.0 * a.cos(), 2.0 * a.sin());
    let (a, b) = (-0.8, 1.1);
    let low = edge(&mut edges, circle(around_x(1.0), 2.0), at(a, 1.0), at(b, 1.0));
    let right = segment(&mut edges, at(b, 1.0), at(b, 3.0));
    let high = edge(&mut edges, circle(around_x(3.0), 2.0), at(a, 3.0), at(b, 3.0));
    let left = segment(&mut edges, at(a, 1.0), at(a, 3.0));
    let bound = vec![Boundary::Edges(vec![(low, true), (right, true), (high, false), (left, false)])];
    let built = build(SurfaceGeometry::BSpline(tube()), bound, &edges);
    assert_area(&built, 2.0 * 1.9 * 2.0, 1e-9);
    let ((u0, u1), _) = built.face.surface.domain();
    assert!(u0 < u1 && built.face.loops[0].bounds().0.x > u0 - 1e-9);
    // the moved seam still lies on the tube
    let grid = built.face.surface.patches();
    for k in 0..=200 {
        let p = grid.point(u0 + (u1 - u0) * f64::from(k) / 200.0, 2.0);
        assert!((p.y.hypot(p.z) - 2.0).abs() < 1e-13);
    }
}

#[test]
fn a_spline_with_a_collapsed_side() {
    // an eighth of a sphere of radius 3 as a rational biquadratic; its side v = 1 is the north pole
    let k = 0.5f64.sqrt();
    let profile = [(3.0, 0.0, 1.0), (3.0, 3.0, k), (0.0, 3.0, 1.0)];
    let turn = [(1.0, 0.0, 1.0), (1.0, 1.0, k), (0.0, 1.0, 1.0)];
    let points = profile
        .iter()
        .flat_map(|(r, z, w)| turn.iter().map(move |(x, y, v)| DVec4::from_point(DVec3::new(r * x, r * y, *z), w * v)));
    let knots = vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0];
    let s = Surface::new((2, 2), knots.clone(), knots, points.collect()).unwrap();
    let f = Frame::WORLD;
    let mut edges = Vec::new();
    let (a, b, c) = (DVec3::X * 3.0, DVec3::Y * 3.0, DVec3::Z * 3.0);
    let equator = edge(&mut edges, circle(f, 3.0), a, b);
    let up = edge(&mut edges, circle(meridian_frame(f, FRAC_PI_2), 3.0), b, c);
    let down = edge(&mut edges, circle(meridian_frame(f, 0.0), 3.0), a, c);
    let bound = vec![Boundary::Edges(vec![(equator, true), (up, true), (down, false)])];
    let built = build(SurfaceGeometry::BSpline(s.clone()), bound, &edges);
    assert_area(&built, 36.0 * PI / 8.0, 1e-9);
    assert_eq!(built.face.loops[0].curves().len(), 4, "three edges and the pole");

    // half of it, cut by a meridian that ends in the pole at u = 1/2
    let mut edges = Vec::new();
    let middle = (DVec3::X + DVec3::Y).normalize() * 3.0;
    let equator = edge(&mut edges, circle(f, 3.0), a, middle);
    let up = edge(&mut edges, circle(meridian_frame(f, PI / 4.0), 3.0), middle, c);
    let down = edge(&mut edges, circle(meridian_frame(f, 0.0), 3.0), a, c);
    let bound = vec![Boundary::Edges(vec![(equator, true), (up, true), (down, false)])];
    assert_area(&build(SurfaceGeometry::BSpline(s), bound, &edges), 36.0 * PI / 16.0, 1e-9);
}

#[test]
fn extruded_spline_with_straight_and_oblique_edges() {
    let profile = spline(
        3,
        &[0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 2.0, 2.0],
        &[[0.0, 0.0, 0.0], [1.0, 2.0, 0.0], [3.0, -1.0, 0.0], [5.0, 1.5, 0.0], [6.0, 0.0, 0.0]],
    );
    let length: f64 = profile
        .beziers()
        .iter()
        .map(|s| {
            let pieces = (0..64).map(|k| f64::from(k) / 64.0);
            pieces.map(|a| gauss(a, a + 1.0 / 64.0, |t| s.piece.jet(t).1.truncate().length())).sum::<f64>()
        })
        .sum();
    let direction = DVec3::new(0.0, 0.0, 2.0);
    let curve = CurveGeometry::BSpline(profile.clone());
    let surface = SurfaceGeometry::Extrusion { profile: Box::new(curve.clone()), direction };
    let lift = |z: f64| {
        let points = profile.points().iter().map(|p| *p + DVec4::Z * z).collect();
        CurveGeometry::BSpline(BSpline::new(3, profile.knots().to_vec(), points).unwrap())
    };
    let (a, b) = (DVec3::ZERO, DVec3::X * 6.0);
    let mut edges = Vec::new();
    let low = edge(&mut edges, lift(1.0), a + DVec3::Z, b + DVec3::Z);
    let right = segment(&mut edges, b + DVec3::Z, b + DVec3::Z * 4.0);
    let high = edge(&mut edges, lift(4.0), a + DVec3::Z * 4.0, b + DVec3::Z * 4.0);
    let left = segment(&mut edges, a + DVec3::Z, a + DVec3::Z * 4.0);
    let bound = vec![Boundary::Edges(vec![(low, true), (right, true), (high, false), (left, false)])];
    let built = build(surface.clone(), bound, &edges);
    // the profile turns sharply for 12 Gauss points a span
    assert_area(&built, 3.0 * length, 1e-7);
    assert!(built.face.loops[0].curves().all(|c| c.degree() == 1));
    let (_, (v0, v1)) = built.face.surface.domain();
    assert!((v0 - 0.5).abs() < 1e-9 && (v1 - 2.0).abs() < 1e-9);

    // the upper edge in a sloped plane, z = 4 + x / 6: the same curve, sheared
    let points = profile.points().iter().map(|p| *p + DVec4::Z * (4.0 + p.x / 6.0)).collect();
    let sloped = CurveGeometry::BSpline(BSpline::new(3, profile.knots().to_vec(), points).unwrap());
    let mut edges = Vec::new();
    let low = edge(&mut edges, lift(1.0), a + DVec3::Z, b + DVec3::Z);
    let right = segment(&mut edges, b + DVec3::Z, b + DVec3::Z * 5.0);
    let high = edge(&mut edges, sloped, a + DVec3::Z * 4.0, b + DVec3::Z * 5.0);
    let left = segment(&mut edges, a + DVec3::Z, a + DVec3::Z * 4.0);
    let bound = vec![Boundary::Edges(vec![(low, true), (right, true), (high, false), (left, false)])];
    let built = build(surface, bound, &edges);
    assert!(built.deviation < 1e-7, "{:e}", built.deviation);
    let off = farthest(&built, |p| {
        let border = (p.z - 1.0).abs().min((p.z - 4.0 - p.x / 6.0).abs());
        border.min(p.x.abs()).min((p.x - 6.0).abs())
    });
    assert!(off < 1e-7, "{off:e}");
}

#[test]
fn turned_profiles_reach_the_axis() {
    // a bowl: a quarter ellipse from the axis to the rim, turned; the bottom is a pole
    let f = odd_frame();
    let m = meridian_frame(f, 0.9);
    let quarter = CurveGeometry::Trimmed {
        basis: Box::new(CurveGeometry::Ellipse { frame: m, semi_x: 3.0, semi_y: 2.0 }),
        start: -FRAC_PI_2,
        end: 0.0,
        forward: true,
    };
    let profile = Box::new(CurveGeometry::Composite(vec![quarter]));
    let surface = SurfaceGeometry::Revolution { profile, origin: f.origin, axis: f.z };
    // half an oblate spheroid: a = 3, c = 2
    let e = (1.0f64 - 4.0 / 9.0).sqrt();
    let half = PI * 9.0 * (1.0 + (1.0 - e * e) / e * e.atanh());
    let mut edges = Vec::new();
    full_circle(&mut edges, f, 3.0);
    for direction in [true, false] {
        let bounds = vec![Boundary::Edges(vec![(0, direction)])];
        assert_area(&build(surface.clone(), bounds, &edges), half, 1e-9);
    }
}

#[test]
fn turned_lines_and_circles() {
    let f = odd_frame();
    let at = |rho: f64, z: f64| f.world(DVec3::new(rho, 0.0, z));
    let line = |a: DVec3, b: DVec3| Box::new(CurveGeometry::Line { origin: a, direction: b - a });
    let turned = |profile| SurfaceGeometry::Revolution { profile, origin: f.origin, axis: f.z };
    for (a, b, area) in [
        ((2.0, 0.0), (2.0, 3.0), TAU * 6.0),
        ((2.0, 0.0), (4.0, 3.0), PI * 6.0 * 13.0f64.sqrt()),
        ((2.0, 1.0), (4.0, 1.0), PI * 12.0),
    ] {
        let mut edges = Vec::new();
        full_circle(&mut edges, moved(f, [0.0, 0.0, a.1]), a.0);
        full_circle(&mut edges, moved(f, [0.0, 0.0, b.1]), b.0);
        let bounds = vec![Boundary::Edges(vec![(0, true)]), Boundary::Edges(vec![(1, false)])];
        assert_area(&build(turned(line(at(a.0, a.1), at(b.0, b.1))), bounds, &edges), area, 1e-10);
    }
    let ring = Frame { origin: at(5.0, 0.0), ..meridian_frame(f, 0.0) };
    let torus = build(turned(Box::new(circle(ring, 2.0))), Vec::new(), &[]);
    assert_area(&torus, 4.0 * PI * PI * 10.0, 1e-10);
}

/// Round at the axis, where a step to the foot may overshoot the end of the profile: the axis has no
/// far side there, and the radius grows backwards.
#[test]
fn a_profile_that_ends_square_to_the_axis_inverts_to_itself() {
    let knots = [0.0, 0.0, 0.0, 0.0, 9.0, 21.0, 31.0, 39.0, 39.0, 39.0, 39.0];
    // the knob of a handle about y
    let points = [[3.0, 6.0], [6.6, 6.7], [6.7, 15.9], [9.7, 25.1], [6.4, 35.5], [4.4, 40.0], [0.0, 40.0]];
    let profile = spline(3, &knots, &points.map(|[x, y]| [x, y, 0.0]));
    for profile in [profile.clone(), profile.reversed()] {
        let (curve, axis) = (Box::new(CurveGeometry::BSpline(profile.clone())), DVec3::Y);
        let support =
            Support::new(&SurfaceGeometry::Revolution { profile: curve, origin: DVec3::ZERO, axis }, 1e-7).unwrap();
        assert_eq!(support.poles.len(), 1);
        for k in 0..=390 {
            let v = f64::from(k) / 10.0;
            let p = support.point(DVec2::new(0.4, v));
            // from nowhere, from either side, from the pole
            for hint in [None, Some(v - 2.0), Some(v + 2.0), Some(support.poles[0].value)] {
                let found = support.invert(p, hint.map(|v| DVec2::new(0.4, v)), 1e-9);
                let gap = support.point(found).distance(p);
                assert!(gap <= 1e-9, "{gap:e} at {v} from {hint:?}");
            }
        }
    }
}

/// Four radii of curvature off a ridge, where whole Gauss-Newton steps run away from the foot.
#[test]
fn a_point_far_off_a_ridge_finds_its_foot() {
    // y = -2 x² with x = 2 u - 1: radius 1/4 at its top, u = 1/2, which is the foot of (0, 1)
    let ridge = spline(2, &[0.0, 0.0, 0.0, 1.0, 1.0, 1.0], &[[-1.0, -2.0, 0.0], [0.0, 2.0, 0.0], [1.0, -2.0, 0.0]]);
    let profile = Box::new(CurveGeometry::BSpline(ridge));
    let support = Support::new(&SurfaceGeometry::Extrusion { profile, direction: DVec3::Z }, 1e-7).unwrap();
    for hint in [None, Some(DVec2::new(0.3, 5.0)), Some(DVec2::new(0.9, 5.0))] {
        let foot = support.invert(DVec3::new(0.0, 1.0, 5.0), hint, 1e-9);
        // the distance is even about the foot: rounding of 1e-16 is a parameter of 1e-8
        assert!((foot - DVec2::new(0.5, 5.0)).abs().max_element() < 1e-7, "{foot} from {hint:?}");
    }
}
