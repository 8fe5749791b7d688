//! Windows, natural borders, loops out of order, offsets and curves on surfaces.

use super::flat::rectangle;
use super::*;
use crate::brep::{curve_on_surface, offset_curve, offset_surface};
use crate::spline::{BSpline, Surface};
use glam::DVec4;

fn window(basis: SurfaceGeometry, u: (f64, f64), v: (f64, f64)) -> SurfaceGeometry {
    SurfaceGeometry::Window { basis: Box::new(basis), u, v }
}

#[test]
fn a_window_is_what_a_face_without_loops_shows() {
    let f = odd_frame();
    let plane = build(window(SurfaceGeometry::Plane { frame: f }, (-1.0, 2.0), (4.0, 6.0)), Vec::new(), &[]);
    assert_area(&plane, 6.0, 1e-13);
    let tube = SurfaceGeometry::Cylinder { frame: f, radius: 2.0 };
    assert_area(&build(window(tube.clone(), (0.0, TAU), (1.0, 4.0)), Vec::new(), &[]), 2.0 * TAU * 3.0, 1e-12);
    // over the seam
    assert_area(&build(window(tube, (5.0, 8.0), (1.0, 4.0)), Vec::new(), &[]), 2.0 * 3.0 * 3.0, 1e-12);
    let ball = SurfaceGeometry::Sphere { frame: f, radius: 3.0 };
    let zone = 9.0 * 2.0 * (0.5f64.sin() - (-0.2f64).sin());
    assert_area(&build(window(ball.clone(), (1.0, 3.0), (-0.2, 0.5)), Vec::new(), &[]), zone, 1e-12);
    let cap = 9.0 * TAU * (1.0 - 0.5f64.sin());
    assert_area(&build(window(ball.clone(), (0.0, TAU), (0.5, FRAC_PI_2)), Vec::new(), &[]), cap, 1e-12);
    // a surface patch of 4 by 2, of which a quarter is seen
    assert_area(&build(window(flat_spline(), (0.0, 0.5), (0.0, 0.5)), Vec::new(), &[]), 2.0, 1e-12);
    let empty = build_face(&face(window(ball, (1.0, 1.0), (0.0, 1.0)), Vec::new()), &[], TOLERANCE);
    assert!(matches!(empty.unwrap_err(), BuildError::Surface { reason: "its parameter range is empty", .. }));
}

/// The rectangle 4 x 2 in the plane z = 0 as a spline over the unit square.
fn flat_spline() -> SurfaceGeometry {
    let at = |x: f64, y: f64| DVec4::new(x, y, 0.0, 1.0);
    let k = || vec![0.0, 0.0, 1.0, 1.0];
    let net = vec![at(0.0, 0.0), at(4.0, 0.0), at(0.0, 2.0), at(4.0, 2.0)];
    SurfaceGeometry::BSpline(Surface::new((1, 1), k(), k(), net).unwrap())
}

#[test]
fn holes_in_a_natural_border() {
    let mut edges = Vec::new();
    let hole = full_circle(&mut edges, moved(Frame::WORLD, [2.0, 1.0, 0.0]), 0.5);
    let bounds = vec![Boundary::Edges(vec![(hole, false)]), Boundary::Natural];
    assert_area(&build(flat_spline(), bounds, &edges), 8.0 - PI * 0.25, 1e-9);
    // the closed surface has the border that it is cut open along
    let f = odd_frame();
    let r = 2.0f64.sqrt();
    let mut edges = Vec::new();
    let rim = full_circle(&mut edges, moved(f, [0.0, 0.0, 1.0]), 1.0);
    let ball = SurfaceGeometry::Sphere { frame: f, radius: r };
    let bounds = vec![Boundary::Edges(vec![(rim, true)])];
    // at 45 degrees: the cap above, as ever
    assert_area(&build(ball, bounds, &edges), TAU * r * (r - 1.0), 1e-9);
    let plane = build_face(&face(SurfaceGeometry::Plane { frame: f }, vec![Boundary::Natural]), &[], TOLERANCE);
    assert_eq!(plane.unwrap_err(), BuildError::Unbounded { face: 7 });
}

