//! Cylinders, cones, spheres, tori: seams, rims, poles, holes.

use super::*;
use crate::spline::BSpline;
use glam::DVec4;

/// Rims of a cylinder of radius 2 about `f`, at heights 0 and 3, and its seam at angle 0.
fn cylinder_edges(f: Frame) -> (Vec<Edge>, usize, usize, usize) {
    let mut edges = Vec::new();
    let low = full_circle(&mut edges, f, 2.0);
    let top = moved(f, [0.0, 0.0, 3.0]);
    let high = full_circle(&mut edges, top, 2.0);
    let seam = segment(&mut edges, f.origin + f.x * 2.0, top.origin + f.x * 2.0);
    (edges, low, high, seam)
}

#[test]
fn full_cylinder_with_and_without_a_seam() {
    let f = odd_frame();
    let surface = SurfaceGeometry::Cylinder { frame: f, radius: 2.0 };
    let (edges, low, high, seam) = cylinder_edges(f);
    let with_seam = vec![Boundary::Edges(vec![(low, true), (seam, true), (high, false), (seam, false)])];
    // started at the seam, and listed the other way around
    let rotated = vec![Boundary::Edges(vec![(seam, true), (high, false), (seam, false), (low, true)])];
    let reversed = vec![Boundary::Edges(vec![(seam, true), (high, true), (seam, false), (low, false)])];
    for bounds in [with_seam, rotated, reversed] {
        let built = build(surface.clone(), bounds, &edges);
        assert_area(&built, TAU * 2.0 * 3.0, 1e-12);
        assert_eq!(built.face.loops.len(), 1);
        assert!(built.deviation < 1e-13 && built.notes.is_empty());
    }
    for (a, b) in [(true, false), (false, true), (true, true)] {
        let rims = vec![Boundary::Edges(vec![(high, b)]), Boundary::Edges(vec![(low, a)])];
        let built = build(surface.clone(), rims, &edges[..2]);
        assert_area(&built, TAU * 2.0 * 3.0, 1e-12);
        let ((u0, u1), (v0, v1)) = built.face.surface.domain();
        assert!((u1 - u0 - TAU).abs() < 1e-12 && v0.abs() < 1e-12 && (v1 - 3.0).abs() < 1e-12);
        let (nu, _) = built.face.surface.counts();
        assert_eq!(built.face.surface.points()[0], built.face.surface.points()[nu - 1]);
    }
}

#[test]
fn rims_whose_vertices_lie_at_different_angles() {
    let f = odd_frame();
    let surface = SurfaceGeometry::Cylinder { frame: f, radius: 2.0 };
    let mut edges = Vec::new();
    let low = full_circle(&mut edges, f, 2.0);
    let top = moved(f, [0.0, 0.0, 3.0]);
    let turned = Frame::new(top.origin, f.z, f.x * (2.1f64).cos() + f.y * (2.1f64).sin()).unwrap();
    let high = full_circle(&mut edges, turned, 2.0);
    let rims = vec![Boundary::Edges(vec![(low, true)]), Boundary::Edges(vec![(high, false)])];
    assert_area(&build(surface, rims, &edges), TAU * 6.0, 1e-12);
}

/// A quadrilateral patch `u0..u1 × v0..v1` of a cylinder of radius 2.
fn patch(edges: &mut Vec<Edge>, f: Frame, (u0, u1): (f64, f64), (v0, v1): (f64, f64)) -> Vec<(usize, bool)> {
    let at = |u: f64, v: f64| f.world(DVec3::new(2.0 * u.cos(), 2.0 * u.sin(), v));
    let rim = |v: f64| circle(moved(f, [0.0, 0.0, v]), 2.0);
    let low = edge(edges, rim(v0), at(u0, v0), at(u1, v0));
    let right = segment(edges, at(u1, v0), at(u1, v1));
    let high = edge(edges, rim(v1), at(u0, v1), at(u1, v1));
    let left = segment(edges, at(u0, v0), at(u0, v1));
    vec![(low, true), (right, true), (high, false), (left, false)]
}

#[test]
fn loops_across_the_seam_stay_in_one_piece() {
    let f = odd_frame();
    for u in [(-0.7, 0.9), (5.9, 7.1), (3.0, 3.3), (-3.5, 2.7)] {
        let mut edges = Vec::new();
        let bound = patch(&mut edges, f, u, (-1.0, 2.5));
        let cylinder = SurfaceGeometry::Cylinder { frame: f, radius: 2.0 };
        let built = build(cylinder, vec![Boundary::Edges(bound)], &edges);
        assert_area(&built, 2.0 * (u.1 - u.0) * 3.5, 1e-12);
        let ((u0, u1), _) = built.face.surface.domain();
        assert!((u1 - u0 - (u.1 - u.0)).abs() < 1e-9);
        assert!(built.deviation < 1e-12);
    }
}