#[test]
fn edges_out_of_order_are_put_in_order() {
    let f = odd_frame();
    for order in [[0, 2, 1, 3], [0, 3, 2, 1], [0, 2, 3, 1]] {
        let mut edges = Vec::new();
        let bound = rectangle(&mut edges, f, 4.0, 2.0);
        let mixed: Vec<_> = order.iter().map(|i| bound[*i]).collect();
        let built = build(SurfaceGeometry::Plane { frame: f }, vec![Boundary::Edges(mixed)], &edges);
        assert_area(&built, 8.0, 1e-12);
        // run backwards, every edge meets its neighbours: only directions are wrong
        let sorted = built.notes.iter().any(|n| n.contains("the edges of a loop were put in order"));
        assert_eq!(sorted, order != [0, 3, 2, 1], "{:?}", built.notes);
    }
    // one edge that belongs elsewhere: no order helps, and the gap is named
    let mut edges = Vec::new();
    let mut bound = rectangle(&mut edges, f, 4.0, 2.0);
    bound[2] = (segment(&mut edges, f.origin + f.z * 9.0, f.origin + f.z * 8.0), true);
    let open = build_face(&face(SurfaceGeometry::Plane { frame: f }, vec![Boundary::Edges(bound)]), &edges, TOLERANCE);
    assert!(matches!(open.unwrap_err(), BuildError::OpenLoop { face: 7, .. }));
}

/// A circle turned about an axis that it crosses: without loops its part beyond the axis.
#[test]
fn a_lemon_is_the_inner_part_of_a_degenerate_torus() {
    let (major, minor) = (1.0, 2.0);
    let f = odd_frame();
    let circle_frame = Frame { origin: f.origin + f.x * major, x: f.x, y: f.z, z: -f.y };
    let profile = Box::new(circle(circle_frame, minor));
    let lemon = SurfaceGeometry::Revolution { profile, origin: f.origin, axis: f.z };
    let built = build(lemon, Vec::new(), &[]);
    // 2 pi r times the integral of |R + r cos v| from acos(-R/r) to 2 pi - acos(-R/r)
    let end = (-major / minor).acos();
    let area = 2.0 * TAU * minor * (minor * end.sin() - major * (PI - end));
    assert_area(&built, area, 1e-9);
}

/// A quarter of a tube of radius 2 as a rational spline, exact.
fn tube() -> SurfaceGeometry {
    let w = 0.5f64.sqrt();
    let row =
        |z: f64| [(2.0, 0.0, 1.0), (2.0, 2.0, w), (0.0, 2.0, 1.0)].map(|(x, y, w)| DVec4::new(x * w, y * w, z * w, w));
    let net = [row(0.0), row(3.0)].concat();
    let (u, v) = (vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0], vec![0.0, 0.0, 1.0, 1.0]);
    SurfaceGeometry::BSpline(Surface::new((2, 1), u, v, net).unwrap())
}

#[test]
fn an_offset_spline_keeps_its_stated_error() {
    for d in [0.5, -0.75] {
        let (offset, error) = offset_surface(&tube(), d, 1e-4).unwrap();
        let SurfaceGeometry::BSpline(s) = offset else { panic!() };
        let grid = s.patches();
        // the normal of the tube points outwards
        let samples = (0..=97).flat_map(|i| (0..=7).map(move |j| (f64::from(i) / 97.0, f64::from(j) / 7.0)));
        let worst = samples.map(|(u, v)| (grid.point(u, v).truncate().length() - 2.0 - d).abs()).fold(0.0, f64::max);
        assert!(worst <= error && error <= 1e-6, "{worst:e} {error:e}");
    }
    // a roof: at its ridge the offset is torn
    let at = |x: f64, z: f64, y: f64| DVec4::new(x, y, z, 1.0);
    let net = vec![
        at(0.0, 0.0, 0.0),
        at(1.0, 1.0, 0.0),
        at(2.0, 0.0, 0.0),
        at(0.0, 0.0, 3.0),
        at(1.0, 1.0, 3.0),
        at(2.0, 0.0, 3.0),
    ];
    let roof = Surface::new((1, 1), vec![0.0, 0.0, 1.0, 2.0, 2.0], vec![0.0, 0.0, 1.0, 1.0], net).unwrap();
    let torn = offset_surface(&SurfaceGeometry::BSpline(roof), 0.5, 1e-4);
    assert_eq!(torn.unwrap_err(), "its offset is not smooth");
}