#[test]
fn holes_in_a_seamless_cylinder_even_across_every_cut() {
    let f = odd_frame();
    let surface = SurfaceGeometry::Cylinder { frame: f, radius: 2.0 };
    let cases: [&[(f64, f64)]; 3] = [
        &[(1.0, 2.0)],
        // around the rims' vertices at angle 0
        &[(-0.5, 0.7), (2.0, 3.0)],
        // no angle is free of holes
        &[(-0.5, 1.8), (1.5, 3.9), (3.6, 5.9)],
    ];
    for holes in cases {
        let (mut edges, low, high, _) = cylinder_edges(f);
        edges.truncate(2);
        let mut bounds = vec![Boundary::Edges(vec![(low, true)]), Boundary::Edges(vec![(high, false)])];
        let mut removed = 0.0;
        for (i, u) in holes.iter().enumerate() {
            let v = (0.4 + 0.8 * i as f64, 1.0 + 0.8 * i as f64);
            bounds.push(Boundary::Edges(patch(&mut edges, f, *u, v)));
            removed += 2.0 * (u.1 - u.0) * 0.6;
        }
        let built = build(surface.clone(), bounds, &edges);
        assert_area(&built, TAU * 6.0 - removed, 1e-12);
        let ((u0, u1), _) = built.face.surface.domain();
        assert!(u1 - u0 < TAU + 1e-9);
    }
}

#[test]
fn a_hole_a_period_away_comes_home() {
    let f = odd_frame();
    let surface = SurfaceGeometry::Cylinder { frame: f, radius: 2.0 };
    let mut edges = Vec::new();
    // inverted separately, the outer loop starts near -π and the hole near +π
    let outer = Boundary::Edges(patch(&mut edges, f, (PI - 1.0, PI + 1.0), (0.0, 4.0)));
    let hole = Boundary::Edges(patch(&mut edges, f, (PI + 0.1, PI + 0.5), (1.0, 2.0)));
    for bounds in [vec![outer.clone(), hole.clone()], vec![hole, outer]] {
        assert_area(&build(surface.clone(), bounds, &edges), 2.0 * (8.0 - 0.4), 1e-12);
    }
}

#[test]
fn an_oblique_cut_of_a_cylinder_is_fitted() {
    // the plane z = 3 + x / 2 cuts the cylinder in an ellipse with semi axes 2 √(1 + 1/4) and 2
    let f = odd_frame();
    let mut edges = Vec::new();
    let low = full_circle(&mut edges, f, 2.0);
    let x = (f.x + f.z * 0.5).normalize();
    let tilted = Frame { origin: f.world(DVec3::new(0.0, 0.0, 3.0)), x, y: f.y, z: x.cross(f.y) };
    let start = tilted.origin + tilted.x * 2.0 * 1.25f64.sqrt();
    let ellipse = CurveGeometry::Ellipse { frame: tilted, semi_x: 2.0 * 1.25f64.sqrt(), semi_y: 2.0 };
    let high = edge(&mut edges, ellipse, start, start);
    let rims = vec![Boundary::Edges(vec![(low, true)]), Boundary::Edges(vec![(high, false)])];
    let built = build(SurfaceGeometry::Cylinder { frame: f, radius: 2.0 }, rims, &edges);
    assert_area(&built, TAU * 2.0 * 3.0, 1e-8);
    assert!(built.deviation < 2e-8, "{:e}", built.deviation);
    // on the cylinder, on the plane z = 3 + x / 2 or on the lower rim, or on the cut at angle 0
    let off = farthest(&built, |p| {
        let l = f.local(p);
        let cut = if l.x > 0.0 { l.y.abs() } else { f64::INFINITY };
        (l.z - 3.0 - 0.5 * l.x).abs().min(l.z.abs()).min(cut).max((l.x.hypot(l.y) - 2.0).abs())
    });
    assert!(off < 3e-8, "{off:e}");
}

#[test]
fn a_helical_edge_is_fitted_within_its_bound() {
    // a strip between two helices of one turn, each a cubic spline that interpolates it in 64 pieces
    let f = odd_frame();
    let (radius, pitch, n) = (2.0, 0.5, 64);
    let helix = |lift: f64| {
        let span = TAU / f64::from(n);
        let h = |u: f64| f.world(DVec3::new(radius * u.cos(), radius * u.sin(), lift + pitch * u / TAU));
        let d = |u: f64| {
            let speed = DVec3::new(-radius * u.sin(), radius * u.cos(), pitch / TAU);
            f.x * speed.x + f.y * speed.y + f.z * speed.z
        };
        let mut points = vec![DVec4::from_point(h(0.0), 1.0)];
        let mut knots = vec![0.0; 4];
        for i in 0..n {
            let (a, b) = (span * f64::from(i), span * f64::from(i + 1));
            points.push(DVec4::from_point(h(a) + d(a) * (span / 3.0), 1.0));
            points.push(DVec4::from_point(h(b) - d(b) * (span / 3.0), 1.0));
            points.push(DVec4::from_point(h(b), 1.0));
            knots.extend([b; 3]);
        }
        knots.push(TAU);
        (CurveGeometry::BSpline(BSpline::new(3, knots, points).unwrap()), h(0.0), h(TAU))
    };
    let mut edges = Vec::new();
    let (low, a, b) = helix(0.0);
    let (high, d, c) = helix(1.0);
    let low = edge(&mut edges, low, a, b);
    let right = segment(&mut edges, b, c);
    let high = edge(&mut edges, high, d, c);
    let left = segment(&mut edges, a, d);
    let bound = Boundary::Edges(vec![(low, true), (right, true), (high, false), (left, false)]);
    let built = build(SurfaceGeometry::Cylinder { frame: f, radius }, vec![bound], &edges);
    // between equal helices a height of 1 apart: one turn of the cylinder
    assert_area(&built, TAU * radius, 1e-6);
    // the edge itself leaves the cylinder by R h⁴ / 384 · a little: 5e-7; the bound says so
    assert!(built.deviation < 1e-6, "{:e}", built.deviation);
    let off = farthest(&built, |p| {
        let l = f.local(p);
        let u = l.y.atan2(l.x).rem_euclid(TAU);
        let above = (l.z - pitch * u / TAU).rem_euclid(0.5);
        above.min(0.5 - above).min(u.min(TAU - u) * radius)
    });
    assert!(off < 1e-6, "{off:e}");
}

#[test]
fn cone_frustum_and_cone_to_its_tip() {
    let f = odd_frame();
    // radius 2 at v = 0, tip at v = -2 / tan 0.5
    let angle: f64 = 0.5;
    let surface = SurfaceGeometry::Cone { frame: f, radius: 2.0, half_angle: angle };
    let tip = -2.0 / angle.tan();
    let lateral = |r: f64| PI * r * r / angle.sin();
    let mut edges = Vec::new();
    let rim = full_circle(&mut edges, f, 2.0);
    let small = full_circle(&mut edges, moved(f, [0.0, 0.0, tip / 2.0]), 1.0);
    let apex = f.world(DVec3::new(0.0, 0.0, tip));
    let seam = segment(&mut edges, apex, f.origin + f.x * 2.0);

    let frustum = vec![Boundary::Edges(vec![(rim, true)]), Boundary::Edges(vec![(small, true)])];
    assert_area(&build(surface.clone(), frustum, &edges[..2]), lateral(2.0) - lateral(1.0), 1e-12);
    let used = vec![edges[rim].clone(), edges[seam].clone()];
    let seamed = vec![Boundary::Edges(vec![(0, false), (1, false), (1, true)])];
    assert_area(&build(surface.clone(), seamed, &used), lateral(2.0), 1e-12);
    for direction in [true, false] {
        let capped = vec![Boundary::Edges(vec![(0, direction)])];
        assert_area(&build(surface.clone(), capped, &edges[..1]), lateral(2.0), 1e-12);
        let vertex = vec![Boundary::Vertex(apex), Boundary::Edges(vec![(0, direction)])];
        assert_area(&build(surface.clone(), vertex, &edges[..1]), lateral(2.0), 1e-12);
    }
    // a rim beyond the tip: the other nappe
    let mut beyond = Vec::new();
    full_circle(&mut beyond, moved(f, [0.0, 0.0, 1.5 * tip]), 1.0);
    let nappe = build(surface.clone(), vec![Boundary::Edges(vec![(0, true)])], &beyond);
    assert_area(&nappe, lateral(1.0), 1e-12);
    // a quarter between two generators that meet in the tip
    let mut quarter = Vec::new();
    let (a, b) = (f.origin + f.x * 2.0, f.origin + f.y * 2.0);
    let arc = edge(&mut quarter, circle(f, 2.0), a, b);
    let up = segment(&mut quarter, b, apex);
    let down = segment(&mut quarter, apex, a);
    let bound = vec![Boundary::Edges(vec![(arc, true), (up, true), (down, true)])];
    assert_area(&build(surface, bound, &quarter), lateral(2.0) / 4.0, 1e-12);
}