#[test]
fn offsets_of_swept_surfaces_sweep_the_moved_profile() {
    let f = odd_frame();
    let ellipse = CurveGeometry::Ellipse { frame: f, semi_x: 3.0, semi_y: 2.0 };
    let swept = SurfaceGeometry::Extrusion { profile: Box::new(ellipse), direction: f.z * 4.0 };
    let (offset, error) = offset_surface(&swept, 0.25, 1e-4).unwrap();
    let SurfaceGeometry::Extrusion { profile, .. } = offset else { panic!() };
    let CurveGeometry::BSpline(curve) = *profile else { panic!() };
    for k in 0..=200 {
        let t = TAU * f64::from(k) / 200.0;
        let normal = (f.x * (2.0 * t.cos()) + f.y * (3.0 * t.sin())).normalize();
        let exact = f.origin + f.x * (3.0 * t.cos()) + f.y * (2.0 * t.sin()) + normal * 0.25;
        assert!(curve.point(t).distance(exact) <= error, "{t}");
    }
    assert!(error < 1e-6, "{error:e}");
    // a straight line turned about a slanted axis: a cone moved along its normal
    let line = CurveGeometry::Line { origin: f.origin + f.x, direction: f.z + f.x };
    let cone = SurfaceGeometry::Revolution { profile: Box::new(line), origin: f.origin, axis: f.z };
    let (offset, error) = offset_surface(&cone, 0.5, 1e-4).unwrap();
    let SurfaceGeometry::Revolution { profile, .. } = offset else { panic!() };
    let CurveGeometry::Line { origin, .. } = *profile else { panic!() };
    // du is along y, dv along (1, 0, 1): the normal is (1, 0, -1)
    let expected = f.origin + f.x + (f.x - f.z).normalize() * 0.5;
    assert!(error == 0.0 && origin.distance(expected) < 1e-14);
}

#[test]
fn offset_curves_and_curves_on_surfaces() {
    let f = odd_frame();
    // z × tangent points to the centre of a circle run counter-clockwise
    let (inner, error) = offset_curve(&circle(f, 2.0), 0.5, f.z, 1e-4).unwrap();
    let CurveGeometry::BSpline(c) = inner else { panic!() };
    let worst = (0..=300).map(|k| from_circle(c.point(TAU * f64::from(k) / 300.0), f, 1.5)).fold(0.0, f64::max);
    assert!(worst <= error && error < 1e-6, "{worst:e} {error:e}");

    let tube = SurfaceGeometry::Cylinder { frame: f, radius: 2.0 };
    let (helix, error) = curve_on_surface(&tube, &|t| DVec2::new(t, 0.3 * t), &[], (1.0, 5.0), 1e-4).unwrap();
    let CurveGeometry::BSpline(c) = helix else { panic!() };
    for k in 0..=300 {
        let t = 1.0 + 4.0 * f64::from(k) / 300.0;
        let exact = f.world(DVec3::new(2.0 * t.cos(), 2.0 * t.sin(), 0.3 * t));
        assert!(c.point(t).distance(exact) <= error, "{t}");
    }
    assert!(error < 1e-6, "{error:e}");
    let corner = BSpline::new(
        1,
        vec![0.0, 0.0, 1.0, 2.0, 2.0],
        [0.0, 1.0, 0.5].map(|x| DVec4::new(x, x * x, 0.0, 1.0)).to_vec(),
    );
    let turn = |t: f64| corner.as_ref().unwrap().point(t).truncate();
    let (bent, error) = curve_on_surface(&tube, &turn, &[1.0], (0.0, 2.0), 1e-4).unwrap();
    assert!(matches!(bent, CurveGeometry::BSpline(_)) && error < 1e-6, "{error:e}");
}