#[test]
fn sphere_caps_zones_and_octants() {
    let f = odd_frame();
    let r = 3.0;
    let sphere = SurfaceGeometry::Sphere { frame: f, radius: r };
    let latitude = |v: f64| (moved(f, [0.0, 0.0, r * v.sin()]), r * v.cos());
    let zone = |v0: f64, v1: f64| TAU * r * r * (v1.sin() - v0.sin());
    let mut edges = Vec::new();
    let (frame, radius) = latitude(0.6);
    let rim = full_circle(&mut edges, frame, radius);
    // counter-clockwise seen from the north: the face lies north; the other way: south
    for (direction, area) in [(true, zone(0.6, FRAC_PI_2)), (false, zone(-FRAC_PI_2, 0.6))] {
        let built = build(sphere.clone(), vec![Boundary::Edges(vec![(rim, direction)])], &edges);
        assert_area(&built, area, 1e-12);
        let north = Boundary::Vertex(f.world(DVec3::new(0.0, 0.0, r)));
        let named = build(sphere.clone(), vec![north, Boundary::Edges(vec![(rim, direction)])], &edges);
        assert_area(&named, zone(0.6, FRAC_PI_2), 1e-12);
    }
    let (frame, radius) = latitude(-0.9);
    full_circle(&mut edges, frame, radius);
    let both = vec![Boundary::Edges(vec![(0, true)]), Boundary::Edges(vec![(1, true)])];
    assert_area(&build(sphere.clone(), both, &edges), zone(-0.9, 0.6), 1e-12);

    let whole = build(sphere.clone(), vec![Boundary::Vertex(f.world(DVec3::new(0.0, 0.0, -r)))], &[]);
    assert!(whole.face.loops.is_empty());
    assert_area(&whole, 4.0 * PI * r * r, 1e-12);

    for turn in [0.0, 2.8, -0.4] {
        for forward in [true, false] {
            let mut edges = Vec::new();
            let at = |u: f64| f.world(DVec3::new(r * u.cos(), r * u.sin(), 0.0));
            let north = f.world(DVec3::new(0.0, 0.0, r));
            let equator = edge(&mut edges, circle(f, r), at(turn), at(turn + FRAC_PI_2));
            let up = edge(&mut edges, circle(meridian_frame(f, turn + FRAC_PI_2), r), at(turn + FRAC_PI_2), north);
            let down = edge(&mut edges, circle(meridian_frame(f, turn), r), at(turn), north);
            let mut bound = vec![(equator, true), (up, true), (down, false)];
            if !forward {
                bound = bound.into_iter().rev().map(|(e, d)| (e, !d)).collect();
            }
            // the sphere is closed: run the other way, the loop bounds the rest of it
            let built = build(sphere.clone(), vec![Boundary::Edges(bound)], &edges);
            let area = 4.0 * PI * r * r * if forward { 1.0 / 8.0 } else { 7.0 / 8.0 };
            assert_area(&built, area, 1e-12);
        }
    }
}

#[test]
fn spheres_by_seam_by_two_halves_and_by_a_lune() {
    let f = odd_frame();
    let r = 3.0;
    let sphere = SurfaceGeometry::Sphere { frame: f, radius: r };
    let (south, north) = (f.origin - f.z * r, f.origin + f.z * r);
    let mut edges = Vec::new();
    let seam = edge(&mut edges, circle(meridian_frame(f, 0.0), r), south, north);
    let whole = build(sphere.clone(), vec![Boundary::Edges(vec![(seam, true), (seam, false)])], &edges);
    assert_area(&whole, 4.0 * PI * r * r, 1e-12);

    // a great circle through both poles as one closed edge: a hemisphere
    let mut edges = Vec::new();
    full_circle(&mut edges, meridian_frame(f, 0.7), r);
    for direction in [true, false] {
        let half = build(sphere.clone(), vec![Boundary::Edges(vec![(0, direction)])], &edges);
        assert_area(&half, 2.0 * PI * r * r, 1e-12);
        // the great circle's own axis points away from one of the two hemispheres
        let middle = meridian_frame(f, 0.7).z * if direction { r } else { -r };
        let l = f.local(f.origin + middle);
        let u = l.y.atan2(l.x);
        let ((u0, u1), _) = half.face.surface.domain();
        let inside = super::super::law::nearest(u, 0.5 * (u0 + u1), TAU);
        assert!((inside - 0.5 * (u0 + u1)).abs() < 1e-6, "{u} in {u0}..{u1}");
    }

    let mut edges = Vec::new();
    let up = edge(&mut edges, circle(meridian_frame(f, 1.5), r), south, north);
    let down = edge(&mut edges, circle(meridian_frame(f, 0.3), r), south, north);
    let lune = build(sphere, vec![Boundary::Edges(vec![(up, true), (down, false)])], &edges);
    assert_area(&lune, 2.0 * r * r * 1.2, 1e-12);
}

#[test]
fn a_circle_on_a_sphere_bounds_either_side() {
    // a small circle about an oblique axis, away from poles and seam, then around a pole
    let f = odd_frame();
    let r = 3.0;
    let sphere = SurfaceGeometry::Sphere { frame: f, radius: r };
    for (axis, half_angle) in
        [(DVec3::new(1.0, 0.3, 0.2), 0.5f64), (DVec3::new(-1.0, 0.1, 0.1), 0.6), (DVec3::new(0.2, 0.1, 1.0), 0.5)]
    {
        let axis = (f.x * axis.x + f.y * axis.y + f.z * axis.z).normalize();
        let ring = Frame::new(f.origin + axis * (r * half_angle.cos()), axis, f.y).unwrap();
        let cap = TAU * r * r * (1.0 - half_angle.cos());
        for (direction, area) in [(true, cap), (false, 4.0 * PI * r * r - cap)] {
            let mut edges = Vec::new();
            full_circle(&mut edges, ring, r * half_angle.sin());
            let built = build(sphere.clone(), vec![Boundary::Edges(vec![(0, direction)])], &edges);
            assert_area(&built, area, 1e-7);
            assert!(built.deviation < 2e-8, "{:e}", built.deviation);
        }
    }
}

#[test]
fn torus_quarter_fillet_bands_and_holes() {
    let f = odd_frame();
    let (major, minor) = (5.0, 2.0);
    let torus = SurfaceGeometry::Torus { frame: f, major, minor };
    let parallel = |v: f64| (moved(f, [0.0, 0.0, minor * v.sin()]), major + minor * v.cos());
    let meridian = |u: f64| {
        let m = meridian_frame(f, u);
        Frame { origin: f.origin + m.x * major, ..m }
    };
    let at = |u: f64, v: f64| {
        let rho = major + minor * v.cos();
        f.world(DVec3::new(rho * u.cos(), rho * u.sin(), minor * v.sin()))
    };
    let area = |u: f64, v0: f64, v1: f64| u * minor * (major * (v1 - v0) + minor * (v1.sin() - v0.sin()));

    for (u, v) in [((0.2, 1.7), (0.0, FRAC_PI_2)), ((2.0, 4.5), (2.0, 4.0)), ((-1.0, 1.0), (-0.5, 0.5))] {
        let mut edges = Vec::new();
        let (low, high) = (parallel(v.0), parallel(v.1));
        let a = edge(&mut edges, circle(low.0, low.1), at(u.0, v.0), at(u.1, v.0));
        let b = edge(&mut edges, circle(meridian(u.1), minor), at(u.1, v.0), at(u.1, v.1));
        let c = edge(&mut edges, circle(high.0, high.1), at(u.0, v.1), at(u.1, v.1));
        let d = edge(&mut edges, circle(meridian(u.0), minor), at(u.0, v.0), at(u.0, v.1));
        let inside = vec![Boundary::Edges(vec![(a, true), (b, true), (c, false), (d, false)])];
        let built = build(torus.clone(), inside, &edges);
        assert_area(&built, area(u.1 - u.0, v.0, v.1), 1e-12);
        assert!(built.face.loops[0].curves().all(|c| c.degree() == 1), "closed form");
        let outside = vec![Boundary::Edges(vec![(d, true), (c, true), (b, false), (a, false)])];
        let rest = 4.0 * PI * PI * major * minor - area(u.1 - u.0, v.0, v.1);
        assert_area(&build(torus.clone(), outside, &edges), rest, 1e-12);
    }
    // a band around the axis: which of the two is said by the directions of its rims
    let mut edges = Vec::new();
    for v in [0.3, 2.0] {
        let (frame, radius) = parallel(v);
        full_circle(&mut edges, frame, radius);
    }
    let band = |low: bool| vec![Boundary::Edges(vec![(0, low)]), Boundary::Edges(vec![(1, !low)])];
    assert_area(&build(torus.clone(), band(true), &edges), area(TAU, 0.3, 2.0), 1e-12);
    assert_area(&build(torus.clone(), band(false), &edges), area(TAU, 2.0, 0.3 + TAU), 1e-12);
    // a bend between two whole meridians
    let mut edges = Vec::new();
    for u in [0.5, 1.5] {
        full_circle(&mut edges, meridian(u), minor);
    }
    let bend = |first: bool| vec![Boundary::Edges(vec![(0, first)]), Boundary::Edges(vec![(1, !first)])];
    // at the smaller angle the face lies towards +u: its rim runs towards -v
    assert_area(&build(torus.clone(), bend(false), &edges), area(1.0, 0.0, TAU), 1e-12);
    assert_area(&build(torus, bend(true), &edges), area(TAU - 1.0, 0.0, TAU), 1e-12);
}

#[test]
fn an_apple_is_closed_over_its_poles() {
    let f = odd_frame();
    let (major, minor): (f64, f64) = (1.0, 2.0);
    let apple = SurfaceGeometry::Torus { frame: f, major, minor };
    let end = (-major / minor).acos();
    let mut edges = Vec::new();
    full_circle(&mut edges, f, major + minor);
    let half = TAU * minor * (major * end + minor * end.sin());
    for direction in [true, false] {
        let built = build(apple.clone(), vec![Boundary::Edges(vec![(0, direction)])], &edges);
        assert_area(&built, half, 1e-12);
        let ((_, _), (v0, v1)) = built.face.surface.domain();
        assert!(if direction { v0.abs() < 1e-12 } else { v1.abs() < 1e-12 }, "{v0} {v1}");
    }
}

#[test]
fn a_lemon_is_the_inner_part_of_the_same_torus() {
    let f = odd_frame();
    let (major, minor): (f64, f64) = (1.0, 2.0);
    let torus = SurfaceGeometry::Torus { frame: f, major, minor };
    let end = (-major / minor).acos();
    let mut edges = Vec::new();
    full_circle(&mut edges, f, minor - major);
    let half = TAU * minor * (minor * end.sin() - major * (PI - end));
    for direction in [true, false] {
        assert_area(&build(torus.clone(), vec![Boundary::Edges(vec![(0, direction)])], &edges), half, 1e-12);
    }
}

#[test]
fn a_helical_strip_may_run_around_many_times() {
    // between two helices of pitch 1, a quarter apart, over three turns: lines in the domain, so the
    // area is the height times the developed length around
    let f = Frame::WORLD;
    let (radius, turns, n) = (2.0, 3.0, 240);
    let helix = |lift: f64| {
        let span = turns * TAU / f64::from(n);
        let h = |u: f64| DVec3::new(radius * u.cos(), radius * u.sin(), lift + u / TAU);
        let d = |u: f64| DVec3::new(-radius * u.sin(), radius * u.cos(), 1.0 / TAU);
        let mut points = vec![DVec4::from_point(h(0.0), 1.0)];
        let mut knots = vec![0.0; 4];
        for i in 0..n {
            let (a, b) = (span * f64::from(i), span * f64::from(i + 1));
            points.extend([h(a) + d(a) * (span / 3.0), h(b) - d(b) * (span / 3.0), h(b)].map(|p| p.extend(1.0)));
            knots.extend([b; 3]);
        }
        knots.push(turns * TAU);
        (CurveGeometry::BSpline(BSpline::new(3, knots, points).unwrap()), h(0.0), h(turns * TAU))
    };
    let mut edges = Vec::new();
    let (low, a, b) = helix(0.0);
    let (high, d, c) = helix(0.25);
    let low = edge(&mut edges, low, a, b);
    let right = segment(&mut edges, b, c);
    let high = edge(&mut edges, high, d, c);
    let left = segment(&mut edges, a, d);
    let bound = Boundary::Edges(vec![(low, true), (right, true), (high, false), (left, false)]);
    let built = build(SurfaceGeometry::Cylinder { frame: f, radius }, vec![bound], &edges);
    assert_area(&built, 0.25 * turns * TAU * radius, 1e-6);
    let ((u0, u1), _) = built.face.surface.domain();
    assert!((u1 - u0 - turns * TAU).abs() < 1e-6);
}
